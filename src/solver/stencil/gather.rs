//! From the grid to points.

use super::dilation::Centre;
use super::group::{Fours, Group, Needs, Rows};
use super::offered::{Asked, Offered, offered, offered_to_one};
use super::same::Gifts;
use super::scatter::{Scattered, scatter_one, scatter_rows};
use super::wider::Wider;
use super::{Columns, Pass, Rates, Reach, Tile, Wanted};
use crate::basis::Basis;
use crate::grid::{Block, Node};
use crate::solver::lane::{Lane, Points};
use crate::transfer::Transfer;
use std::mem::MaybeUninit;

/// What the gathering of one block leaves behind.
#[derive(Clone, Copy, Debug)]
pub struct Gathered {
    /// Σ ½ m v² after the step, J.
    pub kinetic: f64,
    /// Largest v² of a point, m²/s².
    pub speed_squared: f64,
    /// Points of groups that could not be taken as one, where points move in 2D and 3D.
    pub apart: usize,
    /// Points of groups of four that can be taken as one in 3D, but not with another four as eight, where points move. Whether eight
    /// are taken as one depends on the processor, this does not.
    pub alone: usize,
    /// Whether all points are finite, and, unless they stay where they are in the grid, inside it and within the reach of their
    /// block.
    pub within: bool,
}

impl Gathered {
    /// Nothing yet.
    pub const NONE: Self = Self {
        kinetic: 0.0,
        speed_squared: 0.0,
        apart: 0,
        alone: 0,
        within: true,
    };

    /// Both together.
    pub fn and(self, other: Self) -> Self {
        Self {
            kinetic: self.kinetic + other.kinetic,
            speed_squared: self.speed_squared.max(other.speed_squared),
            apart: self.apart + other.apart,
            alone: self.alone + other.alone,
            within: self.within && other.within,
        }
    }
}

/// The arrays of the grid that points read.
#[derive(Clone, Copy)]
pub struct Sources {
    /// Velocities after the step, m/s.
    pub main: *const Node,
    /// Their change over the step, m/s.
    pub change: *const Node,
    /// The velocities whose gradient strains the points, where they are not `main`.
    pub second: *const Node,
}

/// Brings the grid to the given rows (at most [`CHUNK`](super::CHUNK)) of a block, in groups as [`scatter`](super::scatter()) has them.
///
/// # Safety
/// See the module header; `sources` are arrays of the grid with all of the tile's nodes (those that the pass does not use may
/// dangle), and no other thread uses these rows meanwhile.
#[inline(always)]
#[allow(clippy::too_many_arguments)]
pub unsafe fn gather<E: Points, const D: usize, const N: usize, B: Basis<N>, T: Transfer>(
    pass: &Pass<D, B, T>,
    columns: &Columns<D>,
    tile: &Tile<D>,
    reach: &Reach<D>,
    rows: std::ops::Range<usize>,
    what: Wanted,
    sources: &Sources,
    rates: &mut Rates<D>,
) -> Gathered {
    let mut group = Group::<E::Four, D, N>::new();
    let mut centre = Centre::new(pass);
    let needs = Needs {
        slope: (what.velocity && T::TAYLOR) || (what.rate && !T::MOVING_LEAST_SQUARES),
        affine: (what.velocity && T::AFFINE && !T::TAYLOR)
            || (what.rate && T::MOVING_LEAST_SQUARES),
    };
    let mut sums = GatheredLanes::<E::Four>::new();
    let affine = T::AFFINE && what.velocity;
    let start = rows.start;
    let asked_of = |rows| Asked {
        columns,
        rows,
        what,
        sources,
    };
    let mut wider = Wider::<E, D, N>::new();
    let mut fours = Fours(rows);
    // where the nodes begin of the four points before, unless they are apart or half of an eight
    let mut single = None;
    loop {
        // SAFETY: the rows belong to this block alone, and the tile holds every node of their stencils (module header)
        unsafe {
            let eight = wider.take(&mut fours, pass, columns, tile, needs, centre.used);
            if let Some((rows, place)) = eight {
                columns.prefetch::<E>(rows.first, affine, false);
                let (at, asked) = (rows.first - start, asked_of(rows));
                let gradients = Some((&mut *rates, at));
                let offered = offered_to_one(pass, &asked, &wider.group, tile, gradients);
                sums.bring(pass, &asked, reach, &place, &offered, rates.hoops_from(at));
                single = None;
                continue;
            }
        }
        let Some(rows) = fours.next() else {
            return sums.total();
        };
        // SAFETY: as above
        unsafe {
            let place = columns.places::<E::Four>(rows.first, rows.count);
            columns.prefetch::<E::Four>(rows.first, affine, false);
            group.set(pass, tile, &place, needs);
            if centre.used {
                centre.set(&group);
            }
            let (at, asked) = (rows.first - start, asked_of(rows));
            let gradients = Some((&mut *rates, at));
            let offered = offered(pass, &asked, &group, &centre, tile, gradients);
            sums.bring(pass, &asked, reach, &place, &offered, rates.hoops_from(at));
            if what.position && D > 1 {
                if !group.is_one(rows.count, centre.used) {
                    sums.apart += rows.count;
                    single = None;
                } else if D == 3 {
                    let node = (group.row[0], group.node[0]);
                    if single == Some(node) {
                        sums.alone -= rows.count;
                        single = None;
                    } else {
                        sums.alone += rows.count;
                        single = Some(node);
                    }
                }
            }
        }
    }
}

/// Gives the points of one block their new velocities, and adds their new momenta and masses to `second`.
///
/// # Safety
/// As for [`gather`] and [`scatter`](super::scatter()); `second` is none of the sources.
#[inline(always)]
pub unsafe fn exchange<E: Points, const D: usize, const N: usize, B: Basis<N>, T: Transfer>(
    pass: &Pass<D, B, T>,
    columns: &Columns<D>,
    block: &Block<D>,
    edge: i32,
    sources: &Sources,
    second: *mut Node,
) -> Gathered {
    let tile = Tile::new(block, edge, N);
    let mut group = Group::<E::Four, D, N>::new();
    let centre = Centre::new(pass);
    let mut gifts = Gifts::none();
    let needs = Needs {
        slope: T::TAYLOR,
        affine: T::AFFINE,
    };
    let mut sums = GatheredLanes::<E::Four>::new();
    let asked_of = |rows| Asked {
        columns,
        rows,
        what: Wanted::VELOCITY,
        sources,
    };
    let what = Scattered::MOMENTUM;
    let mut wider = Wider::<E, D, N>::new();
    let mut fours = Fours(block.points());
    loop {
        // SAFETY: as in `gather`, and as in `scatter`
        unsafe {
            let eight = wider.take(&mut fours, pass, columns, &tile, needs, centre.used);
            if let Some((rows, _)) = eight {
                let asked = asked_of(rows);
                let offered = offered_to_one(pass, &asked, &wider.group, &tile, None);
                sums.take(pass, &asked, &offered);
                let Wider { group, gifts } = &mut wider;
                let first = rows.first;
                scatter_one(
                    pass, columns, group, &tile, first, what, second, second, gifts,
                );
                continue;
            }
        }
        let Some(rows) = fours.next() else {
            return sums.total();
        };
        // SAFETY: as above
        unsafe {
            let place = columns.places::<E::Four>(rows.first, rows.count);
            group.set(pass, &tile, &place, needs);
            let asked = asked_of(rows);
            let offered = offered(pass, &asked, &group, &centre, &tile, None);
            sums.take(pass, &asked, &offered);
            scatter_rows(
                pass, columns, &group, &centre, &tile, rows, what, second, second, &mut gifts,
            );
        }
    }
}

#[inline(always)]
fn all_finite<P: Points, const D: usize>(position: &[P; D]) -> bool {
    let mut finite = true;
    for a in 0..D {
        finite &= position[a].all_within(-f64::MAX, f64::MAX);
    }
    finite
}

/// [`Gathered`] of every fourth point.
struct GatheredLanes<L> {
    /// Σ m v².
    kinetic: L,
    fastest: L,
    apart: usize,
    alone: usize,
    within: bool,
}

impl<L: Lane> GatheredLanes<L> {
    #[inline(always)]
    fn new() -> Self {
        Self {
            kinetic: L::splat(0.0),
            fastest: L::splat(0.0),
            apart: 0,
            alone: 0,
            within: true,
        }
    }

    /// Gives the points of a group what the grid offers them, velocities and positions, and counts them; `hoops` are their hoop
    /// rates in an axisymmetric scene.
    ///
    /// # Safety
    /// Nobody else uses these rows.
    #[inline(always)]
    unsafe fn bring<P: Points<Four = L>, const D: usize, B, T: Transfer>(
        &mut self,
        pass: &Pass<D, B, T>,
        asked: &Asked<'_, D>,
        reach: &Reach<D>,
        place: &[P; D],
        offered: &Offered<P, D>,
        hoops: &mut [MaybeUninit<f64>],
    ) {
        let Asked { columns, what, .. } = asked;
        let Rows { first, count } = asked.rows;
        // where the two are one column, it is read once
        let mut position = *place;
        if columns.total {
            // SAFETY: as the caller says
            position = unsafe { columns.positions::<P>(first, count) };
        }
        if what.rate && D == 2 && columns.axisymmetric {
            let rate = offered.radial / position[0];
            // SAFETY: as above
            unsafe { columns.stretch_hoops(first, count, rate, pass.dt, hoops) };
        }
        let mut moving = offered.new;
        if what.velocity {
            // SAFETY: as above
            unsafe { self.take(pass, asked, offered) };
        } else if what.position && !T::CHANGE {
            // the velocity that the points took from these nodes
            // SAFETY: as above
            moving = unsafe { columns.velocities::<P>(first, count) };
        }
        if what.position {
            let dt = P::splat(pass.dt);
            let mut x = position;
            for a in 0..D {
                position[a] = dt.mul_add(moving[a], position[a]);
                x[a] = (position[a] - pass.min[a]) * pass.inverse_size;
            }
            // SAFETY: as above
            unsafe { columns.set_positions(first, count, &position) };
            self.within &= if columns.total {
                all_finite(&position)
            } else {
                reach.holds_all(&x)
            };
        }
    }

    /// Gives the points of a group their new velocities, and counts them.
    ///
    /// # Safety
    /// Nobody else uses these rows.
    #[inline(always)]
    unsafe fn take<P: Points<Four = L>, const D: usize, B, T: Transfer>(
        &mut self,
        pass: &Pass<D, B, T>,
        asked: &Asked<'_, D>,
        offered: &Offered<P, D>,
    ) {
        let columns = asked.columns;
        let Rows { first, count } = asked.rows;
        let mut velocity = offered.new;
        if T::CHANGE {
            // SAFETY: as the caller says
            let old = unsafe { columns.velocities::<P>(first, count) };
            for a in 0..D {
                let (new, change) = (offered.new[a], offered.change[a]);
                velocity[a] = pass.transfer.velocity(old[a], new, change);
            }
        }
        let mut square = velocity[0] * velocity[0];
        for a in 1..D {
            square = velocity[a].mul_add(velocity[a], square);
        }
        // SAFETY: as the caller says
        let mass = unsafe {
            columns.set_velocities(first, count, &velocity);
            columns.masses::<P>(first, count)
        };
        // `max` would hide a velocity that is not a number
        self.within &= square.all_within(0.0, f64::MAX);
        // four after the other: the same sums however many points are taken at once
        for h in 0..P::LANES / 4 {
            let square = square.four(h);
            self.kinetic = mass.four(h).mul_add(square, self.kinetic);
            self.fastest = self.fastest.max(square);
        }
    }

    #[inline(always)]
    fn total(&self) -> Gathered {
        let (kinetic, fastest) = (self.kinetic.array(), self.fastest.array());
        Gathered {
            kinetic: 0.5 * ((kinetic[0] + kinetic[1]) + (kinetic[2] + kinetic[3])),
            speed_squared: fastest.iter().fold(0.0, |most, v| f64::max(most, *v)),
            apart: self.apart,
            alone: self.alone,
            within: self.within,
        }
    }
}
