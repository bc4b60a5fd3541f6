//! How fast this machine computes: time and memory of one step of the real solver, beside what the machine's memory allows.
//!
//! A [`Case`] says what is computed, [`measure`] computes it and gives a [`Row`], [`machine`] measures the memory. Nothing here
//! judges: there is no limit that a row could miss.

mod bandwidth;
mod case;
mod floor;
mod measure;
mod table;

pub use bandwidth::{Bandwidth, Machine, bandwidth, machine};
pub use case::{Case, Order};
pub use floor::{Traffic, traffic};
pub use measure::{Effort, Row, measure};
pub use table::{legend, table};

use crate::input::Problem;
use crate::scenario::InputError;
use crate::solver::Fault;

/// Why a case could not be measured.
#[derive(Debug)]
pub enum BenchError {
    /// It makes no scenario.
    Input(InputError),
    /// Its motion went wrong.
    Fault(Fault),
    /// The system refused threads.
    Threads(rayon::ThreadPoolBuildError),
}

impl std::fmt::Display for BenchError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Input(error) => {
                // a reader of this has written no file: where in it something is wrong says nothing
                let message = |problem: &Problem| format!("{}: {}", problem.key, problem.message);
                let messages: Vec<_> = error.problems.iter().map(message).collect();
                write!(f, "{}", messages.join("; "))
            }
            Self::Fault(fault) => fault.fmt(f),
            Self::Threads(error) => write!(f, "cannot start threads: {error}"),
        }
    }
}

impl std::error::Error for BenchError {}
