//! Splines at walls: near an end of the grid a spline that is cut off there no longer adds up to one with its neighbours, and
//! points lose mass and momentum to functions that do not exist. The bases offered here have open knots or ghost nodes; the
//! splines without either are computed here only, to show what these prevent.

use super::bar::Bar;
use super::crossing::bases;
use super::findings::{Drawing, Findings, Sense};
use super::{Failure, Method, Study};
use crate::report::{LineChart, Series, Style};
use crate::study::validate::CaseError;

/// The case.
pub const FAILURE: Failure = Failure {
    name: "walls",
    title: "splines at walls: functions that are cut off at the end of the grid lose mass and momentum",
    measure: "largest share of a uniform velocity that points within a cell and a half of the end of the grid lose in one PIC step; fails above 1e-12",
    prediction: "0 for bases complete at the ends; 1 - sum N for splines cut off there (1/8 quadratic, 1/6 cubic at the wall)",
    run,
};

fn run(study: &Study) -> Result<Findings, CaseError> {
    let bases = bases(study);
    let lost = study.map(&bases, |method| measured(*method));
    let mut findings = Findings::new("share of velocity lost", Sense::AtMost, 1e-12);
    for (method, lost) in bases.iter().zip(&lost) {
        let lost = lost.iter().map(|(_, lost)| *lost).fold(0.0, f64::max);
        findings.push(method.basis, "at the wall", Some(0.0), lost);
    }
    let names: Vec<&str> = bases.iter().map(|method| method.basis).collect();
    let most = |i: usize| {
        let at = |curve: &Vec<(f64, f64)>| curve.get(i).copied().unwrap_or((0.0, 0.0));
        lost.iter()
            .map(at)
            .fold((0.0, 0.0_f64), |a, b| (b.0, a.1.max(b.1)))
    };
    let count = lost.first().map_or(0, Vec::len);
    let mut series = vec![Series::new(
        format!("every basis offered: {}", names.join(", ")),
        (0..count).map(most).collect(),
        Style::Line,
    )];
    for (degree, name, exact) in [
        (2, "quadratic, cut off (not offered)", 0.125),
        (3, "cubic, cut off (not offered)", 1.0 / 6.0),
    ] {
        let curve: Vec<(f64, f64)> = (0..=300)
            .map(|i| f64::from(i) / 200.0)
            .map(|x| (x, 1.0 - cut_off_sum(degree, x)))
            .collect();
        let most = curve.iter().map(|point| point.1).fold(0.0, f64::max);
        findings.push(name, "at the wall", Some(exact), most);
        series.push(Series::new(name, curve, Style::Line));
    }
    findings.shown = "Every basis offered keeps a uniform velocity to round-off at a wall. Node-centred splines without open knots or ghost nodes lose an eighth (quadratic) or a sixth (cubic) of it there.".into();
    findings.drawings.push((
        "",
        Drawing::Lines(vec![LineChart {
            title: "Share of a uniform velocity that points beside a wall lose in one step".into(),
            x_label: "distance from the end of the grid (cells)".into(),
            y_label: "1 − Σ N".into(),
            y_range: Some([-0.02, 0.2]),
            series,
            ..LineChart::default()
        }]),
    ));
    Ok(findings)
}

/// Distance from the end of the grid, cells, and the share of its velocity that a point there loses in one step of PIC.
fn measured(method: Method) -> Vec<(f64, f64)> {
    let method = Method {
        transfer: "pic",
        ..method
    };
    let bar = Bar {
        span: [0.0, 6.0],
        cells: 12,
        held: Vec::new(),
        ..Bar::held(method, 8, 0.0)
    };
    let Ok(mut specimen) = bar.build() else {
        return vec![(0.0, f64::NAN)];
    };
    specimen.set(|_| [1.0, 0.0, 0.0]);
    if specimen.step(1e-6).is_err() {
        return vec![(0.0, f64::NAN)];
    }
    let after = specimen.get();
    let near = specimen.rest().iter().zip(&after);
    near.take_while(|(x, _)| **x < 1.5)
        .map(|(x, point)| (*x, (point[0] - 1.0).abs()))
        .collect()
}

/// Σ N at `x` of the cardinal splines centred at the nodes 0, 1, 2, … only.
fn cut_off_sum(degree: u32, x: f64) -> f64 {
    let spline = |s: f64| {
        let s = s.abs();
        match degree {
            2 if s < 0.5 => 0.75 - s * s,
            2 if s < 1.5 => 0.5 * (1.5 - s).powi(2),
            3 if s < 1.0 => 2.0 / 3.0 - s * s + 0.5 * s.powi(3),
            3 if s < 2.0 => (2.0 - s).powi(3) / 6.0,
            _ => 0.0,
        }
    };
    (0..6).map(|node| spline(x - f64::from(node))).sum()
}
