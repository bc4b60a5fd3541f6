//! Nodes that move as prescribed, in some directions or in all.

use super::{Condition, ConditionParameters, Node, Place};
use crate::input::{Expression, Reader, Unit, Variables};
use crate::math::Vector;

/// v_i = given_i(x, y, z, t) for every component that is not free.
#[derive(Clone, Debug, PartialEq)]
pub struct Driven {
    /// Velocity, m/s, one entry an axis; `None` is free.
    pub velocity: Vec<Option<Expression>>,
}

impl ConditionParameters for Driven {
    fn read(reader: &mut Reader<'_>, place: &Place) -> Option<Self> {
        let velocity = reader.expressions_or_word("velocity", Unit::VELOCITY, place.dimension, &["x", "y", "z", "t"], "free")?;
        if velocity.iter().all(Option::is_none) {
            reader.problem("velocity", "every component is \"free\": give at least one, or leave the boundary out");
            return None;
        }
        Some(Self { velocity })
    }

    fn is_uniform_along(&self, axis: usize) -> bool {
        let given = self.velocity.iter().enumerate();
        let mut given = given.filter_map(|(component, formula)| Some((component, formula.as_ref()?)));
        given.all(|(component, formula)| formula.is_uniform_along(axis, component))
    }

    fn mirrored(&self, axis: usize) -> Option<Self> {
        let given = self.velocity.iter().enumerate();
        let images = given.map(|(component, formula)| match formula {
            Some(formula) => formula.mirrored(axis, component).map(Some),
            None => Some(None),
        });
        let velocity = images.collect::<Option<_>>()?;
        Some(Self { velocity })
    }
}

impl Driven {
    fn given<const D: usize>(&self, node: &Node<D>, axis: usize) -> Option<f64> {
        let mut at = Variables { position: [0.0; 3], time: node.time };
        for axis in 0..D {
            at.position[axis] = node.position[axis];
        }
        self.velocity[axis].as_ref().map(|velocity| velocity.value(&at))
    }
}

impl<const D: usize> Condition<D> for Driven {
    fn impose(&self, node: &Node<D>, velocity: &Vector<D>) -> Vector<D> {
        Vector::from_fn(|axis, _| self.given(node, axis).unwrap_or(velocity[axis]))
    }

    fn wall_velocity(&self, node: &Node<D>) -> Vector<D> {
        Vector::from_fn(|axis, _| self.given(node, axis).unwrap_or(0.0))
    }
}
