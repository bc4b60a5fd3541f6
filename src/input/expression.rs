//! Arithmetic in scenario files: compiled once, evaluated for every point.

use super::{Quantity, Unit, compile};
use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;

/// What an expression may depend on.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Variables {
    /// Position, m.
    pub position: [f64; 3],
    /// Time, s.
    pub time: f64,
}

/// Why a text is not an expression.
#[derive(Clone, Debug, PartialEq)]
pub struct ExpressionError {
    /// What is wrong and what to do.
    pub message: String,
    /// Bytes of the text.
    pub span: Range<usize>,
}

impl fmt::Display for ExpressionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for ExpressionError {}

/// More values than this are never waiting at the same time; longer programs are refused when they are compiled.
pub(super) const STACK: usize = 32;

/// Parts of an expression that can be kept for a second use.
pub(super) const SLOTS: usize = 32;

/// A compiled expression.
#[derive(Clone, Debug, PartialEq)]
pub struct Expression {
    pub(super) program: Box<[Op]>,
}

/// One instruction of a stack machine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Op {
    Push(f64),
    /// 0, 1, 2 for x, y, z and 3 for t.
    Load(u8),
    One(One),
    Two(Two),
    /// Copies the last value into a slot.
    Keep(u8),
    /// Takes the value of a slot.
    Recall(u8),
}

/// A function of one argument.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum One {
    Negate,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sinh,
    Cosh,
    Tanh,
    Exp,
    Ln,
    Log10,
    Sqrt,
    Abs,
    Sign,
    Floor,
    Ceil,
    Step,
}

/// A function of two arguments.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Two {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    Atan2,
    Hypot,
    Min,
    Max,
}

impl One {
    pub fn of(self, a: f64) -> f64 {
        match self {
            One::Negate => -a,
            One::Sin => a.sin(),
            One::Cos => a.cos(),
            One::Tan => a.tan(),
            One::Asin => a.asin(),
            One::Acos => a.acos(),
            One::Atan => a.atan(),
            One::Sinh => a.sinh(),
            One::Cosh => a.cosh(),
            One::Tanh => a.tanh(),
            One::Exp => a.exp(),
            One::Ln => a.ln(),
            One::Log10 => a.log10(),
            One::Sqrt => a.sqrt(),
            One::Abs => a.abs(),
            One::Sign if a == 0.0 => 0.0,
            One::Sign => a.signum(),
            One::Floor => a.floor(),
            One::Ceil => a.ceil(),
            One::Step => f64::from(a >= 0.0),
        }
    }
}

impl Two {
    pub fn of(self, a: f64, b: f64) -> f64 {
        match self {
            Two::Add => a + b,
            Two::Subtract => a - b,
            Two::Multiply => a * b,
            Two::Divide => a / b,
            // A whole exponent is exact for negative bases too, and faster.
            Two::Power if b.fract() == 0.0 && b.abs() <= 64.0 => a.powi(b as i32),
            Two::Power => a.powf(b),
            Two::Less => f64::from(a < b),
            Two::LessEqual => f64::from(a <= b),
            Two::Greater => f64::from(a > b),
            Two::GreaterEqual => f64::from(a >= b),
            Two::Atan2 => a.atan2(b),
            Two::Hypot => a.hypot(b),
            Two::Min => a.min(b),
            Two::Max => a.max(b),
        }
    }
}

impl Expression {
    /// Compiles `text`, whose value has to be an `expected`, and which may depend on `variables` (of `x`, `y`, `z`, `t`) and
    /// on `constants`.
    pub fn parse(
        text: &str,
        expected: Unit,
        variables: &[&str],
        constants: &BTreeMap<String, Quantity>,
    ) -> Result<Expression, ExpressionError> {
        compile::expression(text, expected, variables, constants)
    }

    /// The same value everywhere and always.
    pub fn constant(value: f64) -> Self {
        Expression {
            program: Box::new([Op::Push(value)]),
        }
    }

    /// True if it depends on no variable.
    pub fn is_constant(&self) -> bool {
        !self.program.iter().any(|op| matches!(op, Op::Load(_)))
    }

    /// True if it depends on time.
    pub fn depends_on_time(&self) -> bool {
        self.program.contains(&Op::Load(3))
    }

    /// True if it depends on the position along an axis, 0, 1 or 2.
    pub fn depends_on_axis(&self, axis: usize) -> bool {
        self.program.contains(&Op::Load(axis as u8))
    }

    /// As a component of a vector field: whether the field has no part along `axis` for it, and is the same all along that axis.
    pub fn is_uniform_along(&self, axis: usize, component: usize) -> bool {
        if component == axis {
            self.is_constant() && self.value(&Variables::default()) == 0.0
        } else {
            !self.depends_on_axis(axis)
        }
    }

    /// As a component of a vector field: the same component of the field's image in a mirror across `axis`, wherever that stands;
    /// `None` where that is not certain.
    pub fn mirrored(&self, axis: usize, component: usize) -> Option<Self> {
        if component != axis {
            return (!self.depends_on_axis(axis)).then(|| self.clone());
        }
        let value = self.value(&Variables::default());
        self.is_constant().then(|| Self::constant(-value))
    }

    /// Its value in SI units. Not finite where the formula is not defined.
    pub fn value(&self, at: &Variables) -> f64 {
        if let [Op::Push(value)] = *self.program {
            return value;
        }
        let mut stack = [0.0; STACK];
        let mut slots = [0.0; SLOTS];
        let mut top = 0;
        for op in &self.program {
            match *op {
                Op::Push(value) => {
                    stack[top] = value;
                    top += 1;
                }
                Op::Load(number) => {
                    stack[top] = if number < 3 {
                        at.position[usize::from(number)]
                    } else {
                        at.time
                    };
                    top += 1;
                }
                Op::Keep(slot) => slots[usize::from(slot)] = stack[top - 1],
                Op::Recall(slot) => {
                    stack[top] = slots[usize::from(slot)];
                    top += 1;
                }
                Op::One(function) => stack[top - 1] = function.of(stack[top - 1]),
                Op::Two(function) => {
                    top -= 1;
                    stack[top - 1] = function.of(stack[top - 1], stack[top]);
                }
            }
        }
        stack[0]
    }
}
