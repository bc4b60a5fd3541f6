//! Nodes of little mass: the last point of a bar has just crossed into an empty cell, and the far node of that cell has next to
//! none of its mass. A free end that moves through the grid passes all such places.
//!
//! For the linear basis and a point ξ cells into the empty cell, the node of mass ξ m limits USL to √(2ξ) and APIC to 2√ξ as ξ
//! goes to 0; FLIP with MUSL or USF never notices, because the node's velocity reaches points multiplied by ξ again.

use super::bar::{Bar, noise};
use super::bisect::first_failure;
use super::findings::{Drawing, Findings, Sense};
use super::measure::survive;
use super::operator::{ROUND_OFF, real_radius, whole};
use super::{Failure, Method, Study};
use crate::report::{HeatCell, HeatMap};
use crate::study::validate::CaseError;

/// The case.
pub const FAILURE: Failure = Failure {
    name: "small_mass",
    title: "a free end whose last point has just entered an empty cell: nodes of little mass cut the time step",
    measure: "critical Courant number c dt/h of noise on a bar with one free end: energy grows 1000-fold within 800 steps; fails below 0.3, the step of the scenarios here",
    prediction: "spectral radius of one step of the solver on the same bar",
    run,
};

const DEPTHS: [f64; 6] = [1e-4, 1e-3, 0.01, 0.03, 0.1, 0.3];
const LIMIT: f64 = 0.3;

fn run(study: &Study) -> Result<Findings, CaseError> {
    let points = study.points_or(&[2])[0];
    let mut jobs = Vec::new();
    // nothing moves but by round-off: the frames do the same
    let methods = study.whatever_frame();
    for method in &methods {
        jobs.extend(DEPTHS.map(|depth| (*method, depth)));
    }
    let edges = study.map(&jobs, |(method, depth)| {
        let bar = bar(*method, points, *depth);
        (predicted(&bar), measured(&bar))
    });
    let mut findings = Findings::new("critical Courant number c dt/h", Sense::AtLeast, LIMIT);
    for ((method, depth), (predicted, measured)) in jobs.iter().zip(&edges) {
        findings.push(method, at(*depth), Some(*predicted), *measured);
    }
    let closed = [
        ("linear flip usl", "sqrt(2 xi) = 0.141"),
        ("linear apic usl", "2 sqrt(xi) = 0.200"),
    ];
    let found = closed.into_iter().filter_map(|(name, form)| {
        let row = findings.row(name, &at(0.01))?;
        Some(format!(" {name} is stable to {:.3} ({form}).", row.measured))
    });
    findings.shown = format!(
        "With the last point one hundredth of a cell in, at {points} points per cell:{} Smooth bases keep a bounded step. {} of {} places fail. Measured and predicted edges differ by {:.1} % at most.",
        found.collect::<String>(),
        findings.failing(),
        findings.rows.len(),
        100.0 * findings.worst_deviation()
    );
    let row = |method: &Method| {
        let of = jobs.iter().zip(&edges).filter(|(job, _)| job.0 == *method);
        of.map(|(_, edge)| cell(edge.1)).collect()
    };
    findings.drawings.push((
        "",
        Drawing::Map(HeatMap {
            title: format!(
                "Longest stable step c Δt/h of a bar with a free end, {points} points per cell"
            ),
            x_label: "how far the last point is inside an otherwise empty cell (cells)".into(),
            holds: "stable at Courant number 0.3".into(),
            fails: "unstable at 0.3 (the critical Courant number is written in each cell)".into(),
            columns: DEPTHS.map(|depth| depth.to_string()).into(),
            rows: methods.iter().map(Method::within_frame).collect(),
            cells: methods.iter().map(row).collect(),
        }),
    ));
    Ok(findings)
}

fn at(depth: f64) -> String {
    format!("xi = {depth}")
}

/// How an edge is shown beside [`LIMIT`].
fn cell(edge: f64) -> HeatCell {
    let ratio = (edge / LIMIT).log10().abs();
    HeatCell {
        text: format!("{edge:.3}"),
        fails: edge < LIMIT,
        strength: ratio,
    }
}

/// Some seven cells, of which those below 4 m are held; the last point is `depth` above the node at 9 m.
fn bar(method: Method, points: u32, depth: f64) -> Bar {
    let spacing = 1.0 / f64::from(points);
    let end = 9.0 + depth + 0.5 * spacing;
    Bar {
        span: [end - 7.0, end],
        cells: 14,
        held: vec![[-2.0, 4.0]],
        ..Bar::held(method, points, 0.0)
    }
}

fn predicted(bar: &Bar) -> f64 {
    let Ok(mut specimen) = bar.build() else {
        return f64::NAN;
    };
    first_failure([1e-3, 4.0], 0.1, 1e-4, |dt| {
        whole(&mut specimen, dt).is_ok_and(|step| real_radius(&step) > 1.0 + ROUND_OFF)
    })
}

fn measured(bar: &Bar) -> f64 {
    first_failure([1e-3, 4.0], 0.1, 1e-3, |dt| {
        let Ok(mut specimen) = bar.build() else {
            return true;
        };
        // small enough that the last point does not leave the place that is examined
        specimen.set(|id| [1e-12 * noise(id), 0.0, 0.0]);
        survive(&mut specimen, 0.0, dt, 800).is_err()
    })
}
