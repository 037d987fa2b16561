//! Chains with forces and composed steps, against facts that are known otherwise.

use clebsch::{Clebsch, SiteStorage};
use clebsch_tests::oracle::motion::{motion, order};
use clebsch_tests::oracle::random::Random;
use nalgebra::{Matrix3, SVector, Vector1, Vector3};

/// A chain of Fermi, Pasta, Ulam and Tsingou with fixed ends, in a fluid that swings, and pushed.
macro_rules! chain {
    ($name:ident, $order:literal) => {
        #[derive(Clebsch, Clone, Debug)]
        #[clebsch(
            action     = |a: [Translation<1>; N], x: [Vector1; N]| (0..N).map(|i| x[i] + a[i]),
            lagrangian = |v| (0..N).map(|i| v[i].norm_squared()).sum() / 2,
            potential  = |x| (0..N - 1).map(|i| {
                let stretch = x[i + 1].x - x[i].x;
                stretch.powi(2) / 2 + self.cubic * stretch.powi(4) / 4
            }).sum() + (x[0].norm_squared() + x[N - 1].norm_squared()) / 2,
            force      = |t, x, v, push: [Vector1; N]| (0..N).map(|i| push[i] - self.drag[i] * v[i] * (1 + x[i].x.powi(2)) + self.swing * t.sin() * x[i]),
            order      = $order,
        )]
        pub struct $name<const N: usize> {
            pub cubic: f64,
            pub swing: f64,
            pub drag: [f64; N],
        }
    };
}
chain!(Second, 2);
chain!(Fourth, 4);
chain!(Sixth, 6);
chain!(Eighth, 8);

const SITES: usize = 4;
const CUBIC: f64 = 0.8;
const SWING: f64 = 0.2;
const DRAG: [f64; SITES] = [0.1, 0.3, 0.0, 0.2];
const PUSH: [f64; SITES] = [0.2, -0.1, 0.4, 0.0];
const START: [f64; SITES] = [0.5, -0.3, 0.8, 0.1];

/// The equations of motion, with the time as the last number.
fn slopes(y: &SVector<f64, 9>) -> SVector<f64, 9> {
    let place = |i: isize| if (0..SITES as isize).contains(&i) { y[i as usize] } else { 0.0 };
    let pull = |stretch: f64, is_end: bool| stretch + if is_end { 0.0 } else { CUBIC * stretch.powi(3) };
    SVector::from_fn(|k, _| {
        let Some(i) = k.checked_sub(SITES) else { return y[k + SITES] };
        if i == SITES {
            return 1.0;
        }
        let (x, v) = (y[i], y[k]);
        let right = pull(place(i as isize + 1) - x, i + 1 == SITES);
        let left = pull(x - place(i as isize - 1), i == 0);
        right - left + PUSH[i] - DRAG[i] * v * (1.0 + x * x) + SWING * y[8].sin() * x
    })
}

/// The errors at t = 1 for steps that halve, against the equations of motion.
macro_rules! measured {
    ($name:ident, $counts:expr) => {{
        let start = SVector::<f64, 9>::from_fn(|k, _| if k < SITES { START[k] } else { 0.0 });
        let exact = motion(slopes, start, 1.0, 400);
        let errors = $counts.map(|count: u32| {
            let chain = $name::<SITES> { cubic: CUBIC, swing: SWING, drag: DRAG };
            let stepper = chain.into_stepper(1.0 / f64::from(count)).unwrap();
            let mut state = stepper.state(START.map(Vector1::new), [Vector1::zeros(); SITES]).unwrap();
            for _ in 0..count {
                state = stepper.step_with(&state, &PUSH.map(Vector1::new)).unwrap();
            }
            let error = |i: usize| {
                (state.configuration()[i].x - exact[i]).abs().max((state.momentum()[i].x - exact[SITES + i]).abs())
            };
            (0..SITES).map(error).fold(0.0, f64::max)
        });
        (order(&errors), errors.to_vec())
    }};
}

#[test]
fn composed_steps_of_a_chain_have_their_order() {
    let orders = [
        (2.0, measured!(Second, [10, 20, 40, 80])),
        (4.0, measured!(Fourth, [10, 20, 40, 80])),
        (6.0, measured!(Sixth, [4, 8, 16])),
        (8.0, measured!(Eighth, [1, 2, 4])),
    ];
    for (expected, (found, errors)) in orders {
        assert!((found - expected).abs() < 0.25, "{found} for {expected}: {errors:?}");
    }
}

/// In a step of second order each site has dE/dt = f·v, from the potential and from differences of it.
#[test]
fn forces_do_their_work() {
    let random = &mut Random::new(3);
    for _ in 0..10 {
        let chain = Second::<SITES> { cubic: CUBIC, swing: 0.0, drag: DRAG };
        let q: [Vector1<f64>; SITES] = std::array::from_fn(|_| random.vector());
        let mu: [Vector1<f64>; SITES] = std::array::from_fn(|_| random.vector());
        let push: [Vector1<f64>; SITES] = std::array::from_fn(|_| random.vector());
        let power: f64 = (0..SITES).map(|i| (push[i].x - DRAG[i] * mu[i].x * (1.0 + q[i].x.powi(2))) * mu[i].x).sum();
        let gained = |h: f64| {
            let stepper = chain.stepper(h).unwrap();
            let state = stepper.state(q, mu).unwrap();
            let next = stepper.step_with(&state, &push).unwrap();
            stepper.energy(&next) - stepper.energy(&state)
        };
        let slope = |h: f64| (gained(h) - gained(-h)) / (2.0 * h);
        // differences of both sizes have an error in h², and this combination of them has none
        let found = (4.0 * slope(5e-4) - slope(1e-3)) / 3.0;
        assert!((found - power).abs() < 1e-8 * (1.0 + power.abs()), "{found} and {power}");
    }
}

/// Bodies in a ring, whose attitudes are coupled, of fourth order.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: [SO<3>; N], R: [SO<3>; N]| (0..N).map(|i| F[i] * R[i]),
    cost       = |h, F| (0..N).map(|i| self.inertia[i] * (F[i] - I).norm_squared() / (4 * h)).sum(),
    potential  = |R| -self.coupling * (0..N).map(|i| (R[i].transpose() * R[(i + 1) % N]).trace()).sum(),
    order      = 4,
)]
pub struct Ring<const N: usize> {
    pub inertia: [f64; N],
    pub coupling: f64,
}

/// The potential does not change where all bodies turn alike: the sum of their spatial momenta stays.
#[test]
fn composed_steps_conserve_momenta() {
    let random = &mut Random::new(4);
    let ring = Ring::<5> { inertia: [1.0, 1.3, 0.7, 2.0, 1.1], coupling: 0.6 };
    let stepper = ring.into_stepper(0.05).unwrap();
    let q: [Matrix3<f64>; 5] = std::array::from_fn(|_| random.attitude::<3>());
    let mu: [Vector3<f64>; 5] = std::array::from_fn(|_| random.vector());
    let mut state = stepper.state(q, mu).unwrap();
    let (start, energy) = (mu.iter().sum::<Vector3<f64>>(), stepper.energy(&state));
    for _ in 0..2000 {
        state = stepper.step(&state).unwrap();
    }
    let drift = (state.momentum().iter().sum::<Vector3<f64>>() - start).amax();
    assert!(drift < 1e-13, "{drift:e}");
    assert!((stepper.energy(&state) - energy).abs() < 1e-4 * energy.abs(), "{:e}", stepper.energy(&state) - energy);
    let conserved = stepper.conserved(&state);
    assert!((Vector3::from_column_slice(conserved.values()) - start).amax() < 1e-13);
}

/// In vectors and in an array, bit for bit.
#[test]
fn storage_does_not_matter_with_inputs() {
    const N: usize = 1000;
    let stepper = || Fourth::<N> { cubic: 0.5, swing: 0.2, drag: [0.05; N] }.into_stepper(0.1).unwrap();
    let place = |i: usize| Vector1::new((i as f64).sin());
    let (push, q) = ([Vector1::new(0.1); N], std::array::from_fn(place));
    let (stepper, mut sites) =
        (stepper(), stepper().sites(SiteStorage::of(q.to_vec(), vec![Vector1::zeros(); N])).unwrap());
    let mut state = stepper.state(q, [Vector1::zeros(); N]).unwrap();
    for _ in 0..2 {
        state = stepper.step_with(&state, &push).unwrap();
        sites.step_with(&push).unwrap();
    }
    state = stepper.step(&state).unwrap();
    sites.step().unwrap();
    assert_eq!((sites.configuration(), sites.momentum()), (&state.configuration()[..], &state.momentum()[..]));
}

/// A chain with free ends, pulled by forces of its own.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |a: [Translation<3>; N], x: [Vector3; N]| (0..N).map(|i| x[i] + a[i]),
    lagrangian = |v| (0..N).map(|i| v[i].norm_squared()).sum() / 2,
    potential  = |x| self.stiffness * (0..N - 1).map(|i| (x[i + 1] - x[i]).norm_squared()).sum() / 2,
    force      = |pull: [Vector3; N]| (0..N).map(|i| pull[i]),
    order      = 4,
)]
pub struct Long<const N: usize> {
    pub stiffness: f64,
}

/// 20 000 sites, 480 kB for each array of vectors, step on a stack of 256 KiB, with the feature `heavy` 50 000. Their momentum is that of the pull.
#[test]
fn many_sites_take_no_stack() {
    const N: usize = if cfg!(feature = "heavy") { 50_000 } else { 20_000 };
    let stepped = std::thread::Builder::new().stack_size(1 << 18).spawn(|| {
        let q: Vec<Vector3<f64>> = (0..N).map(|i| Vector3::x() * i as f64 + Vector3::y() * (i as f64).sin()).collect();
        let storage = SiteStorage::of(q, vec![Vector3::zeros(); N]);
        let mut sites = Long::<N> { stiffness: 0.7 }.into_stepper(0.1).unwrap().sites(storage).unwrap();
        let pull = vec![Vector3::z(); N];
        sites.step_with(pull[..].try_into().unwrap()).unwrap();
        sites.step().unwrap();
        let momentum: Vector3<f64> = sites.momentum().iter().sum();
        momentum / N as f64
    });
    let mean = stepped.unwrap().join().unwrap();
    assert!((mean - Vector3::z() * 0.1).amax() < 1e-13, "{mean}");
}

/// An input that is no number is refused, and the sites stay.
#[test]
fn inputs_are_numbers() {
    let chain = Fourth::<2> { cubic: 0.5, swing: 0.2, drag: [0.05; 2] };
    let storage = SiteStorage::of([Vector1::new(0.3); 2], [Vector1::zeros(); 2]);
    let mut sites = chain.into_stepper(0.1).unwrap().sites(storage).unwrap();
    let error = sites.step_with(&[Vector1::new(0.1), Vector1::new(f64::NAN)]).unwrap_err();
    assert_eq!((error.site, error.error), (None, clebsch::Error::NotFinite { name: "the input" }));
    assert_eq!((sites.configuration()[0].x, sites.steps()), (0.3, 0));
}
