//! Compressible neo-Hookean solid: rubber, and any elastic solid at moderate strain.

use super::{Deformation, Hyperelastic, Isotropic, Plane, Stress};
use crate::input::{Parameters, Reader};
use crate::math::excess_over_logarithm;
use crate::real::Real;

/// W = μ/2 (tr b − 3) − μ ln J + λ/2 (ln J)² and so τ = μ (b − I) + λ ln J I.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NeoHookean {
    /// Elastic constants at small strain.
    pub elasticity: Isotropic,
}

impl Parameters for NeoHookean {
    fn read(reader: &mut Reader<'_>) -> Option<Self> {
        Isotropic::read(reader).map(|elasticity| Self { elasticity })
    }
}

impl Hyperelastic for NeoHookean {
    fn elasticity(&self) -> Isotropic {
        self.elasticity
    }

    #[inline(always)]
    fn stress<R: Real, const D: usize>(&self, deformation: &Deformation<R, D>) -> Stress<R, D> {
        let (lambda, mu) = self.elasticity.lame();
        let pressure = deformation.volume_change().ln_1p() * lambda;
        Stress {
            plane: (deformation.finger_less_one() * mu).plus_diagonal(pressure),
            transverse: deformation.transverse_finger_less_one() * mu + pressure,
        }
    }

    /// tr b − 3 = 2 tr H + |H|² (and the same of the transverse stretches), so that W holds tr H − ln J. That is
    /// (J − 1 − ln J) − (J − 1 − tr H), both of second order: the terms of first order are cancelled on paper.
    #[inline]
    fn energy<const D: usize>(&self, deformation: &Deformation<f64, D>) -> f64 {
        let (lambda, mu) = self.elasticity.lame();
        let change = deformation.volume_change();
        let log_j = change.ln_1p();
        let squares = deformation.displacement_gradient.norm_squared()
            + Deformation::<f64, D>::TRANSVERSE * deformation.transverse * deformation.transverse;
        let shape = excess_over_logarithm(change) - deformation.volume_change_beyond_trace();
        mu * (shape + 0.5 * squares) + 0.5 * lambda * log_j * log_j
    }

    /// δτ = μ (L b + b Lᵀ) + λ tr L I with L = m ⊗ n gives Q = μ (n·b n) I + (μ + λ (1 − ln J)) n ⊗ n.
    ///
    /// Where the transverse stretches t are free, 2μ t² ε_t + λ (tr L + n ε_t) = 0 reduces the λ that multiplies tr L to
    /// λ · 2μt² / (2μt² + nλ), n being the number of free directions.
    #[inline(always)]
    fn stiffness<R: Real, const D: usize>(&self, deformation: &Deformation<R, D>, plane: Plane) -> R {
        let (lambda, mu) = self.elasticity.lame();
        let mut bulk = R::splat(lambda);
        if plane == Plane::Stress {
            let side = (deformation.transverse_finger_less_one() + 1.0) * (2.0 * mu);
            bulk = bulk * (side / (side + Deformation::<R, D>::TRANSVERSE * lambda));
        }
        let mut largest = deformation.finger_less_one().largest_eigenvalue();
        if D < 3 {
            // waves do not run that way, but 3D counts it too: the same scene gets the same step in every dimension
            largest = largest.max(deformation.transverse_finger_less_one());
        }
        let along = bulk - deformation.volume_change().ln_1p() * lambda + mu;
        // across n the second term is missing
        (largest + 1.0) * mu + along.max(R::splat(0.0))
    }

    #[cfg(test)]
    fn samples(elasticity: Isotropic) -> Vec<Self> {
        vec![Self { elasticity }]
    }
}
