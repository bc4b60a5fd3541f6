//! Hooke's law in rate form, the law of the classical Material Point Method.
//!
//! Right at small strain and any rotation. At large strain the stress oscillates in shear and closed cycles are not free: use
//! a hyperelastic law there.

use super::points::Points;
use super::{Isotropic, Kinematics, Law, Material, MaterialPoints, Plane, Stress};
use crate::input::{Parameters, Reader};
use crate::real::Real;
use crate::tensor::Tensor;

/// Which stress the rate is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StressRate {
    /// `cauchy`: the true stress σ.
    Cauchy,
    /// `kirchhoff`: τ = J σ. With it the volume of a point drops out of its internal force, as in the classical algorithm,
    /// which never updates it.
    Kirchhoff,
}

/// Isotropic hypoelastic law with the Jaumann rate: σ̇ = λ tr D I + 2μ D + W σ − σ W, or the same for τ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearElastic {
    /// Elastic constants.
    pub elasticity: Isotropic,
    /// Which stress the rate is of.
    pub rate: StressRate,
}

impl Parameters for LinearElastic {
    fn read(reader: &mut Reader<'_>) -> Option<Self> {
        let elasticity = Isotropic::read(reader);
        let rate = match reader.choice("rate", &["cauchy", "kirchhoff"], Some("cauchy")) {
            Some("kirchhoff") => Some(StressRate::Kirchhoff),
            Some(_) => Some(StressRate::Cauchy),
            None => None,
        };
        Some(Self { elasticity: elasticity?, rate: rate? })
    }
}

impl Law for LinearElastic {
    fn points<const D: usize>(&self, plane: Plane, count: usize) -> Box<dyn MaterialPoints<D>> {
        let (lambda, mu) = self.elasticity.lame();
        let material = Hypoelastic {
            elasticity: self.elasticity,
            rate: self.rate,
            axisymmetric: plane == Plane::Axisymmetric,
            plane_lambda: self.elasticity.plane_lambda::<D>(plane),
            mu,
            transverse_ratio: self.elasticity.transverse_ratio::<D>(plane),
            held_share: match plane {
                Plane::Strain => lambda / (D as f64 * lambda + 2.0 * mu),
                _ => 0.0,
            },
        };
        Box::new(Points::new(material, count))
    }

    fn is_hyperelastic(&self) -> bool {
        false
    }

    #[cfg(test)]
    fn samples(elasticity: Isotropic) -> Vec<Self> {
        [StressRate::Cauchy, StressRate::Kirchhoff]
            .map(|rate| Self { elasticity, rate })
            .to_vec()
    }
}

/// [`LinearElastic`] in a given dimension and plane. Remembers J − 1.
#[derive(Clone)]
struct Hypoelastic {
    elasticity: Isotropic,
    rate: StressRate,
    axisymmetric: bool,
    /// λ, or λ* where the transverse directions are free, Pa.
    plane_lambda: f64,
    /// Pa.
    mu: f64,
    /// κ: a free transverse direction strains at −κ tr D.
    transverse_ratio: f64,
    /// A held transverse direction carries this share of the trace of the modelled stresses: its rate is λ tr D, theirs add
    /// up to (Dλ + 2μ) tr D, and rotation changes neither.
    held_share: f64,
}

impl<const D: usize> Material<D> for Hypoelastic {
    type Memory<R: Real> = R;

    fn initial_memory(&self) -> f64 {
        0.0
    }

    /// The increment of the classical algorithm, Δε = Δt sym(∇v): its work is what internal forces do on the grid. Half of the
    /// elastic increment, the rotation R = (I − Δt W/2)⁻¹ (I + Δt W/2), the other half: second order in Δt for a steady ∇v, and
    /// R is orthogonal, so that spin alone never changes the size of a stress.
    #[inline(always)]
    fn update_stress<R: Real>(
        &self,
        memory: &mut R,
        stress: &mut Stress<R, D>,
        step: &Kinematics<R, D>,
    ) {
        let one = R::splat(1.0);
        let l = step.rate.scaled(step.dt);
        let strain = l.plus_transpose() * 0.5;
        let hoop = step.hoop_rate * step.dt;

        // a transverse strain of −κ tr D multiplies lengths by 1 + side
        let side = hoop - strain.trace() * self.transverse_ratio;
        let sides = match D {
            1 => side * (side + 2.0),
            2 => side,
            _ => R::splat(0.0),
        };
        let plane = l.determinant_less_one();
        let change = plane.mul_add(sides, plane + sides);
        let old_ratio = *memory + 1.0;
        *memory = change.mul_add(old_ratio, *memory);
        let ratio = *memory + 1.0;
        let possible = ratio.greater(R::splat(0.0)) & side.greater(-one) & plane.greater(-one);

        let pressure = (strain.trace() + hoop) * self.plane_lambda;
        let half = (strain * self.mu).plus_diagonal(pressure * 0.5);
        let (before, after) = match self.rate {
            StressRate::Cauchy => (one / old_ratio, ratio),
            StressRate::Kirchhoff => (one, one),
        };
        let mut rotated = stress.plane.scaled_plus(before, half);
        if D > 1 {
            let half_spin = (l - l.transpose()) * 0.25;
            let identity = Tensor::identity();
            let rotation = (identity - half_spin).inverse() * (identity + half_spin);
            rotated = rotated.turned_by(&rotation);
        }
        stress.plane = (rotated + half).scaled(after);
        if self.axisymmetric {
            let increment = hoop.mul_add(R::splat(2.0 * self.mu), pressure);
            stress.transverse = stress.transverse.mul_add(before, increment) * after;
        }
        *stress = stress.defined_where(possible);
    }

    /// J/2 σ : C⁻¹ : σ = τ : C⁻¹ : τ / (2J) or τ : C⁻¹ : τ / 2, with all three normal stresses;
    /// C⁻¹ : τ = ((1 + ν) τ − ν tr τ I) / E.
    #[inline]
    fn energy(&self, memory: &f64, stress: &Stress<f64, D>, _: f64) -> f64 {
        let trace = stress.plane.trace();
        let sides = 3.0 - D as f64;
        let side = if self.axisymmetric {
            stress.transverse
        } else {
            self.held_share * trace
        };
        let squares = stress.plane.norm_squared() + sides * side * side;
        let trace = trace + sides * side;
        let nu = self.elasticity.poissons_ratio();
        let energy = ((1.0 + nu) * squares - nu * trace * trace)
            / (2.0 * self.elasticity.youngs_modulus());
        match self.rate {
            StressRate::Cauchy => energy / (1.0 + memory),
            StressRate::Kirchhoff => energy,
        }
    }

    #[inline]
    fn volume_ratio(&self, memory: &f64, _: f64) -> f64 {
        1.0 + memory
    }

    /// With M = λ* + 2μ, the spread s of the principal τ, and p the largest principal pressure −τ (or 0):
    ///
    /// - the Jaumann terms ½ [(n·τ n) I − n ⊗ τ n − τ + τ n ⊗ n] see the deviator only: at most ½ s, and their skew part ¼ s;
    /// - for the Kirchhoff rate −τ Lᵀ n = −τ n (m·n) remains: at most p + ¼ s;
    /// - for the Cauchy rate τ̇ = J σ̇ + τ tr L cancels that but for the share κ per free transverse direction.
    ///
    /// In 1D the spread is that to the transverse stress, so that a bar gets the same step in every dimension.
    #[inline(always)]
    fn stiffness<R: Real>(&self, memory: &R, stress: &Stress<R, D>, _: R) -> R {
        let modulus = self.plane_lambda + 2.0 * self.mu;
        let (modulus, share) = match self.rate {
            StressRate::Cauchy => (
                (*memory + 1.0) * modulus,
                self.transverse_ratio * (3.0 - D as f64),
            ),
            StressRate::Kirchhoff => (R::splat(modulus), 1.0),
        };
        let spread = match D {
            1 => (stress.plane[(0, 0)] * (1.0 - self.held_share)).abs(),
            _ => stress.plane.eigenvalue_spread(),
        };
        let sign = 1.0_f64.copysign(share); // κ < 0 where ν < 0: then tension counts
        let pressure = (stress.plane * -sign).largest_eigenvalue();
        let pressure = pressure.max(R::splat(0.0));
        modulus + spread * 0.75 + (pressure + spread * 0.25) * share.abs()
    }

    fn memory_names(&self) -> Vec<String> {
        vec!["volume_ratio".to_owned()]
    }

    fn memory_values(&self, memory: &f64, values: &mut Vec<f64>) {
        values.push(1.0 + memory);
    }
}
