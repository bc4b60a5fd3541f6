//! A block in free flight: the parabola, and no stress, whatever the basis and the transfer.
//!
//! x = x₀ + v₀t, y = y₀ + w₀t − gt²/2. A uniform velocity has no gradient as long as the weights add up to one and the slopes to
//! nothing, so that this holds for all methods to round-off. In steps, with v⁺ = v + Δt g and y⁺ = y + Δt v⁺, the velocity is
//! exact and the fall is g t (t + Δt)/2.
//!
//! Seen from a carriage that moves along, the same happens: the run with sideways speed differs from the one without by v₀t.

use super::compare::{chart, curve, largest, map};
use super::{Case, CaseError, Recorded, Report, set};
use crate::report::Style;

/// The case.
pub const CASE: Case = Case {
    name: "free_fall",
    claim: "a thrown block flies along a parabola, free of stress, with every basis and transfer",
    reference: "Galileo's parabola",
    run,
};

const SCENARIO: &str = include_str!("../../../scenarios/free_fall.toml");
const G: f64 = 10.0;
const DT: f64 = 5e-4;
const V0: f64 = 2.0;
const W0: f64 = 3.0;
/// Centre of the block at the start, m.
const CENTER: [f64; 2] = [0.51737, 0.62319];
/// Round-off of a thousand steps on numbers of the order of one.
const ROUND_OFF: f64 = 1e-12;

const METHODS: [(&str, &str, &str); 8] = [
    ("linear", "flip", "musl"),
    ("linear", "pic", "musl"),
    ("gimp", "flip", "usf"),
    ("gimp", "apic", "musl"),
    ("quadratic", "apic", "usl"),
    ("quadratic", "flip", "usl"),
    ("cubic", "apic", "usf"),
    ("cubic", "pic", "musl"),
];

fn run(report: &mut Report) -> Result<(), CaseError> {
    let mut shown = None;
    for (basis, transfer, update) in METHODS {
        let method = [
            ("method.basis", basis),
            ("method.transfer", transfer),
            ("method.update", update),
        ];
        let flight = report.run_with_frames(SCENARIO, &set(&method))?;
        let worst = Errors::of(&flight, V0);
        let mut drop = method.to_vec();
        drop.push(("constants.v0", "0 m/s"));
        let dropped = report.run(SCENARIO, &set(&drop))?;
        let name = format!("{basis} {transfer} {update}");
        report.at_most(
            format!("{name}: position, largest distance from the parabola in steps, m"),
            worst.position,
            ROUND_OFF,
        );
        report.at_most(
            format!("{name}: velocity, largest error / v0"),
            worst.velocity,
            ROUND_OFF,
        );
        // velocities of 1 m/s with a relative error of 1e-16, differing over 0.1 m, make strains of 1e-15 a second, and each of the
        // thousand steps may add its own; a code that makes stress makes very much more
        report.at_most(
            format!("{name}: stress, largest / E"),
            worst.stress,
            ROUND_OFF,
        );
        let heights = [&flight, &dropped].map(|run| run.column("body_block", "position_y"));
        report.at_most(
            format!("{name}: height with and without sideways speed, largest difference, m"),
            largest(&heights[0], &heights[1]),
            ROUND_OFF,
        );
        if (basis, transfer, update) == ("quadratic", "apic", "usl") {
            energy(report, &flight);
            shown = Some(flight);
        }
    }
    if let Some(flight) = shown {
        draw(report, &flight);
    }
    Ok(())
}

/// Fall in steps, m.
fn fall(time: f64) -> f64 {
    0.5 * G * time * (time + DT)
}

/// Largest over all times and points.
struct Errors {
    position: f64,
    velocity: f64,
    stress: f64,
}

impl Errors {
    fn of(flight: &Recorded, v0: f64) -> Self {
        let frames = &flight.memory.frames;
        let (mut position, mut velocity, mut stress) = (Vec::new(), Vec::new(), Vec::new());
        for frame in frames {
            let t = frame.time;
            for (point, start) in frame.points.iter().zip(&frames[0].points) {
                position.push(point.position[0] - start.position[0] - v0 * t);
                position.push(point.position[1] - start.position[1] - W0 * t + fall(t));
                velocity.push((point.velocity[0] - v0) / V0);
                velocity.push((point.velocity[1] - W0 + G * t) / V0);
                stress.extend(point.stress.iter().flatten().map(|stress| stress / 1e4));
            }
        }
        let [position, velocity, stress] =
            [position, velocity, stress].map(|errors| largest(&errors, &vec![0.0; errors.len()]));
        Self {
            position,
            velocity,
            stress,
        }
    }
}

/// What is lost in height is won in speed.
fn energy(report: &mut Report, flight: &Recorded) {
    let [time, kinetic, potential] =
        ["time", "kinetic", "potential"].map(|column| flight.column("energy", column));
    let mass = 1000.0 * 0.4 * 0.4;
    let exact = map(&time, |t| 0.5 * mass * (V0 * V0 + (W0 - G * t).powi(2)));
    report.at_most(
        "kinetic energy against the closed form: largest error, relative",
        largest(&kinetic, &exact) / exact[0],
        ROUND_OFF,
    );
    // y falls g t Δt/2 more than the parabola
    let sum: Vec<f64> = (0..time.len())
        .map(|i| kinetic[i] + potential[i] + 0.5 * mass * G * G * DT * time[i])
        .collect();
    report.at_most(
        "kinetic + potential energy, beside the known first-order fall: largest change, relative",
        largest(&sum, &vec![sum[0]; sum.len()]) / exact[0],
        ROUND_OFF,
    );
}

fn draw(report: &mut Report, flight: &Recorded) {
    let time = flight.column("body_block", "time");
    let [x, y] = ["position_x", "position_y"].map(|column| flight.column("body_block", column));
    let exact_x = map(&time, |t| CENTER[0] + V0 * t);
    let exact_y = map(&time, |t| CENTER[1] + W0 * t - 0.5 * G * t * t);
    report.table(
        "flight",
        &[
            ("time", &time),
            ("x", &x),
            ("y", &y),
            ("x_exact", &exact_x),
            ("y_exact", &exact_y),
        ],
    );
    let thin = |column: &[f64]| -> Vec<f64> { column.iter().copied().step_by(5).collect() };
    let path = chart(
        "Path of the centre (quadratic, APIC, USL)",
        "x (m)",
        "y (m)",
        vec![
            curve("computed", &thin(&x), &thin(&y), Style::Markers),
            curve("parabola", &exact_x, &exact_y, Style::Dashed),
        ],
    );
    let [kinetic, potential] =
        ["kinetic", "potential"].map(|column| flight.column("energy", column));
    let start = potential[0];
    let gained = map(&potential, |potential| potential - start);
    let sum: Vec<f64> = kinetic.iter().zip(&gained).map(|(k, p)| k + p).collect();
    let mass = 160.0;
    let exact = map(&time, |t| 0.5 * mass * (V0 * V0 + (W0 - G * t).powi(2)));
    let fallen = map(&time, |t| mass * G * (W0 * t - 0.5 * G * t * t));
    let energies = chart(
        "Energy",
        "time (s)",
        "energy (J)",
        vec![
            curve("kinetic", &thin(&time), &thin(&kinetic), Style::Markers),
            curve(
                "potential, from the start",
                &thin(&time),
                &thin(&gained),
                Style::Markers,
            ),
            curve("sum", &time, &sum, Style::Line),
            curve("exact", &time, &exact, Style::Dashed),
            curve("", &time, &fallen, Style::Dashed),
        ],
    );
    report.chart("flight", vec![path, energies]);
}
