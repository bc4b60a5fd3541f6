//! The finite-grid instability: a bar without stress that moves through the grid heats up, although nothing acts on it.
//!
//! Seen from the bar the grid passes by, and the step of small motion changes with the position of the points in their cells. After
//! one cell it repeats. Predicted (Floquet): the matrices of all steps over one cell, multiplied, have a spectral radius R; small
//! motion grows as R^(1/T) over the time T of a cell. Measured: noise on a long drifting bar whose ends are held in the moving
//! frame, so that its nodes of little mass (the case `small_mass`) play no part.

use super::bar::{Bar, noise};
use super::findings::{Findings, Sense};
use super::operator::{Response, radius, waves};
use super::{Failure, Method, Study};
use crate::report::{HeatCell, HeatMap};
use crate::study::validate::CaseError;
use nalgebra::{Complex, DMatrix};

/// The case.
pub const FAILURE: Failure = Failure {
    name: "drift",
    title: "finite-grid instability: a stress-free bar that drifts through the grid heats up",
    measure: "growth rate of noise in units of c/h, from the energy in the moving frame, over the best third of 500 h/c, Courant number 0.5; fails above 5e-3: e-fold in 200 h/c",
    prediction: "Floquet: spectral radius of the product of the solver's steps while the bar passes one cell",
    run,
};

const SPEEDS: [f64; 5] = [0.02, 0.05, 0.1, 0.2, 0.4];
const COURANT: f64 = 0.5;
const LIMIT: f64 = 5e-3;
const DURATION: f64 = 500.0;
/// Cells between the held ends. What grows also travels: in a short bar it reaches an end before it has grown.
const FREE: f64 = 300.0;

fn run(study: &Study) -> Result<Findings, CaseError> {
    let points = study.points_or(&[2])[0];
    let mut jobs = Vec::new();
    for method in &study.methods {
        jobs.extend(SPEEDS.map(|speed| (*method, speed)));
    }
    let rates = study.map(&jobs, |(method, speed)| {
        (
            predicted(*method, points, *speed),
            measured(*method, points, *speed),
        )
    });
    let mut findings = Findings::new("growth rate (c/h)", Sense::AtMost, LIMIT);
    for ((method, speed), (predicted, measured)) in jobs.iter().zip(&rates) {
        let at = format!("drift {speed} c");
        findings.push(method, at, Some(*predicted), *measured);
        // what decays is as safe as what stays
        if let Some(row) = findings.rows.last_mut().filter(|_| *measured <= 0.0) {
            (row.survives, row.margin) = (true, f64::INFINITY);
        }
    }
    let mut most: Vec<(String, f64)> = Vec::new();
    let updated = jobs.iter().zip(&rates);
    for ((method, _), (rate, _)) in updated.filter(|(job, _)| !job.0.is_total()) {
        let name = format!("{} {}", method.basis, method.transfer);
        match most.last_mut().filter(|last| last.0 == name) {
            Some(last) => last.1 = last.1.max(*rate),
            None => most.push((name, *rate)),
        }
    }
    let most: Vec<String> = most
        .iter()
        .map(|(name, rate)| format!("{name} {rate:.1e}"))
        .collect();
    let most = match most.is_empty() {
        true => String::new(),
        false => format!(
            "Largest predicted growth at {points} points per cell in the updated frame, any update, in c/h: {}. ",
            most.join(", ")
        ),
    };
    let total = findings.rows.iter().filter(|row| !row.survives);
    let total = total.filter(|row| row.method.ends_with("total frame")).count();
    findings.shown = format!(
        "{most}{} of {} combinations fail, {total} of them in the total frame. Rates below some 3e-3 need longer than the run to rise above the noise that neither grows nor decays.",
        findings.failing(),
        findings.rows.len(),
    );
    let row = |method: &Method| {
        let of = jobs.iter().zip(&rates).filter(|(job, _)| job.0 == *method);
        of.map(|(_, (_, measured))| HeatCell {
            text: if *measured < 5e-5 {
                "0".into()
            } else {
                format!("{measured:.4}")
            },
            fails: *measured > LIMIT,
            strength: (measured / LIMIT).max(1e-3).log10().abs() / 1.5,
        })
        .collect()
    };
    let map = HeatMap {
            title: format!("Growth of noise on a stress-free bar that drifts through the grid, {points} points per cell, c Δt/h = 0.5"),
            x_label: "drift velocity / wave speed c".into(),
            holds: "no growth, or an e-fold takes longer than 200 h/c".into(),
            fails: "heats up (growth rate in c/h is written in each cell)".into(),
            columns: SPEEDS.map(|speed| speed.to_string()).into(),
            ..HeatMap::default()
    };
    findings.draw_maps(study, &map, row);
    Ok(findings)
}

/// Where the first cell of points begins in its cell of the grid: with few steps a cell that matters, so that both bars start
/// alike. Never exactly at a node.
fn start(speed: f64) -> f64 {
    0.37 * speed * COURANT
}

/// The growth rate of an endless bar, c/h; 0 if nothing grows.
fn predicted(method: Method, points: u32, speed: f64) -> f64 {
    // in the total frame the points keep their places in the grid, and one step is as good as any other
    let steps = match method.is_total() {
        true => 1,
        false => (1.0 / (speed * COURANT)).round() as usize,
    };
    let dt = match method.is_total() {
        true => COURANT,
        false => 1.0 / (speed * steps as f64),
    };
    let numbers: Vec<f64> = waves().collect();
    let mut products: Vec<Option<DMatrix<Complex<f64>>>> = vec![None; numbers.len()];
    for step in 0..steps {
        let offset = start(speed) + step as f64 / steps as f64;
        let bar = Bar::held(method, points, offset);
        let response = bar
            .build()
            .and_then(|mut specimen| Response::of(&mut specimen, points as usize, dt));
        let Ok(response) = response else {
            return f64::NAN;
        };
        for (product, k) in products.iter_mut().zip(&numbers) {
            let wave = response.wave(*k);
            *product = Some(match product.take() {
                Some(before) => wave * before,
                None => wave,
            });
        }
    }
    let largest = products.iter().flatten().map(radius).fold(1.0, f64::max);
    let rate = largest.ln() / (steps as f64 * dt);
    // many round-offs of eigenvalues that are exactly one
    if rate < 1e-5 { 0.0 } else { rate }
}

/// The growth rate of noise on a long bar, c/h; negative if it decays.
fn measured(method: Method, points: u32, speed: f64) -> f64 {
    let way = (speed * DURATION).ceil();
    let start = 3.0 + start(speed);
    let end = start + way + 12.0 + FREE;
    let bar = Bar {
        span: [start, end],
        cells: (end + way + 6.0).ceil() as u32,
        held: vec![[-2.0, start + way + 6.0], [end - 6.0, end + way + 9.0]],
        drift: speed,
        ..Bar::held(method, points, 0.0)
    };
    let Ok(mut specimen) = bar.build() else {
        return f64::NAN;
    };
    specimen.set(|id| [speed + 1e-9 * noise(id), 0.0, 0.0]);
    let steps = (DURATION / COURANT) as usize;
    let first = specimen.energy(speed);
    let mut history = vec![0.0];
    for _ in 0..steps {
        if specimen.step(COURANT).is_err() {
            break;
        }
        let grown = (specimen.energy(speed) / first).ln();
        history.push(grown);
        // beyond this it is no longer small
        if grown.is_nan() || grown > 25.0 {
            break;
        }
    }
    let last = history.len() - 1;
    let window = last / 3;
    // what has decayed to round-off neither grows nor decays
    let seen = |from: &usize| history[*from] > -60.0;
    let slope = |from: usize| (history[from + window] - history[from]) / window.max(1) as f64;
    let steepest = (last / 6..=last - window).filter(seen).map(slope);
    let steepest = steepest.fold(f64::NEG_INFINITY, f64::max);
    // energy grows at twice the rate of velocities
    0.5 * steepest.max(-2.0) / COURANT
}
