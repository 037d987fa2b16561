//! Roots of functions without a derivative at hand, where time does not matter.

use crate::linear::solve_dense;
use crate::{Real, Space};
use nalgebra::{SMatrix, SVector};

/// More corrections than any start that leads to a root takes.
const CORRECTIONS: usize = 50;

/// The x near `start` where `defect` vanishes but for rounding, by Newton's method with differences for slopes. Defects have no units: those
/// of order one are large. `None` where the defect is not defined, or shrinks no further before it is below √ε.
#[cold]
pub(crate) fn root<T: Real, const M: usize>(
    start: SVector<T, M>,
    defect: impl Fn(&SVector<T, M>) -> Option<SVector<T, M>>,
) -> Option<SVector<T, M>> {
    let (mut x, mut before) = (start, T::from_f64(f64::INFINITY));
    for _ in 0..CORRECTIONS {
        // the largest of some numbers knows nothing of NaN
        let now = defect(&x).filter(Space::<T>::all_finite)?;
        let size = now.max_abs();
        let shrinks = size > T::zero() && size < before;
        if !shrinks {
            return (size < T::EPSILON.sqrt()).then_some(x);
        }
        before = size;
        let step = T::EPSILON.sqrt() * (x.max_abs() + T::EPSILON);
        let mut slope = SMatrix::<T, M, M>::from_element(T::zero());
        for j in 0..M {
            let mut beside = x;
            beside[j] += step;
            slope.set_column(j, &((defect(&beside)? - now) * step.recip()));
        }
        let (correction, _) = solve_dense(&slope, &now)?;
        x -= correction;
    }
    None
}

#[cfg(test)]
mod tests;
