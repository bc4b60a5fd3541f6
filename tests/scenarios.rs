//! Every scenario that comes with the program is understood without a warning and runs.

use mpm::scenario::load;
use mpm::study::validate::simulate;
use std::fs;
use std::path::{Path, PathBuf};

fn scenarios(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("the folder is part of the sources") {
        let path = entry.expect("readable").path();
        if path.is_dir() {
            scenarios(&path, found);
        } else if path.extension().is_some_and(|end| end == "toml") {
            found.push(path);
        }
    }
}

#[test]
fn every_scenario_loads_without_a_warning_and_runs() {
    let mut files = Vec::new();
    scenarios(
        &Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios"),
        &mut files,
    );
    files.sort();
    assert!(!files.is_empty());
    for path in &files {
        let name = path.display();
        let loaded = load(path, &[]).unwrap_or_else(|error| panic!("{error}"));
        assert!(loaded.warnings.is_empty(), "{name}: {:?}", loaded.warnings);
        let scenario = loaded.scenario;
        let text = fs::read_to_string(path).expect("readable");
        // a thousandth of the run, recorded at its ends
        let end = format!("{:e}", 1e-3 * scenario.end);
        let shortened = [
            format!("time.end={end}"),
            format!("output={{ every = {end} }}"),
        ];
        let run =
            simulate(&text, &shortened, false).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(run.summary.steps > 0, "{name}");
        let residual = run.summary.worst_energy_residual;
        assert!(residual <= 1e-11, "{name}: energy residual {residual:e}");
    }
}
