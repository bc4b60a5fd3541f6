//! Whole files: places, several problems at once, overrides.

use super::Random;
use crate::input::*;

/// What is said about a file, one problem a line.
fn said(document: &Document) -> Vec<String> {
    document
        .problems()
        .iter()
        .map(ToString::to_string)
        .collect()
}

#[derive(Debug, PartialEq)]
struct Law {
    stiffness: f64,
    ratio: f64,
}

impl Parameters for Law {
    fn read(reader: &mut Reader<'_>) -> Option<Self> {
        let stiffness = reader.required("youngs_modulus", Unit::PRESSURE, Bound::Positive);
        let ratio = reader.or("poissons_ratio", Unit::NONE, Bound::Open(-1.0, 0.5), 0.0);
        Some(Law {
            stiffness: stiffness?,
            ratio: ratio?,
        })
    }
}

struct Eager;

impl Parameters for Eager {
    fn read(reader: &mut Reader<'_>) -> Option<Self> {
        reader.required("first", Unit::NONE, Bound::Positive)?;
        reader.required("second", Unit::NONE, Bound::Positive)?;
        Some(Eager)
    }
}

const SCENE: &str = r#"# A bar.
title = "Bar"
dimension = 2
[constants]
L = "half + half" # later is fine
half = "12.5 m"
[material.bar]
density = "1 kg/m^3"
linear_elastic = { youngs_modulus = "100 Pa", poissons_ratio = 0.3 }
[[body]]
name = "bar"
shape.box = { min = [0.0, 0], max = ["L", "1 m"] }
velocity = ["0.1 m/s * sin(pi * x / L)", 0]
[method]
transfer = "flip"
"#;

fn read(document: &Document) -> usize {
    let mut root = document.root();
    root.text("title");
    if let Some(dimension) = root.integer("dimension", 1, 3) {
        document.set_dimension(dimension as usize);
    }
    for (_, mut material) in root.named_tables("material") {
        material.required("density", Unit::DENSITY, Bound::Positive);
        if let Some((_, mut law)) = material.one_of(&["linear_elastic", "neo_hookean"]) {
            Law::read(&mut law);
        }
        material.finish();
    }
    for mut body in root.tables("body") {
        body.text("name");
        if let Some(mut shape) = body.table("shape")
            && let Some((_, mut shape)) = shape.one_of(&["box", "ball"])
        {
            shape.vector("min", Unit::LENGTH, 2);
            shape.vector("max", Unit::LENGTH, 2);
        }
        body.expressions("velocity", Unit::VELOCITY, 2, &["x", "y"]);
        body.finish();
    }
    if let Some(mut method) = root.optional_table("method") {
        if let Some((name, mut transfer)) =
            method.name_or_table_or("transfer", &["pic", "flip"], "flip")
            && name == "flip"
        {
            transfer.or("ratio", Unit::NONE, Bound::Closed(0.0, 1.0), 1.0);
        }
        method.finish();
    }
    root.finish();
    document.problems().len()
}

fn changed(from: &str, to: &str) -> Vec<String> {
    assert!(SCENE.contains(from), "{from}");
    let document = Document::parse(&SCENE.replace(from, to), &[]);
    read(&document);
    said(&document)
}

fn set(settings: &[&str]) -> (Document, Vec<String>) {
    let settings: Vec<String> = settings.iter().map(ToString::to_string).collect();
    let document = Document::parse(SCENE, &settings);
    read(&document);
    let said = said(&document);
    (document, said)
}

#[test]
fn a_good_file_has_no_problems() {
    let document = Document::parse(SCENE, &[]);
    read(&document);
    assert_eq!(said(&document), Vec::<String>::new());
    assert_eq!(
        document.constants()["L"],
        Quantity {
            value: 25.0,
            unit: Some(Unit::LENGTH)
        }
    );
    assert_eq!(document.resolved(), SCENE);
}

#[test]
fn every_problem_names_its_line_and_its_key() {
    for (from, to, wanted) in [
        (
            "\"100 Pa\"",
            "\"-3 Pa\"",
            "line 9, material.bar.linear_elastic.youngs_modulus: -3 Pa is not positive",
        ),
        (
            "\"100 Pa\"",
            "-3",
            "line 9, material.bar.linear_elastic.youngs_modulus: -3 is not positive",
        ),
        (
            "\"100 Pa\"",
            "nan",
            "line 9, material.bar.linear_elastic.youngs_modulus: nan is not a finite number; give one",
        ),
        (
            "\"100 Pa\"",
            "1e999",
            "line 9, material.bar.linear_elastic.youngs_modulus: 1e999 is too large for a number",
        ),
        (
            "= 0.3",
            "= \"30 deg\"",
            "line 9, material.bar.linear_elastic.poissons_ratio: 30 deg is not below 28.64789 deg",
        ),
        (
            "density",
            "densty",
            "line 8, material.bar.densty: unknown key \"densty\"; did you mean \"density\"?",
        ),
        (
            "density = \"1 kg/m^3\"",
            "",
            "line 7, material.bar.density: this key is missing; expected a density",
        ),
        (
            "linear_elastic",
            "linear_elastc",
            "line 9, material.bar.linear_elastc: unknown key \"linear_elastc\"; did you mean",
        ),
        (
            "linear_elastic = {",
            "neo_hookean = {}\nlinear_elastic = {",
            "line 9, material.bar.neo_hookean: \"linear_elastic\" and",
        ),
        (
            "dimension = 2",
            "dimension = 4",
            "line 3, dimension: 4 is not a whole number from 1 to 3",
        ),
        (
            "dimension = 2",
            "dimension = 99999999999999999999",
            "line 3, dimension: 99999999999999999999 is not",
        ),
        (
            "dimension = 2",
            "dimension = 2.5",
            "line 3, dimension: expected a whole number from 1 to 3, found the number 2.5",
        ),
        (
            "[0.0, 0]",
            "[0.0]",
            "line 12, body[0].shape.box.min: expected a list of 2 values because dimension = 2, found 1",
        ),
        (
            "[0.0, 0]",
            "0",
            "line 12, body[0].shape.box.min: expected a list of 2 values because dimension = 2, found the number 0; write",
        ),
        (
            "\"1 m\"]",
            "\"1 s\"]",
            "line 12, body[0].shape.box.max[1]: expected a length",
        ),
        (
            "* x /",
            "* z /",
            "line 13, body[0].velocity[0]: \"z\" cannot be used here",
        ),
        (
            "\"flip\"",
            "\"flop\"",
            "line 15, method.transfer: there is no \"flop\"; did you mean \"flip\"?",
        ),
        (
            "\"flip\"",
            "{ flip = { ratio = 2 } }",
            "line 15, method.transfer.flip.ratio: 2 is not at most 1",
        ),
        (
            "\"flip\"",
            "{ flop = {} }",
            "line 15, method.transfer.flop: unknown key \"flop\"; did you mean \"flip\"?",
        ),
        (
            "\"flip\"",
            "3",
            "line 15, method.transfer: expected a name or a table with one of pic or flip, found the number 3",
        ),
        (
            "[[body]]",
            "[body]",
            "line 10, body: expected a list of tables [[body]], found a table",
        ),
        (
            "title = \"Bar\"",
            "",
            "title: this key is missing; expected a text in quotes",
        ),
        (
            "\"12.5 m\"",
            "\"L\"",
            "line 5, constants.L: this is defined through itself (L → half → L)",
        ),
        (
            "half = ",
            "sin = ",
            "line 6, constants.sin: \"sin\" already has a meaning in formulas",
        ),
        (
            "\"12.5 m\"",
            "\"12.5 mn\"",
            "line 6, constants.half: unknown unit \"mn\"",
        ),
        (
            "title = \"Bar\"",
            "title = \"Bar\"\ntitle = \"Bar\"",
            "line 3: this is not valid TOML: duplicate key",
        ),
        ("[method]", "[method", "line 14: this is not valid TOML:"),
        ("\"100 Pa\"", "", "line 9: this is not valid TOML:"),
    ] {
        let said = changed(from, to);
        assert!(
            said.iter().any(|line| line.starts_with(wanted)),
            "{to}: {said:#?}\nwanted {wanted}"
        );
        let most = if to == "sin = " { 2 } else { 1 };
        assert!(said.len() <= most, "{to}: {said:#?}");
    }
}

#[test]
fn all_problems_are_reported_at_once_in_the_order_of_the_file() {
    let source = SCENE
        .replace("100 Pa", "-1 Pa")
        .replace("0.3", "0.7")
        .replace("title", "titel")
        .replace("25", "2x");
    let document = Document::parse(&source, &[]);
    read(&document);
    let text = report("bar.toml", document.source(), &document.problems());
    let wanted = r#"error: bar.toml has 3 problems
  line 2, titel: unknown key "titel"; did you mean "title"?
    2 | titel = "Bar"
      | ^^^^^
  line 9, material.bar.linear_elastic.youngs_modulus: -1 Pa is not positive
    9 | linear_elastic = { youngs_modulus = "-1 Pa", poissons_ratio = 0.7 }
      |                                     ^^^^^^^
  line 9, material.bar.linear_elastic.poissons_ratio: 0.7 is not below 0.5
    9 | linear_elastic = { youngs_modulus = "-1 Pa", poissons_ratio = 0.7 }
      |                                                               ^^^
"#;
    assert_eq!(text, wanted);
}

#[test]
fn the_marker_points_into_the_formula() {
    let document = Document::parse("a = [1, \"2 m + 3 s\"]", &[]);
    document.root().vector("a", Unit::LENGTH, 2);
    let problem = &document.problems()[0];
    assert_eq!(&document.source()[problem.span.clone().unwrap()], "+");
}

#[test]
fn an_early_return_does_not_make_unread_keys_unknown() {
    let said = |text: &str| -> Vec<String> {
        let problems = parse_parameters::<Eager>(text).err().unwrap_or_default();
        problems
            .iter()
            .map(|problem| format!("{}: {}", problem.key, problem.message))
            .collect()
    };
    assert_eq!(
        said("first = -1\nsecond = 2"),
        ["first: -1 is not positive"]
    );
    assert_eq!(
        said("frist = 1\nsecond = 2"),
        ["frist: unknown key \"frist\"; did you mean \"first\"?"]
    );
    assert_eq!(
        said("first = 1\nsecond = 2\nother = 3"),
        ["other: unknown key \"other\"; known here: first and second"]
    );
}

#[test]
fn parameters_can_be_read_without_a_file() {
    let law = parse_parameters::<Law>("youngs_modulus = \"1 GPa\"").unwrap();
    assert_eq!(
        law,
        Law {
            stiffness: 1e9,
            ratio: 0.0
        }
    );
    assert!(defaults::<Law>().is_none());
}

#[test]
fn overrides_change_the_tree_and_the_text() {
    let (document, said) = set(&[
        "material.bar.linear_elastic.youngs_modulus=2 GPa",
        "body[0].velocity=[\"1 m/s\", 0]",
        "body.0.shape.box.max[1]=\"2 m\"",
        "method.transfer={ flip = { ratio = 0.9 } }",
        "constants.half=10 m",
        "title=A long title = here",
        "material.steel.density=3",
        "material.steel.neo_hookean.youngs_modulus=3",
    ]);
    assert_eq!(said, Vec::<String>::new());
    assert_eq!(document.constants()["L"].value, 20.0);
    let text = document.resolved();
    for part in [
        "# A bar.",
        "# later is fine",
        "youngs_modulus = \"2 GPa\"",
        "\"A long title = here\"",
        "ratio = 0.9",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let again = Document::parse(text, &[]);
    assert_eq!(read(&again), 0, "{:?}", again.problems());
    assert_eq!(
        format!("{:?}", again.constants()),
        format!("{:?}", document.constants())
    );
}

#[test]
fn problems_of_overrides_name_the_override() {
    for (setting, wanted) in [
        (
            "material.bar.density=-1",
            "--set material.bar.density=-1: -1 is not positive",
        ),
        (
            "material.bar.densty=1",
            "--set material.bar.densty=1: unknown key \"densty\"; did you mean \"density\"?",
        ),
        (
            "body[0].velocity=[1]",
            "--set body[0].velocity=[1]: expected a list of 2 values",
        ),
        (
            "body[0].velocity[1]=3 s",
            "--set body[0].velocity[1]=3 s: expected a velocity",
        ),
        (
            "body[3].name=a",
            "--set body[3].name=a: there is no body[3]; the list ends with body[0]",
        ),
        (
            "body.name=a",
            "--set body.name=a: body is a list; give the number of an element, body[0]",
        ),
        (
            "method.transfer.flip.ratio=1",
            "--set method.transfer.flip.ratio=1: method.transfer is \"flip\", not a table",
        ),
        (
            "title",
            "--set title: this has no \"=\"; write --set KEY=VALUE",
        ),
        (
            "title=",
            "--set title=: there is no value behind \"=\"; give one",
        ),
        ("a..b=1", "--set a..b=1: this is not a dotted key"),
        (
            "body[0].velocity=[1, 2",
            "--set body[0].velocity=[1, 2: [1, 2 is not a TOML value",
        ),
    ] {
        let (_, said) = set(&[setting]);
        assert_eq!(said.len(), 1, "{said:?}");
        assert!(said[0].starts_with(wanted), "{said:?}");
    }
}

#[test]
fn hostile_files_are_refused_politely() {
    let deep = "a.".repeat(100_000) + "b = 1";
    let lists = format!("title = {}", "[".repeat(100_000));
    let tables = format!("a = {}", "{ b = ".repeat(50_000));
    let header = format!("[{}b]", "a.".repeat(100_000));
    for text in [deep, lists, tables, header] {
        assert!(read(&Document::parse(&text, &[])) > 0);
    }
    let constants: String = (0..20_000)
        .map(|i| format!("c{i} = \"c{}\"\n", i + 1))
        .collect();
    let document = Document::parse(&format!("[constants]\n{constants}c20000 = 1"), &[]);
    assert_eq!(document.constants()["c0"].value, 1.0);
    let document = Document::from_bytes(b"title = 1\nb = \xff", &[]);
    assert_eq!(
        said(&document),
        ["line 2: the file is not UTF-8 text from here on; save it with that encoding"]
    );
    set(&[
        &format!("{}b=1", "a.".repeat(100_000)),
        &format!("a{}=1", "[0]".repeat(100_000)),
    ]);
}

#[test]
fn no_file_makes_the_program_panic() {
    let mut random = Random(7);
    let pieces = [
        "[",
        "]",
        "{",
        "}",
        "\"",
        "'",
        "=",
        ".",
        "\n",
        "#",
        "1",
        "nan",
        "\\u",
        "µ",
        "[[body]]\n",
        "[a]\n",
        "\"\"\"",
    ];
    for i in 0..4_000 {
        let text = random.mutate(SCENE, &pieces);
        let setting = random.mutate("body[0].shape.box.max[1]=[\"2 m\"]", &pieces);
        let document = Document::parse(
            &text,
            if i % 2 == 0 {
                &[]
            } else {
                std::slice::from_ref(&setting)
            },
        );
        read(&document);
        let text = report("scene.toml", document.source(), &document.problems());
        assert!(text.starts_with("error: scene.toml has"));
        if document.problems().is_empty() {
            let again = Document::parse(document.resolved(), &[]);
            assert_eq!(
                read(&again),
                0,
                "{setting}\n{:?}\n{}",
                again.problems(),
                document.resolved()
            );
        }
    }
}
