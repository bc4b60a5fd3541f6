//! The critical time step in 2D and 3D: a block at rest, held all around.
//!
//! Predicted as in `courant`: the answers of the solver to unit disturbances of one cell are the step of an endless block. For each
//! wave vector they add up to a small matrix, a polynomial of the second degree in the step, so that three steps of the solver say it
//! for all. Measured: noise on a block whose outer nodes are held, by bisection around the prediction. The same in 1D is what the
//! rule of thumb divides by √d.

use super::bar::noise;
use super::bisect::first_failure;
use super::findings::{Drawing, Findings, Sense};
use super::measure::ENERGY_GROWTH;
use super::operator::{ROUND_OFF, radius};
use super::{Failure, Method, Study};
use crate::math::packed_len;
use crate::report::{HeatCell, HeatMap, ZoneChart, ZonePanel};
use crate::run::{Computing, build_with};
use crate::scenario::{Scenario, parse};
use crate::solver::{Fault, Solver};
use crate::state::State;
use crate::study::validate::CaseError;
use nalgebra::{Complex, DMatrix};
use std::f64::consts::PI;

/// The case.
pub const FAILURE: Failure = Failure {
    name: "block",
    title: "the critical time step in 2D and 3D, against 1D and against the time in which a wave crosses a cell",
    measure: "critical Courant number c dt/h, c the speed of pressure waves, of noise on a held block (Poisson's ratio 0.3): energy grows 1000-fold within 200 steps, searched from 0.7 to 1.4 of the predicted edge; fails below 1, which is `courant = 1` of a scenario",
    prediction: "spectral radius of one step of the solver on an endless block, points between nodes and at nodes, wave numbers in steps of pi/24 (1D), pi/8 (2D) and pi/4 (3D)",
    run,
};

const STEPS: usize = 200;
const RANGE: [f64; 2] = [0.05, 4.0];
const POISSON: f64 = 0.3;
/// Cells that are empty around a block.
const MARGIN: u32 = 2;
/// Wave numbers along an axis, between 0 and π per cell, by dimension.
const WAVES: [usize; 4] = [0, 24, 8, 4];

/// Dimension, and points a cell and axis.
type Place = (usize, u32);

fn at((dimension, points): Place) -> String {
    format!("{dimension}D, {points} per cell and axis")
}

fn run(study: &Study) -> Result<Findings, CaseError> {
    let points = study.points_or(&[1, 2]);
    let mut places: Vec<Place> = points.iter().map(|n| (1, *n)).collect();
    places.extend(points.iter().map(|n| (2, *n)));
    // 144 numbers a cell with 2 × 2 × 2 points: too many for a look at all waves
    places.extend(points.iter().filter(|n| **n == 1).map(|n| (3, *n)));
    // nothing moves: the frames do the same
    // the prediction is a polynomial of second degree in the step, with the reach of one stencil
    let mut methods = study.whatever_frame();
    methods.retain(|method| !method.has_terms());
    let jobs: Vec<(Method, Place)> = methods
        .iter()
        .flat_map(|method| places.iter().map(|place| (*method, *place)))
        .collect();
    let edges = study.map(&jobs, |(method, (dimension, points))| match dimension {
        1 => edge::<1>(*method, *points),
        2 => edge::<2>(*method, *points),
        _ => edge::<3>(*method, *points),
    });
    let mut findings = Findings::new("critical Courant number c dt/h", Sense::AtLeast, 1.0);
    for ((method, place), (predicted, measured)) in jobs.iter().zip(&edges) {
        findings.push(
            method.within_frame(),
            at(*place),
            Some(*predicted),
            *measured,
        );
    }
    let measured = |method: &Method, place: Place| {
        let row = findings.row(&method.within_frame(), &at(place));
        row.map_or(f64::NAN, |row| row.measured)
    };
    let several: Vec<Place> = places.iter().copied().filter(|place| place.0 > 1).collect();
    let ratios: Vec<Vec<f64>> = methods
        .iter()
        .map(|method| {
            let ratio = |place: &Place| measured(method, *place) / measured(method, (1, place.1));
            several.iter().map(ratio).collect()
        })
        .collect();
    let said = several.iter().enumerate().map(|(i, place)| {
        let of = ratios.iter().map(|row| row[i]);
        let (least, most) = of.fold((f64::INFINITY, 0.0_f64), |(a, b), x| (a.min(x), b.max(x)));
        format!(
            "{least:.2} to {most:.2} of 1D in {} (1/sqrt(d) = {:.2})",
            at(*place),
            (place.0 as f64).powf(-0.5)
        )
    });
    findings.shown = format!(
        "The step is {}. {} of {} edges lie below 1. Measured and predicted edges differ by {:.1} % at most.",
        said.collect::<Vec<_>>().join(", "),
        findings.failing(),
        findings.rows.len(),
        100.0 * findings.worst_deviation()
    );
    let panel = |place: &Place| {
        let of = || jobs.iter().zip(&edges).filter(|(job, _)| job.1 == *place);
        ZonePanel {
            title: match place {
                (1, 1) => "1D, 1 point per cell".into(),
                (1, n) => format!("1D, {n} points per cell"),
                (d, n) => format!("{d}D, {}", vec![n.to_string(); *d].join(" × ")),
            },
            edges: of().map(|(_, edge)| edge.1).collect(),
            predicted: of().map(|(_, edge)| Some(edge.0)).collect(),
        }
    };
    let rows: Vec<String> = methods.iter().map(Method::within_frame).collect();
    let chart = ZoneChart {
        title:
            "Longest stable time step of an elastic block at rest, c the speed of pressure waves"
                .into(),
        x_label: "c Δt/h".into(),
        x_range: [0.0, 3.6],
        x_log: false,
        holds: "stable".into(),
        fails: "unstable: energy grows 1000-fold".into(),
        predicted: "predicted edge: spectral radius of one step".into(),
        rows: rows.clone(),
        panels: several.iter().map(panel).collect(),
    };
    let map = HeatMap {
        title: "Longest stable step in 2D and 3D over that in 1D; rule of thumb: 1/√2 = 0.71, 1/√3 = 0.58".into(),
        x_label: "dimension and points".into(),
        holds: "as in 1D, or not much less".into(),
        fails: "as the rule says: some 1/√d of 1D".into(),
        columns: several.iter().map(|place| at(*place)).collect(),
        rows,
        cells: ratios
            .iter()
            .map(|row| row.iter().zip(&several).map(|(ratio, place)| cell(*ratio, place.0)).collect())
            .collect(),
    };
    findings.drawings.push(("", Drawing::Zones(chart)));
    findings.drawings.push(("ratio", Drawing::Map(map)));
    Ok(findings)
}

fn cell(ratio: f64, dimension: usize) -> HeatCell {
    let rule = (dimension as f64).powf(-0.5);
    HeatCell {
        text: format!("{ratio:.2}"),
        fails: ratio < 0.5 * (1.0 + rule),
        strength: ((ratio - 0.5 * (1.0 + rule)) / (0.5 * (1.0 - rule))).abs(),
    }
}

/// Predicted and measured edge.
fn edge<const D: usize>(method: Method, points: u32) -> (f64, f64) {
    let spacing = 1.0 / f64::from(points);
    let worst = [0.0, 1e-4 - 0.5 * spacing]
        .map(|offset| (predicted::<D>(method, points, offset), offset))
        .into_iter()
        .min_by(|a, b| a.0.total_cmp(&b.0));
    let (predicted, offset) = worst.unwrap_or((f64::NAN, 0.0));
    if !predicted.is_finite() {
        return (predicted, f64::NAN);
    }
    let range = [0.7 * predicted, 1.4 * predicted];
    let measured = first_failure(range, 0.1 * predicted, 5e-3, |dt| {
        noise_grows::<D>(method, points, offset, dt)
    });
    (predicted, measured)
}

/// A block of points in an elastic material with ρ = 1 kg/m³ and c = 1 m/s on cells of 1 m.
struct Block<const D: usize> {
    state: State<D>,
    solver: Box<dyn Solver<D>>,
    rest: Vec<crate::math::Vector<D>>,
    /// Points along an axis.
    along: usize,
    affine: bool,
}

impl<const D: usize> Block<D> {
    /// A cube of so many cells, whose points lie `offset` m beyond places that part a cell evenly. Nodes are held within `held`
    /// cells of its faces.
    fn new(method: Method, points: u32, cells: u32, held: u32, offset: f64) -> Result<Self, Fault> {
        let scenario = scenario::<D>(method, points, cells, held, offset);
        let computing = Computing {
            parallel: Some(false),
            instructions: None,
        };
        let mut scene = build_with::<D>(&scenario, &computing);
        let p = &scene.state.bodies[0].particles;
        let (rest, affine) = (p.position.clone(), !p.affine.is_empty());
        scene.solver.start(&mut scene.state)?;
        Ok(Self {
            state: scene.state,
            solver: scene.solver,
            rest,
            along: (cells * points) as usize,
            affine,
        })
    }

    /// Numbers a point: velocity, stress, affine field.
    fn numbers(&self) -> usize {
        D + packed_len(D) + if self.affine { D * D } else { 0 }
    }

    /// Puts every point back to its place, at rest but for what `number` says of (point, number).
    fn set(&mut self, number: impl Fn(usize, usize) -> f64) {
        let packed = packed_len(D);
        let p = &mut self.state.bodies[0].particles;
        let total = p.is_total();
        for row in 0..p.len() {
            let id = p.id[row] as usize;
            p.position[row] = self.rest[id];
            for a in 0..D {
                p.velocity[row][a] = number(id, a);
            }
            for a in 0..packed {
                p.stress[row * packed + a] = number(id, D + a);
            }
            if let Some(field) = p.affine.get_mut(row) {
                for a in 0..D * D {
                    field[a] = number(id, D + packed + a);
                }
            }
            if total {
                if let Some(deformed) = p.deformation_gradient.get_mut(row) {
                    *deformed = crate::math::Matrix::identity();
                }
                p.first_piola_stress[row] =
                    crate::math::unpack(&p.stress[row * packed..][..packed]);
            }
        }
    }

    /// What all points hold, point after point in the order of their numbers.
    fn get(&self) -> Vec<f64> {
        let (numbers, packed) = (self.numbers(), packed_len(D));
        let p = &self.state.bodies[0].particles;
        let mut all = vec![0.0; p.len() * numbers];
        for row in 0..p.len() {
            let of = &mut all[p.id[row] as usize * numbers..][..numbers];
            of[..D].copy_from_slice(p.velocity[row].as_slice());
            of[D..D + packed].copy_from_slice(&p.stress[row * packed..][..packed]);
            if let Some(field) = p.affine.get(row) {
                of[D + packed..].copy_from_slice(field.as_slice());
            }
        }
        all
    }

    /// Squares of velocities and stresses.
    fn size(&self) -> f64 {
        let p = &self.state.bodies[0].particles;
        let moving: f64 = p.velocity.iter().map(|v| v.norm_squared()).sum();
        moving + p.stress.iter().map(|s| s * s).sum::<f64>()
    }
}

fn noise_grows<const D: usize>(method: Method, points: u32, offset: f64, dt: f64) -> bool {
    let cells = [0, 30, 14, 10][D];
    let Ok(mut block) = Block::<D>::new(method, points, cells, 1, offset) else {
        return true;
    };
    block.set(|id, number| {
        if number < D {
            1e-9 * noise(id * D + number)
        } else {
            0.0
        }
    });
    let start = block.size();
    for step in 0..STEPS {
        if block.solver.step(&mut block.state, dt).is_err() {
            return true;
        }
        if step % 8 == 7 {
            let grown = block.size() / start;
            if grown.is_nan() || grown > ENERGY_GROWTH {
                return true;
            }
        }
    }
    false
}

/// The critical Courant number of an endless block.
fn predicted<const D: usize>(method: Method, points: u32, offset: f64) -> f64 {
    // points know of what happens as far away as four stencils reach
    let cells = match method.basis {
        "linear" | "gimp" => 11,
        "quadratic" => 13,
        _ => 17,
    };
    let Ok(mut block) = Block::<D>::new(method, points, cells, 0, offset) else {
        return f64::NAN;
    };
    let answers =
        [0.5, 1.0, 1.5].map(|dt| Answers::of(&mut block, points as usize, cells as usize, dt));
    let [Ok(a), Ok(b), Ok(c)] = answers else {
        return f64::NAN;
    };
    let mut edge = f64::INFINITY;
    for wave in waves::<D>() {
        let [a, b, c] = [&a, &b, &c].map(|answers| answers.wave(&wave));
        // the polynomial through the three
        let half = Complex::new(0.5, 0.0);
        let (x, y) = ((&c - &a) * half, (&c + &a) * half - &b);
        let grows = |dt: f64| {
            let s = (dt - 1.0) / 0.5;
            let step = &b + &x * Complex::new(s, 0.0) + &y * Complex::new(s * s, 0.0);
            radius(&step) > 1.0 + ROUND_OFF
        };
        // most waves are stable where the worst one so far is not
        let high = if edge.is_finite() { edge } else { RANGE[1] };
        if grows(high * (1.0 - 1e-3)) || !edge.is_finite() {
            edge = edge.min(first_failure([RANGE[0], high], 0.2, 1e-3, grows));
        }
    }
    edge
}

/// Wave vectors, 1/cells, that are not mirror images or permutations of each other; the most critical kind first.
fn waves<const D: usize>() -> Vec<[f64; D]> {
    let most = WAVES[D];
    let count = (most + 1).pow(D as u32);
    let all = (0..count).rev().map(|code| {
        let digit = |a: usize| code / (most + 1).pow(a as u32) % (most + 1);
        std::array::from_fn(|a| PI * digit(a) as f64 / most as f64)
    });
    all.filter(|wave: &[f64; D]| wave.is_sorted()).collect()
}

/// How an endless block answers, within one step, to what happens in one of its cells.
struct Answers<const D: usize> {
    size: usize,
    /// How many cells away, and the answer there.
    blocks: Vec<([f64; D], DMatrix<f64>)>,
}

impl<const D: usize> Answers<D> {
    fn of(block: &mut Block<D>, points: usize, cells: usize, dt: f64) -> Result<Self, Fault> {
        const UNIT: f64 = 1e-9;
        let numbers = block.numbers();
        let inside = points.pow(D as u32);
        let size = inside * numbers;
        let along = block.along;
        // the number of a point of a cell: x slowest
        let number = |cell: usize, point: usize| {
            (0..D).fold(0, |number, a| {
                let digit = |code: usize, base: usize| code / base.pow((D - 1 - a) as u32) % base;
                number * along + digit(cell, cells) * points + digit(point, points)
            })
        };
        let every = cells.pow(D as u32);
        let middle = (0..D).fold(0, |code, _| code * cells + cells / 2);
        let mut matrices = vec![DMatrix::zeros(size, size); every];
        for q in 0..inside {
            let cause = number(middle, q);
            for b in 0..numbers {
                block.set(|id, a| if id == cause && a == b { UNIT } else { 0.0 });
                block.solver.step(&mut block.state, dt)?;
                let held = block.get();
                for (cell, matrix) in matrices.iter_mut().enumerate() {
                    for p in 0..inside {
                        let of = &held[number(cell, p) * numbers..][..numbers];
                        for (a, value) in of.iter().enumerate() {
                            matrix[(p * numbers + a, q * numbers + b)] = value / UNIT;
                        }
                    }
                }
            }
        }
        let away = |cell: usize| {
            std::array::from_fn(|a| {
                let digit = cell / cells.pow((D - 1 - a) as u32) % cells;
                digit as f64 - (cells / 2) as f64
            })
        };
        let blocks = matrices.into_iter().enumerate();
        let blocks = blocks.map(|(cell, matrix)| (away(cell), matrix));
        Ok(Self {
            size,
            blocks: blocks
                .filter(|(_, matrix)| matrix.iter().any(|x| *x != 0.0))
                .collect(),
        })
    }

    fn wave(&self, k: &[f64; D]) -> DMatrix<Complex<f64>> {
        let mut sum = DMatrix::zeros(self.size, self.size);
        for (cells, block) in &self.blocks {
            let turned: f64 = cells.iter().zip(k).map(|(cells, k)| cells * k).sum();
            let phase = Complex::from_polar(1.0, -turned);
            sum.zip_apply(block, |sum, x| *sum += phase * x);
        }
        sum
    }
}

fn scenario<const D: usize>(
    method: Method,
    points: u32,
    cells: u32,
    held: u32,
    offset: f64,
) -> Scenario {
    let vector = |x: f64| format!("{:?}", [x; D]);
    let (from, end) = (f64::from(MARGIN), f64::from(MARGIN + cells));
    let mut sides = String::new();
    for axis in 0..D {
        for upper in [false, true] {
            let (mut min, mut max) = ([-99.0; D], [99.0; D]);
            if upper {
                min[axis] = end - f64::from(held);
            } else {
                max[axis] = from + f64::from(held);
            }
            sides += &format!(
                "[[boundary]]\nname = \"side{axis}{upper}\"\non.box = {{ min = {min:?}, max = {max:?} }}\ncondition = \"fixed\"\n"
            );
        }
    }
    if held == 0 {
        sides.clear();
    }
    // λ + 2μ = 1 Pa
    let young = match D {
        1 => 1.0,
        _ => (1.0 + POISSON) * (1.0 - 2.0 * POISSON) / (1.0 - POISSON),
    };
    let ratio = if D == 1 { 0.0 } else { POISSON };
    let text = format!(
        r#"dimension = {D}
time = {{ end = 1.0, step = 1.0 }}
grid = {{ min = {}, max = {}, cell_size = 1.0 }}
{}material.block = {{ density = 1.0, linear_elastic = {{ youngs_modulus = {young:?}, poissons_ratio = {ratio:?}, rate = "kirchhoff" }} }}
[[body]]
name = "block"
material = "block"
shape.box = {{ min = {}, max = {} }}
particles_per_cell = {points}
{sides}"#,
        vector(0.0),
        vector(end + f64::from(MARGIN)),
        method.toml(),
        vector(from + offset),
        vector(end + offset),
    );
    match parse("block", &text, &[]) {
        Ok(loaded) => loaded.scenario,
        Err(error) => unreachable!("the block of a stability case is a valid scenario:\n{error}"),
    }
}
