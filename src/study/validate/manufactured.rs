//! Manufactured motions: the answer is chosen first, and the body force that makes it the answer follows.
//!
//! uᵢ = A sin(πXᵢ) sin(cπt + φᵢ) between walls a length 1 apart, φ = (0, π, 0), neo-Hookean: τ = μ(b − I) + λ ln J I. F is diagonal,
//! P = τF⁻ᵀ has Pᵢᵢ = μ(Fᵢᵢ − 1/Fᵢᵢ) + λ ln J/Fᵢᵢ, and as the other stretches do not depend on Xᵢ,
//! ∂Pᵢᵢ/∂Xᵢ = [μ(1 + 1/Fᵢᵢ²) + λ(1 − ln J)/Fᵢᵢ²] ∂²uᵢ/∂Xᵢ², with ∂²uᵢ/∂Xᵢ² = −π²uᵢ and üᵢ = −c²π²uᵢ. Newton's law ρ₀ü = ∂P/∂X + ρ₀b gives
//! b = (π²uᵢ/ρ₀)[μ(1 + 1/Fᵢᵢ²) + λ(1 − ln J)/Fᵢᵢ² − ρ₀c²], which the scenarios write out.
//!
//! What to expect for small A, where no point leaves its cell: second order for linear, gimp and quadratic. A lumped mass
//! matrix costs the cubic basis some of it where its functions are cut off at the walls. At A = 0.05, where the walls' layers are
//! strained by 16 % and points cross cells, forces are sums over points that no longer tile the cells evenly: an error that does
//! not fall with h and in the end rules.

use super::compare::{chart, curve, larger, orders, root_mean};
use super::problem::{SECOND, cell_size, displacement_error};
use super::{Case, CaseError, Expected, Layout, Problem, Recorded, Report, set};
use crate::report::Style;
use std::f64::consts::PI;

const CUBIC: &str = "expected: less than 2, lumped masses where the functions are cut off at the walls are off at first order";
const CROSSING: &str = "expected: points that cross cells leave an error that h does not reduce (Steffen, Kirby and Berzins 2008, doi:10.1002/nme.2360, on quadrature)";

/// Amplitude, m, of a chart's small motion. With 1e-4 the linear basis stops at an error of 1.6e-4 whatever the cells and the step:
/// strained by 3e-4, points tile the cells unevenly by as much.
const TINY: f64 = 1e-6;

/// Small motion, where no point leaves its cell.
pub const SMALL: Problem = Problem {
    name: "manufactured",
    about: "a manufactured motion of neo-Hookean rubber, so small that no point leaves its cell",
    norm: "displacement, relative L2 norm over points and recorded times",
    reference: CASE.reference,
    cells_are: "along each side",
    dimensions: &[1, 2, 3],
    layout: |dimension, cells| layout(dimension, cells, TINY),
    error: |run| against(run, TINY),
    cells: |dimension| match dimension {
        1 => &[8, 16, 32, 64],
        2 => &[8, 16, 32],
        _ => &[4, 8, 16],
    },
    points: &[1, 2, 3],
    doubt: 0.0,
    expected: &[
        Expected { basis: "linear", order: 2.0, source: SECOND },
        Expected { basis: "gimp", order: 2.0, source: SECOND },
        Expected { basis: "quadratic", order: 2.0, source: SECOND },
        Expected { basis: "cubic", order: 1.5, source: CUBIC },
    ],
};

/// Strains of 16 %, where points cross cells.
pub const LARGE: Problem = Problem {
    name: "manufactured_large",
    about: "the manufactured motion with strains of 16 %, where points cross cells",
    layout: |dimension, cells| layout(dimension, cells, 0.05),
    error: |run| against(run, 0.05),
    points: &[2, 3, 4],
    expected: &[
        Expected { basis: "linear", order: 0.0, source: CROSSING },
        Expected { basis: "gimp", order: 0.0, source: CROSSING },
        Expected { basis: "quadratic", order: 0.0, source: CROSSING },
    ],
    ..SMALL
};

/// The case.
pub const CASE: Case = Case {
    name: "manufactured",
    claim: "manufactured motions in 1D, 2D and 3D are met with the order of convergence of each basis",
    reference: "manufactured solution (body force derived in the case file)",
    run,
};

const LINE: &str = include_str!("../../../scenarios/manufactured1d.toml");
const SQUARE: &str = include_str!("../../../scenarios/manufactured2d.toml");
const CUBE: &str = include_str!("../../../scenarios/manufactured3d.toml");
const BASES: [&str; 4] = ["linear", "gimp", "quadratic", "cubic"];
const FINE: [f64; 4] = [1.0 / 8.0, 1.0 / 16.0, 1.0 / 32.0, 1.0 / 64.0];
const COARSE: [f64; 3] = [1.0 / 8.0, 1.0 / 16.0, 1.0 / 32.0];
const COARSEST: [f64; 3] = [1.0 / 4.0, 1.0 / 8.0, 1.0 / 16.0];
const SPEED: f64 = 100.0;

fn layout(dimension: usize, cells: u32, amplitude: f64) -> Layout {
    let text = [LINE, SQUARE, CUBE][dimension - 1];
    Layout {
        text: text.into(),
        overrides: vec![
            cell_size(1.0, cells),
            format!("constants.A=\"{amplitude} m\""),
            "time.end=\"10 ms\"".into(),
            "output.every=\"1 ms\"".into(),
        ],
    }
}

fn against(run: &Recorded, amplitude: f64) -> f64 {
    displacement_error(run, |x, time| {
        let swing = amplitude * (SPEED * PI * time).sin();
        let wave = x.map(|x| swing * (PI * x).sin());
        [wave[0], -wave[1], wave[2]]
    })
}

fn run(report: &mut Report) -> Result<(), CaseError> {
    let small = errors(report, LINE, 1e-4, &FINE, "20 ms")?;
    let large = errors(report, LINE, 0.05, &FINE, "20 ms")?;
    let plane = errors(report, SQUARE, 1e-4, &COARSE, "5 ms")?;
    let cube = errors(report, CUBE, 1e-4, &COARSEST, "5 ms")?;
    for (basis, found) in BASES.iter().zip(&small) {
        judge(
            report,
            &format!("1D, A = 1e-4, {basis}"),
            &FINE,
            found,
            basis,
            1.0,
        );
    }
    for (basis, found) in BASES.iter().zip(&plane) {
        // the error, which starts as t³, has not got far in a quarter of the time
        judge(
            report,
            &format!("2D, A = 1e-4, {basis}"),
            &COARSE,
            found,
            basis,
            0.25,
        );
    }
    for (basis, found) in BASES.iter().zip(&cube) {
        judge(
            report,
            &format!("3D, A = 1e-4, {basis}"),
            &COARSEST,
            found,
            basis,
            0.25,
        );
    }
    at_finite_amplitude(report, &large);
    draw(report, &small, &large, &plane);
    Ok(())
}

/// For every basis and size, the largest of all times of the root mean square of u − u_exact, over the largest of u_exact.
fn errors(
    report: &mut Report,
    text: &str,
    amplitude: f64,
    sizes: &[f64],
    end: &str,
) -> Result<Vec<Vec<f64>>, CaseError> {
    let mut all = Vec::new();
    for basis in BASES {
        let mut found = Vec::new();
        for size in sizes {
            let texts = [format!("{size} m"), format!("{amplitude} m")];
            let overrides = [
                ("method.basis", basis),
                ("grid.cell_size", &texts[0]),
                ("constants.A", &texts[1]),
                ("time.end", end),
            ];
            let motion = report.run_with_frames(text, &set(&overrides))?;
            found.push(error(&motion, amplitude));
        }
        all.push(found);
    }
    Ok(all)
}

fn error(motion: &Recorded, amplitude: f64) -> f64 {
    let frames = &motion.memory.frames;
    let dimension = motion.scenario.dimension;
    let start = &frames[0].points;
    let (mut worst, mut size) = (0.0_f64, 0.0_f64);
    for frame in frames {
        let swing = amplitude * (SPEED * PI * frame.time).sin();
        let exact = |point: usize, axis: usize| {
            let sign = if axis == 1 { -1.0 } else { 1.0 };
            sign * swing * (PI * start[point].position[axis]).sin()
        };
        let sum = |f: &dyn Fn(usize) -> f64| -> f64 {
            (0..dimension).map(|axis| f(axis) * f(axis)).sum()
        };
        let error = root_mean(&frame.points, |i, point| {
            sum(&|axis| point.position[axis] - start[i].position[axis] - exact(i, axis))
        });
        worst = larger(worst, error);
        size = size.max(root_mean(&frame.points, |i, _| sum(&|axis| exact(i, axis))));
    }
    worst / size
}

/// What the error may be: spreading by weights of variance v (in cells: 1/4 for the quadratic, 1/3 for the cubic spline, less for
/// the others) multiplies a wave by 1 − v θ²/2, θ = πh, to the nodes and again back to the points, so that the stiffness that
/// the motion feels is low by 2vθ². The body force is the difference of the stiffness and of the inertia, in proportion to
/// M − ρc², M = λ + 2μ: what the stiffness lacks shows by the factor M/(M − ρc²) = 3.9.
fn largest_error(basis: &str, size: f64) -> f64 {
    // cubic: half as much again for the lumped masses at the walls
    let variance = if basis == "cubic" { 0.5 } else { 0.25 };
    let (lambda, mu) = (0.3 / (1.3 * 0.4), 0.5 / 1.3);
    let modulus = lambda + 2.0 * mu;
    2.0 * variance * (PI * size).powi(2) * modulus / (modulus - 1.0)
}

fn judge(report: &mut Report, name: &str, sizes: &[f64], errors: &[f64], basis: &str, share: f64) {
    let last = sizes.len() - 1;
    report.at_most(
        format!("{name}: displacement error at h = 1/{}", 1.0 / sizes[last]),
        errors[last],
        share * largest_error(basis, sizes[last]),
    );
    // the order is reached from below by some
    let least = if basis == "cubic" { 1.5 } else { 1.9 };
    report.at_least(
        format!("{name}: order of convergence, last two grids"),
        orders(sizes, errors)[last - 1],
        least,
    );
}

fn at_finite_amplitude(report: &mut Report, large: &[Vec<f64>]) {
    for (basis, errors) in BASES.iter().zip(large) {
        let name = format!("1D, A = 0.05, {basis}");
        if *basis == "linear" {
            report.at_least(
                format!("{name}: error at h = 1/64 / at 1/16 (crossing cells: finer is worse)"),
                errors[3] / errors[1],
                1.0,
            );
            continue;
        }
        // twice what small motion may have: the unevenness of the points adds about as much
        report.at_most(
            format!("{name}: displacement error at h = 1/64"),
            errors[3],
            2.0 * largest_error(basis, FINE[3]).max(0.006),
        );
        report.at_least(
            format!("{name}: error at h = 1/8 / at 1/64 (64 if it were second order)"),
            errors[0] / errors[3],
            10.0,
        );
        if *basis != "cubic" {
            let order = orders(&FINE, errors)[2];
            report.at_most(
                format!("{name}: order of convergence, last two grids (degrades)"),
                order,
                1.6,
            );
        }
    }
}

fn draw(report: &mut Report, small: &[Vec<f64>], large: &[Vec<f64>], plane: &[Vec<f64>]) {
    let mut panels = Vec::new();
    for (name, title, sizes, errors) in [
        ("small_1d", "1D, A = 0.0001 (no crossing)", &FINE[..], small),
        (
            "large_1d",
            "1D, A = 0.05 (points cross cells)",
            &FINE[..],
            large,
        ),
        (
            "small_2d",
            "2D, A = 0.0001 (no crossing)",
            &COARSE[..],
            plane,
        ),
    ] {
        let mut columns = vec![("cell_size", sizes)];
        columns.extend(
            BASES
                .iter()
                .zip(errors)
                .map(|(basis, errors)| (*basis, &errors[..])),
        );
        report.table(name, &columns);
        let mut series: Vec<_> = BASES
            .iter()
            .zip(errors)
            .map(|(basis, errors)| curve(*basis, sizes, errors, Style::LineMarkers))
            .collect();
        let slope: Vec<f64> = sizes.iter().map(|h| 4.0 * h * h).collect();
        series.push(curve("second order", sizes, &slope, Style::Dashed));
        let mut panel = chart(
            title,
            "cell size (m)",
            "displacement error / largest",
            series,
        );
        (panel.x_log, panel.y_log) = (true, true);
        panels.push(panel);
    }
    report.chart("errors", panels);
}
