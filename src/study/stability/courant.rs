//! The critical time step of an endless bar at rest: no free end, no node of little mass, only the method.
//!
//! Predicted: the step of small motion is linear, so that the answers of the solver to unit disturbances of one cell are the step
//! of an endless bar; for each wave number they add up to a small matrix, and the step is stable as long as no eigenvalue of it
//! exceeds one. Measured: noise on a long bar, both ends of which are held over six cells, for 800 steps. Where points lie within
//! their cells matters; the prediction takes the worst of nine places, and the run repeats that one.

use super::bar::{Bar, noise};
use super::bisect::first_failure;
use super::findings::{Drawing, Findings, Sense};
use super::measure::survive;
use super::operator::Response;
use super::{Failure, Method, Study};
use crate::report::{ZoneChart, ZonePanel};
use crate::study::validate::CaseError;

/// The case.
pub const FAILURE: Failure = Failure {
    name: "courant",
    title: "the critical time step of a bar at rest, against the time in which a wave crosses a cell",
    measure: "critical Courant number c dt/h of noise on a bar whose ends are held: energy grows 1000-fold within 800 steps; fails below 1, where the wave-speed estimate calls a step stable",
    prediction: "spectral radius of one step of the solver on an endless bar, worst of 9 positions in the cell",
    run,
};

const STEPS: usize = 800;
const RANGE: [f64; 2] = [0.05, 4.0];

fn run(study: &Study) -> Result<Findings, CaseError> {
    let points = study.points_or(&[1, 2, 4]);
    let jobs = study.with_points(&points);
    let edges = study.map(&jobs, |(method, points)| {
        let (predicted, offset) = predicted(*method, *points);
        (predicted, measured(*method, *points, offset), offset)
    });
    let mut findings = Findings::new("critical Courant number c dt/h", Sense::AtLeast, 1.0);
    for ((method, points), (predicted, measured, _)) in jobs.iter().zip(&edges) {
        findings.push(method, at(*points), Some(*predicted), *measured);
    }
    findings.tables.push((
        "positions",
        vec!["basis", "transfer", "update", "points_per_cell", "worst_position"],
        jobs.iter()
            .zip(&edges)
            .map(|((method, points), (_, _, offset))| {
                [method.basis, method.transfer, method.update]
                    .map(String::from)
                    .into_iter()
                    .chain([points.to_string(), offset.to_string()])
                    .collect()
            })
            .collect(),
    ));
    findings.shown = format!(
        "The estimate dt = h/c is no bound of its own: {} of {} edges lie below 1. Measured and predicted edges differ by {:.1} % at most.",
        findings.failing(),
        findings.rows.len(),
        100.0 * findings.worst_deviation()
    );
    let edges: Vec<_> = jobs.iter().zip(&edges).collect();
    for (name, frame, methods) in study.frames() {
        let of = edges.iter().filter(|(job, _)| methods.contains(&job.0));
        let of: Vec<Edge> = of.map(|(_, edge)| **edge).collect();
        findings.drawings.push((name, draw(&methods, frame, &points, &of)));
    }
    Ok(findings)
}

/// How a row names its place.
pub(super) fn at(points: u32) -> String {
    format!("{points} per cell")
}

/// The critical Courant number of an endless bar, and the worst position of its points, m.
fn predicted(method: Method, points: u32) -> (f64, f64) {
    let spacing = 1.0 / f64::from(points);
    // half of the range is enough: the other half is its mirror image. A point exactly at a node has no slope of its own.
    let places = (0..=8).map(|i| spacing * (f64::from(i) / 16.0).max(1e-4));
    let edge = |offset: f64| {
        // the box of a bar begins half a spacing below its first point
        let bar = Bar::held(method, points, offset - 0.5 * spacing);
        let Ok(mut specimen) = bar.build() else {
            return 0.0;
        };
        first_failure(RANGE, 0.1, 1e-4, |dt| {
            Response::of(&mut specimen, points as usize, dt)
                .is_ok_and(|response| response.grows())
        })
    };
    places
        .map(|offset| (edge(offset), offset))
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .unwrap_or((f64::NAN, 0.0))
}

/// The critical Courant number of noise on a long bar.
fn measured(method: Method, points: u32, offset: f64) -> f64 {
    let spacing = 1.0 / f64::from(points);
    let bar = Bar::held(method, points, offset - 0.5 * spacing);
    first_failure(RANGE, 0.1, 1e-3, |dt| {
        let Ok(mut specimen) = bar.build() else {
            return true;
        };
        specimen.set(|id| [1e-9 * noise(id), 0.0, 0.0]);
        survive(&mut specimen, 0.0, dt, STEPS).is_err()
    })
}

/// Predicted, measured, and at which place of the points in their cells.
type Edge = (f64, f64, f64);

fn draw(methods: &[Method], frame: &str, points: &[u32], edges: &[Edge]) -> Drawing {
    let panel = |column: usize| {
        let of = edges.iter().skip(column).step_by(points.len());
        ZonePanel {
            title: match points[column] {
                1 => "1 point per cell".into(),
                n => format!("{n} points per cell"),
            },
            edges: of.clone().map(|(_, measured, _)| *measured).collect(),
            predicted: of.map(|(predicted, _, _)| Some(*predicted)).collect(),
        }
    };
    Drawing::Zones(ZoneChart {
        title: format!("Longest stable time step of an elastic bar at rest, points at their worst place in the cell{frame}"),
        x_label: "Courant number c Δt/h".into(),
        x_range: [0.0, 3.2],
        x_log: false,
        holds: "stable".into(),
        fails: "unstable: energy grows 1000-fold".into(),
        predicted: "predicted edge: spectral radius of one step".into(),
        rows: methods.iter().map(Method::within_frame).collect(),
        panels: (0..points.len()).map(panel).collect(),
    })
}
