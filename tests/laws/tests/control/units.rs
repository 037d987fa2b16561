//! Plans are the same in other units of mass and of time.

use super::long;
use clebsch::{Clebsch, Control, Controlled, Error, Target};
use clebsch_tests::oracle::random::Random;
use nalgebra::{Matrix3, Rotation3, Vector3};

/// A body that turns past two forbidden cones, no faster than a limit.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<3>, R: SO<3>| R * F,
    lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
    force      = |torque: Vector3| torque,
    effort     = |h, torque| h * torque.norm_squared() / 2,
    bounds     = |R, omega, torque| [R[(2, 0)] <= self.most, R[(0, 1)] <= self.most, omega.norm_squared() <= self.top.powi(2)],
)]
struct Shy {
    #[clebsch(symmetric)]
    inertia: Matrix3<f64>,
    most: f64,
    top: f64,
}

/// So many old units are a new one.
#[derive(Clone, Copy, Debug)]
struct Units {
    mass: f64,
    time: f64,
}

impl Units {
    /// Those of a force, and of a torque.
    fn force(self) -> f64 {
        self.mass / self.time.powi(2)
    }

    /// Those of the effort ½ ∫ u² dt.
    fn effort(self) -> f64 {
        self.force().powi(2) * self.time
    }
}

/// The number of linearisations, and the price in the first units.
type Found = (u32, f64);

fn found<S, const D: usize, const U: usize, const C: usize>(
    control: &Control<S, D, U, C>,
    start: &S::Place,
    target: Target<S::Place>,
    units: Units,
) -> Result<Found, Error>
where
    S: Controlled<D, U, C, Scalar = f64>,
{
    let mut plan = vec![control.stage(start); 40];
    let optimum = control.solve(start, target, &mut plan)?;
    Ok((optimum.iterations(), optimum.price() / units.effort()))
}

/// Plans of `count` random problems are the same in several units.
fn are_the_same(
    count: usize,
    seed: u64,
    solve: impl Fn(&mut Random, Units) -> Result<Found, Error>,
) -> Result<(), Error> {
    let units = [(1.0, 1.0), (1e-3, 1.0), (1e3, 1e3), (1.0, 1e-3)].map(|(mass, time)| Units { mass, time });
    for problem in 0..count as u64 {
        let [first, others @ ..] = units.map(|units| (units, solve(&mut Random::new(seed + problem), units)));
        let (iterations, price) = first.1?;
        for (units, other) in others {
            let (again, dearer) = other?;
            let text = format!("problem {problem}, {units:?}: {again} {dearer} is not {iterations} {price}");
            assert!(again.abs_diff(iterations) <= 2 && (dearer - price).abs() < 1e-9 * price, "{text}");
        }
    }
    Ok(())
}

fn rotation(turn: Vector3<f64>) -> Matrix3<f64> {
    *Rotation3::new(turn).matrix()
}

/// An attitude outside of both cones.
fn attitude(random: &mut Random) -> Matrix3<f64> {
    loop {
        let attitude = rotation(random.vector::<3>() * 2.0);
        if attitude.m31 < 0.45 && attitude.m12 < 0.45 {
            return attitude;
        }
    }
}

const INERTIA: Vector3<f64> = Vector3::new(1.0, 2.0, 3.0);

#[test]
fn bounds_of_attitudes_do_not_tell_units() -> Result<(), Error> {
    are_the_same(long(16), 4100, |random, units| {
        let Units { mass, time } = units;
        let inertia = Matrix3::from_diagonal(&(INERTIA * mass));
        let control = Shy { inertia, most: 0.5, top: 4.0 / time }.control(0.025 * time)?;
        let start = (attitude(random), Vector3::zeros());
        let leaving = inertia * random.vector::<3>() * 0.5 / time;
        let goal = (attitude(random), leaving);
        found(&control, &start, Target::Place(goal), units)
    })
}
