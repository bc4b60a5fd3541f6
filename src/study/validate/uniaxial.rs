//! One cell under uniaxial strain: four points, the bottom held, the top pushed down at 0.01 m/s for ten steps of 0.01 s.
//!
//! The figures that the CB-Geo benchmark of this name is checked against, to eight decimals, in its `test_benchmark.py` (inputs
//! in `mpm.json`; github.com/cb-geo/mpm-benchmarks, 2d/uniaxial_stress): σ_yy = E ε = −1 Pa, σ_xx = 0. The classical rate law adds E Δt ∂v/∂y in each step, with ∂v/∂y = −0.01 /s on the fixed grid, so −1 Pa holds to round-off.

use super::compare::larger;
use super::history::{last, points};
use super::{Case, CaseError, Report};
use crate::report::{LineChart, Series, Style};

/// The case.
pub const CASE: Case = Case {
    name: "uniaxial_stress",
    claim: "one cell of four points, compressed by a thousandth, carries the published stress to its last digit",
    reference: "CB-Geo MPM benchmarks, 2d/uniaxial_stress: stress_yy = -1, to eight decimals",
    run,
};

const SCENARIO: &str = include_str!("../../../scenarios/uniaxial_stress.toml");

fn run(report: &mut Report) -> Result<(), CaseError> {
    let run = report.run_with_frames(SCENARIO, &[])?;
    let frames = &run.memory.frames;
    let component = |a: usize, b: usize| -> Vec<Vec<f64>> {
        frames
            .iter()
            .map(|frame| {
                frame
                    .points
                    .iter()
                    .map(|point| point.stress[a][b])
                    .collect()
            })
            .collect()
    };
    let worst = |stresses: &[Vec<f64>], exact: &dyn Fn(usize) -> f64| {
        let errors = stresses
            .iter()
            .enumerate()
            .flat_map(|(row, all)| all.iter().map(move |s| (s - exact(row)).abs()));
        errors.fold(0.0, larger)
    };
    let (along, across, shear) = (component(1, 1), component(0, 0), component(0, 1));
    let end = &along[along.len() - 1..];
    // half of the last published digit
    report.at_most(
        "published: largest |stress_yy + 1| of the four points (Pa)",
        worst(end, &|_| -1.0),
        5e-9,
    );
    // the law's own figure in every step, to round-off of ten additions
    report.at_most(
        "every step: largest |stress_yy - E strain| (Pa)",
        worst(&along, &|row| -0.1 * row as f64),
        1e-12,
    );
    report.at_most(
        "every step: largest |stress_xx|, |stress_xy| (Pa)",
        worst(&across, &|_| 0.0).max(worst(&shear, &|_| 0.0)),
        1e-12,
    );
    let time = run.column("energy", "time");
    let first: Vec<f64> = along.iter().map(|all| all[0]).collect();
    let exact: Vec<f64> = time.iter().map(|t| -10.0 * t).collect();
    // The top is pushed with the force that the points carry: E ε · 1 m², less by the strain, as the grid's cell is not shortened.
    let reaction = last(&run.column("boundary_top", "reaction_y"));
    report.close(
        "force of the top in the last step (N)",
        reaction,
        -1.0,
        0.002,
    );
    report.table(
        "stress",
        &[("time", &time), ("computed", &first), ("exact", &exact)],
    );
    report.chart(
        "stress",
        vec![LineChart {
            title: "Stress of a point".into(),
            x_label: "time (s)".into(),
            y_label: "stress along y (Pa)".into(),
            series: vec![
                Series::new("computed", points(&time, &first), Style::LineMarkers),
                Series::new("exact", points(&time, &exact), Style::Dashed),
            ],
            ..LineChart::default()
        }],
    );
    Ok(())
}
