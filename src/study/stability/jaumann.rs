//! The Jaumann rate in large shear. A rate law that turns with the spin W lets its stress go round with it: in simple shear γ
//! its shear stress is G sin γ, which falls beyond γ = π/2 and changes its sign at π. That is the law's exact answer, no error
//! of the method. Logarithmic strain (Hencky) gives 2G asinh(γ/2)/√(1 + γ²/4), which falls beyond γ = 3.018; the others never do.

use super::findings::{Drawing, Findings, Sense};
use super::{Failure, Study};
use crate::material::LawChoice;
use crate::report::{LineChart, Series, Style};
use crate::scenario::parse;
use crate::study::validate::{CaseError, simulate};

/// The case.
pub const FAILURE: Failure = Failure {
    name: "jaumann",
    title: "rate laws in large shear: the stress of the Jaumann rate oscillates",
    measure: "shear at which the shear stress of a block under simple shear is highest (searched to 4); fails below 2",
    prediction: "closed forms of the laws: pi/2 for the Jaumann rate, 3.018 for Hencky's law, none for the others",
    run,
};

const MOST: f64 = 4.0;

fn run(study: &Study) -> Result<Findings, CaseError> {
    let empty = |name: &&&str| parse("law", &scenario(name), &[]).is_ok();
    // a law that needs more than two elastic constants has no place here
    let laws: Vec<&str> = LawChoice::NAMES.iter().filter(empty).copied().collect();
    let mut findings = Findings::new("shear at the peak", Sense::AtLeast, 2.0);
    let mut series = Vec::new();
    for result in study.map(&laws, |law| shear(law)) {
        let (law, curve) = result?;
        let peak = curve
            .windows(2)
            .find(|pair| pair[1].1 <= pair[0].1)
            .map_or(f64::INFINITY, |pair| pair[0].0);
        let predicted = match law {
            "linear_elastic" => Some(std::f64::consts::FRAC_PI_2),
            "hencky" => Some(3.0177),
            _ => None,
        };
        findings.push(law, "simple shear", predicted, peak);
        series.push(Series::new(law, curve, Style::Line));
    }
    let exact = |name: &str, f: &dyn Fn(f64) -> f64| {
        let points = (0..=200).map(|i| 0.02 * f64::from(i)).map(|g| (g, f(g)));
        Series::new(name, points.collect(), Style::Dashed)
    };
    series.push(exact("exact: sin γ, γ, 2 asinh(γ/2)/√(1 + γ²/4)", &f64::sin));
    for f in [
        (&|g: f64| g) as &dyn Fn(f64) -> f64,
        &|g: f64| 2.0 * (0.5 * g).asinh() / (1.0 + 0.25 * g * g).sqrt(),
    ] {
        let mut curve = exact("", f);
        curve.color = Some(crate::report::Color(34, 34, 34));
        series.push(curve);
    }
    let peak = findings.row("linear_elastic", "simple shear");
    findings.shown = format!(
        "The shear stress of the rate law peaks at a shear of {:.3} (pi/2 = 1.571) and is negative beyond 3.14, as its equations say. Hyperelastic laws keep rising over the same range, Hencky's to 3.02.",
        peak.map_or(f64::NAN, |row| row.measured)
    );
    findings.drawings.push((
        "",
        Drawing::Lines(vec![LineChart {
            title: "Simple shear of a block: the stress of the Jaumann rate (linear_elastic) turns round".into(),
            x_label: "shear γ".into(),
            y_label: "shear stress / shear modulus".into(),
            y_range: Some([-1.0, 4.2]),
            series,
            ..LineChart::default()
        }]),
    ));
    Ok(findings)
}

/// A block all of whose nodes are driven: G = 1 Pa, shear rate 1/s, so that time is shear.
fn scenario(law: &str) -> String {
    format!(
        r#"dimension = 2
time = {{ end = {MOST:?}, step = 0.005 }}
grid = {{ min = [0.0, 0.0], max = [6.0, 1.0], cell_size = 0.5 }}
method = {{ basis = "linear", transfer = "flip", update = "usl" }}
material.block = {{ density = 1.0, {law} = {{ youngs_modulus = 2.5, poissons_ratio = 0.25 }} }}
output.every = 0.02
[[body]]
name = "block"
material = "block"
shape.box = {{ min = [0.5, 0.0], max = [1.0, 1.0] }}
particles_per_cell = 2
[[boundary]]
name = "shear"
on.box = {{ min = [-1.0, -1.0], max = [7.0, 2.0] }}
condition.driven = {{ velocity = ["y / 1 s", 0.0] }}
[[probe]]
name = "point"
body = "block"
particle = 0
"#
    )
}

type Curve = Vec<(f64, f64)>;

/// Shear and shear stress.
fn shear<'a>(law: &&'a str) -> Result<(&'a str, Curve), CaseError> {
    let run = simulate(&scenario(law), &[], false)?;
    let time = run.column("probe_point", "time");
    let stress = run.column("probe_point", "stress_xy");
    Ok((law, time.into_iter().zip(stress).collect()))
}
