//! Runs that overflow end soon, however many steps are asked for, by every way to make many steps: `u64::MAX` would never end.

use clebsch::{Clebsch, Error, F64x4, Scalar, SiteStorage};
use clebsch_tests::oracle::random::Random;
use nalgebra::{SVector, Vector1};

/// Falls from a potential without a floor: x grows faster than any exponential.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |a: Translation<1>, x: Vector1| x + a,
    cost      = |h, a| self.mass * a.norm_squared() / (2 * h),
    potential = |x| -self.slope * x.norm_squared().powi(2) / 4,
)]
struct Falling<T: Scalar> {
    mass: T,
    slope: T,
}

/// The same by a splitting.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |a: Translation<1>, x: Vector1| x + a,
    lagrangian     = |v| self.mass * v.norm_squared() / 2,
    potential      = |x| -self.slope * x.norm_squared().powi(2) / 4,
    discretization = exact,
    order          = 4,
)]
struct Split {
    mass: f64,
    slope: f64,
}

/// Drives with the time.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |a: Translation<1>, x: Vector1| x + a,
    cost      = |h, a| self.mass * a.norm_squared() / (2 * h),
    potential = |t, x| -self.slope * x.norm_squared().powi(2) / 4 + t * x.x,
)]
struct Driven {
    mass: f64,
    slope: f64,
}

/// Without a force: its place overflows, its momentum stays.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(action = |a: Translation<1>, x: Vector1| x + a, cost = |h, a| self.mass * a.norm_squared() / (2 * h))]
struct Free {
    mass: f64,
}

/// Many of them.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |a: [Translation<1>; N], x: [Vector1; N]| (0..N).map(|i| x[i] + a[i]),
    cost      = |h, a| (0..N).map(|i| a[i].norm_squared() / (2 * h)).sum(),
    potential = |x| (0..N).map(|i| -(x[(i + 1) % N] - x[i]).norm_squared().powi(2) / 4).sum(),
)]
struct Ring<const N: usize>;

/// A point on a large sphere, which falls in a field that overflows.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<12>, q: Unit<SVector<12>>| F * q,
    cost      = |h, F| (F - I).norm_squared() / (4 * h),
    potential = |q| -(self.steepness * q[11]).exp(),
)]
struct Pointer {
    steepness: f64,
}

/// `advance` ends, with the error of the first step that fails; an integrator stands before it, and says how many it made.
fn ends<S: Clebsch<Scalar = f64> + Clone + std::fmt::Debug>(
    system: &S,
    h: f64,
    q: S::Configuration,
    mu: S::Momentum,
) -> Result<u64, Error>
where
    S::Configuration: Copy,
{
    let stepper = system.clone().into_stepper(h)?;
    let start = stepper.state(q, mu)?;
    let error = stepper.advance(&start, usize::MAX).expect_err("it overflows");
    let mut integrator = stepper.clone().integrator(start);
    assert_eq!(integrator.advance(u64::MAX), Err(error), "{system:?}");
    let made = integrator.steps();
    let (before, failing) = (usize::try_from(made).expect("few"), usize::try_from(made + 1).expect("few"));
    let last = stepper.trajectory(start).take(before + 1).last().expect("a state")?;
    assert_eq!(format!("{:?}", integrator.state().configuration()), format!("{:?}", last.configuration()));
    assert_eq!(stepper.trajectory(start).take(failing + 1).last().expect("an error").err(), Some(error));
    // whoever asks for fewer gets them
    assert!(stepper.advance(&start, before).is_ok(), "{system:?}: {before} steps");
    Ok(made)
}

#[test]
fn runs_that_overflow_end() -> Result<(), Error> {
    let mut random = Random::new(51);
    let mut most = 0;
    for _ in 0..20 {
        let (mass, slope) = (random.between(0.5, 2.0), 10_f64.powf(random.between(-3.0, 3.0)));
        let h = 10_f64.powf(random.between(-3.0, 0.0));
        let (x, mu) = (Vector1::new(random.between(0.5, 2.0)), Vector1::new(random.number()));
        most = most.max(ends(&Falling { mass, slope }, h, x, mu)?);
        ends(&Split { mass, slope }, h, x, mu)?;
        ends(&Driven { mass, slope }, h, x, mu)?;
        ends(&Free { mass }, h, x, Vector1::new(1e307 * random.between(0.1, 8.0) * mass))?;
        ends(&Ring::<5>, h, [0.0, x.x, 0.5, -1.0, 0.2].map(Vector1::new), [mu; 5])?;
    }
    assert!(most > 2048, "the longest run has {most} steps only");
    let q = SVector::<f64, 12>::from_fn(|i, _| if i == 0 { 1.0 } else { 0.0 });
    let pointer = Pointer { steepness: 800.0 };
    let mu = pointer.momentum_map(&q, &SVector::from_fn(|i, _| if i == 11 { 1.0 } else { 0.0 }));
    ends(&pointer, 1e-3, q, mu).map(|_| ())
}

#[test]
fn sites_that_overflow_end() -> Result<(), Error> {
    let mut random = Random::new(52);
    for _ in 0..5 {
        let h = 10_f64.powf(random.between(-3.0, 0.0));
        let (q, mu) = ((0..5).map(|_| random.vector()).collect::<Vec<_>>(), vec![Vector1::zeros(); 5]);
        let mut sites = Ring::<5>.into_stepper(h)?.sites(SiteStorage::of(q, mu))?;
        assert!(sites.advance(u64::MAX).is_err());
        assert!(sites.steps() > 0 && sites.configuration().iter().all(|x| x.x.is_finite()));
    }
    Ok(())
}

/// Lanes, and ensembles in which all bodies fail, each at its own step.
#[test]
fn bodies_that_overflow_end() -> Result<(), Box<dyn std::error::Error>> {
    let mut random = Random::new(53);
    let system = Falling { mass: F64x4::splat(1.0), slope: F64x4::splat(1.0) };
    let starts: Vec<_> = (0..11).map(|_| (Vector1::new(random.between(0.5, 2.0)), Vector1::zeros())).collect();
    let stepper = system.stepper(F64x4::splat(0.01))?;
    let lanes = Vector1::new(F64x4::from_lanes(|lane| starts[lane].0.x));
    let error = stepper.advance(&stepper.state(lanes, Vector1::zeros())?, usize::MAX);
    assert!(matches!(error, Err(Error::InLane { .. })));
    let mut bodies = stepper.ensemble(starts.iter().copied())?;
    bodies.advance(u64::MAX);
    assert_eq!(bodies.failures().count(), 11);
    for (failure, body) in bodies.failures().map(|failure| (failure, failure.body)) {
        let alone = Falling { mass: 1.0, slope: 1.0 }.into_stepper(0.01)?;
        let mut integrator = alone.clone().integrator(alone.state(starts[body].0, starts[body].1)?);
        assert!(integrator.advance(u64::MAX).is_err());
        assert_eq!(failure.step, integrator.steps());
    }
    Ok(())
}
