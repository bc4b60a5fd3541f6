//! `energy.csv`: the energy account.

use super::{Observer, View};

/// Stored energies, what went in and out since the start, and the residual, J.
pub struct EnergyTable {
    /// Whether the scene has loads.
    pub loads: bool,
    /// Whether the scene has boundaries.
    pub boundaries: bool,
    /// Whether the scene is damped.
    pub damping: bool,
}

impl<const D: usize> Observer<D> for EnergyTable {
    fn name(&self) -> String {
        "energy".into()
    }

    fn header(&self) -> Vec<String> {
        let optional = [
            (self.damping, "damping"),
            (true, "numerical"),
            (self.loads, "external_work"),
            (self.boundaries, "boundary_work"),
        ];
        ["time", "step", "kinetic", "elastic", "potential"]
            .into_iter()
            .chain(
                optional
                    .into_iter()
                    .filter(|(there, _)| *there)
                    .map(|(_, name)| name),
            )
            .chain(["total", "residual"])
            .map(String::from)
            .collect()
    }

    fn row(&self, view: &View<'_, D>) -> Vec<f64> {
        let account = &view.account;
        let stored = &account.stored;
        let optional = [
            (self.damping, account.damping),
            (true, account.numerical),
            (self.loads, account.external_work),
            (self.boundaries, account.boundary_work),
        ];
        [
            view.state.time,
            view.state.step as f64,
            stored.kinetic,
            stored.elastic,
            stored.potential,
        ]
        .into_iter()
        .chain(
            optional
                .into_iter()
                .filter(|(there, _)| *there)
                .map(|(_, value)| value),
        )
        .chain([account.total, account.residual])
        .collect()
    }
}
