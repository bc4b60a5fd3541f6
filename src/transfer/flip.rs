//! Fluid implicit particle, and its blend with PIC: particles keep their own velocity and add the change on the grid.

use super::Transfer;
use crate::input::{Bound, Parameters, Reader, Unit};
use crate::real::Real;

/// v ← ratio (v + Σ N_i Δv_i) + (1 − ratio) Σ N_i v_i.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flip {
    /// The share of FLIP, 1 (the default) is pure FLIP and 0 is PIC.
    pub ratio: f64,
}

impl Parameters for Flip {
    fn read(reader: &mut Reader<'_>) -> Option<Self> {
        Some(Self { ratio: reader.or("ratio", Unit::NONE, Bound::Closed(0.0, 1.0), 1.0)? })
    }
}

impl Transfer for Flip {
    const AFFINE: bool = false;
    const CHANGE: bool = true;

    fn ratio(&self) -> f64 {
        self.ratio
    }

    #[inline(always)]
    fn velocity<R: Real>(&self, old: R, new: R, change: R) -> R {
        R::splat(self.ratio) * (old + change) + R::splat(1.0 - self.ratio) * new
    }
}
