//! Quadratic B-splines that are the same everywhere: the outermost functions stand half a cell outside the grid.

use super::{Axis, Basis};
use crate::input::{Parameters, Reader};

/// With s = x − c in cell c the functions c, c + 1, c + 2 are (1 − s)²/2, 3/4 − (s − 1/2)², s²/2.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ghosted;

impl Parameters for Ghosted {
    fn read(_: &mut Reader<'_>) -> Option<Self> {
        Some(Self)
    }
}

impl Basis<3> for Ghosted {
    fn axis(&self, x: f64, cells: i32) -> Axis<3> {
        let first = (x as i32).min(cells - 1);
        let s = x - f64::from(first);
        let r = 1.0 - s;
        Axis {
            first,
            weight: [0.5 * r * r, 0.5 + r * s, 0.5 * s * s],
            slope: [-r, r - s, s],
            arm: [-0.5 - s, 0.5 - s, 1.5 - s],
        }
    }

    fn count(&self, cells: i32) -> i32 {
        cells + 2
    }

    fn position(&self, index: i32, _cells: i32) -> f64 {
        f64::from(index) - 0.5
    }
}
