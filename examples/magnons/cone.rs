//! Spin waves of any tilt: all spins turn about the third axis, as cones.
//!
//! q = (sin α cos φ, sin α sin φ, cos α) with φ = kx + ωt, and N·q = s. In continuous time:
//! ```text
//! ω² − sω/cos α − 2J(1 − cos k) = 0
//! ```
//! Between two steps N is a e₃ + b m. The unit vector m is along the mean of both q in the plane. With Ω = ωh:
//! ```text
//! b sin(Ω/2) = −h J(1 − cos k) sin α cos α             the kick turns N by Ω
//! a cos α + b sin α cos(Ω/2) = s
//! |N| sin α sin(Ω/2) = tan(φ/2) (a sin α cos(Ω/2) − b cos α)    N turns q by φ, with sin φ = h|N|
//! ```
//! Source: Kikuchi and Tatara, *Spin dynamics with inertia in metallic ferromagnets*, Physical Review B 92 (2015) 184410, for spins with inertia.

use crate::ring::{Magnet, turned};
use clebsch_examples::scene::Failure;
use nalgebra::{Rotation3, Vector3};

/// The two frequencies of a wave.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Branch {
    /// Of the spins: that of Heisenberg's model for large s.
    Slow,
    /// Nutation, near s.
    Fast,
}

/// A wave on a ring.
#[derive(Clone, Copy, Debug)]
pub struct Cone {
    /// J.
    pub exchange: f64,
    /// s.
    pub spin: f64,
    /// α, rad.
    pub tilt: f64,
    /// k, rad.
    pub k: f64,
    /// Seconds.
    pub h: f64,
}

impl Cone {
    /// 2J(1 − cos k)
    fn pull(&self) -> f64 {
        4.0 * self.exchange * (self.k / 2.0).sin().powi(2)
    }

    /// In continuous time, 1/s.
    pub fn frequency(&self, branch: Branch) -> f64 {
        let half = self.spin / self.tilt.cos() / 2.0;
        let fast = half + half.signum() * (half * half + self.pull()).sqrt();
        // the product of both is −2J(1 − cos k)
        if branch == Branch::Fast { fast } else { -self.pull() / fast }
    }

    /// Of Heisenberg's model, 1/s.
    pub fn heisenberg(&self) -> f64 {
        -self.pull() * self.tilt.cos() / self.spin
    }

    /// a and b for the angle Ω of a step.
    fn momentum(&self, turn: f64) -> [f64; 2] {
        let (sin, cos) = self.tilt.sin_cos();
        let b = if turn == 0.0 { 0.0 } else { -self.h * self.pull() / 2.0 * sin * cos / (turn / 2.0).sin() };
        [(self.spin - b * sin * (turn / 2.0).cos()) / cos, b]
    }

    /// How far Ω is from that of a step, over h.
    fn defect(&self, turn: f64) -> f64 {
        let (sin, cos) = self.tilt.sin_cos();
        let [a, b] = self.momentum(turn);
        let norm = a.hypot(b);
        let half = (self.h * norm).asin() / 2.0;
        let reach = a * sin * (turn / 2.0).cos() - b * cos;
        2.0 * (norm * sin * (turn / 2.0).sin() * half.cos() - half.sin() * reach) / (self.h * norm * sin)
    }

    /// That of the steps, 1/s, by secants from that in continuous time.
    pub fn of_steps(&self, branch: Branch) -> f64 {
        let mut last = self.frequency(branch) * self.h;
        let mut turn = last * (1.0 + 1e-4);
        let mut before = self.defect(last);
        for _ in 0..30 {
            let defect = self.defect(turn);
            let next = turn - defect * (turn - last) / (defect - before);
            if !next.is_finite() || (next - turn).abs() <= f64::EPSILON * turn.abs() {
                break;
            }
            (last, before, turn) = (turn, defect, next);
        }
        turn / self.h
    }

    /// A ring of spins on this wave at a vertex: q, and N half a kick after the last drift.
    fn start(&self, sites: usize, turn: f64) -> (Vec<Vector3<f64>>, Vec<Vector3<f64>>) {
        let (sin, cos) = self.tilt.sin_cos();
        let [a, b] = self.momentum(turn);
        // the mean of both N about a vertex
        let mean = Vector3::new(b * (turn / 2.0).cos(), 0.0, a);
        let about = |i: usize| Rotation3::new(Vector3::z() * (self.k * i as f64));
        let q = (0..sites).map(|i| about(i) * Vector3::new(sin, 0.0, cos)).collect();
        (q, (0..sites).map(|i| about(i) * mean).collect())
    }

    /// The frequency of a ring of so many spins in so many steps, and by how much N·q moves from s.
    ///
    /// # Errors
    /// Those of steps.
    pub fn measured(&self, branch: Branch, sites: usize, steps: u64) -> Result<[f64; 2], Failure> {
        let stepper = Magnet { exchange: self.exchange }.ring(sites, self.h)?;
        let (q, mu) = self.start(sites, self.of_steps(branch) * self.h);
        let mut state = stepper.state(q, mu)?;
        let (mut turn, mut defect) = (0.0, 0.0_f64);
        for step in 1..=steps {
            let before = state.configuration()[0];
            stepper.step(&mut state).map_err(Failure::step(step))?;
            turn += turned(&before, &state.configuration()[0]);
            let along = state.configuration().iter().zip(state.momentum()).map(|(q, mu)| (q.dot(mu) - self.spin).abs());
            defect = along.fold(defect, f64::max);
        }
        Ok([turn / (steps as f64 * self.h), defect])
    }
}
