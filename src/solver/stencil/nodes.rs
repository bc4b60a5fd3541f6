//! From one point to the nodes of its stencil and back: the innermost loops.

use super::Tile;
use super::group::{Group, Kept};
use crate::grid::Node;
use crate::solver::lane::{Lane, Points};

/// The stencil of one point of a group, with the functions along the last axis, which every row of nodes needs.
pub(super) struct Stencil<'a, P, const D: usize, const N: usize> {
    pub group: &'a Group<P, D, N>,
    pub tile: &'a Tile<D>,
    /// Which of its points.
    pub q: usize,
}

impl<L: Lane, const D: usize, const N: usize> Stencil<'_, L, D, N> {
    /// N_i along axis `a`, in all parts of a lane.
    #[inline(always)]
    fn weight(&self, a: usize, i: usize) -> L {
        self.splat(&self.group.weight[a][i])
    }

    #[inline(always)]
    fn weights(&self, a: usize) -> [L; N] {
        self.all(&self.group.weight[a])
    }

    /// The number of this point, in all parts of a lane.
    #[inline(always)]
    pub(super) fn splat(&self, numbers: &Kept<L>) -> L {
        L::splat(numbers.of(self.q))
    }

    /// The numbers of this point, each in all parts of a lane.
    #[inline(always)]
    fn all(&self, numbers: &[Kept<L>; N]) -> [L; N] {
        let mut lanes = [L::splat(0.0); N];
        for i in 0..N {
            lanes[i] = self.splat(&numbers[i]);
        }
        lanes
    }
}

impl<P: Points, const D: usize, const N: usize> Stencil<'_, P, D, N> {
    /// The first node of the stencil's row (i, j), for an array that starts at `nodes`.
    #[inline(always)]
    pub(super) unsafe fn row(&self, nodes: *mut Node, i: usize, j: usize) -> *mut f64 {
        let number = match D {
            1 => 0,
            2 => self.group.row[self.q] as usize + i,
            _ => self.group.row[self.q] as usize + i * self.tile.width + j,
        };
        // SAFETY: the tile addresses stored nodes only (module header)
        unsafe {
            let row = self.tile.row(number);
            nodes
                .wrapping_add(self.group.node[self.q] as usize)
                .wrapping_byte_offset(row)
                .cast()
        }
    }
}

/// What a point gives to every node I = (i₁ … i_D) of its stencil: `value Π_a N_a`, and `Σ_a slant_a[i_a] Π_{b≠a} N_b`, where
/// the slant along an axis takes the place of that axis' function, as the slope does in a gradient.
pub(super) struct Gift<L, const D: usize, const N: usize> {
    pub value: L,
    pub slant: [[L; N]; D],
}

/// Adds `value` of the gift to the nodes of `of_value` if `VALUE`, and its slants to those of `of_slant` if `SLANT`; if there is
/// no `VALUE`, then the gift's value is counted with the slants.
#[inline(always)]
pub(super) unsafe fn scatter_gift<
    L: Lane,
    const D: usize,
    const N: usize,
    const VALUE: bool,
    const SLANT: bool,
>(
    of_value: *mut Node,
    of_slant: *mut Node,
    s: &Stencil<'_, L, D, N>,
    gift: &Gift<L, D, N>,
) {
    let last: [L; N] = s.weights(D - 1);
    match D {
        1 => {
            // SAFETY: the tile addresses stored nodes only (module header)
            unsafe {
                let (values, slants) = (s.row(of_value, 0, 0), s.row(of_slant, 0, 0));
                for k in 0..N {
                    if VALUE {
                        add(values, k, gift.value, last[k]);
                        if SLANT {
                            add_whole(slants, k, gift.slant[0][k]);
                        }
                    } else {
                        add_whole(slants, k, gift.value.mul_add(last[k], gift.slant[0][k]));
                    }
                }
            }
        }
        2 => {
            for i in 0..N {
                let wi: L = s.weight(0, i);
                let mut along = gift.slant[0][i];
                if !VALUE {
                    along = gift.value.mul_add(wi, along);
                }
                // SAFETY: as above
                unsafe {
                    if VALUE {
                        let (values, row) = (s.row(of_value, i, 0), gift.value * wi);
                        for k in 0..N {
                            add(values, k, row, last[k]);
                        }
                    }
                    if SLANT {
                        let slants = s.row(of_slant, i, 0);
                        for k in 0..N {
                            add_both(slants, k, along, last[k], wi, gift.slant[1][k]);
                        }
                    }
                }
            }
        }
        _ => {
            let middle: [L; N] = s.weights(1);
            // not N, see `Tile::n`
            for i in 0..s.tile.n {
                let wi: L = s.weight(0, i);
                let mut along = gift.slant[0][i];
                if !VALUE {
                    along = gift.value.mul_add(wi, along);
                }
                for j in 0..N {
                    let wij = wi * middle[j];
                    // SAFETY: as above
                    unsafe {
                        if VALUE {
                            let (values, row) = (s.row(of_value, i, j), gift.value * wij);
                            for k in 0..N {
                                add(values, k, row, last[k]);
                            }
                        }
                        if SLANT {
                            let slants = s.row(of_slant, i, j);
                            let row = along.mul_add(middle[j], wi * gift.slant[1][j]);
                            for k in 0..N {
                                add_both(slants, k, row, last[k], wij, gift.slant[2][k]);
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Node k of a row gets `a`.
#[inline(always)]
unsafe fn add_whole<L: Lane>(row: *mut f64, k: usize, a: L) {
    // SAFETY: the caller's row has a node k
    unsafe {
        let node = row.add(4 * k);
        (a + L::load(node)).store(node);
    }
}

/// Node k of a row gets `a b`.
#[inline(always)]
unsafe fn add<L: Lane>(row: *mut f64, k: usize, a: L, b: L) {
    // SAFETY: the caller's row has a node k
    unsafe {
        let node = row.add(4 * k);
        a.mul_add(b, L::load(node)).store(node);
    }
}

/// Node k of a row gets `a b + c d`.
#[inline(always)]
unsafe fn add_both<L: Lane>(row: *mut f64, k: usize, a: L, b: L, c: L, d: L) {
    // SAFETY: the caller's row has a node k
    unsafe {
        let node = row.add(4 * k);
        let sum = a.mul_add(b, L::load(node));
        c.mul_add(d, sum).store(node);
    }
}

/// For nodes that hold a velocity and, as number `D`, 1 (0 where no mass came):
/// Σ_I N_I node_I, and for each set of functions `g[m]` and each axis a the same with `g[m]` in place of N along that axis: with
/// the slopes Σ_I ∂_a N_I node_I. All sets together read the nodes once. In 2D and 3D; in 1D
/// there is [`gather_four`](super::line::gather_four).
#[inline(always)]
pub(super) unsafe fn gather_linear<L: Lane, const D: usize, const N: usize, const M: usize>(
    nodes: *const Node,
    s: &Stencil<'_, L, D, N>,
    g: [&[[Kept<L>; N]; D]; M],
) -> (L, [[L; D]; M]) {
    let nodes = nodes.cast_mut();
    let zero = L::splat(0.0);
    let last: [L; N] = s.weights(D - 1);
    let mut slant = [[zero; N]; M];
    for m in 0..M {
        slant[m] = s.all(&g[m][D - 1]);
    }
    let mut gradient = [[zero; D]; M];
    let mut sum = zero;
    match D {
        2 => {
            for i in 0..N {
                // SAFETY: the tile addresses stored nodes only (module header)
                let (value, change) = unsafe { gather_row(s.row(nodes, i, 0), &last, &slant) };
                let wi: L = s.weight(0, i);
                sum = wi.mul_add(value, sum);
                for m in 0..M {
                    let gi = s.splat(&g[m][0][i]);
                    gradient[m][0] = gi.mul_add(value, gradient[m][0]);
                    gradient[m][1] = wi.mul_add(change[m], gradient[m][1]);
                }
            }
        }
        _ => {
            // not N, see `Tile::n`
            for i in 0..s.tile.n {
                let (mut value, mut dy, mut dz) = (zero, [zero; M], [zero; M]);
                for j in 0..N {
                    // SAFETY: as above
                    let (v, c) = unsafe { gather_row(s.row(nodes, i, j), &last, &slant) };
                    let wj: L = s.weight(1, j);
                    value = wj.mul_add(v, value);
                    for m in 0..M {
                        let gj = s.splat(&g[m][1][j]);
                        dy[m] = gj.mul_add(v, dy[m]);
                        dz[m] = wj.mul_add(c[m], dz[m]);
                    }
                }
                let wi: L = s.weight(0, i);
                sum = wi.mul_add(value, sum);
                for m in 0..M {
                    let gi = s.splat(&g[m][0][i]);
                    gradient[m][0] = gi.mul_add(value, gradient[m][0]);
                    gradient[m][1] = wi.mul_add(dy[m], gradient[m][1]);
                    gradient[m][2] = wi.mul_add(dz[m], gradient[m][2]);
                }
            }
        }
    }
    (sum, gradient)
}

/// Nodes without mass have no velocity: what is missing in Σ ∂N_I over the others is made up with the point's own velocity.
/// (A point of the linear basis that lies on a node has a slope, but no weight, at the node ahead.)
#[inline(always)]
pub(super) fn without_absent<L: Lane, const D: usize>(value: L, gradient: &mut [L; D]) {
    for a in 0..D {
        let present = match D {
            1 => gradient[a].broadcast::<1>(),
            2 => gradient[a].broadcast::<2>(),
            _ => gradient[a].broadcast::<3>(),
        };
        gradient[a] = (-present).mul_add(value, gradient[a]);
    }
}

/// Value and slants along the last axis of N nodes in a row. A function and not a closure: closures are not always inlined,
/// and outside the kernels that are compiled for them wide instructions become calls.
#[inline(always)]
unsafe fn gather_row<L: Lane, const N: usize, const M: usize>(
    row: *const f64,
    weight: &[L; N],
    slant: &[[L; N]; M],
) -> (L, [L; M]) {
    // SAFETY: the caller vouches for N nodes
    let node = unsafe { L::load(row) };
    let mut value = weight[0] * node;
    let mut change = [value; M];
    for m in 0..M {
        change[m] = slant[m][0] * node;
    }
    for k in 1..N {
        // SAFETY: as above
        let node = unsafe { L::load(row.add(4 * k)) };
        value = weight[k].mul_add(node, value);
        for m in 0..M {
            change[m] = slant[m][k].mul_add(node, change[m]);
        }
    }
    (value, change)
}
