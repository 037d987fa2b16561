//! Every public type and trait of the runtime has an example in its documentation, which `cargo test -p clebsch --doc` runs.

use crate::pages::{files, read, root};

/// The names that a line of `lib.rs` exports.
fn exported(line: &str) -> Vec<&str> {
    let Some(path) = line.strip_prefix("pub use ").and_then(|path| path.strip_suffix(';')) else { return Vec::new() };
    match path.split_once("::{").and_then(|(_, names)| names.strip_suffix('}')) {
        Some(names) => names.split(", ").collect(),
        None => path.rsplit("::").take(1).filter(|name| name.starts_with(char::is_uppercase)).collect(),
    }
}

/// The name of a public type or trait that a line declares.
fn declared(line: &str) -> Option<&str> {
    let kinds = ["pub struct ", "pub enum ", "pub trait ", "pub type "];
    let name = kinds.iter().find_map(|kind| line.trim_start().strip_prefix(kind))?;
    name.split(|letter: char| !letter.is_alphanumeric()).next().filter(|name| !name.is_empty())
}

/// The types and traits of a source whose documentation has a block of code without a language, which is Rust that runs.
fn with_examples(source: &str) -> Vec<&str> {
    let mut found = Vec::new();
    let mut has_example = false;
    for line in source.lines() {
        let text = line.trim_start();
        if text.starts_with("///") {
            has_example |= text == "/// ```";
        } else if let Some(name) = declared(line) {
            found.extend(has_example.then_some(name));
            has_example = false;
        } else if !text.starts_with(['#', ')', '/']) && !text.contains(" = \"") {
            has_example = false;
        }
    }
    found
}

#[test]
fn every_public_type_and_trait_has_an_example() {
    let sources: Vec<String> = files(&root().join("runtime/src"), "rs").iter().map(|path| read(path)).collect();
    let known: Vec<&str> = sources.iter().flat_map(|source| with_examples(source)).collect();
    let library = read(&root().join("runtime/src/lib.rs"));
    let names: Vec<&str> = library.lines().flat_map(exported).collect();
    assert!(names.len() > 50, "{names:?}");
    // the numbers in lanes are declared by a macro, which gives them their examples
    let of_macro = |name: &str| name.starts_with("F64x") || name.starts_with("F32x");
    let missing: Vec<&str> = names.into_iter().filter(|name| !of_macro(name) && !known.contains(name)).collect();
    assert!(missing.is_empty(), "without an example in runtime/src: {missing:?}");
}

#[test]
fn every_public_type_of_plots_has_an_example() {
    let sources: Vec<String> = files(&root().join("runtime/plot/src"), "rs").iter().map(|path| read(path)).collect();
    let names: Vec<&str> = sources.iter().flat_map(|source| source.lines()).filter_map(declared).collect();
    let known: Vec<&str> = sources.iter().flat_map(|source| with_examples(source)).collect();
    let missing: Vec<&&str> = names.iter().filter(|name| !known.contains(name)).collect();
    assert!(names.len() > 20 && missing.is_empty(), "without an example in runtime/plot/src: {missing:?}");
}

#[test]
fn every_group_has_an_example() {
    let groups = read(&root().join("runtime/src/group.rs"));
    let names: Vec<&str> = groups.lines().filter_map(declared).collect();
    let known = with_examples(&groups);
    assert!(names.len() > 10 && names == known, "{names:?}, with examples {known:?}");
}
