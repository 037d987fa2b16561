//! Slews by shooting: the momentum at the start whose free motion ends at the target, by Newton's method.

use super::euler::{Euler, Motion};
use crate::attitude::turn;
use nalgebra::{Matrix3, Vector3};

/// Newton corrections at most.
const CORRECTIONS: usize = 40;
/// The largest correction, in units of the momentum of a body that turns by one radian.
const LARGEST: f64 = 0.5;
/// Times at which conjugate points are looked for.
const SAMPLES: usize = 400;
/// Times at which the growth of errors is looked at.
const GROWTH: u64 = 50;

/// A free motion that ends at the target.
#[derive(Clone, Copy, Debug)]
pub struct Shot {
    /// π₀ in units of [`Euler`].
    pub momentum: Vector3<f64>,
    /// J·s
    pub action: f64,
    /// How far the momentum may be off: the error of integration, as the motion magnifies it.
    pub error: f64,
}

impl Shot {
    /// The motion near this momentum that ends at `to`; `None` where corrections do not end.
    pub fn aim(euler: &Euler, to: &Matrix3<f64>, guess: &Vector3<f64>) -> Option<Self> {
        let mut momentum = *guess;
        let mut last = f64::INFINITY;
        for _ in 0..CORRECTIONS {
            let end = euler.after(&euler.start(&momentum), 1.0);
            let inverse = end.by_momentum.try_inverse()?;
            let correction = inverse * turn(&end.attitude, to);
            let size = correction.norm();
            // Corrections are squared each time, until only rounding is left.
            if size >= last && last < 1e-10 {
                let error = last + inverse.norm() * end.error;
                return Some(Self { momentum, action: euler.action(&momentum), error });
            }
            last = size;
            momentum += correction * (LARGEST / size).min(1.0);
        }
        None
    }

    /// The number of conjugate points within the slew, where det ∂η/∂π₀ vanishes: the index of the action, by Morse's theorem.
    ///
    /// `None` where two of them are too near one another, or one too near the end, to be counted.
    pub fn conjugate_points(&self, euler: &Euler) -> Option<usize> {
        let part = 1.0 / SAMPLES as f64;
        let mut motion = euler.start(&self.momentum);
        let mut sizes = Vec::with_capacity(SAMPLES);
        for k in 1..=SAMPLES {
            motion = euler.after(&motion, part);
            sizes.push((motion.by_momentum / (k as f64 * part)).determinant());
        }
        let touches = |w: &[f64]| w[1].abs() < 1e-3 * sizes[0] && w[1].abs() < w[0].abs() && w[1].abs() <= w[2].abs();
        let crosses = |w: &[f64]| (w[0] < 0.0) != (w[1] < 0.0);
        let unclear = sizes.windows(3).any(|w| touches(w) && !crosses(&w[..2]) && !crosses(&w[1..]));
        let last = sizes[SAMPLES - 1].abs() < 1e-6 * sizes[0];
        (!unclear && !last).then(|| sizes.windows(2).filter(|w| crosses(w)).count())
    }

    /// The motion at so many equal parts of the time, the start and the end among them.
    pub fn path(&self, euler: &Euler, parts: u64) -> Vec<Motion> {
        let start = euler.start(&self.momentum);
        let later = |motion: &Motion| Some(euler.after(motion, 1.0 / parts as f64));
        std::iter::successors(Some(start), later).take(parts as usize + 1).collect()
    }

    /// By how much an error of the momentum, relative, grows as an angle on the way.
    pub fn growth(&self, euler: &Euler) -> f64 {
        let path = self.path(euler, GROWTH);
        path.iter().fold(1.0, |growth, motion| (motion.by_momentum.norm() * self.momentum.norm()).max(growth))
    }
}
