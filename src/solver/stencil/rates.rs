//! Velocity gradients on their way from the grid to a law.

use super::CHUNK;
use crate::material::FourRates;
use crate::solver::lane::{Lane, Points};
use std::mem::MaybeUninit;

/// Velocity gradients of up to [`CHUNK`] points, set by the kernel that gathers them: lane by lane, as laws want them.
pub struct Rates<const D: usize> {
    /// ∂v/∂x, or Ḟ in the total frame, 1/s; as [`FourRates`].
    fours: [[[Lanes; D]; D]; CHUNK / 4],
    /// v_r / r, 1/s; only set in an axisymmetric scene.
    hoop: [MaybeUninit<f64>; CHUNK],
}

/// The same number of four points.
#[derive(Clone, Copy)]
#[repr(C, align(32))]
struct Lanes([MaybeUninit<f64>; 4]);

impl<const D: usize> Default for Rates<D> {
    /// None yet.
    fn default() -> Self {
        Self {
            fours: [[[Lanes([MaybeUninit::uninit(); 4]); D]; D]; CHUNK / 4],
            hoop: [MaybeUninit::uninit(); CHUNK],
        }
    }
}

impl<const D: usize> Rates<D> {
    /// The gradients of the first `count` points, and the hoop rates of the first `hoops`.
    ///
    /// # Safety
    /// The gradients of that many points were gathered, and the hoop rates in an axisymmetric scene.
    pub unsafe fn of(&mut self, count: usize, hoops: usize) -> (&[FourRates<D>], &[f64]) {
        let left = count % 4;
        if left > 0 {
            for lanes in self.fours[count / 4].as_flattened_mut() {
                lanes.0[left..].fill(MaybeUninit::new(0.0));
            }
        }
        let fours: *const [[[Lanes; D]; D]] = &self.fours[..count.div_ceil(4)];
        let hoop: *const [MaybeUninit<f64>] = &self.hoop[..hoops];
        // SAFETY: MaybeUninit<T> has the layout of T, and the caller knows that these are set
        unsafe { (&*(fours as *const [FourRates<D>]), &*(hoop as *const [f64])) }
    }

    /// Sets the gradients of as many points as there are lanes, given their columns; `point` is a multiple of four.
    #[inline(always)]
    pub(super) fn set_all<P: Points>(&mut self, point: usize, columns: &[[P; D]; D]) {
        debug_assert!(point.is_multiple_of(4));
        let fours = &mut self.fours[point / 4..point / 4 + P::LANES / 4];
        for (h, four) in fours.iter_mut().enumerate() {
            for a in 0..D {
                for i in 0..D {
                    // SAFETY: four numbers, aligned to 32 bytes
                    unsafe {
                        columns[a][i]
                            .four(h)
                            .store(four[a][i].0.as_mut_ptr().cast())
                    };
                }
            }
        }
    }

    /// Sets the columns of one point's gradient.
    #[inline(always)]
    pub(super) fn set<L: Lane>(&mut self, point: usize, columns: &[L; D]) {
        let four = &mut self.fours[point / 4];
        for a in 0..D {
            let column = columns[a].array();
            for i in 0..D {
                four[a][i].0[point % 4].write(column[i]);
            }
        }
    }

    /// The hoop rates of a point and of those after it.
    #[inline(always)]
    pub(super) fn hoops_from(&mut self, point: usize) -> &mut [MaybeUninit<f64>] {
        &mut self.hoop[point..]
    }
}
