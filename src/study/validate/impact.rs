//! A bar hits a rigid wall that can push and not pull.
//!
//! Until the front has run to the free end and back, 2L/c, the wall pushes with ρcv₀ and everything behind the front is at rest
//! under −ρcv₀; then the bar flies off with v₀, undeformed.
//!
//! What the grid adds: a jump cannot be carried, and after a way d the front is about (d h²)^⅓ wide (`wave.rs`). The bar leaves with
//! the ringing of that width in it, and what that holds of the energy is missing in the speed: a loss that falls as h^⅔,
//! measured on three grids.

use super::compare::{chart, curve, largest, orders};
use super::{Case, CaseError, Recorded, Report, set};
use crate::report::Style;

/// The case.
pub const CASE: Case = Case {
    name: "impact",
    claim: "a bar that hits a wall is stopped by a wave, touches for 2 L / c, and leaves with the speed it came with",
    reference: "one-dimensional wave theory of impact",
    run,
};

const SCENARIO: &str = include_str!("../../../scenarios/impact.toml");
const V0: f64 = 0.01;
/// ρcv₀.
const PUSH: f64 = 100.0;
/// 2L/c.
const CONTACT: f64 = 0.2;
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
