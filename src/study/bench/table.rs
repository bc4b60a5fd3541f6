//! Rows for people.

use super::{Machine, Order, Row};
use crate::report::{Align, Table};

/// One line a row.
pub fn table(rows: &[Row]) -> Table {
    let headers = [
        "dim",
        "basis",
        "transfer",
        "update",
        "law",
        "order",
        "particles",
        "threads",
        "ns/step",
        "fastest",
        "slowest",
        "M steps/s",
        "bytes",
        "memory",
        "floor B",
        "floor ns",
        "of floor",
    ];
    let mut table = Table::new(headers);
    for column in 6..headers.len() {
        table = table.align(column, Align::Right);
    }
    for row in rows {
        let case = &row.case;
        let optional = |value: Option<f64>, digits: usize| {
            value.map_or_else(|| "-".to_owned(), |value| format!("{value:.digits$}"))
        };
        let memory = match row.memory_per_particle {
            0.0 => "-".into(),
            bytes => format!("{bytes:.0}"),
        };
        table.push([
            format!("{}D", case.dimension),
            case.basis.clone(),
            case.transfer.clone(),
            case.update.clone(),
            case.law.clone(),
            match case.order {
                Order::Lattice => "lattice".into(),
                Order::Random => "random".into(),
            },
            case.particles.to_string(),
            case.threads.to_string(),
            format!("{:.1}", row.nanoseconds),
            format!("{:.1}", row.fastest),
            format!("{:.1}", row.slowest),
            format!("{:.2}", 1e-6 * row.particle_steps_per_second),
            format!("{:.0}", row.bytes_per_particle),
            memory,
            format!("{:.0}", row.floor_bytes),
            optional(row.floor_nanoseconds, 1),
            row.share_of_floor
                .map_or_else(|| "-".into(), |share| format!("{:.0} %", 100.0 * share)),
        ]);
    }
    table
}

/// What the machine is, and what the columns mean.
pub fn legend(machine: &Machine) -> String {
    let name = match machine.processor.as_str() {
        "" => "processor",
        name => name,
    };
    let mut text = format!(
        "{name}, {} threads, {}\n",
        machine.threads, machine.instructions
    );
    for b in &machine.bandwidth {
        let plural = if b.threads == 1 { "" } else { "s" };
        text += &format!(
            "memory bandwidth, {} thread{plural}: {:.1} GB/s (triad {:.1}, update in place {:.1})\n",
            b.threads,
            b.best(),
            b.triad,
            b.update
        );
    }
    text + "\
ns/step    time per particle and step: median, fastest and slowest of the repeats; M steps/s are millions of particle steps a second
bytes      of a particle's columns, its law's memory included; memory: what the process grew by at most, nodes and sorting included
floor      bytes that a step has to move for a particle (each pass reads its inputs and writes its outputs once, each node once),
           and the time that this takes at the measured bandwidth; points that fit into the caches may beat it
"
}
