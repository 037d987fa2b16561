//! The page in the tree is the one that the tables print, and it has every name that messages list.

use clebsch_symbolic::Graph;

use super::{keys_for_editors, reference};
use crate::compile;

const PAGE: &str = include_str!("../../../reference.md");
const ACTION: &str = "action = |F: SO<3>, R: SO<3>| R * F";
const LAGRANGIAN: &str = "lagrangian = |omega| omega.norm_squared()";

#[test]
fn the_page_is_up_to_date() {
    let declaration = include_str!("../../../../tests/fixtures/accept/free_particle.rs");
    let snapshot = include_str!("../../../../tests/snapshots/accept/free_particle.6_generated.snap");
    let expansion = snapshot.splitn(3, "---\n").nth(2).unwrap_or_default();
    let is_printed = PAGE == reference(declaration, expansion);
    assert!(is_printed, "cargo run -p clebsch-compiler --example reference > macros/reference.md");
}

#[test]
fn the_texts_for_editors_are_up_to_date() {
    let is_printed = keys_for_editors() == include_str!("../../../../runtime/src/__private/keys.rs");
    assert!(is_printed, "cargo run -p clebsch-compiler --example reference hints > runtime/src/__private/keys.rs");
}

/// The names that the error for an unknown one lists, in backticks behind `are` or `it is`.
fn listed(declaration: &str) -> Vec<String> {
    let item = format!("#[clebsch({declaration})] struct System {{ mass: f64 }}");
    let tokens = item.parse().expect("tokens");
    let errors = compile(&Graph::new(), tokens).err().expect("an unknown name").to_string();
    let (_, names) = errors.rsplit_once(" are ").or(errors.rsplit_once("it is ")).expect("a list of names");
    let names: Vec<String> = names.split('`').skip(1).step_by(2).map(str::to_string).collect();
    assert!(names.len() > 1, "{errors}");
    names
}

#[test]
fn every_key_has_a_section() {
    for key in listed("unknownkey = 1") {
        assert!(PAGE.contains(&format!("\n## `{key}`\n")), "{key}");
    }
    for key in ["group", "method"] {
        assert!(PAGE.contains(&format!("\n## `{key}`\n")), "{key}");
    }
}

#[test]
fn every_word_of_a_dial_has_a_meaning() {
    for dial in ["discretization", "chart", "solver", "summation", "code", "isotropy", "signature", "emit"] {
        let value = if dial == "emit" { "[unknownword]" } else { "unknownword" };
        let section = PAGE.split(&format!("\n## `{dial}`\n")).nth(1).and_then(|text| text.split("\n## ").next());
        for word in listed(&format!("{ACTION}, {LAGRANGIAN}, {dial} = {value}")) {
            assert!(section.is_some_and(|text| text.contains(&format!("\n* `{word}`: "))), "{dial} = {word}");
        }
    }
}

#[test]
fn every_group_and_every_function_has_a_row() {
    for group in listed(&format!("action = |F: Unheardof, R: SO<3>| R * F, {LAGRANGIAN}")) {
        assert!(PAGE.contains(&format!("| `{group}<N>`")), "{group}");
    }
    for method in listed(&format!("{ACTION}, lagrangian = |omega| omega.unheardof()")) {
        assert!(PAGE.contains(&format!("\n| `{method}` |")), "{method}");
    }
    for constructor in listed(&format!("{ACTION}, lagrangian = |omega| omega.dot(&Vector3::unheardof())")) {
        let has_row = PAGE.contains(&format!("\n| `{constructor}` |"));
        assert!(has_row || constructor == "new", "{constructor}");
    }
}
