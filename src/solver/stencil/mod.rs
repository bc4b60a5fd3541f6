//! The hot loops: from the points of one block to the grid nodes around them and back.
//!
//! Weights factorise axis by axis, so a stencil of N^D nodes costs a few operations a node. Points come four at a time, cell by cell:
//! four that have the same nodes are taken as one (`same`, in 1D `line`), others one after the other (`nodes`). Where registers hold
//! eight numbers, eight points in 3D are taken as one too (`wider`). All loops are generic over lanes
//! ([`Points`](super::lane::Points), [`Lane`](super::lane::Lane)), compiled for every set of instructions; `solver::plain` says what they mean.
//!
//! Everything `unsafe` here rests on three facts. A point's stencil starts at most one node outside its block (checked by
//! [`gather`] whenever a point moves, and by the sort, which refuses points that are not finite or outside the grid; in the total
//! Lagrangian frame points never move in the grid); should
//! somebody else have moved the point meanwhile, [`Tile`] holds its stencil inside the tile, which is wrong but addresses only
//! stored nodes, and the health check at the end of the step tells. Blocks that are scattered at the same time have the same colour, so they share no
//! node. Blocks hold disjoint ranges of rows, so no two threads touch the same point.

mod apart;
mod columns;
mod cpdi;
mod dilation;
mod gather;
mod group;
mod line;
mod nodes;
mod offered;
mod rates;
mod same;
mod scatter;
mod tile;
mod wanted;
mod wider;
pub use columns::Columns;
pub use cpdi::Domains;
pub use gather::{Gathered, Sources, exchange, gather};
pub use rates::Rates;
pub use scatter::{Scattered, scatter, scatter_forces};
pub use tile::{Reach, Tile};
pub use wanted::Wanted;

use crate::grid::Geometry;
use crate::math::Vector;

/// Points that are gathered together before their law is asked, so that their velocity gradients stay in the first cache.
pub const CHUNK: usize = 64;

/// What all points of a body have in common in one pass over them.
///
/// Numbers by value: behind a reference they would be read again, and divided by, after every write to a point.
pub struct Pass<const D: usize, B, T> {
    /// Lower corner of the grid, m.
    pub min: [f64; D],
    /// Edge of a cell, m.
    pub cell_size: f64,
    /// One over that, 1/m.
    pub inverse_size: f64,
    /// Cells along each axis.
    pub cells: [i32; D],
    /// The basis along each axis.
    pub basis: [B; D],
    /// The transfer.
    pub transfer: T,
    /// Δt, s.
    pub dt: f64,
}

impl<const D: usize, B, T> Pass<D, B, T> {
    /// A pass over a grid of this geometry.
    pub fn new(geometry: &Geometry<D>, basis: [B; D], transfer: T, dt: f64) -> Self {
        Self {
            min: geometry.min.into(),
            cell_size: geometry.cell_size,
            inverse_size: 1.0 / geometry.cell_size,
            cells: geometry.cells,
            basis,
            transfer,
            dt,
        }
    }

    /// A place, m, in cells from the lower corner of the grid.
    #[inline(always)]
    fn in_cells(&self, place: &Vector<D>) -> [f64; D] {
        std::array::from_fn(|a| (place[a] - self.min[a]) * self.inverse_size)
    }
}
