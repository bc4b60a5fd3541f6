//! Every wrong scenario is refused with a message that says what is wrong and where, and no text at all makes a panic.

use mpm::scenario::{load, parse};
use std::fs;
use std::panic::catch_unwind;
use std::path::{Path, PathBuf};

fn files(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests")
        .join(folder);
    let entries = fs::read_dir(folder).expect("the folder is part of the sources");
    let mut files: Vec<_> = entries
        .map(|entry| entry.expect("readable").path())
        .collect();
    files.sort();
    files
}

/// What is missing in the shown problems. `line 14, some text` asks for one problem of line 14 that contains the text.
fn unmet<'e>(expected: &[&'e str], shown: &[String]) -> Vec<&'e str> {
    let met = |expectation: &str| {
        let (line, text) = match expectation.strip_prefix("line ") {
            Some(rest) => rest.split_once(", ").unwrap_or((rest, "")),
            None => ("", expectation),
        };
        let place = [format!("line {line},"), format!("line {line}:")];
        shown.iter().any(|problem| {
            (line.is_empty() || place.iter().any(|place| problem.starts_with(place)))
                && problem.contains(text)
        })
    };
    expected
        .iter()
        .copied()
        .filter(|expectation| !met(expectation))
        .collect()
}

#[test]
fn every_bad_scenario_is_refused_with_the_message_that_it_expects() {
    let files = files("bad_scenarios");
    assert!(files.len() >= 70, "only {} bad scenarios", files.len());
    let mut mismatches = String::new();
    for path in &files {
        let text = fs::read_to_string(path).expect("readable");
        let expected: Vec<_> = text
            .lines()
            .filter_map(|line| line.strip_prefix("# expect: "))
            .collect();
        assert!(!expected.is_empty(), "{} expects nothing", path.display());
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        match load(path, &[]) {
            Ok(_) => mismatches += &format!("\n{name}: accepted, expected {expected:?}\n"),
            Err(error) => {
                let shown: Vec<_> = error.problems.iter().map(ToString::to_string).collect();
                let unmet = unmet(&expected, &shown);
                if !unmet.is_empty() || std::env::var_os("MPM_SHOW_PROBLEMS").is_some() {
                    mismatches += &format!(
                        "\n{name}: does not say {unmet:?}, says\n  {}\n",
                        shown.join("\n  ")
                    );
                }
            }
        }
    }
    assert!(mismatches.is_empty(), "{mismatches}");
}

#[test]
fn one_mistake_is_reported_once() {
    let mut mismatches = String::new();
    for path in files("bad_scenarios") {
        let text = fs::read_to_string(&path).expect("readable");
        let expected = text
            .lines()
            .filter(|line| line.starts_with("# expect: "))
            .count();
        let Err(error) = load(&path, &[]) else {
            continue;
        };
        if error.problems.len() != expected {
            let shown: Vec<_> = error.problems.iter().map(ToString::to_string).collect();
            mismatches += &format!("\n{}:\n  {}\n", path.display(), shown.join("\n  "));
        }
    }
    assert!(
        mismatches.is_empty(),
        "other than one problem for each expectation:{mismatches}"
    );
}

#[test]
fn files_that_are_no_scenarios_are_refused() {
    let folder = std::env::temp_dir().join(format!("mpm-not-a-scenario-{}", std::process::id()));
    fs::create_dir_all(&folder).expect("a temporary folder");
    let write = |name: &str, bytes: &[u8]| {
        let path = folder.join(name);
        fs::write(&path, bytes).expect("a temporary file");
        path
    };
    let cases = [
        (folder.join("missing.toml"), "there is no such file"),
        (folder.clone(), "this is a folder"),
        (write("empty.toml", b""), "the file is empty"),
        (write("blank.toml", b" \n\n"), "the file is empty"),
        (
            write("binary.toml", &[0, 159, 146, 150, 255, 0]),
            "not UTF-8",
        ),
        (write("zeros.toml", &[0; 5000]), "not valid TOML"),
    ];
    for (path, expected) in cases {
        let shown = load(&path, &[]).expect_err("not a scenario").to_string();
        assert!(shown.contains(expected), "{}: {shown}", path.display());
        assert!(
            shown.contains(&path.display().to_string()),
            "the file is not named: {shown}"
        );
    }
    fs::remove_dir_all(&folder).expect("still there");
}

/// Reads a text; all that matters is that reading ends.
fn survives(text: &str) {
    let read = catch_unwind(|| parse("mutant", text, &[]).map_err(|error| error.to_string()));
    match read {
        Ok(Ok(_)) => {}
        Ok(Err(shown)) => assert!(
            shown.contains("problem"),
            "refused without a reason: {shown}\n{text}"
        ),
        Err(_) => panic!("a panic while reading\n{text}"),
    }
}

#[test]
fn no_damaged_line_of_a_good_scenario_makes_a_panic() {
    let junk = [
        "",
        "0",
        "-1",
        "1e300",
        "-1e-300",
        "nan",
        "inf",
        "true",
        "\"\"",
        "\"text\"",
        "[]",
        "{}",
        "[[]]",
        "[{}]",
        "2024-01-01",
        "99999999999999999999",
        "9223372036854775807",
        "\"1 km\"",
        "\"1 nm\"",
        "[0]",
        "[0, 0, 0]",
        "[1e300, 1e300]",
        "[-1e300]",
        "\"((((\"",
        "\"sin(\"",
        "{ box = 1 }",
        "= =",
        "\"😀\"",
    ];
    for path in files("good_scenarios") {
        let good = fs::read_to_string(&path).expect("readable");
        let lines: Vec<&str> = good.lines().collect();
        for number in 0..lines.len() {
            let with = |replacement: &[&str]| {
                let mut mutant = lines.clone();
                mutant.splice(number..=number, replacement.iter().copied());
                survives(&mutant.join("\n"));
            };
            let line = lines[number];
            with(&[]);
            with(&[line, line]);
            with(&[&line.replacen(['e', 'a'], "", 1)]);
            with(&[&line.replacen(['[', '"', '{'], "", 1)]);
            with(&[&line.chars().rev().collect::<String>()]);
            if let Some((key, _)) = line.split_once('=') {
                for value in junk {
                    with(&[&format!("{key}= {value}")]);
                }
            }
        }
    }
}

#[test]
fn no_cut_or_scrambled_scenario_makes_a_panic() {
    let mut state = 0x9E37_79B9_7F4A_7C15_u64;
    let mut random = |below: usize| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state % below.max(1) as u64) as usize
    };
    for path in files("good_scenarios") {
        let good = fs::read_to_string(&path).expect("readable");
        for cut in (0..good.len())
            .step_by(7)
            .filter(|cut| good.is_char_boundary(*cut))
        {
            survives(&good[..cut]);
        }
        let characters: Vec<char> = good.chars().collect();
        for _ in 0..500 {
            let mut mutant = characters.clone();
            for _ in 0..=random(4) {
                let (from, to) = (random(mutant.len()), random(mutant.len()));
                mutant[to] = characters[from];
            }
            survives(&mutant.iter().collect::<String>());
        }
    }
}
