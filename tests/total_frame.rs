//! The total Lagrangian frame: points stay where they are in the grid, however far the body goes and stretches.

mod common;

use common::{Scene, Variant, flying_box, list, texts, variants_in};
use mpm::observe::Point;
use mpm::run::{Computing, build_with};
use mpm::scenario::parse;
use mpm::solver::Fault;
use mpm::study::validate::{CaseError, Recorded, simulate};

type Matrix3 = [[f64; 3]; 3];

const IDENTITY: Matrix3 = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

fn run(scene: &Scene, variant: &Variant) -> Recorded {
    simulate(&scene.text(variant), &[], true).unwrap_or_else(|error| panic!("{variant:?}: {error}"))
}

/// A cube of `edge` cells whose points move with v = G x for one step or several, so softly bound that it follows.
fn moving_cube(dimension: usize, edge: u32, gradient: &Matrix3, steps: u32, modulus: f64) -> Scene {
    let names = ["x", "y", "z"];
    let velocity = [0, 1, 2].map(|i| {
        let term = |j: usize| format!("({:e}) * {}", gradient[i][j], names[j]);
        (0..dimension).map(term).collect::<Vec<_>>().join(" + ")
    });
    let [u, v, w] = &velocity;
    let rest = format!(
        "[[body]]\nname = \"cube\"\nmaterial = \"stuff\"\nparticles_per_cell = 1\n\
         shape.box = {{ min = {}, max = {} }}\nvelocity = {}\n",
        list(dimension, [1.0; 3]),
        list(dimension, [1.0 + 0.5 * f64::from(edge); 3]),
        texts(dimension, [u, v, w]),
    );
    Scene {
        dimension,
        cells: [edge + 4; 3],
        cell_size: 0.5,
        step: 0.1,
        steps,
        law: format!("neo_hookean = {{ youngs_modulus = {modulus:e}, poissons_ratio = 0.3 }}"),
        head: String::new(),
        rest,
    }
}

fn determinant(f: &Matrix3) -> f64 {
    let minor = |i: usize, j: usize| f[1][i] * f[2][j] - f[1][j] * f[2][i];
    f[0][0] * minor(1, 2) - f[0][1] * minor(0, 2) + f[0][2] * minor(0, 1)
}

/// σ = [μ(F Fᵀ − I) + λ ln J I] / J.
fn neo_hookean(f: &Matrix3, modulus: f64) -> Matrix3 {
    let (lambda, mu) = (modulus * 0.3 / (1.3 * 0.4), modulus / 2.6);
    let j = determinant(f);
    [0, 1, 2].map(|a| {
        [0, 1, 2].map(|b| {
            let finger: f64 = (0..3).map(|k| f[a][k] * f[b][k]).sum();
            (mu * (finger - IDENTITY[a][b]) + lambda * j.ln() * IDENTITY[a][b]) / j
        })
    })
}

fn differ(point: &Point, expected: &Matrix3, dimension: usize) -> f64 {
    let mut most = 0.0_f64;
    for a in 0..dimension {
        for b in 0..dimension {
            let difference = (point.stress[a][b] - expected[a][b]).abs();
            if most.is_nan() || difference <= most {
                continue;
            }
            most = difference;
        }
    }
    most
}

/// Far enough from the faces nothing but the uniform motion is felt: the points between must have the stress that the law gives
/// for F, though their neighbours are by then three cells away, and be where F takes them.
#[test]
fn a_stretch_to_three_times_the_length_gives_the_stress_of_the_law() {
    let rate = [[10.0, 1.0, 0.5], [0.5, -2.5, 0.0], [-0.5, 1.0, -1.0]];
    for dimension in 1..=3 {
        for variant in variants_in("total") {
            let far = variant.transfer.contains("fmpm") && variant.basis == "quadratic";
            if dimension == 3 && (variant.basis == "cubic" || far) {
                continue; // what the faces do has reached every point that a small cube has
            }
            let mut gradient = rate;
            let mut f = IDENTITY;
            for a in 0..3 {
                for b in 0..3 {
                    if a >= dimension || b >= dimension {
                        gradient[a][b] = 0.0;
                    }
                    f[a][b] += 0.2 * gradient[a][b];
                }
            }
            let edge = [72, 48, 28][dimension - 1];
            let scene = moving_cube(dimension, edge, &gradient, 2, 1.0);
            let run = run(&scene, &variant);
            let (start, end) = (&run.memory.frames[0], &run.memory.frames[2]);
            let expected = neo_hookean(&f, 1.0);
            let middle = 1.0 + 0.25 * f64::from(edge);
            let inner = |point: &Point| {
                let from_middle = |a: usize| (point.position[a] - middle).abs();
                (0..dimension).all(|a| from_middle(a) < 0.6)
            };
            let mut seen = 0;
            for (from, to) in start.points.iter().zip(&end.points) {
                if !inner(from) {
                    continue;
                }
                seen += 1;
                let name = format!("{dimension}D {variant:?}");
                let wrong = differ(to, &expected, dimension);
                assert!(wrong <= 1e-11, "{name}: stress is off by {wrong:e}");
                for a in 0..dimension {
                    let x: f64 = (0..dimension).map(|b| f[a][b] * from.position[b]).sum();
                    let wrong = (to.position[a] - x).abs();
                    assert!(wrong <= 1e-11, "{name}: position is off by {wrong:e}");
                }
            }
            assert!(seen >= 2, "{dimension}D: {seen} points");
        }
    }
}

/// One step with v = (R − I) X / Δt turns the body by R, and nothing else.
#[test]
fn a_finite_rotation_leaves_no_stress() {
    let (c, s) = (0.8, 0.6);
    let plane = [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]];
    // about (1, 1, 1) by a third of a turn
    let space = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    for (dimension, turn) in [(2, plane), (3, space)] {
        let gradient = [0, 1, 2].map(|a| [0, 1, 2].map(|b| (turn[a][b] - IDENTITY[a][b]) / 0.1));
        // transfers that keep a linear field at the faces as well
        let affine = |variant: &Variant| variant.is_apic() || variant.transfer.contains("tpic");
        for variant in variants_in("total").into_iter().filter(affine) {
            let run = run(&moving_cube(dimension, 5, &gradient, 1, 1.0), &variant);
            for point in &run.memory.frames[1].points {
                let wrong = differ(point, &[[0.0; 3]; 3], dimension);
                assert!(wrong <= 1e-13, "{dimension}D {variant:?}: stress {wrong:e}");
            }
        }
    }
}

/// Where the grid ends says nothing about where a body may go.
#[test]
fn a_body_may_leave_the_grid() {
    for dimension in 1..=3 {
        let mut scene = flying_box(dimension);
        scene.rest = scene.rest.replace("\"12 + 1", "\"400 + 1");
        let variant = |frame| Variant {
            basis: "quadratic",
            transfer: "\"apic\"".into(),
            update: "usl",
            frame,
        };
        let run = run(&scene, &variant("total"));
        let x = run.column("body_box", "position_x");
        let (first, last) = (x[0], x[x.len() - 1]);
        let exact = first + 400.0 * scene.step * f64::from(scene.steps);
        assert!(
            (last - exact).abs() < 1e-9,
            "{dimension}D: {last}, not {exact}"
        );
        match simulate(&scene.text(&variant("updated")), &[], false) {
            Err(CaseError::Run(mpm::run::RunError::Fault(Fault::Escaped(_)))) => {}
            other => panic!("{dimension}D: {:?}", other.err()),
        }
    }
}

/// The motion does not depend on how fast the observer flies along.
#[test]
fn points_move_alike_for_a_flying_observer() {
    for variant in variants_in("total") {
        let scene = flying_box(2);
        let mut slow = scene.clone();
        slow.rest = slow.rest.replace("\"12 + 1", "\"2 + 1");
        let (fast, slow) = (run(&scene, &variant), run(&slow, &variant));
        let ends = |run: &Recorded| run.memory.frames[run.memory.frames.len() - 1].clone();
        let (fast, slow) = (ends(&fast), ends(&slow));
        let drift = 10.0 * fast.time;
        for (a, b) in fast.points.iter().zip(&slow.points) {
            let wrong = (a.position[0] - b.position[0] - drift).abs();
            assert!(wrong < 1e-11, "{variant:?}: {wrong:e}");
            let wrong = differ(a, &b.stress, 2);
            assert!(wrong < 1e-10, "{variant:?}: stress differs by {wrong:e}");
        }
    }
}

/// In one dimension P(F) = [μ (F² − 1) + λ ln F] / F, and waves cross the reference configuration at √(dP/dF / ρ₀).
#[test]
fn the_step_is_limited_by_waves_in_the_reference_configuration() {
    let modulus = 1e-6;
    let variant = Variant {
        basis: "linear",
        transfer: "\"apic\"".into(),
        update: "usl",
        frame: "total",
    };
    for f in [0.4, 0.7, 2.0] {
        let steps = 16;
        let rate = (f - 1.0) / (0.1 * f64::from(steps));
        let mut gradient = [[0.0; 3]; 3];
        gradient[0][0] = rate;
        let scenario = moving_cube(1, 40, &gradient, steps, modulus).scenario(&variant);
        let mut scene = build_with::<1>(&scenario, &Computing::default());
        let (state, solver) = (&mut scene.state, &mut scene.solver);
        solver
            .start(state)
            .unwrap_or_else(|fault| panic!("{fault}"));
        for _ in 0..steps {
            solver
                .step(state, 0.1)
                .unwrap_or_else(|fault| panic!("{fault}"));
        }
        let (lambda, mu) = (modulus * 0.3 / (1.3 * 0.4), modulus / 2.6);
        let slope = |f: f64| mu * (1.0 + 1.0 / (f * f)) + lambda * (1.0 - f.ln()) / (f * f);
        // where the body is stretched, its undeformed stiffness is kept
        let exact = (slope(f).max(slope(1.0)) / 1.5_f64).sqrt();
        let found = solver.limit(state).wave_speed;
        // laws give an upper estimate
        let ratio = found / exact;
        assert!(
            ratio > 0.9999 && ratio < 1.15,
            "{f}: {found:e}, not {exact:e}"
        );
    }
}

#[test]
fn a_motion_that_is_no_number_is_a_fault() {
    for variant in variants_in("total") {
        let scenario = flying_box(2).scenario(&variant);
        for spoil in [0, 1] {
            let mut scene = build_with::<2>(&scenario, &Computing::default());
            let (state, solver) = (&mut scene.state, &mut scene.solver);
            solver
                .start(state)
                .unwrap_or_else(|fault| panic!("{fault}"));
            let p = &mut state.bodies[0].particles;
            let id = p.id[3];
            match spoil {
                0 => p.velocity[3][1] = f64::NAN,
                _ => p.position[3][1] = f64::INFINITY,
            }
            match solver.step(state, 0.004) {
                Err(Fault::NotFinite(place)) => {
                    // a velocity spoils its neighbours as well
                    assert!(spoil == 0 || place.particle == id, "{variant:?}: {place:?}");
                }
                other => panic!("{variant:?}: {other:?}"),
            }
        }
    }
}

#[test]
fn what_the_frame_does_not_do_is_told() {
    let variant = |frame| Variant {
        basis: "linear",
        transfer: "\"apic\"".into(),
        update: "usl",
        frame,
    };
    let warnings = |scene: &Scene, frame| {
        let text = scene.text(&variant(frame));
        let loaded = parse("scene", &text, &[]).unwrap_or_else(|error| panic!("{error}"));
        loaded.warnings.join("\n")
    };
    let mut scene = flying_box(2);
    // no point crosses a cell
    assert_eq!(warnings(&scene, "total"), "");
    assert!(warnings(&scene, "updated").contains("linear basis"));
    scene.rest += "[[body]]\nname = \"other\"\nmaterial = \"stuff\"\nshape.box = { min = [1, 1], max = [2, 2] }\n\
                   [[boundary]]\nname = \"floor\"\non.side = \"y_min\"\ncondition = \"wall\"\n";
    let told = warnings(&scene, "total");
    assert!(
        told.contains("never meet") && told.contains("\"floor\""),
        "{told}"
    );
    assert!(!warnings(&scene, "updated").contains("frame"));
}

/// Over a cell a hat is a straight line: its mean over a point that reaches no farther is its value in the middle.
#[test]
fn gimp_is_the_linear_basis_where_no_point_reaches_beyond_its_cell() {
    let largest = |one: &Recorded, other: &Recorded| {
        let pairs = one.memory.frames.iter().zip(&other.memory.frames);
        let pairs = pairs.flat_map(|(a, b)| a.points.iter().zip(&b.points));
        pairs.fold(0.0_f64, |most, (a, b)| {
            let way = |k: usize| (a.position[k] - b.position[k]).abs();
            most.max(way(0)).max(way(1)).max(way(2))
        })
    };
    for dimension in 1..=3 {
        let inside = flying_box(dimension);
        let mut across = inside.clone();
        across.cell_size = 0.4;
        for gimp in variants_in("total").iter().filter(|v| v.basis == "gimp") {
            let linear = Variant {
                basis: "linear",
                ..gimp.clone()
            };
            let apart = |scene: &Scene| largest(&run(scene, gimp), &run(scene, &linear));
            let name = format!("{dimension}D {gimp:?}");
            let same = apart(&inside);
            assert!(same < 1e-11, "{name}: {same:e}");
            let differs = apart(&across);
            assert!(differs > 1e-6, "{name}: {differs:e}");
        }
    }
}

/// Root mean square of the stress across a bending beam over that along it, in its outermost points at mid-span.
fn across_over_along(half: &str, update: &str) -> f64 {
    let overrides = [
        "time.end=\"4 ms\"".to_string(),
        "method={ frame = \"total\", basis = \"gimp\", transfer = \"apic\", placement = \"even\" }"
            .into(),
        format!("method.update=\"{update}\""),
        format!("body[0].shape.box.min=[0, \"-{half}\"]"),
        format!("body[0].shape.box.max=[\"L\", \"{half}\"]"),
    ];
    let text = include_str!("../scenarios/beam.toml");
    let run = simulate(text, &overrides, true).unwrap_or_else(|error| panic!("{error}"));
    let points = run.memory.frames.iter().flat_map(|frame| &frame.points);
    let outermost =
        points.filter(|p| (p.position[0] - 0.5).abs() < 0.02 && p.position[1].abs() > 0.04);
    let (across, along) = outermost.fold((0.0, 0.0), |(across, along), p| {
        (
            across + p.stress[1][1].powi(2),
            along + p.stress[0][0].powi(2),
        )
    });
    (across / along).sqrt()
}

/// Hat functions that end on a free surface leave stress across it. A GIMP domain that sticks out by 0.1 µm frees the surface, because
/// the node outside strains the points: with `usl` alone, for `musl` maps the points' velocities back first.
#[test]
fn a_domain_that_sticks_out_of_a_surface_makes_it_free() {
    let on_the_line = across_over_along("50 mm", "usl");
    assert!((0.06..0.09).contains(&on_the_line), "{on_the_line}");
    let beyond = across_over_along("50.0001 mm", "usl");
    assert!(beyond < 0.002, "{beyond}");
    let mapped_back = across_over_along("50.0001 mm", "musl");
    assert!(
        (mapped_back / on_the_line - 1.0).abs() < 0.02,
        "{mapped_back}"
    );
}
