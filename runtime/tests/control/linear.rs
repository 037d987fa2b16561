//! Linear systems with quadratic prices and linear bounds.

use clebsch::{Arrival, BoundsExpansion, Controlled, EndpointExpansion, Error, Expansion};
use nalgebra::{SMatrix, SVector};

/// x⁺ = A x + B u at the price ½ x·Qx + ½ u·Ru, at last ½ x·Sx, under G x + H u ≤ b. The first M components are the
/// configuration.
#[derive(Clone, Debug)]
pub struct Linear<const D: usize, const U: usize, const C: usize, const M: usize> {
    pub a: SMatrix<f64, D, D>,
    pub b: SMatrix<f64, D, U>,
    pub place_price: SMatrix<f64, D, D>,
    pub input_price: SMatrix<f64, U, U>,
    pub end_price: SMatrix<f64, D, D>,
    pub bound_place: SMatrix<f64, C, D>,
    pub bound_input: SMatrix<f64, C, U>,
    pub bound: SVector<f64, C>,
}

/// (x, v) with x⁺ = x + hv + h²u/2, v⁺ = v + hu, at the price ½ h u².
pub fn double_integrator<const C: usize>(h: f64) -> Linear<2, 1, C, 1> {
    Linear {
        a: SMatrix::<f64, 2, 2>::new(1.0, h, 0.0, 1.0),
        b: SMatrix::<f64, 2, 1>::new(h * h / 2.0, h),
        place_price: SMatrix::zeros(),
        input_price: SMatrix::<f64, 1, 1>::new(h),
        end_price: SMatrix::zeros(),
        bound_place: SMatrix::zeros(),
        bound_input: SMatrix::zeros(),
        bound: SVector::zeros(),
    }
}

/// The same with −1 ≤ u ≤ 1.
pub fn bounded_integrator(h: f64) -> Linear<2, 1, 2, 1> {
    let bound_input = SMatrix::<f64, 2, 1>::new(1.0, -1.0);
    Linear { bound_input, bound: SVector::<f64, 2>::new(1.0, 1.0), ..double_integrator(h) }
}

impl<const D: usize, const U: usize, const C: usize, const M: usize> Controlled<D, U, C> for Linear<D, U, C, M> {
    type Scalar = f64;
    type Place = SVector<f64, D>;
    type Constants = ();
    const NAME: &'static str = "Linear";
    const BOUNDS: [&'static str; C] = ["the bound"; C];
    const MOTIONS: usize = M;

    fn prepare(&self, _: f64) -> Result<(), Error> {
        Ok(())
    }

    fn check_place(&self, x: &SVector<f64, D>) -> Result<(), Error> {
        if x.iter().all(|x| x.is_finite()) { Ok(()) } else { Err(Error::NotFinite { name: "the place" }) }
    }

    fn follow(&self, (): &(), _: f64, x: &SVector<f64, D>, u: &SVector<f64, U>) -> Result<SVector<f64, D>, Error> {
        Ok(self.a * x + self.b * u)
    }

    fn price(&self, (): &(), _: f64, x: &SVector<f64, D>, u: &SVector<f64, U>) -> Result<f64, Error> {
        Ok(x.dot(&(self.place_price * x)) / 2.0 + u.dot(&(self.input_price * u)) / 2.0)
    }

    fn expand(
        &self,
        (): &(),
        t: f64,
        x: &SVector<f64, D>,
        u: &SVector<f64, U>,
        _: &SVector<f64, D>,
    ) -> Result<Expansion<SVector<f64, D>, f64, D, U>, Error> {
        Ok(Expansion {
            next: self.a * x + self.b * u,
            by_place: self.a,
            by_input: self.b,
            price: self.price(&(), t, x, u)?,
            price_by_place: self.place_price * x,
            price_by_input: self.input_price * u,
            place_curvature: self.place_price,
            mixed_curvature: SMatrix::zeros(),
            input_curvature: self.input_price,
        })
    }

    fn price_of_time(
        &self,
        (): &(),
        _: f64,
        _: f64,
        _: &SVector<f64, D>,
        _: &SVector<f64, U>,
        _: &SVector<f64, D>,
    ) -> Result<f64, Error> {
        Ok(0.0)
    }

    fn bounds(&self, (): &(), _: f64, x: &SVector<f64, D>, u: &SVector<f64, U>) -> Result<SVector<f64, C>, Error> {
        Ok(self.bound_place * x + self.bound_input * u - self.bound)
    }

    fn bounds_expanded(
        &self,
        (): &(),
        t: f64,
        x: &SVector<f64, D>,
        u: &SVector<f64, U>,
        _: &SVector<f64, C>,
    ) -> Result<BoundsExpansion<f64, D, U, C>, Error> {
        let (by_place, by_input) = (self.bound_place, self.bound_input);
        Ok(BoundsExpansion { values: self.bounds(&(), t, x, u)?, by_place, by_input, ..crate::no_bounds() })
    }

    fn endpoint(&self, (): &(), _: f64, x: &SVector<f64, D>) -> f64 {
        x.dot(&(self.end_price * x)) / 2.0
    }

    fn endpoint_expanded(&self, (): &(), t: f64, x: &SVector<f64, D>) -> EndpointExpansion<f64, D> {
        let (price, slope) = (self.endpoint(&(), t, x), self.end_price * x);
        EndpointExpansion { price, by_time: 0.0, slope, curvature: self.end_price }
    }

    fn arrival(&self, x: &SVector<f64, D>, target: &SVector<f64, D>) -> Arrival<f64, D> {
        Arrival { residual: target - x, slope: SMatrix::identity() }
    }

    fn displacement(&self, x: &SVector<f64, D>, y: &SVector<f64, D>) -> SVector<f64, D> {
        y - x
    }

    fn moved(&self, x: &SVector<f64, D>, delta: &SVector<f64, D>) -> SVector<f64, D> {
        x + delta
    }

    fn infinitesimal_motion(&self, _: &SVector<f64, D>, delta: &SVector<f64, D>) -> SVector<f64, D> {
        *delta
    }
}
