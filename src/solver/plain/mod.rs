//! What the kernels of `stencil` mean: the loops of the textbook, for each point, for each of its N^D nodes, over dense arrays.

use super::stencil::{Scattered, Wanted};
use crate::basis::{Axis, Basis};
use crate::grid::Geometry;
use crate::math::{Matrix, Vector, packed_len, unpack};
use crate::state::{Masses, Particles};

mod cloud;
mod compare;
mod domains;
mod tiling;

/// Δt of all passes, s.
const DT: f64 = 0.013;

/// A vector and a number for every node of the grid.
struct Dense<const D: usize> {
    counts: [i32; D],
    nodes: Vec<[f64; 4]>,
}

impl<const D: usize> Dense<D> {
    fn new(counts: [i32; D]) -> Self {
        Self {
            counts,
            nodes: vec![[0.0; 4]; counts.iter().product::<i32>() as usize],
        }
    }

    fn number(&self, node: &[i32; D]) -> usize {
        (0..D).fold(0, |number, a| {
            number * self.counts[a] as usize + node[a] as usize
        })
    }

    fn vector(&self, node: &[i32; D]) -> Vector<D> {
        let numbers = &self.nodes[self.number(node)];
        Vector::from_fn(|a, _| numbers[a])
    }

    fn add(&mut self, node: &[i32; D], vector: &Vector<D>, number: f64) {
        let index = self.number(node);
        for a in 0..D {
            self.nodes[index][a] += vector[a];
        }
        self.nodes[index][D] += number;
    }
}

/// A node that a point knows: which one, x_i − x, N_i and ∇N_i at the point.
struct Known<const D: usize> {
    node: [i32; D],
    arm: Vector<D>,
    weight: f64,
    gradient: Vector<D>,
    /// What a force gives more to the node for each metre that it acts beside the point, measured where the point is undeformed.
    lean: Vector<D>,
    /// N_i D⁻¹ (x_i − x) with D = Σ N_i (x_i − x)(x_i − x)ᵀ; the gradient where a point has no D, or the basis says so.
    fitted: Vector<D>,
    /// ∇N_i at the middle of the point's cell, if changes of volume are taken there.
    middle: Option<Vector<D>>,
}

/// Which nodes the point in a row knows.
type Knows<'a, const D: usize> = dyn Fn(&Particles<D>, usize) -> Vec<Known<D>> + 'a;

/// All nodes that a point knows, weights and gradients as products.
fn known<const D: usize, const N: usize, B: Basis<N>>(
    geometry: &Geometry<D>,
    basis: &[B; D],
    position: &Vector<D>,
) -> Vec<Known<D>> {
    let h = geometry.cell_size;
    let x = geometry.in_cells(position, 1.0 / h);
    let axes: [_; D] = std::array::from_fn(|a| basis[a].axis(x[a], geometry.cells[a]));
    let middle: [_; D] = std::array::from_fn(|a| {
        let cell = (x[a] as i32).min(geometry.cells[a] - 1);
        basis[a].axis(f64::from(cell) + 0.5, geometry.cells[a])
    });
    let mut nodes: Vec<Known<D>> = (0..N.pow(D as u32))
        .map(|number| {
            let local: [usize; D] = std::array::from_fn(|a| number / N.pow(a as u32) % N);
            let node = std::array::from_fn(|a| axes[a].first + local[a] as i32);
            let product = |axes: &[Axis<N>; D], slope: usize| -> f64 {
                (0..D)
                    .map(|a| {
                        if a == slope {
                            axes[a].slope[local[a]] / h
                        } else {
                            axes[a].weight[local[a]]
                        }
                    })
                    .product()
            };
            Known {
                node,
                arm: Vector::from_fn(|a, _| {
                    h * (basis[a].position(node[a], geometry.cells[a]) - x[a])
                }),
                weight: product(&axes, D),
                gradient: Vector::from_fn(|a, _| product(&axes, a)),
                lean: Vector::from_fn(|a, _| product(&axes, a)),
                fitted: Vector::zeros(),
                middle: basis[0]
                    .dilation_at_centre()
                    .then(|| Vector::from_fn(|a, _| product(&middle, a))),
            }
        })
        .collect();
    let inertia: Matrix<D> = nodes
        .iter()
        .map(|k| k.arm * k.arm.transpose() * k.weight)
        .sum();
    for known in &mut nodes {
        known.fitted = Vector::from_fn(|a, _| {
            if N == 2 || inertia[(a, a)] == 0.0 {
                known.gradient[a]
            } else {
                known.weight * known.arm[a] / inertia[(a, a)]
            }
        });
    }
    nodes
}

/// How a transfer is written in a paper.
#[derive(Clone, Copy, Debug)]
enum Method {
    Pic,
    Flip(f64),
    Apic,
    MlsApic,
    Tpic,
}

/// Momentum m v + m C (x_i − x) and mass; force −V₀ τ ∇N, and −V₀ τ_θ N / r along r. In the total frame N is that of the
/// reference position, and the force −V₀ P ∇₀N; r is the present one.
fn plain_scatter<const D: usize>(
    knows: &Knows<'_, D>,
    method: Method,
    p: &Particles<D>,
    what: Scattered,
    main: &mut Dense<D>,
    force: &mut Dense<D>,
) {
    let width = packed_len(D);
    for i in 0..p.len() {
        for known in knows(p, i) {
            if what.momentum {
                let mut velocity = p.velocity[i];
                if matches!(method, Method::Apic | Method::MlsApic | Method::Tpic) {
                    velocity += p.affine[i] * known.arm;
                }
                main.add(
                    &known.node,
                    &(velocity * (p.mass[i] * known.weight)),
                    p.mass[i] * known.weight,
                );
            }
            if what.force {
                let mut stress: Matrix<D> = unpack(&p.stress[i * width..(i + 1) * width]);
                if p.is_total() {
                    stress = p.first_piola_stress[i];
                }
                let mut gradient = known.gradient;
                if matches!(method, Method::MlsApic) {
                    gradient = known.fitted;
                }
                let volume = p.mass.initial_volume(i);
                let mut internal = stress * gradient;
                if let Some(middle) = known.middle {
                    // P = P_dev + (P : F / d) F⁻ᵀ; in the updated frame τ with F = I
                    let (f, inverse) = stretching(p, i);
                    let pressure = inverse * (stress.dot(&f) / D as f64);
                    internal = (stress - pressure) * gradient + pressure * middle;
                }
                internal *= -volume;
                if let Some(hoop) = p.hoop_stress.get(i) {
                    internal[0] -= volume * hoop * known.weight / p.position[i][0];
                }
                match method {
                    Method::Flip(_) => force.add(&known.node, &internal, 0.0),
                    _ => main.add(&known.node, &(internal * DT), 0.0),
                }
            }
        }
    }
}

/// F and F⁻ᵀ of a point; I where the grid is that of the present positions.
fn stretching<const D: usize>(p: &Particles<D>, i: usize) -> (Matrix<D>, Matrix<D>) {
    let f = if p.is_total() {
        p.deformation_gradient[i]
    } else {
        Matrix::identity()
    };
    let inverse = f.try_inverse().expect("F is not singular");
    (f, inverse.transpose())
}

/// What every point takes from the grid: (velocity gradient, v_r / r); in the total frame the gradient is Ḟ. Domains are carried
/// along when points move.
fn plain_gather<const D: usize>(
    knows: &Knows<'_, D>,
    method: Method,
    p: &mut Particles<D>,
    what: Wanted,
    grid: &[Dense<D>; 3],
) -> Vec<(Matrix<D>, f64)> {
    let [main, change, second] = grid;
    let total = p.is_total();
    let mut rates = Vec::new();
    for i in 0..p.len() {
        let nodes = knows(p, i);
        let mean = |grid: &Dense<D>| -> Vector<D> {
            nodes.iter().map(|k| grid.vector(&k.node) * k.weight).sum()
        };
        // nodes without mass count as if they had the velocity of the point
        let columns = |grid: &Dense<D>, function: &dyn Fn(&Known<D>) -> Vector<D>| -> Matrix<D> {
            let mean = mean(grid);
            let from = |k: &Known<D>| {
                let mass = grid.nodes[grid.number(&k.node)][D];
                (grid.vector(&k.node) - mean * mass) * function(k).transpose()
            };
            nodes.iter().map(from).sum()
        };
        let slope = |grid: &Dense<D>| columns(grid, &|k| k.gradient);
        let fit = |grid: &Dense<D>| columns(grid, &|k| k.fitted);
        let straining = if what.same { main } else { second };
        let hoop_rate = mean(straining)[0] / p.position[i][0];
        let mut rate = match method {
            Method::MlsApic => fit(straining),
            _ => slope(straining),
        };
        if nodes.iter().any(|k| k.middle.is_some()) {
            let at_middle = nodes.iter().filter_map(|k| Some((k, k.middle?)));
            let middle: Matrix<D> = at_middle
                .map(|(k, gradient)| straining.vector(&k.node) * gradient.transpose())
                .sum();
            let (f, inverse) = stretching(p, i);
            rate += f * ((middle - rate).dot(&inverse) / D as f64);
        }
        rates.push((rate, hoop_rate));
        if what.rate && !p.hoop_stretch.is_empty() {
            p.hoop_stretch[i] *= 1.0 + DT * hoop_rate;
        }
        if what.velocity {
            match method {
                Method::Pic => p.velocity[i] = mean(main),
                Method::Flip(ratio) => {
                    p.velocity[i] =
                        (p.velocity[i] + mean(change)) * ratio + mean(main) * (1.0 - ratio);
                }
                Method::Apic | Method::MlsApic => {
                    p.velocity[i] = mean(main);
                    p.affine[i] = fit(main);
                }
                Method::Tpic => {
                    p.velocity[i] = mean(main);
                    p.affine[i] = slope(main);
                }
            }
        }
        if what.position {
            // points that take the velocity of the grid whole have it by now
            let taken = !what.velocity && !matches!(method, Method::Flip(_));
            let velocity = if taken { p.velocity[i] } else { mean(main) };
            p.position[i] += velocity * DT;
            if let (Some(f), false) = (p.deformation_gradient.get_mut(i), total) {
                *f += slope(main) * *f * DT;
            }
        }
    }
    rates
}
