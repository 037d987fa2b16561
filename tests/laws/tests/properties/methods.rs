//! Methods: several ways to step one system.

use crate::arbitrary::{attitude, cases, vector};
use crate::bodies::H;
use crate::runner::proptest;
use clebsch::{Clebsch, Error, Method};
use clebsch_tests::fixtures::three_ways::{Fine, Quick, ThreeWays};
use clebsch_tests::oracle::near::assert_near;
use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;

/// Rounding of a few steps of numbers of order one, divided by h.
const NEAR: f64 = 1e-12;

/// Where the dial `tolerance` of `Quick` ends its iterations.
const TOLERANCE: f64 = 1e-6;

/// Tops with moments between ½ and 3/2.
fn tops() -> BoxedStrategy<ThreeWays> {
    let numbers = (vector::<3>(0.5), 0.1_f64..3.0, vector(1.0));
    let top = |(moments, weight, center): (Vector3<f64>, f64, Vector3<f64>)| ThreeWays {
        moments: moments.add_scalar(1.0),
        weight,
        center,
    };
    numbers.prop_map(top).boxed()
}

/// The transforms of a method at a step and its kinetic energy, which is that of every method.
fn laws_of_a_method<M: Method<ThreeWays>>(
    top: &ThreeWays,
    (r, mu): (&Matrix3<f64>, &Vector3<f64>),
    near: f64,
) -> Result<(), Error> {
    let stepper = top.stepper_by::<M>(H)?;
    let f = stepper.inverse_legendre(r, mu)?;
    assert_near(&M::legendre(top, H, 0.0, r, &f), mu, near, "the momentum before");
    let energy = M::kinetic_energy(top, &M::constants(top, H)?, 0.0, r, mu);
    assert!((energy - mu.component_div(&top.moments).dot(mu) / 2.0).abs() < NEAR);
    assert!((energy + top.potential(0.0, r) - stepper.energy(&stepper.state(*r, *mu)?)).abs() < NEAR);
    assert_eq!(stepper.step_size(), top.clone().into_stepper_by::<M>(H)?.step_size());
    Ok(())
}

proptest! {
    #![proptest_config(cases(32))]

    /// The items of a method obey the laws of a system. A step of first order ends with N⁺ = F⁺ℓd(q, F), half a kick
    /// ahead.
    #[test]
    fn methods_step_one_system(top in tops(), r in attitude(), mu in vector::<3>(1.0)) {
        laws_of_a_method::<Fine>(&top, (&r, &mu), NEAR)?;
        laws_of_a_method::<Quick>(&top, (&r, &mu), TOLERANCE)?;
        let stepper = top.stepper_by::<Quick>(H)?;
        let (f, next) = (stepper.inverse_legendre(&r, &mu)?, stepper.step(&stepper.state(r, mu)?)?);
        assert_near(&Quick::legendre_next(&top, H, 0.0, &r, &f), &next.momentum(), TOLERANCE, "the momentum after");
        let ahead = r.row(2).transpose().cross(&top.center) * (H * top.weight / 2.0);
        assert_near(&Quick::stagger(&top, H, 0.0, &r), &ahead, NEAR, "half a kick");
        prop_assert_eq!(Fine::stagger(&top, H, 0.0, &r), Vector3::zeros());
    }

    /// A state of one method is one of every other, at the same q and π: there and back it is itself.
    #[test]
    fn states_of_methods_are_the_same_bodies(top in tops(), r in attitude(), mu in vector::<3>(1.0)) {
        let (fine, quick) = (top.stepper_by::<Fine>(H)?, top.stepper_by::<Quick>(H / 3.0)?);
        let state = fine.state(r, mu)?;
        let other = quick.state_of(&fine, &state)?;
        assert_near(&quick.synchronized(&other), &mu, NEAR, "the momentum of the configuration");
        let back = fine.state_of(&quick, &other)?;
        prop_assert_eq!(back.configuration(), &r);
        assert_near(&back.momentum(), &mu, NEAR, "there and back");
    }
}
