//! What a chart varies. An axis is one entry of [`AXES`]: its option, its column and its place in a scenario follow from it.

use crate::basis::BasisChoice;
use crate::scenario::{Method, ReferenceFrame};
use crate::transfer::TransferChoice;
use std::fmt;

/// One thing that a chart varies.
pub struct Axis {
    /// Name of its option and of its column.
    pub name: &'static str,
    /// What it is, for the help of the command.
    pub help: &'static str,
    /// Which values it can have.
    pub values: Values,
    /// Where in a scenario it goes.
    pub place: Place,
}

/// Which values an axis can have.
#[derive(Clone, Copy)]
pub enum Values {
    /// Some names.
    Names(&'static [&'static str]),
    /// Names of transfers, each alone or with its parameter: `fmpm`, `fmpm(3)`.
    Transfers,
    /// Whole numbers from 1 up to this one.
    Counts(u32),
    /// Positive numbers up to this one.
    Numbers(f64),
}

impl Values {
    /// All names, where values are names; none where they are numbers.
    pub fn names(&self) -> &'static [&'static str] {
        match self {
            Self::Names(names) => names,
            Self::Transfers => TransferChoice::NAMES,
            Self::Counts(_) | Self::Numbers(_) => &[],
        }
    }
}

/// Where in a scenario a value goes.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// A key that takes the value as it is.
    Key(&'static str),
    /// `particles_per_cell` of every body.
    Points,
    /// `time.courant`, in place of a fixed step.
    Courant,
    /// Asked from the subject: how many cells, how many dimensions.
    Layout,
}

/// Every axis, those that vary slowest first.
pub const AXES: &[Axis] = &[
    Axis {
        name: "dimensions",
        help: "Dimensions to set the case up in",
        values: Values::Counts(3),
        place: Place::Layout,
    },
    Axis {
        name: "frame",
        help: "Configurations that shape functions are taken in",
        values: Values::Names(&ReferenceFrame::NAMES),
        place: Place::Key("method.frame"),
    },
    Axis {
        name: "basis",
        help: "Shape functions",
        values: Values::Names(BasisChoice::NAMES),
        place: Place::Key("method.basis"),
    },
    Axis {
        name: "transfer",
        help: "Velocity transfers",
        values: Values::Transfers,
        place: Place::Key("method.transfer"),
    },
    Axis {
        name: "update",
        help: "When stresses are updated",
        values: Values::Names(&["usf", "usl", "musl"]),
        place: Place::Key("method.update"),
    },
    Axis {
        name: "points",
        help: "Points a cell along each axis",
        values: Values::Counts(16),
        place: Place::Points,
    },
    Axis {
        name: "courant",
        help: "Courant numbers",
        values: Values::Numbers(5.0),
        place: Place::Courant,
    },
    Axis {
        name: "cells",
        help: "Resolutions, in cells (a scenario file: along x)",
        values: Values::Counts(1 << 20),
        place: Place::Layout,
    },
];

/// A value on an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// A name.
    Name(&'static str),
    /// A name and its parameter: what that is called, and its value.
    With(&'static str, &'static str, f64),
    /// A whole number.
    Count(u32),
    /// A number.
    Number(f64),
}

impl Value {
    /// As a number; NaN if it is a name.
    pub fn number(self) -> f64 {
        match self {
            Self::Count(count) => f64::from(count),
            Self::Number(number) => number,
            Self::Name(_) | Self::With(..) => f64::NAN,
        }
    }
}

impl Value {
    /// As a value of TOML.
    pub fn toml(self) -> String {
        match self {
            Self::Name(name) => format!("\"{name}\""),
            Self::With(name, parameter, number) => {
                format!("{{ {name} = {{ {parameter} = {number} }} }}")
            }
            Self::Count(_) | Self::Number(_) => self.to_string(),
        }
    }
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Name(name) => f.write_str(name),
            Self::With(name, _, number) => write!(f, "{name}({number})"),
            Self::Count(count) => count.fmt(f),
            Self::Number(number) => number.fmt(f),
        }
    }
}

impl Axis {
    /// Reads a value, or says what is wrong with the text.
    pub fn read(&self, text: &str) -> Result<Value, String> {
        let option = self.name;
        let name = |names: &[&'static str], text: &str| {
            let found = names.iter().find(|name| **name == text);
            found.copied().ok_or_else(|| {
                let all = names.join(", ");
                format!("--{option}: there is no \"{text}\"; known: {all}")
            })
        };
        match self.values {
            Values::Names(names) => name(names, text).map(Value::Name),
            Values::Transfers => {
                let Some((of, number)) = text.strip_suffix(')').and_then(|t| t.split_once('('))
                else {
                    return name(TransferChoice::NAMES, text).map(Value::Name);
                };
                let of = name(TransferChoice::NAMES, of)?;
                let Some(parameter) = TransferChoice::parameter(of) else {
                    return Err(format!("--{option}: {of} has no parameter: write {of}"));
                };
                let number = number.parse::<f64>().ok();
                let number = number.filter(|number| number.is_finite()).ok_or_else(|| {
                    format!("--{option}: the {parameter} in \"{text}\" is not a number")
                })?;
                Ok(Value::With(of, parameter, number))
            }
            Values::Counts(most) => match text.parse::<u32>() {
                Ok(count) if (1..=most).contains(&count) => Ok(Value::Count(count)),
                _ => Err(format!(
                    "--{option}: \"{text}\" is not a whole number from 1 to {most}"
                )),
            },
            Values::Numbers(most) => match text.parse::<f64>() {
                Ok(number) if number > 0.0 && number <= most => Ok(Value::Number(number)),
                _ => Err(format!(
                    "--{option}: \"{text}\" is not a number above 0 and up to {most}"
                )),
            },
        }
    }

    /// All names, where values are names.
    pub fn names(&self) -> Vec<Value> {
        let names = self.values.names().iter();
        names.map(|name| Value::Name(name)).collect()
    }
}

/// The axes of a method, and its values on them; of a transfer its name alone.
pub fn names_of(method: &Method) -> [(&'static str, Value); 4] {
    [
        ("frame", method.frame.name()),
        ("basis", method.basis.name()),
        ("transfer", method.transfer.name()),
        ("update", method.update.name()),
    ]
    .map(|(axis, name)| (axis, Value::Name(name)))
}

/// Index of the axis of a name.
///
/// # Panics
/// If there is none.
pub fn axis(name: &str) -> usize {
    let found = AXES.iter().position(|axis| axis.name == name);
    found.unwrap_or_else(|| panic!("no axis is called {name}"))
}

/// One value on each axis, in their order.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting(pub Vec<Value>);

impl Setting {
    /// The value on an axis.
    pub fn get(&self, name: &str) -> Value {
        self.0[axis(name)]
    }

    /// A whole number on an axis; 0 where it is something else.
    pub fn count(&self, name: &str) -> u32 {
        match self.get(name) {
            Value::Count(count) => count,
            _ => 0,
        }
    }

    /// A number on an axis, as such; NaN where it is a name.
    pub fn number(&self, name: &str) -> f64 {
        self.get(name).number()
    }

    /// Whether two settings differ on this axis at most.
    pub fn agrees_but_for(&self, other: &Self, name: &str) -> bool {
        let skip = axis(name);
        let mut pairs = self.0.iter().zip(&other.0).enumerate();
        pairs.all(|(i, (a, b))| i == skip || a == b)
    }

    /// The method alone: the names.
    pub fn method(&self) -> String {
        let names = self.0.iter().filter_map(|value| match value {
            Value::Name(_) | Value::With(..) => Some(value.to_string()),
            _ => None,
        });
        names.collect::<Vec<_>>().join(" ")
    }

    /// What does not depend on the layout, as overrides `KEY=VALUE` of a scenario with so many bodies and this end, s.
    pub fn overrides(&self, bodies: usize, end: f64) -> Vec<String> {
        let mut all = Vec::new();
        for (axis, value) in AXES.iter().zip(&self.0) {
            match axis.place {
                Place::Key(key) => all.push(format!("{key}={}", value.toml())),
                Place::Points => {
                    all.extend(
                        (0..bodies).map(|body| format!("body[{body}].particles_per_cell={value}")),
                    );
                }
                Place::Courant => {
                    all.push(format!("time={{ end = {end:e}, courant = {value} }}"));
                }
                Place::Layout => {}
            }
        }
        all
    }
}

/// The values of each axis, in the order of [`AXES`].
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep(pub Vec<Vec<Value>>);

impl Sweep {
    /// Every combination; the last axis varies fastest.
    pub fn settings(&self) -> Vec<Setting> {
        let mut all = vec![Vec::new()];
        for values in &self.0 {
            let longer = |start: &Vec<Value>| {
                let start = start.clone();
                values
                    .iter()
                    .map(move |value| [&start[..], &[*value]].concat())
                    .collect::<Vec<_>>()
            };
            all = all.iter().flat_map(longer).collect();
        }
        all.into_iter().map(Setting).collect()
    }

    /// The values on an axis.
    pub fn on(&self, name: &str) -> &[Value] {
        &self.0[axis(name)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sweep_has_every_combination_once_and_cells_vary_fastest() {
        let mut values: Vec<Vec<Value>> = AXES.iter().map(|_| vec![Value::Count(1)]).collect();
        values[axis("cells")] = vec![Value::Count(8), Value::Count(16)];
        values[axis("basis")] = vec![Value::Name("linear"), Value::Name("cubic")];
        let settings = Sweep(values).settings();
        let seen: Vec<_> = settings
            .iter()
            .map(|s| (s.get("basis").to_string(), s.count("cells")))
            .collect();
        let expected = [("linear", 8), ("linear", 16), ("cubic", 8), ("cubic", 16)];
        assert_eq!(seen, expected.map(|(name, n)| (name.to_string(), n)));
        assert!(settings[0].agrees_but_for(&settings[1], "cells"));
        assert!(!settings[0].agrees_but_for(&settings[2], "cells"));
    }

    #[test]
    fn a_transfer_with_its_parameter_reads_back_as_it_is_written() {
        let transfer = &AXES[axis("transfer")];
        for text in ["fmpm(3)", "flip(0.9)", "apic"] {
            let value = transfer.read(text).expect("a transfer");
            assert_eq!(value.to_string(), text);
            let mut values = vec![Value::Count(1); AXES.len()];
            values[axis("transfer")] = value;
            let overrides = Setting(values).overrides(0, 1.0);
            let expected = match text {
                "fmpm(3)" => "method.transfer={ fmpm = { order = 3 } }",
                "flip(0.9)" => "method.transfer={ flip = { ratio = 0.9 } }",
                _ => "method.transfer=\"apic\"",
            };
            assert!(overrides.contains(&expected.to_string()), "{overrides:?}");
        }
    }

    #[test]
    fn a_value_that_cannot_be_is_refused_with_what_can() {
        let basis = &AXES[axis("basis")];
        assert!(
            basis
                .read("qudratic")
                .is_err_and(|why| why.contains("quadratic"))
        );
        let courant = &AXES[axis("courant")];
        assert!(courant.read("0").is_err() && courant.read("nan").is_err());
        assert_eq!(courant.read("0.3"), Ok(Value::Number(0.3)));
        let transfer = &AXES[axis("transfer")];
        for wrong in ["pic(2)", "fmpm(many)", "fmpm()", "upic(2)", "fmpm(nan)"] {
            assert!(transfer.read(wrong).is_err(), "{wrong}");
        }
    }
}
