//! Whether the scene fits into this machine.

use super::bodies::MOST_CANDIDATES;
use super::{CountedBody, Frame, Named};
use crate::input::Reader;
use crate::scenario::GridSpec;
use crate::scenario::fill::Filling;

/// Points have 31-bit numbers.
const MOST_POINTS: f64 = (1_u64 << 31) as f64;
/// About what a point takes with its stress, its law's memory, its share of the occupied grid and room to sort, by dimension.
const BYTES_PER_POINT: [f64; 3] = [120.0, 220.0, 400.0];
/// What the total Lagrangian frame adds: a position and two matrices.
const BYTES_OF_REFERENCE: [f64; 3] = [24.0, 80.0, 168.0];

/// Notes a problem if there are more points than can be numbered, stored or counted.
pub(super) fn check(
    grid_reader: &mut Reader<'_>,
    bodies: &[Named<CountedBody>],
    grid: &GridSpec,
    frame: Frame,
    total: bool,
) {
    let mut points = 0.0;
    let mut uncountable = false;
    for counted in bodies.iter().filter_map(|named| named.found.as_ref()) {
        let body = &counted.body;
        let filling = Filling::of(body, grid, frame.plane);
        points += counted
            .points
            .map_or(filling.estimate(), |points| points as f64);
        uncountable |= counted.points.is_none() && filling.candidates() > MOST_CANDIDATES;
    }
    let mut bytes = points * BYTES_PER_POINT[frame.dimension - 1];
    if total {
        bytes += points * BYTES_OF_REFERENCE[frame.dimension - 1];
    }
    let remedy = "use larger cells or fewer points a cell";
    let available = available_memory();
    let message = if points > MOST_POINTS {
        format!(
            "the bodies would have {points:.2e} material points, which need about {} of memory; at most 2^31 points have numbers: {remedy}",
            amount(bytes)
        )
    } else if let Some(available) = available.filter(|available| bytes > *available) {
        format!(
            "the bodies would have {points:.2e} material points, which need about {} of memory, and {} are free: {remedy}",
            amount(bytes),
            amount(available)
        )
    } else if uncountable {
        format!(
            "a body spans more than {MOST_CANDIDATES:e} places of its lattice, too many to look at: {remedy}"
        )
    } else {
        return;
    };
    grid_reader.problem("cell_size", message);
}

/// Bytes that this machine can still give, if it tells.
fn available_memory() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = text
        .lines()
        .find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kibibytes: f64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(1024.0 * kibibytes)
}

/// Bytes, for people.
fn amount(bytes: f64) -> String {
    let units = ["bytes", "kB", "MB", "GB", "TB", "PB"];
    let power = (bytes.max(1.0).log10() / 3.0).floor().clamp(0.0, 5.0);
    format!(
        "{:.3} {}",
        bytes / 1000_f64.powf(power),
        units[power as usize]
    )
}
