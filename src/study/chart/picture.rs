//! From trials to a picture.

use super::axes::{AXES, Setting, Value};
use super::{Chart, Cost, Status, Subject, Trial};
use crate::report::{Best, Group, TradeOff};

/// Error against cost, a color for each basis, or for each dimension if there are several.
pub fn picture(chart: &Chart, cost: Cost) -> TradeOff {
    let kind = if values(chart, "dimensions").len() > 1 {
        "dimensions"
    } else {
        "basis"
    };
    let groups = values(chart, kind);
    let index = |setting: &Setting| {
        let value = setting.get(kind);
        groups.iter().position(|group| *group == value).unwrap_or(0)
    };
    let mut drawn: Vec<Group> = groups
        .iter()
        .map(|value| Group {
            name: match value {
                Value::Count(count) if kind == "dimensions" => format!("{count}D"),
                value => value.to_string(),
            },
            ..Group::default()
        })
        .collect();
    let mut failed = 0;
    for trial in &chart.trials {
        let group = &mut drawn[index(&trial.setting)];
        match trial.status {
            Status::Done => group.points.push((cost.of(trial), trial.error)),
            _ => {
                group.failed.push(cost.of(trial));
                failed += 1;
            }
        }
    }
    let varied = varied(chart);
    let best = chart.frontier(cost).into_iter().map(|i| {
        let trial = &chart.trials[i];
        Best {
            cost: cost.of(trial),
            error: trial.error,
            label: label(&trial.setting, &varied),
            group: index(&trial.setting),
        }
    });
    let frontier = best.collect();
    let places = |among: &dyn Fn(&Trial) -> bool| -> Vec<(f64, f64)> {
        let own = chart.frontier_of(cost, among).into_iter();
        own.map(|i| (cost.of(&chart.trials[i]), chart.trials[i].error))
            .collect()
    };
    let other = match values(chart, "frame")[..] {
        [first, _, ..] => {
            let own = places(&|trial| trial.setting.get("frame") == first);
            Some((format!("{first} frame alone"), own))
        }
        _ => None,
    };
    let own = places(&|trial| trial.default);
    // where all are the default there is nothing to see
    let all = chart.trials.iter().all(|trial| trial.default);
    let marked = (!own.is_empty() && !all).then(|| ("default".into(), own));
    let about = chart.subject.about();
    let dimension = chart.trials.first().map(|t| t.setting.count("dimensions"));
    let what = match dimension {
        Some(dimension) if kind == "basis" => format!("{about} ({dimension}D)"),
        _ => about,
    };
    let (floor, dashes) = match &chart.subject {
        Subject::File(file) if file.doubt > 0.0 && file.doubt.is_finite() => (
            Some(file.doubt),
            " Grey dashes: reference against half its cells.",
        ),
        Subject::Problem(problem) if problem.doubt > 0.0 => {
            (Some(problem.doubt), " Grey dashes: doubt of the reference.")
        }
        _ => (None, ""),
    };
    TradeOff {
        title: capitalised(&what),
        subtitle: format!(
            "{} runs. Labels: method, cells × points a cell and axis, C = Courant number. Cells are {}.{dashes}",
            chart.trials.len(),
            chart.subject.cells_are()
        ),
        cost_label: match cost {
            Cost::Wall => "wall time (s)".into(),
            Cost::Work => {
                "work: times that a point meets a node (steps × points × nodes × passes)".into()
            }
        },
        error_label: format!("error: {}", short(&chart.subject.norm())),
        failed_label: format!("{failed} failed or unstable ×"),
        groups: drawn,
        frontier,
        other,
        marked,
        floor,
    }
}

/// The first words of a norm, for the side of a picture.
fn short(norm: &str) -> String {
    let first = norm.split(',').next().unwrap_or_default();
    let mut words = String::new();
    for word in first.split_whitespace() {
        if words.len() + word.len() > 34 {
            words.push('…');
            break;
        }
        if !words.is_empty() {
            words.push(' ');
        }
        words.push_str(word);
    }
    if norm.contains("relative") {
        words.push_str(", relative");
    }
    if norm.contains("L2") {
        words.push_str(" L2");
    }
    words
}

fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    match letters.next() {
        Some(first) => first.to_uppercase().chain(letters).collect(),
        None => String::new(),
    }
}

/// The values of an axis that occur, in their order.
fn values(chart: &Chart, axis: &str) -> Vec<Value> {
    let mut all = Vec::new();
    for trial in &chart.trials {
        let value = trial.setting.get(axis);
        if !all.contains(&value) {
            all.push(value);
        }
    }
    all
}

/// Names of the axes with more than one value.
fn varied(chart: &Chart) -> Vec<&'static str> {
    let names = AXES.iter().map(|axis| axis.name);
    names.filter(|name| values(chart, name).len() > 1).collect()
}

/// A setting in a few words: "quadratic flip musl, 32 × 2, C 0.5". Names of axes that do not vary are left out.
pub fn label(setting: &Setting, varied: &[&str]) -> String {
    let shows = |name: &str| varied.contains(&name);
    let names: Vec<String> = AXES
        .iter()
        .filter(|axis| !axis.values.names().is_empty() && shows(axis.name))
        .map(|axis| setting.get(axis.name).to_string())
        .collect();
    let mut parts = Vec::new();
    if shows("dimensions") {
        parts.push(format!("{}D", setting.get("dimensions")));
    }
    if !names.is_empty() {
        parts.push(names.join(" "));
    }
    parts.push(format!(
        "{} × {}",
        setting.get("cells"),
        setting.get("points")
    ));
    if shows("courant") {
        parts.push(format!("C {}", setting.get("courant")));
    }
    parts.join(", ")
}
