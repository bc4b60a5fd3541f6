//! `mpm stability`.

use super::{ThreadArguments, code, fail, out};
use crate::report::{Align, Cell, Table};
use crate::study::stability::{FAILURES, Failure, Findings, Method, Row, Sense, Study};
use clap::Args;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

pub const EXAMPLES: &str = "\
Examples:
  mpm stability                               every way of failing
  mpm stability --list                        what they are, and how they are measured
  mpm stability courant --basis quadratic     the critical time steps of one basis
  mpm stability courant --output maps         its picture, and its edges as CSV and JSON

A method that fails here is what the case shows, no error: exit code 0 whatever fails.";

/// Options of `mpm stability`.
#[derive(Args)]
pub struct StabilityArguments {
    /// Cases to go through [default: all]
    cases: Vec<String>,
    /// List the cases and what counts as failed
    #[arg(long)]
    list: bool,
    /// Only these bases
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    basis: Vec<String>,
    /// Only these transfers
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    transfer: Vec<String>,
    /// Only these updates
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    update: Vec<String>,
    /// Only these frames [default: updated]
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    frame: Vec<String>,
    /// Points per cell and axis, where a case leaves them open; cases that map something else take the first
    #[arg(long, value_name = "N", value_delimiter = ',', value_parser = clap::value_parser!(u32).range(1..=8))]
    points: Vec<u32>,
    /// Print the results as one JSON object on standard output
    #[arg(long)]
    json: bool,
    /// Write edges and pictures there
    #[arg(long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Write into the output folder even if it exists
    #[arg(long)]
    force: bool,
    /// Do not show progress
    #[arg(long)]
    quiet: bool,
    #[command(flatten)]
    threads: ThreadArguments,
}

#[derive(Serialize)]
struct Outcome {
    case: &'static str,
    title: &'static str,
    measure: &'static str,
    prediction: &'static str,
    quantity: &'static str,
    limit: f64,
    sense: Sense,
    shown: String,
    seconds: f64,
    edges: Vec<Row>,
}

#[derive(Serialize)]
struct Results {
    cases: Vec<Outcome>,
}

/// Shows where methods fail.
pub fn stability(arguments: &StabilityArguments) -> Result<ExitCode, ExitCode> {
    let cases = choose(&arguments.cases)?;
    let methods = methods(arguments)?;
    if arguments.list {
        let mut table = Table::new(["case", "what fails", "what counts as failed"]);
        for case in cases {
            table.push([case.name, case.title, case.measure]);
        }
        out::result(&table.to_string())?;
        return Ok(ExitCode::SUCCESS);
    }
    if let Some(folder) = &arguments.output {
        prepare(folder, arguments.force)?;
    }
    let mut outcomes = Vec::new();
    for (index, case) in cases.iter().enumerate() {
        let started = Instant::now();
        let bar = progress_bar(arguments, case, index, cases.len());
        let study = Study {
            methods: methods.clone(),
            points: arguments.points.clone(),
            progress: &|done, all| {
                bar.set_length(all as u64);
                bar.set_position(done as u64);
            },
        };
        let found = arguments.threads.install(|| (case.run)(&study))?;
        bar.finish_and_clear();
        let findings = found.map_err(|error| {
            let message = format!("{}: {error}", case.name);
            fail(code::RUN, &message)
        })?;
        let outcome = Outcome {
            case: case.name,
            title: case.title,
            measure: case.measure,
            prediction: case.prediction,
            quantity: findings.quantity,
            limit: findings.limit,
            sense: findings.sense,
            shown: findings.shown.clone(),
            seconds: started.elapsed().as_secs_f64(),
            edges: findings.rows.clone(),
        };
        if let Some(folder) = &arguments.output {
            write(folder, &outcome, &findings).map_err(|error| {
                let message = format!("cannot write to {}: {error}", folder.display());
                fail(code::SYSTEM, &message)
            })?;
        }
        if !arguments.json {
            out::result(&describe(&outcome))?;
        }
        outcomes.push(outcome);
    }
    if arguments.json {
        out::json(&Results { cases: outcomes })?;
    }
    Ok(ExitCode::SUCCESS)
}

fn progress_bar(
    arguments: &StabilityArguments,
    case: &Failure,
    index: usize,
    count: usize,
) -> ProgressBar {
    if arguments.quiet {
        return ProgressBar::hidden();
    }
    // indicatif shows nothing where standard error is no terminal
    let bar = ProgressBar::with_draw_target(Some(1), ProgressDrawTarget::stderr());
    let template = format!(
        "{:>2}/{count} {:<12} {{bar:30}} {{pos}}/{{len}}, {{elapsed}} gone, {{eta}} left",
        index + 1,
        case.name
    );
    if let Ok(style) = ProgressStyle::with_template(&template) {
        bar.set_style(style);
    }
    bar
}

fn choose(names: &[String]) -> Result<Vec<&'static Failure>, ExitCode> {
    if names.is_empty() {
        return Ok(FAILURES.iter().collect());
    }
    let find = |name: &String| {
        FAILURES
            .iter()
            .find(|case| case.name == name)
            .ok_or_else(|| {
                let all = FAILURES.iter().map(|case| case.name);
                let hint = crate::input::nearest(name, all).map_or_else(
                    || "`mpm stability --list` names them all".into(),
                    |near| format!("did you mean \"{near}\"?"),
                );
                let message = format!("there is no case \"{name}\"; {hint}");
                fail(code::INPUT, &message)
            })
    };
    names.iter().map(find).collect()
}

/// The methods that are asked for.
fn methods(arguments: &StabilityArguments) -> Result<Vec<Method>, ExitCode> {
    let mut methods = Method::all();
    type Limit<'a> = (&'a str, &'a [String], fn(&Method) -> &'static str);
    let limits: [Limit<'_>; 4] = [
        ("basis", &arguments.basis, |m| m.basis),
        ("transfer", &arguments.transfer, |m| m.transfer),
        ("update", &arguments.update, |m| m.update),
        ("frame", &arguments.frame, |m| m.frame),
    ];
    for (kind, wanted, of) in limits {
        let mut known: Vec<&str> = Method::all().iter().map(of).collect();
        known.dedup();
        known.sort_unstable();
        known.dedup();
        if let Some(name) = wanted.iter().find(|name| !known.contains(&name.as_str())) {
            let message = format!(
                "there is no {kind} \"{name}\"; known here: {}",
                known.join(", ")
            );
            return Err(fail(code::INPUT, &message));
        }
        methods.retain(|method| wanted.is_empty() || wanted.iter().any(|name| name == of(method)));
    }
    if arguments.frame.is_empty() {
        methods.retain(|method| !method.is_total());
    }
    Ok(methods)
}

fn prepare(folder: &Path, force: bool) -> Result<(), ExitCode> {
    let name = folder.display();
    if folder.exists() && !folder.is_dir() {
        let message = format!("{name} is a file; name a folder for edges and pictures");
        return Err(fail(code::INPUT, &message));
    }
    if folder.exists() && !force {
        let message = format!(
            "{name} already exists; name another folder with --output, or write into it with --force"
        );
        return Err(fail(code::INPUT, &message));
    }
    std::fs::create_dir_all(folder).map_err(|error| {
        let message = format!("cannot create {name}: {error}");
        fail(code::SYSTEM, &message)
    })
}

fn describe(outcome: &Outcome) -> String {
    let Outcome {
        case,
        title,
        seconds,
        ..
    } = outcome;
    let side = match outcome.sense {
        Sense::AtLeast => "at least",
        Sense::AtMost => "at most",
    };
    let mut text = format!("{case}: {title} ({seconds:.1} s)\n");
    text += &wrapped("  measured:  ", outcome.measure);
    text += &wrapped("  predicted: ", outcome.prediction);
    let asked = format!("{} {side} {}", outcome.quantity, number(outcome.limit));
    text += &wrapped("  asked for: ", &asked);
    let mut table = Table::new(["  method", "at", "predicted", "measured", "", "margin"])
        .align(2, Align::Right)
        .align(3, Align::Right)
        .align(5, Align::Right)
        .colored_on_terminal();
    for row in &outcome.edges {
        table.push([
            Cell::from(format!("  {}", row.method)),
            Cell::from(&row.at),
            Cell::from(row.predicted.map_or("-".into(), number)),
            Cell::from(number(row.measured)),
            Cell::survival(row.survives),
            Cell::from(number(row.margin)),
        ]);
    }
    text += &table.to_string();
    text + &wrapped("  ", &outcome.shown) + "\n"
}

/// Text in lines of a width that terminals have, all but the first indented by the width of `head`.
fn wrapped(head: &str, text: &str) -> String {
    const WIDTH: usize = 118;
    let indent = head.chars().count();
    let mut out = head.to_owned();
    let mut column = indent;
    for word in text.split_whitespace() {
        let width = word.chars().count();
        if column > indent && column + 1 + width > WIDTH {
            out += "\n";
            out += &" ".repeat(indent);
            column = indent;
        }
        if column > indent {
            out += " ";
            column += 1;
        }
        out += word;
        column += width;
    }
    out + "\n"
}

/// Four digits, or why there is none.
fn number(value: f64) -> String {
    match value.abs() {
        x if x.is_nan() => "nan".into(),
        x if x.is_infinite() => "none".into(),
        0.0 => "0".into(),
        x if (1e-3..1e4).contains(&x) => format!("{value:.4}"),
        _ => format!("{value:.2e}"),
    }
}

fn write(folder: &Path, outcome: &Outcome, findings: &Findings) -> std::io::Result<()> {
    let case = outcome.case;
    let mut writer = csv::Writer::from_path(folder.join(format!("{case}.csv")))?;
    writer.write_record([
        "method",
        "at",
        "predicted",
        "measured",
        "survives",
        "margin",
    ])?;
    for row in &outcome.edges {
        writer.write_record([
            row.method.clone(),
            row.at.clone(),
            row.predicted.map_or(String::new(), |x| x.to_string()),
            row.measured.to_string(),
            row.survives.to_string(),
            row.margin.to_string(),
        ])?;
    }
    writer.flush()?;
    for (name, header, rows) in &findings.tables {
        let mut writer = csv::Writer::from_path(folder.join(format!("{case}_{name}.csv")))?;
        writer.write_record(header)?;
        for row in rows {
            writer.write_record(row)?;
        }
        writer.flush()?;
    }
    let json = serde_json::to_string_pretty(outcome).map_err(std::io::Error::other)?;
    std::fs::write(folder.join(format!("{case}.json")), json + "\n")?;
    for (name, drawing) in &findings.drawings {
        let name = if name.is_empty() {
            format!("{case}.png")
        } else {
            format!("{case}_{name}.png")
        };
        drawing.write(&folder.join(name))?;
    }
    Ok(())
}
