//! What a text says: tables with places, quantities with units, expressions. Knows nothing of mechanics.
//!
//! A [`Document`] is a parsed file with its `--set` overrides; a [`Reader`] walks one of its tables and records every
//! [`Problem`] it meets, so that a user sees all of them at once.

mod compile;
mod constants;
mod document;
mod expression;
mod lists;
mod names;
mod overrides;
mod problem;
mod quantity;
mod reader;
mod share;
mod suffix;
mod suggest;
mod tokens;
mod tree;
mod units;
mod values;

pub use document::{Document, defaults, parse_parameters};
pub use expression::{Expression, ExpressionError, Variables};
pub use problem::{Problem, report};
pub use quantity::{Quantity, Unit};
pub use reader::{Bound, Parameters, Reader};
pub use suggest::nearest;

#[cfg(test)]
mod tests;
