//! Electromagnetic fields and frames in spacetime; c = 1, signature + − − −, time in ns, fields in tesla (E/c for the electric).

use nalgebra::{Matrix3, Matrix4, Vector3, Vector4};

/// m/s
const SPEED_OF_LIGHT: f64 = 299_792_458.0;

/// A constant and homogeneous field, tesla.
#[derive(Clone, Copy, Debug)]
pub struct Field {
    /// E/c.
    pub electric: Vector3<f64>,
    /// B.
    pub magnetic: Vector3<f64>,
}

impl Field {
    /// From MV/m and tesla.
    pub fn new(megavolts_per_metre: [f64; 3], tesla: [f64; 3]) -> Self {
        let electric = Vector3::from(megavolts_per_metre) * (1e6 / SPEED_OF_LIGHT);
        Self { electric, magnetic: tesla.into() }
    }

    /// 𝓕 with one upper and one lower index: du/dτ = κ 𝓕 u is the Lorentz force.
    pub fn tensor(&self) -> Matrix4<f64> {
        let mut tensor = Matrix4::zeros();
        tensor.fixed_view_mut::<1, 3>(0, 1).copy_from(&self.electric.transpose());
        tensor.fixed_view_mut::<3, 1>(1, 0).copy_from(&self.electric);
        // u × B = −B × u
        tensor.fixed_view_mut::<3, 3>(1, 1).copy_from(&-self.magnetic.cross_matrix());
        tensor
    }

    /// The field with this tensor.
    pub fn of(tensor: &Matrix4<f64>) -> Self {
        let turn: Matrix3<f64> = tensor.fixed_view::<3, 3>(1, 1).into();
        let magnetic = -Vector3::new(turn[(2, 1)], turn[(0, 2)], turn[(1, 0)]);
        Self { electric: tensor.fixed_view::<3, 1>(1, 0).into(), magnetic }
    }

    /// The magnetic part alone.
    pub fn turning(&self) -> Self {
        Self { electric: Vector3::zeros(), magnetic: self.magnetic }
    }

    /// The same field in the axes of a frame.
    pub fn seen_from(&self, frame: &Matrix4<f64>) -> Self {
        Self::of(&(inverse(frame) * self.tensor() * frame))
    }

    /// B² − E² and E·B, the same in every frame.
    pub fn invariants(&self) -> [f64; 2] {
        [self.magnetic.norm_squared() - self.electric.norm_squared(), self.electric.dot(&self.magnetic)]
    }
}

/// κ = e/m of one elementary charge, rad/(ns T).
pub fn charge_to_mass(megaelectronvolts: f64) -> f64 {
    SPEED_OF_LIGHT * SPEED_OF_LIGHT / (megaelectronvolts * 1e6) * 1e-9
}

/// diag(1, −1, −1, −1)
pub fn metric() -> Matrix4<f64> {
    Matrix4::from_diagonal(&Vector4::new(1.0, -1.0, -1.0, -1.0))
}

/// q⁻¹ = η qᵀ η of a Lorentz matrix.
pub fn inverse(q: &Matrix4<f64>) -> Matrix4<f64> {
    metric() * q.transpose() * metric()
}

/// The frame at rest in the laboratory, set in motion with momentum `u` = p/(mc) without turning it.
pub fn boost(u: &Vector3<f64>) -> Matrix4<f64> {
    let gamma = (1.0 + u.norm_squared()).sqrt();
    let mut q = Matrix4::identity();
    q[(0, 0)] = gamma;
    q.fixed_view_mut::<1, 3>(0, 1).copy_from(&u.transpose());
    q.fixed_view_mut::<3, 1>(1, 0).copy_from(u);
    q.fixed_view_mut::<3, 3>(1, 1).copy_from(&(Matrix3::identity() + u * u.transpose() / (1.0 + gamma)));
    q
}

/// p/(mc) of a particle at rest in the frame.
pub fn momentum(q: &Matrix4<f64>) -> Vector3<f64> {
    q.fixed_view::<3, 1>(1, 0).into()
}

/// The four-vector of a direction of the frame.
pub fn carried(q: &Matrix4<f64>, direction: &Vector3<f64>) -> Vector4<f64> {
    q * Vector4::new(0.0, direction.x, direction.y, direction.z)
}

/// A direction of the frame as an observer sees it for whom the particle was stopped without turning.
pub fn at_rest(q: &Matrix4<f64>, direction: &Vector3<f64>) -> Vector3<f64> {
    let s = carried(q, direction);
    s.fixed_rows::<3>(1) - momentum(q) * (s[0] / (1.0 + q[(0, 0)]))
}
