//! Fields that are shared by ranks.

#![allow(dead_code, reason = "each example has some of them")]

use clebsch::Clebsch;
use nalgebra::{SVector, UnitVector3, Vector3, Vector4};

/// Waves of unit vectors in two directions of space. The forces of all edges of a site are one formula.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost   = |h, F| (F - I).norm_squared() / (4 * h),
    space  = [
        |dx, q, next| (next - q).norm_squared() / (2 * dx.powi(2)),
        |dy, q, next| (next - q).norm_squared() / (2 * dy.powi(2)),
    ],
)]
pub struct WaveMap;

/// A rod of rigid sections that bends, turns, stretches and shears.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SE<3>, q: SE<3>| q * F,
    cost   = |h, F| ((F - I) * Matrix4::from_diagonal(&self.section) * (F - I).transpose()).trace() / (2 * h),
    space  = |ds, W| {
        let strain = W.cayley() / ds - self.reference;
        ds * strain.dot(&self.stiffness.component_mul(&strain)) / 2
    },
)]
pub struct Rod {
    /// Principal second moments and mass of a section, kg·m² and kg.
    pub section: Vector4<f64>,
    /// EI, EI, GJ in N·m², GA, GA, EA in N.
    pub stiffness: SVector<f64, 6>,
    /// Curvature in 1/m and tangent without load.
    pub reference: SVector<f64, 6>,
}

/// A sheet of beads, each with a mass and a spring of its own, in a potential that grows. Steps of order 4.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |a: Translation<2>, x: Vector2| x + a,
    cost      = |h, a| self.mass * a.norm_squared() / (2 * h),
    potential = |t, x| self.spring * (1 - x.x.cos()) * (1 + t),
    space     = [
        |dx, x, next| self.spring * (next - x).norm_squared().powi(2) / dx.powi(2) + (next.x - x.x).cos(),
        |dy, x, next| (next - x).norm_squared() / (2 * dy.powi(2)),
    ],
    order     = 4,
)]
pub struct Beads {
    /// Kilograms.
    pub mass: f64,
    /// Joules.
    pub spring: f64,
}

/// A chiral field of rotations in three directions of space.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, R: SO<3>| R * F,
    cost   = |h, F| (F - I).norm_squared() / (4 * h),
    space  = [
        |dx, W| (W - I).norm_squared() / (4 * dx.powi(2)),
        |dy, W| (W - I).norm_squared() / (4 * dy.powi(2)),
        |dz, W| (W - I).norm_squared() / (4 * dz.powi(2)),
    ],
)]
pub struct Crystal;

/// A string, its displacement x. Steps of order 8 in single precision.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |a: Translation<1>, x: Vector1| x + a,
    cost   = |h, a| a.norm_squared() / (2 * h),
    space  = |dx, x, next| (next - x).norm_squared() / (2 * dx.powi(2)),
    order  = 8,
    scalar = f32,
)]
pub struct Strand;

/// A unit vector by the number of its site, and a momentum across it.
pub fn spin(site: usize) -> (Vector3<f64>, Vector3<f64>) {
    let x = site as f64;
    let q = UnitVector3::new_normalize(Vector3::new(x.sin(), (1.3 * x).cos(), 2.0)).into_inner();
    (q, q.cross(&Vector3::new((0.7 * x).cos(), 0.2, (2.0 * x).sin())) * 0.1)
}
