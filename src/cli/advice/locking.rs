//! Nearly incompressible bodies on shape functions that lock.

use super::{Advice, Subject};
use crate::basis::BasisChoice;
use crate::material::{LawChoice, Plane};
use crate::scenario::{MaterialSpec, Scenario};

/// Poisson's ratio from which on there is something to say. A cantilever on linear functions bends as it should at 0.3, to 58 % at
/// 0.49 and to 17 % at 0.499 (docs/stability.md, "locking").
pub const HIGH: f64 = 0.45;

pub fn advise(subject: &Subject) -> Vec<Advice> {
    let scenario = subject.scenario;
    // in 1D, and in a sheet that may grow thinner, nothing has to keep its volume
    let free = scenario.dimension == 1 || scenario.plane == Plane::Stress;
    let (BasisChoice::Linear(_) | BasisChoice::Gimp(_)) = scenario.method.basis else {
        return Vec::new();
    };
    let (name, ratio) = highest_ratio(scenario);
    if free || ratio < HIGH {
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
    let ratio = |material: &MaterialSpec| poissons_ratio(&material.law);
    let all = scenario
        .materials
        .iter()
        .map(|material| (&material.name[..], ratio(material)));
    all.fold(
        ("", -1.0),
        |best, next| if next.1 > best.1 { next } else { best },
    )
}

/// Poisson's ratio of any isotropic law at small strain, from the stiffness of a bar between rollers, M, and with free sides, E, and
/// of a sheet, S: M/E = (1 − ν) / ((1 + ν)(1 − 2ν)) has a positive and a negative solution, of which S/E = 1 / (1 − ν²) tells the
/// right one (derived here). Stiffnesses are upper estimates, so that below −1/2 it need not be exact.
fn poissons_ratio(law: &LawChoice) -> f64 {
    let stiffness = |plane| law.points::<1>(plane, 1).reference_stiffness();
    let free = stiffness(Plane::Stress);
    let r = stiffness(Plane::Strain) / free;
    let square = 1.0 - free / law.points::<2>(Plane::Stress, 1).reference_stiffness();
    let root = ((r - 1.0) * (9.0 * r - 1.0)).max(0.0).sqrt();
    let [upper, lower] = [root, -root].map(|root| (1.0 - r + root) / (4.0 * r));
    if (upper * upper - square).abs() <= (lower * lower - square).abs() {
        upper
    } else {
        lower
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::Isotropic;

    #[test]
    fn poissons_ratio_of_every_law_is_found_from_its_stiffness() {
        for law in LawChoice::samples(Isotropic::new(3.0, -0.95)) {
            assert!(poissons_ratio(&law) < HIGH, "{law:?}");
        }
        for given in [-0.3, 0.0, 0.2, 0.3, 0.45, 0.4999] {
            for law in LawChoice::samples(Isotropic::new(3.0, given)) {
                let found = poissons_ratio(&law);
                assert!((found - given).abs() < 1e-6, "{law:?}: {found}");
            }
        }
    }
}
