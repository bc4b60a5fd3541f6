//! What a run says of itself while it goes and when it has ended.

use crate::solver::Account;
use serde::Serialize;

/// How far a run is.
#[derive(Clone, Copy, Debug)]
pub struct Progress {
    /// Simulated time, s.
    pub time: f64,
    /// Simulated time at the end, s.
    pub end: f64,
    /// Steps taken.
    pub steps: u64,
    /// Size of the last step, s.
    pub dt: f64,
    /// Points.
    pub points: usize,
}

/// What a finished (or stopped) run has to say, as in `summary.json`.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Summary {
    /// "done", or why the run stopped.
    pub status: String,
    /// Title of the scenario.
    pub title: String,
    /// 1, 2 or 3.
    pub dimension: usize,
    /// Points of all bodies.
    pub particles: usize,
    /// Steps taken.
    pub steps: u64,
    /// Simulated time reached, s.
    pub time: f64,
    /// Simulated time asked for, s.
    pub end: f64,
    /// Smallest and largest step, s (the last step of a fixed-step run, which is cut to meet the end, not counted).
    pub dt: [f64; 2],
    /// Wall time of the run, s.
    pub wall_seconds: f64,
    /// Points times steps a second of wall time.
    pub particle_steps_per_second: f64,
    /// Largest memory of the process so far, bytes; 0 where the system does not tell.
    pub peak_memory: u64,
    /// Threads that the run could use.
    pub threads: usize,
    /// Energies at the last recorded time, J.
    pub energy: Energies,
    /// Largest |residual| of the energy account at a recorded time, over the largest energy turned over.
    pub worst_energy_residual: f64,
    /// Linear momentum of all bodies at the start and at the last recorded time, kg m/s.
    pub momentum: [Vec<f64>; 2],
    /// Steps that exceeded the stable one by the wave-speed estimate, with the largest excess as a ratio; null if none did.
    pub warning: Option<String>,
    /// Recorded rows in each table.
    pub rows: u64,
    /// Time of the last recorded row, s; energies and the second momentum are those of it.
    pub recorded: f64,
}

/// The energy account, J.
#[derive(Clone, Copy, Debug, Default, Serialize)]
#[allow(missing_docs)]
pub struct Energies {
    pub kinetic: f64,
    pub elastic: f64,
    pub potential: f64,
    pub external_work: f64,
    pub boundary_work: f64,
    pub damping: f64,
    pub numerical: f64,
    pub total: f64,
    pub residual: f64,
    pub turned_over: f64,
}

impl From<&Account> for Energies {
    fn from(account: &Account) -> Self {
        Self {
            kinetic: account.stored.kinetic,
            elastic: account.stored.elastic,
            potential: account.stored.potential,
            external_work: account.external_work,
            boundary_work: account.boundary_work,
            damping: account.damping,
            numerical: account.numerical,
            total: account.total,
            residual: account.residual,
            turned_over: account.turned_over,
        }
    }
}

/// Largest memory of this process so far, bytes; 0 where the system does not tell.
pub fn peak_memory() -> u64 {
    from_status("VmHWM:")
}

/// Memory that this process has now, bytes; 0 where the system does not tell.
pub fn memory_now() -> u64 {
    from_status("VmRSS:")
}

/// A number of bytes that Linux tells of this process.
fn from_status(name: &str) -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix(name));
    let kibibytes = line.and_then(|line| {
        line.trim()
            .trim_end_matches("kB")
            .trim()
            .parse::<u64>()
            .ok()
    });
    kibibytes.unwrap_or(0) * 1024
}
