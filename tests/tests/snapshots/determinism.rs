//! The same declaration gives the same tokens, whatever was expanded before it.

use clebsch_compiler::expand;

use crate::fixture::Fixture;

#[test]
fn the_same_input_gives_the_same_tokens() {
    let expand_all = |fixtures: &[Fixture]| -> Vec<String> {
        fixtures.iter().map(|fixture| expand(fixture.item()).to_string()).collect()
    };
    let mut fixtures = Fixture::all("accept");
    let first = expand_all(&fixtures);
    fixtures.reverse();
    let mut again = expand_all(&fixtures);
    again.reverse();
    for ((fixture, first), again) in fixtures.iter().rev().zip(first).zip(again) {
        assert!(first == again, "{} expands to other tokens the second time", fixture.name);
    }
}

#[test]
fn errors_come_in_the_same_order() {
    for fixture in Fixture::all("reject") {
        let expand = || expand(fixture.item()).to_string();
        assert_eq!(expand(), expand(), "{}", fixture.name);
    }
}
