//! Constitutive laws. A law knows one material point: no grid, no neighbours, no loop.
//!
//! The stress that laws return and the solver stores is the **Kirchhoff stress** τ = J σ, so that a point's internal force
//! needs its initial volume only: V σ = V₀ τ. Tension is positive.

use crate::input::{Parameters, Reader};
use crate::math::Matrix;

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
    /// Velocity gradient L = ∂v_i/∂x_j in the modelled directions, 1/s.
    pub rate: Matrix<D>,
    /// Stretch rate of the hoop direction (v_r/r), 1/s; 0 unless axisymmetric.
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
    /// The hoop direction; kept from step to step in an axisymmetric scene only.
    pub hoop: f64,
}

/// A constitutive law for points of a `D`-dimensional scene.
pub trait Material<const D: usize>: Clone + Send + Sync + 'static {
    /// What a point remembers from step to step besides its stress: `()`, F, J, hardening …
    type Memory: Copy + Send + Sync + std::fmt::Debug + 'static;

    /// The memory of an undeformed point.
    fn initial_memory(&self) -> Self::Memory;

    /// Carries memory and stress of one point over one step.
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

    /// ρ₀ c² of the fastest elastic wave in the point's present state, Pa: an upper estimate over all directions of the
    /// acoustic tensor in the current configuration times J.
    fn stiffness(&self, memory: &Self::Memory, stress: &Stress<D>, hoop_stretch: f64) -> f64;
}

mod points;
pub use points::MaterialPoints;

#[allow(unused_macros)]
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

            /// The memory of `count` undeformed points of this law.
            pub fn points<const D: usize>(&self, plane: Plane, count: usize) -> Box<dyn MaterialPoints<D>> {
                match self { $(Self::$law(law) => law.clone().points::<D>(plane, count)),* }
            }
        }
    };
}

// materials! { "neo_hookean" => neo_hookean::NeoHookean, }
/// Stub.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LawChoice {}
