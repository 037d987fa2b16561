//! Many bodies at once: each as if it were alone.

use crate::arbitrary::{attitude, cases, definite, vector};
use crate::bodies::{H, generic_top, satellites};
use crate::runner::proptest;
use clebsch::{Body, Clebsch, Conserved, Drive, Ensemble, F64x8, Scalar, Stepper};
use clebsch_tests::fixtures::generic_body::GenericBody;
use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;

type Tops = Ensemble<GenericBody<F64x8>>;
type Top = (Matrix3<f64>, Vector3<f64>);

/// Up to 20 bodies; some are too fast for a step.
fn bodies() -> BoxedStrategy<Vec<Top>> {
    let body = (attitude(), vector::<3>(1.0), prop::bool::weighted(0.2));
    let made = |(r, mu, is_fast): (Matrix3<f64>, Vector3<f64>, bool)| (r, if is_fast { mu * 1e4 } else { mu });
    prop::collection::vec(body.prop_map(made), 1..20).boxed()
}

/// The last state that a body reaches alone, and how many steps it made.
fn alone(
    stepper: &Stepper<GenericBody<f64>>,
    (r, mu): &Top,
    steps: u64,
) -> (Body<GenericBody<f64>>, u64, Option<clebsch::Error>) {
    let mut state = stepper.state(*r, *mu).expect("a state");
    for made in 0..steps {
        match stepper.step(&state) {
            Ok(next) => state = next,
            Err(error) => return (state.into_parts(), made, Some(error)),
        }
    }
    (state.into_parts(), steps, None)
}

proptest! {
    #![proptest_config(cases(8))]

    /// Bit for bit, on one thread and on all; those that fail stay where they are and say why.
    #[test]
    fn ensembles_are_bodies_alone(
        mass in definite::<3>(), weight in 0.1_f64..3.0, center in vector::<3>(1.0), bodies in bodies(), steps in 0_u64..6, other in (attitude(), vector::<3>(1.0)),
    ) {
        let one = generic_top::<f64>(&mass, weight, &center).into_stepper(H)?;
        let wide = generic_top::<F64x8>(&mass, weight, &center).into_stepper(F64x8::splat(H))?;
        let mut all: Tops = wide.clone().ensemble(bodies.clone())?;
        let mut on_all_cores: Tops = wide.clone().ensemble(bodies.clone())?;
        let mut one_by_one: Tops = wide.ensemble(bodies.clone())?;
        prop_assert_eq!((all.len(), all.is_empty(), all.steps()), (bodies.len(), false, 0));
        all.advance(steps);
        on_all_cores.par_advance(steps);
        (0..steps).for_each(|_| one_by_one.step());
        prop_assert_eq!((all.steps(), on_all_cores.steps(), one_by_one.steps()), (steps, steps, steps));
        for (i, body) in bodies.iter().enumerate() {
            let (last, made, error) = alone(&one, body, steps);
            for ensemble in [&all, &on_all_cores, &one_by_one] {
                prop_assert_eq!(ensemble.body(i), Some(last));
                prop_assert_eq!(ensemble.bodies().nth(i), Some(last));
                prop_assert_eq!(ensemble.failure(i).map(|failure| (failure.body, failure.step, failure.error)), error.map(|error| (i, made, error)));
                prop_assert_eq!(ensemble.failures().any(|failure| failure.body == i), error.is_some());
            }
            let state = one.state(last.0, last.1)?;
            prop_assert_eq!(all.energy(i), Some(one.energy(&state)));
            let conserved: Option<Conserved<f64, 1>> = all.conserved(i);
            prop_assert_eq!(conserved, Some(one.conserved(&state)));
        }
        prop_assert!(all.body(bodies.len()).is_none() && all.failure(bodies.len()).is_none() && all.energy(bodies.len()).is_none());
        // one that is put elsewhere goes on from there
        all.set_body(0, other)?;
        prop_assert_eq!((all.body(0), all.failure(0)), (Some(other), None));
        prop_assert!(all.set_body(bodies.len(), other).is_err());
        all.step();
        prop_assert_eq!(all.body(0), Some(alone(&one, &other, 1).0));
    }

    /// One set of words, whatever is stepped.
    #[test]
    fn drives_share_their_words(mass in definite::<3>(), center in vector::<3>(1.0), body in (attitude(), vector::<3>(1.0)), steps in 0_u64..6) {
        let stepper = generic_top::<f64>(&mass, 1.0, &center).into_stepper(H)?;
        let mut alone = stepper.clone().integrator(stepper.state(body.0, body.1)?);
        let mut many = stepper.ensemble([body])?;
        Drive::advance(&mut alone, steps)?;
        Drive::step(&mut alone)?;
        Drive::advance(&mut many, steps)?;
        Drive::step(&mut many)?;
        prop_assert_eq!((Drive::steps(&alone), Drive::steps(&many)), (steps + 1, steps + 1));
        let reached = many.state().next().expect("one body");
        let state = Drive::state(&alone);
        prop_assert!((reached.0 - state.configuration()).amax() < 1e-13 && (reached.1 - state.momentum()).amax() < 1e-13);
    }

    /// Each with its own weight.
    #[test]
    fn bodies_have_their_own_parameters(mass in definite::<3>(), center in vector::<3>(1.0), bodies in bodies()) {
        let weight = |body: usize| 0.5 + body as f64 / 7.0;
        let mut all: Tops = Ensemble::with_parameters(bodies.clone(), |numbers| {
            let mut top = generic_top::<F64x8>(&mass, 0.0, &center);
            top.weight = F64x8::from_lanes(|lane| weight(numbers[lane]));
            top.into_stepper(F64x8::splat(H))
        })?;
        all.advance(3);
        for (i, body) in bodies.iter().enumerate() {
            let one = generic_top::<f64>(&mass, weight(i), &center).into_stepper(H)?;
            prop_assert_eq!(all.body(i), Some(alone(&one, body, 3).0));
        }
    }

    /// The time of a body is that of its steps.
    #[test]
    fn bodies_have_times(satellite in satellites(), r in attitude(), mu in vector::<3>(1.0), steps in 0_u64..9) {
        let mut all = satellite.stepper(H)?.ensemble([(r, mu)])?;
        all.advance(steps);
        let stepper = satellite.stepper(H)?;
        let alone = stepper.advance(&stepper.state(r, mu)?, steps as usize)?;
        prop_assert_eq!(all.time(0), Some(alone.time()));
        prop_assert_eq!(all.body(0), Some(alone.into_parts()));
        prop_assert_eq!(all.time(1), None);
    }
}
