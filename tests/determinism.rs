//! The same scene gives the same bits on any number of threads.

mod common;

use common::{NEO_HOOKEAN, Scene, Variant, list, texts, variants};
use mpm::real::Instructions;
use mpm::run::{Computing, build_with};
use mpm::scenario::Scenario;
use mpm::solver::Account;
use mpm::state::{Body, State};
use rayon::ThreadPoolBuilder;

/// Everything that a body is, in the order of the numbers of its points.
fn bits_of<const D: usize>(body: &Body<D>) -> Vec<Vec<u64>> {
    let p = &body.particles;
    let mut memory = Vec::new();
    body.material.state_bits(&mut memory);
    let stride = memory.len() / p.len();
    let width = p.stress.len() / p.len();
    let mut points: Vec<Vec<u64>> = (0..p.len())
        .map(|row| {
            let mut numbers: Vec<f64> = p.position[row]
                .iter()
                .chain(p.velocity[row].iter())
                .copied()
                .collect();
            numbers.extend(&p.stress[row * width..(row + 1) * width]);
            let matrices = [&p.deformation_gradient, &p.first_piola_stress];
            numbers.extend(matrices.iter().flat_map(|m| m.get(row)).flatten());
            numbers.extend(p.affine.get(row).iter().flat_map(|affine| affine.iter()));
            numbers.extend(
                p.hoop_stress
                    .get(row)
                    .iter()
                    .chain(&p.hoop_stretch.get(row))
                    .copied(),
            );
            let mut bits = vec![u64::from(p.id[row])];
            bits.extend(numbers.iter().map(|number| number.to_bits()));
            bits.extend(&memory[row * stride..(row + 1) * stride]);
            bits
        })
        .collect();
    points.sort();
    points
}

/// State and account after a run, and the orders in which points were stored: at the start, and after each step that changed it.
#[derive(PartialEq)]
struct Outcome {
    bits: Vec<Vec<Vec<u64>>>,
    account: Account,
    reactions: Vec<Vec<u64>>,
    orders: Vec<(u32, Vec<Vec<u32>>)>,
}

fn order<const D: usize>(state: &State<D>) -> Vec<Vec<u32>> {
    state
        .bodies
        .iter()
        .map(|body| body.particles.id.clone())
        .collect()
}

fn run<const D: usize>(
    scenario: &Scenario,
    steps: u32,
    step: f64,
    computing: &Computing,
) -> Outcome {
    let mut scene = build_with::<D>(scenario, computing);
    let (state, solver) = (&mut scene.state, &mut scene.solver);
    let method = format!("{:?}", scenario.method);
    solver
        .start(state)
        .unwrap_or_else(|fault| panic!("{fault}"));
    let mut orders = vec![(0, order(state))];
    for number in 1..=steps {
        solver
            .step(state, step)
            .unwrap_or_else(|fault| panic!("{method}: {fault}"));
        let now = order(state);
        if orders.last().is_none_or(|(_, last)| *last != now) {
            orders.push((number, now));
        }
    }
    let totals: Vec<_> = state.bodies.iter().map(|body| body.totals()).collect();
    let ledger = solver.ledger();
    Outcome {
        bits: state.bodies.iter().map(bits_of).collect(),
        account: ledger.account(solver.stored(&totals)),
        reactions: (0..scenario.boundaries.len())
            .map(|boundary| {
                ledger
                    .impulse(boundary)
                    .iter()
                    .map(|number| number.to_bits())
                    .collect()
            })
            .collect(),
        orders,
    }
}

fn same_on_any_number_of_threads(scene: &Scene) {
    let pools: Vec<_> = [1, 2, 3, 7]
        .map(|threads| {
            ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .expect("threads can be started")
        })
        .into();
    // in the total frame "musl" has every pass
    let mut variants = variants();
    variants.retain(|variant| !variant.is_total() || variant.update == "musl");
    for variant in variants {
        let scenario = scene.scenario(&variant);
        let run = |parallel| {
            let computing = Computing {
                parallel: Some(parallel),
                instructions: None,
            };
            match scene.dimension {
                1 => run::<1>(&scenario, scene.steps, scene.step, &computing),
                2 => run::<2>(&scenario, scene.steps, scene.step, &computing),
                _ => run::<3>(&scenario, scene.steps, scene.step, &computing),
            }
        };
        let name = format!("{}D {variant:?}", scene.dimension);
        let alone = run(false);
        // points on a line keep their order, and in the total frame all points do
        assert!(
            alone.orders.len() > 1 || scene.dimension == 1 || variant.is_total(),
            "{name}: points were never re-sorted"
        );
        for pool in &pools {
            let together = pool.install(|| run(true));
            let threads = pool.current_num_threads();
            assert!(
                together == alone,
                "{name}: {threads} threads give other bits than plain loops"
            );
        }
    }
}

/// Two boxes, one that flies off and one that is pulled towards a wall, both on a smooth floor: full blocks, so that every block is a task.
fn two_boxes(dimension: usize) -> Scene {
    let (low, high, per_cell) = [
        ([10.0, 0.0, 0.0], [160.0, 0.0, 0.0], 16),
        ([6.0, 0.0, 0.0], [21.0, 18.0, 0.0], 4),
        ([5.0, 0.0, 1.5], [9.5, 5.0, 6.5], 3),
    ][dimension - 1];
    let body = |name: &str, from: f64, velocity: [&str; 3]| {
        format!(
            "[[body]]\nname = \"{name}\"\nmaterial = \"stuff\"\nparticles_per_cell = {per_cell}\n\
             shape.box = {{ min = {}, max = {} }}\nvelocity = {}\n",
            list(dimension, [low[0] + from, low[1], low[2]]),
            list(dimension, [high[0] + from, high[1], high[2]]),
            texts(dimension, velocity),
        )
    };
    let apart = high[0] - low[0] + 1.0;
    // on a line nothing gives way to the side: eight times the speed of sound into the wall turns points inside out
    let right = if dimension == 1 {
        "1 + 0.04 * x"
    } else {
        "1 + 0.1 * x"
    };
    let rest = body("left", 0.0, ["-35 + 0.1 * x", "2", "20"])
        + &body("right", apart, [right, "-1", "30"])
        + "[[load]]\nbody = \"right\"\non.side = \"x_max\"\nfactor = \"1 + 1 * t\"\n"
        + &format!("force = {}\n", list(dimension, [50.0; 3]))
        + "[[boundary]]\nname = \"wall\"\non.side = \"x_max\"\ncondition = \"wall\"\n"
        + if dimension > 1 {
            "[[boundary]]\nname = \"rail\"\non.side = \"y_min\"\ncondition = \"roller\"\n"
        } else {
            ""
        }
        + "[damping]\nrate = 0.1\n";
    Scene {
        dimension,
        cells: [[312, 1, 1], [38, 24, 1], [16, 8, 12]][dimension - 1],
        cell_size: 1.0,
        step: 0.01,
        steps: 9,
        law: NEO_HOOKEAN.into(),
        head: format!("gravity = {}", list(dimension, [1.0, -9.0, 2.0])),
        rest,
    }
}

#[test]
fn one_dimension() {
    same_on_any_number_of_threads(&two_boxes(1));
}

#[test]
fn two_dimensions() {
    same_on_any_number_of_threads(&two_boxes(2));
}

#[test]
fn three_dimensions() {
    same_on_any_number_of_threads(&two_boxes(3));
}

#[test]
fn axisymmetric() {
    let mut scene = two_boxes(2);
    scene.head = "plane = \"axisymmetric\"\ngravity = [0, -9]".into();
    same_on_any_number_of_threads(&scene);
}

#[test]
fn a_law_without_memory() {
    let mut scene = two_boxes(2);
    scene.law = "linear_elastic = { youngs_modulus = 100, poissons_ratio = 0.3 }".into();
    same_on_any_number_of_threads(&scene);
}

/// Points that drift through cells, so that groups fall apart and are sorted early, give the same bits in groups of four and of
/// eight; on a processor without registers of eight numbers both are groups of four.
#[test]
fn eight_at_a_time() {
    let mut scene = two_boxes(3);
    scene.rest = "[[body]]\nname = \"left\"\nmaterial = \"stuff\"\nparticles_per_cell = 2\n\
                  shape.box = { min = [2, 2, 2], max = [10, 9, 8] }\n\
                  velocity = [\"2 + 0.1 * x\", \"1.5 - 0.1 * z\", \"1\"]\n"
        .into();
    scene.head = String::new();
    scene.cells = [16; 3];
    for (transfer, update) in [("\"mls_apic\"", "usl"), ("\"flip\"", "musl")] {
        let variant = Variant {
            basis: "quadratic",
            transfer: transfer.into(),
            update,
            frame: "updated",
        };
        let scenario = scene.scenario(&variant);
        let run = |instructions| {
            let computing = Computing {
                parallel: Some(false),
                instructions: Some(instructions),
            };
            run::<3>(&scenario, 80, 0.01, &computing)
        };
        let four = run(Instructions::Wide);
        let eight = run(Instructions::Widest);
        let sorts: Vec<_> = four.orders.iter().map(|(step, _)| *step).collect();
        // fastest is 3 m/s: no point is a cell away from its block before step 33
        assert!(sorts[1] < 33, "no sort is early: {sorts:?}");
        assert!(four == eight, "eight at a time give other bits: {update}");
    }
}

/// So many that blocks are large ones.
#[test]
fn many_points() {
    let mut scene = two_boxes(3);
    scene.rest = "[[body]]\nname = \"left\"\nmaterial = \"stuff\"\nparticles_per_cell = 2\n\
                  shape.box = { min = [6, 5.5, 6], max = [52, 51.5, 52] }\n\
                  velocity = [\"-35 + 0.1 * x\", \"2\", \"20\"]\n"
        .into();
    scene.cells = [58; 3];
    let variant = Variant {
        basis: "quadratic",
        transfer: "\"mls_apic\"".into(),
        update: "usl",
        frame: "updated",
    };
    let scenario = scene.scenario(&variant);
    let run = |threads: usize| {
        let computing = Computing {
            parallel: Some(threads > 1),
            instructions: None,
        };
        let pool = ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads can be started").install(|| {
            let mut scene = build_with::<3>(&scenario, &computing);
            let (state, solver) = (&mut scene.state, &mut scene.solver);
            solver
                .start(state)
                .unwrap_or_else(|fault| panic!("{fault}"));
            // nodes 5 to 53 an axis, seven blocks of eight with one around them; of four they would be fifteen
            assert_eq!(solver.stored_nodes(), 9_usize.pow(3) * 512);
            let before = order(state);
            for _ in 0..5 {
                solver
                    .step(state, 0.01)
                    .unwrap_or_else(|fault| panic!("{fault}"));
            }
            assert!(before != order(state), "points were never re-sorted");
            let p = &mut state.bodies[0].particles;
            let vectors = p.position.iter().chain(&p.velocity).flatten();
            let numbers = vectors.chain(p.affine.iter().flatten()).chain(&p.stress);
            numbers.map(|number| number.to_bits()).collect::<Vec<_>>()
        })
    };
    let alone = run(1);
    for threads in [2, 3, 7] {
        assert!(run(threads) == alone, "{threads} threads give other bits");
    }
}
