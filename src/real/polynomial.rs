//! Polynomials, as series that are cut off.

use super::Real;

/// Σ terms[n] xⁿ. Neighbours are summed first, then pairs of them, and so on (Estrin's scheme): what takes time is the chain of
/// operations that wait for each other, and this has log₂ N in place of N.
#[inline(always)]
pub(super) fn polynomial<R: Real, const N: usize>(x: R, terms: &[f64; N]) -> R {
    let mut sums = [R::splat(0.0); N];
    for n in 0..N {
        sums[n] = R::splat(terms[n]);
    }
    let mut power = x;
    let mut count = N;
    while count > 1 {
        for k in 0..count / 2 {
            sums[k] = power.mul_add(sums[2 * k + 1], sums[2 * k]);
        }
        if count % 2 == 1 {
            sums[count / 2] = sums[count - 1];
        }
        count = count.div_ceil(2);
        power = power * power;
    }
    sums[0]
}
