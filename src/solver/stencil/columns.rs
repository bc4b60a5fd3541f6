//! The columns of a body's points, as threads share them.

use crate::math::{Matrix, Vector, packed_len};
use crate::state::Particles;

/// The columns of a body's points, shared by threads that work on disjoint rows.
#[derive(Clone, Copy)]
pub struct Columns<const D: usize> {
    pub(super) position: *mut Vector<D>,
    pub(super) velocity: *mut Vector<D>,
    pub(super) affine: *mut Matrix<D>,
    pub(super) mass: *const f64,
    pub(super) volume: *const f64,
    pub(super) stress: *mut f64,
    pub(super) hoop_stress: *mut f64,
    pub(super) hoop_stretch: *mut f64,
    pub(super) axisymmetric: bool,
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
        Self {
            position: particles.position.as_mut_ptr(),
            velocity: particles.velocity.as_mut_ptr(),
            affine: particles.affine.as_mut_ptr(),
            mass: particles.mass.as_ptr(),
            volume: particles.initial_volume.as_ptr(),
            stress: particles.stress.as_mut_ptr(),
            hoop_stress: particles.hoop_stress.as_mut_ptr(),
            hoop_stretch: particles.hoop_stretch.as_mut_ptr(),
            axisymmetric: !particles.hoop_stretch.is_empty(),
        }
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
