//! `mpm validate`.

use super::{ThreadArguments, code, fail, out};
use crate::report::{Align, Cell, Size, Table, panels};
use crate::study::validate::{CASES, Case, CaseError, Check, Report};
use clap::Args;
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

pub const EXAMPLES: &str = "\
Examples:
  mpm validate                          every case
  mpm validate --list                   what they claim, and where the answers come from
  mpm validate bar1d --output compared  tables and pictures of computed against exact

Exit code 0 only if every case passes, 1 if one fails.";

/// Options of `mpm validate`.
#[derive(Args)]
pub struct ValidateArguments {
    /// Cases to run [default: all]
    cases: Vec<String>,
    /// List the cases and what they claim
    #[arg(long)]
    list: bool,
    /// Print the results as one JSON object on standard output
    #[arg(long)]
    json: bool,
    /// Write tables and pictures of computed against exact there
    #[arg(long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Replace files in the output folder
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    threads: ThreadArguments,
}

#[derive(Serialize)]
struct Outcome {
    case: &'static str,
    claim: &'static str,
    reference: &'static str,
    passed: bool,
    error: Option<String>,
    seconds: f64,
    checks: Vec<Check>,
}

#[derive(Serialize)]
struct Results<'a> {
    passed: bool,
    cases: &'a [Outcome],
}

/// Runs cases with known answers.
pub fn validate(arguments: &ValidateArguments) -> Result<ExitCode, ExitCode> {
    let cases = choose(&arguments.cases)?;
    if arguments.list {
        let mut table = Table::new(["case", "claim", "reference"]);
        for case in cases {
            table.push([case.name, case.claim, case.reference]);
        }
        out::result(&table.to_string())?;
        return Ok(ExitCode::SUCCESS);
    }
    if let Some(folder) = &arguments.output {
        let name = folder.display();
        if folder.exists() && !folder.is_dir() {
            let message = format!("{name} is a file; name a folder for tables and pictures");
            return Err(fail(code::INPUT, &message));
        }
        let used = std::fs::read_dir(folder).is_ok_and(|mut entries| entries.next().is_some());
        if used && !arguments.force {
            let message = format!(
                "{name} already holds files; name another folder with --output, or replace them with --force"
            );
            return Err(fail(code::INPUT, &message));
        }
    }
    let mut outcomes = Vec::new();
    for case in cases {
        let started = Instant::now();
        let mut report = Report::default();
        let result: Result<(), CaseError> =
            arguments.threads.install(|| (case.run)(&mut report))?;
        report.close_account();
        if let Some(folder) = &arguments.output {
            write(folder, case.name, &report).map_err(|error| {
                fail(
                    code::SYSTEM,
                    &format!("cannot write to {}: {error}", folder.display()),
                )
            })?;
        }
        let outcome = Outcome {
            case: case.name,
            claim: case.claim,
            reference: case.reference,
            passed: result.is_ok() && report.passed(),
            error: result.err().map(|error| error.to_string()),
            seconds: started.elapsed().as_secs_f64(),
            checks: report.checks,
        };
        if !arguments.json {
            out::result(&describe(&outcome))?;
        }
        outcomes.push(outcome);
    }
    let failed = outcomes.iter().filter(|outcome| !outcome.passed).count();
    if arguments.json {
        let passed = failed == 0;
        out::json(&Results {
            passed,
            cases: &outcomes,
        })?;
    } else {
        let passed = outcomes.len() - failed;
        out::result(&format!("{passed} of {} cases passed\n", outcomes.len()))?;
    }
    Ok(ExitCode::from(if failed == 0 {
        code::DONE
    } else {
        code::VALIDATION_FAILED
    }))
}

fn choose(names: &[String]) -> Result<Vec<&'static Case>, ExitCode> {
    if names.is_empty() {
        return Ok(CASES.iter().collect());
    }
    let mut chosen = Vec::new();
    for name in names {
        let Some(case) = CASES.iter().find(|case| case.name == name) else {
            let hint = crate::input::nearest(name, CASES.iter().map(|case| case.name)).map_or_else(
                || "`mpm validate --list` names them all".into(),
                |near| format!("did you mean \"{near}\"?"),
            );
            return Err(fail(
                code::INPUT,
                &format!("there is no case \"{name}\"; {hint}"),
            ));
        };
        chosen.push(case);
    }
    Ok(chosen)
}

fn describe(outcome: &Outcome) -> String {
    let mut text = format!(
        "{}: {} ({:.1} s)\n  reference: {}\n",
        outcome.case, outcome.claim, outcome.seconds, outcome.reference
    );
    let mut table = Table::new(["  ", "measured", "limit", ""])
        .align(1, Align::Right)
        .align(2, Align::Left)
        .colored_on_terminal();
    for check in &outcome.checks {
        table.push([
            Cell::from(format!("  {}", check.what)),
            Cell::from(format!("{:.5e}", check.measured)),
            Cell::from(limit(check)),
            Cell::verdict(check.passed),
        ]);
    }
    text += &table.to_string();
    if let Some(error) = &outcome.error {
        text += &format!("  FAIL: {error}\n");
    }
    text + "\n"
}

fn limit(check: &Check) -> String {
    match (check.lowest, check.highest) {
        (Some(lowest), Some(highest)) => format!("{lowest:.5e} .. {highest:.5e}"),
        (Some(lowest), None) => format!(">= {lowest:.2e}"),
        (None, Some(highest)) => format!("<= {highest:.2e}"),
        (None, None) => String::new(),
    }
}

fn write(folder: &Path, case: &str, report: &Report) -> std::io::Result<()> {
    std::fs::create_dir_all(folder)?;
    for (name, header, columns) in &report.tables {
        let mut writer = csv::Writer::from_path(folder.join(format!("{case}_{name}.csv")))?;
        writer.write_record(header)?;
        let rows = columns.iter().map(Vec::len).min().unwrap_or(0);
        for row in 0..rows {
            writer.write_record(columns.iter().map(|column| format!("{:?}", column[row])))?;
        }
        writer.flush()?;
    }
    for (name, charts) in &report.charts {
        panels(
            charts,
            &folder.join(format!("{case}_{name}.png")),
            Size::default(),
        )?;
    }
    Ok(())
}
