//! Steady motions, and when they are stable.

use crate::vehicle::Vehicle;
use nalgebra::{Complex, ComplexField, Matrix4, Rotation3, Vector3, Vector6};

/// Along which body axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Course {
    /// Level, along the first axis, the third one upright.
    Cruise,
    /// Vertical, along the third axis, spinning about it.
    Rise,
}

/// A translation without acceleration.
#[derive(Clone, Copy, Debug)]
pub struct Steady {
    /// The vehicle.
    pub vehicle: Vehicle,
    /// Its course.
    pub course: Course,
    /// m/s
    pub speed: f64,
    /// About the third axis, rad/s; zero on a level course.
    pub spin: f64,
}

impl Steady {
    /// W l* = P² (1/m_∥ − 1/m_⊥): how low the centre of mass of a vehicle without spin has to be, metres. It is not
    /// above zero where the fluid turns the vehicle back by itself.
    ///
    /// m_∥ is the mass along the course, m_⊥ that along the axis which the fluid turns into it. Sources: Leonard
    /// (1997), level course of a bottom-heavy ellipsoid. Leonard and Marsden, *Stability and drift of underwater
    /// vehicle dynamics: mechanical systems with rigid motion symmetry*, Physica D 105 (1997) 130–162, steady rise.
    pub fn critical_offset(&self) -> f64 {
        self.fluid_moment() / self.vehicle.weight()
    }

    /// (J₃Ω*)² = 4J P² (1/m_∥ − 1/m_⊥), rad/s: the spin that holds a rise without ballast, as it holds a sleeping top.
    pub fn critical_spin(&self) -> f64 {
        2.0 * (self.vehicle.moments.y * self.fluid_moment().max(0.0)).sqrt() / self.vehicle.moments.z
    }

    /// P² (1/m_∥ − 1/m_⊥), Munk's moment for a small tilt, N·m.
    fn fluid_moment(&self) -> f64 {
        let masses = self.vehicle.masses;
        let (along, across) = match self.course {
            Course::Cruise => (masses.x, masses.z),
            Course::Rise => (masses.z, masses.x),
        };
        (along * self.speed).powi(2) * (1.0 / along - 1.0 / across)
    }

    /// The small oscillations of the third axis about the vertical.
    pub fn oscillation(&self) -> Oscillation {
        let Vehicle { mass, offset, masses, moments, .. } = self.vehicle;
        // The momentum P is constant in space, so a turn about the second axis drags the ballast against m₁.
        let inertia = moments.y - (mass * offset).powi(2) / masses.x;
        Oscillation {
            gyration: moments.z * self.spin / inertia,
            stiffness: (self.vehicle.weight() * offset - self.fluid_moment()) / inertia,
            pull: ((self.vehicle.weight() * offset).abs() + self.fluid_moment().abs()) / inertia,
        }
    }

    /// Pose and momentum of the steady motion, turned by `tilt` (radians) about the second body axis. The linear
    /// momentum in space is that of the steady motion, so that only the tilt is perturbed.
    pub fn tilted(&self, tilt: f64) -> (Matrix4<f64>, Vector6<f64>) {
        let rotation = Rotation3::from_axis_angle(&Vector3::y_axis(), tilt);
        let direction = if self.course == Course::Cruise { Vector3::x() } else { Vector3::z() };
        let momentum = direction.component_mul(&self.vehicle.masses) * self.speed;
        let v = (rotation.inverse() * momentum).component_div(&self.vehicle.masses);
        let velocity = Vector6::new(0.0, 0.0, self.spin, v.x, v.y, v.z);
        (rotation.to_homogeneous(), self.vehicle.inertia() * velocity)
    }
}

/// D²γ = i g Dγ − k γ, for the tilt γ = Γ₁ + iΓ₂ and its rate as seen from space, Dγ = −ω₂ + iω₁. Γ = Rᵀe₃ is the
/// vertical in the body.
///
/// Follows from Kirchhoff's equations linearised about the steady motion, with P constant in space. For a rise (J −
/// m²l²/m₁) D²γ = iJ₃Ω Dγ − (W l − P²(1/m₃ − 1/m₁)) γ. On a level course the pitch obeys the same with Ω = 0, and 1 and
/// 3 exchanged in the bracket.
#[derive(Clone, Copy, Debug)]
pub struct Oscillation {
    /// g, 1/s.
    pub gyration: f64,
    /// k, 1/s²: the stiffness by the ballast less that by the fluid.
    pub stiffness: f64,
    /// Both added, 1/s².
    pub pull: f64,
}

impl Oscillation {
    /// The roots of s² = i g s − k, that with the larger real part first: γ is a sum of exp(s t).
    pub fn roots(&self) -> [Complex<f64>; 2] {
        let root = Complex::new(-self.gyration.powi(2) - 4.0 * self.stiffness, 0.0).sqrt();
        [root, -root].map(|root| (Complex::new(0.0, self.gyration) + root) / 2.0)
    }

    /// How fast a tilt grows, 1/s; zero where it does not.
    pub fn growth(&self) -> f64 {
        self.roots()[0].re
    }

    /// The part of a tilt that grows like exp(s₁ t): Dγ − s₂ γ.
    pub fn growing_part(&self, tilt: Complex<f64>, rate: Complex<f64>) -> f64 {
        (rate - self.roots()[1] * tilt).modulus()
    }

    /// How large the entries of the linear system are, 1/s.
    pub fn size(&self) -> f64 {
        self.pull.sqrt().max(self.gyration.abs())
    }

    /// How far a relative change of those entries, times the size, moves the roots: large near the threshold, where they meet.
    pub fn condition(&self) -> f64 {
        let [first, second] = self.roots();
        2.0 * self.size() / (first - second).modulus()
    }

    /// The largest tilt over the first one, where that began at rest and nothing grows.
    pub fn largest(&self) -> f64 {
        let [first, second] = self.roots();
        (first.modulus() + second.modulus()) / (first - second).modulus()
    }
}
