//! Particle in cell: particles take the velocity of the grid. Stable and strongly dissipative.

use super::Transfer;
use crate::input::{Parameters, Reader};
use crate::real::Real;

/// v = Σ N_i v_i.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pic;

impl Parameters for Pic {
    fn read(_: &mut Reader<'_>) -> Option<Self> {
        Some(Self)
    }
}

impl Transfer for Pic {
    const AFFINE: bool = false;
    const CHANGE: bool = false;

    fn ratio(&self) -> f64 {
        0.0
    }

    #[inline(always)]
    fn velocity<R: Real>(&self, _old: R, new: R, _change: R) -> R {
        new
    }
}
