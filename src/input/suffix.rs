//! The unit behind a number: `8.96 g/cm^3`.

use super::compile::{Compiler, Step, fail};
use super::names::{VARIABLES, reserved};
use super::suggest::{list, short};
use super::tokens::Kind;
use super::{Quantity, Unit, units};
use std::ops::Range;

impl Compiler<'_> {
    /// The unit behind a number, if there is one.
    pub(super) fn unit(&mut self, value: f64, number: Range<usize>) -> Step<Quantity> {
        let mut quantity = Quantity { value, unit: None };
        let mut power = 1;
        let mut divided = false;
        let (mut up, mut down) = (1.0, 1.0);
        // "5 1/s" and "5/s" mean 5 s^-1.
        let one = self.kind() == Kind::Number(1.0) && self.kind_after(1) == Kind::Sign('/');
        if one && self.is_unit(2) {
            self.at += 1;
        }
        if self.kind() == Kind::Sign('/') && self.is_unit(1) {
            let name = &self.text[self.tokens[self.at + 1].span.clone()];
            if one || !self.constants.contains_key(name) {
                self.at += 1;
                (power, divided) = (-1, true);
            }
        }
        while self.kind() == Kind::Name {
            let span = self.next().span;
            let name = &self.text[span.clone()];
            if quantity.unit.is_some() && self.constants.contains_key(name) {
                let message = format!(
                    "\"{name}\" is a unit and a constant; rename the constant or write ({name})"
                );
                return fail(message, span);
            }
            let Some((factor, unit)) = units::unit(name) else {
                return fail(self.unknown_unit(name), span);
            };
            let exponent = power * self.unit_exponent()?;
            let unit = self.combine(quantity.unit.unwrap_or(Unit::NONE), unit, exponent, span)?;
            // Most factors are powers of ten or their inverses; only the first are exact, so keep them apart.
            let inverse = factor.recip().round();
            let small = factor < 1.0 && (inverse * factor - 1.0).abs() < 1e-12;
            let scale = if small { inverse } else { factor }.powi(exponent.abs());
            if small == (exponent < 0) {
                up *= scale
            } else {
                down *= scale
            }
            quantity.unit = Some(unit);
            power = 1;
            match self.kind() {
                Kind::Sign(sign @ ('*' | '/')) if self.is_unit(1) => {
                    self.at += 1;
                    divided |= sign == '/';
                    power = if sign == '/' { -1 } else { 1 };
                }
                Kind::Name if divided => {
                    let message =
                        "it is not clear what \"/\" divides by here; put * or / between all units";
                    return fail(message, self.next().span);
                }
                Kind::Name => {}
                _ => break,
            }
        }
        quantity.value = if up >= down {
            value * (up / down)
        } else {
            value / (down / up)
        };
        if !quantity.value.is_finite() {
            return fail(
                "this number is too large in SI units; give a smaller one",
                number,
            );
        }
        Ok(quantity)
    }

    /// `^3`, `^-3` or `^(-3)` behind a unit.
    fn unit_exponent(&mut self) -> Step<i32> {
        if self.kind() != Kind::Sign('^') {
            return Ok(1);
        }
        let span = self.next().span;
        let open = self.kind() == Kind::Sign('(');
        self.at += usize::from(open);
        let negative = self.kind() == Kind::Sign('-');
        self.at += usize::from(negative);
        let exponent = match self.next().kind {
            Kind::Number(number) if number.fract() == 0.0 && number <= 9.0 => number as i32,
            _ => {
                return fail(
                    "a unit takes a whole exponent up to 9; put the quantity in parentheses",
                    span,
                );
            }
        };
        if open {
            self.close(span)?;
        }
        Ok(if negative { -exponent } else { exponent })
    }

    fn unknown_unit(&self, name: &str) -> String {
        let known = self.constants.contains_key(name) || reserved().any(|word| word == name);
        match units::suggestion(name) {
            _ if known => format!("expected an operator before \"{name}\"; to multiply, write *"),
            Some(near) => format!("unknown unit \"{}\"; did you mean \"{near}\"?", short(name)),
            None => {
                let known: Vec<&str> = Quantity::units().collect();
                format!(
                    "unknown unit \"{}\"; known are {}, with SI prefixes",
                    short(name),
                    list(&known, "and")
                )
            }
        }
    }

    /// True if the token after `skip` others is a unit and nothing else.
    fn is_unit(&self, skip: usize) -> bool {
        let Some(token) = self.tokens.get(self.at + skip) else {
            return false;
        };
        let name = &self.text[token.span.clone()];
        token.kind == Kind::Name
            && !VARIABLES.contains(&name)
            && self.kind_after(skip + 1) != Kind::Sign('(')
            && units::unit(name).is_some()
    }
}
