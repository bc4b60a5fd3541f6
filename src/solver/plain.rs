//! What the kernels of `stencil` mean: the loops of the textbook, for each point, for each of its N^D nodes, over dense arrays;
//! and the test that holds the fast kernels to them.

use super::kernels::{Context, Kernels, Stencils, wide_instructions};
use super::stencil::{CHUNK, Columns, Rates, Reach, Scattered, Sources, Tile, Wanted};
use crate::basis::{Basis, BasisChoice, BasisVisitor};
use crate::grid::{Blocks, Geometry, Node, block_edge};
use crate::math::{Matrix, Vector, packed_len, unpack};
use crate::state::Particles;
use crate::transfer::{Apic, Flip, Pic, Transfer, TransferChoice};

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

/// A node that a point knows: which one, x_i − x, N_i and ∇N_i.
struct Known<const D: usize> {
    node: [i32; D],
    arm: Vector<D>,
    weight: f64,
    gradient: Vector<D>,
}

/// All nodes that a point knows, weights and gradients as products.
fn known<const D: usize, const N: usize, B: Basis<N>>(
    geometry: &Geometry<D>,
    basis: &[B; D],
    position: &Vector<D>,
) -> Vec<Known<D>> {
    let h = geometry.cell_size;
    let x = geometry.in_cells(position, 1.0 / h);
    let axes: [_; D] = std::array::from_fn(|a| basis[a].axis(x[a], geometry.cells[a]));
    (0..N.pow(D as u32))
        .map(|number| {
            let local: [usize; D] = std::array::from_fn(|a| number / N.pow(a as u32) % N);
            let node = std::array::from_fn(|a| axes[a].first + local[a] as i32);
            let product = |slope: usize| -> f64 {
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
                weight: product(D),
                gradient: Vector::from_fn(|a, _| product(a)),
            }
        })
        .collect()
}

/// How a transfer is written in a paper.
#[derive(Clone, Copy)]
enum Method {
    Pic,
    Flip(f64),
    Apic,
}

/// Momentum m v + m C (x_i − x) and mass; force −V₀ τ ∇N, and −V₀ τ_θ N / r along r.
fn plain_scatter<const D: usize, const N: usize, B: Basis<N>>(
    geometry: &Geometry<D>,
    basis: &[B; D],
    method: Method,
    p: &Particles<D>,
    what: Scattered,
    main: &mut Dense<D>,
    force: &mut Dense<D>,
) {
    let width = packed_len(D);
    for i in 0..p.len() {
        for known in known(geometry, basis, &p.position[i]) {
            if what.momentum {
                let mut velocity = p.velocity[i];
                if matches!(method, Method::Apic) {
                    velocity += p.affine[i] * known.arm;
                }
                main.add(
                    &known.node,
                    &(velocity * (p.mass[i] * known.weight)),
                    p.mass[i] * known.weight,
                );
            }
            if what.force {
                let stress: Matrix<D> = unpack(&p.stress[i * width..(i + 1) * width]);
                let mut internal = stress * known.gradient * -p.initial_volume[i];
                if let Some(hoop) = p.hoop_stress.get(i) {
                    internal[0] -= p.initial_volume[i] * hoop * known.weight / p.position[i][0];
                }
                match method {
                    Method::Flip(_) => force.add(&known.node, &internal, 0.0),
                    _ => main.add(&known.node, &(internal * DT), 0.0),
                }
            }
        }
    }
}

/// What every point takes from the grid: (velocity gradient, v_r / r).
fn plain_gather<const D: usize, const N: usize, B: Basis<N>>(
    geometry: &Geometry<D>,
    basis: &[B; D],
    method: Method,
    p: &mut Particles<D>,
    what: Wanted,
    grid: &[Dense<D>; 3],
) -> Vec<(Matrix<D>, f64)> {
    let [main, change, second] = grid;
    let mut rates = Vec::new();
    for i in 0..p.len() {
        let nodes = known(geometry, basis, &p.position[i]);
        let mean = |grid: &Dense<D>| -> Vector<D> {
            nodes.iter().map(|k| grid.vector(&k.node) * k.weight).sum()
        };
        let slope = |grid: &Dense<D>| -> Matrix<D> {
            nodes
                .iter()
                .map(|k| grid.vector(&k.node) * k.gradient.transpose())
                .sum()
        };
        let straining = if what.same { main } else { second };
        let hoop_rate = mean(straining)[0] / p.position[i][0];
        rates.push((slope(straining), hoop_rate));
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
                Method::Apic => {
                    p.velocity[i] = mean(main);
                    let moment: Matrix<D> = (nodes.iter())
                        .map(|k| main.vector(&k.node) * k.arm.transpose() * k.weight)
                        .sum();
                    let inertia: Matrix<D> = nodes
                        .iter()
                        .map(|k| k.arm * k.arm.transpose() * k.weight)
                        .sum();
                    for a in 0..D {
                        // C = B D⁻¹, D diagonal; where a point has no inertia, or the basis says so, the slope
                        let plain = N == 2 || inertia[(a, a)] == 0.0;
                        let column = if plain {
                            slope(main).column(a).into()
                        } else {
                            moment.column(a) / inertia[(a, a)]
                        };
                        p.affine[i].set_column(a, &column);
                    }
                }
            }
        }
        if what.position {
            let velocity = mean(main);
            p.position[i] += velocity * DT;
        }
    }
    rates
}

/// Numbers between −1 and 1 (xorshift64*).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// Points all over the grid, some in its corners, with random content, then sorted into blocks and moved as far as a point may
/// go before it has to be sorted again.
fn points<const D: usize>(
    geometry: &Geometry<D>,
    kernels: &dyn Kernels<D>,
    affine: bool,
    axisymmetric: bool,
    random: &mut Random,
) -> (Particles<D>, Blocks<D>) {
    let edge = block_edge(D, kernels.nodes());
    let h = geometry.cell_size;
    let count = [300, 500, 700][D - 1];
    let place = |random: &mut Random, i: usize| -> [f64; D] {
        std::array::from_fn(|a| {
            let cells = f64::from(geometry.cells[a]);
            match (random.next() * 20.0) as i32 {
                10.. if i.is_multiple_of(2) => cells,
                ..-10 if i.is_multiple_of(2) && !(a == 0 && axisymmetric) => 0.0,
                5 => (random.next() * 0.5 + 0.5) * 1.5,
                -5 => cells - (random.next() * 0.5 + 0.5) * 1.5,
                _ => (0.5 * random.next() + 0.5) * cells,
            }
        })
    };
    let block = |x: &[f64; D]| {
        kernels
            .first(0, x, &geometry.cells)
            .map(|first| first.div_euclid(edge))
    };
    let mut places: Vec<_> = (0..count).map(|i| place(random, i)).collect();
    places.sort_by_key(block);
    let mut occupied: Vec<([i32; D], (u32, u32))> = Vec::new();
    for (row, x) in places.iter_mut().enumerate() {
        let key = block(x);
        match occupied.last_mut() {
            Some((last, (_, end))) if *last == key => *end += 1,
            _ => occupied.push((key, (row as u32, row as u32 + 1))),
        }
        let reach = Reach::new(
            key.map(|b| b * edge),
            edge,
            geometry.cells,
            kernels.shift(0),
        );
        let strayed = std::array::from_fn(|a| x[a] + 0.97 * random.next());
        if row % 3 > 0 && reach.holds(&strayed) {
            *x = strayed;
        }
    }
    let mut blocks = Blocks::default();
    blocks.rebuild(edge, &geometry.counts, &[occupied]);
    let mut numbers = |count: usize| -> Vec<f64> { (0..count).map(|_| random.next()).collect() };
    let hoops = if axisymmetric { count } else { 0 };
    let vectors = numbers(D * count);
    let matrices = numbers(D * D * count);
    let particles = Particles {
        // an end of the grid is hit exactly, whatever the cell size
        position: places
            .iter()
            .map(|x| Vector::from_fn(|a, _| geometry.min[a] + h * x[a]))
            .collect(),
        velocity: vectors
            .chunks_exact(D)
            .map(Vector::from_column_slice)
            .collect(),
        mass: numbers(count).iter().map(|m| 1.5 + m).collect(),
        initial_volume: numbers(count).iter().map(|v| 1.5 + v).collect(),
        stress: numbers(packed_len(D) * count),
        affine: if affine {
            matrices
                .chunks_exact(D * D)
                .map(Matrix::from_column_slice)
                .collect()
        } else {
            Vec::new()
        },
        hoop_stress: numbers(hoops),
        hoop_stretch: numbers(hoops).iter().map(|s| 1.5 + s).collect(),
        id: (0..count as u32).collect(),
    };
    (particles, blocks)
}

/// The nodes of the grid from their storage.
fn dense<const D: usize>(geometry: &Geometry<D>, blocks: &Blocks<D>, nodes: &[Node]) -> Dense<D> {
    let mut dense = Dense::new(geometry.counts);
    for row in &blocks.rows {
        for k in 0..row.len {
            let mut node = row.node;
            node[D - 1] += k as i32;
            let number = dense.number(&node);
            dense.nodes[number] = nodes[(row.start + k) as usize].0;
        }
    }
    dense
}

#[track_caller]
fn agree<'a>(
    name: &str,
    fast: impl IntoIterator<Item = &'a f64>,
    plain: impl IntoIterator<Item = &'a f64>,
) {
    let (fast, plain): (Vec<f64>, Vec<f64>) = (
        fast.into_iter().copied().collect(),
        plain.into_iter().copied().collect(),
    );
    assert_eq!(fast.len(), plain.len(), "{name}");
    let scale = plain.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    for (i, (fast, plain)) in fast.iter().zip(&plain).enumerate() {
        let close = (fast - plain).abs() <= 1e-13 * scale;
        assert!(
            close,
            "{name}: number {i} is {fast:e}, plain {plain:e}, the largest {scale:e}"
        );
    }
}

struct EveryPass {
    wide: bool,
}

impl BasisVisitor for EveryPass {
    type Output = ();

    fn visit<const N: usize, B: Basis<N>>(self, basis: B) {
        assert_eq!(
            TransferChoice::NAMES,
            ["pic", "flip", "apic"],
            "a new transfer needs its plain form here"
        );
        self.dimensions(basis, Pic, Method::Pic);
        self.dimensions(basis, Flip { ratio: 1.0 }, Method::Flip(1.0));
        self.dimensions(basis, Flip { ratio: 0.9 }, Method::Flip(0.9));
        self.dimensions(basis, Apic, Method::Apic);
    }
}

impl EveryPass {
    fn dimensions<const N: usize, B: Basis<N>, T: Transfer>(
        &self,
        basis: B,
        transfer: T,
        method: Method,
    ) {
        self.check::<1, N, B, T>(basis, transfer, method, [150], false);
        self.check::<2, N, B, T>(basis, transfer, method, [41, 37], false);
        self.check::<2, N, B, T>(basis, transfer, method, [41, 37], true);
        self.check::<3, N, B, T>(basis, transfer, method, [13, 10, 11], false);
    }

    fn check<const D: usize, const N: usize, B: Basis<N>, T: Transfer>(
        &self,
        basis: B,
        transfer: T,
        method: Method,
        cells: [i32; D],
        axisymmetric: bool,
    ) {
        let wide = self.wide;
        let name = format!(
            "{} {} {D}D wide {wide}",
            std::any::type_name::<B>(),
            std::any::type_name::<T>()
        );
        // small cells and places that are no round numbers; the axis of an axisymmetric grid is at zero
        let min = Vector::from_fn(|a, _| {
            if axisymmetric {
                0.0
            } else {
                [0.0, -0.3, 0.7][a]
            }
        });
        let geometry = Geometry::new(min, 0.0625, cells, &basis);
        let axes: [B; D] = std::array::from_fn(|a| basis.for_spacing([0.5, 0.31, 1.0][a]));
        let kernels = Stencils::<D, N, B, T> {
            nodes: basis,
            basis: vec![axes],
            transfer,
        };
        let mut random = Random(0x9E37_79B9_7F4A_7C15 + D as u64);
        let (mut fast, blocks) = points(&geometry, &kernels, T::AFFINE, axisymmetric, &mut random);
        let edge = block_edge(D, N);
        let context = Context {
            geometry: &geometry,
            body: 0,
            edge,
            dt: DT,
            wide: wide && wide_instructions(),
        };

        for (momentum, force) in [(true, true), (true, false), (false, true)] {
            let what = Scattered { momentum, force };
            let mut arrays = [
                vec![Node::default(); blocks.stored],
                vec![Node::default(); blocks.stored],
            ];
            let count = fast.len();
            let columns = Columns::new(&mut fast, count, T::AFFINE);
            let [main, change] = &mut arrays;
            for block in &blocks.bodies[0].blocks {
                // SAFETY: one thread; the points were sorted, and moved within reach
                unsafe {
                    kernels.scatter(
                        &context,
                        &columns,
                        block,
                        what,
                        [main.as_mut_ptr(), change.as_mut_ptr()],
                    )
                };
            }
            let mut plain = [Dense::new(geometry.counts), Dense::new(geometry.counts)];
            let [plain_main, plain_change] = &mut plain;
            plain_scatter(
                &geometry,
                &axes,
                method,
                &fast,
                what,
                plain_main,
                plain_change,
            );
            for (nodes, plain) in arrays.iter().zip(&plain) {
                let nodes = dense(&geometry, &blocks, nodes);
                agree(
                    &format!("{name} {what:?}"),
                    nodes.nodes.as_flattened(),
                    plain.nodes.as_flattened(),
                );
            }
        }

        let arrays = [0; 3].map(|_| -> Vec<Node> {
            (0..blocks.stored)
                .map(|_| {
                    Node(std::array::from_fn(
                        |a| if a < D { random.next() } else { 1.0 },
                    ))
                })
                .collect()
        });
        let grid = [0, 1, 2].map(|k| dense(&geometry, &blocks, &arrays[k]));
        let sources = Sources {
            main: arrays[0].as_ptr(),
            change: arrays[1].as_ptr(),
            second: arrays[2].as_ptr(),
        };
        for [velocity, position, rate, same] in [
            [true, true, true, true],
            [true, true, false, false],
            [true, false, false, false],
            [false, false, true, false],
            [false, true, true, false],
        ] {
            let what = Wanted {
                velocity,
                position,
                rate,
                same,
            };
            let name = format!("{name} {what:?}");
            let (mut fast, mut plain) = (fast.clone(), fast.clone());
            let plain_rates = plain_gather(&geometry, &axes, method, &mut plain, what, &grid);
            let count = fast.len();
            let columns = Columns::new(&mut fast, count, T::AFFINE);
            let (mut gradients, mut hoops) = (Vec::new(), Vec::new());
            for block in &blocks.bodies[0].blocks {
                let tile = Tile::new(block, edge, N);
                let reach = Reach::new(block.origin, edge, geometry.cells, kernels.shift(0));
                for first in block.points().step_by(CHUNK) {
                    let rows = first..(first + CHUNK).min(block.points().end);
                    let mut rates = Rates::zeros();
                    let rows_here = rows.len();
                    // SAFETY: one thread; the points were sorted, and moved within reach
                    unsafe {
                        kernels.gather(
                            &context, &columns, &tile, &reach, rows, what, &sources, &mut rates,
                        )
                    };
                    gradients.extend(rates.gradient[..rows_here].iter().copied());
                    hoops.extend(&rates.hoop[..rows_here]);
                }
            }
            if rate {
                agree(
                    &name,
                    gradients.iter().flatten(),
                    plain_rates.iter().flat_map(|(gradient, _)| gradient),
                );
                if axisymmetric {
                    agree(&name, &hoops, plain_rates.iter().map(|(_, hoop)| hoop));
                }
            }
            agree(
                &name,
                fast.position.iter().flatten(),
                plain.position.iter().flatten(),
            );
            agree(
                &name,
                fast.velocity.iter().flatten(),
                plain.velocity.iter().flatten(),
            );
            agree(
                &name,
                fast.affine.iter().flatten(),
                plain.affine.iter().flatten(),
            );
            agree(&name, &fast.hoop_stretch, &plain.hoop_stretch);
        }
    }
}

#[test]
fn the_wide_kernels_do_what_the_textbook_says() {
    BasisChoice::all()
        .iter()
        .for_each(|basis| basis.visit(EveryPass { wide: true }));
}

#[test]
fn the_portable_kernels_do_what_the_textbook_says() {
    BasisChoice::all()
        .iter()
        .for_each(|basis| basis.visit(EveryPass { wide: false }));
}
