//! The material point method: one step, as the algorithm box of a paper would print it.

use super::grouping::{Grouping, sort_in_steps};
use super::integrate::{Constraint, GridStep};
use super::kernels::Kernels;
use super::ledger::{GridSums, Ledger, Stored};
use super::loads::{Load, Loads};
use super::sort::Scratch;
use super::stencil::{Columns, Gathered, Scattered, Sources, Wanted};
use super::survey::max_stiffness;
use super::{Fault, Limit, Solver};
use crate::boundary::Condition;
use crate::grid::{Blocks, Geometry, Node, block_edge};
use crate::math::{Sum, Vector, packed_len};
use crate::real::Instructions;
use crate::scenario::Scheme;
use crate::state::{Body, State};
use crate::totals::{Totals, in_parts, largest_in_parts};

/// Everything that a solver is told before a run.
pub struct Setup<const D: usize> {
    /// The grid.
    pub geometry: Geometry<D>,
    /// The basis and the transfer.
    pub kernels: Box<dyn Kernels<D>>,
    /// Terms of the velocities that points take from the grid, see [`Method::terms`](crate::transfer::Method::terms).
    pub terms: u32,
    /// When stresses are updated.
    pub scheme: Scheme,
    /// Acceleration of gravity, m/s².
    pub gravity: Vector<D>,
    /// Damping rate, 1/s.
    pub damping: f64,
    /// Conditions on nodes.
    pub boundaries: Vec<Box<dyn Condition<D>>>,
    /// For each boundary, the closed box of positions, m, of its nodes.
    pub boundary_boxes: Vec<(Vector<D>, Vector<D>)>,
    /// Forces on points.
    pub loads: Vec<Load<D>>,
    /// Whether steps may use several threads.
    pub parallel: bool,
}

/// The solver for `D` dimensions.
pub struct Mpm<const D: usize> {
    pub(super) geometry: Geometry<D>,
    pub(super) kernels: Box<dyn Kernels<D>>,
    pub(super) terms: u32,
    pub(super) scheme: Scheme,
    pub(super) edge: i32,
    pub(super) gravity: Vector<D>,
    pub(super) damping: f64,
    pub(super) boundaries: Vec<Box<dyn Condition<D>>>,
    /// First and last node of each boundary along each axis.
    pub(super) boundary_nodes: Vec<[(i32, i32); D]>,
    pub(super) loads: Loads<D>,
    pub(super) blocks: Blocks<D>,
    pub(super) main: Vec<Node>,
    pub(super) change: Vec<Node>,
    pub(super) second: Vec<Node>,
    pub(super) external: Vec<Node>,
    /// The last term of the velocities, m/s, and the momenta of points that move with it.
    pub(super) term: Vec<Node>,
    pub(super) image: Vec<Node>,
    pub(super) row_sums: Vec<GridSums>,
    pub(super) constraints: Vec<Constraint<D>>,
    pub(super) constraint_ranges: Vec<(u32, u32)>,
    pub(super) gathered: Vec<Gathered>,
    /// The columns of every body, for one step.
    pub(super) columns: Vec<Columns<D>>,
    pub(super) scratch: Scratch<D>,
    pub(super) ledger: Ledger<D>,
    pub(super) grouping: Grouping,
    pub(super) needs_sort: bool,
    pub(super) parallel: bool,
    pub(super) instructions: Instructions,
    pub(super) last_dt: f64,
    pub(super) wave_speed: f64,
    pub(super) speed: f64,
}

/// Steps between two looks at how stiff the points have become.
const STIFFNESS_INTERVAL: u64 = 16;

impl<const D: usize> Mpm<D> {
    /// A solver for the given setup.
    pub fn new(setup: Setup<D>) -> Self {
        let geometry = setup.geometry;
        let boundary_nodes = setup
            .boundary_boxes
            .iter()
            .map(|(min, max)| {
                std::array::from_fn(|a| {
                    let low = (min[a] - geometry.min[a]) / geometry.cell_size - 1e-9;
                    let high = (max[a] - geometry.min[a]) / geometry.cell_size + 1e-9;
                    let position = |index| setup.kernels.position(index, geometry.cells[a]);
                    nodes_between(position, geometry.counts[a], low, high)
                })
            })
            .collect();
        Self {
            edge: block_edge(D, setup.kernels.nodes()),
            geometry,
            kernels: setup.kernels,
            terms: setup.terms,
            scheme: setup.scheme,
            gravity: setup.gravity,
            damping: setup.damping,
            boundaries: setup.boundaries,
            boundary_nodes,
            loads: Loads::new(setup.loads),
            blocks: Blocks::default(),
            main: Vec::new(),
            change: Vec::new(),
            second: Vec::new(),
            external: Vec::new(),
            term: Vec::new(),
            image: Vec::new(),
            row_sums: Vec::new(),
            constraints: Vec::new(),
            constraint_ranges: Vec::new(),
            gathered: Vec::new(),
            columns: Vec::new(),
            scratch: Scratch::default(),
            ledger: Ledger::default(),
            grouping: Grouping::default(),
            needs_sort: true,
            parallel: setup.parallel,
            instructions: Instructions::found(),
            last_dt: 0.0,
            wave_speed: 0.0,
            speed: 0.0,
        }
    }

    /// Whether velocities other than those at the end of the step strain the points.
    pub(super) fn has_second(&self) -> bool {
        self.scheme != Scheme::UpdateStressLast
    }

    /// Whether points take more from the grid than the first term.
    pub(super) fn has_terms(&self) -> bool {
        self.terms > 1
    }

    /// Uses these instructions, as far as the processor has them.
    pub fn with_instructions(mut self, instructions: Instructions) -> Self {
        self.instructions = instructions.usable();
        self
    }

    /// Whether so many groups of points have fallen apart that sorting them pays.
    fn is_worn(&mut self, gathered: &Gathered) -> bool {
        let points = self.blocks.bodies.iter().map(|body| body.points()).sum();
        self.grouping.note(gathered.apart, gathered.alone, points);
        self.grouping.is_worn(sort_in_steps(D))
    }

    fn grid_step(&mut self, state: &State<D>, dt: f64) -> GridSums {
        let mut step = GridStep {
            main: &mut self.main,
            change: &mut self.change,
            external: &self.external,
            rows: &self.blocks.rows,
            ranges: &self.constraint_ranges,
            constraints: &mut self.constraints,
            boundaries: &self.boundaries,
            gravity: self.gravity,
            damping: self.damping,
            ratio: self.kernels.ratio(),
            time: state.time,
            dt,
            wide: self.instructions.wide(),
        };
        step.integrate(&mut self.row_sums, self.parallel);
        self.row_sums
            .iter()
            .fold(GridSums::default(), GridSums::and)
    }

    /// Sums the impulses of each boundary.
    fn react(&mut self, dt: f64) {
        for boundary in 0..self.boundaries.len() {
            let mut impulse = [Sum::default(); D];
            for constraint in self.constraints.iter().filter(|c| c.boundary == boundary) {
                for a in 0..D {
                    impulse[a].add(constraint.impulse[a]);
                }
            }
            let impulse = Vector::from_fn(|a, _| impulse[a].value());
            self.ledger.reactions[boundary] = impulse / dt;
            self.ledger.push(boundary, &impulse);
        }
    }

    /// Velocities from the momenta in `second`.
    fn second_velocities(&mut self, time: f64) {
        GridStep::velocities(
            &mut self.second,
            &self.blocks.rows,
            &self.constraint_ranges,
            &self.constraints,
            &self.boundaries,
            time,
            &mut self.row_sums,
            self.parallel,
            self.instructions.wide(),
        );
    }

    fn sources(&self) -> Sources {
        Sources {
            main: self.main.as_ptr(),
            change: self.change.as_ptr(),
            second: self.second.as_ptr(),
        }
    }

    /// How stiff and fast the points are.
    ///
    /// # Errors
    /// If a point has no stress, because it was turned inside out.
    fn survey(&mut self, state: &State<D>) -> Result<(), Fault> {
        let wave_speed = state
            .bodies
            .iter()
            .map(|body| {
                let p = &body.particles;
                // a law that softens keeps the step of its undeformed state: it may stiffen again within a step
                let stiffness =
                    largest_in_parts(p.len(), |part| max_stiffness(body, part, self.instructions));
                let reference = body.material.reference_stiffness();
                let stiffness = if stiffness < reference {
                    reference
                } else {
                    stiffness
                };
                (stiffness / body.particles.mass.density()).sqrt()
            })
            .fold(0.0, |most: f64, speed| {
                if speed > most || speed.is_nan() {
                    speed
                } else {
                    most
                }
            });
        if wave_speed.is_nan() {
            let width = packed_len(D);
            for body in &state.bodies {
                let stresses = body.particles.stress.chunks_exact(width);
                if let Some(row) = stresses
                    .map(|s| s.iter().any(|x| x.is_nan()))
                    .position(|nan| nan)
                {
                    return Err(Fault::NotFinite(
                        self.place(state.time, state.step, body, row),
                    ));
                }
            }
        }
        self.wave_speed = wave_speed;
        Ok(())
    }
}

impl<const D: usize> Solver<D> for Mpm<D> {
    fn start(&mut self, state: &mut State<D>) -> Result<(), Fault> {
        self.sort(state)?;
        let totals: Vec<_> = state.bodies.iter().map(Body::totals).collect();
        let stored = self.stored(&totals);
        self.ledger.open(stored, self.boundaries.len());
        self.speed = state
            .bodies
            .iter()
            .flat_map(|body| &body.particles.velocity)
            .fold(0.0, |most: f64, v| most.max(v.norm()));
        self.survey(state)
    }

    fn step(&mut self, state: &mut State<D>, dt: f64) -> Result<(), Fault> {
        if self.needs_sort {
            self.sort(state)?;
        }
        self.point_at_columns(state);
        self.clear_grid();
        match self.scheme {
            Scheme::UpdateStressFirst => {
                self.points_to_grid(dt, Scattered::MOMENTUM);
                self.second.copy_from_slice(&self.main);
                self.second_velocities(state.time);
                self.grid_to_points(state, dt, Wanted::STRAIN, &self.sources());
                self.points_to_grid(dt, Scattered::FORCE);
            }
            _ => self.points_to_grid(dt, Scattered::ALL),
        }
        self.loads_to_grid(state, dt);
        let sums = self.grid_step(state, dt).and(&self.sharpen(state.time, dt));
        self.react(dt);
        let sources = self.sources();
        let gathered = match self.scheme {
            Scheme::UpdateStressFirst => self.grid_to_points(state, dt, Wanted::MOTION, &sources),
            Scheme::UpdateStressLast => self.grid_to_points(state, dt, Wanted::ALL, &sources),
            Scheme::ModifiedUpdateStressLast => {
                let mut second = std::mem::take(&mut self.second);
                let gathered = self.exchange(dt, &sources, &mut second);
                self.second = second;
                self.second_velocities(state.time + dt);
                let rest = Wanted::POSITION_AND_STRAIN;
                gathered.and(self.grid_to_points(state, dt, rest, &sources))
            }
        };
        self.ledger.book(&sums, gathered.kinetic);
        self.speed = gathered.speed_squared.sqrt();
        self.needs_sort = !gathered.within || self.is_worn(&gathered);
        self.last_dt = dt;
        state.time += dt;
        state.step += 1;
        if self.needs_sort {
            self.sort(state)?;
        }
        if state.step.is_multiple_of(STIFFNESS_INTERVAL) {
            self.survey(state)?;
        }
        Ok(())
    }

    fn stored(&self, totals: &[Totals<D>]) -> Stored {
        let (mut kinetic, mut elastic, mut potential) =
            (Sum::default(), Sum::default(), Sum::default());
        for totals in totals {
            kinetic.add(totals.kinetic);
            elastic.add(totals.elastic);
            potential.add(-totals.mass * self.gravity.dot(&totals.position));
        }
        Stored {
            kinetic: kinetic.value(),
            elastic: elastic.value(),
            potential: potential.value(),
        }
    }

    fn ledger(&self) -> &Ledger<D> {
        &self.ledger
    }

    fn limit(&self, _state: &State<D>) -> Limit {
        Limit {
            wave_speed: self.wave_speed,
            particle_speed: self.speed,
            cell_size: self.geometry.cell_size,
        }
    }

    fn angular_momentum(&self, state: &State<D>, body: usize) -> Vec<f64> {
        let known = &state.bodies[body];
        let p = &known.particles;
        let pairs: &[(usize, usize)] = match D {
            1 => &[],
            2 => &[(0, 1)],
            _ => &[(1, 2), (2, 0), (0, 1)],
        };
        let parts = in_parts(p.len(), |part| {
            let mut sums = [Sum::default(); 3];
            for i in part {
                let (x, v) = (&p.position[i], &p.velocity[i]);
                for (sum, &(a, b)) in sums.iter_mut().zip(pairs) {
                    sum.add(p.mass[i] * (x[a] * v[b] - x[b] * v[a]));
                }
                if let Some(affine) = p.affine.get(i) {
                    let place = &p.grid_position()[i];
                    let cells = self.geometry.in_cells(place, 1.0 / self.geometry.cell_size);
                    let (frame, domain) = if p.is_total() {
                        (Some(known.deformation_gradient(i)), None)
                    } else {
                        (None, p.deformation_gradient.get(i))
                    };
                    let cell = &self.geometry.cells;
                    let inertia = self.kernels.inertia(body, &cells, domain, cell);
                    let mass = p.mass[i] * self.geometry.cell_size.powi(2);
                    // Σ N_i F (X_i − X) × C (X_i − X), with F = I where the grid is that of the present positions
                    let moment = frame.map_or(inertia, |f| f * inertia) * affine.transpose();
                    for (sum, &(a, b)) in sums.iter_mut().zip(pairs) {
                        sum.add(mass * (moment[(a, b)] - moment[(b, a)]));
                    }
                }
            }
            sums
        });
        let mut sums = [Sum::default(); 3];
        for part in &parts {
            for (sum, part) in sums.iter_mut().zip(part) {
                sum.add_sum(part);
            }
        }
        sums[..pairs.len()].iter().map(Sum::value).collect()
    }

    fn stored_nodes(&self) -> usize {
        self.blocks.stored
    }

    fn bytes_per_node(&self) -> usize {
        let arrays = 1
            + usize::from(self.kernels.change())
            + usize::from(self.has_second())
            + usize::from(!self.loads.is_empty())
            + if self.has_terms() { 2 } else { 0 };
        arrays * size_of::<Node>()
    }
}

/// First and last node of an axis whose position, in cells, lies in `low ..= high`; an empty range if there is none.
fn nodes_between(position: impl Fn(i32) -> f64, count: i32, low: f64, high: f64) -> (i32, i32) {
    // positions ascend with the number: search by halving
    let find = |beyond: &dyn Fn(f64) -> bool| {
        let (mut first, mut last) = (0, count);
        while first < last {
            let middle = first + (last - first) / 2;
            if beyond(position(middle)) {
                last = middle;
            } else {
                first = middle + 1;
            }
        }
        first
    };
    (find(&|x| x >= low), find(&|x| x > high) - 1)
}
