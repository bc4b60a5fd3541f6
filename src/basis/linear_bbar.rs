//! Hat functions with the volume changes of the middle of the cell, against locking.
//!
//! Near ν = ½ every point forbids a change of its volume. With several points a cell that is more than the nodes of hat functions
//! can obey, and the body grows stiff. One change of volume a cell is what they can.

use super::{Basis, Functions, Linear};
use crate::input::{Parameters, Reader};
use crate::real::Real;

/// As [`Linear`], with selective integration: L̄ = L + (1/d) (tr L_c − tr L) I strains a point, L_c being the velocity gradient at
/// the middle of its cell, and f_i = −V₀ [(τ − p I) ∇N_i(x) + p ∇N_i(x_c)] with p = tr τ / d is the force of equal power, d the
/// number of dimensions. In the total Lagrangian frame the same holds for L = Ḟ F⁻¹ with the point's own F. Finite elements know
/// such methods as B̄; this form of it is derived here.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LinearBBar;

impl Parameters for LinearBBar {
    fn read(_: &mut Reader<'_>) -> Option<Self> {
        Some(Self)
    }
}

impl Basis<2> for LinearBBar {
    const AFFINE_IS_SLOPE: bool = Linear::AFFINE_IS_SLOPE;
    const SLOPES_JUMP: bool = Linear::SLOPES_JUMP;
    const DILATION_AT_CENTRE: bool = true;

    #[inline(always)]
    fn functions<R: Real>(&self, s: R) -> Functions<R, 2> {
        Linear.functions(s)
    }

    fn count(&self, cells: i32) -> i32 {
        Linear.count(cells)
    }

    fn position(&self, index: i32, cells: i32) -> f64 {
        Linear.position(index, cells)
    }
}
