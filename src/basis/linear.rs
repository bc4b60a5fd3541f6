//! Hat functions, one a grid node.

use super::{Basis, Functions};
use crate::input::{Parameters, Reader};
use crate::real::Real;

/// Piecewise linear functions: N = 1 − |x − i| on |x − i| < 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Linear;

impl Parameters for Linear {
    fn read(_: &mut Reader<'_>) -> Option<Self> {
        Some(Self)
    }
}

impl Basis<2> for Linear {
    const AFFINE_IS_SLOPE: bool = true;
    const SLOPES_JUMP: bool = true;

    #[inline(always)]
    fn functions<R: Real>(&self, s: R) -> Functions<R, 2> {
        let one = R::splat(1.0);
        Functions {
            weight: [one - s, s],
            slope: [-one, one],
            arm: [-s, one - s],
        }
    }

    fn count(&self, cells: i32) -> i32 {
        cells + 1
    }

    fn position(&self, index: i32, _cells: i32) -> f64 {
        f64::from(index)
    }
}
