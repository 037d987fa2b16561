//! The Crazyflie 2.0, as identified by Förster, *System Identification of the Crazyflie 2.0 Nano Quadrocopter*, ETH
//! Zürich (2015). The data are mass, inertia tensor, thrust of a rotor at full command (its quadratic in the command,
//! at 65535), and torque per thrust.

use super::declaration::Thrusts;
use clebsch_examples::scene::Failure;
use nalgebra::{Matrix3, Matrix4, Vector3};

/// kg
pub const MASS: &str = "0.028";
/// N: 2.130295e−11 c² + 1.032633e−6 c + 5.48456e−4 with c = 65535.
pub const TOP: &str = "0.1597";
/// m/s²
pub const GRAVITY: f64 = 9.81;
/// Of the inertia tensor about the centre of mass, kg·m²: xx, yy, zz, xy, xz, yz.
const INERTIA: [f64; 6] = [16.571710e-6, 16.655602e-6, 29.261652e-6, 0.830806e-6, 0.718277e-6, 1.800197e-6];
/// From the centre to a rotor, m; rotors stand at 45° to the axes.
const RADIUS: f64 = 0.046;
/// Torque about the axis of a rotor per thrust, m.
pub const DRAG: f64 = 0.005_964_552;

/// A quadrotor.
#[derive(Clone, Copy, Debug)]
pub struct Vehicle {
    /// kg
    pub mass: f64,
    /// About the centre of mass, body frame, kg·m².
    pub inertia: Matrix3<f64>,
    /// The largest thrust of a rotor, N.
    pub top: f64,
}

impl Vehicle {
    /// Of this mass, kg, with rotors that push up to `top`, N.
    ///
    /// # Errors
    /// [`Failure::Flags`] where the rotors cannot carry it.
    pub fn new(mass: f64, top: f64) -> Result<Self, Failure> {
        let [xx, yy, zz, xy, xz, yz] = INERTIA;
        let inertia = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
        let vehicle = Self { mass, inertia, top };
        if vehicle.hover() >= vehicle.top {
            let (hover, top) = (vehicle.hover(), vehicle.top);
            return Err(Failure::Flags(format!(
                "hovering takes {hover:.4} N of each rotor, none gives more than {top:.4} N"
            )));
        }
        Ok(vehicle)
    }

    /// The same with another mass, and an inertia that goes with it.
    pub fn with_mass(&self, factor: f64) -> Self {
        Self { mass: self.mass * factor, inertia: self.inertia * factor, ..*self }
    }

    /// The thrust of a rotor at hover, N.
    pub fn hover(&self) -> f64 {
        self.mass * GRAVITY / 4.0
    }

    /// Rotors from the axes of the body, m.
    pub fn arm() -> f64 {
        RADIUS / 2.0_f64.sqrt()
    }

    /// ½ tr(J) I − J and the mass, about the centre of mass, kg·m², kg.
    pub fn mass_matrix(&self) -> Matrix4<f64> {
        let mut mass_matrix = Matrix4::zeros();
        let second = Matrix3::identity() * (self.inertia.trace() / 2.0) - self.inertia;
        mass_matrix.fixed_view_mut::<3, 3>(0, 0).copy_from(&second);
        mass_matrix[(3, 3)] = self.mass;
        mass_matrix
    }

    /// The torque that thrusts make, by r × f and the drag of each rotor, N·m: not from the declaration.
    pub fn torque(thrusts: &Thrusts) -> Vector3<f64> {
        // x and y in units of the arm, and the side to which drag turns
        const ROTORS: [(f64, f64, f64); 4] = [(1.0, -1.0, -1.0), (-1.0, -1.0, 1.0), (-1.0, 1.0, -1.0), (1.0, 1.0, 1.0)];
        let of = |((x, y, side), thrust): (&(f64, f64, f64), &f64)| {
            let place = Vector3::new(*x, *y, 0.0) * Self::arm();
            (place.cross(&Vector3::z()) + Vector3::z() * (DRAG * side)) * *thrust
        };
        ROTORS.iter().zip(thrusts).map(of).sum()
    }
}
