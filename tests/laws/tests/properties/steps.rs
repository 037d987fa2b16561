//! Steps: their invariants, their inverses, and that each way of making them is the same.

use crate::arbitrary::{attitude, cases, definite, matrix, unit, vector};
use crate::bodies::{H, damped_bodies, generic_top, particles, pendulums, satellites, staggered_tops, tops};
use crate::runner::proptest;
use clebsch::__private::{At, Scheme};
use clebsch::{Clebsch, Clock, Conserved, Conserves, Error, F64x8, Mask, Scalar, Space, Time};
use clebsch_tests::fixtures::generic_body::GenericBody;
use clebsch_tests::fixtures::split_top::SplitTop;
use clebsch_tests::oracle::near::assert_near;
use clebsch_tests::stepping::Stepping;
use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;

/// How a top is stepped.
type SchemeOf = <clebsch_tests::fixtures::watched_top::WatchedTop as Clebsch>::Scheme;

/// Rounding of a few steps of numbers of order one, divided by h.
const NEAR: f64 = 1e-12;

/// Eight bodies; some are too fast for a step.
fn eight() -> BoxedStrategy<[(Matrix3<f64>, Vector3<f64>); 8]> {
    let body = (attitude(), vector::<3>(1.0), prop::bool::weighted(0.3));
    let made = |(r, mu, is_fast): (Matrix3<f64>, Vector3<f64>, bool)| (r, if is_fast { mu * 1e4 } else { mu });
    prop::collection::vec(body.prop_map(made), 8).prop_map(|bodies| bodies.try_into().expect("eight")).boxed()
}

proptest! {
    #![proptest_config(cases(32))]

    /// So many steps at once are so many steps, and the states of a trajectory: bit for bit where steps are not merged.
    #[test]
    fn ways_of_stepping_agree(top in tops(), r in attitude(), mu in vector::<3>(2.0), steps in 0_usize..12) {
        let stepper = top.stepper(H)?;
        let start = stepper.state(r, mu)?;
        prop_assert_eq!((start.configuration(), start.momentum(), start.into_parts()), (&r, mu, (r, mu)));
        let mut state = start;
        for _ in 0..steps {
            state = stepper.step(&state)?;
        }
        prop_assert_eq!(stepper.advance(&start, steps)?, state);
        prop_assert_eq!(stepper.trajectory(start).nth(steps), Some(Ok(state)));
        let constants = top.step_constants(H)?;
        let impulse = top.impulse(&constants, 0.0, &r, &mu);
        let (q, n, _) = SchemeOf::steps(At::new(&top, &constants, 0.0), H, steps, (&r, &mu, &impulse), &())?;
        prop_assert_eq!((q, n), state.into_parts());
        let (q, n, last) = top.step(&constants, 0.0, &r, &mu, &impulse, &())?;
        prop_assert_eq!((q, n), stepper.step(&start)?.into_parts());
        // the kick at the end is that at the start of the next step
        assert_near(&last, &top.impulse(&constants, H, &q, &n), NEAR, "the shared kick");
        prop_assert_eq!(SchemeOf::left_after(At::new(&top, &constants, H), &q, &n, &last), top.impulse(&constants, H, &q, &n));
        let (state, made) = stepper.step_each(&start);
        prop_assert_eq!((state, made, stepper.failure(&start, 0)), (stepper.step(&start)?, true, None));
        prop_assert_eq!(Space::<f64>::lane(&r, 0), start.lane(0).0);
    }

    /// Splittings merge the drifts of neighbouring steps, so that only rounding differs.
    #[test]
    fn merged_steps_agree(inertia in definite::<3>(), center in vector::<3>(1.0), r in attitude(), mu in vector::<3>(2.0), steps in 0_usize..12) {
        let stepper = SplitTop { inertia, weight: 1.0, center }.into_stepper(H)?;
        let start = stepper.state(r, mu)?;
        let mut state = start;
        for _ in 0..steps {
            state = stepper.step(&state)?;
        }
        let at_once = stepper.advance(&start, steps)?;
        assert_near(at_once.configuration(), state.configuration(), NEAR, "the configuration");
        assert_near(&at_once.momentum(), &state.momentum(), NEAR, "the momentum");
    }

    /// A step obeys F⁻ℓd and F⁺ℓd, steps of −h lead back, and the vertical momentum stays.
    #[test]
    fn steps_are_legendre_transforms_and_symmetric(top in tops(), r in attitude(), mu in vector::<3>(2.0)) {
        let (stepper, back) = (top.stepper(H)?, top.stepper(-H)?);
        let start = stepper.state(r, mu)?;
        let state = stepper.step(&start)?;
        let f = stepper.inverse_legendre(&r, &mu)?;
        assert_near(state.configuration(), &stepper.act(&f, &r), NEAR, "q⁺ = Φ_F(q)");
        assert_near(&state.momentum(), &stepper.legendre_next(&r, &f), NEAR, "N⁺ = F⁺ℓd");
        let returned = back.step(&state)?;
        assert_near(returned.configuration(), &r, NEAR, "back");
        assert_near(&returned.momentum(), &mu, NEAR, "back");
        prop_assert_eq!((back.step_size(), back.system().weight), (-H, top.weight));
        let end = stepper.advance(&start, 20)?;
        let (then, now): (Conserved<f64, 1>, Conserved<f64, 1>) = (stepper.conserved(&start), stepper.conserved(&end));
        prop_assert!((then[0] - (r * mu).z).abs() < 1e-14 && (now[0] - then[0]).abs() < 1e-14 * 20.0);
        prop_assert_eq!(top.conserved(end.configuration(), &end.momentum()), now);
        // of second order: at |μ| ≤ 4 and h = 0.05 energies move by some h²
        let energy = stepper.energy(&start);
        prop_assert!((stepper.energy(&end) - energy).abs() < 0.05 * (1.0 + energy.abs()));
    }

    /// (q, p) is stepped as (q, J(q, p)).
    #[test]
    fn representations_agree(top in tops(), r in attitude(), p in matrix::<3, 3>(1.0)) {
        let stepper = top.stepper(H)?;
        let upstairs = stepper.cotangent_state(r, p)?;
        prop_assert_eq!((upstairs.configuration(), upstairs.covector(), upstairs.into_parts()), (&r, &p, (r, p)));
        let next = stepper.step_symmetric(&upstairs)?;
        let state = stepper.step(&stepper.state(r, stepper.momentum_map(&r, &p))?)?;
        assert_near(next.configuration(), state.configuration(), NEAR, "q");
        let map = stepper.momentum_map(next.configuration(), next.covector());
        assert_near(&map, &state.momentum(), NEAR, "N = J(q, p)");
        let constants = top.step_constants(H)?;
        prop_assert_eq!(top.step_symmetric(&constants, 0.0, &r, &p)?, next.into_parts());
    }

    /// Each lane is a body alone, with the same bits and the same errors.
    #[test]
    fn lanes_are_bodies_alone(mass in definite::<3>(), weight in 0.1_f64..3.0, center in vector::<3>(1.0), bodies in eight()) {
        let wide = generic_top::<F64x8>(&mass, weight, &center).into_stepper(F64x8::splat(H))?;
        let one = generic_top::<f64>(&mass, weight, &center).into_stepper(H)?;
        let q = <Matrix3<F64x8> as Space<F64x8>>::side_by_side(|lane| bodies[lane].0);
        let mu = <Vector3<F64x8> as Space<F64x8>>::side_by_side(|lane| bodies[lane].1);
        let start = wide.state(q, mu)?;
        let (next, stepped) = wide.step_each(&start);
        for (lane, (r, mu)) in bodies.iter().enumerate() {
            prop_assert_eq!(start.lane(lane), (*r, *mu));
            let alone = one.state(*r, *mu)?;
            match one.step(&alone) {
                Ok(state) => {
                    prop_assert!(stepped.lane(lane) && wide.failure(&start, lane).is_none());
                    prop_assert_eq!(next.lane(lane), state.into_parts());
                }
                Err(error) => {
                    prop_assert!(!stepped.lane(lane));
                    prop_assert_eq!(wide.failure(&start, lane), Some(error));
                    prop_assert_eq!(next.lane(lane), (*r, *mu), "it stays");
                }
            }
        }
        match wide.step(&start) {
            Ok(state) => prop_assert!(stepped.all() && state == next),
            Err(error) => {
                let is_said = matches!(error, Error::InLane { .. });
                prop_assert!(!stepped.all() && is_said, "{error}");
            }
        }
    }

    /// Where the time matters, states have one: t₀ + kh, on both bundles.
    #[test]
    fn states_know_their_time(satellite in satellites(), r in attitude(), p in matrix::<3, 3>(1.0), t in -5.0_f64..5.0, steps in 0_usize..9) {
        let stepper = satellite.stepper(H)?;
        let mu = stepper.momentum_map(&r, &p);
        let start = stepper.state_at(t, r, mu)?;
        let end = stepper.advance(&start, steps)?;
        prop_assert_eq!(start.time(), t);
        prop_assert!((end.time() - t - H * steps as f64).abs() <= 2.0 * f64::EPSILON * (t.abs() + 1.0));
        prop_assert_eq!(stepper.state(r, mu)?, stepper.state_at(0.0, r, mu)?);
        let mut upstairs = stepper.cotangent_state_at(t, r, p)?;
        prop_assert_eq!(upstairs.time(), t);
        for _ in 0..steps {
            upstairs = stepper.step_symmetric(&upstairs)?;
        }
        prop_assert_eq!(upstairs.time(), end.time());
        assert_near(upstairs.configuration(), end.configuration(), NEAR, "both at their times");
        prop_assert_eq!(<Clock<f64> as Time<f64>>::at(t).now(), t);
        prop_assert_eq!(stepper.staggered_state_at(t, r, mu)?, start);
        prop_assert!(stepper.state_at(f64::NAN, r, mu).is_err() && stepper.cotangent_state_at(f64::NAN, r, p).is_err());
    }

    /// A step of order 1 is half a kick ahead: the reading half a kick before is the result of steps of order 2.
    #[test]
    fn staggered_steps_are_read_to_second_order(top in staggered_tops(), r in attitude(), mu in vector::<3>(1.0), steps in 0_usize..9) {
        let stepper = top.stepper(H)?;
        let start = stepper.staggered_state(r, mu)?;
        assert_near(&stepper.synchronized(&start), &mu, NEAR, "there and back");
        // −h/2 J(R, ∂V) of V = w (R c)_z
        let ahead = r.row(2).transpose().cross(&top.center) * (H * top.weight / 2.0);
        assert_near(&top.stagger(H, 0.0, &r), &ahead, NEAR, "half a kick");
        let second = generic_top::<f64>(&top.mass_matrix, top.weight, &top.center).into_stepper(H)?;
        let (one, other) = (stepper.advance(&start, steps)?, second.advance(&second.state(r, mu)?, steps)?);
        assert_near(one.configuration(), other.configuration(), NEAR, "the same configurations");
        assert_near(&stepper.synchronized(&one), &other.momentum(), NEAR, "the same momenta");
        prop_assert!((stepper.synchronized_energy(&one) - second.energy(&other)).abs() < NEAR);
        prop_assert_eq!(second.synchronized(&other), other.momentum());
        prop_assert_eq!(second.synchronized_energy(&other), second.energy(&other));
        prop_assert_eq!(second.staggered_state(r, mu)?, second.state(r, mu)?);
    }

    /// R⁺N⁺ − RN = h/2 (Ru + R⁺u) of a torque u in the body, where nothing damps; without an input it is a plain step.
    #[test]
    fn torques_add_to_the_momentum(body in damped_bodies(), r in attitude(), mu in vector::<3>(1.0), u in vector::<3>(1.0)) {
        let stepper = body.stepper(H)?;
        let start = stepper.state(r, mu)?;
        prop_assert_eq!(stepper.step_with(&start, &Vector3::zeros())?, stepper.step(&start)?);
        let mut free = body;
        free.damping = 0.0;
        let stepper = free.into_stepper(H)?;
        let next = stepper.step_with(&stepper.state(r, mu)?, &u)?;
        let (q, n) = next.into_parts();
        assert_near(&(q * n - r * mu), &((r * u + q * u) * (H / 2.0)), NEAR, "the balance of momentum");
    }

    /// Points of the sphere stay there, and their momenta are orthogonal to them.
    #[test]
    fn pendulums_stay_on_the_sphere(pendulum in pendulums(), q in unit(), mu in vector::<3>(1.0), steps in 0_usize..50) {
        let stepper = pendulum.stepper(0.02)?;
        let end = stepper.advance(&stepper.project(q, mu)?, steps)?;
        prop_assert!((end.configuration().norm() - 1.0).abs() < 1e-14);
        prop_assert!(end.configuration().dot(&end.momentum()).abs() < NEAR);
    }
}

proptest! {
    #![proptest_config(cases(8))]

    /// The error of the suggested step after a time is about the wished one: a particle on a spring, whose motion is
    /// known.
    #[test]
    fn suggested_steps_reach_their_error(particle in particles(), x in vector::<2>(1.0), p in vector::<2>(1.0), digits in 3.0_f64..7.0) {
        prop_assume!(x.norm() > 0.3);
        let (error, duration) = (10.0_f64.powf(-digits), 30.0);
        let mut particle = particle;
        particle.drift = nalgebra::Vector2::zeros();
        let probing = particle.stepper(0.2)?;
        let h = probing.suggest_step_size(&probing.state_at(0.0, x, p)?, error, duration)?;
        let stepper = particle.stepper(h)?;
        let steps = (duration / h) as usize;
        let end = stepper.advance(&stepper.state_at(0.0, x, p)?, steps)?;
        let omega = (particle.stiffness / particle.mass).sqrt();
        let (sine, cosine) = (omega * h * steps as f64).sin_cos();
        let exact = x * cosine + p * (sine / (omega * particle.mass));
        let found = (end.configuration() - exact).norm();
        // the phase may hide a part of it at the end; the visible part is below twice the error
        prop_assert!(found < 2.0 * error, "{found:e} for {error:e}");
        prop_assert!(h > 0.02 * 10.0_f64.powf(-digits / 2.0) && h <= 3.2, "{h}");
    }
}

/// A generic body has lanes of its own parameters; one number is one lane.
#[test]
fn masks_of_one_lane_are_truth_values() {
    assert_eq!(<GenericBody<f64> as Clebsch>::Scalar::LANES, 1);
    assert!(<bool as Mask>::everywhere().lane(0));
}
