//! What a case measured.

use super::{CaseError, Recorded, simulate};
use crate::report::LineChart;
use serde::Serialize;

/// One measured figure beside its limit.
#[derive(Clone, Debug, Serialize)]
pub struct Check {
    /// What was measured.
    pub what: String,
    /// What came out.
    pub measured: f64,
    /// Smallest value that passes.
    pub lowest: Option<f64>,
    /// Largest value that passes.
    pub highest: Option<f64>,
    /// Whether it passes.
    pub passed: bool,
}

/// Largest energy residual, relative to the largest energy turned over, that any validation run may have.
const ENERGY_RESIDUAL: f64 = 1e-11;

/// Collects what a case measures and draws.
#[derive(Default)]
pub struct Report {
    /// Measured figures.
    pub checks: Vec<Check>,
    /// Pictures of computed against exact, by name.
    pub charts: Vec<(String, Vec<LineChart>)>,
    /// Tables of computed against exact: name, header, columns.
    pub tables: Vec<(String, Vec<String>, Vec<Vec<f64>>)>,
    worst_residual: Option<f64>,
}

impl Report {
    /// Claims that `measured` is at most `limit`.
    pub fn at_most(&mut self, what: impl Into<String>, measured: f64, limit: f64) {
        self.between(what, measured, None, Some(limit));
    }

    /// Claims that `measured` is at least `limit`.
    pub fn at_least(&mut self, what: impl Into<String>, measured: f64, limit: f64) {
        self.between(what, measured, Some(limit), None);
    }

    /// Claims that `measured` differs from `expected` by at most `tolerance`, all in the same unit.
    pub fn close(&mut self, what: impl Into<String>, measured: f64, expected: f64, tolerance: f64) {
        self.between(
            what,
            measured,
            Some(expected - tolerance),
            Some(expected + tolerance),
        );
    }

    fn between(
        &mut self,
        what: impl Into<String>,
        measured: f64,
        lowest: Option<f64>,
        highest: Option<f64>,
    ) {
        // a measured NaN passes nothing
        let passed = lowest.is_none_or(|limit| measured >= limit)
            && highest.is_none_or(|limit| measured <= limit)
            && measured.is_finite();
        self.checks.push(Check {
            what: what.into(),
            measured,
            lowest,
            highest,
            passed,
        });
    }

    /// Adds a picture with one panel or several.
    pub fn chart(&mut self, name: &str, panels: Vec<LineChart>) {
        self.charts.push((name.into(), panels));
    }

    /// Adds a table, column by column.
    pub fn table(&mut self, name: &str, columns: &[(&str, &[f64])]) {
        self.tables.push((
            name.into(),
            columns
                .iter()
                .map(|(header, _)| header.to_string())
                .collect(),
            columns.iter().map(|(_, column)| column.to_vec()).collect(),
        ));
    }

    /// Runs a scenario as [`simulate`] does, and watches its energy account.
    ///
    /// # Errors
    /// If the scenario is wrong or its run goes wrong.
    pub fn run(&mut self, text: &str, overrides: &[String]) -> Result<Recorded, CaseError> {
        let recorded = simulate(text, overrides, false)?;
        self.watch(&recorded);
        Ok(recorded)
    }

    /// The same, keeping all points at every recorded time.
    ///
    /// # Errors
    /// If the scenario is wrong or its run goes wrong.
    pub fn run_with_frames(
        &mut self,
        text: &str,
        overrides: &[String],
    ) -> Result<Recorded, CaseError> {
        let recorded = simulate(text, overrides, true)?;
        self.watch(&recorded);
        Ok(recorded)
    }

    fn watch(&mut self, recorded: &Recorded) {
        let residual = recorded.summary.worst_energy_residual;
        self.worst_residual = Some(
            self.worst_residual
                .map_or(residual, |worst: f64| worst.max(residual)),
        );
    }

    /// Adds the claim that every case makes about the energy account of its runs.
    pub fn close_account(&mut self) {
        if let Some(worst) = self.worst_residual {
            self.at_most(
                "energy residual / energy turned over, worst run",
                worst,
                ENERGY_RESIDUAL,
            );
        }
    }

    /// Whether everything measured passes, and anything was.
    pub fn passed(&self) -> bool {
        !self.checks.is_empty() && self.checks.iter().all(|check| check.passed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn passes(claim: impl Fn(&mut Report)) -> bool {
        let mut report = Report::default();
        claim(&mut report);
        assert_eq!(report.passed(), report.checks[0].passed);
        report.passed()
    }

    #[test]
    fn a_figure_passes_on_the_right_side_of_its_limits_only() {
        for (figure, low, high, near) in [
            (0.9, false, true, false),
            (1.0, true, true, true),
            (1.05, true, false, true),
            (1.2, true, false, false),
            (-1.0, false, true, false),
            // what is no number, or no finite one, is never right
            (f64::NAN, false, false, false),
            (f64::INFINITY, false, false, false),
            (f64::NEG_INFINITY, false, false, false),
        ] {
            assert_eq!(passes(|r| r.at_least("", figure, 1.0)), low, "{figure}");
            assert_eq!(passes(|r| r.at_most("", figure, 1.0)), high, "{figure}");
            let close = |r: &mut Report| r.close("", figure, 1.03, 0.04);
            assert_eq!(passes(close), near, "{figure}");
        }
    }

    #[test]
    fn a_case_passes_if_all_of_its_figures_do_and_there_are_any() {
        let mut report = Report::default();
        assert!(!report.passed(), "nothing was measured");
        report.at_most("good", 1.0, 2.0);
        assert!(report.passed());
        report.at_most("bad", 3.0, 2.0);
        report.at_most("good again", 1.0, 2.0);
        assert!(!report.passed());
    }
}
