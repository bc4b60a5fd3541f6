//! How many grid nodes that a body reaches each boundary holds, before the first step.

use crate::basis::{Basis, BasisVisitor};
use crate::scenario::{Region, Scenario};
use crate::state::State;
use std::collections::BTreeSet;

/// For each boundary the nodes of its region that have mass at the start.
pub fn held_nodes<const D: usize>(scenario: &Scenario, state: &State<D>) -> Vec<usize> {
    scenario.method.basis.visit(Reach { scenario, state })
}

/// Nodes of the whole grid.
pub fn node_count(scenario: &Scenario) -> f64 {
    struct Count<'a>(&'a [i32]);
    impl BasisVisitor for Count<'_> {
        type Output = f64;
        fn visit<const N: usize, B: Basis<N>>(self, basis: B) -> f64 {
            let count = |cells: &i32| f64::from(basis.count(*cells));
            self.0.iter().map(count).product()
        }
    }
    scenario.method.basis.visit(Count(&scenario.grid.cells))
}

struct Reach<'a, const D: usize> {
    scenario: &'a Scenario,
    state: &'a State<D>,
}

impl<const D: usize> BasisVisitor for Reach<'_, D> {
    type Output = Vec<usize>;

    fn visit<const N: usize, B: Basis<N>>(self, basis: B) -> Vec<usize> {
        let grid = &self.scenario.grid;
        let regions = self.scenario.boundaries.iter().map(|spec| &spec.on);
        let ranges: Vec<[[i32; 2]; D]> = regions.map(|on| self.range(&basis, on)).collect();
        let mut held = vec![BTreeSet::new(); ranges.len()];
        for body in &self.state.bodies {
            let own: [B; D] =
                std::array::from_fn(|a| basis.for_spacing(body.spacing[a] / grid.cell_size));
            for position in body.particles.grid_position() {
                let axes: [_; D] = std::array::from_fn(|a| {
                    let x = (position[a] - grid.min[a]) / grid.cell_size;
                    own[a].axis(x.clamp(0.0, f64::from(grid.cells[a])), grid.cells[a])
                });
                for (range, held) in ranges.iter().zip(&mut held) {
                    let apart = |a: usize| {
                        axes[a].first > range[a][1] || axes[a].first + (N as i32) <= range[a][0]
                    };
                    if (0..D).any(apart) {
                        continue;
                    }
                    for number in 0..N.pow(D as u32) {
                        let mut rest = number;
                        let mut node = [0; D];
                        let mut inside = true;
                        for a in 0..D {
                            let k = rest % N;
                            rest /= N;
                            node[a] = axes[a].first + k as i32;
                            inside &= axes[a].weight[k] > 0.0
                                && (range[a][0]..=range[a][1]).contains(&node[a]);
                        }
                        if inside {
                            held.insert(node);
                        }
                    }
                }
            }
        }
        held.iter().map(BTreeSet::len).collect()
    }
}

impl<const D: usize> Reach<'_, D> {
    /// First and last node of a region along each axis.
    fn range<const N: usize, B: Basis<N>>(&self, basis: &B, on: &Region) -> [[i32; 2]; D] {
        let grid = &self.scenario.grid;
        std::array::from_fn(|a| {
            let (low, high) = match on {
                Region::Box { min, max } => (min[a], max[a]),
                Region::Side(side) if side.axis != a => (f64::NEG_INFINITY, f64::INFINITY),
                Region::Side(side) if side.upper => (grid.max[a], f64::INFINITY),
                Region::Side(_) => (f64::NEG_INFINITY, grid.min[a]),
            };
            let cells = |x: f64| (x - grid.min[a]) / grid.cell_size;
            let (low, high) = (cells(low) - 1e-9, cells(high) + 1e-9);
            let position = |index: i32| basis.position(index, grid.cells[a]);
            let count = basis.count(grid.cells[a]);
            // only grids with very many cells along one axis make this slow, and then by milliseconds
            let first = (0..count).find(|&i| position(i) >= low).unwrap_or(count);
            let last = (first..count)
                .take_while(|&i| position(i) <= high)
                .last()
                .unwrap_or(first - 1);
            [first, last]
        })
    }
}
