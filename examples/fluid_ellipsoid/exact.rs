//! Two motions that are known: a swirling spheroid, and a shear.

use crate::spheroid::Spheroid;
use crate::{Flags, FluidEllipsoid, geodesic};
use clebsch::{Clebsch, Declared};
use clebsch_examples::claims::Claims;
use clebsch_examples::convergence::{Convergence, refined};
use clebsch_examples::flags::{Order, Run};
use clebsch_examples::scene::Failure;
use nalgebra::Matrix3;

/// Steps of h of every comparison.
pub const STEPS: u64 = 1000;

/// The accuracy of the quadrature.
const QUADRATURE: f64 = 1e-12;

/// The spheroid by steps and by quadrature.
pub struct Swirl {
    /// (time, radius by steps)
    pub radii: Vec<(f64, f64)>,
    /// (time, radius by quadrature)
    pub exact: Vec<(f64, f64)>,
    convergence: Option<Convergence>,
}

/// Follows a swirling spheroid.
pub fn spheroid(drop: &FluidEllipsoid, spheroid: &Spheroid, run: &Run) -> Result<Swirl, Failure> {
    /// Points of the figure.
    const POINTS: u64 = 50;
    let steps = run.steps.min(STEPS);
    let (q, velocity) = spheroid.start();
    let momentum = geodesic::momentum(drop.mass, &q, &velocity);
    let stepper = drop.clone().into_stepper(run.step_size)?;
    let radius = |q: &Matrix3<f64>| q.m11.hypot(q.m21);
    let mut swirl = Swirl { radii: Vec::new(), exact: Vec::new(), convergence: None };
    for (step, state) in (0..=steps).zip(stepper.trajectory(stepper.state(q, momentum)?)) {
        let state = state.map_err(|error| Failure::Step { step, error })?;
        swirl.radii.push((run.time(step), radius(state.configuration())));
        if step.is_multiple_of(steps.div_ceil(POINTS)) {
            swirl.exact.extend(spheroid.at(run.time(step)).map(|q| (run.time(step), radius(&q))));
        }
    }
    if let Some(end) = spheroid.at(run.time(steps)) {
        let size = end.amax();
        let ends = refined::<_, Declared>(drop, run, steps, |stepper| stepper.state(q, momentum))?;
        let errors = ends.map(|state| (state.configuration() - end).amax() / size);
        let size_of_momentum = momentum.amax().max(f64::MIN_POSITIVE);
        let rounding = geodesic::rounding(drop.mass, &end, &velocity) / size_of_momentum;
        let reference = QUADRATURE + rounding * (4.0 * steps as f64).sqrt();
        swirl.convergence = Some(Convergence { errors, reference, steps });
    }
    Ok(swirl)
}

impl Swirl {
    /// The steps converge to the quadrature.
    pub fn claim(&self, claims: &mut Claims) {
        let name = "the order against the quadrature of a swirling spheroid";
        match self.convergence {
            Some(convergence) => convergence.claim(Order::Second, name, claims),
            None => claims.skip(name, "at rest, or it contracts without swirl: the quadrature ends at radius zero"),
        }
    }
}

/// How far a shear is from its flow.
pub struct Shear {
    defect: f64,
    scale: f64,
    steps: u64,
}

/// The flow q(t) = (I + t S) q₀ with S = G₁₂ E₁₂ has no acceleration: a straight line of the flat metric that stays on SL(3).
pub fn shear(drop: &FluidEllipsoid, flags: &Flags) -> Result<Shear, Failure> {
    let steps = flags.run.steps.min(STEPS);
    let (q, _) = flags.start()?;
    let mut gradient = Matrix3::zeros();
    gradient.m12 = flags.gradient[1];
    let velocity = gradient * q;
    let stepper = drop.clone().into_stepper(flags.run.step_size)?;
    let mut shear = Shear { defect: 0.0, scale: 0.0, steps };
    let start = stepper.state(q, geodesic::momentum(drop.mass, &q, &velocity))?;
    for (step, state) in (0..=steps).zip(stepper.trajectory(start)) {
        let state = state.map_err(|error| Failure::Step { step, error })?;
        let expected = q + velocity * flags.run.time(step);
        shear.defect = shear.defect.max((state.configuration() - expected).amax());
        // Momenta are rounded relative to |q̇||q|, and q̇ is found from them with |q⁻¹|.
        let condition = expected.norm() * expected.try_inverse().map_or(f64::INFINITY, |inverse| inverse.norm());
        shear.scale = shear.scale.max(expected.norm() * condition);
    }
    Ok(shear)
}

impl Shear {
    /// The steps are on the line.
    pub fn claim(&self, claims: &mut Claims) {
        claims.round_off("a shear follows its straight line", self.defect, self.steps, self.scale);
    }
}
