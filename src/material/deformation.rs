//! The deformation of one point, all three directions of it.

use crate::math::{Matrix, determinant_beyond_trace, determinant_less_one};

/// How a point is deformed. What is kept is the difference from no deformation, so that strains of 1e-9 have all their
/// digits: 1 + 1e-9 has lost nine of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deformation<const D: usize> {
    /// H = F − I, the displacement gradient ∂u_i/∂X_j in the modelled directions.
    pub displacement_gradient: Matrix<D>,
    /// Stretch less one of each direction that is not modelled: two alike in 1D, one in 2D, none in 3D.
    pub transverse: f64,
}

impl<const D: usize> Deformation<D> {
    /// How many directions are not modelled.
    pub const TRANSVERSE: f64 = 3.0 - D as f64;

    /// F in the modelled directions.
    #[inline(always)]
    pub fn gradient(&self) -> Matrix<D> {
        Matrix::identity() + self.displacement_gradient
    }

    /// b − I = F Fᵀ − I in the modelled directions, twice the strain when it is small.
    #[inline(always)]
    pub fn finger_less_one(&self) -> Matrix<D> {
        let h = self.displacement_gradient;
        h + h.transpose() + h * h.transpose()
    }

    /// Green's strain E = (FᵀF − I)/2 in the modelled directions.
    #[inline(always)]
    pub fn green_strain(&self) -> Matrix<D> {
        let h = self.displacement_gradient;
        (h + h.transpose() + h.transpose() * h) * 0.5
    }

    /// The square of the transverse stretch, less one.
    #[inline(always)]
    pub fn transverse_finger_less_one(&self) -> f64 {
        self.transverse * (2.0 + self.transverse)
    }

    /// J − 1 of all directions together; −1 or less where the point is crushed or turned inside out.
    #[inline(always)]
    pub fn volume_change(&self) -> f64 {
        let plane = determinant_less_one(&self.displacement_gradient);
        let transverse = self.transverse_change();
        plane + transverse + plane * transverse
    }

    /// What J − 1 has beyond the sum of the strains, that is, its part of second and higher order.
    #[inline(always)]
    pub fn volume_change_beyond_trace(&self) -> f64 {
        let squared = match D {
            1 => self.transverse * self.transverse,
            _ => 0.0,
        };
        let product = determinant_less_one(&self.displacement_gradient) * self.transverse_change();
        determinant_beyond_trace(&self.displacement_gradient) + squared + product
    }

    /// The product of the transverse stretches, less one.
    #[inline(always)]
    fn transverse_change(&self) -> f64 {
        match D {
            1 => self.transverse_finger_less_one(),
            2 => self.transverse,
            _ => 0.0,
        }
    }
}
