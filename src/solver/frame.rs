//! The total Lagrangian frame: the speed of waves as the grid sees it, which lives in the reference configuration. How rates and
//! stresses go from one configuration to the other is in [`crate::material`], point by point.

use crate::math::Matrix;
use crate::real::{Portable, Real};
use crate::tensor::Tensor;

/// Points that are computed together.
const GROUP: usize = 4;

/// Turns ρ₀ c² of some points, Pa, into an upper estimate of ρ₀ c₀², c₀ being the speed of a wave measured in the reference
/// configuration; `f` are their deformation gradients.
///
/// A wave with the wave vector K in the reference configuration has k = F⁻ᵀ K in the present one and the same frequency, so that
/// c₀ = c |k|/|K| ≤ c ‖F⁻¹‖.
pub(super) fn seen_from_reference<const D: usize>(f: &[Matrix<D>], stiffness: &mut [f64]) {
    for (f, stiffness) in f.chunks(GROUP).zip(stiffness.chunks_mut(GROUP)) {
        let mut numbers = [Portable::splat(0.0); 9];
        for (k, f) in f.iter().enumerate() {
            for (number, x) in numbers.iter_mut().zip(f.as_slice()) {
                *number = number.with_lane(k, *x);
            }
        }
        let inverse = Tensor::<Portable, D>::from_columns(&numbers).inverse();
        let squares = (inverse * inverse.transpose()).largest_eigenvalue();
        for (k, stiffness) in stiffness.iter_mut().enumerate() {
            *stiffness *= squares.lane(k);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Any numbers between −½ and ½.
    fn number(k: usize) -> f64 {
        (0.37 + k as f64 * 0.618_033_988_75).fract() - 0.5
    }

    /// Every number of points up to five groups.
    fn as_in_the_book<const D: usize>() {
        for count in 1..=20 {
            let f: Vec<Matrix<D>> = (0..count)
                .map(|k| {
                    Matrix::identity() * 1.5 + Matrix::from_fn(|i, j| number(100 * k + D * i + j))
                })
                .collect();
            let mut stiffness: Vec<f64> = (0..count).map(|k| 1.0 + k as f64).collect();
            seen_from_reference(&f, &mut stiffness);
            for k in 0..count {
                let inverse = Tensor::from(f[k].try_inverse().expect("F is not singular"));
                let (squares, _) = (inverse * inverse.transpose()).symmetric_eigen();
                let largest = squares.into_iter().fold(0.0, f64::max);
                let expected = (1.0 + k as f64) * largest;
                assert!((stiffness[k] / expected - 1.0).abs() < 1e-13, "{D}D c₀");
            }
        }
    }

    #[test]
    fn waves_are_as_fast_as_the_smallest_stretch_says() {
        as_in_the_book::<1>();
        as_in_the_book::<2>();
        as_in_the_book::<3>();
    }
}
