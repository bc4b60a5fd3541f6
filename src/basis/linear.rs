//! Hat functions, one a grid node.

use super::{Basis, Functions};
use crate::input::{Parameters, Reader};
use crate::real::Real;

/// Piecewise linear functions: N = 1 − |x − i| on |x − i| < 1.
///
/// Near ν = ½ every point forbids a change of its volume. With several points a cell that is more than the nodes of hat functions
/// can obey, and a body grows stiff. One change of volume a cell is what they can: with `b_bar` L̄ = L + (1/d) (tr L_c − tr L) I
/// strains a point, L_c being the velocity gradient at the middle of its cell, and f_i = −V₀ [(τ − p I) ∇N_i(x) + p ∇N_i(x_c)]
/// with p = tr τ / d is the force of equal power, d the number of dimensions. In the total Lagrangian frame the same holds for
/// L = Ḟ F⁻¹ with the point's own F. Finite elements know such methods as B̄; this form of it is derived here.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Linear {
    /// Whether changes of volume are those at the middle of the cell. Only for points that stay in their cells: one that has just
    /// come into a cell would push at nodes that have next to none of its mass.
    pub b_bar: bool,
}

impl Parameters for Linear {
    fn read(reader: &mut Reader<'_>) -> Option<Self> {
        Some(Self {
            b_bar: reader.flag("b_bar", false)?,
        })
    }
}

impl Basis<2> for Linear {
    const AFFINE_IS_SLOPE: bool = true;
    const SLOPES_JUMP: bool = true;
    const BENDS: bool = false;

    #[inline(always)]
    fn functions<R: Real>(&self, s: R) -> Functions<R, 2> {
        let one = R::splat(1.0);
        Functions {
            weight: [one - s, s],
            slope: [-one, one],
            arm: [-s, one - s],
        }
    }

    #[inline(always)]
    fn dilation_at_centre(&self) -> bool {
        self.b_bar
    }

    fn count(&self, cells: i32) -> i32 {
        cells + 1
    }

    fn position(&self, index: i32, _cells: i32) -> f64 {
        f64::from(index)
    }
}
