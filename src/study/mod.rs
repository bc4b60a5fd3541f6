//! What runs many runs.

pub mod validate;
