//! Nodes that do not move.

use super::{Condition, ConditionParameters, Node, Place};
use crate::input::Reader;
use crate::math::Vector;

/// v = 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fixed;

impl ConditionParameters for Fixed {
    fn read(_: &mut Reader<'_>, _: &Place) -> Option<Self> {
        Some(Self)
    }

    fn stands_still(&self) -> bool {
        true
    }

    fn is_uniform_along(&self, _: usize) -> bool {
        true
    }

    fn mirrored(&self, _: usize) -> Option<Self> {
        Some(*self)
    }
}

impl<const D: usize> Condition<D> for Fixed {
    fn impose(&self, _: &Node<D>, _: &Vector<D>) -> Vector<D> {
        Vector::zeros()
    }

    fn wall_velocity(&self, _: &Node<D>) -> Vector<D> {
        Vector::zeros()
    }
}
