//! Lanes in 256-bit registers.
//!
//! Every `unsafe` block below rests on the same fact: [`Avx`] is made only in functions that are compiled for AVX2 and FMA and
//! called after both were found at run time; its methods are inlined there, which makes the instructions sound and fast. The
//! addresses are the callers' to vouch for.

use super::{Lane, Points, Task};
use crate::real::MOST_LANES;
use crate::real::{Avx, Real};
use std::arch::x86_64::*;

impl Points for Avx {
    type Four = Self;

    #[inline(always)]
    fn four(self, _: usize) -> Self {
        self
    }
    #[inline(always)]
    fn apart(task: impl Task) {
        #[cold]
        #[inline(never)]
        #[target_feature(enable = "avx2,fma")]
        fn compiled(task: impl Task) {
            task.run();
        }
        // SAFETY: module header
        unsafe { compiled(task) }
    }
    #[inline(always)]
    fn all_within(self, low: f64, high: f64) -> bool {
        // SAFETY: module header
        unsafe {
            let above = _mm256_cmp_pd::<_CMP_GE_OQ>(self.0, _mm256_set1_pd(low));
            let below = _mm256_cmp_pd::<_CMP_LE_OQ>(self.0, _mm256_set1_pd(high));
            _mm256_movemask_pd(_mm256_and_pd(above, below)) == 0b1111
        }
    }
    #[inline(always)]
    fn whole(self, to: &mut [u32; MOST_LANES]) {
        // SAFETY: module header; there is room for four numbers
        unsafe { _mm_storeu_si128(to.as_mut_ptr().cast(), _mm256_cvttpd_epi32(self.0)) }
    }
    #[inline(always)]
    unsafe fn load_points<const D: usize>(from: *const f64) -> [Self; D] {
        let mut points = [Self::splat(0.0); D];
        // SAFETY: module header
        unsafe {
            match D {
                1 => points[0] = Self(_mm256_loadu_pd(from)),
                2 => {
                    let (p01, p23) = (_mm256_loadu_pd(from), _mm256_loadu_pd(from.add(4)));
                    let p02 = _mm256_permute2f128_pd::<0x20>(p01, p23);
                    let p13 = _mm256_permute2f128_pd::<0x31>(p01, p23);
                    points[0] = Self(_mm256_unpacklo_pd(p02, p13));
                    points[1] = Self(_mm256_unpackhi_pd(p02, p13));
                }
                _ => {
                    // x₀ y₀ z₀ x₁, y₁ z₁ x₂ y₂, z₂ x₃ y₃ z₃
                    let a = _mm256_loadu_pd(from);
                    let b = _mm256_loadu_pd(from.add(4));
                    let c = _mm256_loadu_pd(from.add(8));
                    let xy = _mm256_blend_pd::<0b1100>(a, b); // x₀ y₀ x₂ y₂
                    let zx = _mm256_permute2f128_pd::<0x21>(a, c); // z₀ x₁ z₂ x₃
                    let yz = _mm256_blend_pd::<0b1100>(b, c); // y₁ z₁ y₃ z₃
                    points[0] = Self(_mm256_shuffle_pd::<0b1010>(xy, zx));
                    points[1] = Self(_mm256_shuffle_pd::<0b0101>(xy, yz));
                    points[2] = Self(_mm256_shuffle_pd::<0b1010>(zx, yz));
                }
            }
        }
        points
    }
    #[inline(always)]
    unsafe fn store_points<const D: usize>(points: &[Self; D], to: *mut f64) {
        // SAFETY: module header
        unsafe {
            match D {
                1 => _mm256_storeu_pd(to, points[0].0),
                2 => {
                    let p02 = _mm256_unpacklo_pd(points[0].0, points[1].0);
                    let p13 = _mm256_unpackhi_pd(points[0].0, points[1].0);
                    _mm256_storeu_pd(to, _mm256_permute2f128_pd::<0x20>(p02, p13));
                    _mm256_storeu_pd(to.add(4), _mm256_permute2f128_pd::<0x31>(p02, p13));
                }
                _ => {
                    let [x, y, z] = [points[0].0, points[1].0, points[2].0];
                    let xy = _mm256_shuffle_pd::<0b0000>(x, y);
                    let zx = _mm256_shuffle_pd::<0b1010>(z, x);
                    let yz = _mm256_shuffle_pd::<0b1111>(y, z);
                    _mm256_storeu_pd(to, _mm256_permute2f128_pd::<0x20>(xy, zx));
                    _mm256_storeu_pd(to.add(4), _mm256_blend_pd::<0b1100>(yz, xy));
                    _mm256_storeu_pd(to.add(8), _mm256_permute2f128_pd::<0x31>(zx, yz));
                }
            }
        }
    }
    #[inline(always)]
    unsafe fn load_some(from: *const f64, count: usize) -> Self {
        // SAFETY: module header
        Self(unsafe {
            let places = _mm256_set_epi64x(3, 2, 1, 0);
            let there = _mm256_cmpgt_epi64(_mm256_set1_epi64x(count as i64), places);
            _mm256_maskload_pd(from, there)
        })
    }
    #[inline(always)]
    unsafe fn add_sums(given: [Self; 4], node: *mut f64) {
        // SAFETY: module header
        unsafe {
            let [a, b, c, d] = [given[0].0, given[1].0, given[2].0, given[3].0];
            // a₀ + a₁, b₀ + b₁, a₂ + a₃, b₂ + b₃
            let ab = _mm256_add_pd(_mm256_unpacklo_pd(a, b), _mm256_unpackhi_pd(a, b));
            let cd = _mm256_add_pd(_mm256_unpacklo_pd(c, d), _mm256_unpackhi_pd(c, d));
            let low = _mm256_blend_pd::<0b1100>(ab, cd);
            let high = _mm256_permute2f128_pd::<0x21>(ab, cd);
            let sums = Self(_mm256_add_pd(low, high));
            (Self::load(node) + sums).store(node);
        }
    }
}

impl Lane for Avx {
    #[inline(always)]
    fn new(x: [f64; 4]) -> Self {
        // SAFETY: both types are 32 bytes of f64
        Self(unsafe { std::mem::transmute::<[f64; 4], __m256d>(x) })
    }
    #[inline(always)]
    fn array(self) -> [f64; 4] {
        // SAFETY: both types are 32 bytes of f64
        unsafe { std::mem::transmute::<__m256d, [f64; 4]>(self.0) }
    }
    #[inline(always)]
    fn broadcast<const I: usize>(self) -> Self {
        // SAFETY: module header
        Self(unsafe {
            match I {
                0 => _mm256_permute4x64_pd::<0b00_00_00_00>(self.0),
                1 => _mm256_permute4x64_pd::<0b01_01_01_01>(self.0),
                2 => _mm256_permute4x64_pd::<0b10_10_10_10>(self.0),
                _ => _mm256_permute4x64_pd::<0b11_11_11_11>(self.0),
            }
        })
    }
    #[inline(always)]
    unsafe fn load(from: *const f64) -> Self {
        // SAFETY: module header
        Self(unsafe { _mm256_load_pd(from) })
    }
    #[inline(always)]
    unsafe fn store(self, to: *mut f64) {
        // SAFETY: module header
        unsafe { _mm256_store_pd(to, self.0) }
    }
    #[inline(always)]
    unsafe fn load_point<const D: usize>(from: *const f64) -> Self {
        // SAFETY: module header
        Self(unsafe {
            match D {
                1 => _mm256_zextpd128_pd256(_mm_load_sd(from)),
                2 => _mm256_zextpd128_pd256(_mm_loadu_pd(from)),
                _ => _mm256_maskload_pd(from, _mm256_set_epi64x(0, -1, -1, -1)),
            }
        })
    }
    #[inline(always)]
    unsafe fn store_matrix<const D: usize>(columns: &[Self; D], to: *mut f64) {
        // SAFETY: module header
        unsafe {
            match D {
                1 => _mm_store_sd(to, _mm256_castpd256_pd128(columns[0].0)),
                2 => _mm256_storeu_pd(
                    to,
                    _mm256_permute2f128_pd::<0x20>(columns[0].0, columns[1].0),
                ),
                _ => {
                    // the fourth number of a column is written over by the next
                    _mm256_storeu_pd(to, columns[0].0);
                    _mm256_storeu_pd(to.add(3), columns[1].0);
                    _mm_storeu_pd(to.add(6), _mm256_castpd256_pd128(columns[2].0));
                    _mm_store_sd(to.add(8), _mm256_extractf128_pd::<1>(columns[2].0));
                }
            }
        }
    }
    #[inline(always)]
    fn turn<const D: usize>(points: &[Self; 4]) -> [Self; D] {
        let mut turned = [Self::splat(0.0); D];
        // SAFETY: module header
        unsafe {
            let [a, b, c, d] = [points[0].0, points[1].0, points[2].0, points[3].0];
            let even = (_mm256_unpacklo_pd(a, b), _mm256_unpacklo_pd(c, d));
            turned[0] = Self(_mm256_permute2f128_pd::<0x20>(even.0, even.1));
            if D > 2 {
                turned[2] = Self(_mm256_permute2f128_pd::<0x31>(even.0, even.1));
            }
            if D > 1 {
                let odd = (_mm256_unpackhi_pd(a, b), _mm256_unpackhi_pd(c, d));
                turned[1] = Self(_mm256_permute2f128_pd::<0x20>(odd.0, odd.1));
            }
        }
        turned
    }
    #[inline(always)]
    unsafe fn load_pairs(from: [*const f64; 4]) -> [Self; 2] {
        // SAFETY: module header
        unsafe {
            let even = _mm256_set_m128d(_mm_load_pd(from[2]), _mm_load_pd(from[0]));
            let odd = _mm256_set_m128d(_mm_load_pd(from[3]), _mm_load_pd(from[1]));
            [
                Self(_mm256_unpacklo_pd(even, odd)),
                Self(_mm256_unpackhi_pd(even, odd)),
            ]
        }
    }
    #[inline(always)]
    unsafe fn store_pairs(pairs: [Self; 2], to: [*mut f64; 4]) {
        // SAFETY: module header
        unsafe {
            let pairs = pair_up(pairs);
            for q in 0..4 {
                _mm_store_pd(to[q], pairs[q]);
            }
        }
    }
    #[inline(always)]
    unsafe fn add_pairs(pairs: [Self; 2], to: [*mut f64; 4]) {
        // SAFETY: module header
        unsafe {
            let pairs = pair_up(pairs);
            for q in 0..4 {
                _mm_store_pd(to[q], _mm_add_pd(_mm_load_pd(to[q]), pairs[q]));
            }
        }
    }
    #[inline(always)]
    unsafe fn load_symmetric<const D: usize>(from: *const f64) -> [Self; D] {
        let mut columns = [Self::splat(0.0); D];
        // SAFETY: module header
        unsafe {
            match D {
                1 => columns[0] = Self::load_point::<1>(from),
                2 => {
                    columns[0] = Self::load_point::<2>(from);
                    columns[1] = Self::load_point::<2>(from.add(1));
                }
                _ => {
                    columns[0] = Self(_mm256_loadu_pd(from));
                    for a in 1..3 {
                        let row = _mm256_loadu_pd(from.add(a));
                        columns[a] = Self(_mm256_permute4x64_pd::<0b11_11_10_00>(row));
                    }
                }
            }
        }
        columns
    }
}

/// The two numbers of each of four pairs, side by side.
#[inline(always)]
fn pair_up([first, second]: [Avx; 2]) -> [__m128d; 4] {
    // SAFETY: module header
    unsafe {
        let even = _mm256_unpacklo_pd(first.0, second.0);
        let odd = _mm256_unpackhi_pd(first.0, second.0);
        [
            _mm256_castpd256_pd128(even),
            _mm256_castpd256_pd128(odd),
            _mm256_extractf128_pd::<1>(even),
            _mm256_extractf128_pd::<1>(odd),
        ]
    }
}
