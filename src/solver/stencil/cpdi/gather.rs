//! From the grid to points, by the corners of their domains.

use super::NODES;
use super::domain::{Domain, side};
use super::scatter::scatter_point;
use crate::basis::Cpdi;
use crate::grid::{Block, Node};
use crate::solver::lane::Lane;
use crate::solver::stencil::{
    Columns, Gathered, Pass, Rates, Reach, Scattered, Sources, Tile, Wanted,
};
use crate::tensor::Tensor;
use crate::transfer::Transfer;

/// The velocities at the corners of a domain.
struct Taken<L, const D: usize> {
    /// Their mean.
    value: L,
    /// The mean of s_a times them.
    slant: [L; D],
    /// The mean of Σ_i N_i (x_i − x_c) v_i, in cells m/s; not set where nobody asked.
    moment: [L; D],
}

impl<L: Lane, const D: usize> Taken<L, D> {
    /// Columns of the velocity gradient Σ v_i ∇φ_iᵀ, the mean of v_c G_cᵀ = v_c (R⁻ᵀ s)ᵀ, times the size of a cell.
    #[inline(always)]
    fn gradient(&self, domain: &Domain<D>) -> [L; D] {
        times(&self.slant, &domain.inverse)
    }

    /// Columns of APIC's C = B D⁻¹ with B = Σ φ_i v_i (x_i − x_p)ᵀ, times the size of a cell.
    #[inline(always)]
    fn fit(&self, domain: &Domain<D>) -> [L; D] {
        let mut b = times(&self.slant, &domain.edges.transpose());
        for a in 0..D {
            b[a] = b[a] + self.moment[a];
        }
        times(&b, &domain.inertia().inverse())
    }
}

/// The columns of a product, from those of the left matrix.
#[inline(always)]
fn times<L: Lane, const D: usize>(columns: &[L; D], matrix: &Tensor<f64, D>) -> [L; D] {
    let mut product = [L::splat(0.0); D];
    for a in 0..D {
        for b in 0..D {
            product[a] = columns[b].mul_add(L::splat(matrix[(b, a)]), product[a]);
        }
    }
    product
}

/// What the nodes around the corners of a domain hold, with moments if `moments`.
///
/// # Safety
/// `nodes` is an array of the grid with all of the tile's nodes, and nobody writes to it meanwhile.
#[inline(always)]
unsafe fn take<L: Lane, const D: usize>(
    nodes: *const Node,
    tile: &Tile<D>,
    domain: &Domain<D>,
    moments: bool,
) -> Taken<L, D> {
    let zero = L::splat(0.0);
    let mut taken = Taken {
        value: zero,
        slant: [zero; D],
        moment: [zero; D],
    };
    for c in 0..Domain::<D>::CORNERS {
        let hats = domain.hats(c);
        let mut corner = zero;
        let mut beyond = [zero; D];
        for j in 0..Domain::<D>::CORNERS / 2 {
            let mut share = 1.0 / Domain::<D>::CORNERS as f64;
            for a in 0..D - 1 {
                share *= hats[a][j >> (D - 2 - a) & 1];
            }
            let [first, second] = hats[D - 1].map(|hat| L::splat(share * hat));
            // SAFETY: as the caller says; a corner's row has two nodes
            let (near, far) = unsafe {
                let node = domain.row(nodes.cast_mut(), tile, c, j);
                (L::load(node) * first, L::load(node.add(4)) * second)
            };
            let both = near + far;
            corner = corner + both;
            if moments {
                for a in 0..D - 1 {
                    if j >> (D - 2 - a) & 1 == 1 {
                        beyond[a] = beyond[a] + both;
                    }
                }
                beyond[D - 1] = beyond[D - 1] + far;
            }
        }
        taken.value = taken.value + corner;
        for a in 0..D {
            taken.slant[a] = corner.mul_add(L::splat(side(c, a)), taken.slant[a]);
            if moments {
                // of the nodes one cell on, less that of all nodes from the corner's own place
                let own = beyond[a] - corner * L::splat(hats[a][1]);
                taken.moment[a] = taken.moment[a] + own;
            }
        }
    }
    taken
}

/// [`gather`](super::super::gather) for points with domains, which are carried along when the points move.
///
/// # Safety
/// As there.
#[inline(always)]
#[allow(clippy::too_many_arguments)]
pub(super) unsafe fn gather<L: Lane, const D: usize, T: Transfer>(
    pass: &Pass<D, Cpdi, T>,
    columns: &Columns<D>,
    tile: &Tile<D>,
    reach: &Reach<D>,
    rows: std::ops::Range<usize>,
    what: Wanted,
    sources: &Sources,
    rates: &mut Rates<D>,
) -> Gathered {
    let mut sums = Gathered::NONE;
    let per_metre = L::splat(pass.inverse_size);
    let deforms = what.position && columns.convected;
    for p in rows.clone() {
        let at = p - rows.start;
        if p % 4 == 0 {
            columns.prefetch::<L>(p, T::AFFINE && what.velocity, false);
        }
        // SAFETY: the tile holds every node of the stencil, and the row belongs to this block alone (module header)
        unsafe {
            let domain = Domain::of(pass, columns, tile, p);
            let fits = T::AFFINE && !T::TAYLOR;
            let mut strained = None;
            let mut moving = L::splat(0.0);
            if what.velocity || deforms || (what.position && T::CHANGE) || (what.rate && what.same)
            {
                let moments = fits && (what.velocity || (what.rate && what.same));
                let taken = take::<L, D>(sources.main, tile, &domain, moments);
                moving = taken.value;
                if what.velocity {
                    give_velocity::<L, D, T>(
                        pass, columns, tile, &domain, p, &taken, sources, &mut sums,
                    );
                }
                if deforms {
                    deform(columns, &domain, p, &taken, pass.dt * pass.inverse_size);
                }
                strained = Some(taken);
            }
            if what.rate {
                let taken = match strained {
                    Some(taken) if what.same => taken,
                    _ => take(sources.second, tile, &domain, T::MOVING_LEAST_SQUARES),
                };
                let mut gradient = if T::MOVING_LEAST_SQUARES {
                    taken.fit(&domain)
                } else {
                    taken.gradient(&domain)
                };
                for a in 0..D {
                    gradient[a] = gradient[a] * per_metre;
                }
                rates.set(at, &gradient);
                if D == 2 && columns.axisymmetric {
                    let radius = (&*columns.position.add(p))[0];
                    let rate = L::splat(taken.value.lane(0) / radius);
                    columns.stretch_hoops(p, 1, rate, pass.dt, rates.hoops_from(at));
                }
            }
            if what.position {
                if !what.velocity && !T::CHANGE {
                    // the velocity that the point took from these nodes
                    moving = L::load_point::<D>(columns.velocity.add(p).cast());
                }
                let position = &mut *columns.position.add(p);
                for a in 0..D {
                    position[a] += pass.dt * moving.lane(a);
                }
                sums.within &= if columns.total {
                    position.iter().all(|x| x.is_finite())
                } else {
                    reach.holds(&pass.in_cells(position))
                };
            }
        }
    }
    sums
}

/// Gives a point its new velocity and affine field, and counts it.
///
/// # Safety
/// As for [`gather`].
#[inline(always)]
#[allow(clippy::too_many_arguments)]
unsafe fn give_velocity<L: Lane, const D: usize, T: Transfer>(
    pass: &Pass<D, Cpdi, T>,
    columns: &Columns<D>,
    tile: &Tile<D>,
    domain: &Domain<D>,
    p: usize,
    taken: &Taken<L, D>,
    sources: &Sources,
    sums: &mut Gathered,
) {
    // SAFETY: as the caller says
    unsafe {
        let mut velocity = taken.value;
        if T::CHANGE {
            let old = L::load_point::<D>(columns.velocity.add(p).cast());
            let change = take::<L, D>(sources.change, tile, domain, false).value;
            velocity = pass.transfer.velocity(old, taken.value, change);
        }
        let new = &mut *columns.velocity.add(p);
        let mut square = 0.0;
        for a in 0..D {
            new[a] = velocity.lane(a);
            square += new[a] * new[a];
        }
        sums.kinetic += 0.5 * columns.mass(p) * square;
        // `max` would hide a velocity that is not a number
        sums.within &= square.is_finite();
        sums.speed_squared = sums.speed_squared.max(square);
        if T::AFFINE {
            let mut field = if T::TAYLOR {
                taken.gradient(domain)
            } else {
                taken.fit(domain)
            };
            for a in 0..D {
                field[a] = field[a] * (1.0 / pass.cell_size);
            }
            L::store_matrix::<D>(&field, columns.affine.add(p).cast());
        }
    }
}

/// Carries a domain along with the velocities of its corners: F ← (I + Δt Σ v_i ∇φ_iᵀ) F. `step` is Δt over the size of a cell.
///
/// # Safety
/// The row exists, and no other thread uses it meanwhile.
#[inline(always)]
unsafe fn deform<L: Lane, const D: usize>(
    columns: &Columns<D>,
    domain: &Domain<D>,
    p: usize,
    taken: &Taken<L, D>,
    step: f64,
) {
    // SAFETY: as the caller says
    let f = unsafe { columns.domain(p) };
    let start = Tensor::from(*f);
    let change = times(&taken.gradient(domain), &start);
    for a in 0..D {
        for i in 0..D {
            f[(i, a)] = start[(i, a)] + step * change[a].lane(i);
        }
    }
}

/// [`exchange`](super::super::exchange) for points with domains.
///
/// # Safety
/// As there.
#[inline(always)]
pub(super) unsafe fn exchange<L: Lane, const D: usize, T: Transfer>(
    pass: &Pass<D, Cpdi, T>,
    columns: &Columns<D>,
    block: &Block<D>,
    edge: i32,
    sources: &Sources,
    second: *mut Node,
) -> Gathered {
    let tile = Tile::new(block, edge, NODES);
    let mut sums = Gathered::NONE;
    for p in block.points() {
        // SAFETY: as in `gather`, and as in `scatter`
        unsafe {
            let domain = Domain::of(pass, columns, &tile, p);
            let taken = take(sources.main, &tile, &domain, T::AFFINE && !T::TAYLOR);
            give_velocity::<L, D, T>(pass, columns, &tile, &domain, p, &taken, sources, &mut sums);
            let what = Scattered::MOMENTUM;
            scatter_point::<L, D, T>(pass, columns, &tile, &domain, p, what, second, second);
        }
    }
    sums
}
