//! From points to the grid.

use super::dilation::Centre;
use super::group::{Fours, Group, Needs, Rows};
use super::line::scatter_four;
use super::nodes::{Gift, Stencil, scatter_gift};
use super::same::{Gifts, scatter_same};
use super::wider::Wider;
use super::{Columns, Pass, Tile};
use crate::basis::Basis;
use crate::grid::{Block, Node};
use crate::math::{Matrix, Vector, packed_len};
use crate::solver::lane::{Lane, Points};
use crate::transfer::Transfer;

/// What points give to the grid.
#[derive(Clone, Copy, Debug)]
pub struct Scattered {
    /// Momentum and mass.
    pub momentum: bool,
    /// Internal forces.
    pub force: bool,
}

impl Scattered {
    /// Momenta, masses and internal forces.
    pub const ALL: Self = Self {
        momentum: true,
        force: true,
    };
    /// Momenta and masses.
    pub const MOMENTUM: Self = Self {
        momentum: true,
        force: false,
    };
    /// Internal forces.
    pub const FORCE: Self = Self {
        momentum: false,
        force: true,
    };
}

/// Adds the points of one block to the grid: momenta and masses into `main`, internal forces
/// into `force` (in N) where the transfer needs forces by themselves, else as impulses into `main` too. Points are taken in groups
/// of four or, where that pays, of as many as `E` has lanes.
///
/// # Safety
/// See the module header; `main` and `force` are arrays of the grid with all of the tile's nodes (`force` may dangle where the
/// transfer does not use it), and no other thread adds to nodes of this tile meanwhile.
#[inline(always)]
pub unsafe fn scatter<E: Points, const D: usize, const N: usize, B: Basis<N>, T: Transfer>(
    pass: &Pass<D, B, T>,
    columns: &Columns<D>,
    block: &Block<D>,
    edge: i32,
    what: Scattered,
    main: *mut Node,
    force: *mut Node,
) {
    let tile = Tile::new(block, edge, N);
    let mut group = Group::<E::Four, D, N>::new();
    let mut centre = Centre::new(pass);
    let mut gifts = Gifts::none();
    let needs = Needs {
        slope: what.force && !T::MOVING_LEAST_SQUARES,
        affine: T::AFFINE,
    };
    let affine = T::AFFINE && what.momentum;
    let mut wider = Wider::<E, D, N>::new();
    let mut fours = Fours(block.points());
    loop {
        // SAFETY: the rows belong to this block alone (module header), and the tile holds every node of their stencils
        unsafe {
            let eight = wider.take(&mut fours, pass, columns, &tile, needs, centre.used);
            if let Some((Rows { first, .. }, _)) = eight {
                columns.prefetch::<E>(first, affine, what.force);
                let Wider { group, gifts } = &mut wider;
                scatter_one(pass, columns, group, &tile, first, what, main, force, gifts);
                continue;
            }
        }
        let Some(rows) = fours.next() else {
            return;
        };
        // SAFETY: as above
        unsafe {
            let place = columns.places::<E::Four>(rows.first, rows.count);
            columns.prefetch::<E::Four>(rows.first, affine, what.force);
            group.set(pass, &tile, &place, needs);
            if centre.used {
                centre.set(&group);
            }
            scatter_rows(
                pass, columns, &group, &centre, &tile, rows, what, main, force, &mut gifts,
            );
        }
    }
}

/// Adds the points of a group to the grid: as one if they are, else one after the other.
///
/// # Safety
/// As for [`scatter`]; the functions of the points are those in `group`.
#[inline(always)]
#[allow(clippy::too_many_arguments)]
pub(super) unsafe fn scatter_rows<
    L: Lane,
    const D: usize,
    const N: usize,
    B: Basis<N>,
    T: Transfer,
>(
    pass: &Pass<D, B, T>,
    columns: &Columns<D>,
    group: &Group<L, D, N>,
    centre: &Centre<L, D, N>,
    tile: &Tile<D>,
    rows: Rows,
    what: Scattered,
    main: *mut Node,
    force: *mut Node,
    gifts: &mut Gifts<L, D, N>,
) {
    let Rows { first, count } = rows;
    // SAFETY: as the caller says
    unsafe {
        if D == 1 {
            scatter_four::<L, D, N, B, T>(pass, columns, group, tile, rows, what, main, force);
        } else if group.is_one(count, centre.used) {
            scatter_one::<L, D, N, B, T>(
                pass, columns, group, tile, first, what, main, force, gifts,
            );
        } else {
            for q in 0..count {
                let s = Stencil { group, tile, q };
                let p = first + q;
                scatter_point::<L, D, N, B, T>(pass, columns, &s, centre, p, what, main, force);
            }
        }
    }
}

#[inline(always)]
#[allow(clippy::too_many_arguments)]
unsafe fn scatter_point<L: Lane, const D: usize, const N: usize, B: Basis<N>, T: Transfer>(
    pass: &Pass<D, B, T>,
    columns: &Columns<D>,
    s: &Stencil<'_, L, D, N>,
    centre: &Centre<L, D, N>,
    p: usize,
    what: Scattered,
    main: *mut Node,
    force: *mut Node,
) {
    let zero = L::splat(0.0);
    let mut value = zero;
    let mut moment = [zero; D]; // columns of m C Σ N (x_i − x)²
    let mut pull = [zero; D]; // columns of −V₀ τ, or of −V₀ P in the total frame, times Δt where impulses are wanted
    let mut hoop = 0.0; // radial force that goes with N
    if what.momentum {
        // SAFETY: row p belongs to this block alone (module header)
        let (velocity, mass) = unsafe {
            (
                L::load_point::<D>(columns.velocity.add(p).cast()),
                columns.mass(p),
            )
        };
        // m (v, 1)
        value = (velocity + L::new(unit::<D>())) * L::splat(mass);
        if T::AFFINE {
            for a in 0..D {
                // SAFETY: as above; column a of a D × D matrix
                let column =
                    unsafe { L::load_point::<D>(columns.affine.add(p).cast::<f64>().add(a * D)) };
                moment[a] = column * L::splat(mass * s.group.inertia[a].of(s.q));
            }
        }
    }
    if what.force {
        // SAFETY: as above
        let (mass, stress) = unsafe {
            let stress = if columns.total {
                load_matrix::<L, D>(columns.first_piola.add(p))
            } else {
                L::load_symmetric::<D>(columns.stress.add(p * packed_len(D)))
            };
            (columns.mass(p), stress)
        };
        let scale = if T::CHANGE {
            -columns.specific_volume * mass
        } else {
            -columns.specific_volume * pass.dt * mass
        };
        // zero where a node has its mass: there the stress' columns may hold anything
        let scales = L::new(first_numbers::<D>(scale));
        for a in 0..D {
            pull[a] = stress[a] * scales;
        }
        if centre.used {
            let nodes = if T::CHANGE { force } else { main };
            // SAFETY: as the caller says
            unsafe { centre.press(columns, s.tile, p, s.q, nodes, &mut pull) };
        }
        if D == 2 && columns.axisymmetric {
            // SAFETY: as above
            hoop = unsafe { scale * *columns.hoop_stress.add(p) / (&*columns.position.add(p))[0] };
        }
    }
    let mut slant = [[zero; N]; D];
    let (affine, slope) = (&s.group.affine, &s.group.slope);
    for a in 0..D {
        if T::MOVING_LEAST_SQUARES {
            let column = moment[a] + pull[a];
            for i in 0..N {
                slant[a][i] = column * s.splat(&affine[a][i]);
            }
            continue;
        }
        if T::AFFINE && what.momentum {
            for i in 0..N {
                slant[a][i] = moment[a] * s.splat(&affine[a][i]);
            }
        }
        if what.force {
            for i in 0..N {
                slant[a][i] = pull[a].mul_add(s.splat(&slope[a][i]), slant[a][i]);
            }
        }
    }
    let mut gift = Gift { value, slant };
    let radial = L::new([hoop, 0.0, 0.0, 0.0]);
    // SAFETY: the tile holds every node of the stencil (module header)
    unsafe {
        match (T::CHANGE, what.momentum, what.force) {
            (true, true, true) if !columns.axisymmetric => {
                scatter_gift::<L, D, N, true, true>(main, force, s, &gift);
            }
            (true, momentum, internal) => {
                if momentum {
                    scatter_gift::<L, D, N, true, false>(main, main, s, &gift);
                }
                if internal {
                    gift.value = radial;
                    scatter_gift::<L, D, N, false, true>(force, force, s, &gift);
                }
            }
            (false, _, true) => {
                gift.value = gift.value + radial;
                scatter_gift::<L, D, N, false, true>(main, main, s, &gift);
            }
            (false, _, false) if T::AFFINE => {
                scatter_gift::<L, D, N, false, true>(main, main, s, &gift);
            }
            (false, _, false) => scatter_gift::<L, D, N, true, false>(main, main, s, &gift),
        }
    }
}

/// [`scatter_point`] for the points of a group, from row `first` on, which have the same nodes.
#[inline(always)]
#[allow(clippy::too_many_arguments)]
pub(super) unsafe fn scatter_one<
    P: Points,
    const D: usize,
    const N: usize,
    B: Basis<N>,
    T: Transfer,
>(
    pass: &Pass<D, B, T>,
    columns: &Columns<D>,
    group: &Group<P, D, N>,
    tile: &Tile<D>,
    first: usize,
    what: Scattered,
    main: *mut Node,
    force: *mut Node,
    gifts: &mut Gifts<P, D, N>,
) {
    let zero = P::splat(0.0);
    let mut moment = [[zero; D]; D];
    let mut pull = [[zero; D]; D];
    let mut hoop = zero;
    gifts.value = [zero; 4];
    // SAFETY: these rows belong to this block alone (module header of `stencil`)
    let mass = unsafe { columns.masses::<P>(first, P::LANES) };
    if what.momentum {
        // SAFETY: as above
        let velocity = unsafe { columns.velocities::<P>(first, P::LANES) };
        for c in 0..D {
            gifts.value[c] = velocity[c] * mass;
        }
        gifts.value[D] = mass;
        if T::AFFINE {
            // SAFETY: as above
            let affine = unsafe { columns.affines::<P>(first) };
            for a in 0..D {
                let inertia = mass * group.inertia[a].get();
                for c in 0..D {
                    moment[a][c] = affine[a][c] * inertia;
                }
            }
        }
    }
    if what.force {
        let dt = if T::CHANGE { 1.0 } else { pass.dt };
        let scale = mass * P::splat(-columns.specific_volume * dt);
        // SAFETY: as above
        let stress = unsafe { columns.stresses::<P>(first) };
        for a in 0..D {
            for c in 0..D {
                pull[a][c] = stress[a][c] * scale;
            }
        }
        if D == 2 && columns.axisymmetric {
            // SAFETY: as above
            unsafe {
                let radius = columns.positions::<P>(first, P::LANES)[0];
                hoop = scale * columns.hoop_stresses::<P>(first) / radius;
            }
        }
    }
    for a in 0..D {
        for i in 0..N {
            let (affine, slope): (P, P) = (group.affine[a][i].get(), group.slope[a][i].get());
            for c in 0..D {
                let mut slant = zero;
                if T::MOVING_LEAST_SQUARES {
                    slant = (moment[a][c] + pull[a][c]) * affine;
                } else {
                    if T::AFFINE && what.momentum {
                        slant = moment[a][c] * affine;
                    }
                    if what.force {
                        slant = pull[a][c].mul_add(slope, slant);
                    }
                }
                gifts.slant[a][i][c].set(slant);
            }
        }
    }
    // SAFETY: as the caller says
    unsafe {
        match (T::CHANGE, what.momentum, what.force) {
            (true, true, true) if !columns.axisymmetric => {
                scatter_same::<P, D, N, true, true>(main, force, group, tile, gifts);
            }
            (true, momentum, internal) => {
                if momentum {
                    scatter_same::<P, D, N, true, false>(main, main, group, tile, gifts);
                }
                if internal {
                    gifts.value = [zero; 4];
                    gifts.value[0] = hoop;
                    scatter_same::<P, D, N, false, true>(force, force, group, tile, gifts);
                }
            }
            (false, _, true) => {
                gifts.value[0] = gifts.value[0] + hoop;
                scatter_same::<P, D, N, false, true>(main, main, group, tile, gifts);
            }
            (false, _, false) if T::AFFINE => {
                scatter_same::<P, D, N, false, true>(main, main, group, tile, gifts);
            }
            (false, _, false) => {
                scatter_same::<P, D, N, true, false>(main, main, group, tile, gifts);
            }
        }
    }
}

/// The columns of a matrix.
#[inline(always)]
unsafe fn load_matrix<L: Lane, const D: usize>(from: *const Matrix<D>) -> [L; D] {
    let mut columns = [L::splat(0.0); D];
    for a in 0..D {
        // SAFETY: the caller vouches for a matrix, whose column a starts there
        columns[a] = unsafe { L::load_point::<D>(from.cast::<f64>().add(a * D)) };
    }
    columns
}

/// One where a node has its mass.
const fn unit<const D: usize>() -> [f64; 4] {
    let mut numbers = [0.0; 4];
    numbers[D] = 1.0;
    numbers
}

/// The same number D times, then zeros.
#[inline(always)]
fn first_numbers<const D: usize>(x: f64) -> [f64; 4] {
    match D {
        1 => [x, 0.0, 0.0, 0.0],
        2 => [x, x, 0.0, 0.0],
        _ => [x, x, x, 0.0],
    }
}

/// Adds a given force on each listed point of a block to `nodes`, N, as if it acted `offset` metres from the point: node I gets
/// the share N_I + offset · ∇N_I. The shares add up to one and their moment is that of the offset, as for N_I at the place
/// itself, but no node gets a force that the point has no part in: beyond a free face there is no mass to take it.
///
/// # Safety
/// As for [`scatter`].
#[inline(always)]
pub unsafe fn scatter_forces<L: Lane, const D: usize, const N: usize, B: Basis<N>, T: Transfer>(
    pass: &Pass<D, B, T>,
    columns: &Columns<D>,
    block: &Block<D>,
    edge: i32,
    nodes: *mut Node,
    offset: &Vector<D>,
    forces: &[(u32, Vector<D>)],
) {
    let tile = Tile::new(block, edge, N);
    let mut group = Group::<L, D, N>::new();
    let needs = Needs {
        slope: true,
        affine: false,
    };
    for (p, force) in forces {
        // SAFETY: row p belongs to this block alone (module header)
        let place = unsafe { columns.places::<L>(*p as usize, 1) };
        group.set::<B, T>(pass, &tile, &place, needs);
        let s = Stencil {
            group: &group,
            tile: &tile,
            q: 0,
        };
        // SAFETY: a vector has D numbers
        let value = unsafe { L::load_point::<D>(force.as_ptr()) };
        let mut gift = Gift {
            value,
            slant: [[L::splat(0.0); N]; D],
        };
        for a in 0..D {
            let moment = value * L::splat(offset[a]);
            for i in 0..N {
                gift.slant[a][i] = moment * s.splat(&group.slope[a][i]);
            }
        }
        // SAFETY: the tile holds every node of the stencil
        unsafe { scatter_gift::<L, D, N, false, true>(nodes, nodes, &s, &gift) };
    }
}
