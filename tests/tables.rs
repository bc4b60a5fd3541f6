//! What tables say is what the points hold: each column against a sum over the points of the same recorded time.

mod common;

use common::{Scene, Variant, list, texts};
use mpm::observe::Point;
use mpm::study::validate::{Recorded, simulate};

const AXES: [&str; 3] = ["x", "y", "z"];
const GRAVITY: [f64; 3] = [0.5, -2.0, 1.0];

fn variant(transfer: &str, update: &'static str) -> Variant {
    Variant {
        basis: "quadratic",
        transfer: format!("\"{transfer}\""),
        update,
        frame: "updated",
    }
}

/// A box of one of two stuffs, which flies and turns from one block of the grid to the next.
fn flying(dimension: usize, name: &str, material: &str, low: f64, speed: f64) -> String {
    let turning = [
        format!("{speed} + 0.4 * (x - {low}) - 2 * (y - {low})"),
        format!("2 * (x - {low}) - {speed}"),
        format!("0.5 * {speed} + 1 * (x - {low}) - 1 * (y - {low})"),
    ];
    let line = [
        format!("{speed} + 0.4 * (x - {low})"),
        String::new(),
        String::new(),
    ];
    let [u, v, w] = if dimension == 1 { &line } else { &turning };
    format!(
        "[[body]]\nname = \"{name}\"\nmaterial = \"{material}\"\nshape.box = {{ min = {}, max = {} }}\nvelocity = {}\n",
        list(dimension, [low, low, low + 0.5]),
        list(dimension, [low + 1.5, low + 1.0, low + 1.0]),
        texts(dimension, [u, v, w]),
    )
}

/// A light box and a heavy and soft one, far from each other.
fn two_boxes(dimension: usize, bodies: &[&str]) -> Scene {
    let all = [
        flying(dimension, "light", "stuff", 3.5, 3.0),
        flying(dimension, "heavy", "lead", 8.5, -2.0),
    ];
    let chosen = all
        .iter()
        .filter(|body| bodies.iter().any(|name| body.contains(name)));
    let lead = "[material.lead]\ndensity = 4\nneo_hookean = { youngs_modulus = 12, poissons_ratio = 0.2 }\n";
    Scene {
        dimension,
        cells: [[60; 3], [28; 3], [28; 3]][dimension - 1],
        cell_size: 0.5,
        step: 0.01,
        steps: 30,
        law: "neo_hookean = { youngs_modulus = 20, poissons_ratio = 0.3 }".into(),
        head: format!("gravity = {}", list(dimension, GRAVITY)),
        rest: lead.to_string() + &chosen.cloned().collect::<String>(),
    }
}

fn run(scene: &Scene, variant: &Variant) -> Recorded {
    let text = scene.text(variant);
    simulate(&text, &[], true).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

#[track_caller]
fn close(what: &str, found: f64, expected: f64, size: f64) {
    assert!(
        (found - expected).abs() <= 1e-12 * size,
        "{what} is {found:e}, not {expected:e}"
    );
}

/// Σ m x × v about axis `a` of points without affine fields.
fn spin(points: &[&Point], a: usize) -> f64 {
    let (b, c) = ((a + 1) % 3, (a + 2) % 3);
    let of = |p: &&Point| p.mass * (p.position[b] * p.velocity[c] - p.position[c] * p.velocity[b]);
    points.iter().map(of).sum()
}

#[test]
fn a_body_has_the_sums_over_its_own_points() {
    for dimension in 1..=3 {
        let run = run(
            &two_boxes(dimension, &["light", "heavy"]),
            &variant("flip", "musl"),
        );
        let frames = &run.memory.frames;
        assert_eq!((frames.len() as u64, frames.len()), (run.summary.rows, 31));
        for (row, frame) in frames.iter().enumerate() {
            let mut momentum = [0.0; 3];
            for (body, name) in ["light", "heavy"].iter().enumerate() {
                let points: Vec<&Point> = frame.points.iter().filter(|p| p.body == body).collect();
                let sum = |of: &dyn Fn(&Point) -> f64| points.iter().map(|p| of(p)).sum::<f64>();
                let says = |column: &str| {
                    let column = run.column(&format!("body_{name}"), column);
                    *column.get(row).unwrap_or(&f64::NAN)
                };
                let mass = sum(&|p| p.mass);
                close("time", says("time"), frame.time, 1.0);
                close("mass", says("mass"), mass, mass);
                let volume = sum(&|p| p.initial_volume * p.volume_ratio);
                close("volume", says("volume"), volume, volume);
                for (a, axis) in AXES.iter().enumerate().take(dimension) {
                    let given = sum(&|p| p.mass * p.velocity[a]);
                    momentum[a] += given;
                    let says = |name: &str| says(&format!("{name}_{axis}"));
                    close("momentum", says("momentum"), given, 10.0 * mass);
                    close("velocity", says("velocity"), given / mass, 10.0);
                    let position = sum(&|p| p.mass * p.position[a]) / mass;
                    close("position", says("position"), position, 10.0);
                }
                let turns = [0..0, 2..3, 0..3][dimension - 1].clone();
                for a in turns {
                    let found = says(&format!("angular_momentum_{}", AXES[a]));
                    close("angular momentum", found, spin(&points, a), 100.0 * mass);
                }
            }
            // the summary adds up both bodies, at the start and at the end
            for (at, told) in [
                (0, &run.summary.momentum[0]),
                (30, &run.summary.momentum[1]),
            ] {
                if row == at {
                    assert_eq!(told.len(), dimension);
                    (0..dimension).for_each(|a| close("sum", told[a], momentum[a], 100.0));
                }
            }
            let all = |of: &dyn Fn(&Point) -> f64| frame.points.iter().map(of).sum::<f64>();
            let square = |v: &[f64; 3]| v.iter().map(|v| v * v).sum::<f64>();
            let height = |x: &[f64; 3]| -> f64 { (0..dimension).map(|a| GRAVITY[a] * x[a]).sum() };
            let says = |column: &str| run.column("energy", column)[row];
            let kinetic = all(&|p| 0.5 * p.mass * square(&p.velocity));
            close("kinetic energy", says("kinetic"), kinetic, kinetic);
            let potential = all(&|p| -p.mass * height(&p.position));
            close("potential energy", says("potential"), potential, 1e3);
            let total = kinetic + says("elastic") + potential;
            close("total energy", says("total"), total, 1e3);
            // nothing comes in or goes out but by the method
            let lost = run.column("energy", "total")[0] - total;
            close("lost by the method", says("numerical"), lost, 1e3);
        }
    }
}

/// Each of two bodies that never come near each other moves as it does alone, and accounts add up.
#[test]
fn two_bodies_have_the_energies_of_both() {
    for dimension in 1..=3 {
        for (transfer, update) in [("apic", "usl"), ("flip", "musl")] {
            let run =
                |bodies: &[&str]| run(&two_boxes(dimension, bodies), &variant(transfer, update));
            let (both, light, heavy) = (run(&["light", "heavy"]), run(&["light"]), run(&["heavy"]));
            for column in ["kinetic", "elastic", "potential", "numerical", "total"] {
                let of = |run: &Recorded| run.column("energy", column);
                let (found, one, other) = (of(&both), of(&light), of(&heavy));
                assert_eq!(found.len(), 31);
                for row in 0..found.len() {
                    close(column, found[row], one[row] + other[row], 1e3);
                }
                let last = |column: &[f64]| column[30].abs();
                assert!(
                    last(&one) > 1e-6 && last(&other) > 1e-6,
                    "{column}: nothing to see"
                );
            }
        }
    }
}

#[test]
fn a_probe_follows_its_point_wherever_it_is_stored() {
    for dimension in 1..=3 {
        let mut scene = two_boxes(dimension, &["light", "heavy"]);
        let place = list(dimension, [9.4, 9.1, 9.3]);
        scene.rest += &format!(
            "[[probe]]\nname = \"near\"\nbody = \"heavy\"\nnear = {place}\n\
             [[probe]]\nname = \"first\"\nbody = \"light\"\nparticle = 2\n"
        );
        let run = run(&scene, &variant("apic", "usl"));
        let nearest = |point: &&Point| {
            let away = |a: usize| (point.position[a] - [9.4, 9.1, 9.3][a]).powi(2);
            (0..dimension).map(away).sum::<f64>()
        };
        let start = run.memory.frames[0].points.iter();
        let near = start
            .filter(|p| p.body == 1)
            .min_by(|p, q| nearest(p).total_cmp(&nearest(q)));
        let near = near.expect("points").id;
        let mut stressed = 0.0_f64;
        for (row, frame) in run.memory.frames.iter().enumerate() {
            for (name, body, id) in [("near", 1, near), ("first", 0, 2)] {
                let mut of = frame.points.iter().filter(|p| (p.body, p.id) == (body, id));
                let point = of.next().expect("the point");
                let says = |column: &str| {
                    let column = run.column(&format!("probe_{name}"), column);
                    *column.get(row).unwrap_or(&f64::NAN)
                };
                assert_eq!(says("time"), frame.time);
                for a in 0..dimension {
                    assert_eq!(says(&format!("position_{}", AXES[a])), point.position[a]);
                    assert_eq!(says(&format!("velocity_{}", AXES[a])), point.velocity[a]);
                    for b in a..dimension {
                        let column = format!("stress_{}{}", AXES[a], AXES[b]);
                        assert_eq!(says(&column), point.stress[a][b], "{dimension}D {column}");
                        stressed = stressed.max(point.stress[a][b].abs());
                    }
                }
            }
        }
        assert!(stressed > 0.1, "{dimension}D: nothing to see");
    }
}

/// A ring that grows and is flattened evenly, v = (a r, b z), has after one step F = diag(1 + a Δt, 1 + b Δt, 1 + a Δt): its stress along
/// the hoop is that along the radius, σ = [μ(F Fᵀ − I) + λ ln J I] / J.
#[test]
fn an_even_growth_of_a_ring_gives_the_same_stress_along_radius_and_hoop() {
    let text = |frame: &str| {
        format!(
            "dimension = 2\nplane = \"axisymmetric\"\n[time]\nend = 0.1\nstep = 0.1\n\
             [grid]\nmin = [0, 0]\nmax = [4, 4]\ncell_size = 0.25\n\
             [method]\nbasis = \"quadratic\"\ntransfer = \"apic\"\nupdate = \"usl\"\nframe = \"{frame}\"\n\
             [material.stuff]\ndensity = 1\nneo_hookean = {{ youngs_modulus = 2.6, poissons_ratio = 0.3 }}\n\
             [[body]]\nname = \"ring\"\nmaterial = \"stuff\"\nshape.box = {{ min = [1, 1], max = [3, 3] }}\n\
             velocity = [\"3 * x\", \"-2 * y\"]\n[output]\nevery = 0.1\n\
             [[probe]]\nname = \"middle\"\nbody = \"ring\"\nnear = [2, 2]\n"
        )
    };
    let (mu, lambda) = (1.0, 2.6 * 0.3 / (1.3 * 0.4));
    let stretches = [1.3_f64, 0.8, 1.3];
    let j: f64 = stretches.iter().product();
    let [radial, axial, hoop] = stretches.map(|s| (mu * (s * s - 1.0) + lambda * j.ln()) / j);
    for frame in ["updated", "total"] {
        let text = text(frame);
        let run = simulate(&text, &[], true).unwrap_or_else(|error| panic!("{error}"));
        let last = |column: &str| run.column("probe_middle", column)[1];
        close("radial stress", last("stress_xx"), radial, 1.0);
        close("axial stress", last("stress_yy"), axial, 1.0);
        close("hoop stress", last("stress_hoop"), hoop, 1.0);
        for point in &run.memory.frames[1].points {
            close("J", point.volume_ratio, j, 1.0);
            close("hoop stress in pictures", point.stress[2][2], hoop, 1.0);
        }
    }
}

/// A force that first pushes and then brakes leaves a body at rest after its period T: nothing is stored and no work done in the end, but
/// ½ m v² with v = F T/(π m) was turned over in the middle.
#[test]
fn what_was_turned_over_remembers_its_peak() {
    let mut scene = two_boxes(1, &["light"]);
    scene.head = String::new();
    scene.steps = 200;
    scene.rest = scene.rest.replace("3 + 0.4 * (x - 3.5)", "0")
        + "[[load]]\nbody = \"light\"\non.box = { min = [0] }\nforce = [6]\nfactor = \"sin(pi * t / (1 s))\"\n";
    let run = run(&scene, &variant("flip", "musl"));
    let mass = 1.5 * 1.5;
    let peak = 0.5 * mass * (6.0 * 2.0 / (std::f64::consts::PI * mass)).powi(2);
    let kinetic = run.column("energy", "kinetic");
    assert!(kinetic[200] < 1e-3 * peak, "{}", kinetic[200]);
    let told = run.summary.energy.turned_over;
    assert!((told / peak - 1.0).abs() < 1e-3, "{told}, {peak}");
    assert_eq!(run.summary.energy.kinetic, kinetic[200]);
    let work = run.column("energy", "external_work")[200];
    assert_eq!(run.summary.energy.external_work, work);
    assert_eq!(run.summary.recorded, 2.0);
}

/// Sums are taken over parts of a body's points: all of them count.
#[test]
fn a_body_of_many_points_has_all_their_mass() {
    let scene = Scene {
        cells: [9000; 3],
        steps: 1,
        head: String::new(),
        rest: "[[body]]\nname = \"long\"\nmaterial = \"stuff\"\nshape.box = { min = [10], max = [4310.5] }\n\
               velocity = [\"0.25\"]\n"
            .into(),
        ..two_boxes(1, &[])
    };
    let run = run(&scene, &variant("flip", "musl"));
    let mass = 1.5 * 4300.5;
    for (column, exact) in [
        ("mass", mass),
        ("volume", 4300.5),
        ("momentum_x", 0.25 * mass),
    ] {
        close(column, run.column("body_long", column)[0], exact, exact);
    }
    close(
        "middle",
        run.column("body_long", "position_x")[0],
        2160.25,
        1e3,
    );
    let kinetic = run.column("energy", "kinetic")[0];
    close("kinetic energy", kinetic, 0.03125 * mass, mass);
}
