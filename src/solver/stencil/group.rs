//! The stencils of four points at once.

use super::{Pass, Tile};
use crate::basis::{Basis, Functions};
use crate::solver::lane::Lane;
use crate::transfer::Transfer;
use std::ops::Range;

/// Rows of up to four points, one after the other.
#[derive(Clone, Copy)]
pub(super) struct FourRows {
    pub first: usize,
    pub count: usize,
}

/// All rows of a range, four at a time. The standard library's steps cost a dozen instructions each.
pub(super) struct Fours(pub Range<usize>);

impl Iterator for Fours {
    type Item = FourRows;

    #[inline(always)]
    fn next(&mut self) -> Option<FourRows> {
        let Range { start: first, end } = self.0;
        if first >= end {
            return None;
        }
        self.0.start = first + 4;
        let count = (end - first).min(4);
        Some(FourRows { first, count })
    }
}

/// One number of each of four points, to be read one by one or together.
#[repr(C, align(32))]
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Four(pub [f64; 4]);

impl Four {
    #[inline(always)]
    pub(super) fn set<L: Lane>(&mut self, lane: L) {
        // SAFETY: four numbers, aligned to 32 bytes
        unsafe { lane.store(self.0.as_mut_ptr()) }
    }

    #[inline(always)]
    pub(super) fn get<L: Lane>(&self) -> L {
        // SAFETY: as above
        unsafe { L::load(self.0.as_ptr()) }
    }
}

/// The stencils of four points, axis by axis.
pub(super) struct Group<const D: usize, const N: usize> {
    /// Which row of the tile has the first node of each point's stencil.
    pub row: [u32; 4],
    /// The first node's place along the last axis of the tile.
    pub node: [u32; 4],
    /// N_i.
    pub weight: [[Four; N]; D],
    /// dN_i/dx, 1/m.
    pub slope: [[Four; N]; D],
    /// N_i (x_i − x) / Σ N_j (x_j − x)², 1/m: the functions whose gathered velocities are the columns of APIC's C. Bases that are
    /// products of functions of one coordinate and complete to first order have no others.
    pub affine: [[Four; N]; D],
    /// Σ N_i (x_i − x)², m².
    pub inertia: [Four; D],
    /// Whether they all start at the same node, in 2D and 3D.
    pub same: bool,
}

/// Which of a group's functions somebody needs.
#[derive(Clone, Copy)]
pub(super) struct Needs {
    pub slope: bool,
    pub affine: bool,
}

impl<const D: usize, const N: usize> Group<D, N> {
    pub(super) fn new() -> Self {
        Self {
            row: [0; 4],
            node: [0; 4],
            weight: [[Four::default(); N]; D],
            slope: [[Four::default(); N]; D],
            affine: [[Four::default(); N]; D],
            inertia: [Four::default(); D],
            same: false,
        }
    }

    /// Whether these are four points, which do not need the nodes of the middle of their cells as well.
    #[inline(always)]
    pub(super) fn is_whole(&self, count: usize, middle: bool) -> bool {
        count == 4 && !middle
    }

    /// Whether these are four points that can be taken as one: they have the same nodes.
    #[inline(always)]
    pub(super) fn is_one(&self, count: usize, middle: bool) -> bool {
        self.same && self.is_whole(count, middle)
    }

    /// The stencils of points at the given places, m.
    #[inline(always)]
    pub(super) fn set<L: Lane, B: Basis<N>, T: Transfer>(
        &mut self,
        pass: &Pass<D, B, T>,
        tile: &Tile<D>,
        position: &[L; D],
        needs: Needs,
    ) {
        let inverse = L::splat(pass.inverse_size);
        let mut row = L::splat(0.0);
        let mut node = L::splat(0.0);
        for a in 0..D {
            let basis = &pass.basis[a];
            let cells = pass.cells[a];
            let x = (position[a] - L::splat(pass.min[a])) * inverse;
            let shifted = x + L::splat(basis.shift());
            let first = shifted
                .floor()
                .min(L::splat(f64::from(basis.count(cells) - N as i32)));
            let (low, high) = basis.alike(cells);
            if tile.alike(a, low, high) || first.all_within(f64::from(low), f64::from(high)) {
                let functions = basis.functions(shifted - first);
                let sizes = (pass.cell_size, pass.inverse_size);
                self.set_axis::<L, B>(a, &functions, sizes, needs);
            } else {
                self.set_one_by_one(a, basis, x.array(), cells, pass.cell_size, needs);
            }
            let local = tile.local(a, first);
            if a + 1 == D {
                node = local;
            } else {
                row = row.mul_add(L::splat(tile.width as f64), local);
            }
        }
        if D > 1 {
            let number = row.mul_add(L::splat(tile.width as f64), node);
            let first = number.lane(0);
            self.same = number.all_within(first, first);
        }
        self.row = row.whole();
        self.node = node.whole();
    }

    #[inline(always)]
    fn set_axis<L: Lane, B: Basis<N>>(
        &mut self,
        a: usize,
        functions: &Functions<L, N>,
        (cell_size, inverse_size): (f64, f64),
        needs: Needs,
    ) {
        for i in 0..N {
            self.weight[a][i].set(functions.weight[i]);
        }
        if needs.slope || (needs.affine && B::AFFINE_IS_SLOPE) {
            let inverse = L::splat(inverse_size);
            for i in 0..N {
                let slope = functions.slope[i] * inverse;
                if needs.slope {
                    self.slope[a][i].set(slope);
                }
                if B::AFFINE_IS_SLOPE {
                    self.affine[a][i].set(slope);
                }
            }
        }
        if needs.affine {
            let mut moment = functions.arm;
            for i in 0..N {
                moment[i] = functions.weight[i] * functions.arm[i];
            }
            let (inertia, inverse) = match B::INERTIA {
                Some(inertia) => (
                    L::splat(inertia * cell_size * cell_size),
                    L::splat(1.0 / (inertia * cell_size)),
                ),
                None => {
                    let mut inertia = L::splat(0.0);
                    for i in 0..N {
                        inertia = moment[i].mul_add(functions.arm[i], inertia);
                    }
                    let scaled = inertia * cell_size;
                    (scaled * cell_size, L::splat(1.0) / scaled)
                }
            };
            self.inertia[a].set(inertia);
            if !B::AFFINE_IS_SLOPE {
                for i in 0..N {
                    self.affine[a][i].set(moment[i] * inverse);
                }
            }
        }
    }

    /// Where functions differ from cell to cell.
    #[inline(never)]
    fn set_one_by_one<B: Basis<N>>(
        &mut self,
        a: usize,
        basis: &B,
        x: [f64; 4],
        cells: i32,
        cell_size: f64,
        needs: Needs,
    ) {
        for q in 0..4 {
            let axis = basis.axis(x[q], cells);
            let mut inertia = 0.0;
            for i in 0..N {
                inertia += axis.weight[i] * axis.arm[i] * axis.arm[i];
            }
            // on the very end of a grid of splines one node has all the weight and no arm: the slopes are the limit
            let plain = B::AFFINE_IS_SLOPE || inertia <= f64::MIN_POSITIVE;
            for i in 0..N {
                let slope = axis.slope[i] / cell_size;
                self.weight[a][i].0[q] = axis.weight[i];
                if needs.slope {
                    self.slope[a][i].0[q] = slope;
                }
                if needs.affine {
                    self.affine[a][i].0[q] = if plain {
                        slope
                    } else {
                        axis.weight[i] * axis.arm[i] / (inertia * cell_size)
                    };
                }
            }
            self.inertia[a].0[q] = inertia * cell_size * cell_size;
        }
    }
}
