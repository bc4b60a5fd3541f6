use super::*;
use crate::math::{pack, packed_len, unpack};

/// A tensor without symmetry whose entries are of the order of `size`.
fn sample<const D: usize>(size: f64) -> Tensor<f64, D> {
    let matrix = Matrix::<D>::from_fn(|i, j| size * ((1 + 3 * i + 7 * j) as f64).sin());
    assert_eq!(Matrix::from(Tensor::from(matrix)), matrix);
    matrix.into()
}

fn in_dimension<const D: usize>() {
    let identity = Tensor::<f64, D>::identity();
    for size in [1e-9, 0.1, 0.4] {
        let h = sample::<D>(size);
        let f = identity + h;
        assert!((f.inverse() * f - identity).norm_squared().sqrt() < 1e-14);
        let less_one = h.determinant_less_one();
        assert!((less_one - (f.determinant() - 1.0)).abs() < 1e-15 * 4.0);
        assert!((h.determinant_beyond_trace() - (less_one - h.trace())).abs() < 1e-15);

        let symmetric = h + h.transpose();
        let (values, vectors) = symmetric.symmetric_eigen();
        assert!(
            (vectors * vectors.transpose() - identity)
                .norm_squared()
                .sqrt()
                < 1e-14
        );
        assert!(
            (Tensor::from_eigen(&values, &vectors) - symmetric)
                .norm_squared()
                .sqrt()
                < 1e-14 * size
        );
        let largest = values.into_iter().fold(f64::NEG_INFINITY, f64::max);
        let smallest = values.into_iter().fold(f64::INFINITY, f64::min);
        let found = symmetric.largest_eigenvalue();
        assert!((found - largest).abs() < 1e-13 * size, "{found} {largest}");
        let spread = symmetric.eigenvalue_spread();
        assert!((spread - (largest - smallest)).abs() < 1e-13 * size);

        let (mut packed, mut same) = (vec![0.0; packed_len(D)], vec![0.0; packed_len(D)]);
        symmetric.to_packed(&mut packed);
        assert_eq!(Tensor::from_packed(&packed), symmetric);
        pack(&Matrix::from(symmetric), &mut same);
        assert_eq!(packed, same);
        assert_eq!(Matrix::from(symmetric), unpack::<D>(&packed));

        let turned = f * symmetric * f.transpose() - symmetric.turned_by(&f);
        assert!(turned.norm_squared().sqrt() < 1e-15 * 8.0);
        let square = h * h.transpose() + symmetric - h.square_plus(symmetric);
        assert!(square.norm_squared().sqrt() < 1e-15 * 4.0);
        let product = h * f + symmetric - h.times_plus(&f, symmetric);
        assert!(product.norm_squared().sqrt() < 1e-15 * 4.0);
    }
    // NaN comes back as NaN, and comes back
    let (values, _) = Tensor::<f64, D>::filled(f64::NAN).symmetric_eigen();
    assert!(values.iter().all(|value| value.is_nan()));
}

/// Eigenvalues 1, t and −1 in every order of size, turned: all values of cos 3φ, its ends with two equal ones among them.
#[test]
fn extreme_eigenvalues_are_found_wherever_the_third_one_lies() {
    let (_, axes) = (sample::<3>(1.0) + sample::<3>(1.0).transpose()).symmetric_eigen();
    for k in 0..=200 {
        let t = 0.01 * f64::from(k) - 1.0;
        let tensor = Tensor::from_eigen(&[t, 1.0, -1.0], &axes).scaled(3e-7);
        // where two are equal, round-off in the determinant counts as its root
        let close = if t.abs() > 0.999 {
            2e-8
        } else {
            2e-15 / (1.0 - t.abs())
        };
        let largest = tensor.largest_eigenvalue() / 3e-7;
        assert!((largest - 1.0).abs() < close, "{t}: {largest}");
        let spread = tensor.eigenvalue_spread() / 3e-7;
        assert!((spread - 2.0).abs() < 2.0 * close, "{t}: {spread}");
    }
    assert_eq!(Tensor::<f64, 3>::zero().largest_eigenvalue(), 0.0);
    assert_eq!(Tensor::<f64, 3>::identity().largest_eigenvalue(), 1.0);
    let mut broken = Tensor::<f64, 3>::identity();
    broken[(0, 1)] = f64::NAN;
    assert!(broken.largest_eigenvalue().is_nan() && broken.eigenvalue_spread().is_nan());
}

#[test]
fn small_tensors_obey_their_definitions_in_every_dimension() {
    in_dimension::<1>();
    in_dimension::<2>();
    in_dimension::<3>();
}
