//! From a file to a checked scenario, or to everything that is wrong with it.

use super::{Scenario, check};
use crate::input::{Document, Problem, report};
use std::fmt;
use std::fs::File;
use std::io::{ErrorKind, Read as _};
use std::path::Path;

/// No scenario is larger; what is larger is some other file.
const MOST_BYTES: u64 = 64 << 20;

/// A scenario and what goes with it.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The checked scene.
    pub scenario: Scenario,
    /// The text of the file with the overrides and what was left to the scene in place, and its comments kept.
    pub resolved_toml: String,
    /// What is allowed and still likely to surprise.
    pub warnings: Vec<String>,
}

/// Why a scenario was refused. Shown, it is a headline and one entry for each problem.
#[derive(Clone, Debug, PartialEq)]
pub struct InputError {
    /// The file, as the user called it.
    pub name: String,
    /// Everything wrong, in file order; at least one problem.
    pub problems: Vec<Problem>,
    /// The text that the problems point into.
    source: String,
}

impl fmt::Display for InputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&report(&self.name, &self.source, &self.problems))
    }
}

impl std::error::Error for InputError {}

impl InputError {
    /// A problem with the file as a whole.
    fn whole(name: &str, message: impl Into<String>) -> Self {
        let problem = Problem {
            line: None,
            key: String::new(),
            message: message.into(),
            span: None,
            setting: None,
        };
        Self {
            name: name.into(),
            problems: vec![problem],
            source: String::new(),
        }
    }
}

/// Reads a scenario file with overrides `KEY=VALUE`.
pub fn load(path: &Path, overrides: &[String]) -> Result<Loaded, InputError> {
    let name = path.display().to_string();
    let bytes = read(path).map_err(|message| InputError::whole(&name, message))?;
    let stem = path
        .file_stem()
        .map_or(name.clone(), |stem| stem.to_string_lossy().into_owned());
    finish(&name, &stem, &Document::from_bytes(&bytes, overrides))
}

/// Reads a scenario from its text; `name` stands for the file in messages and is the default title.
pub fn parse(name: &str, text: &str, overrides: &[String]) -> Result<Loaded, InputError> {
    finish(name, name, &Document::parse(text, overrides))
}

fn read(path: &Path) -> Result<Vec<u8>, String> {
    let explain = |error: std::io::Error| match error.kind() {
        ErrorKind::NotFound => "there is no such file; check the path".to_string(),
        ErrorKind::PermissionDenied => "you may not read this file; change its permissions".into(),
        ErrorKind::IsADirectory => "this is a folder; give a scenario file in it".into(),
        _ => format!("the file cannot be read: {error}"),
    };
    if path.is_dir() {
        return Err(explain(ErrorKind::IsADirectory.into()));
    }
    let mut bytes = Vec::new();
    let mut file = File::open(path).map_err(explain)?.take(MOST_BYTES + 1);
    file.read_to_end(&mut bytes).map_err(explain)?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err("the file is larger than 64 MiB; give a scenario file".into());
    }
    Ok(bytes)
}

fn finish(name: &str, title: &str, document: &Document) -> Result<Loaded, InputError> {
    let mut warnings = Vec::new();
    let scenario = check::scenario(document, title, &mut warnings);
    let problems = document.problems();
    match scenario {
        Some(scenario) if problems.is_empty() => {
            let chosen = scenario.method.chosen.iter();
            let chosen: Vec<_> = chosen
                .map(|c| format!("method.{}=\"{}\"", c.key, c.value))
                .collect();
            let resolved = Document::parse(document.resolved(), &chosen);
            let resolved_toml = resolved.resolved().to_string();
            Ok(Loaded {
                scenario,
                resolved_toml,
                warnings,
            })
        }
        None if problems.is_empty() => Err(InputError::whole(
            name,
            "the file could not be understood; simplify it until it can",
        )),
        _ => {
            let source = document.source().to_string();
            Err(InputError {
                name: name.into(),
                problems,
                source,
            })
        }
    }
}
