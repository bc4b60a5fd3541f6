//! The stencils of four or eight points at once.

use super::{Pass, Tile};
use crate::basis::{Basis, Functions};
use crate::real::MOST_LANES;
use crate::solver::lane::{Points, Task};
use crate::transfer::Transfer;
use std::ops::Range;

/// Rows of some points, one after the other: of a group, or of what is left of one.
#[derive(Clone, Copy)]
pub(super) struct Rows {
    pub first: usize,
    pub count: usize,
}

/// All rows of a range, four at a time or more. The standard library's steps cost a dozen instructions each.
pub(super) struct Fours(pub Range<usize>);

impl Fours {
    /// The next rows, if there are so many; they are not taken.
    #[inline(always)]
    pub(super) fn ahead(&self, count: usize) -> Option<Rows> {
        let Range { start: first, end } = self.0;
        (first + count <= end).then_some(Rows { first, count })
    }

    /// Takes so many rows.
    #[inline(always)]
    pub(super) fn drop_first(&mut self, count: usize) {
        self.0.start += count;
    }
}

impl Iterator for Fours {
    type Item = Rows;

    #[inline(always)]
    fn next(&mut self) -> Option<Rows> {
        let Range { start: first, end } = self.0;
        if first >= end {
            return None;
        }
        self.0.start = first + 4;
        let count = (end - first).min(4);
        Some(Rows { first, count })
    }
}

/// One number of each point of a group, to be read one by one or together.
#[repr(transparent)]
#[derive(Clone, Copy, Debug)]
pub(super) struct Kept<P>(P);

impl<P: Points> Kept<P> {
    /// Zeros.
    #[inline(always)]
    pub(super) fn none() -> Self {
        Self(P::splat(0.0))
    }

    #[inline(always)]
    pub(super) fn set(&mut self, numbers: P) {
        self.0 = numbers;
    }

    #[inline(always)]
    pub(super) fn get(&self) -> P {
        self.0
    }

    /// The number of point `q`.
    #[inline(always)]
    pub(super) fn of(&self, q: usize) -> f64 {
        debug_assert!(q < P::LANES);
        // SAFETY: lanes are so many numbers and nothing else
        unsafe { *(&raw const self.0).cast::<f64>().add(q) }
    }
}

/// The stencils of four or eight points, axis by axis.
pub(super) struct Group<P, const D: usize, const N: usize> {
    /// Which row of the tile has the first node of each point's stencil.
    pub row: [u32; MOST_LANES],
    /// The first node's place along the last axis of the tile.
    pub node: [u32; MOST_LANES],
    /// N_i.
    pub weight: [[Kept<P>; N]; D],
    /// dN_i/dx, 1/m.
    pub slope: [[Kept<P>; N]; D],
    /// N_i (x_i − x) / Σ N_j (x_j − x)², 1/m: the functions whose gathered velocities are the columns of APIC's C. Bases that are
    /// products of functions of one coordinate and complete to first order have no others.
    pub affine: [[Kept<P>; N]; D],
    /// Σ N_i (x_i − x)², m².
    pub inertia: [Kept<P>; D],
    /// Whether they all start at the same node, in 2D and 3D.
    pub same: bool,
}

/// Places in cells along an axis, shifted as the functions want them, and the first nodes of their stencils.
#[inline(always)]
fn start<P: Points, const N: usize, B: Basis<N>>(basis: &B, x: P, cells: i32) -> (P, P) {
    let shifted = x + P::splat(basis.shift());
    let last = P::splat(f64::from(basis.count(cells) - N as i32));
    (shifted, shifted.floor().min(last))
}

/// Whether stencils of points at the given places, m, start at the same node.
#[inline(always)]
pub(super) fn start_together<P: Points, const D: usize, const N: usize, B: Basis<N>, T>(
    pass: &Pass<D, B, T>,
    position: &[P; D],
) -> bool {
    let inverse = P::splat(pass.inverse_size);
    for a in 0..D {
        let x = (position[a] - P::splat(pass.min[a])) * inverse;
        let (_, first) = start(&pass.basis[a], x, pass.cells[a]);
        let node = first.lane(0);
        if !first.all_within(node, node) {
            return false;
        }
    }
    true
}

/// Whether there are as many points as lanes, which do not need the nodes of the middle of their cells as well.
#[inline(always)]
pub(super) fn is_whole<P: Points>(count: usize, middle: bool) -> bool {
    count == P::LANES && !middle
}

/// Which of a group's functions somebody needs.
#[derive(Clone, Copy)]
pub(super) struct Needs {
    pub slope: bool,
    pub affine: bool,
}

impl<P: Points, const D: usize, const N: usize> Group<P, D, N> {
    pub(super) fn new() -> Self {
        Self {
            row: [0; MOST_LANES],
            node: [0; MOST_LANES],
            weight: [[Kept::none(); N]; D],
            slope: [[Kept::none(); N]; D],
            affine: [[Kept::none(); N]; D],
            inertia: [Kept::none(); D],
            same: false,
        }
    }

    /// Whether these are as many points as there are lanes, and can be taken as one: they have the same nodes, and do not need those
    /// of the middle of their cells as well.
    #[inline(always)]
    pub(super) fn is_one(&self, count: usize, middle: bool) -> bool {
        self.same && is_whole::<P>(count, middle)
    }

    /// The stencils of points at the given places, m.
    #[inline(always)]
    pub(super) fn set<B: Basis<N>, T: Transfer>(
        &mut self,
        pass: &Pass<D, B, T>,
        tile: &Tile<D>,
        position: &[P; D],
        needs: Needs,
    ) {
        let inverse = P::splat(pass.inverse_size);
        let mut row = P::splat(0.0);
        let mut node = P::splat(0.0);
        for a in 0..D {
            let basis = &pass.basis[a];
            let cells = pass.cells[a];
            let x = (position[a] - P::splat(pass.min[a])) * inverse;
            let (shifted, first) = start(basis, x, cells);
            let (low, high) = basis.alike(cells);
            let sizes = (pass.cell_size, pass.inverse_size);
            if tile.alike(a, low, high) || first.all_within(f64::from(low), f64::from(high)) {
                let functions = basis.functions(shifted - first);
                self.set_axis::<B, true>(a, &functions, sizes, needs);
            } else {
                P::apart(NearEnd {
                    group: self,
                    axis: (a, basis, cells),
                    place: [x, shifted - first, first],
                    sizes,
                    needs,
                });
            }
            let local = tile.local(a, first);
            if a + 1 == D {
                node = local;
            } else {
                row = row.mul_add(P::splat(tile.width as f64), local);
            }
        }
        if D > 1 {
            let number = row.mul_add(P::splat(tile.width as f64), node);
            let first = number.lane(0);
            self.same = number.all_within(first, first);
        }
        row.whole(&mut self.row);
        node.whole(&mut self.node);
    }

    /// The functions of an axis; `ALIKE` where every point's are those of the middle of the grid.
    #[inline(always)]
    fn set_axis<B: Basis<N>, const ALIKE: bool>(
        &mut self,
        a: usize,
        functions: &Functions<P, N>,
        (cell_size, inverse_size): (f64, f64),
        needs: Needs,
    ) {
        for i in 0..N {
            self.weight[a][i].set(functions.weight[i]);
        }
        if needs.slope || (needs.affine && B::AFFINE_IS_SLOPE) {
            let inverse = P::splat(inverse_size);
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
                Some(inertia) if ALIKE => (
                    P::splat(inertia * cell_size * cell_size),
                    P::splat(1.0 / (inertia * cell_size)),
                ),
                _ => {
                    let mut inertia = P::splat(0.0);
                    for i in 0..N {
                        inertia = moment[i].mul_add(functions.arm[i], inertia);
                    }
                    let scaled = inertia * cell_size;
                    (scaled * cell_size, P::splat(1.0) / scaled)
                }
            };
            self.inertia[a].set(inertia);
            if !B::AFFINE_IS_SLOPE {
                // on the very end of a grid of splines one node has all the weight and no arm: the slopes are the limit
                let nothing = inertia.at_most(P::splat(f64::MIN_POSITIVE));
                for i in 0..N {
                    let affine = moment[i] * inverse;
                    self.affine[a][i].set(if ALIKE {
                        affine
                    } else {
                        P::select(nothing, functions.slope[i] * inverse_size, affine)
                    });
                }
            }
        }
    }
}

/// The functions along an axis of points of which some lie near an end of the grid.
struct NearEnd<'a, P, B, const D: usize, const N: usize> {
    group: &'a mut Group<P, D, N>,
    axis: (usize, &'a B, i32),
    /// In cells from the end of the grid and in the cell, and the first node.
    place: [P; 3],
    sizes: (f64, f64),
    needs: Needs,
}

impl<P: Points, B: Basis<N>, const D: usize, const N: usize> Task for NearEnd<'_, P, B, D, N> {
    #[inline(always)]
    fn run(self) {
        let (a, basis, cells) = self.axis;
        let [x, s, first] = self.place;
        let (low, high) = basis.alike(cells);
        let inside =
            P::splat(f64::from(low)).at_most(first) & first.at_most(P::splat(f64::from(high)));
        let mut functions = basis.at_end(x, first, cells);
        let same = basis.functions(s);
        for i in 0..N {
            functions.weight[i] = P::select(inside, same.weight[i], functions.weight[i]);
            functions.slope[i] = P::select(inside, same.slope[i], functions.slope[i]);
            functions.arm[i] = P::select(inside, same.arm[i], functions.arm[i]);
        }
        self.group
            .set_axis::<B, false>(a, &functions, self.sizes, self.needs);
    }
}
