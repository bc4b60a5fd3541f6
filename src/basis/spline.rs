//! What B-splines of any degree share: the plain recursion, used where knots coincide at the ends of the grid.
//!
//! The knots are open (clamped): every cell edge is a knot, and both ends of the grid are knots `degree + 1` times. In the
//! middle of the grid all functions are shifted copies of one; within a few cells of an end they are not.

use super::Functions;
use crate::real::Real;

/// Knot number `degree + index` of splines over so many cells, held between the ends of the grid.
#[inline(always)]
fn knot<R: Real>(index: R, cells: R) -> R {
    index.max(R::splat(0.0)).min(cells)
}

/// The `N` functions of degree N − 1 that are not zero in `cell`, for any cell of a grid of any size.
///
/// Cox–de Boor recursion from degree 0 upwards:
/// `N_{i,q} = (x − t_i) / (t_{i+q} − t_i) N_{i,q−1} + (t_{i+q+1} − x) / (t_{i+q+1} − t_{i+1}) N_{i+1,q−1}`,
/// whose derivative is `q N_{i,q−1} / (t_{i+q} − t_i) − q N_{i+1,q−1} / (t_{i+q+1} − t_{i+1})`; a term over an interval of
/// length zero is zero. The intervals met here all contain the cell, so that none has length zero.
#[inline(always)]
pub(super) fn clamped<R: Real, const N: usize>(x: R, cell: R, cells: i32) -> Functions<R, N> {
    let zero = R::splat(0.0);
    let last = R::splat(f64::from(cells));
    let mut weight = [zero; N];
    let mut slope = [zero; N];
    weight[0] = R::splat(1.0);
    for q in 1..N {
        let mut carried = zero;
        let mut carried_slope = zero;
        for k in 0..q {
            // function k of degree q − 1 feeds functions k and k + 1 of degree q
            let upper = cell + (k + 1) as f64;
            let (lower, upper) = (knot(upper - q as f64, last), knot(upper, last));
            let share = weight[k] / (upper - lower);
            weight[k] = carried + (upper - x) * share;
            carried = (x - lower) * share;
            slope[k] = carried_slope - share * q as f64;
            carried_slope = share * q as f64;
        }
        weight[q] = carried;
        slope[q] = carried_slope;
    }
    let mut arm = [zero; N];
    for k in 0..N {
        arm[k] = greville::<R, N>(cell + k as f64, last) - x;
    }
    Functions { weight, slope, arm }
}

/// The Greville abscissa of function `index` of degree N − 1, the mean of its inner knots: with these coefficients the splines
/// add up to x.
#[inline(always)]
fn greville<R: Real, const N: usize>(index: R, cells: R) -> R {
    let degree = (N - 1) as f64;
    let mut sum = R::splat(0.0);
    for j in 1..N {
        sum = sum + knot(index + (j as f64 - degree), cells);
    }
    sum / degree
}

/// Where function `index` of the splines of degree N − 1 stands, in cells.
pub(super) fn position<const N: usize>(index: i32, cells: i32) -> f64 {
    greville::<f64, N>(f64::from(index), f64::from(cells))
}
