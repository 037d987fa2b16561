//! The declaration, and spirals on a block of unit vectors in closed form.
//!
//! A spiral is q = (sin α cos φ, sin α sin φ, cos α) with φ = k·x + ωt. For every tilt α it solves the equations of the grid, with
//! ```text
//! sin²(ωh/2)/h² = Σ sin²(k_d dx/2)/dx²
//! ```

use clebsch::{Clebsch, Field, FieldStepper, Grid};
use clebsch_examples::integrate::FieldOf;
use clebsch_examples::scene::Failure;
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// Waves of unit vectors in three directions of space.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost   = |h, F| (F - I).norm_squared() / (4 * h),
    space  = [
        |dx, q, next| (next - q).norm_squared() / (2 * dx.powi(2)),
        |dy, q, next| (next - q).norm_squared() / (2 * dy.powi(2)),
        |dz, q, next| (next - q).norm_squared() / (2 * dz.powi(2)),
    ],
)]
pub struct Block;

/// Tilt of the spirals, rad.
const TILT: f64 = 0.9;
/// Waves of the spiral along each side.
const WAVES: [f64; 3] = [1.0, 1.0, 2.0];

/// Unit vectors on a periodic cube of side 1 m.
#[derive(Clone)]
pub struct Cube {
    /// Its steps.
    pub stepper: Steps,
    /// Its sites.
    pub state: FieldOf<Block>,
    /// Sites along each side.
    pub side: usize,
}

/// Steps of a block.
pub type Steps = FieldStepper<Block, Grid<f64, 3>>;

/// The largest distance of a site from the spiral.
pub fn off(side: usize, stepper: &Steps, state: &FieldOf<Block>) -> f64 {
    let h = stepper.step_size();
    let turned = omega(side, h * side as f64) * h * state.steps() as f64;
    let far = |(index, q): (usize, &Vector3<f64>)| (q - vector(phase(side, index) + turned)).amax();
    state.configuration().iter().enumerate().map(far).fold(0.0, f64::max)
}

impl Cube {
    /// A spiral on so many sites along each side. A step is this part of the spacing.
    ///
    /// # Errors
    /// Those of a start.
    pub fn spiral(side: usize, part: f64) -> Result<Self, Failure> {
        let dx = 1.0 / side as f64;
        let stepper = Block.grid([side; 3]).spacing([dx; 3]).periodic().stepper(part * dx)?;
        let q: Vec<Vector3<f64>> = (0..side.pow(3)).map(|index| vector(phase(side, index))).collect();
        // N = q × (q₊ − q₋)/2h
        let rate = (omega(side, part) * part * dx).sin() / (part * dx);
        let mu: Vec<Vector3<f64>> = q.iter().map(|q| (Vector3::z() - q * q.z) * rate).collect();
        let state = stepper.state(q, mu)?;
        Ok(Self { stepper, state, side })
    }

    /// Bytes of the sites.
    pub fn bytes(&self) -> usize {
        self.state.configuration().len() * 2 * size_of::<Vector3<f64>>()
    }
}

/// k·x of a site.
fn phase(side: usize, index: usize) -> f64 {
    let place = [index / (side * side), index / side % side, index % side];
    let around: f64 = (0..3).map(|d| WAVES[d] * place[d] as f64).sum();
    TAU * (around / side as f64).fract()
}

fn vector(phase: f64) -> Vector3<f64> {
    let ((sin, cos), (up, down)) = (TILT.sin_cos(), phase.sin_cos());
    Vector3::new(sin * down, sin * up, cos)
}

/// Of the grid, 1/s.
fn omega(side: usize, part: f64) -> f64 {
    let sum: f64 = WAVES.map(|waves| (TAU * waves / side as f64 / 2.0).sin().powi(2)).iter().sum();
    2.0 * side as f64 / part * (part * sum.sqrt()).asin()
}
