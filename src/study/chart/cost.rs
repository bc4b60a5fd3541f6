//! What a run costs, counted in a way that no machine changes.

use crate::basis::{Basis, BasisVisitor};
use crate::scenario::{ReferenceFrame, Scenario, Scheme};

/// How often a step visits the stencil of every point: update stress last scatters and gathers once; the others map momenta (or
/// forces) and gather velocities a second time. Loads are not counted: they are the same for all methods.
pub fn passes(update: Scheme) -> u32 {
    match update {
        Scheme::UpdateStressLast => 2,
        Scheme::UpdateStressFirst | Scheme::ModifiedUpdateStressLast => 4,
    }
}

/// Passes more that the terms of a transfer take: for each but the first, from the grid to the points and back.
pub fn term_passes(scenario: &Scenario) -> u32 {
    2 * (scenario.method.transfer.terms() - 1)
}

/// How many nodes a point meets in a pass: nᵈ for n functions an axis; of a domain each of the 2ᵈ corners meets 2ᵈ nodes.
pub fn stencil_nodes(scenario: &Scenario) -> u64 {
    struct Nodes;
    impl BasisVisitor for Nodes {
        type Output = u64;

        fn visit<const N: usize, B: Basis<N>>(self, _: B) -> u64 {
            N as u64
        }

        // two ends an axis, each of which knows two nodes
        fn visit_domains<const N: usize, B: Basis<N>>(self, _: B) -> u64 {
            4
        }
    }
    scenario
        .method
        .basis
        .visit(Nodes)
        .pow(scenario.dimension as u32)
}

/// What the total Lagrangian frame adds to a step of a point, in nodes that it meets: it turns stresses, and where a law does not
/// remember F rates too. A linear `usl` step, which meets 4, 8 and 16 nodes, has 1.03, 1.04 and 1.05 times the instructions of the
/// updated frame in 1D, 2D and 3D if the law is hyperelastic, and 1.04, 1.10 and 1.15 times if it is not. What sorting costs the
/// updated frame is not counted.
pub fn tensor_visits(scenario: &Scenario) -> f64 {
    let laws = || scenario.materials.iter().map(|material| &material.law);
    let visits = match scenario.method.frame {
        ReferenceFrame::Updated => [0.0; 3],
        ReferenceFrame::Total if laws().all(|law| law.is_hyperelastic()) => [0.1, 0.3, 0.8],
        ReferenceFrame::Total => [0.2, 0.8, 2.4],
    };
    visits[scenario.dimension - 1]
}

/// Work of a run: steps × points × (nodes in a stencil × passes + tensor visits), the number of times that a point meets a node.
pub fn work(scenario: &Scenario, points: usize, steps: u64) -> f64 {
    let method = &scenario.method;
    let passes = passes(method.update) + term_passes(scenario);
    let visits = stencil_nodes(scenario) * u64::from(passes);
    let tensors = tensor_visits(scenario);
    points as f64 * steps as f64 * (visits as f64 + tensors)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::parse;

    /// Work of 7 steps of 10 points, quadratic and `usl`, with one more override.
    fn with(setting: &str) -> f64 {
        let text = include_str!("../../../scenarios/bar1d.toml");
        let overrides = [
            "method.basis=\"quadratic\"".into(),
            "method.update=\"usl\"".into(),
            setting.to_string(),
        ];
        let loaded = parse("bar1d", text, &overrides).expect("a scenario");
        work(&loaded.scenario, 10, 7)
    }

    #[test]
    fn each_term_of_fmpm_costs_a_step_of_pic_more() {
        let of = |transfer: &str| with(&format!("method.transfer={transfer}"));
        assert_eq!(of("\"pic\""), 70.0 * 6.0);
        assert_eq!(of("{ fmpm = { order = 1 } }"), 70.0 * 6.0);
        assert_eq!(of("{ fmpm = { order = 4 } }"), 70.0 * 24.0);
    }

    #[test]
    fn the_total_frame_costs_a_fifth_of_a_node_a_point_more_in_1d() {
        let of = |frame: &str| with(&format!("method.frame=\"{frame}\""));
        assert_eq!(of("updated"), 70.0 * 6.0);
        assert_eq!(of("total"), 70.0 * 6.2);
    }

    #[test]
    fn a_law_that_remembers_f_spares_the_total_frame_half_of_that() {
        let text = include_str!("../../../scenarios/manufactured1d.toml");
        let of = |frame: &str| {
            let overrides = [format!("method.frame=\"{frame}\"")];
            let loaded = parse("manufactured1d", text, &overrides).expect("a scenario");
            work(&loaded.scenario, 1, 1)
        };
        assert!((of("total") - of("updated") - 0.1).abs() < 1e-14);
    }

    #[test]
    fn two_updates_visit_every_node_twice_as_often_as_the_third() {
        let of = |update: &str| with(&format!("method.update=\"{update}\""));
        assert_eq!(of("usl"), 70.0 * 6.0);
        assert_eq!(of("usf"), 70.0 * 12.0);
        assert_eq!(of("musl"), 70.0 * 12.0);
    }

    #[test]
    fn both_ends_of_a_domain_meet_two_nodes() {
        let of = |basis: &str| with(&format!("method.basis=\"{basis}\""));
        assert_eq!(of("linear"), 70.0 * 4.0);
        assert_eq!(of("cpdi"), 70.0 * 8.0);
    }
}
