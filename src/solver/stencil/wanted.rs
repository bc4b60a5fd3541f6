//! What a pass from the grid to points brings.

/// What points take from the grid.
#[derive(Clone, Copy, Debug)]
pub struct Wanted {
    /// New velocities, and affine fields.
    pub velocity: bool,
    /// New positions.
    pub position: bool,
    /// Velocity gradients.
    pub rate: bool,
    /// Whether the gradients are those of `main`; else of `second`.
    pub same: bool,
}

impl Wanted {
    /// Update stress last: everything from the velocities at the end of the step.
    pub const ALL: Self = Self {
        velocity: true,
        position: true,
        rate: true,
        same: true,
    };
    /// New velocities and positions.
    pub const MOTION: Self = Self {
        rate: false,
        same: false,
        ..Self::ALL
    };
    /// New velocities.
    pub const VELOCITY: Self = Self {
        position: false,
        ..Self::MOTION
    };
    /// Gradients of the second velocities.
    pub const STRAIN: Self = Self {
        velocity: false,
        position: false,
        rate: true,
        same: false,
    };
    /// New positions, and gradients of the second velocities. Positions follow the velocities at the end of the step, which
    /// points that take them whole have by now.
    pub const POSITION_AND_STRAIN: Self = Self {
        position: true,
        ..Self::STRAIN
    };
}
