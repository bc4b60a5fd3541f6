//! The deformation of one point, all three directions of it.

use crate::real::Real;
use crate::tensor::Tensor;

/// How a point is deformed. What is kept is the difference from no deformation, so that strains of 1e-9 have all their
/// digits: 1 + 1e-9 has lost nine of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deformation<R, const D: usize> {
    /// H = F − I, the displacement gradient ∂u_i/∂X_j in the modelled directions.
    pub displacement_gradient: Tensor<R, D>,
    /// Stretch less one of each direction that is not modelled: two alike in 1D, one in 2D, none in 3D.
    pub transverse: R,
}

impl<R: Real, const D: usize> Deformation<R, D> {
    /// How many directions are not modelled.
    pub const TRANSVERSE: f64 = 3.0 - D as f64;

    /// F in the modelled directions.
    #[inline(always)]
    pub fn gradient(&self) -> Tensor<R, D> {
        self.displacement_gradient.plus_diagonal(R::splat(1.0))
    }

    /// b − I = F Fᵀ − I = H + Hᵀ + H Hᵀ in the modelled directions, twice the strain when it is small.
    #[inline(always)]
    pub fn finger_less_one(&self) -> Tensor<R, D> {
        let h = self.displacement_gradient;
        h.square_plus(h.plus_transpose())
    }

    /// Green's strain E = (FᵀF − I)/2 = (H + Hᵀ + Hᵀ H)/2 in the modelled directions.
    #[inline(always)]
    pub fn green_strain(&self) -> Tensor<R, D> {
        let h = self.displacement_gradient;
        h.transpose().square_plus(h.plus_transpose()) * 0.5
    }

    /// The square of the transverse stretch, less one.
    #[inline(always)]
    pub fn transverse_finger_less_one(&self) -> R {
        self.transverse * (self.transverse + 2.0)
    }

    /// J − 1 of all directions together; −1 or less where the point is crushed or turned inside out.
    #[inline(always)]
    pub fn volume_change(&self) -> R {
        let plane = self.displacement_gradient.determinant_less_one();
        if D == 3 {
            return plane;
        }
        let transverse = self.transverse_change();
        plane.mul_add(transverse, plane + transverse)
    }

    /// What J − 1 has beyond the sum of the strains, that is, its part of second and higher order.
    #[inline(always)]
    pub fn volume_change_beyond_trace(&self) -> R {
        let h = self.displacement_gradient;
        let squared = match D {
            1 => self.transverse * self.transverse,
            _ => R::splat(0.0),
        };
        let product = h.determinant_less_one() * self.transverse_change();
        h.determinant_beyond_trace() + squared + product
    }

    /// The product of the transverse stretches, less one.
    #[inline(always)]
    fn transverse_change(&self) -> R {
        match D {
            1 => self.transverse_finger_less_one(),
            2 => self.transverse,
            _ => R::splat(0.0),
        }
    }
}
