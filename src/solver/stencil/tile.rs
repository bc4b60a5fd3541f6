//! Which nodes the points of a block may reach, and where those nodes are stored.

use crate::grid::{Block, Node};
use crate::real::Real;
use crate::solver::lane::Points;
use std::mem::MaybeUninit;

/// The most rows that a tile has: 15 × 15, for blocks of 8 and stencils of 6 in 3D.
const MAX_ROWS: usize = 225;

/// How many nodes outside its block a stencil may start.
const MARGIN: usize = 1;

/// Storage of the nodes that the points of one block may reach: all rows of an `edge + N + 1` cube, one node below the block
/// to `N` nodes above it.
pub struct Tile<const D: usize> {
    /// Bytes from the start of an array of nodes to the first node of each row; below zero where a margin that nobody reaches
    /// would lie before the array.
    rows: [MaybeUninit<isize>; MAX_ROWS],
    pub(super) width: usize,
    /// The last place at which a stencil may start, along every axis.
    last: f64,
    /// N, in a form that keeps the compiler from unrolling all N³ nodes of a 3D stencil, which takes it long and wins nothing.
    pub(super) n: usize,
    origin: [i32; D],
}

impl<const D: usize> Tile<D> {
    /// The tile of a block of `edge` nodes for stencils of `n` nodes.
    #[inline(always)]
    pub fn new(block: &Block<D>, edge: i32, n: usize) -> Self {
        let width = edge as usize + n + 2 * MARGIN - 1;
        let edge = edge as usize;
        // only the rows that this tile has are written, or ever read
        let mut rows = [MaybeUninit::uninit(); MAX_ROWS];
        let bytes = |node: usize| (node as isize - MARGIN as isize) * size_of::<Node>() as isize;
        // (which of the three neighbouring blocks, row within it) of row t of the tile
        let place = |t: usize| match t {
            t if t < MARGIN => (0, edge + t - MARGIN),
            t if t < MARGIN + edge => (1, t - MARGIN),
            t => (2, t - MARGIN - edge),
        };
        match D {
            1 => {
                rows[0].write(bytes(block.anchors[0].0 as usize));
            }
            2 => {
                for t in 0..width {
                    let (column, i) = place(t);
                    let (base, stride) = block.anchors[column];
                    rows[t].write(bytes(base as usize + i * stride as usize));
                }
            }
            _ => {
                for t in 0..width {
                    let (column, i) = place(t);
                    for u in 0..width {
                        let (next, j) = place(u);
                        let (base, stride) = block.anchors[3 * column + next];
                        let node = base as usize + (i * edge + j) * stride as usize;
                        rows[t * width + u].write(bytes(node));
                    }
                }
            }
        }
        Self {
            rows,
            width,
            last: (edge + 2 * MARGIN - 1) as f64,
            n: std::hint::black_box(n),
            origin: block.origin,
        }
    }

    /// Bytes from the start of an array of nodes to the first node of a row.
    ///
    /// # Safety
    /// The tile has this row.
    #[inline(always)]
    pub(super) unsafe fn row(&self, number: usize) -> isize {
        debug_assert!(
            number
                < if D == 1 {
                    1
                } else {
                    self.width.pow(D as u32 - 1)
                }
        );
        // SAFETY: `new` wrote all rows of the tile
        unsafe { self.rows.get_unchecked(number).assume_init() }
    }

    /// Where stencils that start at the given nodes lie along axis `a` of the tile.
    #[inline(always)]
    pub(super) fn local<R: Real>(&self, a: usize, first: R) -> R {
        let start = R::splat(f64::from(self.origin[a] - MARGIN as i32));
        // a place that is not a number counts as the first
        (first - start).max(R::splat(0.0)).min(R::splat(self.last))
    }

    /// Whether all stencils that start in the tile are among `low ..= high` along axis `a`.
    #[inline(always)]
    pub(super) fn alike(&self, a: usize, low: i32, high: i32) -> bool {
        let first = self.origin[a] - MARGIN as i32;
        first >= low && first + self.last as i32 <= high
    }
}

/// The part of the grid, in cells, in which a point may be as long as it is counted to a block.
#[derive(Clone, Copy, Debug)]
pub struct Reach<const D: usize> {
    low: [f64; D],
    high: [f64; D],
}

impl<const D: usize> Reach<D> {
    /// One node more than the block on either side, within the grid; `shift` is where stencils start relative to their point.
    #[inline(always)]
    pub fn new(origin: [i32; D], edge: i32, cells: [i32; D], shift: [f64; D]) -> Self {
        // a hair inside, so that rounding cannot put a stencil's start beyond the tile
        let hair = 1e-9
            + cells
                .iter()
                .fold(0.0, |most: f64, &n| most.max(f64::from(n)))
                * 1e-15;
        Self {
            low: std::array::from_fn(|a| (f64::from(origin[a] - 1) - shift[a] + hair).max(0.0)),
            high: std::array::from_fn(|a| {
                (f64::from(origin[a] + edge + 1) - shift[a] - hair).min(f64::from(cells[a]))
            }),
        }
    }

    /// Whether a position is inside; false if it is not a number.
    #[inline(always)]
    pub fn holds(&self, x: &[f64; D]) -> bool {
        (0..D).all(|a| x[a] >= self.low[a] && x[a] <= self.high[a])
    }

    /// Whether the positions of all points are inside.
    #[inline(always)]
    pub(super) fn holds_all<P: Points>(&self, x: &[P; D]) -> bool {
        let mut inside = true;
        for a in 0..D {
            inside &= x[a].all_within(self.low[a], self.high[a]);
        }
        inside
    }
}
