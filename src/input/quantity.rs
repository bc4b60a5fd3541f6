//! Numbers with units.
/// A physical dimension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unit;
impl Unit {
    /// A pure number.
    pub const NONE: Unit = Unit;
    /// Pa.
    pub const PRESSURE: Unit = Unit;
}
/// A value in SI units with its dimension.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantity;
