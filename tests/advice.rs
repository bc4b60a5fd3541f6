//! Who follows the advice of `mpm check` gets the same answer.

use mpm::study::validate::{Recorded, simulate};
use std::process::Command;

fn run(text: &str) -> Recorded {
    simulate(text, &[], false).unwrap_or_else(|error| panic!("{text}\n{error}"))
}

/// The kinds of advice that `mpm check --json` gives on a scenario, with what it says in words.
fn advised(name: &str, text: &str) -> (Vec<String>, String) {
    let path = std::env::temp_dir().join(format!("mpm_advice_{name}_{}.toml", std::process::id()));
    std::fs::write(&path, text).expect("a place for temporary files");
    let check = |more: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_mpm"))
            .arg("check")
            .arg(&path)
            .args(more)
            .output()
            .expect("the program starts");
        assert!(output.status.success());
        output.stdout
    };
    let plan: serde_json::Value = serde_json::from_slice(&check(&["--json"])).expect("JSON");
    let words = String::from_utf8(check(&[])).expect("a text");
    std::fs::remove_file(&path).expect("the file is there");
    let kinds = plan["advice"].as_array().expect("a list").iter();
    let kinds = kinds.map(|advice| advice["kind"].as_str().expect("a kind").to_string());
    (kinds.collect(), words)
}

/// The largest difference of a column, beside its largest change.
fn difference(a: &Recorded, b: &Recorded, table: &str, column: &str) -> f64 {
    let (a, b) = (a.column(table, column), b.column(table, column));
    assert_eq!(a.len(), b.len());
    let largest =
        |numbers: &mut dyn Iterator<Item = f64>| numbers.fold(0.0, |m: f64, x| m.max(x.abs()));
    let change = largest(&mut a.iter().map(|x| x - a[0]));
    assert!(change > 0.0, "{table}.{column} moves");
    largest(&mut a.iter().zip(&b).map(|(a, b)| a - b)) / change
}

/// A bar that vibrates under a load at its end, and slams into compression by several percent.
fn bar(dimension: usize, method: &str) -> String {
    let list = |x: &str, other: &str| {
        let others = [other; 2];
        let all: Vec<&str> = std::iter::once(x).chain(others).take(dimension).collect();
        format!("[{}]", all.join(", "))
    };
    let sides = ["y_min", "y_max", "z_min", "z_max"];
    let rollers: String = sides[..2 * (dimension - 1)]
        .iter()
        .map(|side| {
            format!(
                "[[boundary]]\nname = \"{side}\"\non.side = \"{side}\"\ncondition = \"roller\"\n"
            )
        })
        .collect();
    let (high, load) = (list("10", "1"), list("8e-1", "0"));
    let velocity = list("\"0.4 * sin(pi * x / (16 m))\"", "0");
    let shape = list("8", "1");
    let zero = list("0", "0");
    format!(
        r#"dimension = {dimension}
time = {{ end = 2, courant = 0.3 }}
grid = {{ min = {zero}, max = {high}, cell_size = 0.5 }}
output.samples = 20
{method}
material.soft = {{ density = 1, neo_hookean = {{ youngs_modulus = 100, poissons_ratio = 0.3 }} }}
[[body]]
name = "bar"
material = "soft"
shape.box = {{ min = {zero}, max = {shape} }}
velocity = {velocity}
[[boundary]]
name = "held"
on.side = "x_min"
condition = "fixed"
{rollers}[[load]]
name = "pull"
body = "bar"
on.side = "x_max"
force = {load}
[[probe]]
name = "tip"
body = "bar"
near = {shape}
"#
    )
}

#[test]
fn a_bar_between_rollers_moves_in_one_dimension_as_in_three() {
    let (kinds, words) = advised("bar", &bar(3, ""));
    assert!(
        kinds.contains(&"uniform_along_axis".to_string()),
        "{kinds:?}"
    );
    assert!(
        words.contains("advice     nothing varies along y and z"),
        "{words}"
    );
    assert!(advised("thin_bar", &bar(1, "")).0.is_empty());
    for (basis, transfer) in [
        ("linear", "flip"),
        ("gimp", "flip"),
        ("gimp", "mls_apic"),
        ("quadratic", "flip"),
        ("quadratic", "apic"),
    ] {
        let method = format!("method = {{ basis = \"{basis}\", transfer = \"{transfer}\" }}");
        let thin = run(&bar(1, &method));
        for dimension in [2, 3] {
            let wide = run(&bar(dimension, &method));
            // nothing but the order of sums differs
            let apart = difference(&thin, &wide, "probe_tip", "position_x");
            assert!(apart < 1e-10, "{basis} {transfer} {dimension}D: {apart:e}");
        }
    }
}

/// A block on a floor that is squeezed from both sides, or its right half against a roller.
fn block(half: bool, basis: &str) -> String {
    let (low, left, start) = if half {
        (
            "0",
            "0",
            "{ name = \"middle\", on.side = \"x_min\", condition = \"roller\" }, ",
        )
    } else {
        ("-4", "-2", "")
    };
    let other = if half {
        ""
    } else {
        ", { name = \"left\", body = \"block\", on.side = \"x_min\", traction = [3, 0] }"
    };
    format!(
        r#"dimension = 2
time = {{ end = 1, courant = 0.3 }}
grid = {{ min = [{low}, 0], max = [4, 4], cell_size = 0.25 }}
output.samples = 20
gravity = [0, -1]
method = {{ basis = "{basis}", transfer = "flip", update = "musl" }}
material.soft = {{ density = 1, neo_hookean = {{ youngs_modulus = 100, poissons_ratio = 0.3 }} }}
boundary = [{start}{{ name = "floor", on.side = "y_min", condition = "roller" }}]
load = [{{ name = "right", body = "block", on.side = "x_max", traction = [-3, 0] }}{other}]
probe = [{{ name = "corner", body = "block", near = [2, 2] }}]
[[body]]
name = "block"
material = "soft"
shape.box = {{ min = [{left}, 0], max = [2, 2] }}
"#
    )
}

#[test]
fn half_of_a_symmetric_block_moves_as_the_whole() {
    let (kinds, words) = advised("block", &block(false, "linear"));
    assert_eq!(kinds, ["mirror_symmetry"]);
    assert!(
        words.contains("about 2.0 times cheaper. grid.min[0] = 0"),
        "{words}"
    );
    assert!(advised("half_block", &block(true, "linear")).0.is_empty());
    // splines have other functions at the end of a grid than in its middle: the same answer but for the error of the grid
    for (basis, most) in [("linear", 1e-10), ("quadratic", 0.02)] {
        let (whole, half) = (run(&block(false, basis)), run(&block(true, basis)));
        for column in ["position_x", "position_y"] {
            let apart = difference(&whole, &half, "probe_corner", column);
            assert!(apart < most, "{basis} {column}: {apart:e}");
        }
    }
}
