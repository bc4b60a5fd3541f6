//! Forces on chosen points.

use crate::math::Vector;
use crate::state::Particles;

/// A number that depends on time.
pub type Factor = Box<dyn Fn(f64) -> f64 + Send + Sync>;

/// A vector that depends on a point's initial position and on time.
pub type Field<const D: usize> = Box<dyn Fn(&Vector<D>, f64) -> Vector<D> + Send + Sync>;

/// What acts on the points of a load.
pub enum LoadForce<const D: usize> {
    /// A force on each point, N, in the order of [`Load::points`], times a factor of time.
    Forces(Vec<Vector<D>>, Factor),
    /// An acceleration of each point, m/s², as a field over the initial positions, m, given in the order of [`Load::points`].
    Acceleration(Vec<Vector<D>>, Field<D>),
}

/// Forces on points of one body.
pub struct Load<const D: usize> {
    /// Index of the body.
    pub body: usize,
    /// Numbers of its loaded points, ascending.
    pub points: Vec<u32>,
    /// Where it acts, from the points, m: zero, or half a point's spacing towards the side that is loaded.
    pub offset: Vector<D>,
    /// What acts on them.
    pub force: LoadForce<D>,
}

/// All loads, and where their points are now.
pub struct Loads<const D: usize> {
    loads: Vec<Load<D>>,
    /// For each load (row of the point, index into its lists), by row.
    rows: Vec<Vec<(u32, u32)>>,
    /// For each load (row of the point, force now), by row.
    now: Vec<Vec<(u32, Vector<D>)>>,
}

impl<const D: usize> Loads<D> {
    /// Loads whose points have not been looked up yet.
    pub fn new(loads: Vec<Load<D>>) -> Self {
        Self {
            rows: loads
                .iter()
                .map(|load| Vec::with_capacity(load.points.len()))
                .collect(),
            now: loads
                .iter()
                .map(|load| Vec::with_capacity(load.points.len()))
                .collect(),
            loads,
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.loads.is_empty()
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.loads.len()
    }

    /// The body of load `index`.
    pub fn body(&self, index: usize) -> usize {
        self.loads[index].body
    }

    /// Where load `index` acts, from its points, m.
    pub fn offset(&self, index: usize) -> Vector<D> {
        self.loads[index].offset
    }

    /// Looks up the rows of a body's loaded points; called whenever its points have been re-sorted.
    pub fn locate(&mut self, body: usize, particles: &Particles<D>) {
        for (load, rows) in self.loads.iter().zip(&mut self.rows) {
            if load.body == body {
                rows.clear();
                for (row, id) in particles.id.iter().enumerate() {
                    if let Ok(entry) = load.points.binary_search(id) {
                        rows.push((row as u32, entry as u32));
                    }
                }
            }
        }
    }

    /// Evaluates all loads at `time`, s.
    pub fn evaluate(&mut self, time: f64, mass: impl Fn(usize, u32) -> f64) {
        for ((load, rows), now) in self.loads.iter().zip(&self.rows).zip(&mut self.now) {
            now.clear();
            match &load.force {
                LoadForce::Forces(forces, factor) => {
                    let factor = factor(time);
                    now.extend(
                        rows.iter()
                            .map(|&(row, entry)| (row, forces[entry as usize] * factor)),
                    );
                }
                LoadForce::Acceleration(origins, field) => {
                    now.extend(rows.iter().map(|&(row, entry)| {
                        (
                            row,
                            field(&origins[entry as usize], time) * mass(load.body, row),
                        )
                    }));
                }
            }
        }
    }

    /// The forces of load `index` on the rows of a block, as last evaluated.
    pub fn in_rows(&self, index: usize, rows: std::ops::Range<usize>) -> &[(u32, Vector<D>)] {
        let now = &self.now[index];
        let first = now.partition_point(|(row, _)| (*row as usize) < rows.start);
        let last = now.partition_point(|(row, _)| (*row as usize) < rows.end);
        &now[first..last]
    }
}
