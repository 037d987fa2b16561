//! Energies and momenta of the scenes, and arguments that make no sense.

use crate::exports::{advance, number, start_body, start_pendulum, start_top};
use crate::refusal::Refusal;
use std::f64::consts::{FRAC_PI_3, TAU};

const TIME: u32 = 0;
const STEPS: u32 = 1;
const ENERGY_ERROR: u32 = 4;
const MOMENTUM_ERROR: u32 = 5;
const LONGEST_STEP: u32 = 6;
const CONFIGURATION: u32 = 10;

/// The entry of an attitude in this row and column, counted from 0.
fn attitude(row: u32, column: u32) -> f64 {
    number(CONFIGURATION + 3 * row + column)
}

/// The least of a number of the run, read after every step.
fn least(steps: u32, value: impl Fn() -> f64) -> f64 {
    (0..steps).fold(value(), |least, _| {
        assert_eq!(advance(1), 0);
        least.min(value())
    })
}

#[test]
fn no_argument_traps() {
    let values = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 0.0, -0.0, -1.0, 1.0, f64::MAX, f64::MIN_POSITIVE];
    let go = |started: u32| {
        assert!(started <= Refusal::NoState.number());
        let advanced = advance(20);
        assert!(advanced <= Refusal::NoState.number());
        if started != 0 {
            assert_eq!(advanced, Refusal::NoRun.number());
            assert!(number(STEPS).is_nan());
        }
    };
    for a in values {
        for b in values {
            for c in values {
                for order in [2, 4, 6] {
                    go(start_top(a, b, c, order));
                }
                for d in values {
                    go(start_body(a, b, c, d));
                    go(start_pendulum(a, b, c, d));
                }
            }
        }
    }
    assert!(number(u32::MAX).is_nan());
}

#[test]
fn reasons_are_told_apart() {
    assert_eq!(advance(1), Refusal::NoRun.number());
    assert_eq!(start_top(f64::NAN, 1.0, 0.01, 2), Refusal::NotFinite.number());
    assert_eq!(start_top(6.4, 1.0, 0.0, 2), Refusal::NotPositive.number());
    assert_eq!(start_top(6.4, 1.0, 0.01, 3), Refusal::NoOrder.number());
    assert_eq!(start_body(1.0, 2.0, 3.5, 0.01), Refusal::NoBody.number());
    assert_eq!(start_body(1.0, 2.0, -1.0, 0.01), Refusal::NotPositive.number());
    assert_eq!(start_pendulum(1.0, 0.0, 0.0, 0.01), Refusal::NotPositive.number());
    assert_eq!(start_pendulum(1.0, 0.0, f64::MIN_POSITIVE, 0.01), Refusal::NotPositive.number());
}

#[test]
fn a_step_that_is_too_long_leaves_the_state_and_names_the_longest() {
    assert_eq!(start_top(6.4, FRAC_PI_3, 0.32, 2), 0);
    assert!(number(LONGEST_STEP).is_nan());
    assert_eq!(advance(1), Refusal::TooLong.number());
    assert_eq!(number(STEPS), 0.0);
    let longest = number(LONGEST_STEP);

    assert_eq!(start_top(6.4, FRAC_PI_3, longest, 2), 0);
    assert_eq!(advance(1), 0);
    assert_eq!(start_top(6.4, FRAC_PI_3, 1.03 * longest, 2), 0);
    assert_eq!(advance(1), Refusal::TooLong.number());
}

#[test]
fn the_energy_error_of_a_top_shrinks_by_its_order() {
    for order in [2, 4, 6] {
        let error = |h: f64| {
            assert_eq!(start_top(6.4, FRAC_PI_3, h, order), 0);
            assert_eq!(advance((200.0 / h) as u32), 0);
            assert!(number(MOMENTUM_ERROR) < 1e-12);
            number(ENERGY_ERROR)
        };
        let slope = (error(0.02) / error(0.01)).log2();
        assert!((slope - f64::from(order)).abs() < 0.2, "order {order}: {slope}");
    }
}

#[test]
fn a_top_sleeps_above_4_rad_per_second() {
    let upright = |spin: f64| {
        assert_eq!(start_top(spin, 0.02, 0.01, 2), 0);
        least(20_000, || attitude(2, 2))
    };
    assert!(upright(4.5) > 0.99);
    assert!(upright(3.5) < 0.8);
}

#[test]
fn a_book_turns_over_about_its_middle_axis_alone() {
    let upright = |moments: [f64; 3]| {
        let [first, second, third] = moments;
        assert_eq!(start_body(first, second, third, 0.01), 0);
        let least = least(10_000, || attitude(1, 1));
        assert!(number(ENERGY_ERROR) < 1e-12 && number(MOMENTUM_ERROR) < 1e-12);
        least
    };
    assert!(upright([1.0, 2.0, 2.8]) < -0.99);
    assert!(upright([2.0, 1.0, 2.8]) > 0.99);
    assert!(upright([1.0, 2.8, 2.0]) > 0.99);
}

#[test]
fn a_pendulum_four_times_as_long_takes_twice_as_long() {
    let period = |length: f64| {
        assert_eq!(start_pendulum(0.1, 0.0, length, 0.001), 0);
        let bob = || number(CONFIGURATION);
        for _ in 0..20 {
            while bob() > 0.0 {
                assert_eq!(advance(1), 0);
            }
            while bob() <= 0.0 {
                assert_eq!(advance(1), 0);
            }
        }
        // twenty periods less a quarter, so far
        number(TIME) / 19.75
    };
    let short = period(1.0);
    assert!((short / (TAU / 9.81_f64.sqrt()) - 1.0).abs() < 1e-3);
    assert!((period(4.0) / short - 2.0).abs() < 1e-3);
}

#[test]
fn a_pendulum_with_the_right_push_goes_round() {
    assert_eq!(start_pendulum(FRAC_PI_3, 3.8, 1.0, 0.02), 0);
    let height = || number(CONFIGURATION + 2);
    let start = height();
    let lowest = least(10_000, height);
    assert!(start - lowest < 0.02, "from {start} to {lowest}");
}

#[test]
fn the_energy_of_a_pendulum_stays_in_a_band() {
    assert_eq!(start_pendulum(1.0, 1.0, 1.0, 0.01), 0);
    assert_eq!(advance(10_000), 0);
    let early = number(ENERGY_ERROR);
    assert_eq!(advance(90_000), 0);
    assert!(early < 2e-2 && number(ENERGY_ERROR) < 1.01 * early);
    assert!(number(MOMENTUM_ERROR) < 1e-12);
}
