//! The declarations, and a line of pendulums with its angles.

use crate::solitons::Soliton;
use clebsch::{Clebsch, Domain, Field, FieldStepper, Grid, MovingField};
use clebsch_examples::integrate::FieldOf;
use clebsch_examples::scene::Failure;
use nalgebra::{Matrix2, Rotation2, Vector1};
use std::f64::consts::TAU;

/// Pendulums at the angles u with springs between them, by chords.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<2>, R: SO<2>| R * F,
    cost      = |h, F| (F - I).norm_squared() / (4 * h),
    potential = |R| 1 - R[(0, 0)],
    space     = |dx, W| (W - I).norm_squared() / (4 * dx.powi(2)),
)]
pub struct Chord;

/// The same by angles: the exponential in time, and the angle of an edge by its strain 2 tan(θ/2).
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<2>, R: SO<2>| R * F,
    lagrangian     = |xi| xi.norm_squared() / 2,
    discretization = exponential,
    potential      = |R| 1 - R[(0, 0)],
    space          = |dx, W| {
        let angle = 2 * (W.cayley().x / 2).atan();
        angle.powi(2) / (2 * dx.powi(2))
    },
)]
pub struct Angle;

/// One of both.
pub trait Pendulums:
    Field<1> + MovingField + Clebsch<Scalar = f64, Configuration = Matrix2<f64>, Momentum = Vector1<f64>, Time = ()> + Clone
{
}

impl Pendulums for Chord {}
impl Pendulums for Angle {}

/// Sites of a line, and steps.
#[derive(Clone, Copy, Debug)]
pub struct Mesh {
    /// Metres.
    pub length: f64,
    /// Metres.
    pub dx: f64,
    /// Seconds.
    pub h: f64,
    /// Number of steps.
    pub steps: u64,
}

impl Mesh {
    /// The number of sites.
    pub fn sites(&self) -> usize {
        (self.length / self.dx).round() as usize + 1
    }

    /// The places of the sites, the middle at 0.
    pub fn places(&self) -> impl Iterator<Item = f64> + use<> {
        let (dx, middle) = (self.dx, (self.sites() - 1) as f64 / 2.0);
        (0..self.sites()).map(move |i| (i as f64 - middle) * dx)
    }

    /// The same length and time with other spacings and steps: `part` times as many.
    #[must_use]
    pub fn refined(&self, part: f64) -> Self {
        let steps = (self.steps as f64 * part).round() as u64;
        Self { dx: self.dx / part, h: self.h / part, steps, ..*self }
    }

    /// Seconds.
    pub fn time(&self) -> f64 {
        self.h * self.steps as f64
    }
}

/// Steps of a line with free ends.
pub type Steps<S> = FieldStepper<S, Grid<f64, 1>>;

/// A line of pendulums.
pub struct Line<S: Pendulums> {
    /// Its steps.
    pub stepper: Steps<S>,
    /// Its sites.
    pub state: FieldOf<S>,
}

impl<S: Pendulums> Line<S> {
    /// A line that starts as a soliton at a time.
    ///
    /// # Errors
    /// Those of a start.
    pub fn start(system: &S, mesh: &Mesh, soliton: &Soliton, from: f64) -> Result<Self, Failure> {
        let domain: Domain<S, Grid<f64, 1>> = system.grid([mesh.sites()]).spacing([mesh.dx]).free();
        let stepper = domain.stepper(mesh.h)?;
        let waves: Vec<[f64; 2]> = mesh.places().map(|x| soliton.at(x, from)).collect();
        let turns: Vec<_> = waves.iter().map(|[u, _]| Rotation2::new(*u).into_inner()).collect();
        let rates: Vec<_> = waves.iter().map(|[_, rate]| Vector1::new(*rate)).collect();
        let state = stepper.state(turns, rates)?;
        Ok(Self { stepper, state })
    }

    /// Moves on.
    ///
    /// # Errors
    /// Those of steps.
    pub fn advance(&mut self, steps: u64) -> Result<(), Failure> {
        let before = self.state.steps();
        self.stepper.advance(&mut self.state, steps).map_err(Failure::step(before + 1))
    }

    /// J.
    ///
    /// # Errors
    /// None of a line that has been made.
    pub fn energy(&self) -> Result<f64, Failure> {
        let dx = self.stepper.lattice().spacings()[0];
        Ok(self.stepper.energy(&self.state).map_err(Failure::step(self.state.steps()))? * dx)
    }

    /// u of all sites; neighbours are less than half a turn apart, and the first is near 0.
    pub fn angles(&self) -> Vec<f64> {
        let mut last: f64 = 0.0;
        let turn = |turn: &Matrix2<f64>| {
            let angle = turn[(1, 0)].atan2(turn[(0, 0)]);
            last = angle + TAU * ((last - angle) / TAU).round();
            last
        };
        self.state.configuration().iter().map(turn).collect()
    }
}
