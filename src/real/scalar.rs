//! One number.

use super::{Mask, Real};

impl Mask for bool {
    #[inline(always)]
    fn all(self) -> bool {
        self
    }
    #[inline(always)]
    fn lane(self, _: usize) -> bool {
        self
    }
}

impl Real for f64 {
    const LANES: usize = 1;
    type Mask = bool;

    #[inline(always)]
    fn splat(x: f64) -> Self {
        x
    }
    #[inline(always)]
    fn lane(self, _: usize) -> f64 {
        self
    }
    #[inline(always)]
    fn with_lane(self, _: usize, x: f64) -> Self {
        x
    }
    #[inline(always)]
    fn read_strided(from: &[f64], _: usize, numbers: &mut [Self]) {
        numbers.copy_from_slice(&from[..numbers.len()]);
    }
    #[inline(always)]
    fn read_fours(from: &[f64], _: usize) -> Self {
        from[0]
    }
    #[inline(always)]
    fn write_strided(to: &mut [f64], _: usize, numbers: &[Self]) {
        to[..numbers.len()].copy_from_slice(numbers);
    }
    #[inline(always)]
    fn mul_add(self, b: Self, c: Self) -> Self {
        // not f64::mul_add: without the instruction it is a slow library call
        self * b + c
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }
    #[inline(always)]
    fn floor(self) -> Self {
        // not f64::floor, which is a library call on the oldest processors; beyond 2^63 there are no other numbers
        let whole = self as i64 as f64;
        whole - f64::from(u8::from(whole > self))
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        if self < other { self } else { other }
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        if self > other { self } else { other }
    }
    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        f64::copysign(self, sign)
    }
    #[inline(always)]
    fn greater(self, other: Self) -> bool {
        self > other
    }
    #[inline(always)]
    fn at_most(self, other: Self) -> bool {
        self <= other
    }
    #[inline(always)]
    fn select(mask: bool, a: Self, b: Self) -> Self {
        if mask { a } else { b }
    }
    #[inline(always)]
    fn ln(self) -> Self {
        f64::ln(self)
    }
    #[inline(always)]
    fn ln_1p(self) -> Self {
        f64::ln_1p(self)
    }
    #[inline(always)]
    fn exp_m1(self) -> Self {
        f64::exp_m1(self)
    }
}
