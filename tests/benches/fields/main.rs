//! The benchmark of fields: `cargo bench -p clebsch-tests --bench fields`.
//!
//! Nanoseconds of a step for each site, and the same by hand in plain Rust with nalgebra. These are waves of unit vectors on sheets that are
//! periodic, and a string. All are timed in turn in the same run. By hand no state is checked.

#[path = "../steps/timing.rs"]
mod timing;

use clebsch::{Clebsch, Field, FieldState, SiteError};
use clebsch_tests::fixtures::wave_map::WaveMap;
use nalgebra::{Vector1, Vector3};
use std::cell::RefCell;
use timing::{Run, Time, interleaved};

/// The step size, and the spacing of sites.
const H: f64 = 0.05;
const SPACING: f64 = 0.1;
/// Rounds of so many steps start anew.
const STEPS: u64 = 50;
/// 8ε, from which on |q|² is off.
const OFF: f64 = 8.0 * f64::EPSILON;

/// A string of density 1 and tension 1, its displacement x.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |a: Translation<1>, x: Vector1| x + a,
    cost   = |h, a| a.norm_squared() / (2 * h),
    space  = |dx, x, next| (next - x).norm_squared() / (2 * dx.powi(2)),
)]
struct Strand;

type Vectors = Vec<Vector3<f64>>;

/// A wave with 1 along the sides and along the others.
fn wave(n: usize) -> (Vectors, Vectors) {
    let turn = |i: usize| std::f64::consts::TAU * i as f64 / n as f64;
    let tilt = |site: usize| 0.5 * turn(site / n).sin() * turn(site % n).cos();
    let place = |site: usize| Vector3::new(tilt(site).sin(), 0.0, tilt(site).cos());
    ((0..n * n).map(place).collect(), vec![Vector3::zeros(); n * n])
}

/// N ← N + w q × Σ of the neighbours of each site, on a sheet of n × n sites.
fn kick(n: usize, weight: f64, q: &[Vector3<f64>], mu: &mut [Vector3<f64>]) {
    for i in 0..n {
        let row = |i: usize| &q[i % n * n..][..n];
        let (before, own, after) = (row(i + n - 1), row(i), row(i + 1));
        for (j, mu) in mu[i * n..][..n].iter_mut().enumerate() {
            let (left, right) = (if j == 0 { n - 1 } else { j - 1 }, if j + 1 == n { 0 } else { j + 1 });
            let sum = before[j] + after[j] + own[left] + own[right];
            *mu += own[j].cross(&(sum * weight));
        }
    }
}

/// q turns by θ about N, sin θ = h|N|.
fn drift(q: &mut [Vector3<f64>], mu: &[Vector3<f64>]) {
    for (q, mu) in q.iter_mut().zip(mu) {
        let x = mu * H;
        let cosine = (1.0 - x.norm_squared()).sqrt();
        *q = *q * cosine + x.cross(q);
        let squared = q.norm_squared();
        if (squared - 1.0).abs() > OFF {
            *q *= (3.0 - squared) / 2.0;
        }
    }
}

/// So many steps by hand.
fn by_hand(n: usize, steps: u64, q: &mut [Vector3<f64>], mu: &mut [Vector3<f64>]) {
    let weight = H / (SPACING * SPACING);
    kick(n, weight / 2.0, q, mu);
    for step in 1..=steps {
        drift(q, mu);
        kick(n, if step == steps { weight / 2.0 } else { weight }, q, mu);
    }
}

/// So many steps of a string by hand.
fn string_by_hand(steps: u64, x: &mut [f64], mu: &mut [f64]) {
    let (n, weight) = (x.len(), H / (SPACING * SPACING));
    let kick = |weight: f64, x: &[f64], mu: &mut [f64]| {
        mu[0] += weight * (x[1] + x[n - 1] - 2.0 * x[0]);
        for (mu, x) in mu[1..n - 1].iter_mut().zip(x.windows(3)) {
            *mu += weight * (x[0] + x[2] - 2.0 * x[1]);
        }
        mu[n - 1] += weight * (x[0] + x[n - 2] - 2.0 * x[n - 1]);
    };
    kick(weight / 2.0, x, mu);
    for step in 1..=steps {
        x.iter_mut().zip(&*mu).for_each(|(x, mu)| *x += H * mu);
        kick(if step == steps { weight / 2.0 } else { weight }, x, mu);
    }
}

/// Rounds of steps that start anew.
fn rounds<'a, V: Clone + 'a>(start: V, step: impl FnMut(&mut V, u64) + 'a) -> Run<'a> {
    let step = RefCell::new(step);
    Box::new(move |steps| {
        let mut left = steps;
        while left > 0 {
            let now = left.min(STEPS);
            let mut state = start.clone();
            (step.borrow_mut())(&mut state, now);
            std::hint::black_box(&state);
            left -= now;
        }
    })
}

fn print(name: &str, sites: usize, times: &[Time]) {
    let [ours, by_hand] = [0, 1].map(|k| times[k].least / sites as f64);
    let medians = times[0].median / times[1].median;
    println!("{name:<24} {sites:>8} {ours:>10.2} {by_hand:>10.2} {:>8.2} {medians:>10.2}", ours / by_hand);
}

fn main() -> Result<(), SiteError> {
    println!(
        "{:<24} {:>8} {:>10} {:>10} {:>8} {:>10}",
        "ns a step and site", "sites", "clebsch", "by hand", "ratio", "of medians"
    );
    for n in [32, 128, 512] {
        let stepper = WaveMap.grid([n, n]).spacing([SPACING; 2]).periodic().stepper(H)?;
        let (q, mu) = wave(n);
        let start: FieldState<Vectors, Vectors> = stepper.state(q.clone(), mu.clone())?;
        let mut check = (start.clone(), (q.clone(), mu.clone()));
        stepper.advance(&mut check.0, STEPS)?;
        by_hand(n, STEPS, &mut check.1.0, &mut check.1.1);
        let apart = check.0.configuration().iter().zip(&check.1.0).map(|(a, b)| (a - b).amax()).fold(0.0, f64::max);
        assert!(apart < 1e-11, "both are the same motion, and {apart} apart");
        let ours = rounds(start, |state, steps| stepper.advance(state, steps).expect("steps"));
        let hand = rounds((q, mu), |(q, mu), steps| by_hand(n, steps, q, mu));
        print("waves of unit vectors", n * n, &interleaved(&[ours, hand]));
    }
    for n in [1024, 65_536] {
        let stepper = Strand.grid([n]).spacing([SPACING]).periodic().stepper(H)?;
        let heights = |i: usize| (std::f64::consts::TAU * i as f64 / n as f64).sin();
        let start =
            stepper.state((0..n).map(|i| Vector1::new(heights(i))).collect::<Vec<_>>(), vec![Vector1::zeros(); n])?;
        let ours = rounds(start, |state, steps| stepper.advance(state, steps).expect("steps"));
        let plain: (Vec<f64>, Vec<f64>) = ((0..n).map(heights).collect(), vec![0.0; n]);
        let hand = rounds(plain, |(x, mu), steps| string_by_hand(steps, x, mu));
        print("string", n, &interleaved(&[ours, hand]));
    }
    Ok(())
}
