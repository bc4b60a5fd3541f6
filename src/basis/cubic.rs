//! Cubic B-splines: slopes and curvatures pass smoothly across cell edges.

use super::{Axis, Basis, spline};
use crate::input::{Parameters, Reader};

/// Cubic B-splines on open uniform knots at the cell edges.
///
/// Away from the ends and with s = x − c, r = 1 − s in cell c, the functions c … c + 3 are r³/6, 2/3 − s² (1 + r)/2,
/// 2/3 − r² (1 + s)/2 and s³/6.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CubicBSpline;

impl Parameters for CubicBSpline {
    fn read(_: &mut Reader<'_>) -> Option<Self> {
        Some(Self)
    }
}

impl Basis<4> for CubicBSpline {
    #[inline(always)]
    fn axis(&self, x: f64, cells: i32) -> Axis<4> {
        let first = spline::cell_of(x, cells);
        if first < 2 || first > cells - 3 {
            return spline::clamped(x, first, cells);
        }
        let s = x - f64::from(first);
        let r = 1.0 - s;
        let (s2, r2) = (s * s, r * r);
        let (lowest, highest) = (r2 * r / 6.0, s2 * s / 6.0);
        let lower = 2.0 / 3.0 - 0.5 * s2 * (1.0 + r);
        Axis {
            first,
            // 2/3 is not a number of the machine: what the others leave of one makes the sum one, and momentum constant
            weight: [lowest, lower, 1.0 - lowest - lower - highest, highest],
            slope: [
                -0.5 * r2,
                s * (1.5 * s - 2.0),
                r * (2.0 - 1.5 * r),
                0.5 * s2,
            ],
            arm: [-1.0 - s, -s, r, 1.0 + r],
        }
    }

    fn count(&self, cells: i32) -> i32 {
        cells + 3
    }

    fn position(&self, index: i32, cells: i32) -> f64 {
        spline::greville(index, 3, cells)
    }
}
