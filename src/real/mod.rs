//! Real numbers that a formula is written in once: one `f64`, or four of them that are computed together.
//!
//! Functions that take numbers of four must be inlined into the function that was compiled for wide instructions: mark them
//! `#[inline(always)]` and keep such numbers out of closures. Otherwise every operation becomes a call.

#[cfg(target_arch = "x86_64")]
mod avx;
mod exponential;
mod logarithm;
mod portable;
mod scalar;
#[cfg(test)]
mod tests;

#[cfg(target_arch = "x86_64")]
pub use avx::Avx;
pub use portable::Portable;

use std::fmt::Debug;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// One or four numbers. Operations between it and an `f64` take the `f64` on the right.
pub trait Real:
    Copy
    + Debug
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
    + 'static
{
    /// How many numbers it holds: 1 or 4.
    const LANES: usize;

    /// What comparing gives.
    type Mask: Mask;

    /// The same number in every lane.
    fn splat(x: f64) -> Self;

    /// The number in one lane.
    fn lane(self, k: usize) -> f64;

    /// With another number in one lane.
    fn with_lane(self, k: usize, x: f64) -> Self;

    /// Reads one row of `numbers.len()` numbers for each lane, the rows one after the other: row k goes to lane k of every
    /// number.
    fn read_rows(rows: &[f64], numbers: &mut [Self]);

    /// Writes what [`Self::read_rows`] reads.
    fn write_rows(rows: &mut [f64], numbers: &[Self]);

    /// Reads the first `numbers.len()` (at most four) of the four numbers of a row for each lane; where there is one lane only
    /// the first row counts.
    fn read_padded(rows: [&[f64; 4]; 4], numbers: &mut [Self]);

    /// Writes what [`Self::read_padded`] reads, and leaves the rest of the rows.
    fn write_padded(rows: [&mut [f64; 4]; 4], numbers: &[Self]);

    /// Asks the processor for the cache lines of `count` numbers that are needed soon. The address may be any; nothing is read.
    #[inline(always)]
    fn prefetch(from: *const f64, count: usize) {
        let _ = (from, count);
    }

    /// `self * b + c`, rounded once or twice as the processor can.
    fn mul_add(self, b: Self, c: Self) -> Self;

    /// √x.
    fn sqrt(self) -> Self;

    /// |x|.
    fn abs(self) -> Self;

    /// The largest whole number that is not above it.
    fn floor(self) -> Self;

    /// The smaller one; `other` where either is NaN.
    fn min(self, other: Self) -> Self;

    /// The larger one; `other` where either is NaN.
    fn max(self, other: Self) -> Self;

    /// The size of `self` with the sign of `sign`.
    fn copysign(self, sign: Self) -> Self;

    /// Where it is greater than `other`; nowhere where either is NaN.
    fn greater(self, other: Self) -> Self::Mask;

    /// Where it is less than or equal to `other`; nowhere where either is NaN.
    fn at_most(self, other: Self) -> Self::Mask;

    /// Where it is less than `other`; nowhere where either is NaN.
    #[inline(always)]
    fn less(self, other: Self) -> Self::Mask {
        other.greater(self)
    }

    /// `a` where the mask is set, `b` elsewhere.
    fn select(mask: Self::Mask, a: Self, b: Self) -> Self;

    /// The natural logarithm, as [`f64::ln`] but for the last bit.
    fn ln(self) -> Self;

    /// ln(1 + x) with all digits of a small x, as [`f64::ln_1p`] but for the last bit.
    fn ln_1p(self) -> Self;

    /// exp x − 1 with all digits of a small x, as [`f64::exp_m1`] but for the last bit.
    fn exp_m1(self) -> Self;
}

/// Rows of `width` numbers for [`Real::read_rows`] where there are fewer than four: the last one stands for those that there are
/// not. Zeros where there is none at all. `N` is at least 4 `width`; what is behind that is zero.
#[inline(always)]
pub fn filled_up<const N: usize>(rows: &[f64], width: usize) -> [f64; N] {
    let mut four = [0.0; N];
    let count = rows.len() / width.max(1);
    if count > 0 {
        for k in 0..4 {
            let from = k.min(count - 1) * width;
            four[k * width..(k + 1) * width].copy_from_slice(&rows[from..from + width]);
        }
    }
    four
}

/// Whether this processor has the instructions that four wide lanes need.
pub fn wide_instructions() -> bool {
    #[cfg(target_arch = "x86_64")]
    {
        std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma")
    }
    #[cfg(not(target_arch = "x86_64"))]
    {
        false
    }
}

/// Which instructions a kernel may use, from the fewest on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Instructions {
    /// Those that every processor has.
    Portable,
    /// Registers of four numbers: AVX2 and FMA.
    Wide,
    /// Twice as many of them: AVX-512VL too.
    WideAndMany,
}

impl Instructions {
    /// The most that this processor has.
    pub fn found() -> Self {
        #[cfg(target_arch = "x86_64")]
        if wide_instructions() {
            let many = std::arch::is_x86_feature_detected!("avx512f")
                && std::arch::is_x86_feature_detected!("avx512vl");
            return if many { Self::WideAndMany } else { Self::Wide };
        }
        Self::Portable
    }

    /// Whether there are registers of four numbers.
    pub fn wide(self) -> bool {
        self > Self::Portable
    }

    /// What they are called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Portable => "no wide instructions",
            Self::Wide => "wide instructions (AVX2, FMA)",
            Self::WideAndMany => "wide instructions (AVX2, FMA, AVX-512VL)",
        }
    }
}

/// What comparing gives: yes or no in every lane.
pub trait Mask:
    Copy + Debug + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self>
{
    /// Yes in every lane.
    fn all(self) -> bool;

    /// Yes in at least one lane.
    #[inline(always)]
    fn any(self) -> bool {
        !(!self).all()
    }

    /// Yes or no in one lane.
    fn lane(self, k: usize) -> bool;
}

/// Implements the operators of [`Real`] for lanes that have `binary` and `splat`.
macro_rules! operators {
    ($lanes:ty, $($trait:ident $method:ident $plain:path),*) => {
        $(
            impl std::ops::$trait for $lanes {
                type Output = Self;
                #[inline(always)]
                fn $method(self, other: Self) -> Self {
                    $plain(self, other)
                }
            }
            impl std::ops::$trait<f64> for $lanes {
                type Output = Self;
                #[inline(always)]
                fn $method(self, other: f64) -> Self {
                    $plain(self, <Self as $crate::real::Real>::splat(other))
                }
            }
        )*
    };
}
use operators;
