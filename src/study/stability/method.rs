//! The methods that a study goes through, by their names in a scenario.

use crate::basis::BasisChoice;
use crate::scenario::Scheme;
use crate::transfer::TransferChoice;
use serde::Serialize;

/// A basis, a transfer and an update, each with its default parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Method {
    /// Shape functions.
    pub basis: &'static str,
    /// Velocity transfer.
    pub transfer: &'static str,
    /// When stresses are updated.
    pub update: &'static str,
}

impl Method {
    /// Every combination of what is registered.
    pub fn all() -> Vec<Self> {
        let mut all = Vec::new();
        for &basis in BasisChoice::NAMES {
            for &transfer in TransferChoice::NAMES {
                for update in Scheme::ALL.map(|scheme| scheme.name()) {
                    all.push(Self {
                        basis,
                        transfer,
                        update,
                    });
                }
            }
        }
        all
    }

    /// The table of a scenario.
    pub fn toml(&self) -> String {
        let Self {
            basis,
            transfer,
            update,
        } = self;
        format!(
            "method = {{ basis = \"{basis}\", transfer = \"{transfer}\", update = \"{update}\" }}\n"
        )
    }

    /// Whether points carry an affine field.
    pub fn is_affine(&self) -> bool {
        let empty = crate::input::Document::parse("", &[]);
        TransferChoice::read(self.transfer, &mut empty.root())
            .is_some_and(|transfer| transfer.is_affine())
    }
}

impl std::fmt::Display for Method {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} {} {}", self.basis, self.transfer, self.update)
    }
}
