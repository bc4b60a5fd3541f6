//! What a text says: tables with places, quantities with units, expressions. Knows nothing of mechanics.

mod expression;
mod quantity;
mod reader;

pub use expression::{Expression, Variables};
pub use quantity::{Quantity, Unit};
pub use reader::{Bound, Parameters, Problem, Reader};
