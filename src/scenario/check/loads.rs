//! Gravity, damping and loads.

use super::{CountedBody, Frame, Named, named, region_under};
use crate::boundary::Side;
use crate::input::{Bound, Reader, Unit};
use crate::material::Plane;
use crate::scenario::fill::Filling;
use crate::scenario::shape::Shape;
use crate::scenario::{GridSpec, LoadKind, LoadPlace, LoadSpec, Region};

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
    let on = place(reader, frame, grid);
    let kind = kind(reader, frame, on.as_ref());
    let factor = if reader.has("factor") {
        reader.expression("factor", Unit::NONE, &["t"]).map(Some)
    } else {
        Some(None)
    };
    let (body, on) = (body?, on?);
    if let Some(grid) = grid
        && let Some(CountedBody {
            body,
            points: Some(_),
        }) = &bodies[body].found
    {
        let filling = Filling::of(body, grid, frame.plane);
        check_reach(reader, &body.name, &filling, &on, kind.as_ref());
    }
    Some(LoadSpec {
        name: name?,
        body,
        on,
        kind: kind?,
        factor: factor?,
    })
}

/// Where a load acts: `on.side`, `on.box` or `on.shape`.
fn place(reader: &mut Reader<'_>, frame: Frame, grid: Option<&GridSpec>) -> Option<LoadPlace> {
    let mut on = reader.table_such_as(
        "on",
        "on.side = \"x_min\", on.box = { min = [...], max = [...] } or on.shape = { ball = { center = [...], radius = ... } }",
    )?;
    let place = match on.one_key(&["side", "box", "shape"])? {
        "shape" => {
            let mut table = on.table("shape")?;
            let shape = Shape::read(&mut table, frame.dimension)?;
            table.finish();
            LoadPlace::Shape(shape)
        }
        key => LoadPlace::Region(region_under(&mut on, key, frame, grid)?),
    };
    on.finish();
    Some(place)
}

/// Notes a problem if a load acts on nothing of its body.
fn check_reach(
    reader: &mut Reader<'_>,
    body: &str,
    filling: &Filling<'_>,
    on: &LoadPlace,
    kind: Option<&LoadKind>,
) {
    let no_point = |place| {
        format!("no material point of \"{body}\" is inside this {place}: move it or make it larger")
    };
    match (on, kind) {
        (LoadPlace::Region(Region::Box { min, max }), _) if !filling.reaches(min, max) => {
            reader.problem("on.box", no_point("box"));
        }
        (LoadPlace::Shape(shape), Some(LoadKind::Pressure { .. }))
            if !filling.looks_into(shape) =>
        {
            let message = format!(
                "no surface of \"{body}\" looks into this shape: it has to hold the space in front of the loaded surface to a depth of half \
                 the points' spacing or more, as a ball that fills a bore does"
            );
            reader.problem("on.shape", message);
        }
        (LoadPlace::Shape(shape), Some(LoadKind::Force(_) | LoadKind::Acceleration(_))) => {
            let dimension = shape.bounds().min.len();
            let inside = |at: &[f64; 3]| shape.contains(&at[..dimension]);
            if filling.find(inside).is_none() {
                reader.problem("on.shape", no_point("shape"));
            }
        }
        _ => {}
    }
}

fn kind(reader: &mut Reader<'_>, frame: Frame, on: Option<&LoadPlace>) -> Option<LoadKind> {
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
    if let Some(LoadPlace::Shape(_)) = on {
        if reader.has("side") {
            let message =
                "with on.shape every surface that looks into the shape is loaded: remove this key";
            reader.problem("side", message);
        }
        if kind == "traction" {
            let message = "a traction needs the area of a flat side, and on.shape has none: give on.side or on.box, a pressure, or the total as a force";
            reader.problem("traction", message);
            return None;
        }
    }
    let side = match on {
        Some(LoadPlace::Region(Region::Side(side))) => Some(*side),
        Some(LoadPlace::Region(Region::Box { .. })) => Side::read(reader, "side", frame.dimension),
        Some(LoadPlace::Shape(_)) => None,
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
    let pressure = reader.required("pressure", Unit::PRESSURE, Bound::Any)?;
    let complete = side.is_some() || matches!(on, Some(LoadPlace::Shape(_)));
    complete.then_some(LoadKind::Pressure { pressure, side })
}
