//! Conditions on grid nodes. A condition knows one node: where it is, how it would move, and the time.

use crate::math::Vector;

/// One node, as a condition sees it.
#[derive(Clone, Copy, Debug)]
pub struct Node<const D: usize> {
    /// Position, m.
    pub position: Vector<D>,
    /// Time at which the velocity holds, s.
    pub time: f64,
}

/// What a boundary imposes on a node.
pub trait Condition<const D: usize>: Send + Sync {
    /// The velocity, m/s, of a node that would move with `velocity` if the condition were not there.
    fn impose(&self, node: &Node<D>, velocity: &Vector<D>) -> Vector<D>;

    /// The velocity of the wall itself, m/s: the reaction times this is the work that the boundary does.
    fn wall_velocity(&self, node: &Node<D>) -> Vector<D>;
}

/// TODO registry
#[derive(Clone, Debug)]
pub enum ConditionChoice {}
