//! From the corners of domains to the grid.

use super::domain::{Domain, side};
use crate::basis::Cpdi;
use crate::grid::{Block, Node};
use crate::math::{Vector, packed_len};
use crate::solver::lane::Lane;
use crate::solver::stencil::{Columns, Pass, Scattered, Tile};
use crate::transfer::Transfer;

use super::NODES;

/// What a point gives: the corner with the signs s gets `value + Σ_a s_a slant_a` for its nodes, and a node k cells from the
/// corner `Σ_a k_a field_a` more, all times the node's share.
struct Gift<L, const D: usize> {
    value: L,
    slant: [L; D],
    field: [L; D],
}

impl<L: Lane, const D: usize> Gift<L, D> {
    fn nothing() -> Self {
        let zero = L::splat(0.0);
        Self {
            value: zero,
            slant: [zero; D],
            field: [zero; D],
        }
    }

    /// Adds a field that is linear in x_i − x_p: that of the corners from their point, too.
    #[inline(always)]
    fn add_field(&mut self, domain: &Domain<D>, columns: &[L; D]) {
        for a in 0..D {
            self.field[a] = self.field[a] + columns[a];
            for b in 0..D {
                let edge = L::splat(domain.edges[(b, a)]);
                self.slant[a] = columns[b].mul_add(edge, self.slant[a]);
            }
        }
    }
}

/// [`scatter`](super::super::scatter) for points with domains.
///
/// # Safety
/// As there.
#[inline(always)]
pub(super) unsafe fn scatter<L: Lane, const D: usize, T: Transfer>(
    pass: &Pass<D, Cpdi, T>,
    columns: &Columns<D>,
    block: &Block<D>,
    edge: i32,
    what: Scattered,
    main: *mut Node,
    force: *mut Node,
) {
    let tile = Tile::new(block, edge, NODES);
    for p in block.points() {
        if p % 4 == 0 {
            columns.prefetch::<L>(p, T::AFFINE && what.momentum, what.force);
        }
        // SAFETY: the rows belong to this block alone (module header)
        unsafe {
            let domain = Domain::of(pass, columns, &tile, p);
            scatter_point::<L, D, T>(pass, columns, &tile, &domain, p, what, main, force);
        }
    }
}

/// What one point gives.
///
/// # Safety
/// As for [`scatter`].
#[inline(always)]
#[allow(clippy::too_many_arguments)]
pub(super) unsafe fn scatter_point<L: Lane, const D: usize, T: Transfer>(
    pass: &Pass<D, Cpdi, T>,
    columns: &Columns<D>,
    tile: &Tile<D>,
    domain: &Domain<D>,
    p: usize,
    what: Scattered,
    main: *mut Node,
    force: *mut Node,
) {
    let h = pass.cell_size;
    let mut gift = Gift::<L, D>::nothing();
    if what.momentum {
        // SAFETY: row p belongs to this block alone
        let (velocity, mass) = unsafe {
            (
                L::load_point::<D>(columns.velocity.add(p).cast()),
                columns.mass(p),
            )
        };
        let mut unit = [0.0; 4];
        unit[D] = 1.0;
        gift.value = (velocity + L::new(unit)) * L::splat(mass);
        if T::AFFINE {
            let mut moment = [L::splat(0.0); D];
            for a in 0..D {
                // SAFETY: as above; column a of a D × D matrix
                let column =
                    unsafe { L::load_point::<D>(columns.affine.add(p).cast::<f64>().add(a * D)) };
                moment[a] = column * L::splat(mass * h);
            }
            gift.add_field(domain, &moment);
        }
    }
    let mut internal = Gift::<L, D>::nothing();
    if what.force {
        // SAFETY: as above
        unsafe { pull::<L, D, T>(pass, columns, domain, p, &mut internal) };
    }
    // SAFETY: the tile holds every node of the stencil
    unsafe {
        if T::CHANGE {
            if what.momentum {
                give(main, tile, domain, &gift, T::AFFINE);
            }
            if what.force {
                give(force, tile, domain, &internal, T::MOVING_LEAST_SQUARES);
            }
        } else {
            gift.value = gift.value + internal.value;
            for a in 0..D {
                gift.slant[a] = gift.slant[a] + internal.slant[a];
                gift.field[a] = gift.field[a] + internal.field[a];
            }
            give(main, tile, domain, &gift, T::AFFINE);
        }
    }
}

/// The internal force of a point, N, or its impulse where the transfer wants that: the corner s gets −V τ G_c, with G_c = R⁻ᵀ s,
/// and the hoop force.
///
/// # Safety
/// The row exists, and no other thread uses it meanwhile.
#[inline(always)]
unsafe fn pull<L: Lane, const D: usize, T: Transfer>(
    pass: &Pass<D, Cpdi, T>,
    columns: &Columns<D>,
    domain: &Domain<D>,
    p: usize,
    gift: &mut Gift<L, D>,
) {
    let inverse_h = 1.0 / pass.cell_size;
    // SAFETY: as the caller says
    let (mass, stress) = unsafe {
        let stress = if columns.total {
            let mut stress = [L::splat(0.0); D];
            for a in 0..D {
                stress[a] = L::load_point::<D>(columns.first_piola.add(p).cast::<f64>().add(a * D));
            }
            stress
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
    let mut scales = [0.0; 4];
    scales[..D].fill(scale * inverse_h);
    let mut pull = [L::splat(0.0); D];
    for a in 0..D {
        pull[a] = stress[a] * L::new(scales);
    }
    if T::MOVING_LEAST_SQUARES {
        let fit = domain.inertia().inverse();
        let mut field = [L::splat(0.0); D];
        for a in 0..D {
            for b in 0..D {
                field[a] = pull[b].mul_add(L::splat(fit[(b, a)]), field[a]);
            }
        }
        gift.add_field(domain, &field);
    } else {
        for a in 0..D {
            for b in 0..D {
                let inverse = L::splat(domain.inverse[(a, b)]);
                gift.slant[a] = pull[b].mul_add(inverse, gift.slant[a]);
            }
        }
    }
    if D == 2 && columns.axisymmetric {
        // SAFETY: as the caller says
        let radial =
            unsafe { scale * *columns.hoop_stress.add(p) / (&*columns.position.add(p))[0] };
        gift.value = L::new([radial, 0.0, 0.0, 0.0]);
    }
}

/// Adds a point's gift to the nodes around each of its corners; without its field where there is none.
///
/// # Safety
/// `nodes` is an array of the grid with all of the tile's nodes, and no other thread adds to them meanwhile.
#[inline(always)]
unsafe fn give<L: Lane, const D: usize>(
    nodes: *mut Node,
    tile: &Tile<D>,
    domain: &Domain<D>,
    gift: &Gift<L, D>,
    field: bool,
) {
    for c in 0..Domain::<D>::CORNERS {
        let hats = domain.hats(c);
        let mut own = gift.value;
        for a in 0..D {
            own = gift.slant[a].mul_add(L::splat(side(c, a)), own);
            if field {
                own = own - gift.field[a] * L::splat(hats[a][1]);
            }
        }
        for j in 0..Domain::<D>::CORNERS / 2 {
            let mut share = 1.0 / Domain::<D>::CORNERS as f64;
            let mut here = own;
            for a in 0..D - 1 {
                let k = j >> (D - 2 - a) & 1;
                share *= hats[a][k];
                if field && k == 1 {
                    here = here + gift.field[a];
                }
            }
            // SAFETY: as the caller says; a corner's row has two nodes
            unsafe {
                let node = domain.row(nodes, tile, c, j);
                let [first, second] = hats[D - 1].map(|hat| L::splat(share * hat));
                here.mul_add(first, L::load(node)).store(node);
                if field {
                    here = here + gift.field[D - 1];
                }
                let node = node.add(4);
                here.mul_add(second, L::load(node)).store(node);
            }
        }
    }
}

/// [`scatter_forces`](super::super::scatter_forces) for points with domains: an offset is part of the domain and deforms with it. A
/// force on a face of a point goes to the corners of that face.
///
/// # Safety
/// As there.
pub(super) unsafe fn scatter_forces<L: Lane, const D: usize, T>(
    pass: &Pass<D, Cpdi, T>,
    columns: &Columns<D>,
    block: &Block<D>,
    edge: i32,
    nodes: *mut Node,
    offset: &Vector<D>,
    forces: &[(u32, Vector<D>)],
) {
    let tile = Tile::new(block, edge, NODES);
    for (p, force) in forces {
        let mut gift = Gift::<L, D>::nothing();
        // SAFETY: a vector has D numbers
        gift.value = unsafe { L::load_point::<D>(force.as_ptr()) };
        for a in 0..D {
            let half = pass.basis[a].half_width() * pass.cell_size;
            gift.slant[a] = gift.value * L::splat(offset[a] / half);
        }
        // SAFETY: row p belongs to this block alone; the tile holds every node of the stencil
        unsafe {
            let domain = Domain::of(pass, columns, &tile, *p as usize);
            give(nodes, &tile, &domain, &gift, false);
        }
    }
}
