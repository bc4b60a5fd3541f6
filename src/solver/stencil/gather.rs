//! From the grid to points.

use super::nodes::{gather_linear, gather_value, matrix, vector};
use super::{CHUNK, Columns, Pass, Reach, Tile};
use crate::basis::Basis;
use crate::grid::Node;
use crate::math::{Matrix, Vector};
use crate::solver::lane::Lane;
use crate::transfer::Transfer;

/// What the gathering of one block leaves behind.
#[derive(Clone, Copy, Debug)]
pub struct Gathered {
    /// Σ ½ m v² after the step, J.
    pub kinetic: f64,
    /// Largest v² of a point, m²/s².
    pub speed_squared: f64,
    /// Whether all points are finite, inside the grid and within the reach of their block.
    pub within: bool,
}

impl Gathered {
    /// Nothing yet.
    pub const NONE: Self = Self {
        kinetic: 0.0,
        speed_squared: 0.0,
        within: true,
    };

    /// Both together.
    pub fn and(self, other: Self) -> Self {
        Self {
            kinetic: self.kinetic + other.kinetic,
            speed_squared: self.speed_squared.max(other.speed_squared),
            within: self.within && other.within,
        }
    }
}

/// Velocity gradients of up to [`CHUNK`] points.
pub struct Rates<const D: usize> {
    /// L, 1/s.
    pub gradient: [Matrix<D>; CHUNK],
    /// v_r / r, 1/s; only set in an axisymmetric scene.
    pub hoop: [f64; CHUNK],
}

impl<const D: usize> Rates<D> {
    /// All zero.
    pub fn zeros() -> Self {
        Self {
            gradient: [Matrix::zeros(); CHUNK],
            hoop: [0.0; CHUNK],
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

/// What points take from the grid.
#[derive(Clone, Copy, Debug)]
pub struct Wanted {
    /// New velocities, and affine fields.
    pub velocity: bool,
    /// New positions.
    pub position: bool,
    /// Velocity gradients.
    pub rate: bool,
    /// Whether the gradients are those of `main`; else of `second`.
    pub same: bool,
}

/// Brings the grid to the given rows (at most [`CHUNK`]) of a block.
///
/// # Safety
/// See the module header; `sources` are arrays of the grid with all of the tile's nodes (those that the pass does not use may
/// dangle), and no other thread uses these rows meanwhile.
#[inline(always)]
#[allow(clippy::too_many_arguments)]
pub unsafe fn gather<L: Lane, const D: usize, const N: usize, B: Basis<N>, T: Transfer>(
    pass: &Pass<'_, D, B, T>,
    columns: &Columns<D>,
    tile: &Tile<D>,
    reach: &Reach<D>,
    rows: std::ops::Range<usize>,
    what: Wanted,
    sources: &Sources,
    rates: &mut Rates<D>,
) -> Gathered {
    let mut gathered = Gathered::NONE;
    let inverse = 1.0 / pass.geometry.cell_size;
    let blend = pass.transfer.ratio() < 1.0;
    let first_row = rows.start;
    for p in rows {
        // SAFETY: row p belongs to this block alone (module header)
        let mut position = unsafe { *columns.position.add(p) };
        let s = pass.stencil::<N>(tile, &position);
        let (t, w) = (s.at, &s.weight);
        let mut new = L::splat(0.0);
        let mut hoop_velocity = 0.0;
        // SAFETY: the tile holds every node of the stencil (module header)
        unsafe {
            if what.rate && what.same && what.velocity && T::AFFINE {
                let g = pass.affine_weights(&s);
                let (value, [gradient, affine]) =
                    gather_linear::<L, D, N, 2>(sources.main, tile, t, w, [&s.slope, &g]);
                rates.gradient[p - first_row] = matrix::<L, D>(&gradient);
                *columns.affine.add(p) = matrix::<L, D>(&affine);
                hoop_velocity = value.array()[0];
                new = value;
            } else {
                if what.rate {
                    let from = if what.same {
                        sources.main
                    } else {
                        sources.second
                    };
                    let (value, [gradient]) =
                        gather_linear::<L, D, N, 1>(from, tile, t, w, [&s.slope]);
                    rates.gradient[p - first_row] = matrix::<L, D>(&gradient);
                    hoop_velocity = value.array()[0];
                    if what.same {
                        new = value;
                    }
                }
                if what.velocity && T::AFFINE {
                    let g = pass.affine_weights(&s);
                    let (value, [affine]) =
                        gather_linear::<L, D, N, 1>(sources.main, tile, t, w, [&g]);
                    *columns.affine.add(p) = matrix::<L, D>(&affine);
                    new = value;
                } else if !(what.rate && what.same)
                    && (what.position || (what.velocity && (blend || !T::CHANGE)))
                {
                    new = gather_value::<L, D, N>(sources.main, tile, t, w);
                }
            }
        }
        if what.rate && D == 2 && columns.axisymmetric {
            let hoop = hoop_velocity / position[0];
            rates.hoop[p - first_row] = hoop;
            // SAFETY: as above
            unsafe { *columns.hoop_stretch.add(p) *= 1.0 + pass.dt * hoop };
        }
        let new: [f64; D] = vector(new);
        if what.velocity {
            // SAFETY: as above
            let (old, mass) = unsafe { (*columns.velocity.add(p), *columns.mass.add(p)) };
            let change: [f64; D] = if T::CHANGE {
                // SAFETY: as above
                vector(unsafe { gather_value::<L, D, N>(sources.change, tile, t, w) })
            } else {
                [0.0; D]
            };
            let mut velocity = Vector::<D>::zeros();
            let mut square = 0.0;
            for a in 0..D {
                let v = pass.transfer.velocity(old[a], new[a], change[a]);
                velocity[a] = v;
                square += v * v;
            }
            // SAFETY: as above
            unsafe { *columns.velocity.add(p) = velocity };
            gathered.kinetic += 0.5 * mass * square;
            // `max` would hide a velocity that is not a number
            gathered.within &= square.is_finite();
            gathered.speed_squared = gathered.speed_squared.max(square);
        }
        if what.position {
            for a in 0..D {
                position[a] += pass.dt * new[a];
            }
            // SAFETY: as above
            unsafe { *columns.position.add(p) = position };
            gathered.within &= reach.holds(&pass.geometry.in_cells(&position, inverse));
        }
    }
    gathered
}
