//! `body_<name>.csv`: a body as a whole.

use super::{Observer, View, components, numbers};

/// Mass-weighted means, momenta, mass and volume of one body.
pub struct BodyTable {
    /// Its index.
    pub body: usize,
    /// Its name.
    pub name: String,
}

impl<const D: usize> Observer<D> for BodyTable {
    fn name(&self) -> String {
        format!("body_{}", self.name)
    }

    fn header(&self) -> Vec<String> {
        let spins: &[&str] = match D {
            1 => &[],
            2 => &["angular_momentum_z"],
            _ => &[
                "angular_momentum_x",
                "angular_momentum_y",
                "angular_momentum_z",
            ],
        };
        std::iter::once("time".to_string())
            .chain(components::<D>("position"))
            .chain(components::<D>("velocity"))
            .chain(components::<D>("momentum"))
            .chain(["mass", "volume"].map(String::from))
            .chain(spins.iter().map(|name| name.to_string()))
            .collect()
    }

    fn row(&self, view: &View<'_, D>) -> Vec<f64> {
        let totals = &view.totals[self.body];
        std::iter::once(view.state.time)
            .chain(numbers(&totals.position))
            .chain(numbers(&(totals.momentum / totals.mass)))
            .chain(numbers(&totals.momentum))
            .chain([totals.mass, totals.volume])
            .chain(view.spin[self.body].iter().copied())
            .collect()
    }
}
