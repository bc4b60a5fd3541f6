//! The bar of `bar1d` at strains of 10 % and 20 %: points cross cells, and the closed form of small motion is of no use.
//!
//! The reference solves ρ₀ü = ∂P/∂X, P = σ = E ln F (uniaxial strain, no lateral strain), by sine modes and a Runge–Kutta method
//! (`swing.rs`), to six digits and better.
//!
//! Where the linear basis fails: a point that crosses into the next cell takes its share of force away from one node at once
//! and gives it to another, so that the nodal forces of a smooth stress are wrong by as much as one point's share of it. More
//! cells bring more crossings: its stress gets worse, and this is claimed here.

use super::compare::{chart, curve, orders, root_mean};
use super::swing::Swing;
use super::problem::{bar_grid, displacement_error};
use super::{Case, CaseError, Layout, Problem, Recorded, Report, set};
use crate::report::Style;
use std::sync::OnceLock;

/// The case.
pub const CASE: Case = Case {
    name: "large_bar",
    claim: "a bar that swings by 10 % and more moves as it should with gimp and splines, and the linear basis fails",
    reference: "sine-Galerkin and Runge-Kutta solution of the same equations (swing.rs)",
    run,
};

/// Half a period at 10 % of strain.
pub const PROBLEM: Problem = Problem {
    name: "large_bar",
    about: "a bar swings by 10 % of strain for half a period; points cross cells",
    norm: "displacement, relative L2 norm over points and recorded times",
    reference: CASE.reference,
    cells_are: "along the bar",
    dimensions: &[1],
    layout: |_, cells| {
        // a quarter more for the swing
        let mut overrides = bar_grid(LENGTH, cells, (f64::from(cells) / 4.0).ceil());
        overrides.extend(["time.end=\"5 s\"".into(), format!("output.every={RECORD}")]);
        Layout { text: SCENARIO.into(), overrides }
    },
    error: |run| {
        displacement_error(run, |x, time| {
            let record = (time / RECORD).round() as usize;
            let swing = reference().get(record);
            [swing.map_or(f64::NAN, |swing| swing.displacement(x[0])), 0.0, 0.0]
        })
    },
    cells: |_| &[8, 16, 32, 64],
    points: &[2, 3, 4],
    doubt: 0.0,
    expected: &[],
};

/// Time between two recorded rows of a chart, s.
const RECORD: f64 = 0.5;

/// The reference at the recorded times of half a period.
fn reference() -> &'static [Swing] {
    static REFERENCE: OnceLock<Vec<Swing>> = OnceLock::new();
    REFERENCE.get_or_init(|| {
        let mut swing = Swing::new(LENGTH, 1.0, WAVE_SPEED * WAVE_SPEED, 1.0);
        let mut all = vec![swing.clone()];
        for _ in 0..10 {
            swing.advance(RECORD, 0.02);
            all.push(swing.clone());
        }
        all
    })
}

pub(super) const SCENARIO: &str = include_str!("../../../scenarios/large_bar.toml");
const LENGTH: f64 = 25.0;
const WAVE_SPEED: f64 = 10.0;
const BASES: [&str; 4] = ["linear", "gimp", "quadratic", "cubic"];
const CELLS: [f64; 3] = [16.0, 32.0, 64.0];

/// How a motion compares with the reference, over all recorded times.
pub(super) struct Errors {
    /// Root mean square of the stress error over E v₀/c.
    pub(super) stress: f64,
    /// Root mean square of the displacement error over v₀/ω.
    pub(super) displacement: f64,
}

fn run(report: &mut Report) -> Result<(), CaseError> {
    let mut all = Vec::new();
    for basis in BASES {
        let mut errors = Vec::new();
        for cells in CELLS {
            let bar = swing(report, basis, cells, 2, 1.0, 10.0)?;
            errors.push(compare(&bar, 1.0));
        }
        all.push(errors);
    }
    judge(report, &all);
    larger_still(report)?;
    draw(report, &all)
}

fn swing(
    report: &mut Report,
    basis: &str,
    cells: f64,
    per_cell: u32,
    speed: f64,
    end: f64,
) -> Result<Recorded, CaseError> {
    let texts = [
        format!("{} m", LENGTH / cells),
        format!("{speed} m/s"),
        format!("{end} s"),
        per_cell.to_string(),
    ];
    let overrides = [
        ("method.basis", basis),
        ("grid.cell_size", &texts[0]),
        ("constants.v0", &texts[1]),
        ("time.end", &texts[2]),
        ("body[0].particles_per_cell", &texts[3]),
    ];
    report.run_with_frames(SCENARIO, &set(&overrides))
}

pub(super) fn compare(bar: &Recorded, speed: f64) -> Errors {
    let frames = &bar.memory.frames;
    let mut reference = Swing::new(LENGTH, 1.0, WAVE_SPEED * WAVE_SPEED, speed);
    let (mut stress, mut displacement) = (0.0, 0.0);
    for pair in frames.windows(2) {
        reference.advance(pair[1].time - pair[0].time, 0.02);
        let x = |i: usize| start(frames, i);
        let error = |i: usize, computed: f64| computed - reference.stress(x(i));
        stress += root_mean(&pair[1].points, |i, point| {
            error(i, point.stress[0][0]).powi(2)
        })
        .powi(2);
        let moved = |i: usize, at: f64| at - x(i) - reference.displacement(x(i));
        displacement += root_mean(&pair[1].points, |i, point| {
            moved(i, point.position[0]).powi(2)
        })
        .powi(2);
    }
    let count = (frames.len() - 1) as f64;
    let omega = std::f64::consts::PI * WAVE_SPEED / (2.0 * LENGTH);
    Errors {
        stress: (stress / count).sqrt() / (WAVE_SPEED * speed),
        displacement: (displacement / count).sqrt() / (speed / omega),
    }
}

/// Initial position of a point, m.
fn start(frames: &[crate::observe::Frame], point: usize) -> f64 {
    frames[0].points[point].position[0]
}

// Two errors add up. The wave is slow by the share θ²/4 (quadratic) or θ²/3 (cubic), θ = kh: after a period, 64 cells, a
// displacement off by 2π θ²/3 /√6 = 5e-4. And where strained points no longer tile the cells evenly, nodal forces are off by a
// share of the stress that does not fall with h, only with the points a cell and the smoothness of the basis: per cent for gimp
// and quadratic with two points a cell (so that their stress does not converge), a tenth of that for cubic. The limits are
// what this leaves, rounded up by a third or so; a density wrong by 1 % alone moves the displacement by 1.3 %.
fn judge(report: &mut Report, all: &[Vec<Errors>]) {
    let limits = [
        (0.0, 0.0, 0.0),
        (0.04, 0.003, 0.5),
        (0.04, 0.003, 0.5),
        (0.015, 0.0015, 1.3),
    ];
    for ((basis, errors), (stress, displacement, least)) in BASES.iter().zip(all).zip(limits) {
        let finest = &errors[CELLS.len() - 1];
        if *basis == "linear" {
            report.at_least(
                "linear, 64 cells: stress, rms error / (E v0 / c) (cell crossing)",
                finest.stress,
                0.1,
            );
            let ratio = finest.stress / errors[0].stress;
            report.at_least(
                "linear: stress error with 64 cells / with 16 (finer is worse)",
                ratio,
                1.0,
            );
            continue;
        }
        report.at_most(
            format!("{basis}, 64 cells: stress, rms error / (E v0 / c)"),
            finest.stress,
            stress,
        );
        report.at_most(
            format!("{basis}, 64 cells: displacement, rms error / (v0 / omega)"),
            finest.displacement,
            displacement,
        );
        let column: Vec<f64> = errors.iter().map(|errors| errors.displacement).collect();
        let order = orders(&CELLS.map(|cells| LENGTH / cells), &column);
        report.at_least(
            format!("{basis}: order of convergence of the displacement, 16 to 64 cells"),
            0.5 * (order[0] + order[1]),
            least,
        );
    }
    for (basis, errors) in [("gimp", &all[1]), ("quadratic", &all[2])] {
        report.at_least(
            format!(
                "{basis}: stress error with 64 cells / with 16 (two points a cell: no convergence)"
            ),
            errors[2].stress / errors[0].stress,
            0.5,
        );
    }
}

/// 20 % of strain, half a period, four points a cell: the wave steepens, and points cross many cells.
fn larger_still(report: &mut Report) -> Result<(), CaseError> {
    // gimp points keep their initial extent, and where the bar is stretched gaps open between them
    for (basis, stress, displacement) in [
        ("gimp", 0.2, 0.03),
        ("quadratic", 0.1, 0.006),
        ("cubic", 0.01, 0.0005),
    ] {
        let name = format!("{basis}, 64 cells of 4 points, v0 = 2 m/s, half a period");
        let errors = compare(&swing(report, basis, 64.0, 4, 2.0, 5.0)?, 2.0);
        report.at_most(
            format!("{name}: stress, rms error / (E v0 / c)"),
            errors.stress,
            stress,
        );
        report.at_most(
            format!("{name}: displacement, rms error / (v0 / omega)"),
            errors.displacement,
            displacement,
        );
        if basis == "gimp" {
            report.at_least(
                format!("{name}: stress error (degrades)"),
                errors.stress,
                0.05,
            );
        }
    }
    let mut reference = Swing::new(LENGTH, 1.0, WAVE_SPEED * WAVE_SPEED, 2.0);
    reference.advance(5.0, 0.02);
    report.at_most(
        "reference, v0 = 2 m/s: what its last modes still hold, relative",
        reference.tail(),
        1e-6,
    );
    Ok(())
}

fn draw(report: &mut Report, all: &[Vec<Errors>]) -> Result<(), CaseError> {
    let sizes = CELLS.map(|cells| LENGTH / cells);
    let mut panels = Vec::new();
    let mut columns: Vec<(String, Vec<f64>)> = vec![("cell_size".into(), sizes.to_vec())];
    for (what, pick) in [
        (
            "stress",
            (|errors: &Errors| errors.stress) as fn(&Errors) -> f64,
        ),
        ("displacement", |errors: &Errors| errors.displacement),
    ] {
        let mut series = Vec::new();
        for (basis, errors) in BASES.iter().zip(all) {
            let column: Vec<f64> = errors.iter().map(pick).collect();
            series.push(curve(*basis, &sizes, &column, Style::LineMarkers));
            columns.push((format!("{basis}_{what}"), column));
        }
        if what == "displacement" {
            series.push(curve(
                "second order",
                &sizes,
                &sizes.map(|h| 0.01 * h * h),
                Style::Dashed,
            ));
        }
        let mut panel = chart(
            &format!("Error of the {what}, one period"),
            "cell size (m)",
            "relative rms error",
            series,
        );
        (panel.x_log, panel.y_log) = (true, true);
        panels.push(panel);
    }
    let table: Vec<(&str, &[f64])> = columns
        .iter()
        .map(|(name, column)| (&name[..], &column[..]))
        .collect();
    report.table("errors", &table);

    // the stress along the bar where it is stretched most
    let mut profiles = Vec::new();
    for basis in ["linear", "quadratic"] {
        let bar = swing(report, basis, 32.0, 2, 1.0, 2.5)?;
        let frames = &bar.memory.frames;
        let last = &frames[frames.len() - 1].points;
        let x: Vec<f64> = (0..last.len()).map(|i| start(frames, i)).collect();
        let stress: Vec<f64> = last.iter().map(|point| point.stress[0][0]).collect();
        profiles.push(curve(basis, &x, &stress, Style::LineMarkers));
    }
    let mut reference = Swing::new(LENGTH, 1.0, WAVE_SPEED * WAVE_SPEED, 1.0);
    reference.advance(2.5, 0.02);
    let x: Vec<f64> = (0..=100).map(|i| 0.25 * f64::from(i)).collect();
    let stress: Vec<f64> = x.iter().map(|&x| reference.stress(x)).collect();
    profiles.push(curve("reference", &x, &stress, Style::Dashed));
    panels.insert(
        0,
        chart(
            "Stress at a quarter of the period, 32 cells",
            "initial position (m)",
            "stress (Pa)",
            profiles,
        ),
    );
    report.chart("errors", panels);
    Ok(())
}
