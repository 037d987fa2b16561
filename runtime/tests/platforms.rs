//! The same bits on every platform: without the feature `std`, a run takes nothing from the platform but IEEE 754 arithmetic.
//!
//! The numbers below were printed by this test. They pin that platforms agree, and a change of any formula changes them; whether results are
//! right is for other tests to say. `tests/miri/check` runs this one for processors of other kinds: of 32 bits, and of the other byte order.
#![cfg(not(feature = "std"))]

use clebsch::{Clebsch, Real, Scalar, Space, State, Time};
use nalgebra::{Matrix3, Vector3};
use std::cell::Cell;

/// A body that turns freely: Newton's method.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<3>, R: SO<3>| R * F,
    lagrangian     = |omega| omega.dot(&(self.inertia * omega)) / 2,
    discretization = moser_veselov,
)]
pub struct FreeBody<T: Scalar> {
    /// Inertia tensor, kg·m².
    #[clebsch(symmetric)]
    pub inertia: Matrix3<T>,
}

/// A heavy top.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, R: SO<3>| R * F,
    cost      = |h, F| (self.mass_matrix * (F - I) * (F - I).transpose()).trace() / (2 * h),
    potential = |R| self.weight * (R * self.center).z,
)]
pub struct Top<T: Scalar> {
    /// ½tr(J)I − J, kg·m².
    #[clebsch(symmetric)]
    pub mass_matrix: Matrix3<T>,
    /// m·g, newtons.
    pub weight: T,
    /// Centre of mass in the body frame, metres.
    pub center: Vector3<T>,
}

/// A pendulum in a wind that comes and goes: elementary functions, and time.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost      = |h, F| self.mass * (F - I).norm_squared() / (4 * h),
    potential = |t, q| self.mass * self.gravity * q.z + (self.wind * t).sin() * q.x.exp() + (2 + q.y).ln() * (3 + q.z).powf(self.wind),
)]
pub struct Pendulum<T: Scalar> {
    /// Mass, kg; the rod has length one.
    pub mass: T,
    /// g, m/s².
    pub gravity: T,
    /// Its angular frequency, rad/s.
    pub wind: T,
}

/// A top by exact turns and kicks: roots and series.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<3>, R: SO<3>| R * F,
    lagrangian     = |omega| omega.dot(&(Matrix3::from_diagonal(&self.moments) * omega)) / 2,
    discretization = exact,
    potential      = |R| self.weight * R[(2, 2)],
    order          = 4,
)]
pub struct SplitTop<T: Scalar> {
    /// Principal moments of inertia, kg·m².
    pub moments: Vector3<T>,
    /// m·g·l, newton metres.
    pub weight: T,
}

/// Steps of the runs; Miri interprets, and makes the shorter ones.
const STEPS: [usize; 3] = [2, 20, 1000];

/// FNV-1a of the bits of all states after the first, their energies and times.
fn digest<S: Clebsch<Scalar: Real>>(system: S, q: S::Configuration, mu: S::Momentum, steps: usize) -> u64 {
    let hash = Cell::new(0xcbf2_9ce4_8422_2325_u64);
    let add = |x: S::Scalar| {
        let bytes = x.to_f64().to_bits().to_le_bytes();
        let add = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        hash.set(bytes.into_iter().fold(hash.get(), add));
        true
    };
    let stepper = system.into_stepper(S::Scalar::from_ratio(1, 32)).expect("a regular system");
    let mut state: State<S> = stepper.state(q, mu).expect("a state");
    let mut time = S::Time::at(S::Scalar::from_ratio(0, 1));
    for _ in 0..steps {
        state = stepper.step(&state).expect("a step");
        time = time.after_step(stepper.step_size());
        let _ = state.configuration().all(add) & state.momentum().all(add);
        let _ = add(stepper.energy(&state)) & add(time.now());
    }
    hash.get()
}

fn number<T: Scalar>(value: f64) -> T {
    T::from_f64(value)
}

fn inertia<T: Real>() -> Matrix3<T> {
    Matrix3::new(1.0, 0.125, 0.0, 0.125, 1.5, -0.25, 0.0, -0.25, 2.0).map(number)
}

fn vector<T: Real>(x: f64, y: f64, z: f64) -> Vector3<T> {
    Vector3::new(number(x), number(y), number(z))
}

/// The digests of all scenes in the order in which they are declared.
fn digests<T: Real>(steps: usize) -> [u64; 4] {
    let mass_matrix = inertia::<T>();
    let momentum = vector(0.5, -1.25, 0.75);
    let attitude = Matrix3::new(0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0).map(number);
    let top = Top { mass_matrix, weight: number(9.81), center: vector(0.1, -0.2, 0.3) };
    let pendulum = Pendulum { mass: number::<T>(1.25), gravity: number(9.81), wind: number(1.3) };
    let split = SplitTop { moments: vector::<T>(1.0, 1.5, 2.0), weight: number(1.7) };
    [
        digest(FreeBody { inertia: inertia::<T>() }, attitude, momentum, steps),
        digest(top, attitude, momentum, steps),
        digest(pendulum, vector(0.0, 1.0, 0.0), vector(0.5, 0.0, -0.25), steps),
        digest(split, attitude, momentum, steps),
    ]
}

/// Those of `digests` after so many steps of both lengths.
const DOUBLE: [[u64; 4]; 3] = [
    [0x09f3_54bf_e3fe_56b3, 0x3712_5c7f_4c83_76b4, 0x9e56_76fa_0eee_e519, 0x950d_8ed8_2768_044a],
    [0xbd14_1f06_dc1d_a45b, 0x4ee4_cf04_a931_48e8, 0x1951_d886_608e_fb02, 0x8e1a_c305_4d71_f4c3],
    [0xc105_b71b_b2fc_066a, 0xa689_472e_3f21_c3fd, 0x9c70_1763_103f_e5d6, 0x7995_18e9_76e6_47b0],
];
const SINGLE: [[u64; 4]; 3] = [
    [0x6f36_db2e_daf3_a369, 0xb1d7_6d29_a4c1_2f70, 0xd196_43be_8f67_16f2, 0x817a_07ac_37a7_d3ea],
    [0x3deb_875d_53ca_cc2f, 0x608c_2970_714b_2680, 0x15b2_7c4d_3dfd_6f73, 0x0836_bf94_8fde_82ff],
    [0x8e0a_8ad2_8b95_e8da, 0xf0fd_ca33_898c_3c2a, 0xe0e3_1487_013b_9ef3, 0x83e2_6a83_e17f_21ff],
];

fn check(length: usize) {
    let steps = STEPS[length];
    let (double, single) = (digests::<f64>(steps), digests::<f32>(steps));
    println!("{steps} steps: {double:#018x?}, {single:#018x?}");
    assert_eq!(double, DOUBLE[length], "double precision, {steps} steps");
    assert_eq!(single, SINGLE[length], "single precision, {steps} steps");
}

#[test]
fn short_runs_have_the_same_bits_everywhere() {
    assert_eq!(digests::<f64>(STEPS[0]), DOUBLE[0]);
    if !cfg!(miri) {
        check(0);
    }
}

#[test]
fn every_platform_has_the_same_bits() {
    check(1);
    if !cfg!(miri) {
        check(2);
    }
}

/// Eight bodies in lanes have the bits that each has alone, on processors without such registers too.
#[cfg(feature = "lanes")]
#[test]
fn lanes_have_the_same_bits() {
    use clebsch::F64x8;
    let weight = |lane: usize| 9.0 + lane as f64 / 8.0;
    let lanes = Top {
        mass_matrix: inertia::<f64>().map(F64x8::splat),
        weight: F64x8::from_lanes(weight),
        center: vector::<f64>(0.1, -0.2, 0.3).map(F64x8::splat),
    };
    let (q, mu) = (Matrix3::identity(), vector::<f64>(0.5, -1.25, 0.75));
    let stepper = lanes.into_stepper(F64x8::splat(0.03125)).expect("tops");
    let start = stepper.state(q.map(F64x8::splat), mu.map(F64x8::splat)).expect("states");
    let last = stepper.advance(&start, STEPS[1]).expect("steps");
    for lane in 0..8 {
        let top = Top { mass_matrix: inertia(), weight: weight(lane), center: vector(0.1, -0.2, 0.3) };
        let alone = top.into_stepper(0.03125).expect("a top");
        let end = alone.advance(&alone.state(q, mu).expect("a state"), STEPS[1]).expect("steps");
        assert_eq!(last.lane(lane), end.into_parts(), "lane {lane}");
    }
}
