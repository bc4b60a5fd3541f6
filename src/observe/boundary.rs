//! `boundary_<name>.csv`: what a boundary does to the bodies.

use super::{Observer, View, components, numbers};

/// Reaction of one boundary in the last step, N, and the impulse that it has given since the start, N s.
pub struct ReactionTable {
    /// Its index.
    pub boundary: usize,
    /// Its name.
    pub name: String,
}

impl<const D: usize> Observer<D> for ReactionTable {
    fn name(&self) -> String {
        format!("boundary_{}", self.name)
    }

    fn header(&self) -> Vec<String> {
        std::iter::once("time".to_string())
            .chain(components::<D>("reaction"))
            .chain(components::<D>("impulse"))
            .collect()
    }

    fn row(&self, view: &View<'_, D>) -> Vec<f64> {
        std::iter::once(view.state.time)
            .chain(numbers(&view.ledger.reactions[self.boundary]))
            .chain(numbers(&view.ledger.impulse(self.boundary)))
            .collect()
    }
}
