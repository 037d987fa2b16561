//! Steps that are too long are told the longest one that has a solution, whatever a potential, a force or the cost makes of the step size.

use crate::checks::{Scene, momentum, step};
use crate::slots::Slots;
use clebsch::__private::Scheme;
use clebsch::{Error, Scalar};
use clebsch_tests::oracle::random::Random;

/// From random momenta, slow to fast: how many steps were too long, and for how many the longest is not the solvable fraction of them.
pub fn longest_steps<S: Scene>() -> [usize; 2] {
    let h = S::step_size();
    // longer ones are too long for what the potential gives in a step
    let counts = [1, 8, 40].map(|times| longest_steps_of::<S>(h * S::Scalar::from_ratio(times, 1)));
    [0, 1].map(|i| counts.iter().map(|count| count[i]).sum())
}

fn longest_steps_of<S: Scene>(h: S::Scalar) -> [usize; 2] {
    let random = &mut Random::new(811);
    let stepper = S::ordinary().stepper(h).expect("an ordinary system");
    let q = S::configuration();
    let [mut refused, mut bent] = [0, 0];
    for size in [1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1e4, 1e7] {
        let mut mu = momentum(&stepper);
        mu.slots().into_iter().for_each(|slot| slot.put(size * random.number()));
        let mu = stepper.project(&q, &mu).expect("a projection");
        let start = stepper.state(q, mu).expect("a state");
        let Err(error) = step(&stepper, &start) else { continue };
        let Error::Unsolvable { solvable_fraction, step_size: Some(h), solvable_step } = error else { continue };
        let Some(longest) = solvable_step else {
            // none is tried where each would take constants of kilobytes, but for free motions, where it is known
            assert!(
                size_of::<<S::Scheme as Scheme<S>>::Constants>() > 2048 && !S::IS_FREE_MOTION,
                "{}: no step for {mu:?}: {error}",
                S::NAME
            );
            continue;
        };
        let step_of = |h: f64| {
            let other = S::ordinary().stepper(S::Scalar::from_f64(h))?;
            step(&other, &other.state(q, mu)?)
        };
        assert!(step_of(longest).is_ok(), "{}: {longest} is too long for {mu:?}: {error}", S::NAME);
        assert!(step_of(longest * 1.05).is_err(), "{}: {longest} is not the longest for {mu:?}: {error}", S::NAME);
        let text = error.to_string();
        assert!(text.contains(&format!("{:.3e} or less", longest * 0.9995)), "{text}");
        refused += 1;
        bent += usize::from((longest / (solvable_fraction * h) - 1.0).abs() > 0.05);
    }
    [refused, bent]
}
