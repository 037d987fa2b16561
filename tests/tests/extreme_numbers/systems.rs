//! The accepted fixtures with ordinary parameters.

use crate::checks::check;
use crate::longest::longest_steps;
use crate::slots::Slots;
use crate::trial::{Of, Scene, Trial};
use clebsch_tests::fixtures::*;
use clebsch_tests::scenes::*;
use nalgebra::*;

macro_rules! scenes {
    ($($name:ident: $module:ident::$system:ident$(<$number:tt>)? { $($field:tt: $value:expr),* }, $configuration:expr, $h:expr;)*) => {
        $(
            impl Scene for $module::$system$(<$number>)? {
                fn ordinary() -> Self {
                    $module::$system { $($field: $value),* }
                }
                fn step_size() -> Self::Scalar {
                    $h
                }
                fn configuration() -> Self::Configuration {
                    $configuration
                }
                fn fields(&mut self) -> Vec<(&'static str, usize)> {
                    vec![$((stringify!($field), self.$field.slots().len())),*]
                }
                #[allow(unused_mut, unused_variables, reason = "some systems have no fields")]
                fn with_field(mut self, field: &str, place: usize, value: f64) -> Self {
                    $(
                        if field == stringify!($field) {
                            self.$field = self.$field.with(place, value);
                        }
                    )*
                    self
                }
            }

            #[test]
            fn $name() {
                check_scene(&mut Of::<$module::$system$(<$number>)?>::new());
            }
        )*
    };
}

/// All checks of a scene.
fn check_scene(trial: &mut dyn Trial) {
    let report = check(trial);
    let [results, errors] = report.counts;
    let count = report.failures.len();
    let shown: Vec<_> = report.failures.into_iter().take(40).collect();
    assert!(count == 0, "{count} failures\n{}", shown.join("\n"));
    let [refused, bent] = longest_steps(trial);
    println!(
        "{results} results, {errors} errors, {refused} steps too long, {bent} of which not in proportion to the momentum"
    );
}

#[cfg(feature = "heavy")]
clebsch_tests::every_scene!(scenes);
#[cfg(not(feature = "heavy"))]
clebsch_tests::scenes_of_each_kind!(scenes);

macro_rules! modules {
    ($($name:ident: $module:ident::$system:ident$(<$number:tt>)? { $($fields:tt)* }, $configuration:expr, $h:expr;)*) => {
        /// The modules of all scenes.
        const MODULES: &[&str] = &[$(stringify!($module)),*];
    };
}

clebsch_tests::every_scene!(modules);

/// Systems that are not stepped here. `driven_sleigh`, `follower`, `frugal_car`, `gripping_disc`, `hopper`, `regulator`, `telescope`, `unicycle` and `wheeled_car` are planned, in the tests of control.
/// `annotated_body` has private fields. `cosserat_rod`, `harmonic_map`, `sine_gordon` and `wave_map` are fields, whose tests step them on grids.
const OTHERS: [&str; 15] = [
    "annotated_body",
    "cosserat_rod",
    "driven_sleigh",
    "follower",
    "frugal_car",
    "gripping_disc",
    "harmonic_map",
    "hopper",
    "rate_limited_body",
    "regulator",
    "sine_gordon",
    "telescope",
    "unicycle",
    "wave_map",
    "wheeled_car",
];

#[test]
fn no_fixture_is_left_out() {
    let folder = std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/fixtures/accept")).expect("a folder");
    for file in folder {
        let name = file.expect("a file").file_name().into_string().expect("a name");
        let name = name.trim_end_matches(".rs");
        let known = MODULES.contains(&name) || OTHERS.contains(&name);
        assert!(known, "`{name}` is in no list of tests/src/scenes.rs");
    }
}
