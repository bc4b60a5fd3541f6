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

impl<const D: usize> Tensor<f64, D> {
    /// The largest eigenvalue of a symmetric tensor, to round-off.
    #[inline]
    pub fn largest_eigenvalue(&self) -> f64 {
        self.extreme_eigenvalues().1
    }

    /// The largest difference between two eigenvalues of a symmetric tensor, to round-off.
    #[inline]
    pub fn eigenvalue_spread(&self) -> f64 {
        let (smallest, largest) = self.extreme_eigenvalues();
        largest - smallest
    }

    /// The smallest and the largest eigenvalue of a symmetric tensor: roots of the quadratic in 2D, the trigonometric roots of
    /// the cubic in 3D.
    ///
    /// With q = tr T / 3, s = T − q I and p² = tr s² / 6, the eigenvalues of s are 2p cos(φ + 2πk/3) where
    /// cos 3φ = det s / (2p³): x = 2p cos φ in x³ − 3p² x − det s = 0 gives 2p³ cos 3φ = det s.
    #[inline]
    fn extreme_eigenvalues(&self) -> (f64, f64) {
        let mean = self.trace() / D as f64;
        let deviator = self.plus_diagonal(-mean);
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
                let cosine = (deviator * (1.0 / p)).determinant() * 0.5;
                let phi = cosine.clamp(-1.0, 1.0).acos() / 3.0;
                let third = 2.0 * std::f64::consts::FRAC_PI_3;
                (
                    mean + 2.0 * p * (phi + third).cos(),
                    mean + 2.0 * p * phi.cos(),
                )
            }
        }
    }
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
