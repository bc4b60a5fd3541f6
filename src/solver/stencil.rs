//! The hot loops: from the points of one block to the grid nodes around them and back.
//!
//! Weights factorise axis by axis, so a stencil of N^D nodes costs a few operations a node. All loops are generic over
//! [`Lane`], once with wide instructions and once without; `plain` beside this file says what they mean.
//!
//! Everything `unsafe` here rests on three facts. A point's stencil starts at most one node outside its block (checked by
//! [`gather`] whenever a point moves, and by the sort, which refuses points that are not finite or outside the grid); should
//! somebody else have moved the point meanwhile, [`Tile`] holds its stencil inside the tile, which is wrong but addresses only
//! stored nodes, and the health check at the end of the step tells. Blocks that are scattered at the same time have the same colour, so they share no
//! node. Blocks hold disjoint ranges of rows, so no two threads touch the same point.

use super::lane::Lane;
use crate::basis::Basis;
use crate::grid::{Block, Geometry, Node};
use crate::math::{Matrix, Vector, packed_len, unpack};
use crate::state::Particles;
use crate::transfer::Transfer;

/// Points that are gathered together before their law is asked, so that their velocity gradients stay in the first cache.
pub const CHUNK: usize = 64;

/// The most rows that a tile has: 13 × 13, for blocks of 8 and stencils of 4 in 3D.
const MAX_ROWS: usize = 169;

/// Storage of the nodes that the points of one block may reach: all rows of an `edge + N + 1` cube, one node below the block
/// to `N` nodes above it.
pub struct Tile<const D: usize> {
    rows: [usize; MAX_ROWS],
    width: usize,
    /// The last place at which a stencil may start, along every axis.
    last: u32,
    /// N, in a form that keeps the compiler from unrolling all N³ nodes of a 3D stencil, which takes it long and wins nothing.
    n: usize,
    origin: [i32; D],
}

impl<const D: usize> Tile<D> {
    /// The tile of a block of `edge` nodes for stencils of `n` nodes.
    #[inline(always)]
    pub fn new(block: &Block<D>, edge: i32, n: usize) -> Self {
        let width = edge as usize + n + 1;
        let edge = edge as usize;
        let mut rows = [0; MAX_ROWS];
        // (which of the three neighbouring blocks, row within it) of row t of the tile
        let place = |t: usize| match t {
            0 => (0, edge - 1),
            t if t <= edge => (1, t - 1),
            t => (2, t - 1 - edge),
        };
        match D {
            1 => rows[0] = block.anchors[0].0 as usize - 1,
            2 => {
                for t in 0..width {
                    let (column, i) = place(t);
                    let (base, stride) = block.anchors[column];
                    rows[t] = base as usize + i * stride as usize - 1;
                }
            }
            _ => {
                for t in 0..width {
                    let (column, i) = place(t);
                    for u in 0..width {
                        let (next, j) = place(u);
                        let (base, stride) = block.anchors[3 * column + next];
                        rows[t * width + u] = base as usize + (i * edge + j) * stride as usize - 1;
                    }
                }
            }
        }
        Self {
            rows,
            width,
            last: edge as u32 + 1,
            n: std::hint::black_box(n),
            origin: block.origin,
        }
    }

    /// Where a stencil that starts at node `first` lies in the tile.
    #[inline(always)]
    fn local(&self, first: [i32; D]) -> [usize; D] {
        let mut t = [0; D];
        for a in 0..D {
            // below the tile is far above it in unsigned numbers
            let local = first[a].wrapping_sub(self.origin[a]).wrapping_add(1) as u32;
            t[a] = local.min(self.last) as usize;
        }
        t
    }
}

/// `N^D` nodes: for a stencil at `t`, calls `visit(storage index of the first node, i, j)` for each row of N nodes.
macro_rules! for_each_row {
    ($tile:expr, $t:expr, $n:expr, |$at:ident, $i:ident, $j:ident| $body:block) => {
        match D {
            1 => {
                let ($i, $j) = (0_usize, 0_usize);
                let $at = $tile.rows[0] + $t[0];
                $body
            }
            2 => {
                let $j = 0_usize;
                for $i in 0..$n {
                    let $at = $tile.rows[$t[0] + $i] + $t[1];
                    $body
                }
            }
            _ => {
                for $i in 0..$tile.n {
                    for $j in 0..$n {
                        let $at = $tile.rows[($t[0] + $i) * $tile.width + $t[1] + $j] + $t[2];
                        $body
                    }
                }
            }
        }
    };
}

/// Adds `q N_I` to every node of a stencil.
#[inline(always)]
unsafe fn scatter_value<L: Lane, const D: usize, const N: usize>(
    nodes: *mut Node,
    tile: &Tile<D>,
    t: [usize; D],
    w: &[[f64; N]; D],
    q: L,
) {
    let last = splats::<L, N>(&w[D - 1]);
    for_each_row!(tile, t, N, |at, i, j| {
        let row = match D {
            1 => q,
            2 => q.mul(L::splat(w[0][i])),
            _ => q.mul(L::splat(w[0][i] * w[1][j])),
        };
        for k in 0..N {
            // SAFETY: the tile addresses stored nodes only (module header)
            unsafe {
                let node = nodes.add(at + k).cast::<f64>();
                row.mul_add(last[k], L::load(node)).store(node);
            }
        }
    });
}

/// Adds `Σ_a x[a][i_a] Π_{b≠a} N_b` to every node (i_1 … i_D) of a stencil: a value with x[0] = q N_1, and anything that has a
/// different function along one axis, such as a gradient.
#[inline(always)]
unsafe fn scatter_linear<L: Lane, const D: usize, const N: usize>(
    nodes: *mut Node,
    tile: &Tile<D>,
    t: [usize; D],
    w: &[[f64; N]; D],
    x: &[[L; N]; D],
) {
    match D {
        1 => {
            for k in 0..N {
                // SAFETY: the tile addresses stored nodes only (module header)
                unsafe {
                    let node = nodes.add(tile.rows[0] + t[0] + k).cast::<f64>();
                    x[0][k].add(L::load(node)).store(node);
                }
            }
        }
        2 => {
            let last = splats::<L, N>(&w[1]);
            for i in 0..N {
                let at = tile.rows[t[0] + i] + t[1];
                let wi = L::splat(w[0][i]);
                for k in 0..N {
                    // SAFETY: as above
                    unsafe {
                        let node = nodes.add(at + k).cast::<f64>();
                        let sum = x[0][i].mul_add(last[k], L::load(node));
                        wi.mul_add(x[1][k], sum).store(node);
                    }
                }
            }
        }
        _ => {
            let mut plane = [[L::splat(0.0); N]; N];
            let mut slant = plane;
            for j in 0..N {
                for k in 0..N {
                    plane[j][k] = L::splat(w[1][j] * w[2][k]);
                    let first = x[1][j].mul(L::splat(w[2][k]));
                    slant[j][k] = x[2][k].mul_add(L::splat(w[1][j]), first);
                }
            }
            for i in 0..tile.n {
                let wi = L::splat(w[0][i]);
                for j in 0..N {
                    let at = tile.rows[(t[0] + i) * tile.width + t[1] + j] + t[2];
                    for k in 0..N {
                        // SAFETY: as above
                        unsafe {
                            let node = nodes.add(at + k).cast::<f64>();
                            let sum = x[0][i].mul_add(plane[j][k], L::load(node));
                            wi.mul_add(slant[j][k], sum).store(node);
                        }
                    }
                }
            }
        }
    }
}

/// Σ_I N_I node_I.
#[inline(always)]
unsafe fn gather_value<L: Lane, const D: usize, const N: usize>(
    nodes: *const Node,
    tile: &Tile<D>,
    t: [usize; D],
    w: &[[f64; N]; D],
) -> L {
    let last = splats::<L, N>(&w[D - 1]);
    let mut sum = L::splat(0.0);
    for_each_row!(tile, t, N, |at, i, j| {
        let mut row = L::splat(0.0);
        for k in 0..N {
            // SAFETY: the tile addresses stored nodes only (module header)
            row = unsafe { last[k].mul_add(L::load(nodes.add(at + k).cast()), row) };
        }
        sum = match D {
            1 => row,
            2 => row.mul_add(L::splat(w[0][i]), sum),
            _ => row.mul_add(L::splat(w[0][i] * w[1][j]), sum),
        };
    });
    sum
}

/// Σ_I N_I node_I, and for each set of functions `g[m]` and each axis a the same with `g[m]` in place of N along that axis: with
/// the slopes Σ_I ∂_a N_I node_I. All sets together read the nodes once.
#[inline(always)]
unsafe fn gather_linear<L: Lane, const D: usize, const N: usize, const M: usize>(
    nodes: *const Node,
    tile: &Tile<D>,
    t: [usize; D],
    w: &[[f64; N]; D],
    g: [&[[f64; N]; D]; M],
) -> (L, [[L; D]; M]) {
    let zero = L::splat(0.0);
    let last = splats::<L, N>(&w[D - 1]);
    let mut slope = [[zero; N]; M];
    for m in 0..M {
        slope[m] = splats::<L, N>(&g[m][D - 1]);
    }
    // (value, slopes along the last axis) of N nodes in a row
    let row = |at: usize| {
        let (mut value, mut change) = (zero, [zero; M]);
        for k in 0..N {
            // SAFETY: the tile addresses stored nodes only (module header)
            let node = unsafe { L::load(nodes.add(at + k).cast()) };
            value = last[k].mul_add(node, value);
            for m in 0..M {
                change[m] = slope[m][k].mul_add(node, change[m]);
            }
        }
        (value, change)
    };
    let mut gradient = [[zero; D]; M];
    let mut sum = zero;
    match D {
        1 => {
            let (value, change) = row(tile.rows[0] + t[0]);
            sum = value;
            for m in 0..M {
                gradient[m][0] = change[m];
            }
        }
        2 => {
            for i in 0..N {
                let (value, change) = row(tile.rows[t[0] + i] + t[1]);
                let wi = L::splat(w[0][i]);
                sum = wi.mul_add(value, sum);
                for m in 0..M {
                    gradient[m][0] = L::splat(g[m][0][i]).mul_add(value, gradient[m][0]);
                    gradient[m][1] = wi.mul_add(change[m], gradient[m][1]);
                }
            }
        }
        _ => {
            for i in 0..tile.n {
                let (mut value, mut dy, mut dz) = (zero, [zero; M], [zero; M]);
                for j in 0..N {
                    let at = tile.rows[(t[0] + i) * tile.width + t[1] + j] + t[2];
                    let (v, c) = row(at);
                    let wj = L::splat(w[1][j]);
                    value = wj.mul_add(v, value);
                    for m in 0..M {
                        dy[m] = L::splat(g[m][1][j]).mul_add(v, dy[m]);
                        dz[m] = wj.mul_add(c[m], dz[m]);
                    }
                }
                let wi = L::splat(w[0][i]);
                sum = wi.mul_add(value, sum);
                for m in 0..M {
                    gradient[m][0] = L::splat(g[m][0][i]).mul_add(value, gradient[m][0]);
                    gradient[m][1] = wi.mul_add(dy[m], gradient[m][1]);
                    gradient[m][2] = wi.mul_add(dz[m], gradient[m][2]);
                }
            }
        }
    }
    (sum, gradient)
}

/// Each number in all parts of a lane.
#[inline(always)]
fn splats<L: Lane, const N: usize>(numbers: &[f64; N]) -> [L; N] {
    let mut lanes = [L::splat(0.0); N];
    for k in 0..N {
        lanes[k] = L::splat(numbers[k]);
    }
    lanes
}

/// The first `D` numbers of a lane.
#[inline(always)]
fn vector<L: Lane, const D: usize>(lane: L) -> [f64; D] {
    let numbers = lane.array();
    let mut vector = [0.0; D];
    vector.copy_from_slice(&numbers[..D]);
    vector
}

/// A matrix from its columns.
#[inline(always)]
fn matrix<L: Lane, const D: usize>(columns: &[L; D]) -> Matrix<D> {
    let mut matrix = Matrix::<D>::zeros();
    for a in 0..D {
        matrix.data.0[a] = vector(columns[a]);
    }
    matrix
}

/// The columns of a body's points, shared by threads that work on disjoint rows.
#[derive(Clone, Copy)]
pub struct Columns<const D: usize> {
    position: *mut Vector<D>,
    velocity: *mut Vector<D>,
    affine: *mut Matrix<D>,
    mass: *const f64,
    volume: *const f64,
    stress: *mut f64,
    hoop_stress: *mut f64,
    hoop_stretch: *mut f64,
    axisymmetric: bool,
}

// SAFETY: threads are given disjoint rows (module header)
unsafe impl<const D: usize> Send for Columns<D> {}
// SAFETY: as above
unsafe impl<const D: usize> Sync for Columns<D> {}

impl<const D: usize> Columns<D> {
    /// Pointers to the columns, valid until the columns are moved or resized.
    ///
    /// # Panics
    /// If the columns do not have one entry for each of `count` points, affine fields included if `affine`.
    pub fn new(particles: &mut Particles<D>, count: usize, affine: bool) -> Self {
        assert!(
            particles.are_whole(count, affine),
            "the columns of a body were resized between two steps; points are added and removed before a run only"
        );
        Self {
            position: particles.position.as_mut_ptr(),
            velocity: particles.velocity.as_mut_ptr(),
            affine: particles.affine.as_mut_ptr(),
            mass: particles.mass.as_ptr(),
            volume: particles.initial_volume.as_ptr(),
            stress: particles.stress.as_mut_ptr(),
            hoop_stress: particles.hoop_stress.as_mut_ptr(),
            hoop_stretch: particles.hoop_stretch.as_mut_ptr(),
            axisymmetric: !particles.hoop_stretch.is_empty(),
        }
    }

    /// Stress, hoop stress and hoop stretch of the given rows, for their law.
    ///
    /// # Safety
    /// No other thread uses these rows meanwhile.
    pub unsafe fn law_columns(
        &self,
        first: usize,
        count: usize,
    ) -> (&mut [f64], &mut [f64], &mut [f64]) {
        let width = packed_len(D);
        let hoops = if self.axisymmetric { count } else { 0 };
        let offset = if self.axisymmetric { first } else { 0 };
        // SAFETY: the rows exist, and the caller alone uses them
        unsafe {
            (
                std::slice::from_raw_parts_mut(self.stress.add(first * width), count * width),
                std::slice::from_raw_parts_mut(self.hoop_stress.add(offset), hoops),
                std::slice::from_raw_parts_mut(self.hoop_stretch.add(offset), hoops),
            )
        }
    }
}

/// What all points of a body have in common in one pass over them.
pub struct Pass<'a, const D: usize, B, T> {
    /// The grid.
    pub geometry: &'a Geometry<D>,
    /// The basis along each axis.
    pub basis: [B; D],
    /// The transfer.
    pub transfer: T,
    /// Δt, s.
    pub dt: f64,
}

/// The stencil of one point.
struct Stencil<const D: usize, const N: usize> {
    at: [usize; D],
    weight: [[f64; N]; D],
    /// Per metre.
    slope: [[f64; N]; D],
    /// x_i − x, in cells.
    arm: [[f64; N]; D],
}

impl<const D: usize, B, T: Transfer> Pass<'_, D, B, T> {
    #[inline(always)]
    fn stencil<const N: usize>(&self, tile: &Tile<D>, position: &Vector<D>) -> Stencil<D, N>
    where
        B: Basis<N>,
    {
        let inverse = 1.0 / self.geometry.cell_size;
        let x = self.geometry.in_cells(position, inverse);
        let mut first = [0; D];
        let (mut weight, mut slope, mut arm) = ([[0.0; N]; D], [[0.0; N]; D], [[0.0; N]; D]);
        for a in 0..D {
            let axis = self.basis[a].axis(x[a], self.geometry.cells[a]);
            first[a] = axis.first;
            weight[a] = axis.weight;
            arm[a] = axis.arm;
            for i in 0..N {
                slope[a][i] = axis.slope[i] * inverse;
            }
        }
        Stencil {
            at: tile.local(first),
            weight,
            slope,
            arm,
        }
    }

    /// The functions whose gathered velocities are the columns of APIC's C, per metre: N_i (x_i − x) / D with
    /// D = Σ N_i (x_i − x)²; tensor-product bases that are complete to first order have a diagonal D.
    #[inline(always)]
    fn affine_weights<const N: usize>(&self, s: &Stencil<D, N>) -> [[f64; N]; D]
    where
        B: Basis<N>,
    {
        if B::AFFINE_IS_SLOPE {
            return s.slope;
        }
        let mut weights = s.arm;
        for a in 0..D {
            let mut inertia = 0.0;
            for i in 0..N {
                let arm = weights[a][i];
                weights[a][i] *= s.weight[a][i];
                inertia += weights[a][i] * arm;
            }
            if inertia <= f64::MIN_POSITIVE {
                // on the very end of a grid of splines one node has all the weight and no arm: the slopes are the limit
                weights[a] = s.slope[a];
                continue;
            }
            let scale = 1.0 / (inertia * self.geometry.cell_size);
            for i in 0..N {
                weights[a][i] *= scale;
            }
        }
        weights
    }
}

/// What points give to the grid.
#[derive(Clone, Copy, Debug)]
pub struct Scattered {
    /// Momentum and mass.
    pub momentum: bool,
    /// Internal forces.
    pub force: bool,
}

/// Adds the points of one block to the grid: momenta and masses into `main`, internal forces
/// into `force` (in N) where the transfer needs forces by themselves, else as impulses into `main` too.
///
/// # Safety
/// See the module header; `main` and `force` are arrays of the grid with all of the tile's nodes (`force` may dangle where the
/// transfer does not use it), and no other thread adds to nodes of this tile meanwhile.
#[inline(always)]
pub unsafe fn scatter<L: Lane, const D: usize, const N: usize, B: Basis<N>, T: Transfer>(
    pass: &Pass<'_, D, B, T>,
    columns: &Columns<D>,
    block: &Block<D>,
    edge: i32,
    what: Scattered,
    main: *mut Node,
    force: *mut Node,
) {
    let tile = Tile::new(block, edge, N);
    let width = packed_len(D);
    for p in block.points() {
        // SAFETY: row p belongs to this block alone (module header)
        let (position, velocity, mass) = unsafe {
            (
                *columns.position.add(p),
                *columns.velocity.add(p),
                *columns.mass.add(p),
            )
        };
        let s = pass.stencil::<N>(&tile, &position);
        let mut value = [0.0; 4]; // goes with N
        let mut hoop = 0.0; // radial force that goes with N
        let mut columns_of_x = [[L::splat(0.0); N]; D];
        if what.momentum {
            for a in 0..D {
                value[a] = mass * velocity[a];
            }
            value[D] = mass;
            if T::AFFINE {
                // SAFETY: as above
                let affine = unsafe { &*columns.affine.add(p) };
                let scale = L::splat(mass * pass.geometry.cell_size);
                for a in 0..D {
                    let column = lane::<L, D>(&affine.data.0[a]).mul(scale);
                    for i in 0..N {
                        columns_of_x[a][i] = column.mul(L::splat(s.weight[a][i] * s.arm[a][i]));
                    }
                }
            }
        }
        let mut forces = [[L::splat(0.0); N]; D];
        if what.force {
            // SAFETY: as above
            let (volume, stress) = unsafe {
                (
                    *columns.volume.add(p),
                    std::slice::from_raw_parts(columns.stress.add(p * width), width),
                )
            };
            let scale = if T::CHANGE {
                -volume
            } else {
                -volume * pass.dt
            };
            let stress = unpack::<D>(stress);
            for a in 0..D {
                let column = lane::<L, D>(&stress.data.0[a]).mul(L::splat(scale));
                for i in 0..N {
                    let x = if T::CHANGE {
                        &mut forces
                    } else {
                        &mut columns_of_x
                    };
                    x[a][i] = column.mul_add(L::splat(s.slope[a][i]), x[a][i]);
                }
            }
            if D == 2 && columns.axisymmetric {
                // SAFETY: as above
                hoop = scale * unsafe { *columns.hoop_stress.add(p) } / position[0];
            }
        }
        // SAFETY: the tile holds every node of the stencil (module header)
        unsafe {
            if T::CHANGE {
                if what.momentum {
                    add_point(main, &tile, &s, L::new(value), T::AFFINE, columns_of_x);
                }
                if what.force {
                    add_point(
                        force,
                        &tile,
                        &s,
                        L::new([hoop, 0.0, 0.0, 0.0]),
                        true,
                        forces,
                    );
                }
            } else {
                value[0] += hoop;
                let linear = what.force || T::AFFINE;
                add_point(main, &tile, &s, L::new(value), linear, columns_of_x);
            }
        }
    }
}

#[inline(always)]
unsafe fn add_point<L: Lane, const D: usize, const N: usize>(
    nodes: *mut Node,
    tile: &Tile<D>,
    s: &Stencil<D, N>,
    value: L,
    linear: bool,
    mut x: [[L; N]; D],
) {
    // SAFETY: the caller's tile holds every node of the stencil
    unsafe {
        if linear {
            for i in 0..N {
                x[0][i] = value.mul_add(L::splat(s.weight[0][i]), x[0][i]);
            }
            scatter_linear(nodes, tile, s.at, &s.weight, &x);
        } else {
            scatter_value(nodes, tile, s.at, &s.weight, value);
        }
    }
}

/// A vector as a lane.
#[inline(always)]
fn lane<L: Lane, const D: usize>(vector: &[f64; D]) -> L {
    let mut numbers = [0.0; 4];
    numbers[..D].copy_from_slice(vector);
    L::new(numbers)
}

/// Adds a given force on each listed point of a block to `nodes`, N.
///
/// # Safety
/// As for [`scatter`].
#[inline(always)]
pub unsafe fn scatter_forces<L: Lane, const D: usize, const N: usize, B: Basis<N>, T: Transfer>(
    pass: &Pass<'_, D, B, T>,
    columns: &Columns<D>,
    block: &Block<D>,
    edge: i32,
    nodes: *mut Node,
    forces: &[(u32, Vector<D>)],
) {
    let tile = Tile::new(block, edge, N);
    for (p, force) in forces {
        // SAFETY: row p belongs to this block alone (module header)
        let position = unsafe { *columns.position.add(*p as usize) };
        let s = pass.stencil::<N>(&tile, &position);
        let mut value = [0.0; 4];
        value[..D].copy_from_slice(force.as_slice());
        // SAFETY: the tile holds every node of the stencil
        unsafe { scatter_value::<L, D, N>(nodes, &tile, s.at, &s.weight, L::new(value)) };
    }
}

/// What the gathering of one block leaves behind.
#[derive(Clone, Copy, Debug)]
pub struct Gathered {
    /// Σ ½ m v² after the step, J.
    pub kinetic: f64,
    /// Largest v² of a point, m²/s².
    pub speed_squared: f64,
    /// Whether all points are finite, inside the grid and within the reach of their block.
    pub within: bool,
}

impl Gathered {
    /// Nothing yet.
    pub const NONE: Self = Self {
        kinetic: 0.0,
        speed_squared: 0.0,
        within: true,
    };

    /// Both together.
    pub fn and(self, other: Self) -> Self {
        Self {
            kinetic: self.kinetic + other.kinetic,
            speed_squared: self.speed_squared.max(other.speed_squared),
            within: self.within && other.within,
        }
    }
}

/// Velocity gradients of up to [`CHUNK`] points.
pub struct Rates<const D: usize> {
    /// L, 1/s.
    pub gradient: [Matrix<D>; CHUNK],
    /// v_r / r, 1/s; only set in an axisymmetric scene.
    pub hoop: [f64; CHUNK],
}

impl<const D: usize> Rates<D> {
    /// All zero.
    pub fn zeros() -> Self {
        Self {
            gradient: [Matrix::zeros(); CHUNK],
            hoop: [0.0; CHUNK],
        }
    }
}

/// The arrays of the grid that points read.
#[derive(Clone, Copy)]
pub struct Sources {
    /// Velocities after the step, m/s.
    pub main: *const Node,
    /// Their change over the step, m/s.
    pub change: *const Node,
    /// The velocities whose gradient strains the points, where they are not `main`.
    pub second: *const Node,
}

/// What points take from the grid.
#[derive(Clone, Copy, Debug)]
pub struct Wanted {
    /// New velocities, and affine fields.
    pub velocity: bool,
    /// New positions.
    pub position: bool,
    /// Velocity gradients.
    pub rate: bool,
    /// Whether the gradients are those of `main`; else of `second`.
    pub same: bool,
}

/// Brings the grid to the given rows (at most [`CHUNK`]) of a block.
///
/// # Safety
/// See the module header; `sources` are arrays of the grid with all of the tile's nodes (those that the pass does not use may
/// dangle), and no other thread uses these rows meanwhile.
#[inline(always)]
#[allow(clippy::too_many_arguments)]
pub unsafe fn gather<L: Lane, const D: usize, const N: usize, B: Basis<N>, T: Transfer>(
    pass: &Pass<'_, D, B, T>,
    columns: &Columns<D>,
    tile: &Tile<D>,
    reach: &Reach<D>,
    rows: std::ops::Range<usize>,
    what: Wanted,
    sources: &Sources,
    rates: &mut Rates<D>,
) -> Gathered {
    let mut gathered = Gathered::NONE;
    let inverse = 1.0 / pass.geometry.cell_size;
    let blend = pass.transfer.ratio() < 1.0;
    let first_row = rows.start;
    for p in rows {
        // SAFETY: row p belongs to this block alone (module header)
        let mut position = unsafe { *columns.position.add(p) };
        let s = pass.stencil::<N>(tile, &position);
        let (t, w) = (s.at, &s.weight);
        let mut new = L::splat(0.0);
        let mut hoop_velocity = 0.0;
        // SAFETY: the tile holds every node of the stencil (module header)
        unsafe {
            if what.rate && what.same && what.velocity && T::AFFINE {
                let g = pass.affine_weights(&s);
                let (value, [gradient, affine]) =
                    gather_linear::<L, D, N, 2>(sources.main, tile, t, w, [&s.slope, &g]);
                rates.gradient[p - first_row] = matrix::<L, D>(&gradient);
                *columns.affine.add(p) = matrix::<L, D>(&affine);
                hoop_velocity = value.array()[0];
                new = value;
            } else {
                if what.rate {
                    let from = if what.same {
                        sources.main
                    } else {
                        sources.second
                    };
                    let (value, [gradient]) =
                        gather_linear::<L, D, N, 1>(from, tile, t, w, [&s.slope]);
                    rates.gradient[p - first_row] = matrix::<L, D>(&gradient);
                    hoop_velocity = value.array()[0];
                    if what.same {
                        new = value;
                    }
                }
                if what.velocity && T::AFFINE {
                    let g = pass.affine_weights(&s);
                    let (value, [affine]) =
                        gather_linear::<L, D, N, 1>(sources.main, tile, t, w, [&g]);
                    *columns.affine.add(p) = matrix::<L, D>(&affine);
                    new = value;
                } else if !(what.rate && what.same)
                    && (what.position || (what.velocity && (blend || !T::CHANGE)))
                {
                    new = gather_value::<L, D, N>(sources.main, tile, t, w);
                }
            }
        }
        if what.rate && D == 2 && columns.axisymmetric {
            let hoop = hoop_velocity / position[0];
            rates.hoop[p - first_row] = hoop;
            // SAFETY: as above
            unsafe { *columns.hoop_stretch.add(p) *= 1.0 + pass.dt * hoop };
        }
        let new: [f64; D] = vector(new);
        if what.velocity {
            // SAFETY: as above
            let (old, mass) = unsafe { (*columns.velocity.add(p), *columns.mass.add(p)) };
            let change: [f64; D] = if T::CHANGE {
                // SAFETY: as above
                vector(unsafe { gather_value::<L, D, N>(sources.change, tile, t, w) })
            } else {
                [0.0; D]
            };
            let mut velocity = Vector::<D>::zeros();
            let mut square = 0.0;
            for a in 0..D {
                let v = pass.transfer.velocity(old[a], new[a], change[a]);
                velocity[a] = v;
                square += v * v;
            }
            // SAFETY: as above
            unsafe { *columns.velocity.add(p) = velocity };
            gathered.kinetic += 0.5 * mass * square;
            // `max` would hide a velocity that is not a number
            gathered.within &= square.is_finite();
            gathered.speed_squared = gathered.speed_squared.max(square);
        }
        if what.position {
            for a in 0..D {
                position[a] += pass.dt * new[a];
            }
            // SAFETY: as above
            unsafe { *columns.position.add(p) = position };
            gathered.within &= reach.holds(&pass.geometry.in_cells(&position, inverse));
        }
    }
    gathered
}

/// The part of the grid, in cells, in which a point may be as long as it is counted to a block.
#[derive(Clone, Copy, Debug)]
pub struct Reach<const D: usize> {
    low: [f64; D],
    high: [f64; D],
}

impl<const D: usize> Reach<D> {
    /// One node more than the block on either side, within the grid; `shift` is where stencils start relative to their point.
    #[inline(always)]
    pub fn new(origin: [i32; D], edge: i32, cells: [i32; D], shift: [f64; D]) -> Self {
        // a hair inside, so that rounding cannot put a stencil's start beyond the tile
        let hair = 1e-9
            + cells
                .iter()
                .fold(0.0, |most: f64, &n| most.max(f64::from(n)))
                * 1e-15;
        Self {
            low: std::array::from_fn(|a| (f64::from(origin[a] - 1) - shift[a] + hair).max(0.0)),
            high: std::array::from_fn(|a| {
                (f64::from(origin[a] + edge + 1) - shift[a] - hair).min(f64::from(cells[a]))
            }),
        }
    }

    /// Whether a position is inside; false if it is not a number.
    #[inline(always)]
    pub fn holds(&self, x: &[f64; D]) -> bool {
        (0..D).all(|a| x[a] >= self.low[a] && x[a] <= self.high[a])
    }
}
