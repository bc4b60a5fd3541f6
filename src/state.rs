//! What a simulation is at one instant: bodies made of material points.

use crate::material::{MaterialPoints, Present};
use crate::math::{Matrix, Sum, Vector, packed_len};
use crate::reorder;

/// The columns that every material point of a body has. Columns that a scene does not need stay empty.
#[derive(Clone, Debug, Default)]
pub struct Particles<const D: usize> {
    /// x, m.
    pub position: Vec<Vector<D>>,
    /// v, m/s.
    pub velocity: Vec<Vector<D>>,
    /// m, kg.
    pub mass: Vec<f64>,
    /// V₀, m³ (2D: for a thickness of 1 m, or the full ring of an axisymmetric scene; 1D: for a section of 1 m²).
    pub initial_volume: Vec<f64>,
    /// Kirchhoff stress τ = J σ, Pa, packed: `D (D + 1) / 2` numbers a point.
    pub stress: Vec<f64>,
    /// APIC's affine velocity field C, 1/s; empty for other transfers.
    pub affine: Vec<Matrix<D>>,
    /// Kirchhoff hoop stress, Pa; empty unless axisymmetric.
    pub hoop_stress: Vec<f64>,
    /// Hoop stretch; empty unless axisymmetric.
    pub hoop_stretch: Vec<f64>,
    /// The number that the point got when its body was filled. Rows are re-sorted for speed as a run goes; this is not.
    pub id: Vec<u32>,
}

impl<const D: usize> Particles<D> {
    /// How many points there are.
    pub fn len(&self) -> usize {
        self.position.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.position.is_empty()
    }

    /// Hoop stretch of point `p`, 1 unless axisymmetric.
    pub fn hoop_stretch(&self, p: usize) -> f64 {
        self.hoop_stretch.get(p).copied().unwrap_or(1.0)
    }

    /// The present row of the point with number `id`.
    pub fn row_of(&self, id: u32) -> Option<usize> {
        self.id.iter().position(|&other| other == id)
    }

    /// What laws see of all points.
    pub fn present(&self) -> Present<'_> {
        Present {
            stress: &self.stress,
            hoop_stress: &self.hoop_stress,
            hoop_stretches: &self.hoop_stretch,
        }
    }

    /// Memory of one point's columns, bytes.
    pub fn bytes_per_point(&self) -> usize {
        if self.is_empty() {
            return 0;
        }
        let numbers = |column: usize| 8 * column / self.len();
        size_of::<Vector<D>>() * 2
            + 16
            + 4
            + numbers(self.stress.len())
            + size_of::<Matrix<D>>() * usize::from(!self.affine.is_empty())
            + numbers(self.hoop_stress.len())
            + numbers(self.hoop_stretch.len())
    }

    /// Whether every column has one entry for each of `count` points, or none where the scene may do without.
    pub fn are_whole(&self, count: usize, affine: bool) -> bool {
        let hoops = if self.hoop_stretch.is_empty() {
            0
        } else {
            count
        };
        self.position.len() == count
            && self.velocity.len() == count
            && self.mass.len() == count
            && self.initial_volume.len() == count
            && self.stress.len() == packed_len(D) * count
            && self.affine.len() == if affine { count } else { 0 }
            && self.hoop_stress.len() == hoops
            && self.hoop_stretch.len() == hoops
            && self.id.len() == count
    }

    /// Re-orders all columns: row `i` becomes what row `order[i]` was.
    pub fn permute(&mut self, order: &[u32], leaders: &[u32], parallel: bool) {
        let Self {
            position,
            velocity,
            mass,
            initial_volume,
            stress,
            affine,
            hoop_stress,
            hoop_stretch,
            id,
        } = self;
        let mut motion = || {
            reorder::permute_in_place(position, 1, order, leaders);
            reorder::permute_in_place(velocity, 1, order, leaders);
        };
        let mut rest = || {
            reorder::permute_in_place(mass, 1, order, leaders);
            reorder::permute_in_place(initial_volume, 1, order, leaders);
            reorder::permute_in_place(id, 1, order, leaders);
        };
        let mut stresses = || {
            reorder::permute_in_place(stress, packed_len(D), order, leaders);
            if !hoop_stress.is_empty() {
                reorder::permute_in_place(hoop_stress, 1, order, leaders);
                reorder::permute_in_place(hoop_stretch, 1, order, leaders);
            }
        };
        let mut affines = || {
            if !affine.is_empty() {
                reorder::permute_in_place(affine, 1, order, leaders);
            }
        };
        // each of the four moves about as many bytes; a join allocates nothing
        if parallel {
            rayon::join(
                || rayon::join(motion, rest),
                || rayon::join(stresses, affines),
            );
        } else {
            motion();
            rest();
            stresses();
            affines();
        }
    }
}

/// One deforming thing.
pub struct Body<const D: usize> {
    /// Its name in the scenario.
    pub name: String,
    /// Its points.
    pub particles: Particles<D>,
    /// Their law, and what they remember for it.
    pub material: Box<dyn MaterialPoints<D>>,
    /// Distance between neighbouring points at the start, m, one number an axis.
    pub spacing: Vector<D>,
    /// Initial density, kg/m³.
    pub density: f64,
}

/// Sums over the points of one body or of all.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Totals<const D: usize> {
    /// Mass, kg.
    pub mass: f64,
    /// Present volume, m³.
    pub volume: f64,
    /// Mass-weighted mean position, m.
    pub position: Vector<D>,
    /// Linear momentum, kg m/s.
    pub momentum: Vector<D>,
    /// Kinetic energy Σ ½ m v², J.
    pub kinetic: f64,
    /// Elastic energy, J.
    pub elastic: f64,
}

impl<const D: usize> Body<D> {
    /// Compensated sums over all points.
    pub fn totals(&self) -> Totals<D> {
        let p = &self.particles;
        let (mut mass, mut volume, mut kinetic) = (Sum::default(), Sum::default(), Sum::default());
        let (mut moment, mut momentum) = ([Sum::default(); D], [Sum::default(); D]);
        for i in 0..p.len() {
            mass.add(p.mass[i]);
            volume.add(p.initial_volume[i] * self.material.volume_ratio(i, p.hoop_stretch(i)));
            kinetic.add(0.5 * p.mass[i] * p.velocity[i].norm_squared());
            for a in 0..D {
                moment[a].add(p.mass[i] * p.position[i][a]);
                momentum[a].add(p.mass[i] * p.velocity[i][a]);
            }
        }
        let mass = mass.value();
        Totals {
            mass,
            volume: volume.value(),
            position: Vector::from_fn(|a, _| moment[a].value() / mass),
            momentum: Vector::from_fn(|a, _| momentum[a].value()),
            kinetic: kinetic.value(),
            elastic: self
                .material
                .energy(0..p.len(), &p.present(), &p.initial_volume),
        }
    }

    /// The Cauchy stress of point `p`, Pa, in the modelled directions.
    pub fn cauchy_stress(&self, p: usize) -> Matrix<D> {
        let width = packed_len(D);
        let j = self
            .material
            .volume_ratio(p, self.particles.hoop_stretch(p));
        crate::math::unpack(&self.particles.stress[p * width..(p + 1) * width]) / j
    }
}

/// Everything at one instant.
pub struct State<const D: usize> {
    /// t, s.
    pub time: f64,
    /// Steps taken.
    pub step: u64,
    /// The bodies, in scenario order.
    pub bodies: Vec<Body<D>>,
}

impl<const D: usize> State<D> {
    /// How many points all bodies have together.
    pub fn point_count(&self) -> usize {
        self.bodies.iter().map(|body| body.particles.len()).sum()
    }
}
