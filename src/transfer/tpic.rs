//! Taylor particle in cell: as APIC, with the velocity gradient that strains the points in place of the fitted affine field.

use super::Transfer;
use crate::input::{Parameters, Reader};
use crate::real::Real;

/// v = Σ N_i v_i, and C = ∇v = Σ v_i ∇N_iᵀ; the momentum of a point on node i is N_i m (v + C (x_i − x)).
///
/// Source: K. Nakamura, Tesserae.jl, documentation, "Transfer between grid and particles", section "Taylor PIC (TPIC)".
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tpic;

impl Parameters for Tpic {
    fn read(_: &mut Reader<'_>) -> Option<Self> {
        Some(Self)
    }
}

impl Transfer for Tpic {
    const AFFINE: bool = true;
    const CHANGE: bool = false;
    const TAYLOR: bool = true;

    fn ratio(&self) -> f64 {
        0.0
    }

    #[inline(always)]
    fn velocity<R: Real>(&self, _old: R, new: R, _change: R) -> R {
        new
    }
}
