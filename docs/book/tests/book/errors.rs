//! The page about errors names every error of the runtime.

use crate::pages::{read, root};

/// The name that a line of the enum declares.
fn variant(line: &str) -> Option<&str> {
    let line = line.strip_prefix("        ")?;
    let name = line.strip_suffix(" {").or(line.strip_suffix(" =>"))?;
    let is_name = name.starts_with(char::is_uppercase) && name.chars().all(char::is_alphanumeric);
    is_name.then_some(name)
}

#[test]
fn every_error_has_a_cause_and_a_cure() {
    let page = read(&root().join("docs/book/src/reference/errors.md"));
    let source = read(&root().join("runtime/src/error.rs"));
    let names: Vec<&str> = source.lines().filter_map(variant).collect();
    assert!(names.len() > 20, "{names:?}");
    for name in names {
        assert!(page.contains(&format!("\n| `{name}` | ")), "{name} is missing in docs/book/src/reference/errors.md");
    }
}
