//! What is recorded of a run: tables with one row a recorded time.
//!
//! An observer is a function of one recorded state. The core decides when it is asked and where its rows go.

mod body;
mod boundary;
mod energy;
mod probe;
mod sink;

pub use body::BodyTable;
pub use boundary::ReactionTable;
pub use energy::EnergyTable;
pub use probe::ProbeTable;
pub use sink::{CsvSink, Frame, Memory, Point, Sink, Table};

use crate::math::Vector;
use crate::solver::{Account, Ledger};
use crate::state::State;
use crate::totals::Totals;

/// One recorded state.
pub struct View<'a, const D: usize> {
    /// Bodies, time, step.
    pub state: &'a State<D>,
    /// Energies so far.
    pub account: Account,
    /// Reactions and impulses of boundaries.
    pub ledger: &'a Ledger<D>,
    /// For each body, angular momentum about the origin, kg m²/s: one number in 2D, three in 3D, none in 1D.
    pub spin: &'a [Vec<f64>],
    /// The sums of each body.
    pub totals: &'a [Totals<D>],
}

/// A table of a run.
pub trait Observer<const D: usize> {
    /// Name of the table, which is the name of its file without the ending.
    fn name(&self) -> String;

    /// Names of its columns; the first is `time`.
    fn header(&self) -> Vec<String>;

    /// The row for one state.
    fn row(&self, view: &View<'_, D>) -> Vec<f64>;
}

/// `name_x`, `name_y`, `name_z` for a vector, or `name_xx` … for pairs.
fn components<const D: usize>(name: &str) -> impl Iterator<Item = String> {
    ["x", "y", "z"]
        .into_iter()
        .take(D)
        .map(move |axis| format!("{name}_{axis}"))
}

/// Numbers of a vector.
fn numbers<const D: usize>(vector: &Vector<D>) -> impl Iterator<Item = f64> + '_ {
    vector.iter().copied()
}
