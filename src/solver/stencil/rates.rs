//! Velocity gradients on their way from the grid to a law.

use super::CHUNK;
use crate::material::Rate;
use crate::solver::lane::{Lane, Points};
use std::mem::MaybeUninit;

/// Velocity gradients of up to [`CHUNK`] points, set by the kernel that gathers them.
pub struct Rates<const D: usize> {
    /// ∂v/∂x, or Ḟ in the total frame, 1/s.
    gradient: [MaybeUninit<Rate<D>>; CHUNK],
    /// v_r / r, 1/s; only set in an axisymmetric scene.
    hoop: [MaybeUninit<f64>; CHUNK],
}

impl<const D: usize> Default for Rates<D> {
    /// None yet.
    fn default() -> Self {
        Self {
            gradient: [MaybeUninit::uninit(); CHUNK],
            hoop: [MaybeUninit::uninit(); CHUNK],
        }
    }
}

impl<const D: usize> Rates<D> {
    /// The gradients of the first `count` points, and the hoop rates of the first `hoops`.
    ///
    /// # Safety
    /// The gradients of that many points were gathered, and the hoop rates in an axisymmetric scene.
    pub unsafe fn of(&self, count: usize, hoops: usize) -> (&[Rate<D>], &[f64]) {
        let gradients: *const [MaybeUninit<Rate<D>>] = &self.gradient[..count];
        let rates: *const [MaybeUninit<f64>] = &self.hoop[..hoops];
        // SAFETY: MaybeUninit<T> has the layout of T, and the caller knows that these are set
        unsafe { (&*(gradients as *const [Rate<D>]), &*(rates as *const [f64])) }
    }

    /// Sets the gradients of as many points as there are lanes, given their columns.
    #[inline(always)]
    pub(super) fn set_all<P: Points>(&mut self, point: usize, columns: &[[P; D]; D]) {
        let some = &mut self.gradient[point..point + P::LANES];
        let to = some.as_mut_ptr().cast::<f64>();
        for a in 0..D {
            let column = &columns[a];
            // SAFETY: a gradient is D columns of four numbers; all but the first D of a column may be anything
            unsafe {
                P::store_strided([column[0], column[1.min(D - 1)]], to.add(4 * a), 4 * D);
                if D == 3 {
                    P::store_strided([column[2], column[2]], to.add(4 * a + 2), 4 * D);
                }
            }
        }
    }

    /// Sets the columns of one point's gradient.
    #[inline(always)]
    pub(super) fn set<L: Lane>(&mut self, point: usize, columns: &[L; D]) {
        let gradient = self.gradient[point].as_mut_ptr().cast::<f64>();
        for a in 0..D {
            // SAFETY: column a of a gradient is four numbers, aligned to 32 bytes
            unsafe { columns[a].store(gradient.add(4 * a)) };
        }
    }

    /// The hoop rates of a point and of those after it.
    #[inline(always)]
    pub(super) fn hoops_from(&mut self, point: usize) -> &mut [MaybeUninit<f64>] {
        &mut self.hoop[point..]
    }
}
