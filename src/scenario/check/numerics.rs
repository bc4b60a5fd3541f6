//! Time, grid and method.

use super::{AXES, Frame};
use crate::basis::BasisChoice;
use crate::input::{Bound, Reader, Unit};
use crate::material::Plane;
use crate::scenario::{GridSpec, Method, Scheme, StepRule};
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
                        "{:.1e} steps of {step} s would be needed up to {end} s: use a longer step",
                        end / step
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
            min[0]
        );
        reader.problem("min", message);
        return (None, Some(reader));
    }
    let (Some(min), Some(max), Some(cell_size)) = (min, max, cell_size) else {
        return (None, Some(reader));
    };
    let cells: Vec<Option<i32>> = (0..dimension)
        .map(|axis| match cells(min[axis], max[axis], cell_size) {
            Ok(cells) => Some(cells),
            Err((key, message)) => {
                reader.problem(key, format!("along {} {message}", AXES[axis]));
                None
            }
        })
        .collect();
    let cells = cells.into_iter().collect::<Option<_>>();
    (
        cells.map(|cells| GridSpec {
            min,
            max,
            cell_size,
            cells,
        }),
        Some(reader),
    )
}

/// How many cells fit between two ends, or the key to change and why.
fn cells(min: f64, max: f64, size: f64) -> Result<i32, (&'static str, String)> {
    if min >= max {
        let message = format!(
            "the grid ends at {max} m, which is not above its start {min} m: make max larger than min"
        );
        return Err(("max", message));
    }
    let length = max - min;
    let exact = length / size;
    if !(exact <= MOST_CELLS) {
        return Err((
            "cell_size",
            format!(
                "{exact:.1e} cells of {size} m would be needed, more than 2^30: use larger cells"
            ),
        ));
    }
    let whole = exact.round();
    if (exact - whole).abs() <= 1e-9 * whole {
        return Ok(whole as i32);
    }
    let below = exact.floor();
    let fewer = if below >= 1.0 {
        format!("{} m ({below} cells) or ", length / below)
    } else {
        String::new()
    };
    let more = format!("{} m ({} cells)", length / (below + 1.0), below + 1.0);
    Err((
        "cell_size",
        format!(
            "the grid is {length} m long, which is {exact:.3} cells of {size} m and not a whole number: use {fewer}{more}"
        ),
    ))
}

/// The numerical method.
pub(super) fn method(root: &mut Reader<'_>) -> Option<Method> {
    let mut given = root.optional_table("method");
    if given.is_none() && root.has("method") {
        return None;
    }
    let Some(reader) = given.as_mut() else {
        let empty = crate::input::Document::parse("", &[]);
        return choices(&mut empty.root());
    };
    choices(reader)
}

fn choices(reader: &mut Reader<'_>) -> Option<Method> {
    let basis = reader
        .name_or_table_or("basis", BasisChoice::NAMES, "quadratic")
        .and_then(|(name, mut parameters)| BasisChoice::read(name, &mut parameters));
    let transfer = reader
        .name_or_table_or("transfer", TransferChoice::NAMES, "apic")
        .and_then(|(name, mut parameters)| TransferChoice::read(name, &mut parameters));
    let update = reader.choice("update", &["usf", "usl", "musl"], Some("usl"));
    if reader.choice("frame", &["updated", "total"], Some("updated")) == Some("total") {
        reader.problem(
            "frame",
            "the total Lagrangian frame is not available yet: use \"updated\"",
        );
    }
    let update = match update? {
        "usf" => Scheme::UpdateStressFirst,
        "usl" => Scheme::UpdateStressLast,
        _ => Scheme::ModifiedUpdateStressLast,
    };
    Some(Method {
        basis: basis?,
        transfer: transfer?,
        update,
    })
}
