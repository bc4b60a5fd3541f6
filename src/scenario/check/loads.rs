//! Gravity, damping and loads.

use super::{CountedBody, Frame, Named, named, region};
use crate::boundary::Side;
use crate::input::{Bound, Reader, Unit};
use crate::material::Plane;
use crate::scenario::fill::Filling;
use crate::scenario::{GridSpec, LoadKind, LoadSpec, Region};

/// Acceleration of gravity; zero if left out.
pub(super) fn gravity(root: &mut Reader<'_>, frame: Frame) -> Option<Vec<f64>> {
    let zero = vec![0.0; frame.dimension];
    let gravity = root.vector_or("gravity", Unit::ACCELERATION, frame.dimension, &zero)?;
    if frame.plane == Plane::Axisymmetric && gravity[0] != 0.0 {
        root.problem("gravity", "gravity cannot point away from the axis of an axisymmetric scene: set its first number to 0");
    }
    Some(gravity)
}

/// Rate of mass-proportional damping; zero if left out.
pub(super) fn damping(root: &mut Reader<'_>) -> Option<f64> {
    if !root.has("damping") {
        return Some(0.0);
    }
    let mut reader = root.table("damping")?;
    let rate = reader.required("rate", Unit::FREQUENCY, Bound::NotNegative);
    reader.finish();
    rate
}

/// All loads, in file order.
pub(super) fn loads(
    root: &mut Reader<'_>,
    frame: Frame,
    grid: Option<&GridSpec>,
    bodies: &[Named<CountedBody>],
) -> Option<Vec<LoadSpec>> {
    let mut taken = Vec::new();
    let tables = root.tables("load").into_iter().enumerate();
    let found: Vec<_> = tables
        .map(|(index, mut reader)| {
            let default = format!("load{}", index + 1);
            let name = super::name(&mut reader, "load", &taken, Some(default));
            taken.extend(name.clone());
            let load = load(&mut reader, name, frame, grid, bodies);
            reader.finish();
            load
        })
        .collect();
    found.into_iter().collect()
}

fn load(
    reader: &mut Reader<'_>,
    name: Option<String>,
    frame: Frame,
    grid: Option<&GridSpec>,
    bodies: &[Named<CountedBody>],
) -> Option<LoadSpec> {
    let body = named(
        reader,
        "body",
        "body",
        bodies.iter().map(|named| &named.name[..]),
    );
    let on = region(reader, frame, grid);
    let kind = kind(reader, frame, on.as_ref());
    let factor = if reader.has("factor") {
        reader.expression("factor", Unit::NONE, &["t"]).map(Some)
    } else {
        Some(None)
    };
    let (body, on) = (body?, on?);
    if let (Some(grid), Region::Box { min, max }) = (grid, &on)
        && let Some(CountedBody {
            body,
            points: Some(_),
        }) = &bodies[body].found
        && !Filling::new(&body.shape, grid, &body.particles_per_cell, frame.plane).reaches(min, max)
    {
        reader.problem(
            "on.box",
            format!(
                "no material point of \"{}\" is inside this box: move it or make it larger",
                body.name
            ),
        );
    }
    Some(LoadSpec {
        name: name?,
        body,
        on,
        kind: kind?,
        factor: factor?,
    })
}

fn kind(reader: &mut Reader<'_>, frame: Frame, on: Option<&Region>) -> Option<LoadKind> {
    let kind = reader.one_key(&["force", "traction", "pressure", "acceleration"])?;
    if kind == "acceleration" {
        let variables = &["x", "y", "z", "t"];
        let variables: Vec<&str> = (variables
            .iter()
            .take(frame.dimension)
            .chain(&variables[3..]))
        .copied()
        .collect();
        return reader
            .expressions(
                "acceleration",
                Unit::ACCELERATION,
                frame.dimension,
                &variables,
            )
            .map(LoadKind::Acceleration);
    }
    if kind == "force" {
        return reader
            .vector("force", Unit::FORCE, frame.dimension)
            .map(LoadKind::Force);
    }
    let side = match on {
        Some(Region::Side(side)) => Some(*side),
        Some(Region::Box { .. }) => Side::read(reader, "side", frame.dimension),
        None => {
            reader.used("side");
            None
        }
    };
    if kind == "traction" {
        let traction = reader.vector("traction", Unit::PRESSURE, frame.dimension);
        return Some(LoadKind::Traction {
            traction: traction?,
            side: side?,
        });
    }
    let pressure = reader.required("pressure", Unit::PRESSURE, Bound::Any);
    Some(LoadKind::Pressure {
        pressure: pressure?,
        side: side?,
    })
}
