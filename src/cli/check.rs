//! `mpm check`.
use super::{ScenarioArguments, load};
use clap::Args;
use std::process::ExitCode;
/// Options of `mpm check`.
#[derive(Args)]
pub struct CheckArguments {
    #[command(flatten)]
    scenario: ScenarioArguments,
}
/// Checks.
pub fn check(arguments: &CheckArguments) -> ExitCode {
    match load(&arguments.scenario) {
        Ok(_) => ExitCode::SUCCESS,
        Err(code) => code,
    }
}
