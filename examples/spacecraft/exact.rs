//! The closed forms: the period of a pitch libration, Kepler's orbit; and an orbit that feels the attitude.

use crate::body::{Body, Orientation};
use crate::equations::Equations;
use crate::libration::Tilt;
use crate::orbit::{Circle, Kepler};
use crate::{Flags, Momentum, Pose, Spacecraft, halves};
use clebsch::{Clebsch, Method};
use clebsch_examples::claims::Claims;
use clebsch_examples::convergence::{Convergence, refined};
use clebsch_examples::elliptic::complete;
use clebsch_examples::flags::Run;
use clebsch_examples::scene::Failure;
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::TAU;
use std::fmt::{self, Display, Formatter};

/// Steps of h of every comparison.
const STEPS: u64 = 300;

/// A libration in the plane of the orbit.
pub struct Pitch {
    /// Radians.
    amplitude: f64,
    /// From the steps, s: the mean over all librations that they show.
    measured: Option<f64>,
    /// 4K(sin² θ₀)/ω_p, s.
    exact: Option<f64>,
    /// 2π/ω_p, s.
    small: f64,
    /// h times the fastest rate.
    angle: f64,
}

/// Follows a libration in pitch alone, which is a pendulum in twice the angle: θ̈ = −½ω_p² sin 2θ, ω_p = n√(3(J₁ −
/// J₃)/J₂). The moments are J₁ about the direction of flight, J₂ about the normal, J₃ about the radius.
pub fn pitch<M: Method<Spacecraft>>(
    system: &Spacecraft,
    body: &Body,
    circle: &Circle,
    run: &Run,
    amplitude: f64,
) -> Result<Pitch, Failure> {
    let (orientation, equations) = (Orientation::stable(body), Equations::new(body));
    let [yaw, roll, pitch] = orientation.moments.into();
    let rate = circle.mean_motion * (3.0 * (roll - yaw) / pitch).sqrt();
    let stepper = system.stepper_by::<M>(run.step_size)?;
    let (pose, momentum) = circle.start(body, &orientation, &(Vector3::z() * amplitude));
    let mut crossings = Crossings::default();
    for (step, state) in (0..=run.steps).zip(stepper.trajectory(stepper.state(pose, momentum)?)) {
        let state = state.map_err(|error| Failure::Step { step, error })?;
        let tilt = Tilt::new(&equations, &orientation, circle, state.configuration(), &state.momentum());
        crossings.observe(run.time(step), tilt.angles.z);
    }
    let m = amplitude.sin().powi(2);
    // Beyond a right angle the body turns over instead.
    let exact = complete(0.0, m).filter(|_| amplitude.abs() < TAU / 4.0).map(|integrals| 4.0 * integrals.first / rate);
    let angle = run.step_size * rate.max(circle.mean_motion);
    Ok(Pitch { amplitude, measured: crossings.period(), exact, small: TAU / rate, angle })
}

/// Times at which an angle passes zero on its way up.
#[derive(Default)]
struct Crossings {
    last: Option<(f64, f64)>,
    first: Option<f64>,
    latest: f64,
    count: u32,
}

impl Crossings {
    fn observe(&mut self, time: f64, angle: f64) {
        if let Some((before, below)) = self.last.filter(|last| last.1 < 0.0 && angle >= 0.0) {
            self.latest = before + (time - before) * below / (below - angle);
            self.count += u32::from(self.first.is_some());
            self.first.get_or_insert(self.latest);
        }
        self.last = Some((time, angle));
    }

    fn period(&self) -> Option<f64> {
        self.first.filter(|_| self.count > 0).map(|first| (self.latest - first) / f64::from(self.count))
    }
}

impl Display for Pitch {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let seconds = |period: Option<f64>| period.map_or("-".to_owned(), |period| format!("{period:.3} s"));
        writeln!(
            f,
            "  pitch alone, amplitude {:.2}°: period {} by steps, {} by 4K/ω_p, {} for small angles",
            self.amplitude.to_degrees(),
            seconds(self.measured),
            seconds(self.exact),
            seconds(Some(self.small))
        )
    }
}

impl Pitch {
    /// The measured period is the pendulum's. Left out: (hΩ)² of it.
    pub fn claim(&self, claims: &mut Claims) {
        let name = "the period of a pitch libration is 4K(sin²θ₀)/ω_p";
        match (self.measured, self.exact) {
            (Some(measured), Some(exact)) if self.amplitude != 0.0 => {
                let error = (measured / exact - 1.0).abs();
                claims.at_most(name, error, self.angle * self.angle, "relative; ω_p = n√(3(J₁ − J₃)/J₂); (hΩ)²");
            }
            _ => claims.skip(name, "the run shows no whole libration, or the body turns over"),
        }
    }
}

/// An ellipse against Kepler's solution, and the run's own start against the equations of orbit and attitude.
pub fn convergence<M: Method<Spacecraft>>(
    system: &Spacecraft,
    body: &Body,
    flags: &Flags,
    start: (Pose, Momentum),
    claims: &mut Claims,
) -> Result<(), Failure> {
    let run = &flags.run;
    let steps = run.steps.min(STEPS);
    let time = run.time(steps);

    let kepler = Kepler {
        gravitation: flags.gravitation,
        semi_major_axis: flags.radius / (1.0 - flags.eccentricity),
        eccentricity: flags.eccentricity,
    };
    let (position, velocity) = kepler.at(0.0);
    let mut momentum = Momentum::zeros();
    momentum.fixed_rows_mut::<3>(0).copy_from(&(velocity * flags.mass));
    let at_rest = ((position, Matrix3::identity()), momentum);
    let ends = refined::<_, M>(system, run, steps, |stepper| stepper.state(at_rest.0, at_rest.1))?;
    let errors = ends.map(|end| (end.configuration().0 - kepler.at(time).0).norm() / flags.radius);
    // Kepler's orbit is that of a point.
    let coupling = body.moments.z / (body.mass * flags.radius.powi(2));
    let orbit = Convergence { errors, reference: coupling + f64::EPSILON, steps };
    orbit.claim(run.order, "the order against Kepler's orbit", claims);

    let ends = refined::<_, M>(system, run, steps, |stepper| stepper.state(start.0, start.1))?;
    let rate = 2.0 * (flags.gravitation / flags.radius.powi(3)).sqrt();
    let exact = Equations::new(body).motion(&start, time, rate);
    let attitude = Matrix3::from_column_slice(&exact.end.as_slice()[6..15]);
    let position: Vector3<f64> = exact.end.fixed_rows::<3>(0).into();
    let errors = ends.map(|end| {
        let (found, turned) = end.configuration();
        ((found - position).norm() / flags.radius).max((turned - attitude).amax())
    });
    // The estimate is one of lengths, and those are of the size of the radius.
    let reference = exact.error / flags.radius;
    Convergence { errors, reference, steps }.claim(run.order, "the order against the equations of motion", claims);
    Ok(())
}

/// The same body so large that its attitude takes part in the angular momentum: one half takes the amount that the
/// other gives.
pub fn exchange<M: Method<Spacecraft>>(body: &Body, flags: &Flags, claims: &mut Claims) -> Result<(), Failure> {
    /// J/(m r²) of the large body.
    const SIZE: f64 = 0.01;
    let name = "while each of them gives and takes";
    if body.moments.x > 0.9 * body.moments.z {
        claims.skip(name, "a body that is almost a sphere feels almost no torque");
        return Ok(());
    }
    let large = body.scaled(SIZE * body.mass * flags.radius.powi(2) / body.moments.z);
    let circle = Circle::new(&large, flags.radius, &flags.run)?;
    // Half an orbit.
    let steps = (TAU / 2.0 / (circle.mean_motion * flags.run.step_size)).ceil().min(1e5) as u64;
    let (pose, momentum) = circle.start(&large, &Orientation::stable(&large), &Vector3::repeat(0.5));
    let stepper = Spacecraft::from(&large).into_stepper_by::<M>(flags.run.step_size)?;
    let spin = |pose: &Pose, momentum: &Momentum| pose.1 * halves(momentum).1;
    let start = stepper.state(pose, momentum)?;
    let (total, first) = (stepper.conserved(&start), spin(&pose, &momentum));
    let (mut defect, mut exchanged, mut scale) = (0.0_f64, 0.0_f64, 0.0_f64);
    for (step, state) in (0..=steps).zip(stepper.trajectory(start)) {
        let state = state.map_err(|error| Failure::Step { step, error })?;
        let (pose, momentum) = (state.configuration(), state.momentum());
        let now = stepper.conserved(&state);
        defect = (0..3).fold(defect, |defect, index| defect.max((now[index] - total[index]).abs()));
        exchanged = exchanged.max((spin(pose, &momentum) - first).norm());
        let (linear, angular) = halves(&momentum);
        scale = scale.max(pose.0.norm() * linear.norm() + angular.norm());
    }
    claims.round_off("a body of J = 0.01 m r² keeps orbit and spin together", defect, steps, scale);
    let reason = "of the angular momentum, given by the orbit to the spin within half an orbit";
    claims.within(name, exchanged / scale, 1e-3..=1.0, 6, reason);
    Ok(())
}
