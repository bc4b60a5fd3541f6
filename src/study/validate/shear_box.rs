//! The copper box under a tangential force on its top face: 25 × 25 × 1 mm, base fixed, 14.43 N put on at once.
//!
//! There is no closed form: the box is as high as it is long, so that it bends and shears, and the corners of its base are
//! singular. The references are linear finite elements: the response in three dimensions, and static states and lowest
//! frequencies for plane stress and plane strain. Motions are a ten-thousandth of a cell, so both are linear.
//!
//! A load on the side of a body acts on its face, half a spacing of points outside its uppermost layer. Put on that layer
//! itself, h/4 below the face with two points a cell, the force would shear a box lower by that much: its top would move less
//! by about 1.3 · h/(4L), and so on, to first order in h. Both are run, to see the one error vanish and the other halve.

use super::history::{frequency_near, from_start, largest, last, points, scaled};
use super::{Case, CaseError, Layout, Problem, Recorded, Report, rms, set};
use crate::report::{LineChart, Series, Style};

/// The case.
pub const CASE: Case = Case {
    name: "shear_box",
    claim: "a copper box swings under a sudden tangential force as finite elements say, and settles where they do",
    reference: "linear finite elements: history and static state in 3D, static state and period in plane stress and strain",
    run,
};

/// The box in plane stress, settled.
pub const PROBLEM: Problem = Problem {
    name: "shear_box",
    about: "a copper box in plane stress, its base fixed, settles under a tangential force on its top",
    norm: "displacement of the top at rest, relative",
    reference: "linear finite elements in plane stress",
    cells_are: "over the height of the box",
    dimensions: &[2],
    layout: |_, cells| {
        let h = 0.025 / f64::from(cells);
        let (low, high) = (-2.0 * h, 0.025 + 2.0 * h);
        let mut overrides = settling();
        overrides.extend([
            format!("grid={{ min=[{low:?}, 0.0], max=[{high:?}, {high:?}], cell_size={h:?} }}"),
            "output.every=170e-6".into(),
        ]);
        Layout {
            text: PLANE_STRESS.into(),
            overrides,
        }
    },
    error: |run| (last(&top(run, 14430.0)) / PLANES[0].top - 1.0).abs(),
    cells: |_| &[5, 10, 20, 40],
    points: &[1, 2],
    doubt: 1e-3,
    expected: &[],
};

const BOX: &str = include_str!("../../../scenarios/shear_box.toml");
const LARGE_GRID: &str = include_str!("../../../scenarios/shear_box_large_grid.toml");
const PLANE_STRESS: &str = include_str!("../../../scenarios/shear_box_plane_stress.toml");
const PLANE_STRAIN: &str = include_str!("../../../scenarios/shear_box_plane_strain.toml");
const REFERENCE: &str = include_str!("../../../scenarios/reference/shear_box_fem.csv");

/// What makes a scenario settle: damping near critical for the first mode, 2 · 2π · 15.8 kHz, so that after 170 µs the swing is
/// 1e-6 of what it was; the way does not matter, so steps may be long.
fn settling() -> Vec<String> {
    set(&[
        ("damping.rate", "200000.0"),
        ("time.end", "170e-6"),
        ("time.courant", "0.8"),
    ])
}

fn run(report: &mut Report) -> Result<(), CaseError> {
    let mut panels = history(report)?;
    let (convergence, energy) = reductions(report)?;
    panels.push(convergence);
    panels.push(energy);
    report.chart("response", panels);
    static_state(report)?;
    enlarged_grid(report)
}

/// A 2D scenario with its force on the uppermost layer of points instead of the face.
fn on_the_layer(text: &str, cell_size: f64) -> String {
    let within = format!("on.box = {{ min = [-1.0, {:e}] }}", 0.025 - 0.4 * cell_size);
    text.replace("on.side = \"y_max\"", &within)
}

/// A column of the finite-element history, from its first row at 1 µs.
fn reference(column: &str) -> Vec<f64> {
    let mut lines = REFERENCE.lines().filter(|line| !line.starts_with('#'));
    let header = lines.next().unwrap_or_default();
    let Some(index) = header.split(',').position(|name| name == column) else {
        return Vec::new();
    };
    lines
        .filter_map(|line| line.split(',').nth(index)?.parse().ok())
        .collect()
}

/// Displacement of the loaded face along a constant `force`: the work done so far per unit of it.
fn top(run: &Recorded, force: f64) -> Vec<f64> {
    scaled(&run.column("energy", "external_work"), 1.0 / force)
}

fn mean(run: &Recorded) -> Vec<f64> {
    from_start(&run.column("body_box", "position_x"))
}

/// 200 µs in three dimensions, record by record against finite elements.
fn history(report: &mut Report) -> Result<Vec<LineChart>, CaseError> {
    let force = 14.43;
    let run = report.run(BOX, &[])?;
    let time = reference("time");
    let columns = [
        ("top_mean_displacement_x", top(&run, force)),
        ("mean_displacement_x", mean(&run)),
        ("kinetic", run.column("energy", "kinetic")),
        ("elastic", run.column("energy", "elastic")),
    ];
    let mut pairs = Vec::new();
    for (name, computed) in &columns {
        let (computed, exact) = (computed[1..].to_vec(), reference(name));
        // A period 0.5 % long, from cells of 1/25 of the box, is 0.1 rad of phase after three periods: 3 % rms of the swing,
        // and the energies, which swing twice as fast, have twice of it. A wrong density, modulus or force of 5 % shows.
        let limit = if name.contains("displacement") {
            0.03
        } else {
            0.06
        };
        let error = rms(&computed, &exact) / largest(&exact);
        report.at_most(
            format!("3D, 200 us: {name}, rms error / largest"),
            error,
            limit,
        );
        pairs.push((computed, exact));
    }
    let numerical = run.column("energy", "numerical");
    let work = largest(&run.column("energy", "external_work"));
    // the staggered steps of MUSL make the energy ripple by about ω Δt / 2; a leak would grow beyond it
    report.at_most(
        "3D, 200 us: |K + U - F u| / largest F u",
        largest(&numerical) / work,
        0.01,
    );
    let names = ["top", "mean", "kinetic", "elastic"];
    let labels: Vec<[String; 2]> = names
        .iter()
        .map(|n| [format!("{n}_computed"), format!("{n}_finite_elements")])
        .collect();
    let mut table: Vec<(&str, &[f64])> = vec![("time", &time)];
    for (label, pair) in labels.iter().zip(&pairs) {
        table.push((&label[0], &pair.0));
        table.push((&label[1], &pair.1));
    }
    report.table("history", &table);
    let micro = scaled(&time, 1e6);
    let curves = |chosen: &[usize]| {
        let mut series = Vec::new();
        for &i in chosen {
            series.push(Series::new(
                names[i],
                points(&micro, &scaled(&pairs[i].0, 1e6)),
                Style::Line,
            ));
        }
        for &i in chosen {
            let name = if i == chosen[0] {
                "finite elements"
            } else {
                ""
            };
            series.push(Series::new(
                name,
                points(&micro, &scaled(&pairs[i].1, 1e6)),
                Style::Dashed,
            ));
        }
        series
    };
    let chart = |title: &str, y_label: &str, chosen: &[usize]| LineChart {
        title: title.into(),
        x_label: "time (µs)".into(),
        y_label: y_label.into(),
        series: curves(chosen),
        ..LineChart::default()
    };
    Ok(vec![
        chart("Displacement, 3D", "displacement (µm)", &[0, 1]),
        chart("Energies, 3D", "energy (µJ)", &[2, 3]),
    ])
}

/// A reduction to two dimensions, and what finite elements say of it.
struct Plane {
    name: &'static str,
    text: &'static str,
    /// Static mean displacement of the top, m.
    top: f64,
    /// Static energy of 1 m, J.
    energy: f64,
    /// Lowest frequency, Hz.
    frequency: f64,
}

const PLANES: [Plane; 2] = [
    Plane {
        name: "plane stress",
        text: PLANE_STRESS,
        top: 7.935e-7,
        energy: 5.724e-3,
        frequency: 15838.0,
    },
    Plane {
        name: "plane strain",
        text: PLANE_STRAIN,
        top: 7.452e-7,
        energy: 5.375e-3,
        frequency: 16315.0,
    },
];

/// Plane stress and plane strain: static states and their convergence, a dozen cycles of free swing.
fn reductions(report: &mut Report) -> Result<(LineChart, LineChart), CaseError> {
    let force = 14430.0;
    let sizes = [2.5e-3, 1.25e-3, 0.625e-3];
    let (mut rows, mut series, mut cycles) = (Vec::new(), Vec::new(), Vec::new());
    for plane in &PLANES {
        let name = plane.name;
        let mut settled =
            |report: &mut Report, face: bool, h: f64| -> Result<[f64; 2], CaseError> {
                let text = if face {
                    plane.text.to_string()
                } else {
                    on_the_layer(plane.text, h)
                };
                let cell = format!("{h:e}");
                let run = report.run(
                    &text,
                    &[settling(), set(&[("grid.cell_size", &cell)])].concat(),
                )?;
                let found = [
                    last(&top(&run, force)) / plane.top,
                    last(&run.column("energy", "elastic")) / plane.energy,
                ];
                rows.push([
                    f64::from(u8::from(plane.name == "plane strain")),
                    f64::from(u8::from(face)),
                    h,
                    found[0],
                    found[1],
                ]);
                Ok(found)
            };
        let (mut layer, mut face) = (Vec::new(), Vec::new());
        // the finest size takes as long as all else: one plane is enough to see where it goes
        for h in &sizes[..if name == "plane stress" { 3 } else { 2 }] {
            layer.push(settled(report, false, *h)?);
            face.push(settled(report, true, *h)?);
        }
        // Force on the face, cells of 1/20: what is left is the corners, about 1/3 % above and halving with h or faster. A
        // force in the wrong place by half a spacing shows as 2 %.
        report.close(
            format!("{name}, settled: top displacement / reference"),
            face[1][0],
            1.0,
            0.007,
        );
        report.close(
            format!("{name}, settled: energy / reference"),
            face[1][1],
            1.0,
            0.007,
        );
        // Force on the layer: the first-order error in h is taken away by extrapolation from two sizes; what is left is the
        // second order and the corners.
        let extrapolated = |i: usize| 2.0 * layer[1][i] - layer[0][i];
        report.close(
            format!("{name}, force h/4 below: displacement, h -> 0 / reference"),
            extrapolated(0),
            1.0,
            0.01,
        );
        report.close(
            format!("{name}, force h/4 below: energy, h -> 0 / reference"),
            extrapolated(1),
            1.0,
            0.01,
        );
        if let ([_, middle, finest], [_, far, near]) = (&face[..], &layer[..]) {
            // the errors of the corners fall by 2.5 on halving the cells, those of the force's place by 2
            report.at_least(
                format!("{name}, force on the face: energy error, 1.25 mm / 0.625 mm"),
                (middle[1] - 1.0) / (finest[1] - 1.0),
                1.8,
            );
            report.close(
                format!("{name}, force h/4 below: energy error, 1.25 mm / 0.625 mm"),
                (far[1] - 1.0) / (near[1] - 1.0),
                2.0,
                0.2,
            );
        }
        for (label, found) in [("h/4 below", &layer), ("on the face", &face)] {
            let values = sizes
                .iter()
                .zip(found)
                .map(|(h, found)| (h * 1e3, 100.0 * (found[1] - 1.0)));
            series.push(Series::new(
                format!("{name}, force {label}"),
                values.collect(),
                Style::LineMarkers,
            ));
        }

        let run = report.run(plane.text, &[])?;
        let frequency = frequency_near(&run.column("energy", "time"), &mean(&run), plane.frequency);
        // slow by a lumped mass, to second order: 1.7, 0.43, 0.11 % with cells of 2.5, 1.25, 0.625 mm
        report.close(
            format!("{name}, 12 cycles: period / reference"),
            plane.frequency / frequency,
            1.0,
            0.01,
        );
        let (time, numerical) = (
            run.column("energy", "time"),
            run.column("energy", "numerical"),
        );
        let work = largest(&run.column("energy", "external_work"));
        let cycle = (time.len() as f64 / 800e-6 / plane.frequency) as usize;
        let average = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
        let drift = average(&numerical[numerical.len() - cycle..]) - average(&numerical[..cycle]);
        // the ripple of MUSL, ω Δt / 2 for each mode, does not grow: 12 cycles later the mean over a cycle is the same
        report.at_most(
            format!("{name}, 12 cycles: |K + U - F u| / largest F u"),
            largest(&numerical) / work,
            0.01,
        );
        report.at_most(
            format!("{name}, 12 cycles: drift of K + U - F u / largest F u"),
            drift.abs() / work,
            1e-3,
        );
        cycles.push((time, run));
    }
    let column = |i: usize| rows.iter().map(|row| row[i]).collect::<Vec<f64>>();
    report.table(
        "settled",
        &[
            ("plane_strain", &column(0)),
            ("force_on_face", &column(1)),
            ("cell_size", &column(2)),
            ("top_over_reference", &column(3)),
            ("energy_over_reference", &column(4)),
        ],
    );
    let convergence = LineChart {
        title: "Energy of the settled box, 2D".into(),
        x_label: "cell size (mm)".into(),
        y_label: "error (%)".into(),
        x_range: Some([0.0, 2.7]),
        series: [
            series,
            vec![Series::new(
                "finite elements",
                vec![(0.0, 0.0), (2.7, 0.0)],
                Style::Dashed,
            )],
        ]
        .concat(),
        ..LineChart::default()
    };
    let (time, run) = &cycles[0];
    let (time, energy) = (scaled(time, 1e6), |name: &str| {
        scaled(&run.column("energy", name), 1e3)
    });
    let stored = energy("total");
    let balance: Vec<f64> = stored
        .iter()
        .zip(energy("external_work"))
        .map(|(total, work)| total - work)
        .collect();
    let twice = 2.0 * 14430.0 * PLANES[0].top * 1e3;
    let energy = LineChart {
        title: "Twelve cycles, plane stress".into(),
        x_label: "time (µs)".into(),
        y_label: "energy (mJ per m)".into(),
        series: vec![
            Series::new("K + U", points(&time, &stored), Style::Line),
            Series::new("K + U − F u", points(&time, &balance), Style::Line),
            Series::new(
                "0, and F · twice the static u",
                vec![(0.0, 0.0), (800.0, 0.0)],
                Style::Dashed,
            ),
            Series::new("", vec![(0.0, twice), (800.0, twice)], Style::Dashed),
        ],
        ..LineChart::default()
    };
    Ok((convergence, energy))
}

/// The settled box in three dimensions.
fn static_state(report: &mut Report) -> Result<(), CaseError> {
    let force = 14.43;
    let run = report.run(BOX, &settling())?;
    // The reference is given to 0.3 % (its finest two meshes differ by that), and the corners make 0.3 % at this size.
    report.close(
        "3D, settled: top displacement (m)",
        last(&top(&run, force)),
        7.92e-7,
        0.01 * 7.92e-7,
    );
    report.close(
        "3D, settled: mean displacement (m)",
        last(&mean(&run)),
        3.354e-7,
        0.01 * 3.354e-7,
    );
    report.close(
        "3D, settled: elastic energy (J)",
        last(&run.column("energy", "elastic")),
        5.71e-6,
        0.01 * 5.71e-6,
    );
    Ok(())
}

/// The scenarios as they are, in a close grid and in a large one: nothing may come loose, and nothing may change.
fn enlarged_grid(report: &mut Report) -> Result<(), CaseError> {
    let short = set(&[("time.end", "\"70 us\"")]); // beyond a period
    let (close, large) = (report.run(BOX, &short)?, report.run(LARGE_GRID, &short)?);
    let difference = |of: &dyn Fn(&Recorded) -> Vec<f64>| {
        let (a, b) = (of(&close), of(&large));
        rms(&a, &b) / largest(&a)
    };
    // positions count from another corner, so they round differently: 1e-16 of 50 mm beside a motion of 1e-6 m is 1e-11
    report.at_most(
        "grid 45 times as large: change of the mean displacement",
        difference(&mean),
        1e-9,
    );
    report.at_most(
        "grid 45 times as large: change of the elastic energy",
        difference(&|run| run.column("energy", "elastic")),
        1e-9,
    );
    let most = largest(&top(&close, 14.43));
    // cells of 1/25 and a lumped mass: the corners, and a period 0.5 % long
    let exact = largest(&reference("top_mean_displacement_x")[..70]);
    report.close(
        "grid as it is: largest displacement / reference",
        most / exact,
        1.0,
        0.02,
    );
    Ok(())
}
