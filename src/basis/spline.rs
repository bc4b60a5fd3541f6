//! What B-splines of any degree share: the plain recursion, used where knots coincide at the ends of the grid.
//!
//! The knots are open (clamped): every cell edge is a knot, and both ends of the grid are knots `degree + 1` times. In the
//! middle of the grid all functions are shifted copies of one; within a few cells of an end they are not.

use super::Axis;

/// Knot number `index` of splines of `degree` over `cells` cells: j − p, held between the ends of the grid.
fn knot(index: i32, degree: i32, cells: i32) -> f64 {
    f64::from((index - degree).clamp(0, cells))
}

/// The `N` functions of degree N − 1 that are not zero in `cell`, for any cell of a grid of any size.
///
/// Cox–de Boor recursion from degree 0 upwards:
/// `N_{i,q} = (x − t_i) / (t_{i+q} − t_i) N_{i,q−1} + (t_{i+q+1} − x) / (t_{i+q+1} − t_{i+1}) N_{i+1,q−1}`,
/// whose derivative is `q N_{i,q−1} / (t_{i+q} − t_i) − q N_{i+1,q−1} / (t_{i+q+1} − t_{i+1})`; a term over an interval of
/// length zero is zero. The intervals met here all contain the cell, so that none has length zero.
#[cold]
#[inline(never)]
pub(super) fn clamped<const N: usize>(x: f64, cell: i32, cells: i32) -> Axis<N> {
    let degree = N as i32 - 1;
    let span = cell + degree; // number of the knot at the lower end of the cell
    let mut weight = [0.0; N];
    let mut slope = [0.0; N];
    weight[0] = 1.0;
    for q in 1..N {
        let mut carried = 0.0;
        let mut carried_slope = 0.0;
        for k in 0..q {
            // function k of degree q − 1 feeds functions k and k + 1 of degree q
            let lower = knot(span + 1 + k as i32 - q as i32, degree, cells);
            let upper = knot(span + 1 + k as i32, degree, cells);
            let share = weight[k] / (upper - lower);
            weight[k] = carried + (upper - x) * share;
            carried = (x - lower) * share;
            slope[k] = carried_slope - q as f64 * share;
            carried_slope = q as f64 * share;
        }
        weight[q] = carried;
        slope[q] = carried_slope;
    }
    let mut arm = [0.0; N];
    for k in 0..N {
        arm[k] = greville(cell + k as i32, degree, cells) - x;
    }
    Axis {
        first: cell,
        weight,
        slope,
        arm,
    }
}

/// The Greville abscissa of function `index`, the mean of its inner knots: with these coefficients the splines of `degree`
/// add up to x.
pub(super) fn greville(index: i32, degree: i32, cells: i32) -> f64 {
    let inner = index + 1..=index + degree;
    inner.map(|j| knot(j, degree, cells)).sum::<f64>() / f64::from(degree)
}
