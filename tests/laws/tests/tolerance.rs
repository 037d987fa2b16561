//! Steps whose equation is solved to a tolerance: exact quantities, and the drift of the others.
//!
//! `cargo test --release -p clebsch-laws --features heavy --test tolerance -- --nocapture` prints drifts against tolerances after 1e5 steps.

#![allow(missing_docs)]

use clebsch::{Clebsch, Error, Stepper};
use clebsch_tests::fixtures::tolerant_top::TolerantTop;
use clebsch_tests::oracle::near::{assert_near, distance};
use clebsch_tests::oracle::random::Random;
use nalgebra::{Matrix3, Vector3};

/// Declares a free body, the same body by fixed points, a top and one whose drifts are exact, in a module of its own.
/// They have a tolerance, or none.
macro_rules! systems {
    ($($(#[$gate:meta])? $module:ident $(($tolerance:literal))?;)*) => { $(
        $(#[$gate])?
        pub mod $module {
            use clebsch::{Clebsch, Scalar};
            use nalgebra::{Matrix3, Vector3};

            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action         = |F: SO<3>, R: SO<3>| R * F,
                lagrangian     = |omega| omega.dot(&(Matrix3::from_diagonal(&self.moments) * omega)) / 2,
                discretization = moser_veselov,
                solver         = newton,
                $(tolerance    = $tolerance,)?
            )]
            pub struct Body<T: Scalar> {
                pub moments: Vector3<T>,
            }

            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action         = |F: SO<3>, R: SO<3>| R * F,
                lagrangian     = |omega| omega.dot(&(Matrix3::from_diagonal(&self.moments) * omega)) / 2,
                discretization = moser_veselov,
                solver         = fixed_point,
                $(tolerance    = $tolerance,)?
            )]
            pub struct Fixed<T: Scalar> {
                pub moments: Vector3<T>,
            }

            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action    = |F: SO<3>, R: SO<3>| R * F,
                cost      = |h, F| (self.mass_matrix * (F - I) * (F - I).transpose()).trace() / (2 * h),
                potential = |R| self.weight * (R * self.center).z,
                $(tolerance = $tolerance,)?
            )]
            pub struct Top {
                #[clebsch(symmetric)]
                pub mass_matrix: Matrix3<f64>,
                pub weight: f64,
                pub center: Vector3<f64>,
            }

            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action         = |F: SO<3>, R: SO<3>| R * F,
                lagrangian     = |omega| omega.dot(&(self.inertia * omega)) / 2,
                potential      = |R| self.weight * (R * self.center).z,
                discretization = exact,
                order          = 4,
                $(tolerance    = $tolerance,)?
            )]
            pub struct ExactTop {
                #[clebsch(symmetric)]
                pub inertia: Matrix3<f64>,
                pub weight: f64,
                pub center: Vector3<f64>,
            }
        }
    )* };
}
#[rustfmt::skip]
systems! {
    rounded;
    invisible(1e-20);
    #[cfg(feature = "heavy")] tenth(1e-10);
    eighth(1e-8);
    #[cfg(feature = "heavy")] sixth(1e-6);
    fourth(1e-4);
    second(1e-2);
}

const STEPS: usize = if cfg!(feature = "heavy") { 100_000 } else { 5000 };
const H: f64 = 0.1;

fn moments<T: clebsch::Scalar>() -> Vector3<T> {
    Vector3::new(1.0, 2.0, 2.8).map(T::from_f64)
}

fn start() -> (Matrix3<f64>, Vector3<f64>) {
    (Random::new(81).attitude::<3>(), Vector3::new(0.4, 1.2, -0.7))
}

/// The losses after all steps from `spin` times the momentum: the largest relative errors of energy, spatial momentum
/// about e3, and RᵀR − I.
#[derive(Debug)]
struct Lost {
    energy: f64,
    momentum: f64,
    rotation: f64,
}

fn lost<S>(stepper: &Stepper<S>, spin: f64) -> Lost
where
    S: Clebsch<Scalar = f64, Configuration = Matrix3<f64>, Momentum = Vector3<f64>>,
{
    let (r, pi) = start();
    let pi = spin * pi;
    let start = stepper.state(r, pi).expect("a state");
    let (energy, momentum) = (stepper.energy(&start), (r * pi).z);
    let mut lost = Lost { energy: 0.0, momentum: 0.0, rotation: 0.0 };
    for state in stepper.trajectory(start).take(STEPS + 1) {
        let state = state.expect("a solvable step");
        let r = state.configuration();
        lost.energy = lost.energy.max((stepper.energy(&state) / energy - 1.0).abs());
        lost.momentum = lost.momentum.max(((r * state.momentum()).z - momentum).abs() / pi.norm());
        lost.rotation = lost.rotation.max(distance(&(r.transpose() * r), &Matrix3::identity()));
    }
    lost
}

/// For all tolerances: the losses of a free body, by Newton's method and by fixed points, of a top, and of one by free
/// rotations. The feature `heavy` has two tolerances more.
fn all() -> Vec<(f64, [Lost; 4])> {
    macro_rules! lost_at {
        ($($(#[$gate:meta])? $module:ident $tolerance:expr;)*) => { vec![$($(#[$gate])? {
            let top = TOP;
            let exact = $module::ExactTop { inertia: inertia(&top.0), weight: top.1, center: top.2 };
            let top = $module::Top { mass_matrix: top.0, weight: top.1, center: top.2 };
            ($tolerance, [
                lost(&$module::Body { moments: moments() }.into_stepper(H).expect("a body"), 1.0),
                lost(&$module::Fixed { moments: moments() }.into_stepper(H).expect("a body"), 1.0),
                lost(&top.into_stepper(H / 2.0).expect("a top"), 1.0),
                lost(&exact.into_stepper(2.0 * H).expect("a top"), 24.0),
            ])
        }),*] };
    }
    lost_at! {
        rounded f64::EPSILON / 4.0;
        #[cfg(feature = "heavy")] tenth 1e-10;
        eighth 1e-8;
        #[cfg(feature = "heavy")] sixth 1e-6;
        fourth 1e-4;
        second 1e-2;
    }
}

/// tr(W) I − W of the mass matrix.
fn inertia(mass_matrix: &Matrix3<f64>) -> Matrix3<f64> {
    Matrix3::identity() * mass_matrix.trace() - mass_matrix
}

const TOP: (Matrix3<f64>, f64, Vector3<f64>) =
    (Matrix3::new(1.2, 0.1, -0.2, 0.1, 0.8, 0.05, -0.2, 0.05, 0.5), 3.0, Vector3::new(0.1, -0.2, 0.7));

/// F lies on the group and N⁺ is Ad* of N, whatever the tolerance. So rotations stay rotations, and spatial momenta
/// stay constant, to the rounding of all steps. The step is not symplectic. The energy of a body goes astray, the
/// further the larger the tolerance is, and by no more than the tolerance at each step.
#[test]
fn momenta_stay_and_energies_drift() {
    let found = all();
    println!("tolerance   free body, Newton      free body, fixed points   top, Newton            top, exact drifts");
    println!("            energy    momentum     energy    momentum        energy    momentum     energy    momentum");
    for (tolerance, lost) in &found {
        print!("{tolerance:9.1e}");
        lost.iter().for_each(|Lost { energy, momentum, .. }| print!("   {energy:8.1e}  {momentum:8.1e}   "));
        println!();
    }
    for (tolerance, systems) in &found {
        for Lost { energy, momentum, rotation } in systems {
            assert!(*momentum < 1e-11 && *rotation < 1e-11, "{tolerance:e}: {momentum:e} {rotation:e}");
            assert!(energy.is_finite());
        }
    }
    let energies = |system: usize| found.iter().map(move |(tolerance, lost)| (*tolerance, lost[system].energy));
    // a free body by the Moser–Veselov step conserves its energy to rounding, a top keeps it within a bound
    for system in [0, 1] {
        let (_, exact) = energies(system).next().expect("a first one");
        assert!(exact < 1e-10, "{exact:e}");
        for (tolerance, energy) in energies(system).skip(1) {
            assert!(energy < 10.0 * STEPS as f64 * tolerance, "{tolerance:e}: {energy:e}");
        }
        let drifts: Vec<f64> = energies(system).map(|(_, energy)| energy).collect();
        assert!(drifts.windows(2).all(|pair| pair[1] > pair[0] / 2.0), "{drifts:?}");
        assert!(
            drifts[drifts.len() - 1] > 1e3 * drifts[0],
            "{drifts:?}: a tolerance that costs nothing has not been used"
        );
    }
    // with exact drifts it goes astray beyond the bound of the splitting, by less than a thousandth of the tolerance a step
    let drifts: Vec<(f64, f64)> = energies(3).collect();
    for (tolerance, energy) in &drifts {
        assert!(*energy < 1e-5 + 1e-3 * STEPS as f64 * tolerance, "{tolerance:e}: {energy:e}");
    }
    assert!(
        drifts[drifts.len() - 1].1 > 100.0 * drifts[0].1,
        "{drifts:?}: a tolerance that costs nothing has not been used"
    );
}

/// The equation is missed by no more than the tolerance, but for the condition of Σ, and by more than rounding.
///
/// The sum of later corrections is below 4/3 of the tolerance of |x|₁ ≤ √3 |x|, and |Σx| is between 1 and 2.8 of |x|.
#[test]
fn equations_are_missed_by_the_tolerance() -> Result<(), Error> {
    fn missed<S>(stepper: &Stepper<S>, longest: f64) -> f64
    where
        S: Clebsch<
                Scalar = f64,
                Configuration = Matrix3<f64>,
                Momentum = Vector3<f64>,
                Element = Matrix3<f64>,
                Time = (),
            >,
    {
        let mut random = Random::new(82);
        let missed = |_| {
            let (r, pi) = (random.attitude::<3>(), random.unit::<3>() * random.between(0.01, longest));
            let f = stepper.inverse_legendre(&r, &pi).expect("a solvable equation");
            (stepper.legendre(&r, &f) - pi).norm() / pi.norm()
        };
        (0..1000).map(missed).fold(0.0, f64::max)
    }
    let most = |tolerance: f64| 4.0 / 3.0 * 3.0_f64.sqrt() * 2.8 * tolerance;
    let body = second::Body { moments: moments::<f64>() }.into_stepper(H)?;
    let fixed = second::Fixed { moments: moments::<f64>() }.into_stepper(H)?;
    for found in [missed(&body, 5.0), missed(&fixed, 5.0)] {
        assert!((1e-6..most(1e-2)).contains(&found), "1e-2: {found:e}");
    }
    let body = eighth::Body { moments: moments::<f64>() }.into_stepper(H)?;
    let fixed = eighth::Fixed { moments: moments::<f64>() }.into_stepper(H)?;
    for found in [missed(&body, 5.0), missed(&fixed, 5.0)] {
        assert!((1e-13..most(1e-8)).contains(&found), "1e-8: {found:e}");
    }
    // those that fixed points do not solve go over to Newton's method, with the same tolerance
    assert!((1e-13..most(1e-8)).contains(&missed(&fixed, 9.0)));
    Ok(())
}

/// A tolerance below rounding is rounding, in each precision: the same bits.
#[test]
fn tolerances_below_rounding_are_rounding() -> Result<(), Error> {
    macro_rules! compare {
        ($system:ident, $scalar:ty, $precise:ident) => {{
            let h = H as $scalar;
            let one = $precise::$system { moments: moments::<$scalar>() }.into_stepper(h)?;
            let other = rounded::$system { moments: moments::<$scalar>() }.into_stepper(h)?;
            let (r, pi) = start();
            let (r, pi) = (r.map(|x| x as $scalar), pi.map(|x| x as $scalar));
            let (mut a, mut b) = (one.state(r, pi)?, other.state(r, pi)?);
            for _ in 0..100 {
                (a, b) = (one.step(&a)?, other.step(&b)?);
                assert_eq!((a.configuration(), a.momentum()), (b.configuration(), b.momentum()));
            }
        }};
    }
    compare!(Body, f64, invisible);
    compare!(Fixed, f64, invisible);
    compare!(Body, f32, eighth);
    compare!(Fixed, f32, eighth);
    Ok(())
}

/// The loosest tolerance steps like the tightest to within a few times itself.
#[test]
fn steps_agree_to_the_tolerance() -> Result<(), Error> {
    let (r, pi) = start();
    let (mass_matrix, weight, center) = TOP;
    let tolerant = TolerantTop { mass_matrix, weight, center }.into_stepper(H)?;
    let exact = rounded::Top { mass_matrix, weight, center }.into_stepper(H)?;
    let (a, b) = (tolerant.step(&tolerant.state(r, pi)?)?, exact.step(&exact.state(r, pi)?)?);
    assert_near(a.configuration(), b.configuration(), 3e-6, "attitudes");
    assert!(TolerantTop::DERIVATION.contains("below 1e-6 of x"));
    assert!(TolerantTop::DERIVATION.contains("conserved to rounding all the same: the momentum about e3, spatial."));
    Ok(())
}

/// A body of revolution, for all values of its parameters.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<3>, R: SO<3>| R * F,
    lagrangian     = |omega| (self.across * (omega.x.powi(2) + omega.y.powi(2)) + self.along * omega.z.powi(2)) / 2,
    discretization = moser_veselov,
    tolerance      = 1e-3,
)]
pub struct Revolved {
    pub across: f64,
    pub along: f64,
}

/// The spatial momentum is carried by Ad*; the momentum about the axis of revolution stays because the step solves its equation, and so drifts.
#[test]
fn only_momenta_that_are_carried_stay() -> Result<(), Error> {
    let sentence = Revolved::DERIVATION.lines().find(|line| line.contains("all the same")).expect("a sentence");
    for name in ["e1, spatial", "e2, spatial", "e3, spatial", "e3, body"] {
        assert!(Revolved::DERIVATION.contains(&format!("Conserved: the momentum about {name}")), "{name}");
        assert_eq!(sentence.contains(name), name.ends_with("spatial"), "{name}");
    }
    let stepper = Revolved { across: 1.0, along: 2.0 }.into_stepper(0.3)?;
    let (r, pi) = start();
    let end = stepper.advance(&stepper.state(r, pi)?, 1000)?;
    assert_near(&(end.configuration() * end.momentum()), &(r * pi), 1e-13, "the spatial momentum");
    let drift = (end.momentum().z - pi.z).abs();
    assert!((1e-8..1.0).contains(&drift), "about the axis: {drift:e}");
    Ok(())
}
