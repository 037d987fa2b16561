//! Random problems: those that compile integrate as the oracle does, and those that are refused say why.
//!
//! A seed makes a problem as data: groups, sides, spaces, a cost or a Lagrangian, a polynomial potential, dials. From
//! the same data come the text of a declaration and a problem of the oracle. The program of the text is stepped by
//! running its kernels in the order of emitted code. The oracle solves the unsimplified equations to 30 digits. A
//! problem that fails is shrunk before it is shown.
//!
//! Some problems have a constraint. Its equations are affine in the velocity, or of the configuration. The oracle has the
//! multipliers as unknowns, and the continuous motion has them from differences.
//!
//! Each test takes some ten seeds, and twelve times as many with the feature `heavy`.
//! `CLEBSCH_RANDOM=5000 cargo test -p clebsch-laws --test random` takes as many as it says, `CLEBSCH_RANDOM=1234..1235`
//! these, and `-- --nocapture` shows the results of each.

mod broken;
mod checks;
mod constrained;
mod equations;
mod formula;
mod generator;
mod groups;
mod kernels;
#[path = "../../../../macros/compiler/tests/fuzz/mutation.rs"]
mod mutation;
mod powers;
mod problem;
mod shrinking;
mod stepping;
#[path = "../../../../macros/compiler/tests/fuzz/verdict.rs"]
mod verdict;

use std::ops::Range;

use checks::{Found, Gradient, check, check_power};
use generator::problem;
use mutation::{Choices, mutated};
use powers::Power;
use verdict::verdict;

/// The count with the feature `heavy`, and a twelfth of it without.
const fn cases(count: u64) -> u64 {
    if cfg!(feature = "heavy") { count } else { count / 12 }
}

/// The seeds of a test that takes `count` of them with the feature `heavy`, unless it is told otherwise.
fn seeds(count: u64) -> Range<u64> {
    let Ok(asked) = std::env::var("CLEBSCH_RANDOM") else { return 0..cases(count) };
    let number = |text: &str| text.parse().unwrap_or_else(|_| panic!("CLEBSCH_RANDOM is a count or a range of seeds"));
    match asked.split_once("..") {
        Some((from, to)) => number(from)..number(to),
        None => 0..number(&asked),
    }
}

/// Fails with all that has failed.
fn report(failures: &[String]) {
    assert!(failures.is_empty(), "{} failures\n\n{}", failures.len(), failures.join("\n\n"));
}

/// A failure without numbers: a smaller problem has to fail with it too.
fn kind(failure: &str) -> String {
    let line = failure.lines().next().unwrap_or_default();
    line.chars().filter(|c| c.is_alphabetic()).collect::<String>().chars().skip(4).take(16).collect()
}

/// The failure of the smallest problem that fails in the same way.
fn smallest(seed: u64, failure: &str) -> String {
    let fails = |other: &problem::Declared| check(other, seed).is_err_and(|other| kind(&other) == kind(failure));
    check(&shrinking::shrunk(&problem(seed), fails), seed).err().unwrap_or_else(|| failure.to_string())
}

/// Problems that have a motion: next to none is too large, no other is refused, and all step as the oracle does.
fn integrates(seeds: impl Iterator<Item = u64>) {
    let (mut found, mut failures) = (Vec::new(), Vec::new());
    for seed in seeds {
        match check(&problem(seed), seed) {
            Ok(one) => {
                println!("{seed}: {one:?}");
                found.push(one);
            }
            Err(failure) => failures.push(smallest(seed, &failure)),
        }
    }
    let count = |which: &dyn Fn(&Found) -> bool| found.iter().filter(|one| which(one)).count();
    let stepped = count(&|one| one.stepped);
    let large = count(&|one| one.is_large);
    println!("{stepped} of {} problems stepped, {large} too large", found.len());
    assert!(50 * large < 50 + found.len(), "{large} of {} problems are too large", found.len());
    assert!(10 * stepped >= 7 * found.len(), "only {stepped} of {} problems were stepped", found.len());
    report(&failures);
    if found.len() >= 50 {
        let kinds = [
            count(&|one| one.composed),
            count(&|one| !one.composed),
            count(&|one| one.conserved > 0),
            count(&|one| one.couples),
            count(&|one| one.iterates),
            count(&|one| !one.iterates),
            count(&|one| one.specialised),
            count(&|one| one.compensated),
            count(&|one| one.collocated),
        ];
        assert!(kinds.iter().all(|&count| count > 2), "the problems are too much alike: {kinds:?}");
    }
}

#[test]
fn what_compiles_integrates_as_the_oracle_does() {
    integrates(seeds(100).filter(|seed| seed % 2 == 0));
}

/// The other half of the run.
#[test]
fn what_compiles_integrates_as_the_oracle_does_too() {
    integrates(seeds(100).filter(|seed| seed % 2 == 1));
}

/// Costs on abelian groups that couple configuration and group element. Their equations are linear where the cost is
/// quadratic, with more in them than the inertia. Few of the problems above are such.
#[test]
fn what_is_linear_integrates_as_the_oracle_does() {
    let is_abelian = |name: &str| name.starts_with("Translation") || ["SO<2>", "U<1>"].contains(&name);
    let couples = |seed: &u64| {
        let problem = problem(*seed);
        let is_cost = matches!(problem.kinetic, problem::Kinetic::Cost(_));
        is_cost
            && problem.factors.iter().all(|factor| is_abelian(&factor.group.name))
            && problem.text().contains("(h * ")
    };
    let some: Vec<u64> = (1000..4000).filter(couples).take(cases(40) as usize).collect();
    assert_eq!(some.len() as u64, cases(40));
    integrates(some.into_iter());
}

/// Costs of the displacement of planes and frames. Few of the problems above are such.
#[test]
fn planes_and_frames_integrate_as_the_oracle_does() {
    let moves = |seed: &u64| ["Projector<", "Orthonormal<"].iter().any(|space| problem(*seed).text().contains(space));
    let some: Vec<u64> = (5000..20_000).filter(moves).take(cases(48) as usize).collect();
    assert_eq!(some.len() as u64, cases(48));
    integrates(some.into_iter());
}

/// Costs that couple and are composed with their adjoint. Once F⁻¹ did not cancel in F⁻¹ Φ_F(q), and they did not end.
/// The first is matrix code, and the third is refused as too large. The feature `heavy` adds one of both kinds.
#[test]
fn adjoints_of_coupled_costs_end() {
    const SEEDS: [u64; 5] = [920_257, 920_321, 920_286, 930_161, 940_047];
    let taken = if cfg!(feature = "heavy") { 5 } else { 2 };
    let found: Vec<_> = SEEDS.into_iter().take(taken).map(|seed| check(&problem(seed), seed)).collect();
    let failures: Vec<String> = found.iter().filter_map(|one| one.clone().err()).collect();
    report(&failures);
    assert!(found.iter().flatten().filter(|one| one.stepped).count() >= 2, "{found:?}");
}

/// Systems with a const generic: random sites, which rings, chains and pairs of random terms tie to each other.
#[test]
fn powers_integrate_as_the_oracle_does() {
    let (mut found, mut failures) = (Vec::new(), Vec::new());
    for seed in seeds(60) {
        match check_power(&Power::random(seed), seed) {
            Ok(how) => found.push(how),
            Err(failure) => failures.push(failure),
        }
    }
    report(&failures);
    let count = |wanted| found.iter().filter(|how| **how == wanted).count();
    let [gathered, added, large] = [Gradient::Gathered, Gradient::Added, Gradient::TooLarge].map(count);
    println!("{} powers: {gathered} gathered, {added} added, {large} too large", found.len());
    assert!(found.len() < 30 || gathered > 2 && added > 2, "{gathered} gathered, {added} added");
    assert!(30 * large <= found.len(), "{large} of {} are too large", found.len());
}

/// Random equations of velocities and places. One problem in three is compared with the continuous motion too.
#[test]
fn constraints_push_as_lagrange_and_dalembert_say() {
    let (mut found, mut failures) = (Vec::new(), Vec::new());
    for seed in seeds(120) {
        let is_thorough = seed.is_multiple_of(3);
        match constrained::check_seed(seed, is_thorough) {
            Ok(one) => {
                println!("{seed}: {one:?}");
                found.push(one);
            }
            Err(failure) => {
                let fails = |other: &problem::Declared| {
                    constrained::check(other, seed, is_thorough).is_err_and(|other| kind(&other) == kind(&failure))
                };
                let smallest = shrinking::shrunk(&generator::constrained(seed, false), fails);
                failures.push(constrained::check(&smallest, seed, is_thorough).err().unwrap_or(failure));
            }
        }
    }
    let count = |which: &dyn Fn(&constrained::Tied) -> bool| found.iter().filter(|one| which(one)).count();
    let stepped = count(&|one| one.stepped);
    println!("{stepped} of {} problems stepped, {} too large", found.len(), count(&|one| one.is_large));
    let kinds = [
        count(&|one| one.stepped && one.of_velocity && !one.of_places),
        count(&|one| one.stepped && one.of_places && !one.of_velocity),
        count(&|one| one.stepped && one.of_places && one.of_velocity),
        count(&|one| one.stepped && one.is_bent),
        count(&|one| one.stepped && one.is_affine),
        count(&|one| one.stepped && one.has_poles),
        count(&|one| one.stepped && one.of_each),
        count(&|one| one.stepped && one.conserved > 0),
        count(&|one| one.stepped && one.has_moving_inertia),
        count(&|one| one.stepped && !one.refused.is_empty()),
        count(&|one| one.ratio.is_some()),
    ];
    println!("{kinds:?}");
    report(&failures);
    if found.len() >= 40 {
        assert!(10 * stepped >= 9 * found.len(), "only {stepped} of {} problems were stepped", found.len());
        assert!(kinds.iter().all(|&count| count > 0), "the problems are too much alike: {kinds:?}");
    }
}

#[test]
fn what_is_refused_says_why() {
    let mut failures = Vec::new();
    let mut count = 0;
    for seed in seeds(100) {
        for mistake in broken::mistakes(&problem(seed)) {
            count += 1;
            match verdict(&mistake.text) {
                Ok(Some(_)) => {}
                Ok(None) => failures.push(format!("seed {seed}, {}: not refused\n{}", mistake.name, mistake.text)),
                Err(failure) => failures.push(format!("seed {seed}, {}: {failure}", mistake.name)),
            }
        }
    }
    for seed in seeds(100) {
        let problem = problem::Declared { order: 2, ..generator::constrained(seed, true) };
        for (mistake, help) in broken::mistakes_in_constraint(&problem) {
            count += 1;
            match verdict(&mistake.text) {
                Ok(Some(errors)) if errors.to_string().contains(help) => {}
                Ok(found) => failures.push(format!("seed {seed}, {}: {found:?}\n{}", mistake.name, mistake.text)),
                Err(failure) => failures.push(format!("seed {seed}, {}: {failure}", mistake.name)),
            }
        }
    }
    println!("{count} mistakes");
    report(&failures);
}

/// Any tokens at all: a program, or errors that help.
#[test]
fn mutilated_declarations_are_refused_or_compiled() {
    let mut failures = Vec::new();
    let mut refused = 0;
    for seed in seeds(300) {
        // one in three has a constraint
        let of = |seed: u64| if seed.is_multiple_of(3) { generator::constrained(seed, false) } else { problem(seed) };
        let text = mutated(&of(seed).text(), &of(seed + 1).text(), &mut Choices::new(seed));
        match verdict(&text) {
            Ok(errors) => refused += usize::from(errors.is_some()),
            Err(failure) => failures.push(format!("seed {seed}: {failure}")),
        }
    }
    println!("{refused} refused");
    report(&failures);
}

/// A declaration that ends too early has its error at the end.
#[test]
fn the_end_of_a_declaration_has_a_place() {
    let declaration = |potential: &str| {
        let rest = "action = |F: SO<3>, q: Vector3| F * q, cost = |h, F| (F - I).norm_squared() / (4 * h)";
        format!("#[clebsch({rest}, potential = |q| {potential})]\npub struct P;")
    };
    for potential in ["q.", "q.x +", "vector![1, 2 +, 3].dot(&q)", "q.dot(&vector![1, 2, 3 +])", ""] {
        match verdict(&declaration(potential)) {
            Ok(Some(_)) => {}
            Ok(None) => panic!("`{potential}` is compiled"),
            Err(failure) => panic!("{failure}"),
        }
    }
}
