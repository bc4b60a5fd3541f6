//! Pictures of a run, drawn from its recorded tables.

use crate::material::Plane;
use crate::observe::{self, Point, Table};
use crate::report::{ColorMap, LineChart, ParticlePlot, Series, Size, Style, panels};
use crate::scenario::Scenario;
use std::io;
use std::path::Path;

/// Every picture that a run may draw.
pub const NAMES: [&str; 4] = ["energy.png", "motion.png", "particles.png", "stress.png"];

/// Curves that one panel can show and still be read.
const MOST_CURVES: usize = 6;
/// Larger tables are not drawn.
const MOST_BYTES: u64 = 200 << 20;
/// What is smaller than this share of the largest is not worth a curve.
const NEGLIGIBLE: f64 = 1e-9;

/// Draws what the tables in `folder` and the frames have to show.
pub fn draw(folder: &Path, scenario: &Scenario, frames: &[observe::Frame]) -> io::Result<()> {
    let strained = energy(folder, scenario)?;
    motion(folder, scenario)?;
    if frames.iter().any(|frame| !frame.points.is_empty()) {
        particles(folder, scenario, frames, strained)?;
    }
    Ok(())
}

/// A recorded table; empty if it has no rows.
fn table(folder: &Path, name: &str) -> io::Result<Table> {
    let path = folder.join(format!("{name}.csv"));
    if std::fs::metadata(&path)?.len() > MOST_BYTES {
        return Err(io::Error::other(format!("{} is too large", path.display())));
    }
    let mut reader = csv::Reader::from_path(&path)?;
    let header = reader.headers()?.iter().map(String::from).collect();
    let mut rows = Vec::new();
    for record in reader.records() {
        let numbers = |text: &str| text.parse().unwrap_or(f64::NAN);
        rows.push(record?.iter().map(numbers).collect());
    }
    Ok(Table { header, rows })
}

fn largest(values: &[f64]) -> f64 {
    let finite = values.iter().filter(|x| x.is_finite());
    finite.fold(0.0, |most, x| most.max(x.abs()))
}

fn points(time: &[f64], values: &[f64]) -> Vec<(f64, f64)> {
    time.iter().copied().zip(values.iter().copied()).collect()
}

/// Stored energies above, what brought and took them below; tells whether there is more than round-off of elastic energy.
fn energy(folder: &Path, scenario: &Scenario) -> io::Result<bool> {
    let table = table(folder, "energy")?;
    let time = table.column("time");
    let relative = |values: Vec<f64>| -> Vec<f64> {
        let first = values.first().copied().unwrap_or(0.0);
        values.iter().map(|x| x - first).collect()
    };
    let kinetic = table.column("kinetic");
    let elastic = table.column("elastic");
    let potential = relative(table.column("potential"));
    let total: Vec<f64> = (0..time.len())
        .map(|i| kinetic[i] + elastic[i] + potential[i])
        .collect();
    let exchanged: Vec<(&str, Vec<f64>)> = [
        ("loads", "external_work", 1.0),
        ("boundaries", "boundary_work", 1.0),
        ("damping", "damping", -1.0),
        ("the method itself", "numerical", -1.0),
    ]
    .map(|(name, column, sign)| {
        let values = table.column(column);
        (name, values.iter().map(|x| sign * x).collect())
    })
    .to_vec();
    let scale = [&kinetic, &elastic, &potential]
        .into_iter()
        .chain(exchanged.iter().map(|(_, values)| values))
        .map(|values| largest(values))
        .fold(0.0, f64::max);
    let matters = |values: &[f64]| largest(values) > NEGLIGIBLE * scale;
    let mut stored = vec![
        Series::new("kinetic", points(&time, &kinetic), Style::Line),
        Series::new("elastic", points(&time, &elastic), Style::Line),
    ];
    let mut total_name = "total";
    if matters(&potential) {
        stored.push(Series::new(
            "potential, from the start",
            points(&time, &potential),
            Style::Line,
        ));
        total_name = "total, from the start";
    }
    stored.push(Series::new(
        total_name,
        points(&time, &total),
        Style::Dashed,
    ));
    let mut charts = vec![LineChart {
        title: format!("{}: stored energy", scenario.title),
        x_label: "time (s)".into(),
        y_label: "energy (J)".into(),
        series: stored,
        ..LineChart::default()
    }];
    let flows: Vec<Series> = exchanged
        .into_iter()
        .filter(|(_, values)| matters(values))
        .map(|(name, values)| Series::new(name, points(&time, &values), Style::Line))
        .collect();
    if !flows.is_empty() {
        charts.push(LineChart {
            title: "Energy brought in since the start by … (negative: taken out)".into(),
            x_label: "time (s)".into(),
            y_label: "energy (J)".into(),
            series: flows,
            ..LineChart::default()
        });
    }
    let height = 450 * charts.len() as u32;
    let size = Size {
        width: 1000,
        height,
    };
    panels(&charts, &folder.join("energy.png"), size)?;
    Ok(largest(&elastic) > 1e-20 * scale)
}

/// Displacement and velocity along each axis: centres of mass of bodies, and probes.
fn motion(folder: &Path, scenario: &Scenario) -> io::Result<()> {
    let mut followed = Vec::new();
    for body in &scenario.bodies {
        let file = format!("body_{}", body.name);
        let label = format!("{}, centre of mass", body.name);
        followed.push((label, table(folder, &file)?));
    }
    for probe in &scenario.probes {
        let file = format!("probe_{}", probe.name);
        let label = format!("probe {}", probe.name);
        followed.push((label, table(folder, &file)?));
    }
    let curves = |column: &str, from_start: bool| -> Vec<(String, Vec<(f64, f64)>)> {
        let curve = |(label, table): &(String, Table)| {
            let values = table.column(column);
            let first = if from_start {
                values.first().copied()
            } else {
                None
            };
            let origin = first.unwrap_or(0.0);
            let moved: Vec<f64> = values.iter().map(|x| x - origin).collect();
            (label.clone(), points(&table.column("time"), &moved))
        };
        followed.iter().take(MOST_CURVES).map(curve).collect()
    };
    let quantities = [
        ("position", "Displacement", "displacement", "m", true),
        ("velocity", "Velocity", "velocity", "m/s", false),
    ];
    let axes = &["x", "y", "z"][..scenario.dimension];
    let mut charts: Vec<(f64, LineChart)> = Vec::new();
    for axis in axes {
        let mut size = 0.0_f64;
        let mut pair = Vec::new();
        for (column, title, label, unit, from_start) in quantities {
            let curves = curves(&format!("{column}_{axis}"), from_start);
            let highest = curves.iter().flat_map(|(_, points)| points);
            let highest = highest.fold(0.0, |most: f64, point| most.max(point.1.abs()));
            if from_start {
                size = highest;
            }
            let series = curves
                .into_iter()
                .map(|(name, points)| Series::new(name, points, Style::Line));
            pair.push(LineChart {
                title: format!("{title} along {axis}"),
                x_label: "time (s)".into(),
                y_label: format!("{label} ({unit})"),
                series: series.collect(),
                ..LineChart::default()
            });
        }
        charts.extend(pair.into_iter().map(|chart| (size, chart)));
    }
    let most = charts.iter().map(|(size, _)| *size).fold(0.0, f64::max);
    // an axis along which nothing moves says nothing
    let mut shown: Vec<LineChart> = charts
        .into_iter()
        .filter(|(size, _)| *size >= 1e-6 * most)
        .map(|(_, chart)| chart)
        .collect();
    if let Some(first) = shown.first_mut() {
        let hidden = followed.len().saturating_sub(MOST_CURVES);
        let note = match hidden {
            0 => String::new(),
            hidden => format!(" ({hidden} more in the tables)"),
        };
        first.title = format!("{}{note}", first.title);
    }
    let rows = shown.len().div_ceil(2) as u32;
    let size = Size {
        width: 1200,
        height: 420 * rows,
    };
    panels(&shown, &folder.join("motion.png"), size)
}

/// The points in the x–y plane at a few times, by speed and by stress.
fn particles(
    folder: &Path,
    scenario: &Scenario,
    frames: &[observe::Frame],
    strained: bool,
) -> io::Result<()> {
    let total: usize = scenario
        .bodies
        .iter()
        .enumerate()
        .map(|(index, _)| crate::scenario::body_point_count(scenario, index) as usize)
        .sum();
    // fewer points are drawn larger, so that bodies keep their look
    let shown = frames[0].points.len().max(1);
    let thinned = (total as f64 / shown as f64).powf(1.0 / scenario.dimension as f64);
    let per_cell = |body: &crate::scenario::BodySpec| body.particles_per_cell[0];
    let per_cell = scenario.bodies.iter().map(per_cell).min().unwrap_or(1);
    let size = scenario.grid.cell_size / f64::from(per_cell) * thinned;
    let speed = |point: &Point| point.velocity.iter().map(|v| v * v).sum::<f64>().sqrt();
    let plot = |label: String, value: &dyn Fn(&Point) -> f64| ParticlePlot {
        title: scenario.title.clone(),
        x_label: if scenario.plane == Plane::Axisymmetric {
            "r (m)".into()
        } else {
            "x (m)".into()
        },
        y_label: if scenario.plane == Plane::Axisymmetric {
            "z (m)".into()
        } else {
            "y (m)".into()
        },
        value_label: label,
        particle_size: size,
        color_map: ColorMap::Viridis,
        frames: frames.iter().map(|frame| flat(frame, value)).collect(),
        ..ParticlePlot::default()
    };
    plot("speed (m/s)".into(), &speed).write(&folder.join("particles.png"))?;
    if strained {
        let (label, measure) = stress_measure(scenario);
        plot(label.into(), &measure).write(&folder.join("stress.png"))?;
    }
    Ok(())
}

/// The frame as seen from high z.
fn flat(frame: &observe::Frame, value: &dyn Fn(&Point) -> f64) -> crate::report::Frame {
    let mut points: Vec<&Point> = frame.points.iter().collect();
    points.sort_by(|a, b| a.position[2].total_cmp(&b.position[2]));
    crate::report::Frame {
        label: format!("t = {:.4} s", Short(frame.time)),
        points: points
            .iter()
            .map(|p| [p.position[0], p.position[1]])
            .collect(),
        values: Some(points.iter().map(|p| value(p)).collect()),
    }
}

/// A number in few characters.
struct Short(f64);

impl std::fmt::Display for Short {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let x = self.0;
        if x == 0.0 || (1e-3..1e5).contains(&x.abs()) {
            // as many decimals as are not zero
            let text = format!("{x:.4}");
            write!(f, "{}", text.trim_end_matches('0').trim_end_matches('.'))
        } else {
            write!(f, "{x:.3e}")
        }
    }
}

/// The stress to show. In plane strain the stress across the plane is not recorded, which von Mises' would need.
fn stress_measure(scenario: &Scenario) -> (&'static str, fn(&Point) -> f64) {
    if scenario.dimension == 2 && scenario.plane == Plane::Strain {
        ("largest shear stress in the plane (Pa)", |point| {
            let s = &point.stress;
            (0.5 * (s[0][0] - s[1][1])).hypot(s[0][1])
        })
    } else {
        ("von Mises stress (Pa)", |point| {
            let s = &point.stress;
            let normal = (s[0][0] - s[1][1]).powi(2)
                + (s[1][1] - s[2][2]).powi(2)
                + (s[2][2] - s[0][0]).powi(2);
            let shear = s[0][1] * s[0][1] + s[1][2] * s[1][2] + s[0][2] * s[0][2];
            (0.5 * normal + 3.0 * shear).sqrt()
        })
    }
}
