//! Constitutive laws. A law knows one material point: no grid, no neighbours, no loop.
//!
//! The stress that laws return and the solver stores is the **Kirchhoff stress** τ = J σ, so that a point's internal force
//! needs its initial volume only: V σ = V₀ τ. Tension is positive.

mod deformation;
mod elasticity;
mod hyperelastic;
mod points;
#[cfg(test)]
mod tests;

pub use deformation::Deformation;
pub use elasticity::Isotropic;
pub use hyperelastic::Hyperelastic;
pub use points::{Increments, MaterialPoints, Present, StressMut};

use crate::input::{Parameters, Reader};
use crate::math::Matrix;
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
pub struct Kinematics<const D: usize> {
    /// Velocity gradient L = ∂v_i/∂x_j in the modelled directions, 1/s, x as it was at the start of the step: the step maps
    /// dx to (I + Δt L) dx.
    pub rate: Matrix<D>,
    /// Stretch rate of the hoop direction, v_r/r at the start of the step, 1/s; 0 unless axisymmetric.
    pub hoop_rate: f64,
    /// Stretch of the hoop direction after the step; 1 unless axisymmetric.
    pub hoop_stretch: f64,
    /// Duration of the step, s.
    pub dt: f64,
}

/// Kirchhoff stress of one point, Pa.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stress<const D: usize> {
    /// The modelled directions, symmetric.
    pub plane: Matrix<D>,
    /// Each direction that is not modelled (out of plane, hoop). Kept from step to step in an axisymmetric scene only.
    pub transverse: f64,
}

impl<const D: usize> Stress<D> {
    /// No stress.
    pub fn zero() -> Self {
        Self {
            plane: Matrix::zeros(),
            transverse: 0.0,
        }
    }

    /// The stress of a point that a law has no answer for; the health check at the end of a step finds it.
    #[cold]
    pub(crate) fn undefined() -> Self {
        Self {
            plane: Matrix::from_element(f64::NAN),
            transverse: f64::NAN,
        }
    }
}

/// A constitutive law for points of a `D`-dimensional scene, its plane already chosen.
pub trait Material<const D: usize>: Clone + Send + Sync + 'static {
    /// What a point remembers from step to step besides its stress: `()`, F, J, hardening …
    type Memory: Copy + Send + Sync + Debug + 'static;

    /// The memory of an undeformed point.
    fn initial_memory(&self) -> Self::Memory;

    /// Carries memory and stress of one point over one step. A point that cannot be (J ≤ 0) gets a stress of NaN.
    fn update_stress(
        &self,
        memory: &mut Self::Memory,
        stress: &mut Stress<D>,
        step: &Kinematics<D>,
    );

    /// Elastic energy stored in the point per initial volume, J/m³.
    fn energy(&self, memory: &Self::Memory, stress: &Stress<D>, hoop_stretch: f64) -> f64;

    /// J = current volume / initial volume of the point, out-of-plane stretch included.
    fn volume_ratio(&self, memory: &Self::Memory, hoop_stretch: f64) -> f64;

    /// ρ₀ c² of the fastest elastic wave in the point's present state, Pa: an upper estimate, over all directions n in the
    /// modelled space, of the largest eigenvalue of the acoustic tensor Q(n) in the current configuration times J.
    ///
    /// Q(n) m = (δτ − τ Lᵀ) n, where δτ is the change of stress that the velocity gradient L = m ⊗ n makes in unit time:
    /// P = τ F⁻ᵀ, so that δP Fᵀ = δτ − τ Lᵀ. Zero-order terms of an axisymmetric scene (v_r/r) are no part of it.
    fn stiffness(&self, memory: &Self::Memory, stress: &Stress<D>, hoop_stretch: f64) -> f64;

    /// What the numbers that [`Self::memory_values`] gives are called.
    fn memory_names(&self) -> Vec<String>;

    /// What a point remembers, for people to look at.
    fn memory_values(&self, memory: &Self::Memory, values: &mut Vec<f64>);

    /// Every bit that a point remembers, for comparing two states exactly.
    fn memory_bits(&self, memory: &Self::Memory, bits: &mut Vec<u64>);
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

            /// The memory of `count` undeformed points of this law. `plane` says nothing in 3D.
            pub fn points<const D: usize>(&self, plane: Plane, count: usize) -> Box<dyn MaterialPoints<D>> {
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

materials! {
    "linear_elastic" => linear_elastic::LinearElastic,
    "neo_hookean" => neo_hookean::NeoHookean,
    "st_venant_kirchhoff" => st_venant_kirchhoff::StVenantKirchhoff,
    "hencky" => hencky::Hencky,
}
