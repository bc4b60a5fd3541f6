//! A cube under pressure on all sides: the stress is −p I and the volume ratio 1 − p/K, K = E / (3 (1 − 2ν)).

use super::{Case, CaseError, Report};
use crate::report::{LineChart, Series, Style};

/// The case.
pub const CASE: Case = Case {
    name: "hydrostatic",
    claim: "a cube pressed on all sides carries the pressure in every direction and shrinks by p/K",
    reference: "Hooke's law",
    run,
};

const SCENARIO: &str = include_str!("../../../scenarios/hydrostatic.toml");

const PRESSURE: f64 = 10e6;
const BULK: f64 = 70e9 / (3.0 * (1.0 - 2.0 * 0.33));

fn run(report: &mut Report) -> Result<(), CaseError> {
    let cube = report.run(SCENARIO, &[])?;
    let probe = |column: &str| cube.column("probe_inside", column);
    let last = |column: &str| probe(column).last().copied().unwrap_or(f64::NAN);
    // Four cells inside a cube of eight the uneven stress of the outermost cells has faded to some per mille.
    for axis in ["xx", "yy", "zz"] {
        let stress = last(&format!("stress_{axis}")) / PRESSURE;
        report.close(format!("stress_{axis} / pressure"), stress, -1.0, 0.01);
    }
    for pair in ["xy", "xz", "yz"] {
        let stress = last(&format!("stress_{pair}")) / PRESSURE;
        report.close(format!("stress_{pair} / pressure"), stress, 0.0, 0.005);
    }
    let shrunk = (1.0 - last("volume_ratio")) / (PRESSURE / BULK);
    report.close("loss of volume / (p / K)", shrunk, 1.0, 0.01);
    let reaction = cube.column("boundary_left", "reaction_x");
    let force = reaction.last().copied().unwrap_or(f64::NAN) / (PRESSURE * 0.04 * 0.04);
    // the sum of all forces; only what still moves is missing
    report.close("reaction of the left side / (p A)", force, 1.0, 1e-3);

    let time = probe("time");
    let expected: Vec<f64> = time.iter().map(|t| -PRESSURE * (t / 0.4e-3).min(1.0)).collect();
    let curve = |y: &[f64]| time.iter().copied().zip(y.iter().map(|y| y / 1e6)).collect();
    report.table(
        "stress",
        &[("time", &time), ("stress_xx", &probe("stress_xx")), ("exact", &expected)],
    );
    report.chart(
        "stress",
        vec![LineChart {
            title: "Stress inside a cube under slowly growing pressure".into(),
            x_label: "time (s)".into(),
            y_label: "stress (MPa)".into(),
            series: vec![
                Series::new("computed", curve(&probe("stress_xx")), Style::LineMarkers),
                Series::new("at rest", curve(&expected), Style::Dashed),
            ],
            ..LineChart::default()
        }],
    );
    Ok(())
}
