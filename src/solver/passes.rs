//! Passes over the points, block by block: on one thread or several, with wide instructions or without, always with the same
//! order of additions at every node.

use super::kernels::Context;
use super::mpm::Mpm;
use super::stencil::{CHUNK, Columns, Gathered, Rates, Reach, Scattered, Sources, Tile, Wanted};
use crate::grid::{Block, Node};
use crate::material::{Increments, MaterialPoints, StressMut};
use crate::state::{Body, State};
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

fn for_each(count: usize, points_each: usize, parallel: bool, work: impl Fn(usize) + Send + Sync) {
    if parallel && count > 1 {
        (0..count)
            .into_par_iter()
            .with_min_len((POINTS_PER_TASK / points_each.max(1)).max(1))
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
            wide: self.wide,
        }
    }

    /// The columns of a body, which has as many points as when it was sorted.
    fn columns(&self, index: usize, body: &mut Body<D>) -> Columns<D> {
        let count = self.blocks.bodies[index]
            .blocks
            .last()
            .map_or(0, |block| block.points().end);
        Columns::new(&mut body.particles, count, self.kernels.affine())
    }

    /// Zeroes the nodes that the step will add to.
    pub(super) fn clear_grid(&mut self) {
        // `second` is filled anew where it is used
        for array in [&mut self.main, &mut self.change, &mut self.external] {
            clear(array, &self.blocks.rows, self.parallel);
        }
    }

    /// Momenta, masses and internal forces.
    pub(super) fn points_to_grid(&mut self, state: &mut State<D>, dt: f64) {
        let (main, force) = (
            Target(self.main.as_mut_ptr()),
            Target(self.change.as_mut_ptr()),
        );
        self.scatter_pass(
            state,
            dt,
            Scattered {
                momentum: true,
                force: true,
            },
            main,
            force,
        );
    }

    /// Momenta and masses.
    pub(super) fn momenta_to_grid(&mut self, state: &mut State<D>, dt: f64) {
        let (main, force) = (
            Target(self.main.as_mut_ptr()),
            Target(self.change.as_mut_ptr()),
        );
        self.scatter_pass(
            state,
            dt,
            Scattered {
                momentum: true,
                force: false,
            },
            main,
            force,
        );
    }

    /// Internal forces.
    pub(super) fn forces_to_grid(&mut self, state: &mut State<D>, dt: f64) {
        let (main, force) = (
            Target(self.main.as_mut_ptr()),
            Target(self.change.as_mut_ptr()),
        );
        self.scatter_pass(
            state,
            dt,
            Scattered {
                momentum: false,
                force: true,
            },
            main,
            force,
        );
    }

    /// Momenta and masses, into the second array.
    pub(super) fn momenta_to_grid_again(&mut self, state: &mut State<D>, dt: f64) {
        clear(&mut self.second, &self.blocks.rows, self.parallel);
        let (second, force) = (
            Target(self.second.as_mut_ptr()),
            Target(self.change.as_mut_ptr()),
        );
        self.scatter_pass(
            state,
            dt,
            Scattered {
                momentum: true,
                force: false,
            },
            second,
            force,
        );
    }

    fn scatter_pass(
        &self,
        state: &mut State<D>,
        dt: f64,
        what: Scattered,
        main: Target,
        force: Target,
    ) {
        for (index, body) in state.bodies.iter_mut().enumerate() {
            let columns = self.columns(index, body);
            let context = self.context(index, dt);
            let own = &self.blocks.bodies[index];
            let points_each = body.particles.len() / own.blocks.len().max(1);
            for colour in &own.colours {
                for_each(colour.len(), points_each, self.parallel, |i| {
                    let block = &own.blocks[colour[i] as usize];
                    // SAFETY: blocks of one colour share no node and no row; the tile of a block is stored
                    unsafe {
                        self.kernels.scatter(
                            &context,
                            &columns,
                            block,
                            what,
                            [main.pointer(), force.pointer()],
                        )
                    };
                });
            }
        }
    }

    /// Forces of loads.
    pub(super) fn loads_to_grid(&mut self, state: &mut State<D>, dt: f64) {
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
            let columns = self.columns(index, &mut state.bodies[index]);
            let context = self.context(index, dt);
            let own = &self.blocks.bodies[index];
            let offset = loads.offset(load);
            for colour in &own.colours {
                for_each(colour.len(), POINTS_PER_TASK / 4, self.parallel, |i| {
                    let block = &own.blocks[colour[i] as usize];
                    let forces = loads.in_rows(load, block.points());
                    if !forces.is_empty() {
                        // SAFETY: as for the points' momenta
                        unsafe {
                            self.kernels.scatter_forces(
                                &context,
                                &columns,
                                block,
                                external.pointer(),
                                &offset,
                                forces,
                            )
                        };
                    }
                });
            }
        }
        self.loads = loads;
    }

    /// Update stress last: velocities, positions and stresses from the velocities at the end of the step.
    pub(super) fn move_and_strain_points(
        &mut self,
        state: &mut State<D>,
        dt: f64,
        from: &Sources,
    ) -> Gathered {
        let what = Wanted {
            velocity: true,
            position: true,
            rate: true,
            same: true,
        };
        self.gather_pass(state, dt, what, from)
    }

    /// Velocities and positions.
    pub(super) fn move_points(
        &mut self,
        state: &mut State<D>,
        dt: f64,
        from: &Sources,
    ) -> Gathered {
        let what = Wanted {
            velocity: true,
            position: true,
            rate: false,
            same: false,
        };
        self.gather_pass(state, dt, what, from)
    }

    /// Velocities.
    pub(super) fn accelerate_points(
        &mut self,
        state: &mut State<D>,
        dt: f64,
        from: &Sources,
    ) -> Gathered {
        let what = Wanted {
            velocity: true,
            position: false,
            rate: false,
            same: false,
        };
        self.gather_pass(state, dt, what, from)
    }

    /// Stresses from the second velocities.
    pub(super) fn strain_points(
        &mut self,
        state: &mut State<D>,
        dt: f64,
        from: &Sources,
    ) -> Gathered {
        let what = Wanted {
            velocity: false,
            position: false,
            rate: true,
            same: false,
        };
        self.gather_pass(state, dt, what, from)
    }

    /// Positions from the velocities at the end of the step, stresses from the second velocities.
    pub(super) fn move_points_and_strain_by_second(
        &mut self,
        state: &mut State<D>,
        dt: f64,
        from: &Sources,
    ) -> Gathered {
        let what = Wanted {
            velocity: false,
            position: true,
            rate: true,
            same: false,
        };
        self.gather_pass(state, dt, what, from)
    }

    fn gather_pass(
        &mut self,
        state: &mut State<D>,
        dt: f64,
        what: Wanted,
        from: &Sources,
    ) -> Gathered {
        let mut results = std::mem::take(&mut self.gathered);
        let mut total = Gathered::NONE;
        let from = Readable(*from);
        for (index, body) in state.bodies.iter_mut().enumerate() {
            let columns = self.columns(index, body);
            let material = &*body.material;
            let context = self.context(index, dt);
            let blocks = &self.blocks.bodies[index].blocks;
            let points_each = body.particles.len() / blocks.len().max(1);
            let shift = self.kernels.shift(index);
            results.clear();
            results.resize(blocks.len(), Gathered::NONE);
            let work = |block: &Block<D>| {
                self.gather_block(
                    &context,
                    &columns,
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
                    .with_min_len((POINTS_PER_TASK / points_each.max(1)).max(1))
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
        let mut rates = Rates::zeros();
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
                // SAFETY: these rows belong to this block alone
                unsafe {
                    let (plane, hoop, hoop_stretches) = columns.law_columns(first, count);
                    let increments = Increments {
                        rates: &rates.gradient[..count],
                        hoop_rates: &rates.hoop[..hoop_stretches.len()],
                        hoop_stretches,
                        dt: context.dt,
                    };
                    material.update(first..first + count, StressMut { plane, hoop }, &increments);
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
