//! States that are changed from outside: impulses, other configurations, steps of other sizes.

use crate::arbitrary::{attitude, cases, definite, unit, vector};
use crate::bodies::{H, generic_top, pendulums, satellites, staggered_tops, tops};
use crate::runner::proptest;
use crate::whole::Neumann;
use clebsch::__private::{At, Scheme};
use clebsch::{Clebsch, Error, F64x4, SiteStorage, Stepper};
use clebsch_tests::fixtures::chaplygin_sleigh::ChaplyginSleigh;
use clebsch_tests::fixtures::compensated_top::CompensatedTop;
use clebsch_tests::fixtures::exact_body::ExactBody;
use clebsch_tests::fixtures::free_rigid_body::FreeRigidBody;
use clebsch_tests::fixtures::sixth_order_top::SixthOrderTop;
use clebsch_tests::fixtures::spin_chain::SpinChain;
use clebsch_tests::oracle::near::assert_near;
use nalgebra::{Matrix3, SVector, Vector3};
use proptest::prelude::*;

const NEAR: f64 = 1e-12;

/// A point on a large sphere that nothing pushes: its state holds the plane of its motion.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(action = |F: SO<8>, q: Unit<SVector<8>>| F * q, cost = |h, F| (F - I).norm_squared() / (4 * h), scalar = f64)]
struct FreePoint;

/// A hit after some steps of a body that turns freely. Its spatial momentum is constant before and after, and jumps
/// by RΔμ: Ad* of a right action.
fn hit<S>(stepper: &Stepper<S>, (r, mu): (Matrix3<f64>, Vector3<f64>), push: Vector3<f64>) -> Result<(), Error>
where
    S: Clebsch<Scalar = f64, Configuration = Matrix3<f64>, Momentum = Vector3<f64>>,
{
    let before = stepper.advance(&stepper.state(r, mu)?, 5)?;
    let after = stepper.kick(&before, push)?;
    assert_eq!(after.configuration(), before.configuration());
    // compensated sums round the rounding error of N with it
    assert_near(&after.momentum(), &(before.momentum() + push), 4.0 * f64::EPSILON, "N + Δμ");
    let attitude = before.configuration();
    let end = stepper.advance(&after, 5)?;
    let spatial = end.configuration() * end.momentum();
    assert_near(&spatial, &(r * mu + attitude * push), NEAR, "the jump of the spatial momentum");
    // as if it had started with this momentum
    let anew = stepper.advance(&stepper.state(*attitude, before.momentum() + push)?, 5)?;
    assert_near(end.configuration(), anew.configuration(), NEAR, "the attitude");
    Ok(())
}

/// A hit of a point on S⁷ by a push p on its place: Δμ = J(q, p).
fn hit_point<S, const D: usize>(
    stepper: &Stepper<S>,
    start: [SVector<f64, 8>; 2],
    p: SVector<f64, 8>,
) -> Result<(), Error>
where
    S: Clebsch<Scalar = f64, Configuration = SVector<f64, 8>, Momentum = SVector<f64, D>>,
{
    let [q, v] = start;
    let q = q.normalize();
    let before = stepper.advance(&stepper.state(q, stepper.momentum_map(&q, &v))?, 5)?;
    let push = stepper.momentum_map(before.configuration(), &p);
    let after = stepper.kick(&before, push)?;
    assert_near(&after.momentum(), &(before.momentum() + push), NEAR, "N + Δμ");
    let anew = stepper.state(*before.configuration(), before.momentum() + push)?;
    let (end, anew) = (stepper.advance(&after, 5)?, stepper.advance(&anew, 5)?);
    assert_near(end.configuration(), anew.configuration(), NEAR, "the place");
    assert_near(&end.momentum(), &anew.momentum(), NEAR, "the momentum");
    let aside = SVector::from_fn(|i, _| if i == 0 { 1.0 } else { 0.0 });
    let refused = stepper.kick(&after, aside);
    let is_refused = matches!(refused, Err(Error::OutsideMomentumSpace { .. }));
    assert!(is_refused, "a push along motions that fix q: {refused:?}");
    Ok(())
}

proptest! {
    #![proptest_config(cases(16))]

    /// N⁺ = N + Δμ at the same q, whatever a state takes along.
    #[test]
    fn kicks_add_to_momenta(inertia in definite::<3>(), center in vector::<3>(1.0), r in attitude(), mu in vector::<3>(2.0), push in vector::<3>(1.0), place in vector::<8>(1.0), v in vector::<8>(1.0), p in vector::<8>(1.0)) {
        prop_assume!(place.norm() > 0.1);
        hit(&FreeRigidBody { inertia }.into_stepper(H)?, (r, mu), push)?;
        hit(&ExactBody { moments: Vector3::new(1.0, 1.5, 2.0) }.into_stepper(H)?, (r, mu), push)?;
        hit(&CompensatedTop { mass_matrix: inertia, weight: 0.0, center }.into_stepper(H)?, (r, mu), push)?;
        hit(&SixthOrderTop { inertia, weight: 0.0, center }.into_stepper(H)?, (r, mu), push)?;
        hit_point(&FreePoint.into_stepper(H)?, [place, v], p)?;
        hit_point(&Neumann { stiffness: v }.into_stepper(H)?, [place, v], p)?;
        // the impulse of the potential stays: a push and its reverse change nothing but the last place
        let stepper = SixthOrderTop { inertia, weight: 1.0, center }.into_stepper(H)?;
        let state = stepper.step(&stepper.state(r, mu)?)?;
        prop_assert_eq!(stepper.step(&stepper.kick(&state, Vector3::zeros())?)?, stepper.step(&state)?);
        let refused = stepper.kick(&state, Vector3::new(0.0, f64::NAN, 0.0));
        prop_assert_eq!(refused.err(), Some(Error::NotFinite { name: "the impulse" }));
        let constants = <SixthOrderTop as Clebsch>::Scheme::constants(stepper.system(), H)?;
        let at = At::new(stepper.system(), &constants, 0.0);
        let kicked = <SixthOrderTop as Clebsch>::Scheme::kicked(at, &r, (&mu, &center), &push);
        prop_assert_eq!(kicked, (mu + push, center));
        // compensated sums: a thousand pushes below the last place add up
        let stepper = CompensatedTop { mass_matrix: inertia, weight: 0.0, center }.into_stepper(H)?;
        let mut state = stepper.state(r, Vector3::x())?;
        for _ in 0..1000 {
            state = stepper.kick(&state, Vector3::x() * 1e-17)?;
        }
        prop_assert_eq!(stepper.kick(&state, Vector3::zeros())?.momentum().x, 1.0 + 1e-14);
    }

    /// The blade of a sleigh answers: with ξ = (ω, v, 0) its momentum is ((J + ma²)ω, mv, maω).
    #[test]
    fn constraints_answer_kicks(mass in 0.5_f64..2.0, inertia in 0.5_f64..2.0, offset in 0.1_f64..1.0, xi in vector::<2>(1.0), push in vector::<3>(1.0)) {
        let stepper = ChaplyginSleigh { mass, inertia, offset }.into_stepper(H)?;
        let start = stepper.state_moving(Matrix3::identity(), Vector3::new(xi.x, xi.y, 0.0))?;
        let kicked = stepper.kick(&stepper.step(&start)?, push)?;
        let before = stepper.step(&start)?.momentum() + push;
        let omega = before.x / (inertia + mass * offset * offset);
        assert_near(&kicked.momentum(), &Vector3::new(before.x, before.y, mass * offset * omega), NEAR, "the blade");
        stepper.step(&kicked)?;
    }

    /// The components of N stay, without those that motions of the new q cannot have.
    #[test]
    fn states_move_to_other_places(pendulum in pendulums(), top in tops(), q in unit(), other in unit(), mu in vector::<3>(1.0), r in attitude(), turn in attitude()) {
        let stepper = pendulum.stepper(H)?;
        let moved = stepper.with_configuration(&stepper.step(&stepper.project(q, mu)?)?, other)?;
        prop_assert_eq!(moved.configuration(), &other);
        let before = stepper.step(&stepper.project(q, mu)?)?.momentum();
        assert_near(&moved.momentum(), &(before - other * other.dot(&before)), NEAR, "tangential");
        prop_assert_eq!(stepper.step(&moved)?, stepper.step(&stepper.state(other, moved.momentum())?)?);
        let refused = stepper.with_configuration(&moved, other * 1.1);
        let is_refused = matches!(refused, Err(Error::OffOrbit { .. }));
        prop_assert!(is_refused, "{refused:?}");
        let stepper = top.stepper(H)?;
        let state = stepper.step(&stepper.state(r, mu)?)?;
        let moved = stepper.with_configuration(&state, turn)?;
        prop_assert_eq!(moved.into_parts(), (turn, state.momentum()));
    }

    /// A step of another size is the step of a stepper of that size.
    #[test]
    fn steps_of_other_sizes_agree(top in tops(), staggered in staggered_tops(), satellite in satellites(), r in attitude(), mu in vector::<3>(1.0), part in 0.1_f64..1.0) {
        let stepper = top.stepper(H)?;
        let state = stepper.step(&stepper.state(r, mu)?)?;
        prop_assert_eq!(stepper.step_for(&state, H)?, stepper.step(&state)?);
        let other = stepper.with_step_size(part * H)?;
        prop_assert_eq!(other.step_size(), part * H);
        let next = stepper.step_for(&state, part * H)?;
        prop_assert_eq!(next, other.step(&state)?);
        // the step after it has the size of its stepper again
        assert_near(stepper.step(&next)?.configuration(), stepper.step(&stepper.state(*next.configuration(), next.momentum())?)?.configuration(), NEAR, "goes on");
        prop_assert_eq!(stepper.step_for(&state, 0.0).err(), Some(Error::StepSize { value: 0.0 }));
        let Err(Error::Unsolvable { step_size, .. }) = stepper.step_for(&stepper.state(r, mu.normalize() * 50.0)?, 2.0) else {
            return Err(TestCaseError::fail("a turn by a hundred radians has no solution"));
        };
        prop_assert_eq!(step_size, Some(2.0));
        // with order 1 readings are those of order 2
        let first = staggered.stepper(H)?;
        let second = generic_top::<f64>(&staggered.mass_matrix, staggered.weight, &staggered.center).into_stepper(H)?;
        let one = first.step_for(&first.step(&first.staggered_state(r, mu)?)?, part * H)?;
        let two = second.step_for(&second.step(&second.state(r, mu)?)?, part * H)?;
        assert_near(one.configuration(), two.configuration(), NEAR, "the same attitude");
        assert_near(&first.synchronized(&one), &two.momentum(), NEAR, "the same momentum");
        assert_near(&first.synchronized(&first.step(&one)?), &second.step(&two)?.momentum(), NEAR, "and after it");
        // exact motions of other times need no constants: those of the size itself, and two that make up one
        let body = ExactBody { moments: Vector3::new(1.0, 1.5, 2.0) }.into_stepper(H)?;
        let spin = body.step(&body.state(r, mu)?)?;
        let other = body.with_step_size(part * H)?.step(&spin)?;
        let next = body.step_for(&spin, part * H)?;
        assert_near(next.configuration(), other.configuration(), 1e-14, "the attitude of a free body");
        assert_near(&next.momentum(), &other.momentum(), 1e-14, "its momentum");
        let next = body.step_for(&next, (1.0 - part) * H)?;
        assert_near(next.configuration(), body.step(&spin)?.configuration(), 1e-14, "two parts of a step");
        assert_near(body.step_for(&spin, 1e-200)?.configuration(), spin.configuration(), 1e-15, "no time");
        let timed = satellite.stepper(H)?;
        let later = timed.step_for_with(&timed.state_at(1.0, r, mu)?, part * H, &())?;
        prop_assert!((later.time() - 1.0 - part * H).abs() <= f64::EPSILON);
    }

    /// Drivers that step in place are kicked in place, with the same bits.
    #[test]
    fn drivers_are_kicked(mass in definite::<3>(), center in vector::<3>(1.0), bodies in prop::array::uniform5((attitude(), vector::<3>(1.0))), push in vector::<3>(1.0), q in prop::array::uniform4(unit())) {
        let stepper = generic_top::<f64>(&mass, 1.0, &center).into_stepper(H)?;
        let mut alone = stepper.clone().integrator(stepper.state(bodies[4].0, bodies[4].1)?);
        let wide = generic_top::<F64x4>(&mass, 1.0, &center).into_stepper(F64x4::splat(H))?;
        let mut many = wide.ensemble(bodies)?;
        for _ in 0..2 {
            alone.step()?;
            many.step();
            alone.kick(push)?;
            many.kick(4, push)?;
        }
        prop_assert_eq!(many.body(4), Some(alone.state().into_parts()));
        prop_assert_eq!(many.kick(5, push), Err(Error::NoBody { body: 5, bodies: 5 }));
        alone.step_for(H / 3.0)?;
        prop_assert_eq!(alone.steps(), 3);

        let stepper = SpinChain::<4> { exchange: 1.0, field: push }.into_stepper(H)?;
        let across = q.map(|q| q.cross(&push));
        let mut sites = stepper.clone().sites(SiteStorage::of(q, across))?;
        sites.step()?;
        let state = stepper.step(&stepper.state(q, across)?)?;
        let aside = state.configuration()[2].cross(&Vector3::new(0.3, 0.1, 0.2));
        let mut impulse = [Vector3::zeros(); 4];
        impulse[2] = aside;
        sites.kick(2, aside)?;
        sites.step()?;
        let next = stepper.step(&stepper.kick(&state, impulse)?)?;
        prop_assert_eq!((sites.configuration(), sites.momentum()), (&next.configuration()[..], &next.momentum()[..]));
        let along = sites.kick(1, sites.configuration()[1]).expect_err("motions that fix the site");
        let is_refused = matches!((along.site, along.error), (Some(1), Error::OutsideMomentumSpace { .. }));
        prop_assert!(is_refused);
        prop_assert_eq!(sites.kick(4, aside).map_err(Error::from), Err(Error::NoSite { site: 4, sites: 4 }));
    }
}
