//! Small scenes that several tests share, and all combinations of methods to run them with.
#![allow(dead_code)] // every test uses some of it

use mpm::basis::BasisChoice;
use mpm::scenario::{Scenario, parse};
use mpm::transfer::TransferChoice;

/// A basis, a transfer and an update, as a scenario names them.
#[derive(Clone, Debug)]
pub struct Variant {
    pub basis: &'static str,
    /// A value of TOML.
    pub transfer: String,
    pub update: &'static str,
    pub frame: &'static str,
}

impl Variant {
    pub fn table(&self) -> String {
        let Self {
            basis,
            transfer,
            update,
            frame,
        } = self;
        format!(
            "[method]\nbasis = \"{basis}\"\ntransfer = {transfer}\nupdate = \"{update}\"\nframe = \"{frame}\"\n"
        )
    }

    pub fn is_apic(&self) -> bool {
        self.transfer.contains("apic")
    }

    pub fn is_total(&self) -> bool {
        self.frame == "total"
    }
}

/// Every combination of methods, and FLIP with a share of PIC, in both frames.
pub fn variants() -> Vec<Variant> {
    ["updated", "total"]
        .into_iter()
        .flat_map(variants_in)
        .collect()
}

/// Those of one frame.
pub fn variants_in(frame: &'static str) -> Vec<Variant> {
    let transfers = TransferChoice::NAMES
        .iter()
        .map(|name| format!("\"{name}\""));
    let transfers: Vec<_> = transfers
        .chain(["{ flip = { ratio = 0.9 } }".to_string()])
        .collect();
    let mut variants = Vec::new();
    for basis in BasisChoice::NAMES {
        for transfer in &transfers {
            for update in ["usf", "usl", "musl"] {
                variants.push(Variant {
                    basis,
                    transfer: transfer.clone(),
                    update,
                    frame,
                });
            }
        }
    }
    variants
}

/// `[a, b, c]` with as many numbers as there are axes.
pub fn list<T: std::fmt::Display>(dimension: usize, numbers: [T; 3]) -> String {
    let numbers: Vec<_> = numbers[..dimension]
        .iter()
        .map(ToString::to_string)
        .collect();
    format!("[{}]", numbers.join(", "))
}

/// The same for texts.
pub fn texts(dimension: usize, texts: [&str; 3]) -> String {
    list(dimension, texts.map(|text| format!("\"{text}\"")))
}

/// What a scene has besides its method.
#[derive(Clone, Debug)]
pub struct Scene {
    pub dimension: usize,
    pub cells: [u32; 3],
    pub cell_size: f64,
    pub step: f64,
    pub steps: u32,
    /// A constitutive law with its parameters.
    pub law: String,
    /// Top-level keys.
    pub head: String,
    /// Bodies and all that follows.
    pub rest: String,
}

impl Scene {
    pub fn text(&self, variant: &Variant) -> String {
        let Self {
            dimension,
            cells,
            cell_size,
            step,
            steps,
            law,
            head,
            rest,
        } = self;
        let min = list(*dimension, [0.0; 3]);
        let max = list(*dimension, cells.map(|n| f64::from(n) * cell_size));
        let end = step * f64::from(*steps);
        let method = variant.table();
        format!(
            "dimension = {dimension}\n{head}\n[time]\nend = {end:e}\nstep = {step:e}\n\
             [grid]\nmin = {min}\nmax = {max}\ncell_size = {cell_size}\n{method}\
             [material.stuff]\ndensity = 1.5\n{law}\n[output]\nevery = {step:e}\n{rest}"
        )
    }

    pub fn scenario(&self, variant: &Variant) -> Scenario {
        let text = self.text(variant);
        parse("scene", &text, &[])
            .unwrap_or_else(|error| panic!("{error}\n{text}"))
            .scenario
    }
}

pub const NEO_HOOKEAN: &str = "neo_hookean = { youngs_modulus = 20, poissons_ratio = 0.3 }";

/// A box that flies, turns and stretches, and crosses from one block of the grid to the next; its sound travels at about
/// 4 m/s, so that methods that are not stable have no time to show it.
pub fn flying_box(dimension: usize) -> Scene {
    // just before the end of a block in one, two and three dimensions
    let start = [30.5, 6.5, 2.5][dimension - 1];
    let low = [start, start + 0.25, start];
    let high = [start + 1.5, start + 1.25, start + 1.0];
    let center = [0, 1, 2].map(|a| 0.5 * (low[a] + high[a]));
    let [x, y, z] = center;
    let velocity = match dimension {
        1 => [format!("12 + 1 * (x - {x})"), String::new(), String::new()],
        2 => [
            format!("12 + 1 * (x - {x}) - 3 * (y - {y})"),
            format!("10 + 3 * (x - {x}) - 1 * (y - {y})"),
            String::new(),
        ],
        _ => [
            format!("12 + 1 * (x - {x}) - 3 * (y - {y}) + 2 * (z - {z})"),
            format!("10 + 3 * (x - {x}) - 1 * (y - {y})"),
            format!("8 - 2 * (x - {x}) + 1 * (z - {z})"),
        ],
    };
    let [u, v, w] = &velocity;
    let rest = format!(
        "[[body]]\nname = \"box\"\nmaterial = \"stuff\"\nshape.box = {{ min = {}, max = {} }}\nvelocity = {}\n",
        list(dimension, low),
        list(dimension, high),
        texts(dimension, [u, v, w]),
    );
    let cells = [[120; 3], [40; 3], [20; 3]][dimension - 1];
    Scene {
        dimension,
        cells,
        cell_size: 0.5,
        step: 0.004,
        steps: 40,
        law: NEO_HOOKEAN.into(),
        head: String::new(),
        rest,
    }
}
