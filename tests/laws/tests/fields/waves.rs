//! Linear waves, whose motion on a grid is known in closed form, and orders of accuracy.

use std::f64::consts::TAU;

use clebsch::{Clebsch, Field, MovingField, SiteError};
use clebsch_tests::fixtures::sine_gordon::SineGordon;
use nalgebra::{Vector1, Vector2};

/// A displacement in three directions of space: u″ = Δu.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |a: Translation<1>, u: Vector1| u + a,
    cost   = |h, a| a.norm_squared() / (2 * h),
    space  = [
        |dx, u, next| (next - u).norm_squared() / (2 * dx.powi(2)),
        |dy, u, next| (next - u).norm_squared() / (2 * dy.powi(2)),
        |dz, u, next| (next - u).norm_squared() / (2 * dz.powi(2)),
    ],
)]
struct Sound;

/// sin²(ωh/2)/h² = Σ sin²(k dx/2)/dx², for standing waves cos(ωt) cos(k·x).
#[test]
fn waves_in_three_directions_have_the_frequency_of_the_grid() -> Result<(), SiteError> {
    let (sizes, spacing, h) = ([8, 6, 5], [0.5, 0.7, 0.6], 0.2);
    let wave: [f64; 3] = [1.0, 2.0, 1.0];
    let k = [0, 1, 2].map(|d| TAU * wave[d] / (sizes[d] as f64 * spacing[d]));
    let sum: f64 = (0..3).map(|d| ((k[d] * spacing[d] / 2.0).sin() / spacing[d]).powi(2)).sum();
    let omega = 2.0 / h * (h * sum.sqrt()).asin();
    let domain = Sound.grid(sizes).spacing(spacing).periodic();
    let grid = *domain.lattice();
    let shape = |index: usize| {
        let place = grid.place(index).expect("a site");
        (0..3).map(|d| k[d] * spacing[d] * place[d] as f64).sum::<f64>().cos()
    };
    let stepper = domain.stepper(h)?;
    let start: Vec<_> = (0..grid.sites()).map(|index| Vector1::new(shape(index))).collect();
    let mut state = stepper.state(start, vec![Vector1::zeros(); grid.sites()])?;
    for steps in [1_u32, 7, 400] {
        let more = u64::from(steps) - state.steps();
        stepper.advance(&mut state, more)?;
        let now = (omega * f64::from(steps) * h).cos();
        for (index, u) in state.configuration().iter().enumerate() {
            assert!((u.x - now * shape(index)).abs() < 2e-12, "{steps} {index}: {} {}", u.x, now * shape(index));
        }
    }
    Ok(())
}

/// The longest stable step of waves of speed 1 is dx/√d: shorter ones stay bounded, longer ones grow.
#[test]
fn waves_are_stable_up_to_the_step_of_courant_friedrichs_and_lewy() -> Result<(), SiteError> {
    let limit = 0.5 / 3.0_f64.sqrt();
    for (part, is_stable) in [(0.99, true), (1.01, false)] {
        let stepper = Sound.grid([6, 6, 6]).spacing([0.5; 3]).periodic().stepper(part * limit)?;
        let start: Vec<_> = (0..216).map(|i| Vector1::new(f64::from(i * i % 17) / 17.0 - 0.5)).collect();
        let mut state = stepper.state(start, vec![Vector1::zeros(); 216])?;
        stepper.advance(&mut state, 400)?;
        let largest = state.configuration().iter().map(|u| u.x.abs()).fold(0.0, f64::max);
        assert_eq!(largest < 10.0, is_stable, "{part}: {largest:e}");
    }
    Ok(())
}

/// u and its rate, of a kink of speed v: u = 4 atan exp((x − vt)/√(1 − v²)). Sites are (cos u, sin u).
fn kink(x: f64, t: f64, v: f64) -> (f64, f64) {
    let gamma = 1.0 / (1.0 - v * v).sqrt();
    let slope = (gamma * (x - v * t)).exp();
    (4.0 * slope.atan(), -4.0 * gamma * v * slope / (1.0 + slope * slope))
}

/// Where u = π, by linear interpolation between sites.
fn middle(q: &[Vector2<f64>], dx: f64) -> f64 {
    let is_between = |pair: &[Vector2<f64>]| pair[0].x < 0.0 && pair[0].y >= 0.0 && pair[1].y < 0.0;
    let i = q.windows(2).position(is_between).expect("a kink");
    let angle = |q: &Vector2<f64>| q.y.atan2(-q.x);
    let (a, b) = (angle(&q[i]), angle(&q[i + 1]));
    dx * (i as f64 + a / (a - b))
}

/// The same chain in steps of second order.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<2>, q: Unit<Vector2>| F * q,
    cost      = |h, F| (F - I).norm_squared() / (4 * h),
    potential = |q| 1 - q.x,
    space     = |dx, q, next| (next - q).norm_squared() / (2 * dx.powi(2)),
)]
struct SecondOrder;

/// The speed of a kink that starts with the speed ½, over 20 s.
fn speed<S>(system: &S, dx: f64) -> Result<f64, SiteError>
where
    S: Field<1>
        + MovingField
        + Clone
        + Clebsch<Scalar = f64, Configuration = Vector2<f64>, Momentum = Vector1<f64>, Time = ()>,
{
    let (sites, duration) = ((40.0 / dx) as usize, 20.0);
    let start = |i: usize| kink(dx * i as f64 - 12.0, 0.0, 0.5);
    let q: Vec<_> = (0..sites).map(|i| Vector2::new(start(i).0.cos(), start(i).0.sin())).collect();
    let mu: Vec<_> = (0..sites).map(|i| Vector1::new(start(i).1)).collect();
    let stepper = system.grid([sites]).spacing([dx]).free().stepper(dx / 2.0)?;
    let mut state = stepper.state(q, mu)?;
    let before = middle(state.configuration(), dx);
    stepper.advance(&mut state, (duration / (dx / 2.0)) as u64)?;
    Ok((middle(state.configuration(), dx) - before) / duration)
}

/// Of another integration of the same scheme, to the precision of its fit.
#[test]
fn kinks_have_the_speed_of_the_grid() -> Result<(), SiteError> {
    let speeds = [(0.2, 0.49008), (0.1, 0.497_654), (0.05, 0.499_421)];
    for (dx, expected) in speeds.into_iter().take(if cfg!(feature = "heavy") { 3 } else { 2 }) {
        let found = speed(&SecondOrder, dx)?;
        assert!((found - expected).abs() < 2e-4, "{dx}: {found} {expected}");
    }
    Ok(())
}

/// The speed of a kink comes to v like dx², and at order 4 its error is that of the grid alone.
#[test]
fn kinks_keep_their_speed() -> Result<(), SiteError> {
    let errors = [speed(&SineGordon, 0.2)? - 0.5, speed(&SineGordon, 0.1)? - 0.5];
    let order = (errors[0] / errors[1]).log2();
    assert!((1.8..2.2).contains(&order) && errors[1].abs() < 4e-3, "{errors:?}, {order}");
    Ok(())
}

/// Steps of order 4 against short ones.
#[test]
fn composed_steps_have_their_order() -> Result<(), SiteError> {
    let run = |h: f64, steps: u64| {
        let stepper = SineGordon.grid([12]).spacing([0.4]).periodic().stepper(h)?;
        let angle = |i: usize| 0.4 + 0.9 * (TAU * i as f64 / 12.0).sin();
        let q: Vec<_> = (0..12).map(|i| Vector2::new(angle(i).cos(), angle(i).sin())).collect();
        let mut state = stepper.state(q, vec![Vector1::new(0.3); 12])?;
        stepper.advance(&mut state, steps)?;
        Ok::<_, SiteError>(state.into_storage().0)
    };
    let exact = run(0.0025, 800)?;
    let error = |h: f64, steps: u64| {
        let found = run(h, steps)?;
        Ok::<_, SiteError>(found.iter().zip(&exact).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max))
    };
    let order = (error(0.08, 25)? / error(0.04, 50)?).log2();
    assert!((3.7..4.3).contains(&order), "{order}");
    Ok(())
}
