//! A rod that is pushed at its first section, and flies.

use crate::Flags;
use crate::beam::{Beam, FLYING};
use crate::declaration::{Sections, centre, momenta};
use clebsch_examples::claims::{Claims, largest};
use clebsch_examples::flags::Run;
use clebsch_examples::progress::Progress;
use clebsch_examples::round_off;
use clebsch_examples::scene::Failure;
use nalgebra::{SVector, Vector3};

/// Rods of the picture.
const PICTURES: u64 = 25;
/// Points of the curves.
const POINTS: u64 = 250;
/// The time of the load, s.
pub const LOADED: f64 = 2.5;

/// One time.
#[derive(Clone, Debug)]
pub struct Sample {
    /// Seconds.
    pub time: f64,
    /// Of all sections, metres.
    pub places: Vec<Vector3<f64>>,
    /// Joules.
    pub energy: f64,
    /// Momentum, kg·m/s, and angular momentum about the origin, kg·m²/s.
    pub momenta: [Vector3<f64>; 2],
}

/// One flight.
pub struct Flight {
    /// At a few times.
    pub samples: Vec<Sample>,
    /// The interval of rods in a picture, in samples.
    pub interval: usize,
    run: Run,
    impulses: [Vector3<f64>; 2],
    momentum_defects: [f64; 2],
    centre_defect: f64,
    /// The least and the largest energy without load, J.
    free: Option<(f64, f64)>,
}

fn middle(beam: &Beam, state: &Sections) -> Vector3<f64> {
    let q = state.configuration();
    let ends = [q.first(), q.last()].into_iter().flatten().map(centre).sum::<Vector3<f64>>() / 2.0;
    (q.iter().map(centre).sum::<Vector3<f64>>() - ends) * beam.spacing(q.len() - 1) / beam.length
}

impl Flight {
    /// Steps a rod of so many edges to the end of the run. `record` gets some states.
    ///
    /// # Errors
    /// Those of steps, and of `record`.
    pub fn of(
        flags: &Flags,
        run: &Run,
        edges: usize,
        mut record: impl FnMut(u64, &Sample) -> Result<(), Failure>,
    ) -> Result<Self, Failure> {
        let stepper = FLYING.steps(edges, run.step_size)?;
        let start = FLYING.straight(edges);
        let mut state = stepper.state(start, vec![SVector::<f64, 6>::zeros(); edges + 1])?;
        let [push, moment] = [flags.push, flags.moment].map(Vector3::from);
        let mut inputs = vec![SVector::<f64, 6>::zeros(); edges + 1];
        inputs[0] = SVector::from_iterator(moment.iter().chain(push.iter()).copied());
        let loaded = (LOADED / run.step_size).round() as u64;
        let mut flight = Self {
            samples: Vec::new(),
            interval: (run.steps.div_ceil(PICTURES) / run.steps.div_ceil(POINTS)).max(1) as usize,
            run: run.clone(),
            impulses: [Vector3::zeros(); 2],
            momentum_defects: [0.0; 2],
            centre_defect: 0.0,
            free: None,
        };
        let mass = FLYING.mass * FLYING.length;
        let begin = middle(&FLYING, &state);
        let mut progress = Progress::new(run.steps);
        for step in 0..=run.steps {
            if step > 0 {
                let torque = |state: &Sections| moment + centre(&state.configuration()[0]).cross(&push);
                if step <= loaded {
                    let before = torque(&state);
                    stepper.step_with(&mut state, &inputs).map_err(Failure::step(step))?;
                    flight.impulses[0] += push * run.step_size;
                    flight.impulses[1] += (before + torque(&state)) * (run.step_size / 2.0);
                } else {
                    stepper.step(&mut state).map_err(Failure::step(step))?;
                }
            }
            if run.samples(step, POINTS) || run.writes(step) {
                let time = run.time(step);
                let energy = stepper.energy(&state).map_err(Failure::step(step))?;
                let places = state.configuration().iter().map(centre).collect();
                let sample = Sample { time, places, energy, momenta: momenta(&state) };
                record(step, &sample)?;
                for i in 0..2 {
                    let defect = (sample.momenta[i] - flight.impulses[i]).amax();
                    flight.momentum_defects[i] = largest([flight.momentum_defects[i], defect]);
                }
                // constant acceleration, then constant velocity
                let pushed = time.min(run.time(loaded));
                let expected = begin + push / mass * (pushed * pushed / 2.0 + pushed * (time - pushed));
                let defect = (middle(&FLYING, &state) - expected).amax();
                flight.centre_defect = largest([flight.centre_defect, defect]);
                if step >= loaded {
                    let (least, most) = flight.free.unwrap_or((energy, energy));
                    flight.free = Some((least.min(energy), most.max(energy)));
                }
                if run.samples(step, POINTS) {
                    flight.samples.push(sample);
                }
            }
            progress.reached(step);
        }
        Ok(flight)
    }

    /// Lower and upper end of the rod at the end of the run.
    pub fn tips(&self) -> [Vector3<f64>; 2] {
        let last = self.samples.last().map(|sample| &sample.places);
        let ends = last.and_then(|places| Some([*places.first()?, *places.last()?]));
        ends.unwrap_or([Vector3::repeat(f64::NAN); 2])
    }

    /// The band of the energy without load, J.
    pub fn band(&self) -> f64 {
        self.free.map_or(f64::NAN, |(least, most)| most - least)
    }

    /// Claims momenta and the centre of mass.
    pub fn claim(&self, claims: &mut Claims) {
        let reach = 1.0 + largest(self.samples.iter().flat_map(|sample| &sample.places).map(|place| place.norm()));
        let pushes = 1.0 + self.impulses[0].norm();
        let scale = [pushes, 1.0 + self.impulses[1].norm() + reach * pushes];
        for (i, name) in ["the momentum is the impulse of the load", "the angular momentum is that of its moment"]
            .into_iter()
            .enumerate()
        {
            claims.round_off(name, self.momentum_defects[i], self.run.steps, scale[i]);
        }
        claims.round_off(
            "the centre of mass flies on its parabola and on its line, m",
            self.centre_defect,
            self.run.steps,
            reach,
        );
    }

    /// Claims the band of the energy after the load, from this run and one with half the step.
    pub fn claim_band(&self, halved: &Self, claims: &mut Claims) {
        let name = "half the step, a quarter of the energy band without load";
        let (one, half) = (self.band(), halved.band());
        if one.is_nan() {
            claims.skip(name, "the load acts until the end");
        } else if half > 10.0 * round_off::worst_case(2 * self.run.steps, 1.0) {
            claims.within(name, one / half, 3.5..=4.5, 3, &format!("the band with h is {one:.1e} J"));
        } else {
            claims.skip(name, "too little motion for the order to show");
        }
    }
}
