//! What limits a step follows the points: the fastest of them, the stiffest body, and those that have no stress.

mod common;

use common::{NEO_HOOKEAN, Scene, Variant, flying_box, list, texts, variants};
use mpm::run::{Computing, build_with};
use mpm::scenario::Scenario;
use mpm::solver::Fault;

fn fastest<const D: usize>(scenario: &Scenario, parallel: bool, name: &str) {
    let computing = Computing {
        parallel: Some(parallel),
        instructions: None,
    };
    let mut scene = build_with::<D>(scenario, &computing);
    let (state, solver) = (&mut scene.state, &mut scene.solver);
    solver
        .start(state)
        .unwrap_or_else(|fault| panic!("{fault}"));
    let mut speeds = Vec::new();
    for _ in 0..4 {
        let points = state.bodies.iter().flat_map(|b| &b.particles.velocity);
        let fastest = points.fold(0.0_f64, |most, v| most.max(v.norm()));
        let told = solver.limit(state).particle_speed;
        assert!((told / fastest - 1.0).abs() < 1e-14, "{name}: {told}");
        speeds.push(fastest);
        solver
            .step(state, 0.004)
            .unwrap_or_else(|fault| panic!("{fault}"));
    }
    let changed = (speeds[3] / speeds[0] - 1.0).abs();
    assert!(changed > 1e-3, "{name}: nothing to see");
}

/// The fastest point of a box that turns is at one of its corners, and under gravity it grows faster.
#[test]
fn the_fastest_point_is_known_after_every_step() {
    for dimension in 1..=3 {
        for variant in variants() {
            let scene = Scene {
                head: format!("gravity = {}", list(dimension, [90.0; 3])),
                ..flying_box(dimension)
            };
            let scenario = scene.scenario(&variant);
            for parallel in [false, true] {
                let name = format!("{dimension}D {variant:?} parallel {parallel}");
                match dimension {
                    1 => fastest::<1>(&scenario, parallel, &name),
                    2 => fastest::<2>(&scenario, parallel, &name),
                    _ => fastest::<3>(&scenario, parallel, &name),
                }
            }
        }
    }
}

/// Waves of bodies without stress run at √(E/ρ) if ν = 0.
#[test]
fn the_stiffest_body_limits_the_step_in_any_order() {
    let moduli = [60.0, 1500.0, 240.0];
    for turn in 0..3 {
        let body = |k: usize| {
            let modulus = moduli[(k + turn) % 3];
            let x = 2 * k + 1;
            format!(
                "[material.m{k}]\ndensity = 2\nlinear_elastic = {{ youngs_modulus = {modulus}, poissons_ratio = 0 }}\n\
                 [[body]]\nname = \"b{k}\"\nmaterial = \"m{k}\"\nshape.box = {{ min = [{x}, 1], max = [{}, 2] }}\n",
                x + 1
            )
        };
        let scene = Scene {
            dimension: 2,
            cells: [16, 8, 0],
            cell_size: 0.5,
            step: 0.001,
            steps: 1,
            law: NEO_HOOKEAN.into(),
            head: String::new(),
            rest: (0..3).map(body).collect(),
        };
        let scenario = scene.scenario(&variants()[0]);
        let mut scene = build_with::<2>(&scenario, &Computing::default());
        scene
            .solver
            .start(&mut scene.state)
            .unwrap_or_else(|fault| panic!("{fault}"));
        let found = scene.solver.limit(&scene.state).wave_speed;
        assert!((found / 750.0_f64.sqrt() - 1.0).abs() < 1e-12, "{found}");
    }
}

/// A thick layer turned inside out in one step has finite places and velocities and no stress: the look at its stiffness tells.
#[test]
fn a_body_turned_inside_out_is_a_fault_of_the_step_that_did_it() {
    let laws = [
        "linear_elastic",
        "neo_hookean",
        "st_venant_kirchhoff",
        "hencky",
    ];
    let frames = ["updated", "total"];
    for (law, frame) in laws.iter().flat_map(|law| frames.map(|frame| (law, frame))) {
        let variant = Variant {
            basis: "quadratic",
            transfer: "\"flip\"".into(),
            update: "usl",
            frame,
        };
        let scene = Scene {
            dimension: 2,
            cells: [16; 3],
            cell_size: 0.5,
            step: 0.001,
            steps: 20,
            law: format!("{law} = {{ youngs_modulus = 20, poissons_ratio = 0.3 }}"),
            head: String::new(),
            rest: format!(
                "[[body]]\nname = \"box\"\nmaterial = \"stuff\"\nshape.box = {{ min = [3, 3], max = [5, 5] }}\nvelocity = {}\n",
                texts(2, ["0", "0", "0"])
            ),
        };
        let scenario = scene.scenario(&variant);
        let mut scene = build_with::<2>(&scenario, &Computing::default());
        let (state, solver) = (&mut scene.state, &mut scene.solver);
        solver
            .start(state)
            .unwrap_or_else(|fault| panic!("{fault}"));
        for _ in 0..15 {
            solver
                .step(state, 0.001)
                .unwrap_or_else(|fault| panic!("{fault}"));
        }
        let p = &mut state.bodies[0].particles;
        for (v, x) in p.velocity.iter_mut().zip(&p.position) {
            v[0] = -1500.0 * (x[0] - 4.0);
        }
        // stiffness is looked at every sixteen steps
        match solver.step(state, 0.001) {
            Err(Fault::NotFinite(place)) => {
                assert_eq!(place.step, 16, "{law} {frame}");
                assert!(
                    place.position.iter().all(|x| x.is_finite()),
                    "{law} {frame}"
                );
            }
            other => panic!("{law} {frame}: {other:?}"),
        }
    }
}
