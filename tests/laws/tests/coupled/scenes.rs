//! The scenes: systems over any scalar, with random starts in numbers that `f32` has.

use std::cell::RefCell;

use clebsch::{Clebsch, Conserved, Conserves, Real, Scalar, Space, Stepper};
use clebsch_tests::oracle::random::Random;
use nalgebra::{Matrix3, Matrix4, Quaternion, SVector, Vector1, Vector3, Vector6};

/// The most steps of a run, and the longest time: longer motions are chaotic, and tell rounding from nothing.
const STEPS: usize = 200;
const TIME: f64 = 2.0;

/// The results of a run.
pub struct Run {
    /// The conserved momenta at the start and at the end.
    pub conserved: [Vec<f64>; 2],
    /// The numbers of the last state.
    pub end: Vec<f64>,
}

/// A system over any scalar, with random parameters and a random start.
pub trait Scene {
    /// A run with steps of the size h.
    fn run<T: Real>(seed: u64, h: f64) -> Run;
}

fn numbers<T: Real>(space: &impl Space<T>) -> Vec<f64> {
    let found = RefCell::new(Vec::new());
    space.all(|x| {
        found.borrow_mut().push(x.to_f64());
        true
    });
    found.into_inner()
}

fn followed<T, S, const K: usize>(stepper: Stepper<S>, q: S::Configuration, mu: S::Momentum) -> Run
where
    T: Real,
    S: Conserves<Conserved = Conserved<T, K>> + Clebsch<Scalar = T>,
{
    let start = stepper.state(q, mu).expect("a state");
    let end = stepper
        .advance(&start, STEPS.min((TIME / stepper.step_size().to_f64()).round() as usize))
        .expect("solvable steps");
    let conserved = [&start, &end].map(|state| stepper.conserved(state).values().iter().map(|x| x.to_f64()).collect());
    Run { conserved, end: [numbers(end.configuration()), numbers(&end.momentum())].concat() }
}

/// The number that `f32` has for another.
fn number<T: Real>(x: f64) -> T {
    T::from_f64(f64::from(x as f32))
}

/// Random numbers that `f32` has.
struct Numbers(Random);

impl Numbers {
    fn new(seed: u64) -> Numbers {
        Numbers(Random::new(seed))
    }

    fn number<T: Real>(&mut self, low: f64, high: f64) -> T {
        number(self.0.between(low, high))
    }

    fn positive<T: Real>(&mut self) -> T {
        self.number(0.5, 2.0)
    }

    fn vector<T: Real, const N: usize>(&mut self) -> SVector<T, N> {
        SVector::from_fn(|_, _| self.number(-1.0, 1.0))
    }

    /// A unit vector along an axis, and a momentum that moves it.
    fn point<T: Real>(&mut self) -> (Vector3<T>, Vector3<T>) {
        let axis = self.0.between(0.0, 2.999) as usize;
        let mut momentum = self.vector();
        momentum[axis] = T::zero();
        (Vector3::ith(axis, if self.0.number() < 0.0 { -T::one() } else { T::one() }), momentum)
    }

    /// A turn by multiples of a right angle.
    fn attitude<T: Real>(&mut self) -> Matrix3<T> {
        let [x, y, z] = [Vector3::x(), Vector3::y(), Vector3::z()];
        let turns = [[x, y, z], [y, z, x], [z, x, y], [-y, x, z]];
        Matrix3::from_columns(&turns[self.0.between(0.0, 3.999) as usize]).map(T::from_f64)
    }
}

/// Two points that a spring joins: nothing couples in the cost.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |(F, G): (SO<3>, SO<3>), (p, q): (Unit<Vector3>, Unit<Vector3>)| (F * p, G * q),
    cost      = |h, (F, G)| (self.masses[0] * (F - I).norm_squared() + self.masses[1] * (G - I).norm_squared()) / (4 * h),
    potential = |(p, q)| self.gravity * (p.z + q.z) + self.masses[0] * (p - q).norm_squared(),
)]
pub struct Springs<T: Scalar> {
    masses: [T; 2],
    gravity: T,
}

pub struct Separate;

impl Scene for Separate {
    fn run<T: Real>(seed: u64, h: f64) -> Run {
        let mut random = Numbers::new(seed);
        let system = Springs { masses: [random.positive(), random.positive()], gravity: random.positive() };
        let ((p, a), (q, b)) = (random.point(), random.point());
        followed(
            system.into_stepper(number::<T>(h)).expect("a system"),
            (p, q),
            Vector6::from_iterator(a.iter().chain(&b).copied()),
        )
    }
}

/// Two bobs in series: the mass matrix depends on the angle between the rods.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |(F, G): (SO<3>, SO<3>), (p, q): (Unit<Vector3>, Unit<Vector3>)| (F * p, G * q),
    cost      = |h, (p, q), (F, G)| {
        let lower = self.masses[1];
        let separate = (self.masses[0] + lower) * (F - I).norm_squared() / 2 + lower * (G - I).norm_squared() / 2;
        (separate + 2 * lower * (F * p - p).dot(&(G * q - q))) / (2 * h)
    },
    potential = |(p, q)| self.gravity * ((self.masses[0] + self.masses[1]) * p.z + self.masses[1] * q.z),
)]
pub struct TwoBobs<T: Scalar> {
    masses: [T; 2],
    gravity: T,
}

pub struct Pendulums;

impl Scene for Pendulums {
    fn run<T: Real>(seed: u64, h: f64) -> Run {
        let mut random = Numbers::new(seed);
        let system = TwoBobs { masses: [random.positive(), random.positive()], gravity: random.positive() };
        let ((p, a), (q, b)) = (random.point(), random.point());
        followed(
            system.into_stepper(number::<T>(h)).expect("a system"),
            (p, q),
            Vector6::from_iterator(a.iter().chain(&b).copied()),
        )
    }
}

/// Three bobs in series, of one mass.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: [SO<3>; 3], q: [Unit<Vector3>; 3]| [F[0] * q[0], F[1] * q[1], F[2] * q[2]],
    cost      = |h, q, F| {
        let separate = 3 * (F[0] - I).norm_squared() + 2 * (F[1] - I).norm_squared() + (F[2] - I).norm_squared();
        let lower = (F[0] * q[0] - q[0] + F[1] * q[1] - q[1]).dot(&(F[2] * q[2] - q[2]));
        let both = 2 * (F[0] * q[0] - q[0]).dot(&(F[1] * q[1] - q[1])) + lower;
        self.mass * (separate / 2 + 2 * both) / (2 * h)
    },
    potential = |q| self.gravity * (3 * q[0].z + 2 * q[1].z + q[2].z),
)]
pub struct ThreeBobs<T: Scalar> {
    mass: T,
    gravity: T,
}

pub struct Chain;

impl Scene for Chain {
    fn run<T: Real>(seed: u64, h: f64) -> Run {
        let mut random = Numbers::new(seed);
        let system = ThreeBobs { mass: random.positive(), gravity: random.positive() };
        let points: [_; 3] = std::array::from_fn(|_| random.point());
        let mu = SVector::<T, 9>::from_iterator(points.iter().flat_map(|(_, momentum)| momentum.iter().copied()));
        followed(system.into_stepper(number::<T>(h)).expect("a system"), points.map(|(point, _)| point), mu)
    }
}

/// A bob on a cart that slides along x.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |(a, F): (Translation<1>, SO<3>), (x, q): (Vector1, Unit<Vector3>)| (x + a, F * q),
    cost      = |h, (x, q), (a, F)| {
        let separate = (self.cart + self.bob) * a.norm_squared() + self.bob * (F - I).norm_squared() / 2;
        (separate + 2 * self.bob * a.x * (F * q - q).x) / (2 * h)
    },
    potential = |(x, q)| self.gravity * self.bob * q.z,
)]
pub struct BobOnCart<T: Scalar> {
    cart: T,
    bob: T,
    gravity: T,
}

pub struct Cart;

impl Scene for Cart {
    fn run<T: Real>(seed: u64, h: f64) -> Run {
        let mut random = Numbers::new(seed);
        let system = BobOnCart { cart: random.positive(), bob: random.positive(), gravity: random.positive() };
        let (q, b) = random.point();
        let (x, a): (Vector1<T>, Vector1<T>) = (random.vector(), random.vector());
        let mu = SVector::<T, 4>::from_iterator(a.iter().chain(&b).copied());
        followed(system.into_stepper(number::<T>(h)).expect("a system"), (x, q), mu)
    }
}

/// The heavy top, in whose cost nothing couples.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, R: SO<3>| R * F,
    cost      = |h, F| (self.mass_matrix * (F - I) * (F - I).transpose()).trace() / (2 * h),
    potential = |R| self.weight * (R * self.center).z,
    // as costs that couple are solved: the scalar unknown of this one would leave less rounding
    solver    = newton,
)]
pub struct HeavyTop<T: Scalar> {
    mass_matrix: Matrix3<T>,
    weight: T,
    center: Vector3<T>,
}

pub struct Top;

impl Scene for Top {
    fn run<T: Real>(seed: u64, h: f64) -> Run {
        let mut random = Numbers::new(seed);
        let mass_matrix = Matrix3::from_diagonal(&Vector3::from_fn(|_, _| random.positive()));
        let system = HeavyTop { mass_matrix, weight: random.positive(), center: random.vector() };
        followed(system.into_stepper(number::<T>(h)).expect("a system"), random.attitude(), random.vector())
    }
}

/// A midpoint rule for the potential of a top, which stands in the cost.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, R: SO<3>| R * F,
    cost   = |h, R, F| {
        let kinetic = (self.mass_matrix * (F - I) * (F - I).transpose()).trace() / (2 * h);
        let height = ((R + R * F) / 2 * self.center).z;
        kinetic - h * (self.weight * height + height.powi(2) / 2)
    },
)]
pub struct MidpointTop<T: Scalar> {
    mass_matrix: Matrix3<T>,
    weight: T,
    center: Vector3<T>,
}

pub struct Midpoint;

impl Scene for Midpoint {
    fn run<T: Real>(seed: u64, h: f64) -> Run {
        let mut random = Numbers::new(seed);
        let mass_matrix = Matrix3::from_diagonal(&Vector3::from_fn(|_, _| random.positive()));
        let system = MidpointTop { mass_matrix, weight: random.positive(), center: random.vector() };
        followed(system.into_stepper(number::<T>(h)).expect("a system"), random.attitude(), random.vector())
    }
}

/// A body to which an inertia about the vertical is attached, by one discretization of the velocity or the other.
#[rustfmt::skip]
macro_rules! attached {
    ($name:ident, $scene:ident, $discretization:ident) => {
        #[derive(Clebsch, Clone, Debug)]
        #[clebsch(
            action         = |F: SO<3>, R: SO<3>| R * F,
            lagrangian     = |R, omega| omega.dot(&self.inertia.component_mul(&omega)) / 2 + self.added * (R * omega).z.powi(2) / 2,
            potential      = |R| self.weight * (R * Vector3::x()).z,
            discretization = $discretization,
        )]
        pub struct $name<T: Scalar> {
            inertia: Vector3<T>,
            added: T,
            weight: T,
        }

        pub struct $scene;

        impl Scene for $scene {
            fn run<T: Real>(seed: u64, h: f64) -> Run {
                let mut random = Numbers::new(seed);
                let inertia = Vector3::from_fn(|_, _| random.positive());
                let system = $name { inertia, added: random.positive(), weight: random.positive() };
                followed(system.into_stepper(number::<T>(h)).expect("a system"), random.attitude(), random.vector())
            }
        }
    };
}

attached!(AttachedByCayley, Attached, cayley);
attached!(AttachedByExponential, Exponential, exponential);

/// A body whose inertia depends on its attitude, as a unit quaternion.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SU<2>, Q: SU<2>| Q * F,
    cost   = |h, Q, F| (self.inertia + (Q * Vector3::z()).z + (Q * F * Vector3::z()).z) * (F - I).norm_squared() / h,
)]
pub struct Spin<T: Scalar> {
    inertia: T,
}

pub struct Quaternions;

impl Scene for Quaternions {
    fn run<T: Real>(seed: u64, h: f64) -> Run {
        let mut random = Numbers::new(seed);
        let system = Spin { inertia: random.number(2.5, 5.0) };
        let q = Quaternion::new(T::one(), T::zero(), T::zero(), T::zero());
        followed(system.into_stepper(number::<T>(h)).expect("a system"), q, random.vector())
    }
}

/// A body in space whose inertia depends on its attitude.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SE<3>, q: SE<3>| q * F,
    cost   = |h, q, F| (self.mass + q[(2, 2)] + (q * F)[(2, 2)]) * (F - I).norm_squared() / (4 * h),
)]
pub struct Flying<T: Scalar> {
    mass: T,
}

pub struct Shifted;

impl Scene for Shifted {
    fn run<T: Real>(seed: u64, h: f64) -> Run {
        let mut random = Numbers::new(seed);
        let system = Flying { mass: random.number(2.5, 5.0) };
        let mut q = Matrix4::identity();
        q.fixed_view_mut::<3, 3>(0, 0).copy_from(&random.attitude());
        q.fixed_view_mut::<3, 1>(0, 3).copy_from(&random.vector::<T, 3>());
        followed(system.into_stepper(number::<T>(h)).expect("a system"), q, random.vector())
    }
}
