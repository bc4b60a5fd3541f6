//! The command line: what can be asked, and what the program says and returns.

mod check;
mod pictures;
mod run;
mod validate;

use clap::{Args, Parser, Subcommand};
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
  mpm run scenarios/bar1d.toml                run it; tables go to runs/bar1d/
  mpm run scenarios/bar1d.toml --set time.courant=0.3 --output runs/coarse
  mpm validate                                every case with a known answer
  mpm validate bar1d shear_box                some of them

Exit codes: 0 done, 1 a validation failed, 2 the input is wrong, 3 the run went wrong, 74 a file or the system failed.";

/// Simulates how solids deform, touch and break with the Material Point Method: a TOML scenario goes in, CSV tables come out.
#[derive(Parser)]
#[command(name = "mpm", version, after_help = EXAMPLES, arg_required_else_help = true)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Run a scenario and write its tables
    Run(run::RunArguments),
    /// Say everything that is wrong with a scenario, or what running it would mean
    Check(check::CheckArguments),
    /// Compare runs with known answers
    Validate(validate::ValidateArguments),
}

/// A scenario and changes to it.
#[derive(Args)]
struct ScenarioArguments {
    /// The scenario file (TOML)
    scenario: PathBuf,
    /// Change a key before the run, such as time.courant=0.3 or body[0].velocity=["1 m/s"]
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
            Err(error) => Err(fail(
                code::SYSTEM,
                &format!("cannot start {threads} threads: {error}"),
            )),
        }
    }
}

/// Runs the program.
pub fn main() -> ExitCode {
    match Arguments::parse().command {
        Command::Run(arguments) => run::run(&arguments),
        Command::Check(arguments) => check::check(&arguments),
        Command::Validate(arguments) => validate::validate(&arguments),
    }
}

/// Prints an error and gives the exit code.
fn fail(code: u8, message: &str) -> ExitCode {
    eprintln!("error: {message}");
    ExitCode::from(code)
}

/// Reads a scenario, or says everything that is wrong with it.
fn load(arguments: &ScenarioArguments) -> Result<crate::scenario::Loaded, ExitCode> {
    match crate::scenario::load(&arguments.scenario, &arguments.set) {
        Ok(loaded) => {
            for warning in &loaded.warnings {
                eprintln!("warning: {warning}");
            }
            Ok(loaded)
        }
        Err(error) => {
            eprintln!("{error}");
            Err(ExitCode::from(code::INPUT))
        }
    }
}

/// The name of a scenario: its file name without the ending.
fn stem(path: &Path) -> String {
    path.file_stem().map_or_else(
        || "scenario".into(),
        |stem| stem.to_string_lossy().into_owned(),
    )
}
