//! How velocities travel between particles and grid.
//!
//! A transfer knows one velocity component of one particle. Loops, weights and storage belong to the solver.

use crate::input::{Parameters, Reader};

/// What a transfer makes of the velocities that the grid offers to one particle.
pub trait Transfer: Copy + Send + Sync + 'static {
    /// Whether particles carry an affine velocity field (the matrix C of APIC).
    const AFFINE: bool;
    /// Whether the *change* of the grid velocity is used, so that forces and momenta need separate storage on the grid.
    const CHANGE: bool;

    /// The share of the particle's own velocity that survives, between 0 (PIC, APIC) and 1 (FLIP).
    fn ratio(&self) -> f64;

    /// A velocity component after the step, from the `old` one, the grid's velocity `new` and the grid's `change` at the particle.
    fn velocity(&self, old: f64, new: f64, change: f64) -> f64;
}

/// Something to be done with a transfer whose type is not known before the run.
pub trait TransferVisitor {
    /// What comes out.
    type Output;
    /// Does it.
    fn visit<T: Transfer>(self, transfer: T) -> Self::Output;
}

macro_rules! transfers {
    ($($name:literal => $module:ident::$transfer:ident),* $(,)?) => {
        $(mod $module; pub use $module::$transfer;)*

        /// Every transfer, by its name in a scenario.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub enum TransferChoice { $(#[doc = concat!("`", $name, "`")] $transfer($transfer)),* }

        impl TransferChoice {
            /// All names.
            pub const NAMES: &'static [&'static str] = &[$($name),*];

            /// Its name in a scenario.
            pub fn name(&self) -> &'static str { match self { $(Self::$transfer(_) => $name),* } }

            /// Reads the transfer called `name` with its parameters.
            pub fn read(name: &str, reader: &mut Reader<'_>) -> Option<Self> {
                match name { $($name => $transfer::read(reader).map(Self::$transfer),)* _ => None }
            }

            /// Whether points carry an affine velocity field.
            pub fn is_affine(&self) -> bool { match self { $(Self::$transfer(_) => $transfer::AFFINE),* } }

            /// Calls the visitor with the transfer.
            pub fn visit<V: TransferVisitor>(&self, visitor: V) -> V::Output {
                match self { $(Self::$transfer(transfer) => visitor.visit(*transfer)),* }
            }
        }
    };
}

transfers! {
    "pic" => pic::Pic,
    "flip" => flip::Flip,
    "apic" => apic::Apic,
}
