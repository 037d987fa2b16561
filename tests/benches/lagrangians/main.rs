//! The benchmark of Lagrangians with long steps: `cargo bench -p clebsch-tests --bench lagrangians`.
//!
//! Nanoseconds of a step where the metric depends on the configuration, or where the group has many dimensions. The
//! same scheme by hand in nalgebra is timed in turn in the same run. Both are seen to make the same motion first.

mod hand;
mod systems;
#[path = "../steps/timing.rs"]
mod timing;

use clebsch::{Clebsch, Declared, Method};
use hand::ByHand;
use nalgebra::{Matrix3, Rotation3, SMatrix, SVector, Vector3};
use std::hint::black_box;
use systems::{Chain, Foucault, Hyperbolic, OrderFour, Similarity, Unitary};
use timing::{Run, interleaved};

/// The step size.
const H: f64 = 0.01;
/// The steps after which both are compared.
const COMPARED: usize = 100;
/// By how much they may differ then. Round-off of 100 steps in nearby numbers is 10⁻¹³ here.
const SAME: f64 = 1e-12;

/// A momentum of about this size, in a general direction.
fn momentum<const M: usize>(size: f64) -> SVector<f64, M> {
    SVector::from_fn(|i, _| size * ((3 * i + 1) as f64).sin())
}

/// Positive weights, all different.
fn weights<const M: usize>() -> SVector<f64, M> {
    SVector::from_fn(|i, _| 1.0 + 0.3 * i as f64)
}

/// A general matrix.
fn stiffness<const N: usize>() -> SMatrix<f64, N, N> {
    SMatrix::from_fn(|i, j| 0.3 * ((2 * i + 5 * j + 1) as f64).cos())
}

/// A state in the numbers of the scheme by hand.
type Handed<S, B> = fn(<S as Clebsch>::Configuration, <S as Clebsch>::Momentum) -> <B as ByHand>::State;
/// By how much the configuration and the momentum of both differ.
type Apart<S, B> = fn(&<S as Clebsch>::Configuration, &<S as Clebsch>::Momentum, &<B as ByHand>::State) -> f64;

/// A system, a start, and the scheme by hand.
struct Scene<S: Clebsch, B: ByHand> {
    name: &'static str,
    system: S,
    q: S::Configuration,
    mu: S::Momentum,
    by_hand: B,
    handed: Handed<S, B>,
    apart: Apart<S, B>,
}

impl<S: Clebsch<Scalar = f64> + Clone, B: ByHand> Scene<S, B> {
    /// Compares both motions, and prints the times.
    fn report<M: Method<S>>(&self) {
        let stepper = self.system.stepper_by::<M>(H).expect("a regular system");
        let start = stepper.state(self.q, self.mu).expect("a state");
        let handed = (self.handed)(self.q, self.mu);
        let by_hand = |steps: u64| (0..steps).fold(black_box(handed), |state, _| self.by_hand.step(state));

        let end = stepper.advance(&start, COMPARED).expect("steps");
        let apart = (self.apart)(end.configuration(), &end.momentum(), &by_hand(COMPARED as u64));
        assert!(apart < SAME, "{}: the same motion, not {apart:e} off", self.name);

        let contestants: [Run<'_>; 2] = [
            Box::new(|steps| {
                black_box(stepper.advance(black_box(&start), steps as usize).expect("steps"));
            }),
            Box::new(|steps| {
                black_box(by_hand(steps));
            }),
        ];
        let times = interleaved(&contestants);
        let [ours, hand] = [times[0], times[1]];
        println!(
            "{:34} {:9.1} {:9.1} {:9.1} {:9.1} {:6.2} {apart:9.1e}",
            self.name,
            ours.least,
            hand.least,
            ours.median,
            hand.median,
            ours.least / hand.least
        );
    }
}

/// The largest difference of two matrices.
fn off<const R: usize, const C: usize>(a: &SMatrix<f64, R, C>, b: &SMatrix<f64, R, C>) -> f64 {
    (a - b).amax()
}

fn foucault() {
    let system = Foucault { gravity: 9.81, rate: Vector3::new(0.3, 0.0, 0.4) };
    let q = Vector3::new(0.36, 0.48, -0.8);
    Scene {
        name: "Foucault's pendulum",
        by_hand: hand::foucault::Pendulum { system: system.clone(), h: H },
        system,
        q,
        mu: q.cross(&Vector3::new(0.3, 1.0, 0.2)),
        handed: |q, mu| (q, mu),
        apart: |q, mu, hand| off(q, &hand.0).max(off(mu, &hand.1)),
    }
    .report::<Declared>();
}

fn hyperbolic() {
    let system = Hyperbolic { inertia: weights(), stiffness: 0.7 };
    let q = Vector3::new(0.3, -0.2, 1.2);
    Scene {
        name: "orbits of SO(2, 1)",
        by_hand: hand::hyperbolic::Orbit::new(&system, H),
        q,
        mu: system.momentum_map(&q, &momentum(0.5)),
        system,
        handed: |q, mu| (q, hand::hyperbolic::vector(&mu)),
        apart: |q, mu, hand| off(q, &hand.0).max(off(mu, &hand::hyperbolic::basis(&hand.1))),
    }
    .report::<Declared>();
}

fn chain() {
    let inertia = Matrix3::new(0.5, 0.1, 0.0, 0.1, 0.6, -0.05, 0.0, -0.05, 0.7);
    let system = Chain { mass: 0.7, weight: 3.0, link: Vector3::new(0.1, -0.2, -0.9), inertia };
    let turned = |x: f64, y: f64, z: f64| *Rotation3::from_scaled_axis(Vector3::new(x, y, z)).matrix();
    Scene {
        name: "three links, SO(3)³",
        by_hand: hand::chain::Links { system: system.clone(), h: H },
        system,
        q: [turned(0.1, 0.2, 0.3), turned(-0.4, 0.1, 0.2), turned(0.5, -0.3, 0.1)],
        mu: SVector::from([0.3, 0.2, 0.1, -0.2, 0.1, 0.4, 0.1, 0.1, -0.3]),
        handed: |q, mu| (q, mu),
        apart: |q, mu, hand| (0..3).map(|k| off(&q[k], &hand.0[k])).fold(off(mu, &hand.1), f64::max),
    }
    .report::<Declared>();
}

fn similarity() {
    let system = Similarity { inertia: weights(), stiffness: stiffness() };
    Scene {
        name: "Sim(2)",
        by_hand: hand::similarity::Plane { system: system.clone(), h: H },
        system: system.clone(),
        q: SMatrix::identity(),
        mu: momentum(0.5),
        handed: |q, mu| (q, mu),
        apart: |q, mu, hand| off(q, &hand.0).max(off(mu, &hand.1)),
    }
    .report::<Declared>();
    Scene {
        name: "Sim(2), order 4",
        by_hand: hand::similarity::Composed::new(&system, H),
        system,
        q: SMatrix::identity(),
        mu: momentum(0.5),
        handed: |q, mu| (q, mu),
        apart: |q, mu, hand| off(q, &hand.0).max(off(mu, &hand.1)),
    }
    .report::<OrderFour>();
}

fn unitary(name: &'static str, size: f64) {
    let system = Unitary { inertia: weights(), stiffness: stiffness() };
    Scene {
        name,
        by_hand: hand::unitary::Body::new(&system, H),
        system,
        q: SMatrix::identity(),
        mu: momentum(size),
        handed: |q, mu| (q, mu),
        apart: |q, mu, hand| off(q, &hand.0).max(off(mu, &hand.1)) / off(mu, &SVector::zeros()),
    }
    .report::<Declared>();
}

fn main() {
    println!("Time of a step, ns, least and median; ratio to the same scheme by hand; by how much they differ after");
    println!("{COMPARED} steps\n");
    println!(
        "{:34} {:>9} {:>9} {:>9} {:>9} {:>6} {:>9}",
        "", "least", "by hand", "median", "by hand", "ratio", "apart"
    );
    foucault();
    hyperbolic();
    chain();
    similarity();
    unitary("SU(3)", 0.5);
    unitary("SU(3), h|ω| of 0.1", 10.0);
}
