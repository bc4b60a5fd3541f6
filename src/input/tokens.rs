//! Words and signs of an expression.
