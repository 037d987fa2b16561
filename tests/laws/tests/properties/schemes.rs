//! Schemes: a step is its parts, one after the other.

use crate::arbitrary::{attitude, cases, definite, matrix, vector};
use crate::bodies::{H, damped_bodies, tops};
use crate::runner::proptest;
use clebsch::__private::{
    At, FreeMotion, GreatCircles, HamiltonEquations, Parts, Scheme, SplitKicks, Substep, TimeTransformed, VariedSubstep,
};
use clebsch::{Clebsch, Error, Variational};
use clebsch_tests::fixtures::collocated_top::CollocatedTop;
use clebsch_tests::fixtures::damped_body::DampedBody;
use clebsch_tests::fixtures::eccentric_orbit::EccentricOrbit;
use clebsch_tests::fixtures::exact_body::ExactBody;
use clebsch_tests::fixtures::midpoint_top::MidpointTop;
use clebsch_tests::fixtures::neumann20::Neumann20;
use clebsch_tests::fixtures::sixth_order_top::SixthOrderTop;
use clebsch_tests::fixtures::split_top::SplitTop;
use clebsch_tests::fixtures::watched_top::WatchedTop;
use clebsch_tests::oracle::near::assert_near;
use clebsch_tests::stepping::Stepping;
use nalgebra::{Matrix3, Quaternion, SMatrix, SVector, Vector3};
use proptest::prelude::*;

const NEAR: f64 = 1e-12;

type Pair = (Matrix3<f64>, Vector3<f64>);

/// kick, solve, move, update, kick.
fn kick_drift_kick(top: &WatchedTop, (q, mu): &Pair) -> Result<Pair, Error> {
    let constants = top.constants(H)?;
    let mu = mu + Substep::<0>::start_kick(top, &constants, 0.0, q).expect("a kick");
    let x = Substep::<0>::solve(top, &constants, 0.0, q, &mu, &())?;
    let motion = top.motion(&x, || top.increment(&x));
    let next = Parts::advance(top, q, &motion);
    let mu = Substep::<0>::update(top, &constants, 0.0, q, &mu, &motion).expect("an update");
    let mu = mu + Substep::<0>::end_kick(top, &constants, 0.0, &next).expect("a kick");
    Ok((WatchedTop::on_space(next, ()).0, mu))
}

/// The same of (q, p).
fn symmetric(top: &WatchedTop, q: &Matrix3<f64>, p: &Matrix3<f64>) -> Result<(Matrix3<f64>, Matrix3<f64>), Error> {
    let constants = top.constants(H)?;
    let p = p + Substep::<0>::start_gradient(top, &constants, 0.0, q).expect("a gradient");
    let x = Substep::<0>::solve(top, &constants, 0.0, q, &top.momentum_map(q, &p), &())?;
    let d = top.increment(&x);
    let next = Parts::advance(top, q, &top.motion(&x, || d));
    let p = top.lift(&next, &p, &d);
    Ok((next, p + Substep::<0>::end_gradient(top, &constants, 0.0, &next).expect("a gradient")))
}

/// A point on a line that the time pushes and pulls.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |a: Translation<1>, x: Vector1| x + a,
    lagrangian = |v| v.norm_squared() / 2,
    potential  = |t, x| self.strength * ((self.rate * t).sin() * x.norm_squared() - (self.rate * t).cos() * x.x),
    order      = 16,
)]
struct Pushed {
    strength: f64,
    rate: f64,
}

/// How a top of sixth order is stepped.
type SixthOrder = <SixthOrderTop as Clebsch>::Scheme;

proptest! {
    #![proptest_config(cases(32))]

    /// A step is a kick, the solve, the move, the update and a kick, in both representations. F = I + D has the
    /// momentum that was solved for.
    #[test]
    fn steps_are_their_parts(top in tops(), r in attitude(), mu in vector::<3>(2.0), p in matrix::<3, 3>(1.0)) {
        let stepper = top.stepper(H)?;
        let next = stepper.step(&stepper.state(r, mu)?)?;
        prop_assert_eq!(kick_drift_kick(&top, &(r, mu))?, next.into_parts());
        let next = stepper.step_symmetric(&stepper.cotangent_state(r, p)?)?;
        prop_assert_eq!(symmetric(&top, &r, &p)?, next.into_parts());
        let constants = top.step_constants(H)?;
        let kicked = mu + Substep::<0>::start_kick(&top, &constants, 0.0, &r).expect("a kick");
        let x = Substep::<0>::solve(&top, &constants, 0.0, &r, &kicked, &())?;
        let f = WatchedTop::element(&top.increment(&x));
        prop_assert_eq!(f, Stepping::inverse_legendre(&top, &constants, 0.0, &r, &mu)?);
        assert_near(&top.legendre(H, 0.0, &r, &f), &mu, 1e-10, "F⁻ℓd");
    }

    /// The methods of a system's scheme, and those of the system that stand for them. Several steps at once and in
    /// place are steps one by one.
    #[test]
    fn schemes_step_systems(inertia in definite::<3>(), weight in 0.1_f64..3.0, center in vector::<3>(1.0), r in attitude(), mu in vector::<3>(2.0), p in matrix::<3, 3>(1.0)) {
        let top = SixthOrderTop { inertia, weight, center };
        let stepper = top.stepper(H)?;
        let constants = SixthOrder::constants(&top, H)?;
        let same = top.step_constants(H)?;
        let energy = |constants| top.kinetic_energy(constants, 0.0, &r, &mu);
        prop_assert_eq!(energy(<SixthOrder as Scheme<SixthOrderTop>>::whole(&constants)), energy(&top.constants(H)?));
        let held = <SixthOrder as Scheme<SixthOrderTop>>::held(&r, &mu);
        prop_assert_eq!(SixthOrderTop::held(&r, &mu), held);
        prop_assert_eq!(<SixthOrder as Scheme<SixthOrderTop>>::momentum(&r, &held), SixthOrderTop::momentum_held(&r, &held));
        let at = At::new(&top, &constants, 0.0);
        let left = SixthOrder::left(at, &r, &mu);
        prop_assert_eq!(top.impulse(&same, 0.0, &r, &mu), left);
        prop_assert_eq!(SixthOrder::left_after(at, &r, &mu, &left), left);
        // saved data stays, and wrong data is made anew
        prop_assert_eq!(SixthOrder::resumed(at, &r, &mu, &left), left);
        prop_assert_eq!(SixthOrder::resumed(at, &r, &mu, &(left + Vector3::repeat(1e16))), left);
        prop_assert_eq!(<SixthOrder as Scheme<SixthOrderTop>>::held_defect(&r, &held), 0.0);
        let one = SixthOrder::step(at, (&r, &held, &left), &())?;
        prop_assert_eq!(Stepping::step(&top, &same, 0.0, &r, &held, &left, &())?, one);
        prop_assert_eq!((one.0, one.1), stepper.step(&stepper.state(r, mu)?)?.into_parts());
        let mut place = (r, held, left);
        let into = (&mut place.0, &mut place.1, &mut place.2);
        SixthOrder::step_into(at, (&r, &held, &left), &(), into)?;
        prop_assert_eq!(place, one);
        let two = SixthOrder::step(At::new(&top, &constants, H), (&one.0, &one.1, &one.2), &())?;
        prop_assert_eq!(SixthOrder::steps(at, H, 2, (&r, &held, &left), &())?, two);
        let symmetric = SixthOrder::step_symmetric(at, &r, &p)?;
        prop_assert_eq!(Stepping::step_symmetric(&top, &same, 0.0, &r, &p)?, symmetric);
        let f = SixthOrder::inverse_legendre(at, &r, &mu)?;
        assert_near(&top.legendre(H, 0.0, &r, &f), &mu, 1e-10, "F⁻ℓd");
        // kicks are linear in the step size: the impulse for a step that is twice as long
        let twice = <<WatchedTop as Clebsch>::Scheme as Scheme<WatchedTop>>::scaled(mu, 2.0);
        prop_assert_eq!(twice, mu * 2.0);
    }

    /// Forces push at both ends, by the velocity of the step: N⁺ = M⁺ + end force with M = N + start force.
    #[test]
    fn forces_push_at_both_ends(body in damped_bodies(), r in attitude(), mu in vector::<3>(1.0), u in vector::<3>(1.0)) {
        let stepper = body.stepper(H)?;
        let constants = body.constants(H)?;
        let next = stepper.step_with(&stepper.state(r, mu)?, &u)?;
        let pushed = mu + Substep::<0>::start_force(&body, &constants, 0.0, &r, &u).expect("a torque");
        let x = Substep::<0>::solve(&body, &constants, 0.0, &r, &pushed, &u)?;
        let motion = body.motion(&x, || body.increment(&x));
        let moving = Substep::<0>::moving_force(&body, &constants, 0.0, &r, &x, &u).expect("damping");
        let reached = Parts::advance(&body, &r, &motion);
        let moved = Substep::<0>::update(&body, &constants, 0.0, &r, &(pushed + moving), &motion).expect("an update");
        let end = moved + Substep::<0>::end_force(&body, &constants, 0.0, &reached, &x, &u).expect("a torque");
        prop_assert_eq!((DampedBody::on_space(reached, ()).0, end), next.into_parts());
        // half of h times the torque less the damping, at each end; the damping of the start is that of the same velocity
        let torque = Substep::<0>::start_force(&body, &constants, 0.0, &r, &u).expect("a torque") + moving;
        let at_end = Substep::<0>::end_force(&body, &constants, 0.0, &reached, &x, &u).expect("a torque");
        assert_near(&torque, &at_end, NEAR, "both ends");
    }

    /// A cost that couples: its value at F = I is no momentum of the motion, and its slope moves the covector.
    #[test]
    fn coupled_costs_have_slopes(mass in definite::<3>(), weight in 0.1_f64..3.0, center in vector::<3>(1.0), r in attitude(), p in matrix::<3, 3>(1.0)) {
        let top = MidpointTop { mass_matrix: mass, weight, stiffness: 0.5, center };
        let constants = top.constants(H)?;
        let stepper = top.stepper(H)?;
        let start = stepper.cotangent_state(r, p)?;
        let rest = Substep::<0>::rest(&top, &constants, 0.0, &r).expect("what is left at F = I");
        let x = Substep::<0>::solve(&top, &constants, 0.0, &r, &(top.momentum_map(&r, &p) + rest), &())?;
        let d = top.increment(&x);
        let pushed = p + Substep::<0>::coupled_gradient(&top, &constants, 0.0, &r, &d).expect("a slope");
        let next = Parts::advance(&top, &r, &top.motion(&x, || d));
        prop_assert_eq!((next, top.lift(&next, &pushed, &d)), stepper.step_symmetric(&start)?.into_parts());
    }

    /// The constants of a free motion stay: a step follows it from its place.
    #[test]
    fn free_motions_are_followed(moments in vector::<3>(0.4), r in attitude(), mu in vector::<3>(2.0)) {
        let body = ExactBody { moments: moments.add_scalar(1.0) };
        let constants = body.constants(H)?;
        let stepper = body.stepper(H)?;
        let next = stepper.step(&stepper.state(r, mu)?)?;
        let (x, moved) = body.follow(&constants, &body.kept(&constants, &mu), &mu)?;
        let motion = body.motion(&x, || body.increment(&x));
        let after = Substep::<0>::update(&body, &constants, 0.0, &r, &moved, &motion).unwrap_or(moved);
        prop_assert_eq!((ExactBody::on_space(Parts::advance(&body, &r, &motion), ()).0, after), next.into_parts());
        // the same motion, one step later
        let again = stepper.step(&next)?;
        let later = body.kept(&constants, &next.momentum());
        let (x, moved) = body.follow(&constants, &later, &next.momentum())?;
        let motion = body.motion(&x, || body.increment(&x));
        let after = Substep::<0>::update(&body, &constants, 0.0, next.configuration(), &moved, &motion).unwrap_or(moved);
        assert_near(&after, &again.momentum(), NEAR, "N");
    }

    /// Kicks of a splitting are those of a potential with these weights: J of the gradient.
    #[test]
    fn kicks_of_splittings_are_momenta(inertia in definite::<3>(), weight in 0.1_f64..3.0, center in vector::<3>(1.0), r in attitude(), b in -1.0_f64..1.0, g in -0.1_f64..0.1) {
        let top = SplitTop { inertia, weight, center };
        let constants = top.constants(H)?;
        prop_assert_eq!(SplitTop::step_size(&constants), H);
        let (kick, gradient) = (top.kick(&constants, 0.0, &r, b, g), top.kick_gradient(&constants, 0.0, &r, b, g));
        assert_near(&top.momentum_map(&r, &gradient), &kick, NEAR, "J(q, ∂U)");
    }

    /// A monitor, its slope, and the kick for a step of that time; a step from a place takes about h g.
    #[test]
    fn monitors_set_the_times_of_steps(mass in 0.5_f64..2.0, strength in 0.5_f64..2.0, q in vector::<3>(1.0), mu in vector::<3>(0.5), t in -1.0_f64..1.0) {
        prop_assume!(q.norm() > 0.3);
        type Steps = <EccentricOrbit as Clebsch>::Scheme;
        let (h, orbit) = (1e-3, EccentricOrbit { mass, strength });
        let constants = orbit.constants(h)?;
        prop_assert_eq!(<EccentricOrbit as TimeTransformed>::step_size(&constants), h);
        prop_assert!((orbit.monitor(&constants, &q) - q.norm()).abs() < NEAR, "g");
        let kick = orbit.monitored_kick(&constants, t, &q);
        assert_near(&kick, &(-q * (h * strength / q.norm_squared())), NEAR, "−h g J(q, ∂V)");
        // h ġ/g with the velocity μ/m
        let rate = orbit.monitor_slope(&constants, &q).dot(&mu);
        prop_assert!((rate - h * q.dot(&mu) / (mass * q.norm_squared())).abs() < NEAR, "γ·μ");
        let at = At::new(&orbit, &constants, t);
        prop_assert_eq!(Steps::check_monitor(at, &q), Ok(()));
        prop_assert_eq!(Steps::check_monitor(at, &(q * 0.0)), Err(Error::Monitor { value: 0.0 }));
        let left = Steps::left(at, &q, &mu);
        let now = <Steps as Scheme<EccentricOrbit>>::now;
        prop_assert_eq!(now(&left), Some(t));
        // at another place W is that of the place
        prop_assert_eq!(Steps::left_elsewhere(at, &(q * 1.05), &mu, &left), Steps::left(at, &(q * 1.05), &mu));
        let (.., left) = Steps::step(at, (&q, &mu, &left), &())?;
        let took = now(&left).map_or(f64::NAN, |now| now - t);
        prop_assert!((took / (h * q.norm()) - 1.0).abs() < 0.02, "the time of a step is {took}");
    }

    /// Hamilton's equations: J(q, p) = μ of the covector, its slope by the torque alone, and a guess that is the velocity.
    #[test]
    fn slopes_are_those_of_hamilton(moments in vector::<3>(0.4), weight in 0.1_f64..3.0, q in vector::<4>(1.0), mu in vector::<3>(1.0)) {
        prop_assume!(q.norm() > 0.1);
        let top = CollocatedTop { moments: moments.add_scalar(1.0), weight };
        let constants = top.constants(H)?;
        let q = Quaternion::from(q.normalize());
        prop_assert_eq!(<CollocatedTop as HamiltonEquations<8>>::step_size(&constants), H);
        let p = HamiltonEquations::<8>::covector(&top, &constants, &q, &mu);
        assert_near(&top.momentum_map(&q, &p), &mu, NEAR, "J(q, p)");
        assert_near(&HamiltonEquations::<8>::momentum(&top, &q, &p), &mu, NEAR, "J(q, p) of a step");
        let y = <CollocatedTop as HamiltonEquations<8>>::joined(&q, &p);
        prop_assert_eq!(<CollocatedTop as HamiltonEquations<8>>::parted(&y), (q, p));
        let (dq, dp) = <CollocatedTop as HamiltonEquations<8>>::parted(&HamiltonEquations::<8>::slope(&top, &constants, 0.0, &[], &y));
        // Ad* keeps |μ| and the potential pushes across the vertical: μ̇·Rᵀe₃ = 0
        let slope = top.momentum_map(&dq, &p) + top.momentum_map(&q, &dp);
        let velocity = mu.component_div(&top.moments);
        let vertical = nalgebra::UnitQuaternion::from_quaternion(q).inverse() * Vector3::z();
        let torque = vertical.cross(&Vector3::z()) * weight;
        assert_near(&slope, &(mu.cross(&velocity) + torque), 1e-11, "μ̇ = μ × ω + m g Γ × χ");
        let guess = HamiltonEquations::<8>::guess(&top, &constants, 0.0, &q, &mu);
        let half = <CollocatedTop as HamiltonEquations<8>>::part(&guess, 0.5);
        let f = CollocatedTop::element(&top.increment(&half));
        assert_near(&(f.imag() * 4.0 / H), &velocity, 1e-2, "ω");
    }

    /// A force of the time alone: p′ is made of the terms of that time, and q′ of p.
    #[test]
    fn slopes_take_the_terms_of_their_time(strength in 0.5_f64..2.0, rate in 0.1_f64..3.0, t in -5.0_f64..5.0, x in vector::<1>(1.0), p in vector::<1>(1.0)) {
        let pushed = Pushed { strength, rate };
        let constants = pushed.constants(H)?;
        let terms: [f64; 2] = pushed.terms_of_time(&constants, t);
        let [velocity, force] = pushed.slope(&constants, t, &terms, &[x.x, p.x]);
        prop_assert_eq!(velocity, p.x);
        let expected = strength * ((rate * t).cos() - 2.0 * (rate * t).sin() * x.x);
        prop_assert!((force - expected).abs() < NEAR, "{force} for {expected}");
    }

    /// A great circle is turned by h/κ: of a point that nothing pushes that is its angle.
    #[test]
    fn points_turn_by_the_step_over_the_inertia(q in vector::<21>(1.0), w in vector::<21>(1.0), speed in 0.1_f64..2.0) {
        let q = q.normalize();
        let point = Neumann20 { stiffness: SMatrix::zeros() };
        let constants = point.constants(H)?;
        let w = (w - q * q.dot(&w)).normalize() * speed;
        let a = Neumann20::turn(&constants);
        let stepper = point.stepper(H)?;
        let next = stepper.step(&stepper.state(q, point.momentum_map(&q, &w))?)?;
        let expected: SVector<f64, 21> = q * (1.0 - (a * speed).powi(2)).sqrt() + w * a;
        assert_near(next.configuration(), &expected, NEAR, "q⁺");
    }

    /// The derivatives of an edge are those that a path is made of.
    #[test]
    fn edges_are_those_of_substeps(top in tops(), r in attitude(), eta in vector::<3>(0.5)) {
        let constants = top.step_constants(H)?;
        let d = top.retraction(&eta);
        let next = Variational::advance(&top, &r, &d);
        let edge = VariedSubstep::<0, 3>::edge(&top, &constants, 0.0, (&r, &d, &next, &()));
        prop_assert_eq!(edge, Variational::edge(&top, &constants, 0, 0.0, (&r, &d, &next, &())));
        let momenta = VariedSubstep::<0, 3>::momenta(&top, &constants, 0.0, (&r, &d, &next, &()));
        assert_near(&momenta.before, &edge.before, NEAR, "N");
        let carried = VariedSubstep::<0, 3>::carried(&top, &constants, 0.0, (&r, &d, &next, &()));
        assert_near(&carried.before, &(edge.before_by_start + edge.before_by_end * carried.adjoint), 1e-10, "∂N");
        let (before, _) = VariedSubstep::<0, 3>::slopes(&top, &constants, 0.0, (&r, &d, &next, &()));
        // N = (F𝒥 − 𝒥Fᵀ)/h less half a kick: the slope along the weight is that of the kick
        let heavier = WatchedTop { weight: top.weight + 1.0, ..top.clone() };
        let change = VariedSubstep::<0, 3>::momenta(&heavier, &heavier.step_constants(H)?, 0.0, (&r, &d, &next, &())).before - momenta.before;
        assert_near(&before.column(3).into_owned(), &change, 1e-9, "∂N/∂weight");
        // without a constraint a step passes the edge as it is, whatever its momentum
        let at = (&constants, 0.0, (&r, &d, &next, &()), &momenta.before);
        let passed = VariedSubstep::<0, 3>::passed(&top, at.0, at.1, at.2, at.3, carried).expect("an edge");
        prop_assert_eq!((passed.edge, passed.balance), (carried, None));
        let slopes = VariedSubstep::<0, 3>::slopes_passed(&top, at.0, at.1, at.2, at.3).expect("slopes");
        prop_assert_eq!(slopes.0, before);
    }
}
