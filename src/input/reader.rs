//! One table of a file, read key by key.

use super::suggest::{hint, list, nearest};
use super::tree::{Entry, Node, Origin, Table, Value};
use super::{Document, overrides};
use std::collections::BTreeSet;

/// What a number has to satisfy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bound {
    /// Any finite number.
    Any,
    /// > 0
    Positive,
    /// ≥ 0
    NotNegative,
    /// lower ≤ x ≤ upper
    Closed(f64, f64),
    /// lower < x < upper
    Open(f64, f64),
}

/// A struct of parameters that can be read from a table.
pub trait Parameters: Sized {
    /// Reads every key it knows; `None` if a problem was found (and recorded in the reader).
    ///
    /// Ask for every key first and use `?` afterwards: then a user sees all problems at once.
    fn read(reader: &mut Reader<'_>) -> Option<Self>;
}

/// A table being read.
///
/// Methods return `None` for what is missing or wrong, and record why. A key that was never asked for is reported when the
/// reader is dropped. If reading stopped at an earlier problem, keys may just not have been reached: then only likely
/// misspellings are reported, unless the caller declares with [`Reader::finish`] that it has asked for everything.
pub struct Reader<'a> {
    pub(super) document: &'a Document,
    table: Option<&'a Table>,
    pub(super) path: String,
    place: Option<Origin>,
    known: BTreeSet<String>,
    missing: Vec<Missing>,
    earlier: usize,
    complete: bool,
}

/// A key that was needed and not found; reported in the end, when a misspelling may explain it.
struct Missing {
    key: String,
    names: Vec<String>,
    message: String,
}

impl<'a> Reader<'a> {
    pub(super) fn new(
        document: &'a Document,
        table: Option<&'a Table>,
        path: String,
        place: Option<Origin>,
    ) -> Self {
        let mut known = BTreeSet::new();
        if path.is_empty() {
            known.insert("constants".to_string());
        }
        Reader {
            document,
            table,
            path,
            place,
            known,
            missing: Vec::new(),
            earlier: document.count(),
            complete: false,
        }
    }

    /// The dotted key of this table; empty for the whole file.
    pub fn path(&self) -> &str {
        &self.path
    }

    /// Marks a key as known.
    pub fn used(&mut self, key: &str) {
        self.known.insert(key.to_string());
    }

    /// True if the key is there. It counts as known from now on.
    pub fn has(&mut self, key: &str) -> bool {
        self.find(key).is_some()
    }

    /// The keys of this table, in file order.
    pub fn keys(&self) -> Vec<&'a str> {
        self.table.map_or_else(Vec::new, |table| {
            table
                .entries
                .iter()
                .map(|entry| entry.key.as_str())
                .collect()
        })
    }

    /// Records a problem with the value of `key` (which may go deeper: `min[1]`).
    pub fn problem(&mut self, key: &str, message: impl Into<String>) {
        let mut place = self.place.clone();
        if let (Some(path), Some(mut table)) = (overrides::path(key), self.table) {
            let mut node: Option<&Node> = None;
            for part in path {
                let next = match (node.map(|node| &node.value), part.parse::<usize>()) {
                    (Some(Value::List(items)), Ok(number)) => items.get(number),
                    (None | Some(Value::Table(_)), _) => table.get(&part).map(|entry| &entry.node),
                    _ => None,
                };
                let Some(next) = next else { break };
                if let Value::Table(inner) = &next.value {
                    table = inner;
                }
                place = Some(next.origin.clone());
                node = Some(next);
            }
        }
        self.document.add(place, &self.join(key), message.into());
    }

    /// Records a problem with the table as a whole.
    pub fn problem_here(&mut self, message: impl Into<String>) {
        self.document
            .add(self.place.clone(), &self.path, message.into());
    }

    /// Ends the reading: every key that was not asked for is a problem.
    pub fn finish(mut self) {
        self.complete = true;
    }

    /// A sub-table that must be there.
    pub fn table(&mut self, key: &str) -> Option<Reader<'a>> {
        self.find_or_report(key, &format!("add a table [{}]", self.join(key)))?;
        self.optional_table(key)
    }

    /// A sub-table that may be left out.
    pub fn optional_table(&mut self, key: &str) -> Option<Reader<'a>> {
        let entry = self.find(key)?;
        self.as_table(&entry.node, self.join(key), Some(&entry.key_origin))
    }

    /// The tables of an array `[[key]]`; none if it is left out.
    pub fn tables(&mut self, key: &str) -> Vec<Reader<'a>> {
        let Some(entry) = self.find(key) else {
            return Vec::new();
        };
        let path = self.join(key);
        match &entry.node.value {
            Value::List(items) => {
                let numbered = items.iter().enumerate();
                numbered
                    .filter_map(|(i, item)| self.as_table(item, format!("{path}[{i}]"), None))
                    .collect()
            }
            other => {
                let message = format!(
                    "expected a list of tables [[{path}]], found {}",
                    other.found()
                );
                let place = if matches!(other, Value::Table(_)) {
                    &entry.key_origin
                } else {
                    &entry.node.origin
                };
                self.document.add(Some(place.clone()), &path, message);
                Vec::new()
            }
        }
    }

    /// The sub-tables of a table whose keys are names that the user chose, in file order; none if it is left out.
    pub fn named_tables(&mut self, key: &str) -> Vec<(String, Reader<'a>)> {
        let Some(mut inner) = self.optional_table(key) else {
            return Vec::new();
        };
        inner.complete = true;
        let names = inner.keys();
        names
            .iter()
            .filter_map(|name| Some((name.to_string(), inner.optional_table(name)?)))
            .collect()
    }

    /// Exactly one of these sub-tables, and its name.
    pub fn one_of(&mut self, keys: &[&'static str]) -> Option<(&'static str, Reader<'a>)> {
        let key = self.one_key(keys)?;
        Some((key, self.optional_table(key)?))
    }

    /// Notes that one of several keys was needed.
    pub(super) fn missing_one_of(&mut self, keys: &[&'static str]) {
        self.missing.push(Missing {
            key: String::new(),
            names: keys.iter().map(|key| key.to_string()).collect(),
            message: format!(
                "expected exactly one of {}, found none; add one",
                list(keys, "and")
            ),
        });
    }

    /// A choice that is a bare name, `"flip"`, or a table with one name and its parameters, `{ flip = { ratio = 0.9 } }`.
    pub fn name_or_table(
        &mut self,
        key: &str,
        names: &[&'static str],
    ) -> Option<(&'static str, Reader<'a>)> {
        let entry = self.find_or_report(key, &format!("expected one of {}", list(names, "or")))?;
        match &entry.node.value {
            Value::Text(text) => {
                let name = self.pick(key, text, &entry.node, names)?;
                Some((
                    name,
                    Reader::new(
                        self.document,
                        None,
                        format!("{}.{name}", self.join(key)),
                        Some(entry.node.origin.clone()),
                    ),
                ))
            }
            Value::Table(_) => {
                let mut inner = self.optional_table(key)?;
                inner.complete = true;
                inner.one_of(names)
            }
            other => {
                let message = format!(
                    "expected a name or a table with one of {}, found {}",
                    list(names, "or"),
                    other.found()
                );
                self.wrong(&entry.node, &self.join(key), message)
            }
        }
    }

    /// As [`Reader::name_or_table`]; `default` and no parameters if the key is left out.
    pub fn name_or_table_or(
        &mut self,
        key: &str,
        names: &[&'static str],
        default: &'static str,
    ) -> Option<(&'static str, Reader<'a>)> {
        if self.has(key) {
            return self.name_or_table(key, names);
        }
        Some((
            default,
            Reader::new(self.document, None, self.join(key), self.place.clone()),
        ))
    }

    /// One of several names; without a default the key must be there.
    pub fn choice(
        &mut self,
        key: &str,
        names: &[&'static str],
        default: Option<&'static str>,
    ) -> Option<&'static str> {
        let Some(entry) = self.find(key) else {
            if default.is_none() {
                self.find_or_report(key, &format!("expected one of {}", list(names, "or")));
            }
            return default;
        };
        match &entry.node.value {
            Value::Text(text) => self.pick(key, text, &entry.node, names),
            other => {
                let message = format!(
                    "expected one of {} in quotes, found {}",
                    list(names, "or"),
                    other.found()
                );
                self.wrong(&entry.node, &self.join(key), message)
            }
        }
    }

    fn pick(
        &self,
        key: &str,
        text: &str,
        node: &Node,
        names: &[&'static str],
    ) -> Option<&'static str> {
        if let Some(name) = names.iter().find(|name| **name == text) {
            return Some(name);
        }
        let hint = hint(text, names.iter().copied());
        let message = format!(
            "there is no {}{hint}; known are {}",
            node.value.found(),
            list(names, "and")
        );
        let message = if hint.is_empty() {
            message
        } else {
            format!("there is no {}{hint}", node.value.found())
        };
        self.wrong(node, &self.join(key), message)
    }

    /// The value of a key, which counts as known from now on.
    pub(super) fn find(&mut self, key: &str) -> Option<&'a Entry> {
        self.known.insert(key.to_string());
        self.table?.get(key)
    }

    /// The value of a key that must be there.
    pub(super) fn find_or_report(&mut self, key: &str, expected: &str) -> Option<&'a Entry> {
        let found = self.find(key);
        if found.is_none() {
            let message = format!("this key is missing; {expected}");
            self.missing.push(Missing {
                key: key.to_string(),
                names: vec![key.to_string()],
                message,
            });
        }
        found
    }

    pub(super) fn join(&self, key: &str) -> String {
        let bare = !key.is_empty()
            && key
                .chars()
                .all(|c| c.is_alphanumeric() || "_-.[]".contains(c));
        match (self.path.as_str(), key) {
            (path, "") => path.to_string(),
            ("", key) if bare => key.to_string(),
            ("", key) => format!("\"{key}\""),
            (path, key) if bare => format!("{path}.{key}"),
            (path, key) => format!("{path}.\"{key}\""),
        }
    }

    /// Records a problem with a value and gives nothing.
    pub(super) fn wrong<T>(&self, node: &Node, path: &str, message: String) -> Option<T> {
        self.document.add(Some(node.origin.clone()), path, message);
        None
    }

    fn as_table(&self, node: &'a Node, path: String, key: Option<&Origin>) -> Option<Reader<'a>> {
        match &node.value {
            Value::Table(table) => Some(Reader::new(
                self.document,
                Some(table),
                path,
                Some(key.unwrap_or(&node.origin).clone()),
            )),
            other => self.wrong(
                node,
                &path,
                format!("expected a table, found {}", other.found()),
            ),
        }
    }
}

impl Drop for Reader<'_> {
    fn drop(&mut self) {
        let stopped_early = !self.missing.is_empty() || self.document.count() > self.earlier;
        // Behind a broken line a key may stand in the wrong table.
        let unsure = self.document.broken || (stopped_early && !self.complete);
        let entries = self.table.map_or(&[][..], |table| &table.entries);
        for entry in entries
            .iter()
            .filter(|entry| !self.known.contains(&entry.key))
        {
            let key = entry.key.as_str();
            // A key that is there was not misspelt; one that was missed is the best guess.
            let missed = nearest(
                key,
                self.missing
                    .iter()
                    .flat_map(|missing| &missing.names)
                    .map(String::as_str),
            );
            let absent =
                |name: &&str| self.complete || !entries.iter().any(|entry| entry.key == **name);
            let near = missed
                .or_else(|| nearest(key, self.known.iter().map(String::as_str).filter(absent)));
            let near = near.map(str::to_string);
            let message = match &near {
                Some(near) => format!("unknown key \"{key}\"; did you mean \"{near}\"?"),
                None if unsure => continue,
                None if self.known.is_empty() => {
                    format!("unknown key \"{key}\"; nothing can be set here")
                }
                None => {
                    let known: Vec<&String> = self
                        .known
                        .iter()
                        .filter(|name| *name != "constants")
                        .collect();
                    format!("unknown key \"{key}\"; known here: {}", list(&known, "and"))
                }
            };
            if let Some(near) = near {
                self.missing
                    .retain(|missing| !missing.names.contains(&near));
            }
            self.document
                .add(Some(entry.key_origin.clone()), &self.join(key), message);
        }
        if !self.document.broken {
            for missing in &self.missing {
                self.document.add(
                    self.place.clone(),
                    &self.join(&missing.key),
                    missing.message.clone(),
                );
            }
        }
    }
}
