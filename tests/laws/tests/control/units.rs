//! Plans are the same in other units of mass and of time.

use super::long;
use clebsch::{Clebsch, Controlled, Error, Target};
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

/// An attitude outside of both cones.
fn attitude(random: &mut Random) -> Matrix3<f64> {
    loop {
        let attitude = *Rotation3::new(random.vector::<3>() * 2.0).matrix();
        if attitude.m31 < 0.45 && attitude.m12 < 0.45 {
            return attitude;
        }
    }
}

/// The number of linearisations of a random plan, and its price ½ ∫ u² dt in the first units.
fn planned(seed: u64, Units { mass, time }: Units) -> Result<(u32, f64), Error> {
    let random = &mut Random::new(seed);
    let inertia = Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 3.0)) * mass;
    let control = Shy { inertia, most: 0.5, top: 4.0 / time }.control(0.025 * time)?;
    let start = (attitude(random), Vector3::zeros());
    let leaving = inertia * random.vector::<3>() * 0.5 / time;
    let goal = (attitude(random), leaving);
    let mut plan = [control.stage(&start); 40];
    let optimum = control.solve(&start, Target::Place(goal), &mut plan)?;
    let torque = mass / time.powi(2);
    Ok((optimum.iterations(), optimum.price() / (torque.powi(2) * time)))
}

#[test]
fn bounds_of_attitudes_do_not_tell_units() -> Result<(), Error> {
    let units = [(1e-3, 1.0), (1e3, 1e3), (1.0, 1e-3)].map(|(mass, time)| Units { mass, time });
    for seed in 0..long(16) as u64 {
        let (iterations, price) = planned(seed, Units { mass: 1.0, time: 1.0 })?;
        for units in units {
            let (again, dearer) = planned(seed, units)?;
            let text = format!("{seed}, {units:?}: {again} {dearer} is not {iterations} {price}");
            assert!(again.abs_diff(iterations) <= 2 && (dearer - price).abs() < 1e-9 * price, "{text}");
        }
    }
    Ok(())
}
