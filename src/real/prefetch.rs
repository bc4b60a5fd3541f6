//! Asking the processor for memory before it is needed.

/// Asks for the cache lines of so many bytes. The address may be any; nothing is read.
#[inline(always)]
pub fn prefetch<T>(from: *const T, bytes: usize) {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        for line in 0..bytes.div_ceil(LINE) {
            let at = from.cast::<i8>().wrapping_add(LINE * line);
            // SAFETY: a prefetch reads nothing
            unsafe { _mm_prefetch::<_MM_HINT_T0>(at) };
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (from, bytes);
}

/// Bytes of a cache line.
#[cfg(target_arch = "x86_64")]
const LINE: usize = 64;
