//! Four numbers in one register.

use super::exponential::{self, Power};
use super::logarithm::{self, BIAS, EXPONENT, Exponent, ONE, ROOT_HALF, TWICE_BIAS, TWO_52};
use super::{Mask, Real, operators};
use std::arch::x86_64::*;
use std::ops::{BitAnd, BitOr, Neg, Not};

/// One 256-bit register. Made only in functions that are compiled for AVX2 and FMA and called after both were found at run
/// time; its methods are inlined there, which is what makes the instructions below sound and fast.
#[derive(Clone, Copy, Debug)]
pub struct Avx(pub(crate) __m256d);

/// All bits of a lane set, or none.
#[derive(Clone, Copy, Debug)]
pub struct AvxMask(__m256d);

/// Wraps what an intrinsic gives.
macro_rules! wide {
    ($wrap:ident, $value:expr) => {
        // SAFETY: only reached where AVX2 and FMA were found (see `Avx`)
        $wrap(unsafe { $value })
    };
}

impl Avx {
    #[inline(always)]
    fn sum(self, b: Self) -> Self {
        wide!(Self, _mm256_add_pd(self.0, b.0))
    }
    #[inline(always)]
    fn difference(self, b: Self) -> Self {
        wide!(Self, _mm256_sub_pd(self.0, b.0))
    }
    #[inline(always)]
    fn product(self, b: Self) -> Self {
        wide!(Self, _mm256_mul_pd(self.0, b.0))
    }
    #[inline(always)]
    fn quotient(self, b: Self) -> Self {
        wide!(Self, _mm256_div_pd(self.0, b.0))
    }
    #[inline(always)]
    fn from_array(x: [f64; 4]) -> Self {
        // SAFETY: both types are 32 bytes of f64
        Self(unsafe { std::mem::transmute::<[f64; 4], __m256d>(x) })
    }
    #[inline(always)]
    fn array(self) -> [f64; 4] {
        // SAFETY: both types are 32 bytes of f64
        unsafe { std::mem::transmute::<__m256d, [f64; 4]>(self.0) }
    }
}

operators!(Avx, Add add Self::sum, Sub sub Self::difference, Mul mul Self::product, Div div Self::quotient);

impl Neg for Avx {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        wide!(Self, _mm256_xor_pd(self.0, _mm256_set1_pd(-0.0)))
    }
}

/// Transposes the starts of four rows into registers, two numbers of each at a time.
///
/// # Safety
/// Row k, `numbers.len()` numbers at `k * stride`, is readable; AVX2 was found.
#[inline(always)]
unsafe fn read(from: *const f64, stride: usize, numbers: &mut [Avx]) {
    let width = numbers.len();
    let rows = [0, 1, 2, 3].map(|k| from.wrapping_add(k * stride));
    // SAFETY: as the caller says
    unsafe {
        for pair in 0..width / 2 {
            let i = 2 * pair;
            let even = _mm256_set_m128d(_mm_loadu_pd(rows[2].add(i)), _mm_loadu_pd(rows[0].add(i)));
            let odd = _mm256_set_m128d(_mm_loadu_pd(rows[3].add(i)), _mm_loadu_pd(rows[1].add(i)));
            numbers[i] = Avx(_mm256_unpacklo_pd(even, odd));
            numbers[i + 1] = Avx(_mm256_unpackhi_pd(even, odd));
        }
        if width % 2 == 1 {
            let i = width - 1;
            numbers[i] = Avx(_mm256_set_pd(
                *rows[3].add(i),
                *rows[2].add(i),
                *rows[1].add(i),
                *rows[0].add(i),
            ));
        }
    }
}

/// Writes what [`read`] reads.
///
/// # Safety
/// As there, but writable.
#[inline(always)]
unsafe fn write(to: *mut f64, stride: usize, numbers: &[Avx]) {
    let width = numbers.len();
    let rows = [0, 1, 2, 3].map(|k| to.wrapping_add(k * stride));
    // SAFETY: as the caller says
    unsafe {
        for pair in 0..width / 2 {
            let i = 2 * pair;
            let even = _mm256_unpacklo_pd(numbers[i].0, numbers[i + 1].0);
            let odd = _mm256_unpackhi_pd(numbers[i].0, numbers[i + 1].0);
            _mm_storeu_pd(rows[0].add(i), _mm256_castpd256_pd128(even));
            _mm_storeu_pd(rows[1].add(i), _mm256_castpd256_pd128(odd));
            _mm_storeu_pd(rows[2].add(i), _mm256_extractf128_pd::<1>(even));
            _mm_storeu_pd(rows[3].add(i), _mm256_extractf128_pd::<1>(odd));
        }
        if width % 2 == 1 {
            let i = width - 1;
            let low = _mm256_castpd256_pd128(numbers[i].0);
            let high = _mm256_extractf128_pd::<1>(numbers[i].0);
            _mm_storel_pd(rows[0].add(i), low);
            _mm_storeh_pd(rows[1].add(i), low);
            _mm_storel_pd(rows[2].add(i), high);
            _mm_storeh_pd(rows[3].add(i), high);
        }
    }
}

impl Real for Avx {
    const LANES: usize = 4;
    type Mask = AvxMask;

    #[inline(always)]
    fn splat(x: f64) -> Self {
        wide!(Self, _mm256_set1_pd(x))
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
        assert!(from.len() >= 3 * stride + width);
        let start = from.as_ptr();
        // SAFETY: the rows are as long as that; AVX2 as for `Avx`
        unsafe {
            if (width, stride) == (1, 1) {
                numbers[0] = Self(_mm256_loadu_pd(start));
            } else if width == 3 && from.len() >= 3 * stride + 4 {
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
    fn read_fours(from: &[f64], _: usize) -> Self {
        assert!(from.len() >= 4);
        // SAFETY: the numbers are there; AVX2 as for `Avx`
        Self(unsafe { _mm256_loadu_pd(from.as_ptr()) })
    }
    #[inline(always)]
    fn write_strided(to: &mut [f64], stride: usize, numbers: &[Self]) {
        let width = numbers.len();
        assert!(to.len() >= 3 * stride + width);
        let start = to.as_mut_ptr();
        // SAFETY: the rows are as long as that; AVX2 as for `Avx`
        unsafe {
            if (width, stride) == (1, 1) {
                _mm256_storeu_pd(start, numbers[0].0);
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
        wide!(Self, _mm256_fmadd_pd(self.0, b.0, c.0))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        wide!(Self, _mm256_sqrt_pd(self.0))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        wide!(Self, _mm256_andnot_pd(_mm256_set1_pd(-0.0), self.0))
    }
    #[inline(always)]
    fn floor(self) -> Self {
        wide!(Self, _mm256_floor_pd(self.0))
    }
    #[inline(always)]
    fn min(self, b: Self) -> Self {
        wide!(Self, _mm256_min_pd(self.0, b.0))
    }
    #[inline(always)]
    fn max(self, b: Self) -> Self {
        wide!(Self, _mm256_max_pd(self.0, b.0))
    }
    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        let sign = wide!(Self, _mm256_and_pd(_mm256_set1_pd(-0.0), sign.0));
        wide!(Self, _mm256_or_pd(self.abs().0, sign.0))
    }
    #[inline(always)]
    fn greater(self, b: Self) -> AvxMask {
        wide!(AvxMask, _mm256_cmp_pd::<_CMP_GT_OQ>(self.0, b.0))
    }
    #[inline(always)]
    fn at_most(self, b: Self) -> AvxMask {
        wide!(AvxMask, _mm256_cmp_pd::<_CMP_LE_OQ>(self.0, b.0))
    }
    #[inline(always)]
    fn select(mask: AvxMask, a: Self, b: Self) -> Self {
        wide!(Self, _mm256_blendv_pd(b.0, a.0, mask.0))
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

impl Exponent for Avx {
    #[inline(always)]
    fn exponent(self) -> (Self, Self) {
        // SAFETY: AVX2 as for `Avx`
        unsafe {
            let bits = _mm256_castpd_si256(self.0);
            let shifted = _mm256_add_epi64(bits, _mm256_set1_epi64x((ONE - ROOT_HALF) as i64));
            let exponent = _mm256_and_si256(shifted, _mm256_set1_epi64x(EXPONENT as i64));
            let scale = _mm256_sub_epi64(_mm256_set1_epi64x(TWICE_BIAS as i64), exponent);
            let integer = _mm256_srli_epi64::<52>(shifted);
            let number = _mm256_or_si256(integer, _mm256_set1_epi64x(TWO_52 as i64));
            let k = Self(_mm256_castsi256_pd(number)) - BIAS;
            (Self(_mm256_castsi256_pd(scale)), k)
        }
    }
}

impl Power for Avx {
    #[inline(always)]
    fn power_of_two(self) -> Self {
        // SAFETY: AVX2 as for `Avx`
        unsafe {
            let bits = _mm256_add_epi64(_mm256_castpd_si256(self.0), _mm256_set1_epi64x(1023));
            Self(_mm256_castsi256_pd(_mm256_slli_epi64::<52>(bits)))
        }
    }
}

impl BitAnd for AvxMask {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, b: Self) -> Self {
        wide!(Self, _mm256_and_pd(self.0, b.0))
    }
}

impl BitOr for AvxMask {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, b: Self) -> Self {
        wide!(Self, _mm256_or_pd(self.0, b.0))
    }
}

impl Not for AvxMask {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        let all = wide!(Self, _mm256_castsi256_pd(_mm256_set1_epi64x(-1)));
        wide!(Self, _mm256_xor_pd(self.0, all.0))
    }
}

impl Mask for AvxMask {
    #[inline(always)]
    fn all(self) -> bool {
        // SAFETY: AVX as for `Avx`
        unsafe { _mm256_movemask_pd(self.0) == 0b1111 }
    }
    #[inline(always)]
    fn lane(self, k: usize) -> bool {
        // SAFETY: AVX as for `Avx`
        unsafe { _mm256_movemask_pd(self.0) >> k & 1 == 1 }
    }
}
