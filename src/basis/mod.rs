//! Shape functions of the background grid, one axis at a time.
//!
//! A basis knows one coordinate, measured in cells from the lower end of the grid. It knows no dimension, no particle and
//! no grid: the solver multiplies axes together.

use crate::input::{Parameters, Reader};
use crate::real::Real;

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

/// What the functions of a stencil are at one place between nodes.
#[derive(Clone, Copy, Debug)]
pub struct Functions<R, const N: usize> {
    /// Values N_i.
    pub weight: [R; N],
    /// Slopes dN_i/dx per cell.
    pub slope: [R; N],
    /// Arms x_i − x in cells.
    pub arm: [R; N],
}

/// A family of shape functions over `cells` cells of unit length, complete to first order on `0 ≤ x ≤ cells`:
/// `Σ N_i = 1` and `Σ N_i(x) position(i) = x` everywhere, the ends included.
pub trait Basis<const N: usize>: Copy + Send + Sync + 'static {
    /// The functions of a stencil at s = x + shift − first, `0 ≤ s ≤ 1`, where they are the same in every cell. Four points are
    /// computed together: write it without branches.
    fn functions<R: Real>(&self, s: R) -> Functions<R, N>;

    /// How far before its point a stencil starts: `first = floor(x + shift)`, or the last stencil of the grid.
    fn shift(&self) -> f64 {
        0.0
    }

    /// Σ N_i (x_i − x)² of stencils that are [alike](Self::alike), in cells², if it is the same at every x.
    const INERTIA: Option<f64> = None;

    /// The first and last stencil whose functions are those of [`Self::functions`], numbered by their first function.
    fn alike(&self, cells: i32) -> (i32, i32) {
        (0, self.count(cells) - N as i32)
    }

    /// The functions at `x` of a stencil that is not [alike](Self::alike) the others: near the ends of the grid. As
    /// [`Self::functions`], for several points together; each has its own `first`.
    #[inline(always)]
    fn at_end<R: Real>(&self, x: R, first: R, cells: i32) -> Functions<R, N> {
        let _ = cells;
        self.functions(x + self.shift() - first)
    }

    /// The functions at `x` cells from the lower end, `0 ≤ x ≤ cells`.
    fn axis(&self, x: f64, cells: i32) -> Axis<N> {
        let shifted = x + self.shift();
        let first = (shifted as i32).min(self.count(cells) - N as i32);
        let (low, high) = self.alike(cells);
        let start = f64::from(first);
        let Functions { weight, slope, arm } = if first < low || first > high {
            self.at_end(x, start, cells)
        } else {
            self.functions(shifted - start)
        };
        Axis {
            first,
            weight,
            slope,
            arm,
        }
    }

    /// The same basis for points that are `spacing` cells apart; only bases that give points an extent care.
    fn for_spacing(&self, spacing: f64) -> Self {
        let _ = spacing;
        *self
    }

    /// Whether the slopes serve APIC as well: where a point's velocity field has no other gradient (two nodes an axis), and the
    /// usual formula would divide zero by zero at a node.
    const AFFINE_IS_SLOPE: bool = false;

    /// Whether a function may have a slope where it has no value, as hat functions have at the next node: then a point can be
    /// told to strain by a node that has no mass.
    const SLOPES_JUMP: bool = false;

    /// Whether a function can be bent within a cell, as x² is: hat functions, and means of them, are not.
    const BENDS: bool = true;

    /// Whether changes of volume are those at the middle of the cell (B̄), for functions that lock otherwise: then stencils are the
    /// nodes of one cell.
    #[inline(always)]
    fn dilation_at_centre(&self) -> bool {
        false
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

    /// Does it with a basis whose points have domains that deform with them: `basis` is that of undeformed points.
    fn visit_domains<const N: usize, B: Basis<N>>(self, basis: B) -> Self::Output
    where
        Self: Sized,
    {
        self.visit(basis)
    }
}

mod spline;
#[cfg(test)]
mod tests;

/// Whether a basis has domains, and which function of a visitor it is handed to.
macro_rules! kind {
    (has) => {
        false
    };
    (has domains) => {
        true
    };
    (visit $visitor:ident, $basis:ident, $n:literal) => {
        $visitor.visit::<$n, _>(*$basis)
    };
    (visit $visitor:ident, $basis:ident, $n:literal domains) => {
        $visitor.visit_domains::<$n, _>(*$basis)
    };
}

macro_rules! bases {
    ($($name:literal => $module:ident::$basis:ident with $n:literal nodes $(and deforming $domains:ident)?),* $(,)?) => {
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

            /// Whether points have domains that deform with them, so that the functions above are those of undeformed points.
            pub fn has_domains(&self) -> bool {
                match self { $(Self::$basis(_) => kind!(has $($domains)?)),* }
            }

            /// Whether changes of volume are those at the middle of the cell, see [`Basis::dilation_at_centre`].
            pub fn dilation_at_centre(&self) -> bool {
                match self { $(Self::$basis(basis) => Basis::<$n>::dilation_at_centre(basis)),* }
            }

            /// Whether functions can be bent within a cell, see [`Basis::BENDS`].
            pub fn bends(&self) -> bool {
                match self { $(Self::$basis(_) => <$basis as Basis<$n>>::BENDS),* }
            }

            /// Calls the visitor with the basis and its number of nodes an axis.
            pub fn visit<V: BasisVisitor>(&self, visitor: V) -> V::Output {
                match self { $(Self::$basis(basis) => kind!(visit visitor, basis, $n $($domains)?)),* }
            }
        }
    };
}

bases! {
    "linear" => linear::Linear with 2 nodes,
    "gimp" => gimp::Gimp with 3 nodes,
    "quadratic" => quadratic::QuadraticBSpline with 3 nodes,
    "cubic" => cubic::CubicBSpline with 4 nodes,
    "cpdi" => cpdi::Cpdi with 3 nodes and deforming domains,
}
