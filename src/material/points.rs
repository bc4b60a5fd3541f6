//! The points of one body, as their law sees them.
/// Object-safe access to a law and the memory of its points.
pub trait MaterialPoints<const D: usize>: Send + Sync {}
