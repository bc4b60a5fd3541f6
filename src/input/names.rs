//! The names in an expression: variables, constants and functions.

use super::Unit;
use super::compile::{Compiler, Step, fail};
use super::expression::{One, Op, Two};
use super::suggest::{hint, list, short};
use super::tokens::Kind;
use super::units;
use std::ops::Range;

/// What stands for a position or for time.
pub(super) const VARIABLES: &[&str] = &["x", "y", "z", "t"];

/// What a function does with dimensions.
#[derive(Clone, Copy, PartialEq)]
enum Rule {
    /// A pure number of a pure number.
    Pure,
    /// A pure number of anything.
    Free,
    /// The same.
    Same,
    /// The square root.
    Root,
}

const ONES: &[(&str, One, Rule)] = &[
    ("sin", One::Sin, Rule::Pure),
    ("cos", One::Cos, Rule::Pure),
    ("tan", One::Tan, Rule::Pure),
    ("asin", One::Asin, Rule::Pure),
    ("acos", One::Acos, Rule::Pure),
    ("atan", One::Atan, Rule::Pure),
    ("sinh", One::Sinh, Rule::Pure),
    ("cosh", One::Cosh, Rule::Pure),
    ("tanh", One::Tanh, Rule::Pure),
    ("exp", One::Exp, Rule::Pure),
    ("ln", One::Ln, Rule::Pure),
    ("log10", One::Log10, Rule::Pure),
    ("floor", One::Floor, Rule::Pure),
    ("ceil", One::Ceil, Rule::Pure),
    ("sqrt", One::Sqrt, Rule::Root),
    ("abs", One::Abs, Rule::Same),
    ("sign", One::Sign, Rule::Free),
    ("step", One::Step, Rule::Free),
];

const TWOS: &[(&str, Two, Rule)] = &[
    ("atan2", Two::Atan2, Rule::Free),
    ("hypot", Two::Hypot, Rule::Same),
    ("min", Two::Min, Rule::Same),
    ("max", Two::Max, Rule::Same),
];

/// Names that a constant must not have.
pub(super) fn reserved() -> impl Iterator<Item = &'static str> {
    let functions = ONES
        .iter()
        .map(|one| one.0)
        .chain(TWOS.iter().map(|two| two.0));
    functions
        .chain(["pi", "e"])
        .chain(VARIABLES.iter().copied())
}

impl Compiler<'_> {
    pub(super) fn name(&mut self, span: Range<usize>) -> Step<Option<Unit>> {
        let text = self.text;
        let name = &text[span.clone()];
        if let Some(number) = VARIABLES.iter().position(|variable| *variable == name) {
            if !self.variables.contains(&name) {
                let may = match self.variables {
                    [] => "this must be constant".to_string(),
                    some => format!("this may depend on {}", list(some, "and")),
                };
                return fail(format!("\"{name}\" cannot be used here; {may}"), span);
            }
            self.push(Op::Load(number as u8), &span)?;
            return Ok(Some(if name == "t" {
                Unit::TIME
            } else {
                Unit::LENGTH
            }));
        }
        if let Some(known) = self.constants.get(name).copied() {
            self.used.push(name.to_string());
            self.push(Op::Push(known.value), &span)?;
            return Ok(known.unit);
        }
        let number = match name {
            "pi" => std::f64::consts::PI,
            "e" => std::f64::consts::E,
            _ => return self.function(span),
        };
        self.push(Op::Push(number), &span)?;
        Ok(Some(Unit::NONE))
    }

    fn function(&mut self, span: Range<usize>) -> Step<Option<Unit>> {
        let text = self.text;
        let name = &text[span.clone()];
        let one = ONES.iter().find(|one| one.0 == name);
        let two = TWOS.iter().find(|two| two.0 == name);
        if one.is_none() && two.is_none() {
            let mut all: Vec<&str> = self.variables.to_vec();
            all.extend(self.constants.keys().map(String::as_str));
            for name in reserved().filter(|name| !VARIABLES.contains(name)) {
                all.push(name);
            }
            let message = match units::unit(name) {
                Some(_) => {
                    format!("the unit \"{name}\" needs a number before it: write \"1 {name}\"")
                }
                None => {
                    let hint = hint(name, all);
                    let hint = if hint.is_empty() {
                        "; add it to [constants]"
                    } else {
                        &hint
                    };
                    format!("unknown name \"{}\"{hint}", short(name))
                }
            };
            return fail(message, span);
        }
        if self.kind() != Kind::Sign('(') {
            return fail(format!("\"{name}\" is a function; write {name}(...)"), span);
        }
        let open = self.next().span;
        let mut unit = self.comparison()?;
        let mut count = 1;
        while self.kind() == Kind::Sign(',') {
            let comma = self.next().span;
            let right = self.comparison()?;
            count += 1;
            let Some((_, function, _)) = two else {
                continue;
            };
            unit = self.same(unit, right, comma)?;
            self.two(*function, span.start)?;
        }
        self.close(open)?;
        let variadic = matches!(two, Some((_, Two::Min | Two::Max, _)));
        let wanted = if one.is_some() { 1 } else { 2 };
        if count != wanted && !(variadic && count > 2) {
            let s = if wanted == 1 { "" } else { "s" };
            let span = span.start..self.tokens[self.at - 1].span.end;
            return fail(
                format!("{name} takes {wanted} argument{s}, found {count}"),
                span,
            );
        }
        if let Some((_, function, _)) = one {
            self.one(*function, span.start)?;
        }
        let rule = one
            .map(|one| one.2)
            .or(two.map(|two| two.2))
            .unwrap_or(Rule::Same);
        match (rule, unit) {
            (Rule::Pure, Some(found)) if found != Unit::NONE => {
                let advice = "divide it by one of its kind, such as a constant";
                fail(
                    format!(
                        "{name} needs a pure number or an angle, found {}; {advice}",
                        found.noun()
                    ),
                    span,
                )
            }
            (Rule::Pure | Rule::Free, _) => Ok(Some(Unit::NONE)),
            (Rule::Same, unit) => Ok(unit),
            (Rule::Root, unit) => Ok(unit.and_then(|unit| {
                let half = |exponent: i8| (exponent % 2 == 0).then_some(exponent / 2);
                Some(Unit::new(
                    half(unit.length)?,
                    half(unit.mass)?,
                    half(unit.time)?,
                ))
            })),
        }
    }
}
