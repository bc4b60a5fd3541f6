//! `probe_<name>.csv`: one material point.

use super::{Observer, View, components, numbers};

/// Position, velocity, Cauchy stress and what the law remembers of one point.
pub struct ProbeTable {
    /// Index of its body.
    pub body: usize,
    /// Number of the point.
    pub particle: u32,
    /// Name of the probe.
    pub name: String,
    /// Names of what the law remembers.
    pub memory: Vec<String>,
    /// Whether there is a hoop stress.
    pub axisymmetric: bool,
}

const AXES: [&str; 3] = ["x", "y", "z"];

impl<const D: usize> Observer<D> for ProbeTable {
    fn name(&self) -> String {
        format!("probe_{}", self.name)
    }

    fn header(&self) -> Vec<String> {
        let stresses = (0..D)
            .map(|a| (a, a))
            .chain((0..D).flat_map(|a| (a + 1..D).map(move |b| (a, b))));
        std::iter::once("time".to_string())
            .chain(components::<D>("position"))
            .chain(components::<D>("velocity"))
            .chain(stresses.map(|(a, b)| format!("stress_{}{}", AXES[a], AXES[b])))
            .chain(self.axisymmetric.then(|| "stress_hoop".to_string()))
            .chain(self.memory.iter().cloned())
            .collect()
    }

    fn row(&self, view: &View<'_, D>) -> Vec<f64> {
        let body = &view.state.bodies[self.body];
        let mut row = vec![view.state.time];
        let Some(p) = body.particles.row_of(self.particle) else {
            return row;
        };
        row.extend(numbers(&body.particles.position[p]));
        row.extend(numbers(&body.particles.velocity[p]));
        let stress = body.cauchy_stress(p);
        row.extend((0..D).map(|a| stress[(a, a)]));
        row.extend((0..D).flat_map(|a| (a + 1..D).map(move |b| stress[(a, b)])));
        if self.axisymmetric {
            let stretch = body.particles.hoop_stretch(p);
            row.push(body.particles.hoop_stress[p] / body.material.volume_ratio(p, stretch));
        }
        body.material.memory_values(p, &mut row);
        row
    }
}
