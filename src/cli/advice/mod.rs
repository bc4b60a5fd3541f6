//! What would be cheaper, or safer, and as good: advice of `mpm check`, one file for each kind.
//!
//! Advice is given where it is certain from what the scenario says, not where it is likely: a scene that is uniform without
//! saying so gets none.

mod locking;
mod small_motion;
mod symmetry;
mod time_step;
mod uniform;

use crate::basis::{Basis, BasisVisitor};
use crate::scenario::{BoundarySpec, PointSet, ReferenceFrame, Scenario};
use serde::Serialize;

/// One piece of advice.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Advice {
    /// Which kind, for programs.
    pub kind: &'static str,
    /// What was noticed, and what it means.
    pub says: String,
    /// What to change in the scenario.
    pub change: String,
    /// How many times cheaper a run is expected to be; none where it is the result that is at stake.
    pub factor: Option<f64>,
}

/// What there is to judge by.
pub struct Subject<'a> {
    pub scenario: &'a Scenario,
    /// The points of every body.
    pub sets: &'a [PointSet],
    /// Time in which the fastest signal crosses a cell at the start, s.
    pub crossing_time: f64,
    /// The time step at the start, s.
    pub dt: f64,
}

/// Every kind, in the order in which they are said.
const KINDS: &[fn(&Subject) -> Vec<Advice>] = &[
    uniform::advise,
    symmetry::advise,
    small_motion::advise,
    time_step::advise,
    locking::advise,
];

/// All advice on a scene.
pub fn advise(subject: &Subject) -> Vec<Advice> {
    KINDS.iter().flat_map(|kind| kind(subject)).collect()
}

/// Names of the axes.
const AXES: [&str; 3] = ["x", "y", "z"];

/// Functions an axis that are not zero at a point.
fn stencil(scenario: &Scenario) -> i32 {
    struct Nodes;
    impl BasisVisitor for Nodes {
        type Output = i32;

        fn visit<const N: usize, B: Basis<N>>(self, _: B) -> i32 {
            N as i32
        }
    }
    scenario.method.basis.visit(Nodes)
}

/// Instructions of a point in a step with APIC and `usl`, in 1D, 2D and 3D: those that do not depend on the basis, those of a node
/// of its stencil, and those of the tensors that the total frame turns. They were counted with 2 and 3 nodes an axis
/// (docs/performance.md, "What a point costs").
const INSTRUCTIONS: [[f64; 3]; 3] = [
    [100.0, 12.5, 12.0],
    [245.0, 9.4, 42.0],
    [467.0, 13.1, 122.0],
];

/// What a point costs in a step, about, in instructions.
fn cost(nodes_an_axis: i32, dimension: usize, frame: ReferenceFrame) -> f64 {
    let [point, node, tensors] = INSTRUCTIONS[dimension - 1];
    let own = point + node * f64::from(nodes_an_axis).powi(dimension as i32);
    match frame {
        ReferenceFrame::Updated => own,
        ReferenceFrame::Total => own + tensors,
    }
}

/// `"a", "b" and "c"`.
fn quoted(names: &[&str]) -> String {
    let names: Vec<_> = names.iter().map(|name| format!("\"{name}\"")).collect();
    match names.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, rest)) => format!("{} and {last}", rest.join(", ")),
        None => String::new(),
    }
}

/// Names of boundaries for which something holds.
fn names(boundaries: &[BoundarySpec], holds: impl Fn(&BoundarySpec) -> bool) -> Vec<&str> {
    let held = boundaries.iter().filter(|spec| holds(spec));
    held.map(|spec| &spec.name[..]).collect()
}

/// Points above which the lines of a body are not looked at: sorting them would take long.
const MOST: usize = 1_000_000;

/// The points of a body, line after line along an axis, and in order along each.
fn along(points: &PointSet, axis: usize) -> Option<Vec<[f64; 3]>> {
    if points.positions.len() > MOST {
        return None;
    }
    let mut sorted = points.positions.clone();
    let key = |at: &[f64; 3]| (at[(axis + 1) % 3], at[(axis + 2) % 3], at[axis]);
    sorted.sort_unstable_by(|p, q| {
        let (p, q) = (key(p), key(q));
        p.0.total_cmp(&q.0)
            .then(p.1.total_cmp(&q.1))
            .then(p.2.total_cmp(&q.2))
    });
    Some(sorted)
}

/// Whether two points lie on one line along an axis.
fn aligned(axis: usize, p: &[f64; 3], q: &[f64; 3]) -> bool {
    (0..3).all(|a| a == axis || p[a] == q[a])
}

#[cfg(test)]
mod tests;
