//! Powers at their edges: one site, none, storage of another length, a step that fails.

use clebsch::{Clebsch, Error, SiteStorage};
use clebsch_tests::oracle::random::Random;
use nalgebra::*;

/// A ring of spins.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: [SO<3>; N], q: [Unit<Vector3>; N]| (0..N).map(|i| F[i] * q[i]),
    cost      = |h, F| (0..N).map(|i| (F[i] - I).norm_squared() / (4 * h)).sum(),
    potential = |q| -self.exchange * (0..N).map(|i| q[i].dot(&q[(i + N - 1) % N])).sum(),
)]
pub struct Ring<T, const N: usize> {
    pub exchange: T,
}

#[test]
fn one_site_is_its_own_neighbour() {
    // V = −J |q|², whose gradient has no moment
    let ring = Ring::<f64, 1> { exchange: 0.7 };
    let stepper = ring.stepper(0.1).expect("a regular ring");
    let start = stepper.state([Vector3::x()], [Vector3::new(0.0, 0.3, 0.4)]).expect("a state");
    let next = stepper.step(&start).expect("a step");
    assert!((next.momentum()[0] - start.momentum()[0]).norm() < 1e-17);
    assert_eq!(ring.potential(0.0, &[Vector3::x()]), -0.7);
}

#[test]
fn storage_of_another_length_is_refused() {
    let ring = Ring::<f64, 3> { exchange: 0.7 };
    let storage = SiteStorage::of(vec![Vector3::x(); 2], vec![Vector3::zeros(); 3]);
    let error = ring.into_stepper(0.1).expect("a ring").sites(storage).expect_err("a site is missing");
    assert_eq!(error.error, Error::NumberOfSites { found: 2, sites: 3 });
    assert_eq!(error.to_string(), "the storage has 2 entries where there are 3 sites: give one entry for each site");
}

#[test]
fn a_site_off_its_sphere_is_named() {
    let ring = Ring::<f64, 3> { exchange: 0.7 };
    let q = vec![Vector3::x(), Vector3::x() * 1.1, Vector3::x()];
    let error = ring
        .into_stepper(0.1)
        .expect("a ring")
        .sites(SiteStorage::of(q, vec![Vector3::zeros(); 3]))
        .expect_err("off its sphere");
    assert_eq!(error.site, Some(1));
    assert!(error.to_string().starts_with("at site 1: the configuration is off its space"), "{error}");
}

#[test]
fn a_step_that_fails_leaves_the_state_and_names_the_site() {
    let ring = Ring::<f64, 4> { exchange: 0.0 };
    let mut mu = vec![Vector3::zeros(); 4];
    mu[2] = Vector3::z() * 11.0;
    let q = vec![Vector3::x(); 4];
    let mut sites =
        ring.into_stepper(0.1).expect("a ring").sites(SiteStorage::of(q.clone(), mu.clone())).expect("a state");
    let error = sites.step().expect_err("h|ω| = 1.1 has no solution");
    assert_eq!(error.site, Some(2));
    assert!(matches!(error.error, Error::Unsolvable { .. }), "{error}");
    assert_eq!((sites.configuration(), sites.momentum(), sites.steps()), (&q[..], &mu[..], 0));
}

#[test]
fn many_sites_in_vectors() {
    const N: usize = if cfg!(feature = "heavy") { 100_000 } else { 20_000 };
    let random = &mut Random::new(5);
    let q: Vec<Vector3<f64>> = (0..N).map(|_| random.unit()).collect();
    let mu: Vec<Vector3<f64>> = q.iter().map(|q| q.cross(&random.vector())).collect();
    let total = |mu: &[Vector3<f64>]| mu.iter().sum::<Vector3<f64>>();
    let start = total(&mu);
    let mut sites = Ring::<f64, N> { exchange: 0.7 }
        .into_stepper(0.05)
        .expect("a ring")
        .sites(SiteStorage::of(q, mu))
        .expect("a state");
    let energy = sites.energy().expect("all sites");
    sites.advance(3).expect("steps");
    // Σμ is conserved, as the exchange is the same for all spins turned alike; round-off grows as √N
    assert!((total(sites.momentum()) - start).norm() < 1e-10, "{:e}", (total(sites.momentum()) - start).norm());
    let conserved = sites.conserved().expect("all sites");
    assert!((conserved[0] - start.x).abs() < 1e-10);
    assert!((sites.energy().expect("all sites") / energy - 1.0).abs() < 1e-3);
}

#[test]
fn single_precision_is_the_same_system() {
    let random = &mut Random::new(3);
    let q: [Vector3<f64>; 6] = std::array::from_fn(|_| random.unit());
    let mu = q.map(|q| q.cross(&random.vector()));
    let double = Ring::<f64, 6> { exchange: 0.7 }.stepper(0.05).expect("a regular ring");
    let single = Ring::<f32, 6> { exchange: 0.7 }.stepper(0.05).expect("a regular ring");
    let mut a = double.state(q, mu).expect("a state");
    let mut b = single.state(q.map(|q| q.cast()), mu.map(|mu| mu.cast())).expect("a state");
    for _ in 0..50 {
        a = double.step(&a).expect("a step");
        b = single.step(&b).expect("a step");
    }
    for (a, b) in a.configuration().iter().zip(b.configuration()) {
        assert!((a - b.cast::<f64>()).norm() < 1e-5);
    }
}

/// The generated code for N sites is documented on the struct itself, and is the same for every N.
#[test]
fn generated_code_does_not_grow() {
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action    = |F: [SO<3>; N], q: [Unit<Vector3>; N]| (0..N).map(|i| F[i] * q[i]),
        cost      = |h, F| (0..N).map(|i| (F[i] - I).norm_squared() / (4 * h)).sum(),
        potential = |q| -(0..N).map(|i| q[i].dot(&q[(i + 1) % N])).sum(),
        emit      = [generated],
    )]
    struct Seen<const N: usize> {}
    assert!(Seen::<4>::GENERATED.contains("impl<const N: usize> runtime::Clebsch for Seen<N>"));
    assert_eq!(Seen::<4>::GENERATED, Seen::<100>::GENERATED);
    assert!(Seen::<4>::DERIVATION.starts_with("Seen\n\nA power: N sites"));
    assert_eq!(Seen::<4>::NAME, "Seen");
}

/// Free bodies are bodies alone, of a tuple struct, each with its own inertia.
#[test]
fn free_bodies_are_bodies_alone() {
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action         = |F: [SO<3>; N], R: [SO<3>; N]| (0..N).map(|i| R[i] * F[i]),
        lagrangian     = |omega| (0..N).map(|i| self.1 * omega[i].dot(&(self.0[i] * omega[i])) / 2).sum(),
        discretization = moser_veselov,
    )]
    struct Cloud<const N: usize>(#[clebsch(symmetric)] [Matrix3<f64>; N], f64);
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action         = |F: SO<3>, R: SO<3>| R * F,
        lagrangian     = |omega| omega.dot(&(self.0 * omega)) / 2,
        discretization = moser_veselov,
    )]
    struct Alone(#[clebsch(symmetric)] Matrix3<f64>);
    let random = &mut Random::new(11);
    let inertia: [Matrix3<f64>; 3] = std::array::from_fn(|_| random.inertia());
    let (q, mu): ([Matrix3<f64>; 3], [Vector3<f64>; 3]) =
        (std::array::from_fn(|_| random.rotation(1.0)), std::array::from_fn(|_| random.vector()));
    let stepper = Cloud(inertia, 2.0).into_stepper(0.1).expect("three bodies");
    let mut all = stepper.state(q, mu).expect("a state");
    let steppers = inertia.map(|inertia| Alone(2.0 * inertia).into_stepper(0.1).expect("a body"));
    let mut each: [_; 3] = std::array::from_fn(|i| steppers[i].state(q[i], mu[i]).expect("a state"));
    for _ in 0..50 {
        all = stepper.step(&all).expect("a step of all");
        each = std::array::from_fn(|i| steppers[i].step(&each[i]).expect("a step"));
    }
    for (i, alone) in each.iter().enumerate() {
        assert!((all.configuration()[i] - alone.configuration()).amax() < 1e-12);
        assert!((all.momentum()[i] - alone.momentum()).amax() < 1e-12);
    }
    let mut skew = inertia;
    skew[2][(0, 1)] += 0.1;
    let error = Cloud(skew, 2.0).into_stepper(0.1).expect_err("the third is not symmetric");
    assert!(matches!(error, Error::NotSymmetric { field: "self.0", .. }), "{error:?}");
}
