//! Higher modes of a bar that is held at one end: vₙ = v₀ sin βₙX, βₙ = (2n − 1)π/(2L), swings with ωₙ = βₙ √(E/ρ).
//!
//! **The frequency that FLIP with MUSL gives**, θ = kh, small motion, many small steps. Averaging points to nodes and back
//! multiplies a wave by its transfer function twice, and the strain is the difference of nodes; for points that tile the cells:
//!
//! - linear, p points a cell and axis: with ξ the place of a point in its cell, a = 4⟨ξ(1 − ξ)⟩ = 2/3 + 1/(3p²): 1 for one
//!   point, 3/4 for two. dω/ω = −θ²(1/24 + a/8);
//! - quadratic −θ²/4, cubic −θ²/3 (the variance of the spline, 1/4 and 1/3 of a cell squared, once as mass and once as force).
//!
//! The masses of the cubic basis, lumped where its functions are cut off at the wall, make the bar seem longer by a hundredth
//! of a cell, the same for every mode: of mode 1 with 64 cells, as much again as the dispersion.

use super::compare::{chart, curve};
use super::history::frequency_near;
use super::problem::{SECOND_ORDER, displacement_error};
use super::{Case, CaseError, Layout, Problem, Report, set};
use crate::report::Style;
use std::f64::consts::PI;

/// The case.
pub const CASE: Case = Case {
    name: "vibration",
    claim: "a bar swings in its modes 1, 2 and 3 with the frequency that theory gives each basis",
    reference: "closed form of the linear wave equation; dispersion of each basis (derived in the case file)",
    run,
};

const SCENARIO: &str = include_str!("../../../scenarios/bar1d.toml");
const LENGTH: f64 = 25.0;
const SPEED: f64 = 10.0;
const V0: f64 = 1e-6;

/// Mode 3 for two of its periods.
pub const PROBLEM: Problem = Problem {
    name: "vibration",
    about: "an elastic bar, held at one end, vibrates in its third mode for two periods",
    norm: "displacement, relative L2 norm over points and recorded times",
    reference: "closed form of the linear wave equation",
    cells_are: "along the bar",
    dimensions: &[1],
    layout: |_, cells| Layout {
        text: SCENARIO.into(),
        overrides: overrides(3, f64::from(cells), 2.0 * period(3), 0.1 * period(3)),
    },
    error: |run| {
        displacement_error(run, |x, time| {
            let omega = 2.0 * PI / period(3);
            let swing = V0 / omega * (omega * time).sin();
            [swing * (beta(3) * x[0]).sin(), 0.0, 0.0]
        })
    },
    cells: |_| &[16, 32, 64, 128],
    points: &[1, 2, 3],
    doubt: 0.0,
    expected: SECOND_ORDER,
};

fn beta(mode: u32) -> f64 {
    f64::from(2 * mode - 1) * PI / (2.0 * LENGTH)
}

fn period(mode: u32) -> f64 {
    2.0 * PI / (beta(mode) * SPEED)
}

fn overrides(mode: u32, cells: f64, end: f64, every: f64) -> Vec<String> {
    let waves = 2 * mode - 1;
    vec![
        format!("grid.cell_size={}", LENGTH / cells),
        format!("constants.v0=\"{V0} m/s\""),
        format!("body[0].velocity=[\"v0 * sin({waves} * pi * x / (2 * L))\"]"),
        format!("time.end={end}"),
        format!("output.every={every}"),
    ]
}

/// How much too low the frequency is, over θ².
fn dispersion(basis: &str, per_cell: u32) -> f64 {
    match (basis, per_cell) {
        ("linear", 1) => 1.0 / 24.0 + 1.0 / 8.0,
        ("linear", _) => 1.0 / 24.0 + 0.75 / 8.0,
        ("quadratic", _) => 0.25,
        _ => 1.0 / 3.0,
    }
}

const METHODS: [(&str, u32); 4] = [("linear", 1), ("linear", 2), ("quadratic", 2), ("cubic", 2)];
const CELLS: f64 = 64.0;

fn run(report: &mut Report) -> Result<(), CaseError> {
    let mut series = Vec::new();
    let mut table: Vec<(String, Vec<f64>)> = vec![("mode".into(), vec![1.0, 2.0, 3.0])];
    for (basis, per_cell) in METHODS {
        let mut lags = Vec::new();
        for mode in 1..=3 {
            let texts = [per_cell.to_string(), "0.1".into()];
            let mut all = overrides(mode, CELLS, 10.0 * period(mode), 0.02 * period(mode));
            all.extend(set(&[
                ("method.basis", basis),
                ("body[0].particles_per_cell", &texts[0]),
                ("time.courant", &texts[1]),
            ]));
            let bar = report.run(SCENARIO, &all)?;
            let guess = 1.0 / period(mode);
            let found = frequency_near(
                &bar.column("body_bar", "time"),
                &bar.column("body_bar", "velocity_x"),
                guess,
            );
            let theta = beta(mode) * LENGTH / CELLS;
            // the steps raise the frequency by (ωΔt)²/24
            let steps = (2.0 * PI * guess * bar.summary.dt[1]).powi(2) / 24.0;
            let lag = 1.0 - found / guess;
            let predicted = dispersion(basis, per_cell) * theta * theta - steps;
            // the next term of the dispersion, and where the bar seems to end
            let end = if basis == "cubic" { 0.02 } else { 0.001 };
            report.close(
                format!("{basis}, {per_cell} point(s) a cell, mode {mode}: frequency, too low by"),
                lag,
                predicted,
                0.05 * predicted + end / CELLS,
            );
            lags.push(lag);
        }
        let modes = [1.0, 2.0, 3.0];
        let name = format!("{basis}, {per_cell} point(s) a cell");
        series.push(curve(name.clone(), &modes, &lags, Style::LineMarkers));
        table.push((format!("{basis}_{per_cell}"), lags));
    }
    let columns: Vec<(&str, &[f64])> = table.iter().map(|(n, c)| (&n[..], &c[..])).collect();
    report.table("frequency", &columns);
    let mut errors = chart(
        "Frequency of small vibrations, 64 cells",
        "mode",
        "too low by, relative",
        series,
    );
    errors.y_log = true;
    report.chart("frequency", vec![errors]);
    Ok(())
}
