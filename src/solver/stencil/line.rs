//! The innermost loops in 1D. A node holds one component and its mass there, too little to fill a lane: so four points are
//! taken together, and what they give to their nodes is added in their order.

use super::group::{Group, Kept, Rows};
use super::same::more;
use super::scatter::Scattered;
use super::{Columns, Pass, Tile};
use crate::grid::Node;
use crate::solver::lane::Lane;
use crate::transfer::Transfer;

/// A function of four points at each of their nodes.
#[inline(always)]
fn lanes<L: Lane, const N: usize>(numbers: &[Kept<L>; N]) -> [L; N] {
    let mut lanes = [L::splat(0.0); N];
    for i in 0..N {
        lanes[i] = numbers[i].get();
    }
    lanes
}

/// The first nodes of the stencils of four points, for an array that starts at `nodes`.
#[inline(always)]
fn starts<L: Lane, const D: usize, const N: usize>(
    nodes: *mut Node,
    group: &Group<L, D, N>,
    tile: &Tile<D>,
) -> [*mut Node; 4] {
    // SAFETY: every tile has a first row
    let row = nodes.wrapping_byte_offset(unsafe { tile.row(0) });
    let mut starts = [row; 4];
    for q in 0..4 {
        starts[q] = row.wrapping_add(group.node[q] as usize);
    }
    starts
}

/// The numbers of node k after each of four.
#[inline(always)]
fn after(starts: &[*mut Node; 4], k: usize) -> [*mut f64; 4] {
    let mut nodes = [starts[0].cast(); 4];
    for q in 0..4 {
        nodes[q] = starts[q].wrapping_add(k).cast();
    }
    nodes
}

/// What [`gather_same`](super::same::gather_same) says, in 1D.
///
/// # Safety
/// The tile addresses stored nodes only (module header of `stencil`).
#[inline(always)]
pub(super) unsafe fn gather_four<L: Lane, const D: usize, const N: usize, const M: usize>(
    nodes: *const Node,
    group: &Group<L, D, N>,
    tile: &Tile<D>,
    g: [&[[Kept<L>; N]; D]; M],
    absent: bool,
) -> ([L; D], [[[L; D]; D]; M]) {
    let zero = L::splat(0.0);
    let starts = starts(nodes.cast_mut(), group, tile);
    let weight: [L; N] = lanes(&group.weight[0]);
    let mut function = [[zero; N]; M];
    for m in 0..M {
        function[m] = lanes(&g[m][0]);
    }
    let mut value = zero;
    let mut gradient = [[[zero; D]; D]; M];
    let mut present = [zero; M];
    for k in 0..N {
        // SAFETY: as the caller says
        let [velocity, there] =
            unsafe { L::load_pairs(after(&starts, k).map(|node| node.cast_const())) };
        value = more(k, weight[k], velocity, value);
        for m in 0..M {
            gradient[m][0][0] = more(k, function[m][k], velocity, gradient[m][0][0]);
            if absent {
                present[m] = more(k, function[m][k], there, present[m]);
            }
        }
    }
    if absent {
        for m in 0..M {
            gradient[m][0][0] = (-present[m]).mul_add(value, gradient[m][0][0]);
        }
    }
    ([value; D], gradient)
}

/// What [`scatter_point`](super::scatter::scatter_point) says, for four points. Points that there are not have no mass and no
/// force, and stand where the last one does: they add zeros to its nodes.
///
/// # Safety
/// As for [`scatter`](super::scatter()); the functions of the points are those in `group`.
#[inline(always)]
#[allow(clippy::too_many_arguments)]
pub(super) unsafe fn scatter_four<L: Lane, const D: usize, const N: usize, B, T: Transfer>(
    pass: &Pass<D, B, T>,
    columns: &Columns<D>,
    group: &Group<L, D, N>,
    tile: &Tile<D>,
    rows: Rows,
    what: Scattered,
    main: *mut Node,
    force: *mut Node,
) {
    let Rows { first, count } = rows;
    let zero = L::splat(0.0);
    let (mut mass, mut momentum, mut moment, mut pull) = (zero, zero, zero, zero);
    // SAFETY: these rows belong to this block alone (module header of `stencil`)
    unsafe {
        if what.momentum {
            mass = columns.masses::<L>(first, count);
            momentum = columns.velocities::<L>(first, count)[0] * mass;
            if T::AFFINE {
                let inertia: L = group.inertia[0].get();
                moment = columns.line_affines::<L>(first, count) * (mass * inertia);
            }
        }
        if what.force {
            let scale = if T::CHANGE {
                -columns.specific_volume
            } else {
                -columns.specific_volume * pass.dt
            };
            let mass = columns.masses::<L>(first, count);
            pull = columns.line_stresses::<L>(first, count) * (mass * scale);
        }
    }
    let weight: [L; N] = lanes(&group.weight[0]);
    let mut slant = [zero; N];
    for k in 0..N {
        let (affine, slope): (L, L) = (group.affine[0][k].get(), group.slope[0][k].get());
        if T::MOVING_LEAST_SQUARES {
            slant[k] = (moment + pull) * affine;
            continue;
        }
        if T::AFFINE && what.momentum {
            slant[k] = moment * affine;
        }
        if what.force {
            slant[k] = pull.mul_add(slope, slant[k]);
        }
    }
    // SAFETY: the tile addresses stored nodes only, and they are this block's alone (module header of `stencil`)
    unsafe {
        if what.momentum {
            let nodes = starts(main, group, tile);
            for k in 0..N {
                let mut given = momentum * weight[k];
                if !T::CHANGE && (T::AFFINE || what.force) {
                    given = momentum.mul_add(weight[k], slant[k]);
                }
                L::add_pairs([given, mass * weight[k]], after(&nodes, k));
            }
        }
        if what.force && (T::CHANGE || !what.momentum) {
            let nodes = starts(if T::CHANGE { force } else { main }, group, tile);
            for k in 0..N {
                L::add_pairs([slant[k], zero], after(&nodes, k));
            }
        }
    }
}
