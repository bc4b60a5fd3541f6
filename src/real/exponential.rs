//! The exponential of four numbers.
//!
//! With k the integer nearest to x / ln 2 and r = x − k ln 2, |r| ≤ ln 2 / 2, exp x − 1 = 2ᵏ (exp r − 1) + (2ᵏ − 1). The series
//! exp r − 1 = r + r²/2! + … + r¹⁴/14! leaves out less than 2⁻⁶¹ of the sum. ln 2 is split as in [`super::logarithm`], so that r keeps
//! its digits. The error is below 2 units in the last place.

use super::logarithm::{LN2_HIGH, LN2_LOW};
use super::polynomial::polynomial;
use super::{Mask, Real};

/// Beyond this the library is asked.
const LARGEST: f64 = 700.0;

/// 3 · 2⁵¹: what is added to it is rounded to an integer, which stands in the lowest bits.
pub(super) const ROUNDER: f64 = 6_755_399_441_055_744.0;

/// Four numbers whose powers of two can be had.
pub(super) trait Power: Real {
    /// 2ᵏ from k + [`ROUNDER`], for |k| < 1023; anything, but without a fault, elsewhere.
    fn power_of_two(self) -> Self;
}

/// 1/2!, 1/3! … 1/14!.
const SERIES: [f64; 13] = {
    let mut series = [1.0; 13];
    let mut factorial = 1.0;
    let mut n = 0;
    while n < series.len() {
        factorial *= (n + 2) as f64;
        series[n] = 1.0 / factorial;
        n += 1;
    }
    series
};

#[inline(always)]
pub(super) fn exp_m1<R: Power>(x: R) -> R {
    let ordinary = x.abs().less(R::splat(LARGEST));
    let rounded = x * std::f64::consts::LOG2_E + ROUNDER;
    let k = rounded - ROUNDER;
    let r = k.mul_add(R::splat(-LN2_LOW), k.mul_add(R::splat(-LN2_HIGH), x));
    let small = (r * r).mul_add(polynomial(r, &SERIES), r);
    let power = rounded.power_of_two();
    let result = small.mul_add(power, power - 1.0);
    if ordinary.all() {
        result
    } else {
        super::logarithm::others(x, ordinary, result, f64::exp_m1)
    }
}
