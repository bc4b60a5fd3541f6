//! Laws whose stress follows from the deformation alone, and what turns such a law into a material: keeping F, and finding
//! the stretch of directions that carry no stress.

use super::points::Points;
use super::{Deformation, Isotropic, Kinematics, Law, Material, MaterialPoints, Plane, Stress};
use crate::input::Parameters;
use crate::real::{Mask, Real};
use crate::tensor::Tensor;
use std::fmt::Debug;

/// A law with a stored energy W(F) per initial volume: three short functions of one deformation, for J > 0. What they give
/// elsewhere is thrown away; they only have to come back.
pub trait Hyperelastic: Parameters + Clone + Debug + PartialEq + Send + Sync + 'static {
    /// The constants that the law has at small strain.
    fn elasticity(&self) -> Isotropic;

    /// Kirchhoff stress τ = (∂W/∂F) Fᵀ, Pa. Written as for one point and run for four at once, under the conditions of
    /// [`Material::update_stress`].
    fn stress<R: Real, const D: usize>(&self, deformation: &Deformation<R, D>) -> Stress<R, D>;

    /// W, J/m³.
    fn energy<const D: usize>(&self, deformation: &Deformation<f64, D>) -> f64;

    /// An upper estimate of ρ₀ c², Pa, see [`Material::stiffness`], which is run for four points at once as well. With
    /// [`Plane::Stress`] the directions that are not modelled give way, otherwise they are held.
    fn stiffness<R: Real, const D: usize>(
        &self,
        deformation: &Deformation<R, D>,
        plane: Plane,
    ) -> R;

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

/// F ← (I + Δt L) F, written for H = F − I: H ← H + Δt (L + L H).
#[inline(always)]
fn advance<R: Real, const D: usize>(h: &Tensor<R, D>, step: &Kinematics<R, D>) -> Tensor<R, D> {
    let l = step.rate;
    l.times_plus(h, l).scaled_plus(step.dt, *h)
}

/// The stiffness of a law; NaN where the point is turned inside out, which a function of b or of E does not see.
#[inline(always)]
fn stiffness<L: Hyperelastic, R: Real, const D: usize>(
    law: &L,
    deformation: &Deformation<R, D>,
    plane: Plane,
) -> R {
    let possible = deformation.volume_change().greater(R::splat(-1.0));
    R::select(
        possible,
        law.stiffness(deformation, plane),
        R::splat(f64::NAN),
    )
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
fn gradient_values<const D: usize>(h: &Tensor<f64, D>, values: &mut Vec<f64>) {
    let f = h.plus_diagonal(1.0);
    values.extend((0..D).flat_map(|i| (0..D).map(move |j| f[(i, j)])));
}

/// A law in 3D, or with transverse directions whose stretch is given: 1 in plane and uniaxial strain, the hoop stretch in an
/// axisymmetric scene. Remembers H = F − I.
#[derive(Clone)]
struct Held<L> {
    law: L,
}

#[inline(always)]
fn held<R: Real, const D: usize>(h: &Tensor<R, D>, hoop_stretch: R) -> Deformation<R, D> {
    Deformation {
        displacement_gradient: *h,
        transverse: hoop_stretch - 1.0,
    }
}

impl<L: Hyperelastic> Held<L> {
    /// The stress at the end of a step.
    #[inline(always)]
    fn stress<R: Real, const D: usize>(
        &self,
        h: &Tensor<R, D>,
        step: &Kinematics<R, D>,
    ) -> Stress<R, D> {
        let deformation = held(h, step.hoop_stretch);
        let possible = deformation.volume_change().greater(R::splat(-1.0));
        self.law.stress(&deformation).defined_where(possible)
    }
}

impl<const D: usize, L: Hyperelastic> Material<D> for Held<L> {
    type Memory<R: Real> = Tensor<R, D>;

    fn initial_memory(&self) -> Tensor<f64, D> {
        Tensor::zero()
    }

    #[inline(always)]
    fn deformation_gradient<R: Real>(&self, h: &Tensor<R, D>) -> Option<Tensor<R, D>> {
        Some(h.plus_diagonal(R::splat(1.0)))
    }

    #[inline(always)]
    fn update_stress<R: Real>(
        &self,
        h: &mut Tensor<R, D>,
        stress: &mut Stress<R, D>,
        step: &Kinematics<R, D>,
    ) {
        *h = advance(h, step);
        *stress = self.stress(h, step);
    }

    #[inline(always)]
    fn update_stress_in_reference<R: Real>(
        &self,
        h: &mut Tensor<R, D>,
        stress: &mut Stress<R, D>,
        step: &Kinematics<R, D>,
        _: &Tensor<R, D>,
    ) {
        *h = step.rate.scaled_plus(step.dt, *h);
        *stress = self.stress(h, step);
    }

    #[inline]
    fn energy(&self, h: &Tensor<f64, D>, _: &Stress<f64, D>, hoop_stretch: f64) -> f64 {
        self.law.energy(&held(h, hoop_stretch))
    }

    #[inline]
    fn volume_ratio(&self, h: &Tensor<f64, D>, hoop_stretch: f64) -> f64 {
        1.0 + held(h, hoop_stretch).volume_change()
    }

    #[inline(always)]
    fn stiffness<R: Real>(&self, h: &Tensor<R, D>, _: &Stress<R, D>, hoop_stretch: R) -> R {
        stiffness(&self.law, &held(h, hoop_stretch), Plane::Strain)
    }

    fn memory_names(&self) -> Vec<String> {
        gradient_names::<D>()
    }

    fn memory_values(&self, h: &Tensor<f64, D>, values: &mut Vec<f64>) {
        gradient_values(h, values);
    }
}

/// A law in 1D or 2D whose transverse directions carry no stress. Remembers the whole deformation.
#[derive(Clone)]
struct Free<L> {
    law: L,
}

impl<const D: usize, L: Hyperelastic> Material<D> for Free<L> {
    type Memory<R: Real> = Deformation<R, D>;

    fn initial_memory(&self) -> Deformation<f64, D> {
        held(&Tensor::zero(), 1.0)
    }

    #[inline(always)]
    fn deformation_gradient<R: Real>(&self, memory: &Deformation<R, D>) -> Option<Tensor<R, D>> {
        Some(memory.gradient())
    }

    #[inline(always)]
    fn update_stress<R: Real>(
        &self,
        memory: &mut Deformation<R, D>,
        stress: &mut Stress<R, D>,
        step: &Kinematics<R, D>,
    ) {
        memory.displacement_gradient = advance(&memory.displacement_gradient, step);
        *stress = relax(&self.law, memory);
    }

    #[inline(always)]
    fn update_stress_in_reference<R: Real>(
        &self,
        memory: &mut Deformation<R, D>,
        stress: &mut Stress<R, D>,
        step: &Kinematics<R, D>,
        _: &Tensor<R, D>,
    ) {
        let h = &mut memory.displacement_gradient;
        *h = step.rate.scaled_plus(step.dt, *h);
        *stress = relax(&self.law, memory);
    }

    #[inline]
    fn energy(&self, memory: &Deformation<f64, D>, _: &Stress<f64, D>, _: f64) -> f64 {
        self.law.energy(memory)
    }

    #[inline]
    fn volume_ratio(&self, memory: &Deformation<f64, D>, _: f64) -> f64 {
        1.0 + memory.volume_change()
    }

    #[inline(always)]
    fn stiffness<R: Real>(&self, memory: &Deformation<R, D>, _: &Stress<R, D>, _: R) -> R {
        stiffness(&self.law, memory, Plane::Stress)
    }

    fn memory_names(&self) -> Vec<String> {
        let mut names = gradient_names::<D>();
        names.push("transverse_stretch".to_owned());
        names
    }

    fn memory_values(&self, memory: &Deformation<f64, D>, values: &mut Vec<f64>) {
        gradient_values(&memory.displacement_gradient, values);
        values.push(1.0 + memory.transverse);
    }
}

/// Finds the transverse stretch at which the transverse stress vanishes, starting from the one in `deformation`, and the
/// stress there. Where there is none between 1/1000 and 1000, both are NaN.
///
/// Secant steps in the logarithm of the stretch, the first with the slope of small strain, kept inside the bracket as soon
/// as both of its ends are known. The search ends when a step is lost in round-off. Each of four points ends its own search:
/// the others leave it alone from then on.
#[inline(always)]
fn relax<R: Real, const D: usize, L: Hyperelastic>(
    law: &L,
    deformation: &mut Deformation<R, D>,
) -> Stress<R, D> {
    const FARTHEST: f64 = 6.9; // ln 1000
    let (lambda, mu) = law.elasticity().lame();
    let compliance = R::splat(1.0 / (Deformation::<R, D>::TRANSVERSE * lambda + 2.0 * mu));
    let (zero, one, farthest) = (R::splat(0.0), R::splat(1.0), R::splat(FARTHEST));
    let plane = deformation.displacement_gradient.determinant_less_one();
    let mut y = deformation.transverse.ln_1p();
    let mut stress = law.stress(deformation);
    let (mut lower, mut upper) = (-farthest, farthest);
    let mut inverse_slope = compliance;
    let mut found = one.greater(zero);
    // a point that is not a number has been searched for
    let mut searching = stress.transverse.abs().greater(zero) & plane.greater(-one);
    for _ in 0..100 {
        if !searching.any() {
            break;
        }
        let residual = stress.transverse;
        let above = residual.greater(zero);
        upper = R::select(above, y, upper);
        lower = R::select(above, lower, y);
        let wish = residual * inverse_slope;
        let wish = R::select(wish.abs().greater(one), one.copysign(wish), wish);
        let mut next = y - wish;
        searching = searching & (next.less(y) | next.greater(y));
        let near = next.abs().less(farthest);
        found = found & (near | !searching); // where not there is no such stretch
        searching = searching & near;
        // y is one end of the bracket and the step leads away from it; the other end, if known, must not be passed
        let passed = next.at_most(lower) | upper.at_most(next);
        next = R::select(passed, (lower + upper) * 0.5, next);
        let step = next - y;
        let small = step.abs().at_most(next.abs() * (4.0 * f64::EPSILON));
        let trial = Deformation {
            transverse: next.exp_m1(),
            ..*deformation
        };
        let trial_stress = law.stress(&trial);
        let worse = residual.abs().at_most(trial_stress.transverse.abs());
        // round-off is all that is left
        searching = searching & !(worse & step.abs().less(R::splat(1e-10)));
        y = R::select(searching, next, y);
        deformation.transverse = R::select(searching, trial.transverse, deformation.transverse);
        stress = Stress::select(searching, trial_stress, stress);
        let slope = step / (trial_stress.transverse - residual);
        inverse_slope = R::select(slope.greater(zero), slope, compliance);
        searching = searching & !small & stress.transverse.abs().greater(zero);
    }
    let number = stress.transverse.abs().at_most(R::splat(f64::INFINITY));
    let found = found & number & plane.greater(-one);
    deformation.transverse = R::select(found, deformation.transverse, R::splat(f64::NAN));
    stress.transverse = zero;
    stress.defined_where(found)
}
