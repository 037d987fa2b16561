//! The docs show the table.

use super::keys_as_markdown;

#[test]
fn the_docs_show_the_keys() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/features.md");
    let page = std::fs::read_to_string(path).unwrap_or_default();
    assert!(page.contains(&keys_as_markdown()), "cargo run -p clebsch-compiler --example features > docs/features.md");
}
