//! Geometry of bodies.
/// A shape.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {}
