//! Volumetric locking: near ν = ½ a point may not change its volume, and with the linear basis and several points a cell there
//! are more such constraints than nodes to meet them: the body grows too stiff to bend.
//!
//! A cantilever, 4 × 1 m on cells of ¼ m, plane strain, under a small shear load on its free end that acts at once. Its tip swings
//! to about twice the static deflection; the reference is that of fine finite elements (small strain, clamped, load 1 N on E = 1000
//! Pa): 0.24345 m at ν = 0.3, 0.20095 at 0.49, 0.19666 at 0.499. Half of the first peak, over the reference, is what is measured; a
//! sudden load also excites higher modes, so that 0.9 … 1.1 is as good as it gets.

use super::crossing::bases;
use super::findings::{Drawing, Findings, Sense};
use super::{Failure, Method, Study};
use crate::report::{HeatCell, HeatMap};
use crate::study::validate::{CaseError, simulate};

/// The case.
pub const FAILURE: Failure = Failure {
    name: "locking",
    title: "volumetric locking: a nearly incompressible cantilever is too stiff to bend",
    measure: "half of the first peak of the tip's deflection under a sudden load / static deflection of fine finite elements; fails below 0.8",
    prediction: "small-strain finite elements with the same functions, 2 x 2 points a cell (linear basis; 1 for the others)",
    run,
};

/// Poisson's ratio, static deflection for E = 1000 Pa and an end load of 1 N, m, and the share of it that bilinear finite elements
/// with 2 × 2 points reach on the same cells.
const REFERENCE: [(f64, f64, f64); 3] = [
    (0.3, 0.24345, 0.98),
    (0.49, 0.20095, 0.61),
    (0.499, 0.19666, 0.18),
];
/// Small enough for small strain.
const LOAD: f64 = 0.01;

fn run(study: &Study) -> Result<Findings, CaseError> {
    let points = study.points_or(&[2])[0];
    let kinds: Vec<Kind> = bases(study).iter().flat_map(kinds).collect();
    let jobs: Vec<(&Kind, (f64, f64, f64))> = kinds
        .iter()
        .flat_map(|kind| REFERENCE.map(|reference| (kind, reference)))
        .collect();
    let reached = study.map(&jobs, |(kind, (ratio, deflection, _))| {
        peak(kind, points, *ratio).map(|peak| 0.5 * peak / (LOAD * deflection))
    });
    let mut findings = Findings::new("deflection / exact", Sense::AtLeast, 0.8);
    let mut cells = vec![Vec::new(); kinds.len()];
    for (i, ((kind, (ratio, _, linear)), reached)) in jobs.iter().zip(reached).enumerate() {
        let reached = reached?;
        let predicted = match (&kind.name[..], points) {
            ("linear", 2) => Some(*linear),
            ("linear" | "gimp" | "cpdi", _) => None,
            _ => Some(1.0),
        };
        findings.push(kind.name.clone(), format!("nu = {ratio}"), predicted, reached);
        cells[i / REFERENCE.len()].push(HeatCell {
            text: format!("{:.0} %", 100.0 * reached),
            fails: reached < 0.8,
            strength: ((reached - 0.8).abs() / 0.4).min(1.0),
        });
    }
    let linear = findings.row("linear", "nu = 0.499").map(|row| row.measured);
    let quadratic = findings.row("quadratic", "nu = 0.499").map(|row| row.measured);
    let percent = |x: Option<f64>| x.map_or("-".into(), |x| format!("{:.0} %", 100.0 * x));
    findings.shown = format!(
        "At nu = 0.499 the linear basis reaches {} of the deflection, the quadratic one {}, with {points} x {points} points per cell.",
        percent(linear),
        percent(quadratic)
    );
    findings.drawings.push((
        "",
        Drawing::Map(HeatMap {
            title: format!("Deflection of a cantilever, 16 × 4 cells with {points} × {points} points each, against the exact one"),
            x_label: "Poisson's ratio".into(),
            holds: "bends: 80 % or more".into(),
            fails: "locks".into(),
            columns: REFERENCE.map(|(ratio, ..)| ratio.to_string()).into(),
            rows: kinds.iter().map(|kind| kind.name.clone()).collect(),
            cells,
        }),
    ));
    Ok(findings)
}

/// A basis, and how it is asked for.
struct Kind {
    name: String,
    toml: String,
}

/// A basis as it is, and in its frame with the cure for locking if there is one.
fn kinds(method: &Method) -> Vec<Kind> {
    // FLIP with MUSL neither damps the swing nor minds the linear basis
    let method = Method {
        transfer: "flip",
        update: "musl",
        frame: "updated",
        ..*method
    };
    let plain = Kind {
        name: method.basis.into(),
        toml: method.toml(),
    };
    if method.basis != "linear" {
        return vec![plain];
    }
    let cured = Method {
        frame: "total",
        ..method
    };
    let toml = cured
        .toml()
        .replace("\"linear\"", "{ linear = { b_bar = true } }");
    let name = "linear b_bar, total frame".into();
    vec![plain, Kind { name, toml }]
}

/// The first peak of the tip's deflection, m.
fn peak(kind: &Kind, points: u32, ratio: f64) -> Result<f64, CaseError> {
    // the first period of the beam is 3 s, its half a little more
    let text = format!(
        r#"dimension = 2
time = {{ end = 1.9, courant = 0.5 }}
grid = {{ min = [0.0, -0.5], max = [4.5, 1.5], cell_size = 0.25 }}
{}material.rubber = {{ density = 1.0, linear_elastic = {{ youngs_modulus = 1000.0, poissons_ratio = {ratio:?} }} }}
output.every = 0.02
[[body]]
name = "beam"
material = "rubber"
shape.box = {{ min = [0.0, 0.0], max = [4.0, 1.0] }}
particles_per_cell = {points}
[[boundary]]
name = "clamp"
on.side = "x_min"
condition = "fixed"
[[load]]
name = "end"
body = "beam"
on.side = "x_max"
force = [0.0, {:?}]
[[probe]]
name = "tip"
body = "beam"
near = [4.0, 0.5]
"#,
        kind.toml,
        -LOAD
    );
    let run = simulate(&text, &[], false)?;
    let place = run.column("probe_tip", "position_y");
    let start = place.first().copied().unwrap_or(f64::NAN);
    Ok(place.iter().map(|y| start - y).fold(0.0, f64::max))
}
