//! Reading as a user meets it: what a text means, and what is said when it means nothing.

use super::*;
use std::collections::BTreeMap;
use std::f64::consts::PI;

const AT: Variables = Variables {
    position: [2.0, 3.0, 5.0],
    time: 7.0,
};

fn number(text: &str) -> f64 {
    match Expression::parse(text, Unit::NONE, &[], &BTreeMap::new()) {
        Ok(expression) => expression.value(&AT),
        Err(error) => panic!("{text}: {error}"),
    }
}

fn error(text: &str, unit: Unit) -> String {
    let constants = BTreeMap::from([(
        "L".to_string(),
        Quantity {
            value: 25.0,
            unit: Some(Unit::LENGTH),
        },
    )]);
    match Expression::parse(text, unit, &["x", "t"], &constants) {
        Ok(expression) => panic!("{text} is accepted as {expression:?}"),
        Err(error) => {
            assert!(text.get(error.span.clone()).is_some(), "{text}: {error:?}");
            format!("[{}] {}", &text[error.span], error.message)
        }
    }
}

#[test]
fn arithmetic_follows_the_conventions_of_mathematics() {
    for (text, value) in [
        ("1 + 2 * 3", 7.0),
        ("-2^2", -4.0),
        ("2^3^2", 512.0),
        ("2^-1", 0.5),
        ("(-2)^3", -8.0),
        ("8 / 4 / 2", 1.0),
        ("1/2", 0.5),
        ("1e-3*2", 0.002),
        ("1 - 2 - 3", -4.0),
        ("--3", 3.0),
        ("2 * -3", -6.0),
        ("1 + 1 < 3", 1.0),
        ("2 >= 3", 0.0),
        ("3 <= 3", 1.0),
        ("step(0) + step(-1e-9)", 1.0),
        ("sign(-3) + sign(0)", -1.0),
        ("max(1, 2, 3) - min(3, 1, 2)", 2.0),
        ("hypot(3, 4)", 5.0),
        ("atan2(1, 1) * 4", PI),
        ("cos(pi)", -1.0),
        ("sin(90 deg)", 1.0),
        ("ln(e)", 1.0),
        ("log10(1000)", 3.0),
        ("floor(1.5) + ceil(1.5)", 3.0),
        ("abs(-2) + sqrt(16)", 6.0),
        ("(2 − 1) · 3²", 9.0),
        (".5 + 5.", 5.5),
    ] {
        assert!(
            (number(text) - value).abs() < 1e-14,
            "{text} = {}",
            number(text)
        );
    }
}

#[test]
fn units_become_si() {
    for (text, unit, value) in [
        ("128 GPa", Unit::PRESSURE, 128e9),
        ("8.96 g/cm^3", Unit::DENSITY, 8960.0),
        ("14.43 N", Unit::FORCE, 14.43),
        ("1 mm/s", Unit::VELOCITY, 1e-3),
        ("9.81 m/s^2", Unit::ACCELERATION, 9.81),
        ("25mm", Unit::LENGTH, 0.025),
        ("25 mm^2", Unit::AREA, 25e-6),
        ("180 deg", Unit::NONE, PI),
        ("1e3 kg m^-3", Unit::DENSITY, 1e3),
        ("1e3 kg*m^-3", Unit::DENSITY, 1e3),
        ("1e3 kg·m^(-3)", Unit::DENSITY, 1e3),
        ("1 kN/m^2", Unit::PRESSURE, 1e3),
        ("5 µm", Unit::LENGTH, 5e-6),
        ("5 um", Unit::LENGTH, 5e-6),
        ("3 us", Unit::TIME, 3e-6),
        ("2 kHz", Unit::FREQUENCY, 2e3),
        ("5 1/s", Unit::FREQUENCY, 5.0),
        ("5/s", Unit::FREQUENCY, 5.0),
        ("2 bar", Unit::PRESSURE, 2e5),
        ("3 t", Unit::MASS, 3e3),
        ("2 min", Unit::TIME, 120.0),
        ("0.1 m/s * 2", Unit::VELOCITY, 0.2),
        ("25 mm + 1 m", Unit::LENGTH, 1.025),
        ("2 * (3 m)^2", Unit::AREA, 18.0),
        ("sqrt(4 m^2)", Unit::LENGTH, 2.0),
        ("12", Unit::LENGTH, 12.0),
    ] {
        let parsed = Expression::parse(text, unit, &[], &BTreeMap::new());
        let found = parsed
            .unwrap_or_else(|error| panic!("{text}: {error}"))
            .value(&AT);
        assert_eq!(found, value, "{text}");
    }
    assert_eq!(
        Quantity::parse("25 mm"),
        Ok(Quantity {
            value: 0.025,
            unit: Some(Unit::LENGTH)
        })
    );
    assert_eq!(
        Quantity::parse("25"),
        Ok(Quantity {
            value: 25.0,
            unit: None
        })
    );
}

#[test]
fn variables_and_constants_have_their_values() {
    let constants = BTreeMap::from([
        (
            "L".to_string(),
            Quantity {
                value: 25.0,
                unit: Some(Unit::LENGTH),
            },
        ),
        (
            "v0".to_string(),
            Quantity {
                value: 0.1,
                unit: Some(Unit::VELOCITY),
            },
        ),
        (
            "s".to_string(),
            Quantity {
                value: 2.0,
                unit: None,
            },
        ),
    ]);
    let parse = |text, unit| Expression::parse(text, unit, &["x", "y", "t"], &constants).unwrap();
    let mode = parse("v0 * sin(pi * x / (2 * L))", Unit::VELOCITY);
    assert_eq!(mode.value(&AT), 0.1 * (PI * 2.0 / 50.0).sin());
    assert!(!mode.is_constant() && !mode.depends_on_time());
    assert!(parse("x * t", Unit::new(1, 0, 1)).depends_on_time());
    assert_eq!(parse("2 * L", Unit::LENGTH), Expression::constant(50.0));
    assert_eq!(parse("y + x * s", Unit::LENGTH).value(&AT), 7.0);
    assert_eq!(parse("x / t", Unit::VELOCITY).value(&AT), 2.0 / 7.0);
    let message = Expression::parse("1 m/s", Unit::VELOCITY, &[], &constants)
        .unwrap_err()
        .message;
    assert!(message.contains("a unit and a constant"), "{message}");
}

#[test]
fn errors_of_formulas_say_where_and_what_to_do() {
    for (text, unit, wanted) in [
        (
            "5 mm",
            Unit::PRESSURE,
            "[5 mm] expected a pressure (such as \"100 MPa\" or a number in Pa), found \"5 mm\", a length",
        ),
        (
            "5 Mpa",
            Unit::PRESSURE,
            "[Mpa] unknown unit \"Mpa\"; did you mean \"MPa\"?",
        ),
        ("5 MPA", Unit::PRESSURE, "did you mean \"MPa\"?"),
        ("5 lbf", Unit::FORCE, "[lbf] unknown unit \"lbf\""),
        (
            "x + t",
            Unit::LENGTH,
            "[+] both sides of \"+\" must be of one kind, found a length and a time",
        ),
        (
            "sin(x)",
            Unit::NONE,
            "[sin] sin needs a pure number or an angle, found a length",
        ),
        ("sin(x / L)", Unit::VELOCITY, "such as \"1 m/s\""),
        (
            "y",
            Unit::LENGTH,
            "[y] \"y\" cannot be used here; this may depend on x and t",
        ),
        (
            "sine(2)",
            Unit::NONE,
            "[sine] unknown name \"sine\"; did you mean \"sin\"?",
        ),
        (
            "2 + foo",
            Unit::NONE,
            "[foo] unknown name \"foo\"; add it to [constants]",
        ),
        (
            "2 pi",
            Unit::NONE,
            "[pi] expected an operator before \"pi\"; to multiply, write *",
        ),
        ("2 L", Unit::LENGTH, "to multiply, write *"),
        (
            "m",
            Unit::LENGTH,
            "[m] the unit \"m\" needs a number before it",
        ),
        (
            "1,5 m",
            Unit::LENGTH,
            "[,] a comma only separates arguments",
        ),
        ("(1 + 2", Unit::NONE, "[(] this \"(\" is never closed"),
        ("1 + 2)", Unit::NONE, "[)] this \")\" closes nothing"),
        (
            "1 +",
            Unit::NONE,
            "[] the text ends where a value is expected",
        ),
        ("", Unit::LENGTH, "[] expected a length"),
        (
            "sin",
            Unit::NONE,
            "[sin] \"sin\" is a function; write sin(...)",
        ),
        (
            "sin(1, 2)",
            Unit::NONE,
            "[sin(1, 2)] sin takes 1 argument, found 2",
        ),
        ("hypot(1)", Unit::NONE, "hypot takes 2 arguments, found 1"),
        (
            "3 + 1 / (2 - 2)",
            Unit::NONE,
            "[1 / (2 - 2)] \"1 / (2 - 2)\" is inf",
        ),
        (
            "sqrt(-1)",
            Unit::NONE,
            "is NaN, which is not a finite number",
        ),
        ("1e999", Unit::NONE, "[1e999] this number is too large"),
        ("1 < 2 < 3", Unit::NONE, "[<] comparisons cannot be chained"),
        (
            "2 ^ (3 m)",
            Unit::NONE,
            "[^] an exponent must be a pure number, found a length",
        ),
        ("x ^ t", Unit::NONE, "an exponent must be a pure number"),
        ("x = 2", Unit::NONE, "[=]"),
        (
            "2 $ 3",
            Unit::NONE,
            "[$] the character '$' means nothing here",
        ),
        ("1 J/kg m", Unit::NONE, "[m] it is not clear"),
        ("1 m^99", Unit::NONE, "[^] a unit takes a whole exponent"),
        ("nan", Unit::NONE, "unknown name \"nan\""),
    ] {
        let found = error(text, unit);
        assert!(found.contains(wanted), "{text}: {found}");
    }
}

#[test]
fn monstrous_formulas_are_refused_politely() {
    for (part, count) in [
        ("(", 100_000),
        ("(", 5_000),
        ("-", 5_000),
        ("2^", 3_000),
        ("sin(", 2_000),
        ("1+(", 3_000),
    ] {
        error(&part.repeat(count), Unit::NONE);
    }
    error(
        &format!("{}x{}", "x+(".repeat(40), ")".repeat(40)),
        Unit::LENGTH,
    );
    let long = format!("0{}", "+x".repeat(4_000));
    let sum = Expression::parse(&long, Unit::LENGTH, &["x"], &BTreeMap::new()).unwrap();
    assert_eq!(sum.value(&AT), 8_000.0);
}

/// A small generator of numbers, so that the same mutations are tried everywhere.
struct Random(u64);

impl Random {
    fn below(&mut self, limit: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % limit as u64) as usize
    }

    fn mutate(&mut self, text: &str, pieces: &[&str]) -> String {
        let mut chars: Vec<char> = text.chars().collect();
        for _ in 0..1 + self.below(4) {
            let at = self.below(chars.len() + 1);
            match self.below(3) {
                0 => drop(chars.splice(at..at, pieces[self.below(pieces.len())].chars())),
                1 if at < chars.len() => drop(chars.remove(at)),
                _ if at < chars.len() => chars.truncate(at.max(chars.len() / 2)),
                _ => {}
            }
        }
        chars.into_iter().collect()
    }
}

#[test]
fn no_formula_makes_the_program_panic() {
    let mut random = Random(1);
    let pieces = [
        "(", ")", "^", "-", "/", "1/", "m", "µ", "²", "°", ",", "e", "1e", ".", "<=", "sin(", "x",
        "\n", "\0",
    ];
    let constants = BTreeMap::from([(
        "L".to_string(),
        Quantity {
            value: 0.0,
            unit: Some(Unit::LENGTH),
        },
    )]);
    for _ in 0..20_000 {
        let text = random.mutate(
            "L * sin(pi * x / (2 * 25 mm)) ^ 2 + max(x, 1 kg m^-3/s, 3)",
            &pieces,
        );
        match Expression::parse(&text, Unit::LENGTH, &["x"], &constants) {
            Ok(expression) => drop(expression.value(&AT)),
            Err(error) => assert!(text.get(error.span.clone()).is_some(), "{text}: {error:?}"),
        }
    }
}

mod files;
