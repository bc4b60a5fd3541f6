//! A step asks for no memory once it has seen what it needs.

mod common;

use common::{Scene, Variant, flying_box};
use mpm::run::{Computing, build_with};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

static ALLOCATIONS: AtomicUsize = AtomicUsize::new(0);

thread_local! {
    /// Whether this thread takes steps: that which runs the tests asks for memory at times of its own.
    static STEPS: Cell<bool> = const { Cell::new(false) };
}

/// Counts how often the threads that take steps ask for memory.
struct Counting;

fn count_one() {
    if STEPS.get() {
        ALLOCATIONS.fetch_add(1, Relaxed);
    }
}

// SAFETY: everything is passed on to the system's allocator
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count_one();
        // SAFETY: as the caller says
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: as the caller says
        unsafe { System.dealloc(memory, layout) }
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count_one();
        // SAFETY: as the caller says
        unsafe { System.realloc(memory, layout, size) }
    }
}

#[global_allocator]
static GLOBAL: Counting = Counting;

/// Lets a box fly to the next block and back four times and counts on all ways but the first: (allocations, changes of the grid).
/// The fewest count: what a step needs it needs on every way, a thread that steals its first task only once.
fn count<const D: usize>(scene: &Scene, variant: &Variant, parallel: bool) -> (usize, usize) {
    let scenario = scene.scenario(variant);
    let mut built = build_with::<D>(
        &scenario,
        &Computing {
            parallel: Some(parallel),
            instructions: None,
        },
    );
    let (state, solver) = (&mut built.state, &mut built.solver);
    solver
        .start(state)
        .unwrap_or_else(|fault| panic!("{fault}"));
    // as a rigid body, so that every way is like the one before
    let velocity = state.bodies[0].particles.velocity[0];
    state.bodies[0].particles.velocity.fill(velocity);
    let mut fewest = (usize::MAX, usize::MAX);
    for way in 0..4 {
        let mut counted = (0, 0);
        for _there_and_back in 0..2 {
            for _ in 0..scene.steps {
                let stored = solver.stored_nodes();
                let before = ALLOCATIONS.load(Relaxed);
                solver
                    .step(state, scene.step)
                    .unwrap_or_else(|fault| panic!("{fault}"));
                counted.0 += ALLOCATIONS.load(Relaxed) - before;
                counted.1 += usize::from(solver.stored_nodes() != stored);
            }
            for velocity in &mut state.bodies[0].particles.velocity {
                *velocity = -*velocity;
            }
        }
        if way > 0 {
            fewest = (fewest.0.min(counted.0), fewest.1.min(counted.1));
        }
    }
    fewest
}

#[test]
fn a_warm_step_allocates_nothing() {
    STEPS.set(true);
    let variant = |basis, transfer: &str, update, frame| Variant {
        basis,
        transfer: transfer.into(),
        update,
        frame,
    };
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(2)
        .start_handler(|_| STEPS.set(true))
        .build()
        .expect("threads can be started");
    for dimension in 1..=3 {
        for variant in [
            variant("linear", "\"flip\"", "musl", "updated"),
            variant("quadratic", "\"apic\"", "usl", "updated"),
            variant("gimp", "\"pic\"", "usf", "updated"),
            variant("cubic", "\"flip\"", "usl", "updated"),
            variant("quadratic", "\"fmpm\"", "usl", "updated"),
            variant("quadratic", "\"flip\"", "musl", "total"),
            variant("linear", "\"apic\"", "usf", "total"),
            variant("cpdi", "\"apic\"", "musl", "updated"),
        ] {
            let mut scene = flying_box(dimension);
            scene.law = "neo_hookean = { youngs_modulus = 1, poissons_ratio = 0.3 }".into();
            scene.rest += "[[boundary]]\nname = \"wall\"\non.side = \"x_max\"\ncondition = \"fixed\"\n\
                           [[boundary]]\nname = \"other\"\non.side = \"x_min\"\ncondition = \"wall\"\n\
                           [[load]]\nbody = \"box\"\non.side = \"x_max\"\npressure = 1e-12\nfactor = \"1 + 1 * t\"\n";
            let run = |parallel| match dimension {
                1 => count::<1>(&scene, &variant, parallel),
                2 => count::<2>(&scene, &variant, parallel),
                _ => count::<3>(&scene, &variant, parallel),
            };
            let alone = run(false);
            assert!(
                alone.1 > 0 || variant.is_total(),
                "{dimension}D {variant:?}: the box never left its block"
            );
            assert_eq!(
                alone.0, 0,
                "{dimension}D {variant:?}: allocations on one thread"
            );
            let together = pool.install(|| run(true));
            assert_eq!(
                together.0, 0,
                "{dimension}D {variant:?}: allocations on two threads"
            );
        }
    }
}
