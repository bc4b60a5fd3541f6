//! Points for the comparison of kernels: all over the grid, with random content.

use super::*;
use crate::grid::{Blocks, LARGE_EDGE, block_edge};
use crate::solver::kernels::Kernels;
use crate::solver::stencil::Reach;

/// Numbers between −1 and 1 (xorshift64*).
pub(super) struct Random(pub u64);

impl Random {
    pub(super) fn next(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// What kind of scene points belong to.
#[derive(Clone, Copy, Debug)]
pub(super) struct Kind {
    pub axisymmetric: bool,
    /// Whether the frame is the total Lagrangian one.
    pub total: bool,
    /// Whether points have domains.
    pub domains: bool,
    /// Whether some nodes have no mass.
    pub gaps: bool,
    /// Whether blocks are those of many points.
    pub large: bool,
}

impl Kind {
    /// Every kind of scene of `D` dimensions.
    pub(super) fn all<const D: usize>(domains: bool) -> Vec<Self> {
        let kind = |k: usize| Self {
            axisymmetric: k & 1 == 1,
            total: k & 2 == 2,
            domains,
            gaps: false,
            large: k & 4 == 4,
        };
        let exists =
            |kind: &Self| (D == 2 || !kind.axisymmetric) && (D == 3 && !kind.total || !kind.large);
        (0..8).map(kind).filter(exists).collect()
    }

    /// Nodes along an edge of a block, for stencils of `n` nodes.
    pub(super) fn edge<const D: usize>(&self, n: usize) -> i32 {
        if self.large {
            LARGE_EDGE
        } else {
            block_edge(D, n)
        }
    }

    /// Small cells and places that are no round numbers; the axis of an axisymmetric grid is at zero.
    pub(super) fn corner<const D: usize>(&self) -> Vector<D> {
        Vector::from_fn(|a, _| match self.axisymmetric {
            true => 0.0,
            false => [0.0, -0.3, 0.7][a],
        })
    }
}

/// Points all over the grid, some in its corners, with random content, then sorted into blocks and moved as far as a point may
/// go before it has to be sorted again; in the total frame their present positions are anywhere.
pub(super) fn points<const D: usize>(
    geometry: &Geometry<D>,
    kernels: &dyn Kernels<D>,
    affine: bool,
    kind: Kind,
    random: &mut Random,
) -> (Particles<D>, Blocks<D>) {
    let Kind {
        axisymmetric,
        total,
        domains,
        ..
    } = kind;
    let edge = kind.edge::<D>(kernels.nodes());
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
    let (shift, last) = (kernels.shift(0), kernels.last_start(0, &geometry.cells));
    let first = |x: &[f64; D]| -> [i32; D] {
        std::array::from_fn(|a| ((x[a] + shift[a]).floor() as i32).min(last[a]))
    };
    let block = |x: &[f64; D]| first(x).map(|first| first.div_euclid(edge));
    // half of the points are eight or four in a cell, which stand first in their block: whole groups with the same nodes
    let mut places: Vec<([f64; D], usize)> = Vec::new();
    while places.len() < count {
        let x = place(random, places.len());
        let together = match places.len() % 24 {
            0 => 8,
            8 => 4,
            _ => 1,
        };
        places.push((x, together));
        let mut more = together - 1;
        while more > 0 {
            let near: [f64; D] = std::array::from_fn(|a| x[a] + 0.5 * random.next());
            let inside = (0..D).all(|a| near[a] >= 0.0 && near[a] <= f64::from(geometry.cells[a]));
            if inside && first(&near) == first(&x) {
                places.push((near, together));
                more -= 1;
            }
        }
    }
    let count = places.len();
    places.sort_by_key(|(x, together)| {
        let cell = if *together > 1 { first(x) } else { [0; D] };
        (block(x), 8 - together, cell)
    });
    let mut occupied: Vec<([i32; D], (u32, u32))> = Vec::new();
    for (row, (x, together)) in places.iter_mut().enumerate() {
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
        if row % 3 > 0 && *together == 1 && reach.holds(&strayed) {
            *x = strayed;
        }
    }
    let places: Vec<[f64; D]> = places.into_iter().map(|(x, _)| x).collect();
    let share_of_same = |size: usize| {
        let same = occupied.iter().flat_map(|&(_, (from, to))| {
            let rows = &places[from as usize..to as usize];
            rows.chunks_exact(size)
                .filter(|some| some.iter().all(|x| first(x) == first(&some[0])))
        });
        (size * same.count()) as f64 / count as f64
    };
    let (fours, eights) = (share_of_same(4), share_of_same(8));
    assert!(fours > 0.3 && fours < 0.7, "{fours}");
    assert!(eights > 0.2 && eights < 0.5, "{eights}");
    let mut blocks = Blocks::default();
    blocks.rebuild(edge, &geometry.counts, &[occupied]);
    let mut numbers = |count: usize| -> Vec<f64> { (0..count).map(|_| random.next()).collect() };
    let hoops = if axisymmetric { count } else { 0 };
    let references = if total { count } else { 0 };
    let deformed = if total || domains { count } else { 0 };
    // an end of the grid is hit exactly, whatever the cell size
    let places: Vec<Vector<D>> = places
        .iter()
        .map(|x| Vector::from_fn(|a, _| geometry.min[a] + h * x[a]))
        .collect();
    let astray: Vec<f64> = numbers(D * references);
    let vectors = numbers(D * count);
    let matrices = numbers(D * D * count);
    let particles = Particles {
        // r is not zero
        position: if total {
            astray
                .chunks_exact(D)
                .map(|x| Vector::from_fn(|a, _| 1.5 + x[a]))
                .collect()
        } else {
            places.clone()
        },
        reference_position: places[..references].to_vec(),
        // stretched, turned and sheared, every seventh to more than a domain may be
        deformation_gradient: numbers(D * D * deformed)
            .chunks_exact(D * D)
            .enumerate()
            .map(|(i, f)| {
                let size = if i % 7 == 0 { 6.0 } else { 1.5 };
                (Matrix::identity() * 1.5 + Matrix::from_column_slice(f)) * size
            })
            .collect(),
        first_piola_stress: numbers(D * D * references)
            .chunks_exact(D * D)
            .map(Matrix::from_column_slice)
            .collect(),
        velocity: vectors
            .chunks_exact(D)
            .map(Vector::from_column_slice)
            .collect(),
        // rings differ; otherwise one number for all is what scenes have
        mass: if !axisymmetric && !total {
            Masses::of_volumes(1.7, count, |_| 0.9)
        } else {
            let volumes = numbers(count);
            Masses::of_volumes(1.7, count, |p| 1.5 + volumes[p])
        },
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
