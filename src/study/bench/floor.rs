//! The bytes that a step has to move for each point, however well it is programmed: what the roofline floor is made of.

use crate::grid::Node;
use crate::math::packed_len;
use crate::scenario::{Scenario, Scheme};
use crate::state::State;
use crate::transfer::{Transfer, TransferVisitor};

/// Bytes between memory and processor for one point and step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Traffic {
    /// Columns of the points: every pass over them reads what it needs and writes what it changes, once.
    pub points: f64,
    /// Nodes under the points: each array is written once and read once; that a step touches them more often is for the caches.
    pub nodes: f64,
}

impl Traffic {
    /// Both, bytes.
    pub fn total(&self) -> f64 {
        self.points + self.nodes
    }
}

struct Traits {
    affine: bool,
    /// Whether the points' own velocity survives, so that it has to be read before it is written.
    reads: bool,
}

struct Look;

impl TransferVisitor for Look {
    type Output = Traits;
    fn visit<T: Transfer>(self, transfer: T) -> Traits {
        Traits {
            affine: T::AFFINE,
            reads: transfer.ratio() > 0.0,
        }
    }
}

/// What a step of a scene with one body has to move.
pub fn traffic<const D: usize>(
    scenario: &Scenario,
    state: &State<D>,
    bytes_per_node: usize,
) -> Traffic {
    let body = &state.bodies[0];
    let law = &scenario.materials[scenario.bodies[0].material].law;
    let traits = scenario.method.transfer.visit(Look);
    let vector = 8 * D;
    let affine = if traits.affine { 8 * D * D } else { 0 };
    let stress = 8 * packed_len(D);
    // one number where all points have the same
    let mass = body.particles.mass.bytes_per_point();
    // positions are read by every pass
    let momenta = vector + mass + affine;
    let forces = match scenario.method.update {
        // a pass of their own, and volumes are masses over the density
        Scheme::UpdateStressFirst => mass + stress,
        Scheme::UpdateStressLast | Scheme::ModifiedUpdateStressLast => stress,
    };
    let velocity = vector * if traits.reads { 2 } else { 1 } + affine;
    let position = vector;
    // what follows from the deformation alone need not be read before it is written
    let strain =
        stress * if law.is_hyperelastic() { 1 } else { 2 } + 2 * body.material.bytes_per_point();
    let passes = match scenario.method.update {
        Scheme::UpdateStressLast => 2,
        Scheme::UpdateStressFirst | Scheme::ModifiedUpdateStressLast => 4,
    };
    let again = match scenario.method.update {
        Scheme::ModifiedUpdateStressLast => momenta,
        _ => 0,
    };
    // each term more reads where points are and what they weigh
    let terms = scenario.method.transfer.terms() as usize - 1;
    let series = terms * (vector + mass);
    let points = passes * vector + momenta + forces + velocity + position + strain + again + series;
    let per_cell: f64 = scenario.bodies[0]
        .particles_per_cell
        .iter()
        .map(|n| f64::from(*n))
        .product();
    debug_assert_eq!(bytes_per_node % size_of::<Node>(), 0);
    Traffic {
        points: points as f64,
        nodes: 2.0 * bytes_per_node as f64 / per_cell,
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Case, Order};
    use super::*;
    use crate::run::build;

    #[test]
    fn a_step_of_apic_in_three_dimensions_moves_what_can_be_counted_by_hand() {
        let case = Case {
            dimension: 3,
            basis: "quadratic".into(),
            transfer: "apic".into(),
            update: "usl".into(),
            law: "neo_hookean".into(),
            particles: 1000,
            order: Order::Lattice,
            threads: 1,
        };
        let scenario = case.scenario().unwrap_or_else(|error| panic!("{error}"));
        let scene = build::<3>(&scenario);
        let memory = scene.state.bodies[0].material.bytes_per_point();
        let moved = traffic(&scenario, &scene.state, 32);
        // to the grid: x, v, C, τ (all points have one mass); back: x, v, C, x again, τ, memory twice
        let to_grid = 24 + 24 + 72 + 48;
        let back = 24 + 24 + 72 + 24 + 48 + 2 * memory;
        assert_eq!(moved.points, (to_grid + back) as f64);
        assert_eq!(moved.nodes, 8.0);
    }
}
