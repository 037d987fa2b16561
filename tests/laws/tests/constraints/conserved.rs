//! Momenta that are conserved where a constraint on places holds.

use clebsch::{Clebsch, Conserves, Error, State, Stepper};
use clebsch_tests::fixtures::jointed_bodies::JointedBodies;
use nalgebra::{Matrix4, SVector, Vector3, Vector6};

use crate::places::{bodies, tilted};

mod declared {
    use clebsch::Clebsch;
    use nalgebra::*;

    /// Two bodies in space on a ball joint.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action     = |F: [SE<3>; 2], q: [SE<3>; 2]| [q[0] * F[0], q[1] * F[1]],
        lagrangian = |xi| (0..2).map(|i| {
            let (omega, v) = (xi[i].fixed_rows::<3>(0), xi[i].fixed_rows::<3>(3));
            (omega.dot(&(self.inertia * omega)) + self.mass * v.norm_squared()) / 2
        }).sum(),
        constraint = |q| [q[0].rotation() * self.arm + q[0].translation() == q[1].rotation() * self.arm + q[1].translation()],
        discretization = moser_veselov,
    )]
    pub struct Pair {
        #[clebsch(symmetric)]
        pub inertia: Matrix3<f64>,
        pub mass: f64,
        pub arm: Vector3<f64>,
    }

    /// A body on a pivot that turns about the vertical through the origin move.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action     = |F: SE<3>, q: SE<3>| q * F,
        lagrangian = |(omega, v)| (omega.dot(&(self.inertia * omega)) + self.mass * v.norm_squared()) / 2,
        potential  = |q| self.weight * q.translation().z,
        constraint = |q| [q.rotation() * self.arm + q.translation() == self.pivot],
    )]
    pub struct Aside {
        #[clebsch(symmetric)]
        pub inertia: Matrix3<f64>,
        pub mass: f64,
        pub arm: Vector3<f64>,
        pub pivot: Vector3<f64>,
        pub weight: f64,
    }

    /// Two masses with a rod between them, the first on a plane and the second on wheels.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action     = |(a, b): (Translation<3>, Translation<3>), (x, y): (Vector3, Vector3)| (x + a, y + b),
        lagrangian = |(v, w)| self.mass * (v.norm_squared() + w.norm_squared()) / 2,
        constraint = [|x, y| [x.z == 0, (x - y).norm_squared() == 1], |(v, w)| [w.x == 0]],
    )]
    pub struct Rolled {
        pub mass: f64,
    }
}

use declared::{Aside, Pair, Rolled};

/// The steps of runs that conserve.
const STEPS: usize = if cfg!(feature = "heavy") { 10_000 } else { 1000 };

/// The largest change of each conserved momentum over so many steps.
fn drift<S, const N: usize>(stepper: &Stepper<S>, mut state: State<S>, steps: usize) -> Result<[f64; N], Error>
where
    S: Clebsch<Scalar = f64> + Conserves<Conserved = clebsch::Conserved<f64, N>>,
{
    let start = stepper.conserved(&state);
    let mut worst = [0.0_f64; N];
    for _ in 0..100 {
        state = stepper.advance(&state, steps / 100)?;
        let now = stepper.conserved(&state);
        worst = std::array::from_fn(|i| worst[i].max((now[i] - start[i]).abs()));
    }
    Ok(worst)
}

#[test]
fn hanging_bodies_conserve_the_vertical_angular_momentum() -> Result<(), Error> {
    let bodies = bodies();
    let stepper = bodies.stepper(0.01)?;
    let start = stepper.project(tilted(&bodies), SVector::from_fn(|i, _| 0.02 * (i as f64 - 5.0)))?;
    assert_eq!(stepper.conserved(&start).names(), &["about e3 of all factors, spatial"]);
    // x × p + R L of both, by hand
    let by_hand = |state: &State<JointedBodies>| -> f64 {
        let mu = state.momentum();
        (0..2)
            .map(|i| {
                let q = state.configuration()[i];
                let (turn, place) = (q.fixed_view::<3, 3>(0, 0), q.fixed_view::<3, 1>(0, 3).into_owned());
                let spin: Vector3<f64> = turn * mu.fixed_rows::<3>(6 * i);
                let push: Vector3<f64> = turn * mu.fixed_rows::<3>(6 * i + 3);
                (place.cross(&push) + spin).z
            })
            .sum()
    };
    let value = by_hand(&start);
    assert!((stepper.conserved(&start)[0] - value).abs() < 1e-15 && value.abs() > 1e-3, "{value}");
    let [worst] = drift(&stepper, start, STEPS)?;
    // rounding of terms of 5 N m s in 10 000 steps at most: ε √10⁴ times that
    assert!(worst < 5e-13, "{worst:e}");
    Ok(())
}

#[test]
fn bodies_on_a_joint_conserve_what_one_body_does() -> Result<(), Error> {
    let inertia = nalgebra::Matrix3::new(0.09, 0.01, 0.0, 0.01, 0.085, 0.0, 0.0, 0.0, 0.03);
    let pair = Pair { inertia, mass: 0.8, arm: Vector3::new(0.1, 0.2, 0.5) };
    let stepper = pair.stepper(0.01)?;
    let start = stepper.project([Matrix4::identity(); 2], SVector::from_fn(|i, _| 0.1 * (i as f64 - 4.0)))?;
    let worst: [f64; 6] = drift(&stepper, start, STEPS)?;
    // the places are 50 m away in the end, and so much larger is the rounding of x × p
    let (turns, shifts) = worst.split_at(3);
    assert!(turns.iter().all(|worst| *worst < 1e-11) && shifts.iter().all(|worst| *worst < 2e-13), "{worst:?}");
    Ok(())
}

/// A pivot aside has no symmetry, and wheels leave one direction of the plane.
#[test]
fn only_momenta_that_stay_are_listed() -> Result<(), Error> {
    assert!(Aside::DERIVATION.contains("Conserved: no momentum"), "{}", Aside::DERIVATION);
    let stepper = Rolled { mass: 0.7 }.into_stepper(0.01)?;
    let place = (Vector3::new(0.1, 0.2, 0.0), Vector3::new(0.1, 0.8, 0.8));
    let start = stepper.project(place, Vector6::new(0.3, -0.2, 0.5, 0.1, 0.4, 0.2))?;
    let names = stepper.conserved(&start).names().to_vec();
    assert_eq!(names, ["along e2 of all factors, spatial"]);
    let [worst] = drift(&stepper, start, STEPS)?;
    assert!(worst < 1e-12, "{worst:e}");
    Ok(())
}
