//! From one point to the nodes of its stencil and back: the innermost loops.

use super::Tile;
use crate::grid::Node;
use crate::math::Matrix;
use crate::solver::lane::Lane;

/// `N^D` nodes: for a stencil at `t`, calls `visit(storage index of the first node, i, j)` for each row of N nodes.
macro_rules! for_each_row {
    ($tile:expr, $t:expr, $n:expr, |$at:ident, $i:ident, $j:ident| $body:block) => {
        match D {
            1 => {
                let ($i, $j) = (0_usize, 0_usize);
                let $at = $tile.rows[0] + $t[0];
                $body
            }
            2 => {
                let $j = 0_usize;
                for $i in 0..$n {
                    let $at = $tile.rows[$t[0] + $i] + $t[1];
                    $body
                }
            }
            _ => {
                for $i in 0..$tile.n {
                    for $j in 0..$n {
                        let $at = $tile.rows[($t[0] + $i) * $tile.width + $t[1] + $j] + $t[2];
                        $body
                    }
                }
            }
        }
    };
}

/// Adds `q N_I` to every node of a stencil.
#[inline(always)]
pub(super) unsafe fn scatter_value<L: Lane, const D: usize, const N: usize>(
    nodes: *mut Node,
    tile: &Tile<D>,
    t: [usize; D],
    w: &[[f64; N]; D],
    q: L,
) {
    let last = splats::<L, N>(&w[D - 1]);
    for_each_row!(tile, t, N, |at, i, j| {
        let row = match D {
            1 => q,
            2 => q.mul(L::splat(w[0][i])),
            _ => q.mul(L::splat(w[0][i] * w[1][j])),
        };
        for k in 0..N {
            // SAFETY: the tile addresses stored nodes only (module header)
            unsafe {
                let node = nodes.add(at + k).cast::<f64>();
                row.mul_add(last[k], L::load(node)).store(node);
            }
        }
    });
}

/// Adds `Σ_a x[a][i_a] Π_{b≠a} N_b` to every node (i_1 … i_D) of a stencil: a value with x[0] = q N_1, and anything that has a
/// different function along one axis, such as a gradient.
#[inline(always)]
pub(super) unsafe fn scatter_linear<L: Lane, const D: usize, const N: usize>(
    nodes: *mut Node,
    tile: &Tile<D>,
    t: [usize; D],
    w: &[[f64; N]; D],
    x: &[[L; N]; D],
) {
    match D {
        1 => {
            for k in 0..N {
                // SAFETY: the tile addresses stored nodes only (module header)
                unsafe {
                    let node = nodes.add(tile.rows[0] + t[0] + k).cast::<f64>();
                    x[0][k].add(L::load(node)).store(node);
                }
            }
        }
        2 => {
            let last = splats::<L, N>(&w[1]);
            for i in 0..N {
                let at = tile.rows[t[0] + i] + t[1];
                let wi = L::splat(w[0][i]);
                for k in 0..N {
                    // SAFETY: as above
                    unsafe {
                        let node = nodes.add(at + k).cast::<f64>();
                        let sum = x[0][i].mul_add(last[k], L::load(node));
                        wi.mul_add(x[1][k], sum).store(node);
                    }
                }
            }
        }
        _ => {
            let mut plane = [[L::splat(0.0); N]; N];
            let mut slant = plane;
            for j in 0..N {
                for k in 0..N {
                    plane[j][k] = L::splat(w[1][j] * w[2][k]);
                    let first = x[1][j].mul(L::splat(w[2][k]));
                    slant[j][k] = x[2][k].mul_add(L::splat(w[1][j]), first);
                }
            }
            for i in 0..tile.n {
                let wi = L::splat(w[0][i]);
                for j in 0..N {
                    let at = tile.rows[(t[0] + i) * tile.width + t[1] + j] + t[2];
                    for k in 0..N {
                        // SAFETY: as above
                        unsafe {
                            let node = nodes.add(at + k).cast::<f64>();
                            let sum = x[0][i].mul_add(plane[j][k], L::load(node));
                            wi.mul_add(slant[j][k], sum).store(node);
                        }
                    }
                }
            }
        }
    }
}

/// Σ_I N_I node_I.
#[inline(always)]
pub(super) unsafe fn gather_value<L: Lane, const D: usize, const N: usize>(
    nodes: *const Node,
    tile: &Tile<D>,
    t: [usize; D],
    w: &[[f64; N]; D],
) -> L {
    let last = splats::<L, N>(&w[D - 1]);
    let mut sum = L::splat(0.0);
    for_each_row!(tile, t, N, |at, i, j| {
        let mut row = L::splat(0.0);
        for k in 0..N {
            // SAFETY: the tile addresses stored nodes only (module header)
            row = unsafe { last[k].mul_add(L::load(nodes.add(at + k).cast()), row) };
        }
        sum = match D {
            1 => row,
            2 => row.mul_add(L::splat(w[0][i]), sum),
            _ => row.mul_add(L::splat(w[0][i] * w[1][j]), sum),
        };
    });
    sum
}

/// For nodes that hold a velocity and, as number `D`, 1 (0 where no mass came):
/// Σ_I N_I node_I, and for each set of functions `g[m]` and each axis a the same with `g[m]` in place of N along that axis: with
/// the slopes Σ_I ∂_a N_I node_I. All sets together read the nodes once.
#[inline(always)]
pub(super) unsafe fn gather_linear<L: Lane, const D: usize, const N: usize, const M: usize>(
    nodes: *const Node,
    tile: &Tile<D>,
    t: [usize; D],
    w: &[[f64; N]; D],
    g: [&[[f64; N]; D]; M],
) -> (L, [[L; D]; M]) {
    let zero = L::splat(0.0);
    let last = splats::<L, N>(&w[D - 1]);
    let mut slope = [[zero; N]; M];
    for m in 0..M {
        slope[m] = splats::<L, N>(&g[m][D - 1]);
    }
    let mut gradient = [[zero; D]; M];
    let mut sum = zero;
    match D {
        1 => {
            // SAFETY: the tile addresses stored nodes only (module header)
            let (value, change) =
                unsafe { gather_row(nodes.add(tile.rows[0] + t[0]), &last, &slope) };
            sum = value;
            for m in 0..M {
                gradient[m][0] = change[m];
            }
        }
        2 => {
            for i in 0..N {
                // SAFETY: the tile addresses stored nodes only (module header)
                let (value, change) =
                    unsafe { gather_row(nodes.add(tile.rows[t[0] + i] + t[1]), &last, &slope) };
                let wi = L::splat(w[0][i]);
                sum = wi.mul_add(value, sum);
                for m in 0..M {
                    gradient[m][0] = L::splat(g[m][0][i]).mul_add(value, gradient[m][0]);
                    gradient[m][1] = wi.mul_add(change[m], gradient[m][1]);
                }
            }
        }
        _ => {
            for i in 0..tile.n {
                let (mut value, mut dy, mut dz) = (zero, [zero; M], [zero; M]);
                for j in 0..N {
                    let at = tile.rows[(t[0] + i) * tile.width + t[1] + j] + t[2];
                    // SAFETY: the tile addresses stored nodes only (module header)
                    let (v, c) = unsafe { gather_row(nodes.add(at), &last, &slope) };
                    let wj = L::splat(w[1][j]);
                    value = wj.mul_add(v, value);
                    for m in 0..M {
                        dy[m] = L::splat(g[m][1][j]).mul_add(v, dy[m]);
                        dz[m] = wj.mul_add(c[m], dz[m]);
                    }
                }
                let wi = L::splat(w[0][i]);
                sum = wi.mul_add(value, sum);
                for m in 0..M {
                    gradient[m][0] = L::splat(g[m][0][i]).mul_add(value, gradient[m][0]);
                    gradient[m][1] = wi.mul_add(dy[m], gradient[m][1]);
                    gradient[m][2] = wi.mul_add(dz[m], gradient[m][2]);
                }
            }
        }
    }
    // Nodes without mass have no velocity: what is missing in Σ ∂N_I over the others is made up with the point's own velocity.
    // (A point of the linear basis that lies on a node has a slope, but no weight, at the node ahead.)
    for m in 0..M {
        for a in 0..D {
            let present = gradient[m][a].array()[D];
            gradient[m][a] = L::splat(-present).mul_add(sum, gradient[m][a]);
        }
    }
    (sum, gradient)
}

/// Value and slopes along the last axis of N nodes in a row. A function and not a closure: closures are not always inlined,
/// and outside the kernels that are compiled for them wide instructions become calls.
#[inline(always)]
unsafe fn gather_row<L: Lane, const N: usize, const M: usize>(
    nodes: *const Node,
    weight: &[L; N],
    slope: &[[L; N]; M],
) -> (L, [L; M]) {
    let (mut value, mut change) = (L::splat(0.0), [L::splat(0.0); M]);
    for k in 0..N {
        // SAFETY: the caller vouches for N nodes
        let node = unsafe { L::load(nodes.add(k).cast()) };
        value = weight[k].mul_add(node, value);
        for m in 0..M {
            change[m] = slope[m][k].mul_add(node, change[m]);
        }
    }
    (value, change)
}

/// Each number in all parts of a lane.
#[inline(always)]
pub(super) fn splats<L: Lane, const N: usize>(numbers: &[f64; N]) -> [L; N] {
    let mut lanes = [L::splat(0.0); N];
    for k in 0..N {
        lanes[k] = L::splat(numbers[k]);
    }
    lanes
}

/// The first `D` numbers of a lane.
#[inline(always)]
pub(super) fn vector<L: Lane, const D: usize>(lane: L) -> [f64; D] {
    let numbers = lane.array();
    let mut vector = [0.0; D];
    vector.copy_from_slice(&numbers[..D]);
    vector
}

/// A matrix from its columns.
#[inline(always)]
pub(super) fn matrix<L: Lane, const D: usize>(columns: &[L; D]) -> Matrix<D> {
    let mut matrix = Matrix::<D>::zeros();
    for a in 0..D {
        matrix.data.0[a] = vector(columns[a]);
    }
    matrix
}

/// A vector as a lane.
#[inline(always)]
pub(super) fn lane<L: Lane, const D: usize>(vector: &[f64; D]) -> L {
    let mut numbers = [0.0; 4];
    numbers[..D].copy_from_slice(vector);
    L::new(numbers)
}
