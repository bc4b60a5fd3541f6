//! Small vectors and matrices of any dimension, and sums that do not lose digits.

use nalgebra::{SMatrix, SVector};

/// A vector with one component an axis.
pub type Vector<const D: usize> = SVector<f64, D>;

/// A square matrix with one row and one column an axis.
pub type Matrix<const D: usize> = SMatrix<f64, D, D>;

/// The determinant of a 1 × 1, 2 × 2 or 3 × 3 matrix.
#[inline(always)]
pub fn determinant<const D: usize>(m: &Matrix<D>) -> f64 {
    match D {
        1 => m[(0, 0)],
        2 => m[(0, 0)] * m[(1, 1)] - m[(0, 1)] * m[(1, 0)],
        3 => {
            m[(0, 0)] * (m[(1, 1)] * m[(2, 2)] - m[(1, 2)] * m[(2, 1)])
                - m[(0, 1)] * (m[(1, 0)] * m[(2, 2)] - m[(1, 2)] * m[(2, 0)])
                + m[(0, 2)] * (m[(1, 0)] * m[(2, 1)] - m[(1, 1)] * m[(2, 0)])
        }
        _ => unreachable!("a scene has 1, 2 or 3 dimensions"),
    }
}

/// det(I + H) − 1, without the digits that forming I + H would cost when H is small: the sum of the principal minors of H.
#[inline(always)]
pub fn determinant_less_one<const D: usize>(h: &Matrix<D>) -> f64 {
    match D {
        1 => h[(0, 0)],
        2 => h[(0, 0)] + h[(1, 1)] + determinant(h),
        _ => h.trace() + second_minors(h) + determinant(h),
    }
}

/// What det(I + H) − 1 has beyond the trace of H.
#[inline(always)]
pub fn determinant_beyond_trace<const D: usize>(h: &Matrix<D>) -> f64 {
    match D {
        1 => 0.0,
        2 => determinant(h),
        _ => second_minors(h) + determinant(h),
    }
}

/// The sum of the principal 2 × 2 minors of a 3 × 3 matrix.
#[inline(always)]
fn second_minors<const D: usize>(h: &Matrix<D>) -> f64 {
    let minor = |i: usize, j: usize| h[(i, i)] * h[(j, j)] - h[(i, j)] * h[(j, i)];
    minor(0, 1) + minor(0, 2) + minor(1, 2)
}

/// The inverse of a 1 × 1, 2 × 2 or 3 × 3 matrix; infinite or NaN where there is none.
#[inline(always)]
pub fn inverse<const D: usize>(m: &Matrix<D>) -> Matrix<D> {
    let scale = 1.0 / determinant(m);
    match D {
        1 => Matrix::from_element(scale),
        2 => Matrix::from_fn(|i, j| if i == j { m[(1 - i, 1 - i)] } else { -m[(i, j)] } * scale),
        _ => Matrix::from_fn(|i, j| {
            // the cofactor of (j, i), its indices taken in cyclic order
            let (a, b) = ((j + 1) % 3, (j + 2) % 3);
            let (c, d) = ((i + 1) % 3, (i + 2) % 3);
            (m[(a, c)] * m[(b, d)] - m[(a, d)] * m[(b, c)]) * scale
        }),
    }
}

/// x − ln(1 + x), without the digits that the difference would cost when x is small; NaN for x ≤ −1.
///
/// With z = x / (2 + x), ln(1 + x) = 2 artanh z = 2 (z + z³/3 + z⁵/5 + …) and x = 2z / (1 − z), so that the difference is
/// x z − 2 z³ (1/3 + z²/5 + z⁴/7 + …); eight terms suffice for |x| < 0.1.
#[inline]
pub fn excess_over_logarithm(x: f64) -> f64 {
    if x.abs() < 0.1 {
        let z = x / (2.0 + x);
        let zz = z * z;
        let series = (0..8)
            .rev()
            .fold(0.0, |sum, k| sum * zz + 1.0 / f64::from(2 * k + 3));
        x * z - 2.0 * z * zz * series
    } else if x > -1.0 {
        x - x.ln_1p()
    } else {
        f64::NAN
    }
}

/// Eigenvalues and eigenvectors (columns) of a symmetric matrix, by Jacobi rotations: one rotation in 2D, a few sweeps of
/// three in 3D. NaN in, NaN out.
///
/// A rotation by θ in the plane (p, q) removes a_pq when cot 2θ = (a_qq − a_pp) / (2 a_pq); of the two solutions for
/// t = tan θ of t² + 2t cot 2θ − 1 = 0 the smaller is taken, by which the off-diagonal part shrinks in every sweep.
pub fn symmetric_eigen<const D: usize>(m: &Matrix<D>) -> ([f64; D], Matrix<D>) {
    let mut a = *m;
    let mut vectors = Matrix::<D>::identity();
    for _sweep in 0..12 {
        let mut done = true;
        for p in 0..D {
            for q in p + 1..D {
                let off = a[(p, q)];
                if off.abs() <= f64::EPSILON * 1e-3 * (a[(p, p)] * a[(q, q)]).abs().sqrt() {
                    continue;
                }
                done = false;
                let cot = (a[(q, q)] - a[(p, p)]) / (2.0 * off);
                let t = 1.0_f64.copysign(cot) / (cot.abs() + (1.0 + cot * cot).sqrt());
                let c = 1.0 / (1.0 + t * t).sqrt();
                let s = t * c;
                a[(p, p)] -= t * off;
                a[(q, q)] += t * off;
                a[(p, q)] = 0.0;
                a[(q, p)] = 0.0;
                for k in 0..D {
                    if k != p && k != q {
                        let (x, y) = (a[(k, p)], a[(k, q)]);
                        a[(k, p)] = c * x - s * y;
                        a[(k, q)] = s * x + c * y;
                        a[(p, k)] = a[(k, p)];
                        a[(q, k)] = a[(k, q)];
                    }
                    let (x, y) = (vectors[(k, p)], vectors[(k, q)]);
                    vectors[(k, p)] = c * x - s * y;
                    vectors[(k, q)] = s * x + c * y;
                }
            }
        }
        if done {
            break;
        }
    }
    (std::array::from_fn(|i| a[(i, i)]), vectors)
}

/// The symmetric matrix with these eigenvectors (columns) and eigenvalues.
#[inline(always)]
pub fn from_eigen<const D: usize>(values: &[f64; D], vectors: &Matrix<D>) -> Matrix<D> {
    Matrix::from_fn(|i, j| {
        (0..D)
            .map(|k| values[k] * vectors[(i, k)] * vectors[(j, k)])
            .sum()
    })
}

/// The largest eigenvalue of a symmetric matrix, to round-off.
#[inline]
pub fn largest_eigenvalue<const D: usize>(m: &Matrix<D>) -> f64 {
    extreme_eigenvalues(m).1
}

/// The largest difference between two eigenvalues of a symmetric matrix, to round-off.
#[inline]
pub fn eigenvalue_spread<const D: usize>(m: &Matrix<D>) -> f64 {
    let (smallest, largest) = extreme_eigenvalues(m);
    largest - smallest
}

/// The smallest and the largest eigenvalue of a symmetric matrix: roots of the quadratic in 2D, the trigonometric roots of the
/// cubic in 3D.
///
/// With q = tr m / 3, s = m − q I and p² = tr s² / 6, the eigenvalues of s are 2p cos(φ + 2πk/3) where cos 3φ = det s / (2p³):
/// x = 2p cos φ in x³ − 3p² x − det s = 0 gives 2p³ cos 3φ = det s.
#[inline]
pub fn extreme_eigenvalues<const D: usize>(m: &Matrix<D>) -> (f64, f64) {
    let mean = m.trace() / D as f64;
    let deviator = m - Matrix::<D>::identity() * mean;
    let squares = deviator.norm_squared();
    match D {
        1 => (mean, mean),
        2 => {
            let radius = (0.5 * squares).sqrt();
            (mean - radius, mean + radius)
        }
        _ => {
            let p = (squares / 6.0).sqrt();
            if p <= f64::MIN_POSITIVE {
                return (mean - p, mean + p);
            }
            let cosine = determinant(&(deviator / p)) * 0.5;
            let phi = cosine.clamp(-1.0, 1.0).acos() / 3.0;
            let third = 2.0 * std::f64::consts::FRAC_PI_3;
            (
                mean + 2.0 * p * (phi + third).cos(),
                mean + 2.0 * p * phi.cos(),
            )
        }
    }
}

/// How many numbers a packed symmetric matrix has: 1, 3 or 6.
#[inline(always)]
pub const fn packed_len(dimension: usize) -> usize {
    dimension * (dimension + 1) / 2
}

/// Writes a symmetric matrix as xx, or xx, yy, xy, or xx, yy, zz, xy, xz, yz.
#[inline(always)]
pub fn pack<const D: usize>(m: &Matrix<D>, out: &mut [f64]) {
    let mut off = D;
    for i in 0..D {
        out[i] = m[(i, i)];
        for j in i + 1..D {
            out[off] = m[(i, j)];
            off += 1;
        }
    }
}

/// Reads what [`pack`] wrote.
#[inline(always)]
pub fn unpack<const D: usize>(packed: &[f64]) -> Matrix<D> {
    let mut m = Matrix::zeros();
    let mut off = D;
    for i in 0..D {
        m[(i, i)] = packed[i];
        for j in i + 1..D {
            m[(i, j)] = packed[off];
            m[(j, i)] = packed[off];
            off += 1;
        }
    }
    m
}

/// A sum that keeps the low-order part that plain addition drops.
///
/// Source: A. Neumaier, "Rundungsfehleranalyse einiger Verfahren zur Summation endlicher Summen",
/// Z. angew. Math. Mech. 54 (1974) 39–51, the variant that also covers a term larger than the sum.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sum {
    sum: f64,
    lost: f64,
}

impl Sum {
    /// Adds one term.
    #[inline(always)]
    pub fn add(&mut self, term: f64) {
        let sum = self.sum + term;
        self.lost += if self.sum.abs() >= term.abs() {
            (self.sum - sum) + term
        } else {
            (term - sum) + self.sum
        };
        self.sum = sum;
    }

    /// The sum of all terms so far.
    pub fn value(&self) -> f64 {
        self.sum + self.lost
    }
}

impl FromIterator<f64> for Sum {
    fn from_iter<I: IntoIterator<Item = f64>>(terms: I) -> Self {
        let mut sum = Sum::default();
        terms.into_iter().for_each(|term| sum.add(term));
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A matrix without symmetry whose entries are of the order of `size`.
    fn sample<const D: usize>(size: f64) -> Matrix<D> {
        Matrix::from_fn(|i, j| size * ((1 + 3 * i + 7 * j) as f64).sin())
    }

    fn in_dimension<const D: usize>() {
        let identity = Matrix::<D>::identity();
        for size in [1e-9, 0.1, 0.4] {
            let h = sample::<D>(size);
            let f = identity + h;
            assert!((inverse(&f) * f - identity).norm() < 1e-14);
            let less_one = determinant_less_one(&h);
            assert!((less_one - (determinant(&f) - 1.0)).abs() < 1e-15 * 4.0);
            assert!((determinant_beyond_trace(&h) - (less_one - h.trace())).abs() < 1e-15);

            let symmetric = h + h.transpose();
            let (values, vectors) = symmetric_eigen(&symmetric);
            assert!((vectors * vectors.transpose() - identity).norm() < 1e-14);
            assert!((from_eigen(&values, &vectors) - symmetric).norm() < 1e-14 * size);
            let largest = values.into_iter().fold(f64::NEG_INFINITY, f64::max);
            let smallest = values.into_iter().fold(f64::INFINITY, f64::min);
            let found = largest_eigenvalue(&symmetric);
            assert!((found - largest).abs() < 1e-13 * size, "{found} {largest}");
            let spread = eigenvalue_spread(&symmetric);
            assert!((spread - (largest - smallest)).abs() < 1e-13 * size);

            let mut packed = vec![0.0; packed_len(D)];
            pack(&symmetric, &mut packed);
            assert_eq!(unpack::<D>(&packed), symmetric);
        }
        // NaN comes back as NaN, and comes back
        let (values, _) = symmetric_eigen(&Matrix::<D>::from_element(f64::NAN));
        assert!(values.iter().all(|value| value.is_nan()));
    }

    #[test]
    fn small_matrices_obey_their_definitions_in_every_dimension() {
        in_dimension::<1>();
        in_dimension::<2>();
        in_dimension::<3>();
    }

    #[test]
    fn packed_matrices_have_the_documented_order() {
        let m = Matrix::<3>::from_fn(|i, j| (10 * i.min(j) + i.max(j)) as f64);
        let mut packed = [0.0; 6];
        pack(&m, &mut packed);
        assert_eq!(packed, [0.0, 11.0, 22.0, 1.0, 2.0, 12.0]);
    }

    #[test]
    fn the_excess_over_the_logarithm_keeps_its_digits() {
        for x in [1e-9_f64, -1e-9, 1e-6] {
            let expected = x * x / 2.0 - x * x * x / 3.0 + x.powi(4) / 4.0;
            assert!((excess_over_logarithm(x) / expected - 1.0).abs() < 1e-15 * 4.0);
        }
        for x in [0.0999999_f64, -0.0999999, 0.03, 0.5, -0.9] {
            assert!((excess_over_logarithm(x) - (x - x.ln_1p())).abs() < 1e-16 * 4.0);
        }
        assert!(excess_over_logarithm(-1.0).is_nan() && excess_over_logarithm(f64::NAN).is_nan());
    }
}
