//! Dissipation: what a method loses of a standing wave that loses nothing in truth.
//!
//! PIC smooths velocities once a step, so that it loses the more the *shorter* its steps are; APIC keeps linear fields and loses
//! what is left, again once a step. FLIP smooths nothing, but stress update last damps like a Δt.

use super::bar::Bar;
use super::findings::{Findings, Sense};
use super::operator::Response;
use super::{Failure, Method, Study};
use crate::report::{HeatCell, HeatMap};
use crate::study::validate::CaseError;
use crate::transfer::TransferChoice;
use nalgebra::{Complex, DVector};
use std::f64::consts::PI;

/// The case.
pub const FAILURE: Failure = Failure {
    name: "dissipation",
    title: "dissipation: what is left of a standing wave, 16 cells long, after one period",
    measure: "energy after one period / energy at the start; fails below 0.9",
    prediction: "the solver's step of an endless bar, applied to the same wave",
    run,
};

const COURANTS: [f64; 5] = [0.025, 0.05, 0.1, 0.2, 0.4];
const WAVE: f64 = 16.0;
const LIMIT: f64 = 0.9;

fn run(study: &Study) -> Result<Findings, CaseError> {
    let points = study.points_or(&[2])[0];
    let mut jobs = Vec::new();
    for method in &study.methods {
        jobs.extend(COURANTS.map(|courant| (*method, courant)));
    }
    let kept = study.map(&jobs, |(method, courant)| {
        (
            predicted(*method, points, *courant),
            measured(*method, points, *courant),
        )
    });
    let mut findings = Findings::new("energy kept in a period", Sense::AtLeast, LIMIT);
    for ((method, courant), (predicted, measured)) in jobs.iter().zip(&kept) {
        let at = format!("Courant {courant}");
        findings.push(method, at, Some(*predicted), *measured);
    }
    let range = |transfer: &&str| {
        let of = jobs.iter().zip(&kept);
        let of = of.filter(|((m, _), _)| m.transfer == *transfer);
        let ends = |ends: Option<(f64, f64)>, x: f64| {
            let (low, high) = ends.unwrap_or((x, x));
            Some((low.min(x), high.max(x)))
        };
        let (low, high) = of.map(|(_, kept)| kept.1).fold(None, ends)?;
        Some(format!(
            "{transfer} keeps {:.1} to {:.1} %",
            100.0 * low,
            100.0 * high
        ))
    };
    let ranges: Vec<String> = TransferChoice::NAMES.iter().filter_map(range).collect();
    findings.shown = format!(
        "Of the energy, in one period: {}. PIC and APIC lose more with shorter steps, FLIP with stress update last more with longer ones; what exceeds 100 % is the swing of the energy within a period, no growth.",
        ranges.join(", ")
    );
    let row = |method: &Method| {
        let of = jobs.iter().zip(&kept).filter(|(job, _)| job.0 == *method);
        of.map(|(_, (_, kept))| HeatCell {
            text: format!("{:.1} %", 100.0 * kept),
            fails: *kept < LIMIT,
            strength: if *kept < LIMIT {
                1.0 - kept / LIMIT
            } else {
                1.0 - (1.0 - kept).abs() / (1.0 - LIMIT)
            },
        })
        .collect()
    };
    let map = HeatMap {
            title: format!("Energy left of a standing wave after one period: 16 cells a wave, {points} points per cell"),
            x_label: "Courant number c Δt/h".into(),
            holds: "keeps 90 % or more".into(),
            fails: "loses more than a tenth".into(),
            columns: COURANTS.map(|courant| courant.to_string()).into(),
            ..HeatMap::default()
    };
    findings.draw_maps(study, &map, row);
    Ok(findings)
}

fn steps(courant: f64) -> usize {
    (WAVE / courant).round() as usize
}

fn predicted(method: Method, points: u32, courant: f64) -> f64 {
    let (k, spacing) = (2.0 * PI / WAVE, 1.0 / f64::from(points));
    let bar = Bar::held(method, points, 0.0);
    let response = bar
        .build()
        .and_then(|mut specimen| Response::of(&mut specimen, points as usize, courant));
    let Ok(response) = response else {
        return f64::NAN;
    };
    let step = response.wave(k);
    let numbers = step.nrows() / points as usize;
    let mut state = DVector::from_element(step.nrows(), Complex::new(0.0, 0.0));
    for point in 0..points as usize {
        let wave = Complex::from_polar(1.0, k * (point as f64 + 0.5) * spacing);
        state[point * numbers] = wave;
        if numbers > 2 {
            state[point * numbers + 2] = wave * Complex::new(0.0, k);
        }
    }
    for _ in 0..steps(courant) {
        state = &step * state;
    }
    let energy: f64 = (0..points as usize)
        .map(|p| state[p * numbers].norm_sqr() + state[p * numbers + 1].norm_sqr())
        .sum();
    energy / f64::from(points)
}

/// Half a wave between two fixed ends.
fn measured(method: Method, points: u32, courant: f64) -> f64 {
    let length = 0.5 * WAVE;
    let bar = Bar {
        span: [0.0, length],
        cells: length as u32,
        held: vec![[-2.0, 0.0], [length, length + 2.0]],
        ..Bar::held(method, points, 0.0)
    };
    let Ok(mut specimen) = bar.build() else {
        return f64::NAN;
    };
    let k = PI / length;
    let rest = specimen.rest().to_vec();
    specimen.set(|id| {
        let x = k * rest[id];
        [1e-9 * x.sin(), 0.0, 1e-9 * k * x.cos()]
    });
    let start = specimen.energy(0.0);
    for _ in 0..steps(courant) {
        if specimen.step(courant).is_err() {
            return f64::INFINITY;
        }
    }
    specimen.energy(0.0) / start
}
