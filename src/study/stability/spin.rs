//! Angular momentum: a disc that turns freely. APIC carries what turns within a point's reach and loses none; PIC throws it
//! away in every step; FLIP loses what the grid cannot see. Methods that are unstable lose their points instead.

use super::findings::{Drawing, Findings, Sense};
use super::{Failure, Method, Study};
use crate::report::{HeatCell, HeatMap};
use crate::study::validate::{CaseError, set, simulate};
use std::f64::consts::PI;

/// The case.
pub const FAILURE: Failure = Failure {
    name: "spin",
    title: "angular momentum: a free disc of 10 cells slows down as it turns",
    measure: "turns until the angular momentum has changed by 1 %, the energy has grown by a tenth, or points are lost, within one turn; fails below 1",
    prediction: "none lost where the transfer keeps the affine field of the velocity",
    run,
};

const SCENARIO: &str = include_str!("../../../scenarios/spinning_disc.toml");

fn run(study: &Study) -> Result<Findings, CaseError> {
    let found = study.map(&study.methods, |method| turn(*method));
    let mut findings = Findings::new("turns", Sense::AtLeast, 1.0);
    for (method, fate) in study.methods.iter().zip(&found) {
        let predicted = method.is_affine().then_some(f64::INFINITY);
        findings.push(method, "one turn", predicted, fate.turns());
    }
    findings.shown = format!(
        "{} of {} methods fail within one turn; in the updated frame the survivors carry the affine field of the velocity and are stable.",
        findings.failing(),
        findings.rows.len()
    );
    for (name, frame, methods) in study.frames() {
        findings.drawings.push((name, draw(study, frame, &methods, &found)));
    }
    Ok(findings)
}

/// Rows: basis and transfer; columns: updates.
fn draw(study: &Study, frame: &str, methods: &[Method], found: &[Fate]) -> Drawing {
    let updates = crate::scenario::Scheme::ALL.map(|scheme| scheme.name());
    let mut rows: Vec<String> = Vec::new();
    for method in methods {
        let name = format!("{} {}", method.basis, method.transfer);
        if !rows.contains(&name) {
            rows.push(name);
        }
    }
    let shown: Vec<&str> = updates
        .into_iter()
        .filter(|update| methods.iter().any(|m| m.update == *update))
        .collect();
    let cell = |name: &String, update: &str| {
        let of = study.methods.iter().zip(found);
        let mut of = of.filter(|(m, _)| methods.contains(m));
        of.find(|(m, _)| format!("{} {}", m.basis, m.transfer) == *name && m.update == update)
            .map_or_else(HeatCell::default, |(_, fate)| fate.cell())
    };
    let cells = rows
        .iter()
        .map(|name| shown.iter().map(|update| cell(name, update)).collect())
        .collect();
    Drawing::Map(HeatMap {
            title: format!("Angular momentum of a disc that turns freely: radius 5 cells, 2 × 2 points per cell{frame}"),
            x_label: "stress update".into(),
            holds: "within 1 % for a turn".into(),
            fails: "angular momentum or energy changes, or points are lost".into(),
            columns: shown.iter().map(|name| name.to_string()).collect(),
            rows,
            cells,
    })
}

/// What becomes of a disc: turns until something happens, infinite if it does not.
struct Fate {
    /// 1 % of its angular momentum has changed.
    slowed: f64,
    /// Its energy has grown by a tenth.
    heated: f64,
    /// Points are lost.
    lost: f64,
    /// Share of its angular momentum after one turn.
    kept: f64,
}

impl Fate {
    fn turns(&self) -> f64 {
        self.slowed.min(self.heated).min(self.lost)
    }

    fn cell(&self) -> HeatCell {
        let Self {
            slowed,
            heated,
            lost,
            kept,
        } = self;
        let turns = self.turns();
        let text = if turns.is_infinite() {
            format!("{:.1} % kept after one turn", 100.0 * kept)
        } else if lost.is_finite() {
            format!("points lost at {lost:.2} turns")
        } else if heated < slowed {
            format!("energy + 10 % at {heated:.2} turns")
        } else {
            // no minus sign before a zero
            let kept = 100.0 * kept.abs();
            format!("1 % gone at {slowed:.2} turns, {kept:.0} % kept after one")
        };
        HeatCell {
            text,
            fails: turns.is_finite(),
            strength: if turns.is_finite() { 1.0 - turns } else { 0.5 },
        }
    }
}

fn turn(method: Method) -> Fate {
    let quoted = |name: &str| format!("\"{name}\"");
    let overrides = set(&[
        ("method.basis", &quoted(method.basis)),
        ("method.transfer", &quoted(method.transfer)),
        ("method.update", &quoted(method.update)),
        ("method.frame", &quoted(method.frame)),
        ("time.end", &format!("{PI}")),
        ("output.every", "0.01"),
    ]);
    let (run, lost) = match simulate(SCENARIO, &overrides, false) {
        Ok(run) => (Some(run), None),
        Err(CaseError::Run(crate::run::RunError::Fault(fault))) => (None, Some(fault)),
        Err(_) => (None, None),
    };
    let Some(run) = run else {
        use crate::solver::Fault;
        let time = match lost {
            Some(Fault::Escaped(place) | Fault::NotFinite(place)) => place.time,
            Some(Fault::Collapsed { time, .. }) => time,
            None => 0.0,
        };
        return Fate {
            slowed: f64::INFINITY,
            heated: f64::INFINITY,
            lost: time / PI,
            kept: f64::NAN,
        };
    };
    let time = run.column("body_disc", "time");
    let momentum = run.column("body_disc", "angular_momentum_z");
    let energy = run.column("energy", "total");
    let first = |failed: &dyn Fn(usize) -> bool| {
        let row = (0..time.len()).find(|row| failed(*row));
        row.map_or(f64::INFINITY, |row| time[row] / PI)
    };
    let kept = |row: usize| momentum[row] / momentum[0];
    Fate {
        slowed: first(&|row| (kept(row) - 1.0).abs() > 0.01),
        heated: first(&|row| energy[row] > 1.1 * energy[0]),
        lost: f64::INFINITY,
        kept: kept(time.len() - 1),
    }
}
