//! A bar hits a rigid wall that can push and not pull.
//!
//! Until the front has run to the free end and back, 2L/c, the wall pushes with ρcv₀ and everything behind the front is at rest
//! under −ρcv₀; then the bar flies off with v₀, undeformed.
//!
//! What the grid adds: a jump cannot be carried, and after a way d the front is about (d h²)^⅓ wide (`wave.rs`). The bar leaves with
//! the ringing of that width in it, and what that holds of the energy is missing in the speed: a loss that falls as h^⅔,
//! measured on three grids.

use super::compare::{chart, curve, largest, map, orders};
use super::problem::{bar_grid, displacement_error};
use super::{Case, CaseError, Layout, Problem, Recorded, Report, rms, set};
use crate::report::Style;

/// The case.
pub const CASE: Case = Case {
    name: "impact",
    claim: "a bar that hits a wall is stopped by a wave, touches for 2 L / c, and leaves with the speed it came with",
    reference: "one-dimensional wave theory of impact",
    run,
};

/// The bar from its first touch until it has flown off.
pub const PROBLEM: Problem = Problem {
    name: "impact",
    about: "a bar hits a rigid wall, is stopped by a wave and flies off when that has come back",
    norm: "momentum of the bar, root mean square over recorded times, relative to that before",
    reference: CASE.reference,
    cells_are: "along the bar",
    dimensions: &[1],
    layout: |_, cells| Layout {
        text: SCENARIO.into(),
        overrides: bar_grid(LENGTH, cells, 2.0),
    },
    error: |run| {
        let time = run.column("body_bar", "time");
        let momentum = run.column("body_bar", "momentum_x");
        // under ρcv₀ a bar of mass m slows down by v₀ in the time L/c = CONTACT/2
        let exact = map(&time, |t| 1.0 - 2.0 * (t / CONTACT).min(1.0));
        rms(&map(&momentum, |p| p / momentum[0]), &exact)
    },
    cells: |_| &[25, 50, 100, 200],
    points: &[1, 2, 3],
    doubt: 0.0,
    expected: &[],
};

/// The same bar of rubber so fast that the shock squeezes it to [`SQUEEZED`] of its length, until that has run through.
///
/// Rankine and Hugoniot: behind a shock that runs through the material with U the bar is at rest, v₀ = U (1 − F) and ρ₀ U v₀ = −P(F). With
/// P = (E/2)(F − 1/F) of the neo-Hookean law at ν = 0 and c² = E/ρ₀ they give U² = c² (1 + F)/(2F).
pub const FAST: Problem = Problem {
    name: "impact_large",
    about: "a rubber bar hits a rigid wall with a fifth of its wave speed, and a shock squeezes it by a fifth",
    norm: "displacement, relative L2 norm over points and recorded times",
    reference: "closed form: jump conditions of Rankine and Hugoniot",
    layout: |_, cells| {
        let mut layout = (PROBLEM.layout)(1, cells);
        let end = LENGTH / shock();
        layout.overrides.extend([
            "material.bar={ density = 1000.0, neo_hookean = { youngs_modulus = 1e5, poissons_ratio = 0.0 } }".into(),
            format!("constants.v0={}", shock() * (1.0 - SQUEEZED)),
            format!("time.end={end}"),
            format!("output.every={}", end / 20.0),
        ]);
        layout
    },
    error: |run| {
        displacement_error(run, |x, time| {
            let moving = time.min(x[0] / shock());
            [-shock() * (1.0 - SQUEEZED) * moving, 0.0, 0.0]
        })
    },
    ..PROBLEM
};

/// F behind the shock of [`FAST`].
const SQUEEZED: f64 = 0.8;

/// Speed of the shock of [`FAST`] in the reference configuration, m/s.
fn shock() -> f64 {
    WAVE * ((1.0 + SQUEEZED) / (2.0 * SQUEEZED)).sqrt()
}

const SCENARIO: &str = include_str!("../../../scenarios/impact.toml");
const LENGTH: f64 = 1.0;
/// c, m/s.
const WAVE: f64 = 10.0;
const V0: f64 = 0.01;
/// ρcv₀.
const PUSH: f64 = 100.0;
/// 2L/c.
const CONTACT: f64 = 2.0 * LENGTH / WAVE;
const SIZES: [f64; 3] = [0.02, 0.01, 0.005];

fn run(report: &mut Report) -> Result<(), CaseError> {
    let mut losses = Vec::new();
    for size in SIZES {
        let size_text = format!("{size} m");
        let bar = report.run(SCENARIO, &set(&[("grid.cell_size", &size_text)]))?;
        let velocity = bar.column("body_bar", "velocity_x");
        losses.push(1.0 - velocity[velocity.len() - 1] / V0);
        if size == 0.01 {
            judge(report, &bar);
        }
    }
    // (2L h²)^⅓/(2L) is 0.03 of the length that the front has run over
    report.at_most(
        "speed lost in the rebound / v0, cells of 0.01 m",
        losses[1],
        0.03,
    );
    for order in orders(&SIZES, &losses) {
        report.close(
            "order of convergence of the speed of rebound (2/3)",
            order,
            2.0 / 3.0,
            0.15,
        );
    }
    report.table("rebound", &[("cell_size", &SIZES), ("speed_lost", &losses)]);
    shocked(report)
}

/// [`FAST`] with the method of the scenario.
fn shocked(report: &mut Report) -> Result<(), CaseError> {
    let mut errors = Vec::new();
    for size in SIZES {
        let layout = (FAST.layout)(1, (LENGTH / size).round() as u32);
        let run = report.run_with_frames(&layout.text, &layout.overrides)?;
        errors.push((FAST.error)(&run));
    }
    // displacements are (1 - F) L at most and 0.41 of that in the root mean square; a shock that starts a third of a cell late is off by
    // a third of (1 - F) cells wherever it has been, over half of all points and times: together 0.58 cells / L
    report.at_most(
        "shock, squeezed to 0.8, 100 cells: displacement, relative L2 error",
        errors[1],
        6e-3,
    );
    for order in orders(&SIZES, &errors) {
        report.at_most(
            "shock: what the order of convergence lacks of 1",
            1.0 - order,
            0.25,
        );
    }
    report.table("shock", &[("cell_size", &SIZES), ("error", &errors)]);
    Ok(())
}

fn judge(report: &mut Report, bar: &Recorded) {
    let wall = |column: &str| bar.column("boundary_wall", column);
    let (time, reaction, impulse) = (wall("time"), wall("reaction_x"), wall("impulse_x"));
    let between = |column: &[f64], from: f64, to: f64| {
        let inside: Vec<f64> = time
            .iter()
            .zip(column)
            .filter(|(t, _)| (from..to).contains(*t))
            .map(|(_, value)| *value)
            .collect();
        inside.iter().sum::<f64>() / inside.len() as f64
    };
    // the nonlinear law at a strain of 0.1 % and what is left of the ringing
    report.close(
        "push of the wall while in contact / (density c v0)",
        between(&reaction, 0.02, 0.17) / PUSH,
        1.0,
        0.005,
    );
    let last = time
        .iter()
        .zip(&reaction)
        .filter(|(_, push)| **push > 0.5 * PUSH)
        .map(|(t, _)| *t)
        .fold(0.0, f64::max);
    // the front is (2L h²)^⅓ = 0.06 m wide when it comes back, and 0.03 m take 3 ms; rows are 2 ms apart
    report.close("duration of contact / (2 L / c)", last / CONTACT, 1.0, 0.03);
    let pull = reaction.iter().fold(0.0, |most: f64, push| most.max(-push));
    report.at_most(
        "largest pull of the wall / (density c v0): it cannot",
        pull / PUSH,
        0.0,
    );
    let middle = |column: &str| bar.column("probe_middle", column);
    let (stress, velocity) = (middle("stress_xx"), middle("velocity_x"));
    report.close(
        "stress in the middle between the fronts / (density c v0)",
        between(&stress, 0.075, 0.125) / PUSH,
        -1.0,
        0.01,
    );
    report.at_most(
        "velocity in the middle between the fronts / v0",
        between(&velocity, 0.075, 0.125).abs() / V0,
        0.01,
    );
    let momentum = bar.column("body_bar", "momentum_x");
    let gained: Vec<f64> = momentum.iter().map(|now| now - momentum[0]).collect();
    // sums of 200 points over a thousand steps
    report.at_most(
        "momentum gained against the wall's impulse: largest difference / (m v0)",
        largest(&gained, &impulse) / 10.0,
        1e-12,
    );
    draw(report, &time, [&reaction, &stress, &velocity]);
}

fn draw(report: &mut Report, time: &[f64], [reaction, stress, velocity]: [&[f64]; 3]) {
    let millimetres: Vec<f64> = velocity.iter().map(|v| 1e3 * v).collect();
    report.table(
        "history",
        &[
            ("time", time),
            ("reaction", reaction),
            ("middle_stress", stress),
            ("middle_velocity", velocity),
        ],
    );
    let panel = |title: &str, label: &str, computed: &[f64], exact: &[(f64, f64)]| {
        let (t, y): (Vec<f64>, Vec<f64>) = exact.iter().copied().unzip();
        chart(
            title,
            "time (s)",
            label,
            vec![
                curve("computed", time, computed, Style::LineMarkers),
                curve("exact", &t, &y, Style::Dashed),
            ],
        )
    };
    let steps = |levels: [f64; 4]| {
        let [a, b, c, d] = levels;
        // fronts pass the middle going up and coming back, and with the bar's own vibration gone nothing follows
        [
            (0.0, a),
            (0.05, a),
            (0.05, b),
            (0.15, b),
            (0.15, c),
            (0.3, d),
        ]
    };
    report.chart(
        "history",
        vec![
            panel(
                "Push of the wall",
                "force (N)",
                reaction,
                &[(0.0, PUSH), (CONTACT, PUSH), (CONTACT, 0.0), (0.3, 0.0)],
            ),
            panel(
                "Stress in the middle of the bar",
                "stress (Pa)",
                stress,
                &steps([0.0, -PUSH, 0.0, 0.0]),
            ),
            panel(
                "Velocity in the middle of the bar",
                "velocity (mm/s)",
                &millimetres,
                &steps([-10.0, 0.0, 10.0, 10.0]),
            ),
        ],
    );
}
