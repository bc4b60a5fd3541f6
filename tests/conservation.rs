//! What a free body keeps, and what forces, walls and damping change by exactly as much as they say: for every basis, transfer
//! and update in one, two and three dimensions.

mod common;

use common::{Scene, Variant, flying_box, list, texts, variants};
use mpm::study::validate::{Recorded, simulate};

const AXES: [&str; 3] = ["x", "y", "z"];

/// Runs `scene` with every method and hands what it recorded to `check`.
fn everywhere(scene: impl Fn(usize) -> Scene, check: impl Fn(&str, &Scene, &Variant, &Recorded)) {
    for dimension in 1..=3 {
        let scene = scene(dimension);
        for variant in variants() {
            let name = format!("{dimension}D {variant:?}");
            let run = simulate(&scene.text(&variant), &[], true)
                .unwrap_or_else(|error| panic!("{name}: {error}"));
            assert_eq!(run.summary.steps, u64::from(scene.steps), "{name}");
            check(&name, &scene, &variant, &run);
        }
    }
}

/// Σ m |v| over all points at the start.
fn motion(run: &Recorded) -> f64 {
    let speed = |v: &[f64; 3]| v.iter().map(|v| v * v).sum::<f64>().sqrt();
    run.memory.frames[0]
        .points
        .iter()
        .map(|point| point.mass * speed(&point.velocity))
        .sum()
}

fn mass(run: &Recorded) -> f64 {
    run.column("body_box", "mass")[0]
}

fn last(run: &Recorded, table: &str, column: &str) -> f64 {
    *run.column(table, column)
        .last()
        .unwrap_or_else(|| panic!("no {column} in {table}"))
}

#[track_caller]
fn close(name: &str, what: &str, found: f64, expected: f64, tolerance: f64) {
    let wrong = (found - expected).abs();
    assert!(
        wrong <= tolerance,
        "{name}: {what} is {found:e}, not {expected:e}: {wrong:e} > {tolerance:e}"
    );
}

#[test]
fn a_free_body_keeps_its_momentum_and_its_energy_account_closes() {
    everywhere(flying_box, |name, scene, _, run| {
        for axis in &AXES[..scene.dimension] {
            let momentum = run.column("body_box", &format!("momentum_{axis}"));
            for later in &momentum {
                close(name, "momentum", *later, momentum[0], 1e-13 * motion(run));
            }
        }
        let residual = run.summary.worst_energy_residual;
        assert!(residual <= 1e-11, "{name}: residual {residual:e}");
    });
}

#[test]
fn gravity_gives_mass_times_acceleration_times_time() {
    let gravity = [3.0, -7.0, 11.0];
    let scene = |dimension| Scene {
        head: format!("gravity = {}", list(dimension, gravity)),
        ..flying_box(dimension)
    };
    everywhere(scene, |name, scene, _, run| {
        let time = run.column("body_box", "time");
        for (axis, g) in AXES[..scene.dimension].iter().zip(gravity) {
            let momentum = run.column("body_box", &format!("momentum_{axis}"));
            for (t, later) in time.iter().zip(&momentum) {
                close(
                    name,
                    "momentum",
                    *later,
                    momentum[0] + mass(run) * g * t,
                    2e-13 * motion(run),
                );
            }
        }
        let residual = run.summary.worst_energy_residual;
        assert!(residual <= 1e-11, "{name}: residual {residual:e}");
    });
}

/// A box in the corner of the grid.
fn corner_box(dimension: usize, velocity: [&str; 3], head: &str, rest: &str) -> Scene {
    let body = format!(
        "[[body]]\nname = \"box\"\nmaterial = \"stuff\"\nshape.box = {{ min = {}, max = {} }}\nvelocity = {}\n",
        list(dimension, [0.0; 3]),
        list(dimension, [2.0, 1.0, 1.0]),
        texts(dimension, velocity),
    );
    Scene {
        dimension,
        cells: [8, 6, 4],
        cell_size: 0.5,
        step: 0.01,
        steps: 50,
        law: "neo_hookean = { youngs_modulus = 100, poissons_ratio = 0.3 }".into(),
        head: head.into(),
        rest: body + rest,
    }
}

#[test]
fn loads_gravity_and_reactions_account_for_all_momentum() {
    let (force, gravity) = ([0.5, 0.2, -0.1], [-0.3, -0.9, 0.4]);
    let scene = |dimension| {
        let mut rest = format!(
            "[[load]]\nbody = \"box\"\non.side = \"x_max\"\nforce = {}\n\
             [[boundary]]\nname = \"grip\"\non.side = \"x_min\"\ncondition = \"fixed\"\n",
            list(dimension, force)
        );
        if dimension > 1 {
            // the two share the nodes of an edge
            rest += "[[boundary]]\nname = \"floor\"\non.side = \"y_min\"\ncondition = \"wall\"\n";
        }
        corner_box(
            dimension,
            ["0", "0", "0"],
            &format!("gravity = {}", list(dimension, gravity)),
            &rest,
        )
    };
    everywhere(scene, |name, scene, _, run| {
        let time = run.column("body_box", "time");
        for a in 0..scene.dimension {
            let momentum = run.column("body_box", &format!("momentum_{}", AXES[a]));
            let impulse = |boundary: &str| run.column(boundary, &format!("impulse_{}", AXES[a]));
            let (grip, floor) = (impulse("boundary_grip"), impulse("boundary_floor"));
            let given = force[a] + mass(run) * gravity[a];
            for (row, t) in time.iter().enumerate() {
                let reactions = grip[row] + floor.get(row).unwrap_or(&0.0);
                close(
                    name,
                    "momentum",
                    momentum[row],
                    given * t + reactions,
                    1e-12 * mass(run),
                );
            }
            assert!(grip.last() != Some(&0.0), "{name}: the grip does nothing");
        }
        let residual = run.summary.worst_energy_residual;
        assert!(residual <= 1e-11, "{name}: residual {residual:e}");
    });
}

#[test]
fn damping_slows_a_rigid_body_exponentially_and_books_what_it_takes() {
    let rate = 0.7;
    let scene = |dimension| {
        let damping = format!("[damping]\nrate = {rate}\n");
        let mut scene = corner_box(dimension, ["3", "2", "1"], "", &damping);
        scene.steps = 30;
        scene
    };
    everywhere(scene, |name, scene, _, run| {
        let (time, damping) = (
            run.column("energy", "time"),
            run.column("energy", "damping"),
        );
        let kinetic = run.column("energy", "kinetic");
        for axis in &AXES[..scene.dimension] {
            let momentum = run.column("body_box", &format!("momentum_{axis}"));
            for (t, later) in time.iter().zip(&momentum) {
                close(
                    name,
                    "momentum",
                    *later,
                    momentum[0] * (-rate * t).exp(),
                    1e-12 * momentum[0],
                );
            }
        }
        for row in 1..time.len() {
            assert!(
                damping[row] > damping[row - 1],
                "{name}: damping {damping:?}"
            );
            close(
                name,
                "damping",
                damping[row],
                kinetic[0] - kinetic[row],
                1e-12 * kinetic[0],
            );
        }
    });
}

#[test]
fn a_driven_wall_does_reaction_times_velocity() {
    let scene = |dimension| {
        let driven = format!(
            "condition.driven = {{ velocity = {} }}\n",
            texts(dimension, ["1 + 4 * t", "free", "3 * t"])
        );
        let rest = format!("[[boundary]]\nname = \"grip\"\non.side = \"x_min\"\n{driven}");
        Scene {
            steps: 30,
            ..corner_box(dimension, ["0", "0", "0"], "", &rest)
        }
    };
    everywhere(scene, |name, scene, _, run| {
        let time = run.column("boundary_grip", "time");
        let velocity = |axis: usize, t: f64| [1.0 + 4.0 * t, 0.0, 3.0 * t][axis];
        let booked = run.column("energy", "boundary_work");
        let (mut work, mut turned) = (0.0, 0.0);
        for row in 1..time.len() {
            for a in 0..scene.dimension {
                let reaction = run.column("boundary_grip", &format!("reaction_{}", AXES[a]))[row];
                let mean = 0.5 * (velocity(a, time[row - 1]) + velocity(a, time[row]));
                work += reaction * mean * scene.step;
                turned += (reaction * mean * scene.step).abs();
            }
            close(name, "boundary work", booked[row], work, 1e-12 * turned);
        }
        assert!(work.abs() > 0.1, "{name}: the wall does nothing");
        let residual = run.summary.worst_energy_residual;
        assert!(residual <= 1e-11, "{name}: residual {residual:e}");
    });
}

#[test]
fn a_force_on_a_rigid_body_does_the_work_that_it_moves_with() {
    let force = [5.0, 2.0, -1.0];
    let scene = |dimension| {
        let load = |axis: usize| {
            let only = [0, 1, 2].map(|a| if a == axis { force[a] } else { 0.0 });
            let everywhere = format!("on.box = {{ min = {} }}", list(dimension, [0.0; 3]));
            format!(
                "[[load]]\nbody = \"box\"\n{everywhere}\nforce = {}\n",
                list(dimension, only)
            )
        };
        let loads: String = (0..dimension).map(load).collect();
        let mut scene = corner_box(dimension, ["1", "1", "2"], "", &loads);
        scene.steps = 30;
        scene
    };
    everywhere(scene, |name, scene, _, run| {
        let time = last(run, "energy", "time");
        let start = [1.0, 1.0, 2.0];
        // force times way, with the steps from `later` counted in full
        let work = |later: f64| -> f64 {
            let acceleration = |a: usize| force[a] / mass(run);
            (0..scene.dimension)
                .map(|a| force[a] * time * (start[a] + 0.5 * acceleration(a) * (time + later)))
                .sum()
        };
        // points move with the velocity at the end of each step
        let exact = work(scene.step);
        close(
            name,
            "external work",
            last(run, "energy", "external_work"),
            exact,
            1e-12 * exact.abs(),
        );
        let gained = last(run, "energy", "kinetic") - run.column("energy", "kinetic")[0];
        close(
            name,
            "kinetic energy",
            gained,
            work(0.0),
            1e-12 * last(run, "energy", "kinetic"),
        );
    });
}

/// The work of a load is force times way, point by point: a load stays with its points wherever they are stored, and acts in each step
/// with its factor at the start.
#[test]
fn a_load_does_force_times_the_way_of_its_points() {
    let field = [0.4, -0.3, 0.2];
    let edge = |dimension: usize| [31.25, 7.25, 3.25][dimension - 1];
    let scene = |dimension| {
        let mut scene = flying_box(dimension);
        let [u, v, w] = &field.map(|a| format!("{a} * x"));
        scene.rest += &format!(
            "[[load]]\nbody = \"box\"\non.box = {{ min = {} }}\nacceleration = {}\nfactor = \"1 + 5 * t\"\n",
            list(dimension, [edge(dimension), 0.0, 0.0]),
            texts(dimension, [u, v, w])
        );
        scene
    };
    everywhere(scene, |name, scene, _, run| {
        let frames = &run.memory.frames;
        let start = &frames[0].points;
        let booked = run.column("energy", "external_work");
        let loaded = |i: &usize| start[*i].position[0] > edge(scene.dimension);
        let loaded: Vec<usize> = (0..start.len()).filter(loaded).collect();
        assert!(!loaded.is_empty() && loaded.len() < start.len());
        let (mut work, mut turned) = (0.0, 0.0);
        for (row, pair) in frames.windows(2).enumerate() {
            let factor = 1.0 + 5.0 * pair[0].time;
            for &i in &loaded {
                let force = start[i].mass * start[i].position[0] * factor;
                for a in 0..scene.dimension {
                    let way = pair[1].points[i].position[a] - pair[0].points[i].position[a];
                    work += force * field[a] * way;
                    turned += (force * field[a] * way).abs();
                }
            }
            close(
                name,
                "work of the load",
                booked[row + 1],
                work,
                1e-11 * turned,
            );
        }
    });
}

/// A body that falls from rest has the velocity g t of a wall that is driven so, at the start and at the end of every step: no node is
/// held back, nothing is strained.
#[test]
fn a_wall_that_falls_with_a_body_leaves_it_without_stress() {
    let scene = |dimension| {
        let driven = texts(dimension, ["3 * t", "-2 * t", "1 * t"]);
        let wall = format!(
            "[[boundary]]\nname = \"grip\"\non.side = \"x_min\"\ncondition.driven = {{ velocity = {driven} }}\n"
        );
        let gravity = format!("gravity = {}", list(dimension, [3.0, -2.0, 1.0]));
        let mut scene = corner_box(dimension, ["0", "0", "0"], &gravity, &wall);
        scene.steps = 10;
        scene
    };
    everywhere(scene, |name, scene, _, run| {
        let given = mass(run) * 3.0 * scene.step * f64::from(scene.steps);
        assert!(last(run, "energy", "elastic") < 1e-20, "{name}");
        for axis in &AXES[..scene.dimension] {
            let impulse = last(run, "boundary_grip", &format!("impulse_{axis}"));
            close(name, "impulse of the wall", impulse, 0.0, 1e-12 * given);
        }
    });
}

/// A point on a node has slopes, but no weight, at nodes around it that no mass may have come to: they have no velocity, not that of
/// a place at rest.
#[test]
fn a_point_on_a_node_flies_without_stress() {
    let scene = |dimension| {
        let mut scene = corner_box(dimension, ["3", "2", "1"], "", "");
        scene.rest = format!(
            "[[body]]\nname = \"box\"\nmaterial = \"stuff\"\nparticles_per_cell = 1\n\
             shape.box = {{ min = {}, max = {} }}\nvelocity = {}\n",
            list(dimension, [0.75; 3]),
            list(dimension, [1.25; 3]),
            texts(dimension, ["3", "2", "1"])
        );
        scene.steps = 3;
        scene
    };
    everywhere(scene, |name, scene, _, run| {
        let start = run.memory.frames[0].points[0].position;
        assert_eq!(start[..scene.dimension], [1.0; 3][..scene.dimension]);
        for elastic in run.column("energy", "elastic") {
            assert!(elastic.abs() < 1e-20, "{name}: {elastic:e}");
        }
    });
}

/// APIC returns Σ N (x_i − x) v to the grid in full where Σ N (x_i − x)² does not depend on the place of the point in its
/// cell: for splines away from the ends of the grid. For the other bases the affine field C is kept rather than the moment,
/// and what a point's spin weighs changes a little as it moves.
#[test]
fn apic_keeps_angular_momentum() {
    for dimension in 2..=3 {
        let scene = flying_box(dimension);
        for variant in variants().iter().filter(|variant| variant.is_apic()) {
            let name = format!("{dimension}D {variant:?}");
            let run = simulate(&scene.text(variant), &[], true)
                .unwrap_or_else(|error| panic!("{name}: {error}"));
            // In the total frame a point's moments are about nodes that have moved, which is the same only where F and the
            // gradient of the velocity are those of a linear field over the stencil.
            let constant = matches!(variant.basis, "quadratic" | "cubic") && !variant.is_total();
            let arm = if dimension == 2 { 10.0 } else { 5.0 };
            for axis in if dimension == 2 { &["z"][..] } else { &AXES } {
                let spin = run.column("body_box", &format!("angular_momentum_{axis}"));
                for later in &spin {
                    let tolerance = if constant { 1e-12 } else { 2e-3 };
                    close(
                        &name,
                        "angular momentum",
                        *later,
                        spin[0],
                        tolerance * arm * motion(&run),
                    );
                }
            }
        }
    }
}
