//! The facts that the macro finds out by itself, for every declaration of the gallery. These are the side of the
//! action, whether the step is explicit, the conserved momenta, and the formulas. Each is compared with numbers that
//! are computed by hand.

#![allow(missing_docs)]

mod groups;
mod motions;
mod opaque;
mod rigid_bodies;
mod spheres;

use clebsch::{Clebsch, Conserved, Conserves};
use clebsch_tests::oracle::flat::{Flat, far};

const H: f64 = 0.05;

/// Rounding of numbers near one, divided by h.
const NEAR: f64 = 1e-12;

/// Fails where a sentence is missing in the derivation.
#[track_caller]
fn assert_says<S: Clebsch>(sentences: &[&str]) {
    for sentence in sentences {
        assert!(S::DERIVATION.contains(sentence), "{}: no `{sentence}` in\n{}", S::NAME, S::DERIVATION);
    }
}

/// Fails where a sentence stands in the derivation.
#[track_caller]
fn assert_says_nowhere<S: Clebsch>(sentences: &[&str]) {
    for sentence in sentences {
        assert!(!S::DERIVATION.contains(sentence), "{}: `{sentence}` in\n{}", S::NAME, S::DERIVATION);
    }
}

const STEPS: usize = 200;

/// The momenta with these names, and no others, are conserved over 200 steps to round-off, while something moves.
#[track_caller]
fn assert_conserved<S, const K: usize>(system: S, q: S::Configuration, mu: S::Momentum, names: [&str; K])
where
    S: Clebsch<Scalar = f64> + Conserves<Conserved = Conserved<f64, K>>,
    S::Configuration: Flat,
    S::Momentum: Flat,
{
    let stepper = system.into_stepper(H).expect("a regular system");
    let start = stepper.state(q, mu).expect("a state");
    let expected = stepper.conserved(&start);
    assert_eq!(expected.names(), &names, "{}", S::NAME);
    let mut state = start;
    for _ in 0..STEPS {
        state = stepper.step(&state).expect("a solvable step");
        for ((name, now), (_, then)) in stepper.conserved(&state).iter().zip(expected.iter()) {
            assert!((now - then).abs() < 1e-11, "{}: the momentum {name} was {then} and is {now}", S::NAME);
        }
    }
    assert!(far(state.configuration(), start.configuration()) > 1e-2, "{}: it moves", S::NAME);
}

/// 50 steps of h and 50 of −h lead back to the start, as for every time-symmetric step.
#[track_caller]
fn assert_reversible<S>(system: &S, q: S::Configuration, mu: S::Momentum)
where
    S: Clebsch<Scalar = f64> + Clone,
    S::Configuration: Flat,
    S::Momentum: Flat,
{
    let (forward, back) = (system.stepper(H).expect("a regular system"), system.stepper(-H).expect("a regular system"));
    let start = forward.state(q, mu).expect("a state");
    let mut state = start;
    for _ in 0..50 {
        state = forward.step(&state).expect("a solvable step");
    }
    assert!(far(state.configuration(), start.configuration()) > 1e-2, "{}: it moves", S::NAME);
    // a state keeps the impulse of its stepper, which is that of h
    state = back.state(*state.configuration(), state.momentum()).expect("a state");
    for _ in 0..50 {
        state = back.step(&state).expect("a solvable step");
    }
    let distance = far(state.configuration(), start.configuration()).max(far(&state.momentum(), &start.momentum()));
    assert!(distance < 1e-11, "{}: {distance:.1e} from the start", S::NAME);
}
