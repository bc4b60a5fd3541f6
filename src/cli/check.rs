//! `mpm check`.

use super::out::{bytes, duration};
use super::plan::{Plan, Planner};
use super::{ScenarioArguments, ThreadArguments, code, load, out};
use crate::run::with_scene;
use clap::Args;
use std::process::ExitCode;

pub const EXAMPLES: &str = "\
Examples:
  mpm check scenarios/bar1d.toml
  mpm check scenarios/bar1d.toml --set grid.cell_size='\"0.5 m\"'   what a finer grid would cost
  mpm check scenarios/bar1d.toml --json

The expected run time is measured: the scene is built and steps are taken for 0.3 s. Nothing is written.
Exit codes: 0 the scenario can be run, 2 it is wrong.";

/// Options of `mpm check`.
#[derive(Args)]
pub struct CheckArguments {
    #[command(flatten)]
    scenario: ScenarioArguments,
    /// Print the plan as one JSON object on standard output
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    threads: ThreadArguments,
}

/// Says what is wrong with a scenario, or what running it would mean.
pub fn check(arguments: &CheckArguments) -> Result<ExitCode, ExitCode> {
    let loaded = load(&arguments.scenario, arguments.json)?;
    let planner = Planner {
        scenario: &loaded.scenario,
        warnings: loaded.warnings,
    };
    let plan = arguments
        .threads
        .install(|| with_scene(&loaded.scenario, planner))?;
    if arguments.json {
        out::json(&plan)?;
    } else {
        out::result(&describe(&plan))?;
        plan.warnings.iter().for_each(|warning| out::warn(warning));
    }
    Ok(ExitCode::from(code::DONE))
}

fn vector(numbers: &[f64]) -> String {
    let numbers: Vec<_> = numbers.iter().map(|x| format!("{x:.4e}")).collect();
    format!("({})", numbers.join(", "))
}

/// `1 row`, `2 rows`.
fn count(number: f64, what: &str) -> String {
    let ending = if number == 1.0 { "" } else { "s" };
    if number < 1e9 {
        format!("{number:.0} {what}{ending}")
    } else {
        format!("{number:.2e} {what}{ending}")
    }
}

fn describe(plan: &Plan) -> String {
    let mut lines: Vec<(&str, String)> = vec![
        ("title", plan.title.clone()),
        (
            "models",
            match plan.plane {
                Some(plane) => format!("{}D, {plane}", plan.dimension),
                None => format!("{}D", plan.dimension),
            },
        ),
        (
            "method",
            format!(
                "basis {}, transfer {}, update {}, frame {}",
                plan.basis, plan.transfer, plan.update, plan.frame
            ),
        ),
    ];
    lines.extend(plan.defaults.iter().map(|why| ("default", why.clone())));
    for body in &plan.bodies {
        lines.push((
            "body",
            format!(
                "{}: {}, {:.4e} kg of {} ({}, {:.4e} kg/m³), {:.0} bytes a particle",
                body.name,
                count(body.particles as f64, "particle"),
                body.mass,
                body.material,
                body.law,
                body.density,
                body.bytes_per_particle
            ),
        ));
    }
    let (grid, step) = (&plan.grid, &plan.time_step);
    let cells: Vec<_> = grid.cells.iter().map(i32::to_string).collect();
    lines.push((
        "grid",
        format!(
            "{} cells of {} m, {}, {} of storage",
            cells.join(" x "),
            grid.cell_size,
            count(grid.nodes, "node"),
            bytes(grid.bytes)
        ),
    ));
    lines.push((
        "memory",
        format!(
            "about {}, besides the program's own",
            bytes(plan.memory_bytes)
        ),
    ));
    for boundary in &plan.boundaries {
        let nodes = count(boundary.nodes as f64, "node");
        lines.push((
            "boundary",
            format!(
                "{}: {} on {}, holds {nodes} at the start",
                boundary.name, boundary.condition, boundary.on
            ),
        ));
    }
    for load in &plan.loads {
        let factor = match load.factor {
            [1.0, 1.0] => String::new(),
            [low, high] => format!(" times a factor from {low} to {high}"),
        };
        let faces = load.faces.iter();
        let seen: Vec<_> = faces
            .clone()
            .map(|faces| format!("{:.4e} m² towards {}", faces.area, faces.side))
            .collect();
        let on = match faces.map(|faces| faces.count).sum::<usize>() {
            0 => format!(
                "{} of {}",
                count(load.particles as f64, "particle"),
                load.body
            ),
            all => format!(
                "{} of {} ({})",
                count(all as f64, "face"),
                load.body,
                seen.join(", ")
            ),
        };
        lines.push((
            "load",
            format!(
                "{}: {} on {on}, {} N in all{factor}",
                load.name,
                load.kind,
                vector(&load.force)
            ),
        ));
    }
    if plan.gravity.iter().any(|g| *g != 0.0) {
        lines.push(("gravity", format!("{} m/s²", vector(&plan.gravity))));
    }
    if plan.damping_rate > 0.0 {
        lines.push(("damping", format!("{} 1/s", plan.damping_rate)));
    }
    if !plan.probes.is_empty() {
        lines.push(("probes", plan.probes.join(", ")));
    }
    lines.push((
        "limit",
        format!(
            "the fastest signal crosses a cell in {:.4e} s (waves {:.4e} m/s, particles {:.4e} m/s): {} decides",
            step.crossing_time, step.wave_speed, step.particle_speed, step.limited_by
        ),
    ));
    lines.push((
        "time step",
        format!(
            "{:.4e} s ({}), {:.3} of that",
            step.dt,
            if step.rule == "fixed" {
                "fixed".into()
            } else {
                format!("Courant number {}", step.given)
            },
            step.ratio
        ),
    ));
    lines.push((
        "steps",
        format!("about {} to t = {} s", count(step.steps, "step"), step.end),
    ));
    lines.push((
        "output",
        format!(
            "{} in each of {}, about {}",
            count(plan.output.rows, "row"),
            count(plan.output.tables as f64, "table"),
            bytes(plan.output.bytes)
        ),
    ));
    let cost = &plan.cost;
    let threads = count(cost.threads as f64, "thread");
    lines.push((
        "run time",
        format!(
            "about {} on {threads} ({} a step, {:.0} ns a particle and step)",
            duration(cost.expected_seconds),
            duration(cost.seconds_per_step),
            cost.nanoseconds_per_particle_step
        ),
    ));
    for advice in &plan.advice {
        let factor = match advice.factor {
            Some(factor) => format!(", about {factor:.1} times cheaper"),
            None => String::new(),
        };
        lines.push((
            "advice",
            format!("{}{factor}. {}", advice.says, advice.change),
        ));
    }
    let line = |(name, value): (&str, String)| format!("{name:<10} {value}\n");
    lines.into_iter().map(line).collect()
}
