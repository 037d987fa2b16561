//! The error of a step that is too long gives the longest one that has a solution. This holds whatever a potential, a
//! force or the cost makes of the step size.

use crate::slots::Part;
use crate::trial::{Size, Trial};
use clebsch::Error;
use clebsch_tests::oracle::random::Random;

/// From random momenta, slow to fast: how many steps were too long, and for how many the longest is not the solvable fraction of them.
pub fn longest_steps(trial: &mut dyn Trial) -> [usize; 2] {
    // longer ones are too long for the impulse of the potential in a step
    let counts = [1, 8, 40].map(|times| longest_steps_of(trial, Size::Times(times)));
    [0, 1].map(|i| counts.iter().map(|count| count[i]).sum())
}

fn longest_steps_of(trial: &mut dyn Trial, h: Size) -> [usize; 2] {
    let random = &mut Random::new(811);
    let [mut refused, mut bent] = [0, 0];
    for size in [1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1e4, 1e7] {
        trial.restore();
        trial.stepper(&[], h).expect("an ordinary system");
        trial.slots(Part::Momentum).into_iter().for_each(|slot| slot.put(size * random.number()));
        trial.call("projected").expect("a projection");
        trial.call("state").expect("a state");
        let Err(error) = trial.call("step") else { continue };
        let Error::Unsolvable { solvable_fraction, step_size: Some(h), solvable_step } = error else { continue };
        let scene = format!("{}, momenta of {size}", trial.name());
        let Some(longest) = solvable_step else {
            assert!(!trial.knows_the_longest(), "{scene}: no step: {error}");
            continue;
        };
        let mut step_of = |h: f64| {
            trial.stepper(&[], Size::Of(h))?;
            trial.call("state")?;
            trial.call("step")
        };
        assert!(step_of(longest).is_ok(), "{scene}: {longest} is too long: {error}");
        assert!(step_of(longest * 1.05).is_err(), "{scene}: {longest} is not the longest: {error}");
        let text = error.to_string();
        assert!(text.contains(&format!("{:.3e} or less", longest * 0.9995)), "{text}");
        refused += 1;
        bent += usize::from((longest / (solvable_fraction * h) - 1.0).abs() > 0.05);
    }
    [refused, bent]
}
