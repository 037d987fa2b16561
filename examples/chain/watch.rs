//! The record of a chain while it moves, and the claims about it.

use crate::newton_euler::Exact;
use crate::whip::{LENGTH, Look, MASS, Whip};
use clebsch::{Clebsch, State};
use clebsch_examples::claims::{Claims, largest};
use clebsch_examples::convergence::Convergence;
use clebsch_examples::flags::{Order, Run};
use clebsch_examples::progress::Progress;
use clebsch_examples::round_off;
use clebsch_examples::scene::Failure;
use nalgebra::Vector3;

/// Points of the figure, and of the comparison.
pub const POINTS: u64 = 240;
/// Rounding errors in a joint, ε of the size: those of the sweeps, and of the sum here.
pub const ROUNDINGS: f64 = 16.0;

/// Of energies (J) and forces (N).
const SCALE: f64 = 10.0;

/// One point of the figure.
#[derive(Clone, Debug)]
pub struct Sample {
    /// Seconds.
    pub time: f64,
    /// Places and speeds.
    pub look: Look,
    /// Of the hand on the chain, newtons.
    pub force: Vector3<f64>,
    /// Joules.
    pub energy: f64,
}

/// One run of a chain.
pub struct Watch<const N: usize> {
    /// At a few times.
    pub samples: Vec<Sample>,
    /// The last state.
    pub end: State<Whip<N>>,
    run: Run,
    gaps: [f64; 2],
    /// The largest speed of the tip, m/s.
    pub speed: f64,
    tension: f64,
    imbalance: f64,
    /// The least and the largest energy since the hand is still.
    still: Option<(f64, f64)>,
}

impl<const N: usize> Watch<N> {
    /// Steps a chain from rest to the end of the run, with steps of a part 1/`part`. `record` gets each state.
    ///
    /// # Errors
    /// Those of steps, and of `record`.
    pub fn of(
        whip: &Whip<N>,
        run: &Run,
        part: u64,
        lean: f64,
        mut record: impl FnMut(u64, f64, &Look, f64) -> Result<(), Failure>,
    ) -> Result<Self, Failure> {
        let interval = run.steps.div_ceil(POINTS) * part;
        let run = Run { step_size: run.step_size / part as f64, steps: run.steps * part, ..run.clone() };
        let stepper = whip.stepper(run.step_size)?;
        let (places, velocities) = whip.start(lean);
        let end = stepper.state_moving(places, velocities)?;
        let mut watch = Self {
            samples: Vec::new(),
            end,
            run,
            gaps: [0.0; 2],
            speed: 0.0,
            tension: 0.0,
            imbalance: 0.0,
            still: None,
        };
        let mut progress = Progress::new(watch.run.steps);
        let weight = Vector3::y() * (whip.mass * N as f64 * whip.gravity);
        let mut before = Vector3::zeros();
        for step in 0..=watch.run.steps {
            let failed = |error| Failure::Step { step, error };
            let mut push = None;
            if step > 0 {
                let (next, reactions) = stepper.step_with_reactions(&watch.end).map_err(failed)?;
                (watch.end, push) = (next, Some(reactions[0]));
            }
            let (time, energy) = (watch.run.time(step), stepper.energy(&watch.end));
            let look = whip.look(time, &watch.end);
            if let Some(push) = push {
                // by the change of the momentum alone
                let force = (look.momentum - before) / watch.run.step_size + weight;
                watch.imbalance = largest([watch.imbalance, (force - push).norm()]);
                watch.tension = watch.tension.max(push.norm());
            }
            before = look.momentum;
            watch.gaps = std::array::from_fn(|i| largest([watch.gaps[i], look.gaps[i]]));
            watch.speed = watch.speed.max(look.speed);
            if time >= whip.still() {
                let (least, most) = watch.still.unwrap_or((energy, energy));
                watch.still = Some((least.min(energy), most.max(energy)));
            }
            let is_sample = step == watch.run.steps || step.is_multiple_of(interval);
            if is_sample || watch.run.csv.is_some() {
                let force = stepper.reactions(&watch.end).map_err(failed)?[0];
                record(step, time, &look, force.norm())?;
                if is_sample {
                    watch.samples.push(Sample { time, look, force, energy });
                }
            }
            progress.reached(step);
        }
        Ok(watch)
    }

    /// Claims that joints stay closed, and that the hand carries the chain.
    pub fn claim(&self, claims: &mut Claims) {
        let [gap, opening] = self.gaps;
        let bound = ROUNDINGS * f64::EPSILON;
        claims.at_most("joints are closed at every step, m", gap, bound * (1.0 + LENGTH), "sweeps end at rounding");
        let name = "joints do not open, m/s";
        claims.at_most(name, opening, bound * N as f64 * (1.0 + self.speed), "one solution of N joints");
        let name = "first joint: tension = weight + change of the momentum, N";
        // of the forces on N links, and of momenta over the length of a step
        let scale = N as f64 * (1.0 + self.tension) + MASS * self.speed / self.run.step_size;
        claims.at_most(name, self.imbalance, round_off::worst_case(1, scale), "rounding in one step");
    }

    /// Claims the band of the energy after the hand has stopped, from this run and one with steps of half the length.
    pub fn claim_band(&self, halved: &Self, claims: &mut Claims) {
        let name = "five links, hand at rest: half the step, a quarter of the energy band";
        let (Some(whole), Some(half)) = (self.still, halved.still) else {
            claims.skip(name, "the hand moves until the end");
            return;
        };
        let [whole, half] = [whole, half].map(|(least, most)| most - least);
        let rounding = round_off::worst_case(self.run.steps, 1.0 + self.speed * self.speed);
        if half > 10.0 * rounding {
            claims.within(name, whole / half, 3.5..=4.5, 3, &format!("the band with h is {whole:.1e} J"));
        } else {
            claims.at_most(name, whole, 4.5 * half + rounding, "too little motion for the order to show");
        }
    }

    /// Claims the order of the steps, from runs with h, h/2 and h/4 against the other integrator. Returns the error of the
    /// joints with h, metres.
    pub fn claim_order(refined: &[Self; 3], (exact, error): &(Vec<Exact>, f64), claims: &mut Claims) -> f64 {
        let errors = |of: fn(&Sample, &Exact) -> f64| {
            refined.each_ref().map(|watch| largest(watch.samples.iter().zip(exact).map(|(one, other)| of(one, other))))
        };
        let joints = errors(|one, other| {
            largest(one.look.joints.iter().zip(&other.joints).map(|(one, other)| (one - other).norm())) / LENGTH
        });
        let parts = [
            ("joints", joints),
            ("energy", errors(|one, other| (one.energy - other.energy).abs() / SCALE)),
            ("tension", errors(|one, other| (one.force - other.force).norm() / SCALE)),
        ];
        for (name, errors) in parts {
            let convergence = Convergence { errors, reference: *error, steps: refined[0].run.steps };
            convergence.claim(Order::Second, &format!("five links: {name}"), claims);
        }
        joints[0] * LENGTH
    }

    /// Claims that as many steps back lead to the start. `error` is that of the steps, metres.
    ///
    /// # Errors
    /// Those of steps.
    pub fn claim_back(&self, whip: &Whip<N>, lean: f64, error: f64, claims: &mut Claims) -> Result<(), Failure> {
        let Run { step_size, steps, .. } = self.run;
        let back = whip.stepper(-step_size)?;
        let mut state = back.state_at(self.run.duration(), *self.end.configuration(), self.end.momentum())?;
        for step in 1..=steps {
            state = back.step(&state).map_err(|error| Failure::Step { step, error })?;
        }
        let places = state.configuration().iter().zip(whip.start(lean).0);
        let far = largest(places.map(|(end, start)| (end - start).norm()));
        let bound = (error / 1000.0).max(round_off::worst_case(steps, LENGTH));
        claims.at_most("five links: there and back again, m", far, bound, "a thousandth of the error of the steps");
        Ok(())
    }
}
