//! The columns of a body's points, as threads share them.

use crate::material::ReferenceMut;
use crate::math::{Matrix, Vector, packed_len};
use crate::real::MOST_LANES;
use crate::solver::lane::{Lane, Points};
use crate::state::Particles;
use std::mem::MaybeUninit;

/// How many points before their turn memory is asked for them.
const AHEAD: usize = 16;

/// The columns of a body's points, shared by threads that work on disjoint rows.
#[derive(Clone, Copy)]
pub struct Columns<const D: usize> {
    /// x.
    pub(super) position: *mut Vector<D>,
    /// Where the points stand in the grid: X in the total frame, else x, the same column as `position`.
    pub(super) place: *const Vector<D>,
    pub(super) velocity: *mut Vector<D>,
    pub(super) affine: *mut Matrix<D>,
    mass: *const f64,
    /// All bits if there is a mass for each point, none if they share one: which of them is that of a point.
    each_mass: usize,
    /// 1 / ρ₀.
    pub(super) specific_volume: f64,
    pub(super) stress: *mut f64,
    pub(super) deformation: *mut Matrix<D>,
    pub(super) first_piola: *mut Matrix<D>,
    pub(super) hoop_stress: *mut f64,
    pub(super) hoop_stretch: *mut f64,
    pub(super) axisymmetric: bool,
    /// Whether there is a `deformation` for each point.
    deforms: bool,
    /// Whether points stay where they are in the grid.
    pub(super) total: bool,
    /// Whether points have domains that deform with them, and how they have is in `deformation`.
    pub(super) convected: bool,
}

// SAFETY: threads are given disjoint rows (module header)
unsafe impl<const D: usize> Send for Columns<D> {}
// SAFETY: as above
unsafe impl<const D: usize> Sync for Columns<D> {}

impl<const D: usize> Columns<D> {
    /// Pointers to the columns, valid until the columns are moved or resized.
    ///
    /// # Panics
    /// If the columns do not have one entry for each of `count` points, affine fields included if `affine`.
    pub fn new(particles: &mut Particles<D>, count: usize, affine: bool) -> Self {
        assert!(
            particles.are_whole(count, affine),
            "the columns of a body were resized between two steps; points are added and removed before a run only"
        );
        let total = particles.is_total();
        let position = particles.position.as_mut_ptr();
        Self {
            position,
            place: if total {
                particles.reference_position.as_ptr()
            } else {
                position.cast_const()
            },
            velocity: particles.velocity.as_mut_ptr(),
            affine: particles.affine.as_mut_ptr(),
            mass: particles.mass.numbers().as_ptr(),
            each_mass: if particles.mass.are_same() {
                0
            } else {
                usize::MAX
            },
            specific_volume: 1.0 / particles.mass.density(),
            stress: particles.stress.as_mut_ptr(),
            deformation: particles.deformation_gradient.as_mut_ptr(),
            first_piola: particles.first_piola_stress.as_mut_ptr(),
            hoop_stress: particles.hoop_stress.as_mut_ptr(),
            hoop_stretch: particles.hoop_stretch.as_mut_ptr(),
            axisymmetric: !particles.hoop_stretch.is_empty(),
            deforms: !particles.deformation_gradient.is_empty(),
            total,
            convected: !total && !particles.deformation_gradient.is_empty(),
        }
    }

    /// Asks for what the points of the next groups bring to a pass: a column stops every 4 kB for the processor's own guess of
    /// what comes next.
    #[inline(always)]
    pub(super) fn prefetch<P: Points>(&self, first: usize, affine: bool, stress: bool) {
        let p = first + AHEAD;
        P::prefetch(self.place.wrapping_add(p).cast(), P::LANES * D);
        P::prefetch(self.velocity.wrapping_add(p).cast(), P::LANES * D);
        P::prefetch(self.mass.wrapping_add(p & self.each_mass), P::LANES);
        if affine {
            P::prefetch(self.affine.wrapping_add(p).cast(), P::LANES * D * D);
        }
        if stress {
            if self.total {
                P::prefetch(self.first_piola.wrapping_add(p).cast(), P::LANES * D * D);
            } else {
                let width = packed_len(D);
                P::prefetch(self.stress.wrapping_add(p * width), P::LANES * width);
            }
        }
    }

    /// Whether the shape functions are those of the reference configuration.
    pub fn is_total(&self) -> bool {
        self.total
    }

    /// Where `count` points from row `first` on stand in the grid, at most one a lane, m; the last stands for those that there
    /// are not.
    ///
    /// # Safety
    /// No other thread writes to these rows meanwhile.
    #[inline(always)]
    pub(super) unsafe fn places<P: Points>(&self, first: usize, count: usize) -> [P; D] {
        // SAFETY: the rows exist
        unsafe { points::<P, D>(self.place.add(first), count) }
    }

    /// Present positions of `count` points from row `first` on, at most one a lane, m; the last stands for those that there are
    /// not.
    ///
    /// # Safety
    /// No other thread writes to these rows meanwhile.
    #[inline(always)]
    pub(super) unsafe fn positions<P: Points>(&self, first: usize, count: usize) -> [P; D] {
        // SAFETY: the rows exist
        unsafe { points::<P, D>(self.position.add(first), count) }
    }

    /// Velocities, as for [`Self::positions`].
    ///
    /// # Safety
    /// As there.
    #[inline(always)]
    pub(super) unsafe fn velocities<P: Points>(&self, first: usize, count: usize) -> [P; D] {
        // SAFETY: the rows exist
        unsafe { points::<P, D>(self.velocity.add(first), count) }
    }

    /// Mass of the point in row `p`.
    ///
    /// # Safety
    /// The row exists.
    #[inline(always)]
    pub(super) unsafe fn mass(&self, p: usize) -> f64 {
        // SAFETY: the row exists, or all share the first
        unsafe { *self.mass.add(p & self.each_mass) }
    }

    /// Masses, zero for points that there are not.
    ///
    /// # Safety
    /// As for [`Self::positions`].
    #[inline(always)]
    pub(super) unsafe fn masses<P: Points>(&self, first: usize, count: usize) -> P {
        // SAFETY: the rows exist
        unsafe {
            if self.each_mass != 0 {
                return numbers::<P>(self.mass.add(first), count);
            }
            if count == P::LANES {
                return P::splat(*self.mass);
            }
            P::load_some([*self.mass; MOST_LANES].as_ptr(), count)
        }
    }

    /// In 1D the stresses that forces follow from, zero for points that there are not.
    ///
    /// # Safety
    /// As for [`Self::positions`].
    #[inline(always)]
    pub(super) unsafe fn line_stresses<P: Points>(&self, first: usize, count: usize) -> P {
        let stress = if self.total {
            self.first_piola.cast_const().cast::<f64>()
        } else {
            self.stress.cast_const()
        };
        // SAFETY: the rows exist, a number each in 1D
        unsafe { numbers::<P>(stress.add(first), count) }
    }

    /// In 1D the affine fields, zero for points that there are not.
    ///
    /// # Safety
    /// As for [`Self::positions`].
    #[inline(always)]
    pub(super) unsafe fn line_affines<P: Points>(&self, first: usize, count: usize) -> P {
        // SAFETY: the rows exist, a number each in 1D
        unsafe { numbers::<P>(self.affine.cast_const().cast::<f64>().add(first), count) }
    }

    /// The columns of the affine fields of as many points as there are lanes, in 2D and 3D.
    ///
    /// # Safety
    /// As for [`Self::positions`]; all these rows exist.
    #[inline(always)]
    pub(super) unsafe fn affines<P: Points>(&self, first: usize) -> [[P; D]; D] {
        // SAFETY: the rows exist
        unsafe { matrices::<P, D>(self.affine.add(first)) }
    }

    /// The columns of the stresses that forces follow from, of as many points as there are lanes, in 2D and 3D.
    ///
    /// # Safety
    /// As for [`Self::affines`].
    #[inline(always)]
    pub(super) unsafe fn stresses<P: Points>(&self, first: usize) -> [[P; D]; D] {
        // SAFETY: the rows exist
        unsafe {
            if self.total {
                return matrices::<P, D>(self.first_piola.add(first));
            }
            let width = packed_len(D);
            let rows = std::slice::from_raw_parts(self.stress.add(first * width), P::LANES * width);
            let mut packed = [P::splat(0.0); 6];
            P::read_rows(rows, &mut packed[..width]);
            let mut columns = [[packed[0]; D]; D];
            let mut at = 0;
            for a in 0..D {
                for b in a..D {
                    columns[a][b] = packed[at];
                    columns[b][a] = packed[at];
                    at += 1;
                }
            }
            columns
        }
    }

    /// Hoop stresses of as many points as there are lanes.
    ///
    /// # Safety
    /// As for [`Self::affines`]; the body is axisymmetric.
    #[inline(always)]
    pub(super) unsafe fn hoop_stresses<P: Points>(&self, first: usize) -> P {
        // SAFETY: the rows exist
        unsafe { numbers::<P>(self.hoop_stress.add(first), P::LANES) }
    }

    /// Writes the affine fields of points, in 2D and 3D of one a lane, given the columns of their matrices.
    ///
    /// # Safety
    /// As for [`Self::set_positions`].
    #[inline(always)]
    pub(super) unsafe fn set_affines<P: Points>(
        &self,
        first: usize,
        count: usize,
        field: &[[P; D]; D],
    ) {
        // SAFETY: the rows exist, D² numbers each without gaps
        unsafe {
            if D == 1 {
                let to = self.affine.cast::<Vector<1>>().add(first);
                return set_points::<P, 1>(to, count, &[field[0][0]]);
            }
            let to = self.affine.add(first).cast::<f64>();
            let rows = std::slice::from_raw_parts_mut(to, P::LANES * D * D);
            P::write_rows(rows, field.as_flattened());
        }
    }

    /// Writes the affine field of the point in row `p`, given the columns of its matrix.
    ///
    /// # Safety
    /// As for [`Self::set_positions`].
    #[inline(always)]
    pub(super) unsafe fn set_affine<L: Lane>(&self, p: usize, field: &[L; D]) {
        // SAFETY: the row exists
        unsafe { L::store_matrix::<D>(field, self.affine.add(p).cast()) }
    }

    /// Writes positions of `count` points from row `first` on.
    ///
    /// # Safety
    /// No other thread uses these rows meanwhile.
    #[inline(always)]
    pub(super) unsafe fn set_positions<P: Points>(&self, first: usize, count: usize, x: &[P; D]) {
        // SAFETY: the rows exist
        unsafe { set_points::<P, D>(self.position.add(first), count, x) }
    }

    /// Writes velocities.
    ///
    /// # Safety
    /// As for [`Self::set_positions`].
    #[inline(always)]
    pub(super) unsafe fn set_velocities<P: Points>(&self, first: usize, count: usize, v: &[P; D]) {
        // SAFETY: the rows exist
        unsafe { set_points::<P, D>(self.velocity.add(first), count, v) }
    }

    /// Books hoop rates v_r / r of `count` points from row `first` on, and stretches their hoops by them over `dt`.
    ///
    /// # Safety
    /// As for [`Self::set_positions`]; the body is axisymmetric.
    #[inline(always)]
    pub(super) unsafe fn stretch_hoops<P: Points>(
        &self,
        first: usize,
        count: usize,
        rate: P,
        dt: f64,
        rates: &mut [MaybeUninit<f64>],
    ) {
        for q in 0..count {
            let rate = rate.lane(q);
            rates[q].write(rate);
            // SAFETY: the rows exist
            unsafe { *self.hoop_stretch.add(first + q) *= 1.0 + dt * rate };
        }
    }

    /// What the given rows have in the total frame for their law; nothing in the updated one.
    ///
    /// # Safety
    /// No other thread uses these rows meanwhile.
    pub unsafe fn reference<'a>(&self, first: usize, count: usize) -> ReferenceMut<'a> {
        if !self.total {
            return ReferenceMut::default();
        }
        let numbers = count * D * D;
        let kept = if self.deforms { numbers } else { 0 };
        // SAFETY: the rows exist, a matrix is D² numbers without gaps, and the caller keeps everybody else away
        unsafe {
            let f = self
                .deformation
                .add(if self.deforms { first } else { 0 })
                .cast();
            let p = self.first_piola.add(first).cast();
            ReferenceMut {
                deformation: std::slice::from_raw_parts_mut(f, kept),
                first_piola: std::slice::from_raw_parts_mut(p, numbers),
            }
        }
    }

    /// The deformation gradient of the point in row `p`.
    ///
    /// # Panics
    /// If none is kept.
    ///
    /// # Safety
    /// No other thread writes to this row meanwhile.
    #[inline(always)]
    pub(super) unsafe fn deformation(&self, p: usize) -> Matrix<D> {
        assert!(self.deforms, "no deformation gradients are kept");
        // SAFETY: the row exists, and the caller keeps writers away
        unsafe { *self.deformation.add(p) }
    }

    /// The deformation gradient of the domain of the point in row `p`.
    ///
    /// # Safety
    /// No other thread uses this row meanwhile; points have domains that deform with them.
    #[inline(always)]
    #[allow(clippy::mut_from_ref)] // the caller promises
    pub(super) unsafe fn domain(&self, p: usize) -> &mut Matrix<D> {
        debug_assert!(self.convected);
        // SAFETY: the row exists, and the caller keeps everybody else away
        unsafe { &mut *self.deformation.add(p) }
    }

    /// Stress, hoop stress and hoop stretch of the given rows, for their law.
    ///
    /// # Safety
    /// No other thread uses these rows meanwhile.
    #[allow(clippy::mut_from_ref)] // the caller promises
    pub unsafe fn law_columns(
        &self,
        first: usize,
        count: usize,
    ) -> (&mut [f64], &mut [f64], &mut [f64]) {
        let width = packed_len(D);
        let hoops = if self.axisymmetric { count } else { 0 };
        let offset = if self.axisymmetric { first } else { 0 };
        // SAFETY: the rows exist, and the caller alone uses them
        unsafe {
            (
                std::slice::from_raw_parts_mut(self.stress.add(first * width), count * width),
                std::slice::from_raw_parts_mut(self.hoop_stress.add(offset), hoops),
                std::slice::from_raw_parts_mut(self.hoop_stretch.add(offset), hoops),
            )
        }
    }
}

/// `count` numbers, at most one a lane; zero for those that there are not.
#[inline(always)]
unsafe fn numbers<P: Points>(from: *const f64, count: usize) -> P {
    // SAFETY: the caller vouches for `count` numbers
    unsafe {
        if count == P::LANES {
            let [numbers] = P::load_points::<1>(from);
            return numbers;
        }
        P::load_some(from, count)
    }
}

/// The columns of as many matrices as there are lanes.
#[inline(always)]
unsafe fn matrices<P: Points, const D: usize>(from: *const Matrix<D>) -> [[P; D]; D] {
    let mut columns = [[P::splat(0.0); D]; D];
    // SAFETY: the caller vouches for the matrices, which are D² numbers each without gaps
    let rows = unsafe { std::slice::from_raw_parts(from.cast::<f64>(), P::LANES * D * D) };
    P::read_rows(rows, columns.as_flattened_mut());
    columns
}

/// `count` vectors, at most one a lane; the last stands for those that there are not, of which groups of more than four have none.
#[inline(always)]
unsafe fn points<P: Points, const D: usize>(from: *const Vector<D>, count: usize) -> [P; D] {
    // SAFETY: the caller vouches for `count` vectors
    unsafe {
        if count == P::LANES {
            return P::load_points::<D>(from.cast());
        }
        assert!(P::LANES == 4);
        P::load_points::<D>(filled_up(from, count).as_ptr().cast())
    }
}

/// Fewer than four vectors, the last of them standing for those that there are not. A function of its own, or whole groups would
/// pay for finding these addresses.
#[cold]
#[inline(never)]
unsafe fn filled_up<const D: usize>(from: *const Vector<D>, count: usize) -> [Vector<D>; 4] {
    // SAFETY: the caller vouches for `count` vectors
    std::array::from_fn(|q| unsafe { *from.add(q.min(count - 1)) })
}

/// Writes the first `count` of the vectors, one a lane; groups of more than four are whole.
#[inline(always)]
unsafe fn set_points<P: Points, const D: usize>(to: *mut Vector<D>, count: usize, points: &[P; D]) {
    // SAFETY: the caller vouches for `count` vectors
    unsafe {
        if count == P::LANES {
            return P::store_points::<D>(points, to.cast());
        }
        assert!(P::LANES == 4);
        let mut four = [Vector::<D>::zeros(); 4];
        P::store_points::<D>(points, four.as_mut_ptr().cast());
        // no loop, which would become a call
        *to = four[0];
        if count > 1 {
            *to.add(1) = four[1];
        }
        if count > 2 {
            *to.add(2) = four[2];
        }
    }
}
