//! The equations of a body that rolls, for an integrator that knows nothing of constraints.
//!
//! The contact c and the direction γ up are vectors of the body. Rolling is v = c × ω, and its derivative gives the force at the contact.
//! ```text
//! (J − m c^c^) ω′ = −ω × Jω + c × (m (c′ × ω + ω × (c × ω)) + m g γ),    γ′ = γ × ω
//! ```

use crate::Rattleback;
use nalgebra::{SVector, Vector3};

/// ω and γ.
pub type Rolling = SVector<f64, 6>;

impl Rattleback {
    /// From the centre of mass to the contact, in the body.
    pub fn contact(&self, up: &Vector3<f64>) -> Vector3<f64> {
        let scaled = self.axes.component_mul(&self.axes).component_mul(up);
        Vector3::z() * self.height - scaled / up.dot(&scaled).sqrt()
    }

    /// ω′ and γ′
    pub fn rolling(&self, y: &Rolling) -> Rolling {
        let (omega, up) = (y.fixed_rows::<3>(0).into_owned(), y.fixed_rows::<3>(3).into_owned());
        let squares = self.axes.component_mul(&self.axes);
        let (turning, scaled) = (up.cross(&omega), squares.component_mul(&up));
        let length = up.dot(&scaled).sqrt();
        let contact = self.contact(&up);
        let moved = scaled * (turning.dot(&scaled) / length.powi(3)) - squares.component_mul(&turning) / length;
        let push = (moved.cross(&omega) + omega.cross(&contact.cross(&omega)) + up * self.gravity) * self.mass;
        let hat = contact.cross_matrix();
        let torque = contact.cross(&push) - omega.cross(&(self.inertia * omega));
        let inertia = self.inertia - hat * hat * self.mass;
        let change = inertia.try_inverse().map_or(Vector3::repeat(f64::NAN), |inverse| inverse * torque);
        Rolling::from_iterator(change.iter().chain(turning.iter()).copied())
    }
}
