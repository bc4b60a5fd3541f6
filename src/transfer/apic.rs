//! Affine particle in cell: particles take the velocity of the grid and keep its local gradient, which conserves angular momentum.

use super::Transfer;
use crate::input::{Parameters, Reader};
use crate::real::Real;

/// v = Σ N_i v_i, and C = B D⁻¹ with B = Σ N_i v_i (x_i − x)ᵀ, D = Σ N_i (x_i − x)(x_i − x)ᵀ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Apic;

impl Parameters for Apic {
    fn read(_: &mut Reader<'_>) -> Option<Self> {
        Some(Self)
    }
}

impl Transfer for Apic {
    const AFFINE: bool = true;
    const CHANGE: bool = false;

    fn ratio(&self) -> f64 {
        0.0
    }

    #[inline(always)]
    fn velocity<R: Real>(&self, _old: R, new: R, _change: R) -> R {
        new
    }
}
