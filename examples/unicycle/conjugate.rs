//! Conjugate points of the closed form: the index of the price by Morse's theorem, which no plan has told.
//!
//! Source for normal extremals of contact structures: Agrachev, Barilari and Boscain, *A Comprehensive Introduction to Sub-Riemannian
//! Geometry* (2019), chapter 8.

use crate::geodesic::Geodesic;
use crate::place::apart;
use crate::shooting::slope;
use clebsch_examples::claims::Claims;
use nalgebra::Vector3;

/// Times at which the determinant is looked at.
const SAMPLES: u32 = 240;
/// The first of them: before it the determinant, of fifth order in t, is lost in rounding, and no point is conjugate.
const FIRST: u32 = 12;
/// Determinants below this, relative to the largest, are none.
const SMALL: f64 = 1e-6;

/// The number of times before `duration` where det ∂q/∂λ changes its sign; `None` where the end is all but one of them.
pub fn points(geodesic: &Geodesic, turn_price: f64, duration: f64) -> Option<usize> {
    let costate = geodesic.costate;
    let determinant = |k: u32| {
        let t = duration * f64::from(k) / f64::from(SAMPLES);
        let here = geodesic.at(t).place;
        let place = |costate: &Vector3<f64>| Some(apart(&here, &Geodesic::new(turn_price, costate)?.at(t).place));
        Some(slope(&costate, 1e-4 * costate.norm(), &place)?.determinant())
    };
    let determinants = (FIRST..=SAMPLES).map(determinant).collect::<Option<Vec<_>>>()?;
    let largest = determinants.iter().fold(0.0, |largest: f64, determinant| largest.max(determinant.abs()));
    let clear = determinants.last().is_some_and(|last| last.abs() > SMALL * largest);
    clear.then(|| determinants.windows(2).filter(|pair| (pair[0] < 0.0) != (pair[1] < 0.0)).count())
}

/// The index of a plan is the number of conjugate points.
pub fn claim(name: &str, index: usize, points: Option<usize>, claims: &mut Claims) {
    let name = format!("{name}: the index is the number of conjugate points");
    match points {
        Some(points) => claims.holds(&name, index == points, &format!("index {index}, {points} by the closed form")),
        None => claims.skip(&name, "no geodesic of the closed form is near, or its end is a conjugate point"),
    }
}
