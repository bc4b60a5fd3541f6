//! The program as its users meet it: exit codes, streams, folders.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

const BAR: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/scenarios/bar1d.toml");

/// A folder of its own for one test, empty at the start.
fn folder(test: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("cli_{test}"));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a folder in the target folder");
    folder
}

fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_mpm"));
    command.current_dir(folder).args(arguments);
    command
}

fn mpm(folder: &Path, arguments: &[&str]) -> Output {
    command(folder, arguments)
        .output()
        .expect("the program starts")
}

fn code(output: &Output) -> i32 {
    output.status.code().expect("no signal")
}

fn out(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).expect("text")
}

fn err(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).expect("text")
}

fn json(output: &Output) -> serde_json::Value {
    serde_json::from_slice(&output.stdout).expect("one JSON object on standard output")
}

/// Name and bytes of every table in a folder.
fn tables(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let entries = std::fs::read_dir(folder).expect("a run folder");
    let mut tables: Vec<_> = entries
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|end| end == "csv"))
        .map(|path| {
            let name = path
                .file_name()
                .expect("a name")
                .to_string_lossy()
                .into_owned();
            (name, std::fs::read(&path).expect("a table"))
        })
        .collect();
    tables.sort();
    tables
}

/// A row that a program can read: as many finite numbers as the header has names.
fn assert_readable(tables: &[(String, Vec<u8>)]) {
    for (name, bytes) in tables {
        let text = String::from_utf8(bytes.clone()).expect("text");
        let mut lines = text.lines();
        let columns = lines.next().expect("a header").split(',').count();
        let mut rows = 0;
        for line in lines {
            let numbers: Vec<f64> = line
                .split(',')
                .map(|number| number.parse().expect("a number"))
                .collect();
            assert_eq!(numbers.len(), columns, "{name}: {line}");
            rows += 1;
        }
        assert!(rows > 0, "{name} has no row");
    }
}

const SHORT: &str = "time.end=1";

#[test]
fn a_run_fills_its_folder_and_reports_on_standard_output() {
    let folder = folder("run");
    let run = mpm(&folder, &["run", BAR, "--set", SHORT]);
    assert_eq!(code(&run), 0, "{}", err(&run));
    assert!(out(&run).contains("simulated"), "{}", out(&run));
    assert_eq!(err(&run), "");
    let runs = folder.join("runs/bar1d");
    let names = [
        "energy.csv",
        "body_bar.csv",
        "probe_second.csv",
        "boundary_wall.csv",
        "run.toml",
        "summary.json",
        "energy.png",
        "motion.png",
    ];
    for name in names {
        assert!(runs.join(name).exists(), "{name}");
    }
    assert_readable(&tables(&runs));
    let energy = std::fs::read_to_string(runs.join("energy.csv")).expect("a table");
    let header = "time,step,kinetic,elastic,potential,numerical,boundary_work,total,residual";
    assert_eq!(energy.lines().next(), Some(header));
    assert_eq!(energy.lines().count(), 12);
}

#[test]
fn quiet_prints_nothing_and_json_prints_one_object() {
    let folder = folder("streams");
    let quiet = mpm(
        &folder,
        &["run", BAR, "--set", SHORT, "--quiet", "--output", "a"],
    );
    assert_eq!(
        (code(&quiet), out(&quiet), err(&quiet)),
        (0, String::new(), String::new())
    );
    let run = mpm(
        &folder,
        &["run", BAR, "--set", SHORT, "--json", "--output", "b"],
    );
    let summary = json(&run);
    assert_eq!(summary["status"], "done");
    assert_eq!(summary["particles"], 25);
    assert_eq!(summary["time"], 1.0);
    assert_eq!(err(&run), "");
    let written = std::fs::read(folder.join("b/summary.json")).expect("a summary");
    assert_eq!(written, run.stdout);
    let bare = mpm(
        &folder,
        &["run", BAR, "--set", SHORT, "--no-pictures", "--output", "c"],
    );
    assert_eq!(code(&bare), 0);
    assert!(!folder.join("c/energy.png").exists());
}

#[test]
fn set_changes_the_run_and_is_kept_in_its_folder() {
    let folder = folder("set");
    let stiffer = "material.bar.linear_elastic.youngs_modulus=\"400 Pa\"";
    let run = mpm(
        &folder,
        &[
            "run", BAR, "--set", SHORT, "--set", stiffer, "--json", "--output", "stiff",
        ],
    );
    assert_eq!(code(&run), 0, "{}", err(&run));
    let kept = std::fs::read_to_string(folder.join("stiff/run.toml")).expect("run.toml");
    assert!(kept.contains("400 Pa"), "{kept}");
    let plain = mpm(
        &folder,
        &["run", BAR, "--set", SHORT, "--json", "--output", "plain"],
    );
    assert!(json(&run)["steps"].as_u64() > json(&plain)["steps"].as_u64());
    let again = mpm(
        &folder,
        &["run", "stiff/run.toml", "--output", "again", "--quiet"],
    );
    assert_eq!(code(&again), 0, "{}", err(&again));
    assert_eq!(tables(&folder.join("again")), tables(&folder.join("stiff")));
}

#[test]
fn an_earlier_run_is_replaced_only_by_force_and_strangers_are_left_alone() {
    let folder = folder("force");
    let run = |extra: &[&str]| {
        let mut arguments = vec!["run", BAR, "--set", SHORT, "--output", "runs"];
        arguments.extend(extra);
        mpm(&folder, &arguments)
    };
    assert_eq!(code(&run(&["--quiet"])), 0);
    std::fs::write(folder.join("runs/mine.csv"), "keep").expect("written");
    let before = tables(&folder.join("runs"));
    let refused = run(&["--set", "time.courant=0.3"]);
    assert_eq!(code(&refused), 2);
    assert!(err(&refused).contains("--force"), "{}", err(&refused));
    assert_eq!(out(&refused), "");
    assert_eq!(tables(&folder.join("runs")), before);
    assert_eq!(code(&run(&["--set", "time.courant=0.3", "--force"])), 0);
    assert_ne!(tables(&folder.join("runs")), before);
    let kept = std::fs::read_to_string(folder.join("runs/mine.csv")).expect("a file");
    assert_eq!(kept, "keep");
}

#[test]
fn a_wrong_scenario_is_refused_before_anything_is_written() {
    let folder = folder("wrong");
    let run = mpm(
        &folder,
        &["run", BAR, "--set", "time.courant=fast", "--output", "new"],
    );
    assert_eq!(code(&run), 2);
    assert!(err(&run).starts_with("error: "), "{}", err(&run));
    assert!(err(&run).ends_with('\n') && !err(&run).ends_with("\n\n"));
    assert_eq!(out(&run), "");
    let missing = mpm(&folder, &["run", "nothing.toml"]);
    assert_eq!(code(&missing), 2);
    assert!(err(&missing).contains("no such file"), "{}", err(&missing));
    let checked = mpm(
        &folder,
        &["check", BAR, "--set", "time.courant=fast", "--json"],
    );
    assert_eq!(code(&checked), 2);
    assert_eq!(json(&checked)["problems"].as_array().map(Vec::len), Some(1));
    let entries = std::fs::read_dir(&folder).expect("the folder").count();
    assert_eq!(entries, 0, "something was written");
}

#[test]
fn a_file_in_the_way_is_an_input_error_and_a_folder_that_cannot_be_made_a_system_error() {
    let folder = folder("places");
    std::fs::write(folder.join("file"), "").expect("written");
    let file = mpm(&folder, &["run", BAR, "--output", "file"]);
    assert_eq!(code(&file), 2, "{}", err(&file));
    let below = mpm(&folder, &["run", BAR, "--output", "file/below"]);
    assert_eq!(code(&below), 74, "{}", err(&below));
    let nameless = mpm(&folder, &["run", BAR, "--output", ""]);
    assert_eq!(code(&nameless), 2, "{}", err(&nameless));
}

#[test]
fn a_closed_pipe_is_no_error_and_a_full_disk_is_one() {
    let folder = folder("pipe");
    let mut child = command(&folder, &["run", BAR, "--set", SHORT])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("it ends");
    assert_eq!((code(&output), err(&output)), (0, String::new()));
    if let Ok(full) = std::fs::OpenOptions::new().write(true).open("/dev/full") {
        let output = command(&folder, &["check", BAR]).stdout(full).output();
        assert_eq!(code(&output.expect("the program starts")), 74);
    }
}

#[test]
fn a_particle_that_escapes_ends_the_run_with_code_3_and_readable_tables() {
    let folder = folder("escape");
    let away = "body[0].velocity=[\"2 m/s\"]";
    let run = mpm(
        &folder,
        &[
            "run",
            BAR,
            "--set",
            away,
            "--set",
            "boundary=[]",
            "--json",
            "--output",
            "out",
        ],
    );
    assert_eq!(code(&run), 3, "{}", err(&run));
    assert!(err(&run).contains("left the grid"), "{}", err(&run));
    let summary = json(&run);
    assert_ne!(summary["status"], "done");
    assert!(
        summary["time"]
            .as_f64()
            .is_some_and(|time| time > 0.0 && time < 100.0)
    );
    assert_readable(&tables(&folder.join("out")));
    let written = std::fs::read(folder.join("out/summary.json")).expect("a summary");
    assert_eq!(written, run.stdout);
}

#[test]
fn a_step_beyond_the_crossing_time_is_warned_of_before_the_run_and_after_it() {
    let folder = folder("step");
    let fixed = "time={ end = 1, step = 0.2 }";
    let run = mpm(&folder, &["run", BAR, "--set", fixed, "--json"]);
    assert!(err(&run).contains("2.02 times"), "{}", err(&run));
    let check = mpm(&folder, &["check", BAR, "--set", fixed, "--json"]);
    assert_eq!(code(&check), 0, "{}", err(&check));
    let plan = json(&check);
    assert!(
        plan["time_step"]["ratio"]
            .as_f64()
            .is_some_and(|ratio| ratio > 2.0)
    );
    assert!(
        plan["warnings"][0]
            .as_str()
            .is_some_and(|text| text.contains("2.02 times"))
    );
}

#[test]
fn check_tells_the_plan_and_writes_nothing() {
    let folder = folder("check");
    let check = mpm(&folder, &["check", BAR]);
    assert_eq!(code(&check), 0, "{}", err(&check));
    for word in [
        "1D",
        "25 particles",
        "linear",
        "flip",
        "musl",
        "wave speed",
        "run time",
    ] {
        assert!(out(&check).contains(word), "{word}: {}", out(&check));
    }
    let plan = json(&mpm(&folder, &["check", BAR, "--json"]));
    assert_eq!(plan["particles"], 25);
    assert_eq!(plan["boundaries"][0]["nodes"], 1);
    let steps = plan["time_step"]["steps"].as_f64().expect("a number");
    assert!((steps - 11_000.0).abs() < 600.0, "{steps}");
    assert_eq!(std::fs::read_dir(&folder).expect("the folder").count(), 0);
}

#[test]
fn check_warns_of_boundaries_and_loads_that_do_nothing() {
    let folder = folder("idle");
    let load = "load=[{ body = \"bar\", on.side = \"x_max\", force = [1.0], factor = \"0 * t\" }]";
    let far = "boundary[0].on={ box = { min = [29.5] } }";
    let check = mpm(
        &folder,
        &[
            "check",
            BAR,
            "--set",
            "grid.max=[30]",
            "--set",
            far,
            "--set",
            load,
        ],
    );
    assert_eq!(code(&check), 0, "{}", err(&check));
    assert!(err(&check).contains("holds no node"), "{}", err(&check));
    assert!(err(&check).contains("factor is zero"), "{}", err(&check));
}

/// A block of 9216 points, enough for several threads to share.
const BLOCK: &str = r#"
dimension = 2
gravity = [0.0, -1.0]

[time]
end = 0.02
courant = 0.4

[grid]
min = [0.0, 0.0]
max = [1.5, 1.0]
cell_size = 0.0125

[material.soft]
density = 1000
neo_hookean = { youngs_modulus = 1e5, poissons_ratio = 0.3 }

[[body]]
name = "block"
material = "soft"
shape.box = { min = [0.2, 0.0], max = [0.8, 0.6] }
velocity = ["1 m/s + y / (1 s)", "0.1 * x / (1 s)"]

[[boundary]]
name = "floor"
on.side = "y_min"
condition = "roller"

[[probe]]
name = "corner"
body = "block"
near = [0.8, 0.6]

[output]
samples = 8
"#;

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let folder = folder("threads");
    std::fs::write(folder.join("block.toml"), BLOCK).expect("written");
    let run = |threads: &str| {
        let output = mpm(
            &folder,
            &[
                "run",
                "block.toml",
                "--threads",
                threads,
                "--output",
                threads,
                "--json",
            ],
        );
        assert_eq!(code(&output), 0, "{}", err(&output));
        assert_eq!(json(&output)["threads"].to_string(), threads);
        assert!(json(&output)["particles"].as_u64() > Some(8000));
        tables(&folder.join(threads))
    };
    let one = run("1");
    assert_readable(&one);
    assert_eq!(run("2"), one);
    assert_eq!(run("7"), one);
    for picture in ["particles.png", "stress.png"] {
        assert!(folder.join("2").join(picture).exists(), "{picture}");
    }
}

#[test]
fn validate_names_cases_and_refuses_unknown_ones() {
    let folder = folder("validate");
    let list = mpm(&folder, &["validate", "--list"]);
    assert_eq!(code(&list), 0);
    assert!(out(&list).contains("bar1d"), "{}", out(&list));
    let unknown = mpm(&folder, &["validate", "bar1e"]);
    assert_eq!(code(&unknown), 2);
    assert!(
        err(&unknown).contains("did you mean \"bar1d\"?"),
        "{}",
        err(&unknown)
    );
    let run = mpm(
        &folder,
        &["validate", "bar1d", "--json", "--output", "compared"],
    );
    assert_eq!(code(&run), 0, "{}", err(&run));
    assert_eq!(json(&run)["passed"], true);
    assert!(
        std::fs::read_dir(folder.join("compared"))
            .expect("a folder")
            .count()
            >= 2
    );
}

#[test]
fn usage_errors_end_with_code_2_and_help_with_0() {
    let folder = folder("usage");
    for arguments in [&["fly"][..], &["run"], &["run", BAR, "--threads", "0"], &[]] {
        let output = mpm(&folder, arguments);
        assert_eq!(code(&output), 2, "{arguments:?}");
        assert!(!err(&output).is_empty() && out(&output).is_empty());
    }
    for arguments in [
        &["--help"][..],
        &["run", "--help"],
        &["check", "--help"],
        &["--version"],
    ] {
        let output = mpm(&folder, arguments);
        assert_eq!(code(&output), 0, "{arguments:?}");
        assert!(!out(&output).is_empty() && err(&output).is_empty());
    }
    assert!(out(&mpm(&folder, &["run", "--help"])).contains("Examples:"));
}

#[test]
fn stability_shows_its_edges_and_writes_tables_and_pictures() {
    let folder = folder("stability");
    let shown = mpm(
        &folder,
        &["stability", "jaumann", "walls", "--output", "maps"],
    );
    assert_eq!(code(&shown), 0, "{}", err(&shown));
    assert!(out(&shown).contains("FAILS") && out(&shown).contains("survives"));
    for case in ["jaumann", "walls"] {
        for ending in ["csv", "json", "png"] {
            let path = folder.join(format!("maps/{case}.{ending}"));
            assert!(path.exists(), "{}", path.display());
        }
    }
    let again = mpm(&folder, &["stability", "walls", "--output", "maps"]);
    assert_eq!(code(&again), 2);
    assert!(err(&again).contains("--force"), "{}", err(&again));
    let forced = [
        "stability",
        "walls",
        "--output",
        "maps",
        "--force",
        "--json",
    ];
    let forced = mpm(&folder, &forced);
    assert_eq!(code(&forced), 0, "{}", err(&forced));
    assert_eq!(json(&forced)["cases"][0]["case"], "walls");
    let list = mpm(&folder, &["stability", "--list"]);
    assert!(out(&list).contains("courant"), "{}", out(&list));
    for (arguments, hint) in [
        (["stability", "wals", "--list"], "did you mean \"walls\"?"),
        (["stability", "--basis", "kubic"], "known here: cpdi, cubic"),
    ] {
        let wrong = mpm(&folder, &arguments);
        assert_eq!(code(&wrong), 2);
        assert!(err(&wrong).contains(hint), "{}", err(&wrong));
    }
}
