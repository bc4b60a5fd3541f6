//! From text to an [`Expression`].
use super::{Expression, ExpressionError, Quantity, Unit};
use std::collections::BTreeMap;

pub(super) fn expression(
    _text: &str,
    _expected: Unit,
    _variables: &[&str],
    _constants: &BTreeMap<String, Quantity>,
) -> Result<Expression, ExpressionError> {
    todo!()
}

pub(super) fn quantity(
    _text: &str,
    _constants: &BTreeMap<String, Quantity>,
) -> Result<Quantity, ExpressionError> {
    todo!()
}
