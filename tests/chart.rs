//! `mpm chart` as its users meet it.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const BAR: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/scenarios/bar1d.toml");

/// A folder of its own for one test, empty at the start.
fn folder(test: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("chart_{test}"));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a folder in the target folder");
    folder
}

fn chart(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_mpm"))
        .current_dir(folder)
        .arg("chart")
        .args(arguments)
        .output()
        .expect("the program starts")
}

fn code(output: &Output) -> i32 {
    output.status.code().expect("no signal")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("text")
}

fn json(output: &Output) -> serde_json::Value {
    serde_json::from_slice(&output.stdout).expect("one JSON object on standard output")
}

const SMALL: [&str; 14] = [
    "manufactured",
    "--basis",
    "linear,quadratic",
    "--transfer",
    "flip",
    "--update",
    "musl",
    "--points",
    "2",
    "--courant",
    "0.4",
    "--repeat",
    "1",
    "--json",
];

#[test]
fn a_small_chart_has_every_run_a_frontier_and_second_order() {
    let folder = folder("small");
    fn with<'a>(more: &[&'a str]) -> Vec<&'a str> {
        [&SMALL[..], &["--frame", "updated", "--cells", "8,16"], more].concat()
    }
    let started = std::time::Instant::now();
    let output = chart(&folder, &with(&["--tolerance", "0.05"]));
    let elapsed = started.elapsed().as_secs_f64();
    assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    let results = json(&output);
    let runs = results["runs"].as_array().expect("runs");
    assert_eq!(runs.len(), 4);
    // whatever the machine does, no run takes longer than the program
    for run in runs {
        let wall = run["wall_seconds"].as_f64().expect("a time");
        assert!(wall > 0.0 && wall < elapsed, "{wall} of {elapsed} s");
    }
    for series in results["orders"].as_array().expect("orders") {
        let order = series["order_last_two"].as_f64().expect("an order");
        assert!((order - 2.0).abs() < 0.2, "{series}");
    }
    let frontier = results["frontier"].as_array().expect("a frontier");
    let errors: Vec<f64> = frontier
        .iter()
        .map(|r| r["error"].as_f64().unwrap())
        .collect();
    assert!(!errors.is_empty() && errors.windows(2).all(|pair| pair[0] > pair[1]));
    assert!(results["cheapest"]["error"].as_f64().expect("one") <= 0.05);

    let made = folder.join("charts/manufactured");
    let rows = std::fs::read_to_string(made.join("chart.csv")).expect("a table");
    assert_eq!(rows.lines().count(), 5, "{rows}");
    for name in ["orders.csv", "chart_wall.png", "chart_work.png"] {
        assert!(made.join(name).is_file(), "{name}");
    }

    let refused = chart(&folder, &with(&[]));
    assert_eq!(code(&refused), 2);
    assert!(text(&refused.stderr).contains("--force"));
    let strict = chart(&folder, &with(&["--force", "--tolerance", "1e-9"]));
    assert_eq!(code(&strict), 1, "nothing is so accurate");
}

/// What `--tolerance` shows can be pasted into a scenario, a parameter as well.
#[test]
fn a_transfer_with_its_parameter_is_one_of_its_own() {
    let folder = folder("parameter");
    let arguments = [
        "bar1d",
        "--transfer=pic,fmpm(1),fmpm(3)",
        "--basis=quadratic",
        "--frame=updated",
        "--points=2",
        "--courant=0.4",
        "--cells=8",
        "--repeat=1",
        "--tolerance=0.02",
    ];
    let output = chart(&folder, &arguments);
    assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    let shown = text(&output.stdout);
    let pasted = "transfer = { fmpm = { order = 3 } }";
    assert!(shown.lines().any(|line| line == pasted), "{shown}");
    let rows = std::fs::read_to_string(folder.join("charts/bar1d/chart.csv")).expect("a table");
    let errors: Vec<&str> = ["quadratic,pic,", "quadratic,fmpm(1),", "quadratic,fmpm(3),"]
        .iter()
        .map(|method| {
            let row = rows.lines().find(|row| row.contains(method));
            let row = row.unwrap_or_else(|| panic!("no {method} in {rows}"));
            let header = rows.lines().next().expect("a header");
            let column = header.split(',').position(|name| name == "error");
            row.split(',')
                .nth(column.expect("a column"))
                .expect("a number")
        })
        .collect();
    assert_eq!(errors[0], errors[1], "order 1 is PIC");
    assert_ne!(errors[1], errors[2]);

    for wrong in ["fmpm(0)", "fmpm(2.5)", "pic(1)"] {
        let output = chart(&folder, &["bar1d", "--transfer", wrong, "--force"]);
        assert_eq!(code(&output), 2, "{wrong}: {}", text(&output.stderr));
    }
}

#[test]
fn the_frame_is_an_axis_that_agrees_for_small_motion() {
    let folder = folder("frame");
    let arguments = [
        &SMALL[..],
        &["--cells", "16", "--frame", "updated,total"],
        &["--tolerance", "0.1"],
    ]
    .concat();
    let output = chart(&folder, &arguments);
    assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    let results = json(&output);
    let runs = results["runs"].as_array().expect("runs");
    assert_eq!(runs.len(), 4);
    let (updated, total) = runs.split_at(2);
    for (updated, total) in updated.iter().zip(total) {
        assert_eq!(updated["frame"], "updated");
        assert_eq!(total["frame"], "total");
        assert_eq!(updated["steps"], total["steps"]);
        let of = |run: &serde_json::Value, name: &str| run[name].as_f64().expect("a number");
        let ratio = of(total, "error") / of(updated, "error");
        assert!((ratio - 1.0).abs() < 1e-2, "{results}");
        assert!(of(total, "work") > of(updated, "work"));
    }
    let rows = std::fs::read_to_string(folder.join("charts/manufactured/chart.csv"));
    assert!(
        rows.expect("a table")
            .starts_with("dimensions,frame,basis,")
    );
    let wrong = chart(&folder, &["manufactured", "--frame", "eulerian"]);
    assert_eq!(code(&wrong), 2);
    assert!(text(&wrong.stderr).contains("--frame"));
}

#[test]
fn a_run_that_blows_up_is_on_the_chart_as_such() {
    let folder = folder("failed");
    let mut arguments = SMALL.to_vec();
    arguments[10] = "0.4,5";
    // many cells, or recorded times would keep the steps short
    arguments.extend(["--frame", "updated", "--cells", "64"]);
    let output = chart(&folder, &arguments);
    assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    let results = json(&output);
    let runs = results["runs"].as_array().expect("runs");
    let status = |courant: f64| {
        let run = runs.iter().find(|run| run["courant"] == courant);
        run.expect("the run")["status"]
            .as_str()
            .expect("a status")
            .to_string()
    };
    assert_eq!(runs.len(), 4);
    assert_eq!(status(0.4), "done");
    assert_ne!(status(5.0), "done");

    // beyond its critical step of 1.05 a vibration grows; a run that comes to its end is told apart from one that is right
    let grown = [
        &["manufactured", "--basis=quadratic", "--transfer=flip"][..],
        &[
            "--update=usl",
            "--frame=updated",
            "--points=2",
            "--cells=64",
        ],
        &["--courant=1.5", "--repeat=1", "--json", "--force"],
    ]
    .concat();
    let results = json(&chart(&folder, &grown));
    let run = &results["runs"][0];
    assert_eq!(run["status"], "unstable", "{results}");
    assert!(run["error"].as_f64().expect("an error") > 1.0);
    assert_eq!(results["frontier"].as_array().map(Vec::len), Some(0));
}

#[test]
fn everything_that_is_wrong_is_said_at_once() {
    let folder = folder("wrong");
    let arguments = [
        "manufactured",
        "--basis",
        "qudratic",
        "--cells",
        "0",
        "--courant",
        "fast",
        "--dimensions",
        "4",
        "--tolerance",
        "zero",
    ];
    let output = chart(&folder, &arguments);
    assert_eq!(code(&output), 2);
    let said = text(&output.stderr);
    for option in [
        "--basis",
        "--cells",
        "--courant",
        "--dimensions",
        "--tolerance",
    ] {
        assert!(said.contains(option), "{option} is missing in {said}");
    }
    assert!(said.contains("5 problems"), "{said}");
    assert!(!folder.join("charts").exists(), "nothing is written");
    let unknown = chart(&folder, &["manufacturd"]);
    assert_eq!(code(&unknown), 2);
    assert!(text(&unknown.stderr).contains("did you mean \"manufactured\"?"));
    let missing = chart(&folder, &["nowhere.toml"]);
    assert_eq!(code(&missing), 2);
}

#[test]
fn a_scenario_is_charted_against_a_finer_run_of_itself() {
    let folder = folder("file");
    let arguments = [
        BAR,
        "--set",
        "time.end=10",
        "--set",
        "output.every=1",
        "--set",
        "grid.max=[\"32 m\"]",
        "--basis",
        "linear",
        "--transfer",
        "flip",
        "--update",
        "musl",
        "--cells",
        "16,32",
        "--points",
        "2",
        "--courant",
        "0.3",
        "--repeat",
        "1",
        "--json",
    ];
    let output = chart(&folder, &arguments);
    assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    let results = json(&output);
    let runs = results["runs"].as_array().expect("runs");
    let error = |i: usize| runs[i]["error"].as_f64().expect("an error");
    assert!(error(1) < error(0) && error(0) < 0.5, "{results}");
    // a reference no finer than that would be this very run
    assert!(error(1) > 1e-3, "{results}");
    assert!(folder.join("charts/bar1d/chart.csv").is_file());
}

/// The method of a file that names none is on the chart as such, and by how much it is dearer than the best.
#[test]
fn the_default_is_seen_beside_the_cheapest() {
    let folder = folder("default");
    let arguments = [
        "bar1d",
        "--frame=updated,total",
        "--basis=linear,gimp,quadratic",
        "--transfer=apic",
        "--points=2",
        "--courant=0.4",
        "--cells=8,16",
        "--repeat=1",
    ];
    let output = chart(&folder, &arguments);
    assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    let shown = text(&output.stdout);
    let said = "The default of this scene, total linear apic usl, beside the cheapest of all";
    assert!(shown.contains(said), "{shown}");
    // the same error as in the updated frame, for 4.2 nodes in place of 4
    assert!(shown.contains("1.05"), "{shown}");
    let rows = std::fs::read_to_string(folder.join("charts/bar1d/chart.csv")).expect("a table");
    let defaults: Vec<&str> = rows.lines().filter(|row| row.contains(",true,")).collect();
    assert_eq!(defaults.len(), 2, "{rows}");
    let named = |row: &&str| row.contains("total,linear,apic,usl");
    assert!(defaults.iter().all(named), "{rows}");

    let without = [&arguments[..2], &["--basis=quadratic"], &arguments[3..]].concat();
    let output = chart(&folder, &[&without[..], &["--force"]].concat());
    assert!(text(&output.stdout).contains("is not among the runs"));
}
