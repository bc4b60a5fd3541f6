//! The specimen of most cases: an elastic bar in 1D with E = 1 Pa, ρ = 1 kg/m³ and cells of 1 m, so that the wave speed is
//! 1 m/s and a step of Δt seconds is the Courant number c Δt/h itself.

use super::method::Method;
use crate::material::Plane;
use crate::run::{Computing, build_with};
use crate::scenario::{Scenario, parse};
use crate::solver::{Fault, Solver};
use crate::state::State;

/// What a bar is.
#[derive(Clone, Debug)]
pub struct Bar {
    /// How it is computed.
    pub method: Method,
    /// Points per cell.
    pub points: u32,
    /// Its ends before it is stretched, m.
    pub span: [f64; 2],
    /// Cells of the grid, which starts at 0.
    pub cells: u32,
    /// Ranges of nodes that are held, m.
    pub held: Vec<[f64; 2]>,
    /// The velocity at which they are held, m/s.
    pub drift: f64,
    /// How much farther apart than at rest its points lie. They keep their width, unless they have domains, which are stretched
    /// as the bar is; their stress is set by whoever asks.
    pub stretch: f64,
}

impl Bar {
    /// A long bar with both ends held over six cells, whose points lie `offset` m beyond the places that part a cell evenly. No
    /// free end and no node of little mass takes part in what its middle does.
    pub fn held(method: Method, points: u32, offset: f64) -> Self {
        Self {
            method,
            points,
            span: [3.0 + offset, 43.0 + offset],
            cells: 46,
            held: vec![[-2.0, 8.0], [38.0, 48.0]],
            drift: 0.0,
            stretch: 1.0,
        }
    }

    fn scenario(&self) -> Scenario {
        let [from, to] = self.span;
        let held = self.held.iter().enumerate().map(|(i, [min, max])| {
            format!("[[boundary]]\nname = \"held{i}\"\non.box = {{ min = [{min:?}], max = [{max:?}] }}\ncondition.driven = {{ velocity = [{:?}] }}\n", self.drift)
        });
        // the rate of the Kirchhoff stress is linear in the velocity: what is small stays exactly linear
        let text = format!(
            r#"dimension = 1
time = {{ end = 1.0, step = 1.0 }}
grid = {{ min = [0.0], max = [{:?}], cell_size = 1.0 }}
{}material.bar = {{ density = 1.0, linear_elastic = {{ youngs_modulus = 1.0, poissons_ratio = 0.0, rate = "kirchhoff" }} }}
[[body]]
name = "bar"
material = "bar"
shape.box = {{ min = [{from:?}], max = [{to:?}] }}
particles_per_cell = {}
{}"#,
            f64::from(self.cells),
            self.method.toml(),
            self.points,
            held.collect::<String>()
        );
        match parse("bar", &text, &[]) {
            Ok(loaded) => loaded.scenario,
            Err(error) => unreachable!("the bar of a stability case is a valid scenario:\n{error}"),
        }
    }

    /// The bar on its grid, at rest and free of stress.
    ///
    /// # Errors
    /// If its points do not fit into the grid.
    pub fn build(&self) -> Result<Specimen, Fault> {
        let scenario = self.scenario();
        debug_assert_eq!(scenario.plane, Plane::Strain);
        let computing = Computing {
            parallel: Some(false),
            instructions: None,
        };
        let mut scene = build_with::<1>(&scenario, &computing);
        let middle = 0.5 * (self.span[0] + self.span[1]);
        let p = &mut scene.state.bodies[0].particles;
        let rest: Vec<f64> = p
            .position
            .iter()
            .map(|x| middle + (x[0] - middle) * self.stretch)
            .collect();
        for (x, rest) in p.position.iter_mut().zip(&rest) {
            x[0] = *rest;
        }
        let affine = !p.affine.is_empty();
        scene.solver.start(&mut scene.state)?;
        Ok(Specimen {
            state: scene.state,
            solver: scene.solver,
            rest,
            affine,
            stretch: self.stretch,
        })
    }
}

/// A bar that can be put into any state and stepped by the solver of every run.
pub struct Specimen {
    /// Its points.
    pub state: State<1>,
    solver: Box<dyn Solver<1>>,
    rest: Vec<f64>,
    affine: bool,
    stretch: f64,
}

/// What a point holds: velocity, m/s; stress, Pa; affine field, 1/s.
pub type Point = [f64; 3];

impl Specimen {
    /// How many points there are.
    pub fn len(&self) -> usize {
        self.rest.len()
    }

    /// How many of the numbers of a [`Point`] its method has.
    pub fn numbers(&self) -> usize {
        if self.affine { 3 } else { 2 }
    }

    /// Where the points lie at rest, m, in the order of their numbers.
    pub fn rest(&self) -> &[f64] {
        &self.rest
    }

    /// Puts every point back to its place, with what `point` says it holds.
    pub fn set(&mut self, point: impl Fn(usize) -> Point) {
        let stretch = self.stretch;
        let p = &mut self.state.bodies[0].particles;
        for row in 0..p.len() {
            let id = p.id[row] as usize;
            let [velocity, stress, affine] = point(id);
            p.position[row][0] = self.rest[id];
            if let Some(deformed) = p.deformation_gradient.get_mut(row) {
                deformed[(0, 0)] = self.stretch;
            }
            p.velocity[row][0] = velocity;
            p.stress[row] = stress;
            if let Some(field) = p.affine.get_mut(row) {
                field[(0, 0)] = affine;
            }
            if p.is_total() {
                p.first_piola_stress[row][(0, 0)] = stress / stretch;
            }
        }
    }

    /// What every point holds now, in the order of their numbers.
    pub fn get(&self) -> Vec<Point> {
        let p = &self.state.bodies[0].particles;
        let mut all = vec![[0.0; 3]; p.len()];
        for row in 0..p.len() {
            let affine = p.affine.get(row).map_or(0.0, |field| field[(0, 0)]);
            all[p.id[row] as usize] = [p.velocity[row][0], p.stress[row], affine];
        }
        all
    }

    /// One step of the solver.
    ///
    /// # Errors
    /// If the motion goes wrong.
    pub fn step(&mut self, dt: f64) -> Result<(), Fault> {
        self.solver.step(&mut self.state, dt)
    }

    /// Kinetic energy in the frame that moves at `drift`, m/s, and elastic energy, J.
    pub fn energy(&self, drift: f64) -> f64 {
        let p = &self.state.bodies[0].particles;
        let kinetic = (0..p.len()).map(|i| 0.5 * p.mass[i] * (p.velocity[i][0] - drift).powi(2));
        let elastic = (0..p.len()).map(|i| 0.5 * p.mass.initial_volume(i) * p.stress[i].powi(2));
        kinetic.chain(elastic).sum()
    }
}

/// A number in [−1, 1] that looks random and is the same in every run: noise whose growth shows an instability.
pub fn noise(index: usize) -> f64 {
    // the golden ratio's multiples are spread evenly; their squares are without order
    let x = (index as f64 + 1.0).powi(2) * 0.618_033_988_749_895;
    2.0 * (x - x.floor()) - 1.0
}
