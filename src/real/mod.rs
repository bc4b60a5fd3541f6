//! Real numbers that a formula is written in once: one `f64`, or four or eight of them that are computed together.
//!
//! Functions that take such numbers must be inlined into the function that was compiled for wide instructions: mark them
//! `#[inline(always)]` and keep such numbers out of closures. Otherwise every operation becomes a call.

#[cfg(target_arch = "x86_64")]
mod avx;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod exponential;
mod logarithm;
mod polynomial;
mod portable;
mod prefetch;
mod scalar;
#[cfg(test)]
mod tests;

#[cfg(target_arch = "x86_64")]
pub use avx::Avx;
#[cfg(target_arch = "x86_64")]
pub use avx512::Avx512;
pub use portable::Portable;
pub use prefetch::prefetch;

use std::fmt::Debug;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// The most numbers that are computed together.
pub const MOST_LANES: usize = 8;

/// One, four or eight numbers. Operations between it and an `f64` take the `f64` on the right.
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
    /// How many numbers it holds: 1, 4 or 8.
    const LANES: usize;

    /// What comparing gives.
    type Mask: Mask;

    /// The same number in every lane.
    fn splat(x: f64) -> Self;

    /// The number in one lane.
    fn lane(self, k: usize) -> f64;

    /// With another number in one lane.
    fn with_lane(self, k: usize, x: f64) -> Self;

    /// Reads the first `numbers.len()` numbers of one row for each lane: row k starts `k * stride` after the first and goes to lane
    /// k of every number.
    ///
    /// # Panics
    /// If the rows are not there.
    fn read_strided(from: &[f64], stride: usize, numbers: &mut [Self]);

    /// Writes what [`Self::read_strided`] reads, and leaves the rest of the rows.
    ///
    /// # Panics
    /// As there.
    fn write_strided(to: &mut [f64], stride: usize, numbers: &[Self]);

    /// Reads four numbers for each four lanes, those of the next four `stride` numbers after the first; a single lane reads one.
    ///
    /// # Panics
    /// If the numbers are not there.
    fn read_fours(from: &[f64], stride: usize) -> Self;

    /// [`Self::read_strided`] of rows that have no more numbers than these, one after the other.
    #[inline(always)]
    fn read_rows(rows: &[f64], numbers: &mut [Self]) {
        assert_eq!(rows.len(), Self::LANES * numbers.len());
        Self::read_strided(rows, numbers.len(), numbers);
    }

    /// Writes what [`Self::read_rows`] reads.
    #[inline(always)]
    fn write_rows(rows: &mut [f64], numbers: &[Self]) {
        assert_eq!(rows.len(), Self::LANES * numbers.len());
        Self::write_strided(rows, numbers.len(), numbers);
    }

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

/// Which instructions a kernel may use, from the fewest on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Instructions {
    /// Those that every processor has.
    Portable,
    /// Registers of four numbers: AVX2 and FMA.
    Wide,
    /// Twice as many registers, of eight: AVX-512 (F, VL, DQ) too.
    Widest,
}

impl Instructions {
    /// The most that this processor has.
    pub fn found() -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            use std::arch::is_x86_feature_detected as found;
            if found!("avx2") && found!("fma") {
                let widest = found!("avx512f") && found!("avx512vl") && found!("avx512dq");
                return if widest { Self::Widest } else { Self::Wide };
            }
        }
        Self::Portable
    }

    /// All of them, as far as this processor has them.
    pub fn all() -> impl Iterator<Item = Self> {
        let all = [Self::Portable, Self::Wide, Self::Widest].into_iter();
        all.filter(|some| *some <= Self::found())
    }

    /// These, as far as this processor has them.
    pub fn usable(self) -> Self {
        self.min(Self::found())
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
            Self::Widest => "wide instructions (AVX2, FMA, AVX-512)",
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
