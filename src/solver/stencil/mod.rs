//! The hot loops: from the points of one block to the grid nodes around them and back.
//!
//! Weights factorise axis by axis, so a stencil of N^D nodes costs a few operations a node. All loops are generic over
//! [`Lane`](super::lane::Lane), once with wide instructions and once without; `plain` beside this file says what they mean.
//!
//! Everything `unsafe` here rests on three facts. A point's stencil starts at most one node outside its block (checked by
//! [`gather`] whenever a point moves, and by the sort, which refuses points that are not finite or outside the grid); should
//! somebody else have moved the point meanwhile, [`Tile`] holds its stencil inside the tile, which is wrong but addresses only
//! stored nodes, and the health check at the end of the step tells. Blocks that are scattered at the same time have the same colour, so they share no
//! node. Blocks hold disjoint ranges of rows, so no two threads touch the same point.

mod columns;
mod gather;
mod nodes;
mod scatter;
mod tile;

pub use columns::Columns;
pub use gather::{Gathered, Rates, Sources, Wanted, gather};
pub use scatter::{Scattered, scatter, scatter_forces};
pub use tile::{Reach, Tile};

use crate::basis::Basis;
use crate::grid::Geometry;
use crate::math::Vector;
use crate::transfer::Transfer;

/// Points that are gathered together before their law is asked, so that their velocity gradients stay in the first cache.
pub const CHUNK: usize = 64;

/// What all points of a body have in common in one pass over them.
pub struct Pass<'a, const D: usize, B, T> {
    /// The grid.
    pub geometry: &'a Geometry<D>,
    /// The basis along each axis.
    pub basis: [B; D],
    /// The transfer.
    pub transfer: T,
    /// Δt, s.
    pub dt: f64,
}

/// The stencil of one point.
struct Stencil<const D: usize, const N: usize> {
    at: [usize; D],
    weight: [[f64; N]; D],
    /// Per metre.
    slope: [[f64; N]; D],
    /// x_i − x, in cells.
    arm: [[f64; N]; D],
}

impl<const D: usize, B, T: Transfer> Pass<'_, D, B, T> {
    #[inline(always)]
    fn stencil<const N: usize>(&self, tile: &Tile<D>, position: &Vector<D>) -> Stencil<D, N>
    where
        B: Basis<N>,
    {
        let inverse = 1.0 / self.geometry.cell_size;
        let x = self.geometry.in_cells(position, inverse);
        let mut first = [0; D];
        let (mut weight, mut slope, mut arm) = ([[0.0; N]; D], [[0.0; N]; D], [[0.0; N]; D]);
        for a in 0..D {
            let axis = self.basis[a].axis(x[a], self.geometry.cells[a]);
            first[a] = axis.first;
            weight[a] = axis.weight;
            arm[a] = axis.arm;
            for i in 0..N {
                slope[a][i] = axis.slope[i] * inverse;
            }
        }
        Stencil {
            at: tile.local(first),
            weight,
            slope,
            arm,
        }
    }

    /// The functions whose gathered velocities are the columns of APIC's C, per metre: N_i (x_i − x) / D with
    /// D = Σ N_i (x_i − x)²; tensor-product bases that are complete to first order have a diagonal D.
    #[inline(always)]
    fn affine_weights<const N: usize>(&self, s: &Stencil<D, N>) -> [[f64; N]; D]
    where
        B: Basis<N>,
    {
        if B::AFFINE_IS_SLOPE {
            return s.slope;
        }
        let mut weights = s.arm;
        for a in 0..D {
            let mut inertia = 0.0;
            for i in 0..N {
                let arm = weights[a][i];
                weights[a][i] *= s.weight[a][i];
                inertia += weights[a][i] * arm;
            }
            if inertia <= f64::MIN_POSITIVE {
                // on the very end of a grid of splines one node has all the weight and no arm: the slopes are the limit
                weights[a] = s.slope[a];
                continue;
            }
            let scale = 1.0 / (inertia * self.geometry.cell_size);
            for i in 0..N {
                weights[a][i] *= scale;
            }
        }
        weights
    }
}
