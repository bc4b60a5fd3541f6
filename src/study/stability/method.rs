//! The methods that a study goes through, by their names in a scenario.

use crate::basis::BasisChoice;
use crate::scenario::{ReferenceFrame, Scheme};
use crate::transfer::TransferChoice;
use serde::Serialize;

/// A basis, a transfer, an update and a frame, each with its default parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Method {
    /// Shape functions.
    pub basis: &'static str,
    /// Velocity transfer.
    pub transfer: &'static str,
    /// When stresses are updated.
    pub update: &'static str,
    /// Whether shape functions are those of the present or of the initial positions.
    pub frame: &'static str,
}

impl Method {
    /// Every combination of what is registered, those of the updated frame first.
    pub fn all() -> Vec<Self> {
        let mut all = Vec::new();
        for frame in ReferenceFrame::NAMES {
            for &basis in BasisChoice::NAMES {
                for &transfer in TransferChoice::NAMES {
                    for update in Scheme::ALL.map(|scheme| scheme.name()) {
                        all.push(Self {
                            basis,
                            transfer,
                            update,
                            frame,
                        });
                    }
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
            frame,
        } = self;
        format!(
            "method = {{ basis = \"{basis}\", transfer = \"{transfer}\", update = \"{update}\", frame = \"{frame}\" }}\n"
        )
    }

    /// Whether shape functions are those of the initial positions.
    pub fn is_total(&self) -> bool {
        self.frame == "total"
    }

    /// Basis, transfer and update: what tells methods of one frame apart.
    pub fn within_frame(&self) -> String {
        format!("{} {} {}", self.basis, self.transfer, self.update)
    }

    /// Whether points carry an affine field.
    pub fn is_affine(&self) -> bool {
        self.choice().is_some_and(|transfer| transfer.is_affine())
    }

    /// Whether velocities of the grid have more terms than one, each of which reaches farther and brings another power of the step.
    pub fn has_terms(&self) -> bool {
        self.choice().is_some_and(|transfer| transfer.terms() > 1)
    }

    fn choice(&self) -> Option<TransferChoice> {
        let empty = crate::input::Document::parse("", &[]);
        TransferChoice::read(self.transfer, &mut empty.root())
    }
}

impl std::fmt::Display for Method {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.within_frame())?;
        if self.is_total() {
            write!(f, ", {} frame", self.frame)?;
        }
        Ok(())
    }
}
