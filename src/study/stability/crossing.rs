//! Cell crossing: a uniformly stressed bar is in equilibrium, but its nodal forces vanish only where the slopes of the shape
//! functions, summed over the points, do. The slope of the linear basis jumps at a node, so that points that are not spread
//! evenly over the cells, as in any stretched bar, push nodes about.
//!
//! Measured: the largest acceleration that the solver gives to an inner point of such a bar in one short step, as a share of
//! σ/(ρ h), which the whole stress would give to a node if it acted on one side only. Predicted: the same from the shape functions
//! alone, a_p = Σ N_i f_i/m_i with f_i = −Σ V τ N_i′. Transfer and update make no difference to one step from rest.

use super::bar::Bar;
use super::bisect::first_failure;
use super::findings::{Drawing, Findings, Sense};
use super::{Failure, Method, Study};
use crate::basis::{Basis, BasisChoice, BasisVisitor};
use crate::report::{LineChart, Series, Style};
use crate::study::validate::CaseError;

/// The case.
pub const FAILURE: Failure = Failure {
    name: "crossing",
    title: "cell crossing: a stretched bar under uniform stress is pushed about by its own grid",
    measure: "smallest stretch above 1 at which an inner point accelerates by more than a fifth of stress/(density h); fails below 1.5",
    prediction: "nodal forces summed from the shape functions alone",
    run,
};

const LIMIT: f64 = 0.2;
/// The smallest force that is drawn.
const FLOOR: f64 = 1e-5;
const CELLS: f64 = 60.0;
const GRID: f64 = 180.0;
/// Stretches are searched in steps of an odd size, so that few of them place points evenly again.
const STRIDE: f64 = 0.0137;

fn run(study: &Study) -> Result<Findings, CaseError> {
    let points = study.points_or(&[2, 4]);
    let bases = bases_in_frames(study);
    let jobs: Vec<(Method, u32)> = points
        .iter()
        .flat_map(|n| bases.iter().map(|method| (*method, *n)))
        .collect();
    let edges = study.map(&jobs, |(method, points)| {
        let edge = |imbalance: &dyn Fn(f64) -> f64| {
            first_failure([1.003, 2.6], STRIDE, 1e-3, |stretch| {
                imbalance(stretch) > LIMIT
            })
        };
        let curve: Vec<(f64, f64)> = (0..=200)
            .map(|i| 0.6 + 0.010_007 * f64::from(i))
            // what is exactly balanced would leave a gap on a logarithmic axis
            .map(|stretch| (stretch, measured(*method, *points, stretch).max(FLOOR)))
            .collect();
        (
            edge(&|stretch| predicted(*method, *points, stretch)),
            edge(&|stretch| measured(*method, *points, stretch)),
            curve,
        )
    });
    let mut findings = Findings::new("stretch", Sense::AtLeast, 1.5);
    for ((method, points), (predicted, measured, _)) in jobs.iter().zip(&edges) {
        let (name, at) = (basis_name(method), super::courant::at(*points));
        findings.push(name, at, Some(*predicted), *measured);
    }
    let pushed: Vec<String> = bases
        .iter()
        .filter(|method| !method.is_total())
        .map(|method| (method.basis, measured(*method, points[0], 1.2)))
        .map(|(basis, share)| format!("{:.1} % with the {basis} basis", 100.0 * share))
        .collect();
    findings.shown = format!(
        "At a stretch of 1.2 and {} points per cell false forces reach {} of stress/(density h). Jumps of the slope do not become smaller with more cells, only with more points. In the total frame points never leave their cells. Measured and predicted edges differ by {:.1e} at most.",
        points[0],
        pushed.join(", "),
        findings.worst_deviation()
    );
    let panel = |n: &u32| {
        let of = jobs.iter().zip(&edges).filter(|(job, _)| job.1 == *n);
        let mut series: Vec<Series> = of
            .clone()
            .filter(|(job, _)| !job.0.is_total())
            .map(|(job, edge)| Series::new(job.0.basis, edge.2.clone(), Style::Line))
            .collect();
        // none of these is more than round-off: the worst of them says it all
        let total = of.filter(|(job, _)| job.0.is_total()).map(|(_, edge)| &edge.2);
        if let Some(worst) = total.map(|curve| curve.to_vec()).reduce(higher) {
            series.push(Series::new("any basis, total frame (below 10⁻⁵)", worst, Style::Line));
        }
        let limit = vec![(0.6, LIMIT), (2.6, LIMIT)];
        series.push(Series::new("fails above", limit, Style::Dashed));
        LineChart {
            title: format!("False forces in a stretched bar, {n} points per cell"),
            x_label: "stretch".into(),
            y_label: "largest acceleration ρ h / σ (exact: 0)".into(),
            y_log: true,
            y_range: Some([0.5 * FLOOR, 2.0]),
            series,
            ..LineChart::default()
        }
    };
    let panels = points.iter().map(panel).collect();
    findings.drawings.push(("", Drawing::Lines(panels)));
    Ok(findings)
}

/// One method for every basis of the study.
pub(super) fn bases(study: &Study) -> Vec<Method> {
    let mut once: Vec<Method> = Vec::new();
    for method in bases_in_frames(study) {
        if once.iter().all(|other| other.basis != method.basis) {
            once.push(method);
        }
    }
    once
}

/// One method for every basis and frame of the study.
pub(super) fn bases_in_frames(study: &Study) -> Vec<Method> {
    let mut bases: Vec<Method> = Vec::new();
    for method in &study.methods {
        let same = |other: &Method| (other.basis, other.frame) == (method.basis, method.frame);
        if !bases.iter().any(same) {
            bases.push(Method {
                transfer: "flip",
                update: "usl",
                ..*method
            });
        }
    }
    bases
}

/// The name of a basis in its frame.
pub(super) fn basis_name(method: &Method) -> String {
    if method.is_total() {
        format!("{}, total frame", method.basis)
    } else {
        method.basis.into()
    }
}

/// The higher of two curves over the same places.
fn higher(a: Vec<(f64, f64)>, b: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    let pairs = a.into_iter().zip(b);
    pairs.map(|((x, a), (_, b))| (x, a.max(b))).collect()
}

/// The largest of the inner points, to which no end of the bar shares a node.
fn largest(accelerations: &[f64]) -> f64 {
    let ends = accelerations.len() / 6;
    let inner = &accelerations[ends..accelerations.len() - ends];
    inner.iter().fold(0.0, |most, a| most.max(a.abs()))
}

fn measured(method: Method, points: u32, stretch: f64) -> f64 {
    let bar = Bar {
        span: [0.5 * (GRID - CELLS), 0.5 * (GRID + CELLS)],
        cells: GRID as u32,
        held: Vec::new(),
        stretch,
        ..Bar::held(method, points, 0.0)
    };
    let Ok(mut specimen) = bar.build() else {
        return f64::NAN;
    };
    let dt = 1e-6;
    specimen.set(|_| [0.0, 1.0, 0.0]);
    if specimen.step(dt).is_err() {
        return f64::NAN;
    }
    // the density is 1/stretch
    let accelerations: Vec<f64> = specimen
        .get()
        .iter()
        .map(|p| p[0] / dt / stretch)
        .collect();
    largest(&accelerations)
}

fn predicted(method: Method, points: u32, stretch: f64) -> f64 {
    let empty = crate::input::Document::parse("", &[]);
    let Some(basis) = BasisChoice::read(method.basis, &mut empty.root()) else {
        return f64::NAN;
    };
    // in the total frame the functions are those of the bar before it was stretched, and P = τ/F
    let places = if method.is_total() { 1.0 } else { stretch };
    let accelerations = basis.visit(Accelerations {
        points,
        stretch: places,
    });
    let accelerations: Vec<f64> = accelerations.iter().map(|a| a / stretch).collect();
    largest(&accelerations)
}

/// What a uniform stress of 1 Pa does to the points of a stretched bar.
struct Accelerations {
    points: u32,
    stretch: f64,
}

impl BasisVisitor for Accelerations {
    type Output = Vec<f64>;

    fn visit<const N: usize, B: Basis<N>>(self, basis: B) -> Vec<f64> {
        let spacing = 1.0 / f64::from(self.points);
        let basis = basis.for_spacing(spacing);
        let cells = GRID as i32;
        let count = (CELLS / spacing) as usize;
        let place = |p: usize| {
            let from_middle = (p as f64 + 0.5) * spacing - 0.5 * CELLS;
            0.5 * GRID + from_middle * self.stretch
        };
        let nodes = basis.count(cells) as usize;
        let (mut mass, mut force) = (vec![0.0; nodes], vec![0.0; nodes]);
        for p in 0..count {
            let axis = basis.axis(place(p), cells);
            for k in 0..N {
                let node = axis.first as usize + k;
                mass[node] += spacing * axis.weight[k];
                force[node] -= spacing * axis.slope[k];
            }
        }
        let accelerate = |p: usize| {
            let axis = basis.axis(place(p), cells);
            let of = (0..N).map(|k| (axis.weight[k], axis.first as usize + k));
            of.filter(|(_, node)| mass[*node] > 0.0)
                .map(|(weight, node)| weight * force[node] / mass[node])
                .sum()
        };
        (0..count).map(accelerate).collect()
    }

    /// Domains that touch have the same corners: what pulls at a node from one side pulls from the other.
    fn visit_domains<const N: usize, B: Basis<N>>(self, _: B) -> Vec<f64> {
        vec![0.0; (CELLS * f64::from(self.points)) as usize]
    }
}
