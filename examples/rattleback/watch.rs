//! The record of one spin while it runs, next to the other integrator, and the claims about it.

use crate::Rattleback;
use crate::rolling::Rolling;
use clebsch_examples::claims::{Claims, largest};
use clebsch_examples::convergence::Convergence;
use clebsch_examples::flags::{Order, Run};
use clebsch_examples::reference::{Solution, solve};
use nalgebra::Vector3;

/// Points of the figure, and of the comparison.
const POINTS: u64 = 480;
/// Above the fastest rate of the motion, 1/s: a rolling about the long axis at some 50 rad/s, and its harmonics.
const RATE: f64 = 400.0;
/// The largest error of the spin, relative, where errors are a power of the step.
const IRREGULAR: f64 = 1.5e-3;
/// An error of a reversal that can be seen in the figure, s.
const VISIBLE: f64 = 0.05;

/// One state.
#[derive(Clone, Copy, Debug)]
pub struct Moment {
    /// ω and the direction up, in the body.
    pub motion: Rolling,
    /// Of the centre of mass, in the body, m/s.
    pub velocity: Vector3<f64>,
    /// Of the centre of mass above the table, metres.
    pub height: f64,
    /// Joules.
    pub energy: f64,
}

/// One point of the figure.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Seconds.
    pub time: f64,
    /// ω₃ and that of the other integrator, rad/s.
    pub spins: [f64; 2],
    /// The largest angle of the third axis against the vertical since the last sample, rad.
    pub tilt: f64,
    /// Of the contact above the table, in parts of the shortest half axis.
    pub height: f64,
    /// Its error, in parts of the energy at the start.
    pub energy: f64,
}

/// One spin.
pub struct Watch {
    /// Its name.
    pub name: &'static str,
    /// At a few times.
    pub samples: Vec<Sample>,
    body: Rattleback,
    run: Run,
    exact: Solution<6>,
    energy: Option<f64>,
    tilt: f64,
    slip: f64,
    fastest: f64,
}

impl Watch {
    /// Nothing observed yet.
    pub fn new(run: &Run, body: &Rattleback, name: &'static str, start: Rolling) -> Self {
        Self {
            name,
            samples: Vec::new(),
            body: body.clone(),
            run: run.clone(),
            exact: Solution { end: start, error: 0.0 },
            energy: None,
            tilt: 0.0,
            slip: 0.0,
            fastest: 0.0,
        }
    }

    /// Takes the next state.
    pub fn observe(&mut self, step: u64, moment: &Moment) {
        let omega = moment.motion.fixed_rows::<3>(0).into_owned();
        let up = moment.motion.fixed_rows::<3>(3).into_owned();
        let contact = self.body.contact(&up);
        self.slip = self.slip.max((moment.velocity + omega.cross(&contact)).norm());
        self.fastest = self.fastest.max(moment.velocity.norm() + omega.norm() * contact.norm());
        self.tilt = self.tilt.max(up.xy().norm().atan2(up.z));
        let start = *self.energy.get_or_insert(moment.energy);
        if !self.run.samples(step, POINTS) {
            return;
        }
        let time = self.run.time(step);
        if let Some(last) = self.samples.last() {
            let next = solve(|y| self.body.rolling(y), self.exact.end, time - last.time, RATE);
            self.exact = Solution { end: next.end, error: self.exact.error + next.error };
        }
        self.samples.push(Sample {
            time,
            spins: [omega.z, self.exact.end[2]],
            tilt: self.tilt,
            height: (moment.height + contact.dot(&up)) / self.body.axes.z,
            energy: moment.energy / start - 1.0,
        });
        self.tilt = 0.0;
    }

    /// The largest errors of the spin, the energy and the height of the contact.
    pub fn errors(&self) -> [f64; 3] {
        let all = |error: fn(&Sample) -> f64| largest(self.samples.iter().map(|sample| error(sample).abs()));
        [
            all(|sample| sample.spins[0] - sample.spins[1]) / all(|sample| sample.spins[1]),
            all(|sample| sample.energy),
            all(|sample| sample.height),
        ]
    }

    /// When the spin changes its sign, by the steps or by the other integrator.
    pub fn reversal(&self, which: usize) -> Option<f64> {
        let pair = self.samples.windows(2).find(|pair| pair[0].spins[which] * pair[1].spins[which] <= 0.0)?;
        let [before, after] = [0, 1].map(|i| (pair[i].time, pair[i].spins[which]));
        Some(before.0 + (after.0 - before.0) * before.1 / (before.1 - after.1))
    }

    /// Claims rolling and the time of the reversal.
    pub fn claim(&self, claims: &mut Claims) {
        let name = self.name;
        claims.round_off(&format!("{name}: no slip"), self.slip, self.run.steps, self.fastest);
        let claimed = format!("{name}: time of the reversal");
        match (self.reversal(0), self.reversal(1)) {
            (Some(found), Some(exact)) if self.exact.error < VISIBLE => {
                let reason = format!("s against {exact:.3} s by the other integrator; visible in the figure");
                claims.at_most(&claimed, (found - exact).abs(), VISIBLE, &reason);
            }
            _ => claims.skip(&claimed, "none in this time, or the motion is too irregular to tell"),
        }
    }

    /// Claims the order of the steps, from the errors with h, h/2 and h/4 over the first `steps`.
    pub fn claim_order(refined: &[Self; 3], steps: u64, claims: &mut Claims) {
        let errors = refined.each_ref().map(Self::errors);
        for (i, part) in ["spin", "energy", "height of the contact"].into_iter().enumerate() {
            let reference = if i == 0 { refined[0].exact.error } else { 0.0 };
            let name = format!("{}: {part}", refined[0].name);
            if errors[0][0] > IRREGULAR {
                claims.skip(&name, "the motion is irregular: its spin is not followed in this time by these steps");
                continue;
            }
            Convergence { errors: errors.map(|all| all[i]), reference, steps }.claim(Order::Second, &name, claims);
        }
    }
}
