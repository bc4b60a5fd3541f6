//! Quadratic B-splines: smooth across cell edges, so that a point that changes cells meets no jump in slope.

use super::{Basis, Functions, spline};
use crate::input::{Parameters, Reader};
use crate::real::Real;

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
    const INERTIA: Option<f64> = Some(1.0 / 4.0);

    #[inline(always)]
    fn functions<R: Real>(&self, s: R) -> Functions<R, 3> {
        let (half, one) = (R::splat(0.5), R::splat(1.0));
        let r = one - s;
        Functions {
            weight: [half * r * r, half + r * s, half * s * s],
            slope: [-r, r - s, s],
            arm: [-half - s, half - s, one + half - s],
        }
    }

    fn alike(&self, cells: i32) -> (i32, i32) {
        (1, cells - 2)
    }

    #[inline(always)]
    fn at_end<R: Real>(&self, x: R, first: R, cells: i32) -> Functions<R, 3> {
        spline::clamped(x, first, cells)
    }

    fn count(&self, cells: i32) -> i32 {
        cells + 2
    }

    fn position(&self, index: i32, cells: i32) -> f64 {
        spline::position::<3>(index, cells)
    }
}
