//! What the loads of a scenario act on, and the force that they come to.

use crate::input::Variables;
use crate::scenario::{
    Faces, LoadKind, LoadPlace, LoadSpec, PointSet, Scenario, body_points, loaded_faces,
};
use serde::Serialize;

#[derive(Debug, Serialize)]
pub struct LoadPlan {
    pub name: String,
    pub body: String,
    pub kind: &'static str,
    pub particles: usize,
    /// With `on.shape` the loaded faces of points, by the side that they look to; else none.
    pub faces: Vec<FacesPlan>,
    /// Total over the points at the start and before the factor, N.
    pub force: Vec<f64>,
    /// Smallest and largest factor over the run.
    pub factor: [f64; 2],
}

#[derive(Debug, Serialize)]
pub struct FacesPlan {
    pub side: &'static str,
    pub count: usize,
    /// Of all of them, m²: that of the projection of the loaded surface.
    pub area: f64,
}

/// Times at which the factor of a load is looked at.
const FACTOR_SAMPLES: u32 = 2000;

/// What each load acts on, and how strongly.
pub fn loads(scenario: &Scenario, warnings: &mut Vec<String>) -> Vec<LoadPlan> {
    let plan = |spec: &LoadSpec| {
        let body = &scenario.bodies[spec.body];
        let set = body_points(scenario, spec.body);
        let faces = loaded_faces(scenario, spec, &set);
        let chosen = chosen_points(spec, &set, &faces);
        let factor = factor_range(scenario, spec);
        if factor == [0.0, 0.0] {
            warnings.push(format!(
                "load \"{}\": its factor is zero from the start to the end",
                spec.name
            ));
        }
        LoadPlan {
            name: spec.name.clone(),
            body: body.name.clone(),
            kind: match &spec.kind {
                LoadKind::Force(_) => "force",
                LoadKind::Traction { .. } => "traction",
                LoadKind::Pressure { .. } => "pressure",
                LoadKind::Acceleration(_) => "acceleration",
            },
            particles: chosen.len(),
            force: total_force(scenario, spec, &set, &chosen, &faces),
            faces: match &spec.on {
                LoadPlace::Region(_) => Vec::new(),
                LoadPlace::Shape(_) => faces.iter().map(faces_plan).collect(),
            },
            factor,
        }
    };
    scenario.loads.iter().map(plan).collect()
}

fn faces_plan(faces: &Faces) -> FacesPlan {
    FacesPlan {
        side: faces.side.name(),
        count: faces.points.len(),
        area: faces.area(),
    }
}

/// The points that a load acts on, or on whose faces, ascending.
fn chosen_points(spec: &LoadSpec, set: &PointSet, faces: &[Faces]) -> Vec<usize> {
    if faces.is_empty() {
        return set.selected(&spec.on);
    }
    let mut chosen: Vec<usize> = faces.iter().flat_map(|f| f.points.clone()).collect();
    chosen.sort_unstable();
    chosen.dedup();
    chosen
}

fn factor_range(scenario: &Scenario, spec: &LoadSpec) -> [f64; 2] {
    let Some(factor) = &spec.factor else {
        return [1.0, 1.0];
    };
    let value = |k: u32| {
        let time = scenario.end * f64::from(k) / f64::from(FACTOR_SAMPLES);
        factor.value(&Variables {
            position: [0.0; 3],
            time,
        })
    };
    let values = (0..=FACTOR_SAMPLES).map(value);
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
        [low.min(x), high.max(x)]
    })
}

fn total_force(
    scenario: &Scenario,
    spec: &LoadSpec,
    set: &PointSet,
    chosen: &[usize],
    faces: &[Faces],
) -> Vec<f64> {
    match &spec.kind {
        LoadKind::Force(force) => force.clone(),
        LoadKind::Traction { traction, .. } => {
            let area: f64 = faces.iter().map(Faces::area).sum();
            traction.iter().map(|t| t * area).collect()
        }
        LoadKind::Pressure { pressure, .. } => {
            let mut force = vec![0.0; scenario.dimension];
            for faces in faces {
                force[faces.side.axis] += faces.inwards() * pressure * faces.area();
            }
            force
        }
        LoadKind::Acceleration(field) => {
            let density = scenario.materials[scenario.bodies[spec.body].material].density;
            let total = |component: &crate::input::Expression| {
                let force = |&p: &usize| {
                    let at = Variables {
                        position: set.positions[p],
                        time: 0.0,
                    };
                    density * set.volume(p) * component.value(&at)
                };
                chosen.iter().map(force).sum()
            };
            field.iter().map(total).collect()
        }
    }
}
