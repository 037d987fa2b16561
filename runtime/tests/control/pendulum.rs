//! A pendulum that is swung up by a weak motor, over steps of the symplectic Euler method, and a cart that is in a hurry.

use crate::jet::Jet;
use clebsch::{Arrival, BoundsExpansion, Control, Controlled, EndpointExpansion, Error, Expansion, Target};
use nalgebra::{Matrix1x2, Matrix2, Matrix2x1, SMatrix, Vector1, Vector2};
use std::vec;

/// v⁺ = v + h(u − g sin x), x⁺ = x + h v⁺ at the price h (c + u²/2), with −m ≤ u ≤ m.
#[derive(Clone, Debug)]
pub struct Pendulum {
    pub gravity: f64,
    /// The price c of the time.
    pub hurry: f64,
    /// m
    pub strength: f64,
}

impl Pendulum {
    /// x⁺ and v⁺, where δ are the first two variables and δu the third.
    fn step(&self, h: f64, x: &Vector2<f64>, u: f64) -> [Jet; 2] {
        let (position, velocity) = (Jet::variable(x[0], 0), Jet::variable(x[1], 1));
        let next = velocity + (Jet::variable(u, 2) - position.sin() * self.gravity) * h;
        [position + next * h, next]
    }
}

impl Controlled<2, 1, 2> for Pendulum {
    type Scalar = f64;
    type Place = Vector2<f64>;
    type Constants = f64;
    const NAME: &'static str = "Pendulum";
    const BOUNDS: [&'static str; 2] = ["u <= self.strength", "u >= -self.strength"];
    const MOTIONS: usize = 1;

    fn prepare(&self, h: f64) -> Result<f64, Error> {
        Ok(h)
    }

    fn check_place(&self, x: &Vector2<f64>) -> Result<(), Error> {
        if x.iter().all(|x| x.is_finite()) { Ok(()) } else { Err(Error::NotFinite { name: "the place" }) }
    }

    fn follow(&self, h: &f64, _: f64, x: &Vector2<f64>, u: &Vector1<f64>) -> Result<Vector2<f64>, Error> {
        Ok(self.step(*h, x, u[0]).map(|jet| jet.value).into())
    }

    fn price(&self, h: &f64, _: f64, _: &Vector2<f64>, u: &Vector1<f64>) -> Result<f64, Error> {
        Ok(h * (self.hurry + u[0] * u[0] / 2.0))
    }

    fn expand(
        &self,
        h: &f64,
        t: f64,
        x: &Vector2<f64>,
        u: &Vector1<f64>,
        costate: &Vector2<f64>,
    ) -> Result<Expansion<Vector2<f64>, f64, 2, 1>, Error> {
        let [position, velocity] = self.step(*h, x, u[0]);
        let curvature = position.curvature * costate[0] + velocity.curvature * costate[1];
        Ok(Expansion {
            next: Vector2::new(position.value, velocity.value),
            by_place: Matrix2::new(position.slope[0], position.slope[1], velocity.slope[0], velocity.slope[1]),
            by_input: Matrix2x1::new(position.slope[2], velocity.slope[2]),
            price: self.price(h, t, x, u)?,
            price_by_place: Vector2::zeros(),
            price_by_input: u * *h,
            place_curvature: curvature.fixed_view::<2, 2>(0, 0).into_owned(),
            mixed_curvature: Matrix1x2::new(curvature[(2, 0)], curvature[(2, 1)]),
            input_curvature: Vector1::new(curvature[(2, 2)] + h),
        })
    }

    fn price_of_time(
        &self,
        h: &f64,
        _: f64,
        _: f64,
        x: &Vector2<f64>,
        u: &Vector1<f64>,
        costate: &Vector2<f64>,
    ) -> Result<f64, Error> {
        let force = u[0] - self.gravity * x[0].sin();
        let position = x[1] + 2.0 * h * force;
        Ok(self.hurry + u[0] * u[0] / 2.0 + costate[0] * position + costate[1] * force)
    }

    fn bounds(&self, _: &f64, _: f64, _: &Vector2<f64>, u: &Vector1<f64>) -> Result<Vector2<f64>, Error> {
        Ok(Vector2::new(u[0] - self.strength, -u[0] - self.strength))
    }

    fn bounds_expanded(
        &self,
        h: &f64,
        t: f64,
        x: &Vector2<f64>,
        u: &Vector1<f64>,
        _: &Vector2<f64>,
    ) -> Result<BoundsExpansion<f64, 2, 1, 2>, Error> {
        Ok(BoundsExpansion {
            values: self.bounds(h, t, x, u)?,
            by_input: Vector2::new(1.0, -1.0),
            ..crate::no_bounds()
        })
    }

    fn endpoint(&self, _: &f64, _: f64, _: &Vector2<f64>) -> f64 {
        0.0
    }

    fn endpoint_expanded(&self, _: &f64, _: f64, _: &Vector2<f64>) -> EndpointExpansion<f64, 2> {
        EndpointExpansion { price: 0.0, by_time: 0.0, slope: Vector2::zeros(), curvature: Matrix2::zeros() }
    }

    fn arrival(&self, x: &Vector2<f64>, target: &Vector2<f64>) -> Arrival<f64, 2> {
        Arrival { residual: target - x, slope: SMatrix::identity() }
    }

    fn displacement(&self, x: &Vector2<f64>, y: &Vector2<f64>) -> Vector2<f64> {
        y - x
    }

    fn moved(&self, x: &Vector2<f64>, delta: &Vector2<f64>) -> Vector2<f64> {
        x + delta
    }

    fn infinitesimal_motion(&self, _: &Vector2<f64>, delta: &Vector2<f64>) -> Vector2<f64> {
        *delta
    }
}

/// The motor holds less than half of the weight: the pendulum has to swing. No guess finds a lower price, and few a higher one.
#[test]
#[cfg_attr(miri, ignore = "too long to interpret: twelve swings of 160 stages")]
fn a_weak_motor_swings_the_pendulum_up() -> Result<(), Error> {
    let control: Control<_, 2, 1, 2> = Pendulum { gravity: 1.0, hurry: 0.0, strength: 0.3 }.control(0.1)?;
    let (start, goal) = (Vector2::zeros(), Vector2::new(core::f64::consts::PI, 0.0));
    let mut plan = vec![control.stage(&start); 160];
    let found = control.solve(&start, Target::Place(goal), &mut plan)?;
    let price = found.price();
    assert!(found.iterations() <= 80 && found.is_minimum() && found.gap() < 1e-12, "{found:?}");
    assert!(found.residual() < 1e-9 && found.stages().iter().all(|stage| stage.input()[0].abs() <= 0.3));
    assert!(found.stages().iter().filter(|stage| stage.active()[0]).count() > 5, "{found:?}");
    let mut cheapest = 0;
    for trial in 1..12 {
        let frequency = 0.3 + 0.1 * f64::from(trial);
        for (k, stage) in plan.iter_mut().enumerate() {
            *stage = control.stage(&start).with_input(Vector1::new(0.25 * (0.1 * k as f64 * frequency).sin()));
        }
        let other = control.solve(&start, Target::Place(goal), &mut plan)?;
        assert!(
            other.is_minimum() && other.gap() < 1e-12 && other.price() > price * (1.0 - 1e-9),
            "{other:?} after {price}"
        );
        cheapest += u32::from(other.price() < price * (1.0 + 1e-9));
    }
    assert!(cheapest >= 8, "{cheapest} of 11");
    Ok(())
}

/// Not enough time: the error gives the remaining distance.
#[test]
#[cfg_attr(miri, ignore = "too long to interpret: a search until it is given up")]
fn a_motor_too_weak_misses() -> Result<(), Error> {
    let control: Control<_, 2, 1, 2> = Pendulum { gravity: 1.0, hurry: 0.0, strength: 0.3 }.control(0.1)?;
    let start = Vector2::zeros();
    let mut plan = vec![control.stage(&start); 60];
    let target = Target::Place(Vector2::new(core::f64::consts::PI, 0.0));
    let error = control.solve(&start, target, &mut plan).unwrap_err();
    assert!(matches!(error, Error::TargetMissed { distance, .. } if distance > 0.5), "{error}");
    assert!(plan.iter().all(|stage| stage.input()[0] == 0.0));
    Ok(())
}

/// From rest to rest over the distance d in N steps of h the price is c N h + 6 d²/(h³ N (N² − 1)). It is least for
/// h⁴ = 18 d²/(c N² (N² − 1)).
#[test]
fn the_time_that_is_worth_its_price() -> Result<(), Error> {
    let (distance, hurry, steps) = (2.0, 0.5, if cfg!(miri) { 6 } else { 60 });
    // on both sides of the best step size, which is 0.06, and 0.6 under Miri
    let limited =
        if cfg!(miri) { [(1.0..=2.0, 1.0), (0.1..=0.2, 0.2)] } else { [(0.1..=1.0, 0.1), (0.01..=0.02, 0.02)] };
    let start = Vector2::zeros();
    let target = Target::Place(Vector2::new(distance, 0.0));
    let n = steps as f64;
    let expected = (18.0 * distance * distance / (hurry * n * n * (n * n - 1.0))).powf(0.25);
    let price = |h: f64| hurry * n * h + 6.0 * distance * distance / (h * h * h * n * (n * n - 1.0));
    for guess in [0.5, 0.01, 0.05, expected].into_iter().take(if cfg!(miri) { 1 } else { 4 }) {
        let control: Control<_, 2, 1, 2> = Pendulum { gravity: 0.0, hurry, strength: 1e3 }.control(guess)?;
        let mut plan = vec![control.stage(&start); steps];
        let found = control.solve_free_time(&start, target, 1e-3..=1.0, &mut plan)?;
        assert!((found.step_size() / expected - 1.0).abs() < 1e-10, "{} after {expected}", found.step_size());
        assert!((found.price() - price(expected)).abs() < 1e-10, "{found:?}");
        // at a limit
        for (limits, h) in limited.clone() {
            let found = control.solve_free_time(&start, target, limits, &mut plan)?;
            assert_eq!(found.step_size(), h);
            assert!((found.price() - price(h)).abs() < 1e-9 * price(h), "{found:?} after {}", price(h));
        }
    }
    Ok(())
}

/// With bounds there is a least time, and the first guess is below it. Where time is dear, it is nearly taken.
#[test]
#[cfg_attr(miri, ignore = "too long to interpret: many solutions for one step size")]
fn a_hurry_within_bounds() -> Result<(), Error> {
    let steps = 40;
    let control: Control<_, 2, 1, 2> = Pendulum { gravity: 0.0, hurry: 2.0, strength: 1.0 }.control(0.02)?;
    let start = Vector2::zeros();
    let target = Target::Place(Vector2::new(1.0, 0.0));
    let mut plan = vec![control.stage(&start); steps];
    let found = control.solve_free_time(&start, target, 1e-3..=1.0, &mut plan)?;
    let (h, price) = (found.step_size(), found.price());
    // full thrust there and back: d = (Nh)²/4
    assert!(h * 40.0 > 2.0 && h * 40.0 < 2.1, "{h}");
    for factor in [0.9999, 1.0001] {
        let control: Control<_, 2, 1, 2> = control.system().clone().control(h * factor)?;
        match control.solve(&start, target, &mut plan) {
            Ok(other) => assert!(other.price() > price, "{other:?} after {price}"),
            Err(error) => assert!(factor < 1.0, "{error}"),
        }
    }
    Ok(())
}
