//! Expansions that share a module with hostile names, with no prelude, with a re-exported runtime, under all lints.
//!
//! The same systems are included in each; that they compile is most of the test.

#![deny(warnings)]
#![warn(clippy::all, missing_docs, unused)]

mod generated_names;
mod globs;
mod hostile;
mod named;
#[no_implicit_prelude]
mod no_prelude;
mod reexported;

use clebsch::{Clebsch, Declared, Method};
use nalgebra::{Matrix3, Vector3};

/// A step of a system that starts at rest.
fn steps<S: Clebsch<Scalar = f64> + Clone>(system: &S, q: S::Configuration, mu: S::Momentum) {
    steps_by::<S, Declared>(system, q, mu);
}

/// A step by a method.
fn steps_by<S: Clebsch<Scalar = f64> + Clone, M: Method<S>>(system: &S, q: S::Configuration, mu: S::Momentum) {
    let stepper = system.stepper_by::<M>(0.01).expect("good parameters");
    let start = stepper.state(q, mu).expect("a good state");
    stepper.step(&start).expect("a small step");
}

macro_rules! all_of {
    ($($module:ident)*) => {$(
        #[test]
        fn $module() {
            use $module::{Body, Composed, Fine, Lopsided, Pair, Pendulum, Sites, Top};
            let (z, zero) = (Vector3::z(), Vector3::zeros());
            let top = Top { mass_matrix: Matrix3::identity(), weight: 1.0, center: z };
            steps(&top, Matrix3::identity(), zero);
            assert!(Top::GENERATED.contains("turn_of_body"));
            assert!(Top::DERIVATION_LATEX.starts_with("\\begin{align*}"));
            let body = Body { inertia: Matrix3::identity() };
            steps(&body, Matrix3::identity(), zero);
            steps_by::<_, Fine>(&body, Matrix3::identity(), z);
            steps_by::<_, Composed>(&body, Matrix3::identity(), z);
            steps(&Pair { mass: [1.0, 2.0], coupling: 3.0 }, ([z, z], zero), nalgebra::SVector::zeros());
            steps(&Pendulum(1.0, 2.0), nalgebra::Vector2::y(), nalgebra::Vector1::zeros());
            steps(&Lopsided { gravity: 9.81 }, z, zero);
            steps(&Sites { mass: [1.0, 2.0] }, [z, -z], [zero, zero]);
        }
    )*};
}
all_of!(hostile no_prelude reexported);
