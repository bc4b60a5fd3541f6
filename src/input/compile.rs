//! From text to an [`Expression`]: a recursive descent that checks dimensions as it goes and folds what is constant.
//!
//! From loose to tight: comparison, `+ -`, `* /`, sign, `^`. A unit binds tighter than anything: `2 / 4 m` is 0.5 per metre.

use super::expression::{One, Op, STACK, Two};
use super::suggest::short;
use super::tokens::{Kind, Token, split};
use super::{Expression, ExpressionError, Quantity, Unit};
use std::collections::BTreeMap;
use std::ops::Range;

/// Longer texts are refused.
const LONGEST: usize = 10_000;
/// Deeper nesting is refused, long before the machine's own stack ends.
const DEEPEST: usize = 100;

pub(super) type Step<T> = Result<T, ExpressionError>;
type Constants = BTreeMap<String, Quantity>;

pub(super) fn expression(
    text: &str,
    expected: Unit,
    variables: &[&str],
    constants: &Constants,
) -> Step<Expression> {
    let mut compiler = Compiler::new(text, variables, constants)?;
    if let [Token { span, .. }] = compiler.tokens.as_slice() {
        return fail(
            format!("expected {}, found an empty text", expected.describe()),
            span.clone(),
        );
    }
    let unit = compiler.whole()?;
    if let Some(found) = unit
        && found != expected
    {
        let advice = match found {
            Unit::NONE => "; give it a unit by a factor such as \"1 m/s\"",
            _ => "",
        };
        let trimmed = text.trim();
        let start = text.len() - text.trim_start().len();
        let message = format!(
            "expected {}, found \"{}\", {}{advice}",
            expected.describe(),
            short(trimmed),
            found.noun()
        );
        return fail(message, start..start + trimmed.len());
    }
    Ok(Expression {
        program: super::share::share(&compiler.program).into(),
    })
}

/// The value of a constant expression, whatever its dimension.
pub(super) fn quantity(text: &str, constants: &Constants) -> Step<Quantity> {
    let mut compiler = Compiler::new(text, &[], constants)?;
    let unit = compiler.whole()?;
    let value = Expression {
        program: compiler.program.into(),
    }
    .value(&Default::default());
    Ok(Quantity { value, unit })
}

/// The constants that a text refers to, as far as it can be read.
pub(super) fn references(text: &str, constants: &Constants) -> Vec<String> {
    let Ok(mut compiler) = Compiler::new(text, &[], constants) else {
        return Vec::new();
    };
    let _ = compiler.whole();
    compiler.used
}

pub(super) fn fail<T>(message: impl Into<String>, span: Range<usize>) -> Step<T> {
    Err(ExpressionError {
        message: message.into(),
        span,
    })
}

/// A text on its way to a program; its methods are one grammar rule each, in three files.
pub(super) struct Compiler<'t> {
    pub(super) text: &'t str,
    pub(super) variables: &'t [&'t str],
    pub(super) constants: &'t Constants,
    pub(super) tokens: Vec<Token>,
    pub(super) at: usize,
    pub(super) depth: usize,
    pub(super) height: usize,
    pub(super) program: Vec<Op>,
    pub(super) used: Vec<String>,
}

impl<'t> Compiler<'t> {
    fn new(text: &'t str, variables: &'t [&'t str], constants: &'t Constants) -> Step<Self> {
        if text.len() > LONGEST {
            return fail(
                format!("this is longer than {LONGEST} characters; shorten it"),
                0..text.len(),
            );
        }
        let tokens = split(text)?;
        let (program, used) = (Vec::new(), Vec::new());
        Ok(Compiler {
            text,
            variables,
            constants,
            tokens,
            at: 0,
            depth: 0,
            height: 0,
            program,
            used,
        })
    }

    fn whole(&mut self) -> Step<Option<Unit>> {
        let unit = self.comparison()?;
        let next = self.next();
        match next.kind {
            Kind::End => Ok(unit),
            Kind::Sign(')') => fail("this \")\" closes nothing; remove it", next.span),
            Kind::Sign(',') => fail(
                "a comma only separates arguments; the decimal mark is a point",
                next.span,
            ),
            Kind::Sign('<' | '>') | Kind::LessEqual | Kind::GreaterEqual => fail(
                "comparisons cannot be chained; write (a < b) * (b < c)",
                next.span,
            ),
            _ => {
                let word = &self.text[next.span.clone()];
                fail(
                    format!(
                        "expected an operator before \"{}\"; to multiply, write *",
                        short(word)
                    ),
                    next.span,
                )
            }
        }
    }

    pub(super) fn comparison(&mut self) -> Step<Option<Unit>> {
        let start = self.start();
        let left = self.sum()?;
        let two = match self.kind() {
            Kind::Sign('<') => Two::Less,
            Kind::Sign('>') => Two::Greater,
            Kind::LessEqual => Two::LessEqual,
            Kind::GreaterEqual => Two::GreaterEqual,
            _ => return Ok(left),
        };
        let sign = self.next().span;
        let right = self.sum()?;
        self.same(left, right, sign)?;
        self.two(two, start)?;
        Ok(Some(Unit::NONE))
    }

    fn sum(&mut self) -> Step<Option<Unit>> {
        let start = self.start();
        let mut unit = self.product()?;
        while let Kind::Sign(sign @ ('+' | '-')) = self.kind() {
            let span = self.next().span;
            let right = self.product()?;
            unit = self.same(unit, right, span)?;
            self.two(if sign == '+' { Two::Add } else { Two::Subtract }, start)?;
        }
        Ok(unit)
    }

    fn product(&mut self) -> Step<Option<Unit>> {
        let start = self.start();
        let mut unit = self.signed()?;
        while let Kind::Sign(sign @ ('*' | '/')) = self.kind() {
            let span = self.next().span;
            let right = self.signed()?;
            unit = match unit.zip(right) {
                Some((a, b)) => Some(self.combine(a, b, if sign == '*' { 1 } else { -1 }, span)?),
                None => None,
            };
            self.two(
                if sign == '*' {
                    Two::Multiply
                } else {
                    Two::Divide
                },
                start,
            )?;
        }
        Ok(unit)
    }

    /// Every recursion passes through here.
    fn signed(&mut self) -> Step<Option<Unit>> {
        let start = self.start();
        self.depth += 1;
        if self.depth > DEEPEST {
            let span = self.next().span;
            return fail(
                format!("this is nested more than {DEEPEST} levels deep; simplify it"),
                span,
            );
        }
        let unit = match self.kind() {
            Kind::Sign('-') => {
                self.next();
                let unit = self.signed()?;
                self.one(One::Negate, start)?;
                unit
            }
            Kind::Sign('+') => {
                self.next();
                self.signed()?
            }
            _ => self.power()?,
        };
        self.depth -= 1;
        Ok(unit)
    }

    fn power(&mut self) -> Step<Option<Unit>> {
        let start = self.start();
        let base = self.atom()?;
        if self.kind() != Kind::Sign('^') {
            return Ok(base);
        }
        let span = self.next().span;
        let exponent = self.signed()?;
        if let Some(found) = exponent.filter(|unit| *unit != Unit::NONE) {
            return fail(
                format!("an exponent must be a pure number, found {}", found.noun()),
                span,
            );
        }
        let unit = match (base, self.program.last()) {
            (None | Some(Unit::NONE), _) => base,
            (Some(unit), Some(Op::Push(number)))
                if number.fract() == 0.0 && number.abs() <= 127.0 =>
            {
                Some(self.combine(Unit::NONE, unit, *number as i32, span)?)
            }
            (Some(_), Some(Op::Push(_))) => None,
            (Some(unit), _) => {
                return fail(
                    format!("{} cannot have an exponent that varies", unit.noun()),
                    span,
                );
            }
        };
        self.two(Two::Power, start)?;
        Ok(unit)
    }

    fn atom(&mut self) -> Step<Option<Unit>> {
        let token = self.next();
        match token.kind {
            Kind::Number(value) => {
                let unit = self.unit(value, token.span.clone())?;
                self.push(Op::Push(unit.value), &token.span)?;
                Ok(unit.unit)
            }
            Kind::Sign('(') => {
                let unit = self.comparison()?;
                self.close(token.span)?;
                Ok(unit)
            }
            Kind::Name => self.name(token.span),
            Kind::End => fail(
                "the text ends where a value is expected; complete it",
                token.span,
            ),
            _ => {
                let word = &self.text[token.span.clone()];
                fail(format!("expected a value, found \"{word}\""), token.span)
            }
        }
    }

    pub(super) fn combine(&self, a: Unit, b: Unit, power: i32, span: Range<usize>) -> Step<Unit> {
        let message = "the exponents of this unit are too large; simplify it";
        a.combine(b, power).ok_or_else(|| ExpressionError {
            message: message.into(),
            span,
        })
    }

    /// The common dimension of two sides; a bare number takes that of the other.
    pub(super) fn same(
        &self,
        a: Option<Unit>,
        b: Option<Unit>,
        span: Range<usize>,
    ) -> Step<Option<Unit>> {
        match a.zip(b) {
            Some((a, b)) if a != b => {
                let sign = &self.text[span.clone()];
                let message = format!(
                    "both sides of \"{sign}\" must be of one kind, found {} and {}",
                    a.noun(),
                    b.noun()
                );
                fail(message, span)
            }
            _ => Ok(a.or(b)),
        }
    }

    pub(super) fn push(&mut self, op: Op, span: &Range<usize>) -> Step<()> {
        self.height += 1;
        if self.height > STACK {
            return fail(
                "this formula keeps too many values open; simplify it",
                span.clone(),
            );
        }
        self.program.push(op);
        Ok(())
    }

    pub(super) fn one(&mut self, one: One, start: usize) -> Step<()> {
        match self.program.as_mut_slice() {
            [.., Op::Push(a)] => {
                let value = one.of(*a);
                let known = !a.is_nan();
                *a = value;
                self.finite(value, known, start)
            }
            _ => {
                self.program.push(Op::One(one));
                Ok(())
            }
        }
    }

    pub(super) fn two(&mut self, two: Two, start: usize) -> Step<()> {
        self.height -= 1;
        match self.program.as_mut_slice() {
            [.., Op::Push(a), Op::Push(b)] => {
                let value = two.of(*a, *b);
                let known = !a.is_nan() && !b.is_nan();
                *a = value;
                self.program.pop();
                self.finite(value, known, start)
            }
            _ => {
                self.program.push(Op::Two(two));
                Ok(())
            }
        }
    }

    /// Constants that could not be read are NaN: their own problem has been reported.
    fn finite(&self, value: f64, known: bool, start: usize) -> Step<()> {
        if value.is_finite() || !known {
            return Ok(());
        }
        let span = start..self.tokens[self.at - 1].span.end;
        let formula = short(&self.text[span.clone()]);
        fail(
            format!("\"{formula}\" is {value}, which is not a finite number"),
            span,
        )
    }

    pub(super) fn close(&mut self, open: Range<usize>) -> Step<()> {
        let next = self.next();
        match next.kind {
            Kind::Sign(')') => Ok(()),
            Kind::End => fail("this \"(\" is never closed; add \")\"", open),
            _ => {
                let word = &self.text[next.span.clone()];
                fail(
                    format!("expected an operator or \")\" before \"{}\"", short(word)),
                    next.span,
                )
            }
        }
    }

    pub(super) fn kind(&self) -> Kind {
        self.kind_after(0)
    }

    pub(super) fn kind_after(&self, skip: usize) -> Kind {
        self.tokens
            .get(self.at + skip)
            .map_or(Kind::End, |token| token.kind)
    }

    fn start(&self) -> usize {
        self.tokens[self.at.min(self.tokens.len() - 1)].span.start
    }

    /// The next token; the last one again and again.
    pub(super) fn next(&mut self) -> Token {
        let token = self.tokens[self.at.min(self.tokens.len() - 1)].clone();
        self.at = (self.at + 1).min(self.tokens.len());
        token
    }
}
