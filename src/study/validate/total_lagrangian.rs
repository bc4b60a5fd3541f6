//! The total Lagrangian frame where the updated one fails: stretched beyond the points of a cell, bent by a beam's own length,
//! and with the linear basis wherever points would cross cells.
//!
//! The bar at rest carries the traction, P = μ (F − 1/F) = 4 E/3 with μ = E/2, so that F = 3 everywhere and, its section being
//! held, σ = P. With the linear basis, and with gimp as long as no point reaches beyond its cell, each cell is a finite element with
//! two points in it, which a uniform F satisfies exactly. Splines add what they add at the ends of any loaded body: stresses that
//! alternate from layer to layer of points.

use super::compare::{chart, curve, larger};
use super::{Case, CaseError, Recorded, Report, cantilever, column, large_bar, set};
use crate::report::{LineChart, Style};
use crate::run::RunError;
use crate::solver::Fault;

/// The case.
pub const CASE: Case = Case {
    name: "total_lagrangian",
    claim: "in the total frame bodies stretch threefold and bend by their length without cell crossing or numerical fracture",
    reference: "closed forms; sine-Galerkin solution; total Lagrangian finite elements, 128 x 32",
    run,
};

const SCENARIO: &str = include_str!("../../../scenarios/stretched_bar.toml");
const BASES: [&str; 4] = ["linear", "gimp", "quadratic", "cubic"];
const LENGTH: f64 = 10.0;
const STRETCH: f64 = 3.0;
/// 4 E/3, Pa.
const TRACTION: f64 = 4e5 / 3.0;

fn run(report: &mut Report) -> Result<(), CaseError> {
    let mut panels = vec![stretch(report)?];
    swing(report)?;
    settle(report)?;
    panels.push(bend(report)?);
    report.chart("total", panels);
    Ok(())
}

fn pull(report: &mut Report, basis: &str, frame: &str) -> Result<Recorded, CaseError> {
    // where points cross cells, the linear basis needs the points' own velocities
    let (transfer, update) = if frame == "updated" {
        ("flip", "musl")
    } else {
        ("apic", "usl")
    };
    let overrides = [
        ("method.basis", basis),
        ("method.frame", frame),
        ("method.transfer", transfer),
        ("method.update", update),
    ];
    report.run_with_frames(SCENARIO, &set(&overrides))
}

/// The bar of the scenario, in both frames.
fn stretch(report: &mut Report) -> Result<LineChart, CaseError> {
    let mut series = Vec::new();
    for basis in BASES {
        let bar = pull(report, basis, "total")?;
        let frames = &bar.memory.frames;
        let (start, end) = (&frames[0].points, &frames[frames.len() - 1].points);
        let last = end.len() - 1;
        let moved = end[last].position[0] / start[last].position[0];
        let inner = |x: f64| (LENGTH / 3.0..LENGTH * 2.0 / 3.0).contains(&x);
        let wrong = start
            .iter()
            .zip(end)
            .filter(|(from, _)| inner(from.position[0]))
            .map(|(_, to)| (to.stress[0][0] / TRACTION - 1.0).abs());
        let wrong = wrong.fold(0.0, larger);
        // What is left of the motion is about e^-20. With splines the stress of the last points is off by a tenth, alternating and
        // falling to two per mille five cells from the ends; the middle third begins after seven.
        let (exact, near) = match basis {
            "linear" | "gimp" => (1e-8, 1e-8),
            _ => (1e-3, 1e-2),
        };
        report.at_most(
            format!("{basis}, total: stress of the middle third / traction - 1"),
            wrong,
            exact,
        );
        report.close(
            format!("{basis}, total: stretch of the bar up to its last point"),
            moved,
            STRETCH,
            near,
        );
        let time = bar.column("probe_tip", "time");
        let tip = bar.column("probe_tip", "position_x");
        series.push(curve(format!("{basis}, total"), &time, &tip, Style::Line));
    }
    // Neighbours are as far apart as a cell once F = 2, and no node ties them together: the end flies off and leaves the grid.
    for basis in BASES {
        let torn = match pull(report, basis, "updated") {
            Err(CaseError::Run(RunError::Fault(Fault::Escaped(place)))) => place.time,
            Err(other) => return Err(other),
            Ok(_) => f64::NAN,
        };
        report.at_most(
            format!("{basis}, updated: torn off and out of the grid after / s"),
            torn,
            24.0,
        );
    }
    Ok(chart(
        "Last point of a bar that is pulled to three times its length",
        "time (s)",
        "position (m)",
        series,
    ))
}

/// The bar of `large_bar`: where its points cross cells, the linear basis gets stresses wrong by a tenth and more.
fn swing(report: &mut Report) -> Result<(), CaseError> {
    for (speed, end) in [(1.0, "10 s"), (2.0, "5 s")] {
        let mut errors = Vec::new();
        for size in ["1.5625 m", "0.78125 m", "0.390625 m"] {
            let velocity = format!("{speed} m/s");
            let overrides = [
                ("method.basis", "linear"),
                ("method.frame", "total"),
                ("grid.cell_size", size),
                ("constants.v0", &velocity),
                ("time.end", end),
            ];
            let bar = report.run_with_frames(large_bar::SCENARIO, &set(&overrides))?;
            errors.push(large_bar::compare(&bar, speed));
        }
        let name = format!("linear, total, bar swinging at {speed} m/s");
        // Waves are slow by a share of θ² for the lumped mass and the points' weights, θ = kh = π/128; half of the cubic basis' limit in
        // `large_bar`. A cell has one stress, off by kh/4 at its points, of E v₀/c at most: 0.006.
        report.at_most(
            format!("{name}, 64 cells: displacement, rms error / (v0 / omega)"),
            errors[2].displacement,
            0.00075,
        );
        report.at_most(
            format!("{name}, 64 cells: stress, rms error / (E v0 / c)"),
            errors[2].stress,
            0.006,
        );
        let order = |pick: fn(&large_bar::Errors) -> f64| 0.5 * (pick(&errors[0]) / pick(&errors[2])).log2();
        report.at_least(
            format!("{name}: order of convergence of the stress, 16 to 64 cells"),
            order(|errors| errors.stress),
            0.9,
        );
        if speed == 1.0 {
            report.at_least(
                format!("{name}: order of convergence of the displacement, 16 to 64 cells"),
                order(|errors| errors.displacement),
                1.5,
            );
        }
    }
    Ok(())
}

/// The column of `column`: the linear basis carries in each slice what lies above it.
fn settle(report: &mut Report) -> Result<(), CaseError> {
    for basis in BASES {
        let overrides = [
            ("method.basis", basis),
            ("method.transfer", "flip"),
            ("method.update", "musl"),
            ("method.frame", "total"),
            ("grid.cell_size", "0.25 m"),
            ("output.every", "6 s"),
        ];
        let run = report.run_with_frames(column::SCENARIO, &set(&overrides))?;
        // two points of a cell share the stress of its middle, h/4 away: 0.006 of that at the ground
        report.at_most(
            format!("{basis}, total, column of cells of 0.25 m: stress, rms error / (density g L)"),
            column::stress_error(&column::rest(&run)),
            0.01,
        );
    }
    Ok(())
}

/// The beam of `cantilever`, which the updated frame tears off soon after 1 s, down to where it turns back and beyond.
fn bend(report: &mut Report) -> Result<LineChart, CaseError> {
    let overrides = [
        ("method.frame", "total"),
        ("body[0].particles_per_cell", "2"),
        ("time.end", "2.0"),
    ];
    let run = report.run_with_frames(cantilever::SCENARIO, &set(&overrides))?;
    let (time, tip) = (run.column("energy", "time"), cantilever::tip(&run));
    for (at, exact) in cantilever::REFERENCE {
        let row = time.iter().position(|t| (t - at).abs() < 1e-9);
        report.close(
            format!("beam, total: deflection at {at} s / reference"),
            row.map_or(f64::NAN, |row| tip[row] / exact),
            1.0,
            0.007,
        );
    }
    let lowest = (0..tip.len()).min_by(|&a, &b| tip[a].total_cmp(&tip[b]));
    let (at, lowest) = lowest.map_or((f64::NAN, f64::NAN), |row| (time[row], tip[row]));
    report.close(
        "beam, total: lowest deflection / reference",
        lowest / cantilever::LOWEST.1,
        1.0,
        0.007,
    );
    // recorded every 0.01 s
    report.close(
        "beam, total: time of the lowest deflection / s",
        at,
        cantilever::LOWEST.0,
        0.015,
    );
    let reference: (Vec<f64>, Vec<f64>) = cantilever::REFERENCE
        .into_iter()
        .chain([cantilever::LOWEST])
        .unzip();
    Ok(chart(
        "Middle of the free end of a soft beam",
        "time (s)",
        "deflection (m)",
        vec![
            curve("total", &time, &tip, Style::Line),
            curve("finite elements", &reference.0, &reference.1, Style::Markers),
        ],
    ))
}
