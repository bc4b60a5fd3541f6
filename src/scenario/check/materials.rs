//! Materials.

use super::{CountedBody, Frame, Named};
use crate::input::{Bound, Document, Reader, Unit};
use crate::material::{LawChoice, Plane};
use crate::scenario::MaterialSpec;

/// All materials, in file order.
pub(super) fn materials(root: &mut Reader<'_>, document: &Document) -> Vec<Named<MaterialSpec>> {
    if !root.has("material") && !document.is_broken() {
        root.problem(
            "material",
            "there is no material: add [material.NAME] with a density and a law",
        );
    }
    let tables = root.named_tables("material");
    if tables.is_empty()
        && root
            .optional_table("material")
            .is_some_and(|table| table.keys().is_empty())
    {
        root.problem(
            "material",
            "there is no material: add [material.NAME] with a density and a law",
        );
    }
    tables
        .into_iter()
        .map(|(name, reader)| Named {
            found: material(&name, reader),
            name,
        })
        .collect()
}

fn material(name: &str, mut reader: Reader<'_>) -> Option<MaterialSpec> {
    let density = reader.required("density", Unit::DENSITY, Bound::Positive);
    let law = reader
        .one_of(LawChoice::NAMES)
        .and_then(|(law, mut parameters)| LawChoice::read(law, &mut parameters));
    reader.finish();
    Some(MaterialSpec {
        name: name.into(),
        density: density?,
        law: law?,
    })
}

/// Says what is allowed and still likely to surprise.
pub(super) fn warn(
    frame: Frame,
    materials: &[Named<MaterialSpec>],
    bodies: &[Named<CountedBody>],
    warnings: &mut Vec<String>,
) {
    for (index, material) in materials.iter().enumerate() {
        let name = &material.name;
        let used = |body: &Named<CountedBody>| {
            body.found
                .as_ref()
                .is_none_or(|found| found.body.material == index)
        };
        if !bodies.iter().any(used) {
            warnings.push(format!("material.{name}: no body is made of it"));
            continue;
        }
        let _ = (frame.plane == Plane::Strain, frame.dimension);
    }
}
