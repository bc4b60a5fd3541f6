//! Large simple shear, and a cycle of large strains that ends where it began.
//!
//! **Simple shear** F = [[1, γ], [0, 1]]. With G the shear modulus, and J = 1, so that τ = σ:
//!
//! - Jaumann rate: σ_xy = G sin γ, σ_xx − σ_yy = 2G (1 − cos γ), from a′ = γ′ b, b′ = γ′ (G − a) for σ = [[a, b], [b, −a]];
//! - neo-Hookean, τ = G (b − I): Gγ and Gγ²;
//! - Hencky, principal logarithmic strains ± asinh(γ/2) along the axes of b: 2G asinh(γ/2)/√(1 + γ²/4), and γ times that;
//! - St. Venant–Kirchhoff, τ = F S Fᵀ with S = λ tr E I + 2G E, E = ½ [[0, γ], [γ, γ²]]:
//!   τ_xy = Gγ (1 + γ²) + ½ λγ³, τ_xx − τ_yy = γ² (G + ½ λγ² + Gγ²) (all derived here).
//!
//! Such a stress is the same everywhere and pushes nothing, so that a block whose rim is moved goes on as it started. In the total frame
//! only the nodes of the rim are driven, and the inside finds its way; in the updated frame, where the rim does not stay with nodes,
//! all are.
//!
//! **The cycle** F = [[l, s], [0, 1/l]], (l, s) = (1, 0) → (1, e) → (1 + e, e) → (1 + e, 0) → (1, 0), all nodes driven. Hyperelastic laws
//! end without stress and without work; the Jaumann rate keeps a stress, and the cycle has cost work. Its equations along the path are
//! integrated here by the Runge–Kutta method, which knows no grid.

use super::compare::{chart, curve};
use super::{Case, CaseError, Recorded, Report};
use crate::report::{LineChart, Style};

/// The case.
pub const CASE: Case = Case {
    name: "simple_shear",
    claim: "a block in large simple shear carries the stress of its law, and only hyperelastic laws come back from a cycle without stress",
    reference: "closed forms and ordinary differential equations of the laws (derived in the case file)",
    run,
};

const LAWS: [&str; 4] = [
    "linear_elastic",
    "neo_hookean",
    "hencky",
    "st_venant_kirchhoff",
];
/// E = 2.5 Pa and ν = ¼: G = λ = 1 Pa.
const LAMBDA: f64 = 1.0;
/// The cycle's strain.
const STRAIN: f64 = 0.3;
const DT: f64 = 0.005;

fn run(report: &mut Report) -> Result<(), CaseError> {
    let mut shear = Vec::new();
    for law in LAWS {
        for frame in ["updated", "total"] {
            let run = report.run(&scenario(law, frame, Motion::Shear), &[])?;
            let [gamma, along, across] = stresses(&run);
            let exact: Vec<[f64; 2]> = gamma.iter().map(|gamma| closed(law, *gamma)).collect();
            let pick = |i: usize| exact.iter().map(|pair| pair[i]).collect::<Vec<f64>>();
            // F is exact, for it grows by the same in each step, and so is the stress of a law that has an energy. The rate law follows
            // its spin with an error of (Δγ)²/12 a unit of shear.
            let limit = if law == "linear_elastic" { 1e-5 } else { 1e-9 };
            let wrong = super::compare::largest(&across, &pick(0));
            report.at_most(
                format!("{law}, {frame}: largest error of stress_xy / G, shear up to 1.5"),
                wrong,
                limit,
            );
            let wrong = super::compare::largest(&along, &pick(1));
            report.at_most(
                format!("{law}, {frame}: largest error of (stress_xx - stress_yy) / G"),
                wrong,
                limit,
            );
            if frame == "total" {
                let sparse =
                    |values: &[f64]| values.iter().step_by(20).copied().collect::<Vec<_>>();
                let computed = curve(law, &sparse(&gamma), &sparse(&across), Style::Markers);
                shear.push(computed);
                let mut exact = curve("", &gamma, &pick(0), Style::Dashed);
                if law == LAWS[0] {
                    exact.name = "closed forms".into();
                }
                exact.color = Some(crate::report::Color(34, 34, 34));
                shear.push(exact);
            }
        }
    }
    let mut panels = vec![chart(
        "Simple shear of a block",
        "shear γ",
        "shear stress / G",
        shear,
    )];
    panels.push(cycle(report)?);
    report.chart("simple_shear", panels);
    Ok(())
}

/// Time, σ_xx − σ_yy and σ_xy of a point in the middle.
fn stresses(run: &Recorded) -> [Vec<f64>; 3] {
    let column = |name: &str| run.column("probe_point", name);
    let (xx, yy) = (column("stress_xx"), column("stress_yy"));
    let along = xx.iter().zip(&yy).map(|(xx, yy)| xx - yy).collect();
    [column("time"), along, column("stress_xy")]
}

/// σ_xy and σ_xx − σ_yy at a shear γ, with G = 1.
fn closed(law: &str, gamma: f64) -> [f64; 2] {
    let square = gamma * gamma;
    match law {
        "linear_elastic" => [gamma.sin(), 2.0 * (1.0 - gamma.cos())],
        "neo_hookean" => [gamma, square],
        "hencky" => {
            let shear = 2.0 * (0.5 * gamma).asinh() / (1.0 + 0.25 * square).sqrt();
            [shear, gamma * shear]
        }
        _ => [
            gamma * (1.0 + square) + 0.5 * LAMBDA * gamma * square,
            square * (1.0 + 0.5 * LAMBDA * square + square),
        ],
    }
}

fn cycle(report: &mut Report) -> Result<LineChart, CaseError> {
    let reference = jaumann();
    let [along, across, work] = reference[reference.len() - 1];
    // published beside the derivation: what the equations themselves have to give
    report.close(
        "equations of the Jaumann rate: work of the cycle / G",
        work,
        1.48e-3,
        5e-6,
    );
    let mut series = Vec::new();
    for law in LAWS {
        for frame in ["updated", "total"] {
            let run = report.run(&scenario(law, frame, Motion::Cycle), &[])?;
            let [time, difference, shear] = stresses(&run);
            let end = time.len() - 1;
            let computed = work_done(&run);
            let exact = match law {
                "linear_elastic" => [2.0 * along, across, work],
                _ => [0.0; 3],
            };
            // The rate law as above, over four legs of 0.3. Work is summed over steps by the trapezoidal rule.
            let (stress_limit, work_limit) = match law {
                "linear_elastic" => (2e-5, 2e-6),
                _ => (1e-9, 2e-6),
            };
            let name = format!("{law}, {frame}: after the cycle");
            report.close(
                format!("{name}, stress_xy / G"),
                shear[end],
                exact[1],
                stress_limit,
            );
            report.close(
                format!("{name}, (stress_xx - stress_yy) / G"),
                difference[end],
                exact[0],
                stress_limit,
            );
            report.close(format!("{name}, work / G"), computed, exact[2], work_limit);
            if frame == "updated" {
                series.push(curve(law, &time, &shear, Style::Line));
            }
        }
    }
    let steps = reference.len() - 1;
    let time: Vec<f64> = (0..=steps).map(|i| 4.0 * i as f64 / steps as f64).collect();
    let exact: Vec<f64> = reference.iter().map(|state| state[1]).collect();
    let mut exact = curve("Jaumann rate, integrated", &time, &exact, Style::Dashed);
    exact.color = Some(crate::report::Color(34, 34, 34));
    series.push(exact);
    Ok(chart(
        "Closed cycle of strain: shear, stretch, and both back",
        "leg of the cycle",
        "shear stress / G",
        series,
    ))
}

/// l and s at time t of the cycle, one unit of time a leg.
fn path(t: f64) -> [f64; 2] {
    let ramp = |from: f64| (t - from).clamp(0.0, 1.0);
    [
        1.0 + STRAIN * (ramp(1.0) - ramp(3.0)),
        STRAIN * (ramp(0.0) - ramp(2.0)),
    ]
}

/// Work of the stress of a point in the middle, per volume, over the cycle.
fn work_done(run: &Recorded) -> f64 {
    let column = |name: &str| run.column("probe_point", name);
    let time = column("time");
    let [xx, yy, xy] = ["xx", "yy", "xy"].map(|pair| column(&format!("stress_{pair}")));
    let mut work = 0.0;
    for i in 1..time.len() {
        let [l, s] = path(0.5 * (time[i - 1] + time[i]));
        let ([l0, s0], [l1, s1]) = (path(time[i - 1]), path(time[i]));
        let mean = |stress: &[f64]| 0.5 * (stress[i - 1] + stress[i]);
        let stretched = (l1 - l0) / l;
        let sheared = l * (s1 - s0) - s * (l1 - l0);
        work += (mean(&xx) - mean(&yy)) * stretched + mean(&xy) * sheared;
    }
    work
}

/// a, b and the work per volume along the cycle for the Jaumann rate, G = 1: with the velocity gradient [[p, q], [0, −p]],
/// a′ = 2p + q b, b′ = q − q a, W′ = 2 p a + q b.
fn jaumann() -> Vec<[f64; 3]> {
    const STEPS: usize = 4000;
    let dt = 4.0 / STEPS as f64;
    let rate = |leg: usize, t: f64, [a, b, _]: [f64; 3]| {
        let [l, s] = path(t);
        let (dl, ds) = match leg {
            0 => (0.0, STRAIN),
            1 => (STRAIN, 0.0),
            2 => (0.0, -STRAIN),
            _ => (-STRAIN, 0.0),
        };
        let (p, q) = (dl / l, ds * l - s * dl);
        [2.0 * p + q * b, q - q * a, 2.0 * p * a + q * b]
    };
    let plus = |x: [f64; 3], k: [f64; 3], share: f64| std::array::from_fn(|i| x[i] + share * k[i]);
    let mut states = vec![[0.0; 3]];
    for step in 0..STEPS {
        let (leg, t) = (step * 4 / STEPS, step as f64 * dt);
        let x = states[step];
        let k1 = rate(leg, t, x);
        let k2 = rate(leg, t + 0.5 * dt, plus(x, k1, 0.5 * dt));
        let k3 = rate(leg, t + 0.5 * dt, plus(x, k2, 0.5 * dt));
        let k4 = rate(leg, t + dt, plus(x, k3, dt));
        let next = |i: usize| x[i] + dt / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
        states.push(std::array::from_fn(next));
    }
    states
}

/// What the block does.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Motion {
    Shear,
    Cycle,
}

/// A block of 1 × 1 m. Nodes get the velocity that carries F over the step to its exact next value: Ḟ X in the total frame,
/// ΔF/Δt F⁻¹ x in the updated one, F at the start of the step. Conditions are evaluated at its end, t.
fn scenario(law: &str, frame: &str, motion: Motion) -> String {
    // l, s and 1/l at the start and the end of a step, and their change
    let ramp = |t: &str, from: u32| format!("min(max({t} / (1 s) - {from}, 0), 1)");
    let l = |t: &str| format!("(1 + {STRAIN} * ({} - {}))", ramp(t, 1), ramp(t, 3));
    let s = |t: &str| format!("({STRAIN} * ({} - {}))", ramp(t, 0), ramp(t, 2));
    let before = format!("(t - {DT} s)");
    let step = format!("({DT} s)");
    let (dl, ds) = (
        format!("({} - {})", l("t"), l(&before)),
        format!("({} - {})", s("t"), s(&before)),
    );
    let (velocity, end) = match (motion, frame) {
        (Motion::Shear, _) => (["y / (1 s)".to_string(), "0 * y / (1 s)".into()], 1.5),
        (Motion::Cycle, "total") => (
            [
                format!("({dl} * x + {ds} * y) / {step}"),
                format!("(1 / {} - 1 / {}) * y / {step}", l("t"), l(&before)),
            ],
            4.0,
        ),
        (Motion::Cycle, _) => (
            [
                format!(
                    "({dl} / {l0} * x + ({l0} * {ds} - {s0} * {dl}) * y) / {step}",
                    l0 = l(&before),
                    s0 = s(&before)
                ),
                format!("({} / {} - 1) * y / {step}", l(&before), l("t")),
            ],
            4.0,
        ),
    };
    let [vx, vy] = velocity;
    let rims = [
        "min = [-9.0, -9.0], max = [0.0, 9.0]",
        "min = [1.0, -9.0], max = [9.0, 9.0]",
        "min = [-9.0, -9.0], max = [9.0, 0.0]",
        "min = [-9.0, 1.0], max = [9.0, 9.0]",
    ];
    let everywhere = ["min = [-9.0, -9.0], max = [9.0, 9.0]"];
    let driven: &[&str] = if motion == Motion::Shear && frame == "total" {
        &rims
    } else {
        &everywhere
    };
    let driven = driven.iter().enumerate().map(|(i, on)| {
        format!("[[boundary]]\nname = \"rim{i}\"\non.box = {{ {on} }}\ncondition.driven = {{ velocity = [\"{vx}\", \"{vy}\"] }}\n")
    });
    let start = match motion {
        Motion::Shear => "velocity = [\"y / (1 s)\", 0.0]\n",
        Motion::Cycle => "",
    };
    format!(
        r#"dimension = 2
time = {{ end = {end:?}, step = {DT} }}
grid = {{ min = [0.0, 0.0], max = [4.0, 2.0], cell_size = 0.25 }}
method = {{ basis = "linear", transfer = "flip", update = "usl", frame = "{frame}" }}
material.block = {{ density = 1.0, {law} = {{ youngs_modulus = 2.5, poissons_ratio = 0.25 }} }}
output.every = {DT}
[[body]]
name = "block"
material = "block"
shape.box = {{ min = [0.0, 0.0], max = [1.0, 1.0] }}
particles_per_cell = 2
{start}{}[[probe]]
name = "point"
body = "block"
near = [0.55, 0.55]
"#,
        driven.collect::<String>()
    )
}
