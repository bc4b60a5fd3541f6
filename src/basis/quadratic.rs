//! Quadratic B-splines: smooth across cell edges, so that a point that changes cells meets no jump in slope.

use super::{Axis, Basis, spline};
use crate::input::{Parameters, Reader};

/// Quadratic B-splines on open uniform knots at the cell edges.
///
/// Away from the ends and with s = x − c in cell c, the functions c, c + 1, c + 2 are (1 − s)²/2, 3/4 − (s − 1/2)², s²/2.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct QuadraticBSpline;

impl Parameters for QuadraticBSpline {
    fn read(_: &mut Reader<'_>) -> Option<Self> {
        Some(Self)
    }
}

impl Basis<3> for QuadraticBSpline {
    #[inline(always)]
    fn axis(&self, x: f64, cells: i32) -> Axis<3> {
        let first = spline::cell_of(x, cells);
        if first < 1 || first > cells - 2 {
            return spline::clamped(x, first, cells);
        }
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

    fn position(&self, index: i32, cells: i32) -> f64 {
        spline::greville(index, 2, cells)
    }
}
