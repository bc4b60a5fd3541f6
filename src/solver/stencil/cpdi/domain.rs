//! The domain of one point: where its corners lie in the grid, and what follows from its shape.

use crate::basis::Cpdi;
use crate::grid::Node;
use crate::math::Matrix;
use crate::solver::stencil::{Columns, Pass, Tile};
use crate::tensor::Tensor;

/// Nodes along each axis of a stencil that holds every corner.
pub(super) const NODES: usize = 2 + 2 * Cpdi::REACH as usize;

/// On which side of its point corner `c` lies along edge `a`: −1 or 1.
#[inline(always)]
pub(super) fn side(c: usize, a: usize) -> f64 {
    if c >> a & 1 == 1 { 1.0 } else { -1.0 }
}

/// R, the half-edges of a domain as columns, in cells: F R₀ with those of the undeformed point along the axes.
///
/// A domain that reaches farther than [`Cpdi::REACH`] along an axis of the grid is squeezed along this axis to what it may be.
/// That is again a parallelepiped around its point, so that all that holds for domains holds for it, but its neighbours no longer
/// touch it.
#[inline(always)]
pub(super) fn half_edges<const D: usize>(
    undeformed: &[Cpdi; D],
    deformed: Option<&Matrix<D>>,
) -> Tensor<f64, D> {
    let mut edges = Tensor::zero();
    for a in 0..D {
        let half = undeformed[a].half_width();
        match deformed {
            Some(f) => (0..D).for_each(|i| edges[(i, a)] = f[(i, a)] * half),
            None => edges[(a, a)] = half,
        }
    }
    for i in 0..D {
        let extent: f64 = (0..D).map(|a| edges[(i, a)].abs()).sum();
        let most = f64::from(Cpdi::REACH);
        if extent > most {
            (0..D).for_each(|a| edges[(i, a)] *= most / extent);
        }
    }
    edges
}

/// A corner of a domain.
#[derive(Clone, Copy)]
struct Corner<const D: usize> {
    /// Which row of the tile has the first node of its cell.
    row: usize,
    /// That node's place along the last axis of the tile.
    node: usize,
    /// Where in its cell it lies along each axis, 0 to 1.
    place: [f64; D],
}

/// The domain of a point.
pub(super) struct Domain<const D: usize> {
    /// R: half-edges as columns, in cells.
    pub edges: Tensor<f64, D>,
    /// R⁻¹.
    pub inverse: Tensor<f64, D>,
    corners: [Corner<D>; 8],
}

impl<const D: usize> Domain<D> {
    /// How many corners there are.
    pub(super) const CORNERS: usize = 1 << D;

    /// The domain of the point in row `p`.
    ///
    /// # Safety
    /// The row exists, and no other thread uses it meanwhile.
    #[inline(always)]
    pub(super) unsafe fn of<T>(
        pass: &Pass<D, Cpdi, T>,
        columns: &Columns<D>,
        tile: &Tile<D>,
        p: usize,
    ) -> Self {
        // SAFETY: as the caller says
        let (place, deformed) = unsafe {
            let f = columns.convected.then(|| &*columns.domain(p));
            (&*columns.place.add(p), f)
        };
        let edges = half_edges(&pass.basis, deformed);
        let x = pass.in_cells(place);
        let nowhere = Corner {
            row: 0,
            node: 0,
            place: [0.0; D],
        };
        let mut corners = [nowhere; 8];
        for a in 0..D {
            let first = first(x[a], pass.cells[a]);
            let start = tile.local::<f64>(a, first);
            for (c, corner) in corners.iter_mut().enumerate().take(Self::CORNERS) {
                // in cells from the first node of the stencil
                let mut y = x[a] + f64::from(Cpdi::REACH) - first;
                for b in 0..D {
                    y += side(c, b) * edges[(a, b)];
                }
                // rounding must not lead out of the stencil; what is not a number counts as zero
                let cell = y.floor().max(0.0).min((NODES - 2) as f64);
                corner.place[a] = y - cell;
                let local = (start + cell) as usize;
                if a + 1 == D {
                    corner.node = local;
                } else {
                    corner.row = corner.row * tile.width + local;
                }
            }
        }
        Self {
            edges,
            inverse: edges.inverse(),
            corners,
        }
    }

    /// The shares of the two nodes along each axis of corner `c`: its hat functions.
    #[inline(always)]
    pub(super) fn hats(&self, c: usize) -> [[f64; 2]; D] {
        self.corners[c].place.map(|s| [1.0 - s, s])
    }

    /// The first of the two nodes of corner `c` in row `j` of its cell, for an array that starts at `nodes`. Bit D − 2 − a of `j`
    /// tells which of the two along axis a.
    ///
    /// # Safety
    /// `nodes` is an array of the grid with all of the tile's nodes.
    #[inline(always)]
    pub(super) unsafe fn row(
        &self,
        nodes: *mut Node,
        tile: &Tile<D>,
        c: usize,
        j: usize,
    ) -> *mut f64 {
        let corner = &self.corners[c];
        let number = match D {
            1 => 0,
            2 => corner.row + j,
            _ => corner.row + (j >> 1) * tile.width + (j & 1),
        };
        // SAFETY: `of` keeps cells inside the stencil and `Tile::local` keeps that inside the tile, which addresses stored nodes
        unsafe {
            nodes
                .wrapping_add(corner.node)
                .wrapping_byte_offset(tile.row(number))
                .cast()
        }
    }

    /// Σ φ_i (x_i − x) (x_i − x)ᵀ, in cells².
    #[inline(always)]
    pub(super) fn inertia(&self) -> Tensor<f64, D> {
        let mut own = [0.0; D];
        for corner in &self.corners[..Self::CORNERS] {
            for a in 0..D {
                own[a] += spread(corner.place[a]) / Self::CORNERS as f64;
            }
        }
        with_corners(&self.edges, own)
    }
}

/// Σ φ_i (x_i − x) (x_i − x)ᵀ, in cells², of a domain with the given half-edges around `x`.
pub(super) fn inertia<const D: usize>(x: &[f64; D], edges: &Tensor<f64, D>) -> Tensor<f64, D> {
    let corners = 1 << D;
    let own = std::array::from_fn(|a| {
        let place = |c| x[a] + (0..D).map(|b| side(c, b) * edges[(a, b)]).sum::<f64>();
        let places = (0..corners).map(place);
        places.map(|y| spread(y - y.floor())).sum::<f64>() / f64::from(corners as i32)
    });
    with_corners(edges, own)
}

/// Σ N_i (x_i − x)² of the hat functions at s from a node, in cells².
#[inline(always)]
fn spread(s: f64) -> f64 {
    s * (1.0 - s)
}

/// The moments of the corners about their point, R (mean s sᵀ) Rᵀ = R Rᵀ, and those of the nodes about the corners.
#[inline(always)]
fn with_corners<const D: usize>(edges: &Tensor<f64, D>, own: [f64; D]) -> Tensor<f64, D> {
    let mut sum = *edges * edges.transpose();
    for a in 0..D {
        sum[(a, a)] += own[a];
    }
    sum
}

/// Number of the first node of the stencil of a point at `x` cells along an axis, [`Cpdi::REACH`] nodes before its cell.
#[inline(always)]
pub(super) fn first(x: f64, cells: i32) -> f64 {
    x.floor().min(f64::from(cells - 1))
}
