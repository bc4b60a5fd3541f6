//! Ringing: what the grid cannot see, it cannot act on.
//!
//! There are more points than nodes, so that some velocities have no momentum on any node: with an even number of points in
//! each cell, placed evenly, those that alternate from point to point. FLIP keeps them for ever; they are noise that turns into
//! stress as soon as the points move on. The same pattern of stresses makes no force on any node, and no method here ever removes
//! it.

use super::bar::Bar;
use super::findings::{Findings, Sense};
use super::operator::Response;
use super::{Failure, Method, Study};
use crate::report::{HeatCell, HeatMap};
use crate::study::validate::CaseError;
use nalgebra::{Complex, DVector};

/// The case.
pub const FAILURE: Failure = Failure {
    name: "ringing",
    title: "ringing: alternating velocities and stresses that no node sees stay for ever",
    measure: "share of the energy of an alternating velocity (stress) that is left after 10 steps at Courant number 0.3; fails above 0.01",
    prediction: "tenth power of the solver's step for waves without length",
    run,
};

const COURANT: f64 = 0.3;
const STEPS: usize = 10;

fn run(study: &Study) -> Result<Findings, CaseError> {
    let even: Vec<u32> = study.points_or(&[2, 4]);
    let points: Vec<u32> = even.into_iter().filter(|n| n % 2 == 0).collect();
    let mut jobs = Vec::new();
    for method in &study.methods {
        for n in &points {
            // 0: velocity, 1: stress
            jobs.extend([(*method, *n, 0), (*method, *n, 1)]);
        }
    }
    let left = study.map(&jobs, |(method, points, number)| {
        (
            predicted(*method, *points, *number),
            measured(*method, *points, *number),
        )
    });
    let mut findings = Findings::new("share of energy left", Sense::AtMost, 0.01);
    for ((method, points, number), (predicted, measured)) in jobs.iter().zip(&left) {
        let at = format!("{}, {points} per cell", WHAT[*number]);
        findings.push(method, at, Some(*predicted), *measured);
    }
    let fail = |transfer: &str, number: usize| {
        let of = jobs.iter().zip(&left);
        of.filter(|((m, _, n), (_, left))| m.transfer == transfer && *n == number && *left > 0.01)
            .count()
    };
    findings.shown = format!(
        "Invisible velocities stay in {} runs with FLIP, in {} with PIC and in {} with APIC; invisible stresses in {}, {} and {}: transfers filter velocities, and none of them filters stress.",
        fail("flip", 0),
        fail("pic", 0),
        fail("apic", 0),
        fail("flip", 1),
        fail("pic", 1),
        fail("apic", 1)
    );
    let row = |method: &Method| {
        let of = jobs.iter().zip(&left).filter(|(job, _)| job.0 == *method);
        of.map(|(_, (_, left))| HeatCell {
            text: if *left < 5e-4 {
                "0".into()
            } else {
                format!("{left:.3}")
            },
            fails: *left > 0.01,
            strength: (left / 0.01).max(1e-2).log10().abs() / 2.0,
        })
        .collect()
    };
    let column = |n: &u32| WHAT.map(|what| format!("{what}, {n} points per cell"));
    let map = HeatMap {
            title: "Share of the energy of alternating noise that is left after 10 steps, c Δt/h = 0.3".into(),
            x_label: "what alternates from point to point".into(),
            holds: "gone: below 1 %".into(),
            fails: "stays".into(),
            columns: points.iter().flat_map(column).collect(),
            ..HeatMap::default()
    };
    findings.draw_maps(study, &map, row);
    Ok(findings)
}

const WHAT: [&str; 2] = ["velocity", "stress"];

fn sign(point: usize) -> f64 {
    if point.is_multiple_of(2) { 1.0 } else { -1.0 }
}

fn predicted(method: Method, points: u32, number: usize) -> f64 {
    let bar = Bar::held(method, points, 0.0);
    let response = bar
        .build()
        .and_then(|mut specimen| Response::of(&mut specimen, points as usize, COURANT));
    let Ok(response) = response else {
        return f64::NAN;
    };
    let step = response.wave(0.0);
    let numbers = step.nrows() / points as usize;
    let mut state = DVector::from_element(step.nrows(), Complex::new(0.0, 0.0));
    for point in 0..points as usize {
        state[point * numbers + number] = Complex::new(sign(point), 0.0);
    }
    for _ in 0..STEPS {
        state = &step * state;
    }
    let energy: f64 = (0..points as usize)
        .map(|p| state[p * numbers].norm_sqr() + state[p * numbers + 1].norm_sqr())
        .sum();
    energy / f64::from(points)
}

fn measured(method: Method, points: u32, number: usize) -> f64 {
    let Ok(mut specimen) = Bar::held(method, points, 0.0).build() else {
        return f64::NAN;
    };
    specimen.set(|id| {
        let mut held = [0.0; 3];
        held[number] = 1e-9 * sign(id);
        held
    });
    for _ in 0..STEPS {
        if specimen.step(COURANT).is_err() {
            return f64::INFINITY;
        }
    }
    let (held, middle) = (specimen.get(), specimen.len() / 2);
    // one cell in the middle, which the held ends have not reached
    let first = middle - middle % points as usize;
    let cell = &held[first..first + points as usize];
    let energy: f64 = cell.iter().map(|p| p[0] * p[0] + p[1] * p[1]).sum();
    energy / (f64::from(points) * 1e-18)
}
