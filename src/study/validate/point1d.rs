//! The vibration of a single material point: the smallest problem of the method, where everything is known.
//!
//! One cell, its left node held, linear basis, FLIP, a constant volume in the internal force (rate = "kirchhoff"). The right node
//! has the momentum N m v over the mass N m, so its velocity is v; the strain rate is v/L, the force on the node −V τ/L, and
//! with u = τL/E all of the method comes down to v̇ = −ω²u, u̇ = v, ẋ = x v/L, ω = √(E/ρ)/L. Hence
//! v = v₀ cos ωt, x = x₀ exp(v₀/(ωL) sin ωt), energy (v² + ω²u²) m/2.
//!
//! In steps, MUSL and USF are the symplectic Euler rule, v⁺ = v − Δt ω²u and u⁺ = u + Δt v⁺ (USF: in the other order). It keeps
//! I = v² + ω²u² − Δt ω²uv (USF: +) exactly, so that the energy ripples by the share ωΔt/2 and does not drift; its frequency is
//! given by sin(ω_h Δt/2) = ωΔt/2. A velocity of MUSL belongs to the middle of the step before the time it is stored at, one
//! of USF to the middle of the step after. USL strains with the node's velocity after the step, v − Δt ω²u/N: per step the
//! oscillation loses the share (ωΔt)²(1/N − 1) of its energy, here exp(−0.3948) in ten periods.

use super::compare::{chart, curve, largest, map};
use super::{Case, CaseError, Recorded, Report, rms, set};
use crate::report::Style;
use std::f64::consts::PI;

/// The case.
pub const CASE: Case = Case {
    name: "point1d",
    claim: "a single material point vibrates as the closed form says, for ten periods",
    reference: "closed form of the method's own equations for one point (derived in the case file)",
    run,
};

const SCENARIO: &str = include_str!("../../../scenarios/point1d.toml");
const OMEGA: f64 = 2.0 * PI;
const V0: f64 = 0.1;
const DT: f64 = 1e-3;
/// sin(ω_h Δt/2) = ωΔt/2 is larger than ω_h Δt/2 by the cube of its argument: a phase (ωΔt)²/24 · ωt late or early, at most this
/// after ten periods; over the run its root mean square is 1/√6 of it.
const PHASE: f64 = OMEGA * DT * OMEGA * DT / 24.0 * OMEGA * 10.0;

fn run(report: &mut Report) -> Result<(), CaseError> {
    let musl = Motion::of(report, "musl")?;
    let usf = Motion::of(report, "usf")?;
    let usl = Motion::of(report, "usl")?;
    let time = &musl.time;

    for (name, motion, shift) in [("MUSL", &musl, -0.5 * DT), ("USF", &usf, 0.5 * DT)] {
        // twice what the discrete frequency alone makes: the size of the first step's start is of the same order
        let exact = map(time, |t| V0 * (OMEGA * (t + shift)).cos());
        report.at_most(
            format!("{name}, velocity at its own time (half a step away): rms error / v0"),
            rms(&motion.velocity, &exact) / V0,
            2.0 * PHASE / 6.0_f64.sqrt(),
        );
        // the trajectory through v(0) = v0, u(0) = 0 of the difference equations: round-off of 10,000 steps, growing with t
        let omega = 2.0 / DT * (0.5 * OMEGA * DT).asin();
        let scale = V0 / (0.5 * omega * DT).cos();
        let discrete = map(time, |t| scale * (omega * (t + shift)).cos());
        report.at_most(
            format!("{name}, velocity: largest distance from the solved difference equations / v0"),
            largest(&motion.velocity, &discrete) / V0,
            1e-10,
        );
        report.at_most(
            format!("{name}, v^2 + w^2 u^2 -+ dt w^2 u v: largest relative change"),
            motion.invariant(2.0 * shift),
            1e-12,
        );
        // the ripple is ωΔt/2 sin 2ωt, and the next order (ωΔt)² is a hundred times smaller
        report.close(
            format!("{name}, energy: largest ripple / mean"),
            largest(&motion.energy, &vec![0.005; time.len()]) / 0.005,
            0.5 * OMEGA * DT,
            0.02 * 0.5 * OMEGA * DT,
        );
    }
    let naive = map(time, |t| V0 * (OMEGA * t).cos());
    // half a step of phase, ωΔt/2 sin ωt, is 2.2e-3 in the mean square
    report.close(
        "MUSL, velocity at the time it is stored at: rms error / v0 (first order in dt)",
        rms(&musl.velocity, &naive) / V0,
        0.5 * OMEGA * DT / 2.0_f64.sqrt(),
        0.05 * 0.5 * OMEGA * DT / 2.0_f64.sqrt(),
    );

    // the node of weight N = x/L moves with v − Δt ω²u/N: x⁺ = x (1 + (u⁺ − u)/L) − Δt² ω²u (1 − N). Summed up, beside the exact x:
    // a lag −Δt/2 v₀ (1 − cos ωt) as N = 1/2; and drifts of Δt v₀² t/L times −1/8 (second term of the logarithm of 1 + Δu/L),
    // +1/4 (N changes with u) and +1/4 (the lag is carried along by v/L). What remains is of the order of v₀³Δt.
    let position = map(time, |t| 0.5 * (V0 / OMEGA * (OMEGA * t).sin()).exp());
    report.at_most(
        "MUSL, position: rms error / amplitude",
        rms(&musl.position, &position) / (0.5 * V0 / OMEGA),
        0.01,
    );
    let lagging: Vec<f64> = position
        .iter()
        .zip(time)
        .map(|(x, t)| x - 0.5 * DT * V0 * (1.0 - (OMEGA * t).cos()) + 0.375 * DT * V0 * V0 * t)
        .collect();
    report.at_most(
        "MUSL, position: largest error beside the lag and drift of first order in dt, m",
        largest(&musl.position, &lagging),
        4e-6,
    );
    report.close(
        "MUSL, energy after ten periods, J",
        musl.energy[time.len() - 1],
        0.005,
        1e-6,
    );
    // N moves by 1.6 % about 1/2, which changes the mean of 1/N by 1e-4; (ωΔt)² terms are smaller still
    report.close(
        "USL, share of the energy left after ten periods",
        usl.energy[time.len() - 1] / 0.005,
        (-10.0 * OMEGA * OMEGA * DT).exp(),
        2e-3,
    );

    report.table(
        "history",
        &[
            ("time", time),
            ("velocity", &musl.velocity),
            ("velocity_exact", &naive),
            ("position", &musl.position),
            ("position_exact", &position),
            ("energy_musl", &musl.energy),
            ("energy_usf", &usf.energy),
            ("energy_usl", &usl.energy),
        ],
    );
    draw(report, &musl, &usl, &naive, &position);
    Ok(())
}

/// What one scheme makes of the point.
struct Motion {
    time: Vec<f64>,
    velocity: Vec<f64>,
    position: Vec<f64>,
    /// u = τL/E, m.
    reach: Vec<f64>,
    energy: Vec<f64>,
}

impl Motion {
    fn of(report: &mut Report, update: &str) -> Result<Self, CaseError> {
        let run: Recorded = report.run(SCENARIO, &set(&[("method.update", update)]))?;
        let probe = |column: &str| run.column("probe_point", column);
        let (stress, ratio) = (probe("stress_xx"), probe("volume_ratio"));
        let sum = |(kinetic, elastic): (&f64, &f64)| kinetic + elastic;
        let (kinetic, elastic) = (
            run.column("energy", "kinetic"),
            run.column("energy", "elastic"),
        );
        Ok(Self {
            time: probe("time"),
            velocity: probe("velocity_x"),
            position: probe("position_x"),
            // τ = Jσ
            reach: stress
                .iter()
                .zip(&ratio)
                .map(|(s, j)| s * j / (OMEGA * OMEGA))
                .collect(),
            energy: kinetic.iter().zip(&elastic).map(sum).collect(),
        })
    }

    /// Largest relative change of v² + ω²u² + s ω²uv.
    fn invariant(&self, s: f64) -> f64 {
        let square = OMEGA * OMEGA;
        let pairs = self.velocity.iter().zip(&self.reach);
        let values: Vec<f64> = pairs
            .map(|(v, u)| v * v + square * u * (u + s * v))
            .collect();
        largest(&values, &vec![V0 * V0; values.len()]) / (V0 * V0)
    }
}

fn draw(report: &mut Report, musl: &Motion, usl: &Motion, velocity: &[f64], position: &[f64]) {
    let time = &musl.time;
    // dots of the computed motion 1/20 period apart, over two periods
    let (shown, every) = (2001, 50);
    let thin =
        |column: &[f64]| -> Vec<f64> { column[..shown].iter().copied().step_by(every).collect() };
    let both = |title: &str, label: &str, computed: &[f64], exact: &[f64]| {
        chart(
            title,
            "time (s)",
            label,
            vec![
                curve("computed", &thin(time), &thin(computed), Style::Markers),
                curve("exact", &time[..shown], &exact[..shown], Style::Dashed),
            ],
        )
    };
    let millijoules = |motion: &Motion| map(&motion.energy, |energy| 1e3 * energy);
    let decay = map(time, |t| 5.0 * (-OMEGA * OMEGA * DT * t).exp());
    let energy = vec![
        curve("MUSL", time, &millijoules(musl), Style::Line),
        curve("USL", time, &millijoules(usl), Style::Line),
        curve(
            "exact, and predicted for USL",
            time,
            &vec![5.0; time.len()],
            Style::Dashed,
        ),
        curve("", time, &decay, Style::Dashed),
    ];
    let mut energies = chart("Energy over ten periods", "time (s)", "energy (mJ)", energy);
    energies.y_range = Some([0.0, 6.0]);
    let shifted = map(time, |t| V0 * (OMEGA * (t - 0.5 * DT)).cos());
    let error = |exact: &[f64]| -> Vec<f64> {
        let pairs = musl.velocity.iter().zip(exact);
        pairs.map(|(v, e)| (v - e) / V0).collect()
    };
    let errors = vec![
        curve("at the stored time", time, &error(velocity), Style::Line),
        curve("half a step earlier", time, &error(&shifted), Style::Line),
    ];
    report.chart(
        "history",
        vec![
            both(
                "Velocity of the point (MUSL)",
                "velocity (m/s)",
                &musl.velocity,
                velocity,
            ),
            both(
                "Position of the point (MUSL)",
                "position (m)",
                &musl.position,
                position,
            ),
            energies,
            chart(
                "Error of the velocity (MUSL)",
                "time (s)",
                "error / v0",
                errors,
            ),
        ],
    );
}
