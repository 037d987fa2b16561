//! SU(3) as real matrices: the fixed point x = hΣ⁻¹φ(−ad_x)ᵀμ, with φ(A)μ as a series of vectors, and nalgebra's exponential.

use super::ByHand;
use crate::systems::Unitary;
use clebsch::Clebsch;
use nalgebra::{Matrix6, SMatrix, SVector};
use std::array::from_fn;

type Vector8 = SVector<f64, 8>;
type Matrix8 = SMatrix<f64, 8, 8>;

pub struct Body {
    basis: [Matrix6<f64>; 8],
    /// Those of velocities with ⟨X, E_i⟩ = μ_i.
    dual: Matrix8,
    /// −ad*, for each basis vector.
    minus_coad: [Matrix8; 8],
    /// h/w
    scale: Vector8,
    stiffness: Matrix6<f64>,
    h: f64,
}

/// Fixed-point iterations, and terms of a series, that no step of these systems needs.
const MOST: usize = 50;

impl Body {
    /// The basis is that of the declared system's momentum map.
    pub fn new(system: &Unitary, h: f64) -> Self {
        let mut basis = [Matrix6::zeros(); 8];
        for entry in 0..36 {
            let mut p = Matrix6::zeros();
            p[entry] = 1.0;
            let momentum = system.momentum_map(&Matrix6::identity(), &p);
            for (element, component) in basis.iter_mut().zip(&momentum) {
                element[entry] = *component;
            }
        }
        let gram = Matrix8::from_fn(|i, j| basis[i].dot(&basis[j]));
        let dual = gram.try_inverse().expect("a basis");
        let bracket = |i: usize, j: usize| basis[i] * basis[j] - basis[j] * basis[i];
        let minus_coad = from_fn(|i| -(dual * Matrix8::from_fn(|k, j| bracket(i, j).dot(&basis[k]))).transpose());
        let scale = Vector8::repeat(h).component_div(&system.inertia);
        Self { basis, dual, minus_coad, scale, stiffness: system.stiffness, h }
    }

    fn element(&self, x: &Vector8) -> Matrix6<f64> {
        self.basis.iter().zip(x).map(|(element, x)| element * *x).sum()
    }

    fn components(&self, m: &Matrix6<f64>) -> Vector8 {
        Vector8::from_fn(|i, _| m.dot(&self.basis[i]))
    }

    fn kick(&self, q: &Matrix6<f64>) -> Vector8 {
        self.components(&(self.stiffness * q.transpose() * (-0.5 * self.h)))
    }

    /// φ(A)v = v + Av/2! + A²v/3! + …
    fn phi(a: &Matrix8, v: &Vector8) -> Vector8 {
        let mut term = *v;
        let mut sum = *v;
        for k in 2..MOST {
            term = a * term / k as f64;
            sum += term;
            if term.amax() <= f64::EPSILON / 16.0 * sum.amax() {
                break;
            }
        }
        sum
    }
}

impl ByHand for Body {
    type State = (Matrix6<f64>, Vector8);

    fn step(&self, (q, n): Self::State) -> Self::State {
        let mu = n + self.kick(&q);
        let mut x = mu.component_mul(&self.scale);
        for _ in 0..MOST {
            let coad = self.minus_coad.iter().zip(&x).map(|(matrix, x)| matrix * *x).sum();
            let next = Self::phi(&coad, &mu).component_mul(&self.scale);
            let change = (next - x).amax();
            x = next;
            if change <= f64::EPSILON * x.amax() {
                break;
            }
        }
        let f = self.element(&x).exp();
        let next = f * q;
        let moved = self.components(&(f * self.element(&(self.dual * mu)) * f.transpose()));
        (next, moved + self.kick(&next))
    }
}
