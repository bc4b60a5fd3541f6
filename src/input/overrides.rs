//! Overrides from the command line: `--set body[0].velocity=["1 m/s"]`.
//!
//! They are applied twice: to the tree, which keeps the places of everything else in the file, and to the text, which keeps the
//! comments.

use super::Document;
use super::tree::{Entry, Node, Origin, Table, Value};
use toml_edit::{Array, InlineTable, Item, TableLike};

/// A longer path is refused: each part is one level of nesting.
const LONGEST: usize = 64;

/// The parts of a dotted key, `body[0]."a b".velocity` → body, 0, a b, velocity.
pub(super) fn path(key: &str) -> Option<Vec<String>> {
    let mut parts = Vec::new();
    let mut rest = key.trim();
    loop {
        let end = match rest.chars().next()? {
            quote @ ('"' | '\'') => rest[1..].find(quote)? + 2,
            _ => rest.find(['.', '[', ']', '"', '\'']).unwrap_or(rest.len()),
        };
        let part = rest[..end].trim().trim_matches(['"', '\'']);
        if part.is_empty() || parts.len() >= LONGEST {
            return None;
        }
        parts.push(part.to_string());
        rest = rest[end..].trim_start();
        while let Some(inner) = rest.strip_prefix('[') {
            let (number, after) = inner.split_once(']')?;
            number.trim().parse::<usize>().ok()?;
            parts.push(number.trim().to_string());
            rest = after.trim_start();
        }
        match rest.strip_prefix('.') {
            Some(after) => rest = after.trim_start(),
            None if rest.is_empty() && parts.len() <= LONGEST => return Some(parts),
            None => return None,
        }
    }
}

/// Applies all overrides of a document to its tree, and to its text.
pub(super) fn apply(document: &mut Document) {
    let mut text: Option<toml_edit::DocumentMut> = document.source().parse().ok();
    for (number, setting) in document.settings.clone().iter().enumerate() {
        if let Err((key, message)) = one(&mut document.root, text.as_mut(), number, setting) {
            document.add(Some(Origin::Setting(number)), &key, message);
        }
    }
    if let Some(text) = text.filter(|_| !document.settings.is_empty()) {
        document.set_resolved(text.to_string());
    }
}

/// Applies one override; an error is a key and a message.
fn one(
    root: &mut Table,
    text: Option<&mut toml_edit::DocumentMut>,
    number: usize,
    setting: &str,
) -> Result<(), (String, String)> {
    let Some((key, value)) = halves(setting) else {
        return Err((
            String::new(),
            "this has no \"=\"; write --set KEY=VALUE".into(),
        ));
    };
    let Some(parts) = path(key) else {
        return Err((
            key.into(),
            "this is not a dotted key; write one such as body[0].velocity".into(),
        ));
    };
    let value = value.trim();
    if value.is_empty() {
        return Err((
            key.into(),
            "there is no value behind \"=\"; give one".into(),
        ));
    }
    let (node, edited) = match (
        toml::de::DeValue::parse(value),
        value.parse::<toml_edit::Value>(),
    ) {
        (Ok(parsed), Ok(edited)) => (
            Node::new(parsed.get_ref(), 0..0, &|_| Origin::Setting(number)),
            edited,
        ),
        (Err(error), _) if value.starts_with(['[', '{', '"', '\'']) => {
            let why = error.message().replace('\n', ", ");
            return Err((key.into(), format!("{value} is not a TOML value: {why}")));
        }
        _ => {
            let node = Node {
                value: Value::Text(value.into()),
                origin: Origin::Setting(number),
            };
            (node, toml_edit::Value::from(value))
        }
    };
    set(root, &parts, node, number, "").map_err(|message| (key.to_string(), message))?;
    if let Some(text) = text {
        edit_table(text.as_table_mut(), &parts, edited);
    }
    Ok(())
}

/// The key and the value, at the first `=` outside quotes.
fn halves(setting: &str) -> Option<(&str, &str)> {
    let mut quote = None;
    for (at, c) in setting.char_indices() {
        match (quote, c) {
            (None, '=') => return Some((setting[..at].trim(), &setting[at + 1..])),
            (None, '"' | '\'') => quote = Some(c),
            (Some(open), c) if open == c => quote = None,
            _ => {}
        }
    }
    None
}

fn set(
    table: &mut Table,
    parts: &[String],
    node: Node,
    number: usize,
    above: &str,
) -> Result<(), String> {
    let [key, rest @ ..] = parts else {
        return Ok(());
    };
    let origin = Origin::Setting(number);
    let above = if above.is_empty() {
        key.clone()
    } else {
        format!("{above}.{key}")
    };
    let position = table.entries.iter().position(|entry| entry.key == *key);
    let position = position.unwrap_or_else(|| {
        let node = Node {
            value: Value::Table(Table::default()),
            origin: origin.clone(),
        };
        table.entries.push(Entry {
            key: key.clone(),
            key_origin: origin,
            node,
        });
        table.entries.len() - 1
    });
    let found = &mut table.entries[position].node;
    if rest.is_empty() {
        *found = node;
        return Ok(());
    }
    descend(found, rest, node, number, &above)
}

fn descend(
    found: &mut Node,
    parts: &[String],
    node: Node,
    number: usize,
    above: &str,
) -> Result<(), String> {
    match &mut found.value {
        Value::Table(table) => set(table, parts, node, number, above),
        Value::List(items) => {
            let [key, rest @ ..] = parts else {
                return Ok(());
            };
            let count = items.len();
            let Ok(index) = key.parse::<usize>() else {
                return Err(format!(
                    "{above} is a list; give the number of an element, {above}[0]"
                ));
            };
            let Some(item) = items.get_mut(index) else {
                let most = match count {
                    0 => "is empty".to_string(),
                    count => format!("ends with {above}[{}]", count - 1),
                };
                return Err(format!("there is no {above}[{index}]; the list {most}"));
            };
            if rest.is_empty() {
                *item = node;
                return Ok(());
            }
            descend(item, rest, node, number, &format!("{above}[{index}]"))
        }
        other => Err(format!(
            "{above} is {}, not a table; set {above} as a whole",
            other.found()
        )),
    }
}

fn edit_table(table: &mut dyn TableLike, parts: &[String], value: toml_edit::Value) {
    let [key, rest @ ..] = parts else { return };
    match table.get_mut(key) {
        Some(item) if !rest.is_empty() => edit_item(item, rest, value),
        Some(item) => {
            let mut value = value;
            match item.as_value() {
                Some(old) => *value.decor_mut() = old.decor().clone(),
                None => value.decor_mut().clear(),
            }
            *item = Item::Value(value);
        }
        None => {
            let inner = rest.iter().rev().fold(value, |value, key| {
                let mut table = InlineTable::new();
                table.insert(key, value);
                table.into()
            });
            table.insert(key, Item::Value(inner));
        }
    }
}

fn edit_item(item: &mut Item, parts: &[String], value: toml_edit::Value) {
    match item {
        Item::Table(table) => edit_table(table, parts, value),
        Item::Value(old) => edit_value(old, parts, value),
        Item::ArrayOfTables(tables) => {
            let [key, rest @ ..] = parts else { return };
            let Some(table) = key.parse().ok().and_then(|index| tables.get_mut(index)) else {
                return;
            };
            match value {
                value if !rest.is_empty() => edit_table(table, rest, value),
                toml_edit::Value::InlineTable(new) => *table = new.into_table(),
                _ => {}
            }
        }
        Item::None => {}
    }
}

fn edit_value(old: &mut toml_edit::Value, parts: &[String], value: toml_edit::Value) {
    match old {
        toml_edit::Value::InlineTable(table) => edit_table(table, parts, value),
        toml_edit::Value::Array(items) => edit_array(items, parts, value),
        _ => {}
    }
}

fn edit_array(items: &mut Array, parts: &[String], value: toml_edit::Value) {
    let [key, rest @ ..] = parts else { return };
    let Some(index) = key
        .parse::<usize>()
        .ok()
        .filter(|index| *index < items.len())
    else {
        return;
    };
    if rest.is_empty() {
        items.replace(index, value);
    } else if let Some(item) = items.get_mut(index) {
        edit_value(item, rest, value);
    }
}
