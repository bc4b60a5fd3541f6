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
#[allow(clippy::too_many_arguments)]
pub(super) unsafe fn offered<L: Lane, const D: usize, const N: usize, B: Basis<N>, T: Transfer>(
    pass: &Pass<D, B, T>,
    asked: &Asked<'_, D>,
    group: &Group<D, N>,
    centre: &Centre<D, N>,
    tile: &Tile<D>,
    gradients: Option<(&mut Rates<D>, usize)>,
) -> Offered<L, D> {
    let blend = pass.transfer.ratio() < 1.0;
    // SAFETY: as the caller says
    unsafe {
        if D == 1 || group.is_whole(asked.rows.count, centre.used) && (D == 2 || group.same) {
            to_all::<L, D, N, B, T>(blend, asked, group, tile, gradients)
        } else {
            to_each::<L, D, N, B, T>(blend, asked, group, centre, tile, gradients)
        }
    }
}

/// The functions whose gathered velocities are the columns of L, and of C.
#[inline(always)]
#[allow(clippy::type_complexity)] // two of the group's sets
fn functions<T: Transfer, const D: usize, const N: usize>(
    group: &Group<D, N>,
) -> (&[[Four; N]; D], &[[Four; N]; D]) {
    let (slope, affine) = (&group.slope, &group.affine);
    (
        if T::MOVING_LEAST_SQUARES {
            affine
        } else {
            slope
        },
        if T::TAYLOR { slope } else { affine },
    )
}

/// [`offered`] to points that are taken together.
#[inline(always)]
unsafe fn to_all<L: Lane, const D: usize, const N: usize, B: Basis<N>, T: Transfer>(
    blend: bool,
    asked: &Asked<'_, D>,
    group: &Group<D, N>,
    tile: &Tile<D>,
    mut gradients: Option<(&mut Rates<D>, usize)>,
) -> Offered<L, D> {
    let Asked {
        columns,
        rows: FourRows { first, count },
        what,
        sources,
    } = *asked;
    let zero = L::splat(0.0);
    let (mut new, mut change, mut straining) = ([zero; D], [zero; D], [zero; D]);
    let (slope, own) = functions::<T, D, N>(group);
    let alike = T::MOVING_LEAST_SQUARES || T::TAYLOR;
    // SAFETY: as the caller says
    unsafe {
        if what.rate && what.same {
            if what.velocity && T::AFFINE && !alike {
                let (value, [gradient, columns_of_c]) =
                    gathered_by_all::<L, D, N, B, 2>(sources.main, group, tile, [slope, own]);
                book_all(&mut gradients, &gradient);
                columns.set_affines(first, count, &columns_of_c);
                new = value;
            } else {
                let (value, [gradient]) =
                    gathered_by_all::<L, D, N, B, 1>(sources.main, group, tile, [slope]);
                book_all(&mut gradients, &gradient);
                if what.velocity && T::AFFINE {
                    columns.set_affines(first, count, &gradient);
                }
                new = value;
            }
            straining = new;
        } else {
            if what.rate {
                let (value, [gradient]) =
                    gathered_by_all::<L, D, N, B, 1>(sources.second, group, tile, [slope]);
                book_all(&mut gradients, &gradient);
                straining = value;
            }
            if what.velocity && T::AFFINE {
                let (value, [columns_of_c]) =
                    gathered_by_all::<L, D, N, B, 1>(sources.main, group, tile, [own]);
                columns.set_affines(first, count, &columns_of_c);
                new = value;
            } else if (what.position && T::CHANGE) || (what.velocity && (blend || !T::CHANGE)) {
                new = gathered_by_all::<L, D, N, B, 0>(sources.main, group, tile, []).0;
            }
        }
        if what.velocity && T::CHANGE {
            change = gathered_by_all::<L, D, N, B, 0>(sources.change, group, tile, []).0;
        }
    }
    Offered {
        new,
        change,
        radial: straining[0],
    }
}

/// [`gather_four`] in 1D, [`gather_apart`] in 2D unless the points have the same nodes, else [`gather_same`].
#[inline(always)]
#[allow(clippy::type_complexity)] // values, and for each set of functions the columns of a gradient
unsafe fn gathered_by_all<L: Lane, const D: usize, const N: usize, B: Basis<N>, const M: usize>(
    nodes: *const Node,
    group: &Group<D, N>,
    tile: &Tile<D>,
    g: [&[[Four; N]; D]; M],
) -> ([L; D], [[[L; D]; D]; M]) {
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

/// Books the gradients of four points.
#[inline(always)]
fn book_all<L: Lane, const D: usize>(
    gradients: &mut Option<(&mut Rates<D>, usize)>,
    columns: &[[L; D]; D],
) {
    if let Some((rates, at)) = gradients {
        rates.set_four(*at, columns);
    }
}

/// [`offered`] to one point after the other, in 2D and 3D.
#[inline(always)]
unsafe fn to_each<L: Lane, const D: usize, const N: usize, B: Basis<N>, T: Transfer>(
    blend: bool,
    asked: &Asked<'_, D>,
    group: &Group<D, N>,
    centre: &Centre<D, N>,
    tile: &Tile<D>,
    mut gradients: Option<(&mut Rates<D>, usize)>,
) -> Offered<L, D> {
    let Asked {
        columns,
        rows: FourRows { first, count },
        what,
        sources,
    } = *asked;
    let zero = L::splat(0.0);
    let (mut new, mut change, mut straining) = ([zero; 4], [zero; 4], [zero; 4]);
    let (slope, own) = functions::<T, D, N>(group);
    let alike = T::MOVING_LEAST_SQUARES || T::TAYLOR;
    for q in 0..count {
        let s = Stencil { group, tile, q };
        // SAFETY: as the caller says
        unsafe {
            if what.rate && what.same {
                if what.velocity && T::AFFINE && !alike {
                    let (value, [gradient, columns_of_c]) =
                        gathered::<L, D, N, B, 2>(sources.main, &s, [slope, own]);
                    book(
                        &mut gradients,
                        columns,
                        centre,
                        &s,
                        first,
                        sources.main,
                        gradient,
                    );
                    columns.set_affine(first + q, &columns_of_c);
                    new[q] = value;
                } else {
                    let (value, [gradient]) = gathered::<L, D, N, B, 1>(sources.main, &s, [slope]);
                    book(
                        &mut gradients,
                        columns,
                        centre,
                        &s,
                        first,
                        sources.main,
                        gradient,
                    );
                    if what.velocity && T::AFFINE {
                        columns.set_affine(first + q, &gradient);
                    }
                    new[q] = value;
                }
                straining[q] = new[q];
            } else {
                if what.rate {
                    let (value, [gradient]) =
                        gathered::<L, D, N, B, 1>(sources.second, &s, [slope]);
                    book(
                        &mut gradients,
                        columns,
                        centre,
                        &s,
                        first,
                        sources.second,
                        gradient,
                    );
                    straining[q] = value;
                }
                if what.velocity && T::AFFINE {
                    let (value, [columns_of_c]) =
                        gathered::<L, D, N, B, 1>(sources.main, &s, [own]);
                    columns.set_affine(first + q, &columns_of_c);
                    new[q] = value;
                } else if (what.position && T::CHANGE) || (what.velocity && (blend || !T::CHANGE)) {
                    new[q] = gathered::<L, D, N, B, 0>(sources.main, &s, []).0;
                }
            }
            if what.velocity && T::CHANGE {
                change[q] = gathered::<L, D, N, B, 0>(sources.change, &s, []).0;
            }
        }
    }
    let [radial] = L::turn::<1>(&straining);
    Offered {
        new: L::turn::<D>(&new),
        change: L::turn::<D>(&change),
        radial,
    }
}

/// [`gather_linear`] for point `s.q`; gradients without what nodes without mass would add to them.
#[inline(always)]
unsafe fn gathered<L: Lane, const D: usize, const N: usize, B: Basis<N>, const M: usize>(
    nodes: *const Node,
    s: &Stencil<'_, D, N>,
    g: [&[[Four; N]; D]; M],
) -> (L, [[L; D]; M]) {
    // SAFETY: as the caller says
    let (value, mut gradients) = unsafe { gather_linear::<L, D, N, M>(nodes, s, g) };
    if B::SLOPES_JUMP {
        for m in 0..M {
            without_absent(value, &mut gradients[m]);
        }
    }
    (value, gradients)
}

/// Books the gradient of the point of a stencil, one of those from row `first` on, with the change of volume that its basis wants.
#[inline(always)]
unsafe fn book<L: Lane, const D: usize, const N: usize>(
    gradients: &mut Option<(&mut Rates<D>, usize)>,
    columns: &Columns<D>,
    centre: &Centre<D, N>,
    s: &Stencil<'_, D, N>,
    first: usize,
    velocities: *const Node,
    mut gradient: [L; D],
) {
    if let Some((rates, at)) = gradients {
        if centre.used {
            // SAFETY: as the caller says
            unsafe { centre.dilate(columns, s.tile, first + s.q, s.q, velocities, &mut gradient) };
        }
        rates.set(*at + s.q, &gradient);
    }
}
