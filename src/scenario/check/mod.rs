//! From a document to a scenario, with every problem noted on the way.
//!
//! Each part is read even if an earlier one was wrong, as long as what it says still has a meaning.

mod bodies;
mod boundaries;
mod defaults;
mod loads;
mod materials;
mod numerics;
mod records;
mod size;

use super::{BodySpec, GridSpec, Method, Placement, ReferenceFrame, Region, Scenario};
use crate::boundary::Side;
use crate::input::{Document, Reader, Unit, nearest};
use crate::material::Plane;
use defaults::Surroundings;

/// Axes by number.
const AXES: [&str; 3] = ["x", "y", "z"];

/// A length that matters to nobody, in cells.
const TINY: f64 = 1e-9;

/// What the meaning of most other parts depends on.
#[derive(Clone, Copy, Debug)]
struct Frame {
    dimension: usize,
    plane: Plane,
    /// Whether the file says it.
    plane_given: bool,
}

/// What was found under a name: the name can be referred to even if the rest is wrong.
struct Named<T> {
    name: String,
    found: Option<T>,
}

/// A body, and how many points it has if that could be counted.
#[derive(Clone)]
struct CountedBody {
    body: BodySpec,
    points: Option<u64>,
}

/// The method that a scene would get if its file named none.
pub(super) fn default_method(scenario: &Scenario) -> Option<Method> {
    let scene = Surroundings {
        bodies: scenario.bodies.iter().map(Some).collect(),
        boundaries: &scenario.boundaries,
        materials: scenario.materials.iter().collect(),
        grid: &scenario.grid,
        plane: scenario.plane,
        damping: scenario.damping,
    };
    Some(defaults::method(&numerics::nothing_given()?, &scene))
}

/// Reads a whole document. Problems go to the document.
pub(super) fn scenario(
    document: &Document,
    name: &str,
    warnings: &mut Vec<String>,
) -> Option<Scenario> {
    let mut root = document.root();
    if root.keys().is_empty() {
        if !document.is_broken() {
            root.problem_here("the file is empty; scenarios/bar1d.toml is one to start from");
        }
        return None;
    }
    let title = if root.has("title") {
        root.optional_text("title")
    } else {
        Some(name.into())
    };
    let frame = frame(&mut root, document)?;
    let time = numerics::time(&mut root);
    let (grid, grid_reader) = numerics::grid(&mut root, frame);
    let given = numerics::method(&mut root);
    let materials = materials::materials(&mut root, document, frame, warnings);
    let mut bodies = bodies::bodies(&mut root, document, frame, grid.as_ref(), &materials);
    let basis = given.as_ref().map(defaults::basis_before_all);
    let boundaries = boundaries::boundaries(&mut root, frame, grid.as_ref(), basis);
    let damping = loads::damping(&mut root);
    let mut moments = Vec::new();
    let method = match (&given, &grid) {
        (Some(given), Some(grid)) => {
            let found = bodies.iter().map(|named| named.found.as_ref());
            let scene = Surroundings {
                bodies: found.map(|found| found.map(|own| &own.body)).collect(),
                boundaries: boundaries.as_deref().unwrap_or_default(),
                materials: materials.iter().filter_map(|m| m.found.as_ref()).collect(),
                grid,
                plane: frame.plane,
                damping: damping.unwrap_or_default(),
            };
            let method = defaults::method(given, &scene);
            if method.placement == Placement::Bending {
                let moment = |body: &BodySpec| defaults::moment(body, &method.basis, &scene);
                let bodies = scene.bodies.iter();
                moments.extend(bodies.map(|body| body.and_then(moment)));
            }
            Some(method)
        }
        _ => None,
    };
    for (named, moment) in bodies.iter_mut().zip(moments) {
        if let Some(counted) = &mut named.found {
            counted.body.moment = moment;
        }
    }
    if let (Some(grid), Some(mut reader)) = (&grid, grid_reader) {
        let total = method
            .as_ref()
            .is_some_and(|m| m.frame == ReferenceFrame::Total);
        size::check(&mut reader, &bodies, grid, frame, total);
        reader.finish();
    }
    boundaries::check_axis(
        &mut root,
        frame,
        grid.as_ref(),
        &bodies,
        boundaries.as_deref(),
    );
    let gravity = loads::gravity(&mut root, frame);
    let loads = loads::loads(&mut root, frame, grid.as_ref(), &bodies);
    let output = records::output(&mut root, time.map(|time| time.0));
    let probes = records::probes(&mut root, frame, grid.as_ref(), &bodies, warnings);
    root.finish();
    materials::warn_of_unused(&materials, &bodies, warnings);
    if let (Some(method), Some(boundaries)) = (&method, &boundaries) {
        numerics::warn_of_method(method, warnings);
        numerics::warn_of_frame(method, &bodies, boundaries, warnings);
        numerics::warn_of_placement(method, &bodies, warnings);
    }

    let (end, step) = time?;
    let materials = materials
        .into_iter()
        .map(|named| named.found)
        .collect::<Option<_>>()?;
    let bodies = bodies
        .into_iter()
        .map(|named| named.found.map(|counted| counted.body));
    Some(Scenario {
        title: title?,
        dimension: frame.dimension,
        plane: frame.plane,
        end,
        step,
        grid: grid?,
        method: method?,
        materials,
        bodies: bodies.collect::<Option<_>>()?,
        boundaries: boundaries?,
        loads: loads?,
        gravity: gravity?,
        damping: damping?,
        output: output?,
        probes: probes?,
    })
}

fn frame(root: &mut Reader<'_>, document: &Document) -> Option<Frame> {
    let read = root
        .integer("dimension", 1, 3)
        .map(|dimension| dimension as usize);
    if let Some(dimension) = read {
        document.set_dimension(dimension);
    }
    // Without it the rest can still be read as the grid suggests.
    let dimension = read.or_else(|| {
        let mut grid = root.optional_table("grid")?;
        grid.keys().iter().for_each(|key| grid.used(key));
        grid.list_length("min")
            .filter(|length| (1..=3).contains(length))
    })?;
    let names: &[&'static str] = match dimension {
        1 => &["strain", "stress"],
        2 => &["strain", "stress", "axisymmetric"],
        _ => &[],
    };
    let plane = if names.is_empty() {
        if root.has("plane") {
            root.problem("plane", "nothing is left out in 3D; remove this key");
        }
        Plane::Strain
    } else {
        match root.choice("plane", names, Some("strain")) {
            Some("stress") => Plane::Stress,
            Some("axisymmetric") => Plane::Axisymmetric,
            _ => Plane::Strain,
        }
    };
    let plane_given = root.has("plane");
    Some(Frame {
        dimension,
        plane,
        plane_given,
    })
}

/// The name of one thing of a kind, which has to be new, and fit to be part of a file's name.
fn name(
    reader: &mut Reader<'_>,
    kind: &str,
    taken: &[String],
    default: Option<String>,
) -> Option<String> {
    let name = if default.is_some() && !reader.has("name") {
        default
    } else {
        reader.text("name")
    }?;
    let fits = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    if name.is_empty() || name.len() > 64 || !name.chars().all(fits) {
        let message =
            "a name is part of a file's name: use up to 64 letters, digits, \"-\" and \"_\"";
        reader.problem("name", message);
        return None;
    }
    if taken.contains(&name) {
        let message = format!("another {kind} is called \"{name}\" already: choose another name");
        reader.problem("name", message);
    }
    Some(name)
}

/// The number of the thing of a kind that `key` names.
fn named<'n>(
    reader: &mut Reader<'_>,
    key: &str,
    kind: &str,
    names: impl Iterator<Item = &'n str> + Clone,
) -> Option<usize> {
    let wanted = reader.text(key)?;
    let found = names.clone().position(|name| name == wanted);
    // A name that could not be read, or the lack of any, is a problem of its own and may be the one that is meant.
    let complete = names.clone().next().is_some() && names.clone().all(|name| !name.is_empty());
    if found.is_none() && complete {
        let message = match nearest(&wanted, names.clone()) {
            Some(near) => format!("there is no {kind} \"{wanted}\"; did you mean \"{near}\"?"),
            None => {
                let known: Vec<_> = names.map(|name| format!("\"{name}\"")).collect();
                format!(
                    "there is no {kind} \"{wanted}\"; known: {}",
                    known.join(", ")
                )
            }
        };
        reader.problem(key, message);
    }
    found
}

/// Where a condition acts: `on.side` or `on.box`.
fn region(reader: &mut Reader<'_>, frame: Frame, grid: Option<&GridSpec>) -> Option<Region> {
    let mut on = reader.table_such_as(
        "on",
        "on.side = \"x_min\" or on.box = { min = [...], max = [...] }",
    )?;
    let key = on.one_key(&["side", "box"])?;
    let region = region_under(&mut on, key, frame, grid)?;
    on.finish();
    Some(region)
}

/// The region that stands under `key`, `side` or `box`, of a table `on`.
fn region_under(
    on: &mut Reader<'_>,
    key: &str,
    frame: Frame,
    grid: Option<&GridSpec>,
) -> Option<Region> {
    if key == "side" {
        return Side::read(on, "side", frame.dimension).map(Region::Side);
    }
    let mut table = on.table("box")?;
    let (min, max) = corners(&mut table, frame.dimension)?;
    table.finish();
    let slack = TINY * grid.map_or(0.0, |grid| grid.cell_size);
    Some(Region::Box {
        min: min.iter().map(|x| x - slack).collect(),
        max: max.iter().map(|x| x + slack).collect(),
    })
}

/// The corners of a box that may be open on one end.
fn corners(table: &mut Reader<'_>, dimension: usize) -> Option<(Vec<f64>, Vec<f64>)> {
    let (has_min, has_max) = (table.has("min"), table.has("max"));
    if !has_min && !has_max && table.keys().is_empty() {
        table.problem_here(
            "give min, max or both; without min the box is open towards lower x, y and z",
        );
        return None;
    }
    let min = table.vector_or(
        "min",
        Unit::LENGTH,
        dimension,
        &vec![f64::NEG_INFINITY; dimension],
    );
    let max = table.vector_or(
        "max",
        Unit::LENGTH,
        dimension,
        &vec![f64::INFINITY; dimension],
    );
    let (min, max) = (min?, max?);
    for number in 0..dimension {
        if min[number] > max[number] {
            let (axis, min, max) = (AXES[number], shown(min[number]), shown(max[number]));
            let message =
                format!("along {axis} the box ends at {max} m, below its start {min} m: swap them");
            table.problem(&format!("max[{number}]"), message);
            return None;
        }
    }
    Some((min, max))
}

/// A number, for people: without a page of zeros.
pub(super) fn shown(x: f64) -> String {
    if x == 0.0 || (1e-4..1e7).contains(&x.abs()) {
        format!("{x}")
    } else {
        format!("{x:e}")
    }
}

/// A place, for people.
fn place(at: &[f64]) -> String {
    let numbers: Vec<_> = at.iter().map(|x| shown(*x)).collect();
    format!("({}) m", numbers.join(", "))
}
