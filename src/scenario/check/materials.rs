//! Materials.

use super::{CountedBody, Frame, Named};
use crate::input::{Bound, Document, Reader, Unit};
use crate::material::LawChoice;
use crate::scenario::MaterialSpec;

/// All materials, in file order.
pub(super) fn materials(
    root: &mut Reader<'_>,
    document: &Document,
    frame: Frame,
    warnings: &mut Vec<String>,
) -> Vec<Named<MaterialSpec>> {
    let empty = match root.optional_table("material") {
        Some(mut table) => {
            use_all(&mut table);
            table.keys().is_empty()
        }
        None => !root.has("material"),
    };
    if empty && !document.is_broken() {
        root.problem(
            "material",
            "there is no material: add [material.NAME] with a density and a law",
        );
    }
    let tables = root.named_tables("material").into_iter();
    tables
        .map(|(name, reader)| Named {
            found: material(&name, reader, frame, warnings),
            name,
        })
        .collect()
}

fn material(
    name: &str,
    mut reader: Reader<'_>,
    frame: Frame,
    warnings: &mut Vec<String>,
) -> Option<MaterialSpec> {
    let density = reader.required("density", Unit::DENSITY, Bound::Positive);
    let law = reader
        .one_of(LawChoice::NAMES)
        .and_then(|(law, mut parameters)| LawChoice::read(law, &mut parameters));
    let poissons_ratio = law.and_then(|law| poissons_ratio(&mut reader, law));
    if frame.dimension == 1
        && !frame.plane_given
        && poissons_ratio.is_some_and(|ratio| ratio != 0.0)
    {
        warnings.push(format!(
            "material.{name}: in 1D the default plane = \"strain\" keeps the cross-section as it is, so that E (1 - nu) / ((1 + nu) (1 - 2 nu)) resists instead of E; plane = \"stress\" models a bar"
        ));
    }
    reader.finish();
    Some(MaterialSpec {
        name: name.into(),
        density: density?,
        law: law?,
        poissons_ratio,
    })
}

/// Poisson's ratio as the file gives it, if the law has one.
fn poissons_ratio(reader: &mut Reader<'_>, law: LawChoice) -> Option<f64> {
    let mut parameters = reader.optional_table(law.name())?;
    use_all(&mut parameters);
    parameters.optional("poissons_ratio", Unit::NONE, Bound::Any)
}

/// Leaves it to another reader of the same table to know its keys.
fn use_all(table: &mut Reader<'_>) {
    table.keys().into_iter().for_each(|key| table.used(key));
}

/// Says which materials no body is made of.
pub(super) fn warn_of_unused(
    materials: &[Named<MaterialSpec>],
    bodies: &[Named<CountedBody>],
    warnings: &mut Vec<String>,
) {
    for (index, material) in materials.iter().enumerate() {
        let used = |body: &Named<CountedBody>| {
            body.found
                .as_ref()
                .is_none_or(|found| found.body.material == index)
        };
        if !bodies.iter().any(used) {
            warnings.push(format!("material.{}: no body is made of it", material.name));
        }
    }
}
