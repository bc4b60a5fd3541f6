//! Numbers with units.

use super::ExpressionError;
use super::units;
use std::fmt;

/// A physical dimension: the exponents of length, mass and time. An angle is a pure number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Unit {
    /// Exponent of metres.
    pub length: i8,
    /// Exponent of kilograms.
    pub mass: i8,
    /// Exponent of seconds.
    pub time: i8,
}

/// What is said about the dimensions that have a name: its article and noun, an example, and its SI unit.
const NAMED: &[(Unit, &str, &str, &str)] = &[
    (Unit::LENGTH, "a length", "25 mm", "m"),
    (Unit::TIME, "a time", "10 ms", "s"),
    (Unit::MASS, "a mass", "3 kg", "kg"),
    (Unit::AREA, "an area", "4 mm^2", "m^2"),
    (Unit::VOLUME, "a volume", "4 mm^3", "m^3"),
    (Unit::VELOCITY, "a velocity", "1 mm/s", "m/s"),
    (Unit::ACCELERATION, "an acceleration", "9.81 m/s^2", "m/s^2"),
    (Unit::FORCE, "a force", "14.43 N", "N"),
    (Unit::PRESSURE, "a pressure", "100 MPa", "Pa"),
    (Unit::DENSITY, "a density", "8.96 g/cm^3", "kg/m^3"),
    (Unit::FREQUENCY, "a frequency", "5 Hz", "1/s"),
    (Unit::ENERGY, "an energy", "3 J", "J"),
    (Unit::POWER, "a power", "3 W", "W"),
    (Unit::VISCOSITY, "a viscosity", "1 Pa*s", "Pa s"),
];

impl Unit {
    /// A pure number.
    pub const NONE: Unit = Unit::new(0, 0, 0);
    /// m
    pub const LENGTH: Unit = Unit::new(1, 0, 0);
    /// s
    pub const TIME: Unit = Unit::new(0, 0, 1);
    /// kg
    pub const MASS: Unit = Unit::new(0, 1, 0);
    /// m²
    pub const AREA: Unit = Unit::new(2, 0, 0);
    /// m³
    pub const VOLUME: Unit = Unit::new(3, 0, 0);
    /// m/s
    pub const VELOCITY: Unit = Unit::new(1, 0, -1);
    /// m/s²
    pub const ACCELERATION: Unit = Unit::new(1, 0, -2);
    /// N
    pub const FORCE: Unit = Unit::new(1, 1, -2);
    /// Pa
    pub const PRESSURE: Unit = Unit::new(-1, 1, -2);
    /// kg/m³
    pub const DENSITY: Unit = Unit::new(-3, 1, 0);
    /// 1/s
    pub const FREQUENCY: Unit = Unit::new(0, 0, -1);
    /// J
    pub const ENERGY: Unit = Unit::new(2, 1, -2);
    /// W
    pub const POWER: Unit = Unit::new(2, 1, -3);
    /// Pa s
    pub const VISCOSITY: Unit = Unit::new(-1, 1, -1);

    /// The dimension with these exponents.
    pub const fn new(length: i8, mass: i8, time: i8) -> Self {
        Unit { length, mass, time }
    }

    /// What is expected: `a pressure (such as "100 MPa" or a number in Pa)`.
    pub fn describe(&self) -> String {
        if *self == Unit::NONE {
            return "a number (or a text such as \"30 deg\" or \"1/3\")".into();
        }
        match NAMED.iter().find(|named| named.0 == *self) {
            Some((_, noun, example, si)) => {
                format!("{noun} (such as \"{example}\" or a number in {si})")
            }
            None => format!("a quantity in {self} (or a number in these units)"),
        }
    }

    /// What was found: `a length`.
    pub fn noun(&self) -> String {
        match NAMED.iter().find(|named| named.0 == *self) {
            _ if *self == Unit::NONE => "a pure number or an angle".into(),
            Some((_, noun, ..)) => noun.to_string(),
            None => format!("a quantity in {self}"),
        }
    }

    /// `self * other^sign`; `None` beyond any exponent that makes sense.
    pub(super) fn combine(self, other: Unit, power: i32) -> Option<Unit> {
        let exponent = |a: i8, b: i8| {
            i8::try_from(i32::from(b).checked_mul(power)?.checked_add(i32::from(a))?).ok()
        };
        Some(Unit {
            length: exponent(self.length, other.length)?,
            mass: exponent(self.mass, other.mass)?,
            time: exponent(self.time, other.time)?,
        })
    }
}

impl fmt::Display for Unit {
    /// `kg m^2/s` is written `kg*m^2*s^-1`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut first = true;
        for (symbol, exponent) in [("kg", self.mass), ("m", self.length), ("s", self.time)] {
            if exponent == 0 {
                continue;
            }
            let times = if first { "" } else { "*" };
            first = false;
            match exponent {
                1 => write!(f, "{times}{symbol}")?,
                _ => write!(f, "{times}{symbol}^{exponent}")?,
            }
        }
        if first { write!(f, "1") } else { Ok(()) }
    }
}

/// A value in SI units with its dimension.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantity {
    /// In SI units.
    pub value: f64,
    /// Its dimension; `None` for a bare number, which fits anywhere.
    pub unit: Option<Unit>,
}

impl Quantity {
    /// Reads a number with a unit, `"8.96 g/cm^3"`, or any other constant expression.
    pub fn parse(text: &str) -> Result<Quantity, ExpressionError> {
        super::compile::quantity(text, &Default::default())
    }

    /// Every unit that [`Quantity::parse`] knows, without prefixes.
    pub fn units() -> impl Iterator<Item = &'static str> {
        units::symbols()
    }
}
