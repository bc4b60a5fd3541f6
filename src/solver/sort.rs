//! Keeps the points of each body ordered by the block of the grid that they are in, and within it by cell.

use super::cells::{Places, order_block};
use super::disjoint::Disjoint;
use super::integrate::Constraint;
use super::kernels::Kernels;
use super::mpm::Mpm;
use super::{Fault, Place};
use crate::grid::{Geometry, LARGE_EDGE, Occupied, Row, block_edge};
use crate::math::Vector;
use crate::reorder;
use crate::state::{Body, Particles, State};
use rayon::prelude::*;

/// Memory that a sort needs, kept from one to the next.
#[derive(Default)]
pub struct Scratch<const D: usize> {
    /// Block of each point, later the row that it goes to.
    slots: Vec<u32>,
    /// The rows in the order in which they are moved, see [`reorder::cycles`].
    order: Vec<u32>,
    leaders: Vec<u32>,
    /// The distinct blocks.
    keys: Vec<[i32; D]>,
    pieces: Vec<Piece<D>>,
    /// For each body, its blocks and the rows in each.
    occupied: Vec<Vec<Occupied<D>>>,
}

/// What one thread finds out about consecutive points.
#[derive(Default)]
struct Piece<const D: usize> {
    /// The blocks that they are in.
    keys: Vec<[i32; D]>,
    /// How many may be noted before the list is tidied.
    limit: usize,
    /// For each block how many of them are in it, later the row that the next one goes to.
    starts: Vec<u32>,
    /// The first that has no place in the grid.
    lost: Option<usize>,
}

impl<const D: usize> Piece<D> {
    /// Notes a block. The list is tidied whenever it has doubled, so that points in any order make it no longer than that.
    #[inline(always)]
    fn note(&mut self, key: [i32; D]) {
        if self.keys.last() != Some(&key) {
            self.append(key);
        }
    }

    fn append(&mut self, key: [i32; D]) {
        if self.keys.len() >= self.limit.max(PIECE) {
            self.tidy();
            self.limit = 2 * self.keys.len();
        }
        self.keys.push(key);
    }

    fn tidy(&mut self) {
        self.keys.sort_unstable();
        self.keys.dedup();
    }
}

/// Points from which on sorting them is shared among threads.
const PIECE: usize = 1 << 13;

/// Points from which on large blocks are looked at, where the grid has one array, and four times as many where it has more: fewer
/// leave the caches so little work that nothing is won, and large blocks take more memory a point.
const MANY: usize = 750_000;

/// Points that large blocks must hold on average. Blocks around them have as many nodes, which cost as much as these points when
/// nobody fills them.
const FILLED: usize = 256;

impl<const D: usize> Mpm<D> {
    /// Sorts all bodies by block and lays the grid out around them.
    ///
    /// # Errors
    /// If a point is not finite or not inside the grid.
    pub(super) fn sort(&mut self, state: &mut State<D>) -> Result<(), Fault> {
        let mut scratch = std::mem::take(&mut self.scratch);
        scratch.occupied.resize_with(state.bodies.len(), Vec::new);
        let (time, step) = (state.time, state.step);
        let mut collected = self.choose_edge(state, &mut scratch);
        let mut result = Ok(());
        for (index, body) in state.bodies.iter_mut().enumerate() {
            result = self
                .sort_body(index, body, collected.take(), &mut scratch)
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
            self.grouping.begin();
        }
        self.scratch = scratch;
        result
    }

    /// Where the points of a body are counted to.
    fn places(&self, body: usize) -> Places<'_, D> {
        let geometry = &self.geometry;
        Places {
            geometry,
            inverse: 1.0 / geometry.cell_size,
            shift: self.kernels.shift(body),
            last: self.kernels.last_start(body, &geometry.cells),
            exponent: self.edge.ilog2(),
        }
    }

    /// Sorts one body, or names the row of a point that has no place in the grid.
    ///
    /// A counting sort by block. Pieces of the body are looked at by several threads; where each of their points goes follows
    /// from how many come before it, so that the result does not depend on the pieces.
    fn sort_body(
        &self,
        index: usize,
        body: &mut Body<D>,
        collected: Option<usize>,
        scratch: &mut Scratch<D>,
    ) -> Result<(), usize> {
        let Scratch {
            slots,
            order,
            leaders,
            keys,
            pieces,
            occupied,
        } = scratch;
        let count = body.particles.len();
        let size = match collected {
            Some(size) => size,
            None => self.collect_blocks(index, &body.particles, keys, pieces)?,
        };
        let pieces = &mut pieces[..count.div_ceil(size)];
        slots.resize(count, 0);
        self.count_blocks(index, &body.particles, size, keys, pieces, slots);
        let blocks = &mut occupied[index];
        blocks.clear();
        let mut next = 0;
        for (slot, key) in keys.iter().enumerate() {
            let first = next;
            for piece in &mut *pieces {
                let own = piece.starts[slot];
                piece.starts[slot] = next;
                next += own;
            }
            blocks.push((*key, (first, next)));
        }
        let aim = |(piece, slots): (&mut Piece<D>, &mut [u32])| {
            for slot in slots {
                let target = &mut piece.starts[*slot as usize];
                *slot = *target;
                *target += 1;
            }
        };
        if pieces.len() > 1 {
            let pieces = pieces.par_iter_mut().zip(slots.par_chunks_mut(size));
            pieces.for_each(aim);
        } else {
            pieces.iter_mut().zip(slots.chunks_mut(size)).for_each(aim);
        }
        // room for all, or a later sort that moves more points would ask for memory
        order.clear();
        order.reserve_exact(count);
        if D > 1 {
            self.order_cells(index, &body.particles, blocks, slots, order);
        }
        reorder::cycles(slots, order, leaders);
        if !order.is_empty() {
            let (particles, material) = (&mut body.particles, &mut body.material);
            if self.parallel {
                rayon::join(
                    || particles.permute(order, leaders, true),
                    || material.permute(order, leaders),
                );
            } else {
                particles.permute(order, leaders, false);
                material.permute(order, leaders);
            }
        }
        Ok(())
    }

    /// Orders the points of each block, see [`order_block`]. `slots` has the rows that points go to, `order` is for working.
    fn order_cells(
        &self,
        index: usize,
        particles: &Particles<D>,
        blocks: &[Occupied<D>],
        slots: &mut [u32],
        order: &mut Vec<u32>,
    ) {
        order.resize(slots.len(), 0);
        for (row, slot) in slots.iter().enumerate() {
            order[*slot as usize] = row as u32;
        }
        let positions = particles.grid_position();
        let slots = Disjoint::new(slots);
        let places = self.places(index);
        let order_one = |&(_, (first, end)): &Occupied<D>| {
            let rows = &order[first as usize..end as usize];
            // SAFETY: every row is in one block only, and one thread orders a block
            unsafe { order_block(&places, positions, rows, first, &slots) };
        };
        if self.parallel && blocks.len() > 1 {
            blocks.par_iter().for_each(order_one);
        } else {
            blocks.iter().for_each(order_one);
        }
    }

    /// Edge of the blocks for points as they stand: a large one where they are many and fill such blocks. If that has found the
    /// blocks of the only body, returns the size of pieces as [`Self::collect_blocks`] does.
    fn choose_edge(&mut self, state: &State<D>, scratch: &mut Scratch<D>) -> Option<usize> {
        let least = block_edge(D, self.kernels.nodes());
        let points: usize = state.bodies.iter().map(|body| body.particles.len()).sum();
        // each array of the grid has nodes of blocks that no point fills
        let one_array = !(self.kernels.change() || self.has_second() || self.has_terms());
        let many = if one_array { MANY } else { 4 * MANY };
        self.edge = least;
        if D < 3 || points < many {
            return None;
        }
        self.edge = LARGE_EDGE;
        let (keys, pieces) = (&mut scratch.keys, &mut scratch.pieces);
        let mut blocks = 0;
        let mut collected = None;
        for (index, body) in state.bodies.iter().enumerate() {
            // a point without a place is for the sort to name
            collected = self
                .collect_blocks(index, &body.particles, keys, pieces)
                .ok();
            if collected.is_some() {
                blocks += keys.len();
            }
        }
        if points < FILLED * blocks {
            self.edge = least;
            return None;
        }
        collected.filter(|_| state.bodies.len() == 1)
    }

    /// Finds the blocks that a body occupies, in order, looking at pieces of it of a size that it returns; or names the first row
    /// whose point has no place in the grid.
    fn collect_blocks(
        &self,
        index: usize,
        particles: &Particles<D>,
        keys: &mut Vec<[i32; D]>,
        pieces: &mut Vec<Piece<D>>,
    ) -> Result<usize, usize> {
        let count = particles.len();
        let threads = if self.parallel {
            rayon::current_num_threads()
        } else {
            1
        };
        let size = count.div_ceil(threads).max(PIECE);
        pieces.resize_with(count.div_ceil(size).max(pieces.len()), Piece::default);
        let pieces = &mut pieces[..count.div_ceil(size)];
        self.find_blocks(index, particles, size, pieces)?;
        keys.clear();
        for piece in &mut *pieces {
            keys.extend_from_slice(&piece.keys);
        }
        keys.sort_unstable();
        keys.dedup();
        Ok(size)
    }

    /// Collects the blocks of each piece, or names the first row whose point has no place in the grid.
    fn find_blocks(
        &self,
        index: usize,
        particles: &Particles<D>,
        size: usize,
        pieces: &mut [Piece<D>],
    ) -> Result<(), usize> {
        let positions = particles.grid_position();
        let places = self.places(index);
        let look = |(number, piece): (usize, &mut Piece<D>)| {
            piece.keys.clear();
            piece.lost = None;
            for row in number * size..((number + 1) * size).min(particles.len()) {
                let position = &positions[row];
                // where points stay in the grid, their present positions say nothing else
                let motion = particles.velocity[row].iter();
                let finite = motion
                    .chain(&particles.position[row])
                    .all(|x| x.is_finite());
                if !(places.holds(position) && finite) {
                    piece.lost = Some(row);
                    return;
                }
                piece.note(places.block(position));
            }
            piece.tidy();
        };
        if pieces.len() > 1 {
            pieces.par_iter_mut().enumerate().for_each(look);
        } else {
            pieces.iter_mut().enumerate().for_each(look);
        }
        pieces
            .iter()
            .find_map(|piece| piece.lost)
            .map_or(Ok(()), Err)
    }

    /// Finds the slot of each point's block among `keys` and counts the points of each piece in it.
    fn count_blocks(
        &self,
        index: usize,
        particles: &Particles<D>,
        size: usize,
        keys: &[[i32; D]],
        pieces: &mut [Piece<D>],
        slots: &mut [u32],
    ) {
        let places = self.places(index);
        let count = |((piece, slots), positions): ((&mut Piece<D>, &mut [u32]), &[Vector<D>])| {
            piece.starts.clear();
            piece.starts.resize(keys.len(), 0);
            let mut slot = 0;
            for (target, position) in slots.iter_mut().zip(positions) {
                let key = places.block(position);
                if keys[slot] != key {
                    slot = keys.partition_point(|other| other < &key);
                }
                *target = slot as u32;
                piece.starts[slot] += 1;
            }
        };
        let positions = particles.grid_position();
        if pieces.len() > 1 {
            let pieces = pieces.par_iter_mut().zip(slots.par_chunks_mut(size));
            pieces.zip(positions.par_chunks(size)).for_each(count);
        } else {
            let pieces = pieces.iter_mut().zip(slots.chunks_mut(size));
            pieces.zip(positions.chunks(size)).for_each(count);
        }
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
        if self.has_terms() {
            self.term.resize(stored, Default::default());
            self.image.resize(stored, Default::default());
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
