//! A beam, 4 × 1 m, clamped at one end, under a small shear load on the other that grows slowly and is damped: the deflection at rest.
//!
//! Reference: the middle of the end, by finite elements of small strain, E = 1000 Pa and a load of 1 N: 0.24345 m at ν = 0.3,
//! 0.21221 at 0.45, 0.19666 at 0.499. `mpm stability locking` shows which bases stay far below; here is what the others reach.

use super::compare::{chart, curve};
use super::{Case, CaseError, Layout, Problem, Report, cantilever};
use crate::report::Style;

/// The case.
pub const CASE: Case = Case {
    name: "cantilever_shear",
    claim: "a clamped beam under an end load comes to rest at the deflection of finite elements, nearly incompressible or not",
    reference: "finite elements of small strain, 0.24345, 0.21221 and 0.19666 m for Poisson's ratios of 0.3, 0.45 and 0.499",
    run,
};

/// The beam at a Poisson's ratio of 0.499.
pub const PROBLEM: Problem = Problem {
    name: "cantilever_shear",
    about: "a beam of Poisson's ratio 0.499, clamped at one end, settles under a small load on the other",
    norm: "deflection of the free end at rest, relative",
    reference: "finite elements of nine nodes with a linear pressure each, extrapolated from 64 x 16 and 128 x 32",
    cells_are: "over the height of the beam",
    dimensions: &[2],
    layout: |_, cells| Layout {
        text: scenario("quadratic", 1.0 / f64::from(cells), REFERENCE[2].0),
        // the margin above and below is a whole number of cells
        overrides: vec![format!(
            "grid={{ min=[0.0, -1.0], max=[5.0, 2.0], cell_size={:?} }}",
            1.0 / f64::from(cells)
        )],
    },
    error: |run| {
        let deflection = -super::history::last(&cantilever::tip(run));
        (deflection / (LOAD * NEARLY_INCOMPRESSIBLE) - 1.0).abs()
    },
    cells: |_| &[2, 3, 4, 6],
    points: &[1, 2],
    doubt: 1e-3,
    expected: &[],
};

/// Poisson's ratio, and the deflection, m.
const REFERENCE: [(f64, f64); 3] = [(0.3, 0.24345), (0.45, 0.21221), (0.499, 0.19666)];
/// The deflection at 0.499, m, to a thousandth: finite elements of nine nodes with three pressures each, of which 16 × 4, 32 × 8, 64 × 16 and
/// 128 × 32 give 0.19796, 0.19854, 0.19875 and 0.19882. The figure above is 1.1 % lower, which decides nothing at its
/// tolerance; at 0.3 and 0.45 the two agree to 0.1 %.
const NEARLY_INCOMPRESSIBLE: f64 = 0.19886;
/// Small enough for small strain.
const LOAD: f64 = 1e-3;

fn run(report: &mut Report) -> Result<(), CaseError> {
    let mut reached = [Vec::new(), Vec::new()];
    for (ratio, exact) in REFERENCE {
        for (of, basis) in reached.iter_mut().zip(["quadratic", "linear"]) {
            let deflection = rest(report, basis, 0.25, ratio)? / (LOAD * exact);
            of.push(deflection);
        }
    }
    for ((ratio, _), share) in REFERENCE.iter().zip(&reached[0]) {
        report.close(format!("quadratic, 4 cells over the height, Poisson's ratio {ratio}: deflection / reference"), *share, 1.0, 0.03);
    }
    report.close(
        "linear, 4 cells over the height, Poisson's ratio 0.3: deflection / reference",
        reached[1][0],
        0.98,
        0.02,
    );
    report.at_most(
        "linear, 4 cells over the height, Poisson's ratio 0.499: locks, deflection / reference",
        reached[1][2],
        0.25,
    );
    let fine = rest(report, "quadratic", 0.125, 0.3)? / (LOAD * REFERENCE[0].1);
    report.close(
        "quadratic, 8 cells over the height, Poisson's ratio 0.3: deflection / reference",
        fine,
        1.0,
        0.01,
    );
    let ratios = REFERENCE.map(|(ratio, _)| ratio);
    report.table(
        "deflection",
        &[
            ("poissons_ratio", &ratios),
            ("quadratic", &reached[0]),
            ("linear", &reached[1]),
        ],
    );
    let mut panel = chart(
        "Deflection of a clamped beam under an end load, 16 × 4 cells of 2 × 2 points",
        "Poisson's ratio",
        "deflection / reference",
        vec![
            curve("quadratic", &ratios, &reached[0], Style::LineMarkers),
            curve("linear", &ratios, &reached[1], Style::LineMarkers),
            curve("finite elements", &ratios, &[1.0; 3], Style::Dashed),
        ],
    );
    panel.y_range = Some([0.0, 1.2]);
    report.chart("deflection", vec![panel]);
    Ok(())
}

/// The deflection at rest, m.
fn rest(report: &mut Report, basis: &str, cell: f64, ratio: f64) -> Result<f64, CaseError> {
    let run = report.run_with_frames(&scenario(basis, cell, ratio), &[])?;
    Ok(-super::history::last(&cantilever::tip(&run)))
}

fn scenario(basis: &str, cell: f64, ratio: f64) -> String {
    // The load grows over 3 s, a period of the beam, whose angular frequency is 2/s; twice that is the damping that stops it soonest, and
    // e^(-2 * 5) is left after the 5 s that follow.
    format!(
        r#"dimension = 2
time = {{ end = 8.0, courant = 0.6 }}
grid = {{ min = [0.0, -0.5], max = [4.5, 1.5], cell_size = {cell:?} }}
method = {{ basis = "{basis}", transfer = "flip", update = "musl" }}
material.rubber = {{ density = 1.0, linear_elastic = {{ youngs_modulus = 1000.0, poissons_ratio = {ratio:?} }} }}
damping.rate = 4.0
output.every = 8.0
[[body]]
name = "beam"
material = "rubber"
shape.box = {{ min = [0.0, 0.0], max = [4.0, 1.0] }}
particles_per_cell = 2
[[boundary]]
name = "clamp"
on.side = "x_min"
condition = "fixed"
[[load]]
name = "end"
body = "beam"
on.side = "x_max"
force = [0.0, {:?}]
factor = "min(t / (3 s), 1)"
"#,
        -LOAD
    )
}
