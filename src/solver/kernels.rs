//! The kernels of one basis and one transfer behind one interface, so that everything around them exists once a dimension.
//!
//! This is where the types of a run end: a virtual call for a block of points, none for a point.

use super::stencil::{
    Columns, Gathered, Pass, Rates, Reach, Scattered, Sources, Tile, Wanted, exchange, gather,
    scatter, scatter_forces,
};
use crate::basis::Basis;
use crate::grid::{Block, Geometry, Node};
use crate::math::{Matrix, Vector};
use crate::real::{Instructions, Portable};
use crate::transfer::Transfer;
use std::ops::Range;

/// What a pass over a body's points works with.
#[derive(Clone, Copy)]
pub struct Context<'a, const D: usize> {
    /// The grid.
    pub geometry: &'a Geometry<D>,
    /// Index of the body.
    pub body: usize,
    /// Nodes along an edge of a block.
    pub edge: i32,
    /// Δt, s.
    pub dt: f64,
    /// Which instructions to use; only what the processor has.
    pub instructions: Instructions,
}

/// A basis and a transfer.
pub trait Kernels<const D: usize>: Send + Sync {
    /// Nodes along each axis of a stencil.
    fn nodes(&self) -> usize;

    /// Position of node `index` of an axis, in cells.
    fn position(&self, index: i32, cells: i32) -> f64;

    /// Where stencils of a body start relative to their point, in cells.
    fn shift(&self, body: usize) -> [f64; D];

    /// The last node at which a stencil starts; the first of a point is floor(x + shift), x in cells, or this one.
    fn last_start(&self, body: usize, cells: &[i32; D]) -> [i32; D];

    /// Σ N_i (x_i − x) (x_i − x)ᵀ, in cells², for a point of a body; `deformed` is the deformation gradient of its domain, if it
    /// has one.
    fn inertia(
        &self,
        body: usize,
        x: &[f64; D],
        deformed: Option<&Matrix<D>>,
        cells: &[i32; D],
    ) -> Matrix<D>;

    /// The transfer's share of the points' own velocity.
    fn ratio(&self) -> f64;

    /// Whether forces are stored apart from momenta.
    fn change(&self) -> bool;

    /// Whether points carry an affine velocity field.
    fn affine(&self) -> bool;

    /// [`scatter`] for one block.
    ///
    /// # Safety
    /// As there.
    unsafe fn scatter(
        &self,
        context: &Context<'_, D>,
        columns: &Columns<D>,
        block: &Block<D>,
        what: Scattered,
        targets: [*mut Node; 2],
    );

    /// [`scatter_forces`] for one block.
    ///
    /// # Safety
    /// As there.
    unsafe fn scatter_forces(
        &self,
        context: &Context<'_, D>,
        columns: &Columns<D>,
        block: &Block<D>,
        nodes: *mut Node,
        offset: &Vector<D>,
        forces: &[(u32, Vector<D>)],
    );

    /// [`exchange`] for one block.
    ///
    /// # Safety
    /// As there.
    unsafe fn exchange(
        &self,
        context: &Context<'_, D>,
        columns: &Columns<D>,
        block: &Block<D>,
        sources: &Sources,
        second: *mut Node,
    ) -> Gathered;

    /// [`gather`] for some rows of a block.
    ///
    /// # Safety
    /// As there.
    #[allow(clippy::too_many_arguments)]
    unsafe fn gather(
        &self,
        context: &Context<'_, D>,
        columns: &Columns<D>,
        tile: &Tile<D>,
        reach: &Reach<D>,
        rows: Range<usize>,
        what: Wanted,
        sources: &Sources,
        rates: &mut Rates<D>,
    ) -> Gathered;
}

/// The kernels for a basis of `N` nodes and a transfer.
pub struct Stencils<const D: usize, const N: usize, B, T> {
    /// The basis as the grid sees it.
    pub nodes: B,
    /// The basis of each body along each axis.
    pub basis: Vec<[B; D]>,
    /// The transfer.
    pub transfer: T,
}

impl<const D: usize, const N: usize, B: Basis<N>, T: Transfer> Stencils<D, N, B, T> {
    fn pass(&self, context: &Context<'_, D>) -> Pass<D, B, T> {
        let basis = self.basis[context.body];
        Pass::new(context.geometry, basis, self.transfer, context.dt)
    }
}

/// Calls the version of a kernel for the given instructions.
macro_rules! with_lanes {
    ($instructions:expr, $kernel:ident($($argument:expr),* $(,)?)) => {{
        // SAFETY: wide instructions were found (`Instructions`); the rest as the caller says
        unsafe {
            match $instructions {
                #[cfg(target_arch = "x86_64")]
                Instructions::Widest => widest::$kernel::<D, N, B, T>($($argument),*),
                #[cfg(target_arch = "x86_64")]
                Instructions::Wide => wide::$kernel::<D, N, B, T>($($argument),*),
                _ => $kernel::<Portable, D, N, B, T>($($argument),*),
            }
        }
    }};
}

impl<const D: usize, const N: usize, B: Basis<N>, T: Transfer> Kernels<D> for Stencils<D, N, B, T> {
    fn nodes(&self) -> usize {
        N
    }

    fn position(&self, index: i32, cells: i32) -> f64 {
        self.nodes.position(index, cells)
    }

    fn shift(&self, body: usize) -> [f64; D] {
        self.basis[body].map(|basis| basis.shift())
    }

    fn last_start(&self, body: usize, cells: &[i32; D]) -> [i32; D] {
        std::array::from_fn(|a| self.basis[body][a].count(cells[a]) - N as i32)
    }

    fn inertia(
        &self,
        body: usize,
        x: &[f64; D],
        _: Option<&Matrix<D>>,
        cells: &[i32; D],
    ) -> Matrix<D> {
        Matrix::from_diagonal(&Vector::from_fn(|a, _| {
            let basis = &self.basis[body][a];
            let axis = basis.axis(x[a], cells[a]);
            let arm = |i: usize| basis.position(axis.first + i as i32, cells[a]) - x[a];
            (0..N).map(|i| axis.weight[i] * arm(i) * arm(i)).sum()
        }))
    }

    fn ratio(&self) -> f64 {
        self.transfer.ratio()
    }

    fn change(&self) -> bool {
        T::CHANGE
    }

    fn affine(&self) -> bool {
        T::AFFINE
    }

    unsafe fn scatter(
        &self,
        context: &Context<'_, D>,
        columns: &Columns<D>,
        block: &Block<D>,
        what: Scattered,
        targets: [*mut Node; 2],
    ) {
        let pass = self.pass(context);
        let [main, force] = targets;
        with_lanes!(
            context.instructions,
            scatter(&pass, columns, block, context.edge, what, main, force)
        );
    }

    unsafe fn scatter_forces(
        &self,
        context: &Context<'_, D>,
        columns: &Columns<D>,
        block: &Block<D>,
        nodes: *mut Node,
        offset: &Vector<D>,
        forces: &[(u32, Vector<D>)],
    ) {
        let pass = self.pass(context);
        // SAFETY: as the caller says; loaded points are few, so that wide instructions bring nothing
        unsafe {
            scatter_forces::<Portable, D, N, B, T>(
                &pass,
                columns,
                block,
                context.edge,
                nodes,
                offset,
                forces,
            )
        }
    }

    unsafe fn exchange(
        &self,
        context: &Context<'_, D>,
        columns: &Columns<D>,
        block: &Block<D>,
        sources: &Sources,
        second: *mut Node,
    ) -> Gathered {
        let pass = self.pass(context);
        with_lanes!(
            context.instructions,
            exchange(&pass, columns, block, context.edge, sources, second)
        )
    }

    unsafe fn gather(
        &self,
        context: &Context<'_, D>,
        columns: &Columns<D>,
        tile: &Tile<D>,
        reach: &Reach<D>,
        rows: Range<usize>,
        what: Wanted,
        sources: &Sources,
        rates: &mut Rates<D>,
    ) -> Gathered {
        let pass = self.pass(context);
        with_lanes!(
            context.instructions,
            gather(&pass, columns, tile, reach, rows, what, sources, rates)
        )
    }
}

/// The kernels of `stencil`, compiled for wide instructions.
#[cfg(target_arch = "x86_64")]
macro_rules! compiled_for {
    ($module:ident, $most:ident, $features:literal) => {
        mod $module {
            use super::*;
            use crate::real::$most as Most;

            #[target_feature(enable = $features)]
            pub unsafe fn scatter<const D: usize, const N: usize, B: Basis<N>, T: Transfer>(
                pass: &Pass<D, B, T>,
                columns: &Columns<D>,
                block: &Block<D>,
                edge: i32,
                what: Scattered,
                main: *mut Node,
                force: *mut Node,
            ) {
                // SAFETY: passed on to the caller
                unsafe {
                    super::scatter::<Most, D, N, B, T>(
                        pass, columns, block, edge, what, main, force,
                    )
                }
            }

            #[target_feature(enable = $features)]
            pub unsafe fn exchange<const D: usize, const N: usize, B: Basis<N>, T: Transfer>(
                pass: &Pass<D, B, T>,
                columns: &Columns<D>,
                block: &Block<D>,
                edge: i32,
                sources: &Sources,
                second: *mut Node,
            ) -> Gathered {
                // SAFETY: passed on to the caller
                unsafe {
                    super::exchange::<Most, D, N, B, T>(pass, columns, block, edge, sources, second)
                }
            }

            #[target_feature(enable = $features)]
            #[allow(clippy::too_many_arguments)]
            pub unsafe fn gather<const D: usize, const N: usize, B: Basis<N>, T: Transfer>(
                pass: &Pass<D, B, T>,
                columns: &Columns<D>,
                tile: &Tile<D>,
                reach: &Reach<D>,
                rows: Range<usize>,
                what: Wanted,
                sources: &Sources,
                rates: &mut Rates<D>,
            ) -> Gathered {
                // SAFETY: passed on to the caller
                unsafe {
                    super::gather::<Most, D, N, B, T>(
                        pass, columns, tile, reach, rows, what, sources, rates,
                    )
                }
            }
        }
    };
}

#[cfg(target_arch = "x86_64")]
compiled_for!(wide, Avx, "avx2,fma");
#[cfg(target_arch = "x86_64")]
compiled_for!(widest, Avx512, "avx2,fma,avx512f,avx512vl,avx512dq");
