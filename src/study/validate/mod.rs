//! Runs compared with answers that nobody here made up: closed forms, published figures, other codes.
//!
//! A case is one file with its scenario beside it, and one line in [`CASES`].

mod compare;
mod history;
mod problem;
mod report;
mod swing;

pub use problem::{Expected, Layout, PROBLEMS, Problem};
pub use report::{Check, Report};

use crate::observe::Memory;
use crate::run::{RunError, Scene, SceneVisitor, Summary, drive, with_scene};
use crate::scenario::{InputError, Scenario, parse};

/// A comparison with a known answer.
pub struct Case {
    /// Its name on the command line.
    pub name: &'static str,
    /// What is claimed, in one line.
    pub claim: &'static str,
    /// Where the answer comes from.
    pub reference: &'static str,
    /// Runs it and reports what was measured.
    pub run: fn(&mut Report) -> Result<(), CaseError>,
}

macro_rules! cases {
    ($($case:ident),* $(,)?) => {
        $(mod $case;)*

        /// Every case, in the order in which a reader should meet them.
        pub const CASES: &[Case] = &[$($case::CASE),*];
    };
}

cases! {
    point1d,
    bar1d,
    free_fall,
    wave,
    impact,
    column,
    large_bar,
    manufactured,
    vibration,
    beam,
    vortex,
    uniaxial,
    simple_shear,
    hydrostatic,
    shear_box,
    discs,
    rotation,
    axisymmetric,
    cantilever,
    cantilever_shear,
    breathing_ring,
    pressurised_ring,
    survivors,
    total_lagrangian,
}

/// Why a case could not be finished.
#[derive(Debug)]
pub enum CaseError {
    /// Its scenario is wrong.
    Input(InputError),
    /// Its run went wrong.
    Run(RunError),
}

impl std::fmt::Display for CaseError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Input(error) => error.fmt(f),
            Self::Run(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for CaseError {}

/// A finished run: what it recorded, and its summary.
pub struct Recorded {
    /// The scenario as it was run.
    pub scenario: Scenario,
    /// Tables and, if asked for, all points at every recorded time.
    pub memory: Memory,
    /// Steps, energies, momenta …
    pub summary: Summary,
}

impl Recorded {
    /// A column of a table; empty if there is none.
    pub fn column(&self, table: &str, column: &str) -> Vec<f64> {
        self.memory.column(table, column)
    }
}

/// Runs a scenario text with overrides `KEY=VALUE`, keeping all points at recorded times if `frames`.
///
/// # Errors
/// If the scenario is wrong or its run goes wrong.
pub fn simulate(text: &str, overrides: &[String], frames: bool) -> Result<Recorded, CaseError> {
    let scenario = parse("scenario", text, overrides)
        .map_err(CaseError::Input)?
        .scenario;
    let mut memory = Memory {
        keep_frames: frames,
        ..Memory::default()
    };
    let (summary, result) = with_scene(
        &scenario,
        Record {
            scenario: &scenario,
            memory: &mut memory,
        },
    );
    result.map_err(CaseError::Run)?;
    Ok(Recorded {
        scenario,
        memory,
        summary,
    })
}

struct Record<'a> {
    scenario: &'a Scenario,
    memory: &'a mut Memory,
}

impl SceneVisitor for Record<'_> {
    type Output = (Summary, Result<(), RunError>);

    fn visit<const D: usize>(self, mut scene: Scene<D>) -> Self::Output {
        drive(self.scenario, &mut scene, self.memory, &mut |_| true)
    }
}

/// Root of the mean square of `computed − exact`.
pub fn rms(computed: &[f64], exact: &[f64]) -> f64 {
    let sum: f64 = computed
        .iter()
        .zip(exact)
        .map(|(c, e)| (c - e) * (c - e))
        .sum();
    (sum / computed.len().max(1) as f64).sqrt()
}

/// Overrides from pairs.
pub fn set(pairs: &[(&str, &str)]) -> Vec<String> {
    pairs
        .iter()
        .map(|(key, value)| format!("{key}={value}"))
        .collect()
}
