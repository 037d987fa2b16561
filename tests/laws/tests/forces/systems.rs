//! Systems on which forces act, each by another way through the compiler.

use clebsch::Clebsch;
use nalgebra::Vector3;

/// Damping and a torque, the Lagrangian discretised by Cayley's map.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<3>, R: SO<3>| R * F,
    lagrangian = |omega| omega.dot(&self.moments.component_mul(&omega)) / 2,
    force      = |omega, torque: Vector3| torque - self.damping * omega,
)]
pub struct Damped {
    pub moments: Vector3<f64>,
    pub damping: f64,
}

/// A declared cost, a drag that is not linear, a wind that turns with the time, and a potential.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, R: SO<3>| R * F,
    cost      = |h, F| (Matrix3::from_diagonal(&self.mass) * (F - I) * (F - I).transpose()).trace() / (2 * h),
    potential = |R| self.weight * R[(2, 2)],
    force     = |t, R, omega| R.transpose() * Vector3::new(t.cos(), t.sin(), 0) - self.drag * omega.norm_squared() * omega,
)]
pub struct Windy {
    pub mass: Vector3<f64>,
    pub weight: f64,
    pub drag: f64,
}

/// The logarithm as velocity.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<3>, R: SO<3>| R * F,
    lagrangian     = |omega| omega.dot(&self.moments.component_mul(&omega)) / 2,
    discretization = exponential,
    force          = |omega, torque: Vector3| torque - self.damping * omega,
)]
pub struct DampedByLogarithm {
    pub moments: Vector3<f64>,
    pub damping: f64,
}

/// A tuple of inputs, and a tuple of a torque and a force.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SE<3>, q: SE<3>| q * F,
    lagrangian = |(omega, v)| (omega.dot(&self.inertia.component_mul(&omega)) + v.dot(&self.mass.component_mul(&v))) / 2,
    force      = |(omega, v), (fins, propeller): (Vector3, Vector1)| (fins - self.drag * omega, vector![propeller.x, 0, 0] - self.drag * v),
)]
pub struct Vehicle {
    pub inertia: Vector3<f64>,
    pub mass: Vector3<f64>,
    pub drag: f64,
}

/// Two substeps: a discrete Lagrangian that is not time-symmetric.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, R: SO<3>| R * F,
    cost      = |h, F| {
        let kinetic = (Matrix3::from_diagonal(&self.mass) * (F - I) * (F - I).transpose()).trace() / (2 * h);
        kinetic + self.skew * (F[(1, 0)] - F[(0, 1)]).powi(3) / h
    },
    force     = |omega, torque: Vector3| torque - self.damping * omega,
)]
pub struct Composed {
    pub mass: Vector3<f64>,
    pub skew: f64,
    pub damping: f64,
}

/// A force on the configuration: friction and wind on a bob.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost      = |h, F| (F - I).norm_squared() / (4 * h),
    potential = |q| self.gravity * q.z,
    force_on  = |q, omega, wind: Vector3| wind - self.drag * omega.cross(&q),
)]
pub struct Bob {
    pub gravity: f64,
    pub drag: f64,
}

/// Both kinds of force, on a product; drag on a translation is linear.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |(a, F): (Translation<3>, SO<3>), (x, R): (Vector3, SO<3>)| (x + a, R * F),
    cost      = |h, (a, F)| (self.mass * a.norm_squared() + (Matrix3::from_diagonal(&self.moment) * (F - I) * (F - I).transpose()).trace()) / (2 * h),
    force     = |(v, omega)| (-self.drag * v, -self.drag * omega),
    force_on  = |(x, R), thrust: Vector3| (R * thrust, R * 0),
)]
pub struct Rocket {
    pub mass: f64,
    pub moment: Vector3<f64>,
    pub drag: f64,
}

/// Viscous friction inside the body: it takes energy and no momentum.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<3>, R: SO<3>| R * F,
    lagrangian = |omega| omega.dot(&self.moments.component_mul(&omega)) / 2,
    force      = |omega| {
        let pi = self.moments.component_mul(&omega);
        self.loss * pi.cross(&pi.cross(&omega))
    },
)]
pub struct Sloshing {
    pub moments: Vector3<f64>,
    pub loss: f64,
}

/// Friction of the pivot that does not act about the vertical: one momentum is left.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, R: SO<3>| R * F,
    cost      = |h, F| (Matrix3::from_diagonal(&self.mass) * (F - I) * (F - I).transpose()).trace() / (2 * h),
    potential = |R| self.weight * R[(2, 2)],
    force     = |R, omega| {
        let vertical = R.transpose() * Vector3::z();
        self.friction * vertical.cross(&vertical.cross(&omega))
    },
)]
pub struct Pivoted {
    pub mass: Vector3<f64>,
    pub weight: f64,
    pub friction: f64,
}

/// Gravity gradient, damping and a commanded torque on a circular orbit.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<3>, R: SO<3>| R * F,
    lagrangian     = |omega| omega.dot(&self.moments.component_mul(&omega)) / 2,
    discretization = moser_veselov,
    potential      = |t, R| {
        let phase = self.orbital_rate * t;
        let zenith = R.transpose() * Vector3::new(phase.cos(), phase.sin(), 0);
        3 * self.orbital_rate.powi(2) / 2 * zenith.dot(&self.moments.component_mul(&zenith))
    },
    force          = |t, omega, torque: Vector3| torque * (self.orbital_rate * t).cos() - self.damping * omega,
)]
pub struct Satellite {
    pub moments: Vector3<f64>,
    pub orbital_rate: f64,
    pub damping: f64,
}

/// First order: all of the force at the end of the step.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<3>, R: SO<3>| R * F,
    lagrangian = |omega| omega.dot(&self.moments.component_mul(&omega)) / 2,
    force      = |omega, torque: Vector3| torque - self.damping * omega,
    order      = 1,
)]
pub struct DampedLate {
    pub moments: Vector3<f64>,
    pub damping: f64,
}

/// A drive that pulls the more the faster it goes, past the speed that it is set to.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |a: Translation<1>, x: Vector1| x + a,
    cost   = |h, a| self.mass * a.norm_squared() / (2 * h),
    force  = |v| self.gain * (v - self.speed * Vector1::x()),
)]
pub struct RunAway {
    pub mass: f64,
    pub gain: f64,
    pub speed: f64,
}

/// On top of a hill −kx²/2, the potential at the midpoint of the step.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |a: Translation<1>, x: Vector1| x + a,
    cost   = |h, x, a| self.mass * a.norm_squared() / (2 * h) + h * self.slope * (x + a / 2).norm_squared() / 2,
)]
pub struct Hill {
    pub mass: f64,
    pub slope: f64,
}
