//! Pictures of a finished run.
use crate::scenario::Scenario;
use std::path::Path;
/// Draws them.
pub fn draw(_folder: &Path, _scenario: &Scenario) -> std::io::Result<()> {
    Ok(())
}
