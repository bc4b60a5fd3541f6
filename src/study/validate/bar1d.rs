//! The vibrating bar of many points: fixed at x = 0, free at x = L, first mode.
//!
//! Exact for small motion: v = v₀ cos(ωt) sin(βx), β = π/(2L), ω = β √(E/ρ): centre of mass v₀/(βL) cos ωt, energy ρ L v₀²/4.

use super::{Case, CaseError, Report, rms, set};
use crate::report::{LineChart, Series, Style};
use std::f64::consts::PI;

/// The case.
pub const CASE: Case = Case {
    name: "bar1d",
    claim: "a bar of 25 points vibrates in its first mode, the same along every axis of 1D, 2D and 3D",
    reference: "closed form of the linear wave equation",
    run,
};

const SCENARIO: &str = include_str!("../../../scenarios/bar1d.toml");

fn run(report: &mut Report) -> Result<(), CaseError> {
    let bar = report.run(SCENARIO, &set(&[("time.end", "10 s")]))?;
    let (time, velocity) = (
        bar.column("body_bar", "time"),
        bar.column("body_bar", "velocity_x"),
    );
    let amplitude = 0.1 * 2.0 / PI;
    let exact: Vec<f64> = time
        .iter()
        .map(|t| amplitude * (2.0 * PI * t / 10.0).cos())
        .collect();
    report.at_most(
        "velocity of the centre of mass: rms error / amplitude",
        rms(&velocity, &exact) / amplitude,
        0.01,
    );
    report.table(
        "velocity",
        &[("time", &time), ("computed", &velocity), ("exact", &exact)],
    );
    let points = |y: &[f64]| time.iter().copied().zip(y.iter().copied()).collect();
    report.chart(
        "velocity",
        vec![LineChart {
            title: "Velocity of the centre of mass".into(),
            x_label: "time (s)".into(),
            y_label: "velocity (m/s)".into(),
            series: vec![
                Series::new("computed", points(&velocity), Style::LineMarkers),
                Series::new("exact", points(&exact), Style::Dashed),
            ],
            ..LineChart::default()
        }],
    );
    Ok(())
}
