//! Holds the fast kernels to the loops of the textbook.

use super::cloud::{Kind, Random, points};
use super::*;
use crate::basis::{BasisChoice, BasisVisitor, Linear};
use crate::grid::{Blocks, Node};
use crate::material::FourRates;
use crate::real::Instructions;
use crate::solver::kernels::{Context, Kernels, Stencils};
use crate::solver::stencil::{CHUNK, Columns, Rates, Reach, Sources, Tile};
use crate::transfer::{Apic, Flip, MlsApic, Pic, Tpic, Transfer, TransferChoice};
use std::cell::Cell;

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

/// Distances between points along each axis, in cells.
pub(super) const SPACING: [f64; 3] = [0.5, 0.31, 1.0];

pub(super) struct EveryPass<'a> {
    pub instructions: Instructions,
    /// A number that depends on every bit of what the kernels computed.
    pub bits: &'a Cell<u64>,
}

impl BasisVisitor for EveryPass<'_> {
    type Output = ();

    fn visit<const N: usize, B: Basis<N>>(self, basis: B) {
        assert_eq!(
            TransferChoice::NAMES,
            ["pic", "flip", "apic", "mls_apic", "tpic", "fmpm"],
            "a new transfer needs its plain form here (points of FMPM are those of PIC; tests/full_mass.rs has its matrices)"
        );
        self.dimensions(basis, Pic, Method::Pic);
        self.dimensions(basis, Flip { ratio: 1.0 }, Method::Flip(1.0));
        self.dimensions(basis, Flip { ratio: 0.9 }, Method::Flip(0.9));
        self.dimensions(basis, Apic, Method::Apic);
        self.dimensions(basis, MlsApic, Method::MlsApic);
        self.dimensions(basis, Tpic, Method::Tpic);
    }

    /// Domains have a plain form of their own.
    fn visit_domains<const N: usize, B: Basis<N>>(self, _: B) {}
}

impl EveryPass<'_> {
    /// Holds numbers to plain ones, to round-off of the largest.
    #[track_caller]
    fn agree<'a>(
        &self,
        name: &str,
        fast: impl IntoIterator<Item = &'a f64>,
        plain: impl IntoIterator<Item = &'a f64>,
    ) {
        let (fast, plain): (Vec<f64>, Vec<f64>) = (
            fast.into_iter().copied().collect(),
            plain.into_iter().copied().collect(),
        );
        assert_eq!(fast.len(), plain.len(), "{name}");
        for number in &fast {
            // FNV-1a
            let bits = (self.bits.get() ^ number.to_bits()).wrapping_mul(0x100_0000_01B3);
            self.bits.set(bits);
        }
        let scale = plain.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        for (i, (fast, plain)) in fast.iter().zip(&plain).enumerate() {
            let close = (fast - plain).abs() <= 1e-13 * scale;
            assert!(
                close,
                "{name}: number {i} is {fast:e}, plain {plain:e}, the largest {scale:e}"
            );
        }
    }

    fn dimensions<const N: usize, B: Basis<N>, T: Transfer>(
        &self,
        basis: B,
        transfer: T,
        method: Method,
    ) {
        self.check::<1, N, B, T>(basis, transfer, method, [150]);
        self.check::<2, N, B, T>(basis, transfer, method, [41, 37]);
        self.check::<3, N, B, T>(basis, transfer, method, [13, 10, 11]);
    }

    fn check<const D: usize, const N: usize, B: Basis<N>, T: Transfer>(
        &self,
        basis: B,
        transfer: T,
        method: Method,
        cells: [i32; D],
    ) {
        for mut kind in Kind::all::<D>(false) {
            // only functions whose slopes jump are told of nodes without mass
            kind.gaps = B::SLOPES_JUMP && !basis.dilation_at_centre();
            let geometry = Geometry::new(kind.corner(), 0.0625, cells, &basis);
            let axes: [B; D] = std::array::from_fn(|a| basis.for_spacing(SPACING[a]));
            let kernels = Stencils::<D, N, B, T> {
                nodes: basis,
                basis: vec![axes],
                transfer,
            };
            let knows = |p: &Particles<D>, i: usize| known(&geometry, &axes, &p.grid_position()[i]);
            let name = std::any::type_name::<(B, T)>();
            self.compare(name, &geometry, &kernels, &knows, method, kind);
        }
    }

    /// Forces on every third point, N, that act beside it.
    fn check_forces<const D: usize>(
        &self,
        kernels: &dyn Kernels<D>,
        context: &Context<'_, D>,
        name: &str,
        knows: &Knows<'_, D>,
        blocks: &Blocks<D>,
        fast: &mut Particles<D>,
    ) {
        let offset = Vector::<D>::from_fn(|a, _| 0.01 - 0.004 * a as f64);
        let force = |p: usize| Vector::<D>::from_fn(|a, _| ((7 * p + 3 * a) % 11) as f64 - 4.0);
        let mut nodes = vec![Node::default(); blocks.stored];
        let mut plain = Dense::new(context.geometry.counts);
        let columns = Columns::new(fast, fast.len(), kernels.affine());
        for block in &blocks.bodies[0].blocks {
            let loaded = block.points().step_by(3);
            let forces: Vec<(u32, Vector<D>)> = loaded.map(|p| (p as u32, force(p))).collect();
            let nodes = nodes.as_mut_ptr();
            // SAFETY: one thread; the points were sorted, and moved within reach
            unsafe { kernels.scatter_forces(context, &columns, block, nodes, &offset, &forces) };
        }
        for block in &blocks.bodies[0].blocks {
            for p in block.points().step_by(3) {
                for known in knows(fast, p) {
                    let share = known.weight + known.lean.dot(&offset);
                    plain.add(&known.node, &(force(p) * share), 0.0);
                }
            }
        }
        let nodes = dense(context.geometry, blocks, &nodes);
        let (fast, plain) = (nodes.nodes.as_flattened(), plain.nodes.as_flattened());
        self.agree(&format!("{name} forces"), fast, plain);
    }

    /// Holds every pass of the kernels to the plain ones.
    pub(super) fn compare<const D: usize>(
        &self,
        name: &str,
        geometry: &Geometry<D>,
        kernels: &dyn Kernels<D>,
        knows: &Knows<'_, D>,
        method: Method,
        kind: Kind,
    ) {
        let instructions = self.instructions;
        let name = format!("{name} {D}D {instructions:?} {kind:?}");
        let affine = kernels.affine();
        let mut random = Random(0x9E37_79B9_7F4A_7C15 + D as u64);
        let (mut fast, blocks) = points(geometry, kernels, affine, kind, &mut random);
        let edge = kind.edge::<D>(kernels.nodes());
        let context = Context {
            geometry,
            body: 0,
            edge,
            dt: DT,
            instructions,
        };

        for (momentum, force) in [(true, true), (true, false), (false, true)] {
            let what = Scattered { momentum, force };
            let mut arrays = [
                vec![Node::default(); blocks.stored],
                vec![Node::default(); blocks.stored],
            ];
            let count = fast.len();
            let columns = Columns::new(&mut fast, count, affine);
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
            plain_scatter(knows, method, &fast, what, plain_main, plain_change);
            for (nodes, plain) in arrays.iter().zip(&plain) {
                let nodes = dense(geometry, &blocks, nodes);
                self.agree(
                    &format!("{name} {what:?}"),
                    nodes.nodes.as_flattened(),
                    plain.nodes.as_flattened(),
                );
            }
        }

        self.check_forces(kernels, &context, &name, knows, &blocks, &mut fast);

        let arrays = [0; 3].map(|_| -> Vec<Node> {
            (0..blocks.stored)
                .map(|_| {
                    let mass = if kind.gaps && random.next() > 0.8 {
                        0.0
                    } else {
                        1.0
                    };
                    let number = |a| if a < D { mass * random.next() } else { mass };
                    Node(std::array::from_fn(number))
                })
                .collect()
        });
        let grid = [0, 1, 2].map(|k| dense(geometry, &blocks, &arrays[k]));
        let sources = Sources {
            main: arrays[0].as_ptr(),
            change: arrays[1].as_ptr(),
            second: arrays[2].as_ptr(),
        };
        self.check_exchange(
            kernels, &context, knows, method, &blocks, &fast, &grid, &sources,
        );
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
            let plain_rates = plain_gather(knows, method, &mut plain, what, &grid);
            let count = fast.len();
            let columns = Columns::new(&mut fast, count, affine);
            let (mut gradients, mut hoops) = (Vec::new(), Vec::new());
            for block in &blocks.bodies[0].blocks {
                let tile = Tile::new(block, edge, kernels.nodes());
                let reach = Reach::new(block.origin, edge, geometry.cells, kernels.shift(0));
                for first in block.points().step_by(CHUNK) {
                    let rows = first..(first + CHUNK).min(block.points().end);
                    let mut rates = Rates::default();
                    let rows_here = rows.len();
                    // SAFETY: one thread; the points were sorted, and moved within reach
                    unsafe {
                        kernels.gather(
                            &context, &columns, &tile, &reach, rows, what, &sources, &mut rates,
                        )
                    };
                    if rate {
                        let hoops_here = if kind.axisymmetric { rows_here } else { 0 };
                        // SAFETY: just gathered
                        let (set, hoop) = unsafe { rates.of(rows_here, hoops_here) };
                        gradients.extend((0..rows_here).map(|p| FourRates::point(set, p)));
                        hoops.extend_from_slice(hoop);
                    }
                }
            }
            if rate {
                self.agree(
                    &name,
                    gradients.iter().flatten(),
                    plain_rates.iter().flat_map(|(gradient, _)| gradient),
                );
                if kind.axisymmetric {
                    self.agree(&name, &hoops, plain_rates.iter().map(|(_, hoop)| hoop));
                }
            }
            self.agree(
                &name,
                fast.position.iter().flatten(),
                plain.position.iter().flatten(),
            );
            self.agree(
                &name,
                fast.velocity.iter().flatten(),
                plain.velocity.iter().flatten(),
            );
            self.agree(
                &name,
                fast.affine.iter().flatten(),
                plain.affine.iter().flatten(),
            );
            self.agree(&name, &fast.hoop_stretch, &plain.hoop_stretch);
            self.agree(
                &name,
                fast.deformation_gradient.iter().flatten(),
                plain.deformation_gradient.iter().flatten(),
            );
        }
    }

    /// New velocities as gathered, and their momenta as scattered.
    #[allow(clippy::too_many_arguments)]
    fn check_exchange<const D: usize>(
        &self,
        kernels: &dyn Kernels<D>,
        context: &Context<'_, D>,
        knows: &Knows<'_, D>,
        method: Method,
        blocks: &Blocks<D>,
        points: &Particles<D>,
        grid: &[Dense<D>; 3],
        sources: &Sources,
    ) {
        let name = format!("exchange {method:?} {} {D}D", kernels.nodes());
        let geometry = context.geometry;
        let (mut fast, mut plain) = (points.clone(), points.clone());
        let mut plain_second = Dense::new(geometry.counts);
        let mut unused = Dense::new(geometry.counts);
        plain_gather(knows, method, &mut plain, Wanted::VELOCITY, grid);
        let what = Scattered::MOMENTUM;
        plain_scatter(knows, method, &plain, what, &mut plain_second, &mut unused);
        let mut second = vec![Node::default(); blocks.stored];
        let count = fast.len();
        let columns = Columns::new(&mut fast, count, kernels.affine());
        for block in &blocks.bodies[0].blocks {
            // SAFETY: one thread; the points were sorted, and moved within reach
            unsafe { kernels.exchange(context, &columns, block, sources, second.as_mut_ptr()) };
        }
        let second = dense(geometry, blocks, &second);
        self.agree(
            &name,
            second.nodes.as_flattened(),
            plain_second.nodes.as_flattened(),
        );
        let (fast_velocity, plain_velocity) = (&fast.velocity, &plain.velocity);
        self.agree(
            &name,
            fast_velocity.iter().flatten(),
            plain_velocity.iter().flatten(),
        );
        self.agree(
            &name,
            fast.affine.iter().flatten(),
            plain.affine.iter().flatten(),
        );
    }
}

/// All of them, and hat functions with the changes of volume of the middle of the cell.
fn every_basis() -> impl Iterator<Item = BasisChoice> {
    let cured = BasisChoice::Linear(Linear { b_bar: true });
    BasisChoice::all().into_iter().chain([cured])
}

#[test]
fn the_kernels_do_what_the_textbook_says_whatever_the_instructions() {
    let bits = |instructions| {
        let bits = Cell::new(0);
        for basis in every_basis() {
            let bits = &bits;
            basis.visit(EveryPass { instructions, bits });
        }
        (instructions, bits.get())
    };
    let all: Vec<_> = Instructions::all().map(bits).collect();
    // a product and a sum that are rounded once make a difference, the size and number of registers do not
    if let [_, wide, widest] = all[..] {
        assert_eq!(wide.1, widest.1, "{:?} and {:?}", wide.0, widest.0);
    }
}
