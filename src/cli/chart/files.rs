//! The folder of a chart.

use crate::cli::{code, fail};
use crate::study::chart::{AXES, Chart, Cost, Trial, local_order, picture, series};
use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

const RUNS: &str = "chart.csv";
const ORDERS: &str = "orders.csv";
const PICTURES: [(&str, Cost); 2] = [
    ("chart_wall.png", Cost::Wall),
    ("chart_work.png", Cost::Work),
];

/// Whether a chart writes files of this name.
pub fn is_ours(name: &str) -> bool {
    [RUNS, ORDERS].contains(&name) || PICTURES.iter().any(|(picture, _)| *picture == name)
}

/// `chart.csv`, row by row as runs are done, so that a chart that is stopped leaves what it has.
pub struct Table {
    folder: PathBuf,
    writer: csv::Writer<File>,
    rows: Vec<Trial>,
    norm: String,
    problem: Option<String>,
}

impl Table {
    /// Opens the table.
    pub fn create(folder: &Path, norm: String) -> Result<Self, ExitCode> {
        let path = folder.join(RUNS);
        let file = File::create(&path).map_err(|error| cannot(&path, &error))?;
        let mut table = Self {
            folder: folder.to_path_buf(),
            writer: csv::Writer::from_writer(file),
            rows: Vec::new(),
            norm,
            problem: None,
        };
        let header = AXES.iter().map(|axis| axis.name).chain([
            "cell_size",
            "particles",
            "steps",
            "dt",
            "status",
            "error",
            "order",
            "wall_seconds",
            "work",
            "default",
            "norm",
            "message",
        ]);
        table.write(header.map(String::from).collect());
        table.check()
    }

    /// Adds a run.
    pub fn push(&mut self, trial: &Trial) {
        self.rows.push(trial.clone());
        let order = local_order(&self.rows, self.rows.len() - 1);
        let values = trial.setting.0.iter().map(ToString::to_string);
        let row = values.chain([
            number(trial.cell_size),
            trial.particles.to_string(),
            trial.steps.to_string(),
            number(trial.dt),
            trial.status.name().into(),
            number(trial.error),
            number(order),
            number(trial.wall),
            number(trial.work),
            trial.default.to_string(),
            self.norm.clone(),
            trial.message.clone(),
        ]);
        self.write(row.collect());
    }

    fn write(&mut self, row: Vec<String>) {
        let written = self.writer.write_record(row);
        let flushed = written.and_then(|()| self.writer.flush().map_err(Into::into));
        if let Err(error) = flushed {
            self.problem.get_or_insert(error.to_string());
        }
    }

    fn check(self) -> Result<Self, ExitCode> {
        match &self.problem {
            Some(problem) => Err(cannot(&self.folder.join(RUNS), problem)),
            None => Ok(self),
        }
    }

    /// Makes sure that all rows were written, and writes `orders.csv`.
    pub fn finish(self, chart: &Chart) -> Result<(), ExitCode> {
        let table = self.check()?;
        let path = table.folder.join(ORDERS);
        orders(&path, chart).map_err(|error| cannot(&path, &error))
    }
}

fn orders(path: &Path, chart: &Chart) -> Result<(), csv::Error> {
    let mut writer = csv::Writer::from_path(path)?;
    let kept = || AXES.iter().filter(|axis| axis.name != "cells");
    let header = kept().map(|axis| axis.name);
    let header: Vec<&str> = header
        .chain([
            "runs_done",
            "runs_failed",
            "finest_cells",
            "finest_error",
            "order_last_two",
            "order_fit",
            "order_expected",
            "source",
        ])
        .collect();
    writer.write_record(header)?;
    for series in series(&chart.subject, &chart.trials) {
        let values = kept().map(|axis| series.setting.get(axis.name).to_string());
        let last = |column: &[f64]| number(column.last().copied().unwrap_or(f64::NAN));
        let (expected, source) = match series.expected {
            Some(expected) => (expected.order, expected.source),
            None => (f64::NAN, ""),
        };
        let row: Vec<String> = values
            .chain([
                series.cells.len().to_string(),
                series.failed.to_string(),
                last(&series.cells),
                last(&series.errors),
                number(series.last),
                number(series.fit),
                number(expected),
                source.into(),
            ])
            .collect();
        writer.write_record(row)?;
    }
    writer.flush()?;
    Ok(())
}

/// With every digit; empty where there is none.
fn number(value: f64) -> String {
    if value.is_finite() {
        format!("{value:?}")
    } else {
        String::new()
    }
}

/// Draws error against wall time and against work.
pub fn pictures(folder: &Path, chart: &Chart) -> Result<(), ExitCode> {
    for (name, cost) in PICTURES {
        let path = folder.join(name);
        picture(chart, cost)
            .write(&path)
            .map_err(|error| fail(code::SYSTEM, &error.to_string()))?;
    }
    Ok(())
}

fn cannot(path: &Path, error: &dyn std::fmt::Display) -> ExitCode {
    let message = format!("cannot write {}: {error}", path.display());
    fail(code::SYSTEM, &message)
}
