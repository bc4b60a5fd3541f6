//! Small square matrices whose components are [`Real`]: those of one point, or of four points together.

mod eigen;
#[cfg(test)]
mod tests;

use crate::math::Matrix;
use crate::real::Real;
use std::ops::{Add, Index, IndexMut, Mul, Sub};

/// A tensor of second order with `D` directions; `t[(i, j)]` is the component in row i and column j.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tensor<R, const D: usize>(pub [[R; D]; D]);

impl<R, const D: usize> Index<(usize, usize)> for Tensor<R, D> {
    type Output = R;
    #[inline(always)]
    fn index(&self, (i, j): (usize, usize)) -> &R {
        &self.0[i][j]
    }
}

impl<R, const D: usize> IndexMut<(usize, usize)> for Tensor<R, D> {
    #[inline(always)]
    fn index_mut(&mut self, (i, j): (usize, usize)) -> &mut R {
        &mut self.0[i][j]
    }
}

impl<const D: usize> From<Tensor<f64, D>> for Matrix<D> {
    #[inline(always)]
    fn from(tensor: Tensor<f64, D>) -> Self {
        Self::from_fn(|i, j| tensor[(i, j)])
    }
}

impl<const D: usize> From<Matrix<D>> for Tensor<f64, D> {
    #[inline(always)]
    fn from(matrix: Matrix<D>) -> Self {
        let mut tensor = Self::zero();
        for i in 0..D {
            for j in 0..D {
                tensor[(i, j)] = matrix[(i, j)];
            }
        }
        tensor
    }
}

impl<R: Real, const D: usize> Add for Tensor<R, D> {
    type Output = Self;
    #[inline(always)]
    fn add(mut self, other: Self) -> Self {
        for i in 0..D {
            for j in 0..D {
                self[(i, j)] = self[(i, j)] + other[(i, j)];
            }
        }
        self
    }
}

impl<R: Real, const D: usize> Sub for Tensor<R, D> {
    type Output = Self;
    #[inline(always)]
    fn sub(mut self, other: Self) -> Self {
        for i in 0..D {
            for j in 0..D {
                self[(i, j)] = self[(i, j)] - other[(i, j)];
            }
        }
        self
    }
}

impl<R: Real, const D: usize> Mul<f64> for Tensor<R, D> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        self.scaled(R::splat(factor))
    }
}

/// The product of two tensors, T U.
impl<R: Real, const D: usize> Mul for Tensor<R, D> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let mut product = Self::zero();
        for i in 0..D {
            for j in 0..D {
                let mut sum = self[(i, 0)] * other[(0, j)];
                for k in 1..D {
                    sum = self[(i, k)].mul_add(other[(k, j)], sum);
                }
                product[(i, j)] = sum;
            }
        }
        product
    }
}

impl<R: Real, const D: usize> Tensor<R, D> {
    /// 0.
    #[inline(always)]
    pub fn zero() -> Self {
        Self::filled(0.0)
    }

    /// I.
    #[inline(always)]
    pub fn identity() -> Self {
        Self::zero().plus_diagonal(R::splat(1.0))
    }

    /// The same number everywhere.
    #[inline(always)]
    pub fn filled(x: f64) -> Self {
        Self([[R::splat(x); D]; D])
    }

    /// T + x I.
    #[inline(always)]
    pub fn plus_diagonal(mut self, x: R) -> Self {
        for i in 0..D {
            self[(i, i)] = self[(i, i)] + x;
        }
        self
    }

    /// x T.
    #[inline(always)]
    pub fn scaled(mut self, x: R) -> Self {
        for i in 0..D {
            for j in 0..D {
                self[(i, j)] = self[(i, j)] * x;
            }
        }
        self
    }

    /// x T + U.
    #[inline(always)]
    pub fn scaled_plus(mut self, x: R, other: Self) -> Self {
        for i in 0..D {
            for j in 0..D {
                self[(i, j)] = self[(i, j)].mul_add(x, other[(i, j)]);
            }
        }
        self
    }

    /// T U + V.
    #[inline(always)]
    pub fn times_plus(&self, other: &Self, sum: Self) -> Self {
        let mut result = sum;
        for i in 0..D {
            for j in 0..D {
                for k in 0..D {
                    result[(i, j)] = self[(i, k)].mul_add(other[(k, j)], result[(i, j)]);
                }
            }
        }
        result
    }

    /// T Tᵀ + V, with V symmetric.
    #[inline(always)]
    pub fn square_plus(&self, sum: Self) -> Self {
        let mut result = sum;
        for i in 0..D {
            for j in i..D {
                for k in 0..D {
                    result[(i, j)] = self[(i, k)].mul_add(self[(j, k)], result[(i, j)]);
                }
                result[(j, i)] = result[(i, j)];
            }
        }
        result
    }

    /// U T Uᵀ of a symmetric T.
    #[inline(always)]
    pub fn turned_by(&self, u: &Self) -> Self {
        let half = *u * *self;
        let mut turned = *self;
        for i in 0..D {
            for j in i..D {
                let mut sum = half[(i, 0)] * u[(j, 0)];
                for k in 1..D {
                    sum = half[(i, k)].mul_add(u[(j, k)], sum);
                }
                turned[(i, j)] = sum;
                turned[(j, i)] = sum;
            }
        }
        turned
    }

    /// Tᵀ.
    #[inline(always)]
    pub fn transpose(&self) -> Self {
        let mut transposed = *self;
        for i in 0..D {
            for j in 0..D {
                transposed[(i, j)] = self[(j, i)];
            }
        }
        transposed
    }

    /// T + Tᵀ.
    #[inline(always)]
    pub fn plus_transpose(&self) -> Self {
        let mut sum = *self;
        for i in 0..D {
            for j in i..D {
                sum[(i, j)] = self[(i, j)] + self[(j, i)];
                sum[(j, i)] = sum[(i, j)];
            }
        }
        sum
    }

    /// tr T.
    #[inline(always)]
    pub fn trace(&self) -> R {
        let mut sum = self[(0, 0)];
        for i in 1..D {
            sum = sum + self[(i, i)];
        }
        sum
    }

    /// T : T.
    #[inline(always)]
    pub fn norm_squared(&self) -> R {
        let mut sum = R::splat(0.0);
        for i in 0..D {
            for j in 0..D {
                sum = self[(i, j)].mul_add(self[(i, j)], sum);
            }
        }
        sum
    }

    /// `self` where the mask is set, `other` elsewhere.
    #[inline(always)]
    pub fn select(mask: R::Mask, a: Self, b: Self) -> Self {
        let mut selected = a;
        for i in 0..D {
            for j in 0..D {
                selected[(i, j)] = R::select(mask, a[(i, j)], b[(i, j)]);
            }
        }
        selected
    }

    /// T_ij T_kl − T_il T_kj.
    #[inline(always)]
    fn minor(&self, (i, k): (usize, usize), (j, l): (usize, usize)) -> R {
        self[(i, j)].mul_add(self[(k, l)], -(self[(i, l)] * self[(k, j)]))
    }

    /// The determinant of a 1 × 1, 2 × 2 or 3 × 3 tensor.
    #[inline(always)]
    pub fn determinant(&self) -> R {
        match D {
            1 => self[(0, 0)],
            2 => self.minor((0, 1), (0, 1)),
            _ => {
                let first = self[(0, 0)] * self.minor((1, 2), (1, 2));
                let second = self[(0, 1)].mul_add(self.minor((1, 2), (2, 0)), first);
                self[(0, 2)].mul_add(self.minor((1, 2), (0, 1)), second)
            }
        }
    }

    /// det(I + T) − 1, without the digits that forming I + T would cost when T is small: the sum of the principal minors.
    #[inline(always)]
    pub fn determinant_less_one(&self) -> R {
        match D {
            1 => self[(0, 0)],
            _ => self.trace() + self.determinant_beyond_trace(),
        }
    }

    /// What det(I + T) − 1 has beyond the trace of T.
    #[inline(always)]
    pub fn determinant_beyond_trace(&self) -> R {
        match D {
            1 => R::splat(0.0),
            2 => self.determinant(),
            _ => {
                let minors = self.minor((0, 1), (0, 1)) + self.minor((0, 2), (0, 2));
                minors + self.minor((1, 2), (1, 2)) + self.determinant()
            }
        }
    }

    /// The inverse of a 1 × 1, 2 × 2 or 3 × 3 tensor; infinite or NaN where there is none.
    #[inline(always)]
    pub fn inverse(&self) -> Self {
        let scale = R::splat(1.0) / self.determinant();
        let mut inverse = Self::zero();
        for i in 0..D {
            for j in 0..D {
                let adjugate = match D {
                    1 => R::splat(1.0),
                    2 if i == j => self[(1 - i, 1 - i)],
                    2 => -self[(i, j)],
                    // the cofactor of (j, i), its indices taken in cyclic order
                    _ => self.minor(((j + 1) % 3, (j + 2) % 3), ((i + 1) % 3, (i + 2) % 3)),
                };
                inverse[(i, j)] = adjugate * scale;
            }
        }
        inverse
    }

    /// Reads a tensor column by column.
    #[inline(always)]
    pub fn from_columns(numbers: &[R]) -> Self {
        let mut tensor = Self::zero();
        for a in 0..D {
            for i in 0..D {
                tensor[(i, a)] = numbers[a * D + i];
            }
        }
        tensor
    }

    /// Writes what [`Self::from_columns`] reads.
    #[inline(always)]
    pub fn to_columns(&self, numbers: &mut [R]) {
        for a in 0..D {
            for i in 0..D {
                numbers[a * D + i] = self[(i, a)];
            }
        }
    }

    /// Reads a symmetric tensor row by row from the diagonal on: xx, or xx, xy, yy, or xx, xy, xz, yy, yz, zz.
    #[inline(always)]
    pub fn from_packed(packed: &[R]) -> Self {
        let mut tensor = Self::zero();
        let mut at = 0;
        for i in 0..D {
            for j in i..D {
                tensor[(i, j)] = packed[at];
                tensor[(j, i)] = packed[at];
                at += 1;
            }
        }
        tensor
    }

    /// Writes what [`Self::from_packed`] reads.
    #[inline(always)]
    pub fn to_packed(&self, packed: &mut [R]) {
        let mut at = 0;
        for i in 0..D {
            for j in i..D {
                packed[at] = self[(i, j)];
                at += 1;
            }
        }
    }
}
