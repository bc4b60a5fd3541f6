//! Changes of volume that are taken at the middle of the cell: `Basis::dilation_at_centre`.

use super::group::Group;
use super::nodes::{Gift, Stencil, gather_linear, scatter_gift, without_absent};
use super::{Columns, Pass, Tile};
use crate::basis::Basis;
use crate::grid::Node;
use crate::math::Matrix;
use crate::solver::lane::Lane;
use crate::tensor::Tensor;

/// The functions at the middle of a cell, and the nodes of those in which four points are.
pub(super) struct Centre<L, const D: usize, const N: usize> {
    group: Group<L, D, N>,
    /// Whether the basis wants any of this.
    pub used: bool,
}

impl<L: Lane, const D: usize, const N: usize> Centre<L, D, N> {
    /// The middle of no cell yet.
    #[inline(always)]
    pub(super) fn new<B: Basis<N>, T>(pass: &Pass<D, B, T>) -> Self {
        let mut group = Group::new();
        let used = D > 1 && pass.basis[0].dilation_at_centre();
        if used {
            for a in 0..D {
                let middle = pass.basis[a].functions(L::splat(0.5));
                for i in 0..N {
                    group.weight[a][i].set(middle.weight[i]);
                    group.slope[a][i].set(middle.slope[i] / pass.cell_size);
                }
            }
        }
        Self { group, used }
    }

    /// The middles of the cells in which these points are.
    #[inline(always)]
    pub(super) fn set(&mut self, points: &Group<L, D, N>) {
        (self.group.row, self.group.node) = (points.row, points.node);
    }

    fn stencil<'a>(&'a self, tile: &'a Tile<D>, q: usize) -> Stencil<'a, L, D, N> {
        Stencil {
            group: &self.group,
            tile,
            q,
        }
    }

    /// L̄ of point `p`, the `q`th of four, in place of its L; in the total frame of Ḟ̄ = Ḟ + δ F in place of Ḟ.
    ///
    /// # Safety
    /// As for `gather`; the velocities are those that gave L.
    #[inline(always)]
    pub(super) unsafe fn dilate(
        &self,
        columns: &Columns<D>,
        tile: &Tile<D>,
        p: usize,
        q: usize,
        velocities: *const Node,
        gradient: &mut [L; D],
    ) {
        let s = self.stencil(tile, q);
        // SAFETY: as the caller says; the middle of a cell has the nodes that the points in it have
        unsafe {
            let (value, [mut middle]) =
                gather_linear::<L, D, N, 1>(velocities, &s, [&self.group.slope]);
            without_absent(value, &mut middle);
            let (f, inverse) = volume_change::<L, D>(columns, p);
            let mut difference = [L::splat(0.0); D];
            for a in 0..D {
                difference[a] = middle[a] - gradient[a];
            }
            let rate = L::splat(contract(&difference, &inverse) / D as f64);
            for a in 0..D {
                gradient[a] = f[a].mul_add(rate, gradient[a]);
            }
        }
    }

    /// Takes from −V₀ τ of point `p`, the `q`th of four, its mean part (in the total frame from −V₀ P the part that goes with the
    /// volume), and gives `nodes` the force of it at the middle of the cell.
    ///
    /// # Safety
    /// As for `scatter`.
    #[inline(always)]
    pub(super) unsafe fn press(
        &self,
        columns: &Columns<D>,
        tile: &Tile<D>,
        p: usize,
        q: usize,
        nodes: *mut Node,
        pull: &mut [L; D],
    ) {
        let s = self.stencil(tile, q);
        let zero = L::splat(0.0);
        let mut gift = Gift {
            value: zero,
            slant: [[zero; N]; D],
        };
        // SAFETY: as the caller says
        unsafe {
            let (f, inverse) = volume_change::<L, D>(columns, p);
            let mean = L::splat(contract(pull, &f) / D as f64);
            for a in 0..D {
                let pressure = inverse[a] * mean;
                pull[a] = pull[a] - pressure;
                for i in 0..N {
                    gift.slant[a][i] = pressure * s.splat(&self.group.slope[a][i]);
                }
            }
            scatter_gift::<L, D, N, false, true>(nodes, nodes, &s, &gift);
        }
    }
}

/// The columns of F and of F⁻ᵀ: what a rate of volume change δ adds to Ḟ is δ F, and δ = F⁻ᵀ : Ḟ; I where the grid is that of the
/// present positions.
#[inline(always)]
unsafe fn volume_change<L: Lane, const D: usize>(
    columns: &Columns<D>,
    p: usize,
) -> ([L; D], [L; D]) {
    let mut f = Matrix::<D>::identity();
    let mut inverse = f;
    if columns.total {
        // SAFETY: the caller vouches for row p
        f = unsafe { columns.deformation(p) };
        let tensor = Tensor::<f64, D>::from(f).inverse();
        inverse = Matrix::from_fn(|i, a| tensor[(a, i)]);
    }
    let lanes = |m: &Matrix<D>| {
        let mut columns = [L::splat(0.0); D];
        for a in 0..D {
            // SAFETY: column a of a D × D matrix
            columns[a] = unsafe { L::load_point::<D>(m.as_ptr().add(a * D)) };
        }
        columns
    };
    (lanes(&f), lanes(&inverse))
}

/// A : B, from their columns.
#[inline(always)]
fn contract<L: Lane, const D: usize>(a: &[L; D], b: &[L; D]) -> f64 {
    let mut sum = a[0] * b[0];
    for k in 1..D {
        sum = a[k].mul_add(b[k], sum);
    }
    let sum = sum.array();
    (0..D).map(|i| sum[i]).sum()
}
