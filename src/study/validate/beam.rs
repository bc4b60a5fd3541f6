//! A steel beam on two supports, ten times as long as high, plane strain, swings in its modes 1, 2 and 3 of bending.
//!
//! Its ends are held across and free along. What is sin kx across and cos kx along, k = nπ/L, meets both exactly, so that elasticity
//! itself has a closed form: antisymmetric waves of a plate between surfaces free of traction at y = ± c (Rayleigh–Lamb; derived
//! here). With a² = k² − ω²/c_p², b² = k² − ω²/c_s², c_p and c_s the speeds of pressure and shear waves, and the potentials
//! φ = A sinh ay sin kx, ψ = B cosh by cos kx,
//!
//! u_x = (A k sinh ay + B b sinh by) cos kx, u_y = (A a cosh ay + B k cosh by) sin kx.
//!
//! No shear on the surfaces gives A = (k² + b²) cosh bc, B = − 2 k a cosh ac, and no pull the frequency:
//!
//! (k² + b²)² tanh ac = 4 k² a b tanh bc.
//!
//! Theories of beams approach it. Timoshenko's, with the modulus E′ = E/(1 − ν²) and a share κ = 5/(6 − ν) of the section in shear,
//! has the first two terms in (kc)² and is 0.02 % off in mode 3; Euler and Bernoulli's ω = k² √(E′I/ρA) is 1.7, 6.6 and 14 % high.
//!
//! **What the grid adds**, p ≥ 2 points a cell and axis, to the order of h² where the beam is slender (derived in
//! `scenario/placement.rs`): with m the second moment of the points of a cell in parts of the cell's, 1 − 1/p² in even distances, that of
//! all layers of points is short of H³/12 by (1 − m)(h/H)². Hat functions cannot bend, which is worth m c (h/H)² of the
//! stiffness, c = G/E′ + M/E′ − 1, M the modulus of pressure waves. Half of either is the frequency's. All else goes with (kh)², as in a
//! bar. Points placed for bending have m = 1/(1 + c), or 1/2 if that is more, and splines m = 1: nothing is left.
//!
//! With one point a cell there are fewer layers of points than rows of nodes, whose velocities are then tied to each other: it is
//! another method, and neither sum holds.

use super::compare::{chart, curve, orders};
use super::history::frequency_near;
use super::problem::{SECOND_ORDER, displacement_error};
use super::{Case, CaseError, Layout, Problem, Report};
use crate::report::{LineChart, Style};
use crate::scenario::Placement;
use std::f64::consts::{PI, TAU};

/// The case.
pub const CASE: Case = Case {
    name: "beam",
    claim: "a beam on two supports swings in bending with the frequencies of plane elasticity, but for h^2 times what theory gives each basis",
    reference: "Rayleigh-Lamb equation of a plate (derived in the case file)",
    run,
};

/// The first mode of a beam half as long, which is the second of the whole one, for a period.
pub const PROBLEM: Problem = Problem {
    name: "beam",
    about: "a beam on two supports, five times as long as high, swings in its first mode of bending for a period",
    norm: "displacement, relative L2 norm over points and recorded times",
    reference: CASE.reference,
    cells_are: "over the height of the beam",
    dimensions: &[2],
    layout: |_, cells| Layout {
        text: SCENARIO.into(),
        overrides: overrides(&HALF, f64::from(cells), 1.0, 10),
    },
    error: |run| {
        let mode = Mode::new(&HALF);
        displacement_error(run, |x, time| {
            let swing = V0 / mode.omega * (mode.omega * time).sin();
            mode.shape(x).map(|part| swing * part)
        })
    },
    cells: |_| &[2, 4, 8, 12],
    points: &[1, 2],
    doubt: 0.0,
    expected: SECOND_ORDER,
};

const SCENARIO: &str = include_str!("../../../scenarios/beam.toml");
const HEIGHT: f64 = 0.1;
const YOUNG: f64 = 210e9;
const POISSON: f64 = 0.3;
const DENSITY: f64 = 7850.0;
const V0: f64 = 1e-6;

/// Half waves over a length, m, in steel of this Poisson's ratio.
#[derive(Clone, Copy)]
struct Waves {
    number: u32,
    length: f64,
    poisson: f64,
}

const HALF: Waves = Waves {
    number: 1,
    length: 0.5,
    poisson: POISSON,
};

const fn whole(number: u32, poisson: f64) -> Waves {
    Waves {
        number,
        length: 1.0,
        poisson,
    }
}

/// A wave of bending; everything in SI units.
struct Mode {
    k: f64,
    omega: f64,
    /// Decay of its pressure and shear potentials across the beam.
    decay: [f64; 2],
    /// What they begin with, for a middle line that moves by 1.
    amplitude: [f64; 2],
}

impl Mode {
    fn new(waves: &Waves) -> Self {
        let k = f64::from(waves.number) * PI / waves.length;
        let half = 0.5 * HEIGHT;
        // zero at no frequency at all, and again at the one that is sought
        let nu = waves.poisson;
        let (mut low, mut high) = (0.5 * euler(k, nu), euler(k, nu));
        for _ in 0..80 {
            let omega = 0.5 * (low + high);
            let [a, b] = decay(k, omega, nu);
            let pull = (k * k + b * b).powi(2) * (a * half).tanh();
            if pull < 4.0 * k * k * a * b * (b * half).tanh() {
                low = omega;
            } else {
                high = omega;
            }
        }
        let omega = 0.5 * (low + high);
        let [a, b] = decay(k, omega, nu);
        let (pressure, shear) = (
            (k * k + b * b) * (b * half).cosh(),
            -2.0 * k * a * (a * half).cosh(),
        );
        let middle = pressure * a + shear * k;
        Self {
            k,
            omega,
            decay: [a, b],
            amplitude: [pressure / middle, shear / middle],
        }
    }

    fn period(&self) -> f64 {
        TAU / self.omega
    }

    fn shape(&self, [x, y, _]: &[f64; 3]) -> [f64; 3] {
        let ([a, b], [pressure, shear], k) = (self.decay, self.amplitude, self.k);
        [
            (pressure * k * (a * y).sinh() + shear * b * (b * y).sinh()) * (k * x).cos(),
            (pressure * a * (a * y).cosh() + shear * k * (b * y).cosh()) * (k * x).sin(),
            0.0,
        ]
    }
}

/// Of pressure and of shear waves, Pa.
fn moduli(nu: f64) -> [f64; 2] {
    let shear = 0.5 * YOUNG / (1.0 + nu);
    [
        2.0 * shear * (1.0 - nu) / (1.0 - 2.0 * nu),
        shear,
    ]
}

fn decay(k: f64, omega: f64, nu: f64) -> [f64; 2] {
    moduli(nu).map(|modulus| (k * k - omega * omega * DENSITY / modulus).sqrt())
}

/// E′ = E/(1 − ν²), Pa.
fn in_bending(nu: f64) -> f64 {
    YOUNG / (1.0 - nu * nu)
}

/// Euler and Bernoulli's ω, rad/s.
fn euler(k: f64, nu: f64) -> f64 {
    k * k * HEIGHT * (in_bending(nu) / DENSITY / 12.0).sqrt()
}

/// Timoshenko's ω, rad/s: the lower root of (k²s − ω²)(k²e + s/r² − ω²) = k²s²/r² with s = κG/ρ, e = E′/ρ, r² = H²/12.
fn timoshenko(k: f64) -> f64 {
    let shear = 5.0 / (6.0 - POISSON) * moduli(POISSON)[1] / DENSITY;
    let modulus = in_bending(POISSON) / DENSITY;
    let inertia = shear * 12.0 / (HEIGHT * HEIGHT);
    let half = 0.5 * (k * k * (shear + modulus) + inertia);
    // the product of both roots over the larger one: their difference would cancel
    let product = k.powi(4) * shear * modulus;
    (product / (half + (half * half - product).sqrt())).sqrt()
}

fn overrides(waves: &Waves, cells: f64, periods: f64, rows: u32) -> Vec<String> {
    let mode = Mode::new(waves);
    let period = mode.period();
    vec![
        format!("grid.cell_size={}", HEIGHT / cells),
        format!("constants.L=\"{} m\"", waves.length),
        format!("constants.mode={}", waves.number),
        format!("constants.nu={}", waves.poisson),
        format!("constants.omega=\"{:?} rad/s\"", mode.omega),
        format!("time.end={:?}", periods * period),
        format!("output.every={:?}", period / f64::from(rows)),
    ]
}

/// What is compared: a basis, with points that move through the grid in even distances, or in the total frame with others.
#[derive(Clone, Copy)]
struct Kind {
    basis: &'static str,
    placement: Placement,
}

impl Kind {
    fn name(&self) -> String {
        match self.placement {
            Placement::Even => self.basis.into(),
            Placement::Bending => format!("{}, placed for bending", self.basis),
        }
    }

    /// The error of the frequency over (h/H)² of a slender beam with 2 points a cell and axis.
    fn slender(&self, nu: f64) -> f64 {
        let excess = match self.basis {
            "linear" => moduli(nu).iter().sum::<f64>() / in_bending(nu) - 1.0,
            _ => 0.0,
        };
        let moment = match self.placement {
            Placement::Even => 1.0 - 1.0 / 4.0,
            Placement::Bending => f64::max(1.0 / (1.0 + excess), 0.5),
        };
        0.5 * (moment * (1.0 + excess) - 1.0)
    }
}

const KINDS: [Kind; 4] = [
    kind("linear", Placement::Even),
    kind("quadratic", Placement::Even),
    kind("linear", Placement::Bending),
    kind("quadratic", Placement::Bending),
];

const fn kind(basis: &'static str, placement: Placement) -> Kind {
    Kind { basis, placement }
}

const MODES: [u32; 3] = [1, 2, 3];
/// Cells over the height.
const CELLS: [f64; 3] = [2.0, 4.0, 8.0];

fn run(report: &mut Report) -> Result<(), CaseError> {
    let modes = MODES.map(|number| Mode::new(&whole(number, POISSON)));
    for (number, mode) in MODES.iter().zip(&modes) {
        // they part with the fourth power of kc, times 0.008 where it is small
        report.close(
            format!("equations, mode {number}: Timoshenko / Rayleigh-Lamb"),
            timoshenko(mode.k) / mode.omega,
            1.0,
            0.01 * (0.5 * mode.k * HEIGHT).powi(4),
        );
    }
    let numbers = MODES.map(f64::from);
    let beams = modes.each_ref().map(|mode| euler(mode.k, POISSON));
    let share = |of: [f64; 3]| [0, 1, 2].map(|i| of[i] * modes[i].omega / beams[i]);
    let mut errors = Vec::new();
    let mut shown = vec![curve(
        "exact (Rayleigh–Lamb)",
        &numbers,
        &share([1.0; 3]),
        Style::Dashed,
    )];
    for kind in KINDS {
        let (basis, slender) = (kind.name(), kind.slender(POISSON));
        let mut wrong = |number, cells| wrong(report, &kind, cells, &whole(number, POISSON), &[]);
        let coarse = [wrong(1, CELLS[0])?, wrong(1, CELLS[1])?];
        let fine = [
            wrong(1, CELLS[2])?,
            wrong(2, CELLS[2])?,
            wrong(3, CELLS[2])?,
        ];
        let first = [coarse[0], coarse[1], fine[0]];
        for ((number, mode), error) in MODES.iter().zip(&modes).zip(fine) {
            // dispersion goes with (kh)²: in a bar by a seventh to a quarter of it, in bending, with shear and rotation, by no more than it
            let theta = mode.k * HEIGHT / CELLS[2];
            report.close(
                format!("{basis}, 8 cells over the height, mode {number}: frequency / exact"),
                1.0 + error,
                1.0 + slender / (CELLS[2] * CELLS[2]),
                theta * theta,
            );
        }
        let sizes = CELLS.map(|cells| 1.0 / cells);
        let size = first.map(f64::abs);
        report.close(
            format!("{basis}, mode 1: order of convergence, 4 to 8 cells"),
            orders(&sizes, &size)[1],
            2.0,
            0.2,
        );
        // what is left is of fourth order, as the square of what 4 cells err, 1.5e-4
        report.close(
            format!("{basis}, mode 1: frequency extrapolated from 4 and 8 cells / exact"),
            1.0 + (4.0 * first[2] - first[1]) / 3.0,
            1.0,
            5e-4,
        );
        // modes 1 and 2 together are free of k²; a tenth of what the layers do is left for higher terms
        report.close(
            format!("{basis}: error of the frequency where the beam is slender / (h/H)^2"),
            (4.0 * fine[0] - fine[1]) / 3.0 * CELLS[2] * CELLS[2],
            slender,
            0.0125,
        );
        let file = basis.replace([' ', ','], "_").replace("__", "_");
        report.table(
            &format!("{file}_mode_1"),
            &[("cells", &CELLS), ("error", &first)],
        );
        report.table(
            &format!("{file}_8_cells"),
            &[("mode", &numbers), ("error", &fine)],
        );
        errors.push(curve(basis.clone(), &sizes, &size, Style::LineMarkers));
        shown.push(curve(
            format!("{basis}, 8 cells over the height"),
            &numbers,
            &share(fine.map(|error| 1.0 + error)),
            Style::Markers,
        ));
    }
    for (poisson, kind) in [0.0, 0.45].iter().flat_map(|nu| KINDS.map(|kind| (*nu, kind))) {
        if kind.basis == "linear" {
            let mut wrong = |number| wrong(report, &kind, CELLS[2], &whole(number, poisson), &[]);
            let (first, second) = (wrong(1)?, wrong(2)?);
            report.close(
                format!("{}, ν = {poisson}: error where the beam is slender / (h/H)^2", kind.name()),
                (4.0 * first - second) / 3.0 * CELLS[2] * CELLS[2],
                kind.slender(poisson),
                0.0125,
            );
        }
    }
    plane_stress(report)?;
    let errors = LineChart {
        x_log: true,
        y_log: true,
        ..chart(
            "Bending of a beam, mode 1",
            "cell size / height",
            "error of the frequency, relative",
            errors,
        )
    };
    let frequencies = chart(
        "Bending of a beam ten times as long as high",
        "mode",
        "frequency / Euler and Bernoulli's",
        shown,
    );
    report.chart("beam", vec![frequencies, errors]);
    Ok(())
}

/// In plane stress E′ = E and M = E/(1 − ν²). The shape of the mode is another, but what the places of points change is not: all that goes
/// with (kh)² is the same for both and drops out of their ratio; what is left is of fourth order, a tenth of it.
fn plane_stress(report: &mut Report) -> Result<(), CaseError> {
    for poisson in [0.1, 0.35] {
        let mut share = |placement| {
            let (kind, waves) = (kind("linear", placement), whole(1, poisson));
            wrong(report, &kind, CELLS[2], &waves, &["plane=\"stress\""]).map(|error| 1.0 + error)
        };
        let ratio = share(Placement::Even)? / share(Placement::Bending)?;
        let excess = 0.5 / (1.0 + poisson) + poisson * poisson / (1.0 - poisson * poisson);
        report.close(
            format!("linear, plane stress, ν = {poisson}: even over placed, frequencies, difference / (h/H)^2"),
            (ratio - 1.0) * CELLS[2] * CELLS[2],
            0.5 * (0.75 * (1.0 + excess) - 1.0),
            0.003,
        );
    }
    Ok(())
}

/// The relative error of the angular frequency that two periods show.
fn wrong(
    report: &mut Report,
    kind: &Kind,
    cells: f64,
    waves: &Waves,
    more: &[&str],
) -> Result<f64, CaseError> {
    let mode = Mode::new(waves);
    let mut all = overrides(waves, cells, 2.0, 40);
    let (basis, placement) = (kind.basis, kind.placement.name());
    let frame = match kind.placement {
        Placement::Even => "updated",
        Placement::Bending => "total",
    };
    all.extend([
        format!("method.basis=\"{basis}\""),
        format!("method.frame=\"{frame}\""),
        format!("method.placement=\"{placement}\""),
        "time.courant=0.8".into(),
    ]);
    all.extend(more.iter().map(ToString::to_string));
    let run = report.run_with_frames(SCENARIO, &all)?;
    let frames = &run.memory.frames;
    let start = &frames[0].points;
    let swing = |frame: &crate::observe::Frame| -> f64 {
        let points = frame.points.iter().zip(start);
        points
            .map(|(now, start)| now.velocity[1] * (mode.k * start.position[0]).sin())
            .sum()
    };
    let time: Vec<f64> = frames.iter().map(|frame| frame.time).collect();
    let values: Vec<f64> = frames.iter().map(swing).collect();
    let omega = TAU * frequency_near(&time, &values, 1.0 / mode.period());
    Ok(omega / mode.omega - 1.0)
}
