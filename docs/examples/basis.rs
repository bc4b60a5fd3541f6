//! Quadratic B-splines that are the same everywhere: the outermost functions stand half a cell outside the grid.

use super::{Basis, Functions};
use crate::input::{Parameters, Reader};
use crate::real::Real;

/// With s = x − c in cell c the functions c, c + 1, c + 2 are (1 − s)²/2, 3/4 − (s − 1/2)², s²/2.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ghosted;

impl Parameters for Ghosted {
    fn read(_: &mut Reader<'_>) -> Option<Self> {
        Some(Self)
    }
}

impl Basis<3> for Ghosted {
    #[inline(always)]
    fn functions<R: Real>(&self, s: R) -> Functions<R, 3> {
        let r = R::splat(1.0) - s;
        Functions {
            weight: [r * r * 0.5, r * s + 0.5, s * s * 0.5],
            slope: [-r, r - s, s],
            arm: [-s - 0.5, -s + 0.5, -s + 1.5],
        }
    }

    fn count(&self, cells: i32) -> i32 {
        cells + 2
    }

    fn position(&self, index: i32, _cells: i32) -> f64 {
        f64::from(index) - 0.5
    }
}
