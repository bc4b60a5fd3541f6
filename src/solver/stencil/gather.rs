//! From the grid to points.

use super::dilation::Centre;
use super::group::{FourRows, Fours, Group, Needs};
use super::offered::{Asked, Offered, offered};
use super::same::Gifts;
use super::scatter::{Scattered, scatter_rows};
use super::{Columns, Pass, Rates, Reach, Tile, Wanted};
use crate::basis::Basis;
use crate::grid::{Block, Node};
use crate::solver::lane::Lane;
use crate::transfer::Transfer;

/// What the gathering of one block leaves behind.
#[derive(Clone, Copy, Debug)]
pub struct Gathered {
    /// Σ ½ m v² after the step, J.
    pub kinetic: f64,
    /// Largest v² of a point, m²/s².
    pub speed_squared: f64,
    /// Points of groups that could not be taken as one, where points move in 2D and 3D.
    pub apart: usize,
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
        within: true,
    };

    /// Both together.
    pub fn and(self, other: Self) -> Self {
        Self {
            kinetic: self.kinetic + other.kinetic,
            speed_squared: self.speed_squared.max(other.speed_squared),
            apart: self.apart + other.apart,
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

/// Brings the grid to the given rows (at most [`CHUNK`](super::CHUNK)) of a block.
///
/// # Safety
/// See the module header; `sources` are arrays of the grid with all of the tile's nodes (those that the pass does not use may
/// dangle), and no other thread uses these rows meanwhile.
#[inline(always)]
#[allow(clippy::too_many_arguments)]
pub unsafe fn gather<L: Lane, const D: usize, const N: usize, B: Basis<N>, T: Transfer>(
    pass: &Pass<D, B, T>,
    columns: &Columns<D>,
    tile: &Tile<D>,
    reach: &Reach<D>,
    rows: std::ops::Range<usize>,
    what: Wanted,
    sources: &Sources,
    rates: &mut Rates<D>,
) -> Gathered {
    let mut group = Group::<D, N>::new();
    let mut centre = Centre::new(pass);
    let needs = Needs {
        slope: (what.velocity && T::TAYLOR) || (what.rate && !T::MOVING_LEAST_SQUARES),
        affine: (what.velocity && T::AFFINE && !T::TAYLOR)
            || (what.rate && T::MOVING_LEAST_SQUARES),
    };
    let mut sums = GatheredLanes::<L>::new();
    let dt = L::splat(pass.dt);
    let start = rows.start;
    for four in Fours(rows) {
        let FourRows { first, count } = four;
        let at = first - start;
        // SAFETY: the rows belong to this block alone (module header)
        let place = unsafe { columns.places::<L>(first, count) };
        columns.prefetch::<L>(first, T::AFFINE && what.velocity, false);
        group.set::<L, B, T>(pass, tile, &place, needs);
        if centre.used {
            centre.set(&group);
        }
        // where the two are one column, it is read once
        let mut position = place;
        if columns.total {
            // SAFETY: as above
            position = unsafe { columns.positions::<L>(first, count) };
        }
        // SAFETY: the tile holds every node of the stencils, and the rows belong to this block alone (module header)
        let offered = unsafe {
            let gradients = Some((&mut *rates, at));
            let asked = Asked {
                columns,
                rows: four,
                what,
                sources,
            };
            offered::<L, D, N, B, T>(pass, &asked, &group, &centre, tile, gradients)
        };
        if what.rate && D == 2 && columns.axisymmetric {
            let rate = offered.radial / position[0];
            // SAFETY: as above
            unsafe { columns.stretch_hoops(first, count, rate, pass.dt, rates.hoops_from(at)) };
        }
        let mut moving = offered.new;
        if what.velocity {
            // SAFETY: as above
            unsafe { sums.take(pass, columns, four, &offered) };
        } else if what.position && !T::CHANGE {
            // the velocity that the point took from these nodes
            // SAFETY: as above
            moving = unsafe { columns.velocities::<L>(first, count) };
        }
        if what.position {
            if D > 1 && !group.is_one(count, centre.used) {
                sums.apart += count;
            }
            let mut x = position;
            for a in 0..D {
                position[a] = dt.mul_add(moving[a], position[a]);
                x[a] = (position[a] - pass.min[a]) * pass.inverse_size;
            }
            // SAFETY: as above
            unsafe { columns.set_positions(first, count, &position) };
            sums.within &= if columns.total {
                all_finite(&position)
            } else {
                reach.holds_all(&x)
            };
        }
    }
    sums.total()
}

/// Gives the points of one block their new velocities, and adds their new momenta and masses to `second`.
///
/// # Safety
/// As for [`gather`] and [`scatter`](super::scatter); `second` is none of the sources.
#[inline(always)]
pub unsafe fn exchange<L: Lane, const D: usize, const N: usize, B: Basis<N>, T: Transfer>(
    pass: &Pass<D, B, T>,
    columns: &Columns<D>,
    block: &Block<D>,
    edge: i32,
    sources: &Sources,
    second: *mut Node,
) -> Gathered {
    let tile = Tile::new(block, edge, N);
    let mut group = Group::<D, N>::new();
    let centre = Centre::new(pass);
    let mut gifts = Gifts::none();
    let needs = Needs {
        slope: T::TAYLOR,
        affine: T::AFFINE,
    };
    let mut sums = GatheredLanes::<L>::new();
    for four in Fours(block.points()) {
        let FourRows { first, count } = four;
        // SAFETY: as in `gather`, and as in `scatter`
        unsafe {
            let place = columns.places::<L>(first, count);
            group.set::<L, B, T>(pass, &tile, &place, needs);
            let asked = Asked {
                columns,
                rows: four,
                what: Wanted::VELOCITY,
                sources,
            };
            let offered = offered::<L, D, N, B, T>(pass, &asked, &group, &centre, &tile, None);
            sums.take(pass, columns, four, &offered);
            let what = Scattered::MOMENTUM;
            scatter_rows::<L, D, N, B, T>(
                pass, columns, &group, &centre, &tile, four, what, second, second, &mut gifts,
            );
        }
    }
    sums.total()
}

#[inline(always)]
fn all_finite<L: Lane, const D: usize>(position: &[L; D]) -> bool {
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
    within: bool,
}

impl<L: Lane> GatheredLanes<L> {
    #[inline(always)]
    fn new() -> Self {
        Self {
            kinetic: L::splat(0.0),
            fastest: L::splat(0.0),
            apart: 0,
            within: true,
        }
    }

    /// Gives four points their new velocities, and counts them.
    ///
    /// # Safety
    /// Nobody else uses these rows.
    #[inline(always)]
    unsafe fn take<const D: usize, B, T: Transfer>(
        &mut self,
        pass: &Pass<D, B, T>,
        columns: &Columns<D>,
        rows: FourRows,
        offered: &Offered<L, D>,
    ) {
        let FourRows { first, count } = rows;
        let mut velocity = offered.new;
        if T::CHANGE {
            // SAFETY: as the caller says
            let old = unsafe { columns.velocities::<L>(first, count) };
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
            columns.masses::<L>(first, count)
        };
        self.kinetic = mass.mul_add(square, self.kinetic);
        // `max` would hide a velocity that is not a number
        self.within &= square.all_within(0.0, f64::MAX);
        self.fastest = self.fastest.max(square);
    }

    #[inline(always)]
    fn total(&self) -> Gathered {
        let (kinetic, fastest) = (self.kinetic.array(), self.fastest.array());
        Gathered {
            kinetic: 0.5 * ((kinetic[0] + kinetic[1]) + (kinetic[2] + kinetic[3])),
            speed_squared: fastest.iter().fold(0.0, |most, v| f64::max(most, *v)),
            apart: self.apart,
            within: self.within,
        }
    }
}
