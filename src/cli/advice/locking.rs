//! Nearly incompressible bodies on shape functions that lock.

use super::{Advice, Subject};
use crate::basis::BasisChoice;
use crate::material::Plane;
use crate::scenario::Scenario;

/// Poisson's ratio from which on there is something to say. A cantilever on linear functions bends as it should at 0.3, to 58 % at
/// 0.49 and to 17 % at 0.499 (docs/stability.md, "locking").
pub const HIGH: f64 = 0.45;

pub fn advise(subject: &Subject) -> Vec<Advice> {
    let scenario = subject.scenario;
    // in 1D, and in a sheet that may grow thinner, nothing has to keep its volume
    let free = scenario.dimension == 1 || scenario.plane == Plane::Stress;
    let stiff = match scenario.method.basis {
        BasisChoice::Linear(linear) => !linear.b_bar,
        BasisChoice::Gimp(_) | BasisChoice::Cpdi(_) => true,
        _ => false,
    };
    let (name, ratio) = highest_ratio(scenario);
    if !stiff || free || ratio < HIGH {
        return Vec::new();
    }
    vec![Advice {
        kind: "locking",
        says: format!(
            "with a Poisson's ratio of {ratio:.4} \"{name}\" keeps its volume, and the basis {} is too stiff for that when it bends: \
                 to 58 % of the deflection at 0.49",
            scenario.method.basis.name()
        ),
        change: "method.basis = \"quadratic\"".into(),
        factor: None,
    }]
}

/// The material with the highest Poisson's ratio, and that.
pub fn highest_ratio(scenario: &Scenario) -> (&str, f64) {
    let all = scenario.materials.iter().filter_map(|material| {
        let ratio = material.poissons_ratio?;
        Some((&material.name[..], ratio))
    });
    all.fold(
        ("", -1.0),
        |best, next| if next.1 > best.1 { next } else { best },
    )
}
