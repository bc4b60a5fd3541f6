//! What the default method has to survive of all that other methods fail at: the failure catalogue of `mpm stability`, for one
//! method. A failure that it shares with all others (stress that no node sees) is left out, and so are steps so short that APIC
//! damps, which `mpm stability dissipation` shows.

use super::{Case, CaseError, Report};
use crate::study::stability::{FAILURES, Method, Row, Study};

/// The case.
pub const CASE: Case = Case {
    name: "survivors",
    claim: "quadratic splines with APIC and stress update last survive what breaks other methods",
    reference: "the edges of the failure catalogue, each measured as `mpm stability` does",
    run,
};

const DEFAULT: Method = Method {
    basis: "quadratic",
    transfer: "apic",
    update: "usl",
    frame: "updated",
};

/// A name in the catalogue, and what of it is asked for.
type Asked = (&'static str, fn(&Row) -> bool);

const ASKED: [Asked; 9] = [
    ("courant", |_| true),
    ("small_mass", |_| true),
    ("drift", |_| true),
    ("crossing", |_| true),
    ("fracture", |_| true),
    ("ringing", |row| row.at.starts_with("velocity")),
    ("dissipation", |row| row.at == "Courant 0.4"),
    ("galilei", |_| true),
    ("spin", |_| true),
];

fn run(report: &mut Report) -> Result<(), CaseError> {
    let study = Study {
        methods: vec![DEFAULT],
        points: vec![2],
        progress: &|_, _| {},
    };
    for (name, asked) in ASKED {
        let Some(failure) = FAILURES.iter().find(|failure| failure.name == name) else {
            continue;
        };
        let findings = (failure.run)(&study)?;
        let margins = findings
            .rows
            .iter()
            .filter(|row| asked(row))
            .map(|row| row.margin);
        // not `f64::min`, which would forget a NaN
        let worst = margins.fold(1e6, |worst, margin| if margin >= worst { worst } else { margin });
        report.at_least(
            format!("{name}: smallest margin ({})", findings.quantity),
            worst,
            1.0,
        );
    }
    Ok(())
}
