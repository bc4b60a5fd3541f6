//! Geometry of bodies. A shape knows one point: is it inside? It knows no grid, no lattice and no body.

use crate::input::Reader;

/// A box that holds a shape, one number an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Bounds {
    /// Lower corner, m.
    pub min: Vec<f64>,
    /// Upper corner, m.
    pub max: Vec<f64>,
}

/// What a contributor writes for a new shape.
pub trait Geometry: Sized {
    /// Reads the shape that stands under `key` of a table; `None` if a problem was found (and recorded in the reader).
    fn read(parent: &mut Reader<'_>, key: &'static str, dimension: usize) -> Option<Self>;

    /// Whether a place, m, one number an axis, is inside; the surface counts.
    fn contains(&self, at: &[f64]) -> bool;

    /// The smallest box around it, or one that is a little larger.
    fn bounds(&self) -> Bounds;

    /// Its length, area or volume, if a formula gives it exactly.
    fn measure(&self) -> Option<f64>;

    /// The volume of the ring that the part at x ≥ 0 of a 2D shape sweeps around the axis x = 0, if a formula gives it exactly.
    fn revolved(&self) -> Option<f64> {
        None
    }
}

macro_rules! shapes {
    ($($name:literal => $module:ident::$shape:ident),* $(,)?) => {
        $(mod $module; pub use $module::$shape;)*

        /// Every shape, by its name in a scenario.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Shape { $(#[doc = concat!("`", $name, "`")] $shape($shape)),* }

        impl Shape {
            /// All names.
            pub const NAMES: &'static [&'static str] = &[$($name),*];

            /// Its name in a scenario.
            pub fn name(&self) -> &'static str { match self { $(Self::$shape(_) => $name),* } }

            /// Reads a table that holds exactly one shape, under its name.
            pub fn read(reader: &mut Reader<'_>, dimension: usize) -> Option<Self> {
                match reader.one_key(Self::NAMES)? {
                    $($name => $shape::read(reader, $name, dimension).map(Self::$shape),)*
                    _ => None,
                }
            }

            /// Whether a place, m, is inside; the surface counts.
            pub fn contains(&self, at: &[f64]) -> bool {
                match self { $(Self::$shape(shape) => shape.contains(at)),* }
            }

            /// A box around it.
            pub fn bounds(&self) -> Bounds {
                match self { $(Self::$shape(shape) => shape.bounds()),* }
            }

            /// Its exact length, area or volume, if known.
            pub fn measure(&self) -> Option<f64> {
                match self { $(Self::$shape(shape) => shape.measure()),* }
            }

            /// The exact volume of the part at x ≥ 0 turned around x = 0, if known.
            pub fn revolved(&self) -> Option<f64> {
                match self { $(Self::$shape(shape) => shape.revolved()),* }
            }
        }
    };
}

shapes! {
    "box" => cuboid::Cuboid,
    "ball" => ball::Ball,
    "cylinder" => cylinder::Cylinder,
    "polygon" => polygon::Polygon,
    "union" => union::Union,
    "difference" => difference::Difference,
}

/// Whether the boxes around several shapes have no inner point in common; not looked at if there are very many.
fn lie_apart(shapes: &[Shape]) -> bool {
    let bounds: Vec<Bounds> = shapes.iter().map(Shape::bounds).collect();
    let apart = |a: &Bounds, b: &Bounds| {
        (0..a.min.len()).any(|axis| a.max[axis] <= b.min[axis] || b.max[axis] <= a.min[axis])
    };
    bounds.len() <= 1000
        && (0..bounds.len()).all(|i| bounds[..i].iter().all(|other| apart(other, &bounds[i])))
}

#[cfg(test)]
mod tests;
