//! Aligned text tables for a terminal.

use std::fmt;
use std::io::IsTerminal;

/// One entry of a table.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cell {
    text: String,
    paint: &'static str,
}

impl Cell {
    /// A green PASS or a red FAIL.
    pub fn verdict(passed: bool) -> Self {
        let (text, paint) = if passed {
            ("PASS", "\x1b[32m")
        } else {
            ("FAIL", "\x1b[1;31m")
        };
        Self {
            text: text.to_owned(),
            paint,
        }
    }
}

impl Cell {
    /// A green "survives" or a red "FAILS".
    pub fn survival(survives: bool) -> Self {
        let (text, paint) = if survives {
            ("survives", "\x1b[32m")
        } else {
            ("FAILS", "\x1b[1;31m")
        };
        Self {
            text: text.to_owned(),
            paint,
        }
    }
}

impl<T: fmt::Display> From<T> for Cell {
    fn from(value: T) -> Self {
        // A line break would tear the table.
        Self {
            text: value.to_string().replace(['\n', '\r', '\t'], " "),
            paint: "",
        }
    }
}

/// Which side a column leans to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Align {
    /// As text.
    Left,
    /// As numbers.
    Right,
}

/// Rows under a line of headers, in columns as wide as needed.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Table {
    headers: Vec<Cell>,
    rows: Vec<Vec<Cell>>,
    align: Vec<Option<Align>>,
    colored: bool,
}

impl Table {
    /// A table without rows.
    pub fn new<T: Into<Cell>>(headers: impl IntoIterator<Item = T>) -> Self {
        Self {
            headers: headers.into_iter().map(Into::into).collect(),
            ..Self::default()
        }
    }

    /// Adds a row. Missing cells are blank; those beyond the headers get columns without one.
    pub fn row<T: Into<Cell>>(mut self, cells: impl IntoIterator<Item = T>) -> Self {
        self.push(cells);
        self
    }

    /// Adds a row to a table that is kept.
    pub fn push<T: Into<Cell>>(&mut self, cells: impl IntoIterator<Item = T>) {
        self.rows.push(cells.into_iter().map(Into::into).collect());
    }

    /// Aligns a column (from 0). Of itself, a column leans right where all of its cells are numbers, else left.
    pub fn align(mut self, column: usize, align: Align) -> Self {
        if self.align.len() <= column {
            self.align.resize(column + 1, None);
        }
        self.align[column] = Some(align);
        self
    }

    /// Colors verdicts, or not; a new table has no color.
    pub fn colored(mut self, colored: bool) -> Self {
        self.colored = colored;
        self
    }

    /// Colors verdicts if standard output is a terminal and the variable `NO_COLOR` is not set (<https://no-color.org>).
    pub fn colored_on_terminal(self) -> Self {
        let refused = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
        self.colored(!refused && std::io::stdout().is_terminal())
    }

    fn leaning(&self, column: usize) -> Align {
        let mut cells = self
            .rows
            .iter()
            .filter_map(|row| row.get(column))
            .filter(|c| !c.text.is_empty())
            .peekable();
        let numbers = cells.peek().is_some() && cells.all(|c| is_number(&c.text));
        let own = if numbers { Align::Right } else { Align::Left };
        self.align.get(column).copied().flatten().unwrap_or(own)
    }
}

/// Whether a cell is a number, with at most a unit or a percent sign after it.
fn is_number(text: &str) -> bool {
    let first = text.split_whitespace().next().unwrap_or("");
    let first = first
        .trim_start_matches(['<', '>', '≤', '≥', '±'])
        .trim_end_matches(['%', 'x', '×']);
    matches!(text, "-" | "–" | "—") || first.replace('−', "-").parse::<f64>().is_ok()
}

impl fmt::Display for Table {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let columns = self
            .rows
            .iter()
            .map(Vec::len)
            .chain([self.headers.len()])
            .max()
            .unwrap_or(0);
        let lines = || std::iter::once(&self.headers).chain(&self.rows);
        let width = |column: usize| {
            lines()
                .filter_map(|l| l.get(column))
                .map(|c| c.text.chars().count())
                .max()
        };
        let widths: Vec<usize> = (0..columns).map(|c| width(c).unwrap_or(0)).collect();
        let aligns: Vec<Align> = (0..columns).map(|c| self.leaning(c)).collect();
        for (i, line) in lines().enumerate() {
            let mut text = String::new();
            for column in 0..columns {
                let cell = line.get(column).cloned().unwrap_or_default();
                let pad = " ".repeat(widths[column] - cell.text.chars().count());
                let shown = if self.colored && !cell.paint.is_empty() {
                    format!("{}{}\x1b[0m", cell.paint, cell.text)
                } else {
                    cell.text
                };
                let gap = if column == 0 { "" } else { "  " };
                text += &match aligns[column] {
                    Align::Left => format!("{gap}{shown}{pad}"),
                    Align::Right => format!("{gap}{pad}{shown}"),
                };
            }
            writeln!(out, "{}", text.trim_end())?;
            if i == 0 {
                let rules: Vec<String> = widths.iter().map(|&w| "─".repeat(w)).collect();
                writeln!(out, "{}", rules.join("  "))?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> Table {
        Table::new(["case", "error", "verdict"])
            .row([Cell::from("bar"), Cell::from("1.5e-3"), Cell::verdict(true)])
            .row([
                Cell::from("αβγδε"),
                Cell::from("12 %"),
                Cell::verdict(false),
            ])
    }

    #[test]
    fn numbers_lean_right_and_text_leans_left() {
        let expected = "\
case    error  verdict
─────  ──────  ───────
bar    1.5e-3  PASS
αβγδε    12 %  FAIL
";
        assert_eq!(sample().to_string(), expected);
    }

    #[test]
    fn color_changes_no_column() {
        let colored = sample().colored(true).to_string();
        assert!(colored.contains("\x1b[32mPASS\x1b[0m"));
        let bare = colored
            .replace("\x1b[32m", "")
            .replace("\x1b[1;31m", "")
            .replace("\x1b[0m", "");
        assert_eq!(bare, sample().to_string());
    }

    #[test]
    fn short_long_and_missing_rows_are_shown() {
        let table = Table::new(["a"])
            .row(["1", "2"])
            .row(Vec::<Cell>::new())
            .align(0, Align::Left);
        assert_eq!(table.to_string(), "a\n─  ─\n1  2\n\n");
        assert_eq!(Table::default().to_string(), "\n\n");
    }
}
