//! Space has no preferred axis, side or number of dimensions: one problem posed in several ways has one answer.

mod common;

use common::{Scene, Variant, flying_box, list, texts, variants};
use mpm::observe::Frame;
use mpm::study::validate::{Recorded, simulate};
use std::collections::HashMap;

fn run(scene: &Scene, variant: &Variant) -> Recorded {
    simulate(&scene.text(variant), &[], true).unwrap_or_else(|error| panic!("{variant:?}: {error}"))
}

/// A bar without lateral contraction along `axis`, one cell wide, fixed at its lower end, which moves enough for its points to
/// change cells and blocks.
fn bar(dimension: usize, axis: usize, law: &str) -> Scene {
    let along = |one: f64, other: f64| [0, 1, 2].map(|a| if a == axis { one } else { other });
    let name = ["x", "y", "z"][axis];
    let velocity = format!("2 * sin(pi * {name} / 20)");
    let velocity = [0, 1, 2].map(|a| if a == axis { velocity.as_str() } else { "0" });
    let per_cell = along(2.0, 1.0).map(|n| n as u32);
    let rest = format!(
        "[[body]]\nname = \"bar\"\nmaterial = \"stuff\"\nshape.box = {{ min = {}, max = {} }}\n\
         particles_per_cell = {}\nvelocity = {}\n\
         [[boundary]]\nname = \"wall\"\non.side = \"{name}_min\"\ncondition = \"fixed\"\n",
        list(dimension, [0.0; 3]),
        list(dimension, along(10.0, 1.0)),
        list(dimension, per_cell),
        texts(dimension, velocity),
    );
    Scene {
        dimension,
        cells: along(14.0, 1.0).map(|n| n as u32),
        cell_size: 1.0,
        step: 0.4,
        steps: 8,
        law: format!("{law} = {{ youngs_modulus = 100, poissons_ratio = 0 }}"),
        head: String::new(),
        rest,
    }
}

#[test]
fn a_bar_moves_the_same_along_every_axis_of_every_space() {
    for law in ["neo_hookean", "linear_elastic"] {
        for variant in variants() {
            let history = |dimension, axis: usize| {
                let scene = bar(dimension, axis, law);
                // recorded a few times, with steps found by the solver
                let text = scene
                    .text(&variant)
                    .replace(&format!("step = {:e}", scene.step), "courant = 0.3");
                let run = simulate(&text, &[], false)
                    .unwrap_or_else(|error| panic!("{variant:?}: {error}"));
                let name = ["x", "y", "z"][axis];
                let columns = [format!("position_{name}"), format!("velocity_{name}")];
                let mut numbers: Vec<f64> = columns
                    .iter()
                    .flat_map(|c| run.column("body_bar", c))
                    .collect();
                numbers.extend(run.column("energy", "elastic"));
                numbers.extend(run.column("boundary_wall", &format!("impulse_{name}")));
                (run.summary.steps, numbers)
            };
            let (steps, line) = history(1, 0);
            assert!(steps > 50);
            for (dimension, axis) in [(2, 0), (2, 1), (3, 0), (3, 1), (3, 2)] {
                let (others, other) = history(dimension, axis);
                let name = format!("{law} {variant:?} in {dimension}D along axis {axis}");
                assert_eq!(others, steps, "{name}");
                for (a, b) in line.iter().zip(&other) {
                    assert!(
                        (a - b).abs() <= 1e-12 * a.abs().max(10.0),
                        "{name}: {b:e}, in 1D {a:e}"
                    );
                }
            }
        }
    }
}

/// Points by where they started, in thousandths of a metre.
fn by_start(start: &Frame) -> HashMap<[i64; 3], usize> {
    let key = |x: [f64; 3]| x.map(|x| (x * 1e3).round() as i64);
    start
        .points
        .iter()
        .enumerate()
        .map(|(index, point)| (key(point.position), index))
        .collect()
}

/// Compares the last frames of two runs whose points correspond by `map` of positions and `turn` of vectors.
fn correspond(
    name: &str,
    a: &Recorded,
    b: &Recorded,
    map: impl Fn([f64; 3]) -> [f64; 3],
    turn: impl Fn([f64; 3]) -> [f64; 3],
) {
    let ends = |run: &Recorded| {
        [
            run.memory.frames[0].clone(),
            run.memory.frames[run.memory.frames.len() - 1].clone(),
        ]
    };
    let ([a0, a1], [b0, b1]) = (ends(a), ends(b));
    assert_eq!(a.summary.steps, b.summary.steps);
    let places = by_start(&b0);
    let mut moved = 0.0_f64;
    for (start, end) in a0.points.iter().zip(&a1.points) {
        let key = map(start.position).map(|x| (x * 1e3).round() as i64);
        let other = &b1.points[*places
            .get(&key)
            .unwrap_or_else(|| panic!("{name}: no point at {key:?}"))];
        let (position, velocity) = (map(end.position), turn(end.velocity));
        for axis in 0..3 {
            let x = (position[axis] - other.position[axis]).abs();
            let v = (velocity[axis] - other.velocity[axis]).abs();
            assert!(x <= 1e-11 && v <= 1e-9, "{name}: {end:?}\nbut {other:?}");
            moved = moved.max((end.position[axis] - start.position[axis]).abs());
        }
    }
    assert!(moved > 1.0, "{name}: nothing moved");
}

/// A box in its own frame with centre c and half widths, and everything that acts on it, transformed by a signed permutation
/// of the axes.
fn turned_box(dimension: usize, from: [usize; 3], signs: [f64; 3], size: f64) -> Scene {
    // what stands along axis a of the new scene stood along axis from[a] of the old one
    let center = [0.37 * size, 0.42 * size, 0.55 * size];
    let half = [1.0, 0.75, 0.5];
    let names = ["x", "y", "z"];
    let place = |a: usize| {
        if signs[a] > 0.0 {
            center[from[a]]
        } else {
            size - center[from[a]]
        }
    };
    let old = |axis: usize| {
        // coordinate of the old scene relative to the centre, in new coordinates
        let a = (0..3).find(|a| from[*a] == axis).unwrap_or(axis);
        format!("({} * ({} - {}))", signs[a], names[a], place(a))
    };
    let [u, v, w] = [old(0), old(1), old(2)];
    let mut velocity = [
        format!("9 + 2 * {u} - 4 * {v}"),
        format!("-6 + 5 * {u} + {v}"),
        format!("4 - {w}"),
    ];
    if dimension == 1 {
        velocity = [format!("9 + 2 * {u}"), String::new(), String::new()];
    }
    let velocity = [0, 1, 2].map(|a| format!("{} * ({})", signs[a], velocity[from[a]]));
    let gravity = [3.0, -5.0, 7.0];
    Scene {
        dimension,
        cells: [(size / 0.5) as u32; 3],
        head: format!(
            "gravity = {}",
            list(dimension, [0, 1, 2].map(|a| signs[a] * gravity[from[a]]))
        ),
        rest: format!(
            "[[body]]\nname = \"box\"\nmaterial = \"stuff\"\nshape.box = {{ min = {}, max = {} }}\nvelocity = {}\n",
            list(dimension, [0, 1, 2].map(|a| place(a) - half[from[a]])),
            list(dimension, [0, 1, 2].map(|a| place(a) + half[from[a]])),
            texts(dimension, [0, 1, 2].map(|a| velocity[a].as_str())),
        ),
        step: 0.005,
        steps: 50,
        ..flying_box(dimension)
    }
}

const SIZE: [f64; 3] = [60.0, 20.0, 10.0];

#[test]
fn a_mirrored_scene_moves_in_the_mirror() {
    for dimension in 1..=3 {
        let size = SIZE[dimension - 1];
        for variant in variants() {
            let plain = run(&turned_box(dimension, [0, 1, 2], [1.0; 3], size), &variant);
            for axis in 0..dimension {
                let signs = [0, 1, 2].map(|a| if a == axis { -1.0 } else { 1.0 });
                let mirrored = run(&turned_box(dimension, [0, 1, 2], signs, size), &variant);
                let map =
                    |x: [f64; 3]| [0, 1, 2].map(|a| if a == axis { size - x[a] } else { x[a] });
                let turn = |v: [f64; 3]| [0, 1, 2].map(|a| signs[a] * v[a]);
                correspond(
                    &format!("{variant:?} mirrored in axis {axis}"),
                    &plain,
                    &mirrored,
                    map,
                    turn,
                );
            }
        }
    }
}

#[test]
fn renaming_the_axes_renames_the_results() {
    for (dimension, from) in [(2, [1, 0, 2]), (3, [1, 2, 0]), (3, [2, 1, 0])] {
        let size = SIZE[dimension - 1];
        for variant in variants() {
            let plain = run(&turned_box(dimension, [0, 1, 2], [1.0; 3], size), &variant);
            let renamed = run(&turned_box(dimension, from, [1.0; 3], size), &variant);
            let map = |x: [f64; 3]| from.map(|a| x[a]);
            correspond(
                &format!("{variant:?} with axes {from:?}"),
                &plain,
                &renamed,
                map,
                map,
            );
        }
    }
}
