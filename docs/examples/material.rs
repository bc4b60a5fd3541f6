//! Neo-Hookean solid whose pressure grows with J rather than with ln J: stiffer when it is blown up.

use super::{Deformation, Hyperelastic, Isotropic, Plane, Stress};
use crate::input::{Parameters, Reader};
use crate::real::Real;

/// W = μ/2 (tr b − 3) − μ ln J + λ/2 (J − 1)² and so τ = μ (b − I) + λ J (J − 1) I.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inflatable {
    /// Elastic constants at small strain.
    pub elasticity: Isotropic,
}

impl Parameters for Inflatable {
    fn read(reader: &mut Reader<'_>) -> Option<Self> {
        Isotropic::read(reader).map(|elasticity| Self { elasticity })
    }
}

impl Hyperelastic for Inflatable {
    fn elasticity(&self) -> Isotropic {
        self.elasticity
    }

    #[inline(always)]
    fn stress<R: Real, const D: usize>(&self, deformation: &Deformation<R, D>) -> Stress<R, D> {
        let (lambda, mu) = self.elasticity.lame();
        let change = deformation.volume_change(); // J − 1
        let pressure = (change + 1.0) * change * lambda;
        Stress {
            plane: (deformation.finger_less_one() * mu).plus_diagonal(pressure),
            transverse: deformation.transverse_finger_less_one() * mu + pressure,
        }
    }

    fn energy<const D: usize>(&self, deformation: &Deformation<f64, D>) -> f64 {
        let (lambda, mu) = self.elasticity.lame();
        let change = deformation.volume_change();
        let sides = Deformation::<f64, D>::TRANSVERSE * deformation.transverse_finger_less_one();
        let trace = deformation.finger_less_one().trace() + sides; // tr b − 3
        0.5 * mu * trace - mu * change.ln_1p() + 0.5 * lambda * change * change
    }

    /// δτ = μ (L b + b Lᵀ) + λ (2J² − J) tr L I with L = m ⊗ n, less τ Lᵀ, gives
    /// Q = μ (n·b n) I + (μ + λ J²) n ⊗ n. Free transverse directions make it softer, so the bound holds for them too.
    #[inline(always)]
    fn stiffness<R: Real, const D: usize>(&self, deformation: &Deformation<R, D>, _: Plane) -> R {
        let (lambda, mu) = self.elasticity.lame();
        let ratio = deformation.volume_change() + 1.0;
        let largest = deformation.finger_less_one().largest_eigenvalue() + 1.0;
        largest * mu + ratio * ratio * lambda + mu
    }
}
