//! Conditions on grid nodes. A condition knows one node: where it is, how it would move, and the time.

use crate::input::Reader;
use crate::math::Vector;

/// One node, as a condition sees it.
#[derive(Clone, Copy, Debug)]
pub struct Node<const D: usize> {
    /// Position, m.
    pub position: Vector<D>,
    /// Time at which the velocity holds, s.
    pub time: f64,
}

/// What a boundary imposes on a node. Imposing twice is imposing once, and a component that it changes takes the value that
/// [`Condition::wall_velocity`] has there.
pub trait Condition<const D: usize>: Send + Sync {
    /// The velocity, m/s, of a node that would move with `velocity` if the condition were not there.
    fn impose(&self, node: &Node<D>, velocity: &Vector<D>) -> Vector<D>;

    /// The velocity of the wall itself, m/s, zero in components that it leaves free: the reaction times this is the work that
    /// the boundary does.
    fn wall_velocity(&self, node: &Node<D>) -> Vector<D>;
}

/// A side of a box: an axis (0, 1, 2) and which end of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Side {
    /// 0, 1 or 2 for x, y or z.
    pub axis: usize,
    /// True for `_max`, false for `_min`.
    pub upper: bool,
}

impl Side {
    /// All names, those of the first axis first.
    pub const NAMES: [&'static str; 6] = ["x_min", "x_max", "y_min", "y_max", "z_min", "z_max"];

    /// Reads the name of a side that must be there.
    pub fn read(reader: &mut Reader<'_>, key: &str, dimension: usize) -> Option<Self> {
        let name = reader.choice(key, &Self::NAMES[..2 * dimension], None)?;
        let number = Self::NAMES.iter().position(|known| *known == name)?;
        Some(Self {
            axis: number / 2,
            upper: number % 2 == 1,
        })
    }

    /// The side that its image in a mirror across an axis is.
    pub fn mirrored(self, axis: usize) -> Self {
        Self {
            axis: self.axis,
            upper: self.upper != (self.axis == axis),
        }
    }

    /// Its name in a scenario.
    pub fn name(&self) -> &'static str {
        Self::NAMES[2 * self.axis + usize::from(self.upper)]
    }
}

/// Where a condition acts, as far as its parameters may depend on it.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// Of the scene.
    pub dimension: usize,
    /// The side of the grid, if it acts on one.
    pub side: Option<Side>,
}

/// What a contributor writes besides [`Condition`]: how its parameters are read, and what else is known of it. Of a condition that
/// says no more, nothing is taken for granted: advice that would have to is not given.
pub trait ConditionParameters: Sized {
    /// Reads every key it knows; `None` if a problem was found (and recorded in the reader).
    fn read(reader: &mut Reader<'_>, place: &Place) -> Option<Self>;

    /// Whether it stops a body on one side only: what comes to it later, or leaves it, matters. The total frame cannot do that.
    fn is_one_sided(&self) -> bool {
        false
    }

    /// Whether it never sets in motion what is at rest.
    fn stands_still(&self) -> bool {
        false
    }

    /// Whether a model without an axis, 0, 1 or 2, could have the same condition: it acts in the same way all along the axis, and
    /// gives nothing a motion along it.
    fn is_uniform_along(&self, _axis: usize) -> bool {
        false
    }

    /// The condition that its image in a mirror across an axis is, wherever the mirror stands; `None` where that is not known.
    fn mirrored(&self, _axis: usize) -> Option<Self> {
        None
    }
}

macro_rules! conditions {
    ($($name:literal => $module:ident::$condition:ident),* $(,)?) => {
        $(mod $module; pub use $module::$condition;)*

        /// Every condition, by its name in a scenario.
        #[derive(Clone, Debug, PartialEq)]
        pub enum ConditionChoice { $(#[doc = concat!("`", $name, "`")] $condition($condition)),* }

        impl ConditionChoice {
            /// All names.
            pub const NAMES: &'static [&'static str] = &[$($name),*];

            /// Its name in a scenario.
            pub fn name(&self) -> &'static str { match self { $(Self::$condition(_) => $name),* } }

            /// Reads the condition called `name` with its parameters.
            pub fn read(name: &str, reader: &mut Reader<'_>, place: &Place) -> Option<Self> {
                match name { $($name => $condition::read(reader, place).map(Self::$condition),)* _ => None }
            }

            /// [`ConditionParameters::is_one_sided`]
            pub fn is_one_sided(&self) -> bool {
                match self { $(Self::$condition(condition) => condition.is_one_sided()),* }
            }

            /// [`ConditionParameters::stands_still`]
            pub fn stands_still(&self) -> bool {
                match self { $(Self::$condition(condition) => condition.stands_still()),* }
            }

            /// [`ConditionParameters::is_uniform_along`]
            pub fn is_uniform_along(&self, axis: usize) -> bool {
                match self { $(Self::$condition(condition) => condition.is_uniform_along(axis)),* }
            }

            /// [`ConditionParameters::mirrored`]
            pub fn mirrored(&self, axis: usize) -> Option<Self> {
                match self { $(Self::$condition(condition) => condition.mirrored(axis).map(Self::$condition)),* }
            }

            /// The condition itself, for nodes of a `D`-dimensional grid.
            pub fn build<const D: usize>(&self) -> Box<dyn Condition<D>> {
                match self { $(Self::$condition(condition) => Box::new(condition.clone())),* }
            }
        }
    };
}

conditions! {
    "fixed" => fixed::Fixed,
    "roller" => roller::Roller,
    "driven" => driven::Driven,
    "wall" => wall::Wall,
}

#[cfg(test)]
mod tests;
