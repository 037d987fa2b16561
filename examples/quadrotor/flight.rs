//! Plans flown with the forced stepper where something is not as planned: a gust, or the mass.

use super::declaration::{Place, Quadrotor};
use super::place::{attitude, position, velocity};
use super::plan::Plan;
use super::problem::Problem;
use crate::Flags;
use clebsch::Clebsch;
use clebsch_examples::claims::Claims;
use clebsch_examples::scene::Failure;
use clebsch_examples::table::Table;
use nalgebra::Vector3;

/// The deviation from the plan.
#[derive(Clone, Copy, Debug)]
pub struct Surprise {
    name: &'static str,
    /// The true mass over the known one.
    mass: f64,
    /// The velocity that a gust leaves after a quarter of the flight, space, m/s.
    gust: Vector3<f64>,
}

/// How a flight ends.
#[derive(Clone, Debug)]
pub struct Flight {
    /// Distance from the plan at every step, m.
    pub off: Vec<f64>,
    /// The angle between the attitude at the end and the planned one, rad.
    angle: f64,
    /// The velocity that is left, m/s.
    velocity: f64,
}

/// The same surprise without feedback and with it.
#[derive(Clone, Debug)]
pub struct Pair {
    surprise: Surprise,
    /// Thrusts as planned.
    pub open: Flight,
    /// Thrusts with gains.
    pub closed: Flight,
}

impl Pair {
    /// As planned, with a gust, and with another mass.
    ///
    /// # Errors
    /// Those of a step.
    pub fn all(problem: &Problem, plan: &Plan, flags: &Flags) -> Result<[Self; 3], Failure> {
        let pair = |name, mass, gust: [f64; 3]| -> Result<Self, Failure> {
            let surprise = Surprise { name, mass, gust: gust.into() };
            let fly = |feedback| fly(problem, plan, &surprise, feedback);
            Ok(Self { surprise, open: fly(false)?, closed: fly(true)? })
        };
        let planned = pair("as planned", 1.0, [0.0; 3])?;
        Ok([planned, pair("gust", 1.0, flags.gust)?, pair("heavier", 1.0 + flags.heavier, [0.0; 3])?])
    }
}

impl Flight {
    /// The distance from the goal at the end, m.
    fn distance(&self) -> f64 {
        self.off.last().copied().unwrap_or(f64::NAN)
    }
}

/// Thrusts beyond a bound are cut off there.
fn fly(problem: &Problem, plan: &Plan, surprise: &Surprise, feedback: bool) -> Result<Flight, Failure> {
    let known = problem.steering(1)?;
    let real: Quadrotor = problem.vehicle.with_mass(surprise.mass).system();
    let (mass, stepper) = (real.mass, real.into_stepper(plan.h)?);
    let mut state = stepper.state(problem.start.0, problem.start.1)?;
    let mut flight = Flight { off: Vec::new(), angle: 0.0, velocity: 0.0 };
    for (step, stage) in (1..).zip(&plan.stages) {
        let mut place: Place = (*state.configuration(), state.momentum());
        if step == plan.stages.len() / 4 {
            let push = attitude(&place).tr_mul(&surprise.gust) * mass;
            let mut linear = place.1.fixed_rows_mut::<3>(3);
            linear += push;
            state = stepper.state(place.0, place.1)?;
        }
        flight.off.push((position(&place) - position(stage.place())).norm());
        let thrusts = if feedback { known.feedback(stage, &place) } else { *stage.input() };
        let thrusts = thrusts.map(|thrust| thrust.clamp(0.0, problem.vehicle.top));
        state = stepper.step_with(&state, &thrusts).map_err(|error| Failure::Step { step: step as u64, error })?;
    }
    let place: Place = (*state.configuration(), state.momentum());
    flight.off.push((position(&place) - position(&plan.end)).norm());
    // from the chord, |A − B|² = 8 sin²(θ/2): the trace loses small angles to rounding
    let chord = (attitude(&plan.end) - attitude(&place)).norm();
    flight.angle = 2.0 * (chord / 8.0_f64.sqrt()).min(1.0).asin();
    flight.velocity = velocity(&place, mass).norm();
    Ok(flight)
}

/// All flights.
pub fn table(pairs: &[Pair]) -> Table<7> {
    let headings =
        ["flown", "off at the end / m", "corrected", "turned / °", "corrected", "still moving / m/s", "corrected"];
    let mut table = Table::new(headings);
    for Pair { surprise, open, closed } in pairs {
        let number = |value: f64| format!("{value:.2e}");
        let degrees = |flight: &Flight| number(flight.angle.to_degrees());
        table.row([
            surprise.name.to_owned(),
            number(open.distance()),
            number(closed.distance()),
            degrees(open),
            degrees(closed),
            number(open.velocity),
            number(closed.velocity),
        ]);
    }
    table
}

/// Claims the benefit of feedback.
pub fn claim([planned, gust, heavier]: &[Pair; 3], claims: &mut Claims) {
    claims.at_most("flown as planned, with gains", planned.closed.distance(), 1e-9, "m, nothing to correct");
    for (name, pair) in [("feedback corrects a gust", gust), ("feedback corrects the mass", heavier)] {
        let allowed = pair.open.distance() * 0.1 + 1e-9;
        claims.at_most(name, pair.closed.distance(), allowed, "m, a tenth of what is left without");
    }
}
