//! What `mpm check` promises is what a run then does.

mod common;

use mpm::run::{Scene, build};
use mpm::scenario::parse;
use mpm::study::validate::simulate;
use std::path::PathBuf;
use std::process::Command;

/// A block in a corner of the grid, nowhere held, softly bound.
const BLOCK: &str = r#"
dimension = 2
time = { end = 0.5, courant = 0.4 }
grid = { min = [0, 0], max = [8, 6], cell_size = 0.5 }
method = { basis = "quadratic", transfer = "apic", update = "usl", frame = "updated" }
material.soft = { density = 2, linear_elastic = { youngs_modulus = 1000, poissons_ratio = 0.3 } }
output.every = 0.03
[[body]]
name = "block"
material = "soft"
shape.box = { min = [2, 1], max = [5, 3] }
velocity = [0.001, 0]
"#;

fn check(name: &str, text: &str) -> serde_json::Value {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("plan");
    std::fs::create_dir_all(&folder).expect("a folder in the target folder");
    let file = folder.join(format!("{name}.toml"));
    std::fs::write(&file, text).expect("written");
    let output = Command::new(env!("CARGO_BIN_EXE_mpm"))
        .arg("check")
        .arg(&file)
        .arg("--json")
        .output()
        .expect("the program starts");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    serde_json::from_slice(&output.stdout).unwrap_or_else(|error| panic!("{error}: {said}"))
}

/// A step, s.
const STEP: f64 = 1e-3;

/// What a scene has before its first step, and after it.
fn around_a_step<T>(text: &str, of: impl Fn(&Scene<2>) -> T) -> [T; 2] {
    let loaded = parse("block", text, &[]).unwrap_or_else(|error| panic!("{error}"));
    let mut scene = build::<2>(&loaded.scenario);
    scene
        .solver
        .start(&mut scene.state)
        .unwrap_or_else(|fault| panic!("{fault}"));
    let before = of(&scene);
    scene
        .solver
        .step(&mut scene.state, STEP)
        .unwrap_or_else(|fault| panic!("{fault}"));
    [before, of(&scene)]
}

#[track_caller]
fn number(value: &serde_json::Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value}"))
}

#[test]
fn a_run_has_the_steps_rows_and_mass_of_its_plan() {
    for (name, change) in [("courant", ""), ("fixed", "step = 0.007")] {
        let text = match change {
            "" => BLOCK.to_string(),
            step => BLOCK.replace("courant = 0.4", step),
        };
        let plan = check(name, &text);
        let run = simulate(&text, &[], true).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(number(&plan["output"]["rows"]), run.summary.rows as f64);
        let steps = number(&plan["time_step"]["steps"]);
        // the last row comes early, and its steps are cut to meet it
        let taken = run.summary.steps as f64;
        assert!((steps - taken).abs() <= 2.0, "{name}: {steps}, {taken}");
        assert!(taken > 50.0);
        let dt = number(&plan["time_step"]["dt"]);
        assert!((dt / run.summary.dt[1] - 1.0).abs() < 0.02, "{name}: {dt}");
        assert_eq!(number(&plan["particles"]), run.summary.particles as f64);
        // 3 m × 2 m × 2 kg/m³
        let mass = number(&plan["bodies"][0]["mass"]);
        assert!((mass - 12.0).abs() < 1e-12, "{mass}");
    }
}

/// A free body gets the impulse of the force that is told, whatever kind of load it is.
#[test]
fn loads_give_the_force_that_is_told() {
    for (kind, load, exact) in [
        ("force", "on.side = \"x_max\"\nforce = [3, -1]", [3.0, -1.0]),
        ("low", "on.side = \"x_min\"\npressure = 4", [8.0, 0.0]),
        ("high", "on.side = \"y_max\"\npressure = 4", [0.0, -12.0]),
        (
            "pull",
            "on.side = \"y_min\"\ntraction = [1, -2]",
            [3.0, -6.0],
        ),
        (
            "field",
            "on.box = { min = [0, 0] }\nacceleration = [\"2 / (1 s^2) * x\", \"-1 m/s^2\"]",
            // ∫ ρ 2 x over the block
            [84.0, -12.0],
        ),
        // the upper of the two layers of points in the ball's reach looks up into it, 8 points wide
        (
            "surface",
            "on.shape.ball = { center = [3.5, 3.2], radius = 1 }\npressure = 4",
            [0.0, -8.0],
        ),
        (
            "inside",
            "on.shape.ball = { center = [3.5, 2], radius = 0.5 }\nforce = [3, -1]",
            [3.0, -1.0],
        ),
    ] {
        let text = format!("{BLOCK}\n[[load]]\nname = \"{kind}\"\nbody = \"block\"\n{load}\n");
        let plan = check(kind, &text);
        let [before, after] = around_a_step(&text, |scene| scene.state.bodies[0].totals().momentum);
        let given = (after - before) / STEP;
        for a in 0..2 {
            let told = number(&plan["loads"][0]["force"][a]);
            assert!((told - exact[a]).abs() < 1e-11, "{kind}: {told}");
            assert!((given[a] - told).abs() < 1e-9, "{kind}: {given}");
        }
    }
}

/// The torque of a traction is that of its face, which lies half a spacing outside the outermost points.
#[test]
fn a_traction_acts_on_the_face_it_is_given_for() {
    for (side, place, length) in [
        ("x_min", [2.0, 2.0], 2.0),
        ("x_max", [5.0, 2.0], 2.0),
        ("y_min", [3.5, 1.0], 3.0),
        ("y_max", [3.5, 3.0], 3.0),
    ] {
        let load = format!("on.side = \"{side}\"\ntraction = [1, -2]");
        let text = format!("{BLOCK}\n[[load]]\nbody = \"block\"\n{load}\n");
        let spin = |scene: &Scene<2>| scene.solver.angular_momentum(&scene.state, 0)[0];
        let [before, after] = around_a_step(&text, spin);
        let torque = (after - before) / STEP;
        let exact = length * (place[0] * -2.0 - place[1]);
        assert!((torque - exact).abs() < 1e-9, "{side}: {torque}, {exact}");
    }
}

/// The bore of a ring, as seen along each axis; a body that is pressed in its bore alone goes nowhere and does not spin.
#[test]
fn a_pressure_in_a_bore_is_told_by_the_sides_that_it_acts_on() {
    let ring = "shape.difference = { of.ball = { center = [4, 3], radius = 2.5 }, minus = [{ ball = { center = [4, 3], radius = 1 } }] }";
    let text = BLOCK.replace("shape.box = { min = [2, 1], max = [5, 3] }", ring)
        + "[[load]]\nbody = \"block\"\non.shape.ball = { center = [4, 3], radius = 1 }\npressure = 4\n";
    let plan = check("bore", &text);
    let faces = plan["loads"][0]["faces"].as_array().expect("a list");
    let sides: Vec<_> = faces.iter().map(|faces| faces["side"].as_str()).collect();
    assert_eq!(sides, ["x_min", "x_max", "y_min", "y_max"].map(Some));
    for faces in faces {
        // 2 m with points 0.25 m apart
        assert_eq!(faces["count"], 8);
        assert!((number(&faces["area"]) - 2.0).abs() < 1e-12);
    }
    let [before, after] = around_a_step(&text, |scene| {
        let spin = scene.solver.angular_momentum(&scene.state, 0)[0];
        (scene.state.bodies[0].totals().momentum, spin)
    });
    let force = (after.0 - before.0) / STEP;
    assert!(force.norm() < 1e-9, "{force}");
    assert!((after.1 - before.1).abs() / STEP < 1e-9);
}

/// Rings differ in mass; a force on all of them moves them alike.
#[test]
fn a_force_is_shared_by_mass() {
    let text = BLOCK.replace("dimension = 2", "dimension = 2\nplane = \"axisymmetric\"")
        + "[[load]]\nbody = \"block\"\non.box = { min = [0, 0] }\nforce = [0, 5]\n";
    let [_, (mass, velocities)] = around_a_step(&text, |scene| {
        let body = &scene.state.bodies[0];
        (body.totals().mass, body.particles.velocity.clone())
    });
    let exact = 5.0 * STEP / mass;
    for v in velocities {
        assert!((v[1] / exact - 1.0).abs() < 1e-9, "{}, {exact}", v[1]);
    }
}
