//! What goes wrong is told, by the point that shows it, and nothing panics.

mod common;

use common::{NEO_HOOKEAN, Scene, Variant, flying_box, list, texts, variants, variants_in};
use mpm::observe::Memory;
use mpm::run::{Computing, RunError, build, build_with, drive};
use mpm::scenario::{Scenario, parse};
use mpm::solver::Fault;

/// A flying box and, far behind it, a single point.
fn box_and_point(dimension: usize) -> Scene {
    let mut scene = flying_box(dimension);
    scene.rest += &format!(
        "[[body]]\nname = \"point\"\nmaterial = \"stuff\"\nparticles_per_cell = 1\nshape.box = {{ min = {}, max = {} }}\nvelocity = {}\n",
        list(dimension, [0.5; 3]),
        list(dimension, [1.0; 3]),
        texts(dimension, ["0", "0", "0"]),
    );
    scene
}

/// The fault that the next step shows after `steps` good ones and `spoil`.
fn fault<const D: usize>(
    scenario: &Scenario,
    parallel: bool,
    steps: u64,
    spoil: impl Fn(&mut mpm::state::State<D>),
) -> Option<Fault> {
    let mut scene = build_with::<D>(
        scenario,
        &Computing {
            parallel: Some(parallel),
            instructions: None,
        },
    );
    scene
        .solver
        .start(&mut scene.state)
        .unwrap_or_else(|fault| panic!("{fault}"));
    for _ in 0..steps {
        scene
            .solver
            .step(&mut scene.state, 0.004)
            .unwrap_or_else(|fault| panic!("{fault}"));
    }
    spoil(&mut scene.state);
    let first = scene.solver.step(&mut scene.state, 0.004).err()?;
    // asking again does not make it better
    assert!(scene.solver.step(&mut scene.state, 0.004).is_err());
    Some(first)
}

fn every_fault<const D: usize>(scenario: &Scenario, parallel: bool, steps: u64, name: &str) {
    let velocity = fault::<D>(scenario, parallel, steps, |state| {
        state.bodies[1].particles.velocity[0][D - 1] = f64::NAN
    });
    match velocity {
        Some(Fault::NotFinite(place)) => {
            assert_eq!(
                (&place.body[..], place.particle, place.step),
                ("point", 0, steps + 1),
                "{name}"
            );
        }
        other => panic!("{name}: {other:?}"),
    }
    let escaped = fault::<D>(scenario, parallel, steps, |state| {
        state.bodies[1].particles.velocity[0][0] = -1e3
    });
    match escaped {
        Some(Fault::Escaped(place)) => {
            assert_eq!((&place.body[..], place.particle), ("point", 0), "{name}");
            assert!(place.position[0] < 0.0, "{name}: {place:?}");
        }
        other => panic!("{name}: {other:?}"),
    }
    // a point that somebody else puts elsewhere between two steps is counted to the wrong nodes, but to nodes
    for wild in [f64::NAN, f64::INFINITY, -1e300, 1e300, -1.0] {
        let moved = fault::<D>(scenario, parallel, steps, |state| {
            state.bodies[0].particles.position[3][D - 1] = wild
        });
        assert!(moved.is_some(), "{name}: a point at {wild} goes unnoticed");
    }
}

#[test]
fn a_point_that_is_no_number_or_leaves_the_grid_is_named() {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(2)
        .build()
        .expect("threads can be started");
    for dimension in 1..=3 {
        for variant in variants_in("updated") {
            let scenario = box_and_point(dimension).scenario(&variant);
            // at the start, and just before and after stiffness is looked at and blocks are left
            for (parallel, steps) in [false, true]
                .into_iter()
                .flat_map(|parallel| [0, 1, 14, 15, 16, 23].map(|steps| (parallel, steps)))
            {
                let name = format!("{dimension}D {variant:?} parallel {parallel} after {steps}");
                pool.install(|| match dimension {
                    1 => every_fault::<1>(&scenario, parallel, steps, &name),
                    2 => every_fault::<2>(&scenario, parallel, steps, &name),
                    _ => every_fault::<3>(&scenario, parallel, steps, &name),
                });
            }
        }
    }
}

#[test]
#[should_panic(expected = "points are added and removed before a run only")]
fn a_point_that_is_taken_away_between_steps_is_refused() {
    let variant = &variants()[0];
    let mut scene = build::<2>(&flying_box(2).scenario(variant));
    scene
        .solver
        .start(&mut scene.state)
        .unwrap_or_else(|fault| panic!("{fault}"));
    scene.state.bodies[0].particles.position.pop();
    let _ = scene.solver.step(&mut scene.state, 0.004);
}

#[test]
fn a_run_with_far_too_long_steps_ends_in_a_fault_and_keeps_what_it_recorded() {
    for dimension in 1..=3 {
        let variant = Variant {
            basis: "linear",
            transfer: "\"flip\"".into(),
            update: "usl",
            frame: "updated",
        };
        let scene = Scene {
            steps: 4000,
            law: NEO_HOOKEAN.into(),
            ..flying_box(dimension)
        };
        let text = scene
            .text(&variant)
            .replace(&format!("step = {:e}", scene.step), "courant = 5");
        let scenario = parse("unstable", &text, &[])
            .unwrap_or_else(|error| panic!("{error}"))
            .scenario;
        let mut memory = Memory::default();
        let (summary, result) = match dimension {
            1 => drive(
                &scenario,
                &mut build::<1>(&scenario),
                &mut memory,
                &mut |_| true,
            ),
            2 => drive(
                &scenario,
                &mut build::<2>(&scenario),
                &mut memory,
                &mut |_| true,
            ),
            _ => drive(
                &scenario,
                &mut build::<3>(&scenario),
                &mut memory,
                &mut |_| true,
            ),
        };
        assert!(
            matches!(result, Err(RunError::Fault(_))),
            "{dimension}D: {result:?}"
        );
        assert_ne!(summary.status, "done");
        let times = memory.column("energy", "time");
        assert_eq!(times.len() as u64, summary.rows);
        assert!(times.iter().all(|time| time.is_finite()) && summary.time < scenario.end);
    }
}

#[test]
fn empty_cells_cost_nothing() {
    for dimension in 1..=3 {
        for variant in variants() {
            let small = flying_box(dimension);
            // 10,000 times as many cells
            let mut large = small.clone();
            let times = [10_000, 100, 22][dimension - 1];
            large.cells = large.cells.map(|n| n * times);
            let nodes = |scene: &Scene| {
                let scenario = scene.scenario(&variant);
                match dimension {
                    1 => stored::<1>(&scenario),
                    2 => stored::<2>(&scenario),
                    _ => stored::<3>(&scenario),
                }
            };
            assert_eq!(nodes(&small), nodes(&large), "{dimension}D {variant:?}");
        }
    }
}

fn stored<const D: usize>(scenario: &Scenario) -> (usize, usize) {
    let mut scene = build::<D>(scenario);
    scene
        .solver
        .start(&mut scene.state)
        .unwrap_or_else(|fault| panic!("{fault}"));
    for _ in 0..20 {
        scene
            .solver
            .step(&mut scene.state, 0.004)
            .unwrap_or_else(|fault| panic!("{fault}"));
    }
    (scene.solver.stored_nodes(), scene.solver.bytes_per_node())
}
