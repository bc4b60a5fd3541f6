//! A motion so small that the configuration in which shape functions are taken makes no difference: hat functions of the
//! initial positions meet fewer nodes, and nothing crosses a cell.

use super::{Advice, Subject, cost, locking, stencil};
use crate::input::Variables;
use crate::material::Plane;
use crate::scenario::ReferenceFrame;

/// What points may move, in cells.
const SMALL: f64 = 0.1;

/// How many times cheaper it has to be to be worth a word.
const WORTH: f64 = 1.2;

pub fn advise(subject: &Subject) -> Vec<Advice> {
    let scenario = subject.scenario;
    let nodes = stencil(scenario);
    // bodies do not meet in the total frame, and walls stop only what touches them at the start
    let meets = scenario.bodies.len() > 1
        || scenario
            .boundaries
            .iter()
            .any(|spec| spec.condition.is_one_sided());
    let locks =
        scenario.plane != Plane::Stress && locking::highest_ratio(scenario).1 >= locking::HIGH;
    let dimension = scenario.dimension;
    let factor =
        cost(nodes, dimension, scenario.method.frame) / cost(2, dimension, ReferenceFrame::Total);
    if scenario.method.frame == ReferenceFrame::Total || factor < WORTH || meets || locks {
        return Vec::new();
    }
    let Some(way) = way(subject) else {
        return Vec::new();
    };
    let way = way / scenario.grid.cell_size;
    if way > SMALL {
        return Vec::new();
    }
    let [more, fewer] = [nodes, 2].map(|nodes| nodes.pow(dimension as u32));
    vec![Advice {
        kind: "small_motion",
        says: format!(
            "points move about {way:.2e} of a cell: linear functions of the initial positions may do, {fewer} nodes a point in place of \
             {more}; they are stiffer in bending (compare with mpm chart --frame updated,total --basis linear,{})",
            scenario.method.basis.name()
        ),
        change: "method.frame = \"total\", method.basis = \"linear\"".into(),
        factor: Some(factor),
    }]
}

/// How far the fastest point would come if nothing held it, m; not known where something pushes.
fn way(subject: &Subject) -> Option<f64> {
    let scenario = subject.scenario;
    let mut conditions = scenario.boundaries.iter().map(|spec| &spec.condition);
    if !scenario.loads.is_empty() || !conditions.all(|condition| condition.stands_still()) {
        return None;
    }
    let norm = |vector: &[f64]| vector.iter().map(|x| x * x).sum::<f64>().sqrt();
    let mut fastest = 0.0_f64;
    for (body, set) in scenario.bodies.iter().zip(subject.sets) {
        for &position in &set.positions {
            let at = Variables {
                position,
                time: 0.0,
            };
            let square = |v: &crate::input::Expression| v.value(&at).powi(2);
            fastest = fastest.max(body.velocity.iter().map(square).sum::<f64>().sqrt());
        }
    }
    let end = scenario.end;
    Some(fastest * end + 0.5 * norm(&scenario.gravity) * end * end)
}
