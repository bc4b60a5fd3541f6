//! Nodes that slide along a plane without friction and without leaving it; also a plane of symmetry.

use super::{Condition, ConditionParameters, Node, Place};
use crate::input::Reader;
use crate::math::Vector;

/// v · n = 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Roller {
    /// The axis, 0, 1 or 2, that the plane is across.
    pub normal: usize,
}

impl ConditionParameters for Roller {
    fn read(reader: &mut Reader<'_>, place: &Place) -> Option<Self> {
        let axes = &["x", "y", "z"][..place.dimension];
        let normal = match place.side {
            Some(side) => side.axis,
            None => {
                let name = reader.choice("normal", axes, None)?;
                axes.iter().position(|axis| *axis == name)?
            }
        };
        Some(Self { normal })
    }

    fn stands_still(&self) -> bool {
        true
    }

    fn is_uniform_along(&self, axis: usize) -> bool {
        self.normal != axis
    }

    fn mirrored(&self, _: usize) -> Option<Self> {
        Some(*self)
    }
}

impl<const D: usize> Condition<D> for Roller {
    fn impose(&self, _: &Node<D>, velocity: &Vector<D>) -> Vector<D> {
        let mut velocity = *velocity;
        velocity[self.normal] = 0.0;
        velocity
    }

    fn wall_velocity(&self, _: &Node<D>) -> Vector<D> {
        Vector::zeros()
    }
}
