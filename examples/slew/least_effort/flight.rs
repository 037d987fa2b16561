//! Plans flown where something is not as planned: the inertia, or the attitude at the start.

use super::declaration::{Place, SteeredBody};
use super::plan::Plan;
use super::problem::{Problem, apart};
use crate::Flags;
use clebsch::Controlled;
use clebsch_examples::claims::Claims;
use clebsch_examples::scene::Failure;
use clebsch_examples::table::Table;
use nalgebra::{Rotation3, Vector3};

/// One in so many steps may have a torque that is cut off; where more have, the bounds leave too little to correct with.
const FEW: usize = 20;

/// The deviation from the plan.
#[derive(Clone, Copy, Debug)]
struct Surprise {
    /// Its name.
    name: &'static str,
    /// The true inertia over the known one.
    inertia: f64,
    /// By how much the attitude is off at the start, body frame, rad.
    attitude: f64,
}

/// A plan that was flown.
#[derive(Clone, Debug)]
pub struct Sortie {
    name: &'static str,
    flights: [Pair; 3],
}

/// The same surprise without feedback and with it.
#[derive(Clone, Debug)]
pub struct Pair {
    surprise: Surprise,
    /// Torques as planned.
    pub open: Flight,
    /// Torques with gains.
    pub closed: Flight,
}

impl Sortie {
    /// Flies as planned, with another inertia, and from another attitude.
    ///
    /// # Errors
    /// Those of a step.
    pub fn new(name: &'static str, problem: &Problem, plan: &Plan, flags: &Flags) -> Result<Self, Failure> {
        let pair = |name, inertia, attitude| -> Result<Pair, Failure> {
            let surprise = Surprise { name, inertia, attitude };
            let fly = |feedback| fly(problem, plan, &surprise, feedback);
            Ok(Pair { surprise, open: fly(false)?, closed: fly(true)? })
        };
        let planned = pair("as planned", 1.0, 0.0)?;
        let heavier = pair("inertia larger", 1.0 + flags.heavier, 0.0)?;
        let tilted = pair("start turned", 1.0, flags.tilted.to_radians())?;
        Ok(Self { name, flights: [planned, heavier, tilted] })
    }

    /// Those where something is not as planned: the inertia, the start.
    pub fn surprised(&self) -> [&Pair; 2] {
        let [_, heavier, tilted] = &self.flights;
        [heavier, tilted]
    }
}

/// All flights.
pub fn table(sorties: &[Sortie]) -> Table<6> {
    let headings = ["plan", "flown", "off at the end / °", "with feedback", "spin left / °/s", "with feedback"];
    let mut table = Table::new(headings);
    for (sortie, pair) in sorties.iter().flat_map(|sortie| sortie.flights.iter().map(move |pair| (sortie, pair))) {
        let degrees = |radians: f64| format!("{:.2e}", radians.to_degrees());
        let names = [sortie.name.to_owned(), pair.surprise.name.to_owned()];
        let [open, closed] = [&pair.open, &pair.closed].map(|flight| [flight.angle, flight.spin].map(degrees));
        let ([a, b], [[c, e], [d, g]]) = (names, [open, closed]);
        table.row([a, b, c, d, e, g]);
    }
    table
}

/// Claims the benefit of feedback.
///
/// Gains are those of the plan: at a bound they are nothing. If a bound is active to the very end, the end has no way
/// to correct an inertia that is not as planned. That flight is in the table, and nothing is claimed about it.
pub fn claim(sorties: &[Sortie; 2], claims: &mut Claims) {
    let [bounded, unbounded] = sorties;
    let [planned, _, tilted] = &bounded.flights;
    let reason = "rad, as planned, with gains: nothing to correct";
    claims.at_most("flown as planned", planned.closed.angle, 1e-9, reason);
    let [_, heavier, _] = &unbounded.flights;
    let two =
        [("feedback corrects the start", tilted, 0.01), ("feedback corrects the inertia, unbounded", heavier, 0.1)];
    for (name, Pair { open, closed, .. }, share) in two {
        if closed.cut_off > closed.off.len() / FEW {
            claims.skip(name, &format!("{} torques were cut off: the bounds leave too little", closed.cut_off));
        } else {
            let reason = format!("rad, {share} of what is left without");
            claims.at_most(name, closed.angle, open.angle * share + 1e-9, &reason);
        }
    }
}

/// How a flight ends.
#[derive(Clone, Debug)]
pub struct Flight {
    /// The angle to the attitude that was planned, rad.
    pub angle: f64,
    /// The angular velocity that is left, rad/s.
    pub spin: f64,
    /// How many torques were cut off at a bound.
    cut_off: usize,
    /// The angle to the plan at every step, rad.
    pub off: Vec<f64>,
}

/// Flies a plan with its gains or without; torques beyond a bound are cut off there.
///
/// # Errors
/// Those of a step.
fn fly(problem: &Problem, plan: &Plan, surprise: &Surprise, feedback: bool) -> Result<Flight, Failure> {
    let known = problem.steering(1)?;
    let inertia = problem.body.inertia * surprise.inertia;
    let real = SteeredBody { inertia, top: problem.top }.control(plan.h)?;
    let off = Rotation3::new(Vector3::new(1.0, -1.0, 1.0).normalize() * surprise.attitude);
    let mut place: Place = (problem.from * off.matrix(), Vector3::zeros());
    let mut flight = Flight { angle: 0.0, spin: 0.0, cut_off: 0, off: Vec::new() };
    for (step, stage) in (1..).zip(&plan.stages) {
        flight.off.push(apart(&place, stage.place()).0);
        let torque = if feedback { known.feedback(stage, &place) } else { *stage.input() };
        flight.cut_off += torque.iter().filter(|entry| entry.abs() > problem.top * (1.0 + 1e-9)).count();
        let torque = torque.map(|entry| entry.clamp(-problem.top, problem.top));
        place = real.follow(&place, &torque).map_err(|error| Failure::Step { step, error })?;
    }
    flight.angle = apart(&place, &plan.end).0;
    flight.off.push(flight.angle);
    flight.spin = (problem.body.spin(&place.1) / surprise.inertia).norm();
    Ok(flight)
}
