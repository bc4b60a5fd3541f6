//! The kernels of points whose domains deform with them (convected particle domain interpolation).
//!
//! A domain is a parallelepiped with the half-edges R = F R₀ as columns. With a sign s_a = ±1 for each edge its corners are
//! x_c = x_p + R s. The functions of a point are φ_i = mean N_i(x_c) over the corners, N_i being the hat functions of the grid,
//! and ∇φ_i = mean N_i(x_c) G_c with G_c = R⁻ᵀ s: the mean over the domain of what is N_i at the corners and multilinear in
//! between. So every corner behaves like a point of the linear basis with a 2^D-th of mass and momentum, on which the force −V τ G_c
//! acts; and the velocity gradient is the mean of v(x_c) ⊗ G_c. For any R the functions are complete to first order: Σ φ_i = 1,
//! Σ x_i φ_i = x_p, and Σ x_i ∇φ_iᵀ = R (mean s sᵀ) R⁻¹ = I.
//!
//! Domains do not follow the axes, so that weights do not factorise: the loops go from point to point and from corner to corner.
//! F follows the velocities of the corners in the pass that moves the points, so that domains that touch go on touching.

mod domain;
mod gather;
mod scatter;

use super::{Columns, Gathered, Pass, Rates, Reach, Scattered, Sources, Tile, Wanted};
use crate::basis::{Basis, Cpdi};
use crate::grid::{Block, Node};
use crate::math::{Matrix, Vector};
use crate::real::Portable;
use crate::solver::kernels::{Context, Kernels};
use crate::transfer::Transfer;
use domain::NODES;
use std::ops::Range;

/// The kernels for domains and a transfer.
pub struct Domains<const D: usize, T> {
    /// The undeformed points of each body along each axis.
    pub basis: Vec<[Cpdi; D]>,
    /// The transfer.
    pub transfer: T,
}

impl<const D: usize, T: Transfer> Domains<D, T> {
    fn pass(&self, context: &Context<'_, D>) -> Pass<D, Cpdi, T> {
        let basis = self.basis[context.body];
        Pass::new(context.geometry, basis, self.transfer, context.dt)
    }
}

/// Calls the version of a kernel for wide instructions, or the portable one.
macro_rules! with_lanes {
    ($wide:expr, $kernel:ident($($argument:expr),* $(,)?)) => {{
        #[cfg(target_arch = "x86_64")]
        if $wide {
            // SAFETY: the instructions were found; the rest as the caller says
            return unsafe { wide::$kernel::<D, T>($($argument),*) };
        }
        let _ = $wide;
        // SAFETY: as the caller says
        unsafe { portable::$kernel::<Portable, D, T>($($argument),*) }
    }};
}

impl<const D: usize, T: Transfer> Kernels<D> for Domains<D, T> {
    fn nodes(&self) -> usize {
        NODES
    }

    fn position(&self, index: i32, cells: i32) -> f64 {
        Cpdi::default().position(index, cells)
    }

    fn shift(&self, _: usize) -> [f64; D] {
        [0.0; D]
    }

    fn last_start(&self, _: usize, cells: &[i32; D]) -> [i32; D] {
        cells.map(|cells| cells - 1)
    }

    fn inertia(
        &self,
        body: usize,
        x: &[f64; D],
        deformed: Option<&Matrix<D>>,
        _: &[i32; D],
    ) -> Matrix<D> {
        domain::inertia(x, &domain::half_edges(&self.basis[body], deformed)).into()
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
            context.instructions.wide(),
            scatter(&pass, columns, block, context.edge, what, main, force)
        )
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
            scatter::scatter_forces::<Portable, D, T>(
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
            context.instructions.wide(),
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
            context.instructions.wide(),
            gather(&pass, columns, tile, reach, rows, what, sources, rates)
        )
    }
}

/// The loops for any lanes.
mod portable {
    pub(super) use super::gather::{exchange, gather};
    pub(super) use super::scatter::scatter;
}

/// The same, compiled for wide instructions.
#[cfg(target_arch = "x86_64")]
mod wide {
    use super::*;
    use crate::real::Avx;

    #[target_feature(enable = "avx2,fma")]
    pub unsafe fn scatter<const D: usize, T: Transfer>(
        pass: &Pass<D, Cpdi, T>,
        columns: &Columns<D>,
        block: &Block<D>,
        edge: i32,
        what: Scattered,
        main: *mut Node,
        force: *mut Node,
    ) {
        // SAFETY: passed on to the caller
        unsafe { portable::scatter::<Avx, D, T>(pass, columns, block, edge, what, main, force) }
    }

    #[target_feature(enable = "avx2,fma")]
    pub unsafe fn exchange<const D: usize, T: Transfer>(
        pass: &Pass<D, Cpdi, T>,
        columns: &Columns<D>,
        block: &Block<D>,
        edge: i32,
        sources: &Sources,
        second: *mut Node,
    ) -> Gathered {
        // SAFETY: passed on to the caller
        unsafe { portable::exchange::<Avx, D, T>(pass, columns, block, edge, sources, second) }
    }

    #[target_feature(enable = "avx2,fma")]
    #[allow(clippy::too_many_arguments)]
    pub unsafe fn gather<const D: usize, T: Transfer>(
        pass: &Pass<D, Cpdi, T>,
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
            portable::gather::<Avx, D, T>(pass, columns, tile, reach, rows, what, sources, rates)
        }
    }
}
