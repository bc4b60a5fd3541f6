//! The folder of a run.

use super::{code, fail};
use crate::scenario::Loaded;
use std::io::Error;
use std::path::Path;
use std::process::ExitCode;

/// Makes the output folder ready, and refuses one that already holds a run.
pub fn prepare(folder: &Path, force: bool) -> Result<(), ExitCode> {
    prepare_for(folder, force, "run", is_ours)
}

/// The same for what is not a run: its name, and which files are its own.
pub fn prepare_for(
    folder: &Path,
    force: bool,
    what: &str,
    is_ours: fn(&str) -> bool,
) -> Result<(), ExitCode> {
    let system = |what: &str, path: &Path, error: Error| {
        let message = format!("cannot {what} {}: {error}", path.display());
        fail(code::SYSTEM, &message)
    };
    if folder.as_os_str().is_empty() {
        return Err(fail(code::INPUT, "--output needs the name of a folder"));
    }
    if folder.exists() && !folder.is_dir() {
        let name = folder.display();
        let message = format!("{name} is a file; name a folder for the tables with --output");
        return Err(fail(code::INPUT, &message));
    }
    std::fs::create_dir_all(folder).map_err(|error| system("create", folder, error))?;
    let mut old = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(|error| system("read", folder, error))? {
        let path = entry.map_err(|error| system("read", folder, error))?.path();
        if path
            .file_name()
            .is_some_and(|name| is_ours(&name.to_string_lossy()))
        {
            old.push(path);
        }
    }
    if !old.is_empty() && !force {
        let name = folder.display();
        let message = format!(
            "{name} already holds a {what}; name another folder with --output, or replace the {what} with --force"
        );
        return Err(fail(code::INPUT, &message));
    }
    for path in old {
        std::fs::remove_file(&path).map_err(|error| system("remove", &path, error))?;
    }
    Ok(())
}

/// Whether a run writes files of this name; whatever else lies in the folder is left alone.
fn is_ours(name: &str) -> bool {
    let table = ["body_", "probe_", "boundary_"]
        .iter()
        .any(|start| name.starts_with(start) && name.ends_with(".csv"));
    let named = ["run.toml", "summary.json", "energy.csv"].contains(&name);
    table || named || super::pictures::NAMES.contains(&name)
}

/// Writes the scenario with its overrides, from which the run can be repeated.
pub fn write_scenario(folder: &Path, loaded: &Loaded) -> Result<(), ExitCode> {
    let text = format!(
        "# The scenario as it was run by mpm {}; `mpm run` on this file repeats the run.\n{}",
        env!("CARGO_PKG_VERSION"),
        loaded.resolved_toml
    );
    write(&folder.join("run.toml"), &text)
}

/// Writes a small file.
pub fn write(path: &Path, text: &str) -> Result<(), ExitCode> {
    std::fs::write(path, text).map_err(|error| {
        let message = format!("cannot write {}: {error}", path.display());
        fail(code::SYSTEM, &message)
    })
}
