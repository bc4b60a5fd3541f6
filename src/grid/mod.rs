//! The background grid: where its nodes are, and storage for the blocks of it that points occupy.

mod blocks;

pub use blocks::{Block, Blocks, BodyBlocks, Occupied, Row};

use crate::basis::Basis;
use crate::math::Vector;

/// Four numbers of one grid node that are loaded and stored together: a vector (momentum, velocity or force, components
/// `0 .. D`) and, with momenta, the mass, with velocities 1 if there was any (component `D`).
#[repr(C, align(32))]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Node(pub [f64; 4]);

/// The place and size of the grid.
#[derive(Clone, Debug, PartialEq)]
pub struct Geometry<const D: usize> {
    /// Lower corner, m.
    pub min: Vector<D>,
    /// Edge h of a cell, m.
    pub cell_size: f64,
    /// Cells along each axis.
    pub cells: [i32; D],
    /// Nodes (shape functions) along each axis.
    pub counts: [i32; D],
}

impl<const D: usize> Geometry<D> {
    /// The grid as a basis numbers its nodes.
    pub fn new<const N: usize, B: Basis<N>>(
        min: Vector<D>,
        cell_size: f64,
        cells: [i32; D],
        basis: &B,
    ) -> Self {
        Self {
            min,
            cell_size,
            cells,
            counts: cells.map(|n| basis.count(n)),
        }
    }

    /// A position in cells from the lower corner.
    #[inline(always)]
    pub fn in_cells(&self, position: &Vector<D>, inverse: f64) -> [f64; D] {
        let mut x = [0.0; D];
        for a in 0..D {
            x[a] = (position[a] - self.min[a]) * inverse;
        }
        x
    }
}

/// Nodes along an edge of a block of few points. A stencil of `n` nodes whose point has strayed up to one cell from its block
/// must stay clear of the next block of the same colour, two blocks on: the edge has to exceed `n`.
pub const fn block_edge(dimension: usize, n: usize) -> i32 {
    match dimension {
        1 => 64,
        2 => 16,
        _ => {
            if n <= 3 {
                4
            } else {
                LARGE_EDGE
            }
        }
    }
}

/// Nodes along an edge of a block in 3D where points are many and fill their blocks: columns are then read in longer pieces, and
/// nodes at faces of blocks, which several colours add to, are fewer.
pub const LARGE_EDGE: i32 = 8;
