//! Keeps the points of each body ordered by the block of the grid that they are in.

use super::integrate::Constraint;
use super::kernels::Kernels;
use super::mpm::Mpm;
use super::{Fault, Place};
use crate::grid::{Geometry, Occupied, Row};
use crate::math::Vector;
use crate::reorder;
use crate::state::{Body, State};

/// Memory that a sort needs, kept from one to the next.
#[derive(Default)]
pub struct Scratch<const D: usize> {
    /// Block of each point, later the order of the points.
    slots: Vec<u32>,
    order: Vec<u32>,
    leaders: Vec<u32>,
    seen: Vec<bool>,
    starts: Vec<u32>,
    keys: Vec<[i32; D]>,
    /// For each body, its blocks and the rows in each.
    occupied: Vec<Vec<Occupied<D>>>,
}

impl<const D: usize> Mpm<D> {
    /// Sorts all bodies by block and lays the grid out around them.
    ///
    /// # Errors
    /// If a point is not finite or not inside the grid.
    pub(super) fn sort(&mut self, state: &mut State<D>) -> Result<(), Fault> {
        let mut scratch = std::mem::take(&mut self.scratch);
        scratch.occupied.resize_with(state.bodies.len(), Vec::new);
        let (time, step) = (state.time, state.step);
        let mut result = Ok(());
        for (index, body) in state.bodies.iter_mut().enumerate() {
            result = self
                .sort_body(index, body, &mut scratch)
                .map_err(|row| self.fault(time, step, body, row));
            if result.is_err() {
                break;
            }
            self.loads.locate(index, &body.particles);
        }
        if result.is_ok() {
            self.blocks
                .rebuild(self.edge, &self.geometry.counts, &scratch.occupied);
            self.lay_out();
            self.needs_sort = false;
        }
        self.scratch = scratch;
        result
    }

    fn block_of(&self, body: usize, position: &Vector<D>) -> [i32; D] {
        let x = self
            .geometry
            .in_cells(position, 1.0 / self.geometry.cell_size);
        self.kernels
            .first(body, &x, &self.geometry.cells)
            .map(|first| first.div_euclid(self.edge))
    }

    /// Sorts one body, or names the row of a point that has no place in the grid.
    fn sort_body(
        &self,
        index: usize,
        body: &mut Body<D>,
        scratch: &mut Scratch<D>,
    ) -> Result<(), usize> {
        let Scratch {
            slots,
            order,
            leaders,
            seen,
            starts,
            keys,
            occupied,
        } = scratch;
        let blocks = &mut occupied[index];
        let count = body.particles.len();
        keys.clear();
        for (row, position) in body.particles.position.iter().enumerate() {
            let x = self
                .geometry
                .in_cells(position, 1.0 / self.geometry.cell_size);
            // false too if x is not a number
            let inside = (0..D).all(|a| x[a] >= 0.0 && x[a] <= f64::from(self.geometry.cells[a]));
            let finite = body.particles.velocity[row].iter().all(|v| v.is_finite());
            if !(inside && finite) {
                return Err(row);
            }
            let key = self.block_of(index, position);
            if keys.last() != Some(&key) {
                keys.push(key);
            }
        }
        keys.sort_unstable();
        keys.dedup();
        starts.clear();
        starts.resize(keys.len() + 1, 0);
        slots.clear();
        let mut slot = 0;
        for position in &body.particles.position {
            let key = self.block_of(index, position);
            if keys[slot] != key {
                slot = keys.partition_point(|other| other < &key);
            }
            slots.push(slot as u32);
            starts[slot + 1] += 1;
        }
        for slot in 0..keys.len() {
            starts[slot + 1] += starts[slot];
        }
        blocks.clear();
        blocks.extend(
            keys.iter()
                .enumerate()
                .map(|(slot, key)| (*key, (starts[slot], starts[slot + 1]))),
        );
        let sorted = slots.is_sorted();
        if !sorted {
            order.clear();
            order.resize(count, 0);
            for (row, slot) in slots.iter().enumerate() {
                let target = &mut starts[*slot as usize];
                order[*target as usize] = row as u32;
                *target += 1;
            }
            reorder::cycle_leaders(order, leaders, seen);
            body.particles.permute(order, leaders, self.parallel);
            body.material.permute(order, leaders);
        }
        Ok(())
    }

    /// Makes room for the nodes and finds those that are held.
    fn lay_out(&mut self) {
        let stored = self.blocks.stored;
        self.main.resize(stored, Default::default());
        if self.kernels.change() {
            self.change.resize(stored, Default::default());
        }
        if self.has_second() {
            self.second.resize(stored, Default::default());
        }
        if !self.loads.is_empty() {
            self.external.resize(stored, Default::default());
        }
        self.row_sums
            .resize(self.blocks.rows.len(), Default::default());
        self.constraints.clear();
        self.constraint_ranges.clear();
        for row in &self.blocks.rows {
            let first = self.constraints.len();
            for (boundary, range) in self.boundary_nodes.iter().enumerate() {
                self.constraints.extend(held(row, range).map(|offset| {
                    let mut node = row.node;
                    node[D - 1] += offset as i32;
                    Constraint {
                        boundary,
                        offset,
                        position: node_position(&self.geometry, &*self.kernels, &node),
                        impulse: Vector::zeros(),
                    }
                }));
            }
            self.constraints[first..]
                .sort_unstable_by_key(|constraint| (constraint.offset, constraint.boundary));
            self.constraint_ranges
                .push((first as u32, self.constraints.len() as u32));
        }
    }

    /// Describes the point in `row`.
    pub(super) fn place(&self, time: f64, step: u64, body: &Body<D>, row: usize) -> Place {
        let position = body.particles.position[row];
        let velocity = body.particles.velocity[row];
        Place {
            time,
            step,
            body: body.name.clone(),
            particle: body.particles.id[row],
            position: position.iter().copied().collect(),
            velocity: velocity.iter().copied().collect(),
            courant: self.last_dt * self.wave_speed / self.geometry.cell_size,
        }
    }

    /// What is wrong with the point in `row`.
    fn fault(&self, time: f64, step: u64, body: &Body<D>, row: usize) -> Fault {
        let place = self.place(time, step, body, row);
        if place
            .position
            .iter()
            .chain(&place.velocity)
            .all(|x| x.is_finite())
        {
            Fault::Escaped(place)
        } else {
            Fault::NotFinite(place)
        }
    }
}

/// Position of a node, m.
fn node_position<const D: usize>(
    g: &Geometry<D>,
    kernels: &dyn Kernels<D>,
    node: &[i32; D],
) -> Vector<D> {
    Vector::from_fn(|a, _| g.min[a] + g.cell_size * kernels.position(node[a], g.cells[a]))
}

/// The nodes of a row that lie in a box of node numbers, as offsets in the row.
fn held<const D: usize>(row: &Row<D>, range: &[(i32, i32); D]) -> std::ops::Range<u32> {
    let inside = (0..D - 1).all(|a| range[a].0 <= row.node[a] && row.node[a] <= range[a].1);
    if !inside {
        return 0..0;
    }
    let first = (range[D - 1].0 - row.node[D - 1]).clamp(0, row.len as i32);
    let last = (range[D - 1].1.saturating_add(1) - row.node[D - 1]).clamp(first, row.len as i32);
    first as u32..last as u32
}
