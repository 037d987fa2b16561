//! Any text at all: an integrator, or errors that help, never a panic, and an end within bounds.
//!
//! The findings of fuzzing are replayed here with every run, and some hundred declarations are changed at random.
//! `tests/fuzz` has the targets that go on for hours. `CLEBSCH_FUZZ=20000 cargo test -p clebsch-compiler --test fuzz`
//! changes as many declarations as it says.

mod compiled;
mod limits;
mod mutation;
mod processes;
mod seeds;
mod verdict;

use mutation::{Choices, mutated};
use verdict::verdict;

/// One in four of the declarations that fuzzing began with. Snapshots have the errors of all of them.
#[test]
fn seeds_are_refused_or_compiled() {
    verdicts_of(seeds::sample("fixtures/reject", 4));
}

/// The findings of fuzzing.
#[test]
fn findings_are_refused_or_compiled() {
    verdicts_of(seeds::of("fuzz/seeds"));
}

fn verdicts_of(declarations: Vec<(String, String)>) {
    let failures: Vec<String> = declarations
        .into_iter()
        .filter_map(|(name, text)| verdict(&text).err().map(|failure| format!("{name}: {failure}")))
        .collect();
    assert!(failures.is_empty(), "{} failures\n\n{}", failures.len(), failures.join("\n\n"));
}

/// Changed declarations, half of them.
#[test]
fn changed_declarations_are_refused_or_compiled() {
    changed(0);
}

/// The other half of the run.
#[test]
fn changed_declarations_are_refused_or_compiled_too() {
    changed(1);
}

fn changed(remainder: u64) {
    let count = std::env::var("CLEBSCH_FUZZ").map_or(200, |count| count.parse().expect("CLEBSCH_FUZZ is a count"));
    let (seeds, mut compiled, mut failures) = (seeds::all(), 0, Vec::new());
    let numbers = (0..count).filter(|number| number % 2 == remainder);
    for number in numbers.clone() {
        let choices = &mut Choices::new(number);
        // half of them from accepted ones
        let (accepted, any) = (choices.pick(seeds::of("fixtures/accept").len()), choices.pick(seeds.len()));
        let (from, other) = ([accepted, any][choices.pick(2)], choices.pick(seeds.len()));
        let text = mutated(&seeds[from].1, &seeds[other].1, choices);
        match verdict(&text) {
            Ok(errors) => compiled += usize::from(errors.is_none()),
            Err(failure) => failures.push(format!("change {number} of {}: {failure}", seeds[from].0)),
        }
    }
    println!("{compiled} of {} have no errors", numbers.count());
    assert!(failures.is_empty(), "{} failures\n\n{}", failures.len(), failures.join("\n\n"));
}
