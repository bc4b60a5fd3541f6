//! Numerical fracture: a bar falls apart where neighbouring points no longer share a node, whatever its material says.
//!
//! Two points a distance d apart always share a node while d is below the width of a shape function less one cell, and never do
//! beyond the full width: 1 and 2 cells for the linear basis, 2 and 3 for the quadratic one, 3 and 4 for the cubic one, 3/2 and 5/2
//! for GIMP with two points per cell, whose width does not follow the stretch; 5 and 6 cells for CPDI, whose domains follow it up to
//! 4 cells. With n points per cell d is the stretch over n.
//!
//! Measured: one point is given a velocity; does the stress of its neighbour change in one step?

use super::bar::Bar;
use super::bisect::first_failure;
use super::crossing::{bases_in_frames, basis_name};
use super::findings::{Drawing, Findings, Sense};
use super::{Failure, Method, Study};
use crate::basis::{Basis, BasisChoice, BasisVisitor, Cpdi};
use crate::report::{ZoneChart, ZonePanel};
use crate::study::validate::CaseError;

/// The case.
pub const FAILURE: Failure = Failure {
    name: "fracture",
    title: "numerical fracture: a stretched bar falls apart where neighbouring points share no node",
    measure: "smallest stretch at which a neighbour's stress no longer answers to a point's velocity, at the worst position in the grid; fails below 3",
    prediction: "(width of a shape function - 1 cell) times points per cell",
    run,
};

const CELLS: f64 = 12.0;
const GRID: f64 = 280.0;
/// How far a bar is stretched that should never part.
const FARTHEST: f64 = 21.0;

fn run(study: &Study) -> Result<Findings, CaseError> {
    let points = study.points_or(&[1, 2, 4]);
    let bases = bases_in_frames(study);
    let jobs: Vec<(Method, u32)> = bases
        .iter()
        .flat_map(|method| points.iter().map(|n| (*method, *n)))
        .collect();
    let edges = study.map(&jobs, |(method, points)| {
        let (first, always) = predicted(*method, *points);
        let range = [1.0, if always.is_finite() { 1.3 * always + 1.0 } else { FARTHEST }];
        let stride = 0.1 * f64::from(*points);
        let at = |worst: bool| {
            first_failure(range, stride, 1e-3, |stretch| {
                let parted = parted(*method, *points, stretch);
                if worst {
                    parted.contains(&true)
                } else {
                    !parted.contains(&false)
                }
            })
        };
        ((first, at(true)), (always, at(false)))
    });
    let mut findings = Findings::new("stretch", Sense::AtLeast, 3.0);
    for ((method, points), (first, _)) in jobs.iter().zip(&edges) {
        let at = super::courant::at(*points);
        findings.push(basis_name(method), at, Some(first.0), first.1);
    }
    findings.tables.push((
        "everywhere",
        vec!["basis", "points_per_cell", "predicted_stretch", "measured_stretch"],
        jobs.iter()
            .zip(&edges)
            .map(|((method, points), (_, always))| {
                vec![
                    basis_name(method),
                    points.to_string(),
                    always.0.to_string(),
                    always.1.to_string(),
                ]
            })
            .collect(),
    ));
    findings.shown = format!(
        "With n points per cell a bar first parts at a stretch of n (linear), 2n (quadratic), 3n (cubic) or 5n (CPDI); more points or wider functions delay it, nothing in the updated frame prevents it. In the total frame points keep the nodes that they had at the start. Measured and predicted edges differ by {:.1e} at most.",
        findings.worst_deviation()
    );
    let panel = |(column, n): (usize, &u32)| {
        let of = edges.iter().skip(column).step_by(points.len());
        ZonePanel {
            title: super::courant::at(*n).replace("per", if *n == 1 { "point per" } else { "points per" }),
            edges: of.clone().map(|(first, _)| first.1).collect(),
            predicted: of.map(|(first, _)| Some(first.0)).collect(),
        }
    };
    findings.drawings.push((
        "",
        Drawing::Zones(ZoneChart {
            title: "How far a bar can be stretched before its points lose each other (numerical fracture)".into(),
            x_label: "stretch".into(),
            x_range: [1.0, FARTHEST],
            x_log: false,
            holds: "one piece".into(),
            fails: "parts where points lie badly in the grid".into(),
            predicted: "predicted from the width of the shape functions".into(),
            rows: bases.iter().map(basis_name).collect(),
            panels: points.iter().enumerate().map(panel).collect(),
        }),
    ));
    Ok(findings)
}

/// For neighbours at many positions in the grid, whether they know nothing of each other.
fn parted(method: Method, points: u32, stretch: f64) -> Vec<bool> {
    let mut all = Vec::new();
    for i in 0..8 {
        // not a simple share of a cell: with many pairs every position is met
        let offset = f64::from(i) * 0.123_97 + 1e-4;
        let from = 0.5 * (GRID - CELLS) + offset;
        let bar = Bar {
            span: [from, from + CELLS],
            cells: GRID as u32,
            held: Vec::new(),
            stretch,
            ..Bar::held(method, points, 0.0)
        };
        let Ok(mut specimen) = bar.build() else {
            return vec![true];
        };
        for point in 0..specimen.len() - 1 {
            specimen.set(|id| [if id == point { 1e-9 } else { 0.0 }, 0.0, 0.0]);
            if specimen.step(1e-3).is_err() {
                return vec![true];
            }
            all.push(specimen.get()[point + 1][1] == 0.0);
        }
    }
    all
}

/// The stretch at which neighbours first part, and that at which all have.
fn predicted(method: Method, points: u32) -> (f64, f64) {
    if method.is_total() {
        return (f64::INFINITY, f64::INFINITY);
    }
    let empty = crate::input::Document::parse("", &[]);
    let spacing = 1.0 / f64::from(points);
    let choice = BasisChoice::read(method.basis, &mut empty.root());
    let width = choice.map_or(f64::NAN, |basis| basis.visit(Width { spacing }));
    ((width - 1.0) / spacing, width / spacing)
}

/// The width of a shape function in cells, in the middle of the grid.
struct Width {
    spacing: f64,
}

impl BasisVisitor for Width {
    type Output = f64;

    fn visit<const N: usize, B: Basis<N>>(self, basis: B) -> f64 {
        let basis = basis.for_spacing(self.spacing);
        let (cells, node) = (16, 8);
        let holds = |x: f64| {
            let axis = basis.axis(x, cells);
            (0..N).any(|k| axis.first + k as i32 == node && axis.weight[k] > 0.0)
        };
        let steps = 16 * 1024;
        let inside = (0..steps).filter(|i| holds((f64::from(*i) + 0.5) / 1024.0));
        inside.count() as f64 / 1024.0
    }

    /// Domains touch until they may not grow any more; then they are as wide as they may be.
    fn visit_domains<const N: usize, B: Basis<N>>(self, _: B) -> f64 {
        f64::from(2 * Cpdi::REACH + 2)
    }
}
