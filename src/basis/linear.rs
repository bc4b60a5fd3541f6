//! Hat functions, one a grid node.

use super::{Axis, Basis};
use crate::input::{Parameters, Reader};

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

    #[inline(always)]
    fn axis(&self, x: f64, cells: i32) -> Axis<2> {
        let first = (x as i32).min(cells - 1);
        let s = x - f64::from(first);
        Axis { first, weight: [1.0 - s, s], slope: [-1.0, 1.0], arm: [-s, 1.0 - s] }
    }

    fn count(&self, cells: i32) -> i32 {
        cells + 1
    }

    fn position(&self, index: i32, _cells: i32) -> f64 {
        f64::from(index)
    }
}
