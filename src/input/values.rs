//! The values of a table: numbers, lists, texts and expressions.

use super::suggest::short;
use super::tree::{Node, Value};
use super::{Bound, Expression, Reader, Unit};
use std::f64::consts::PI;

impl<'a> Reader<'a> {
    /// A number that must be there.
    pub fn required(&mut self, key: &str, unit: Unit, bound: Bound) -> Option<f64> {
        let entry = self.find_or_report(key, &format!("expected {}", unit.describe()))?;
        self.number(&entry.node, &self.join(key), unit, bound)
    }

    /// A number that may be left out.
    pub fn optional(&mut self, key: &str, unit: Unit, bound: Bound) -> Option<f64> {
        let entry = self.find(key)?;
        self.number(&entry.node, &self.join(key), unit, bound)
    }

    /// A number that has a default.
    pub fn or(&mut self, key: &str, unit: Unit, bound: Bound, default: f64) -> Option<f64> {
        if self.has(key) {
            self.optional(key, unit, bound)
        } else {
            Some(default)
        }
    }

    /// A list of `len` numbers that must be there.
    pub fn vector(&mut self, key: &str, unit: Unit, len: usize) -> Option<Vec<f64>> {
        self.find_or_report(
            key,
            &format!("expected a list of {len}, each {}", unit.describe()),
        )?;
        self.optional_vector(key, unit, len)
    }

    /// A list of `len` numbers that may be left out.
    pub fn optional_vector(&mut self, key: &str, unit: Unit, len: usize) -> Option<Vec<f64>> {
        let items = self.items(key, len)?;
        all(items.iter().enumerate().map(|(i, item)| {
            let path = format!("{}[{i}]", self.join(key));
            self.number(item, &path, unit, Bound::Any)
        }))
    }

    /// A list of `len` numbers that has a default.
    pub fn vector_or(
        &mut self,
        key: &str,
        unit: Unit,
        len: usize,
        default: &[f64],
    ) -> Option<Vec<f64>> {
        if self.has(key) {
            self.optional_vector(key, unit, len)
        } else {
            Some(default.to_vec())
        }
    }

    /// A whole number that must be there, from `min` to `max`.
    pub fn integer(&mut self, key: &str, min: i64, max: i64) -> Option<i64> {
        self.find_or_report(key, &format!("expected {}", whole(min, max)))?;
        self.optional_integer(key, min, max)
    }

    /// A whole number that may be left out, from `min` to `max`.
    pub fn optional_integer(&mut self, key: &str, min: i64, max: i64) -> Option<i64> {
        let entry = self.find(key)?;
        self.whole_number(&entry.node, &self.join(key), min, max)
    }

    /// A whole number that has a default.
    pub fn integer_or(&mut self, key: &str, min: i64, max: i64, default: i64) -> Option<i64> {
        if self.has(key) {
            self.optional_integer(key, min, max)
        } else {
            Some(default)
        }
    }

    /// `len` whole numbers: one for all, or a list. The key must be there.
    pub fn integers_one_or_list(
        &mut self,
        key: &str,
        len: usize,
        min: i64,
        max: i64,
    ) -> Option<Vec<i64>> {
        let entry = self.find_or_report(
            key,
            &format!("expected {}, or a list of {len}", whole(min, max)),
        )?;
        let path = self.join(key);
        if !matches!(entry.node.value, Value::List(_)) {
            return Some(vec![self.whole_number(&entry.node, &path, min, max)?; len]);
        }
        let items = self.items(key, len)?;
        let numbers = items.iter().enumerate();
        all(numbers.map(|(i, item)| self.whole_number(item, &format!("{path}[{i}]"), min, max)))
    }

    /// A text that must be there.
    pub fn text(&mut self, key: &str) -> Option<String> {
        self.find_or_report(key, "expected a text in quotes")?;
        self.optional_text(key)
    }

    /// A text that may be left out.
    pub fn optional_text(&mut self, key: &str) -> Option<String> {
        let entry = self.find(key)?;
        match &entry.node.value {
            Value::Text(text) => Some(text.clone()),
            other => {
                let message = format!("expected a text in quotes, found {}", other.found());
                self.wrong(&entry.node, &self.join(key), message)
            }
        }
    }

    /// True or false.
    pub fn flag(&mut self, key: &str, default: bool) -> Option<bool> {
        let Some(entry) = self.find(key) else {
            return Some(default);
        };
        match &entry.node.value {
            Value::Flag(flag) => Some(*flag),
            other => {
                let message = format!(
                    "expected true or false, without quotes, found {}",
                    other.found()
                );
                self.wrong(&entry.node, &self.join(key), message)
            }
        }
    }

    /// An expression of some of `x`, `y`, `z` and `t` that must be there.
    pub fn expression(&mut self, key: &str, unit: Unit, variables: &[&str]) -> Option<Expression> {
        self.find_or_report(key, &format!("expected {}", unit.describe()))?;
        self.optional_expression(key, unit, variables)
    }

    /// An expression that may be left out.
    pub fn optional_expression(
        &mut self,
        key: &str,
        unit: Unit,
        variables: &[&str],
    ) -> Option<Expression> {
        let entry = self.find(key)?;
        self.formula(&entry.node, &self.join(key), unit, variables)
    }

    /// A list of `len` expressions that must be there.
    pub fn expressions(
        &mut self,
        key: &str,
        unit: Unit,
        len: usize,
        variables: &[&str],
    ) -> Option<Vec<Expression>> {
        self.find_or_report(
            key,
            &format!("expected a list of {len}, each {}", unit.describe()),
        )?;
        self.optional_expressions(key, unit, len, variables)
    }

    /// A list of `len` expressions that may be left out.
    pub fn optional_expressions(
        &mut self,
        key: &str,
        unit: Unit,
        len: usize,
        variables: &[&str],
    ) -> Option<Vec<Expression>> {
        let items = self.items(key, len)?;
        all(items.iter().enumerate().map(|(i, item)| {
            let path = format!("{}[{i}]", self.join(key));
            self.formula(item, &path, unit, variables)
        }))
    }

    /// The values of a list that must have a certain length.
    pub(super) fn items(&mut self, key: &str, len: usize) -> Option<&'a [Node]> {
        let entry = self.find(key)?;
        let found = match &entry.node.value {
            Value::List(items) if items.len() == len => return Some(items),
            Value::List(items) => items.len().to_string(),
            other => format!("{}; write it in [ ]", other.found()),
        };
        let s = if len == 1 { "" } else { "s" };
        let why = match self.document.dimension.get() {
            Some(dimension) if dimension == len => format!(" because dimension = {dimension}"),
            _ => String::new(),
        };
        self.wrong(
            &entry.node,
            &self.join(key),
            format!("expected a list of {len} value{s}{why}, found {found}"),
        )
    }

    pub(super) fn number(&self, node: &Node, path: &str, unit: Unit, bound: Bound) -> Option<f64> {
        let value = self
            .formula(node, path, unit, &[])?
            .value(&Default::default());
        if value.is_nan() {
            return None; // It uses a constant whose problem has been reported.
        }
        let typed = match &node.value {
            Value::Text(text) => short(text.trim()),
            Value::Integer(_, text) | Value::Float(_, text) => short(text),
            _ => String::new(),
        };
        match breach(value, &typed, bound) {
            Some(message) => self.wrong(node, path, message),
            None => Some(value),
        }
    }

    pub(super) fn formula(
        &self,
        node: &Node,
        path: &str,
        unit: Unit,
        variables: &[&str],
    ) -> Option<Expression> {
        let message = match &node.value {
            Value::Integer(Some(number), _) => return Some(Expression::constant(*number as f64)),
            Value::Float(number, _) if number.is_finite() => {
                return Some(Expression::constant(*number));
            }
            Value::Text(text) => {
                match Expression::parse(text, unit, variables, &self.document.constants) {
                    Ok(expression) => return Some(expression),
                    Err(error) => {
                        let origin = self.document.within(&node.origin, text, &error.span);
                        self.document.add(Some(origin), path, error.message);
                        return None;
                    }
                }
            }
            Value::Integer(None, text) => format!(
                "{} is too large for a whole number; write it with a point",
                short(text)
            ),
            Value::Float(_, text) if text.contains("nan") || text.contains("inf") => {
                format!("{text} is not a finite number; give one")
            }
            Value::Float(_, text) => format!(
                "{} is too large for a number; give a smaller one",
                short(text)
            ),
            other => format!("expected {}, found {}", unit.describe(), other.found()),
        };
        self.wrong(node, path, message)
    }

    fn whole_number(&self, node: &Node, path: &str, min: i64, max: i64) -> Option<i64> {
        let message = match &node.value {
            Value::Integer(Some(number), _) if (min..=max).contains(number) => {
                return Some(*number);
            }
            Value::Integer(_, text) => format!("{} is not {}", short(text), whole(min, max)),
            other => format!("expected {}, found {}", whole(min, max), other.found()),
        };
        self.wrong(node, path, message)
    }
}

/// All values, or nothing; unlike a plain `collect` it visits them all, so that every problem is recorded.
pub(super) fn all<T>(values: impl Iterator<Item = Option<T>>) -> Option<Vec<T>> {
    values.collect::<Vec<_>>().into_iter().collect()
}

fn whole(min: i64, max: i64) -> String {
    match (min, max) {
        (i64::MIN, i64::MAX) => "a whole number".into(),
        (min, i64::MAX) => format!("a whole number of at least {min}"),
        (i64::MIN, max) => format!("a whole number of at most {max}"),
        (min, max) => format!("a whole number from {min} to {max}"),
    }
}

/// Why a value is not within its bound, if it is not.
fn breach(value: f64, typed: &str, bound: Bound) -> Option<String> {
    // Limits are shown in the unit that the user thinks in.
    let show = |limit: f64| match typed.strip_suffix("deg") {
        Some(_) => format!("{} deg", (limit * 180.0 / PI * 1e6).round() / 1e6),
        None => format!("{limit}"),
    };
    match bound {
        Bound::Positive if value <= 0.0 => Some(format!("{typed} is not positive")),
        Bound::NotNegative if value < 0.0 => Some(format!("{typed} is negative; give 0 or more")),
        Bound::Closed(lower, _) if value < lower => {
            Some(format!("{typed} is not at least {}", show(lower)))
        }
        Bound::Closed(_, upper) if value > upper => {
            Some(format!("{typed} is not at most {}", show(upper)))
        }
        Bound::Open(lower, _) if value <= lower => {
            Some(format!("{typed} is not above {}", show(lower)))
        }
        Bound::Open(_, upper) if value >= upper => {
            Some(format!("{typed} is not below {}", show(upper)))
        }
        _ => None,
    }
}
