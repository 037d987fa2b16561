//! Costates at the start that lead to where one wants to be, by Newton's method with differences.

use nalgebra::{Matrix3, Vector3};

/// Newton corrections at most.
const CORRECTIONS: usize = 60;
/// The largest correction, relative.
const LARGEST: f64 = 0.3;
/// Of differences, relative to the costate.
const STEP: f64 = 1e-5;
/// Corrections below this, relative, are those of rounding once they shrink no more.
const SMALL: f64 = 1e-9;

/// A zero of three functions of the costate.
#[derive(Clone, Copy, Debug)]
pub struct Shot {
    /// λ at the start.
    pub costate: Vector3<f64>,
    /// By how much a small error of the residual, in its unit, changes the costate.
    pub sensitivity: f64,
}

/// The zero of `defect` near the guess; `None` where corrections do not end.
pub fn aim(guess: &Vector3<f64>, defect: impl Fn(&Vector3<f64>) -> Option<Vector3<f64>>) -> Option<Shot> {
    let mut costate = *guess;
    let mut last = f64::INFINITY;
    for _ in 0..CORRECTIONS {
        let size = costate.norm();
        let slope = slope(&costate, STEP * size, &defect)?;
        let inverse = slope.try_inverse()?;
        let correction = -(inverse * defect(&costate)?);
        let relative = correction.norm() / size;
        if relative >= last && last < SMALL || relative == 0.0 {
            return Some(Shot { costate, sensitivity: inverse.norm() });
        }
        last = relative;
        costate += correction * (LARGEST / relative).min(1.0);
    }
    None
}

/// The derivative by central differences of fourth order.
pub fn slope(
    costate: &Vector3<f64>,
    step: f64,
    defect: &impl Fn(&Vector3<f64>) -> Option<Vector3<f64>>,
) -> Option<Matrix3<f64>> {
    let mut slope = Matrix3::zeros();
    for column in 0..3 {
        let at = |steps: f64| {
            let mut moved = *costate;
            moved[column] += steps * step;
            defect(&moved)
        };
        let difference = (at(1.0)? - at(-1.0)?) * 8.0 - (at(2.0)? - at(-2.0)?);
        slope.set_column(column, &(difference / (12.0 * step)));
    }
    Some(slope)
}
