//! From points to the grid.

use super::nodes::{lane, scatter_linear, scatter_value};
use super::{Columns, Pass, Stencil, Tile};
use crate::basis::Basis;
use crate::grid::{Block, Node};
use crate::math::{Vector, packed_len, unpack};
use crate::solver::lane::Lane;
use crate::transfer::Transfer;

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

/// Adds a given force on each listed point of a block to `nodes`, N, as if it acted `offset` metres from the point: node I gets
/// the share N_I + offset · ∇N_I. The shares add up to one and their moment is that of the offset, as for N_I at the place
/// itself, but no node gets a force that the point has no part in: beyond a free face there is no mass to take it.
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
    offset: &Vector<D>,
    forces: &[(u32, Vector<D>)],
) {
    let tile = Tile::new(block, edge, N);
    for (p, force) in forces {
        // SAFETY: row p belongs to this block alone (module header)
        let position = unsafe { *columns.position.add(*p as usize) };
        let s = pass.stencil::<N>(&tile, &position);
        let value = lane::<L, D>(&force.data.0[0]);
        let mut moments = [[L::splat(0.0); N]; D];
        for a in 0..D {
            for i in 0..N {
                moments[a][i] = value.mul(L::splat(offset[a] * s.slope[a][i]));
            }
        }
        // SAFETY: the tile holds every node of the stencil
        unsafe { add_point(nodes, &tile, &s, value, true, moments) };
    }
}
