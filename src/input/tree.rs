//! A parsed file as a tree that remembers where everything stands, in file order.

use std::ops::Range;
use toml::de::{DeTable, DeValue};

/// Where something was written.
#[derive(Clone, Debug)]
pub(super) enum Origin {
    /// Bytes of the file.
    File(Range<usize>),
    /// The override of this number.
    Setting(usize),
}

#[derive(Clone, Debug)]
pub(super) enum Value {
    Text(String),
    /// A whole number as typed; `None` if it does not fit 64 bits.
    Integer(Option<i64>, String),
    Float(f64, String),
    Flag(bool),
    Date(String),
    List(Vec<Node>),
    Table(Table),
}

#[derive(Clone, Debug)]
pub(super) struct Node {
    pub value: Value,
    pub origin: Origin,
}

#[derive(Clone, Debug)]
pub(super) struct Entry {
    pub key: String,
    pub key_origin: Origin,
    pub node: Node,
}

#[derive(Clone, Debug, Default)]
pub(super) struct Table {
    pub entries: Vec<Entry>,
}

impl Table {
    pub fn get(&self, key: &str) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.key == key)
    }

    /// `origin` turns a span into a place: an override's own text is not part of the file.
    pub fn new(table: &DeTable<'_>, origin: &impl Fn(Range<usize>) -> Origin) -> Self {
        let mut found: Vec<_> = table.iter().collect();
        found.sort_by_key(|(key, _)| key.span().start);
        let entries = found.into_iter().map(|(key, value)| Entry {
            key: key.get_ref().to_string(),
            key_origin: origin(key.span()),
            node: Node::new(value.get_ref(), value.span(), origin),
        });
        Table {
            entries: entries.collect(),
        }
    }
}

impl Node {
    pub fn new(
        value: &DeValue<'_>,
        span: Range<usize>,
        origin: &impl Fn(Range<usize>) -> Origin,
    ) -> Self {
        let value = match value {
            DeValue::String(text) => Value::Text(text.to_string()),
            DeValue::Integer(number) => Value::Integer(
                i64::from_str_radix(number.as_str(), number.radix()).ok(),
                number.to_string(),
            ),
            DeValue::Float(number) => Value::Float(
                number.as_str().parse().unwrap_or(f64::NAN),
                number.as_str().to_string(),
            ),
            DeValue::Boolean(flag) => Value::Flag(*flag),
            DeValue::Datetime(date) => Value::Date(date.to_string()),
            DeValue::Array(items) => Value::List(
                items
                    .iter()
                    .map(|item| Node::new(item.get_ref(), item.span(), origin))
                    .collect(),
            ),
            DeValue::Table(table) => Value::Table(Table::new(table, origin)),
        };
        Node {
            value,
            origin: origin(span),
        }
    }
}

impl Value {
    /// What it is, in words.
    pub fn found(&self) -> String {
        match self {
            Value::Text(text) => format!("\"{}\"", super::suggest::short(text)),
            Value::Integer(_, text) | Value::Float(_, text) => {
                format!("the number {}", super::suggest::short(text))
            }
            Value::Flag(flag) => format!("{flag}"),
            Value::Date(date) => format!("the date {date}"),
            Value::List(_) => "a list".into(),
            Value::Table(_) => "a table".into(),
        }
    }
}
