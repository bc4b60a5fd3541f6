//! `mpm run`.

use super::{ScenarioArguments, ThreadArguments, code, fail, folder, load, out, stem};
use crate::observe::{CsvSink, Frame};
use crate::run::{Progress, RunError, Scene, SceneVisitor, Summary, drive, with_scene};
use crate::scenario::{Scenario, StepRule};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

pub const EXAMPLES: &str = "\
Examples:
  mpm run scenarios/bar1d.toml
  mpm run scenarios/bar1d.toml --set time.courant=0.3 --output runs/coarse
  mpm run scenarios/bar1d.toml --set 'material.bar.linear_elastic.youngs_modulus=\"400 Pa\"' --force
  mpm run runs/bar1d/run.toml --output runs/again      the folder of a run repeats it
  mpm run scenarios/bar1d.toml --json --force > summary.json

The folder gets energy.csv, a table for each body, probe and boundary, summary.json, run.toml and pictures.
Exit codes: 0 done, 2 the input is wrong, 3 the run went wrong (its tables can be read), 74 a file or the system failed.";

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
    /// Replace an earlier run in the output folder
    #[arg(long)]
    force: bool,
    /// Print nothing but errors
    #[arg(long)]
    quiet: bool,
    /// Print the summary, and nothing else, as one JSON object on standard output
    #[arg(long)]
    json: bool,
    /// Write tables only
    #[arg(long)]
    no_pictures: bool,
}

/// Runs a scenario.
pub fn run(arguments: &RunArguments) -> Result<ExitCode, ExitCode> {
    let loaded = load(&arguments.scenario, arguments.json)?;
    let scenario = &loaded.scenario;
    if !arguments.quiet {
        loaded
            .warnings
            .iter()
            .for_each(|warning| out::warn(warning));
    }
    let name = stem(&arguments.scenario.scenario);
    let default = || Path::new("runs").join(&name);
    let folder = arguments.output.clone().unwrap_or_else(default);
    folder::prepare(&folder, arguments.force)?;
    folder::write_scenario(&folder, &loaded)?;
    let bar = progress_bar(arguments);
    let mut sink = CsvSink::new(&folder);
    let (mut summary, result) = arguments.threads.install(|| {
        let visitor = Drive {
            scenario,
            sink: &mut sink,
            bar: &bar,
            quiet: arguments.quiet,
            frames: !arguments.no_pictures,
        };
        with_scene(scenario, visitor)
    })?;
    bar.finish_and_clear();
    make_finite(&mut summary);
    let json = serde_json::to_string_pretty(&summary)
        .map_err(|error| fail(code::SYSTEM, &format!("cannot write the summary: {error}")))?;
    let written = folder::write(&folder.join("summary.json"), &format!("{json}\n"));
    if arguments.json {
        out::result(&format!("{json}\n"))?;
    }
    written?;
    if !arguments.no_pictures {
        draw(&folder, scenario, sink.frames(), arguments.quiet);
    }
    if let Err(error) = result {
        let (time, name) = (summary.recorded, folder.display());
        out::message(&format!("tables up to t = {time:e} s are in {name}\n"));
        let code = match error {
            RunError::Fault(_) => code::RUN,
            RunError::Io(_) | RunError::Interrupted => code::SYSTEM,
        };
        return Err(fail(code, &error.to_string()));
    }
    if !arguments.quiet
        && let Some(warning) = &summary.warning
    {
        out::warn(warning);
    }
    if !(arguments.quiet || arguments.json) {
        out::result(&describe(&summary, &folder))?;
    }
    Ok(ExitCode::from(code::DONE))
}

fn draw(folder: &Path, scenario: &Scenario, frames: &[Frame], quiet: bool) {
    if let Err(error) = super::pictures::draw(folder, scenario, frames)
        && !quiet
    {
        out::warn(&format!("cannot draw the pictures: {error}"));
    }
}

/// JSON has no infinity: what a run that took no step cannot know is zero.
fn make_finite(summary: &mut Summary) {
    let energy = &mut summary.energy;
    let numbers = [
        &mut energy.kinetic,
        &mut energy.elastic,
        &mut energy.potential,
        &mut energy.external_work,
        &mut energy.boundary_work,
        &mut energy.damping,
        &mut energy.numerical,
        &mut energy.total,
        &mut energy.residual,
        &mut energy.turned_over,
        &mut summary.worst_energy_residual,
    ];
    let momenta = summary.momentum.iter_mut().flatten();
    let all = numbers.into_iter().chain(&mut summary.dt).chain(momenta);
    // adding zero turns -0.0 into 0.0
    all.for_each(|x| *x = if x.is_finite() { *x + 0.0 } else { 0.0 });
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
    quiet: bool,
    frames: bool,
}

impl SceneVisitor for Drive<'_> {
    type Output = (Summary, Result<(), RunError>);

    fn visit<const D: usize>(self, mut scene: Scene<D>) -> Self::Output {
        if self.frames && D > 1 {
            self.sink
                .keep_frames(self.scenario.end, scene.state.point_count());
        }
        // a fixed step is judged before the run as well; a scene that cannot start fails below
        if let StepRule::Fixed(dt) = self.scenario.step
            && !self.quiet
            && scene.solver.start(&mut scene.state).is_ok()
        {
            let ratio = dt / scene.solver.limit(&scene.state).crossing_time();
            if let Some(warning) = step_warning(dt, ratio) {
                out::warn(&warning);
            }
        }
        let started = std::time::Instant::now();
        let mut monitor = |progress: &Progress| {
            let work = progress.points as f64 * progress.steps as f64;
            let rate = work / started.elapsed().as_secs_f64();
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
        };
        drive(self.scenario, &mut scene, self.sink, &mut monitor)
    }
}

/// What to say of a fixed step that is `ratio` of the time in which the fastest signal crosses a cell.
pub fn step_warning(dt: f64, ratio: f64) -> Option<String> {
    (ratio > 1.0).then(|| {
        format!(
            "the fixed step of {dt:e} s is {ratio:.2} times the time in which the fastest signal crosses a cell: \
             few methods survive that; use time.courant, or a step of {:.1e} s or less",
            0.5 * dt / ratio
        )
    })
}

fn describe(summary: &Summary, folder: &Path) -> String {
    let energy = &summary.energy;
    let vector = |v: &[f64]| {
        let numbers: Vec<_> = v.iter().map(|x| format!("{x:.6e}")).collect();
        numbers.join(", ")
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
                "{}, {:.2} M particle steps/s, {} particles, {} threads",
                out::duration(summary.wall_seconds),
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
                energy.external_work,
                energy.boundary_work,
                0.0 - energy.damping,
                energy.numerical
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
        let memory = out::bytes(summary.peak_memory as f64);
        lines.insert(2, ("memory", format!("{memory} at most")));
    }
    let line = |(name, value): (&str, String)| format!("{name:<10} {value}\n");
    lines.into_iter().map(line).collect()
}

fn range(dt: [f64; 2]) -> String {
    if dt[0] >= dt[1] * (1.0 - 1e-9) {
        format!("{:.4e} s", dt[1])
    } else {
        format!("{:.4e} to {:.4e} s", dt[0], dt[1])
    }
}
