//! Tables with places.
use super::Unit;
/// Something wrong in the input.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem;
/// What a number has to satisfy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bound {
    /// Any finite number.
    Any,
    /// > 0
    Positive,
    /// ≥ 0
    NotNegative,
    /// lower ≤ x ≤ upper
    Closed(f64, f64),
    /// lower < x < upper
    Open(f64, f64),
}
/// A table being read.
pub struct Reader<'a>(std::marker::PhantomData<&'a ()>);
impl Reader<'_> {
    /// A number that must be there.
    pub fn required(&mut self, _key: &str, _unit: Unit, _bound: Bound) -> Option<f64> {
        todo!()
    }
    /// A number that may be left out.
    pub fn or(&mut self, _key: &str, _unit: Unit, _bound: Bound, _default: f64) -> Option<f64> {
        todo!()
    }
    /// One of several names.
    pub fn choice(
        &mut self,
        _key: &str,
        _names: &[&'static str],
        _default: &'static str,
    ) -> Option<&'static str> {
        todo!()
    }
}
/// A struct of parameters that can be read from a table.
pub trait Parameters: Sized {
    /// Reads every key it knows; `None` if a problem was found (and recorded in the reader).
    fn read(reader: &mut Reader<'_>) -> Option<Self>;
}
