//! Four numbers at once: with wide instructions where the processor has them, one after the other where not.

/// Four `f64` that are added and multiplied together.
pub trait Lane: Copy {
    /// The same number four times.
    fn splat(x: f64) -> Self;
    /// From an array.
    fn new(x: [f64; 4]) -> Self;
    /// To an array.
    fn array(self) -> [f64; 4];
    /// Reads four numbers.
    ///
    /// # Safety
    /// `from` points to four readable numbers, aligned to 32 bytes.
    unsafe fn load(from: *const f64) -> Self;
    /// Writes four numbers.
    ///
    /// # Safety
    /// `to` points to four writable numbers, aligned to 32 bytes.
    unsafe fn store(self, to: *mut f64);
    /// Sum.
    fn add(self, other: Self) -> Self;
    /// Product.
    fn mul(self, other: Self) -> Self;
    /// `self * b + c`, rounded once or twice as the processor can.
    fn mul_add(self, b: Self, c: Self) -> Self;
}

/// Plain arithmetic, for any processor.
#[derive(Clone, Copy, Debug)]
pub struct Portable([f64; 4]);

impl Lane for Portable {
    #[inline(always)]
    fn splat(x: f64) -> Self {
        Self([x; 4])
    }
    #[inline(always)]
    fn new(x: [f64; 4]) -> Self {
        Self(x)
    }
    #[inline(always)]
    fn array(self) -> [f64; 4] {
        self.0
    }
    #[inline(always)]
    unsafe fn load(from: *const f64) -> Self {
        // SAFETY: the caller vouches for four readable, aligned numbers
        Self(unsafe { *from.cast() })
    }
    #[inline(always)]
    unsafe fn store(self, to: *mut f64) {
        // SAFETY: the caller vouches for four writable, aligned numbers
        unsafe { *to.cast() = self.0 }
    }
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let (a, b) = (self.0, other.0);
        Self([a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]])
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let (a, b) = (self.0, other.0);
        Self([a[0] * b[0], a[1] * b[1], a[2] * b[2], a[3] * b[3]])
    }
    #[inline(always)]
    fn mul_add(self, b: Self, c: Self) -> Self {
        // not f64::mul_add: without the instruction it is a slow library call
        let (a, b, c) = (self.0, b.0, c.0);
        Self([
            a[0] * b[0] + c[0],
            a[1] * b[1] + c[1],
            a[2] * b[2] + c[2],
            a[3] * b[3] + c[3],
        ])
    }
}

#[cfg(target_arch = "x86_64")]
pub use avx::Avx;

#[cfg(target_arch = "x86_64")]
mod avx {
    use super::Lane;
    use std::arch::x86_64::{
        __m256d, _mm256_add_pd, _mm256_fmadd_pd, _mm256_load_pd, _mm256_mul_pd, _mm256_set1_pd,
        _mm256_store_pd,
    };

    /// One 256-bit register. Made only in functions that are compiled for AVX2 and FMA and called after both were found at
    /// run time; its methods are inlined there, which is what makes the instructions below sound and fast.
    #[derive(Clone, Copy, Debug)]
    pub struct Avx(__m256d);

    impl Lane for Avx {
        #[inline(always)]
        fn splat(x: f64) -> Self {
            // SAFETY: only reached where AVX was found (see the type)
            Self(unsafe { _mm256_set1_pd(x) })
        }
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
        unsafe fn load(from: *const f64) -> Self {
            // SAFETY: the caller vouches for the address; AVX as above
            Self(unsafe { _mm256_load_pd(from) })
        }
        #[inline(always)]
        unsafe fn store(self, to: *mut f64) {
            // SAFETY: the caller vouches for the address; AVX as above
            unsafe { _mm256_store_pd(to, self.0) }
        }
        #[inline(always)]
        fn add(self, other: Self) -> Self {
            // SAFETY: AVX as above
            Self(unsafe { _mm256_add_pd(self.0, other.0) })
        }
        #[inline(always)]
        fn mul(self, other: Self) -> Self {
            // SAFETY: AVX as above
            Self(unsafe { _mm256_mul_pd(self.0, other.0) })
        }
        #[inline(always)]
        fn mul_add(self, b: Self, c: Self) -> Self {
            // SAFETY: FMA as above
            Self(unsafe { _mm256_fmadd_pd(self.0, b.0, c.0) })
        }
    }
}
