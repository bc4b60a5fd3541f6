//! Large rotation and shear: the generalised vortex of the literature. The circles of a free ring turn by up to a radian and back, its
//! points shear by up to 6, and its rims, free of traction, are the only thing that holds them together.
//!
//! The motion and the body force that drives it are those of the case `vortex` of `mpm validate`, with A = 1 rad on a ring alone.
//! Points are laid out on circles, or on the square lattice of the grid, whose staircase at the rims has cells with one point
//! or two in them.

use super::findings::{Findings, Sense};
use super::{Failure, Method, Study};
use crate::math::{Matrix, Vector};
use crate::report::{HeatCell, HeatMap};
use crate::run::{Computing, build_with};
use crate::scenario::parse;
use crate::solver::Solver;
use crate::state::{Masses, Particles, State};
use crate::study::validate::CaseError;
use std::f64::consts::PI;

/// The case.
pub const FAILURE: Failure = Failure {
    name: "vortex",
    title: "large rotation and shear: a free ring whose circles turn by up to a radian and back blows up",
    measure: "time until the kinetic energy exceeds 10 times that of the exact motion, or points are lost; fails before the end, 1 s",
    prediction: "the exact motion does not fail",
    run,
};

/// A, rad; T, s.
const ANGLE: f64 = 1.0;
const END: f64 = 1.0;
/// E, Pa; ν; ρ, kg/m³.
const YOUNG: f64 = 1000.0;
const POISSON: f64 = 0.3;
const DENSITY: f64 = 1000.0;
/// Rims, m.
const RIMS: [f64; 2] = [0.75, 1.25];
const COURANT: f64 = 0.3;
/// Kinetic energy over the largest one of the exact motion that counts as blown up.
const BLOWN_UP: f64 = 10.0;
/// Steps after which nobody waits any longer: the exact motion takes some 500, and a step that goes on shrinking has failed.
const MOST_STEPS: usize = 3_000;

/// How the points of a ring are laid out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Seeding {
    Circles,
    Square,
}

impl Seeding {
    fn name(self) -> &'static str {
        match self {
            Self::Circles => "circles",
            Self::Square => "square lattice",
        }
    }
}

const RUNS: [(Seeding, f64); 3] = [
    (Seeding::Circles, 0.1),
    (Seeding::Circles, 0.05),
    (Seeding::Square, 0.1),
];

fn at((seeding, cell): (Seeding, f64)) -> String {
    format!("{}, cells of {cell} m", seeding.name())
}

fn run(study: &Study) -> Result<Findings, CaseError> {
    let points = study.points_or(&[2])[0];
    let mut jobs = Vec::new();
    for method in &study.methods {
        jobs.extend(RUNS.map(|ring| (*method, ring)));
    }
    let fates = study.map(&jobs, |(method, ring)| turn(*method, points, *ring));
    let mut findings = Findings::new("time of failure (s)", Sense::AtLeast, END);
    let mut errors = Vec::new();
    for ((method, ring), fate) in jobs.iter().zip(fates) {
        let fate = fate?;
        findings.push(method, at(*ring), Some(f64::INFINITY), fate.failed);
        errors.push(fate.error);
    }
    let header = vec![
        "basis",
        "transfer",
        "update",
        "frame",
        "points",
        "cell_size",
        "failed",
        "error",
    ];
    let rows = jobs.iter().zip(&findings.rows).zip(&errors);
    let rows = rows.map(|(((method, (seeding, cell)), row), error)| {
        [
            method.basis,
            method.transfer,
            method.update,
            method.frame,
            seeding.name(),
        ]
        .map(String::from)
        .into_iter()
        .chain([*cell, row.measured, *error].map(|x| x.to_string()))
        .collect()
    });
    findings.tables.push(("errors", header, rows.collect()));
    let counts = RUNS.map(|ring| {
        let of = findings.rows.iter().filter(|row| row.at == at(ring));
        let failed = of.clone().filter(|row| !row.survives).count();
        format!("{failed} of {} ({})", of.count(), at(ring))
    });
    findings.shown = format!(
        "Blown up before the end: {}. With points on circles what is left of the motion differs from the exact one at its largest by the error in errors.csv.",
        counts.join(", ")
    );
    let map = HeatMap {
        title: format!(
            "The generalised vortex: a free ring is sheared by up to 6 and back, {points} × {points} points per cell, c Δt/h = 0.3"
        ),
        x_label: "how points are laid out, and size of the cells".into(),
        holds: "lasts for 1 s (error of the displacement at 0.5 s)".into(),
        fails: "blows up (when)".into(),
        columns: RUNS.map(at).into(),
        ..HeatMap::default()
    };
    let rows: Vec<_> = jobs
        .iter()
        .zip(&findings.rows)
        .zip(&errors)
        .map(|((job, row), error)| (job.0, cell(row.measured, *error)))
        .collect();
    findings.draw_maps(study, &map, |method| {
        let of = rows.iter().filter(|row| row.0 == *method);
        of.map(|row| row.1.clone()).collect()
    });
    Ok(findings)
}

fn cell(failed: f64, error: f64) -> HeatCell {
    if failed.is_finite() {
        HeatCell {
            text: format!("{failed:.2} s"),
            fails: true,
            strength: 1.0 - failed / END,
        }
    } else {
        HeatCell {
            text: format!("{:.1} %", 100.0 * error),
            fails: false,
            strength: 1.0 - error,
        }
    }
}

/// What becomes of a ring.
struct Fate {
    /// When it blows up, s; infinite if it does not.
    failed: f64,
    /// Error of the displacement half way, where it is largest: relative L2 norm over the points.
    error: f64,
}

fn turn(method: Method, points: u32, (seeding, cell): (Seeding, f64)) -> Result<Fate, CaseError> {
    let text = scenario(method, points, seeding, cell);
    let scenario = parse("vortex", &text, &[])
        .map_err(CaseError::Input)?
        .scenario;
    let computing = Computing {
        parallel: Some(false),
        instructions: None,
    };
    let mut scene = build_with::<2>(&scenario, &computing);
    seed(&mut scene.state.bodies[0].particles, seeding);
    let places = by_number(&scene.state.bodies[0].particles, |p, row| p.position[row]);
    let (state, solver) = (&mut scene.state, scene.solver.as_mut());
    let mut fate = Fate {
        failed: f64::INFINITY,
        error: f64::NAN,
    };
    if solver.start(state).is_err() {
        fate.failed = 0.0;
        return Ok(fate);
    }
    let most = kinetic(state);
    for target in [0.5 * END, END] {
        if let Err(time) = advance(state, solver, target, most) {
            fate.failed = time;
            return Ok(fate);
        }
        if target < END {
            fate.error = error(&state.bodies[0].particles, &places);
        }
    }
    Ok(fate)
}

/// Goes on until `target`, s.
///
/// # Errors
/// When it blew up, s.
fn advance(
    state: &mut State<2>,
    solver: &mut dyn Solver<2>,
    target: f64,
    most: f64,
) -> Result<(), f64> {
    for _ in 0..MOST_STEPS {
        let left = target - state.time;
        if left <= 1e-9 * END {
            return Ok(());
        }
        let dt = (COURANT * solver.limit(state).crossing_time()).min(left);
        let usable = dt.is_finite() && dt > 0.0;
        if !usable || solver.step(state, dt).is_err() {
            return Err(state.time);
        }
        // what is not a number has blown up, too
        if kinetic(state).partial_cmp(&(BLOWN_UP * most)) != Some(std::cmp::Ordering::Less) {
            return Err(state.time);
        }
    }
    Err(state.time)
}

fn kinetic(state: &State<2>) -> f64 {
    let p = &state.bodies[0].particles;
    (0..p.len())
        .map(|i| 0.5 * p.mass[i] * p.velocity[i].norm_squared())
        .sum()
}

fn by_number<T: Clone>(p: &Particles<2>, of: impl Fn(&Particles<2>, usize) -> T) -> Vec<T> {
    let mut rows: Vec<usize> = (0..p.len()).collect();
    rows.sort_by_key(|row| p.id[*row]);
    rows.iter().map(|row| of(p, *row)).collect()
}

fn error(p: &Particles<2>, places: &[Vector<2>]) -> f64 {
    let (mut wrong, mut size) = (0.0, 0.0);
    let now = by_number(p, |p, row| (p.position[row], p.mass.initial_volume(row)));
    for ((x, volume), start) in now.iter().zip(places) {
        let (sine, cosine) = (ANGLE * profile(start.norm())[0]).sin_cos();
        let turned = Matrix::<2>::new(cosine, -sine, sine, cosine) * start;
        wrong += volume * (x - turned).norm_squared();
        size += volume * (turned - start).norm_squared();
    }
    (wrong / size).sqrt()
}

/// h and h′ at radius r.
fn profile(r: f64) -> [f64; 2] {
    let q = r - 1.0;
    [
        1.0 - 32.0 * q * q + 256.0 * q.powi(4),
        -64.0 * q + 1024.0 * q.powi(3),
    ]
}

/// Bends a strip of points to a ring if they are to lie on circles, and starts their motion: v = ω e_z × x, ω = α̇ at the start.
fn seed(p: &mut Particles<2>, seeding: Seeding) {
    if seeding == Seeding::Circles {
        let strip = std::mem::take(&mut p.mass);
        let volume = |row: usize| strip.initial_volume(row) * p.position[row][1];
        p.mass = Masses::of_volumes(strip.density(), strip.len(), volume);
    }
    for row in 0..p.len() {
        if seeding == Seeding::Circles {
            let (angle, r) = (p.position[row][0], p.position[row][1]);
            let (sine, cosine) = angle.sin_cos();
            p.position[row] = Vector::<2>::new(r * cosine, r * sine);
            if let Some(reference) = p.reference_position.get_mut(row) {
                *reference = p.position[row];
            }
        }
        let x = p.position[row];
        let r = x.norm();
        let [spin, slope] = profile(r).map(|h| ANGLE * PI / END * h);
        p.velocity[row] = Vector::<2>::new(-spin * x[1], spin * x[0]);
        if let Some(field) = p.affine.get_mut(row) {
            let turning = Matrix::<2>::new(0.0, -spin, spin, 0.0);
            *field = turning + Vector::<2>::new(-x[1], x[0]) * x.transpose() * (slope / r);
        }
    }
}

/// The ring. A strip of 2π × 1/2 m whose points will be bent to circles has its angle for x and its radius for y.
fn scenario(method: Method, points: u32, seeding: Seeding, cell: f64) -> String {
    let [inner, outer] = RIMS;
    let (r, angle, shape) = match seeding {
        Seeding::Circles => (
            "(y / (1 m))",
            "(x / (1 m))",
            format!(
                "box = {{ min = [0.0, {inner}], max = [{}, {outer}] }}",
                2.0 * PI
            ),
        ),
        Seeding::Square => (
            "(hypot(x, y) / (1 m))",
            "atan2(y, x)",
            format!(
                "difference = {{ of.ball = {{ center = [0.0, 0.0], radius = {outer} }}, minus = [{{ ball = {{ center = [0.0, 0.0], radius = {inner} }} }}] }}"
            ),
        ),
    };
    let q = format!("({r} - 1)");
    let h = format!("(1 - 32 * {q}^2 + 256 * {q}^4)");
    let slope = format!("(1024 * {q}^3 - 64 * {q})");
    let (sine, cosine) = ("sin(pi * t / (1 s))", "cos(pi * t / (1 s))");
    // squares of the wave speed of shear, of α̇ and of its rate, with T = 1 s
    let wave = YOUNG / (2.0 * (1.0 + POISSON)) / DENSITY;
    let outward = format!(
        "({r} * ({wave} * ({ANGLE} * {sine} * {slope})^2 - ({ANGLE} * pi * {cosine} * {h})^2))"
    );
    let around = format!(
        "({ANGLE} * {sine} * (0 - {r} * pi^2 * {h} - {wave} * (3 * {slope} + {r} * (3072 * {q}^2 - 64))))"
    );
    let turned = format!("({angle} + {ANGLE} * {sine} * {h})");
    format!(
        r#"dimension = 2
time = {{ end = {END:?}, courant = {COURANT} }}
grid = {{ min = [-1.6, -1.6], max = [6.4, 1.6], cell_size = {cell} }}
{}material.rubber = {{ density = {DENSITY}, neo_hookean = {{ youngs_modulus = {YOUNG}, poissons_ratio = {POISSON} }} }}
[[body]]
name = "ring"
material = "rubber"
shape.{shape}
particles_per_cell = {points}
[[load]]
body = "ring"
on.box = {{ min = [-9.0, -9.0], max = [9.0, 9.0] }}
acceleration = ["{outward} * cos{turned} - {around} * sin{turned}", "{outward} * sin{turned} + {around} * cos{turned}"]
"#,
        method.toml()
    )
}
