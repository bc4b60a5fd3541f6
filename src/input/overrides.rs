//! Overrides from the command line: `--set body[0].velocity=["1 m/s"]`.

use super::Document;

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
        if part.is_empty() {
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
            None if rest.is_empty() => return Some(parts),
            None => return None,
        }
    }
}

/// Applies all overrides of a document to its tree, and to its text.
pub(super) fn apply(_document: &mut Document) {}
