//! `mpm bench` measures what it is asked to; what a run takes of memory is what was counted. No test asks how long anything takes.

use std::process::{Command, Output};

fn bench(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_mpm"))
        .arg("bench")
        .args(arguments)
        .output()
        .expect("the program starts")
}

fn rows(arguments: &[&str]) -> serde_json::Value {
    let output = bench(
        &[
            arguments,
            &["--json", "--repeat", "2", "--seconds", "0.001"],
        ]
        .concat(),
    );
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{said}");
    serde_json::from_slice(&output.stdout).expect("one JSON object on standard output")
}

#[test]
fn every_combination_gets_a_row_and_the_machine_is_described() {
    let result = rows(&[
        "--dimension=1,2",
        "--basis=linear,cubic",
        "--transfer=flip",
        "--update=usl,musl",
        "--particles=1000",
        "--order=lattice,random",
        "--threads=1,2",
    ]);
    let list = result["rows"].as_array().expect("rows");
    assert_eq!(list.len(), 2 * 2 * 2 * 2 * 2);
    for row in list {
        for number in [
            "nanoseconds",
            "fastest",
            "slowest",
            "particle_steps_per_second",
            "bytes_per_particle",
            "floor_bytes",
            "floor_nanoseconds",
            "share_of_floor",
        ] {
            assert!(
                row[number].as_f64().is_some_and(|x| x > 0.0),
                "{number}: {row}"
            );
        }
    }
    let machine = &result["machine"];
    assert_eq!(machine["bandwidth"].as_array().map(Vec::len), Some(2));
    assert!(machine["wide_instructions"].is_boolean());
}

#[test]
fn every_law_update_and_transfer_can_be_measured() {
    use mpm::{material::LawChoice, transfer::TransferChoice};
    let result = rows(&[
        "--dimension=3",
        "--particles=500",
        "--threads=1",
        "--update=usf,usl,musl",
        &format!("--transfer={}", TransferChoice::NAMES.join(",")),
        &format!("--law={}", LawChoice::NAMES.join(",")),
    ]);
    let expected = 3 * TransferChoice::NAMES.len() * LawChoice::NAMES.len();
    assert_eq!(result["rows"].as_array().map(Vec::len), Some(expected));
}

#[test]
fn a_process_takes_little_more_memory_than_its_points_and_nodes() {
    for (transfer, most) in [("flip", 200.0), ("apic", 290.0)] {
        let transfer = format!("--transfer={transfer}");
        let result = rows(&[
            "--dimension=3",
            "--particles=1000000",
            "--threads=2",
            "--order=lattice",
            &transfer,
        ]);
        let row = &result["rows"][0];
        let number = |name: &str| row[name].as_f64().expect("a number");
        let grown = number("memory_per_particle");
        if grown == 0.0 {
            return; // a system that does not tell
        }
        let nodes = if transfer.contains("flip") {
            64.0
        } else {
            32.0
        };
        // 8 for the sort
        let counted = number("bytes_per_particle") + 8.0 + nodes * number("nodes_per_particle");
        assert!(
            (grown / counted - 1.0).abs() < 0.06,
            "{transfer}: {grown} bytes a particle, {counted} counted"
        );
        assert!(grown < most, "{transfer}: {grown} bytes a particle");
    }
}

#[test]
fn names_that_nobody_knows_are_refused() {
    for wrong in [
        "--basis=quartic",
        "--transfer=mpic",
        "--dimension=4",
        "--law=jelly",
        "--seconds=0",
    ] {
        let output = bench(&[wrong]);
        assert_eq!(output.status.code(), Some(2), "{wrong}");
        assert!(output.stdout.is_empty(), "{wrong}");
    }
}
