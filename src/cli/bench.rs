//! `mpm bench`.

use super::{code, fail, out};
use crate::basis::BasisChoice;
use crate::material::LawChoice;
use crate::study::bench::{Case, Effort, Machine, Order, Row, legend, machine, measure, table};
use crate::transfer::TransferChoice;
use clap::Args;
use clap::builder::PossibleValuesParser;
use serde::{Deserialize, Serialize};
use std::process::{Command, ExitCode, Stdio};

pub const EXAMPLES: &str = "\
Examples:
  mpm bench                                             every dimension and transfer, on one thread and on all
  mpm bench --quick                                     the same with fewer particles and repeats
  mpm bench --dimension 3 --basis quadratic,linear --transfer apic --threads 1,2
  mpm bench --dimension 3 --particles 100000,1000000,4000000 --order lattice,random
  mpm bench --json > speed.json                         one JSON object a row under \"rows\"

A block of particles flies through a box: 2, 4 and 8 particles a cell in 1D, 2D and 3D. Every row is measured in a process of its
own, so that its memory is its own. Keep the machine otherwise idle.
Exit codes: 0 done, 2 a row cannot be computed, 74 the system failed.";

/// Options of `mpm bench`.
#[derive(Args)]
pub struct BenchArguments {
    /// Dimensions
    #[arg(long, value_name = "D", value_delimiter = ',', default_values_t = [1, 2, 3],
          value_parser = clap::value_parser!(u8).range(1..=3))]
    dimension: Vec<u8>,
    /// Bases
    #[arg(long, value_name = "NAME", value_delimiter = ',', default_value = "quadratic",
          value_parser = PossibleValuesParser::new(BasisChoice::NAMES))]
    basis: Vec<String>,
    /// Transfers [default: all]
    #[arg(long, value_name = "NAME", value_delimiter = ',', hide_default_value = true,
          default_values = TransferChoice::NAMES, value_parser = PossibleValuesParser::new(TransferChoice::NAMES))]
    transfer: Vec<String>,
    /// When stresses are updated
    #[arg(long, value_name = "NAME", value_delimiter = ',', default_value = "usl",
          value_parser = PossibleValuesParser::new(["usf", "usl", "musl"]))]
    update: Vec<String>,
    /// Laws
    #[arg(long, value_name = "NAME", value_delimiter = ',', default_value = "neo_hookean",
          value_parser = PossibleValuesParser::new(LawChoice::NAMES))]
    law: Vec<String>,
    /// Numbers of threads [default: one, and one a core]
    #[arg(long, value_name = "N", value_delimiter = ',', value_parser = clap::value_parser!(u16).range(1..=4096))]
    threads: Vec<u16>,
    /// Numbers of particles [default: a million, 100000 in 1D]
    #[arg(long, value_name = "N", value_delimiter = ',',
          value_parser = clap::value_parser!(u32).range(1..=1_000_000_000))]
    particles: Vec<u32>,
    /// How particles are stored at the start
    #[arg(long, value_name = "ORDER", value_delimiter = ',', default_value = "lattice",
          value_parser = PossibleValuesParser::new(["lattice", "random"]))]
    order: Vec<String>,
    /// Timings of a row, whose median counts [default: 5, with --quick 3]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=10_000))]
    repeat: Option<u16>,
    /// What the timings of a row take together, s [default: 1, with --quick 0.2]; rows that differ in threads alone time the
    /// same steps, as many as the first of them takes in this time
    #[arg(long, value_name = "S", value_parser = seconds)]
    seconds: Option<f64>,
    /// Fewer particles (100000, 10000 in 1D) and shorter timings
    #[arg(long)]
    quick: bool,
    /// Print machine and rows as one JSON object on standard output
    #[arg(long)]
    json: bool,
    /// Measure one row, given as JSON, and print it as JSON: what the program starts for each row
    #[arg(long, hide = true, value_name = "JSON")]
    one: Option<String>,
}

fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(seconds) if seconds > 0.0 && seconds <= 1e6 => Ok(seconds),
        _ => Err("expected a number of seconds above 0".into()),
    }
}

/// What the process of one row is told.
#[derive(Deserialize, Serialize)]
struct Task {
    case: Case,
    effort: Effort,
}

#[derive(Serialize)]
struct Results<'a> {
    machine: &'a Machine,
    rows: &'a [Row],
}

/// Measures how fast this machine computes.
pub fn bench(arguments: &BenchArguments) -> Result<ExitCode, ExitCode> {
    if let Some(task) = &arguments.one {
        return one(task);
    }
    let threads = threads(arguments);
    let effort = effort(arguments);
    let cases = cases(arguments, &threads);
    out::message(&format!(
        "{} rows; measuring the memory first\n",
        cases.len()
    ));
    let machine = machine(&threads)
        .map_err(|error| fail(code::SYSTEM, &format!("cannot start threads: {error}")))?;
    let mut rows = Vec::with_capacity(cases.len());
    for (index, case) in cases.iter().enumerate() {
        // what a step costs changes as points move: threads are compared over the same steps
        let before = index.checked_sub(1).map(|before| &cases[before]);
        let effort = Effort {
            steps: before
                .filter(|before| case.differs_in_threads_alone(before))
                .and(rows.last())
                .map(|row: &Row| row.steps),
            ..effort
        };
        let mut row = measure_apart(case, &effort)?;
        row.compare(&machine.bandwidth);
        out::message(&format!(
            "{}/{}  {}D {} {} {} {}, {} particles, {} thread(s): {:.1} ns\n",
            index + 1,
            cases.len(),
            case.dimension,
            case.basis,
            case.transfer,
            case.update,
            case.law,
            row.case.particles,
            case.threads,
            row.nanoseconds
        ));
        rows.push(row);
    }
    if arguments.json {
        out::json(&Results {
            machine: &machine,
            rows: &rows,
        })?;
    } else {
        out::result(&format!("{}\n{}", legend(&machine), table(&rows)))?;
    }
    Ok(ExitCode::from(code::DONE))
}

/// Measures a row in this process.
fn one(task: &str) -> Result<ExitCode, ExitCode> {
    let Task { case, effort } = serde_json::from_str(task)
        .map_err(|error| fail(code::INPUT, &format!("cannot read the row: {error}")))?;
    match measure(&case, &effort) {
        Ok(row) => out::json(&row).map(|()| ExitCode::from(code::DONE)),
        Err(error) => Err(fail(code::INPUT, &error.to_string())),
    }
}

/// Measures a row in a process of its own.
fn measure_apart(case: &Case, effort: &Effort) -> Result<Row, ExitCode> {
    let system = |what: &str| fail(code::SYSTEM, &format!("cannot measure a row: {what}"));
    let task = Task {
        case: case.clone(),
        effort: *effort,
    };
    let task = serde_json::to_string(&task).map_err(|error| system(&error.to_string()))?;
    let program = std::env::current_exe().map_err(|error| system(&error.to_string()))?;
    let output = Command::new(program)
        .args(["bench", "--one", &task])
        .stderr(Stdio::inherit())
        .output()
        .map_err(|error| system(&error.to_string()))?;
    if !output.status.success() {
        return match output.status.code() {
            // it has said why
            Some(code) => Err(ExitCode::from(u8::try_from(code).unwrap_or(code::SYSTEM))),
            None => Err(system("its process was killed; is there memory enough?")),
        };
    }
    serde_json::from_slice(&output.stdout).map_err(|error| system(&error.to_string()))
}

fn threads(arguments: &BenchArguments) -> Vec<usize> {
    let mut threads: Vec<usize> = arguments.threads.iter().copied().map(usize::from).collect();
    if threads.is_empty() {
        threads = vec![
            1,
            std::thread::available_parallelism().map_or(1, usize::from),
        ];
    }
    threads.dedup();
    threads
}

fn effort(arguments: &BenchArguments) -> Effort {
    let (repeats, seconds) = if arguments.quick { (3, 0.2) } else { (5, 1.0) };
    Effort {
        repeats: arguments.repeat.map_or(repeats, usize::from),
        seconds: arguments.seconds.unwrap_or(seconds),
        steps: None,
    }
}

/// Every combination of what was asked for; the one that varies fastest is the number of threads.
fn cases(arguments: &BenchArguments, threads: &[usize]) -> Vec<Case> {
    let orders = arguments.order.iter().map(|order| match &order[..] {
        "random" => Order::Random,
        _ => Order::Lattice,
    });
    let orders: Vec<Order> = orders.collect();
    let mut cases = Vec::new();
    for &dimension in &arguments.dimension {
        let default = match (arguments.quick, dimension) {
            (false, 1) | (true, 2..) => 100_000,
            (false, _) => 1_000_000,
            (true, _) => 10_000,
        };
        let mut sizes: Vec<usize> = arguments.particles.iter().map(|n| *n as usize).collect();
        if sizes.is_empty() {
            sizes.push(default);
        }
        for basis in &arguments.basis {
            for transfer in &arguments.transfer {
                for update in &arguments.update {
                    for law in &arguments.law {
                        for &particles in &sizes {
                            for &order in &orders {
                                cases.extend(threads.iter().map(|&threads| Case {
                                    dimension: usize::from(dimension),
                                    basis: basis.clone(),
                                    transfer: transfer.clone(),
                                    update: update.clone(),
                                    law: law.clone(),
                                    particles,
                                    order,
                                    threads,
                                }));
                            }
                        }
                    }
                }
            }
        }
    }
    cases
}
