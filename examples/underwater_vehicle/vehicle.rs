//! A homogeneous ellipsoid of the density of water in an ideal fluid at rest, with ballast that lowers its centre of mass.

use clebsch_examples::elliptic::carlson_d;
use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};
use std::f64::consts::PI;

/// kg/m³
pub const DENSITY: f64 = 1000.0;
/// m/s²
pub const GRAVITY: f64 = 9.81;

/// The share of the fluid in the kinetic energy of a body, diagonal in the axes of an ellipsoid.
#[derive(Clone, Copy, Debug)]
pub struct Added {
    /// To the mass, kg.
    pub mass: Vector3<f64>,
    /// To the moments of inertia, kg·m².
    pub inertia: Vector3<f64>,
}

/// Lamb's added masses and inertias of an ellipsoid with semi-axes a, b, c, displacing the mass m.
///
/// α₀ = abc ∫₀^∞ dλ/((a² + λ) Δ) = ⅔ abc R_D(b², c², a²), and the mass is m α₀/(2 − α₀). The inertia is m/5 (b² − c²)²
/// (γ₀ − β₀) / (2(b² − c²) + (b² + c²)(β₀ − γ₀)), and cyclic. Source: Lamb, *Hydrodynamics*, §114 and §115.
pub fn added(semi_axes: [f64; 3]) -> Added {
    let (volume, square) = (semi_axes.iter().product::<f64>(), semi_axes.map(|axis| axis * axis));
    let displaced = DENSITY * 4.0 * PI / 3.0 * volume;
    let cyclic = |i: usize| ((i + 1) % 3, (i + 2) % 3);
    let alpha = |i: usize| 2.0 / 3.0 * volume * carlson_d(square[cyclic(i).0], square[cyclic(i).1], square[i]);
    let inertia = |i: usize| {
        let (j, k) = cyclic(i);
        let (difference, sum, alphas) = (square[j] - square[k], square[j] + square[k], alpha(k) - alpha(j));
        // A circular section moves no fluid: 0/0.
        if difference == 0.0 {
            return 0.0;
        }
        displaced / 5.0 * difference.powi(2) * alphas / (2.0 * difference - sum * alphas)
    };
    Added {
        mass: Vector3::from_fn(|i, _| displaced * alpha(i) / (2.0 - alpha(i))),
        inertia: Vector3::from_fn(|i, _| inertia(i)),
    }
}

/// A neutrally buoyant ellipsoid whose centre of mass is `offset` below its centre of buoyancy, along the third axis.
#[derive(Clone, Copy, Debug)]
pub struct Vehicle {
    /// Metres; the body frame has its origin at the centre of buoyancy.
    pub semi_axes: [f64; 3],
    /// Metres.
    pub offset: f64,
    /// Of the body, which is that of the water it displaces, kg.
    pub mass: f64,
    /// Of body and fluid along the axes, kg.
    pub masses: Vector3<f64>,
    /// Of body and fluid about the axes through the centre of buoyancy, kg·m².
    pub moments: Vector3<f64>,
}

impl Vehicle {
    /// The body's own moments of inertia about the centre of buoyancy are those of a homogeneous ellipsoid.
    pub fn new(semi_axes: [f64; 3], offset: f64) -> Self {
        let mass = DENSITY * 4.0 * PI / 3.0 * semi_axes.iter().product::<f64>();
        let [a, b, c] = semi_axes.map(|axis| axis * axis);
        let body = Vector3::new(b + c, c + a, a + b) * (mass / 5.0);
        let added = added(semi_axes);
        Self { semi_axes, offset, mass, masses: added.mass.add_scalar(mass), moments: added.inertia + body }
    }

    /// The same ellipsoid with its centre of mass elsewhere.
    pub fn with_offset(&self, offset: f64) -> Self {
        Self { offset, ..*self }
    }

    /// m·g, newtons.
    pub fn weight(&self) -> f64 {
        self.mass * GRAVITY
    }

    /// The centre of mass, body frame, metres.
    pub fn center(&self) -> Vector3<f64> {
        Vector3::new(0.0, 0.0, -self.offset)
    }

    /// Body and added inertia on (ω, v): the blocks J, D; Dᵀ, M with D = m r̂ for the centre of mass r.
    pub fn inertia(&self) -> Matrix6<f64> {
        let coupling = self.center().cross_matrix() * self.mass;
        let mut inertia = Matrix6::zeros();
        inertia.fixed_view_mut::<3, 3>(0, 0).copy_from(&Matrix3::from_diagonal(&self.moments));
        inertia.fixed_view_mut::<3, 3>(0, 3).copy_from(&coupling);
        inertia.fixed_view_mut::<3, 3>(3, 0).copy_from(&coupling.transpose());
        inertia.fixed_view_mut::<3, 3>(3, 3).copy_from(&Matrix3::from_diagonal(&self.masses));
        inertia
    }

    /// Maps momenta (Π, P) to velocities (ω, v); none where so low a centre of mass leaves no positive kinetic energy.
    pub fn inverse_inertia(&self) -> Option<Matrix6<f64>> {
        self.inertia().cholesky().map(|factors| factors.inverse())
    }
}

/// Angular and linear half.
pub fn halves(vector: &Vector6<f64>) -> (Vector3<f64>, Vector3<f64>) {
    (vector.fixed_rows::<3>(0).into(), vector.fixed_rows::<3>(3).into())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lamb's closed form for prolate spheroids of eccentricity e, §114 and §115: along, across, and turning about a short axis.
    #[test]
    fn added_masses_of_spheroids_are_lambs_closed_form() {
        for ratio in [1.5_f64, 2.0, 5.0, 10.0] {
            let e = (1.0 - ratio.powi(-2)).sqrt();
            let (square, logarithm) = (e * e, ((1.0 + e) / (1.0 - e)).ln());
            let long = 2.0 * (1.0 - square) / (square * e) * (logarithm / 2.0 - e);
            let short = 1.0 / square - (1.0 - square) / (2.0 * square * e) * logarithm;
            let difference = (2.0 - square) * (short - long);
            let turning = square * square * (short - long) / ((2.0 - square) * (2.0 * square - difference));

            let vehicle = Vehicle::new([1.0, 1.0, ratio], 0.0);
            let (added, own) = (added(vehicle.semi_axes), vehicle.mass / 5.0 * (1.0 + ratio * ratio));
            let found = [added.mass.z / vehicle.mass, added.mass.x / vehicle.mass, added.inertia.x / own];
            for (found, lamb) in found.into_iter().zip([long / (2.0 - long), short / (2.0 - short), turning]) {
                assert!((found - lamb).abs() < 1e-12, "{ratio}: {found} against {lamb}");
            }
            assert_eq!(added.inertia.z, 0.0);
        }
    }

    /// A sphere takes half of the water it displaces along.
    #[test]
    fn a_sphere_takes_half_of_its_mass_along() {
        let added = added([0.7; 3]);
        assert!((added.mass / Vehicle::new([0.7; 3], 0.0).mass - Vector3::repeat(0.5)).amax() < 1e-14);
        assert_eq!(added.inertia, Vector3::zeros());
    }
}
