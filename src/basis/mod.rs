//! Shape functions of the background grid, one axis at a time.
//!
//! A basis knows one coordinate, measured in cells from the lower end of the grid. It knows no dimension, no particle and
//! no grid: the solver multiplies axes together.

use crate::input::{Parameters, Reader};

/// The functions that are not zero at one coordinate: `N` consecutive ones, starting at number `first`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis<const N: usize> {
    /// Number of the first function of the stencil, `0 ..= count - N`.
    pub first: i32,
    /// Values N_i(x); they sum to one.
    pub weight: [f64; N],
    /// Slopes dN_i/dx per cell; they sum to zero.
    pub slope: [f64; N],
    /// Arms x_i − x in cells, where x_i is the position of function i.
    pub arm: [f64; N],
}

/// A family of shape functions over `cells` cells of unit length, complete to first order on `0 ≤ x ≤ cells`:
/// `Σ N_i = 1` and `Σ N_i(x) position(i) = x` everywhere, the ends included.
pub trait Basis<const N: usize>: Copy + Send + Sync + 'static {
    /// The functions at `x` cells from the lower end, `0 ≤ x ≤ cells`.
    fn axis(&self, x: f64, cells: i32) -> Axis<N>;

    /// The same basis for points that are `spacing` cells apart; only bases that give points an extent care.
    fn for_spacing(&self, spacing: f64) -> Self {
        let _ = spacing;
        *self
    }

    /// Whether the slopes serve APIC as well: where a point's velocity field has no other gradient (two nodes an axis), and the
    /// usual formula would divide zero by zero at a node.
    const AFFINE_IS_SLOPE: bool = false;

    /// How far before its point a stencil starts: `first = floor(x + shift)`, but for the upper end of the grid.
    fn shift(&self) -> f64 {
        0.0
    }

    /// How many functions (nodes) an axis of `cells` cells has.
    fn count(&self, cells: i32) -> i32;

    /// Where function `index` stands, in cells from the lower end: the coefficient with which a linear field is reproduced.
    fn position(&self, index: i32, cells: i32) -> f64;
}

/// Something to be done with a basis whose type is not known before the run.
pub trait BasisVisitor {
    /// What comes out.
    type Output;
    /// Does it.
    fn visit<const N: usize, B: Basis<N>>(self, basis: B) -> Self::Output;
}

mod spline;
#[cfg(test)]
mod tests;

macro_rules! bases {
    ($($name:literal => $module:ident::$basis:ident with $n:literal nodes),* $(,)?) => {
        $(mod $module; pub use $module::$basis;)*

        /// Every basis, by its name in a scenario.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub enum BasisChoice { $(#[doc = concat!("`", $name, "`")] $basis($basis)),* }

        impl BasisChoice {
            /// All names.
            pub const NAMES: &'static [&'static str] = &[$($name),*];

            /// Its name in a scenario.
            pub fn name(&self) -> &'static str { match self { $(Self::$basis(_) => $name),* } }

            /// Reads the basis called `name` with its parameters.
            pub fn read(name: &str, reader: &mut Reader<'_>) -> Option<Self> {
                match name { $($name => $basis::read(reader).map(Self::$basis),)* _ => None }
            }

            /// Every basis with its default parameters, for what has to hold for all of them.
            pub fn all() -> Vec<Self> { vec![$(Self::$basis($basis::default())),*] }

            /// Calls the visitor with the basis and its number of nodes an axis.
            pub fn visit<V: BasisVisitor>(&self, visitor: V) -> V::Output {
                match self { $(Self::$basis(basis) => visitor.visit::<$n, _>(*basis)),* }
            }
        }
    };
}

bases! {
    "linear" => linear::Linear with 2 nodes,
    "gimp" => gimp::Gimp with 3 nodes,
    "quadratic" => quadratic::QuadraticBSpline with 3 nodes,
    "cubic" => cubic::CubicBSpline with 4 nodes,
}
