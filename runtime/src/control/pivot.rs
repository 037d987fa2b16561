//! The symmetric U×U Hessian of one input, and what is done where it is not positive.

use crate::Real;
use crate::linear::rows;
use crate::newton::{Curvature, Equilibrated, Ldl, UNITS};
use crate::space::larger;
use nalgebra::{SMatrix, SVector};

/// The inverse of a Hessian.
pub(super) struct Pivot<T, const U: usize> {
    factors: Factors<T, U>,
    /// The number of negative eigenvalues.
    pub negative: usize,
    /// The direction of the most negative one.
    pub fall: Option<Fall<T, U>>,
}

/// A direction δu of an input in which the price curves down.
#[derive(Clone, Copy)]
pub(super) struct Fall<T, const U: usize> {
    pub direction: SVector<T, U>,
    /// δuᵀ Q_uu δu < 0
    pub curvature: T,
}

enum Factors<T, const U: usize> {
    Triangular(Ldl<T, U>),
    /// The inverse itself.
    Spectral(SMatrix<T, U, U>),
}

impl<T: Real, const U: usize> Pivot<T, U> {
    /// Of a symmetric matrix, of which only the lower triangle is read, where the price itself curves by `natural` along each input.
    #[inline]
    pub fn of(h: &SMatrix<T, U, U>, natural: &SVector<T, U>, curvature: Curvature<T>) -> Self {
        let mut h = *h;
        let Curvature { damping, steadiness, .. } = curvature;
        if larger(damping, steadiness) > T::zero() {
            for i in 0..U {
                let entry = h[(i, i)];
                h[(i, i)] = entry + larger(damping * entry.abs(), steadiness * natural[i].abs());
            }
        }
        match Ldl::positive(&rows(&h)) {
            Some(factors) => Self { factors: Factors::Triangular(factors), negative: 0, fall: None },
            None => spectral(&h, curvature),
        }
    }

    /// −H⁻¹B
    #[inline]
    pub fn against<const K: usize>(&self, b: &SMatrix<T, U, K>) -> SMatrix<T, U, K> {
        match &self.factors {
            Factors::Triangular(factors) => {
                let mut w = rows(&-b);
                factors.forward(&mut w);
                let mut x = factors.divided(&w);
                factors.backward(&mut x);
                SMatrix::from_fn(|i, j| x[i][j])
            }
            Factors::Spectral(inverse) => -(inverse * b),
        }
    }
}

/// From the eigenvalues of the matrix with its diagonal scaled to ±1. Directions without any curvature are left alone.
#[cold]
fn spectral<T: Real, const U: usize>(h: &SMatrix<T, U, U>, curvature: Curvature<T>) -> Pivot<T, U> {
    let scaled = Equilibrated::of(h);
    let Equilibrated { spectrum, scale } = &scaled;
    let largest = spectrum.largest();
    let noise = T::from_f64(UNITS) * T::EPSILON * largest;
    let inverse = scaled.map(|value| {
        // Written so that NaN stays NaN.
        if value.abs() <= noise && !curvature.is_mirrored || largest == T::zero() {
            T::zero()
        } else if !curvature.is_mirrored || value > noise {
            value.recip()
        } else {
            spectrum.turned_over(value).recip()
        }
    });
    let wrong = -T::EPSILON.sqrt() * largest;
    let negative = spectrum.values.iter().filter(|&&value| value < wrong).count();
    let least = (0..U).fold(0, |least, i| if spectrum.values[i] < spectrum.values[least] { i } else { least });
    let fall = (negative > 0).then(|| Fall {
        curvature: spectrum.values[least],
        direction: SVector::from_fn(|i, _| scale[i] * spectrum.vectors[(i, least)]),
    });
    Pivot { factors: Factors::Spectral(inverse), negative, fall }
}
