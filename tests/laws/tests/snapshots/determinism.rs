//! The same declaration gives the same tokens, whatever was expanded before it.
//!
//! A sample of fixtures is expanded twice here, all of them with the feature `heavy`. Without it the tests of
//! `clebsch-compiler` expand all of them, in one order, and in the other order in another process.

use clebsch_compiler::expand;

use crate::fixture::Fixture;

/// One fixture in so many is taken.
const SAMPLE: usize = if cfg!(feature = "heavy") { 1 } else { 8 };

fn sample(folder: &str) -> Vec<Fixture> {
    Fixture::all(folder).into_iter().step_by(SAMPLE).collect()
}

#[test]
fn the_same_input_gives_the_same_tokens() {
    let expand_all = |fixtures: &[Fixture]| -> Vec<String> {
        fixtures.iter().map(|fixture| expand(fixture.item()).to_string()).collect()
    };
    let mut fixtures = sample("accept");
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
    for fixture in sample("reject") {
        let expand = || expand(fixture.item()).to_string();
        assert_eq!(expand(), expand(), "{}", fixture.name);
    }
}
