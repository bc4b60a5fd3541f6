//! What is said about alternatives and about lists of lists.

use super::tree::{Node, Value};
use super::values::all;
use super::{Bound, Expression, Reader, Unit};

impl<'a> Reader<'a> {
    /// The one key of several that is there; it is a problem if there is none, or more than one.
    pub fn one_key(&mut self, keys: &[&'static str]) -> Option<&'static str> {
        let found: Vec<&'static str> = keys.iter().copied().filter(|key| self.has(key)).collect();
        match found.as_slice() {
            [] => {
                self.missing_one_of(keys);
                None
            }
            [key] => Some(key),
            [first, second, ..] => {
                self.problem(
                    second,
                    format!("\"{first}\" and \"{second}\" exclude each other; keep one of them"),
                );
                None
            }
        }
    }

    /// A sub-table that must be there; `example` is what to add if it is not.
    pub fn table_such_as(&mut self, key: &str, example: &str) -> Option<Reader<'a>> {
        self.find_or_report(key, &format!("add {example}"))?;
        self.optional_table(key)
    }

    /// The length of the list under a key; `None` if the key is left out or holds something else.
    pub fn list_length(&mut self, key: &str) -> Option<usize> {
        match &self.find(key)?.node.value {
            Value::List(items) => Some(items.len()),
            _ => None,
        }
    }

    /// A list of any number of lists of `len` numbers, that must be there.
    pub fn vectors(&mut self, key: &str, unit: Unit, len: usize) -> Option<Vec<Vec<f64>>> {
        let expected = format!(
            "expected a list of lists of {len}, each {}",
            unit.describe()
        );
        let entry = self.find_or_report(key, &expected)?;
        let path = self.join(key);
        let Value::List(rows) = &entry.node.value else {
            let message = format!("{expected}, found {}", entry.node.value.found());
            return self.wrong(&entry.node, &path, message);
        };
        all(rows.iter().enumerate().map(|(i, row)| {
            let path = format!("{path}[{i}]");
            let found = match &row.value {
                Value::List(items) if items.len() == len => {
                    return all(items.iter().enumerate().map(|(j, item)| {
                        self.number(item, &format!("{path}[{j}]"), unit, Bound::Any)
                    }));
                }
                Value::List(items) => items.len().to_string(),
                other => other.found(),
            };
            self.wrong(
                row,
                &path,
                format!("expected a list of {len} values, found {found}"),
            )
        }))
    }

    /// A list of `len` entries that must be there, each an expression or a certain word, which is read as `None`.
    pub fn expressions_or_word(
        &mut self,
        key: &str,
        unit: Unit,
        len: usize,
        variables: &[&str],
        word: &str,
    ) -> Option<Vec<Option<Expression>>> {
        let expected = format!(
            "expected a list of {len}, each {} or \"{word}\"",
            unit.describe()
        );
        self.find_or_report(key, &expected)?;
        let items = self.items(key, len)?;
        let is_word = |item: &Node| matches!(&item.value, Value::Text(text) if text == word);
        all(items.iter().enumerate().map(|(i, item)| {
            if is_word(item) {
                return Some(None);
            }
            let path = format!("{}[{i}]", self.join(key));
            self.formula(item, &path, unit, variables).map(Some)
        }))
    }
}
