//! Single precision: x⁺ = x + hu at the price h (x² + u²)/2, with −1 ≤ u ≤ 1.

use clebsch::{Arrival, BoundsExpansion, Controlled, EndpointExpansion, Error, Expansion, Target};
use nalgebra::{Matrix2x1, Vector1, Vector2};

#[derive(Clone, Debug)]
struct Tank;

type Level = Vector1<f32>;

impl Controlled<1, 1, 2> for Tank {
    type Scalar = f32;
    type Place = Level;
    type Constants = f32;
    const NAME: &'static str = "Tank";
    const BOUNDS: [&'static str; 2] = ["u <= 1", "u >= -1"];
    const MOTIONS: usize = 1;

    fn prepare(&self, h: f32) -> Result<f32, Error> {
        Ok(h)
    }
    fn check_place(&self, _: &Level) -> Result<(), Error> {
        Ok(())
    }
    fn follow(&self, h: &f32, _: f32, x: &Level, u: &Level) -> Result<Level, Error> {
        Ok(x + u * *h)
    }
    fn price(&self, h: &f32, _: f32, x: &Level, u: &Level) -> Result<f32, Error> {
        Ok(h * (x[0] * x[0] + u[0] * u[0]) / 2.0)
    }
    fn expand(&self, h: &f32, t: f32, x: &Level, u: &Level, _: &Level) -> Result<Expansion<Level, f32, 1, 1>, Error> {
        Ok(Expansion {
            next: self.follow(h, t, x, u)?,
            by_place: Vector1::new(1.0),
            by_input: Vector1::new(*h),
            price: self.price(h, t, x, u)?,
            price_by_place: x * *h,
            price_by_input: u * *h,
            place_curvature: Vector1::new(*h),
            mixed_curvature: Vector1::zeros(),
            input_curvature: Vector1::new(*h),
        })
    }
    fn price_of_time(&self, _: &f32, _: f32, _: f32, x: &Level, u: &Level, p: &Level) -> Result<f32, Error> {
        Ok((x[0] * x[0] + u[0] * u[0]) / 2.0 + p[0] * u[0])
    }
    fn bounds(&self, _: &f32, _: f32, _: &Level, u: &Level) -> Result<Vector2<f32>, Error> {
        Ok(Vector2::new(u[0] - 1.0, -u[0] - 1.0))
    }
    fn bounds_expanded(
        &self,
        h: &f32,
        t: f32,
        x: &Level,
        u: &Level,
        _: &Vector2<f32>,
    ) -> Result<BoundsExpansion<f32, 1, 1, 2>, Error> {
        Ok(BoundsExpansion {
            values: self.bounds(h, t, x, u)?,
            by_place: Matrix2x1::zeros(),
            by_input: Matrix2x1::new(1.0, -1.0),
            place_curvature: Vector1::zeros(),
            mixed_curvature: Vector1::zeros(),
            input_curvature: Vector1::zeros(),
        })
    }
    fn endpoint(&self, _: &f32, _: f32, _: &Level) -> f32 {
        0.0
    }
    fn endpoint_expanded(&self, _: &f32, _: f32, _: &Level) -> EndpointExpansion<f32, 1> {
        EndpointExpansion { price: 0.0, by_time: 0.0, slope: Vector1::zeros(), curvature: Vector1::zeros() }
    }
    fn arrival(&self, x: &Level, target: &Level) -> Arrival<f32, 1> {
        Arrival { residual: target - x, slope: Vector1::new(1.0) }
    }
    fn displacement(&self, x: &Level, y: &Level) -> Level {
        y - x
    }
    fn moved(&self, x: &Level, delta: &Level) -> Level {
        x + delta
    }
    fn infinitesimal_motion(&self, _: &Level, delta: &Level) -> Level {
        *delta
    }
}

/// From 2 to 0: as fast as allowed until the exponential decay needs less. The condition of first order is computed in
/// doubles.
#[test]
fn single_precision_is_enough() -> Result<(), Error> {
    let control = Tank.control(0.05)?;
    let start = Vector1::new(2.0);
    let mut plan = [control.stage(&start); 100];
    let found = control.solve(&start, Target::Place(Vector1::new(0.0)), &mut plan)?;
    assert!(found.gap() < 1e-5 && found.is_minimum() && found.iterations() <= 30, "{found:?}");
    let active: std::vec::Vec<bool> = found.stages().iter().map(|stage| stage.active()[1]).collect();
    let bound = active.iter().filter(|active| **active).count();
    assert!(bound > 10 && active[..bound].iter().all(|active| *active), "{bound}");
    // inside, u_{k+1} − u_k = h x_{k+1} from p_k = p_{k+1} + h x_k and u_k = −p_{k+1}
    for pair in found.stages()[bound + 1..].windows(2) {
        let difference = f64::from(pair[1].input()[0]) - f64::from(pair[0].input()[0]);
        assert!((difference - 0.05 * f64::from(pair[1].place()[0])).abs() < 2e-4, "{difference}");
    }
    Ok(())
}
