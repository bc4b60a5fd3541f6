//! Eight numbers in one register.

use super::exponential::{self, Power};
use super::logarithm::{self, BIAS, EXPONENT, Exponent, ONE, ROOT_HALF, TWICE_BIAS, TWO_52};
use super::{Mask, Real, operators};
use std::arch::x86_64::*;
use std::ops::{BitAnd, BitOr, Neg, Not};

/// One 512-bit register. Made only in functions that are compiled for AVX-512 (F, VL and DQ) and called after these were found at
/// run time; its methods are inlined there, which is what makes the instructions below sound and fast.
#[derive(Clone, Copy, Debug)]
pub struct Avx512(pub(crate) __m512d);

/// One bit a lane.
#[derive(Clone, Copy, Debug)]
pub struct Avx512Mask(__mmask8);

/// Wraps what an intrinsic gives.
macro_rules! wide {
    ($wrap:ident, $value:expr) => {
        // SAFETY: only reached where AVX-512 was found (see `Avx512`)
        $wrap(unsafe { $value })
    };
}

impl Avx512 {
    #[inline(always)]
    fn sum(self, b: Self) -> Self {
        wide!(Self, _mm512_add_pd(self.0, b.0))
    }
    #[inline(always)]
    fn difference(self, b: Self) -> Self {
        wide!(Self, _mm512_sub_pd(self.0, b.0))
    }
    #[inline(always)]
    fn product(self, b: Self) -> Self {
        wide!(Self, _mm512_mul_pd(self.0, b.0))
    }
    #[inline(always)]
    fn quotient(self, b: Self) -> Self {
        wide!(Self, _mm512_div_pd(self.0, b.0))
    }
    #[inline(always)]
    fn from_array(x: [f64; 8]) -> Self {
        // SAFETY: both types are 64 bytes of f64
        Self(unsafe { std::mem::transmute::<[f64; 8], __m512d>(x) })
    }
    #[inline(always)]
    fn array(self) -> [f64; 8] {
        // SAFETY: both types are 64 bytes of f64
        unsafe { std::mem::transmute::<__m512d, [f64; 8]>(self.0) }
    }
}

operators!(Avx512, Add add Self::sum, Sub sub Self::difference, Mul mul Self::product, Div div Self::quotient);

impl Neg for Avx512 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        wide!(Self, _mm512_xor_pd(self.0, _mm512_set1_pd(-0.0)))
    }
}

/// Two numbers at each of four places, one place `stride` numbers after the other.
///
/// # Safety
/// They are readable; AVX-512 was found.
#[inline(always)]
unsafe fn four_pairs(from: *const f64, stride: usize) -> __m512d {
    // SAFETY: as the caller says
    unsafe {
        let pairs = _mm512_castpd128_pd512(_mm_loadu_pd(from));
        let pairs = _mm512_insertf64x2::<1>(pairs, _mm_loadu_pd(from.add(stride)));
        let pairs = _mm512_insertf64x2::<2>(pairs, _mm_loadu_pd(from.add(2 * stride)));
        _mm512_insertf64x2::<3>(pairs, _mm_loadu_pd(from.add(3 * stride)))
    }
}

/// Transposes the starts of eight rows into registers, two numbers of each at a time.
///
/// # Safety
/// Row k, `numbers.len()` numbers at `k * stride`, is readable; AVX-512 was found.
#[inline(always)]
unsafe fn read(from: *const f64, stride: usize, numbers: &mut [Avx512]) {
    let width = numbers.len();
    // SAFETY: as the caller says
    unsafe {
        for pair in 0..width / 2 {
            let i = 2 * pair;
            let even = four_pairs(from.add(i), 2 * stride);
            let odd = four_pairs(from.add(stride + i), 2 * stride);
            numbers[i] = Avx512(_mm512_unpacklo_pd(even, odd));
            numbers[i + 1] = Avx512(_mm512_unpackhi_pd(even, odd));
        }
        if width % 2 == 1 {
            let last = from.add(width - 1);
            numbers[width - 1] = Avx512(_mm512_set_pd(
                *last.add(7 * stride),
                *last.add(6 * stride),
                *last.add(5 * stride),
                *last.add(4 * stride),
                *last.add(3 * stride),
                *last.add(2 * stride),
                *last.add(stride),
                *last,
            ));
        }
    }
}

/// Writes what [`read`] reads.
///
/// # Safety
/// As there, but writable.
#[inline(always)]
unsafe fn write(to: *mut f64, stride: usize, numbers: &[Avx512]) {
    let width = numbers.len();
    // SAFETY: as the caller says
    unsafe {
        for pair in 0..width / 2 {
            let i = 2 * pair;
            let (a, b) = (numbers[i].0, numbers[i + 1].0);
            write_pairs(_mm512_unpacklo_pd(a, b), to.add(i), 2 * stride);
            write_pairs(_mm512_unpackhi_pd(a, b), to.add(stride + i), 2 * stride);
        }
        if width % 2 == 1 {
            let last = numbers[width - 1].array();
            for k in 0..8 {
                *to.add(k * stride + width - 1) = last[k];
            }
        }
    }
}

/// Writes what [`four_pairs`] reads.
///
/// # Safety
/// As there, but writable.
#[inline(always)]
unsafe fn write_pairs(pairs: __m512d, to: *mut f64, stride: usize) {
    // SAFETY: as the caller says
    unsafe {
        _mm_storeu_pd(to, _mm512_castpd512_pd128(pairs));
        _mm_storeu_pd(to.add(stride), _mm512_extractf64x2_pd::<1>(pairs));
        _mm_storeu_pd(to.add(2 * stride), _mm512_extractf64x2_pd::<2>(pairs));
        _mm_storeu_pd(to.add(3 * stride), _mm512_extractf64x2_pd::<3>(pairs));
    }
}

impl Real for Avx512 {
    const LANES: usize = 8;
    type Mask = Avx512Mask;

    #[inline(always)]
    fn splat(x: f64) -> Self {
        wide!(Self, _mm512_set1_pd(x))
    }
    #[inline(always)]
    fn lane(self, k: usize) -> f64 {
        self.array()[k]
    }
    #[inline(always)]
    fn with_lane(self, k: usize, x: f64) -> Self {
        let mut array = self.array();
        array[k] = x;
        Self::from_array(array)
    }
    #[inline(always)]
    fn read_strided(from: &[f64], stride: usize, numbers: &mut [Self]) {
        let width = numbers.len();
        assert!(from.len() >= 7 * stride + width);
        let start = from.as_ptr();
        // SAFETY: the rows are as long as that; AVX-512 as for `Avx512`
        unsafe {
            if (width, stride) == (1, 1) {
                numbers[0] = Self(_mm512_loadu_pd(start));
            } else if width == 3 && from.len() >= 7 * stride + 4 {
                // two pairs cost less than a pair and a single number
                let mut four = [Self::splat(0.0); 4];
                read(start, stride, &mut four);
                numbers.copy_from_slice(&four[..3]);
            } else {
                read(start, stride, numbers);
            }
        }
    }
    #[inline(always)]
    fn read_fours(from: &[f64], stride: usize) -> Self {
        assert!(from.len() >= stride + 4);
        let from = from.as_ptr();
        // SAFETY: the numbers are there; AVX-512 as for `Avx512`
        Self(unsafe {
            let low = _mm512_castpd256_pd512(_mm256_loadu_pd(from));
            _mm512_insertf64x4::<1>(low, _mm256_loadu_pd(from.add(stride)))
        })
    }
    #[inline(always)]
    fn write_strided(to: &mut [f64], stride: usize, numbers: &[Self]) {
        let width = numbers.len();
        assert!(to.len() >= 7 * stride + width);
        let start = to.as_mut_ptr();
        // SAFETY: the rows are as long as that; AVX-512 as for `Avx512`
        unsafe {
            if (width, stride) == (1, 1) {
                _mm512_storeu_pd(start, numbers[0].0);
            } else {
                write(start, stride, numbers);
            }
        }
    }
    #[inline(always)]
    fn prefetch(from: *const f64, count: usize) {
        super::prefetch(from, count * size_of::<f64>());
    }
    #[inline(always)]
    fn mul_add(self, b: Self, c: Self) -> Self {
        wide!(Self, _mm512_fmadd_pd(self.0, b.0, c.0))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        wide!(Self, _mm512_sqrt_pd(self.0))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        wide!(Self, _mm512_andnot_pd(_mm512_set1_pd(-0.0), self.0))
    }
    #[inline(always)]
    fn floor(self) -> Self {
        const DOWN: i32 = _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC;
        wide!(Self, _mm512_roundscale_pd::<DOWN>(self.0))
    }
    #[inline(always)]
    fn min(self, b: Self) -> Self {
        wide!(Self, _mm512_min_pd(self.0, b.0))
    }
    #[inline(always)]
    fn max(self, b: Self) -> Self {
        wide!(Self, _mm512_max_pd(self.0, b.0))
    }
    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        let sign = wide!(Self, _mm512_and_pd(_mm512_set1_pd(-0.0), sign.0));
        wide!(Self, _mm512_or_pd(self.abs().0, sign.0))
    }
    #[inline(always)]
    fn greater(self, b: Self) -> Avx512Mask {
        wide!(Avx512Mask, _mm512_cmp_pd_mask::<_CMP_GT_OQ>(self.0, b.0))
    }
    #[inline(always)]
    fn at_most(self, b: Self) -> Avx512Mask {
        wide!(Avx512Mask, _mm512_cmp_pd_mask::<_CMP_LE_OQ>(self.0, b.0))
    }
    #[inline(always)]
    fn select(mask: Avx512Mask, a: Self, b: Self) -> Self {
        wide!(Self, _mm512_mask_blend_pd(mask.0, b.0, a.0))
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

impl Exponent for Avx512 {
    #[inline(always)]
    fn exponent(self) -> (Self, Self) {
        // SAFETY: AVX-512 as for `Avx512`
        unsafe {
            let bits = _mm512_castpd_si512(self.0);
            let shifted = _mm512_add_epi64(bits, _mm512_set1_epi64((ONE - ROOT_HALF) as i64));
            let exponent = _mm512_and_si512(shifted, _mm512_set1_epi64(EXPONENT as i64));
            let scale = _mm512_sub_epi64(_mm512_set1_epi64(TWICE_BIAS as i64), exponent);
            let integer = _mm512_srli_epi64::<52>(shifted);
            let number = _mm512_or_si512(integer, _mm512_set1_epi64(TWO_52 as i64));
            let k = Self(_mm512_castsi512_pd(number)) - BIAS;
            (Self(_mm512_castsi512_pd(scale)), k)
        }
    }
}

impl Power for Avx512 {
    #[inline(always)]
    fn power_of_two(self) -> Self {
        // SAFETY: AVX-512 as for `Avx512`
        unsafe {
            let bits = _mm512_add_epi64(_mm512_castpd_si512(self.0), _mm512_set1_epi64(1023));
            Self(_mm512_castsi512_pd(_mm512_slli_epi64::<52>(bits)))
        }
    }
}

impl BitAnd for Avx512Mask {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, b: Self) -> Self {
        Self(self.0 & b.0)
    }
}

impl BitOr for Avx512Mask {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, b: Self) -> Self {
        Self(self.0 | b.0)
    }
}

impl Not for Avx512Mask {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(!self.0)
    }
}

impl Mask for Avx512Mask {
    #[inline(always)]
    fn all(self) -> bool {
        self.0 == 0xff
    }
    #[inline(always)]
    fn lane(self, k: usize) -> bool {
        self.0 >> k & 1 == 1
    }
}
