//! How fast this machine moves memory, measured here and now.

use rayon::prelude::*;
use serde::Serialize;
use std::time::Instant;

/// What a machine has that speed depends on.
#[derive(Clone, Debug, Serialize)]
pub struct Machine {
    /// What the processor calls itself; empty where the system does not tell.
    pub processor: String,
    /// Threads that run at the same time.
    pub threads: usize,
    /// Whether the wide instructions (AVX2 and FMA) of the fast kernels are there.
    pub wide_instructions: bool,
    /// Which they are.
    pub instructions: &'static str,
    /// Memory bandwidth for each number of threads that is benched.
    pub bandwidth: Vec<Bandwidth>,
}

/// Memory bandwidth.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Bandwidth {
    /// Threads that moved memory.
    pub threads: usize,
    /// `a[i] = b[i] + s c[i]`, GB/s, 24 bytes an element (what the processor reads of `a` before it overwrites it is not counted).
    pub triad: f64,
    /// `a[i] = a[i] + s b[i]`, GB/s, 24 bytes an element: like a step, it changes memory where it lies.
    pub update: f64,
}

impl Bandwidth {
    /// The larger of the two, GB/s.
    pub fn best(&self) -> f64 {
        self.triad.max(self.update)
    }
}

/// Numbers in an array: 64 MB each, three of them, more than caches hold.
const COUNT: usize = 1 << 23;
/// Numbers that a thread takes at once.
const PIECE: usize = 1 << 16;
/// The best of so many passes counts: whatever else the machine does only takes away.
const PASSES: usize = 6;

/// Describes this machine; takes some tenths of a second for each number of threads.
///
/// # Errors
/// If the system refuses threads.
pub fn machine(threads: &[usize]) -> Result<Machine, rayon::ThreadPoolBuildError> {
    let bandwidth = threads.iter().map(|&threads| bandwidth(threads, COUNT));
    let instructions = crate::real::Instructions::found();
    Ok(Machine {
        processor: processor(),
        threads: std::thread::available_parallelism().map_or(1, usize::from),
        wide_instructions: instructions.wide(),
        instructions: instructions.name(),
        bandwidth: bandwidth.collect::<Result<_, _>>()?,
    })
}

/// Measures the bandwidth of arrays of `count` numbers.
///
/// # Errors
/// If the system refuses threads.
pub fn bandwidth(threads: usize, count: usize) -> Result<Bandwidth, rayon::ThreadPoolBuildError> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()?;
    let mut a = vec![0.0_f64; count];
    let (b, c) = (vec![1.5_f64; count], vec![2.5_f64; count]);
    let bytes = 24.0 * count as f64;
    let (mut triad, mut update) = (0.0_f64, 0.0_f64);
    pool.install(|| {
        for _ in 0..PASSES {
            let started = Instant::now();
            let pieces = a.par_chunks_mut(PIECE).zip(b.par_chunks(PIECE));
            pieces.zip(c.par_chunks(PIECE)).for_each(|((a, b), c)| {
                for ((a, b), c) in a.iter_mut().zip(b).zip(c) {
                    *a = b + 0.5 * c;
                }
            });
            triad = triad.max(rate(bytes, started));
            let started = Instant::now();
            let pieces = a.par_chunks_mut(PIECE).zip(b.par_chunks(PIECE));
            pieces.for_each(|(a, b)| {
                for (a, b) in a.iter_mut().zip(b) {
                    *a += 0.5 * b;
                }
            });
            update = update.max(rate(bytes, started));
        }
    });
    // what nobody reads a compiler need not write
    std::hint::black_box(&a);
    Ok(Bandwidth {
        threads,
        triad,
        update,
    })
}

fn rate(bytes: f64, started: Instant) -> f64 {
    1e-9 * bytes / started.elapsed().as_secs_f64().max(1e-9)
}

fn processor() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = text
        .lines()
        .find_map(|line| line.strip_prefix("model name"));
    name.map_or_else(String::new, |name| {
        name.trim_start_matches([' ', '\t', ':']).trim().to_owned()
    })
}
