//! Points are stored in the order of their blocks, whatever order they come in and however many threads put them there.

mod common;

use common::{NEO_HOOKEAN, Scene, Variant, list, texts};
use mpm::reorder;
use mpm::run::{Computing, build_with};
use mpm::scenario::Scenario;
use mpm::state::State;

/// A block of so many points that several threads share its sort; it moves two cells, so that it is sorted again.
fn block(dimension: usize) -> Scenario {
    let edge = [10_000, 72, 17][dimension - 1];
    let variant = Variant {
        basis: "quadratic",
        transfer: "\"apic\"".into(),
        update: "usl",
        frame: "updated",
    };
    let scene = Scene {
        dimension,
        cells: [edge + 8; 3],
        cell_size: 1.0,
        step: 0.05,
        steps: 10,
        law: NEO_HOOKEAN.into(),
        head: String::new(),
        rest: format!(
            "[[body]]\nname = \"block\"\nmaterial = \"stuff\"\nparticles_per_cell = 2\n\
             shape.box = {{ min = {}, max = {} }}\nvelocity = {}\n",
            list(dimension, [2; 3]),
            list(dimension, [2 + edge; 3]),
            texts(dimension, ["4", "4", "4"]),
        ),
    };
    scene.scenario(&variant)
}

/// Every third of the points comes first, and so on.
fn shuffle<const D: usize>(state: &mut State<D>) {
    let body = &mut state.bodies[0];
    let count = body.particles.len() as u32;
    let thirds = (0..3).flat_map(|first| (first..count).step_by(3));
    let mut targets = vec![0; count as usize];
    for (place, row) in thirds.enumerate() {
        targets[row as usize] = place as u32;
    }
    let (mut order, mut leaders) = (Vec::new(), Vec::new());
    reorder::cycles(&mut targets, &mut order, &mut leaders);
    body.particles.permute(&order, &leaders, false);
    body.material.permute(&order, &leaders);
}

/// Numbers and positions of the points, as they are stored after every step.
fn history<const D: usize>(shuffled: bool, parallel: bool) -> Vec<Vec<(u32, Vec<u64>)>> {
    let scenario = block(D);
    let computing = Computing {
        parallel: Some(parallel),
        instructions: None,
    };
    let mut scene = build_with::<D>(&scenario, &computing);
    if shuffled {
        shuffle(&mut scene.state);
    }
    let (state, solver) = (&mut scene.state, &mut scene.solver);
    solver
        .start(state)
        .unwrap_or_else(|fault| panic!("{fault}"));
    let mut history = Vec::new();
    for _ in 0..10 {
        solver
            .step(state, 0.05)
            .unwrap_or_else(|fault| panic!("{fault}"));
        let p = &state.bodies[0].particles;
        let bits = |row: usize| p.position[row].iter().map(|x| x.to_bits()).collect();
        history.push((0..p.len()).map(|row| (p.id[row], bits(row))).collect());
    }
    history
}

fn check<const D: usize>() {
    for shuffled in [false, true] {
        let alone = history::<D>(shuffled, false);
        let ids = |step: &Vec<(u32, Vec<u64>)>| step.iter().map(|p| p.0).collect::<Vec<_>>();
        // along a line, what comes in order stays in order
        if D > 1 || shuffled {
            assert!(
                ids(&alone[0]) != ids(&alone[9]),
                "{D}D: the block was never sorted again"
            );
        }
        for threads in [2, 7] {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .expect("threads can be started");
            let together = pool.install(|| history::<D>(shuffled, true));
            assert!(
                alone == together,
                "{D}D, shuffled {shuffled}, {threads} threads"
            );
        }
    }
}

#[test]
fn any_number_of_threads_stores_points_in_the_same_order() {
    check::<1>();
    check::<2>();
    check::<3>();
}

/// Whatever order points come in, those of a cell follow each other after a sort.
fn cells_are_together<const D: usize>() {
    let computing = Computing {
        parallel: Some(false),
        instructions: None,
    };
    let mut scene = build_with::<D>(&block(D), &computing);
    shuffle(&mut scene.state);
    let cell =
        |x: &mpm::math::Vector<D>| -> [i64; D] { std::array::from_fn(|a| x[a].floor() as i64) };
    let changes = |state: &State<D>| {
        let x = &state.bodies[0].particles.position;
        x.windows(2)
            .filter(|two| cell(&two[0]) != cell(&two[1]))
            .count()
    };
    let x = &scene.state.bodies[0].particles.position;
    let cells: std::collections::HashSet<_> = x.iter().map(cell).collect();
    assert!(changes(&scene.state) > 2 * cells.len(), "{D}D: shuffled");
    let started = scene.solver.start(&mut scene.state);
    started.unwrap_or_else(|fault| panic!("{fault}"));
    assert_eq!(changes(&scene.state), cells.len() - 1, "{D}D");
}

#[test]
fn points_of_a_cell_follow_each_other() {
    cells_are_together::<2>();
    cells_are_together::<3>();
}
