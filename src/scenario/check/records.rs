//! What is recorded: the times of rows, and probes.

use super::{CountedBody, Frame, Named, named, place, shown};
use crate::input::{Bound, Reader, Unit};
use crate::scenario::{GridSpec, OutputSpec, ProbeSpec, ProbeTarget};

/// Rows if nothing is said.
const SAMPLES: i64 = 200;
/// More rows than this fill any disk.
const MOST_SAMPLES: i64 = 1_000_000_000;

/// When rows are recorded, given the duration.
pub(super) fn output(root: &mut Reader<'_>, end: Option<f64>) -> Option<OutputSpec> {
    let every = |samples: i64| {
        end.map(|end| OutputSpec {
            every: end / samples as f64,
        })
    };
    if !root.has("output") {
        return every(SAMPLES);
    }
    let mut reader = root.table("output")?;
    let given = reader.has("every") || reader.has("samples");
    let output = match given.then(|| reader.one_key(&["every", "samples"])) {
        None => every(SAMPLES),
        Some(None) => None,
        Some(Some("samples")) => reader.integer("samples", 1, MOST_SAMPLES).and_then(every),
        Some(Some(_)) => {
            let every = reader.required("every", Unit::TIME, Bound::Positive);
            if let (Some(every), Some(end)) = (every, end) {
                if every > end {
                    reader.problem(
                        "every",
                        format!(
                            "{} s is longer than the run, which ends at {} s: use less",
                            shown(every),
                            shown(end)
                        ),
                    );
                } else if end / every > MOST_SAMPLES as f64 {
                    reader.problem(
                        "every",
                        format!(
                            "{:.1e} rows would be recorded: use a longer time",
                            end / every
                        ),
                    );
                }
            }
            every.map(|every| OutputSpec { every })
        }
    };
    reader.finish();
    output
}

/// All probes, in file order.
pub(super) fn probes(
    root: &mut Reader<'_>,
    frame: Frame,
    grid: Option<&GridSpec>,
    bodies: &[Named<CountedBody>],
    warnings: &mut Vec<String>,
) -> Option<Vec<ProbeSpec>> {
    let mut taken = Vec::new();
    let tables = root.tables("probe").into_iter();
    let found: Vec<_> = tables
        .map(|mut reader| {
            let name = super::name(&mut reader, "probe", &taken, None);
            taken.extend(name.clone());
            let body = named(
                &mut reader,
                "body",
                "body",
                bodies.iter().map(|named| &named.name[..]),
            );
            let target = target(&mut reader, frame);
            if let (Some(target), Some(grid)) = (&target, grid)
                && let Some(counted) = body.and_then(|body| bodies[body].found.as_ref())
            {
                check_target(&mut reader, target, counted, grid, warnings);
            }
            reader.finish();
            Some(ProbeSpec {
                name: name?,
                body: body?,
                target: target?,
            })
        })
        .collect();
    found.into_iter().collect()
}

fn target(reader: &mut Reader<'_>, frame: Frame) -> Option<ProbeTarget> {
    match reader.one_key(&["particle", "near"])? {
        "particle" => {
            let number = reader.integer("particle", 0, i64::MAX)?;
            Some(ProbeTarget::Particle(usize::try_from(number).ok()?))
        }
        _ => reader
            .vector("near", Unit::LENGTH, frame.dimension)
            .map(ProbeTarget::Near),
    }
}

fn check_target(
    reader: &mut Reader<'_>,
    target: &ProbeTarget,
    counted: &CountedBody,
    grid: &GridSpec,
    warnings: &mut Vec<String>,
) {
    let name = &counted.body.name;
    match (target, counted.points) {
        (ProbeTarget::Particle(number), Some(points)) if *number as u64 >= points => {
            let last = points - 1;
            reader.problem(
                "particle",
                format!("\"{name}\" has {points} material points, numbered from 0 to {last}: {number} is none of them"),
            );
        }
        (ProbeTarget::Near(at), _) => {
            let bounds = counted.body.shape.bounds();
            let far = (0..at.len()).any(|axis| {
                let (min, max) = (
                    bounds.min[axis] - grid.cell_size,
                    bounds.max[axis] + grid.cell_size,
                );
                !(min..=max).contains(&at[axis])
            });
            if far {
                let at = place(at);
                warnings.push(format!(
                    "{}.near: {at} is more than a cell away from \"{name}\"",
                    reader.path()
                ));
            }
        }
        _ => {}
    }
}
