//! Four numbers, one after the other: plain arithmetic for any processor.

use super::exponential::{self, Power};
use super::logarithm::{self, BIAS, EXPONENT, Exponent, ONE, ROOT_HALF, TWICE_BIAS, TWO_52};
use super::{Mask, Real, operators};
use std::ops::{BitAnd, BitOr, Neg, Not};

/// Four `f64`.
#[derive(Clone, Copy, Debug)]
pub struct Portable(pub(crate) [f64; 4]);

/// Four answers.
#[derive(Clone, Copy, Debug)]
pub struct PortableMask([bool; 4]);

/// An array of the values that an expression has in every lane of some variables.
macro_rules! each {
    ($($x:ident),+ => $value:expr) => {
        [
            { $(let $x = $x.0[0];)+ $value },
            { $(let $x = $x.0[1];)+ $value },
            { $(let $x = $x.0[2];)+ $value },
            { $(let $x = $x.0[3];)+ $value },
        ]
    };
}

impl Portable {
    #[inline(always)]
    fn sum(self, b: Self) -> Self {
        let a = self;
        Self(each!(a, b => a + b))
    }
    #[inline(always)]
    fn difference(self, b: Self) -> Self {
        let a = self;
        Self(each!(a, b => a - b))
    }
    #[inline(always)]
    fn product(self, b: Self) -> Self {
        let a = self;
        Self(each!(a, b => a * b))
    }
    #[inline(always)]
    fn quotient(self, b: Self) -> Self {
        let a = self;
        Self(each!(a, b => a / b))
    }
}

operators!(Portable, Add add Self::sum, Sub sub Self::difference, Mul mul Self::product, Div div Self::quotient);

impl Neg for Portable {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        let a = self;
        Self(each!(a => -a))
    }
}

impl Real for Portable {
    const LANES: usize = 4;
    type Mask = PortableMask;

    #[inline(always)]
    fn splat(x: f64) -> Self {
        Self([x; 4])
    }
    #[inline(always)]
    fn lane(self, k: usize) -> f64 {
        self.0[k]
    }
    #[inline(always)]
    fn with_lane(mut self, k: usize, x: f64) -> Self {
        self.0[k] = x;
        self
    }
    #[inline(always)]
    fn read_strided(from: &[f64], stride: usize, numbers: &mut [Self]) {
        assert!(from.len() >= 3 * stride + numbers.len());
        for (i, number) in numbers.iter_mut().enumerate() {
            *number = Self([
                from[i],
                from[stride + i],
                from[2 * stride + i],
                from[3 * stride + i],
            ]);
        }
    }
    #[inline(always)]
    fn read_fours(from: &[f64], _: usize) -> Self {
        Self([from[0], from[1], from[2], from[3]])
    }
    #[inline(always)]
    fn write_strided(to: &mut [f64], stride: usize, numbers: &[Self]) {
        assert!(to.len() >= 3 * stride + numbers.len());
        for (i, number) in numbers.iter().enumerate() {
            for k in 0..4 {
                to[k * stride + i] = number.0[k];
            }
        }
    }
    #[inline(always)]
    fn mul_add(self, b: Self, c: Self) -> Self {
        // not f64::mul_add: without the instruction it is a slow library call
        let a = self;
        Self(each!(a, b, c => a * b + c))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        let a = self;
        Self(each!(a => a.sqrt()))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        let a = self;
        Self(each!(a => a.abs()))
    }
    #[inline(always)]
    fn floor(self) -> Self {
        let x = self;
        Self(each!(x => Real::floor(x)))
    }
    #[inline(always)]
    fn min(self, b: Self) -> Self {
        let a = self;
        Self(each!(a, b => Real::min(a, b)))
    }
    #[inline(always)]
    fn max(self, b: Self) -> Self {
        let a = self;
        Self(each!(a, b => Real::max(a, b)))
    }
    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        let a = self;
        Self(each!(a, sign => a.copysign(sign)))
    }
    #[inline(always)]
    fn greater(self, b: Self) -> PortableMask {
        let a = self;
        PortableMask(each!(a, b => a > b))
    }
    #[inline(always)]
    fn at_most(self, b: Self) -> PortableMask {
        let a = self;
        PortableMask(each!(a, b => a <= b))
    }
    #[inline(always)]
    fn select(mask: PortableMask, a: Self, b: Self) -> Self {
        Self(each!(mask, a, b => if mask { a } else { b }))
    }
    #[inline(always)]
    fn ln(self) -> Self {
        logarithm::ln(self)
    }
    #[inline(always)]
    fn ln_1p(self) -> Self {
        logarithm::ln_1p(self)
    }
    #[inline(always)]
    fn exp_m1(self) -> Self {
        exponential::exp_m1(self)
    }
}

impl Exponent for Portable {
    #[inline(always)]
    fn exponent(self) -> (Self, Self) {
        let shifted = [0, 1, 2, 3].map(|k| self.0[k].to_bits().wrapping_add(ONE - ROOT_HALF));
        let scale = shifted.map(|bits| f64::from_bits(TWICE_BIAS.wrapping_sub(bits & EXPONENT)));
        let k = shifted.map(|bits| f64::from_bits(bits >> 52 | TWO_52) - BIAS);
        (Self(scale), Self(k))
    }
}

impl Power for Portable {
    #[inline(always)]
    fn power_of_two(self) -> Self {
        Self(
            self.0
                .map(|x| f64::from_bits(x.to_bits().wrapping_add(1023) << 52)),
        )
    }
}

impl BitAnd for PortableMask {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, b: Self) -> Self {
        let a = self;
        Self(each!(a, b => a & b))
    }
}

impl BitOr for PortableMask {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, b: Self) -> Self {
        let a = self;
        Self(each!(a, b => a | b))
    }
}

impl Not for PortableMask {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        let a = self;
        Self(each!(a => !a))
    }
}

impl Mask for PortableMask {
    #[inline(always)]
    fn all(self) -> bool {
        self.0[0] & self.0[1] & self.0[2] & self.0[3]
    }
    #[inline(always)]
    fn lane(self, k: usize) -> bool {
        self.0[k]
    }
}
