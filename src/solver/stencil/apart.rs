//! Four points in 2D that have nodes of their own. Two components of a node are loaded at once, so that lanes of four points pay
//! without common nodes too; in 3D they do not.

use super::Tile;
use super::group::{Group, Kept};
use super::nodes::Stencil;
use super::same::{free_of_absent, more};
use crate::basis::Basis;
use crate::grid::Node;
use crate::solver::lane::Lane;

/// Two components.
type Two<L> = [L; 2];

/// What [`gather_same`](super::same::gather_same) says, for points in 2D whatever their nodes.
#[inline(always)]
#[allow(clippy::type_complexity)] // values, and for each set of functions the columns of a gradient
pub(super) unsafe fn gather_apart<
    L: Lane,
    const D: usize,
    const N: usize,
    B: Basis<N>,
    const M: usize,
>(
    nodes: *const Node,
    group: &Group<L, D, N>,
    tile: &Tile<D>,
    g: [&[[Kept<L>; N]; D]; M],
) -> ([L; D], [[[L; D]; D]; M]) {
    let zero = L::splat(0.0);
    let mut values = [zero; D];
    let mut gradients = [[[zero; D]; D]; M];
    // SAFETY: as the caller says
    let (value, slants) = unsafe { two::<L, D, N, M>(nodes, group, tile, g, 0) };
    values.copy_from_slice(&value[..D]);
    for m in 0..M {
        for a in 0..D {
            gradients[m][a].copy_from_slice(&slants[m][a][..D]);
        }
    }
    if B::SLOPES_JUMP && M > 0 {
        // number 2 says whether a node has mass
        // SAFETY: as the caller says
        let (_, two) = unsafe { two::<L, D, N, M>(nodes, group, tile, g, 2) };
        let mut present = [[zero; D]; M];
        for m in 0..M {
            for a in 0..D {
                present[m][a] = two[m][a][0];
            }
        }
        free_of_absent(&values, &mut gradients, &present);
    }
    (values, gradients)
}

/// Numbers c and c + 1 of the nodes: with the weights, and for each set of functions with those in place of the weights along each
/// axis.
#[inline(always)]
unsafe fn two<L: Lane, const D: usize, const N: usize, const M: usize>(
    nodes: *const Node,
    group: &Group<L, D, N>,
    tile: &Tile<D>,
    g: [&[[Kept<L>; N]; D]; M],
    c: usize,
) -> (Two<L>, [[Two<L>; 2]; M]) {
    let zero = L::splat(0.0);
    let mut sum = [zero; 2];
    let mut gradient = [[[zero; 2]; 2]; M];
    for i in 0..N {
        let mut rows = [std::ptr::null::<f64>(); 4];
        for q in 0..4 {
            let s = Stencil { group, tile, q };
            // SAFETY: the tile addresses stored nodes only (module header of `stencil`)
            rows[q] = unsafe { s.row(nodes.cast_mut(), i, 0).add(c) };
        }
        let mut value = [zero; 2];
        let mut along = [[zero; 2]; M];
        for k in 0..N {
            let mut at = rows;
            for q in 0..4 {
                at[q] = rows[q].wrapping_add(4 * k);
            }
            // SAFETY: each row has N nodes of four numbers
            let node = unsafe { L::load_pairs(at) };
            let wk: L = group.weight[1][k].get();
            for c in 0..2 {
                value[c] = more(k, wk, node[c], value[c]);
            }
            for m in 0..M {
                let gk: L = g[m][1][k].get();
                for c in 0..2 {
                    along[m][c] = more(k, gk, node[c], along[m][c]);
                }
            }
        }
        let wi: L = group.weight[0][i].get();
        for c in 0..2 {
            sum[c] = wi.mul_add(value[c], sum[c]);
        }
        for m in 0..M {
            let gi: L = g[m][0][i].get();
            for c in 0..2 {
                gradient[m][0][c] = gi.mul_add(value[c], gradient[m][0][c]);
                gradient[m][1][c] = wi.mul_add(along[m][c], gradient[m][1][c]);
            }
        }
    }
    (sum, gradient)
}
