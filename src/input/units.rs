//! The units that a scenario may use.

use super::Unit;
use super::suggest::nearest;

/// Factor to SI of a symbol, what it is, and the prefixes that it takes.
const UNITS: &[(&str, f64, Unit, &str)] = &[
    ("m", 1.0, Unit::LENGTH, "fpnuµμmcdkMG"),
    ("g", 1e-3, Unit::MASS, "pnuµμmkMG"),
    ("t", 1e3, Unit::MASS, ""),
    ("s", 1.0, Unit::TIME, "fpnuµμmkMG"),
    ("min", 60.0, Unit::TIME, ""),
    ("h", 3600.0, Unit::TIME, ""),
    ("day", 86400.0, Unit::TIME, ""),
    ("N", 1.0, Unit::FORCE, "pnuµμmkMGT"),
    ("Pa", 1.0, Unit::PRESSURE, "pnuµμmhkMGT"),
    ("bar", 1e5, Unit::PRESSURE, "mk"),
    ("psi", 6894.757293168361, Unit::PRESSURE, ""),
    ("J", 1.0, Unit::ENERGY, "fpnuµμmkMGT"),
    ("W", 1.0, Unit::POWER, "pnuµμmkMGT"),
    ("Hz", 1.0, Unit::FREQUENCY, "mkMGT"),
    ("rad", 1.0, Unit::NONE, "m"),
    ("deg", std::f64::consts::PI / 180.0, Unit::NONE, ""),
    ("°", std::f64::consts::PI / 180.0, Unit::NONE, ""),
    ("%", 1e-2, Unit::NONE, ""),
];

const PREFIXES: &[(char, f64)] = &[
    ('f', 1e-15),
    ('p', 1e-12),
    ('n', 1e-9),
    ('u', 1e-6),
    ('µ', 1e-6),
    ('μ', 1e-6),
    ('m', 1e-3),
    ('c', 1e-2),
    ('d', 1e-1),
    ('h', 1e2),
    ('k', 1e3),
    ('M', 1e6),
    ('G', 1e9),
    ('T', 1e12),
];

/// The factor to SI and the dimension of a unit symbol.
pub(super) fn unit(symbol: &str) -> Option<(f64, Unit)> {
    if let Some((_, factor, unit, _)) = UNITS.iter().find(|known| known.0 == symbol) {
        return Some((*factor, *unit));
    }
    let prefix = symbol.chars().next()?;
    let (_, scale) = PREFIXES.iter().find(|known| known.0 == prefix)?;
    let base = &symbol[prefix.len_utf8()..];
    let (_, factor, unit, prefixes) = UNITS.iter().find(|known| known.0 == base)?;
    prefixes.contains(prefix).then_some((scale * factor, *unit))
}

/// All symbols, without prefixes.
pub(super) fn symbols() -> impl Iterator<Item = &'static str> {
    UNITS.iter().map(|known| known.0)
}

/// The unit that `symbol` is most likely meant to be.
pub(super) fn suggestion(symbol: &str) -> Option<String> {
    let mut all: Vec<String> = symbols().map(str::to_string).collect();
    for (base, _, _, prefixes) in UNITS {
        all.extend(
            prefixes
                .chars()
                .filter(|prefix| prefix.is_ascii())
                .map(|prefix| format!("{prefix}{base}")),
        );
    }
    let same = |known: &&String| known.to_lowercase() == symbol.to_lowercase();
    let preferred = ["MPa", "kg", "kN", "mm"]
        .iter()
        .find(|known| known.to_lowercase() == symbol.to_lowercase());
    preferred
        .map(|known| known.to_string())
        .or_else(|| all.iter().find(same).cloned())
        .or_else(|| nearest(symbol, all.iter().map(String::as_str)).map(str::to_string))
}
