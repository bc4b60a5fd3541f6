//! `mpm run`.

use super::{ScenarioArguments, ThreadArguments, code, fail, load, stem};
use crate::observe::CsvSink;
use crate::run::{Progress, RunError, Scene, SceneVisitor, Summary, drive, with_scene};
use crate::scenario::{Loaded, Scenario};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Options of `mpm run`.
#[derive(Args)]
pub struct RunArguments {
    #[command(flatten)]
    scenario: ScenarioArguments,
    /// Folder for the tables [default: runs/<scenario>]
    #[arg(long, value_name = "DIR")]
    output: Option<PathBuf>,
    #[command(flatten)]
    threads: ThreadArguments,
    /// Replace the tables of an earlier run in the output folder
    #[arg(long)]
    force: bool,
    /// Print nothing but errors
    #[arg(long)]
    quiet: bool,
    /// Print the summary as one JSON object on standard output
    #[arg(long)]
    json: bool,
}

/// Runs a scenario.
pub fn run(arguments: &RunArguments) -> ExitCode {
    match try_run(arguments) {
        Ok(code) | Err(code) => code,
    }
}

fn try_run(arguments: &RunArguments) -> Result<ExitCode, ExitCode> {
    let loaded = load(&arguments.scenario)?;
    let name = stem(&arguments.scenario.scenario);
    let folder = arguments
        .output
        .clone()
        .unwrap_or_else(|| Path::new("runs").join(&name));
    prepare(&folder, arguments.force)?;
    write_scenario(&folder, &loaded)?;
    let bar = progress_bar(arguments);
    let (summary, result) = arguments.threads.install(|| {
        let mut sink = CsvSink::new(&folder);
        with_scene(
            &loaded.scenario,
            Drive {
                scenario: &loaded.scenario,
                sink: &mut sink,
                bar: &bar,
            },
        )
    })?;
    bar.finish_and_clear();
    let json = serde_json::to_string_pretty(&summary)
        .map_err(|error| fail(code::SYSTEM, &format!("cannot write the summary: {error}")))?;
    let path = folder.join("summary.json");
    std::fs::write(&path, format!("{json}\n")).map_err(|error| {
        fail(
            code::SYSTEM,
            &format!("cannot write {}: {error}", path.display()),
        )
    })?;
    if arguments.json {
        println!("{json}");
    }
    if let Err(error) = result {
        eprintln!(
            "tables up to t = {:e} s are in {}",
            summary.time,
            folder.display()
        );
        return Err(fail(
            match error {
                RunError::Fault(_) => code::RUN,
                RunError::Io(_) | RunError::Interrupted => code::SYSTEM,
            },
            &error.to_string(),
        ));
    }
    if let Some(warning) = &summary.warning {
        eprintln!("warning: {warning}");
    }
    if let Err(error) = super::pictures::draw(&folder, &loaded.scenario) {
        eprintln!("warning: cannot draw the pictures: {error}");
    }
    if !(arguments.quiet || arguments.json) {
        print_summary(&summary, &folder);
    }
    Ok(ExitCode::SUCCESS)
}

/// Makes the output folder, and refuses one that already holds a run.
fn prepare(folder: &Path, force: bool) -> Result<(), ExitCode> {
    let system = |what: &str, error: std::io::Error| {
        fail(
            code::SYSTEM,
            &format!("cannot {what} {}: {error}", folder.display()),
        )
    };
    if folder.exists() && !folder.is_dir() {
        return Err(fail(
            code::INPUT,
            &format!(
                "{} is a file; name a folder for the tables with --output",
                folder.display()
            ),
        ));
    }
    std::fs::create_dir_all(folder).map_err(|error| system("create", error))?;
    let mut old = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(|error| system("read", error))? {
        let path = entry.map_err(|error| system("read", error))?.path();
        let ours = path
            .extension()
            .is_some_and(|end| end == "csv" || end == "png")
            || path
                .file_name()
                .is_some_and(|name| name == "run.toml" || name == "summary.json");
        if ours {
            old.push(path);
        }
    }
    if !old.is_empty() && !force {
        return Err(fail(
            code::INPUT,
            &format!(
                "{} already holds a run; name another folder with --output, or replace it with --force",
                folder.display()
            ),
        ));
    }
    for path in old {
        std::fs::remove_file(&path).map_err(|error| system("empty", error))?;
    }
    Ok(())
}

fn write_scenario(folder: &Path, loaded: &Loaded) -> Result<(), ExitCode> {
    let path = folder.join("run.toml");
    let text = format!(
        "# The scenario as it was run by mpm {}; `mpm run` on this file repeats the run.\n{}",
        env!("CARGO_PKG_VERSION"),
        loaded.resolved_toml
    );
    std::fs::write(&path, text).map_err(|error| {
        fail(
            code::SYSTEM,
            &format!("cannot write {}: {error}", path.display()),
        )
    })
}

fn progress_bar(arguments: &RunArguments) -> ProgressBar {
    if arguments.quiet || !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(10_000);
    let style = ProgressStyle::with_template("{bar:32} {percent:>3} %  {msg}  {eta} left");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar
}

struct Drive<'a> {
    scenario: &'a Scenario,
    sink: &'a mut CsvSink,
    bar: &'a ProgressBar,
}

impl SceneVisitor for Drive<'_> {
    type Output = (Summary, Result<(), RunError>);

    fn visit<const D: usize>(self, mut scene: Scene<D>) -> Self::Output {
        let started = std::time::Instant::now();
        drive(
            self.scenario,
            &mut scene,
            self.sink,
            &mut |progress: &Progress| {
                let rate = progress.points as f64 * progress.steps as f64
                    / started.elapsed().as_secs_f64();
                self.bar
                    .set_position((10_000.0 * progress.time / progress.end) as u64);
                self.bar.set_message(format!(
                    "t = {:.4e} s  step {}  dt {:.2e} s  {:.1} M particle steps/s",
                    progress.time,
                    progress.steps,
                    progress.dt,
                    rate / 1e6
                ));
                true
            },
        )
    }
}

fn print_summary(summary: &Summary, folder: &Path) {
    let energy = &summary.energy;
    let vector = |v: &[f64]| {
        v.iter()
            .map(|x| format!("{x:.6e}"))
            .collect::<Vec<_>>()
            .join(", ")
    };
    let mut lines = vec![
        (
            "simulated",
            format!(
                "{:.6e} s in {} steps of {}",
                summary.time,
                summary.steps,
                range(summary.dt)
            ),
        ),
        (
            "speed",
            format!(
                "{:.3} s, {:.2} M particle steps/s, {} particles, {} threads",
                summary.wall_seconds,
                summary.particle_steps_per_second / 1e6,
                summary.particles,
                summary.threads
            ),
        ),
        (
            "energy",
            format!(
                "kinetic {:.6e}, elastic {:.6e}, potential {:.6e}, total {:.6e} J",
                energy.kinetic, energy.elastic, energy.potential, energy.total
            ),
        ),
        (
            "work",
            format!(
                "loads {:.6e}, boundaries {:.6e}, damping {:.6e}, lost by the method {:.6e} J",
                energy.external_work, energy.boundary_work, -energy.damping, energy.numerical
            ),
        ),
        (
            "residual",
            format!(
                "{:.1e} of the largest energy turned over",
                summary.worst_energy_residual
            ),
        ),
        (
            "momentum",
            format!(
                "{} -> {} kg m/s",
                vector(&summary.momentum[0]),
                vector(&summary.momentum[1])
            ),
        ),
        (
            "tables",
            format!("{} rows each in {}", summary.rows, folder.display()),
        ),
    ];
    if summary.peak_memory > 0 {
        lines.insert(
            2,
            (
                "memory",
                format!("{:.1} MB at most", summary.peak_memory as f64 / 1e6),
            ),
        );
    }
    let mut out = std::io::stdout().lock();
    for (name, value) in lines {
        // a closed pipe is the reader's choice
        let _ = writeln!(out, "{name:<10} {value}");
    }
}

fn range(dt: [f64; 2]) -> String {
    if dt[0] >= dt[1] * (1.0 - 1e-9) {
        format!("{:.4e} s", dt[1])
    } else {
        format!("{:.4e} to {:.4e} s", dt[0], dt[1])
    }
}
