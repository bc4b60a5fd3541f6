//! Bodies of revolution: a thick tube under internal pressure, and a thin ring that breathes.
//!
//! Tube, a ≤ r ≤ b, ends held, Lamé's closed form with q = p a²/(b² − a²): σ_r = q (1 − b²/r²), σ_θ = q (1 + b²/r²),
//! u = q (1 + ν)/E · ((1 − 2ν) r + b²/r). The pressure acts on the innermost layer of points, h/4 inside the wall, and through
//! them on the nodes within a cell or two: with quadratic splines displacements at the loaded rim converge to first order, and stresses alternate from layer to layer
//! close to the wall, which is over after four cells.
//!
//! Ring, radius R, ν = 0: only the hoop carries stress, E u/R: u = v₀/ω sin ωt with ω = √(E/ρ)/R.

use super::compare::root_mean;
use super::history::{frequency_near, from_start, largest, points, scaled};
use super::problem::displacement_error;
use super::{Case, CaseError, Layout, Problem, Report, rms, set};
use crate::report::{LineChart, Series, Style};
use std::f64::consts::{PI, TAU};

/// The case.
pub const CASE: Case = Case {
    name: "axisymmetric",
    claim: "a thick tube under pressure takes Lamé's state, and a thin ring breathes with its own period",
    reference: "closed forms: Lamé's thick cylinder; the ring's one-mass oscillator",
    run,
};

/// The tube.
pub const PROBLEM: Problem = Problem {
    name: "axisymmetric",
    about: "a long thick tube, half a section of it in an axisymmetric scene, widens under a pressure in its bore",
    norm: "displacement at rest, relative L2 norm",
    reference: "closed form: Lamé's thick cylinder in plane strain",
    cells_are: "over the wall of the tube",
    dimensions: &[2],
    layout: |_, cells| {
        let h = (OUTER - INNER) / f64::from(cells);
        let (low, high) = (INNER - 2.0 * h, OUTER + 2.0 * h);
        Layout {
            text: TUBE.into(),
            overrides: vec![
                format!("grid={{ min=[{low:?}, 0.0], max=[{high:?}, {:?}], cell_size={h:?} }}", 2.0 * h),
                format!("body[0].shape.box.max=[{OUTER:?}, {:?}]", 2.0 * h),
                "output.every=\"1 ms\"".into(),
            ],
        }
    },
    error: |run| {
        displacement_error(run, |&[radius, ..], time| {
            let moved = if time == 0.0 { 0.0 } else { Layer::exact(radius).displacement };
            [moved, 0.0, 0.0]
        })
    },
    cells: |_| &[5, 10, 20, 40],
    points: &[1, 2],
    doubt: 0.0,
    expected: &[],
};

/// The stresses of the tube.
pub const STRESS: Problem = Problem {
    name: "axisymmetric_stress",
    about: "stresses at rest in the wall of a long thick tube under pressure, in an axisymmetric scene",
    norm: "radial and hoop stress at rest, relative L2 norm over points",
    error: |run| {
        let frames = &run.memory.frames;
        let (start, end) = (&frames[0].points, &frames[frames.len() - 1].points);
        let exact = |i: usize| Layer::exact(start[i].position[0]);
        let error = root_mean(end, |i, point| {
            let (exact, stress) = (exact(i), point.stress);
            (stress[0][0] - exact.radial).powi(2) + (stress[2][2] - exact.hoop).powi(2)
        });
        error / root_mean(end, |i, _| exact(i).radial.powi(2) + exact(i).hoop.powi(2))
    },
    ..PROBLEM
};

const TUBE: &str = include_str!("../../../scenarios/thick_cylinder.toml");
const RING: &str = include_str!("../../../scenarios/ring.toml");

const YOUNG: f64 = 210e9;
const POISSON: f64 = 0.3;
const INNER: f64 = 0.1;
const OUTER: f64 = 0.2;
/// q = p a²/(b² − a²), Pa.
const Q: f64 = 1e6 / 3.0;

fn run(report: &mut Report) -> Result<(), CaseError> {
    let mut panels = tube(report)?;
    panels.push(ring(report)?);
    report.chart("axisymmetric", panels);
    Ok(())
}

/// The state of one layer of points.
struct Layer {
    radius: f64,
    displacement: f64,
    radial: f64,
    hoop: f64,
}

impl Layer {
    fn exact(radius: f64) -> Self {
        let square = (OUTER / radius).powi(2);
        let shape = (1.0 - 2.0 * POISSON) + square;
        Self {
            radius,
            displacement: Q * (1.0 + POISSON) / YOUNG * shape * radius,
            radial: Q * (1.0 - square),
            hoop: Q * (1.0 + square),
        }
    }
}

fn tube(report: &mut Report) -> Result<Vec<LineChart>, CaseError> {
    let mut errors = Vec::new();
    let mut finest = Vec::new();
    for h in [10e-3, 5e-3] {
        let run = report.run_with_frames(TUBE, &set(&[("grid.cell_size", &format!("{h:e}"))]))?;
        let frames = &run.memory.frames;
        let (first, end) = (&frames[0], &frames[frames.len() - 1]);
        // one row of points along the radius stands for all
        let height = first.points[0].position[1];
        let row = first
            .points
            .iter()
            .zip(&end.points)
            .filter(|(start, _)| (start.position[1] - height).abs() < 1e-9);
        let layers: Vec<Layer> = row
            .map(|(start, point)| Layer {
                radius: start.position[0],
                displacement: point.position[0] - start.position[0],
                radial: point.stress[0][0],
                hoop: point.stress[2][2],
            })
            .collect();
        let worst = |error: &dyn Fn(&Layer, &Layer) -> f64, from: f64| {
            let inside = layers.iter().filter(|layer| layer.radius > from);
            largest(
                &inside
                    .map(|layer| error(layer, &Layer::exact(layer.radius)))
                    .collect::<Vec<_>>(),
            )
        };
        errors.push([
            worst(
                &|found, exact| found.displacement / exact.displacement - 1.0,
                0.0,
            ),
            worst(
                &|found, exact| found.hoop / exact.hoop - 1.0,
                INNER + 4.0 * h,
            ),
            worst(
                &|found, exact| (found.radial - exact.radial) / Q,
                INNER + 4.0 * h,
            ),
        ]);
        finest = layers;
    }
    let [coarse, fine] = [errors[0], errors[1]];
    // the pressure acts on the face: half a spacing beside it would be 1.3 % of a with the coarse cells. A wrong hoop strain, or
    // a force per radian, is off by tens of per cent.
    report.at_most(
        "tube, cells of 10 mm: displacement, largest relative error",
        coarse[0],
        0.004,
    );
    report.at_most(
        "tube, cells of 5 mm: displacement, largest relative error",
        fine[0],
        0.002,
    );
    report.at_most(
        "tube, cells of 5 mm: hoop stress beyond four cells, largest relative error",
        fine[1],
        0.015,
    );
    report.at_most(
        "tube, cells of 5 mm: radial stress beyond four cells, largest error / q",
        fine[2],
        0.05,
    );
    let exact: Vec<Layer> = finest
        .iter()
        .map(|layer| Layer::exact(layer.radius))
        .collect();
    let column =
        |layers: &[Layer], of: fn(&Layer) -> f64| layers.iter().map(of).collect::<Vec<f64>>();
    let radius = column(&finest, |layer| layer.radius);
    let names = ["displacement", "radial_stress", "hoop_stress"];
    let values: [fn(&Layer) -> f64; 3] = [
        |layer| layer.displacement,
        |layer| layer.radial,
        |layer| layer.hoop,
    ];
    let computed = values.map(|of| column(&finest, of));
    let closed = values.map(|of| column(&exact, of));
    let labels = names.map(|name| [format!("{name}_computed"), format!("{name}_exact")]);
    let mut table: Vec<(&str, &[f64])> = vec![("radius", &radius)];
    for i in 0..3 {
        table.push((&labels[i][0], &computed[i]));
        table.push((&labels[i][1], &closed[i]));
    }
    report.table("tube", &table);
    let millimetres = scaled(&radius, 1e3);
    let curve = |name: &str, values: &[f64], factor: f64, style| {
        Series::new(name, points(&millimetres, &scaled(values, factor)), style)
    };
    let chart = |title: &str, y_label: &str, series| LineChart {
        title: title.into(),
        x_label: "radius (mm)".into(),
        y_label: y_label.into(),
        series,
        ..LineChart::default()
    };
    Ok(vec![
        chart(
            "Tube: displacement",
            "displacement (µm)",
            vec![
                curve("computed", &computed[0], 1e6, Style::Markers),
                curve("Lamé", &closed[0], 1e6, Style::Dashed),
            ],
        ),
        chart(
            "Tube: stress",
            "stress (MPa)",
            vec![
                curve("hoop", &computed[2], 1e-6, Style::Markers),
                curve("radial", &computed[1], 1e-6, Style::Markers),
                curve("Lamé", &closed[2], 1e-6, Style::Dashed),
                curve("", &closed[1], 1e-6, Style::Dashed),
            ],
        ),
    ])
}

fn ring(report: &mut Report) -> Result<LineChart, CaseError> {
    let run = report.run(RING, &[])?;
    let (omega, speed) = (10.0, 1e-3);
    let (time, radius) = (
        run.column("body_ring", "time"),
        run.column("body_ring", "position_x"),
    );
    let displacement = from_start(&radius);
    let exact: Vec<f64> = time
        .iter()
        .map(|t| speed / omega * (omega * t).sin())
        .collect();
    let amplitude = speed / omega;
    // steps of ω Δt = 2e-3 put the phase off by half of that, and a ring 2 % thick is no line: (thickness/R)²/12 = 3e-5
    report.at_most(
        "ring, 10 periods: displacement, rms error / amplitude",
        rms(&displacement, &exact) / amplitude,
        5e-3,
    );
    let period = TAU / omega;
    let found = 1.0 / frequency_near(&time, &displacement, 1.0 / period);
    report.close(
        "ring: period / (2 pi R sqrt(density / E))",
        found / period,
        1.0,
        5e-4,
    );
    let (kinetic, elastic) = (
        run.column("energy", "kinetic"),
        run.column("energy", "elastic"),
    );
    // ½ ρ V v², V = 2π R · 4e-4 m²: rings of points weigh what their circles do
    let start = 0.5 * TAU * 4e-4 * speed * speed;
    report.close(
        "ring: kinetic energy at the start / exact",
        kinetic[0] / start,
        1.0,
        1e-12,
    );
    let total: Vec<f64> = kinetic
        .iter()
        .zip(&elastic)
        .map(|(k, u)| (k + u) / start - 1.0)
        .collect();
    // the ripple of staggered steps, ω Δt/2, no more
    report.at_most(
        "ring, 10 periods: largest change of energy / energy",
        largest(&total),
        3e-3,
    );
    report.close(
        "ring: largest elastic energy / energy",
        largest(&elastic) / start,
        1.0,
        3e-3,
    );
    report.table(
        "ring",
        &[
            ("time", &time),
            ("computed", &displacement),
            ("exact", &exact),
        ],
    );
    let shown = time.partition_point(|t| *t < 2.0 * PI * 0.4);
    let micro = |values: &[f64]| points(&time[..shown], &scaled(&values[..shown], 1e6));
    Ok(LineChart {
        title: "Ring: first four periods".into(),
        x_label: "time (s)".into(),
        y_label: "displacement (µm)".into(),
        series: vec![
            Series::new("computed", micro(&displacement), Style::Line),
            Series::new("closed form", micro(&exact), Style::Dashed),
        ],
        ..LineChart::default()
    })
}
