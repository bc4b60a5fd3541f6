//! The options of a chart's axes, made from the list of axes.

use crate::study::chart::{AXES, Cost, Subject, Value, Values};
use clap::{Arg, ArgMatches, Command};

/// What is paid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum CostChoice {
    /// Wall time on this machine
    Wall,
    /// Times that a point meets a node, the same on every machine
    Work,
}

impl From<CostChoice> for Cost {
    fn from(choice: CostChoice) -> Self {
        match choice {
            CostChoice::Wall => Self::Wall,
            CostChoice::Work => Self::Work,
        }
    }
}

/// The texts given for each axis, in the order of [`AXES`].
pub struct AxisArguments(Vec<Option<Vec<String>>>);

impl AxisArguments {
    /// The values given for each axis; what cannot be read goes to `problems`.
    pub fn read(&self, problems: &mut Vec<String>) -> Vec<Option<Vec<Value>>> {
        let axes = AXES.iter().zip(&self.0);
        axes.map(|(axis, texts)| {
            let mut values = Vec::new();
            for text in texts.as_ref()? {
                match axis.read(text.trim()) {
                    Ok(value) if !values.contains(&value) => values.push(value),
                    Ok(_) => {}
                    Err(problem) => problems.push(problem),
                }
            }
            Some(values)
        })
        .collect()
    }
}

/// Whether the subject can be set up in the dimensions asked for.
pub fn check_dimensions(
    subject: &Subject,
    given: &[Option<Vec<Value>>],
    problems: &mut Vec<String>,
) {
    let known = subject.dimensions();
    for value in given.first().into_iter().flatten().flatten() {
        if let Value::Count(count) = value
            && !known.contains(&(*count as usize))
        {
            let all: Vec<String> = known.iter().map(usize::to_string).collect();
            problems.push(format!(
                "--dimensions: {} cannot be set up in {count}D, only in {}",
                subject.name(),
                all.join(", ")
            ));
        }
    }
}

impl clap::Args for AxisArguments {
    fn augment_args(command: Command) -> Command {
        AXES.iter().fold(command, |command, axis| {
            let (values, sample) = match axis.values {
                Values::Names(names) => (format!(": {}", names.join(", ")), "NAME,…"),
                Values::Transfers => {
                    let names = axis.values.names().join(", ");
                    let with = ", a parameter in parentheses: fmpm(3)";
                    (format!(": {names}{with}"), "NAME,…")
                }
                Values::Counts(_) | Values::Numbers(_) => (String::new(), "N,…"),
            };
            let arg = Arg::new(axis.name)
                .long(axis.name)
                .value_name(sample)
                .value_delimiter(',')
                .action(clap::ArgAction::Append)
                .help(format!("{}{values}", axis.help));
            command.arg(arg)
        })
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl clap::FromArgMatches for AxisArguments {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let texts = |name| Some(matches.get_many::<String>(name)?.cloned().collect());
        Ok(Self(AXES.iter().map(|axis| texts(axis.name)).collect()))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}
