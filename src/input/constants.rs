//! The table `[constants]`.

use super::Document;

/// Evaluates all constants.
pub(super) fn resolve(_document: &mut Document) {}
