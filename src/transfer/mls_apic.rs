//! APIC with moving least squares: the affine velocity field of a particle is its velocity gradient too.

use super::Transfer;
use crate::input::{Parameters, Reader};
use crate::real::Real;

/// As [`Apic`](super::Apic), with ∇v = C, and nodal forces f_i = −V₀ τ D⁻¹ N_i (x_i − x): the gradient of the linear field that
/// fits the nodes' velocities best, weighted by N_i, in place of Σ v_i ∇N_iᵀ. One pass over the nodes yields both.
///
/// Source: Y. Hu et al., "A moving least squares material point method with displacement discontinuity and two-way rigid body
/// coupling", ACM Trans. Graph. 37 (2018) 150, where D is that of a uniform spline; here it is computed, so that it holds at
/// the ends of a grid and for any basis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MlsApic;

impl Parameters for MlsApic {
    fn read(_: &mut Reader<'_>) -> Option<Self> {
        Some(Self)
    }
}

impl Transfer for MlsApic {
    const AFFINE: bool = true;
    const CHANGE: bool = false;
    const MOVING_LEAST_SQUARES: bool = true;

    fn ratio(&self) -> f64 {
        0.0
    }

    #[inline(always)]
    fn velocity<R: Real>(&self, _old: R, new: R, _change: R) -> R {
        new
    }
}
