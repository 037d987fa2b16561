//! The table of keys as the docs print it.

use super::{KEYS, Key};

/// The table of all keys in Markdown.
pub fn keys_as_markdown() -> String {
    let head = "| key | an example | default | of |\n|---|---|---|---|\n";
    KEYS.iter().filter(|key| !key.comes_later()).map(row).fold(head.to_string(), |table, row| table + &row)
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
