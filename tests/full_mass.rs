//! FMPM against its matrices: S and the masses are assembled from the basis, and the solver's step has to be what they say.

mod common;

use common::{Scene, Variant, list, texts, variants};
use mpm::basis::{Basis, BasisChoice, BasisVisitor};
use mpm::run::{Computing, build_with};
use mpm::scenario::Scenario;
use mpm::study::validate::simulate;
use nalgebra::{DMatrix, DVector};

/// A block without stress, held at its lower end along x or nowhere, whose points move without order.
fn restless_block(dimension: usize, held: bool) -> Scene {
    let low = if held { [0.0, 1.0, 1.0] } else { [1.0; 3] };
    let high = [3.0, 2.5, 2.0];
    let wave = |phase: f64| format!("1 m/s * sin(7 * x + {phase}) * cos(5 * x - 2)");
    let [u, v, w] = &[wave(1.0), wave(2.0), wave(3.0)];
    let hold = "[[boundary]]\nname = \"end\"\non.side = \"x_min\"\ncondition = \"fixed\"\n";
    let body = format!(
        "[[body]]\nname = \"block\"\nmaterial = \"stuff\"\nshape.box = {{ min = {}, max = {} }}\nvelocity = {}\n",
        list(dimension, low),
        list(dimension, high),
        texts(dimension, [u, v, w]),
    );
    Scene {
        dimension,
        cells: [9, 8, 7],
        cell_size: 0.5,
        step: 0.013,
        steps: 1,
        law: "linear_elastic = { youngs_modulus = 3, poissons_ratio = 0.0, rate = \"kirchhoff\" }"
            .into(),
        head: String::new(),
        rest: if held { body + hold } else { body },
    }
}

/// What a step starts from, in matrices.
struct Matrices<const D: usize> {
    /// N_i(x_p), and its slope along x in 1/m, one row a point; columns are nodes that some point reaches.
    value: DMatrix<f64>,
    slope: DMatrix<f64>,
    /// Masses of the points.
    mass: DVector<f64>,
    /// Lumped masses of the nodes.
    lumped: DVector<f64>,
    /// Whether a node stands at the lower end of the grid along x.
    end: Vec<bool>,
    /// v of the points, one column a component.
    velocity: DMatrix<f64>,
}

struct Assemble<'a, const D: usize> {
    scenario: &'a Scenario,
    positions: &'a [[f64; D]],
    spacing: [f64; D],
}

impl<const D: usize> BasisVisitor for Assemble<'_, D> {
    /// For each point the nodes that it knows: number, N_i and ∂N_i/∂x; and the last node along x that stands at the lower end.
    type Output = (Vec<Vec<([i32; D], f64, f64)>>, i32);

    fn visit<const N: usize, B: Basis<N>>(self, basis: B) -> Self::Output {
        let grid = &self.scenario.grid;
        let h = grid.cell_size;
        let of = |x: &[f64; D]| {
            let axes: [_; D] = std::array::from_fn(|a| {
                let basis = basis.for_spacing(self.spacing[a] / h);
                basis.axis((x[a] - grid.min[a]) / h, grid.cells[a])
            });
            let node = |number: usize| {
                let local: [usize; D] = std::array::from_fn(|a| number / N.pow(a as u32) % N);
                let others: f64 = (1..D).map(|a| axes[a].weight[local[a]]).product();
                (
                    std::array::from_fn(|a| axes[a].first + local[a] as i32),
                    axes[0].weight[local[0]] * others,
                    axes[0].slope[local[0]] * others / h,
                )
            };
            (0..N.pow(D as u32)).map(node).collect()
        };
        let at_end = |node: &i32| basis.position(*node, grid.cells[0]) <= 0.0;
        let last = (0..N as i32).rev().find(at_end).expect("a node there");
        (self.positions.iter().map(of).collect(), last)
    }
}

/// Velocities, positions and stresses along x of the points after one step of the solver, by number of the point, and the
/// matrices of what it started from.
fn step<const D: usize>(
    scenario: &Scenario,
    dt: f64,
) -> (DMatrix<f64>, DMatrix<f64>, Vec<f64>, Matrices<D>) {
    let computing = Computing {
        parallel: Some(false),
        instructions: None,
    };
    let mut scene = build_with::<D>(scenario, &computing);
    let body = &scene.state.bodies[0];
    let p = &body.particles;
    let positions: Vec<[f64; D]> = p.position.iter().map(|x| (*x).into()).collect();
    let assemble = Assemble {
        scenario,
        positions: &positions,
        spacing: body.spacing.into(),
    };
    let (known, last_at_end) = scenario.method.basis.visit(assemble);
    let mut nodes: Vec<[i32; D]> = known
        .iter()
        .flatten()
        .filter(|k| k.1 > 0.0)
        .map(|k| k.0)
        .collect();
    nodes.sort_unstable();
    nodes.dedup();
    let (mut value, mut slope) = (
        DMatrix::zeros(p.len(), nodes.len()),
        DMatrix::zeros(p.len(), nodes.len()),
    );
    for (row, known) in known.iter().enumerate() {
        for (node, n, dn) in known {
            if let Ok(column) = nodes.binary_search(node) {
                value[(row, column)] = *n;
                slope[(row, column)] = *dn;
            }
        }
    }
    let mass = DVector::from_fn(p.len(), |i, _| p.mass[i]);
    let matrices = Matrices {
        lumped: value.tr_mul(&mass),
        value,
        slope,
        mass,
        end: nodes.iter().map(|node| node[0] <= last_at_end).collect(),
        velocity: DMatrix::from_fn(p.len(), D, |i, a| p.velocity[i][a]),
    };
    scene
        .solver
        .start(&mut scene.state)
        .expect("points inside the grid");
    scene
        .solver
        .step(&mut scene.state, dt)
        .expect("a small step");
    let p = &scene.state.bodies[0].particles;
    let (mut velocity, mut position) = (DMatrix::zeros(p.len(), D), DMatrix::zeros(p.len(), D));
    let mut stress = vec![0.0; p.len()];
    let width = p.stress.len() / p.len();
    for row in 0..p.len() {
        let id = p.id[row] as usize;
        for a in 0..D {
            velocity[(id, a)] = p.velocity[row][a];
            position[(id, a)] = p.position[row][a] - positions[id][a];
        }
        stress[id] = p.stress[row * width];
    }
    (velocity, position, stress, matrices)
}

impl<const D: usize> Matrices<D> {
    /// S⁺ of velocities of points.
    fn map(&self, velocity: &DMatrix<f64>) -> DMatrix<f64> {
        let weighted = DMatrix::from_fn(velocity.nrows(), velocity.ncols(), |i, a| {
            self.mass[i] * velocity[(i, a)]
        });
        let momentum = self.value.tr_mul(&weighted);
        DMatrix::from_fn(momentum.nrows(), momentum.ncols(), |i, a| {
            momentum[(i, a)] / self.lumped[i]
        })
    }

    fn hold(&self, mut velocity: DMatrix<f64>, held: bool) -> DMatrix<f64> {
        for (i, end) in self.end.iter().enumerate() {
            if held && *end {
                velocity.row_mut(i).fill(0.0);
            }
        }
        velocity
    }

    /// Σ_{j<order} (I − S⁺S)^j v, with nothing at nodes that are held.
    fn series(&self, order: u32, held: bool) -> DMatrix<f64> {
        let mut term = self.hold(self.map(&self.velocity), held);
        let mut sum = term.clone();
        for _ in 1..order {
            let image = self.map(&(&self.value * &term));
            term = self.hold(term - image, held);
            sum += &term;
        }
        sum
    }
}

#[track_caller]
fn agree(name: &str, found: &DMatrix<f64>, expected: &DMatrix<f64>) {
    let wrong = (found - expected).amax();
    assert!(
        wrong <= 1e-13 * expected.amax(),
        "{name}: wrong by {wrong:e} of {:e}",
        expected.amax()
    );
}

fn fmpm(order: u32) -> String {
    format!("{{ fmpm = {{ order = {order} }} }}")
}

fn one_step_is_what_the_matrices_say<const D: usize>() {
    // update stress first has forces in the first step already
    let wanted = |variant: &Variant| variant.transfer == "\"pic\"" && variant.update != "usf";
    for variant in variants().into_iter().filter(wanted) {
        for (order, held) in [(1, true), (2, false), (2, true), (3, true), (5, false)] {
            let variant = Variant {
                transfer: fmpm(order),
                ..variant.clone()
            };
            let scene = restless_block(D, held);
            let name = format!("{D}D {variant:?} held {held}");
            let (velocity, way, stress, matrices) =
                step::<D>(&scene.scenario(&variant), scene.step);
            let series = matrices.series(order, held);
            let expected = &matrices.value * &series;
            agree(&name, &velocity, &expected);
            agree(&format!("{name}: way"), &way, &(expected * scene.step));
            if variant.update == "usl" && D == 1 {
                let rate = &matrices.slope * &series;
                let stress = DMatrix::from_column_slice(stress.len(), 1, &stress);
                agree(
                    &format!("{name}: stress"),
                    &stress,
                    &(rate * (3.0 * scene.step)),
                );
            }
        }
    }
}

#[test]
fn a_step_in_one_dimension_is_what_the_matrices_say() {
    one_step_is_what_the_matrices_say::<1>();
}

#[test]
fn a_step_in_two_dimensions_is_what_the_matrices_say() {
    one_step_is_what_the_matrices_say::<2>();
}

#[test]
fn a_step_in_three_dimensions_is_what_the_matrices_say() {
    one_step_is_what_the_matrices_say::<3>();
}

/// v(k) differs from the velocity M⁻¹ p of the full mass matrix M = Sᵀ m S by (I − S⁺S)^k M⁻¹ p. Weighted with lumped masses, I − S⁺S
/// is symmetric with eigenvalues from 0 to 1 − λ, λ the smallest of S⁺S; and S makes no vector longer.
#[test]
fn ever_more_terms_come_to_the_inverse_of_the_full_mass_matrix_as_fast_as_its_eigenvalues_say() {
    for basis in BasisChoice::NAMES {
        let variant = |order| Variant {
            basis,
            transfer: fmpm(order),
            update: "usl",
            frame: "updated",
        };
        let scene = restless_block(1, false);
        let run = |order| step::<1>(&scene.scenario(&variant(order)), scene.step);
        let (_, _, _, m) = run(1);
        let root = m.lumped.map(f64::sqrt);
        let full = m
            .value
            .tr_mul(&(DMatrix::from_diagonal(&m.mass) * &m.value));
        let scaled = DMatrix::from_fn(full.nrows(), full.ncols(), |i, j| {
            full[(i, j)] / (root[i] * root[j])
        });
        let least = scaled.symmetric_eigenvalues().min();
        assert!(
            least > 0.0,
            "{basis}: a node that no velocity of the points can see"
        );
        let momentum = m
            .value
            .tr_mul(&m.velocity.component_mul(&DMatrix::from_column_slice(
                m.mass.len(),
                1,
                m.mass.as_slice(),
            )));
        let exact = full
            .lu()
            .solve(&momentum)
            .expect("enough points for every node");
        let length = |v: &DMatrix<f64>, mass: &DVector<f64>| {
            v.iter()
                .zip(mass.iter())
                .map(|(v, m)| m * v * v)
                .sum::<f64>()
                .sqrt()
        };
        let whole = length(&exact, &m.lumped);
        let mut last = f64::INFINITY;
        for order in 1..=20 {
            let wrong = length(&(run(order).0 - &m.value * &exact), &m.mass);
            let bound = (1.0 - least).powi(order as i32) * whole;
            assert!(
                wrong <= bound + 1e-13 * whole,
                "{basis} order {order}: {wrong:e} > {bound:e}"
            );
            assert!(
                wrong < last,
                "{basis} order {order}: {wrong:e} after {last:e}"
            );
            last = wrong;
        }
    }
}

#[test]
fn order_one_is_pic_to_the_last_bit() {
    for update in ["usf", "usl", "musl"] {
        let variant = |transfer: &str| Variant {
            basis: "quadratic",
            transfer: transfer.into(),
            update,
            frame: "updated",
        };
        let mut scene = restless_block(2, true);
        scene.steps = 20;
        let end = |transfer: &str| {
            let run = simulate(&scene.text(&variant(transfer)), &[], true)
                .unwrap_or_else(|error| panic!("{error}"));
            let frame = run.memory.frames.last().expect("frames");
            frame
                .points
                .iter()
                .map(|p| (p.position, p.velocity))
                .collect::<Vec<_>>()
        };
        assert_eq!(end(&fmpm(1)), end("\"pic\""), "{update}");
    }
}
