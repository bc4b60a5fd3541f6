//! A smooth wall that bodies can hit, slide along and leave.

use super::{Condition, ConditionParameters, Node, Place, Side};
use crate::input::Reader;
use crate::math::Vector;

/// v · n ≤ 0, where n points into the wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wall {
    /// The side of the free space that the wall closes: `x_min` stops motion towards lower x.
    pub side: Side,
}

impl ConditionParameters for Wall {
    fn read(reader: &mut Reader<'_>, place: &Place) -> Option<Self> {
        let side = match place.side {
            Some(side) => side,
            None => Side::read(reader, "side", place.dimension)?,
        };
        Some(Self { side })
    }

    fn is_one_sided(&self) -> bool {
        true
    }

    fn stands_still(&self) -> bool {
        true
    }

    fn is_uniform_along(&self, axis: usize) -> bool {
        self.side.axis != axis
    }

    fn mirrored(&self, axis: usize) -> Option<Self> {
        let side = self.side.mirrored(axis);
        Some(Self { side })
    }
}

impl<const D: usize> Condition<D> for Wall {
    fn impose(&self, _: &Node<D>, velocity: &Vector<D>) -> Vector<D> {
        let mut velocity = *velocity;
        let normal = &mut velocity[self.side.axis];
        *normal = if self.side.upper { normal.min(0.0) } else { normal.max(0.0) };
        velocity
    }

    fn wall_velocity(&self, _: &Node<D>) -> Vector<D> {
        Vector::zeros()
    }
}
