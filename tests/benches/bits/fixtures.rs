//! The accepted fixtures.

use crate::run::{Momenta, Task};
use clebsch::{Clebsch, F64x4};
use clebsch_tests::fixtures::*;
use clebsch_tests::scenes::*;
use nalgebra::*;

/// Fixtures by the name of their module; one over several scalars by that of the scene.
macro_rules! scenes {
    ($($name:ident: $module:ident::$system:ident$(<$number:tt>)? { $($field:tt: $value:expr),* }, $configuration:expr, $h:expr;)*) => {
        pub fn all(task: &impl Task) {
            $({
                type System = $module::$system$(<$number>)?;
                let configuration: <System as Clebsch>::Configuration = $configuration;
                let name = concat!(stringify!($module) $(, "_", stringify!($number))?);
                task.fixture(name, $module::$system { $($field: $value),* }, configuration, $h, |stepper, state| {
                    #[allow(unused_imports, reason = "one of both")]
                    use crate::run::{Conserving, NotConserving};
                    let system: Momenta<'_, System> = Momenta(stepper, state);
                    (&system).conserved()
                });
            })*
            lanes(task);
        }
    };
}
clebsch_tests::every_scene!(scenes);

/// Systems that have no place among the scenes.
fn lanes(task: &impl Task) {
    let number = |x: f64| F64x4::from([x, 0.9 * x, 1.1 * x, x]);
    let body = generic_body::GenericBody {
        mass_matrix: inertia().map(number),
        weight: number(1.3),
        center: centre().map(number),
    };
    task.fixture("generic_body_lanes", body, turned().map(F64x4::from), F64x4::from(0.05), |stepper, state| {
        format!("{:?}", stepper.conserved(state))
    });
}
