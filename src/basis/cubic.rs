//! Cubic B-splines: slopes and curvatures pass smoothly across cell edges.

use super::{Basis, Functions, spline};
use crate::input::{Parameters, Reader};
use crate::real::Real;

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
    const INERTIA: Option<f64> = Some(1.0 / 3.0);

    #[inline(always)]
    fn functions<R: Real>(&self, s: R) -> Functions<R, 4> {
        let (half, one, two) = (R::splat(0.5), R::splat(1.0), R::splat(2.0));
        let (sixth, slant) = (R::splat(1.0 / 6.0), R::splat(1.5));
        let r = one - s;
        let (s2, r2) = (s * s, r * r);
        let (lowest, highest) = (r2 * r * sixth, s2 * s * sixth);
        let lower = R::splat(2.0 / 3.0) - half * s2 * (one + r);
        Functions {
            // 2/3 is not a number of the machine: what the others leave of one makes the sum one, and momentum constant
            weight: [lowest, lower, one - lowest - lower - highest, highest],
            slope: [
                -half * r2,
                s * (slant * s - two),
                r * (two - slant * r),
                half * s2,
            ],
            arm: [-one - s, -s, r, one + r],
        }
    }

    fn alike(&self, cells: i32) -> (i32, i32) {
        (2, cells - 3)
    }

    #[inline(always)]
    fn at_end<R: Real>(&self, x: R, first: R, cells: i32) -> Functions<R, 4> {
        spline::clamped(x, first, cells)
    }

    fn count(&self, cells: i32) -> i32 {
        cells + 3
    }

    fn position(&self, index: i32, cells: i32) -> f64 {
        spline::position::<4>(index, cells)
    }
}
