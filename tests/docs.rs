//! What the documents say stays true.

use mpm::{input, math, real, tensor};
use std::path::{Path, PathBuf};

/// The examples of the documents, compiled as they would be in their places.
#[path = "../docs/examples"]
mod material {
    pub use mpm::material::{Deformation, Hyperelastic, Isotropic, Plane, Stress};
    #[path = "material.rs"]
    pub mod example;
}
#[path = "../docs/examples"]
mod basis {
    pub use mpm::basis::{Basis, Functions};
    #[path = "basis.rs"]
    pub mod example;
}
#[path = "../docs/examples"]
mod boundary {
    pub use mpm::boundary::{Condition, ConditionParameters, Node, Place};
    #[path = "boundary.rs"]
    pub mod example;
}
#[path = "../docs/examples"]
mod validate {
    pub use mpm::study::validate::{Case, CaseError, Report};
    #[path = "case.rs"]
    pub mod example;
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The README and every document.
fn documents() -> Vec<PathBuf> {
    let mut all = vec![root().join("README.md")];
    let entries = std::fs::read_dir(root().join("docs")).expect("docs");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    all.extend(paths.filter(|path| path.extension().is_some_and(|end| end == "md")));
    all
}

/// The blocks of a document that are marked with a language.
fn blocks(text: &str, language: &str) -> Vec<String> {
    let opening = format!("```{language}\n");
    let parts = text.split(&opening).skip(1);
    parts
        .map(|part| part.split("\n```").next().unwrap_or_default().to_string() + "\n")
        .collect()
}

#[test]
fn every_scenario_in_the_documents_can_be_read() {
    let mut count = 0;
    for path in documents() {
        for block in blocks(&read(&path), "toml") {
            if block.contains("dimension =") {
                let loaded = mpm::scenario::parse("example", &block, &[]);
                if let Err(error) = loaded {
                    panic!("{}:\n{error}", path.display());
                }
                count += 1;
            }
        }
    }
    assert!(count >= 2);
}

#[test]
fn every_name_that_a_scenario_may_use_is_in_the_reference() {
    let text = read(&root().join("docs/scenario.md"));
    let names = [
        mpm::basis::BasisChoice::NAMES,
        mpm::transfer::TransferChoice::NAMES,
        mpm::boundary::ConditionChoice::NAMES,
        mpm::material::LawChoice::NAMES,
        mpm::scenario::shape::Shape::NAMES,
    ];
    for name in names.concat() {
        let forms = [
            format!("`{name}`"),
            format!("`\"{name}\"`"),
            format!("`shape.{name}`"),
        ];
        let found = forms.iter().any(|form| text.contains(form));
        assert!(found, "docs/scenario.md does not tell about {name}");
    }
}

#[test]
fn links_between_documents_lead_somewhere() {
    for path in documents() {
        let text = read(&path);
        for part in text.split("](").skip(1) {
            let target = part.split(')').next().unwrap_or_default();
            let target = target.split('#').next().unwrap_or_default();
            if target.is_empty() || target.contains("://") {
                continue;
            }
            let place = path.parent().expect("a folder").join(target);
            assert!(place.exists(), "{}: {target}", path.display());
        }
    }
}

#[test]
fn documents_show_the_examples_that_are_compiled() {
    for (document, example) in [
        ("adding-a-material", "material"),
        ("adding-a-basis", "basis"),
        ("adding-a-boundary", "boundary"),
        ("adding-a-validation-case", "case"),
    ] {
        let text = read(&root().join(format!("docs/{document}.md")));
        let code = read(&root().join(format!("docs/examples/{example}.rs")));
        assert!(
            text.contains(&code),
            "{document}.md differs from {example}.rs"
        );
    }
}

#[test]
fn the_example_law_has_the_stress_that_its_energy_demands() {
    use material::{Deformation, Hyperelastic, Isotropic};
    let law = material::example::Inflatable {
        elasticity: Isotropic::new(1e6, 0.3),
    };
    let stretched = |stretch: f64| Deformation::<f64, 1> {
        displacement_gradient: tensor::Tensor([[stretch - 1.0]]),
        transverse: 0.0,
    };
    let (stretch, step) = (1.2, 1e-6);
    let energy = |x: f64| law.energy(&stretched(x));
    let slope = (energy(stretch + step) - energy(stretch - step)) / (2.0 * step);
    let stress = law.stress(&stretched(stretch)).plane[(0, 0)];
    assert!((stress - slope * stretch).abs() < 1e-6 * stress);
}

#[test]
fn the_example_basis_reproduces_a_linear_field() {
    use basis::Basis;
    let basis = basis::example::Ghosted;
    for k in 0..=50 {
        let x = f64::from(k) / 10.0;
        let axis = basis.axis(x, 5);
        let nodes = (0..3).map(|i| basis.position(axis.first + i, 5));
        let sum: f64 = nodes.zip(axis.weight).map(|(node, w)| node * w).sum();
        assert!((sum - x).abs() < 1e-14);
    }
}

#[test]
fn the_example_condition_turns() {
    use boundary::{Condition, Node};
    let turning = boundary::example::Turning {
        center: vec![1.0, 1.0],
        rate: 2.0,
    };
    let node = Node {
        position: math::Vector::<2>::new(2.0, 1.0),
        time: 0.0,
    };
    let velocity = turning.impose(&node, &math::Vector::<2>::zeros());
    assert_eq!(velocity, math::Vector::<2>::new(0.0, 2.0));
}

#[test]
fn the_example_case_passes() {
    let mut report = validate::Report::default();
    (validate::example::CASE.run)(&mut report).expect("it runs");
    report.close_account();
    assert!(report.passed(), "{:?}", report.checks);
}
