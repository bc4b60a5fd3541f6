//! Arithmetic in scenario files.
use super::Unit;
use std::collections::BTreeMap;
/// What an expression may depend on.
#[derive(Clone, Copy, Debug, Default)]
pub struct Variables {
    /// Position, m.
    pub position: [f64; 3],
    /// Time, s.
    pub time: f64,
}
/// A compiled expression.
#[derive(Clone, Debug, PartialEq)]
pub struct Expression;
impl Expression {
    /// Its value in SI units.
    pub fn value(&self, _at: &Variables) -> f64 {
        todo!()
    }
    /// A constant.
    pub fn constant(_value: f64) -> Self {
        todo!()
    }
    /// Compiles `text`.
    pub fn parse(
        _text: &str,
        _unit: Unit,
        _constants: &BTreeMap<String, super::Quantity>,
    ) -> Result<Self, String> {
        todo!()
    }
}
