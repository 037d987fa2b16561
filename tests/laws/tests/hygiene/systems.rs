/// In m/s².
const GRAVITY: f64 = 9.81;

/// An implicit equation and kicks.
#[derive(::clebsch::Clebsch, ::core::clone::Clone, ::core::fmt::Debug)]
#[clebsch(
    action    = |F: SO<3>, R: SO<3>| R * F,
    cost      = |h, F| (self.mass_matrix * (F - I) * (F - I).transpose()).trace() / (2 * h),
    potential = |R| self.weight * (R * self.center).z,
    emit      = [generated, latex],
)]
pub struct Top {
    /// In kg·m².
    pub mass_matrix: ::nalgebra::Matrix3<f64>,
    /// In N.
    pub weight: f64,
    /// In m.
    pub center: ::nalgebra::Vector3<f64>,
}

/// Along free motions.
pub struct Fine;

/// Composed, of steps that are solved.
pub struct Composed;

/// Generic, by its Lagrangian, with methods.
#[derive(::clebsch::Clebsch, ::core::clone::Clone, ::core::fmt::Debug)]
#[clebsch(
    action         = |F: SO<3>, R: SO<3>| R * F,
    lagrangian     = |omega| omega.dot(&(self.inertia * omega)) / 2,
    discretization = moser_veselov,
    method Fine     = (discretization = exact),
    method Composed = (order = 4, tolerance = 1e-9, summation = compensated),
)]
pub struct Body<T: ::clebsch::Scalar> {
    /// In kg·m².
    #[clebsch(symmetric)]
    pub inertia: ::nalgebra::Matrix3<T>,
}

/// Arrays in a tuple; a root and a function in the potential; some equations explicit.
#[derive(::clebsch::Clebsch, ::core::clone::Clone, ::core::fmt::Debug)]
#[clebsch(
    action    = |(F, a): ([SO<3>; 2], Translation<3>), (q, x): ([Unit<Vector3>; 2], Vector3)| ([F[0] * q[0], F[1] * q[1]], x + a),
    cost      = |h, (F, a)| {
        let turning = (0..2).map(|i| self.mass[i] * (F[i] - I).norm_squared()).sum();
        (turning + a.norm_squared()) / (4 * h)
    },
    potential = |(q, x)| self.coupling * (q[0].dot(&q[1]) + x.norm_squared() + 1 / 3).sqrt() + q[0].dot(&x).sin(),
)]
pub struct Pair {
    /// In kg.
    pub mass: [f64; 2],
    /// In J.
    pub coupling: f64,
}

/// A constant of the module; fields without names.
#[derive(::clebsch::Clebsch, ::core::clone::Clone, ::core::fmt::Debug)]
#[clebsch(
    action    = |F: SO<2>, q: Unit<Vector2>| F * q,
    cost      = |h, F| self.1 * self.0.powi(2) * (F - I).norm_squared() / (4 * h),
    potential = |q| self.1 * GRAVITY * self.0 * q.y,
)]
pub struct Pendulum(pub f64, pub f64);

/// Not time-symmetric, so each step is two.
#[derive(::clebsch::Clebsch, ::core::clone::Clone, ::core::fmt::Debug)]
#[clebsch(
    action = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost   = |h, q, F| (F - I).norm_squared() / (4 * h) - h * self.gravity * q.z,
)]
pub struct Lopsided {
    /// In m/s².
    pub gravity: f64,
}

/// Equal sites, generic in their number, each with its own mass, whose sum is conserved; a constant of the module.
#[derive(::clebsch::Clebsch, ::core::clone::Clone, ::core::fmt::Debug)]
#[clebsch(
    action    = |F: [SO<3>; N], q: [Unit<Vector3>; N]| (0..N).map(|i| F[i] * q[i]),
    cost      = |h, F| (0..N).map(|i| self.mass[i] * (F[i] - I).norm_squared()).sum() / (4 * h),
    potential = |q| (0..N).map(|i| (0..i).map(|j| self.mass[j] * GRAVITY * q[i].dot(&q[j])).sum() + (i * q[i].z).sin()).sum() + q[N - 1].z,
    emit      = [generated, latex],
)]
pub struct Sites<const N: ::core::primitive::usize> {
    /// In kg.
    pub mass: [f64; N],
}
