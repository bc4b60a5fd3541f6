//! A whole file: its tree, its overrides, its constants and its problems.

use super::problem::{line_of, order};
use super::tree::{Origin, Table};
use super::{Parameters, Problem, Quantity, Reader, constants, overrides};
use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::ops::Range;

/// A parsed file with its overrides.
#[derive(Debug)]
pub struct Document {
    source: String,
    resolved: String,
    pub(super) root: Table,
    pub(super) constants: BTreeMap<String, Quantity>,
    pub(super) dimension: Cell<Option<usize>>,
    pub(super) settings: Vec<String>,
    /// True if the text itself is broken: what is missing may only be hidden.
    pub(super) broken: bool,
    problems: RefCell<Vec<Problem>>,
}

impl Document {
    /// Parses `source` and applies `settings`, each `KEY=VALUE`. It never fails: see [`Document::problems`].
    pub fn parse(source: &str, settings: &[String]) -> Self {
        let mut document = Document {
            source: source.to_string(),
            resolved: source.to_string(),
            root: Table::default(),
            constants: BTreeMap::new(),
            dimension: Cell::new(None),
            settings: settings.to_vec(),
            broken: false,
            problems: RefCell::default(),
        };
        let (table, errors) = toml::de::DeTable::parse_recoverable(source);
        document.root = Table::new(table.get_ref(), &Origin::File);
        document.broken = !errors.is_empty();
        // One slip in a line often breaks the rest of it: the first error says enough.
        let start = |error: &toml::de::Error| error.span().map_or(0, |span| span.start);
        let mut errors: Vec<(usize, toml::de::Error)> = errors
            .into_iter()
            .map(|error| (line_of(source, start(&error)), error))
            .collect();
        errors.sort_by_key(|(_, error)| start(error));
        errors.dedup_by_key(|(line, _)| *line);
        for (_, error) in &errors {
            let origin = error.span().map(Origin::File);
            document.add(
                origin,
                "",
                format!(
                    "this is not valid TOML: {}",
                    error.message().replace('\n', ", ")
                ),
            );
        }
        overrides::apply(&mut document);
        constants::resolve(&mut document);
        document
    }

    /// As [`Document::parse`], from bytes that may not be text.
    pub fn from_bytes(bytes: &[u8], settings: &[String]) -> Self {
        match std::str::from_utf8(bytes) {
            Ok(text) => Self::parse(text, settings),
            Err(error) => {
                let good = String::from_utf8_lossy(&bytes[..error.valid_up_to()]).into_owned();
                let mut document = Self::parse("", &[]);
                document.broken = true;
                let at = good.len();
                (document.source, document.resolved) = (good.clone(), good);
                let message = "the file is not UTF-8 text from here on; save it with that encoding";
                document.add(Some(Origin::File(at..at)), "", message.into());
                document
            }
        }
    }

    /// The whole file as a table.
    pub fn root(&self) -> Reader<'_> {
        Reader::new(self, Some(&self.root), String::new(), None)
    }

    /// True if the text itself is not valid: what seems to be missing may only be hidden.
    pub fn is_broken(&self) -> bool {
        self.broken
    }

    /// The text of the file.
    pub fn source(&self) -> &str {
        &self.source
    }

    /// The text with the overrides in place and all comments kept.
    pub fn resolved(&self) -> &str {
        &self.resolved
    }

    pub(super) fn set_resolved(&mut self, text: String) {
        self.resolved = text;
    }

    /// The values of `[constants]`.
    pub fn constants(&self) -> &BTreeMap<String, Quantity> {
        &self.constants
    }

    /// Lets messages explain the length of lists: "because dimension = 2".
    pub fn set_dimension(&self, dimension: usize) {
        self.dimension.set(Some(dimension));
    }

    /// Everything wrong so far, in file order. Ask when all readers are gone: they report unknown keys when they go.
    pub fn problems(&self) -> Vec<Problem> {
        let mut problems = self.problems.borrow().clone();
        // One mistake is one problem: what was read from a line that is not valid TOML says nothing new.
        let broken: Vec<_> = problems
            .iter()
            .filter(|p| p.key.is_empty())
            .filter_map(|p| p.line)
            .collect();
        problems.retain(|problem| {
            problem.key.is_empty() || problem.line.is_none_or(|line| !broken.contains(&line))
        });
        problems.sort_by_key(order);
        problems.dedup();
        problems
    }

    pub(super) fn count(&self) -> usize {
        self.problems.borrow().len()
    }

    /// Records a problem.
    pub(super) fn add(&self, origin: Option<Origin>, key: &str, message: String) {
        let (span, setting) = match origin {
            Some(Origin::File(span)) => (Some(span), None),
            Some(Origin::Setting(number)) => (None, self.settings.get(number).cloned()),
            None => (None, None),
        };
        let line = span.as_ref().map(|span| line_of(&self.source, span.start));
        let problem = Problem {
            line,
            key: key.to_string(),
            message,
            span,
            setting,
        };
        self.problems.borrow_mut().push(problem);
    }

    /// The bytes `part` of the string whose literal stands at `origin`, or the whole literal if it has escapes.
    pub(super) fn within(&self, origin: &Origin, text: &str, part: &Range<usize>) -> Origin {
        if let Origin::File(span) = origin
            && self.source.get(span.start + 1..span.end.saturating_sub(1)) == Some(text)
        {
            return Origin::File(span.start + 1 + part.start..span.start + 1 + part.end);
        }
        origin.clone()
    }
}

/// What a type's parameters are when nothing is said; `None` if it has no default for some.
pub fn defaults<T: Parameters>() -> Option<T> {
    T::read(&mut Document::parse("", &[]).root())
}

/// Reads a type's parameters from the text of one table.
pub fn parse_parameters<T: Parameters>(text: &str) -> Result<T, Vec<Problem>> {
    let document = Document::parse(text, &[]);
    let read = T::read(&mut document.root());
    let problems = document.problems();
    match read {
        Some(parameters) if problems.is_empty() => Ok(parameters),
        _ => Err(problems),
    }
}
