use super::{GradientFour, GradientSix, Kick, Kicks, PlainFour, PlainSix, split};

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

/// To first order in V a step is a quadrature of the kicks along the drift. Its degree is 8 here, and the order without
/// gradients.
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
        let all: std::vec::Vec<_> = nodes(kicks).collect();
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
