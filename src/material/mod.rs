//! Constitutive laws. A law knows one material point: no grid, no neighbours, no loop.
//!
//! The stress that laws return and the solver stores is the **Kirchhoff stress** τ = J σ, so that a point's internal force
//! needs its initial volume only: V σ = V₀ τ. Tension is positive.

mod deformation;
mod elasticity;
mod hyperelastic;
mod numbers;
mod points;
mod survey;
#[cfg(test)]
mod tests;
mod update;

pub use deformation::Deformation;
pub use elasticity::Isotropic;
pub use hyperelastic::Hyperelastic;
pub use linear_elastic::StressRate;
pub use numbers::{MOST, Numbers, one_by_one};
pub use points::{FourRates, Increments, MaterialPoints, Present, ReferenceMut, StressMut};

use crate::input::{Parameters, Reader};
use crate::real::{Mask, Real};
use crate::tensor::Tensor;
use std::any::Any;
use std::fmt::Debug;

/// What the directions that a 1D or 2D scene does not model are doing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Plane {
    /// They do not strain: plane strain in 2D, uniaxial strain in 1D.
    #[default]
    Strain,
    /// They carry no stress: plane stress in 2D, uniaxial stress (a bar) in 1D.
    Stress,
    /// 2D only: the scene is a half plane r ≥ 0 (x = r, y = z) turned around the axis r = 0.
    Axisymmetric,
}

/// How one point deforms over one step.
#[derive(Clone, Copy, Debug)]
pub struct Kinematics<R, const D: usize> {
    /// Velocity gradient L = ∂v_i/∂x_j in the modelled directions, 1/s, x as it was at the start of the step: the step maps
    /// dx to (I + Δt L) dx.
    pub rate: Tensor<R, D>,
    /// Stretch rate of the hoop direction, v_r/r at the start of the step, 1/s; 0 unless axisymmetric.
    pub hoop_rate: R,
    /// Stretch of the hoop direction after the step; 1 unless axisymmetric.
    pub hoop_stretch: R,
    /// Duration of the step, s; the same for all points.
    pub dt: R,
}

/// Kirchhoff stress of one point, Pa.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stress<R, const D: usize> {
    /// The modelled directions, symmetric.
    pub plane: Tensor<R, D>,
    /// Each direction that is not modelled (out of plane, hoop). Kept from step to step in an axisymmetric scene only.
    pub transverse: R,
}

impl<R: Real, const D: usize> Stress<R, D> {
    /// No stress.
    #[inline(always)]
    pub fn zero() -> Self {
        Self {
            plane: Tensor::zero(),
            transverse: R::splat(0.0),
        }
    }

    /// The stress of a point that a law has no answer for; the health check at the end of a step finds it.
    #[inline(always)]
    pub fn undefined() -> Self {
        Self {
            plane: Tensor::filled(f64::NAN),
            transverse: R::splat(f64::NAN),
        }
    }

    /// The same stress where the mask is set, [`Self::undefined`] elsewhere.
    #[inline(always)]
    pub fn defined_where(self, mask: R::Mask) -> Self {
        if mask.all() {
            return self;
        }
        Self::select(mask, self, Self::undefined())
    }

    /// `a` where the mask is set, `b` elsewhere.
    #[inline(always)]
    pub fn select(mask: R::Mask, a: Self, b: Self) -> Self {
        Self {
            plane: Tensor::select(mask, a.plane, b.plane),
            transverse: R::select(mask, a.transverse, b.transverse),
        }
    }
}

/// A constitutive law for points of a `D`-dimensional scene, its plane already chosen.
pub trait Material<const D: usize>: Clone + Send + Sync + 'static {
    /// What a point remembers from step to step besides its stress: `()`, F, J, hardening …
    type Memory<R: Real>: Numbers<R> + Debug;

    /// The memory of an undeformed point.
    fn initial_memory(&self) -> Self::Memory<f64>;

    /// F in the modelled directions, if the law remembers it: the total frame keeps one for the points of other laws only.
    #[inline(always)]
    fn deformation_gradient<R: Real>(&self, _: &Self::Memory<R>) -> Option<Tensor<R, D>> {
        None
    }

    /// Carries memory and stress of one point over one step. A point that cannot be (J ≤ 0) gets a stress of NaN.
    ///
    /// Written as for one point, it is run for four at once: branches become [`Real::select`], or go through [`one_by_one`].
    /// It has to be `#[inline(always)]`, and so has all that it calls with an `R` (see [`crate::real`]). What one point gets
    /// must not depend on the three others.
    fn update_stress<R: Real>(
        &self,
        memory: &mut Self::Memory<R>,
        stress: &mut Stress<R, D>,
        step: &Kinematics<R, D>,
    );

    /// [`Self::update_stress`] in the total frame: there the rate of `step` is Ḟ = ∂v/∂X, and `start` is F at the start of the step.
    /// So L = Ḟ F⁻¹, of which the law's own F ← (I + Δt L) F makes F + Δt Ḟ. Laws that remember F have it for less.
    #[inline(always)]
    fn update_stress_in_reference<R: Real>(
        &self,
        memory: &mut Self::Memory<R>,
        stress: &mut Stress<R, D>,
        step: &Kinematics<R, D>,
        start: &Tensor<R, D>,
    ) {
        let mut spatial = *step;
        spatial.rate = step.rate * start.inverse();
        self.update_stress(memory, stress, &spatial);
    }

    /// Elastic energy stored in the point per initial volume, J/m³.
    fn energy(&self, memory: &Self::Memory<f64>, stress: &Stress<f64, D>, hoop_stretch: f64)
    -> f64;

    /// J = current volume / initial volume of the point, out-of-plane stretch included.
    fn volume_ratio(&self, memory: &Self::Memory<f64>, hoop_stretch: f64) -> f64;

    /// ρ₀ c² of the fastest elastic wave in the point's present state, Pa: an upper estimate, over all directions n in the
    /// modelled space, of the largest eigenvalue of the acoustic tensor Q(n) in the current configuration times J.
    ///
    /// Q(n) m = (δτ − τ Lᵀ) n, where δτ is the change of stress that the velocity gradient L = m ⊗ n makes in unit time:
    /// P = τ F⁻ᵀ, so that δP Fᵀ = δτ − τ Lᵀ. Zero-order terms of an axisymmetric scene (v_r/r) are no part of it.
    ///
    /// Written as for one point and run for four at once, under the conditions of [`Self::update_stress`].
    fn stiffness<R: Real>(
        &self,
        memory: &Self::Memory<R>,
        stress: &Stress<R, D>,
        hoop_stretch: R,
    ) -> R;

    /// What the numbers that [`Self::memory_values`] gives are called.
    fn memory_names(&self) -> Vec<String>;

    /// What a point remembers, for people to look at.
    fn memory_values(&self, memory: &Self::Memory<f64>, values: &mut Vec<f64>);
}

/// What a scenario calls a law: parameters that become a [`Material`] once dimension and plane are known.
///
/// A [`Hyperelastic`] law is one without further ado.
pub trait Law: Parameters + Clone + Debug + PartialEq {
    /// The memory of `count` undeformed points of this law. `plane` says nothing in 3D.
    fn points<const D: usize>(&self, plane: Plane, count: usize) -> Box<dyn MaterialPoints<D>>;

    /// Whether stress and energy depend on the present deformation only, so that closed cycles cost nothing.
    fn is_hyperelastic(&self) -> bool;

    /// One law for each kind of behaviour that the parameters can select, for the tests that every law has to pass.
    #[cfg(test)]
    fn samples(elasticity: Isotropic) -> Vec<Self>;
}

macro_rules! materials {
    ($($name:literal => $module:ident::$law:ident),* $(,)?) => {
        $(mod $module; pub use $module::$law;)*

        /// Every law, by its name in a scenario.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub enum LawChoice { $(#[doc = concat!("`", $name, "`")] $law($law)),* }

        impl LawChoice {
            /// All names.
            pub const NAMES: &'static [&'static str] = &[$($name),*];

            /// Its name in a scenario.
            pub fn name(&self) -> &'static str { match self { $(Self::$law(_) => $name),* } }

            /// Reads the law called `name` with its parameters.
            pub fn read(name: &str, reader: &mut Reader<'_>) -> Option<Self> {
                match name { $($name => $law::read(reader).map(Self::$law),)* _ => None }
            }

            fn points_of<const D: usize>(&self, plane: Plane, count: usize) -> Box<dyn MaterialPoints<D>> {
                match self { $(Self::$law(law) => law.points::<D>(plane, count)),* }
            }

            /// Whether stress and energy depend on the present deformation only, so that closed cycles cost nothing.
            pub fn is_hyperelastic(&self) -> bool {
                match self { $(Self::$law(law) => law.is_hyperelastic()),* }
            }

            /// Every law, in every variant, with these elastic constants.
            #[cfg(test)]
            pub(crate) fn samples(elasticity: Isotropic) -> Vec<Self> {
                let mut samples = Vec::new();
                $(samples.extend(<$law as Law>::samples(elasticity).into_iter().map(Self::$law));)*
                samples
            }
        }
    };
}

impl LawChoice {
    /// The memory of `count` undeformed points of this law. `plane` says nothing in 3D.
    ///
    /// The three functions that it chooses from are not generic, so that all laws are compiled with this crate and not again
    /// with every program that makes points.
    pub fn points<const D: usize>(&self, plane: Plane, count: usize) -> Box<dyn MaterialPoints<D>> {
        let points: Box<dyn Any> = match D {
            1 => Box::new(self.points_1d(plane, count)),
            2 => Box::new(self.points_2d(plane, count)),
            _ => Box::new(self.points_3d(plane, count)),
        };
        match points.downcast() {
            Ok(points) => *points,
            Err(_) => unreachable!("a scene has 1, 2 or 3 dimensions"),
        }
    }

    fn points_1d(&self, plane: Plane, count: usize) -> Box<dyn MaterialPoints<1>> {
        self.points_of(plane, count)
    }

    fn points_2d(&self, plane: Plane, count: usize) -> Box<dyn MaterialPoints<2>> {
        self.points_of(plane, count)
    }

    fn points_3d(&self, plane: Plane, count: usize) -> Box<dyn MaterialPoints<3>> {
        self.points_of(plane, count)
    }
}

materials! {
    "linear_elastic" => linear_elastic::LinearElastic,
    "neo_hookean" => neo_hookean::NeoHookean,
    "st_venant_kirchhoff" => st_venant_kirchhoff::StVenantKirchhoff,
    "hencky" => hencky::Hencky,
}
