//! Passes over the points, block by block: on one thread or several, with wide instructions or without, always with the same
//! order of additions at every node.

use super::disjoint::Disjoint;
use super::kernels::Context;
use super::mpm::Mpm;
use super::stencil::{CHUNK, Columns, Gathered, Rates, Reach, Scattered, Sources, Tile, Wanted};
use crate::grid::{Block, BodyBlocks, Node};
use crate::material::{Increments, MaterialPoints, StressMut};
use crate::state::State;
use rayon::prelude::*;

/// Points that a task should have at least, so that handing it to a thread costs little.
const POINTS_PER_TASK: usize = 1024;

/// An array of nodes that tasks of one colour add to at the same time.
#[derive(Clone, Copy)]
struct Target(*mut Node);

impl Target {
    // a method, so that closures borrow the whole and not the pointer in it
    fn pointer(&self) -> *mut Node {
        self.0
    }
}

// SAFETY: blocks of one colour share no node (see `stencil`)
unsafe impl Send for Target {}
// SAFETY: as above
unsafe impl Sync for Target {}

/// The grid's arrays for reading.
#[derive(Clone, Copy)]
struct Readable(Sources);

impl Readable {
    // as above
    fn sources(&self) -> &Sources {
        &self.0
    }
}

// SAFETY: nobody writes to the grid while points gather from it
unsafe impl Send for Readable {}
// SAFETY: as above
unsafe impl Sync for Readable {}

/// Blocks of a body that a task should have at least.
fn blocks_per_task<const D: usize>(own: &BodyBlocks<D>) -> usize {
    (POINTS_PER_TASK * own.blocks.len() / own.points().max(1)).max(1)
}

fn for_each(
    count: usize,
    least: impl Fn() -> usize,
    parallel: bool,
    work: impl Fn(usize) + Send + Sync,
) {
    if parallel && count > 1 {
        (0..count)
            .into_par_iter()
            .with_min_len(least())
            .for_each(work);
    } else {
        (0..count).for_each(work);
    }
}

impl<const D: usize> Mpm<D> {
    fn context(&self, body: usize, dt: f64) -> Context<'_, D> {
        Context {
            geometry: &self.geometry,
            body,
            edge: self.edge,
            dt,
            instructions: self.instructions,
        }
    }

    /// Points at the columns of all bodies, which have as many points as when they were sorted.
    pub(super) fn point_at_columns(&mut self, state: &mut State<D>) {
        let affine = self.kernels.affine();
        self.columns.clear();
        for (own, body) in self.blocks.bodies.iter().zip(&mut state.bodies) {
            let columns = Columns::new(&mut body.particles, own.points(), affine);
            self.columns.push(columns);
        }
    }

    /// Zeroes the nodes that the step will add to.
    pub(super) fn clear_grid(&mut self) {
        // `second` is filled anew where it is used
        for array in [&mut self.main, &mut self.change, &mut self.external] {
            clear(array, &self.blocks.rows, self.parallel);
        }
    }

    /// What points give to the grid.
    pub(super) fn points_to_grid(&mut self, dt: f64, what: Scattered) {
        let main = Target(self.main.as_mut_ptr());
        let force = Target(self.change.as_mut_ptr());
        for (index, columns) in self.columns.iter().enumerate() {
            let context = self.context(index, dt);
            self.for_each_block(index, |_, block| {
                let targets = [main.pointer(), force.pointer()];
                // SAFETY: blocks of one colour share no node and no row; the tile of a block is stored
                unsafe {
                    self.kernels
                        .scatter(&context, columns, block, what, targets)
                };
            });
        }
    }

    /// New velocities of the points from `from`, and their momenta and masses to `second`, an array of the grid.
    pub(super) fn exchange(&mut self, dt: f64, from: &Sources, second: &mut [Node]) -> Gathered {
        clear(second, &self.blocks.rows, self.parallel);
        let second = Target(second.as_mut_ptr());
        let from = Readable(*from);
        let mut results = std::mem::take(&mut self.gathered);
        let mut total = Gathered::NONE;
        for (index, columns) in self.columns.iter().enumerate() {
            let context = self.context(index, dt);
            results.clear();
            results.resize(self.blocks.bodies[index].blocks.len(), Gathered::NONE);
            let result = Disjoint::new(&mut results);
            self.for_each_block(index, |number, block| {
                // SAFETY: as above; every block has a result of its own
                unsafe {
                    let second = second.pointer();
                    let gathered =
                        self.kernels
                            .exchange(&context, columns, block, from.sources(), second);
                    result.slice(number..number + 1)[0] = gathered;
                }
            });
            total = results.iter().fold(total, |sum, result| sum.and(*result));
        }
        self.gathered = results;
        total
    }

    /// Calls `work` with the number of each block of a body and the block, one colour after the other.
    fn for_each_block(&self, body: usize, work: impl Fn(usize, &Block<D>) + Send + Sync) {
        let own = &self.blocks.bodies[body];
        let least = || blocks_per_task(own);
        for colour in &own.colours {
            for_each(colour.len(), least, self.parallel, |i| {
                let number = colour[i] as usize;
                work(number, &own.blocks[number]);
            });
        }
    }

    /// Forces of loads.
    pub(super) fn loads_to_grid(&mut self, state: &State<D>, dt: f64) {
        if self.loads.is_empty() {
            return;
        }
        let mut loads = std::mem::replace(&mut self.loads, super::Loads::new(Vec::new()));
        loads.evaluate(state.time, |body, row| {
            state.bodies[body].particles.mass[row as usize]
        });
        let external = Target(self.external.as_mut_ptr());
        for load in 0..loads.len() {
            let index = loads.body(load);
            let columns = &self.columns[index];
            let context = self.context(index, dt);
            let offset = loads.offset(load);
            self.for_each_block(index, |_, block| {
                let forces = loads.in_rows(load, block.points());
                if !forces.is_empty() {
                    // SAFETY: as for the points' momenta
                    unsafe {
                        self.kernels.scatter_forces(
                            &context,
                            columns,
                            block,
                            external.pointer(),
                            &offset,
                            forces,
                        )
                    };
                }
            });
        }
        self.loads = loads;
    }

    /// What points take from the grid.
    pub(super) fn grid_to_points(
        &mut self,
        state: &State<D>,
        dt: f64,
        what: Wanted,
        from: &Sources,
    ) -> Gathered {
        let mut results = std::mem::take(&mut self.gathered);
        let mut total = Gathered::NONE;
        let from = Readable(*from);
        for (index, body) in state.bodies.iter().enumerate() {
            let columns = &self.columns[index];
            let material = &*body.material;
            let context = self.context(index, dt);
            let own = &self.blocks.bodies[index];
            let blocks = &own.blocks;
            let shift = self.kernels.shift(index);
            results.clear();
            results.resize(blocks.len(), Gathered::NONE);
            let work = |block: &Block<D>| {
                self.gather_block(
                    &context,
                    columns,
                    block,
                    &shift,
                    material,
                    what,
                    from.sources(),
                )
            };
            if self.parallel && blocks.len() > 1 {
                results
                    .par_iter_mut()
                    .zip(blocks)
                    .with_min_len(blocks_per_task(own))
                    .for_each(|(result, block)| *result = work(block));
            } else {
                for (result, block) in results.iter_mut().zip(blocks) {
                    *result = work(block);
                }
            }
            total = results.iter().fold(total, |sum, result| sum.and(*result));
        }
        self.gathered = results;
        total
    }

    #[allow(clippy::too_many_arguments)]
    fn gather_block(
        &self,
        context: &Context<'_, D>,
        columns: &Columns<D>,
        block: &Block<D>,
        shift: &[f64; D],
        material: &dyn MaterialPoints<D>,
        what: Wanted,
        from: &Sources,
    ) -> Gathered {
        let tile = Tile::new(block, self.edge, self.kernels.nodes());
        let reach = Reach::new(block.origin, self.edge, self.geometry.cells, *shift);
        let mut rates = Rates::default();
        let mut total = Gathered::NONE;
        let rows = block.points();
        for first in rows.clone().step_by(CHUNK) {
            let count = CHUNK.min(rows.end - first);
            let end = first + count;
            // SAFETY: blocks share no row, and nobody writes to the grid now
            let gathered = unsafe {
                self.kernels.gather(
                    context,
                    columns,
                    &tile,
                    &reach,
                    first..end,
                    what,
                    from,
                    &mut rates,
                )
            };
            total = total.and(gathered);
            if what.rate {
                // SAFETY: these rows belong to this block alone, and their gradients were just gathered
                unsafe {
                    let (plane, hoop, hoop_stretches) = columns.law_columns(first, count);
                    let (rates, hoop_rates) = rates.of(count, hoop_stretches.len());
                    let increments = Increments {
                        rates,
                        hoop_rates,
                        hoop_stretches,
                        dt: context.dt,
                        instructions: context.instructions,
                    };
                    let stress = StressMut {
                        plane,
                        hoop,
                        reference: columns.reference(first, count),
                    };
                    material.update(first..end, stress, &increments);
                }
            }
        }
        total
    }
}

fn clear<const D: usize>(array: &mut [Node], rows: &[crate::grid::Row<D>], parallel: bool) {
    if array.is_empty() {
        return;
    }
    if parallel {
        array
            .par_chunks_mut(1 << 14)
            .for_each(|chunk| chunk.fill(Node::default()));
    } else {
        for row in rows {
            array[row.start as usize..(row.start + row.len) as usize].fill(Node::default());
        }
    }
}
