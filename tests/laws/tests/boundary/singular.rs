//! Paths that pass a singularity of the potential: the result is an extremal, or the error says by how much it is none.

use clebsch::{Clebsch, Error, Guess};
use clebsch_tests::oracle::random::Random;
use nalgebra::Vector3;

/// A body about a sun, where energies are counted from `offset`.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |a: Translation<3>, x: Vector3| x + a,
    lagrangian = |v| self.mass * v.norm_squared() / 2,
    potential  = |x| self.offset - self.gravity / x.norm(),
    endpoint   = |x| self.price * (x - self.goal).norm_squared() / 2,
    emit       = [boundary],
)]
struct Kepler {
    mass: f64,
    gravity: f64,
    offset: f64,
    price: f64,
    goal: Vector3<f64>,
}

/// In a field, with the same offset.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |a: Translation<3>, x: Vector3| x + a,
    lagrangian = |v| v.norm_squared() / 2,
    potential  = |x| self.offset + x.norm_squared().powi(2) / 4,
    emit       = [boundary],
)]
struct Well {
    offset: f64,
}

/// From x to −x straight through the sun, by all ways to solve for a path: momenta agree at every vertex of a result.
#[test]
fn what_leads_through_a_singularity_is_no_extremal() {
    let mut random = Random::new(31);
    let (mut found, mut refused) = (0, 0);
    let count = if cfg!(feature = "heavy") { 600 } else { 150 };
    for k in 0..count {
        let x: Vector3<f64> = if k % 3 == 0 { Vector3::x() * random.number() } else { random.vector() };
        let (steps, h) = ([2, 4, 8, 10, 20, 50][k % 6], 10_f64.powf(random.between(-3.0, 1.0)));
        let (mass, gravity) = (random.between(0.5, 1.5), 10_f64.powf(random.between(-3.0, 3.0)));
        let stepper = Kepler { mass, gravity, offset: 0.0, price: 1e3, goal: -x }.into_stepper(h).expect("regular");
        let boundary = stepper.boundary();
        let velocity = Guess::Velocity(-x * 2.0 / (h * steps as f64));
        let guess = [Guess::Geodesic, velocity][k % 2];
        let mut path = vec![boundary.rest(&x); steps];
        let mut judge = |solved: Result<(f64, f64), Error>| match solved {
            Ok((residual, momentum)) => {
                found += 1;
                assert!(residual <= 1e-8 * momentum, "{k}: a residual of {residual:e} beside {momentum:e}");
            }
            Err(Error::NotStationary { residual, momentum }) => {
                refused += 1;
                assert!(residual > 1e-8 * momentum, "{k}: {residual:e} beside {momentum:e}");
            }
            Err(Error::NotFinite { .. } | Error::NoExtremal { .. } | Error::Unreachable { .. }) => {}
            Err(error) => panic!("{k}: {error}"),
        };
        let numbers = |extremal: clebsch::Extremal<'_, Kepler, 3>| {
            let largest = extremal.nodes().iter().map(|node| node.momentum().norm()).fold(0.0, f64::max);
            (extremal.residual(), largest)
        };
        judge(boundary.solve(&x, &-x, guess, &mut path).map(numbers));
        judge(boundary.solve_free(&x, velocity, &mut path).map(numbers));
        let time = boundary.free_time(&x, Some(&-x), h / 2.0..=h * 2.0, guess, &mut path);
        if let Ok(h) = time {
            let stepper = stepper.system().clone().into_stepper(h).expect("regular");
            judge(stepper.boundary().solve(&x, &-x, Guess::Path, &mut path).map(numbers));
        }
    }
    println!("{found} found, {refused} refused");
    assert!(refused > count / 2, "{found} found, {refused} refused");
}

/// Energies count from anywhere: an offset changes no path, however large it is relative to the action.
#[test]
fn an_offset_of_the_potential_hides_no_residual() -> Result<(), Error> {
    let mut random = Random::new(32);
    for k in 0..60 {
        let (start, target): (Vector3<f64>, Vector3<f64>) = (random.vector(), random.vector());
        let momentum = |offset: f64| -> Result<Vector3<f64>, Error> {
            let stepper = Well { offset }.into_stepper(0.05)?;
            let boundary = stepper.boundary();
            let mut path = [boundary.rest(&start); 20];
            Ok(*boundary.solve(&start, &target, Guess::Geodesic, &mut path)?.momentum())
        };
        let expected = momentum(0.0)?;
        let offset = 10_f64.powi(k);
        let found = momentum(offset)?;
        assert!((found - expected).norm() < 1e-11 * expected.norm(), "{offset:e}: {found} and {expected}");
    }
    Ok(())
}
