use super::{TRIALS, WIDTH, longest};
use crate::Error;
use crate::runner::proptest;
use core::cell::Cell;
use proptest::prelude::*;

fn unsolvable(solvable_fraction: f64) -> Result<bool, Error> {
    Err(Error::Unsolvable { solvable_fraction, step_size: None, solvable_step: None })
}

proptest! {
    /// |h μ + h² k| ≤ 1 with a momentum μ and a kick k of any sign, forwards and backwards in time.
    #[test]
    fn the_longest_step_is_found(momentum in -3.0_f64..3.0, kick in -3.0_f64..3.0, excess in 0.01_f64..9.0, sign in prop::bool::ANY) {
        let size = |h: f64| (h * momentum + h * h * kick).abs();
        let h = (1.0 + excess) * if sign { 1.0 } else { -1.0 };
        prop_assume!(size(h) > 1.0);
        let (count, shortest) = (Cell::new(0), Cell::new(h));
        let found = longest(h, 1.0 / size(h), |h| {
            count.set(count.get() + 1);
            if size(h) <= 1.0 {
                return Ok(true);
            }
            shortest.set(h);
            unsolvable(1.0 / size(h))
        });
        let found = found.expect("short steps can be solved");
        prop_assert!(size(found) <= 1.0 && count.get() <= TRIALS);
        let ratio = shortest.get() / found;
        prop_assert!(ratio > 1.0 && ratio <= WIDTH, "{} was refused beside {found}", shortest.get());
    }
}

#[test]
fn momenta_alone_take_two_trials() {
    let count = Cell::new(0);
    let found = longest(0.3, 1e-9, |h| {
        count.set(count.get() + 1);
        if h <= 3e-10 { Ok(true) } else { unsolvable(3e-10 / h) }
    });
    assert!(found.is_some_and(|h| h <= 3e-10 && h > 2.9e-10) && count.get() == 2, "{found:?}");
}

#[test]
fn what_has_no_solution_ends() {
    assert_eq!(longest(1.0, 0.5, |_| unsolvable(0.0)), None);
    assert_eq!(longest(1.0, f64::NAN, |_| Ok(false)), None);
    assert_eq!(longest(1.0, 0.5, |_| Err(Error::StepSize { value: 0.0 })), None);
}
