//! What the grid offers to four points: to all at once where that pays, else to one after the other.

use super::apart::gather_apart;
use super::dilation::Centre;
use super::group::{Four, FourRows, Group};
use super::line::gather_four;
use super::nodes::{Stencil, gather_linear, without_absent};
use super::same::gather_same;
use super::{Columns, Pass, Rates, Sources, Tile, Wanted};
use crate::basis::Basis;
use crate::grid::Node;
use crate::solver::lane::Lane;
use crate::transfer::Transfer;

/// Velocities that the grid offers to four points, m/s.
pub(super) struct Offered<L, const D: usize> {
    /// At the end of the step.
    pub new: [L; D],
    /// Their change over the step.
    pub change: [L; D],
    /// Along r, of those that strain the points.
    pub radial: L,
}

/// What a pass wants of the nodes, and of whom.
pub(super) struct Asked<'a, const D: usize> {
    pub columns: &'a Columns<D>,
    pub rows: FourRows,
    pub what: Wanted,
    pub sources: &'a Sources,
}

/// What the grid offers to four points; affine fields are stored, gradients booked from a place of `gradients` on.
///
/// # Safety
/// As for [`gather`](super::gather()); the functions of the points are those in `group`.
#[inline(always)]
pub(super) unsafe fn offered<L: Lane, const D: usize, const N: usize, B: Basis<N>, T: Transfer>(
    pass: &Pass<D, B, T>,
    asked: &Asked<'_, D>,
    group: &Group<D, N>,
    centre: &Centre<D, N>,
    tile: &Tile<D>,
    mut gradients: Option<(&mut Rates<D>, usize)>,
) -> Offered<L, D> {
    let blend = pass.transfer.ratio() < 1.0;
    let count = asked.rows.count;
    if D == 1 || group.is_whole(count, centre.used) && (D == 2 || group.same) {
        let all = All { asked, group, tile };
        // SAFETY: as the caller says
        let taken = unsafe { all.take::<L, B, T>(blend, &mut gradients) };
        return Offered {
            new: taken.new,
            change: taken.change,
            radial: taken.straining[0],
        };
    }
    let zero = L::splat(0.0);
    let (mut new, mut change, mut straining) = ([zero; 4], [zero; 4], [zero; 4]);
    for q in 0..count {
        let s = Stencil { group, tile, q };
        let one = One { asked, s, centre };
        // SAFETY: as the caller says
        let taken = unsafe { one.take::<L, B, T>(blend, &mut gradients) };
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

/// Where gradients go, and from which place on.
type Gradients<'a, 'b, const D: usize> = &'a mut Option<(&'b mut Rates<D>, usize)>;

/// Who takes from the grid at once: all points of a group, or one of them.
trait Taker<const D: usize, const N: usize> {
    /// Their velocity.
    type Velocity<L: Lane>: Copy;
    /// The columns of a gradient of theirs.
    type Columns<L: Lane>: Copy;

    fn asked(&self) -> &Asked<'_, D>;

    fn group(&self) -> &Group<D, N>;

    fn at_rest<L: Lane>() -> Self::Velocity<L>;

    /// What [`gather_same`] says.
    unsafe fn gathered<L: Lane, B: Basis<N>, const M: usize>(
        &self,
        nodes: *const Node,
        g: [&[[Four; N]; D]; M],
    ) -> (Self::Velocity<L>, [Self::Columns<L>; M]);

    /// Books a gradient of `velocities`.
    unsafe fn book<L: Lane>(
        &self,
        gradients: Gradients<'_, '_, D>,
        velocities: *const Node,
        gradient: Self::Columns<L>,
    );

    /// Stores affine fields.
    unsafe fn set_affine<L: Lane>(&self, field: &Self::Columns<L>);

    /// Takes what is asked for.
    #[inline(always)]
    unsafe fn take<L: Lane, B: Basis<N>, T: Transfer>(
        &self,
        blend: bool,
        gradients: Gradients<'_, '_, D>,
    ) -> Taken<Self::Velocity<L>> {
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
        let rest = Self::at_rest::<L>();
        let (mut new, mut change, mut straining) = (rest, rest, rest);
        // SAFETY: as the caller says
        unsafe {
            if what.rate && what.same {
                let main = sources.main;
                if what.velocity && T::AFFINE && !alike {
                    let (value, [gradient, field]) = self.gathered::<L, B, 2>(main, [slope, own]);
                    self.book(gradients, main, gradient);
                    self.set_affine(&field);
                    new = value;
                } else {
                    let (value, [gradient]) = self.gathered::<L, B, 1>(main, [slope]);
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
                    let (value, [gradient]) = self.gathered::<L, B, 1>(second, [slope]);
                    self.book(gradients, second, gradient);
                    straining = value;
                }
                if what.velocity && T::AFFINE {
                    let (value, [field]) = self.gathered::<L, B, 1>(sources.main, [own]);
                    self.set_affine(&field);
                    new = value;
                } else if (what.position && T::CHANGE) || (what.velocity && (blend || !T::CHANGE)) {
                    new = self.gathered::<L, B, 0>(sources.main, []).0;
                }
            }
            if what.velocity && T::CHANGE {
                change = self.gathered::<L, B, 0>(sources.change, []).0;
            }
        }
        Taken {
            new,
            change,
            straining,
        }
    }
}

/// All points of a group.
struct All<'a, const D: usize, const N: usize> {
    asked: &'a Asked<'a, D>,
    group: &'a Group<D, N>,
    tile: &'a Tile<D>,
}

impl<const D: usize, const N: usize> Taker<D, N> for All<'_, D, N> {
    type Velocity<L: Lane> = [L; D];
    type Columns<L: Lane> = [[L; D]; D];

    #[inline(always)]
    fn asked(&self) -> &Asked<'_, D> {
        self.asked
    }

    #[inline(always)]
    fn group(&self) -> &Group<D, N> {
        self.group
    }

    #[inline(always)]
    fn at_rest<L: Lane>() -> [L; D] {
        [L::splat(0.0); D]
    }

    #[inline(always)]
    unsafe fn gathered<L: Lane, B: Basis<N>, const M: usize>(
        &self,
        nodes: *const Node,
        g: [&[[Four; N]; D]; M],
    ) -> ([L; D], [[[L; D]; D]; M]) {
        let (group, tile) = (self.group, self.tile);
        // SAFETY: as the caller says
        unsafe {
            if D == 1 {
                gather_four::<L, D, N, M>(nodes, group, tile, g, B::SLOPES_JUMP)
            } else if D == 2 && !group.same {
                gather_apart::<L, D, N, B, M>(nodes, group, tile, g)
            } else {
                gather_same::<L, D, N, B, M>(nodes, group, tile, g)
            }
        }
    }

    #[inline(always)]
    unsafe fn book<L: Lane>(
        &self,
        gradients: Gradients<'_, '_, D>,
        _: *const Node,
        gradient: [[L; D]; D],
    ) {
        if let Some((rates, at)) = gradients {
            rates.set_four(*at, &gradient);
        }
    }

    #[inline(always)]
    unsafe fn set_affine<L: Lane>(&self, field: &[[L; D]; D]) {
        let FourRows { first, count } = self.asked.rows;
        // SAFETY: as the caller says
        unsafe { self.asked.columns.set_affines(first, count, field) }
    }
}

/// One point of a group, in 2D and 3D.
struct One<'a, const D: usize, const N: usize> {
    asked: &'a Asked<'a, D>,
    s: Stencil<'a, D, N>,
    centre: &'a Centre<D, N>,
}

impl<const D: usize, const N: usize> Taker<D, N> for One<'_, D, N> {
    type Velocity<L: Lane> = L;
    type Columns<L: Lane> = [L; D];

    #[inline(always)]
    fn asked(&self) -> &Asked<'_, D> {
        self.asked
    }

    #[inline(always)]
    fn group(&self) -> &Group<D, N> {
        self.s.group
    }

    #[inline(always)]
    fn at_rest<L: Lane>() -> L {
        L::splat(0.0)
    }

    /// [`gather_linear`]; gradients without what nodes without mass would add to them.
    #[inline(always)]
    unsafe fn gathered<L: Lane, B: Basis<N>, const M: usize>(
        &self,
        nodes: *const Node,
        g: [&[[Four; N]; D]; M],
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
    unsafe fn book<L: Lane>(
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
    unsafe fn set_affine<L: Lane>(&self, field: &[L; D]) {
        let p = self.asked.rows.first + self.s.q;
        // SAFETY: as the caller says
        unsafe { self.asked.columns.set_affine(p, field) }
    }
}
