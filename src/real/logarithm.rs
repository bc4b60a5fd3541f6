//! The natural logarithm of four numbers.
//!
//! Source: the functions `log` and `log1p` of fdlibm (Sun Microsystems, 1993; `s_log1p.c` and `e_log.c` of FreeBSD's msun),
//! whose constants these are. x = 2ᵏ (1 + f) with √½ ≤ 1 + f < √2, s = f / (2 + f) and z = s² give
//!
//! ln(1 + f) = 2 artanh s = f − f²/2 + s (f²/2 + R(z)), R(z) ≈ z (2/3 + 2z/5 + 2z²/7 + …) to 2⁻⁵⁸·⁴⁵,
//!
//! and ln x = k ln 2 + ln(1 + f) with ln 2 split into a part of few bits and a rest, so that k times the former is exact.
//! The error is below 1 unit in the last place.

use super::polynomial::polynomial;
use super::{Mask, Real};

pub(super) const LN2_HIGH: f64 = 6.931_471_803_691_238e-1;
pub(super) const LN2_LOW: f64 = 1.908_214_929_270_587_7e-10;

/// R(z)/z, the highest power first: Lg7 … Lg1 of the source.
const SERIES: [f64; 7] = [
    1.479_819_860_511_658_6e-1,
    1.531_383_769_920_937_3e-1,
    1.818_357_216_161_805e-1,
    2.222_219_843_214_978_4e-1,
    2.857_142_874_366_239e-1,
    3.999_999_999_940_942e-1,
    6.666_666_666_666_735e-1,
];

/// Largest number that the formulas are used for; the logarithms of what is beyond it are left to the library, as are those of
/// subnormal and negative numbers, zero and NaN.
const LARGEST: f64 = 1e300;

/// Four numbers whose exponents can be had.
pub(super) trait Exponent: Real {
    /// (2⁻ᵏ, k) with √½ ≤ 2⁻ᵏ x < √2, for positive normal x below [`LARGEST`]; anything, but without a fault, elsewhere.
    fn exponent(self) -> (Self, Self);
}

/// Bits of √½, the lowest 32 left out.
pub(super) const ROOT_HALF: u64 = 0x3fe6_a09e_0000_0000;
/// Bits of 1.
pub(super) const ONE: u64 = 0x3ff0_0000_0000_0000;
/// Bits of the exponent and the sign.
pub(super) const EXPONENT: u64 = 0xfff0_0000_0000_0000;
/// Bits of 2⁵², in whose mantissa an integer is a number.
pub(super) const TWO_52: u64 = 0x4330_0000_0000_0000;
/// Bits of an exponent of twice the bias: less the exponent of 2ᵏ it is that of 2⁻ᵏ.
pub(super) const TWICE_BIAS: u64 = 0x7fe0_0000_0000_0000;
/// 2⁵² and the exponent's bias together.
pub(super) const BIAS: f64 = 4_503_599_627_370_496.0 + 1023.0;

/// k ln 2 + ln(1 + f).
#[inline(always)]
fn sum<R: Real>(k: R, f: R) -> R {
    let s = f / (f + 2.0);
    let z = s * s;
    // odd and even powers apart: what takes time is the chain of operations that wait for each other
    let w = z * z;
    let [g7, g6, g5, g4, g3, g2, g1] = SERIES;
    let odd = w.mul_add(R::splat(g7), R::splat(g5));
    let odd = odd.mul_add(w, R::splat(g3)).mul_add(w, R::splat(g1));
    let even = w.mul_add(R::splat(g6), R::splat(g4));
    let even = even.mul_add(w, R::splat(g2));
    let series = even.mul_add(z, odd);
    let half_square = f * 0.5 * f;
    let rest = s.mul_add(series.mul_add(z, half_square), k * LN2_LOW);
    k.mul_add(R::splat(LN2_HIGH), (rest - half_square) + f)
}

#[inline(always)]
pub(super) fn ln<R: Exponent>(x: R) -> R {
    let ordinary = x.greater(R::splat(f64::MIN_POSITIVE)) & x.less(R::splat(LARGEST));
    let (scale, k) = x.exponent();
    let result = sum(k, x.mul_add(scale, R::splat(-1.0)));
    if ordinary.all() {
        result
    } else {
        others(x, ordinary, result, f64::ln)
    }
}

/// Up to which |x| the Taylor series of ln(1 + x) is used: most solids do not change their volume by more, and the series waits
/// for far fewer operations.
const NEAR: f64 = 0.125;

/// 1/3, −1/4 … 1/17.
const NEAR_SERIES: [f64; 15] = {
    let mut series = [0.0; 15];
    let mut n = 0;
    while n < series.len() {
        let sign = if n % 2 == 0 { 1.0 } else { -1.0 };
        series[n] = sign / (n + 3) as f64;
        n += 1;
    }
    series
};

/// x − x²/2 + x³/3 − … + x¹⁷/17; what is left out is below 2⁻⁵⁵ of the first term where |x| is at most [`NEAR`].
#[inline(always)]
fn near<R: Real>(x: R) -> R {
    let series = polynomial(x, &NEAR_SERIES);
    (x * x).mul_add(x.mul_add(series, R::splat(-0.5)), x)
}

/// ln(1 + x).
#[inline(always)]
pub(super) fn ln_1p<R: Exponent>(x: R) -> R {
    let small = x.abs().at_most(R::splat(NEAR));
    let result = near(x);
    if small.all() {
        result
    } else {
        // each lane gets what it would get with any others beside it
        R::select(small, result, far(x))
    }
}

/// 1 + x rounds to u; what that loses, c = x − (u − 1), is added to f.
#[inline(always)]
fn far<R: Exponent>(x: R) -> R {
    let u = x + 1.0;
    let c = x - (u - 1.0);
    let ordinary = u.greater(R::splat(f64::MIN_POSITIVE)) & u.less(R::splat(LARGEST));
    let (scale, k) = u.exponent();
    let result = sum(k, c.mul_add(scale, u.mul_add(scale, R::splat(-1.0))));
    if ordinary.all() {
        result
    } else {
        others(x, ordinary, result, f64::ln_1p)
    }
}

/// Asks the library for those lanes that are not ordinary.
#[cold]
#[inline(never)]
pub(super) fn others<R: Real>(x: R, ordinary: R::Mask, result: R, library: fn(f64) -> f64) -> R {
    let mut result = result;
    for k in 0..R::LANES {
        if !ordinary.lane(k) {
            result = result.with_lane(k, library(x.lane(k)));
        }
    }
    result
}
