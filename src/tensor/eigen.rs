//! Eigenvalues and eigenvectors of symmetric tensors.

use super::Tensor;
use crate::real::{Mask, Real};

impl<R: Real, const D: usize> Tensor<R, D> {
    /// Eigenvalues and eigenvectors (columns) of a symmetric tensor, by Jacobi rotations: one rotation in 2D, a few sweeps of
    /// three in 3D. NaN in, NaN out.
    ///
    /// A rotation by θ in the plane (p, q) removes a_pq when cot 2θ = (a_qq − a_pp) / (2 a_pq); of the two solutions for
    /// t = tan θ of t² + 2t cot 2θ − 1 = 0 the smaller is taken, by which the off-diagonal part shrinks in every sweep.
    #[inline(always)]
    pub fn symmetric_eigen(&self) -> ([R; D], Self) {
        let mut a = *self;
        let mut vectors = Self::identity();
        for _sweep in 0..12 {
            let mut done = true;
            for p in 0..D {
                for q in p + 1..D {
                    let off = a[(p, q)];
                    let small = (a[(p, p)] * a[(q, q)]).abs().sqrt() * (f64::EPSILON * 1e-3);
                    let turn = !off.abs().at_most(small);
                    if (!turn).all() {
                        continue;
                    }
                    done = false;
                    rotate(&mut a, &mut vectors, turn, (p, q));
                }
            }
            if done {
                break;
            }
        }
        let mut values = [R::splat(0.0); D];
        for i in 0..D {
            values[i] = a[(i, i)];
        }
        (values, vectors)
    }

    /// The symmetric tensor with these eigenvectors (columns) and eigenvalues.
    #[inline(always)]
    pub fn from_eigen(values: &[R; D], vectors: &Self) -> Self {
        let mut scaled = *vectors;
        for i in 0..D {
            for k in 0..D {
                scaled[(i, k)] = vectors[(i, k)] * values[k];
            }
        }
        let mut sum = Self::zero();
        for i in 0..D {
            for j in i..D {
                for k in 0..D {
                    sum[(i, j)] = scaled[(i, k)].mul_add(vectors[(j, k)], sum[(i, j)]);
                }
                sum[(j, i)] = sum[(i, j)];
            }
        }
        sum
    }
}

impl<R: Real, const D: usize> Tensor<R, D> {
    /// The largest eigenvalue of a symmetric tensor, to round-off. NaN in, NaN out.
    #[inline(always)]
    pub fn largest_eigenvalue(&self) -> R {
        self.extreme_eigenvalues().1
    }

    /// The largest difference between two eigenvalues of a symmetric tensor, to round-off. NaN in, NaN out.
    #[inline(always)]
    pub fn eigenvalue_spread(&self) -> R {
        let (smallest, largest) = self.extreme_eigenvalues();
        largest - smallest
    }

    /// The smallest and the largest eigenvalue of a symmetric tensor: roots of the quadratic in 2D, the trigonometric roots of
    /// the cubic in 3D.
    ///
    /// With q = tr T / 3, s = T − q I and p² = tr s² / 6, the eigenvalues of s are 2p cos(φ + 2πk/3) where
    /// cos 3φ = det s / (2p³): x = 2p cos φ in x³ − 3p² x − det s = 0 gives 2p³ cos 3φ = det s. The largest has k = 0; the
    /// smallest is less the largest one of −s, whose cos 3φ has the other sign.
    #[inline(always)]
    fn extreme_eigenvalues(&self) -> (R, R) {
        let mean = self.trace() * (1.0 / D as f64);
        if D == 1 {
            return (mean, mean);
        }
        let deviator = self.plus_diagonal(-mean);
        let squares = deviator.norm_squared();
        if D == 2 {
            let radius = (squares * 0.5).sqrt();
            return (mean - radius, mean + radius);
        }
        let p = (squares * (1.0 / 6.0)).sqrt();
        let one = R::splat(1.0);
        // where p is zero so are both products below; where it is not a number so are the results
        let inverse = one / p.max(R::splat(f64::MIN_POSITIVE));
        let cosine = deviator.scaled(inverse).determinant() * 0.5;
        let cosine = cosine.min(one).max(-one);
        (
            mean - p * twice_cosine_of_a_third(-cosine),
            mean + p * twice_cosine_of_a_third(cosine),
        )
    }
}

/// 2 cos(arccos(c) / 3) for −1 ≤ c ≤ 1, to 3e-16 of itself and without a function of a library.
///
/// At c = −1 it has the slope of a root, but with s = √((1 + c)/2), the cosine of half the angle, it is 2 cos(⅔ arccos s), smooth over
/// 0 ≤ s ≤ 1: its interpolant at the Chebyshev points of degree 18, in powers of 2s − 1 (computed with 60 digits, derived here).
#[inline(always)]
fn twice_cosine_of_a_third<R: Real>(c: R) -> R {
    const POWERS: [f64; 19] = [
        1.532088886237956,
        0.4948181326457068,
        -0.031018376872971872,
        0.004932705630131257,
        -0.0010082493822762466,
        0.00023285090663649862,
        -5.78398726110389e-05,
        1.5082151126906054e-05,
        -4.071739330163681e-06,
        1.1283286657056964e-06,
        -3.190867253334955e-07,
        9.165264413380955e-08,
        -2.669723252733702e-08,
        7.964072129288154e-09,
        -2.3692501406348273e-09,
        6.187232346201406e-10,
        -1.8618653028860953e-10,
        1.022932905301698e-10,
        -3.137220548922671e-11,
    ];
    let s = ((c + 1.0) * 0.5).sqrt();
    let x = s * 2.0 - 1.0;
    let mut sum = R::splat(POWERS[18]);
    for k in (0..18).rev() {
        sum = sum.mul_add(x, R::splat(POWERS[k]));
    }
    sum
}

/// One Jacobi rotation in the plane (p, q), in those lanes that need it: the others must come out as if they were alone.
#[inline(always)]
fn rotate<R: Real, const D: usize>(
    a: &mut Tensor<R, D>,
    vectors: &mut Tensor<R, D>,
    turn: R::Mask,
    (p, q): (usize, usize),
) {
    let one = R::splat(1.0);
    let off = a[(p, q)];
    let cot = (a[(q, q)] - a[(p, p)]) / (off * 2.0);
    let t = one.copysign(cot) / (cot.abs() + cot.mul_add(cot, one).sqrt());
    let c = one / t.mul_add(t, one).sqrt();
    let s = t * c;
    a[(p, p)] = R::select(turn, a[(p, p)] - t * off, a[(p, p)]);
    a[(q, q)] = R::select(turn, a[(q, q)] + t * off, a[(q, q)]);
    a[(p, q)] = R::select(turn, R::splat(0.0), off);
    a[(q, p)] = a[(p, q)];
    for k in 0..D {
        if k != p && k != q {
            let (x, y) = (a[(k, p)], a[(k, q)]);
            a[(k, p)] = R::select(turn, c * x - s * y, x);
            a[(k, q)] = R::select(turn, s * x + c * y, y);
            a[(p, k)] = a[(k, p)];
            a[(q, k)] = a[(k, q)];
        }
        let (x, y) = (vectors[(k, p)], vectors[(k, q)]);
        vectors[(k, p)] = R::select(turn, c * x - s * y, x);
        vectors[(k, q)] = R::select(turn, s * x + c * y, y);
    }
}
