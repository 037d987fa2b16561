//! The table is in the docs, and refuses no pair twice.

use super::{combinations, features_as_markdown};

#[test]
fn the_docs_show_the_table() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/features.md");
    let page = std::fs::read_to_string(path).unwrap_or_default();
    assert!(
        page.contains(&features_as_markdown()),
        "cargo run -p clebsch-compiler --example features > docs/features.md"
    );
}

#[test]
fn no_pair_is_refused_twice() {
    let pairs: Vec<_> = combinations().map(|(_, refused, beside)| (refused, beside)).collect();
    for (position, (one, other)) in pairs.iter().enumerate() {
        let again = pairs[..position].iter().any(|pair| *pair == (*one, *other) || *pair == (*other, *one));
        assert!(!again, "{one:?} and {other:?}");
    }
}
