//! The table of keys as the docs print it.

use super::{KEYS, Key};

/// The table of all keys in Markdown.
pub fn keys_as_markdown() -> String {
    let head = "| key | an example | default | of |\n|---|---|---|---|\n";
    let rows = KEYS.iter().filter(|key| !key.comes_later()).map(row);
    let table = rows.fold(head.to_string(), |table, row| table + &row);
    let dials: Vec<String> = KEYS.iter().filter(|key| key.of_method).map(|key| format!("`{}`", key.name)).collect();
    format!(
        "{table}
`method NAME = (dial = value, …)` declares a further way to step the same system. `NAME` is a unit struct of yours. There may be any number of methods.
The dials of a method are {}. One that a method does not name has its default, whatever the declaration says.
`emit = [tangent]` and `[boundary]` serve every method whose steps can be differentiated. `effort` is of the steps with the declared dials.
",
        dials.join(", ")
    )
}

fn row(key: &Key) -> String {
    let Key { name, example, default, of, .. } = key;
    // a bar would end a cell
    format!("| `{name}` | `{name} = {}` | {default} | {of} |\n", example.replace('|', "\\|"))
}

#[test]
fn the_docs_show_the_keys() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/features.md");
    let page = std::fs::read_to_string(path).unwrap_or_default();
    assert!(page.contains(&keys_as_markdown()), "cargo run -p clebsch-compiler --example features > docs/features.md");
}
