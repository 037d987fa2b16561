//! Flights in gusts, with a plan at each tick or at each fifth.

use super::declaration::{Place, Stage, Steering, Thrusts};
use super::place::{attitude, position};
use super::task::Task;
use clebsch::{Ended, Limits, Target};
use clebsch_examples::noise::Noise;
use clebsch_examples::scene::Failure;
use nalgebra::Vector3;

/// How a flight is planned.
#[derive(Clone, Copy, Debug)]
pub struct Pilot {
    pub name: &'static str,
    /// Corrections of each plan; all that it takes where there is no number.
    sweeps: Option<u32>,
    /// Ticks between two plans.
    every: usize,
    /// Whether gains correct the thrusts between two plans.
    has_feedback: bool,
    has_gusts: bool,
    pub has_obstacle: bool,
    /// Whether each plan is made to the end too.
    compares: bool,
}

const CORRECTED: Pilot = Pilot {
    name: "one correction",
    sweeps: Some(1),
    every: 1,
    has_feedback: false,
    has_gusts: true,
    has_obstacle: false,
    compares: false,
};

/// All flights.
pub const PILOTS: [Pilot; 8] = [
    Pilot { name: "one correction, still air", has_gusts: false, ..CORRECTED },
    Pilot { compares: true, ..CORRECTED },
    Pilot { name: "converged plans", sweeps: None, ..CORRECTED },
    Pilot { name: "at each 5th tick", every: 5, ..CORRECTED },
    Pilot { name: "the same with feedback", every: 5, has_feedback: true, ..CORRECTED },
    Pilot { name: "obstacle, one correction", has_obstacle: true, ..CORRECTED },
    Pilot { name: "obstacle, three", sweeps: Some(3), has_obstacle: true, ..CORRECTED },
    Pilot { name: "obstacle, ten", sweeps: Some(10), has_obstacle: true, ..CORRECTED },
];

/// Places in that list: one correction in gusts, converged plans, and the flight past the obstacle that is claimed.
pub const ONE: usize = 1;
pub const CONVERGED: usize = 2;
pub const PAST: usize = 7;

/// A flight that was made.
#[derive(Clone, Debug)]
pub struct Flight {
    pub pilot: Pilot,
    /// Places at all ticks.
    pub path: Vec<Place>,
    /// Thrusts from there on, N.
    pub thrusts: Vec<Thrusts>,
    /// Linearisations of each plan but the first, which is made to the end.
    pub work: Vec<u32>,
    /// Distances of thrusts from those of the converged plan, in units of the thrust at hover.
    pub apart: Vec<f64>,
    /// How much distance from the obstacle is lacking in the first half of a plan, at most, m.
    pub lack: f64,
    /// Plans whose search failed.
    pub failed: usize,
}

impl Flight {
    /// Flies.
    ///
    /// # Errors
    /// Those of a plan and of a step.
    pub fn new(task: &Task, pilot: &Pilot) -> Result<Self, Failure> {
        let (mut noise, mut place) = (Noise::new(task.seed), task.start());
        let (hover, top) = (task.system.hover, task.system.top);
        let mut plan = vec![task.steering(0)?.stage(&place).with_input(Thrusts::repeat(hover)); task.horizon];
        let (path, thrusts, work, apart) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let mut flight = Self { pilot: *pilot, path, thrusts, work, apart, lack: f64::NEG_INFINITY, failed: 0 };
        for tick in 0..task.steps {
            let steering = task.steering(tick)?;
            let since = tick % pilot.every;
            if since == 0 {
                steering.refer(&mut plan, |j, t| task.reference(j, t, pilot.has_obstacle));
                let converged = pilot.compares.then(|| plan.clone());
                if pilot.has_feedback && tick > 0 {
                    guess(&steering, &place, &mut plan, top)?;
                }
                flight.plan(&steering, tick, &place, &mut plan)?;
                if let Some(mut converged) = converged {
                    steering.solve(&place, Target::Free, &mut converged)?;
                    flight.apart.push((converged[0].input() - plan[0].input()).norm() / hover);
                }
            }
            let stage = &plan[since.min(task.horizon - 1)];
            let thrusts = if pilot.has_feedback { corrected(&steering, stage, &place, top) } else { *stage.input() };
            flight.path.push(place);
            flight.thrusts.push(thrusts);
            place =
                steering.follow(&place, &thrusts).map_err(|error| Failure::Step { step: tick as u64 + 1, error })?;
            if pilot.has_gusts {
                let gust = Vector3::from_fn(|_, _| 2.0 * noise.uniform() - 1.0) * (task.gust / 3.0_f64.sqrt());
                push(&mut place, &(gust * task.system.mass));
            }
            if since + 1 == pilot.every {
                steering.shift(&mut plan, pilot.every);
            }
        }
        Ok(flight)
    }

    /// Corrects the plan, the first one to the end.
    fn plan(&mut self, steering: &Steering, tick: usize, place: &Place, plan: &mut [Stage]) -> Result<(), Failure> {
        let half = plan.len().div_ceil(2);
        let reached = match self.pilot.sweeps.filter(|_| tick > 0) {
            Some(sweeps) => steering.solve_within(place, Target::Free, Limits { sweeps }, plan)?,
            None => steering.solve(place, Target::Free, plan)?,
        };
        if tick > 0 {
            self.work.push(reached.iterations());
        }
        self.failed += usize::from(matches!(reached.ended(), Ended::Failed(_)));
        let lacks = reached.stages().iter().take(half).map(|stage| {
            let (.., obstacle, apart) = stage.reference();
            apart.x - (position(stage.place()) - obstacle).norm()
        });
        self.lack = lacks.fold(self.lack, f64::max);
        Ok(())
    }

    /// Distances from the track at all ticks, m.
    pub fn off(&self, task: &Task) -> Vec<f64> {
        (0..).zip(&self.path).map(|(tick, place)| (position(place) - task.track(task.time(tick))).norm()).collect()
    }

    /// Distances from another flight, m.
    pub fn from(&self, other: &Self) -> Vec<f64> {
        self.path.iter().zip(&other.path).map(|(a, b)| (position(a) - position(b)).norm()).collect()
    }

    /// Distances from the obstacle, m.
    pub fn clear(&self, task: &Task) -> Vec<f64> {
        (0..).zip(&self.path).map(|(tick, place)| (position(place) - task.obstacle(task.time(tick))).norm()).collect()
    }

    /// The smallest and the largest thrust of a rotor, N.
    pub fn span(&self) -> (f64, f64) {
        let fold = |(low, high): (f64, f64), thrusts: &Thrusts| (low.min(thrusts.min()), high.max(thrusts.max()));
        self.thrusts.iter().fold((f64::INFINITY, f64::NEG_INFINITY), fold)
    }
}

/// The thrusts of a step from elsewhere, by gains and within bounds.
fn corrected(steering: &Steering, stage: &Stage, place: &Place, top: f64) -> Thrusts {
    steering.feedback(stage, place).map(|thrust| thrust.clamp(0.0, top))
}

/// The plan as its gains fly it from here, for the next correction. Feedback has turned the quadrotor otherwise than
/// planned, so that the thrusts of the plan alone would lead astray.
fn guess(steering: &Steering, place: &Place, plan: &mut [Stage], top: f64) -> Result<(), Failure> {
    let mut place = *place;
    for stage in plan {
        let thrusts = corrected(steering, stage, &place, top);
        *stage = stage.with_input(thrusts);
        place = steering.follow(&place, &thrusts)?;
    }
    Ok(())
}

/// Adds a momentum, seen in space, N·s.
pub fn push(place: &mut Place, by: &Vector3<f64>) {
    let by = attitude(place).tr_mul(by);
    let mut linear = place.1.fixed_rows_mut::<3>(3);
    linear += by;
}
