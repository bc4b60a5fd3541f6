//! The table `[constants]`: numbers and formulas that may refer to each other in any order.

use super::compile::{quantity, references};
use super::names::reserved;
use super::tree::{Node, Origin, Value};
use super::{Document, Quantity};
use std::collections::{BTreeMap, VecDeque};

/// What is not known because of an error reported elsewhere.
const BROKEN: Quantity = Quantity {
    value: f64::NAN,
    unit: None,
};

/// Evaluates all constants. One that cannot be is NaN, so that what uses it causes no second problem.
pub(super) fn resolve(document: &mut Document) {
    let Some(table) = document.root.get("constants") else {
        return;
    };
    let Value::Table(table) = &table.node.value else {
        let message = format!(
            "expected a table [constants], found {}",
            table.node.value.found()
        );
        return document.add(Some(table.node.origin.clone()), "constants", message);
    };
    let mut constants: BTreeMap<String, Quantity> = BTreeMap::new();
    let mut formulas: Vec<(&str, &str, &Node)> = Vec::new();
    for entry in &table.entries {
        let path = format!("constants.{}", entry.key);
        let (name, node) = (entry.key.as_str(), &entry.node);
        let letters = name
            .chars()
            .all(|c| c.is_alphabetic() || c.is_ascii_digit() || c == '_');
        if !letters
            || name.starts_with(|c: char| c.is_ascii_digit())
            || reserved().any(|word| word == name)
        {
            let message = match letters && reserved().any(|word| word == name) {
                true => {
                    format!("\"{name}\" already has a meaning in formulas; choose another name")
                }
                false => {
                    "a constant's name is made of letters, digits and _, and starts with a letter"
                        .into()
                }
            };
            document.add(Some(entry.key_origin.clone()), &path, message);
            continue;
        }
        let message = match &node.value {
            Value::Text(text) => {
                formulas.push((name, text, node));
                constants.insert(name.to_string(), BROKEN);
                continue;
            }
            Value::Integer(Some(number), _) => {
                constants.insert(
                    name.to_string(),
                    Quantity {
                        value: *number as f64,
                        unit: None,
                    },
                );
                continue;
            }
            Value::Float(number, _) if number.is_finite() => {
                constants.insert(
                    name.to_string(),
                    Quantity {
                        value: *number,
                        unit: None,
                    },
                );
                continue;
            }
            Value::Float(..) | Value::Integer(..) => {
                "this is not a finite number that fits; give another".into()
            }
            other => format!(
                "expected a number or a text such as \"25 mm\", found {}",
                other.found()
            ),
        };
        constants.insert(name.to_string(), BROKEN);
        document.add(Some(node.origin.clone()), &path, message);
    }
    evaluate(document, &formulas, &mut constants);
    document.constants = constants;
}

/// Evaluates formulas after those that they refer to.
fn evaluate(
    document: &Document,
    formulas: &[(&str, &str, &Node)],
    constants: &mut BTreeMap<String, Quantity>,
) {
    let number: BTreeMap<&str, usize> = formulas
        .iter()
        .enumerate()
        .map(|(i, formula)| (formula.0, i))
        .collect();
    let needs: Vec<Vec<usize>> = formulas
        .iter()
        .map(|formula| {
            let mut names = references(formula.1, constants);
            names.sort();
            names.dedup();
            names
                .iter()
                .filter_map(|name| number.get(name.as_str()).copied())
                .collect()
        })
        .collect();
    let mut waiting: Vec<usize> = needs.iter().map(Vec::len).collect();
    let mut users = vec![Vec::new(); formulas.len()];
    for (user, needs) in needs.iter().enumerate() {
        needs.iter().for_each(|need| users[*need].push(user));
    }
    let mut ready: VecDeque<usize> = (0..formulas.len()).filter(|i| waiting[*i] == 0).collect();
    while let Some(i) = ready.pop_front() {
        let (name, text, node) = formulas[i];
        match quantity(text, constants) {
            Ok(value) => {
                constants.insert(name.to_string(), value);
            }
            Err(error) => {
                let place: Origin = document.within(&node.origin, text, &error.span);
                document.add(Some(place), &format!("constants.{name}"), error.message);
            }
        }
        for user in &users[i] {
            waiting[*user] -= 1;
            if waiting[*user] == 0 {
                ready.push_back(*user);
            }
        }
    }
    let stuck: Vec<usize> = (0..formulas.len()).filter(|i| waiting[*i] > 0).collect();
    let mut seen = vec![false; formulas.len()];
    for start in stuck {
        let mut ring = Vec::new();
        let mut at = start;
        while !seen[at] {
            seen[at] = true;
            ring.push(at);
            // A stuck formula needs a stuck one: it has a next.
            let Some(next) = needs[at].iter().copied().find(|need| waiting[*need] > 0) else {
                break;
            };
            at = next;
        }
        let Some(begin) = ring.iter().position(|member| *member == at) else {
            continue;
        };
        let ring = &ring[begin..];
        let names: Vec<&str> = ring
            .iter()
            .chain(&ring[..1])
            .take(9)
            .map(|member| formulas[*member].0)
            .collect();
        let message = format!(
            "this is defined through itself ({}); give one of them a value",
            names.join(" → ")
        );
        let (name, _, node) = formulas[ring[0]];
        document.add(
            Some(node.origin.clone()),
            &format!("constants.{name}"),
            message,
        );
    }
}
