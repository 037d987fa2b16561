//! The table as the docs print it.

#[cfg(test)]
use super::combinations;
use super::rows::ROWS;
use super::{Feature, Row, filled};

/// The table of what does not go together in Markdown.
pub fn features_as_markdown() -> String {
    let head = "| what | does not go with | why | what to write |\n|---|---|---|---|\n";
    ROWS.iter().map(row).fold(head.to_string(), |table, row| table + &row)
}

fn row(row: &Row) -> String {
    let refused = words(row.refused, ", ");
    let beside = words(row.beside, ", ");
    let fill = |text: &str, name: &str| {
        filled(text, &either(row.refused, "the former"), &either(row.beside, "the latter"), name)
    };
    let why = fill(if row.why.is_empty() { row.message } else { row.why }, "…");
    // help gives the name of a velocity; a bar would end a cell
    let help = fill(row.help, "omega").replace('|', "\\|");
    format!("| {refused} | {beside} | {why} | {help} |\n")
}

/// Few features by their words, else what stands for them.
fn either(features: &[Feature], stand_in: &str) -> String {
    if features.len() > 2 { stand_in.to_string() } else { words(features, " or ") }
}

fn words(features: &[Feature], separator: &str) -> String {
    features.iter().map(|feature| feature.words()).collect::<Vec<_>>().join(separator)
}

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
