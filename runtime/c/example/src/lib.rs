//! Two systems and three methods, exported to C: the whole crate that a program in C needs.
#![no_std]

use clebsch::Clebsch;
use nalgebra::{Matrix3, Vector3};

/// A rigid body turning about a fixed pivot in uniform gravity.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, R: SO<3>| R * F,
    cost      = |h, F| (self.mass_matrix * (F - I) * (F - I).transpose()).trace() / (2 * h),
    potential = |R| self.weight * (R * self.center).z,
    method Fine = (order = 4),
)]
pub struct HeavyTop {
    /// ½tr(J)I − J about the pivot, kg·m².
    pub mass_matrix: Matrix3<f64>,
    /// m·g, newtons.
    pub weight: f64,
    /// Centre of mass in the body frame, metres.
    pub center: Vector3<f64>,
}

clebsch_c::export!(
    /// The top in C.
    heavy_top: HeavyTop { mass_matrix: Matrix3<f64>, weight: f64, center: Vector3<f64> }
);

/// The method of order four.
#[derive(Clone, Copy, Debug)]
pub struct Fine;

clebsch_c::export!(
    /// The top in C, by the method of order four.
    fine_top: HeavyTop, by Fine { mass_matrix: Matrix3<f64>, weight: f64, center: Vector3<f64> }
);

/// A probe with thrusters and wheels, pulled to a place that moves.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |(a, F): (Translation<3>, SU<2>), (x, Q): (Vector3, SU<2>)| (x + a, Q * F),
    lagrangian = |(v, omega)| (self.mass * v.norm_squared() + omega.dot(&self.moments.component_mul(&omega))) / 2,
    potential  = |t, (x, Q)| self.stiffness * (x - t * self.drift).norm_squared() / 2,
    force      = |(v, omega), (thrust, torque): (Vector3, Vector3)| (thrust, torque),
)]
pub struct Probe {
    /// Mass, kg.
    pub mass: f32,
    /// Principal moments of inertia, kg·m².
    pub moments: Vector3<f32>,
    /// Stiffness, N/m.
    pub stiffness: f32,
    /// Velocity of the place, m/s.
    pub drift: Vector3<f32>,
}

clebsch_c::export!(
    /// The probe in C.
    probe: Probe { mass: f32, moments: Vector3<f32>, stiffness: f32, drift: Vector3<f32> }
);

/// An index that may be out of range.
#[cfg(feature = "planted")]
#[allow(unsafe_code, reason = "an exported name")]
#[unsafe(export_name = "planted_index")]
extern "C" fn planted(values: &[f64; 3], index: usize) -> f64 {
    values[index]
}

/// A library without standard library needs a handler. `tests/no_std/check` shows that steps have no panic.
#[cfg(feature = "bare")]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {}
}
