//! Something wrong in the input, and how it is shown.

use super::suggest::short;
use std::fmt;
use std::fmt::Write as _;
use std::ops::Range;

/// Something wrong in the input.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// Line in the file, from 1; `None` if it lies nowhere in the file (a key that is missing at the top, an override).
    pub line: Option<usize>,
    /// Dotted key, `body[0].velocity[1]`; empty for the file as a whole.
    pub key: String,
    /// What is wrong and what to do.
    pub message: String,
    /// Bytes of the file.
    pub span: Option<Range<usize>>,
    /// The override `KEY=VALUE` that brought it, if one did.
    pub setting: Option<String>,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let place = match (&self.setting, self.line) {
            (Some(setting), _) => format!("--set {}", short(setting)),
            (None, Some(line)) => format!("line {line}"),
            (None, None) => String::new(),
        };
        let typed = self
            .setting
            .as_deref()
            .and_then(|setting| setting.split('=').next());
        let key = if typed.is_some_and(|typed| typed.trim() == self.key) {
            ""
        } else {
            &self.key
        };
        let comma = if place.is_empty() || key.is_empty() {
            ""
        } else {
            ", "
        };
        let colon = if place.is_empty() && key.is_empty() {
            ""
        } else {
            ": "
        };
        write!(f, "{place}{comma}{key}{colon}{}", self.message)
    }
}

/// All problems of one file, for people: a headline, then each problem with its place and its line.
pub fn report(path: &str, source: &str, problems: &[Problem]) -> String {
    let count = problems.len();
    let mut out = format!(
        "error: {path} has {count} problem{}\n",
        if count == 1 { "" } else { "s" }
    );
    let mut sorted: Vec<&Problem> = problems.iter().collect();
    sorted.sort_by_key(|problem| order(problem));
    let width = sorted
        .iter()
        .filter_map(|problem| problem.line)
        .max()
        .unwrap_or(0)
        .to_string()
        .len();
    for problem in sorted {
        let _ = writeln!(out, "  {problem}");
        if let Some((line, (text, marker))) = problem
            .line
            .zip(problem.span.as_ref().and_then(|s| excerpt(source, s)))
        {
            let _ = writeln!(out, "    {line:>width$} | {text}");
            let _ = writeln!(out, "    {:>width$} | {marker}", "");
        }
    }
    out
}

/// Problems of the file by place, then those without a place.
pub(super) fn order(problem: &Problem) -> (bool, usize, usize) {
    let start = problem.span.as_ref().map_or(0, |span| span.start);
    (problem.line.is_none(), problem.line.unwrap_or(0), start)
}

/// The line of byte `at`, from 1.
pub(super) fn line_of(source: &str, at: usize) -> usize {
    source.as_bytes()[..at.min(source.len())]
        .iter()
        .filter(|byte| **byte == b'\n')
        .count()
        + 1
}

/// The source line where `span` starts, cut to a readable width, and a marker line under it.
fn excerpt(source: &str, span: &Range<usize>) -> Option<(String, String)> {
    const WIDTH: usize = 100;
    let before = source.get(..span.start)?;
    let begin = before.rfind('\n').map_or(0, |at| at + 1);
    let line = source[begin..].split('\n').next()?.trim_end_matches('\r');
    let column = source[begin..span.start].chars().count();
    let marked = source
        .get(span.start..span.end)?
        .split('\n')
        .next()?
        .trim_end_matches('\r')
        .chars()
        .count();
    let plain = |c: char| if c.is_control() { ' ' } else { c };
    let length = line.chars().count();
    let start = if length <= WIDTH {
        0
    } else {
        column.saturating_sub(WIDTH / 3)
    };
    let mut text: String = line.chars().skip(start).take(WIDTH).map(plain).collect();
    let mut column = column - start;
    if start > 0 {
        text.insert(0, '…');
        column += 1;
    }
    let room = text.chars().count().saturating_sub(column).max(1);
    if start + WIDTH < length {
        text.push('…');
    }
    let marker = format!(
        "{}{}",
        " ".repeat(column),
        "^".repeat(marked.clamp(1, room))
    );
    Some((text.trim_end().to_string(), marker))
}
