//! Paths between fixed endpoints and with free ones: extremals are motions, and their actions are critical.

use crate::arbitrary::{attitude, cases, vector};
use crate::bodies::{particles, tops};
use crate::runner::proptest;
use clebsch::{Boundary, Clebsch, Error, Extremal, Guess, Variational, Way};
use clebsch_tests::fixtures::watched_top::WatchedTop;
use clebsch_tests::oracle::near::assert_near;
use clebsch_tests::stepping::Stepping;
use nalgebra::Vector3;
use proptest::prelude::*;

const H: f64 = 0.1;
const STEPS: usize = 6;
/// Rounding of momenta, which are of the size of inertia/h, and its growth in a few steps.
const NEAR: f64 = 1e-10;

/// The conditions of an extremal, each evaluated anew. The states are those of steps, the action is the sum over the
/// edges, and the ends are where they should be.
fn is_a_motion(boundary: &Boundary<'_, WatchedTop, 3>, extremal: &Extremal<'_, WatchedTop, 3>) -> Result<(), Error> {
    let stepper = boundary.stepper();
    let constants = stepper.system().step_constants(H)?;
    let states: Vec<_> = extremal.states().collect();
    assert_eq!((states.len(), extremal.nodes().len()), (STEPS + 1, STEPS));
    let mut action = 0.0;
    for (k, node) in extremal.nodes().iter().enumerate() {
        let (state, next) = (&states[k], &states[k + 1]);
        assert_eq!((node.configuration(), *node.momentum()), (state.configuration(), state.momentum()));
        let stepped = stepper.step(state)?;
        assert_near(stepped.configuration(), next.configuration(), NEAR, "a step");
        assert_near(&stepped.momentum(), &next.momentum(), NEAR, "a step");
        let moved = stepper.system().advance(node.configuration(), node.increment());
        assert_near(&moved, next.configuration(), NEAR, "the increment");
        action += stepper
            .system()
            .momenta(&constants, k, 0.0, (node.configuration(), node.increment(), &moved, &()))
            .lagrangian;
    }
    assert!((extremal.action() - action).abs() < NEAR, "{} is not {action}", extremal.action());
    assert_eq!((states[0].momentum(), states[STEPS].momentum()), (*extremal.momentum(), *extremal.final_momentum()));
    assert_eq!(states[STEPS].configuration(), extremal.end());
    assert!(extremal.residual() < NEAR, "{:e}", extremal.residual());
    Ok(())
}

proptest! {
    #![proptest_config(cases(6))]

    /// From where a motion starts to where it ends: the extremal near it is that motion.
    #[test]
    fn motions_are_found_from_their_ends(top in tops(), r in attitude(), mu in vector::<3>(0.7), eta in vector::<3>(1e-4)) {
        let stepper = top.stepper(H)?;
        let target = *stepper.advance(&stepper.state(r, mu)?, STEPS)?.configuration();
        let boundary = stepper.boundary();
        let mut path = [boundary.rest(&r); STEPS];
        prop_assert_eq!((path[0].configuration(), path[0].momentum().norm()), (&r, 0.0));
        let velocity = crate::bodies::inertia_of(&top).try_inverse().expect("regular") * mu;
        let extremal = boundary.solve(&r, &target, Guess::Velocity(velocity), &mut path)?;
        is_a_motion(&boundary, &extremal)?;
        prop_assert!((extremal.end() - target).norm() <= extremal.gap() + 1e-15 && extremal.gap() < NEAR);
        // slow bodies: no second motion is as near
        assert_near(extremal.momentum(), &mu, 1e-8, "the momentum");
        prop_assert!(extremal.iterations() > 0 && extremal.iterations() < 20);
        // feedback: where the start is found moved by η, the next vertex moves by −Kη
        let (gain, second) = (*extremal.nodes()[0].gain(), *extremal.nodes()[1].configuration());
        let (action, negative) = (extremal.action(), extremal.negative());
        let moved = top.advance(&r, &top.retraction(&eta));
        let other = boundary.solve(&moved, &target, Guess::Path, &mut path)?;
        let expected = top.advance(&second, &top.retraction(&-(gain * eta)));
        assert_near(other.nodes()[1].configuration(), &expected, 1e-6, "feedback");
        // by the envelope theorem the action changes by −N·η
        prop_assert!((other.action() - action + mu.dot(&eta)).abs() < 1e-6);
        prop_assert_eq!(other.negative(), negative);
    }

    /// Several ways, in the order of their actions; each is found again.
    #[test]
    fn ways_are_extremals_in_order(top in tops(), r in attitude(), eta in vector::<3>(0.5)) {
        let stepper = top.stepper(0.3)?;
        let boundary = stepper.boundary();
        let target = top.advance(&r, &top.retraction(&eta));
        let mut path = [boundary.rest(&r); 8];
        let ways: [Option<Way<f64, 3>>; 2] = boundary.several(&r, &target, &mut path)?;
        let first = ways[0].expect("the shortest");
        let again = boundary.solve(&r, &target, first.guess, &mut path)?;
        prop_assert!((again.action() - first.action).abs() < NEAR);
        assert_near(again.momentum(), &first.momentum, 1e-7, "the momentum");
        prop_assert_eq!(again.negative(), first.negative);
        if let Some(second) = ways[1] {
            prop_assert!(second.action >= first.action);
            prop_assert!((second.momentum - first.momentum).norm() > 1e-8);
        }
    }

    /// A free end is where the last momentum is −∂φ/∂q, at the time when the path ends.
    #[test]
    fn free_ends_are_pulled(particle in particles(), x in vector::<2>(1.0), t in 0.0_f64..2.0) {
        let stepper = particle.stepper(H)?;
        let boundary = stepper.boundary().starting_at(t)?;
        let mut path = [boundary.rest(&x); STEPS];
        let extremal = boundary.solve_free(&x, Guess::Geodesic, &mut path)?;
        let last = t + H * STEPS as f64;
        let slope = particle.endpoint(last, extremal.end()).slope;
        assert_near(extremal.final_momentum(), &-slope, NEAR, "pulled");
        let states: Vec<_> = extremal.states().collect();
        prop_assert!((states[0].time() - t).abs() < 1e-14 && (states[STEPS].time() - last).abs() < 1e-14);
        let stepped = stepper.advance(&states[0], STEPS)?;
        assert_near(stepped.configuration(), extremal.end(), NEAR, "a motion");
        prop_assert!(extremal.gap() == 0.0 && boundary.starting_at(f64::NAN).is_err());
    }

    /// The time at which the action with its price is critical, or a limit beyond which it falls: by differences of solutions.
    #[test]
    fn free_times_are_critical(particle in particles(), x in vector::<2>(1.0)) {
        let (least, most) = (0.01, 0.3);
        let stepper = particle.stepper(H)?;
        let mut path = [stepper.boundary().rest(&x); STEPS];
        let h = stepper.boundary().free_time(&x, None, least..=most, Guess::Geodesic, &mut path)?;
        let action = |h: f64| -> Result<f64, Error> {
            let stepper = particle.stepper(h)?;
            let mut path = [stepper.boundary().rest(&x); STEPS];
            Ok(stepper.boundary().solve_free(&x, Guess::Geodesic, &mut path)?.action())
        };
        let step = 1e-4 * h;
        let slope = (action(h + step)? - action(h - step)?) / (2.0 * step);
        prop_assert!((least..=most).contains(&h));
        // the third derivative is of order one, and rounding of 10⁻¹⁵/step below 10⁻⁹
        let is_critical = slope.abs() < 1e-5;
        prop_assert!(is_critical || h == least && slope > 0.0 || h == most && slope < 0.0, "{slope} at {h}");
    }
}

/// A guess at rest and one that is no number.
#[test]
fn what_is_given_is_checked() -> Result<(), Error> {
    let stepper = WatchedTop { mass: Vector3::new(1.0, 1.2, 0.9), weight: 0.8 }.into_stepper(H)?;
    let (start, broken) = (nalgebra::Matrix3::identity(), Guess::Velocity(Vector3::repeat(f64::NAN)));
    let boundary = stepper.boundary();
    let mut path = [boundary.rest(&start); STEPS];
    assert!(boundary.solve(&start, &start, broken, &mut path).is_err());
    assert!(boundary.solve(&start, &start, Guess::Geodesic, &mut []).is_err());
    Ok(())
}
