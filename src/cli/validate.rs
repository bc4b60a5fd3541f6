//! `mpm validate`.
use clap::Args;
use std::process::ExitCode;
/// Options of `mpm validate`.
#[derive(Args)]
pub struct ValidateArguments {}
/// Validates.
pub fn validate(_arguments: &ValidateArguments) -> ExitCode {
    ExitCode::SUCCESS
}
