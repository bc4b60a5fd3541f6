//! `mpm`: a Material Point Method simulator for solids.
//!
//! Dependencies run one way: `cli` → `run`, `study` → `scenario`, `observe`, `report` → `solver` → `transfer`, `boundary`,
//! `material`, `basis`, `grid` → `state` → `input`, `math`, `tensor`, `real`.

pub mod basis;
pub mod boundary;
pub mod cli;
pub mod grid;
pub mod input;
pub mod material;
pub mod math;
pub mod observe;
pub mod real;
pub mod reorder;
pub mod report;
pub mod run;
pub mod scenario;
pub mod solver;
pub mod state;
pub mod study;
pub mod tensor;
pub mod totals;
pub mod transfer;
