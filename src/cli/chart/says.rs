//! What a chart says to people and to programs.

use crate::cli::out;
use crate::report::{Align, Cell, Table};
use crate::study::chart::{
    AXES, Chart, Cost, Series, Setting, Status, Trial, best_updates, median, series,
};
use crate::study::validate::PROBLEMS;
use serde_json::{Map, Value, json};
use std::path::Path;

/// The cases.
pub fn list() -> String {
    let mut table = Table::new(["case", "dimensions", "what moves", "error"]);
    for problem in PROBLEMS {
        let dimensions: Vec<String> = problem.dimensions.iter().map(usize::to_string).collect();
        table.push([
            problem.name,
            &dimensions.join(", "),
            problem.about,
            problem.norm,
        ]);
    }
    table.to_string()
}

/// The frontier, the orders, what dimensions cost, and where the files are.
pub fn describe(chart: &Chart, cost: Cost, folder: &Path) -> String {
    let count = |status| chart.trials.iter().filter(|t| t.status == status).count();
    let mut text = format!(
        "{}: {}\nerror: {}; compared with: {}\n{} runs: {} done, {} unstable, {} failed\n\n",
        chart.subject.name(),
        chart.subject.about(),
        chart.subject.norm(),
        chart.subject.against(),
        chart.trials.len(),
        count(Status::Done),
        count(Status::Unstable),
        count(Status::Failed)
    );
    text += &frontier(chart, cost);
    text += &default(chart, cost);
    let all = series(&chart.subject, &chart.trials);
    text += &orders(&all);
    text += &dimensions(chart);
    text + &format!(
        "chart.csv, orders.csv, chart_wall.png and chart_work.png are in {}\n",
        folder.display()
    )
}

fn frontier(chart: &Chart, cost: Cost) -> String {
    let what = match cost {
        Cost::Wall => "wall time",
        Cost::Work => "work",
    };
    let names = AXES.iter().map(|axis| axis.name);
    let mut table = Table::new(names.chain(["error", "wall", "work"]));
    for (i, axis) in AXES.iter().enumerate() {
        if !axis.names().is_empty() {
            table = table.align(i, Align::Left);
        }
    }
    for index in chart.frontier(cost) {
        let trial = &chart.trials[index];
        let values = trial.setting.0.iter().map(ToString::to_string);
        table.push(values.chain([
            format!("{:.2e}", trial.error),
            out::duration(trial.wall),
            format!("{:.2e}", trial.work),
        ]));
    }
    format!("Frontier: nothing is both cheaper ({what}) and more accurate\n{table}\n")
}

/// Errors at which the default is compared with the best: two a decade.
fn tolerances(chart: &Chart) -> Vec<f64> {
    let all = (0..24).map(|k| {
        let decade = 10f64.powi(-(k / 2));
        if k % 2 == 0 { decade } else { 0.3 * decade }
    });
    let best = chart.best_error();
    all.filter(|tolerance| (best..0.2).contains(tolerance))
        .collect()
}

/// What the method costs that the scene gets if none is named, next to the best of all.
fn default(chart: &Chart, cost: Cost) -> String {
    let Some(own) = chart.trials.iter().find(|trial| trial.default) else {
        return "The method that this scene gets by default is not among the runs\n\n".into();
    };
    let mut table = Table::new(["error at most", "cheapest", "default", "ratio"]);
    for tolerance in tolerances(chart) {
        let Some(best) = chart.cheapest(cost, tolerance) else {
            continue;
        };
        let own = chart.cheapest_of(cost, tolerance, |trial| trial.default);
        let shown = |trial: &Trial| match cost {
            Cost::Wall => out::duration(trial.wall),
            Cost::Work => format!("{:.2e}", trial.work),
        };
        table.push([
            format!("{tolerance:.0e}"),
            shown(best),
            own.map_or("not reached".into(), shown),
            own.map_or("-".into(), |own| {
                format!("{:.2}", cost.of(own) / cost.of(best))
            }),
        ]);
    }
    format!(
        "The default of this scene, {}, beside the cheapest of all\n{table}\n",
        own.setting.method()
    )
}

fn orders(all: &[Series]) -> String {
    let best = best_updates(all);
    if best.iter().all(|series| series.fit.is_nan()) {
        return String::new();
    }
    let mut table = Table::new([
        "method",
        "points",
        "courant",
        "finest error",
        "order, last two",
        "order, all",
        "known",
        "source",
    ])
    .align(0, Align::Left)
    .align(6, Align::Right);
    for series in best {
        let order = |order: f64| {
            if order.is_nan() {
                "-".into()
            } else {
                format!("{order:.2}")
            }
        };
        let error = series.errors.last().copied().unwrap_or(f64::NAN);
        let known = series.expected;
        table.push([
            Cell::from(format!(
                "{}D {}",
                series.setting.get("dimensions"),
                series.setting.method()
            )),
            Cell::from(series.setting.get("points")),
            Cell::from(series.setting.get("courant")),
            Cell::from(format!("{error:.2e}")),
            Cell::from(order(series.last)),
            Cell::from(order(series.fit)),
            Cell::from(known.map_or("-".into(), |known| format!("{:.1}", known.order))),
            Cell::from(known.map_or("", |known| known.source)),
        ]);
    }
    format!(
        "Orders of convergence: of each frame, basis and transfer the update with the smallest error (all are in orders.csv)\n{table}\n"
    )
}

/// What the same settings cost in each dimension, over the lowest one.
fn dimensions(chart: &Chart) -> String {
    let of = |trial: &Trial| trial.setting.count("dimensions");
    let mut found: Vec<u32> = chart.trials.iter().map(of).collect();
    found.sort_unstable();
    found.dedup();
    if found.len() < 2 {
        return String::new();
    }
    let mut table = Table::new(["dimension", "error", "points", "work", "wall time"]);
    for &dimension in &found {
        let mut ratios: [Vec<f64>; 4] = Default::default();
        for trial in chart.trials.iter().filter(|t| of(t) == dimension) {
            let twin = chart.trials.iter().find(|other| {
                of(other) == found[0] && other.setting.agrees_but_for(&trial.setting, "dimensions")
            });
            let Some(twin) = twin.filter(|twin| [twin.status, trial.status] == [Status::Done; 2])
            else {
                continue;
            };
            let pairs = [
                (trial.error, twin.error),
                (trial.particles as f64, twin.particles as f64),
                (trial.work, twin.work),
                (trial.wall, twin.wall),
            ];
            for (column, (own, lowest)) in ratios.iter_mut().zip(pairs) {
                column.push(own / lowest);
            }
        }
        let cells = ratios
            .iter()
            .map(|column| format!("x {:.3}", median(column)));
        let name = format!("{dimension}D");
        table.push(std::iter::once(name).chain(cells));
    }
    format!(
        "What a scene needs: the same settings in each dimension, medians relative to {}D\n{table}\n",
        found[0]
    )
}

/// The cheapest setting that meets the tolerance, as TOML.
pub fn to_paste(chart: &Chart, cost: Cost, tolerance: f64) -> String {
    let Some(trial) = chart.cheapest(cost, tolerance) else {
        return format!(
            "\nNo run of this chart has an error of at most {tolerance:e}; the smallest is {:.2e}. Try more --cells.\n",
            chart.best_error()
        );
    };
    let what = match cost {
        Cost::Wall => "fastest",
        Cost::Work => "cheapest by work",
    };
    let setting = &trial.setting;
    let method = AXES.iter().zip(&setting.0).filter_map(|(axis, value)| {
        let names = !axis.names().is_empty();
        names.then(|| format!("{} = {}\n", axis.name, value.toml()))
    });
    format!(
        "\n# the {what} of {} runs of {} with an error of at most {tolerance:e}: {:.2e} in {} (work {:.2e})\n\
         [method]\n{}\n[grid]\ncell_size = {}\n\n[time]\ncourant = {}\n\n# in each [[body]]\nparticles_per_cell = {}\n",
        chart.trials.len(),
        chart.subject.name(),
        trial.error,
        out::duration(trial.wall),
        trial.work,
        method.collect::<String>(),
        trial.cell_size,
        setting.get("courant"),
        setting.get("points")
    )
}

/// Everything, for programs.
pub fn results(chart: &Chart, cost: Cost, tolerance: Option<f64>, folder: &Path) -> Value {
    let all = series(&chart.subject, &chart.trials);
    let orders = all.iter().map(|series| {
        let mut entry = named(&series.setting);
        entry.remove("cells");
        entry.insert("order_last_two".into(), number(series.last));
        entry.insert("order_fit".into(), number(series.fit));
        let known = series.expected;
        entry.insert("order_expected".into(), json!(known.map(|k| k.order)));
        entry.insert("source".into(), json!(known.map(|k| k.source)));
        Value::Object(entry)
    });
    let frontier = chart.frontier(cost);
    json!({
        "subject": chart.subject.name(),
        "norm": chart.subject.norm(),
        "reference": chart.subject.against(),
        "folder": folder.display().to_string(),
        "cost": match cost { Cost::Wall => "wall", Cost::Work => "work" },
        "runs": chart.trials.iter().map(entry).collect::<Vec<_>>(),
        "frontier": frontier.into_iter().map(|i| entry(&chart.trials[i])).collect::<Vec<_>>(),
        "orders": orders.collect::<Vec<_>>(),
        "tolerance": tolerance,
        "cheapest": tolerance.and_then(|t| chart.cheapest(cost, t)).map(entry),
    })
}

fn entry(trial: &Trial) -> Value {
    let mut entry = named(&trial.setting);
    entry.insert("cell_size".into(), number(trial.cell_size));
    entry.insert("particles".into(), json!(trial.particles));
    entry.insert("steps".into(), json!(trial.steps));
    entry.insert("dt".into(), number(trial.dt));
    entry.insert("default".into(), json!(trial.default));
    entry.insert("status".into(), json!(trial.status));
    entry.insert("message".into(), json!(trial.message));
    entry.insert("error".into(), number(trial.error));
    entry.insert("wall_seconds".into(), number(trial.wall));
    entry.insert("work".into(), number(trial.work));
    Value::Object(entry)
}

fn named(setting: &Setting) -> Map<String, Value> {
    use crate::study::chart::Value as Of;
    let pairs = AXES.iter().zip(&setting.0).map(|(axis, value)| {
        let value = match value {
            Of::Name(_) | Of::With(..) => json!(value.to_string()),
            Of::Count(count) => json!(count),
            Of::Number(number) => json!(number),
        };
        (axis.name.to_string(), value)
    });
    pairs.collect()
}

/// JSON has no NaN: null.
fn number(value: f64) -> Value {
    json!(Some(value).filter(|value| value.is_finite()))
}
