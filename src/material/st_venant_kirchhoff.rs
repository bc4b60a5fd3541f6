//! St. Venant–Kirchhoff solid: Hooke's law between Green's strain and the second Piola stress. Good for large rotation at
//! small strain; it softens and then collapses under strong compression.

use super::{Deformation, Hyperelastic, Isotropic, Plane, Stress};
use crate::input::{Parameters, Reader};
use crate::real::Real;

/// W = λ/2 (tr E)² + μ E : E, S = λ tr E I + 2μ E and τ = F S Fᵀ.
///
/// Free transverse directions have E_t = −κ tr E (see [`Isotropic::transverse_ratio`]); at E_t = −1/2 the thickness would be
/// zero, and beyond that the law has no plane stress state: the stress is NaN.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StVenantKirchhoff {
    /// Elastic constants.
    pub elasticity: Isotropic,
}

impl Parameters for StVenantKirchhoff {
    fn read(reader: &mut Reader<'_>) -> Option<Self> {
        Isotropic::read(reader).map(|elasticity| Self { elasticity })
    }
}

impl Hyperelastic for StVenantKirchhoff {
    fn elasticity(&self) -> Isotropic {
        self.elasticity
    }

    #[inline(always)]
    fn stress<R: Real, const D: usize>(&self, deformation: &Deformation<R, D>) -> Stress<R, D> {
        let (lambda, mu) = self.elasticity.lame();
        let strain = deformation.green_strain();
        let transverse = deformation.transverse_finger_less_one() * 0.5;
        let sides = transverse * Deformation::<R, D>::TRANSVERSE;
        let pressure = (strain.trace() + sides) * lambda;
        let second_piola = (strain * (2.0 * mu)).plus_diagonal(pressure);
        let f = deformation.gradient();
        Stress {
            plane: second_piola.turned_by(&f),
            transverse: (transverse * 2.0 + 1.0) * (transverse * (2.0 * mu) + pressure),
        }
    }

    #[inline]
    fn energy<const D: usize>(&self, deformation: &Deformation<f64, D>) -> f64 {
        let (lambda, mu) = self.elasticity.lame();
        let strain = deformation.green_strain();
        let transverse = 0.5 * deformation.transverse_finger_less_one();
        let trace = strain.trace() + Deformation::<f64, D>::TRANSVERSE * transverse;
        let squares =
            strain.norm_squared() + Deformation::<f64, D>::TRANSVERSE * transverse * transverse;
        0.5 * lambda * trace * trace + mu * squares
    }

    /// δτ = L τ + τ Lᵀ + λ tr(b D) b + 2μ b D b with L = m ⊗ n gives
    /// Q = (n·τ n) I + (λ + μ) b n ⊗ b n + μ (n·b n) b, at most the largest principal τ plus (λ + 2μ) b².
    /// Free transverse directions replace λ by λ* (see [`Isotropic::plane_lambda`]) since S is linear in E.
    #[inline(always)]
    fn stiffness<R: Real, const D: usize>(&self, deformation: &Deformation<R, D>, plane: Plane) -> R {
        let (_, mu) = self.elasticity.lame();
        let modulus = self.elasticity.plane_lambda::<D>(plane) + 2.0 * mu;
        let largest = deformation.finger_less_one().largest_eigenvalue() + 1.0;
        let stress = self.stress(deformation).plane;
        stress.largest_eigenvalue() + largest * largest * modulus
    }

    #[cfg(test)]
    fn samples(elasticity: Isotropic) -> Vec<Self> {
        vec![Self { elasticity }]
    }
}
