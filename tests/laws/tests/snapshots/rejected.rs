//! The message about every mistake, and its place.

use std::fmt::Write;

use clebsch_compiler::diagnostic::Diagnostics;
use clebsch_compiler::{Graph, compile};
use insta::assert_snapshot;

use crate::fixture::Fixture;
use crate::place::{Place, places};

#[test]
fn every_mistake_is_explained_at_its_place() {
    Fixture::check_all("reject", |fixture| {
        let errors = errors(fixture);
        let mut text = format!("{errors}\n");
        let places = places(errors.to_compile_errors());
        assert_eq!(places.len(), errors.len());
        for place in places {
            assert!(place.is_inside(&Place::of(fixture.item())), "an error at {place:?} is outside of the item");
            // by construction: writing to a string does not fail
            let _ = write!(text, "\n{}", place.marked(&fixture.source));
        }
        fixture.snapshots("reject", || assert_snapshot!(fixture.name.as_str(), text));
    });
}

#[test]
fn at_least_25_mistakes() {
    assert!(Fixture::all("reject").len() >= 25, "people really make many more mistakes");
}

/// Each line is `error: …`, `help: …` or `note: …`, lower case and without a full stop.
#[test]
fn messages_keep_to_the_style() {
    Fixture::check_all("reject", |fixture| {
        for line in errors(fixture).to_string().lines().map(str::trim).filter(|line| !line.is_empty()) {
            let (kind, text) = line.split_once(": ").unwrap_or_else(|| panic!("`{line}` is of no kind"));
            assert!(["error", "help", "note"].contains(&kind), "`{line}` is of no kind");
            assert!(!text.ends_with('.'), "`{line}` ends with a full stop");
            let mut letters = text.chars();
            let is_capitalised =
                letters.next().is_some_and(char::is_uppercase) && letters.next().is_some_and(char::is_lowercase);
            assert!(!is_capitalised, "`{line}` begins with a capital");
        }
    });
}

/// The message of the compiler; a fixture that it accepts has no place here.
fn errors(fixture: &Fixture) -> Diagnostics {
    let graph = Graph::new();
    compile(&graph, fixture.item()).err().unwrap_or_else(|| panic!("{} is accepted", fixture.name))
}
