//! Time, grid and method.

use super::{AXES, CountedBody, Frame, Named, shown};
use crate::basis::BasisChoice;
use crate::input::{Bound, Reader, Unit};
use crate::material::Plane;
use crate::scenario::{
    BoundarySpec, GridSpec, Method, Placement, ReferenceFrame, Scheme, StepRule,
};
use crate::transfer::TransferChoice;

/// More steps than this end with no computer.
const MOST_STEPS: f64 = 1e12;
/// Above every Courant number that any method here survives, and low enough to catch a slip.
const MOST_COURANT: f64 = 5.0;
/// Cells have 32-bit numbers, with room to spare.
const MOST_CELLS: f64 = (1 << 30) as f64;

/// Duration and time step.
pub(super) fn time(root: &mut Reader<'_>) -> Option<(f64, StepRule)> {
    let mut reader = root.table("time")?;
    let end = reader.required("end", Unit::TIME, Bound::Positive);
    let step = match reader.one_key(&["courant", "step"]) {
        Some("courant") => {
            let courant = reader.required("courant", Unit::NONE, Bound::Positive);
            if let Some(courant) = courant.filter(|courant| *courant > MOST_COURANT) {
                reader.problem(
                    "courant",
                    format!(
                        "{courant} is above {MOST_COURANT}, where no run is stable: use 1 or less"
                    ),
                );
            }
            courant.map(StepRule::Courant)
        }
        Some(_) => {
            let step = reader.required("step", Unit::TIME, Bound::Positive);
            if let (Some(step), Some(end)) = (step, end)
                && end / step > MOST_STEPS
            {
                reader.problem(
                    "step",
                    format!(
                        "{:.1e} steps of {} s would be needed up to {} s: use a longer step",
                        end / step,
                        shown(step),
                        shown(end)
                    ),
                );
            }
            step.map(StepRule::Fixed)
        }
        None => None,
    };
    reader.finish();
    Some((end?, step?))
}

/// The grid, and its table for problems that show up later.
pub(super) fn grid<'a>(
    root: &mut Reader<'a>,
    frame: Frame,
) -> (Option<GridSpec>, Option<Reader<'a>>) {
    let Some(mut reader) = root.table("grid") else {
        return (None, None);
    };
    let dimension = frame.dimension;
    let min = reader.vector("min", Unit::LENGTH, dimension);
    let max = reader.vector("max", Unit::LENGTH, dimension);
    let cell_size = reader.required("cell_size", Unit::LENGTH, Bound::Positive);
    if let Some(min) = min
        .as_ref()
        .filter(|min| frame.plane == Plane::Axisymmetric && min[0] < 0.0)
    {
        let message = format!(
            "x is the distance from the axis and starts at {} m: start at 0 or above",
            shown(min[0])
        );
        reader.problem("min", message);
        return (None, Some(reader));
    }
    let (Some(min), Some(max), Some(cell_size)) = (min, max, cell_size) else {
        return (None, Some(reader));
    };
    for axis in 0..dimension {
        if min[axis] >= max[axis] {
            let key = format!("max[{axis}]");
            let (axis, min, max) = (AXES[axis], shown(min[axis]), shown(max[axis]));
            let message = format!(
                "along {axis} the grid ends at {max} m, which is not above its start {min} m: make max larger than min"
            );
            reader.problem(&key, message);
            return (None, Some(reader));
        }
    }
    let lengths: Vec<f64> = min.iter().zip(&max).map(|(min, max)| max - min).collect();
    match cells(&lengths, cell_size) {
        Ok(cells) => (
            Some(GridSpec {
                min,
                max,
                cell_size,
                cells,
            }),
            Some(reader),
        ),
        Err(message) => {
            reader.problem("cell_size", message);
            (None, Some(reader))
        }
    }
}

/// How many cells fit along each axis, or why they do not.
fn cells(lengths: &[f64], size: f64) -> Result<Vec<i32>, String> {
    let exact = |axis: usize| lengths[axis] / size;
    if let Some(axis) =
        (0..lengths.len()).find(|axis| exact(*axis).is_nan() || exact(*axis) > MOST_CELLS)
    {
        let (count, size, axis) = (exact(axis), shown(size), AXES[axis]);
        return Err(format!(
            "along {axis} {count:.1e} cells of {size} m would be needed, more than 2^30: use larger cells"
        ));
    }
    let Some(axis) = (0..lengths.len()).find(|axis| !is_whole(exact(*axis))) else {
        return Ok((0..lengths.len())
            .map(|axis| exact(axis).round() as i32)
            .collect());
    };
    let (length, count, axis) = (shown(lengths[axis]), exact(axis), AXES[axis]);
    let remedy = match &fitting_sizes(lengths, size)[..] {
        [] => "no size close to it fits every axis: change grid.max".to_string(),
        sizes => {
            let sizes: Vec<_> = sizes
                .iter()
                .map(|size| format!("{} m", shown(*size)))
                .collect();
            format!("use {}", sizes.join(" or "))
        }
    };
    let size = shown(size);
    Err(format!(
        "along {axis} the grid is {length} m long, which is {count:.4} cells of {size} m and has to be a whole number: {remedy}"
    ))
}

fn is_whole(count: f64) -> bool {
    count >= 0.5 && (count - count.round()).abs() <= (1e-9 * count).min(1e-4)
}

/// The sizes next to a given one, above and below, of which a whole number fits along every axis.
fn fitting_sizes(lengths: &[f64], size: f64) -> Vec<f64> {
    let shortest = lengths.iter().copied().fold(f64::INFINITY, f64::min);
    let count = (shortest / size).floor();
    let fits = |count: &f64| {
        lengths
            .iter()
            .all(|length| is_whole(length * count / shortest))
    };
    let most = 10_000;
    let fewer = (0..most)
        .map(|k| count - f64::from(k))
        .take_while(|count| *count >= 1.0)
        .find(fits);
    let more = (1..most).map(|k| count + f64::from(k)).find(fits);
    fewer
        .into_iter()
        .chain(more)
        .map(|count| shortest / count)
        .collect()
}

/// What the file says of the numerical method; the rest depends on the scene.
#[derive(Clone, Copy)]
pub(super) struct GivenMethod {
    pub(super) basis: Option<BasisChoice>,
    pub(super) transfer: TransferChoice,
    pub(super) update: Scheme,
    pub(super) frame: Option<ReferenceFrame>,
    pub(super) placement: Option<Placement>,
}

/// The numerical method, as far as the file says it.
pub(super) fn method(root: &mut Reader<'_>) -> Option<GivenMethod> {
    let mut given = root.optional_table("method");
    if given.is_none() && root.has("method") {
        return None;
    }
    let Some(reader) = given.as_mut() else {
        return nothing_given();
    };
    choices(reader)
}

/// The numerical method of a file that does not say any.
pub(super) fn nothing_given() -> Option<GivenMethod> {
    let empty = crate::input::Document::parse("", &[]);
    choices(&mut empty.root())
}

/// Warns of a method that is known to blow up.
pub(super) fn warn_of_method(method: &Method, warnings: &mut Vec<String>) {
    let jumps = matches!(method.basis, BasisChoice::Linear(_));
    let stable = method.update != Scheme::UpdateStressLast && !method.transfer.is_affine();
    // points that stay where they are in the grid cross no cells
    if jumps && !stable && method.frame == ReferenceFrame::Updated {
        let (basis, transfer) = (method.basis.name(), method.transfer.name());
        let update = method.update.name();
        warnings.push(format!(
            "method: the {basis} basis with \"{transfer}\" and \"{update}\" blows up at any time step once points cross cells near a free surface; take transfer = \"flip\" with update = \"musl\", or basis = \"quadratic\""
        ));
    }
}

/// Warns of what the total Lagrangian frame does not do: in it the grid goes with the bodies, so that it does not see where they
/// are by now.
pub(super) fn warn_of_frame(
    method: &Method,
    bodies: &[Named<CountedBody>],
    boundaries: &[BoundarySpec],
    warnings: &mut Vec<String>,
) {
    if method.frame == ReferenceFrame::Updated {
        return;
    }
    if bodies.len() > 1 {
        warnings.push(format!(
            "method.frame: in the total frame the {} bodies never meet, and those that share grid nodes at the start are welded together there; use frame = \"updated\" for bodies that touch or part",
            bodies.len()
        ));
    }
    let walls = boundaries
        .iter()
        .filter(|boundary| boundary.condition.is_one_sided());
    for wall in walls {
        warnings.push(format!(
            "method.frame: in the total frame the wall \"{}\" stops only what touches it at the start, and wherever that is by then; what comes from afar passes, what has left cannot come back; use frame = \"updated\" for impact",
            wall.name
        ));
    }
}

/// Warns of bodies that keep even distances between their points though others were asked for.
pub(super) fn warn_of_placement(
    method: &Method,
    bodies: &[Named<CountedBody>],
    warnings: &mut Vec<String>,
) {
    let left_to_the_scene = method.chosen.iter().any(|c| c.key == "placement");
    if method.placement == Placement::Even || left_to_the_scene {
        return;
    }
    let bodies = bodies.iter().filter_map(|named| named.found.as_ref());
    for counted in bodies.filter(|counted| counted.body.moment.is_none()) {
        warnings.push(format!(
            "method.placement: \"bending\" does nothing for the body \"{}\": it is for boxes of whole cells in 2D and 3D with two points or more along each axis of a cell, and neither for b_bar nor for splines from a Poisson's ratio of 0.47 on",
            counted.body.name
        ));
    }
}

fn choices(reader: &mut Reader<'_>) -> Option<GivenMethod> {
    let basis = if reader.has("basis") {
        let named = reader.name_or_table("basis", BasisChoice::NAMES);
        Some(named.and_then(|(name, mut parameters)| BasisChoice::read(name, &mut parameters)))
    } else {
        None
    };
    let transfer = reader
        .name_or_table_or("transfer", TransferChoice::NAMES, "apic")
        .and_then(|(name, mut parameters)| TransferChoice::read(name, &mut parameters));
    let update = reader.choice("update", &["usf", "usl", "musl"], Some("usl"));
    let frame = if reader.has("frame") {
        Some(reader.choice("frame", &ReferenceFrame::NAMES, None))
    } else {
        None
    };
    let total = matches!(frame, Some(Some("total")));
    if let Some(Some(BasisChoice::Linear(linear))) = basis
        && linear.b_bar
        && !total
    {
        reader.problem(
            "basis.linear.b_bar",
            "a point that comes into a cell would push at nodes that have none of its mass; add frame = \"total\", or take basis = \"quadratic\", which does not lock",
        );
    }
    let placement = if reader.has("placement") {
        Some(reader.choice("placement", &Placement::NAMES, None))
    } else {
        None
    };
    if placement == Some(Some("bending")) && !total {
        reader.problem(
            "placement",
            "points that move through cells keep no place in them; add frame = \"total\", or remove this key",
        );
    }
    let update = match update? {
        "usf" => Scheme::UpdateStressFirst,
        "usl" => Scheme::UpdateStressLast,
        _ => Scheme::ModifiedUpdateStressLast,
    };
    Some(GivenMethod {
        // what was given and could not be read is a problem, not a default
        basis: match basis {
            Some(read) => Some(read?),
            None => None,
        },
        transfer: transfer?,
        update,
        frame: match frame {
            Some(read) => Some(match read? {
                "total" => ReferenceFrame::Total,
                _ => ReferenceFrame::Updated,
            }),
            None => None,
        },
        placement: match placement {
            Some(read) => Some(match read? {
                "bending" => Placement::Bending,
                _ => Placement::Even,
            }),
            None => None,
        },
    })
}
