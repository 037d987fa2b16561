//! What is said about every mistake, and where.

use std::fmt::Write;

use clebsch_compiler::{Graph, compile};
use insta::assert_snapshot;

use crate::fixture::Fixture;
use crate::place::{Place, places};

#[test]
fn every_mistake_is_explained_at_its_place() {
    let fixtures = Fixture::all("reject");
    assert!(fixtures.len() >= 25, "mistakes that people really make are many more than {}", fixtures.len());
    for fixture in fixtures {
        let item = fixture.item();
        let whole = Place::of(item.clone());
        let graph = Graph::new();
        let Err(errors) = compile(&graph, item) else { panic!("{} is accepted", fixture.name) };
        let mut text = format!("{errors}\n");
        let places = places(errors.to_compile_errors());
        assert_eq!(places.len(), errors.len(), "{}", fixture.name);
        for place in places {
            assert!(place.is_inside(&whole), "{}: an error at {place:?} is outside of the item", fixture.name);
            // by construction: writing to a string does not fail
            let _ = write!(text, "\n{}", place.marked(&fixture.source));
        }
        fixture.snapshots("reject", || assert_snapshot!(fixture.name.as_str(), text));
    }
}

#[test]
fn messages_keep_to_the_style() {
    for fixture in Fixture::all("reject") {
        let graph = Graph::new();
        let Err(errors) = compile(&graph, fixture.item()) else { panic!("{} is accepted", fixture.name) };
        for line in errors.to_string().lines().filter(|line| !line.is_empty()) {
            let (kind, text) =
                line.trim_start().split_once(": ").unwrap_or_else(|| panic!("{}: `{line}`", fixture.name));
            assert!(["error", "help", "note"].contains(&kind), "{}: `{line}` is of no kind", fixture.name);
            assert!(!text.ends_with('.'), "{}: `{line}` ends with a full stop", fixture.name);
            let first = text.chars().next().unwrap_or('?');
            let is_name =
                text.split([' ', ',', ':']).next().is_some_and(|word| word.chars().skip(1).any(char::is_uppercase));
            assert!(
                !first.is_uppercase() || is_name || text[1..].starts_with([' ', '(', '<']),
                "{}: `{line}` begins upper case",
                fixture.name
            );
        }
    }
}
