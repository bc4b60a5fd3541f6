//! The vibrating bar of many points: fixed at x = 0, free at x = L, first mode.
//!
//! Exact for small motion: v = v₀ cos(ωt) sin(βx), β = π/(2L), ω = β √(E/ρ): centre of mass v₀/(βL) cos ωt, energy ρ L v₀²/4.
//!
//! **The frequency that the method gives.** One point at the middle of each cell, linear basis: a node has the mean of its two
//! points' velocities, and the strain rate in a cell is the difference of its nodes' over h. For points moving as sin kX the
//! mean of two neighbours brings the factor cos(θ/2), θ = kh, and the difference of two nodes a cell apart 2 sin(θ/2)/h. The
//! acceleration of a node has the same difference of stresses, (no mean: the node's force over its mass), and its mean
//! over two nodes goes back to the points: another cos(θ/2). Together ω_h = (c/h) 2 sin(θ/2) cos(θ/2) = (c/h) sin θ, and so
//! ω_h/ω − 1 = −θ²/6: second order in h. The step adds (ωΔt)²/24 (`point1d`).
//!
//! **The same bar along every axis.** Transverse directions, one cell wide between rollers and without Poisson's ratio, must
//! change nothing at all.

use super::compare::{chart, curve, largest, map, orders};
use super::problem::{SECOND_ORDER, cell_size, displacement_error};
use super::swing::Swing;
use super::{Case, CaseError, Layout, Problem, Recorded, Report, rms, set};
use crate::report::Style;
use std::f64::consts::PI;

/// The case.
pub const CASE: Case = Case {
    name: "bar1d",
    claim: "a bar of 25 points vibrates in its first mode, the same along every axis of 1D, 2D and 3D",
    reference: "closed form of the linear wave equation; sine-Galerkin solution of the nonlinear one",
    run,
};

/// One period of small motion, along x of 1D, 2D or 3D.
pub const PROBLEM: Problem = Problem {
    name: "bar1d",
    about: "an elastic bar, held at one end, vibrates in its first mode for a period",
    norm: "displacement, relative L2 norm over points and recorded times",
    reference: "closed form of the linear wave equation",
    cells_are: "along the bar",
    dimensions: &[1, 2, 3],
    layout,
    error: |run| {
        displacement_error(run, |x, time| {
            let swing = SMALL_V0 / OMEGA * (OMEGA * time).sin();
            [swing * (PI * x[0] / (2.0 * LENGTH)).sin(), 0.0, 0.0]
        })
    },
    cells: |_| &[8, 16, 32, 64],
    points: &[1, 2, 3],
    doubt: 0.0,
    expected: SECOND_ORDER,
};

/// So slow, m/s, that the nonlinear part of the law is below 1e-7 of the motion.
const SMALL_V0: f64 = 1e-6;

/// The bar along x, one cell wide, for a period.
fn layout(dimension: usize, cells: u32) -> Layout {
    let size = LENGTH / f64::from(cells);
    let maxima: Vec<String> = (0..dimension)
        .map(|a| if a == 0 { LENGTH } else { size }.to_string())
        .collect();
    let max = format!("[{}]", maxima.join(", "));
    let velocity = ["\"v0 * sin(pi * x / (50 m))\"", "0.0", "0.0"][..dimension].join(", ");
    Layout {
        text: along(dimension, 0),
        overrides: vec![
            cell_size(LENGTH, cells),
            format!("grid.max={max}"),
            format!("body[0].shape.box.max={max}"),
            format!("constants.v0=\"{SMALL_V0} m/s\""),
            format!("body[0].velocity=[{velocity}]"),
            "time={ end = 10.0, courant = 0.1 }".into(),
            "output.every=1.0".into(),
        ],
    }
}

const SCENARIO: &str = include_str!("../../../scenarios/bar1d.toml");
const LENGTH: f64 = 25.0;
const V0: f64 = 0.1;
const PERIOD: f64 = 10.0;
const OMEGA: f64 = 2.0 * PI / PERIOD;
/// θ²/6 for 25 cells.
const LATE: f64 = (PI / 50.0) * (PI / 50.0) / 6.0;
/// What the nonlinear law adds to the velocity of the centre of mass over one period, as a share of its amplitude.
const NONLINEAR: f64 = 2.2e-3;

fn run(report: &mut Report) -> Result<(), CaseError> {
    against_closed_form(report)?;
    against_nonlinear_reference(report)?;
    convergence(report)?;
    every_axis(report)
}

/// Root mean square, over `periods`, of the error that a frequency low by the share [`LATE`] makes, over the amplitude:
/// the phase is LATE ωt, and the mean of t² sin² is a sixth of the last t². The nonlinear law comes on top.
fn expected(periods: f64) -> f64 {
    LATE * 2.0 * PI * periods / 6.0_f64.sqrt() + NONLINEAR
}

fn against_closed_form(report: &mut Report) -> Result<(), CaseError> {
    let tip =
        "[{name=\"second\", body=\"bar\", particle=1}, {name=\"tip\", body=\"bar\", particle=24}]";
    let bar = report.run(SCENARIO, &set(&[("probe", tip)]))?;
    let time = bar.column("body_bar", "time");
    let shift = 0.5 * bar.summary.dt[1];
    let velocity = bar.column("body_bar", "velocity_x");
    let amplitude = V0 * 2.0 / PI;
    let exact = map(&time, |t| amplitude * (OMEGA * (t - shift)).cos());
    for periods in [1, 10] {
        let rows = 100 * periods + 1;
        // the phases of the grid and of the law may add: a fifth more than both, of which neither is an estimate
        report.at_most(
            format!("velocity of the centre of mass, {periods} period(s): rms error / amplitude"),
            rms(&velocity[..rows], &exact[..rows]) / amplitude,
            1.2 * expected(periods as f64),
        );
    }
    let mut positions = Vec::new();
    for (name, x) in [("second", 1.5), ("tip", 24.5)] {
        let reach = V0 / OMEGA * (PI * x / (2.0 * LENGTH)).sin();
        let computed = bar.column(&format!("probe_{name}"), "position_x");
        let exact = map(&time, |t| x + reach * (OMEGA * t).sin());
        // near the wall the law's second harmonic, of the order of the strain v0/c = 1 %, weighs most
        report.at_most(
            format!("position of the {name} point, one period: rms error / amplitude"),
            rms(&computed[..101], &exact[..101]) / reach,
            1.2 * expected(1.0) + if name == "second" { 0.01 } else { 0.0 },
        );
        positions.push((computed, exact));
    }
    let energy = bar.column("energy", "total");
    // The ripple of the steps, ωΔt/2 sin 2φ, and the law: with ε = ln F its work is E (ε²/2 + ε³/3), its booked energy
    // V σ²/2E = E (ε²/2 + ε³/2), more by ε³/6. Over the bar ε = (v₀/c) sin φ cos βx: ε/3 of the elastic share sin² φ, times
    // ∫cos³ / ∫cos² = 8/(3π).
    let ripple = OMEGA * shift;
    let law = V0 / 10.0 * 8.0 / (9.0 * PI);
    let largest_expected = (0..=90)
        .map(|degrees| f64::from(degrees).to_radians())
        .map(|phi| ripple * (2.0 * phi).sin() + law * phi.sin().powi(3))
        .fold(0.0, f64::max);
    report.at_most(
        "energy, ten periods: largest distance from density L v0^2 / 4, relative",
        largest(&energy, &vec![0.0625; energy.len()]) / 0.0625,
        1.1 * largest_expected,
    );
    let kinetic = bar.column("energy", "kinetic");
    let exact_kinetic = map(&time, |t| 0.0625 * (OMEGA * (t - shift)).cos().powi(2));
    report.at_most(
        "kinetic energy, one period: rms error / energy",
        rms(&kinetic[..101], &exact_kinetic[..101]) / 0.0625,
        2.4 * expected(1.0),
    );
    report.table(
        "history",
        &[
            ("time", &time),
            ("velocity", &velocity),
            ("velocity_exact", &exact),
            ("second_position", &positions[0].0),
            ("second_position_exact", &positions[0].1),
            ("tip_position", &positions[1].0),
            ("tip_position_exact", &positions[1].1),
            ("kinetic", &kinetic),
            ("kinetic_exact", &exact_kinetic),
            ("total", &energy),
        ],
    );
    let rows = 301;
    let panel = |title: &str, label: &str, computed: &[f64], exact: &[f64]| {
        let thin =
            |column: &[f64]| -> Vec<f64> { column[..rows].iter().copied().step_by(5).collect() };
        chart(
            title,
            "time (s)",
            label,
            vec![
                curve(
                    "computed, 25 points",
                    &thin(&time),
                    &thin(computed),
                    Style::Markers,
                ),
                curve(
                    "exact for small motion",
                    &time[..rows],
                    &exact[..rows],
                    Style::Dashed,
                ),
            ],
        )
    };
    let mut energies = chart(
        "Energy",
        "time (s)",
        "energy (J)",
        vec![
            curve("kinetic", &time[..rows], &kinetic[..rows], Style::Line),
            curve("total", &time[..rows], &energy[..rows], Style::Line),
            curve(
                "exact for small motion",
                &time[..rows],
                &exact_kinetic[..rows],
                Style::Dashed,
            ),
            curve("", &[0.0, 30.0], &[0.0625, 0.0625], Style::Dashed),
        ],
    );
    energies.y_range = Some([0.0, 0.08]);
    report.chart(
        "history",
        vec![
            panel(
                "Velocity of the centre of mass",
                "velocity (m/s)",
                &velocity,
                &exact,
            ),
            panel(
                "Position of the second point",
                "position (m)",
                &positions[0].0,
                &positions[0].1,
            ),
            panel(
                "Position of the last point",
                "position (m)",
                &positions[1].0,
                &positions[1].1,
            ),
            energies,
        ],
    );
    Ok(())
}

/// One period against the nonlinear equations, which the closed form neglects. The linear basis with one point a cell cannot tell:
/// while no point leaves its cell, its nodal forces are V₀τ/h, as if each cell still held its initial share of the bar, and so
/// they are wrong by the share of the strain. Quadratic functions over two points a cell see how the points have moved.
fn against_nonlinear_reference(report: &mut Report) -> Result<(), CaseError> {
    let fine = [
        ("method.basis", "quadratic"),
        ("grid.cell_size", "0.25 m"),
        // the last point would leave a grid that ends with the bar
        ("grid.max", "[26.0]"),
        ("body[0].particles_per_cell", "2"),
        ("time.end", "10 s"),
    ];
    let bar = report.run(SCENARIO, &set(&fine))?;
    let (time, velocity) = (
        bar.column("body_bar", "time"),
        bar.column("body_bar", "velocity_x"),
    );
    let mut swing = Swing::new(LENGTH, 1.0, 100.0, V0);
    let shift = 0.5 * bar.summary.dt[1];
    let mut exact = vec![swing.mean_velocity()];
    for pair in time.windows(2) {
        let start = if exact.len() == 1 {
            0.0
        } else {
            pair[0] - shift
        };
        swing.advance(pair[1] - shift - start, 0.02);
        exact.push(swing.mean_velocity());
    }
    let amplitude = V0 * 2.0 / PI;
    let linear = map(&time, |t| amplitude * (OMEGA * (t - shift)).cos());
    report.close(
        "closed form against the nonlinear reference, one period: rms / amplitude",
        rms(&linear, &exact) / amplitude,
        2.18e-3,
        2e-5,
    );
    // quadratic functions slow the wave by θ²/4 (their weights have the variance h²/4, see `manufactured`): half as much again
    // as LATE, at a quarter of the cell size; and a half more
    report.at_most(
        "quadratic, 100 cells, against the nonlinear reference, one period: rms error / amplitude",
        rms(&velocity, &exact) / amplitude,
        1.5 * 1.5 * LATE / 16.0 * 2.0 * PI / 6.0_f64.sqrt(),
    );
    Ok(())
}

/// The frequency of small motion on three grids.
fn convergence(report: &mut Report) -> Result<(), CaseError> {
    let sizes = [1.0, 0.5, 0.25];
    let mut lags = Vec::new();
    for size in sizes {
        let size_text = format!("{size} m");
        let overrides = set(&[
            ("constants.v0", "1e-4 m/s"),
            ("grid.cell_size", &size_text),
            ("output.every", "0.05 s"),
        ]);
        let bar = report.run(SCENARIO, &overrides)?;
        let lag = 1.0 - frequency(&bar) * PERIOD;
        let theta = PI * size / (2.0 * LENGTH);
        let predicted = theta * theta / 6.0 - (OMEGA * bar.summary.dt[1]).powi(2) / 24.0;
        report.close(
            format!("frequency of small motion, cells of {size} m: how much too low / predicted"),
            lag / predicted,
            1.0,
            // the next term of sin θ/θ is θ²/20 of this one; the rest is how well zero crossings are found
            0.01,
        );
        lags.push(lag);
    }
    for order in orders(&sizes, &lags) {
        report.close("order of convergence of the frequency", order, 2.0, 0.02);
    }
    let first_order = map(&sizes, |h| (PI * h / (2.0 * LENGTH)).powi(2) / 6.0);
    report.table(
        "frequency",
        &[
            ("cell_size", &sizes),
            ("too_low", &lags),
            ("predicted", &first_order),
        ],
    );
    let mut errors = chart(
        "Error of the frequency of small motion",
        "cell size (m)",
        "relative error",
        vec![
            curve("computed", &sizes, &lags, Style::Markers),
            curve(
                "predicted: (k h)^2 / 6",
                &sizes,
                &first_order,
                Style::Dashed,
            ),
        ],
    );
    (errors.x_log, errors.y_log) = (true, true);
    report.chart("frequency", vec![errors]);
    Ok(())
}

/// From the last passage of the centre of mass through its rest position: the 20th, after ten periods.
fn frequency(bar: &Recorded) -> f64 {
    let (time, position) = (
        bar.column("body_bar", "time"),
        bar.column("body_bar", "position_x"),
    );
    let shift = map(&position, |x| x - 0.5 * LENGTH);
    let passages: Vec<f64> = (1..time.len() - 1)
        .filter(|&i| shift[i] * shift[i + 1] < 0.0)
        .map(|i| time[i] + (time[i + 1] - time[i]) * shift[i] / (shift[i] - shift[i + 1]))
        .collect();
    passages
        .last()
        .map_or(f64::NAN, |last| 0.5 * passages.len() as f64 / last)
}

/// Two periods along each axis of each dimension, against 1D.
fn every_axis(report: &mut Report) -> Result<(), CaseError> {
    let line = report.run(&along(1, 0), &[])?;
    let expected = History::of(&line, 0);
    for dimension in [2, 3] {
        let (mut worst, mut across, mut steps) = (0.0_f64, 0.0_f64, 0);
        for axis in 0..dimension {
            let bar = report.run(&along(dimension, axis), &[])?;
            let found = History::of(&bar, axis);
            worst = worst.max(found.distance(&expected));
            steps = steps.max(bar.summary.steps.abs_diff(line.summary.steps));
            for other in (0..dimension).filter(|other| *other != axis) {
                let velocity = bar.column("body_bar", &format!("velocity_{}", AXES[other]));
                across = across.max(largest(&velocity, &vec![0.0; velocity.len()]) / V0);
            }
        }
        // sums of 25 points in another order, over 2000 steps
        report.at_most(
            format!(
                "{dimension}D along every axis, two periods: largest difference from 1D, relative"
            ),
            worst,
            1e-12,
        );
        report.at_most(
            format!("{dimension}D along every axis: largest velocity across the bar / v0"),
            across,
            1e-12,
        );
        report.at_most(
            format!("{dimension}D along every axis: difference in steps"),
            steps as f64,
            0.0,
        );
    }
    Ok(())
}

const AXES: [&str; 3] = ["x", "y", "z"];

/// What is compared between dimensions.
struct History {
    velocity: Vec<f64>,
    position: Vec<f64>,
    elastic: Vec<f64>,
}

impl History {
    fn of(bar: &Recorded, axis: usize) -> Self {
        let axis = AXES[axis];
        Self {
            velocity: bar.column("body_bar", &format!("velocity_{axis}")),
            position: bar.column("probe_second", &format!("position_{axis}")),
            elastic: bar.column("energy", "elastic"),
        }
    }

    fn distance(&self, other: &Self) -> f64 {
        let velocity = largest(&self.velocity, &other.velocity) / V0;
        let position = largest(&self.position, &other.position);
        velocity
            .max(position)
            .max(largest(&self.elastic, &other.elastic) / 0.0625)
    }
}

/// The scenario of the bar along one axis, one cell of 1 m² across. The step is fixed: what bounds the speed of waves in 2D and
/// 3D is an estimate over all directions, and a little above that of 1D.
fn along(dimension: usize, axis: usize) -> String {
    let list = |along: &str, across: &str| {
        let entries = (0..dimension).map(|a| if a == axis { along } else { across });
        format!("[{}]", entries.collect::<Vec<_>>().join(", "))
    };
    let zeros = list("0.0", "0.0");
    let (max, name) = (list("\"25 m\"", "\"1 m\""), AXES[axis]);
    let velocity = list(&format!("\"0.1 m/s * sin(pi * {name} / 50 m)\""), "0.0");
    let rollers = (0..dimension).filter(|a| *a != axis).flat_map(|a| {
        ["min", "max"].map(|side| {
            let side = format!("{}_{side}", AXES[a]);
            format!(
                "[[boundary]]\nname = \"{side}\"\non.side = \"{side}\"\ncondition = \"roller\"\n"
            )
        })
    });
    format!(
        r#"dimension = {dimension}
time = {{ end = "20 s", step = "0.01 s" }}
grid = {{ min = {zeros}, max = {max}, cell_size = "1 m" }}
method = {{ basis = "linear", transfer = "flip", update = "musl" }}
material.bar = {{ density = 1.0, linear_elastic = {{ youngs_modulus = 100.0, poissons_ratio = 0.0 }} }}
output.every = "0.1 s"
[[body]]
name = "bar"
material = "bar"
shape.box = {{ min = {zeros}, max = {max} }}
particles_per_cell = 1
velocity = {velocity}
[[boundary]]
name = "wall"
on.side = "{name}_min"
condition = "roller"
[[probe]]
name = "second"
body = "bar"
particle = 1
{}"#,
        rollers.collect::<String>()
    )
}
