//! `mpm chart`.

mod files;
mod options;
mod says;

use super::{ThreadArguments, code, fail, folder, out};
use crate::study::chart::{
    Chart, FileSubject, Setting, Subject, Sweep, Trial, default_sweep, quick, scenarios,
};
use crate::study::validate::PROBLEMS;
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use options::{AxisArguments, CostChoice};
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, Instant};

pub const EXAMPLES: &str = "\
Examples:
  mpm chart manufactured                          methods on a case with a known answer
  mpm chart bar1d --tolerance 1e-3                the cheapest setting that is right to 1e-3, to paste
  mpm chart vortex --basis quadratic,cubic --cells 20,40 --repeat 1
  mpm chart large_bar --update usl,musl           more than the default sweep: other updates
  mpm chart bar1d --dimensions 1,2,3              what the same answer costs in 2D and 3D
  mpm chart scenarios/discs.toml --quick          a scenario of your own, against a finer run of itself
  mpm chart --list                                cases, and what their error is

The folder gets chart.csv (every run), orders.csv, chart_wall.png and chart_work.png. Wall time is the median of the repeats;
work is steps x points x nodes in a stencil x passes, the same on every machine (frame total: 0.1 to 2.4 nodes a point more, by law and dimension).
Exit codes: 0 done, 1 no setting meets the tolerance, 2 the input is wrong, 3 the reference run went wrong, 74 a file or the system failed.";

/// Options of `mpm chart`.
#[derive(Args)]
pub struct ChartArguments {
    /// A case (see --list) or a scenario file
    #[arg(required_unless_present = "list")]
    case: Option<String>,
    /// List the cases and what their error is
    #[arg(long)]
    list: bool,
    #[command(flatten)]
    axes: AxisArguments,
    /// Change a key of a scenario file first; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Times that each run is timed [default: 3, with --quick 1]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000))]
    repeat: Option<u32>,
    /// Fewer and coarser runs
    #[arg(long)]
    quick: bool,
    /// Name the cheapest setting with an error of at most this, as TOML to paste
    #[arg(long, value_name = "ERROR")]
    tolerance: Option<String>,
    /// What the frontier and the cheapest setting go by
    #[arg(long, value_enum, default_value_t = CostChoice::Work)]
    cost: CostChoice,
    /// Folder for the tables and pictures [default: charts/<case>]
    #[arg(long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Replace an earlier chart in the output folder
    #[arg(long)]
    force: bool,
    /// Print the results, and nothing else, as one JSON object on standard output
    #[arg(long)]
    json: bool,
    /// Print no progress
    #[arg(long)]
    quiet: bool,
    #[command(flatten)]
    threads: ThreadArguments,
}

/// Charts speed against accuracy.
pub fn chart(arguments: &ChartArguments) -> Result<ExitCode, ExitCode> {
    if arguments.list {
        out::result(&says::list())?;
        return Ok(ExitCode::SUCCESS);
    }
    let name = arguments.case.as_deref().unwrap_or_default();
    let Request {
        mut subject,
        sweep,
        settings,
        tolerance,
    } = request(arguments, name)?;
    let settings = scenarios(&subject, settings).map_err(|wrong| {
        wrong
            .iter()
            .for_each(|error| out::message(&error.to_string()));
        ExitCode::from(code::INPUT)
    })?;
    let default = || Path::new("charts").join(subject.name());
    let folder = arguments.output.clone().unwrap_or_else(default);
    folder::prepare_for(&folder, arguments.force, "chart", files::is_ours)?;
    let mut table = files::Table::create(&folder, subject.norm())?;
    let repeats = arguments
        .repeat
        .unwrap_or(if arguments.quick { 1 } else { 3 });
    let cost = arguments.cost.into();

    let mut progress = Progress::new(arguments.quiet);
    let chart = arguments.threads.install(|| {
        if let Subject::File(file) = &subject {
            let setting = file.reference_setting(&sweep);
            progress.say("the reference run, which is the dearest");
            subject.prepare(&setting).map_err(|error| {
                fail(code::RUN, &format!("the reference run went wrong: {error}"))
            })?;
        }
        Ok::<Chart, ExitCode>(Chart::draw(
            subject,
            &settings,
            repeats,
            &mut |done, all, left| progress.show(done, all, left),
            &mut |trial: &Trial| table.push(trial),
        ))
    })??;
    progress.finish();
    table.finish(&chart)?;
    files::pictures(&folder, &chart)?;
    if arguments.json {
        out::json(&says::results(&chart, cost, tolerance, &folder))?;
    } else {
        out::result(&says::describe(&chart, cost, &folder))?;
        if let Some(tolerance) = tolerance {
            out::result(&says::to_paste(&chart, cost, tolerance))?;
        }
    }
    let met = tolerance.is_none_or(|tolerance| chart.cheapest(cost, tolerance).is_some());
    Ok(ExitCode::from(if met {
        code::DONE
    } else {
        code::VALIDATION_FAILED
    }))
}

/// What was asked for, all of it readable.
struct Request {
    subject: Subject,
    sweep: Sweep,
    settings: Vec<Setting>,
    tolerance: Option<f64>,
}

/// Reads what was asked for, or says everything that is wrong with it.
fn request(arguments: &ChartArguments, name: &str) -> Result<Request, ExitCode> {
    let mut problems = Vec::new();
    let given = arguments.axes.read(&mut problems);
    let tolerance = arguments.tolerance.as_ref().and_then(|text| {
        let number = text.parse().ok().filter(|number: &f64| *number > 0.0);
        if number.is_none() {
            problems.push(format!("--tolerance: \"{text}\" is not a positive number"));
        }
        number
    });
    let subject = match PROBLEMS.iter().find(|problem| problem.name == name) {
        Some(problem) => {
            if !arguments.set.is_empty() {
                problems.push("--set: a case has its own scenario; name a scenario file".into());
            }
            Some(Subject::Problem(problem))
        }
        None if name.contains(['.', '/']) => file(arguments, name, &mut problems),
        None => {
            let hint = crate::input::nearest(name, PROBLEMS.iter().map(|problem| problem.name));
            let hint = hint.map_or_else(
                || "`mpm chart --list` names them all; a scenario file ends in .toml".into(),
                |near| format!("did you mean \"{near}\"?"),
            );
            problems.push(format!("there is no case \"{name}\" to chart; {hint}"));
            None
        }
    };
    if let Some(subject) = &subject {
        options::check_dimensions(subject, &given, &mut problems);
    }
    let Some(subject) = subject.filter(|_| problems.is_empty()) else {
        if problems.is_empty() {
            return Err(ExitCode::from(code::INPUT));
        }
        let noun = if problems.len() == 1 {
            "problem"
        } else {
            "problems"
        };
        let list: Vec<String> = problems.iter().map(|p| format!("\n  {p}")).collect();
        let text = format!("mpm chart has {} {noun}{}", problems.len(), list.concat());
        return Err(fail(code::INPUT, &text));
    };
    let mut sweep = default_sweep(&subject, &given);
    if arguments.quick {
        quick(&mut sweep, &given);
    }
    let settings = sweep.settings();
    Ok(Request {
        subject,
        sweep,
        settings,
        tolerance,
    })
}

fn file(arguments: &ChartArguments, name: &str, problems: &mut Vec<String>) -> Option<Subject> {
    let path = Path::new(name);
    match crate::scenario::load(path, &arguments.set) {
        Err(error) => {
            out::message(&error.to_string());
            None
        }
        Ok(loaded) => {
            let name = super::stem(path);
            let file = FileSubject::new(&name, loaded.resolved_toml, Vec::new());
            file.map_err(|error| problems.push(error.to_string()))
                .ok()
                .map(|file| Subject::File(Box::new(file)))
        }
    }
}

/// How far it is: a bar on a terminal, a line now and then elsewhere.
struct Progress {
    bar: ProgressBar,
    lines: bool,
    last: Instant,
}

impl Progress {
    fn new(quiet: bool) -> Self {
        let terminal = std::io::stderr().is_terminal();
        let bar = if quiet || !terminal {
            ProgressBar::hidden()
        } else {
            let bar = ProgressBar::new(1);
            let style = ProgressStyle::with_template("{bar:32} {pos} of {len} runs  {msg}");
            bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
            bar
        };
        Self {
            bar,
            lines: !quiet && !terminal,
            last: Instant::now(),
        }
    }

    fn say(&self, text: &str) {
        self.bar.set_message(text.to_string());
        if self.lines {
            out::message(&format!("{text}\n"));
        }
    }

    fn show(&mut self, done: usize, all: usize, left: f64) {
        let left = out::duration(left);
        self.bar.set_length(all as u64);
        self.bar.set_position(done as u64);
        self.bar.set_message(format!("about {left} left"));
        if self.lines && self.last.elapsed() > Duration::from_secs(10) && done < all {
            out::message(&format!("{done} of {all} runs, about {left} left\n"));
            self.last = Instant::now();
        }
    }

    fn finish(&self) {
        self.bar.finish_and_clear();
    }
}
