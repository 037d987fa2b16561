//! The table as the docs print it.

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
