//! Steps of order 16 by collocation: their invariants over many steps, their results, and that they agree with steps
//! found in other ways.
//!
//! Their order is measured with those of exact drifts, against equations of motion. Their symplectic form is tested
//! with those of all steps, and their lanes with those of all lanes.

#![allow(missing_docs)]

use clebsch::{Clebsch, Error, Scalar};
use clebsch_tests::fixtures::collocated_top::CollocatedTop;
use clebsch_tests::oracle::random::Random;
use nalgebra::{Matrix3, Quaternion, Vector2, Vector3};

/// The same systems of one order.
#[rustfmt::skip]
macro_rules! systems {
    ($name:ident, $($dials:tt)*) => {
        mod $name {
            use clebsch::{Clebsch, Scalar};
            use nalgebra::{Matrix3, Vector3};

            /// A top with any tensor of inertia.
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action     = |F: SO<3>, R: SO<3>| R * F,
                lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
                potential  = |R| self.weight * (R * self.center).z,
                $($dials)*
            )]
            pub struct Top<T: Scalar> {
                #[clebsch(symmetric)]
                pub inertia: Matrix3<T>,
                pub weight: T,
                pub center: Vector3<T>,
            }

            /// A point on a sphere that the time shakes.
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action    = |F: SO<3>, q: Unit<Vector3>| F * q,
                cost      = |h, F| self.mass * (F - I).norm_squared() / (4 * h),
                potential = |t, q| self.gravity * q.z + q.x * (self.rate * t).cos(),
                $($dials)*
            )]
            pub struct Shaken<T: Scalar> {
                pub mass: T,
                pub gravity: T,
                pub rate: T,
            }

            /// A charge in a plane: its momentum is not its velocity, and the action moves the origin.
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action     = |a: Translation<2>, x: Vector2| x + a,
                lagrangian = |x, v| self.mass * v.norm_squared() / 2 + self.field * (x.x * v.y - x.y * v.x) / 2,
                potential  = |x| (x - Vector2::new(1, 0)).norm_squared().powi(2) / 4,
                $($dials)*
            )]
            pub struct Charge<T: Scalar> {
                pub mass: T,
                pub field: T,
            }

            /// Two bobs with a spring between them, each moved by a factor of its own.
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action    = |(F, G): (SO<3>, SO<3>), (q, r): (Unit<Vector3>, Unit<Vector3>)| (F * q, G * r),
                cost      = |h, (F, G)| ((F - I).norm_squared() + self.mass * (G - I).norm_squared()) / (4 * h),
                potential = |(q, r)| self.gravity * q.z + (q - r).norm_squared() / 2,
                $($dials)*
            )]
            pub struct Bobs<T: Scalar> {
                pub mass: T,
                pub gravity: T,
            }
        }
    };
}

systems!(sixteenth, order = 16,);
systems!(eighth, order = 8,);
systems!(loose, order = 16, tolerance = 1e-6,);
systems!(compensated, order = 16, summation = compensated,);

const INERTIA: Matrix3<f64> = Matrix3::new(1.1, 0.1, -0.2, 0.1, 1.9, 0.05, -0.2, 0.05, 2.4);
const CENTER: Vector3<f64> = Vector3::new(0.2, -0.1, 0.6);

macro_rules! top {
    ($name:ident, $scalar:ty) => {{
        // the same in both precisions
        let number = |x: f64| <$scalar as Scalar>::from_f64(f64::from(x as f32));
        $name::Top { inertia: INERTIA.map(number), weight: number(2.0), center: CENTER.map(number) }
    }};
}

fn start() -> (Matrix3<f64>, Vector3<f64>) {
    (Random::new(5).attitude::<3>(), Vector3::new(1.0, -1.5, 2.0))
}

/// (q, N) after `steps` steps of the length `duration / steps`.
fn after<S: Clebsch<Scalar = f64> + Clone>(
    system: S,
    (q, mu): (S::Configuration, S::Momentum),
    duration: f64,
    steps: u32,
) -> Result<(S::Configuration, S::Momentum), Error> {
    let stepper = system.into_stepper(duration / f64::from(steps))?;
    let mut state = stepper.state(q, mu)?;
    for _ in 0..steps {
        state = stepper.step(&state)?;
    }
    Ok((*state.configuration(), state.momentum()))
}

/// Long steps of order 16 and short ones of order 8, which solve other equations, lead to the same place.
#[test]
fn order_eight_leads_to_the_same_place() -> Result<(), Error> {
    let (r, pi) = after(top!(sixteenth, f64), start(), 2.0, 10)?;
    let (other, other_pi) = after(top!(eighth, f64), start(), 2.0, 400)?;
    assert!((r - other).norm() + (pi - other_pi).norm() < 1e-12, "{:e}", (r - other).norm());

    let q = Vector3::new(0.6, 0.0, -0.8);
    let n = q.cross(&Vector3::new(0.3, 1.0, -0.2));
    let (shaken, plain) = (
        sixteenth::Shaken { mass: 1.5, gravity: 2.0, rate: 1.3 },
        eighth::Shaken { mass: 1.5, gravity: 2.0, rate: 1.3 },
    );
    let (p, m) = after(shaken, (q, n), 2.0, 10)?;
    let (other, other_m) = after(plain, (q, n), 2.0, 400)?;
    assert!((p - other).norm() + (m - other_m).norm() < 1e-12, "{:e}", (p - other).norm());

    let (x, v) = (Vector2::new(0.3, -0.4), Vector2::new(0.5, 1.0));
    let (y, w) = after(sixteenth::Charge { mass: 1.5, field: 2.0 }, (x, v), 2.0, 10)?;
    let (other, other_w) = after(eighth::Charge { mass: 1.5, field: 2.0 }, (x, v), 2.0, 400)?;
    assert!((y - other).norm() + (w - other_w).norm() < 1e-12, "{:e}", (y - other).norm());

    let bobs = (q, Vector3::new(0.0, 0.8, 0.6));
    let mut momenta = nalgebra::Vector6::zeros();
    momenta.fixed_rows_mut::<3>(0).copy_from(&n);
    momenta.fixed_rows_mut::<3>(3).copy_from(&bobs.1.cross(&Vector3::new(1.0, -0.5, 0.2)));
    let (pair, mu) = after(sixteenth::Bobs { mass: 0.7, gravity: 2.0 }, (bobs, momenta), 2.0, 10)?;
    let (other, other_mu) = after(eighth::Bobs { mass: 0.7, gravity: 2.0 }, (bobs, momenta), 2.0, 400)?;
    let off = (pair.0 - other.0).norm() + (pair.1 - other.1).norm() + (mu - other_mu).norm();
    assert!(off < 1e-12, "{off:e}");
    Ok(())
}

/// J(q⁺, p⁺) = N⁺: both representations are one step.
#[test]
fn representations_agree() -> Result<(), Error> {
    let stepper = top!(sixteenth, f64).into_stepper(0.2)?;
    let (r, p) = (start().0, Random::new(8).matrix::<3, 3>());
    let pi = stepper.system().momentum_map(&r, &p);
    let state = stepper.step(&stepper.state(r, pi)?)?;
    let pair = stepper.step_symmetric(&stepper.cotangent_state(r, p)?)?;
    assert!((state.configuration() - pair.configuration()).norm() < 1e-14);
    let map = stepper.system().momentum_map(pair.configuration(), pair.covector());
    assert!((map - state.momentum()).norm() < 1e-14, "{:e}", (map - state.momentum()).norm());
    Ok(())
}

/// The invariants after 5000 steps of a fifth of a radian, with `heavy` after 10⁵: orbit, vertical momentum and energy are at round-off. Their
/// sum grows like the root of the number of steps.
#[test]
fn invariants_stay_at_rounding() -> Result<(), Error> {
    const STEPS: u32 = if cfg!(feature = "heavy") { 100_000 } else { 5000 };
    let top = CollocatedTop { moments: Vector3::new(1.0, 1.5, 2.0), weight: 1.0 };
    let stepper = top.into_stepper(0.1)?;
    let q = Quaternion::new(0.25_f64.cos(), 0.25_f64.sin(), 0.0, 0.0);
    let begin = stepper.state(q, Vector3::new(0.1, 0.3, 4.0))?;
    let (energy, vertical) = (stepper.energy(&begin), stepper.conserved(&begin)[0]);
    let mut state = begin;
    let (mut drift, mut turned, mut off) = (0.0_f64, 0.0_f64, 0.0_f64);
    for _ in 0..STEPS {
        state = stepper.step(&state)?;
        drift = drift.max((stepper.energy(&state) / energy - 1.0).abs());
        turned = turned.max((stepper.conserved(&state)[0] / vertical - 1.0).abs());
        off = off.max((state.configuration().norm_squared() - 1.0).abs());
    }
    println!("after {STEPS} steps: energy {drift:.1e}, vertical momentum {turned:.1e}, |q|² {off:.1e}");
    let rounding = f64::EPSILON * f64::from(STEPS).sqrt();
    assert!(drift < 4.0 * rounding && turned < 4.0 * rounding && off < 4.0 * rounding, "{drift:e} {turned:e} {off:e}");
    Ok(())
}

/// Rounding errors of sums are stored with the state, as in other steps.
#[test]
fn compensated_sums_round_less() -> Result<(), Error> {
    let (plain, kept, exact) = (top!(sixteenth, f32), top!(compensated, f32), top!(sixteenth, f64));
    let (r, pi) = (Matrix3::identity(), start().1);
    let h = 1.0 / 32.0;
    let (plain, kept, exact) = (plain.into_stepper(h as f32)?, kept.into_stepper(h as f32)?, exact.into_stepper(h)?);
    let (single, pi_single) = (r.map(|x| x as f32), pi.map(|x| x as f32));
    let mut states = (plain.state(single, pi_single)?, kept.state(single, pi_single)?, exact.state(r, pi)?);
    let [mut worst, mut worst_kept] = [0.0_f64; 2];
    for _ in 0..2000 {
        states = (plain.step(&states.0)?, kept.step(&states.1)?, exact.step(&states.2)?);
        let off = |r: &Matrix3<f32>| (r.map(f64::from) - states.2.configuration()).norm();
        (worst, worst_kept) = (worst.max(off(states.0.configuration())), worst_kept.max(off(states.1.configuration())));
    }
    println!("single precision: {worst:.1e} plain, {worst_kept:.1e} compensated");
    assert!(worst_kept < worst / 8.0 && worst < 0.1, "{worst:e} {worst_kept:e}");
    Ok(())
}

/// A tolerance is the error that the step may have: sweeps end earlier, and the difference to the settled step is below
/// it.
#[test]
fn tolerances_end_sweeps() -> Result<(), Error> {
    let (settled, loose) = (top!(sixteenth, f64).into_stepper(0.25)?, top!(loose, f64).into_stepper(0.25)?);
    let (r, pi) = start();
    let (exact, near) = (settled.step(&settled.state(r, pi)?)?, loose.step(&loose.state(r, pi)?)?);
    let off = (exact.configuration() - near.configuration()).norm() + (exact.momentum() - near.momentum()).norm();
    assert!((1e-12..1e-6).contains(&off), "{off:e}");
    Ok(())
}

/// A state that cannot be stepped is an error, and stays as it was.
#[test]
fn failures_are_typed() -> Result<(), Error> {
    let top = top!(sixteenth, f64);
    let (r, pi) = start();
    let long = top.stepper(40.0)?;
    let state = long.state(r, pi)?;
    assert!(matches!(long.step(&state), Err(Error::NotConverged { .. } | Error::NotFinite { .. })), "40 s");
    assert_eq!((*state.configuration(), state.momentum()), (r, pi));
    let heavy = sixteenth::Top { weight: f64::INFINITY, ..top };
    assert!(matches!(heavy.into_stepper(0.1), Err(Error::NotFinite { name: "weight" })));
    // numbers overflow within the step
    let shaken = sixteenth::Shaken { mass: 1.0, gravity: 1e200, rate: 1.0 }.into_stepper(1e100)?;
    let shaken = shaken.step(&shaken.state(Vector3::x(), Vector3::y())?);
    assert!(matches!(shaken, Err(Error::NotConverged { .. } | Error::NotFinite { .. })), "{shaken:?}");
    Ok(())
}

/// Back by −h from where h leads.
#[test]
fn steps_are_reversible() -> Result<(), Error> {
    let (forth, back) = (top!(sixteenth, f64).into_stepper(0.2)?, top!(sixteenth, f64).into_stepper(-0.2)?);
    let (r, pi) = start();
    let there = forth.step(&forth.state(r, pi)?)?;
    let again = back.step(&back.state(*there.configuration(), there.momentum())?)?;
    let off = (again.configuration() - r).norm() + (again.momentum() - pi).norm();
    assert!(off < 1e-14, "{off:e}");
    Ok(())
}
