//! What a scenario file means, once every problem in it has been ruled out.
//!
//! [`Scenario`] holds plain checked values in SI units: lists have the length that the dimension asks for, names are resolved
//! to numbers and choices. It knows no file, no solver and no grid storage.

mod check;
mod fill;
mod load;
mod placement;
pub mod shape;

pub use crate::boundary::Side;
pub use fill::{Faces, Filling, PointSet, body_point_count, body_points, loaded_faces};
pub use load::{InputError, Loaded, load, parse};
pub use placement::{Placement, bending_moment};

use crate::basis::BasisChoice;
use crate::boundary::ConditionChoice;
use crate::input::Expression;
use crate::material::{LawChoice, Plane};
use crate::transfer::TransferChoice;

/// A complete, checked scene.
#[derive(Clone, Debug)]
pub struct Scenario {
    /// One line for people.
    pub title: String,
    /// 1, 2 or 3.
    pub dimension: usize,
    /// What the directions that are not modelled do.
    pub plane: Plane,
    /// Duration, s.
    pub end: f64,
    /// How the time step is chosen.
    pub step: StepRule,
    /// The background grid.
    pub grid: GridSpec,
    /// The numerical method.
    pub method: Method,
    /// Materials, in file order.
    pub materials: Vec<MaterialSpec>,
    /// Bodies, in file order.
    pub bodies: Vec<BodySpec>,
    /// Conditions on grid nodes, in file order (a later one acts on what an earlier one left).
    pub boundaries: Vec<BoundarySpec>,
    /// Forces on material points.
    pub loads: Vec<LoadSpec>,
    /// Acceleration of gravity, m/s², one number an axis.
    pub gravity: Vec<f64>,
    /// Mass-proportional damping rate α of the force −α m v, 1/s; 0 is none.
    pub damping: f64,
    /// What is recorded, and when.
    pub output: OutputSpec,
    /// Followed material points.
    pub probes: Vec<ProbeSpec>,
}

impl Scenario {
    /// The method that this scene would get if its file named none.
    pub fn default_method(&self) -> Option<Method> {
        check::default_method(self)
    }
}

/// How the time step is chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StepRule {
    /// Always this many seconds.
    Fixed(f64),
    /// This share of (cell size) / (wave speed + particle speed), found anew as the run goes.
    Courant(f64),
}

/// The background grid: cubes of `cell_size` filling a box.
#[derive(Clone, Debug, PartialEq)]
pub struct GridSpec {
    /// Lower corner, m.
    pub min: Vec<f64>,
    /// Upper corner, m: `min + cells * cell_size`.
    pub max: Vec<f64>,
    /// Edge of a cell, m.
    pub cell_size: f64,
    /// Cells an axis, each at least 1.
    pub cells: Vec<i32>,
}

/// The numerical method.
#[derive(Clone, Debug)]
pub struct Method {
    /// Shape functions.
    pub basis: BasisChoice,
    /// Velocity transfer.
    pub transfer: TransferChoice,
    /// When stresses are updated.
    pub update: Scheme,
    /// Which configuration the shape functions belong to.
    pub frame: ReferenceFrame,
    /// Where in their cells points lie before the first step.
    pub placement: Placement,
    /// What the file leaves to the scene.
    pub chosen: Vec<Chosen>,
}

/// A key of the method that the file leaves out, and what this scene gets.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Chosen {
    /// `frame`, `basis` or `placement`.
    pub key: &'static str,
    /// What it is.
    pub value: &'static str,
    /// What in the scene decides.
    pub why: &'static str,
}

impl std::fmt::Display for Chosen {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} {}: {}", self.key, self.value, self.why)
    }
}

/// The configuration of the bodies that shape functions are taken in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ReferenceFrame {
    /// `updated`: the present one; points move through the grid.
    #[default]
    Updated,
    /// `total`: the initial one; points stay where they are in the grid, and their present positions are found beside it.
    Total,
}

impl ReferenceFrame {
    /// All names.
    pub const NAMES: [&'static str; 2] = ["updated", "total"];

    /// Its name in a scenario.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Updated => Self::NAMES[0],
            Self::Total => Self::NAMES[1],
        }
    }
}

/// When in a step the stresses are updated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scheme {
    /// `usf`: before the forces, from the mapped velocities.
    UpdateStressFirst,
    /// `usl`: after the particles have moved, from the updated grid velocities.
    UpdateStressLast,
    /// `musl`: after the updated particle velocities have been mapped to the grid again.
    ModifiedUpdateStressLast,
}

impl Scheme {
    /// All of them.
    pub const ALL: [Self; 3] = [
        Self::UpdateStressFirst,
        Self::UpdateStressLast,
        Self::ModifiedUpdateStressLast,
    ];

    /// Its name in a scenario.
    pub fn name(&self) -> &'static str {
        match self {
            Self::UpdateStressFirst => "usf",
            Self::UpdateStressLast => "usl",
            Self::ModifiedUpdateStressLast => "musl",
        }
    }
}

/// A material: a density and a law.
#[derive(Clone, Debug)]
pub struct MaterialSpec {
    /// Name in the file.
    pub name: String,
    /// Initial mass density, kg/m³ (also in 1D and 2D, where a cross-section of 1 m² and a thickness of 1 m are meant).
    pub density: f64,
    /// Constitutive law.
    pub law: LawChoice,
    /// Poisson's ratio, if the law has one.
    pub poissons_ratio: Option<f64>,
}

/// A body: a shape filled with points.
#[derive(Clone, Debug)]
pub struct BodySpec {
    /// Unique name.
    pub name: String,
    /// Index into [`Scenario::materials`].
    pub material: usize,
    /// Geometry.
    pub shape: shape::Shape,
    /// Points per cell along each axis.
    pub particles_per_cell: Vec<u32>,
    /// Second moment of the points of a cell about its middle, in parts of that of the cell; none where they are placed evenly.
    pub moment: Option<f64>,
    /// Initial velocity, m/s, one expression of x, y, z (at t = 0) an axis.
    pub velocity: Vec<Expression>,
}

/// Where a condition acts, or a load on flat sides.
#[derive(Clone, Debug, PartialEq)]
pub enum Region {
    /// Boundaries: the nodes on this side of the grid. Loads: the outermost layer of the body's points on this side.
    Side(Side),
    /// Nodes or points (in their initial position) inside this closed box, m; infinite where the file leaves a bound open, and
    /// a billionth of a cell larger than the file says, so that round-off does not decide what lies on its surface.
    Box {
        /// Lower corner.
        min: Vec<f64>,
        /// Upper corner.
        max: Vec<f64>,
    },
}

/// A condition on grid nodes.
#[derive(Clone, Debug)]
pub struct BoundarySpec {
    /// Unique name; names the output file.
    pub name: String,
    /// Which nodes.
    pub on: Region,
    /// What is imposed there.
    pub condition: ConditionChoice,
}

/// Where a load acts.
#[derive(Clone, Debug, PartialEq)]
pub enum LoadPlace {
    /// A side of the body, or the points in a box.
    Region(Region),
    /// The points (in their initial position) inside a shape; for a pressure the free faces of points that look into it.
    Shape(shape::Shape),
}

/// Forces on the points of one body.
#[derive(Clone, Debug)]
pub struct LoadSpec {
    /// Unique name.
    pub name: String,
    /// Index into [`Scenario::bodies`].
    pub body: usize,
    /// Which points, or which of their faces.
    pub on: LoadPlace,
    /// What acts on them.
    pub kind: LoadKind,
    /// Multiplies the load; an expression of t.
    pub factor: Option<Expression>,
}

/// What a load is.
#[derive(Clone, Debug, PartialEq)]
pub enum LoadKind {
    /// Total force over all chosen points, N, shared in proportion to their mass.
    Force(Vec<f64>),
    /// Force per initial area of the loaded side, Pa.
    Traction {
        /// Components, Pa.
        traction: Vec<f64>,
        /// The side whose area counts.
        side: Side,
    },
    /// Pressure on the loaded faces, Pa, positive into the body, in the direction of the undeformed normal.
    Pressure {
        /// Size, Pa.
        pressure: f64,
        /// The side that it acts on; none in [`LoadPlace::Shape`], where faces of every direction are loaded.
        side: Option<Side>,
    },
    /// Acceleration of every chosen point, m/s²: expressions of its initial position and of time.
    Acceleration(Vec<Expression>),
}

/// What is recorded, and when.
#[derive(Clone, Debug, PartialEq)]
pub struct OutputSpec {
    /// Seconds between two recorded rows; the start and the end are always recorded.
    pub every: f64,
}

/// A material point that is followed.
#[derive(Clone, Debug, PartialEq)]
pub struct ProbeSpec {
    /// Unique name; names the output file.
    pub name: String,
    /// Index into [`Scenario::bodies`].
    pub body: usize,
    /// Which of its points.
    pub target: ProbeTarget,
}

/// Which point a probe follows.
#[derive(Clone, Debug, PartialEq)]
pub enum ProbeTarget {
    /// By number, in the order in which the body was filled.
    Particle(usize),
    /// The one closest to a place, m, at the start (the lowest number among equals).
    Near(Vec<f64>),
}
