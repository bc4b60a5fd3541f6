//! What is charted: a case with a known answer, or a scenario file against a finer run of itself.

use super::axes::{Setting, Sweep, Value, axis, names_of};
use super::signals::{Signals, Watch, places};
use crate::observe::{Frame, Memory, Sink};
use crate::run::{Progress, RunError, Scene, SceneVisitor, Summary, drive, with_scene};
use crate::scenario::{InputError, Scenario, parse};
use crate::study::validate::{Layout, Problem, Recorded};

/// What runs are compared with.
pub enum Subject {
    /// A case with a known answer, in some dimension.
    Problem(&'static Problem),
    /// A scenario file.
    File(Box<FileSubject>),
}

/// A scenario, and what its finer run gave.
pub struct FileSubject {
    /// The file's name without its ending.
    pub name: String,
    text: String,
    overrides: Vec<String>,
    /// As the file says.
    pub scenario: Scenario,
    /// Places of the probes, by body.
    places: Vec<(usize, [f64; 3])>,
    reference: Option<Signals>,
    /// What the reference differs from a run of it with half as many cells, relative.
    pub doubt: f64,
}

impl FileSubject {
    /// A scenario text with overrides.
    ///
    /// # Errors
    /// If the scenario is wrong.
    pub fn new(name: &str, text: String, overrides: Vec<String>) -> Result<Self, InputError> {
        let scenario = parse(name, &text, &overrides)?.scenario;
        Ok(Self {
            name: name.into(),
            text,
            overrides,
            places: places(&scenario),
            scenario,
            reference: None,
            doubt: f64::NAN,
        })
    }

    fn cells(&self) -> u32 {
        self.scenario.grid.cells[0].unsigned_abs()
    }

    fn layout(&self, cells: u32) -> Layout {
        let grid = &self.scenario.grid;
        let mut overrides = self.overrides.clone();
        // the file's own size to the last digit where that is meant
        if cells != self.cells() {
            let size = (grid.max[0] - grid.min[0]) / f64::from(cells);
            overrides.push(format!("grid.cell_size={size:e}"));
        }
        Layout {
            text: self.text.clone(),
            overrides,
        }
    }

    /// What the runs of a chart are compared with: the file's own method with twice the cells of the finest of them, the most
    /// points and the smallest Courant number.
    pub fn reference_setting(&self, sweep: &Sweep) -> Setting {
        let mut values: Vec<Value> = sweep.0.iter().map(|values| values[0]).collect();
        for (name, value) in names_of(&self.scenario.method) {
            values[axis(name)] = value;
        }
        let numbers = |name: &str| sweep.on(name).iter().map(|value| value.number());
        let most = |name: &str| numbers(name).fold(0.0, f64::max);
        values[axis("points")] = Value::Count(most("points") as u32);
        values[axis("courant")] = Value::Number(numbers("courant").fold(5.0, f64::min));
        values[axis("cells")] = Value::Count(2 * most("cells") as u32);
        Setting(values)
    }

    /// The error of signals against the reference.
    fn error(&self, signals: &Signals) -> f64 {
        self.reference
            .as_ref()
            .map_or(f64::NAN, |reference| signals.distance(reference))
    }
}

impl Subject {
    /// Its name.
    pub fn name(&self) -> &str {
        match self {
            Self::Problem(problem) => problem.name,
            Self::File(file) => &file.name,
        }
    }

    /// What moves, in one line.
    pub fn about(&self) -> String {
        match self {
            Self::Problem(problem) => problem.about.into(),
            Self::File(file) => file.scenario.title.clone(),
        }
    }

    /// What the error is.
    pub fn norm(&self) -> String {
        match self {
            Self::Problem(problem) => problem.norm.into(),
            Self::File(file) if file.places.is_empty() => {
                "displacement of the bodies' centres of mass and energies, relative L2 norm over recorded times".into()
            }
            Self::File(_) => {
                "displacement at the probes' places and energies, relative L2 norm over recorded times".into()
            }
        }
    }

    /// What runs are compared with.
    pub fn against(&self) -> String {
        match self {
            Self::Problem(problem) => problem.reference.into(),
            Self::File(_) => "a run of the same scenario with twice the cells of the finest".into(),
        }
    }

    /// What the number of cells counts.
    pub fn cells_are(&self) -> &str {
        match self {
            Self::Problem(problem) => problem.cells_are,
            Self::File(_) => "along x",
        }
    }

    /// Dimensions that it can be set up in.
    pub fn dimensions(&self) -> Vec<usize> {
        match self {
            Self::Problem(problem) => problem.dimensions.to_vec(),
            Self::File(file) => vec![file.scenario.dimension],
        }
    }

    /// The scenario of a setting.
    ///
    /// # Errors
    /// If the scenario cannot have that setting.
    pub fn scenario(&self, setting: &Setting) -> Result<Scenario, InputError> {
        let cells = setting.count("cells");
        let layout = match self {
            Self::Problem(problem) => (problem.layout)(setting.count("dimensions") as usize, cells),
            Self::File(file) => file.layout(cells),
        };
        let base = parse(self.name(), &layout.text, &layout.overrides)?.scenario;
        let overrides = [
            layout.overrides,
            setting.overrides(base.bodies.len(), base.end),
        ]
        .concat();
        Ok(parse(self.name(), &layout.text, &overrides)?.scenario)
    }

    /// Runs a scenario once and measures its error.
    pub(super) fn measure(&self, scenario: &Scenario, most_steps: u64) -> Measured {
        let mut monitor = |progress: &Progress| progress.steps <= most_steps;
        match self {
            Self::Problem(problem) => {
                let mut memory = Memory {
                    keep_frames: true,
                    ..Memory::default()
                };
                let (summary, result) = run(scenario, &mut memory, &mut monitor);
                let recorded = Recorded {
                    scenario: scenario.clone(),
                    memory,
                    summary: summary.clone(),
                };
                let error = match result {
                    Ok(()) => (problem.error)(&recorded),
                    Err(_) => f64::NAN,
                };
                (summary, result, error)
            }
            Self::File(file) => {
                let mut watch = Watch::new(&file.places);
                let (summary, result) = run(scenario, &mut watch, &mut monitor);
                let error = match result {
                    Ok(()) => file.error(&watch.signals(scenario)),
                    Err(_) => f64::NAN,
                };
                (summary, result, error)
            }
        }
    }

    /// Makes what runs are compared with, where that is a run. The setting is the one of [`FileSubject::reference_setting`].
    ///
    /// # Errors
    /// If the reference itself goes wrong.
    pub fn prepare(&mut self, setting: &Setting) -> Result<(), RunError> {
        let mut coarser = setting.clone();
        coarser.0[axis("cells")] = Value::Count(setting.count("cells") / 2);
        let scenarios = [self.scenario(setting), self.scenario(&coarser)];
        let Self::File(file) = self else {
            return Ok(());
        };
        let mut found = Vec::new();
        for scenario in scenarios.into_iter().flatten() {
            let mut watch = Watch::new(&file.places);
            run(&scenario, &mut watch, &mut |_| true).1?;
            found.push(watch.signals(&scenario));
        }
        let mut found = found.into_iter();
        file.reference = found.next();
        file.doubt = found
            .next()
            .map_or(f64::NAN, |signals| file.error(&signals));
        Ok(())
    }
}

/// Summary, how the run ended, and its error.
pub(super) type Measured = (Summary, Result<(), RunError>, f64);

/// Runs a scenario into a sink.
pub(super) fn run(
    scenario: &Scenario,
    sink: &mut dyn Sink,
    monitor: &mut dyn FnMut(&Progress) -> bool,
) -> (Summary, Result<(), RunError>) {
    struct Drive<'a> {
        scenario: &'a Scenario,
        sink: &'a mut dyn Sink,
        monitor: &'a mut dyn FnMut(&Progress) -> bool,
    }
    impl SceneVisitor for Drive<'_> {
        type Output = (Summary, Result<(), RunError>);

        fn visit<const D: usize>(self, mut scene: Scene<D>) -> Self::Output {
            drive(self.scenario, &mut scene, self.sink, self.monitor)
        }
    }
    let drive = Drive {
        scenario,
        sink,
        monitor,
    };
    with_scene(scenario, drive)
}

/// Takes nothing down: for runs that are only timed.
pub(super) struct Nowhere;

impl Sink for Nowhere {
    fn open(&mut self, _: &str, _: &[String]) -> std::io::Result<()> {
        Ok(())
    }

    fn row(&mut self, _: &str, _: &[f64]) -> std::io::Result<()> {
        Ok(())
    }

    fn frame(&mut self, _: Frame) -> std::io::Result<()> {
        Ok(())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}
