//! Domains in large shear. A point whose domain follows the motion knows the grid at the corners of its domain only, and shear pulls
//! them apart: with points a distance 2a apart and a shear γ they lie ±a ± γa along the shear. Sheared evenly, domains tile as well as
//! at rest and a uniform stress pushes nothing. But what varies along the shear is smeared.
//!
//! Of a wave e^{ikx} the slopes of a domain take mean e^{ika(s₁ + γs₂)} s₁/a over the signs s₁, s₂, which is i sin(ka)/a cos(γka), and its
//! weights take cos(ka) cos(γka). So the acceleration that stresses of this wave give to points is cos²(γka) of that at rest, and the
//! block is as much too soft. Functions that do not follow the shear do not care. That the hats themselves smear a wave, by 5 % in
//! each direction if it has eight cells, is left out: it depends on where in their cells corners lie.
//!
//! Measured: a block is sheared by γ, its stress σ_xx is a wave of eight cells along x, and the solver takes one short step from rest.
//! The amplitude of the acceleration over that at γ = 0 is the share that is left. The total frame is given the same motion: there the wave
//! is one along X + γY, which has fewer and fewer cells of the undeformed grid.

use super::bisect::first_failure;
use super::crossing::bases;
use super::findings::{Drawing, Findings, Sense};
use super::{Failure, Method, Study};
use crate::basis::Cpdi;
use crate::math::{Matrix, Vector, pack, packed_len};
use crate::report::{LineChart, Series, Style};
use crate::run::{Computing, build_with};
use crate::scenario::parse;
use crate::solver::Fault;
use crate::study::validate::CaseError;
use std::f64::consts::PI;

/// The case.
pub const FAILURE: Failure = Failure {
    name: "cpdi_shear",
    title: "domains in large shear: what varies along the shear is smeared over them",
    measure: "smallest shear at which a stress wave of 8 cells along the shear accelerates points by less than 4/5 of what it does at rest (searched to 8); fails below 2",
    prediction: "cos^2(shear k a) = 4/5 for domains 2a apart; none for functions that do not follow the shear",
    run,
};

/// The share of the acceleration that has to be left.
const LEFT: f64 = 0.8;
/// The largest shear that is looked at.
const MOST: f64 = 8.0;
/// Wave number of the stress, 1/m; cells are 1 m.
const WAVE: f64 = 2.0 * PI / 8.0;
/// False forces, as a share of σ/(ρ h), that no tiling leaves behind but for round-off.
const FALSE_FORCE: f64 = 1e-6;
/// How much the block is stretched along the shear as well where false forces are looked for: rows of points whose distance is a share
/// of a cell push nothing, whatever their functions.
const STRETCH: f64 = 1.2;

/// A method, and whether its frame is the total one.
type Way = (Method, bool);

fn run(study: &Study) -> Result<Findings, CaseError> {
    let points = study.points_or(&[1, 2, 4]);
    let ways: Vec<Way> = bases(study)
        .into_iter()
        .flat_map(|method| [(method, false), (method, true)])
        // one basis stands for all in the total frame, which shears none of them
        .filter(|(method, total)| !total || method.basis == "quadratic")
        .collect();
    let jobs: Vec<(Way, u32)> = ways
        .iter()
        .flat_map(|way| points.iter().map(|n| (*way, *n)))
        .collect();
    let edges = study.map(&jobs, |(way, points)| -> Result<_, CaseError> {
        let block = Block { way: *way, points: *points };
        let whole = block.wave(0.0)?;
        let left = |shear: f64| block.wave(shear).map_or(f64::NAN, |a| a / whole);
        // what is not a number has not survived
        let softens = |share: f64| share.is_nan() || share < LEFT;
        let edge = first_failure([0.0, MOST], 0.093, 1e-3, |shear| softens(left(shear)));
        let curve: Vec<(f64, f64)> = (0..=80)
            .map(|i| 0.1 * f64::from(i))
            .map(|shear| (shear, left(shear)))
            .collect();
        let pushes = |shear: f64| block.uniform(shear).is_ok_and(|a| a > FALSE_FORCE);
        let cut = if way.0.basis == "cpdi" && !way.1 {
            first_failure([0.0, MOST], 0.37, 1e-3, pushes)
        } else {
            f64::NAN
        };
        Ok((edge, curve, cut))
    });
    let edges = edges.into_iter().collect::<Result<Vec<_>, _>>()?;
    let mut findings = Findings::new("shear", Sense::AtLeast, 2.0);
    let mut cuts = Vec::new();
    for ((way, n), (edge, _, cut)) in jobs.iter().zip(&edges) {
        let at = super::courant::at(*n);
        findings.push(name(way), at, predicted(way, *n), *edge);
        if cut.is_finite() {
            // ±a STRETCH ± γa along the shear, two cells at most
            let predicted = f64::from(2 * Cpdi::REACH) * f64::from(*n) - STRETCH;
            cuts.push(vec![n.to_string(), predicted.to_string(), cut.to_string()]);
        }
    }
    findings.tables.push((
        "cut",
        vec!["points_per_cell", "predicted_shear", "measured_shear"],
        cuts,
    ));
    findings.shown = format!(
        "Domains that are sheared evenly go on tiling and push nothing until they are cut, when shear and stretch add up to 4n with n points per cell. Long before, they smear what varies along the shear; and in the total frame the wave has fewer and fewer cells, 8/sqrt(1 + shear^2). Measured and predicted edges differ by {:.1e} at most.",
        findings.worst_deviation()
    );
    let panel = |n: &u32| {
        let of = jobs.iter().zip(&edges).filter(|(job, _)| job.1 == *n);
        let mut series: Vec<Series> = of
            .map(|(job, edge)| Series::new(name(&job.0), edge.1.clone(), Style::Line))
            .collect();
        let limit = vec![(0.0, LEFT), (MOST, LEFT)];
        series.push(Series::new("fails below", limit, Style::Dashed));
        LineChart {
            title: format!("A wave of 8 cells along the shear, {n} points per cell"),
            x_label: "shear γ".into(),
            y_label: "acceleration / that at rest (exact: 1)".into(),
            y_range: Some([-0.2, 1.6]),
            series,
            ..LineChart::default()
        }
    };
    let panels = points.iter().map(panel).collect();
    findings.drawings.push(("", Drawing::Lines(panels)));
    Ok(findings)
}

fn name((method, total): &Way) -> String {
    let frame = if *total { ", total frame" } else { "" };
    format!("{}{frame}", method.basis)
}

/// Where cos²(γ k a) = 4/5, a being half the distance of points.
fn predicted((method, total): &Way, points: u32) -> Option<f64> {
    let shear = LEFT.sqrt().acos() * 2.0 * f64::from(points) / WAVE;
    (method.basis == "cpdi" && !total).then_some(shear)
}

/// A block of 60 × 8 cells of 1 m, ρ = 1 kg/m³, that can be sheared about its middle: so long that its middle knows nothing of its
/// slanted ends.
struct Block {
    way: Way,
    points: u32,
}

impl Block {
    /// The amplitude of the acceleration that a wave of σ_xx gives to the block's middle, m/s².
    fn wave(&self, shear: f64) -> Result<f64, CaseError> {
        let points = self.accelerations(1.0, shear, |x| (WAVE * x[0]).sin())?;
        let (mut sum, mut squares) = (0.0, 0.0);
        for (x, a) in points {
            let shape = (WAVE * x[0]).cos();
            sum += shape * a[0];
            squares += shape * shape;
        }
        Ok(sum / squares)
    }

    /// The largest acceleration in the middle of the stretched block under a uniform stress of 1 Pa, m/s².
    fn uniform(&self, shear: f64) -> Result<f64, CaseError> {
        let points = self.accelerations(STRETCH, shear, |_| 1.0)?;
        Ok(points.iter().map(|(_, a)| a.amax()).fold(0.0, f64::max))
    }

    /// Present places and accelerations of the points of the middle after one short step from rest, under a stress σ_xx, Pa.
    fn accelerations(
        &self,
        stretch: f64,
        shear: f64,
        stress: impl Fn(&Vector<2>) -> f64,
    ) -> Result<Vec<(Vector<2>, Vector<2>)>, CaseError> {
        let frame = if self.way.1 { "total" } else { "updated" };
        let text = format!(
            r#"dimension = 2
time = {{ end = 1.0, step = 1.0 }}
grid = {{ min = [-70.0, -12.0], max = [70.0, 12.0], cell_size = 1.0 }}
{}material.block = {{ density = 1.0, linear_elastic = {{ youngs_modulus = 1.0, poissons_ratio = 0.0 }} }}
[[body]]
name = "block"
material = "block"
shape.box = {{ min = [-30.0, -4.0], max = [30.0, 4.0] }}
particles_per_cell = {}
"#,
            self.way.0.toml(),
            self.points
        );
        let frame = format!("method.frame=\"{frame}\"");
        let loaded = parse("block", &text, &[frame]).map_err(CaseError::Input)?;
        let computing = Computing {
            parallel: Some(false),
            instructions: None,
        };
        let mut scene = build_with::<2>(&loaded.scenario, &computing);
        let wrong = |fault: Fault| CaseError::Run(fault.into());
        scene.solver.start(&mut scene.state).map_err(wrong)?;
        let f = Matrix::<2>::new(stretch, shear, 0.0, 1.0);
        let inverse = Matrix::<2>::new(1.0, -shear, 0.0, stretch) / stretch;
        let p = &mut scene.state.bodies[0].particles;
        let width = packed_len(2);
        let mut undeformed = vec![Vector::zeros(); p.len()];
        for row in 0..p.len() {
            let x = f * p.position[row];
            undeformed[p.id[row] as usize] = p.position[row];
            p.position[row] = x;
            let kirchhoff = Matrix::<2>::new(stress(&x), 0.0, 0.0, 0.0);
            pack(&kirchhoff, &mut p.stress[row * width..(row + 1) * width]);
            if let Some(deformed) = p.deformation_gradient.get_mut(row) {
                *deformed = f;
            }
            if let Some(piola) = p.first_piola_stress.get_mut(row) {
                *piola = kirchhoff * inverse.transpose();
            }
        }
        // points have moved: they are sorted anew
        scene.solver.start(&mut scene.state).map_err(wrong)?;
        let dt = 1e-9;
        scene.solver.step(&mut scene.state, dt).map_err(wrong)?;
        let p = &scene.state.bodies[0].particles;
        let rows = (0..p.len()).filter(|row| {
            let x = undeformed[p.id[*row] as usize];
            x[0].abs() < 4.0 && x[1].abs() < 1.0
        });
        Ok(rows
            .map(|row| (p.position[row], p.velocity[row] / dt))
            .collect())
    }
}
