use super::{GradientFour, GradientSix, Kick, Kicks, PlainFour, PlainSix, split};
use std::vec;
use std::vec::Vec;

/// The kicks, with their times from the middle of the step.
fn nodes(kicks: &[Kick]) -> impl Iterator<Item = (f64, Kick)> + '_ {
    kicks.iter().scan(-0.5, |time, kick| {
        *time += kick.drift;
        Some((*time, *kick))
    })
}

fn check(kicks: &[Kick], quadrature: i32) {
    let length: f64 = kicks.iter().map(|kick| kick.drift).sum::<f64>() + kicks[0].drift;
    assert!((length - 1.0).abs() < 2e-15, "{length}");
    let reversed = kicks.iter().rev();
    assert!(kicks.iter().zip(reversed.clone()).all(|(a, b)| a.weight == b.weight && a.gradient == b.gradient));
    assert!(kicks[1..].iter().zip(reversed).all(|(a, b)| (a.drift - b.drift).abs() < 1e-15));
    // ∫ τ^k from −½ to ½
    for power in (0..quadrature).step_by(2) {
        let sum: f64 = nodes(kicks).map(|(time, kick)| kick.weight * time.powi(power)).sum();
        let exact = 0.5_f64.powi(power) / f64::from(power + 1);
        assert!((sum - exact).abs() < 1e-15, "{power}: {sum} for {exact}");
    }
}

/// To first order in V a step is a quadrature of the kicks along the drift. Its order is 8 with gradients, and
/// that of the step without.
#[test]
fn kicks_are_a_quadrature() {
    check(&GradientFour::KICKS, 8);
    check(&GradientSix::KICKS, 8);
    check(&PlainFour::KICKS, 4);
    check(&PlainSix::KICKS, 6);
}

/// ½ Σ_{i>j} b_i b_j (c_i − c_j) + Σ g_i = ½ ∫∫ (t − s) = 1/12: to second order in V, the first condition that gradients help with.
#[test]
fn gradients_make_up_for_the_order_of_kicks() {
    for kicks in [&GradientFour::KICKS[..], &GradientSix::KICKS[..], &PlainFour::KICKS[..], &PlainSix::KICKS[..]] {
        let all: Vec<_> = nodes(kicks).collect();
        let pairs = all.iter().enumerate().flat_map(|(i, one)| all[..i].iter().map(move |other| (one, other)));
        let double: f64 = pairs.map(|(one, other)| one.1.weight * other.1.weight * (one.0 - other.0)).sum();
        let sum = 0.5 * double + kicks.iter().map(|kick| kick.gradient).sum::<f64>();
        assert!((sum - 1.0 / 12.0).abs() < 1e-14, "{sum}");
    }
}

/// p² / 2 + q² / 2 by each, whose exact flow is a turn: the orders.
#[test]
fn an_oscillator_shows_the_orders() {
    fn error<const K: usize>(kicks: &[Kick; K], steps: i32) -> f64 {
        let h = 1.0 / f64::from(steps);
        let drift = |part: f64, (q, p): (f64, f64)| Ok((q + part * h * p, p));
        // {V, {V, T}} = q²
        let kick = |_: f64, b: f64, g: f64, (q, p): (f64, f64)| (q, p - b * h * q + 2.0 * g * h.powi(3) * q);
        let mut state = (1.0, 0.0);
        let mut at_once = split(kicks, (0.0, h, steps as usize), state, drift, kick, |state| state, |_| Ok(()))
            .expect("drifts do not fail");
        for _ in 0..steps {
            state =
                split(kicks, (0.0, h, 1), state, drift, kick, |state| state, |_| Ok(())).expect("drifts do not fail");
        }
        at_once = (at_once.0 - state.0, at_once.1 - state.1);
        assert!(at_once.0.abs() + at_once.1.abs() < 1e-14, "drifts that are merged are the same");
        (state.0 - 1.0_f64.cos()).hypot(state.1 + 1.0_f64.sin())
    }
    let slope = |coarse: f64, fine: f64| (coarse / fine).log2();
    let orders = [
        (slope(error(&GradientFour::KICKS, 2), error(&GradientFour::KICKS, 4)), 4.0),
        (slope(error(&GradientSix::KICKS, 1), error(&GradientSix::KICKS, 2)), 6.0),
        (slope(error(&PlainFour::KICKS, 4), error(&PlainFour::KICKS, 8)), 4.0),
        (slope(error(&PlainSix::KICKS, 2), error(&PlainSix::KICKS, 4)), 6.0),
    ];
    for (slope, order) in orders {
        assert!((slope - order).abs() < 0.3, "{slope} for {order}");
    }
}

/// Series in words of A and B to length [`LONGEST`]: the coefficients of all words of each length, A before B.
type Series = Vec<Vec<f64>>;

const LONGEST: usize = 5;

/// 1, A or B: the word of that length, and its number among those of the length.
fn word(length: usize, number: usize) -> Series {
    let mut series: Series = (0..=LONGEST).map(|length| vec![0.0; 1 << length]).collect();
    series[length][number] = 1.0;
    series
}

fn combined(x: &Series, factor: f64, y: &Series) -> Series {
    let sums = |(x, y): (&Vec<f64>, &Vec<f64>)| x.iter().zip(y).map(|(x, y)| x + factor * y).collect();
    x.iter().zip(y).map(sums).collect()
}

fn scaled(factor: f64, x: &Series) -> Series {
    combined(x, factor - 1.0, x)
}

fn product(x: &Series, y: &Series) -> Series {
    let mut series = scaled(0.0, x);
    for (length, number) in (0..=LONGEST).flat_map(|length| (0..1 << length).map(move |number| (length, number))) {
        for first in 0..=length {
            let last = length - first;
            series[length][number] += x[first][number >> last] * y[last][number & ((1 << last) - 1)];
        }
    }
    series
}

fn bracket(x: &Series, y: &Series) -> Series {
    combined(&product(x, y), -1.0, &product(y, x))
}

/// Σ c_k x^k of the powers that are not longer than a word may be.
fn powers(x: &Series, coefficient: impl Fn(u32) -> f64) -> Series {
    let mut power = word(0, 0);
    let mut sum = scaled(coefficient(0), &power);
    for exponent in 1..=LONGEST as u32 {
        power = product(&power, x);
        sum = combined(&sum, coefficient(exponent), &power);
    }
    sum
}

fn exponential(x: &Series) -> Series {
    powers(x, |k| 1.0 / (1..=k).map(f64::from).product::<f64>())
}

fn logarithm(x: &Series) -> Series {
    powers(&combined(x, -1.0, &word(0, 0)), |k| if k == 0 { 0.0 } else { -(-1.0_f64).powi(k as i32) / f64::from(k) })
}

/// A is the drift and B the kick. The logarithm of a step is A + B up to the order, but for brackets with
/// R = [B, [B, [B, A]]]. R vanishes, as T is quadratic in the momenta.
#[test]
fn order_conditions_hold_for_all_potentials() {
    let (a, b) = (word(1, 0), word(1, 1));
    let gradient = bracket(&b, &bracket(&b, &a));
    let vanishes = bracket(&b, &gradient);
    let vanishing = [bracket(&a, &vanishes), bracket(&b, &vanishes)];
    let dot = |x: &Series, y: &Series| x[5].iter().zip(&y[5]).map(|(x, y)| x * y).sum::<f64>();
    let all = [(&GradientFour::KICKS[..], 4), (&GradientSix::KICKS, 6), (&PlainFour::KICKS, 4), (&PlainSix::KICKS, 6)];
    for (kicks, order) in all {
        let mut step = exponential(&scaled(kicks[0].drift, &a));
        for (kick, drift) in kicks.iter().zip(kicks[1..].iter().chain(&kicks[..1])) {
            let kicked = combined(&scaled(kick.weight, &b), -kick.gradient, &gradient);
            let flows = product(&exponential(&kicked), &exponential(&scaled(drift.drift, &a)));
            step = product(&step, &flows);
        }
        let mut error = combined(&combined(&logarithm(&step), -1.0, &a), -1.0, &b);
        for relation in &vanishing {
            error = combined(&error, -dot(&error, relation) / dot(relation, relation), relation);
        }
        for length in [1, 3, 5] {
            let error = error[length].iter().map(|entry| entry.abs()).fold(0.0, f64::max);
            assert_eq!(length < order, error < 1e-15, "{} kicks, words of {length}: {error:e}", kicks.len());
        }
    }
}
