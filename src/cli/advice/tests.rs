//! Scenes that get advice, and what has to change so that they must not.

use super::Advice;
use crate::cli::plan::Planner;
use crate::run::with_scene;
use crate::scenario::parse;

fn advice(text: &str, changes: &[&str]) -> Vec<Advice> {
    let changes: Vec<String> = changes.iter().map(ToString::to_string).collect();
    let loaded = parse("scene", text, &changes).unwrap_or_else(|error| panic!("{error}"));
    let planner = Planner {
        scenario: &loaded.scenario,
        warnings: Vec::new(),
    };
    with_scene(&loaded.scenario, planner).advice
}

/// The one piece of advice of a kind, if there is any.
fn of(kind: &str, text: &str, changes: &[&str]) -> Option<Advice> {
    let mut all = advice(text, changes);
    all.retain(|advice| advice.kind == kind);
    assert!(all.len() < 2, "{all:?}");
    all.pop()
}

/// A bar along x between rollers across y and z, of 16 × 4 × 2 points.
const BAR: &str = r#"
dimension = 3
time = { end = 0.5, courant = 0.4 }
grid = { min = [0, 0, 0], max = [8, 2, 1], cell_size = 1 }
material.soft = { density = 1, neo_hookean = { youngs_modulus = 100, poissons_ratio = 0.3 } }
output.samples = 2
gravity = [-1, 0, 0]
[[body]]
name = "bar"
material = "soft"
shape.box = { min = [0, 0, 0], max = [8, 2, 1] }
velocity = ["0.1 * sin(pi * x / (8 m))", 0, 0]
[[boundary]]
name = "held"
on.side = "x_min"
condition = "fixed"
[[boundary]]
name = "low_y"
on.side = "y_min"
condition = "roller"
[[boundary]]
name = "high_y"
on.side = "y_max"
condition = "roller"
[[boundary]]
name = "low_z"
on.side = "z_min"
condition = "roller"
[[boundary]]
name = "high_z"
on.side = "z_max"
condition = "roller"
[[load]]
name = "pull"
body = "bar"
on.side = "x_max"
force = [3, 0, 0]
"#;

#[test]
fn a_bar_between_rollers_needs_one_dimension() {
    let found = of("uniform_along_axis", BAR, &[]).expect("advice");
    assert!(found.change.starts_with("dimension = 1;"), "{found:?}");
    assert!(
        found
            .change
            .contains(r#""low_y", "high_y", "low_z" and "high_z""#)
    );
    assert!(found.change.contains("divide the force of \"pull\" by 2"));
    // 8 points of 8 nodes for one of 2
    let expected = 8.0 * (467.0 + 13.1 * 8.0 + 122.0) / (100.0 + 12.5 * 2.0 + 12.0);
    assert!(
        (found.factor.unwrap_or(0.0) / expected - 1.0).abs() < 1e-12,
        "{found:?}"
    );
}

#[test]
fn what_varies_along_one_axis_leaves_two_dimensions() {
    for change in [
        "gravity=[0, 0, -1]",
        "body[0].velocity=[0, 0, 0.1]",
        "body[0].velocity=[\"0.1 / (1 s) * z\", 0, 0]",
        "boundary[4].condition=\"wall\"",
        "boundary[4].condition=\"fixed\"",
        "boundary[4].on.side=\"x_max\"",
        "body[0].shape.box.max=[8, 2, 0.5]",
        "load[0].force=[0, 0, 1]",
        "boundary[0].condition={ driven = { velocity = [0, 0, 0.1] } }",
        "boundary[0].condition={ driven = { velocity = [\"0.1 / (1 s) * z\", \"free\", 0] } }",
    ] {
        let found = of("uniform_along_axis", BAR, &[change]).unwrap_or_else(|| panic!("{change}"));
        assert!(
            found
                .change
                .starts_with("dimension = 2; leave out the y entry"),
            "{change}: {found:?}"
        );
        assert!(
            found.change.contains("x and z becomes x and y"),
            "{change}: {found:?}"
        );
    }
}

#[test]
fn a_condition_that_depends_on_other_axes_alone_is_uniform() {
    for change in [
        "boundary[0].condition={ driven = { velocity = [\"0.1 / (1 s) * t / (1 s) * 1 m\", 0, \"free\"] } }",
        "body[0].velocity=[\"0.1 / (1 s) * x\", 0, 0]",
        "load[0].factor=\"sin(t / (1 s))\"",
    ] {
        let found = of("uniform_along_axis", BAR, &[change]).unwrap_or_else(|| panic!("{change}"));
        assert!(
            found.change.starts_with("dimension = 1;"),
            "{change}: {found:?}"
        );
    }
}

#[test]
fn a_sheet_under_plane_stress_and_a_ring_have_no_model_in_fewer_dimensions() {
    let flat = r#"
dimension = 2
time = { end = 0.5, courant = 0.4 }
grid = { min = [0, 0], max = [4, 2], cell_size = 1 }
material.soft = { density = 1, neo_hookean = { youngs_modulus = 100, poissons_ratio = 0.3 } }
body = [{ name = "b", material = "soft", shape.box = { min = [1, 0], max = [4, 2] }, velocity = ["0.1 / (1 s) * x", 0] }]
boundary = [{ name = "low", on.side = "y_min", condition = "roller" }, { name = "high", on.side = "y_max", condition = "roller" }]
"#;
    let found = of("uniform_along_axis", flat, &[]).expect("advice");
    assert!(found.change.starts_with("dimension = 1;"));
    for plane in ["stress", "axisymmetric"] {
        let plane = format!("plane=\"{plane}\"");
        assert_eq!(of("uniform_along_axis", flat, &[&plane]), None);
    }
}

#[test]
fn a_cylinder_along_the_axis_is_a_disc_and_a_ball_is_not() {
    let round = r#"
dimension = 3
time = { end = 0.1, courant = 0.4 }
grid = { min = [0, 0, 0], max = [6, 6, 2], cell_size = 0.5 }
material.soft = { density = 1, neo_hookean = { youngs_modulus = 100, poissons_ratio = 0.3 } }
boundary = [{ name = "low", on.side = "z_min", condition = "roller" }, { name = "high", on.side = "z_max", condition = "roller" }]
[[body]]
name = "b"
material = "soft"
shape.cylinder = { from = [2.2, 3, 0], to = [2.2, 3, 2], radius = 1 }
velocity = [1, 0, 0]
"#;
    let found = of("uniform_along_axis", round, &[]).expect("advice");
    assert!(
        found
            .change
            .starts_with("dimension = 2; leave out the z entry"),
        "{found:?}"
    );
    assert!(!found.change.contains("becomes"), "{found:?}");
    for shape in [
        "{ cylinder = { from = [2.2, 3, 0.2], to = [2.3, 3, 1.8], radius = 1 } }",
        "{ cylinder = { from = [2.2, 3, 0], to = [2.2, 3, 1.5], radius = 1 } }",
        "{ ball = { center = [2.2, 3, 1], radius = 1 } }",
    ] {
        let change = format!("body[0].shape={shape}");
        assert_eq!(of("uniform_along_axis", round, &[&change]), None, "{shape}");
    }
    let pressed = |into: &str| {
        let change = format!("load=[{{ body = \"b\", on.shape = {into}, pressure = 1 }}]");
        of("uniform_along_axis", round, &[&change])
    };
    let around = "{ cylinder = { from = [2.2, 3, 0], to = [2.2, 3, 2], radius = 3 } }";
    assert!(pressed(around).is_some());
    let to_the_middle = "{ cylinder = { from = [2.2, 3, 0], to = [2.2, 3, 1], radius = 3 } }";
    assert_eq!(pressed(to_the_middle), None);
}

/// A block on a floor, in the middle of the grid, falling apart sideways.
const BLOCK: &str = r#"
dimension = 2
time = { end = 0.5, courant = 0.4 }
grid = { min = [0, 0], max = [8, 4], cell_size = 1 }
material.soft = { density = 1, neo_hookean = { youngs_modulus = 100, poissons_ratio = 0.3 } }
gravity = [0, -1]
output.samples = 2
[[body]]
name = "block"
material = "soft"
shape.box = { min = [2, 0], max = [6, 2] }
velocity = ["0.1 / (1 s) * (x - 4 m)", 0]
[[boundary]]
name = "floor"
on.side = "y_min"
condition = "wall"
"#;

#[test]
fn a_block_that_is_its_own_image_needs_half() {
    let found = of("mirror_symmetry", BLOCK, &[]).expect("advice");
    assert_eq!(found.factor, Some(2.0));
    assert!(found.change.contains("grid.min[0] = 4,"), "{found:?}");
    for change in [
        // a formula need not say that it is symmetric
        "body[0].velocity=[\"0.1 * sin(x / (1 m) - 4)\", \"0.1 * cos(x / (1 m) - 4)\"]",
        "body[0].shape={ ball = { center = [4, 1.5], radius = 1.2 } }",
        "boundary=[{ name = \"l\", on.side = \"x_min\", condition = \"fixed\" }, { name = \"r\", on.side = \"x_max\", condition = \"fixed\" }]",
        "boundary=[{ name = \"m\", on.box = { min = [3, 0], max = [5, 0] }, condition = \"fixed\" }]",
        "load=[{ body = \"block\", on.side = \"x_min\", traction = [-1, 0] }, { body = \"block\", on.side = \"x_max\", traction = [1, 0] }]",
        "load=[{ body = \"block\", on.side = \"y_max\", pressure = 1 }]",
        "load=[{ body = \"block\", on.shape.ball = { center = [4, 2.5], radius = 1 }, pressure = 1 }]",
        "load=[{ body = \"block\", on.shape.ball = { center = [4, 1], radius = 0.8 }, force = [0, 1] }]",
    ] {
        assert!(
            of("mirror_symmetry", BLOCK, &[change]).is_some(),
            "{change}"
        );
    }
}

#[test]
fn what_differs_from_its_image_needs_the_whole() {
    for change in [
        "gravity=[1, 0]",
        "body[0].velocity=[0.1, 0]",
        "body[0].velocity=[0, \"0.1 / (1 s) * x\"]",
        "body[0].shape.box={ min = [1, 0], max = [6, 2] }",
        "body[0].shape={ ball = { center = [4.2, 1.5], radius = 1.2 } }",
        // the plane would halve a cell
        "grid.max=[7, 4]",
        "boundary=[{ name = \"l\", on.side = \"x_min\", condition = \"fixed\" }]",
        "boundary=[{ name = \"l\", on.side = \"x_min\", condition = \"fixed\" }, { name = \"r\", on.side = \"x_max\", condition = \"roller\" }]",
        "boundary=[{ name = \"m\", on.box = { min = [2, 0], max = [5, 0] }, condition = \"fixed\" }]",
        "boundary=[{ name = \"m\", on.side = \"y_min\", condition.driven = { velocity = [0.1, 0] } }]",
        "load=[{ body = \"block\", on.side = \"x_max\", traction = [1, 0] }]",
        "load=[{ body = \"block\", on.side = \"y_max\", traction = [1, 0] }]",
        "load=[{ body = \"block\", on.shape.ball = { center = [4.5, 2.5], radius = 1 }, pressure = 1 }]",
        "load=[{ body = \"block\", on.shape.ball = { center = [4.5, 1], radius = 0.8 }, force = [0, 1] }]",
        "load=[{ body = \"block\", on.shape.ball = { center = [4, 1], radius = 0.8 }, force = [1, 0] }]",
    ] {
        assert_eq!(of("mirror_symmetry", BLOCK, &[change]), None, "{change}");
    }
}

#[test]
fn short_steps_are_noticed_unless_rows_ask_for_them() {
    let change = ["time.courant=0.05"];
    let factor = of("short_time_step", BLOCK, &change).and_then(|advice| advice.factor);
    assert!(factor.is_some_and(|f| (f - 8.0).abs() < 1.5), "{factor:?}");
    assert_eq!(of("short_time_step", BLOCK, &["time.courant=0.25"]), None);
    let rows = ["time.courant=0.05", "output={ every = 0.003 }"];
    assert_eq!(of("short_time_step", BLOCK, &rows), None);
    let fixed = ["time={ end = 0.5, step = 0.001 }"];
    let found = of("short_time_step", BLOCK, &fixed).expect("advice");
    assert!(found.change.contains("in place of time.step"), "{found:?}");
}

#[test]
fn rubber_on_linear_functions_locks() {
    let rubber = "material.soft.neo_hookean.poissons_ratio=0.49";
    for basis in ["linear", "gimp"] {
        let basis = format!("method.basis=\"{basis}\"");
        let found = of("locking", BLOCK, &[rubber, &basis]).expect("advice");
        assert_eq!(found.factor, None);
        assert_eq!(of("locking", BLOCK, &[&basis]), None);
        assert_eq!(
            of("locking", BLOCK, &[rubber, &basis, "plane=\"stress\""]),
            None
        );
    }
    assert_eq!(of("locking", BLOCK, &[rubber]), None);
    // the cure of linear functions needs no other basis
    let cured = "method={ frame = \"total\", basis = { linear = { b_bar = true } } }";
    assert_eq!(of("locking", BLOCK, &[rubber, cured]), None);
}

#[test]
fn a_motion_of_a_small_part_of_a_cell_needs_no_moving_functions() {
    let short = "time.end=0.01";
    let bare = "boundary=[]";
    // something may come to a wall later
    assert_eq!(of("small_motion", BLOCK, &[short]), None);
    let moving = "method.basis=\"cubic\"";
    let found = of("small_motion", BLOCK, &[short, bare, moving]).expect("advice");
    // 16 nodes a point, or 4 and the turning of tensors; 9 nodes are hardly dearer than that
    let expected = (245.0 + 9.4 * 16.0) / (245.0 + 9.4 * 4.0 + 42.0);
    assert_eq!(found.factor, Some(expected));
    for change in [
        vec!["time.end=0.6"],
        vec![short, "method.basis=\"linear\""],
        vec![short, "method.basis=\"quadratic\""],
        vec![short, "method.frame=\"total\""],
        vec![short, "material.soft.neo_hookean.poissons_ratio=0.49"],
        vec![
            short,
            "load=[{ body = \"block\", on.side = \"y_max\", pressure = 1 }]",
        ],
    ] {
        let change = [&[bare], &change[..]].concat();
        assert_eq!(of("small_motion", BLOCK, &change), None, "{change:?}");
    }
}

/// A block at rest falls g t²/2 = 0.1 cells in √(0.2 h/g), and one that flies comes v t far.
#[test]
fn a_tenth_of_a_cell_is_the_most_that_counts_as_small() {
    let falling = ["body[0].velocity=[0, 0]", "grid.cell_size=0.5"];
    let flying = ["body[0].velocity=[0.3, 0.4]", "gravity=[0, 0]"];
    let halved = [&flying[..], &falling[1..]].concat();
    for (scene, longest) in [
        (&falling[..1], 0.2_f64.sqrt()),
        (&falling[..], 0.1_f64.sqrt()),
        (&flying[..], 0.2),
        (&halved[..], 0.1),
    ] {
        for (share, small) in [(0.99, true), (1.01, false)] {
            let end = format!("time.end={}", share * longest);
            let bare = ["boundary=[]", "method.basis=\"cubic\"", &end];
            let changes = [scene, &bare[..]].concat();
            let found = of("small_motion", BLOCK, &changes);
            assert_eq!(found.is_some(), small, "{changes:?}: {found:?}");
        }
    }
}
