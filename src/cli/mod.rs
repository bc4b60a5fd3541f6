//! The command line: what can be asked, and what the program says and returns.

mod advice;
mod bench;
mod chart;
mod check;
mod folder;
mod out;
mod pictures;
mod plan;
mod reach;
mod run;
mod stability;
mod validate;

use clap::{Args, Parser, Subcommand};
use out::fail;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Exit codes, a contract with scripts.
pub mod code {
    /// All went well.
    pub const DONE: u8 = 0;
    /// A validation failed.
    pub const VALIDATION_FAILED: u8 = 1;
    /// The input is wrong.
    pub const INPUT: u8 = 2;
    /// The run went wrong.
    pub const RUN: u8 = 3;
    /// A file or the system failed.
    pub const SYSTEM: u8 = 74;
}

const EXAMPLES: &str = "\
Examples:
  mpm check scenarios/bar1d.toml              what would be simulated, at what cost
  mpm run scenarios/bar1d.toml                run it; tables and pictures go to runs/bar1d/
  mpm run scenarios/bar1d.toml --set time.courant=0.3 --output runs/coarse
  mpm validate                                every case with a known answer
  mpm validate bar1d                          one of them
  mpm bench --quick                           how fast this machine computes
  mpm stability courant                       where methods fail: here, the longest stable time steps
  mpm chart bar1d --tolerance 1e-3            which method is right to 1e-3 at the least cost

Exit codes: 0 done, 1 a validation failed, 2 the input is wrong, 3 the run went wrong, 74 a file or the system failed.
Results go to standard output, messages to standard error. docs/scenario.md explains every key of a scenario.";

/// Simulates how solids deform with the Material Point Method: a TOML scenario goes in, CSV tables and pictures come out.
#[derive(Parser)]
#[command(name = "mpm", version, after_help = EXAMPLES, arg_required_else_help = true)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Run a scenario and write its tables and pictures
    #[command(after_help = run::EXAMPLES)]
    Run(run::RunArguments),
    /// Say everything that is wrong with a scenario, or what running it would mean
    #[command(after_help = check::EXAMPLES)]
    Check(check::CheckArguments),
    /// Compare runs with known answers
    #[command(after_help = validate::EXAMPLES)]
    Validate(validate::ValidateArguments),
    /// Measure how fast this machine computes
    #[command(after_help = bench::EXAMPLES)]
    Bench(bench::BenchArguments),
    /// Show where methods fail: measured edges beside predicted ones, as tables and pictures
    #[command(after_help = stability::EXAMPLES)]
    Stability(stability::StabilityArguments),
    /// Chart speed against accuracy over methods, resolutions and time steps
    #[command(after_help = chart::EXAMPLES)]
    Chart(chart::ChartArguments),
}

/// A scenario and changes to it.
#[derive(Args)]
struct ScenarioArguments {
    /// The scenario file (TOML)
    scenario: PathBuf,
    /// Change a key first, such as time.courant=0.3 or 'body[0].velocity=["1 m/s"]'; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
}

/// How many threads.
#[derive(Args)]
struct ThreadArguments {
    /// Threads to use [default: one a core]; results do not depend on it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=4096))]
    threads: Option<u16>,
}

impl ThreadArguments {
    /// Does `work` on as many threads as asked for.
    fn install<R: Send>(&self, work: impl FnOnce() -> R + Send) -> Result<R, ExitCode> {
        let threads = self.threads.map_or(0, usize::from);
        match rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
            Ok(pool) => Ok(pool.install(work)),
            Err(error) => {
                let message = format!("cannot start {threads} threads: {error}");
                Err(fail(code::SYSTEM, &message))
            }
        }
    }
}

/// Runs the program.
pub fn main() -> ExitCode {
    let done = match Arguments::parse().command {
        Command::Run(arguments) => run::run(&arguments),
        Command::Check(arguments) => check::check(&arguments),
        Command::Validate(arguments) => validate::validate(&arguments),
        Command::Bench(arguments) => bench::bench(&arguments),
        Command::Stability(arguments) => stability::stability(&arguments),
        Command::Chart(arguments) => chart::chart(&arguments),
    };
    match done {
        Ok(code) | Err(code) => code,
    }
}

/// One entry of what is wrong with a scenario, as JSON.
#[derive(serde::Serialize)]
struct WrongEntry<'a> {
    line: Option<usize>,
    key: &'a str,
    message: &'a str,
}

impl<'a> From<&'a crate::input::Problem> for WrongEntry<'a> {
    fn from(problem: &'a crate::input::Problem) -> Self {
        Self {
            line: problem.line,
            key: &problem.key,
            message: &problem.message,
        }
    }
}

/// What is wrong with a scenario, as JSON.
#[derive(serde::Serialize)]
struct Wrong<'a> {
    status: &'static str,
    problems: Vec<WrongEntry<'a>>,
}

/// Reads a scenario, or says everything that is wrong with it: to people, and with `json` to programs as well.
fn load(arguments: &ScenarioArguments, json: bool) -> Result<crate::scenario::Loaded, ExitCode> {
    crate::scenario::load(&arguments.scenario, &arguments.set).map_err(|error| {
        // begins with "error: " and ends with a newline
        out::message(&error.to_string());
        if json {
            let problems = error.problems.iter().map(WrongEntry::from).collect();
            let wrong = Wrong {
                status: "the scenario is wrong",
                problems,
            };
            if let Err(code) = out::json(&wrong) {
                return code;
            }
        }
        ExitCode::from(code::INPUT)
    })
}

/// The name of a scenario: its file name without the ending.
fn stem(path: &Path) -> String {
    path.file_stem().map_or_else(
        || "scenario".into(),
        |stem| match stem.to_string_lossy().into_owned() {
            // `...toml` must not write beside the folder of runs
            name if name.is_empty() || name.chars().all(|c| c == '.') => "scenario".into(),
            name => name,
        },
    )
}
