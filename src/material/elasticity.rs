//! The two constants of isotropic elasticity.

use super::Plane;
use crate::input::{Bound, Parameters, Reader, Unit};

/// Young's modulus and Poisson's ratio, which the laws of this module have in common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Isotropic {
    /// E > 0, Pa.
    pub youngs_modulus: f64,
    /// −1 < ν < 1/2. At 1/2 the material is incompressible, which no explicit method can follow.
    pub poissons_ratio: f64,
}

impl Parameters for Isotropic {
    fn read(reader: &mut Reader<'_>) -> Option<Self> {
        let youngs_modulus = reader.required("youngs_modulus", Unit::PRESSURE, Bound::Positive);
        let poissons_ratio = reader.required("poissons_ratio", Unit::NONE, Bound::Open(-1.0, 0.5));
        Some(Self {
            youngs_modulus: youngs_modulus?,
            poissons_ratio: poissons_ratio?,
        })
    }
}

impl Isotropic {
    /// Lamé's constants λ = E ν / ((1 + ν)(1 − 2ν)) and μ = E / (2 (1 + ν)), Pa.
    #[inline(always)]
    pub fn lame(&self) -> (f64, f64) {
        let (e, nu) = (self.youngs_modulus, self.poissons_ratio);
        (
            e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)),
            e / (2.0 * (1.0 + nu)),
        )
    }

    /// How much each direction that is not modelled shrinks, at small strain, per sum of the modelled strains.
    ///
    /// Free of stress, λ (tr ε + n ε_t) + 2μ ε_t = 0 with n = 3 − D gives ε_t = −κ tr ε, κ = λ / (nλ + 2μ).
    pub fn transverse_ratio<const D: usize>(&self, plane: Plane) -> f64 {
        let (lambda, mu) = self.lame();
        match plane {
            Plane::Stress if D < 3 => lambda / ((3 - D) as f64 * lambda + 2.0 * mu),
            _ => 0.0,
        }
    }

    /// The constant λ* that gives the modelled stresses at small strain, τ = λ* tr ε I + 2μ ε: λ (1 − nκ), Pa.
    pub fn plane_lambda<const D: usize>(&self, plane: Plane) -> f64 {
        let (lambda, _) = self.lame();
        lambda * (1.0 - (3 - D) as f64 * self.transverse_ratio::<D>(plane))
    }
}
