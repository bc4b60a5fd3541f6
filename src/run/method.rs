//! From the names of a basis and a transfer to their types: the only place where every combination of dimension, basis and
//! transfer is compiled.

use crate::basis::{Basis, BasisVisitor, Cpdi};
use crate::grid::Geometry;
use crate::math::Vector;
use crate::scenario::Scenario;
use crate::solver::{Domains, Kernels, Stencils};
use crate::state::State;
use crate::transfer::{Transfer, TransferVisitor};
use std::any::Any;

/// What depends on the types of the basis and the transfer.
pub(super) struct Method<const D: usize> {
    /// The grid.
    pub geometry: Geometry<D>,
    /// The kernels.
    pub kernels: Box<dyn Kernels<D>>,
}

/// The grid and the kernels of a scene.
///
/// The three functions that it chooses from are not generic, so that their many kernels are compiled with this crate and not
/// again with every program that builds a scene.
pub(super) fn method<const D: usize>(scenario: &Scenario, state: &State<D>) -> Method<D> {
    let spacings: Vec<[f64; 3]> = state
        .bodies
        .iter()
        .map(|body| std::array::from_fn(|a| if a < D { body.spacing[a] } else { 1.0 }))
        .collect();
    let method: Box<dyn Any> = match D {
        1 => Box::new(method_1d(scenario, &spacings)),
        2 => Box::new(method_2d(scenario, &spacings)),
        _ => Box::new(method_3d(scenario, &spacings)),
    };
    match method.downcast() {
        Ok(method) => *method,
        Err(_) => unreachable!("a scene has 1, 2 or 3 dimensions"),
    }
}

fn method_1d(scenario: &Scenario, spacings: &[[f64; 3]]) -> Method<1> {
    scenario
        .method
        .basis
        .visit(WithBasis { scenario, spacings })
}

fn method_2d(scenario: &Scenario, spacings: &[[f64; 3]]) -> Method<2> {
    scenario
        .method
        .basis
        .visit(WithBasis { scenario, spacings })
}

fn method_3d(scenario: &Scenario, spacings: &[[f64; 3]]) -> Method<3> {
    scenario
        .method
        .basis
        .visit(WithBasis { scenario, spacings })
}

struct WithBasis<'a, const D: usize> {
    scenario: &'a Scenario,
    /// Distance between the points of each body, m.
    spacings: &'a [[f64; 3]],
}

impl<const D: usize> BasisVisitor for WithBasis<'_, D> {
    type Output = Method<D>;

    fn visit<const N: usize, B: Basis<N>>(self, basis: B) -> Self::Output {
        self.scenario
            .method
            .transfer
            .visit(WithTransfer::<D, N, B> { scene: self, basis })
    }

    fn visit_domains<const N: usize, B: Basis<N>>(self, basis: B) -> Self::Output {
        let geometry = geometry(self.scenario, &basis);
        let WithBasis { scenario, spacings } = self;
        let transfer = scenario.method.transfer;
        transfer.visit(WithDomains { geometry, spacings })
    }
}

/// The grid as a basis numbers its nodes.
fn geometry<const D: usize, const N: usize, B: Basis<N>>(
    scenario: &Scenario,
    basis: &B,
) -> Geometry<D> {
    let grid = &scenario.grid;
    let min = Vector::from_fn(|a, _| grid.min[a]);
    let cells = std::array::from_fn(|a| grid.cells[a]);
    Geometry::new(min, grid.cell_size, cells, basis)
}

/// The bases of each body along each axis, for its points' distances, m.
fn of_bodies<const D: usize, const N: usize, B: Basis<N>>(
    basis: &B,
    spacings: &[[f64; 3]],
    cell_size: f64,
) -> Vec<[B; D]> {
    let of_body =
        |spacing: &[f64; 3]| std::array::from_fn(|a| basis.for_spacing(spacing[a] / cell_size));
    spacings.iter().map(of_body).collect()
}

struct WithDomains<'a, const D: usize> {
    geometry: Geometry<D>,
    spacings: &'a [[f64; 3]],
}

impl<const D: usize> TransferVisitor for WithDomains<'_, D> {
    type Output = Method<D>;

    fn visit<T: Transfer>(self, transfer: T) -> Self::Output {
        let Self { geometry, spacings } = self;
        Method {
            kernels: Box::new(Domains::<D, T> {
                basis: of_bodies(&Cpdi::default(), spacings, geometry.cell_size),
                transfer,
            }),
            geometry,
        }
    }
}

struct WithTransfer<'a, const D: usize, const N: usize, B> {
    scene: WithBasis<'a, D>,
    basis: B,
}

impl<const D: usize, const N: usize, B: Basis<N>> TransferVisitor for WithTransfer<'_, D, N, B> {
    type Output = Method<D>;

    fn visit<T: Transfer>(self, transfer: T) -> Self::Output {
        let WithBasis { scenario, spacings } = self.scene;
        let basis = self.basis;
        Method {
            geometry: geometry(scenario, &basis),
            kernels: Box::new(Stencils::<D, N, B, T> {
                nodes: basis,
                basis: of_bodies(&basis, spacings, scenario.grid.cell_size),
                transfer,
            }),
        }
    }
}
