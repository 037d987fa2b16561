//! The record of one linkage while it runs, next to the other integrator, and the claims about it.

use clebsch_examples::claims::{Claims, largest};
use clebsch_examples::convergence::Convergence;
use clebsch_examples::flags::{Order, Run};
use clebsch_examples::reference::{Solution, solve};
use nalgebra::SVector;

/// Points of the figure, and of the comparison.
const POINTS: u64 = 200;
/// Above the fastest rate of both motions, 1/s.
const RATE: f64 = 160.0;

/// A motion of N numbers, its law, and how far two of them are from each other.
pub trait Law<const N: usize> {
    /// The change of a motion.
    fn law(&self, motion: &SVector<f64, N>) -> SVector<f64, N>;
    /// Radians.
    fn distance(&self, one: &SVector<f64, N>, other: &SVector<f64, N>) -> f64;
}

/// One state.
#[derive(Clone, Copy, Debug)]
pub struct Moment<const N: usize> {
    /// As the other integrator has it.
    pub motion: SVector<f64, N>,
    /// Joules.
    pub energy: f64,
    /// By how much the joints are open, metres.
    pub gap: f64,
    /// How fast they open, m/s.
    pub opening: f64,
}

/// One point of the figure.
#[derive(Clone, Copy, Debug)]
pub struct Sample<const N: usize> {
    /// Seconds.
    pub time: f64,
    /// As the steps have it.
    pub motion: SVector<f64, N>,
    /// How far it is from that of the other integrator, radians.
    pub off: f64,
    /// The error of the energy, joules.
    pub energy: f64,
}

/// One linkage.
pub struct Watch<'a, const N: usize, L> {
    /// At a few times.
    pub samples: Vec<Sample<N>>,
    linkage: &'a L,
    run: Run,
    exact: Solution<N>,
    energy: Option<f64>,
    gap: f64,
    opening: f64,
}

impl<'a, const N: usize, L: Law<N>> Watch<'a, N, L> {
    /// Nothing observed yet.
    pub fn new(run: &Run, linkage: &'a L, start: SVector<f64, N>) -> Self {
        let exact = Solution { end: start, error: 0.0 };
        Self { samples: Vec::new(), linkage, run: run.clone(), exact, energy: None, gap: 0.0, opening: 0.0 }
    }

    /// Takes the next state.
    pub fn observe(&mut self, step: u64, moment: &Moment<N>) {
        self.gap = self.gap.max(moment.gap);
        self.opening = self.opening.max(moment.opening);
        let start = *self.energy.get_or_insert(moment.energy);
        if !self.run.samples(step, POINTS) {
            return;
        }
        let time = self.run.time(step);
        if let Some(last) = self.samples.last() {
            let next = solve(|motion| self.linkage.law(motion), self.exact.end, time - last.time, RATE);
            self.exact = Solution { end: next.end, error: self.exact.error + next.error };
        }
        let off = self.linkage.distance(&moment.motion, &self.exact.end);
        self.samples.push(Sample { time, motion: moment.motion, off, energy: moment.energy - start });
    }

    /// Claims the joints: `scale` is the size of the places, `speed` that of the velocities.
    pub fn claim_joints(&self, name: &str, scale: f64, speed: f64, claims: &mut Claims) {
        claims.round_off(&format!("{name}: joints are closed"), self.gap, self.run.steps, scale);
        claims.round_off(&format!("{name}: joints do not open"), self.opening, self.run.steps, speed);
    }

    /// Claims the order of the steps, from runs with h, h/2 and h/4. `scale` is that of the energy.
    pub fn claim_order(refined: &[Self; 3], name: &str, scale: f64, claims: &mut Claims) {
        let errors = refined.each_ref().map(|watch| {
            let all = |part: fn(&Sample<N>) -> f64| largest(watch.samples.iter().map(part));
            [all(|sample| sample.off), all(|sample| sample.energy.abs()) / scale]
        });
        let steps = refined[0].run.steps;
        for (i, part) in ["motion", "energy"].into_iter().enumerate() {
            let reference = if i == 0 { refined[0].exact.error } else { 0.0 };
            let convergence = Convergence { errors: errors.map(|both| both[i]), reference, steps };
            convergence.claim(Order::Second, &format!("{name}: {part}"), claims);
        }
    }
}
