//! Four or eight points that have the same nodes: the innermost loops in 2D and 3D of points that are stored cell by cell.
//!
//! Here a register holds the same number of all points. A node is read once for all, and what they give to it is summed before
//! it is added.

use super::Tile;
use super::group::{Group, Kept};
use super::nodes::Stencil;
use crate::basis::Basis;
use crate::grid::Node;
use crate::solver::lane::Points;

/// What [`gather_linear`](super::nodes::gather_linear) says, for points that have the same nodes: a component of all is in a lane, and the
/// gradients are free of what nodes without mass would add to them.
#[inline(always)]
#[allow(clippy::type_complexity)] // values, and for each set of functions the columns of a gradient
pub(super) unsafe fn gather_same<
    P: Points,
    const D: usize,
    const N: usize,
    B: Basis<N>,
    const M: usize,
>(
    nodes: *const Node,
    group: &Group<P, D, N>,
    tile: &Tile<D>,
    g: [&[[Kept<P>; N]; D]; M],
) -> ([P; D], [[[P; D]; D]; M]) {
    let zero = P::splat(0.0);
    let mut values = [zero; D];
    let mut gradients = [[[zero; D]; D]; M];
    // one component after the other: all together do not fit 16 registers
    for c in 0..D {
        // SAFETY: as the caller says
        let (value, slants) = unsafe { component::<P, D, N, M>(nodes, group, tile, g, c) };
        values[c] = value;
        for m in 0..M {
            for a in 0..D {
                gradients[m][a][c] = slants[m][a];
            }
        }
    }
    if B::SLOPES_JUMP && M > 0 {
        // number D says whether a node has mass
        // SAFETY: as the caller says
        let (_, present) = unsafe { component::<P, D, N, M>(nodes, group, tile, g, D) };
        free_of_absent(&values, &mut gradients, &present);
    }
    (values, gradients)
}

/// [`without_absent`](super::nodes::without_absent) for several points; `present` is what nodes with mass bring to a field that is one.
#[inline(always)]
pub(super) fn free_of_absent<P: Points, const D: usize, const M: usize>(
    values: &[P; D],
    gradients: &mut [[[P; D]; D]; M],
    present: &[[P; D]; M],
) {
    for m in 0..M {
        for a in 0..D {
            for c in 0..D {
                gradients[m][a][c] = (-present[m][a]).mul_add(values[c], gradients[m][a][c]);
            }
        }
    }
}

/// Number c of the nodes: with the weights, and for each set of functions with those in place of the weights along each axis.
#[inline(always)]
unsafe fn component<P: Points, const D: usize, const N: usize, const M: usize>(
    nodes: *const Node,
    group: &Group<P, D, N>,
    tile: &Tile<D>,
    g: [&[[Kept<P>; N]; D]; M],
    c: usize,
) -> (P, [[P; D]; M]) {
    let s = Stencil { group, tile, q: 0 };
    let nodes = nodes.cast_mut();
    let zero = P::splat(0.0);
    let mut sum = zero;
    let mut gradient = [[zero; D]; M];
    // not N, see `Tile::n`
    let planes = if D == 3 { tile.n } else { N };
    for i in 0..planes {
        // along the axes after the first
        let mut value = zero;
        let mut change = [[zero; 2]; M];
        if D == 2 {
            // SAFETY: the tile addresses stored nodes only (module header of `stencil`)
            let along = unsafe { row::<P, D, N, M>(s.row(nodes, i, 0).add(c), group, g) };
            value = along.0;
            for m in 0..M {
                change[m][0] = along.1[m];
            }
        } else {
            for j in 0..N {
                // SAFETY: as above
                let along = unsafe { row::<P, D, N, M>(s.row(nodes, i, j).add(c), group, g) };
                let wj: P = group.weight[1][j].get();
                value = wj.mul_add(along.0, value);
                for m in 0..M {
                    let gj: P = g[m][1][j].get();
                    change[m][0] = gj.mul_add(along.0, change[m][0]);
                    change[m][1] = wj.mul_add(along.1[m], change[m][1]);
                }
            }
        }
        let wi: P = group.weight[0][i].get();
        sum = wi.mul_add(value, sum);
        for m in 0..M {
            let gi: P = g[m][0][i].get();
            gradient[m][0] = gi.mul_add(value, gradient[m][0]).on_its_own();
            for a in 1..D {
                gradient[m][a] = wi.mul_add(change[m][a - 1], gradient[m][a]).on_its_own();
            }
        }
    }
    (sum, gradient)
}

/// Value and slants along the last axis of the nodes of a row.
#[inline(always)]
unsafe fn row<P: Points, const D: usize, const N: usize, const M: usize>(
    row: *const f64,
    group: &Group<P, D, N>,
    g: [&[[Kept<P>; N]; D]; M],
) -> (P, [P; M]) {
    let zero = P::splat(0.0);
    let mut value = zero;
    let mut slants = [zero; M];
    for k in 0..N {
        // SAFETY: the caller vouches for N nodes
        let number = P::splat(unsafe { *row.add(4 * k) });
        value = more(k, group.weight[D - 1][k].get(), number, value);
        for m in 0..M {
            slants[m] = more(k, g[m][D - 1][k].get(), number, slants[m]);
        }
    }
    (value, slants)
}

/// Adds `a b` to a sum; the first term is the sum.
#[inline(always)]
pub(super) fn more<P: Points>(k: usize, a: P, b: P, sum: P) -> P {
    if k == 0 { a * b } else { a.mul_add(b, sum) }
}

/// What points give to their nodes, as [`Gift`](super::nodes::Gift) says of one: in a lane the same component of all.
pub(super) struct Gifts<P, const D: usize, const N: usize> {
    /// Components, and as number D the mass.
    pub value: [P; 4],
    /// Components of the slants.
    pub slant: [[[Kept<P>; D]; N]; D],
}

impl<P: Points, const D: usize, const N: usize> Gifts<P, D, N> {
    /// Nothing.
    #[inline(always)]
    pub(super) fn none() -> Self {
        Self {
            value: [P::splat(0.0); 4],
            slant: [[[Kept::none(); D]; N]; D],
        }
    }
}

/// What [`scatter_gift`](super::nodes::scatter_gift) says, for points that have the same nodes.
#[inline(always)]
pub(super) unsafe fn scatter_same<
    P: Points,
    const D: usize,
    const N: usize,
    const VALUE: bool,
    const SLANT: bool,
>(
    of_value: *mut Node,
    of_slant: *mut Node,
    group: &Group<P, D, N>,
    tile: &Tile<D>,
    gifts: &Gifts<P, D, N>,
) {
    let zero = P::splat(0.0);
    let s = Stencil { group, tile, q: 0 };
    // not N, see `Tile::n`
    let planes = if D == 3 { tile.n } else { N };
    for i in 0..planes {
        let wi: P = group.weight[0][i].get();
        let mut along = [zero; D];
        if SLANT {
            for c in 0..D {
                along[c] = gifts.slant[0][i][c].get();
                if !VALUE {
                    along[c] = gifts.value[c].mul_add(wi, along[c]);
                }
            }
        }
        for j in 0..if D == 3 { N } else { 1 } {
            let mut weight = wi;
            let mut slanted = along;
            if D == 3 {
                let wj: P = group.weight[1][j].get();
                weight = wi * wj;
                if SLANT {
                    for c in 0..D {
                        let middle: P = gifts.slant[1][j][c].get();
                        slanted[c] = along[c].mul_add(wj, wi * middle);
                    }
                }
            }
            let mut value = [zero; 4];
            for c in 0..=D {
                if VALUE || c == D {
                    value[c] = gifts.value[c] * weight;
                }
            }
            // SAFETY: the tile addresses stored nodes only, and they are this block's alone (module header of `stencil`)
            let (values, slants) = unsafe { (s.row(of_value, i, j), s.row(of_slant, i, j)) };
            for k in 0..N {
                let wk: P = group.weight[D - 1][k].get();
                if VALUE {
                    let mut given = [zero; 4];
                    for c in 0..=D {
                        given[c] = value[c] * wk;
                    }
                    // SAFETY: the row has N nodes
                    unsafe { add(values, k, given) };
                }
                if SLANT {
                    let mut given = [zero; 4];
                    for c in 0..D {
                        let slant: P = gifts.slant[D - 1][k][c].get();
                        given[c] = slanted[c].mul_add(wk, weight * slant);
                    }
                    if !VALUE {
                        given[D] = value[D] * wk;
                    }
                    // SAFETY: as above
                    unsafe { add(slants, k, given) };
                }
            }
        }
    }
}

/// Node k of a row gets the sum over all points of each component.
#[inline(always)]
unsafe fn add<P: Points>(row: *mut f64, k: usize, given: [P; 4]) {
    // SAFETY: the caller's row has a node k
    unsafe { P::add_sums(given, row.add(4 * k)) }
}
