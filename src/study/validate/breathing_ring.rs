//! A thick ring in plane strain, cut out of a square lattice of points, breathes: its rims are free of traction and follow no grid line.
//!
//! Small radial motion u(r) sin ωt obeys (λ + 2μ) (u″ + u′/r − u/r²) + ρω² u = 0 with σ_r = (λ + 2μ) u′ + λ u/r = 0 at both rims.
//! The answer is Bessel's; here the equation is integrated by the Runge–Kutta method from the inner rim with u = 1, and ω is where
//! the outer rim is free. A thin ring of radius R would breathe with √(E′/ρ)/R, E′ = E/(1 − ν²).
//!
//! The staircase of the rims is no worse than a cell, and what it adds at one place it takes at another: the frequency converges with
//! the cells, not evenly.

use super::compare::{chart, curve, larger};
use super::history::frequency_near;
use super::{Case, CaseError, Layout, Problem, Recorded, Report};
use crate::observe::Frame;
use crate::report::Style;
use std::f64::consts::{PI, TAU};

/// The case.
pub const CASE: Case = Case {
    name: "breathing_ring",
    claim: "a thick ring with free curved rims breathes with the frequency of elasticity in plane strain",
    reference: "radial equation of motion, integrated (derived in the case file)",
    run,
};

/// Four periods.
pub const PROBLEM: Problem = Problem {
    name: "breathing_ring",
    about: "a thick ring with free rims, which follow no grid line, breathes for four periods in plane strain",
    norm: "frequency of the mean outward displacement, relative",
    reference: CASE.reference,
    cells_are: "over the wall of the ring",
    dimensions: &[2],
    layout: |_, cells| Layout {
        text: scenario((RIMS[1] - RIMS[0]) / f64::from(cells), omega()),
        overrides: Vec::new(),
    },
    error: |run| (found(run, omega()).0 / omega() - 1.0).abs(),
    cells: |_| &[4, 6, 8, 12],
    points: &[2, 3],
    doubt: 0.0,
    expected: &[],
};

/// Rims, m.
const RIMS: [f64; 2] = [0.75, 1.25];
const YOUNG: f64 = 1.0;
const POISSON: f64 = 0.3;
const SPEED: f64 = 1e-6;

fn run(report: &mut Report) -> Result<(), CaseError> {
    let omega = omega();
    let thin = (YOUNG / (1.0 - POISSON * POISSON)).sqrt();
    // the thin ring's section is no line: (H/R)²/12 = 2 % and as much again
    report.close(
        "equations: frequency / thin ring's",
        omega / thin,
        1.0,
        2.0 * 0.25 / 12.0,
    );
    let sizes = [0.125, 0.0625, 0.03125];
    let mut errors = Vec::new();
    let mut panels = Vec::new();
    for cell in sizes {
        let run = report.run_with_frames(&scenario(cell, omega), &[])?;
        let (found, time, breath) = found(&run, omega);
        errors.push(found / omega - 1.0);
        if cell == sizes[2] {
            let exact: Vec<f64> = time
                .iter()
                .map(|t| SPEED / omega * (omega * t).sin())
                .collect();
            let micro = |values: &[f64]| values.iter().map(|x| 1e6 * x).collect::<Vec<_>>();
            report.table(
                "breath",
                &[("time", &time), ("computed", &breath), ("exact", &exact)],
            );
            panels.push(chart(
                "Mean outward displacement",
                "time (s)",
                "displacement (µm)",
                vec![
                    curve("computed", &time, &micro(&breath), Style::Line),
                    curve("exact frequency", &time, &micro(&exact), Style::Dashed),
                ],
            ));
            let wrong: Vec<f64> = breath
                .iter()
                .zip(&exact)
                .map(|(a, b)| (a - b).abs())
                .collect();
            let worst = wrong.iter().copied().fold(0.0, larger);
            report.at_most(
                "16 cells over the wall: largest error of the displacement / amplitude",
                worst / (SPEED / omega),
                0.1,
            );
        }
    }
    for ((cell, limit), error) in sizes.iter().zip([0.02, 0.01, 0.005]).zip(&errors) {
        report.close(
            format!("cells of {cell} m: frequency / exact"),
            1.0 + error,
            1.0,
            limit,
        );
    }
    let errors: Vec<f64> = errors.iter().map(|error| error.abs()).collect();
    report.table("frequency", &[("cell_size", &sizes), ("error", &errors)]);
    let slope = sizes.map(|h| 0.1 * h);
    let mut panel = chart(
        "Frequency of a breathing ring",
        "cell size (m)",
        "error, relative",
        vec![
            curve(
                "quadratic FLIP, lattice cut at the rims",
                &sizes,
                &errors,
                Style::LineMarkers,
            ),
            curve("first order", &sizes, &slope, Style::Dashed),
        ],
    );
    (panel.x_log, panel.y_log) = (true, true);
    panels.push(panel);
    report.chart("ring", panels);
    Ok(())
}

/// The angular frequency near one, rad/s, of what moves outwards, and that itself: times and displacements.
fn found(run: &Recorded, omega: f64) -> (f64, Vec<f64>, Vec<f64>) {
    let frames = &run.memory.frames;
    let time: Vec<f64> = frames.iter().map(|frame| frame.time).collect();
    let breath = frames.iter().map(|frame| outward(frame, &frames[0]));
    let breath: Vec<f64> = breath.collect();
    let frequency = frequency_near(&time, &breath, omega / TAU);
    (TAU * frequency, time, breath)
}

/// μ and λ.
fn lame() -> (f64, f64) {
    let shear = YOUNG / (2.0 * (1.0 + POISSON));
    (shear, 2.0 * shear * POISSON / (1.0 - 2.0 * POISSON))
}

/// The angular frequency, rad/s, of radial motion without a node.
fn omega() -> f64 {
    let (mut low, mut high) = (0.5, 1.5);
    let sign = traction(low).signum();
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if traction(middle).signum() == sign {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// σ_r at the outer rim of a ring whose inner rim is free, at an angular frequency.
fn traction(omega: f64) -> f64 {
    const STEPS: usize = 1000;
    let (shear, lambda) = lame();
    let stiffness = lambda + 2.0 * shear;
    let [inner, outer] = RIMS;
    let dr = (outer - inner) / STEPS as f64;
    let slope =
        |r: f64, [u, du]: [f64; 2]| [du, u / (r * r) - du / r - omega * omega / stiffness * u];
    let plus = |x: [f64; 2], k: [f64; 2], share: f64| [x[0] + share * k[0], x[1] + share * k[1]];
    let mut x = [1.0, -lambda / stiffness / inner];
    for step in 0..STEPS {
        let r = inner + step as f64 * dr;
        let k1 = slope(r, x);
        let k2 = slope(r + 0.5 * dr, plus(x, k1, 0.5 * dr));
        let k3 = slope(r + 0.5 * dr, plus(x, k2, 0.5 * dr));
        let k4 = slope(r + dr, plus(x, k3, dr));
        let next = |i: usize| x[i] + dr / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
        x = std::array::from_fn(next);
    }
    stiffness * x[1] + lambda * x[0] / outer
}

/// Mean displacement away from the centre.
fn outward(now: &Frame, start: &Frame) -> f64 {
    let (mut sum, mut volume) = (0.0, 0.0);
    for (point, from) in now.points.iter().zip(&start.points) {
        let [x, y, _] = from.position;
        let moved = (point.position[0] - x) * x + (point.position[1] - y) * y;
        sum += from.initial_volume * moved / x.hypot(y);
        volume += from.initial_volume;
    }
    sum / volume
}

fn scenario(cell: f64, omega: f64) -> String {
    let [inner, outer] = RIMS;
    let end = 4.0 * 2.0 * PI / omega;
    format!(
        r#"dimension = 2
time = {{ end = {end:?}, courant = 0.4 }}
grid = {{ min = [-1.5, -1.5], max = [1.5, 1.5], cell_size = {cell:?} }}
method = {{ basis = "quadratic", transfer = "flip", update = "musl" }}
material.ring = {{ density = 1.0, linear_elastic = {{ youngs_modulus = {YOUNG:?}, poissons_ratio = {POISSON:?} }} }}
output.samples = 160
[[body]]
name = "ring"
material = "ring"
shape.difference = {{ of.ball = {{ center = [0.0, 0.0], radius = {outer} }}, minus = [{{ ball = {{ center = [0.0, 0.0], radius = {inner} }} }}] }}
particles_per_cell = 2
velocity = ["{SPEED:?} * x / hypot(x, y) * (1 m) / (1 s)", "{SPEED:?} * y / hypot(x, y) * (1 m) / (1 s)"]
"#
    )
}
