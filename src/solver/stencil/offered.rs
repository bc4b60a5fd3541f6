//! What the grid offers to a group of points: to all at once where that pays, else to one after the other.

use super::apart::gather_apart;
use super::dilation::Centre;
use super::group::{Group, Kept, Rows, is_whole};
use super::line::gather_four;
use super::nodes::{Stencil, gather_linear, without_absent};
use super::same::gather_same;
use super::{Columns, Pass, Rates, Sources, Tile, Wanted};
use crate::basis::Basis;
use crate::grid::Node;
use crate::solver::lane::{Lane, Points};
use crate::transfer::Transfer;

/// Velocities that the grid offers to a group of points, m/s.
pub(super) struct Offered<P, const D: usize> {
    /// At the end of the step.
    pub new: [P; D],
    /// Their change over the step.
    pub change: [P; D],
    /// Along r, of those that strain the points.
    pub radial: P,
}

/// What a pass wants of the nodes, and of whom.
pub(super) struct Asked<'a, const D: usize> {
    pub columns: &'a Columns<D>,
    pub rows: Rows,
    pub what: Wanted,
    pub sources: &'a Sources,
}

/// What the grid offers to a group of points that have the same nodes; affine fields are stored, gradients booked from a place of
/// `gradients` on.
///
/// # Safety
/// As for [`gather`](super::gather()); the functions of the points are those in `group`, which is taken as one.
#[inline(always)]
pub(super) unsafe fn offered_to_one<
    P: Points,
    const D: usize,
    const N: usize,
    B: Basis<N>,
    T: Transfer,
>(
    pass: &Pass<D, B, T>,
    asked: &Asked<'_, D>,
    group: &Group<P, D, N>,
    tile: &Tile<D>,
    mut gradients: Option<(&mut Rates<D>, usize)>,
) -> Offered<P, D> {
    let same = Same { asked, group, tile };
    // SAFETY: as the caller says
    unsafe { same.take::<B, T>(pass, &mut gradients) }.offered()
}

/// What the grid offers to at most four points, as [`offered_to_one`] says.
///
/// # Safety
/// As there, but points may be fewer and have any nodes.
#[inline(always)]
pub(super) unsafe fn offered<L: Lane, const D: usize, const N: usize, B: Basis<N>, T: Transfer>(
    pass: &Pass<D, B, T>,
    asked: &Asked<'_, D>,
    group: &Group<L, D, N>,
    centre: &Centre<L, D, N>,
    tile: &Tile<D>,
    mut gradients: Option<(&mut Rates<D>, usize)>,
) -> Offered<L, D> {
    let count = asked.rows.count;
    if D > 1 && group.is_one(count, centre.used) {
        // SAFETY: as the caller says
        return unsafe { offered_to_one(pass, asked, group, tile, gradients) };
    }
    if D == 1 || D == 2 && is_whole::<L>(count, centre.used) {
        let any = Any { asked, group, tile };
        // SAFETY: as the caller says
        return unsafe { any.take::<B, T>(pass, &mut gradients) }.offered();
    }
    let zero = L::splat(0.0);
    let (mut new, mut change, mut straining) = ([zero; 4], [zero; 4], [zero; 4]);
    for q in 0..count {
        let s = Stencil { group, tile, q };
        let one = One { asked, s, centre };
        // SAFETY: as the caller says
        let taken = unsafe { one.take::<B, T>(pass, &mut gradients) };
        (new[q], change[q], straining[q]) = (taken.new, taken.change, taken.straining);
    }
    let [radial] = L::turn::<1>(&straining);
    Offered {
        new: L::turn::<D>(&new),
        change: L::turn::<D>(&change),
        radial,
    }
}

/// Velocities that were taken.
struct Taken<V> {
    /// At the end of the step.
    new: V,
    /// Their change over the step.
    change: V,
    /// Those that strain the points.
    straining: V,
}

impl<P: Points, const D: usize> Taken<[P; D]> {
    #[inline(always)]
    fn offered(self) -> Offered<P, D> {
        Offered {
            new: self.new,
            change: self.change,
            radial: self.straining[0],
        }
    }
}

/// Where gradients go, and from which place on.
type Gradients<'a, 'b, const D: usize> = &'a mut Option<(&'b mut Rates<D>, usize)>;

/// Who takes from the grid at once: all points of a group, or one of them.
trait Taker<P: Points, const D: usize, const N: usize> {
    /// Their velocity.
    type Velocity: Copy;
    /// The columns of a gradient of theirs.
    type Columns: Copy;

    fn asked(&self) -> &Asked<'_, D>;

    fn group(&self) -> &Group<P, D, N>;

    fn at_rest() -> Self::Velocity;

    /// What [`gather_same`] says.
    unsafe fn gathered<B: Basis<N>, const M: usize>(
        &self,
        nodes: *const Node,
        g: [&[[Kept<P>; N]; D]; M],
    ) -> (Self::Velocity, [Self::Columns; M]);

    /// Books a gradient of `velocities`.
    unsafe fn book(
        &self,
        gradients: Gradients<'_, '_, D>,
        velocities: *const Node,
        gradient: Self::Columns,
    );

    /// Stores affine fields.
    unsafe fn set_affine(&self, field: &Self::Columns);

    /// Takes what is asked for.
    #[inline(always)]
    unsafe fn take<B: Basis<N>, T: Transfer>(
        &self,
        pass: &Pass<D, B, T>,
        gradients: Gradients<'_, '_, D>,
    ) -> Taken<Self::Velocity> {
        let blend = pass.transfer.ratio() < 1.0;
        let (what, sources) = (self.asked().what, self.asked().sources);
        let group = self.group();
        // whose gathered velocities are the columns of L, and of C
        let slope = if T::MOVING_LEAST_SQUARES {
            &group.affine
        } else {
            &group.slope
        };
        let own = if T::TAYLOR {
            &group.slope
        } else {
            &group.affine
        };
        let alike = T::MOVING_LEAST_SQUARES || T::TAYLOR;
        let rest = Self::at_rest();
        let (mut new, mut change, mut straining) = (rest, rest, rest);
        // SAFETY: as the caller says
        unsafe {
            if what.rate && what.same {
                let main = sources.main;
                if what.velocity && T::AFFINE && !alike {
                    let (value, [gradient, field]) = self.gathered::<B, 2>(main, [slope, own]);
                    self.book(gradients, main, gradient);
                    self.set_affine(&field);
                    new = value;
                } else {
                    let (value, [gradient]) = self.gathered::<B, 1>(main, [slope]);
                    self.book(gradients, main, gradient);
                    if what.velocity && T::AFFINE {
                        self.set_affine(&gradient);
                    }
                    new = value;
                }
                straining = new;
            } else {
                if what.rate {
                    let second = sources.second;
                    let (value, [gradient]) = self.gathered::<B, 1>(second, [slope]);
                    self.book(gradients, second, gradient);
                    straining = value;
                }
                if what.velocity && T::AFFINE {
                    let (value, [field]) = self.gathered::<B, 1>(sources.main, [own]);
                    self.set_affine(&field);
                    new = value;
                } else if (what.position && T::CHANGE) || (what.velocity && (blend || !T::CHANGE)) {
                    new = self.gathered::<B, 0>(sources.main, []).0;
                }
            }
            if what.velocity && T::CHANGE {
                change = self.gathered::<B, 0>(sources.change, []).0;
            }
        }
        Taken {
            new,
            change,
            straining,
        }
    }
}

/// Books the gradients of all points of a group.
#[inline(always)]
fn book_all<P: Points, const D: usize>(gradients: Gradients<'_, '_, D>, gradient: &[[P; D]; D]) {
    if let Some((rates, at)) = gradients {
        rates.set_all(*at, gradient);
    }
}

impl<const D: usize> Asked<'_, D> {
    /// Stores the affine fields of all points of a group.
    #[inline(always)]
    unsafe fn set_affines<P: Points>(&self, field: &[[P; D]; D]) {
        let Rows { first, count } = self.rows;
        // SAFETY: as the caller says
        unsafe { self.columns.set_affines(first, count, field) }
    }
}

/// All points of a group, which have the same nodes.
struct Same<'a, P, const D: usize, const N: usize> {
    asked: &'a Asked<'a, D>,
    group: &'a Group<P, D, N>,
    tile: &'a Tile<D>,
}

impl<P: Points, const D: usize, const N: usize> Taker<P, D, N> for Same<'_, P, D, N> {
    type Velocity = [P; D];
    type Columns = [[P; D]; D];

    #[inline(always)]
    fn asked(&self) -> &Asked<'_, D> {
        self.asked
    }

    #[inline(always)]
    fn group(&self) -> &Group<P, D, N> {
        self.group
    }

    #[inline(always)]
    fn at_rest() -> [P; D] {
        [P::splat(0.0); D]
    }

    #[inline(always)]
    unsafe fn gathered<B: Basis<N>, const M: usize>(
        &self,
        nodes: *const Node,
        g: [&[[Kept<P>; N]; D]; M],
    ) -> ([P; D], [[[P; D]; D]; M]) {
        // SAFETY: as the caller says
        unsafe { gather_same::<P, D, N, B, M>(nodes, self.group, self.tile, g) }
    }

    #[inline(always)]
    unsafe fn book(&self, gradients: Gradients<'_, '_, D>, _: *const Node, gradient: [[P; D]; D]) {
        book_all(gradients, &gradient);
    }

    #[inline(always)]
    unsafe fn set_affine(&self, field: &[[P; D]; D]) {
        // SAFETY: as the caller says
        unsafe { self.asked.set_affines(field) }
    }
}

/// All points of a group, whatever their nodes: in 1D, and in 2D as many as there are lanes.
struct Any<'a, L, const D: usize, const N: usize> {
    asked: &'a Asked<'a, D>,
    group: &'a Group<L, D, N>,
    tile: &'a Tile<D>,
}

impl<L: Lane, const D: usize, const N: usize> Taker<L, D, N> for Any<'_, L, D, N> {
    type Velocity = [L; D];
    type Columns = [[L; D]; D];

    #[inline(always)]
    fn asked(&self) -> &Asked<'_, D> {
        self.asked
    }

    #[inline(always)]
    fn group(&self) -> &Group<L, D, N> {
        self.group
    }

    #[inline(always)]
    fn at_rest() -> [L; D] {
        [L::splat(0.0); D]
    }

    #[inline(always)]
    unsafe fn gathered<B: Basis<N>, const M: usize>(
        &self,
        nodes: *const Node,
        g: [&[[Kept<L>; N]; D]; M],
    ) -> ([L; D], [[[L; D]; D]; M]) {
        let (group, tile) = (self.group, self.tile);
        // SAFETY: as the caller says
        unsafe {
            if D == 1 {
                gather_four::<L, D, N, M>(nodes, group, tile, g, B::SLOPES_JUMP)
            } else {
                gather_apart::<L, D, N, B, M>(nodes, group, tile, g)
            }
        }
    }

    #[inline(always)]
    unsafe fn book(&self, gradients: Gradients<'_, '_, D>, _: *const Node, gradient: [[L; D]; D]) {
        book_all(gradients, &gradient);
    }

    #[inline(always)]
    unsafe fn set_affine(&self, field: &[[L; D]; D]) {
        // SAFETY: as the caller says
        unsafe { self.asked.set_affines(field) }
    }
}

/// One point of a group, in 2D and 3D.
struct One<'a, L, const D: usize, const N: usize> {
    asked: &'a Asked<'a, D>,
    s: Stencil<'a, L, D, N>,
    centre: &'a Centre<L, D, N>,
}

impl<L: Lane, const D: usize, const N: usize> Taker<L, D, N> for One<'_, L, D, N> {
    type Velocity = L;
    type Columns = [L; D];

    #[inline(always)]
    fn asked(&self) -> &Asked<'_, D> {
        self.asked
    }

    #[inline(always)]
    fn group(&self) -> &Group<L, D, N> {
        self.s.group
    }

    #[inline(always)]
    fn at_rest() -> L {
        L::splat(0.0)
    }

    /// [`gather_linear`]; gradients without what nodes without mass would add to them.
    #[inline(always)]
    unsafe fn gathered<B: Basis<N>, const M: usize>(
        &self,
        nodes: *const Node,
        g: [&[[Kept<L>; N]; D]; M],
    ) -> (L, [[L; D]; M]) {
        // SAFETY: as the caller says
        let (value, mut gradients) = unsafe { gather_linear::<L, D, N, M>(nodes, &self.s, g) };
        if B::SLOPES_JUMP {
            for m in 0..M {
                without_absent(value, &mut gradients[m]);
            }
        }
        (value, gradients)
    }

    /// Books a gradient, with the change of volume that its basis wants.
    #[inline(always)]
    unsafe fn book(
        &self,
        gradients: Gradients<'_, '_, D>,
        velocities: *const Node,
        mut gradient: [L; D],
    ) {
        let Some((rates, at)) = gradients else {
            return;
        };
        let (s, columns) = (&self.s, self.asked.columns);
        if self.centre.used {
            let p = self.asked.rows.first + s.q;
            let centre = self.centre;
            // SAFETY: as the caller says
            unsafe { centre.dilate(columns, s.tile, p, s.q, velocities, &mut gradient) };
        }
        rates.set(*at + s.q, &gradient);
    }

    #[inline(always)]
    unsafe fn set_affine(&self, field: &[L; D]) {
        let p = self.asked.rows.first + self.s.q;
        // SAFETY: as the caller says
        unsafe { self.asked.columns.set_affine(p, field) }
    }
}
