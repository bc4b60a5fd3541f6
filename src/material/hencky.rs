//! Hencky's solid: Hooke's law between logarithmic strain and Kirchhoff stress.

use super::{Deformation, Hyperelastic, Isotropic, Plane, Stress};
use crate::input::{Parameters, Reader};
use crate::real::Real;
use crate::tensor::Tensor;

/// W = μ |ln V|² + λ/2 (ln J)² and so τ = 2μ ln V + λ ln J I, with V² = b.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hencky {
    /// Elastic constants.
    pub elasticity: Isotropic,
}

impl Parameters for Hencky {
    fn read(reader: &mut Reader<'_>) -> Option<Self> {
        Isotropic::read(reader).map(|elasticity| Self { elasticity })
    }
}

/// Principal logarithmic strains in the modelled directions with their directions, the transverse one, and ln J.
#[inline(always)]
fn logarithmic_strain<R: Real, const D: usize>(
    deformation: &Deformation<R, D>,
) -> ([R; D], Tensor<R, D>, R, R) {
    let (finger_less_one, directions) = deformation.finger_less_one().symmetric_eigen();
    let mut strains = finger_less_one;
    let transverse = deformation.transverse.ln_1p();
    let mut volume = transverse * Deformation::<R, D>::TRANSVERSE;
    for k in 0..D {
        strains[k] = finger_less_one[k].ln_1p() * 0.5;
        volume = volume + strains[k];
    }
    (strains, directions, transverse, volume)
}

impl Hyperelastic for Hencky {
    fn elasticity(&self) -> Isotropic {
        self.elasticity
    }

    #[inline(always)]
    fn stress<R: Real, const D: usize>(&self, deformation: &Deformation<R, D>) -> Stress<R, D> {
        let (lambda, mu) = self.elasticity.lame();
        let (strains, directions, transverse, volume) = logarithmic_strain(deformation);
        let pressure = volume * lambda;
        let mut principal = strains;
        for k in 0..D {
            principal[k] = strains[k] * (2.0 * mu) + pressure;
        }
        Stress {
            plane: Tensor::from_eigen(&principal, &directions),
            transverse: transverse * (2.0 * mu) + pressure,
        }
    }

    #[inline]
    fn energy<const D: usize>(&self, deformation: &Deformation<f64, D>) -> f64 {
        let (lambda, mu) = self.elasticity.lame();
        let (strains, _, transverse, volume) = logarithmic_strain(deformation);
        let squares = strains.iter().map(|strain| strain * strain).sum::<f64>()
            + Deformation::<f64, D>::TRANSVERSE * transverse * transverse;
        mu * squares + 0.5 * lambda * volume * volume
    }

    /// In principal directions, and with s_ik = (τ_i − τ_k)/(b_i − b_k) as the change of the directions of τ demands,
    ///
    /// Q_ii = (λ + 2μ − τ_i) n_i² + Σ_{k≠i} s_ik b_k n_k² and Q_ik = (λ + s_ik b_k − τ_k) n_i n_k.
    ///
    /// Taking (λ + μ) n ⊗ n out, whose largest eigenvalue is λ + μ, leaves m·Q m ≤ Σ_i m_i² (r n_i² + s (1 − n_i²)) ≤
    /// max(r, s), where r is Gershgorin's bound of the matrix with the diagonal μ − τ_i and the rest s_ik b_k − τ_k − μ, and
    /// s is the largest s_ik b_k. Free transverse directions replace λ by λ*, since τ is linear in ln V.
    #[inline(always)]
    fn stiffness<R: Real, const D: usize>(&self, deformation: &Deformation<R, D>, plane: Plane) -> R {
        let (lambda, mu) = self.elasticity.lame();
        let (strains, _, _, volume) = logarithmic_strain(deformation);
        let mut stress = strains;
        for i in 0..D {
            stress[i] = strains[i] * (2.0 * mu) + volume * lambda;
        }
        let mut bound = R::splat(f64::NEG_INFINITY);
        for i in 0..D {
            let mut row = -stress[i] + mu;
            for k in 0..D {
                if k != i {
                    // with ln b_i − ln b_k = x: s_ik b_k = μ x / (eˣ − 1)
                    let x = (strains[i] - strains[k]) * 2.0;
                    let alike = x.abs().at_most(R::splat(0.0));
                    let turning = R::select(alike, R::splat(mu), x * mu / x.exp_m1());
                    bound = bound.max(turning);
                    row = row + (turning - stress[k] - mu).abs();
                }
            }
            bound = bound.max(row);
        }
        bound + (self.elasticity.plane_lambda::<D>(plane) + mu)
    }

    #[cfg(test)]
    fn samples(elasticity: Isotropic) -> Vec<Self> {
        vec![Self { elasticity }]
    }
}
