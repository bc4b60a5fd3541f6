//! One point in one cell with the linear basis, the left node held: the smallest specimen, where every edge has a closed form.
//!
//! With N the value of the right node's function at the point, ω = √(E/ρ)/L, s = ωΔt, velocity v and u = τ L/E, the node's
//! velocity after the forces is w = v − s u/N (in units of ω) and the point's, with FLIP, v⁺ = v − s u. Stress update last takes
//! w, the other two v⁺ (or v, before the forces):
//!
//! | | v⁺ | u⁺ | determinant | edge |
//! |---|---|---|---|---|
//! | FLIP, MUSL and USF | v − s u | u + s v⁺ | 1 | 2 |
//! | FLIP, USL | v − s u | u + s w | 1 − s²(1/N − 1) | √(4N/(2 − N)) |
//! | PIC, MUSL and USF | N v − s u | u + s v⁺ | N | √(2(1 + N)) |
//! | PIC, USL | N w | u + s w | N | √(2N(1 + N)) |
//! | APIC | w is kept | u + s w | 1 | 2√N |
//!
//! The second row loses the share s²(1/N − 1) of its energy in every step.

use super::bar::{Bar, noise};
use super::bisect::first_failure;
use super::findings::{Drawing, Findings, Sense};
use super::measure::survive;
use super::operator::{ROUND_OFF, real_radius, whole};
use super::{Failure, Method, Study};
use crate::report::{LineChart, Series, Style};
use crate::study::validate::CaseError;
use std::f64::consts::TAU;

/// The case.
pub const FAILURE: Failure = Failure {
    name: "point",
    title: "one point in one cell (linear basis): the critical step where the node has little of the point's mass",
    measure: "critical omega dt: energy of a free vibration grows 1000-fold within 800 steps; fails below 1, half of what the oscillator itself allows",
    prediction: "closed form; spectral radius of the solver's step where there is none",
    run,
};

const SHARES: [f64; 7] = [0.02, 0.05, 0.1, 0.25, 0.5, 0.75, 0.95];

fn run(study: &Study) -> Result<Findings, CaseError> {
    // nothing moves far enough for the frame to matter
    let methods = study.whatever_frame();
    let linear = methods.iter().filter(|m| m.basis == "linear");
    let jobs: Vec<(Method, f64)> = linear
        .flat_map(|method| SHARES.map(|share| (*method, share)))
        .collect();
    let edges = study.map(&jobs, |(method, share)| {
        let predicted = closed_form(method, *share).unwrap_or_else(|| critical(*method, *share));
        (predicted, measured(*method, *share))
    });
    let mut findings = Findings::new("critical step omega dt", Sense::AtLeast, 1.0);
    for ((method, share), (predicted, edge)) in jobs.iter().zip(&edges) {
        findings.push(method, format!("N = {share}"), Some(*predicted), *edge);
    }
    if jobs.is_empty() {
        findings.shown = "Nothing was done: this case knows the linear basis only.".into();
        return Ok(findings);
    }
    let (kept, predicted) = damping();
    findings.shown = format!(
        "FLIP with MUSL or USF holds to 2 wherever the point lies; USL and APIC lose their step as N goes to 0. USL also damps: in ten periods of 1000 steps each at N = 0.5 it keeps {:.1} % of the energy (closed form {:.1} %). Measured and predicted edges differ by {:.2} % at most.",
        100.0 * kept,
        100.0 * predicted,
        100.0 * findings.worst_deviation()
    );
    findings.drawings.push(("", draw(&jobs, &edges)));
    Ok(findings)
}

fn closed_form(method: &Method, n: f64) -> Option<f64> {
    let last = method.update == "usl";
    Some(match method.transfer {
        "flip" if last => (4.0 * n / (2.0 - n)).sqrt(),
        "flip" => 2.0,
        "pic" if last => (2.0 * n * (1.0 + n)).sqrt(),
        "pic" => (2.0 * (1.0 + n)).sqrt(),
        "apic" => 2.0 * n.sqrt(),
        _ => return None,
    })
}

/// One point at x = N in the cell from 0 to 1; how wide it is makes no difference to the linear basis.
fn bar(method: Method, share: f64) -> Bar {
    Bar {
        span: [share - 0.01, share + 0.01],
        cells: 1,
        held: vec![[-0.1, 0.1]],
        ..Bar::held(method, 1, 0.0)
    }
}

fn critical(method: Method, share: f64) -> f64 {
    let Ok(mut specimen) = bar(method, share).build() else {
        return f64::NAN;
    };
    first_failure([0.01, 4.0], 0.1, 1e-5, |dt| {
        whole(&mut specimen, dt).is_ok_and(|step| real_radius(&step) > 1.0 + ROUND_OFF)
    })
}

fn measured(method: Method, share: f64) -> f64 {
    let bar = bar(method, share);
    first_failure([0.01, 4.0], 0.1, 1e-4, |dt| {
        let Ok(mut specimen) = bar.build() else {
            return true;
        };
        specimen.set(|id| [1e-9 * noise(id), 0.0, 0.0]);
        survive(&mut specimen, 0.0, dt, 800).is_err()
    })
}

/// The share of energy that FLIP with USL keeps over ten periods at N = 1/2, as measured and by the closed form.
fn damping() -> (f64, f64) {
    let method = Method {
        basis: "linear",
        transfer: "flip",
        update: "usl",
        frame: "updated",
    };
    let (dt, steps) = (TAU / 1000.0, 10_000);
    let Ok(mut specimen) = bar(method, 0.5).build() else {
        return (f64::NAN, f64::NAN);
    };
    specimen.set(|_| [1e-9, 0.0, 0.0]);
    let start = specimen.energy(0.0);
    for _ in 0..steps {
        if specimen.step(dt).is_err() {
            return (f64::NAN, f64::NAN);
        }
    }
    let determinant: f64 = 1.0 - dt * dt;
    (specimen.energy(0.0) / start, determinant.powi(steps))
}

fn draw(jobs: &[(Method, f64)], edges: &[(f64, f64)]) -> Drawing {
    let mut series = Vec::new();
    let mut methods: Vec<Method> = jobs.iter().map(|job| job.0).collect();
    methods.dedup();
    // USF has the edges of MUSL, and APIC has one edge for all
    let shown = |m: &&Method| m.update == "usl" || (m.update == "musl" && m.transfer != "apic");
    for method in methods.iter().filter(shown) {
        let of = jobs.iter().zip(edges).filter(|(job, _)| job.0 == *method);
        let points = of.map(|(job, edge)| (job.1, edge.1)).collect();
        let name = if method.transfer == "apic" {
            "apic, any update".into()
        } else if method.update == "musl" {
            format!("{} musl, usf", method.transfer)
        } else {
            format!("{} usl", method.transfer)
        };
        series.push(Series::new(name, points, Style::Markers));
    }
    for (i, method) in methods.iter().filter(shown).enumerate() {
        let curve = (1..=200).map(|i| f64::from(i) / 200.0);
        let points = curve.filter_map(|n| Some((n, closed_form(method, n)?)));
        let name = if i == 0 {
            "closed forms; unstable above them"
        } else {
            ""
        };
        series.push(Series {
            color: Some(crate::report::Color(34, 34, 34)),
            ..Series::new(name, points.collect(), Style::Dashed)
        });
    }
    Drawing::Lines(vec![LineChart {
        title: "Longest stable step of one point in one cell, linear basis".into(),
        x_label: "N: share of the point's mass at the free node (its place in the cell)".into(),
        y_label: "critical step ω Δt".into(),
        x_range: Some([0.0, 1.0]),
        y_range: Some([0.0, 2.2]),
        series,
        ..LineChart::default()
    }])
}
