//! A bar that is suddenly pulled at its free end: a front, its reflection from the wall with twice the stress, and back.
//!
//! d'Alembert: with v₁ = σ₀/(ρc), a slice X is reached by the front at t₁ = (L − X)/c (velocity v₁, stress σ₀), by its reflection from
//! the wall at t₂ = (L + X)/c (velocity 0, stress 2σ₀), by the next from the free end at t₃ = (3L − X)/c (−v₁, σ₀), from the wall at
//! t₄ = (3L + X)/c (0, 0), and so on with the period 4L/c. The free end moves between 0 and 2σ₀L/E.
//!
//! A grid cannot carry a jump: its shortest waves are slow, and after a way d the front is about (d h²)^⅓ wide. The limits of
//! histories are what fronts of that width make: at d = 8L, 0.09 L, or 2 % of the period for each of two passages.

use super::compare::{chart, curve, largest, map};
use super::problem::{bar_grid, displacement_error};
use super::{Case, CaseError, Expected, Layout, Problem, Recorded, Report, rms};
use crate::report::Style;

/// The case.
pub const CASE: Case = Case {
    name: "wave",
    claim: "a pull runs through a bar with the wave speed, doubles at the wall, and moves the tip to twice the static reach",
    reference: "d'Alembert's solution of the wave equation",
    run,
};

const FRONT: &str = "expected: a front smeared over (d h^2)^(1/3) leaves a corner of the displacement off by as much over as much, 2/3 (1 + 1/2)";

/// One period after the pull.
pub const PROBLEM: Problem = Problem {
    name: "wave",
    about: "a bar that is suddenly pulled at its free end: a front runs up and down for a period",
    norm: "displacement, relative L2 norm over points and recorded times",
    reference: CASE.reference,
    cells_are: "along the bar",
    dimensions: &[1],
    layout: |_, cells| {
        let mut overrides = bar_grid(LENGTH, cells, 2.0);
        overrides.extend(["time.end=0.4".into(), "output.every=0.02".into()]);
        Layout { text: SCENARIO.into(), overrides }
    },
    error: |run| displacement_error(run, |x, time| [displacement(x[0], time), 0.0, 0.0]),
    cells: |_| &[16, 32, 64, 128],
    points: &[1, 2, 3],
    doubt: 0.0,
    expected: &[
        Expected { basis: "linear", order: 1.0, source: FRONT },
        Expected { basis: "gimp", order: 1.0, source: FRONT },
        Expected { basis: "quadratic", order: 1.0, source: FRONT },
        Expected { basis: "cubic", order: 1.0, source: FRONT },
    ],
};

const SCENARIO: &str = include_str!("../../../scenarios/wave.toml");
const LENGTH: f64 = 1.0;
const SPEED: f64 = 10.0;
const STRESS: f64 = 100.0;
const VELOCITY: f64 = 0.01;
const PERIOD: f64 = 4.0 * LENGTH / SPEED;
/// 2σ₀L/E.
const REACH: f64 = 2e-3;

fn run(report: &mut Report) -> Result<(), CaseError> {
    let bar = report.run_with_frames(SCENARIO, &[])?;
    let time = bar.column("probe_tip", "time");
    let (tip, foot) = (start(&bar, "tip"), start(&bar, "foot"));
    let moved = map(&bar.column("probe_tip", "position_x"), |x| x - tip);
    let exact = map(&time, |t| displacement(tip, t));
    // corners are rounded over 2 % of the period, where the error is up to 2 % of the reach; a wave speed wrong by 1 % is 0.6 % in the
    // first period and 1.6 % in the second
    report.at_most(
        "displacement of the tip, two periods: rms error / reach",
        rms(&moved, &exact) / REACH,
        0.01,
    );
    report.close(
        "largest displacement of the tip / (2 s0 L / E)",
        moved.iter().fold(0.0, |most: f64, u| most.max(*u)) / REACH,
        1.0,
        0.02,
    );
    let after = time.iter().position(|t| *t >= PERIOD - 1e-9).unwrap_or(0);
    report.at_most(
        "displacement of the tip after one period / reach",
        (moved[after] / REACH).abs(),
        0.03,
    );

    let stress = bar.column("probe_foot", "stress_xx");
    let exact_stress = map(&time, |t| STRESS * level(foot, t));
    // two of four fronts a period, each with an error of σ₀ or 2σ₀ over 2 % of the period at most: sqrt(0.08) of 2σ₀ would be wrong
    // everywhere in them, and half of that is met
    report.at_most(
        "stress near the wall, two periods: rms error / (2 s0)",
        rms(&stress, &exact_stress) / (2.0 * STRESS),
        0.15,
    );
    let plateau: Vec<f64> = time
        .iter()
        .zip(&stress)
        .filter(|(t, _)| (0.14..0.26).contains(*t))
        .map(|(_, s)| *s)
        .collect();
    // what is left of the ringing behind the front, averaged
    report.close(
        "stress near the wall while doubled / s0",
        plateau.iter().sum::<f64>() / plateau.len() as f64 / STRESS,
        2.0,
        0.01,
    );

    let frame = bar
        .memory
        .frames
        .iter()
        .find(|frame| frame.time >= 0.05 - 1e-9);
    let points = frame.map(|frame| &frame.points[..]).unwrap_or_default();
    let (x, velocity): (Vec<f64>, Vec<f64>) = points
        .iter()
        .map(|p| (p.position[0], p.velocity[0]))
        .unzip();
    let passage = (1..x.len())
        .find(|&i| velocity[i] >= 0.5 * VELOCITY)
        .map_or(f64::NAN, |i| {
            x[i - 1]
                + (x[i] - x[i - 1]) * (0.5 * VELOCITY - velocity[i - 1])
                    / (velocity[i] - velocity[i - 1])
        });
    // half a front's width, (0.5 · 1e-4)^⅓/2, is 0.018; a cell is 0.01
    report.close(
        "place of the front (half the velocity) at t = L / (2 c), m",
        passage,
        0.5,
        0.015,
    );
    let behind: Vec<f64> = x
        .iter()
        .zip(&velocity)
        .filter(|(x, _)| (0.65..0.95).contains(*x))
        .map(|(_, v)| *v)
        .collect();
    report.close(
        "velocity behind the front / (s0 / (density c))",
        behind.iter().sum::<f64>() / behind.len() as f64 / VELOCITY,
        1.0,
        0.01,
    );

    // what the pull has done is in the bar; APIC takes a little of the ringing
    let [kinetic, elastic] = ["kinetic", "elastic"].map(|column| bar.column("energy", column));
    let stored: Vec<f64> = kinetic.iter().zip(&elastic).map(|(k, e)| k + e).collect();
    let done = map(&moved, |u| STRESS * u);
    report.at_most("energy of the bar against s0 times the tip's displacement, largest difference / (s0 reach)", largest(&stored, &done) / (STRESS * REACH), 0.02);

    report.table(
        "history",
        &[
            ("time", &time),
            ("tip", &moved),
            ("tip_exact", &exact),
            ("foot_stress", &stress),
            ("foot_stress_exact", &exact_stress),
        ],
    );
    draw(
        report,
        [&time, &moved, &stress],
        [&x, &velocity],
        [tip, foot],
    );
    Ok(())
}

fn start(bar: &Recorded, probe: &str) -> f64 {
    bar.column(&format!("probe_{probe}"), "position_x")[0]
}

/// The times, within a period, at which fronts pass.
fn passages(x: f64) -> [f64; 4] {
    [LENGTH - x, LENGTH + x, 3.0 * LENGTH - x, 3.0 * LENGTH + x].map(|way| way / SPEED)
}

/// Stress over σ₀.
fn level(x: f64, time: f64) -> f64 {
    let time = time.rem_euclid(PERIOD);
    [1.0, 1.0, -1.0, -1.0]
        .iter()
        .zip(passages(x))
        .filter(|(_, passage)| time >= *passage)
        .map(|(step, _)| step)
        .sum()
}

/// u(X, t), the integral of the velocity.
fn displacement(x: f64, time: f64) -> f64 {
    let time = time.rem_euclid(PERIOD);
    let steps = [1.0, -1.0, -1.0, 1.0].iter().zip(passages(x));
    VELOCITY
        * steps
            .map(|(step, passage)| step * (time - passage).max(0.0))
            .sum::<f64>()
}

fn draw(
    report: &mut Report,
    [time, moved, stress]: [&[f64]; 3],
    [x, velocity]: [&[f64]; 2],
    [tip, foot]: [f64; 2],
) {
    let dense: Vec<f64> = (0..=1600).map(|i| 0.8 * f64::from(i) / 1600.0).collect();
    let millimetres = |u: &[f64]| map(u, |u| 1e3 * u);
    let thin = |column: &[f64]| -> Vec<f64> { column.iter().copied().step_by(2).collect() };
    let panels = vec![
        chart(
            "Displacement of the tip",
            "time (s)",
            "displacement (mm)",
            vec![
                curve(
                    "computed",
                    &thin(time),
                    &thin(&millimetres(moved)),
                    Style::Markers,
                ),
                curve(
                    "exact",
                    &dense,
                    &millimetres(&map(&dense, |t| displacement(tip, t))),
                    Style::Dashed,
                ),
            ],
        ),
        chart(
            "Stress near the wall",
            "time (s)",
            "stress (Pa)",
            vec![
                curve("computed", time, stress, Style::LineMarkers),
                curve(
                    "exact",
                    &dense,
                    &map(&dense, |t| STRESS * level(foot, t)),
                    Style::Dashed,
                ),
            ],
        ),
        chart(
            "Velocity along the bar at t = L / (2 c)",
            "x (m)",
            "velocity (mm/s)",
            vec![
                curve("computed", x, &millimetres(velocity), Style::LineMarkers),
                curve(
                    "exact",
                    &[0.0, 0.5, 0.5, 1.0],
                    &[0.0, 0.0, 10.0, 10.0],
                    Style::Dashed,
                ),
            ],
        ),
    ];
    report.chart("history", panels);
}
