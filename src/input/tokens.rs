//! Words and signs of an expression.

use super::ExpressionError;
use std::ops::Range;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    Number(f64),
    Name,
    /// `+ - * / ^ ( ) , < >`
    Sign(char),
    /// `<=`
    LessEqual,
    /// `>=`
    GreaterEqual,
    End,
}

#[derive(Clone, Debug)]
pub(super) struct Token {
    pub kind: Kind,
    pub span: Range<usize>,
}

/// Splits a text into tokens; the last one is always [`Kind::End`].
pub(super) fn split(text: &str) -> Result<Vec<Token>, ExpressionError> {
    let mut tokens = Vec::new();
    let mut at = 0;
    while let Some(c) = text[at..].chars().next() {
        let start = at;
        let rest = &text[at..];
        at += c.len_utf8();
        let mut push = |kind, end| {
            tokens.push(Token {
                kind,
                span: start..end,
            })
        };
        match c {
            c if c.is_whitespace() => {}
            '0'..='9' | '.' => {
                at = start + number_length(rest);
                let value: Option<f64> = text[start..at].parse().ok();
                match value {
                    Some(value) if value.is_finite() => push(Kind::Number(value), at),
                    Some(_) => {
                        return fail("this number is too large; give a smaller one", start..at);
                    }
                    None => {
                        return fail(
                            "this is not a number; write it as 12.5 or 1.25e1",
                            start..at,
                        );
                    }
                }
            }
            '<' | '>' if rest[1..].starts_with('=') => {
                at += 1;
                push(
                    if c == '<' {
                        Kind::LessEqual
                    } else {
                        Kind::GreaterEqual
                    },
                    at,
                );
            }
            '+' | '-' | '*' | '/' | '^' | '(' | ')' | ',' | '<' | '>' => push(Kind::Sign(c), at),
            '−' => push(Kind::Sign('-'), at),
            '·' | '×' | '⋅' => push(Kind::Sign('*'), at),
            '²' | '³' => {
                push(Kind::Sign('^'), at);
                push(Kind::Number(if c == '²' { 2.0 } else { 3.0 }), at);
            }
            '%' | '°' => push(Kind::Name, at),
            c if c.is_alphabetic() || c == '_' => {
                let word = |c: char| c.is_alphabetic() || c.is_ascii_digit() || c == '_';
                at = start + rest.find(|c| !word(c)).unwrap_or(rest.len());
                push(Kind::Name, at);
            }
            '=' => {
                let message = "\"=\" means nothing here; comparisons are <, <=, > and >=";
                return fail(message, start..at);
            }
            _ => {
                let shown = c.escape_debug();
                return fail(
                    &format!("the character '{shown}' means nothing here; remove it"),
                    start..at,
                );
            }
        }
    }
    tokens.push(Token {
        kind: Kind::End,
        span: at..at,
    });
    Ok(tokens)
}

fn fail<T>(message: &str, span: Range<usize>) -> Result<T, ExpressionError> {
    Err(ExpressionError {
        message: message.to_string(),
        span,
    })
}

/// The bytes of the number at the start of `text`; an `e` counts only if digits follow it.
fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digits = |from: usize| {
        bytes[from..]
            .iter()
            .take_while(|byte| byte.is_ascii_digit())
            .count()
    };
    let mut end = digits(0);
    if bytes.get(end) == Some(&b'.') {
        end += 1 + digits(end + 1);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        if bytes.get(end + 1 + sign).is_some_and(u8::is_ascii_digit) {
            end += 1 + sign + digits(end + 1 + sign);
        }
    }
    end
}
