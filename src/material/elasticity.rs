//! The two constants of isotropic elasticity.

use super::Plane;
use crate::input::{Bound, Parameters, Reader, Unit};

/// Young's modulus and Poisson's ratio, which the laws of this module have in common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Isotropic {
    youngs_modulus: f64,
    poissons_ratio: f64,
    // of the two above; laws ask for them point by point
    lambda: f64,
    mu: f64,
}

impl Parameters for Isotropic {
    fn read(reader: &mut Reader<'_>) -> Option<Self> {
        let youngs_modulus = reader.required("youngs_modulus", Unit::PRESSURE, Bound::Positive);
        let poissons_ratio = reader.required("poissons_ratio", Unit::NONE, Bound::Open(-1.0, 0.5));
        Some(Self::new(youngs_modulus?, poissons_ratio?))
    }
}

impl Isotropic {
    /// E > 0, Pa, and −1 < ν < 1/2. At 1/2 the material is incompressible, which no explicit method can follow.
    pub const fn new(youngs_modulus: f64, poissons_ratio: f64) -> Self {
        let (e, nu) = (youngs_modulus, poissons_ratio);
        Self {
            youngs_modulus,
            poissons_ratio,
            lambda: e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)),
            mu: e / (2.0 * (1.0 + nu)),
        }
    }

    /// E, Pa.
    pub fn youngs_modulus(&self) -> f64 {
        self.youngs_modulus
    }

    /// ν.
    pub fn poissons_ratio(&self) -> f64 {
        self.poissons_ratio
    }

    /// Lamé's constants λ = E ν / ((1 + ν)(1 − 2ν)) and μ = E / (2 (1 + ν)), Pa; computed once, so that a law may ask for
    /// them at every point.
    #[inline(always)]
    pub fn lame(&self) -> (f64, f64) {
        (self.lambda, self.mu)
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
