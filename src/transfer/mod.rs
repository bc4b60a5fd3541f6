//! How velocities travel between particles and grid.
//!
//! A transfer knows one velocity component of one particle. Loops, weights and storage belong to the solver.

use crate::input::{Parameters, Reader};
use crate::real::Real;

/// What a transfer makes of the velocities that the grid offers to one particle.
pub trait Transfer: Copy + Send + Sync + 'static {
    /// Whether particles carry an affine velocity field (the matrix C of APIC).
    const AFFINE: bool;
    /// Whether the *change* of the grid velocity is used, so that forces and momenta need separate storage on the grid.
    const CHANGE: bool;

    /// Whether C is the velocity gradient as well: forces and strains by moving least squares instead of the slopes of the basis.
    const MOVING_LEAST_SQUARES: bool = false;

    /// Whether C is the velocity gradient by the slopes of the basis.
    const TAYLOR: bool = false;

    /// The share of the particle's own velocity that survives, between 0 (PIC, APIC) and 1 (FLIP).
    fn ratio(&self) -> f64;

    /// A velocity component after the step, from the `old` one, the grid's velocity `new` and the grid's `change` at the particle.
    /// Four points are computed together: write it without branches.
    fn velocity<R: Real>(&self, old: R, new: R, change: R) -> R;
}

/// What a scenario can choose: what is done to the velocities of the grid, then what each point makes of them.
///
/// A [`Transfer`] is such a method by itself, which takes the velocities of the grid as they are.
pub trait Method: Parameters {
    /// What each point does. Methods that share it share its compiled kernels.
    type Point: Transfer;

    /// What each point does, with its parameters.
    fn point(&self) -> Self::Point;

    /// How many terms of the series Σ_j (I − S⁺S)^j v make the velocities that points take from the velocities v of the grid; the
    /// first of them is v itself.
    ///
    /// S brings velocities from the grid to points, (S v)_p = Σ_i N_i v_i, and S⁺ those of points to the grid by momenta and lumped
    /// masses, (S⁺ V)_i = Σ_p N_i m_p V_p / m_i.
    fn terms(&self) -> u32;
}

impl<T: Transfer + Parameters> Method for T {
    type Point = T;

    fn point(&self) -> T {
        *self
    }

    fn terms(&self) -> u32 {
        1
    }
}

/// Something to be done with a transfer whose type is not known before the run.
pub trait TransferVisitor {
    /// What comes out.
    type Output;
    /// Does it.
    fn visit<T: Transfer>(self, transfer: T) -> Self::Output;
}

macro_rules! transfers {
    ($($name:literal $(($parameter:literal))? => $module:ident::$transfer:ident),* $(,)?) => {
        $(mod $module; pub use $module::$transfer;)*

        /// Every transfer, by its name in a scenario.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub enum TransferChoice { $(#[doc = concat!("`", $name, "`")] $transfer($transfer)),* }

        impl TransferChoice {
            /// All names.
            pub const NAMES: &'static [&'static str] = &[$($name),*];

            /// The one parameter of the transfer called `name`, if it has any.
            pub fn parameter(name: &str) -> Option<&'static str> {
                match name { $($($name => Some($parameter),)?)* _ => None }
            }

            /// Its name in a scenario.
            pub fn name(&self) -> &'static str { match self { $(Self::$transfer(_) => $name),* } }

            /// Reads the transfer called `name` with its parameters.
            pub fn read(name: &str, reader: &mut Reader<'_>) -> Option<Self> {
                match name { $($name => $transfer::read(reader).map(Self::$transfer),)* _ => None }
            }

            /// Whether points carry an affine velocity field.
            pub fn is_affine(&self) -> bool {
                match self { $(Self::$transfer(_) => <$transfer as Method>::Point::AFFINE),* }
            }

            /// See [`Method::terms`].
            pub fn terms(&self) -> u32 { match self { $(Self::$transfer(method) => method.terms()),* } }

            /// Calls the visitor with what each point does.
            pub fn visit<V: TransferVisitor>(&self, visitor: V) -> V::Output {
                match self { $(Self::$transfer(transfer) => visitor.visit(transfer.point())),* }
            }
        }
    };
}

transfers! {
    "pic" => pic::Pic,
    "flip"("ratio") => flip::Flip,
    "apic" => apic::Apic,
    "mls_apic" => mls_apic::MlsApic,
    "tpic" => tpic::Tpic,
    "fmpm"("order") => fmpm::Fmpm,
}
