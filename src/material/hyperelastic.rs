//! Laws whose stress follows from the deformation alone, and what turns such a law into a material: keeping F, and finding
//! the stretch of directions that carry no stress.

use super::points::Points;
use super::{Deformation, Isotropic, Kinematics, Law, Material, MaterialPoints, Plane, Stress};
use crate::input::Parameters;
use crate::math::{Matrix, determinant_less_one};
use std::fmt::Debug;

/// A law with a stored energy W(F) per initial volume: three short functions of one deformation, valid for J > 0.
pub trait Hyperelastic: Parameters + Clone + Debug + PartialEq + Send + Sync + 'static {
    /// The constants that the law has at small strain.
    fn elasticity(&self) -> Isotropic;

    /// Kirchhoff stress τ = (∂W/∂F) Fᵀ, Pa.
    fn stress<const D: usize>(&self, deformation: &Deformation<D>) -> Stress<D>;

    /// W, J/m³.
    fn energy<const D: usize>(&self, deformation: &Deformation<D>) -> f64;

    /// An upper estimate of ρ₀ c², Pa, see [`Material::stiffness`]. With [`Plane::Stress`] the directions that are not
    /// modelled give way, otherwise they are held.
    fn stiffness<const D: usize>(&self, deformation: &Deformation<D>, plane: Plane) -> f64;

    /// One law for each kind of behaviour that the parameters can select, for the tests that every law has to pass.
    #[cfg(test)]
    fn samples(elasticity: Isotropic) -> Vec<Self>;
}

impl<L: Hyperelastic> Law for L {
    fn points<const D: usize>(&self, plane: Plane, count: usize) -> Box<dyn MaterialPoints<D>> {
        let law = self.clone();
        match plane {
            Plane::Stress if D < 3 => Box::new(Points::new(Free { law }, count)),
            _ => Box::new(Points::new(Held { law }, count)),
        }
    }

    fn is_hyperelastic(&self) -> bool {
        true
    }

    #[cfg(test)]
    fn samples(elasticity: Isotropic) -> Vec<Self> {
        <L as Hyperelastic>::samples(elasticity)
    }
}

/// F ← (I + Δt L) F, written for H = F − I: H ← H + Δt L (I + H).
#[inline(always)]
fn advance<const D: usize>(h: &Matrix<D>, step: &Kinematics<D>) -> Matrix<D> {
    let l = step.rate * step.dt;
    h + l + l * h
}

/// The components of F by name, row by row.
fn gradient_names<const D: usize>() -> Vec<String> {
    let axis = ["x", "y", "z"];
    let pairs = (0..D).flat_map(|i| (0..D).map(move |j| (i, j)));
    pairs
        .map(|(i, j)| format!("deformation_gradient_{}{}", axis[i], axis[j]))
        .collect()
}

/// F from H, row by row.
fn gradient_values<const D: usize>(h: &Matrix<D>, values: &mut Vec<f64>) {
    let f = Matrix::identity() + h;
    values.extend((0..D).flat_map(|i| (0..D).map(move |j| f[(i, j)])));
}

/// A law in 3D, or with transverse directions whose stretch is given: 1 in plane and uniaxial strain, the hoop stretch in an
/// axisymmetric scene. Remembers H = F − I.
#[derive(Clone)]
struct Held<L> {
    law: L,
}

#[inline(always)]
fn held<const D: usize>(h: &Matrix<D>, hoop_stretch: f64) -> Deformation<D> {
    Deformation {
        displacement_gradient: *h,
        transverse: hoop_stretch - 1.0,
    }
}

impl<const D: usize, L: Hyperelastic> Material<D> for Held<L> {
    type Memory = Matrix<D>;

    fn initial_memory(&self) -> Matrix<D> {
        Matrix::zeros()
    }

    #[inline(always)]
    fn update_stress(&self, h: &mut Matrix<D>, stress: &mut Stress<D>, step: &Kinematics<D>) {
        *h = advance(h, step);
        let deformation = held(h, step.hoop_stretch);
        *stress = if deformation.volume_change() > -1.0 {
            self.law.stress(&deformation)
        } else {
            Stress::undefined()
        };
    }

    #[inline]
    fn energy(&self, h: &Matrix<D>, _: &Stress<D>, hoop_stretch: f64) -> f64 {
        self.law.energy(&held(h, hoop_stretch))
    }

    #[inline]
    fn volume_ratio(&self, h: &Matrix<D>, hoop_stretch: f64) -> f64 {
        1.0 + held(h, hoop_stretch).volume_change()
    }

    #[inline]
    fn stiffness(&self, h: &Matrix<D>, _: &Stress<D>, hoop_stretch: f64) -> f64 {
        self.law.stiffness(&held(h, hoop_stretch), Plane::Strain)
    }

    fn memory_names(&self) -> Vec<String> {
        gradient_names::<D>()
    }

    fn memory_values(&self, h: &Matrix<D>, values: &mut Vec<f64>) {
        gradient_values(h, values);
    }

    fn memory_bits(&self, h: &Matrix<D>, bits: &mut Vec<u64>) {
        bits.extend(h.iter().map(|x| x.to_bits()));
    }
}

/// A law in 1D or 2D whose transverse directions carry no stress. Remembers the whole deformation.
#[derive(Clone)]
struct Free<L> {
    law: L,
}

impl<const D: usize, L: Hyperelastic> Material<D> for Free<L> {
    type Memory = Deformation<D>;

    fn initial_memory(&self) -> Deformation<D> {
        held(&Matrix::zeros(), 1.0)
    }

    #[inline(always)]
    fn update_stress(
        &self,
        memory: &mut Deformation<D>,
        stress: &mut Stress<D>,
        step: &Kinematics<D>,
    ) {
        memory.displacement_gradient = advance(&memory.displacement_gradient, step);
        *stress = relax(&self.law, memory);
    }

    #[inline]
    fn energy(&self, memory: &Deformation<D>, _: &Stress<D>, _: f64) -> f64 {
        self.law.energy(memory)
    }

    #[inline]
    fn volume_ratio(&self, memory: &Deformation<D>, _: f64) -> f64 {
        1.0 + memory.volume_change()
    }

    #[inline]
    fn stiffness(&self, memory: &Deformation<D>, _: &Stress<D>, _: f64) -> f64 {
        self.law.stiffness(memory, Plane::Stress)
    }

    fn memory_names(&self) -> Vec<String> {
        let mut names = gradient_names::<D>();
        names.push("transverse_stretch".to_owned());
        names
    }

    fn memory_values(&self, memory: &Deformation<D>, values: &mut Vec<f64>) {
        gradient_values(&memory.displacement_gradient, values);
        values.push(1.0 + memory.transverse);
    }

    fn memory_bits(&self, memory: &Deformation<D>, bits: &mut Vec<u64>) {
        bits.extend(memory.displacement_gradient.iter().map(|x| x.to_bits()));
        bits.push(memory.transverse.to_bits());
    }
}

/// Finds the transverse stretch at which the transverse stress vanishes, starting from the one in `deformation`, and the
/// stress there. Where there is none between 1/1000 and 1000, both are NaN.
///
/// Secant steps in the logarithm of the stretch, the first with the slope of small strain, kept inside the bracket as soon
/// as both of its ends are known. The search ends when a step is lost in round-off.
fn relax<const D: usize, L: Hyperelastic>(law: &L, deformation: &mut Deformation<D>) -> Stress<D> {
    const FARTHEST: f64 = 6.9; // ln 1000
    let (lambda, mu) = law.elasticity().lame();
    let compliance = 1.0 / (Deformation::<D>::TRANSVERSE * lambda + 2.0 * mu);
    let crushed = determinant_less_one(&deformation.displacement_gradient) <= -1.0;
    let mut y = deformation.transverse.ln_1p();
    let mut stress = law.stress(deformation);
    let (mut lower, mut upper) = (-FARTHEST, FARTHEST);
    let mut inverse_slope = compliance;
    for _ in 0..100 {
        let residual = stress.transverse;
        if residual == 0.0 {
            break;
        }
        if residual > 0.0 {
            upper = y;
        } else {
            lower = y;
        }
        let mut next = y - (residual * inverse_slope).clamp(-1.0, 1.0);
        if next == y {
            break;
        }
        if next.abs() >= FARTHEST {
            y = f64::NAN; // no such stretch
            break;
        }
        // y is one end of the bracket and the step leads away from it; the other end, if known, must not be passed
        if next <= lower || next >= upper {
            next = 0.5 * (lower + upper);
        }
        let step = next - y;
        let small = step.abs() <= 4.0 * f64::EPSILON * next.abs();
        let trial = Deformation {
            transverse: next.exp_m1(),
            ..*deformation
        };
        let trial_stress = law.stress(&trial);
        let change = trial_stress.transverse - residual;
        let worse = trial_stress.transverse.abs() >= residual.abs();
        if worse && step.abs() < 1e-10 {
            break; // round-off is all that is left
        }
        y = next;
        *deformation = trial;
        stress = trial_stress;
        if small {
            break;
        }
        inverse_slope = if step / change > 0.0 {
            step / change
        } else {
            compliance
        };
    }
    if crushed || y.is_nan() || stress.transverse.is_nan() {
        deformation.transverse = f64::NAN;
        return Stress::undefined();
    }
    stress.transverse = 0.0;
    stress
}
