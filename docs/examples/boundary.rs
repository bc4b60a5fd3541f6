//! Nodes that turn about an axis along z, like a disc in a lathe.

use super::{Condition, ConditionParameters, Node, Place};
use crate::input::{Bound, Reader, Unit};
use crate::math::Vector;

/// v = ω (−(y − y₀), x − x₀), and no motion along z.
#[derive(Clone, Debug, PartialEq)]
pub struct Turning {
    /// Where the axis stands, m.
    pub center: Vec<f64>,
    /// ω, 1/s, counterclockwise.
    pub rate: f64,
}

impl ConditionParameters for Turning {
    fn read(reader: &mut Reader<'_>, place: &Place) -> Option<Self> {
        if place.dimension == 1 {
            reader.problem_here("turning needs dimension = 2 or 3");
            return None;
        }
        let center = reader.vector("center", Unit::LENGTH, 2);
        let rate = reader.required("rate", Unit::FREQUENCY, Bound::Any);
        Some(Self {
            center: center?,
            rate: rate?,
        })
    }
}

impl<const D: usize> Condition<D> for Turning {
    fn impose(&self, node: &Node<D>, _: &Vector<D>) -> Vector<D> {
        self.wall_velocity(node)
    }

    fn wall_velocity(&self, node: &Node<D>) -> Vector<D> {
        Vector::from_fn(|axis, _| match axis {
            0 => -self.rate * (node.position[1] - self.center[1]),
            1 => self.rate * (node.position[0] - self.center[0]),
            _ => 0.0,
        })
    }
}
