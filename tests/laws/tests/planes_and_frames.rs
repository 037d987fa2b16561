//! Planes as projectors and frames as orthonormal columns, with kinetic energies of their displacement alone.
//!
//! The discrete motion is compared with the constrained difference equation, which knows no group. The continuous one is compared with geodesics
//! in closed form, and with Runge and Kutta's integration of q̈ with multipliers.

#![allow(missing_docs)]

use clebsch::{Clebsch, Conserved, Conserves, Error, State};
use clebsch_tests::fixtures::moving_frame::MovingFrame;
use clebsch_tests::fixtures::rayleigh_plane::RayleighPlane;
use clebsch_tests::oracle::motion::{assert_second_order, errors_of_halved_steps as errors, motion};
use clebsch_tests::oracle::precise::matrix::Matrix;
use clebsch_tests::oracle::random::Random;
use nalgebra::{Matrix2, Matrix3, Matrix3x2, Matrix4, SMatrix, SVector, Vector3, Vector6};

/// A free motion of planes and lines, by the cost of their displacement, and by a Lagrangian in the exponential chart.
macro_rules! planes {
    ($cost:ident, $lagrangian:ident, $n:literal, $k:literal $(, $code:ident)?) => {
        #[derive(Clebsch, Clone, Debug)]
        #[clebsch(
            action = |F: SO<$n>, P: Projector<SMatrix<$n, $n>, $k>| F * P * F.transpose(),
            cost   = |h, P, F| self.mass * (F * P * F.transpose() - P).norm_squared() / (4 * h),
            $(code = $code,)?
        )]
        struct $cost {
            mass: f64,
        }

        #[derive(Clebsch, Clone, Debug)]
        #[clebsch(
            action         = |F: SO<$n>, P: Projector<SMatrix<$n, $n>, $k>| F * P * F.transpose(),
            lagrangian     = |P, xi| self.mass * (xi.matrix() * P - P * xi.matrix()).norm_squared() / 4,
            discretization = exponential,
            $(code = $code,)?
        )]
        struct $lagrangian {
            mass: f64,
        }
    };
}

planes!(Lines3, ExactLines3, 3, 1);
planes!(Planes4, ExactPlanes4, 4, 2);
planes!(Planes5, ExactPlanes5, 5, 2);

/// Frames in a potential, in the metric of the space of matrices.
macro_rules! frames {
    ($name:ident, $n:literal, $k:literal $(, $code:ident)?) => {
        #[derive(Clebsch, Clone, Debug)]
        #[clebsch(
            action    = |F: SO<$n>, X: Orthonormal<SMatrix<$n, $k>>| F * X,
            cost      = |h, X, F| self.mass * (F * X - X).norm_squared() / (2 * h),
            potential = |X| -(self.pull.transpose() * X).trace(),
            $(code = $code,)?
        )]
        struct $name {
            mass: f64,
            pull: SMatrix<f64, $n, $k>,
        }
    };
}

frames!(Frames4, 4, 2);
frames!(Frames5, 5, 2, matrices);

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<4>, X: Orthonormal<Matrix4x2>| F * X,
    cost   = |h, X, F| self.mass * (F * X - X).norm_squared() / (2 * h),
)]
struct FreeFrames {
    mass: f64,
}

/// The metric ½ tr Ẋᵀ(I − ½XXᵀ)Ẋ, whose geodesics are orbits of SO(n).
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<4>, X: Orthonormal<Matrix4x2>| F * X,
    lagrangian     = |X, xi| {
        let velocity = xi.matrix() * X;
        (velocity.norm_squared() - (X.transpose() * velocity).norm_squared() / 2) / 2
    },
    discretization = exponential,
    scalar         = f64,
)]
struct CanonicalFrames;

fn exponential<const N: usize>(a: &SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
    let result = Matrix::from(a).exponential();
    SMatrix::from_fn(|i, j| result[(i, j)])
}

/// The first columns of a random rotation.
fn frame<const N: usize, const K: usize>(random: &mut Random) -> SMatrix<f64, N, K> {
    let rotation = random.rotation::<N>(3.0);
    SMatrix::from_fn(|i, j| rotation[(i, j)])
}

fn skew<const N: usize>(random: &mut Random) -> SMatrix<f64, N, N> {
    let any = random.matrix::<N, N>();
    (any - any.transpose()) * 0.5
}

fn symmetric<const N: usize>(random: &mut Random) -> SMatrix<f64, N, N> {
    let any = random.matrix::<N, N>();
    (any + any.transpose()) * 0.5
}

/// The configuration and the momentum do not leave their spaces. The result is the start and the end.
fn assert_stays<S>(system: &S, (q, mu): (S::Configuration, S::Momentum), steps: usize) -> [State<S>; 2]
where
    S: Clebsch<Scalar = f64, Time = ()> + Clone,
{
    let stepper = system.stepper(0.01).expect("a regular system");
    let start = stepper.state(q, mu).expect("a state");
    let end = stepper.advance(&start, steps).expect("steps");
    let along = system.isotropy_defect(end.configuration(), &end.momentum());
    let off = system.orbit_defect(end.configuration());
    println!("{}: along the isotropy {along:.1e}, off its space {off:.1e}", S::NAME);
    assert!(along < 1e-11, "{}: {along:e} along the isotropy", S::NAME);
    assert!(off < 1e-13, "{}: {off:e} off its space", S::NAME);
    [start, end]
}

/// Momenta are conserved to rounding over these steps.
fn assert_conserves<S, const K: usize>(system: &S, start: (S::Configuration, S::Momentum), steps: usize)
where
    S: Clebsch<Scalar = f64, Time = ()> + Conserves<Conserved = Conserved<f64, K>> + Clone,
{
    let stepper = system.stepper(0.01).expect("a regular system");
    let [before, after] = assert_stays(system, start, steps).map(|state| stepper.conserved(&state));
    let size = before.values().iter().fold(1.0_f64, |size, value| size.max(value.abs()));
    for (name, (before, after)) in before.names().iter().zip(before.values().iter().zip(after.values())) {
        assert!((before - after).abs() < 1e-12 * size, "{} {name}: {before} to {after}", S::NAME);
    }
}

/// A plane, and a horizontal velocity: Pη(I − P) + (I − P)ηP.
fn plane<const N: usize, const K: usize>(random: &mut Random) -> (SMatrix<f64, N, N>, SMatrix<f64, N, N>) {
    let x = frame::<N, K>(random);
    let (p, eta) = (x * x.transpose(), skew::<N>(random));
    let rest = SMatrix::identity() - p;
    (p, p * eta * rest + rest * eta * p)
}

/// P(t) = e^{tξ} P e^{−tξ} for horizontal ξ, whatever n and k.
#[test]
fn planes_move_along_geodesics() {
    macro_rules! check {
        ($cost:ident, $lagrangian:ident, $n:literal, $k:literal) => {
            for seed in [1, 2] {
                let (p, xi) = plane::<$n, $k>(&mut Random::new(seed));
                let mass = 0.6 + 0.3 * seed as f64;
                let turn = exponential(&xi);
                let exact = turn * p * turn.transpose();
                let (by_cost, by_lagrangian) = ($cost { mass }, $lagrangian { mass });
                // ½m⟨Ṗ, ·⟩ is the covector of ¼m|Ṗ|²
                let covector = (xi * p - p * xi) * (mass / 2.0);
                let start = (p, by_cost.momentum_map(&p, &covector));
                let distance = |end: &SMatrix<f64, $n, $n>| (end - exact).norm();
                assert_second_order($cost::NAME, &errors(&by_cost, start, distance));
                for error in errors(&by_lagrangian, start, distance) {
                    assert!(error < 1e-12, "{}: {error:e}", $lagrangian::NAME);
                }
                assert_conserves(&by_cost, start, 1000);
                assert_conserves(&by_lagrangian, start, 1000);
            }
        };
    }
    check!(Lines3, ExactLines3, 3, 1);
    check!(Planes4, ExactPlanes4, 4, 2);
    check!(Planes5, ExactPlanes5, 5, 2);
}

/// The projectors of a stationary discrete action: [P, m(P⁺ + P⁻)/(2h) + hA] = 0, as |P⁺ − P|² is 2k − 2 tr P⁺P.
#[test]
fn steps_of_planes_know_no_group() {
    for seed in [4, 5] {
        let random = &mut Random::new(seed);
        let (p, xi) = plane::<4, 2>(random);
        let system = RayleighPlane { mass: 0.7, form: symmetric(random) };
        let momentum = system.momentum_map(&p, &((xi * p - p * xi) * (system.mass / 2.0)));
        let h = 0.1;
        let stepper = system.stepper(h).expect("a regular system");
        let mut states = vec![stepper.state(p, momentum).expect("a state")];
        for step in 0..100 {
            states.push(stepper.step(&states[step]).expect("a step"));
        }
        for three in states.windows(3) {
            let [before, now, after] = [0, 1, 2].map(|k| three[k].configuration());
            let slope = (after + before) * (system.mass / (2.0 * h)) + system.form * h;
            let off = (now * slope - slope * now).norm();
            assert!(off < 1e-11, "{off:e}");
            assert!((now * now - now).norm() < 1e-13 && (now.trace() - 2.0).abs() < 1e-13);
        }
        let distance = (states[100].configuration() - p).norm();
        assert!(distance > 0.1, "it has moved by {distance}");
    }
}

/// Ẍ of a frame with mass m and the gradient G(X): −G/m + XS with the symmetric S for which XᵀX stays I.
fn acceleration<const N: usize, const K: usize>(
    x: &SMatrix<f64, N, K>,
    v: &SMatrix<f64, N, K>,
    slope: &SMatrix<f64, N, K>,
    mass: f64,
) -> SMatrix<f64, N, K> {
    let along = x.transpose() * slope / mass;
    let multiplier = (along + along.transpose()) * 0.5 - v.transpose() * v;
    x * multiplier - slope / mass
}

/// X(1), from X and Ẋ. `D` is 2NK.
fn moved_frame<const N: usize, const K: usize, const D: usize>(
    (x, v): (SMatrix<f64, N, K>, SMatrix<f64, N, K>),
    slope: impl Fn(&SMatrix<f64, N, K>) -> SMatrix<f64, N, K>,
    mass: f64,
) -> SMatrix<f64, N, K> {
    let part = |y: &SVector<f64, D>, from: usize| SMatrix::<f64, N, K>::from_fn(|i, j| y[from + K * i + j]);
    let both = |x: &SMatrix<f64, N, K>, v: &SMatrix<f64, N, K>| {
        SVector::<f64, D>::from_fn(|k, _| if k < N * K { x[(k / K, k % K)] } else { v[(k / K - N, k % K)] })
    };
    let field = |y: &SVector<f64, D>| {
        let (x, v) = (part(y, 0), part(y, N * K));
        both(&v, &acceleration(&x, &v, &slope(&x), mass))
    };
    part(&motion(field, both(&x, &v), 1.0, 200), 0)
}

/// P = XXᵀ for a frame X with XᵀẊ = 0, ½m|Ẋ|² = ¼m|Ṗ|², in the potential tr XᵀAX.
#[test]
fn planes_move_in_a_potential() {
    for seed in [7, 8] {
        let random = &mut Random::new(seed);
        let x = frame::<4, 2>(random);
        let p = x * x.transpose();
        let v = (Matrix4::identity() - p) * random.matrix::<4, 2>();
        let system = RayleighPlane { mass: 0.7, form: symmetric(random) };
        let end = moved_frame::<4, 2, 16>((x, v), |x| system.form * x * 2.0, system.mass);
        let exact = end * end.transpose();
        let velocity = v * x.transpose() + x * v.transpose();
        let start = (p, system.momentum_map(&p, &(velocity * (system.mass / 2.0))));
        assert_second_order("planes", &errors(&system, start, |end| (end - exact).norm()));
        assert_stays(&system, start, 1000);
    }
}

#[test]
fn frames_move_in_a_potential() {
    macro_rules! check {
        ($name:ident, $n:literal, $k:literal) => {
            for seed in [10, 11] {
                for size in [0.0, 1.0] {
                    let random = &mut Random::new(seed);
                    let x = frame::<$n, $k>(random);
                    let v = skew::<$n>(random) * x;
                    let system = $name { mass: 0.8, pull: random.matrix::<$n, $k>() * size };
                    let exact = moved_frame::<$n, $k, { 2 * $n * $k }>((x, v), |_| -system.pull, system.mass);
                    let start = (x, system.momentum_map(&x, &(v * system.mass)));
                    assert_second_order($name::NAME, &errors(&system, start, |end| (end - exact).norm()));
                    assert_stays(&system, start, 200);
                }
            }
        };
    }
    check!(MovingFrame, 3, 2);
    check!(Frames4, 4, 2);
    // below, its steps obey the discrete equations
    #[cfg(feature = "heavy")]
    check!(Frames5, 5, 2);
}

/// Momenta of frames without a potential.
#[test]
fn free_frames_conserve_their_momentum() {
    for seed in [19, 20] {
        let random = &mut Random::new(seed);
        let x = frame::<4, 2>(random);
        let system = FreeFrames { mass: 1.3 };
        let start = (x, system.momentum_map(&x, &(skew::<4>(random) * x * system.mass)));
        assert_conserves(&system, start, 1000);
    }
}

/// X⁺ − 2X + X⁻ = −h²G/m + XΛ with the symmetric Λ for which X⁺ᵀX⁺ = I: the method of Ryckaert, Ciccotti and Berendsen.
#[test]
fn steps_of_frames_know_no_group() {
    steps_of_frames_from(13);
}

/// The same from another start.
#[test]
fn steps_of_frames_know_no_group_too() {
    steps_of_frames_from(14);
}

fn steps_of_frames_from(seed: u64) {
    macro_rules! check {
        ($name:ident, $n:literal, $k:literal) => {{
            let random = &mut Random::new(seed);
            let x = frame::<$n, $k>(random);
            let system = $name { mass: 0.8, pull: random.matrix::<$n, $k>() };
            let momentum = system.momentum_map(&x, &(skew::<$n>(random) * x * system.mass));
            let h = 0.1;
            let stepper = system.stepper(h).expect("a regular system");
            let mut states = vec![stepper.state(x, momentum).expect("a state")];
            for step in 0..if cfg!(feature = "heavy") { 100 } else { 40 } {
                states.push(stepper.step(&states[step]).expect("a step"));
            }
            for three in states.windows(3) {
                let [before, now, after] = [0, 1, 2].map(|k| three[k].configuration());
                let free = now * 2.0 - before + system.pull * (h * h / system.mass);
                // Λ from the equation itself, which must be symmetric and leave nothing across X
                let force = after - free;
                let multiplier = now.transpose() * force;
                let across = (force - now * multiplier).norm();
                let off = (multiplier - multiplier.transpose()).norm();
                assert!(across < 1e-12 && off < 1e-12, "{}: {across:e}, {off:e}", $name::NAME);
                let length = (after.transpose() * after - Matrix2::identity()).norm();
                assert!(length < 1e-13, "{length:e}");
            }
        }};
    }
    check!(MovingFrame, 3, 2);
    check!(Frames4, 4, 2);
    check!(Frames5, 5, 2);
}

/// X(t) = e^{tξ}X for ξ without a part in 𝔤_X: I − XXᵀ on both sides takes it off.
#[test]
fn frames_move_along_orbits_in_the_canonical_metric() {
    for seed in [16, 17] {
        let random = &mut Random::new(seed);
        let x = frame::<4, 2>(random);
        let (any, rest) = (skew::<4>(random), Matrix4::identity() - x * x.transpose());
        let xi = any - rest * any * rest;
        let velocity = xi * x;
        let covector = velocity - x * (x.transpose() * velocity) * 0.5;
        let start = (x, CanonicalFrames.momentum_map(&x, &covector));
        let exact = exponential(&xi) * x;
        for error in errors(&CanonicalFrames, start, |end| (end - exact).norm()) {
            assert!(error < 1e-12, "{error:e}");
        }
        assert_conserves(&CanonicalFrames, start, 200);
    }
}

/// Other matrices are no states, and the error says by how much they are off.
#[test]
fn states_lie_on_their_spaces() {
    let stepper = Lines3 { mass: 1.0 }.stepper(0.1).expect("a regular system");
    let line = Matrix3::from_diagonal(&Vector3::new(1.0, 0.0, 0.0));
    assert!(stepper.state(line, Vector3::zeros()).is_ok());
    let mut turned = line;
    turned[(0, 1)] = 1e-3;
    let plane = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 0.0));
    for (matrix, expected) in [(turned, 1e-3), (line * 1.25, 0.3125), (plane, 1.0), (Matrix3::zeros(), 1.0)] {
        let error = stepper.state(matrix, Vector3::zeros()).expect_err("no line");
        assert!(error.to_string().contains("make a projector"), "{error}");
        let Error::OffOrbit { defect, .. } = error else { panic!("{error}") };
        assert!((defect - expected).abs() < 1e-12, "{defect} not {expected}");
    }
    let stepper = MovingFrame { mass: 1.0, pull: Matrix3x2::zeros() }.stepper(0.1).expect("a regular system");
    let frame = Matrix3x2::new(0.6, 0.0, 0.0, 1.0, 0.8, 0.0);
    assert!(stepper.state(frame, Vector3::zeros()).is_ok());
    for (matrix, expected) in [(frame * 1.5, 1.25), (Matrix3x2::new(1.0, 0.6, 0.0, 0.8, 0.0, 0.0), 0.6)] {
        let error = stepper.state(matrix, Vector3::zeros()).expect_err("no frame");
        let Error::OffOrbit { defect, .. } = error else { panic!("{error}") };
        assert!((defect - expected).abs() < 1e-12, "{defect} not {expected}");
    }
}

/// A momentum along the isotropy is refused, too.
#[test]
fn momenta_have_no_part_along_the_isotropy() {
    let system = Planes4 { mass: 1.0 };
    let stepper = system.stepper(0.1).expect("a regular system");
    let plane = Matrix4::from_diagonal(&[1.0, 1.0, 0.0, 0.0].into());
    for component in 0..6 {
        let mut momentum = Vector6::zeros();
        momentum[component] = 1.0;
        // planes of e1 and e2, and of e3 and e4, are turned in themselves
        let is_along = component == 0 || component == 5;
        assert_eq!(stepper.state(plane, momentum).is_err(), is_along, "{component}");
    }
}

#[test]
fn derivations_say_what_was_added() {
    for text in [Planes4::DERIVATION, ExactPlanes5::DERIVATION, RayleighPlane::DERIVATION, Frames4::DERIVATION] {
        assert!(text.contains("The vertical term W gives it to them"), "{text}");
    }
    for (text, means) in [(Planes4::DERIVATION, "3P² − 2P³"), (Frames4::DERIVATION, "X(3I − XᵀX)/2")] {
        assert!(text.contains(means), "{text}");
    }
    assert!(!MovingFrame::DERIVATION.contains("vertical term W"), "SO(3) acts freely on two columns");
}
