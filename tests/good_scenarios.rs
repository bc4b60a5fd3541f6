//! What good scenarios mean, field by field.

use mpm::boundary::ConditionChoice;
use mpm::input::{Expression, Variables};
use mpm::material::{LawChoice, Plane};
use mpm::scenario::{
    LoadKind, Loaded, ProbeTarget, Region, Scheme, Side, StepRule, body_points, load, parse,
};
use std::path::Path;

fn good(name: &str) -> Loaded {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/good_scenarios");
    load(&folder.join(name), &[]).unwrap_or_else(|error| panic!("{error}"))
}

fn at(x: f64, y: f64, t: f64) -> Variables {
    Variables {
        position: [x, y, 0.0],
        time: t,
    }
}

#[test]
fn the_bar_is_read_field_by_field() {
    let Loaded {
        scenario,
        resolved_toml,
        warnings,
    } = good("bar.toml");
    assert!(warnings.is_empty(), "{warnings:?}");
    assert!(resolved_toml.contains("# exactly one law, by its name"));
    assert_eq!(scenario.title, "Axial vibration of an elastic bar");
    assert_eq!((scenario.dimension, scenario.plane), (1, Plane::Strain));
    assert_eq!(
        (scenario.end, scenario.step),
        (100.0, StepRule::Courant(0.1))
    );
    assert_eq!(
        (&scenario.grid.min[..], &scenario.grid.max[..]),
        (&[0.0][..], &[25.0][..])
    );
    assert_eq!(
        (scenario.grid.cell_size, &scenario.grid.cells[..]),
        (1.0, &[25][..])
    );
    assert_eq!(scenario.method.basis.name(), "linear");
    assert_eq!(scenario.method.transfer.name(), "flip");
    assert_eq!(scenario.method.update, Scheme::ModifiedUpdateStressLast);
    let [material] = &scenario.materials[..] else {
        panic!("one material")
    };
    assert_eq!((&material.name[..], material.density), ("bar", 1.0));
    let LawChoice::LinearElastic(law) = material.law else {
        panic!("{:?}", material.law)
    };
    assert_eq!(
        (
            law.elasticity.youngs_modulus(),
            law.elasticity.poissons_ratio(),
        ),
        (100.0, 0.0)
    );
    let [body] = &scenario.bodies[..] else {
        panic!("one body")
    };
    assert_eq!(
        (&body.name[..], body.material, &body.particles_per_cell[..]),
        ("bar", 0, &[1][..])
    );
    let speed = 0.1 * (std::f64::consts::PI * 12.5 / 50.0).sin();
    approx::assert_relative_eq!(
        body.velocity[0].value(&at(12.5, 0.0, 0.0)),
        speed,
        max_relative = 1e-15
    );
    let points = body_points(&scenario, 0);
    let expected: Vec<_> = (0..25).map(|k| [f64::from(k) + 0.5, 0.0, 0.0]).collect();
    assert_eq!(
        (points.positions.clone(), points.volume(7)),
        (expected, 1.0)
    );
    let [boundary] = &scenario.boundaries[..] else {
        panic!("one boundary")
    };
    assert_eq!(
        (&boundary.name[..], boundary.condition.name()),
        ("wall", "fixed")
    );
    assert_eq!(
        boundary.on,
        Region::Side(Side {
            axis: 0,
            upper: false
        })
    );
    assert!(scenario.loads.is_empty());
    assert_eq!((&scenario.gravity[..], scenario.damping), (&[0.0][..], 0.0));
    assert_eq!(scenario.output.every, 0.1);
    let [probe] = &scenario.probes[..] else {
        panic!("one probe")
    };
    assert_eq!((&probe.name[..], probe.body), ("second", 0));
    assert_eq!(probe.target, ProbeTarget::Particle(1));
}

#[test]
fn the_plate_is_read_with_its_boundaries_and_loads() {
    let Loaded {
        scenario, warnings, ..
    } = good("plate.toml");
    assert!(warnings.is_empty(), "{warnings:?}");
    assert_eq!(
        (scenario.plane, scenario.step),
        (Plane::Stress, StepRule::Fixed(1e-6))
    );
    assert_eq!(
        (&scenario.gravity[..], scenario.damping),
        (&[0.0, -9.81][..], 100.0)
    );
    assert_eq!(scenario.grid.cells, [20, 20]);
    assert_eq!(scenario.materials[1].name, "foam");
    assert_eq!(scenario.bodies[1].material, 1);
    assert_eq!(scenario.bodies[0].particles_per_cell, [2, 3]);
    approx::assert_relative_eq!(
        scenario.bodies[0].velocity[1].value(&at(0.2, 0.0, 0.0)),
        1e-3,
        max_relative = 1e-14
    );
    let [floor, grip, rail, stop] = &scenario.boundaries[..] else {
        panic!("four boundaries")
    };
    let ConditionChoice::Roller(roller) = &floor.condition else {
        panic!("{floor:?}")
    };
    assert_eq!(roller.normal, 1);
    let ConditionChoice::Driven(driven) = &grip.condition else {
        panic!("{grip:?}")
    };
    assert_eq!(driven.velocity[0], None);
    let half = driven.velocity[1]
        .as_ref()
        .map(|speed: &Expression| speed.value(&at(0.0, 0.0, 0.05)));
    approx::assert_relative_eq!(half.unwrap_or(0.0), 1e-3, max_relative = 1e-14);
    let Region::Box { min, max } = &rail.on else {
        panic!("{rail:?}")
    };
    assert_eq!(min[0], f64::NEG_INFINITY);
    assert!(
        max[0] > 0.0 && max[0] < 1e-9,
        "the box holds its surface: {max:?}"
    );
    let ConditionChoice::Wall(wall) = &stop.condition else {
        panic!("{stop:?}")
    };
    assert_eq!(
        wall.side,
        Side {
            axis: 0,
            upper: true
        }
    );
    let [pull, force, pressure] = &scenario.loads[..] else {
        panic!("three loads")
    };
    assert_eq!(
        (&pull.name[..], &force.name[..], &pressure.name[..]),
        ("pull", "load2", "load3")
    );
    let side = Side {
        axis: 0,
        upper: true,
    };
    assert_eq!(
        pull.kind,
        LoadKind::Traction {
            traction: vec![1e6, 0.0],
            side
        }
    );
    assert_eq!(
        pull.factor
            .as_ref()
            .map(|factor| factor.value(&at(0.0, 0.0, 0.05))),
        Some(0.5)
    );
    assert_eq!(
        (force.body, &force.kind),
        (1, &LoadKind::Force(vec![14.43, 0.0]))
    );
    let side = Side {
        axis: 0,
        upper: false,
    };
    assert_eq!(
        pressure.kind,
        LoadKind::Pressure {
            pressure: 2000.0,
            side: Some(side)
        }
    );
    assert_eq!(scenario.output.every, 0.01);
    assert_eq!(scenario.probes[0].target, ProbeTarget::Near(vec![0.5, 0.5]));
}

#[test]
fn what_is_left_out_has_its_default() {
    let scenario = good("column.toml").scenario;
    assert_eq!(scenario.title, "column");
    assert_eq!(scenario.method.basis.name(), "quadratic");
    assert_eq!(scenario.method.transfer.name(), "apic");
    assert_eq!(scenario.method.update, Scheme::UpdateStressLast);
    assert_eq!(scenario.bodies[0].particles_per_cell, [2, 2, 2]);
    assert_eq!(
        scenario.bodies[0].velocity[2].value(&at(1.0, 1.0, 0.0)),
        0.0
    );
    assert_eq!(scenario.output.every, 1.0 / 200.0);
}

#[test]
fn a_disk_on_the_axis_is_a_sphere() {
    let scenario = good("sphere.toml").scenario;
    let points = body_points(&scenario, 0);
    let volume: f64 = (0..points.positions.len())
        .map(|index| points.volume(index))
        .sum();
    let exact = 4.0 / 3.0 * std::f64::consts::PI * 0.125;
    approx::assert_relative_eq!(volume, exact, max_relative = 1e-12);
    assert!(points.positions.iter().all(|at| at[0] > 0.0));
}

#[test]
fn an_override_replaces_a_value() {
    let text = std::fs::read_to_string(
        Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/good_scenarios/bar.toml"),
    )
    .expect("readable");
    let settings = [
        "time.courant=0.3".to_string(),
        "method.transfer=\"pic\"".to_string(),
    ];
    let loaded = parse("bar", &text, &settings).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(loaded.scenario.step, StepRule::Courant(0.3));
    assert_eq!(loaded.scenario.method.transfer.name(), "pic");
    assert!(loaded.resolved_toml.contains("0.3") && loaded.resolved_toml.contains("# or step"));
    let wrong = parse("bar", &text, &["time.curant=0.3".to_string()]).expect_err("misspelt");
    assert!(wrong.to_string().contains("courant"), "{wrong}");
}

#[test]
fn an_unused_material_and_a_far_probe_are_warned_about() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/good_scenarios");
    let text = std::fs::read_to_string(folder.join("column.toml")).expect("readable")
        + "\n[material.spare]\ndensity = 1\nhencky = { youngs_modulus = 1, poissons_ratio = 0 }\n"
        + "\n[[probe]]\nname = \"far\"\nbody = \"column\"\nnear = [9, 9, 9]\n";
    let warnings = parse("column", &text, &[])
        .unwrap_or_else(|error| panic!("{error}"))
        .warnings;
    assert!(
        warnings
            .iter()
            .any(|warning| warning.contains("material.spare")),
        "{warnings:?}"
    );
    assert!(
        warnings
            .iter()
            .any(|warning| warning.contains("probe[0].near")),
        "{warnings:?}"
    );
}

#[test]
fn a_1d_material_that_would_contract_is_warned_about_unless_the_plane_is_given() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/good_scenarios");
    let text = std::fs::read_to_string(folder.join("bar.toml")).expect("readable");
    let warnings = |settings: &[&str]| {
        let settings: Vec<String> = settings.iter().map(ToString::to_string).collect();
        parse("bar", &text, &settings)
            .unwrap_or_else(|error| panic!("{error}"))
            .warnings
    };
    let ratio = "material.bar.linear_elastic.poissons_ratio=0.3";
    let [warning] = &warnings(&[ratio])[..] else {
        panic!("one warning")
    };
    assert!(warning.contains("plane = \"stress\""), "{warning}");
    assert!(warnings(&[ratio, "plane=\"stress\""]).is_empty());
    assert!(warnings(&[ratio, "plane=\"strain\""]).is_empty());
}

/// What a scenario that names neither a basis nor a frame gets, with these lines added and this Poisson's ratio.
fn left_to_the_scene(lines: &str, ratio: f64) -> (String, String) {
    left_to_a_box(0.4, lines, ratio)
}

/// The same for a body that begins at this x.
fn left_to_a_box(left: f64, lines: &str, ratio: f64) -> (String, String) {
    let text = format!(
        "dimension = 2\ntime = {{ end = 1, courant = 0.3 }}\n\
         grid = {{ min = [0, 0], max = [1, 1], cell_size = 0.1 }}\n\
         material.soft = {{ density = 1, neo_hookean = {{ youngs_modulus = 1, poissons_ratio = {ratio} }} }}\n\
         [[body]]\nname = \"a\"\nmaterial = \"soft\"\nshape.box = {{ min = [{left}, 0.0], max = [0.6, 0.5] }}\n{lines}"
    );
    let loaded = parse("scene", &text, &[]).unwrap_or_else(|error| panic!("{error}"));
    let method = &loaded.scenario.method;
    let (frame, basis) = (method.frame.name(), method.basis.name());
    // the folder of a run says what was chosen, and says it again when it is read
    for line in [
        format!("frame = \"{frame}\""),
        format!("basis = \"{basis}\""),
    ] {
        let said = loaded.resolved_toml.contains(&line) || lines.contains("[method]");
        assert!(said, "{}", loaded.resolved_toml);
    }
    let again = parse("again", &loaded.resolved_toml, &[]).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(again.scenario.method.frame, method.frame);
    assert_eq!(again.scenario.method.basis, method.basis);
    assert_eq!(again.scenario.method.placement, method.placement);
    let moments = [&loaded, &again].map(|of| of.scenario.bodies[0].moment);
    assert_eq!(moments[0], moments[1]);
    (frame.into(), basis.into())
}

#[test]
fn the_scene_decides_on_frame_and_basis_that_nobody_names() {
    let boundary = |on: &str, condition: &str| {
        format!("[[boundary]]\nname = \"b\"\non.{on}\ncondition = \"{condition}\"\n")
    };
    let other = "[[body]]\nname = \"b\"\nmaterial = \"soft\"\nshape.box = { min = [0, 0.8], max = [0.2, 1] }\n";
    let total = |basis: &str| ("total".to_string(), basis.to_string());
    let updated = |basis: &str| ("updated".to_string(), basis.to_string());
    let base = boundary("side = \"y_min\"", "fixed");
    assert_eq!(left_to_the_scene("", 0.3), total("linear"));
    assert_eq!(left_to_the_scene(&base, 0.3), total("linear"));
    assert_eq!(left_to_the_scene(&base, 0.4), total("quadratic"));
    // on its way to rest, or not
    let damped = |rate: f64| format!("{base}[damping]\nrate = {rate}\n");
    assert_eq!(left_to_the_scene(&damped(2.0), 0.3), total("quadratic"));
    assert_eq!(left_to_the_scene(&damped(0.0), 0.3), total("linear"));
    // a ceiling that it may hit, a floor that it may leave, another body, a support that it does not reach
    let ceiling = boundary("side = \"y_max\"", "fixed");
    let floor = boundary("side = \"y_min\"", "wall");
    let far = boundary("box = { min = [0.0, 0.7], max = [1.0, 0.8] }", "fixed");
    let near = boundary("box = { min = [0.0, 0.5], max = [1.0, 0.6] }", "fixed");
    let sides = ["x_min", "x_max"].map(|side| boundary(&format!("side = \"{side}\""), "fixed"));
    // beside it, to the left and to the right
    let beside = [("0.0", "0.2"), ("0.8", "1.0")].map(|(min, max)| {
        let on = format!("box = {{ min = [{min}, 0.0], max = [{max}, 0.5] }}");
        boundary(&on, "fixed")
    });
    let [left, right] = &sides;
    let [before, behind] = &beside;
    for lines in [&ceiling, &floor, &far, other, left, right, before, behind] {
        assert_eq!(
            left_to_the_scene(lines, 0.3),
            updated("quadratic"),
            "{lines}"
        );
    }
    assert_eq!(left_to_the_scene(&near, 0.3), total("linear"));
    // points that would reach across a face of a cell
    assert_eq!(left_to_a_box(0.42, "", 0.3), total("gimp"));
    // who names one of the two is not surprised by the other
    let named = |key: &str| format!("[method]\n{key}\n");
    assert_eq!(
        left_to_the_scene(&named("basis = \"gimp\""), 0.3),
        updated("gimp")
    );
    assert_eq!(
        left_to_the_scene(&named("frame = \"total\""), 0.3),
        total("linear")
    );
    assert_eq!(
        left_to_the_scene(&named("frame = \"updated\""), 0.3),
        updated("quadratic")
    );
}

#[test]
fn points_of_the_total_frame_are_placed_for_bending_where_they_fill_cells() {
    let placed_with = |method: &str, left: f64, ratio: f64| {
        let text = format!(
            "dimension = 2\ntime = {{ end = 1, courant = 0.3 }}\n\
             grid = {{ min = [0, 0], max = [1, 1], cell_size = 0.1 }}\n[method]\n{method}\n\
             [material.soft]\ndensity = 1\nneo_hookean = {{ youngs_modulus = 1, poissons_ratio = {ratio} }}\n\
             [[body]]\nname = \"a\"\nmaterial = \"soft\"\nshape.box = {{ min = [{left}, 0.0], max = [0.6, 0.5] }}\n"
        );
        let loaded = parse("scene", &text, &[]).unwrap_or_else(|error| panic!("{error}"));
        let scenario = &loaded.scenario;
        (
            scenario.method.placement.name(),
            scenario.bodies[0].moment,
            loaded.warnings.len(),
        )
    };
    let placed = |method: &str, left: f64| placed_with(method, left, 0.25);
    let (bending, even) = ("bending", "even");
    // 1/(1 + 3/8 + 1/8) for hat functions, all of the cell's for splines
    assert_eq!(placed("", 0.4), (bending, Some(1.0 / 1.5), 0));
    let total = "frame = \"total\"\n";
    for (basis, moment) in [
        ("\"gimp\"", 1.0 / 1.5),
        ("\"quadratic\"", 1.0),
        ("\"cubic\"", 1.0),
    ] {
        let method = format!("{total}basis = {basis}");
        assert_eq!(placed(&method, 0.4), (bending, Some(moment), 0));
    }
    let b_bar = format!("{total}basis.linear = {{ b_bar = true }}");
    assert_eq!(placed(&b_bar, 0.4), (even, None, 0));
    assert_eq!(placed("frame = \"updated\"", 0.4), (even, None, 0));
    assert_eq!(placed("placement = \"even\"", 0.4), (even, None, 0));
    // splines that would lock
    let spline = |ratio: f64| {
        let text = format!("{total}basis = \"quadratic\"");
        placed_with(&text, 0.4, ratio)
    };
    assert_eq!(spline(0.45), (bending, Some(1.0), 0));
    assert_eq!(spline(0.49), (even, None, 0));
    // half a cell at one end; who asks for it all the same is told
    assert_eq!(placed("", 0.45), (even, None, 0));
    let asked = format!("{total}placement = \"bending\"");
    assert_eq!(placed(&asked, 0.45), (bending, None, 1));
    assert_eq!(placed(&asked, 0.4), (bending, Some(1.0 / 1.5), 0));
    // nobody asked for it here
    let ball = "[[body]]\nname = \"b\"\nmaterial = \"soft\"\nshape.ball = { center = [0.8, 0.8], radius = 0.1 }\n";
    let text = format!(
        "dimension = 2\ntime = {{ end = 1, courant = 0.3 }}\n\
         grid = {{ min = [0, 0], max = [1, 1], cell_size = 0.1 }}\n[method]\n{total}\
         [material.soft]\ndensity = 1\nneo_hookean = {{ youngs_modulus = 1, poissons_ratio = 0.25 }}\n\
         [[body]]\nname = \"a\"\nmaterial = \"soft\"\nshape.box = {{ min = [0.4, 0.0], max = [0.6, 0.5] }}\n{ball}"
    );
    let loaded = parse("scene", &text, &[]).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(loaded.scenario.method.placement.name(), bending);
    let moments: Vec<_> = loaded
        .scenario
        .bodies
        .iter()
        .map(|body| body.moment)
        .collect();
    assert_eq!(moments, [Some(1.0 / 1.5), None]);
    let told = loaded.warnings.join("\n");
    assert!(!told.contains("placement"), "{told}");
}
