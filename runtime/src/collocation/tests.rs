//! The nodes, the order and the invariants of collocation, on oscillators.

use super::{GAUSS_16, SWEEPS, collocate};
use crate::Error;

/// ∫ τ^k over the step, and up to each stage: the conditions B(16) and C(8) that make the order.
#[test]
fn stages_are_those_of_gauss() {
    let table = GAUSS_16.scaled(1.0);
    let nodes: [f64; 8] = core::array::from_fn(|i| if i < 4 { GAUSS_16.nodes[i] } else { 1.0 - GAUSS_16.nodes[i - 4] });
    for power in 0..16 {
        let slopes = nodes.map(|node| node.powi(power));
        let (whole, exact) = (2.0 * table.sum(&slopes), 1.0 / f64::from(power + 1));
        assert!((whole - exact).abs() < 2e-16, "B({power}): {whole} for {exact}");
        if power < 8 {
            let mut stages = [[0.0; 8]];
            table.stages(&[0.0], &[slopes], &mut stages);
            for (stage, node) in stages[0].iter().zip(nodes) {
                let exact = node.powi(power + 1) / f64::from(power + 1);
                assert!((stage - exact).abs() < 2e-16, "C({power}): {stage} for {exact}");
            }
        }
    }
}

fn step(h: f64, t: f64, y: [f64; 2], slope: impl Fn(f64, &[f64; 2]) -> [f64; 2]) -> Result<[f64; 2], Error> {
    let slope = |t: f64, [time]: &[f64; 1], y: &[f64; 2]| {
        assert_eq!(*time, t, "the terms of a stage are those of its time");
        slope(t, y)
    };
    let change = collocate::<f64, 2, 1, 8, 4>(&GAUSS_16, (t, h), &y, (0.0, SWEEPS), |_| y, |t| [t], slope)?;
    Ok([y[0] + change[0], y[1] + change[1]])
}

/// q″ = −q from (1, 0): the error of one step is that of the (8, 8) Padé approximant of the exponential, h¹⁷ (8!)²/(16! 17!).
#[test]
fn one_step_of_an_oscillator_is_the_approximant_of_pade() -> Result<(), Error> {
    for h in [2.0_f64, 3.0, 4.0] {
        let y = step(h, 0.0, [1.0, 0.0], |_, y| [y[1], -y[0]])?;
        let angle = (-y[1]).atan2(y[0]);
        let factorial = |n: u32| (1..=n).map(f64::from).product::<f64>();
        let exact = h.rem_euclid(core::f64::consts::TAU);
        let expected = h.powi(17) * factorial(8).powi(2) / (factorial(16) * factorial(17));
        let error = (angle.rem_euclid(core::f64::consts::TAU) - exact).abs();
        assert!((error / expected - 1.0).abs() < 0.25 || error < 1e-15, "{h}: {error:.3e} for {expected:.3e}");
        let energy = y[0] * y[0] + y[1] * y[1];
        assert!((energy - 1.0).abs() < 4e-15, "the energy is a quadratic invariant: {:.1e} at {h}", energy - 1.0);
    }
    Ok(())
}

/// q′ = cos t, p′ = e⁻ᵗ: stages know their times.
#[test]
fn slopes_of_the_time_are_integrated() -> Result<(), Error> {
    let (t, h) = (0.5_f64, 0.75);
    let y = step(h, t, [0.0, 0.0], |t, _| [t.cos(), (-t).exp()])?;
    assert!((y[0] - ((t + h).sin() - t.sin())).abs() < 1e-15);
    assert!((y[1] - ((-t).exp() - (-t - h).exp())).abs() < 1e-15);
    Ok(())
}

/// Equilibria stay, and so do momenta that nothing acts on.
#[test]
fn rest_is_solved_at_once() -> Result<(), Error> {
    assert_eq!(step(0.1, 0.0, [0.0, 0.0], |_, y| [y[1], -y[0]])?, [0.0, 0.0]);
    assert_eq!(step(0.5, 0.0, [1.0, 2.0], |_, y| [y[1], 0.0])?, [2.0, 2.0]);
    Ok(())
}

/// Too long a step does not converge, and says so; slopes that are NaN are told from that.
#[test]
fn failures_say_what_they_are() {
    let long = step(60.0, 0.0, [1.0, 0.0], |_, y| [y[1], -y[0]]);
    assert!(matches!(long, Err(Error::NotConverged { iterations: 64, residual }) if residual > 1e-3), "{long:?}");
    let root = step(0.5, 0.0, [0.1, -1.0], |_, y| [y[1], -y[0].sqrt()]);
    assert!(matches!(root, Err(Error::NotFinite { .. })), "{root:?}");
    // sweeps that overflow have not converged, and nothing was wrong with the slopes
    let steep = step(1e3, 0.0, [1.0, 1.0], |_, y| [y[1] * y[1] * y[1], y[0] * y[0] * y[0]]);
    assert!(
        matches!(steep, Err(Error::NotConverged { iterations, residual }) if iterations < 64 && residual > 1.0),
        "{steep:?}"
    );
}

/// A step back undoes a step.
#[test]
fn steps_are_reversible() -> Result<(), Error> {
    let pendulum = |_: f64, y: &[f64; 2]| [y[1], -y[0].sin()];
    let there = step(1.0, 0.0, [2.0, 0.5], pendulum)?;
    let back = step(-1.0, 1.0, there, pendulum)?;
    assert!((back[0] - 2.0).abs() < 4e-15 && (back[1] - 0.5).abs() < 4e-15, "{back:?}");
    Ok(())
}
