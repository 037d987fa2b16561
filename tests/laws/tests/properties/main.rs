//! Laws of the runtime, for random systems and states: a property for every public function, and a table that knows of each.

#![allow(missing_docs)]

mod arbitrary;
mod bodies;
mod constraints;
mod derivatives;
mod ensembles;
mod equations;
mod fields;
mod formulas;
mod impulses;
mod joints;
mod matrices;
mod mentions;
mod methods;
mod paths;
mod places;
mod plans;
mod powers;
mod public;
mod recording;
mod rotations;
#[path = "../../../../runtime/src/runner.rs"]
mod runner;
mod runs;
mod scalars;
mod schemes;
mod steps;
mod table;
mod whole;

use mentions::File;
use std::collections::BTreeSet;
use std::path::Path;
use table::PROPERTIES;

/// The root of the repository.
fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).expect("the tests are a folder of the repository")
}

#[test]
fn every_public_function_has_a_property() {
    let public = public::functions(&root().join("runtime/src"));
    let listed: BTreeSet<String> = PROPERTIES
        .iter()
        .flat_map(|(_, properties)| *properties)
        .flat_map(|(_, of)| *of)
        .map(ToString::to_string)
        .collect();
    let missing: Vec<_> = public.difference(&listed).collect();
    let gone: Vec<_> = listed.difference(&public).collect();
    assert!(missing.is_empty(), "no property of {missing:#?}: write one, and name it in `PROPERTIES`");
    assert!(gone.is_empty(), "no public functions any more, but in `PROPERTIES`: {gone:#?}");
}

#[test]
fn every_property_is_about_its_functions() {
    for (path, properties) in PROPERTIES {
        let file = File::read(&root().join(path));
        for (property, functions) in *properties {
            assert!(file.has_property(property), "{path} has no property `{property}` within `proptest!`");
            for function in *functions {
                let name = function.rsplit("::").next().expect("a path has a last name");
                assert!(file.is_about(property, name), "`{property}` of {path} does not name `{function}`");
            }
        }
    }
}
