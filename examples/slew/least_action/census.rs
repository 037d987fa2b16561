//! All slews up to some action, by shooting in all directions.

use super::euler::Euler;
use super::shooting::Shot;
use clebsch_examples::progress::Progress;
use nalgebra::{Matrix3, Vector3};

/// Directions to shoot in, evenly spread.
const DIRECTIONS: u32 = 100;
/// Actions to shoot with, as parts of the largest.
const LEVELS: [f64; 3] = [0.15, 0.5, 0.9];
/// Momenta that are less apart, in units of [`Euler`], are the same.
const SAME: f64 = 1e-6;

/// The free motions to `to` with no more than `largest`, J·s, of action, the least first; and how many shots were made.
///
/// The action of a free motion is its energy times the duration, so that all of them start within an ellipsoid of momenta. Nothing
/// proves that none has been missed.
pub fn take(euler: &Euler, to: &Matrix3<f64>, known: impl Iterator<Item = Shot>, largest: f64) -> (Vec<Shot>, usize) {
    let starts: Vec<_> =
        LEVELS.iter().flat_map(|level| (0..DIRECTIONS).map(move |k| (spiral(k), level * largest))).collect();
    let mut progress = Progress::of(starts.len() as u64, "shots");
    let aimed = (1..).zip(&starts).filter_map(|(number, (direction, action))| {
        let shot = Shot::aim(euler, to, &euler.momentum(direction, *action));
        progress.reached(number);
        shot.filter(|shot| shot.action <= largest * (1.0 + 1e-9))
    });
    let mut shots: Vec<Shot> = Vec::new();
    for new in known.chain(aimed) {
        if shots.iter().all(|known| !is_same(known, &new)) {
            shots.push(new);
        }
    }
    shots.sort_by(|a, b| a.action.total_cmp(&b.action));
    (shots, starts.len())
}

/// Whether both are the same motion.
pub fn is_same(a: &Shot, b: &Shot) -> bool {
    (a.momentum - b.momentum).norm() < SAME
}

/// The k-th of [`DIRECTIONS`] points on a spiral around the sphere, whose turns are golden sections.
fn spiral(k: u32) -> Vector3<f64> {
    let height = 1.0 - (2.0 * f64::from(k) + 1.0) / f64::from(DIRECTIONS);
    let (sin, cos) = (f64::from(k) * std::f64::consts::PI * (3.0 - 5.0_f64.sqrt())).sin_cos();
    let radius = (1.0 - height * height).sqrt();
    Vector3::new(radius * cos, radius * sin, height)
}
