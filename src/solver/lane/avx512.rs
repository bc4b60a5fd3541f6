//! Lanes in 512-bit registers: always of eight points.
//!
//! Every `unsafe` block below rests on the same fact: [`Avx512`] is made only in functions that are compiled for AVX-512 (F, VL and
//! DQ) and called after these were found at run time; its methods are inlined there, which makes the instructions sound and
//! fast. The addresses are the callers' to vouch for.

use super::{Lane, Points, Task};
use crate::real::MOST_LANES;
use crate::real::{Avx, Avx512, Real};
use std::arch::x86_64::*;

impl Points for Avx512 {
    type Four = Avx;

    #[inline(always)]
    fn four(self, h: usize) -> Avx {
        // SAFETY: module header
        Avx(unsafe {
            if h == 0 {
                _mm512_castpd512_pd256(self.0)
            } else {
                _mm512_extractf64x4_pd::<1>(self.0)
            }
        })
    }
    #[inline(always)]
    fn apart(task: impl Task) {
        #[cold]
        #[inline(never)]
        #[target_feature(enable = "avx2,fma,avx512f,avx512vl,avx512dq")]
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
            let above = _mm512_cmp_pd_mask::<_CMP_GE_OQ>(self.0, _mm512_set1_pd(low));
            let both = _mm512_mask_cmp_pd_mask::<_CMP_LE_OQ>(above, self.0, _mm512_set1_pd(high));
            both == 0xff
        }
    }
    #[inline(always)]
    fn whole(self, to: &mut [u32; MOST_LANES]) {
        // SAFETY: module header; there is room for eight numbers
        unsafe { _mm256_storeu_si256(to.as_mut_ptr().cast(), _mm512_cvttpd_epi32(self.0)) }
    }
    #[inline(always)]
    unsafe fn load_points<const D: usize>(from: *const f64) -> [Self; D] {
        let mut points = [Self::splat(0.0); D];
        // SAFETY: module header
        unsafe {
            let a = _mm512_loadu_pd(from);
            match D {
                1 => points[0] = Self(a),
                2 => {
                    let b = _mm512_loadu_pd(from.add(8));
                    points[0] = Self(chosen(a, [0, 2, 4, 6, 8, 10, 12, 14], b));
                    points[1] = Self(chosen(a, [1, 3, 5, 7, 9, 11, 13, 15], b));
                }
                _ => {
                    // x₀ y₀ z₀ x₁ y₁ z₁ x₂ y₂, z₂ x₃ y₃ z₃ x₄ y₄ z₄ x₅, y₅ z₅ x₆ y₆ z₆ x₇ y₇ z₇
                    let (b, c) = (_mm512_loadu_pd(from.add(8)), _mm512_loadu_pd(from.add(16)));
                    let x = chosen(a, [0, 3, 6, 9, 12, 15, 0, 0], b);
                    let y = chosen(a, [1, 4, 7, 10, 13, 0, 0, 0], b);
                    let z = chosen(a, [2, 5, 8, 11, 14, 0, 0, 0], b);
                    points[0] = Self(chosen(x, [0, 1, 2, 3, 4, 5, 10, 13], c));
                    points[1] = Self(chosen(y, [0, 1, 2, 3, 4, 8, 11, 14], c));
                    points[2] = Self(chosen(z, [0, 1, 2, 3, 4, 9, 12, 15], c));
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
                1 => _mm512_storeu_pd(to, points[0].0),
                2 => {
                    let (x, y) = (points[0].0, points[1].0);
                    let low = chosen(x, [0, 8, 1, 9, 2, 10, 3, 11], y);
                    let high = chosen(x, [4, 12, 5, 13, 6, 14, 7, 15], y);
                    _mm512_storeu_pd(to, low);
                    _mm512_storeu_pd(to.add(8), high);
                }
                _ => {
                    let [x, y, z] = [points[0].0, points[1].0, points[2].0];
                    let a = chosen(x, [0, 8, 0, 1, 9, 0, 2, 10], y);
                    let b = chosen(x, [0, 3, 11, 0, 4, 12, 0, 5], y);
                    let c = chosen(x, [13, 0, 6, 14, 0, 7, 15, 0], y);
                    _mm512_storeu_pd(to, chosen(a, [0, 1, 8, 3, 4, 9, 6, 7], z));
                    _mm512_storeu_pd(to.add(8), chosen(b, [10, 1, 2, 11, 4, 5, 12, 7], z));
                    _mm512_storeu_pd(to.add(16), chosen(c, [0, 13, 2, 3, 14, 5, 6, 15], z));
                }
            }
        }
    }
    #[inline(always)]
    unsafe fn load_some(from: *const f64, count: usize) -> Self {
        // SAFETY: module header
        Self(unsafe { _mm512_maskz_loadu_pd(0xff >> (8 - count), from) })
    }
    #[inline(always)]
    unsafe fn add_sums(given: [Self; 4], node: *mut f64) {
        // SAFETY: module header
        unsafe {
            let [a, b, c, d] = [given[0].0, given[1].0, given[2].0, given[3].0];
            // a₀ + a₁, b₀ + b₁, a₂ + a₃, b₂ + b₃ of four points, and of the next
            let ab = _mm512_add_pd(_mm512_unpacklo_pd(a, b), _mm512_unpackhi_pd(a, b));
            let cd = _mm512_add_pd(_mm512_unpacklo_pd(c, d), _mm512_unpackhi_pd(c, d));
            let low = _mm512_mask_blend_pd(0b1100_1100, ab, cd);
            let high = chosen(ab, [2, 3, 8, 9, 6, 7, 12, 13], cd);
            let sums = Self(_mm512_add_pd(low, high));
            (Avx::load(node) + sums.four(0) + sums.four(1)).store(node);
        }
    }
}

/// Number `places[k]` of `a` and, from 8 on, of `b` as number k.
///
/// # Safety
/// Module header.
#[inline(always)]
unsafe fn chosen(a: __m512d, places: [i64; 8], b: __m512d) -> __m512d {
    let [p0, p1, p2, p3, p4, p5, p6, p7] = places;
    // SAFETY: module header
    unsafe {
        let places = _mm512_set_epi64(p7, p6, p5, p4, p3, p2, p1, p0);
        _mm512_permutex2var_pd(a, places, b)
    }
}
