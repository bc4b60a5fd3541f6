//! Galilean invariance: a bar that vibrates while it drifts must vibrate as it does at rest. Every node and every cell is passed,
//! so that what the basis does at cell edges, what the update does at nodes of little mass, and what the transfer smooths show
//! together.

use super::bar::Bar;
use super::findings::{Findings, Sense};
use super::{Failure, Method, Study};
use crate::report::{HeatCell, HeatMap};
use crate::study::validate::CaseError;
use std::f64::consts::PI;

/// The case.
pub const FAILURE: Failure = Failure {
    name: "galilei",
    title: "Galilean invariance: a free bar of 16 cells vibrates while it drifts through the grid",
    measure: "rms difference of the points' velocities from the same bar without drift after one period, over the amplitude (0.01 c), Courant number 0.4; fails above 0.1",
    prediction: "0: mechanics does not know the drift",
    run,
};

const SPEEDS: [f64; 4] = [0.01, 0.03, 0.1, 0.3];
const AMPLITUDE: f64 = 0.01;
const LENGTH: f64 = 16.0;
const COURANT: f64 = 0.4;
const LIMIT: f64 = 0.1;

fn run(study: &Study) -> Result<Findings, CaseError> {
    let points = study.points_or(&[2])[0];
    let changes = study.map(&study.methods, |method| {
        let at_rest = velocities(*method, points, 0.0);
        SPEEDS.map(|speed| {
            let (Some(rest), Some(moving)) = (&at_rest, velocities(*method, points, speed)) else {
                return f64::INFINITY;
            };
            let pairs = rest.iter().zip(&moving);
            let sum: f64 = pairs.map(|(a, b)| (a - b) * (a - b)).sum();
            let change = (sum / rest.len() as f64).sqrt() / AMPLITUDE;
            if change.is_nan() { f64::INFINITY } else { change }
        })
    });
    let mut findings = Findings::new("change / amplitude", Sense::AtMost, LIMIT);
    for (method, changes) in study.methods.iter().zip(&changes) {
        for (speed, change) in SPEEDS.iter().zip(changes) {
            findings.push(method, format!("drift {speed} c"), Some(0.0), *change);
        }
    }
    let failing = |basis: &str| {
        let rows = findings.rows.iter().filter(|row| !row.survives);
        rows.filter(|row| row.method.starts_with(basis)).count()
    };
    findings.shown = format!(
        "{} of {} drifting bars vibrate otherwise than at rest by more than a tenth of the amplitude, {} of them with the linear basis, whose slopes jump as points cross cells and whose free ends meet nodes of little mass.",
        findings.failing(),
        findings.rows.len(),
        failing("linear")
    );
    let row = |method: &Method| {
        let of = study.methods.iter().zip(&changes);
        of.filter(|(other, _)| *other == method)
            .flat_map(|(_, changes)| changes)
            .map(|change| HeatCell {
                text: if change.is_finite() {
                    format!("{change:.3}")
                } else {
                    "lost".into()
                },
                fails: *change > LIMIT,
                strength: (change / LIMIT).log10().abs() / 1.5,
            })
            .collect()
    };
    let map = HeatMap {
            title: format!("Velocities of a drifting, vibrating bar against those at rest, {points} points per cell, c Δt/h = 0.4"),
            x_label: "drift velocity / wave speed c".into(),
            holds: "as at rest, to a tenth of the amplitude".into(),
            fails: "differs (rms difference / amplitude is written in each cell)".into(),
            columns: SPEEDS.map(|speed| speed.to_string()).into(),
            ..HeatMap::default()
    };
    findings.draw_maps(study, &map, row);
    Ok(findings)
}

/// Velocities of the points after one period, less the drift; none if points were lost.
fn velocities(method: Method, points: u32, drift: f64) -> Option<Vec<f64>> {
    // an odd start, so that neither end lies at a node
    let start = 4.217;
    let bar = Bar {
        span: [start, start + LENGTH],
        cells: 40,
        held: Vec::new(),
        ..Bar::held(method, points, 0.0)
    };
    let mut specimen = bar.build().ok()?;
    let rest = specimen.rest().to_vec();
    let k = PI / LENGTH;
    specimen.set(|id| {
        let x = k * (rest[id] - start);
        [drift + AMPLITUDE * x.cos(), 0.0, -AMPLITUDE * k * x.sin()]
    });
    for _ in 0..(2.0 * LENGTH / COURANT).round() as usize {
        specimen.step(COURANT).ok()?;
    }
    Some(specimen.get().iter().map(|p| p[0] - drift).collect())
}
