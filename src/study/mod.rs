//! What runs many runs.

pub mod bench;
pub mod chart;
pub mod stability;
pub mod validate;
