//! Estimates over a window that moves along.

use crate::orbit::Orbit;
use crate::{Estimate, Start};
use clebsch::{Controlled, Error, Prior, Target};
use nalgebra::Vector6;

/// The estimates at the ends of windows of at most `length` steps, each `every` steps, and the linearisations of each.
pub fn estimates(
    orbit: &Orbit,
    start: &Start,
    (length, every): (usize, usize),
) -> Result<(Vec<Estimate>, Vec<u32>), Error> {
    let system = orbit.satellite.clone();
    let mut control = system.control(orbit.h)?.with_prior(Prior::new(start.place, start.information()))?;
    let mut guess = start.place;
    let (mut estimates, mut work) = (Vec::new(), Vec::new());
    let mut plan = Vec::new();
    // the window is from `first` to `last`
    let (mut first, mut last) = (0, 0);
    while last + every <= orbit.gyro.len() {
        let excess = (plan.len() + every).saturating_sub(length);
        if excess > 0 && excess <= plan.len() {
            control.slide(&mut plan, excess)?;
            plan.truncate(plan.len() - excess);
            first += excess;
            guess = *control.prior().place();
        }
        last += every;
        for k in first + plan.len()..last {
            let input = orbit.gyro[k] - guess.1;
            let input = Vector6::from_fn(|i, _| if i < 3 { input[i] } else { 0.0 });
            let (known, measured) = orbit.field[k];
            plan.push(control.stage(&guess).with_input(input).with_reference((orbit.gyro[k], known, measured)));
        }
        let ended = control.clone().with_end_reference(orbit.field[last])?;
        let estimate = ended.solve(&guess, Target::Free, &mut plan)?;
        let (place, iterations) = (*estimate.end(), estimate.iterations());
        estimates.push(Estimate { k: last, place, information: Some(ended.end_information(&plan)?) });
        work.push(iterations);
        guess = *plan[0].place();
    }
    Ok((estimates, work))
}
