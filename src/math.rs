//! Small vectors and matrices of any dimension, and sums that do not lose digits.

use nalgebra::{SMatrix, SVector};

/// A vector with one component an axis.
pub type Vector<const D: usize> = SVector<f64, D>;

/// A square matrix with one row and one column an axis.
pub type Matrix<const D: usize> = SMatrix<f64, D, D>;

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

/// How many numbers a packed symmetric matrix has: 1, 3 or 6.
#[inline(always)]
pub const fn packed_len(dimension: usize) -> usize {
    dimension * (dimension + 1) / 2
}

/// Writes a symmetric matrix row by row from the diagonal on: xx, or xx, xy, yy, or xx, xy, xz, yy, yz, zz.
#[inline(always)]
pub fn pack<const D: usize>(m: &Matrix<D>, out: &mut [f64]) {
    let mut at = 0;
    for i in 0..D {
        for j in i..D {
            out[at] = m[(i, j)];
            at += 1;
        }
    }
}

/// Reads what [`pack`] wrote.
#[inline(always)]
pub fn unpack<const D: usize>(packed: &[f64]) -> Matrix<D> {
    let mut m = Matrix::zeros();
    let mut at = 0;
    for i in 0..D {
        for j in i..D {
            m[(i, j)] = packed[at];
            m[(j, i)] = packed[at];
            at += 1;
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
        // what rounding took, exactly, whichever of the two is the larger (Knuth's TwoSum): no branch
        let added = sum - self.sum;
        self.lost += (self.sum - (sum - added)) + (term - added);
        self.sum = sum;
    }

    /// Adds the terms of another sum.
    #[inline(always)]
    pub fn add_sum(&mut self, other: &Self) {
        self.add(other.sum);
        self.lost += other.lost;
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

    #[test]
    fn packed_matrices_have_the_documented_order() {
        let m = Matrix::<3>::from_fn(|i, j| (10 * i.min(j) + i.max(j)) as f64);
        let mut packed = [0.0; 6];
        pack(&m, &mut packed);
        assert_eq!(packed, [0.0, 1.0, 2.0, 11.0, 12.0, 22.0]);
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
