//! Which features of a declaration do not go together: one table, used by every refusal and printed in the reference.
//!
//! A stage says which features it has found and where; [`refusals`] looks the combinations up. A rule for a new feature is a row.

mod declared;
mod feature;
mod rows;
#[cfg(test)]
mod tests;

use clebsch_symbolic::{Elements, IntoElements, IntoList};
use proc_macro2::Span;

use crate::diagnostic::{Diagnostic, Diagnostics, Location, error};
pub(crate) use declared::declared;
pub(crate) use feature::Feature;
use rows::ROWS;

/// Features that do not go with each other: each of the first with each of the second.
struct Row {
    /// The features that are refused; the error is at their place.
    refused: &'static [Feature],
    /// The features with which they are refused.
    beside: &'static [Feature],
    /// The message. `{refused}` and `{beside}` are the two features, `{name}` is a name that the declaration gives.
    message: &'static str,
    /// The mathematical reason; empty where the message says it.
    why: &'static str,
    /// The replacement.
    help: &'static str,
}

/// A feature that a stage has found.
#[derive(Clone)]
pub(crate) struct Found {
    place: Location,
    name: String,
}

impl Found {
    pub fn at(place: impl Into<Location>) -> Found {
        Found { place: place.into(), name: String::new() }
    }

    /// A feature without a place of its own.
    pub fn somewhere() -> Found {
        Found::at(Span::call_site())
    }

    /// A feature without a place of its own, if it is there.
    pub fn when(found: bool) -> Option<Found> {
        found.then(Found::somewhere)
    }

    /// The same with the name that messages give.
    #[must_use]
    pub fn named(self, name: impl ToString) -> Found {
        Found { name: name.to_string(), ..self }
    }
}

/// An error for each combination of found features that the table refuses, in the order of the table.
pub(crate) fn refusals(found: impl Fn(Feature) -> Option<Found>) -> impl Iterator<Item = Diagnostic> {
    combinations().filter_map(move |combination| error(combination, &found))
}

/// The same for one feature: the features with which it does not go together.
pub(crate) fn refusals_of(
    (feature, itself): (Feature, Found),
    found: impl Fn(Feature) -> Option<Found>,
) -> impl Iterator<Item = Diagnostic> {
    let is_of_it = move |(_, refused, beside): &Combination| [*refused, *beside].contains(&feature);
    let found = move |other| if other == feature { Some(itself.clone()) } else { found(other) };
    combinations().filter(is_of_it).filter_map(move |combination| error(combination, &found))
}

fn error((row, refused, beside): Combination, found: &dyn Fn(Feature) -> Option<Found>) -> Option<Diagnostic> {
    let (refused, beside) = ((refused, found(refused)?), (beside, found(beside)?));
    Some(row.diagnostic(refused, beside))
}

/// Whether a feature goes with all other features that are found.
///
/// # Errors
/// The first combination that the table refuses.
pub(crate) fn check(itself: (Feature, Found), found: impl Fn(Feature) -> Option<Found>) -> Result<(), Diagnostics> {
    refusals_of(itself, found).next().map_or(Ok(()), |error| Err(error.into()))
}

/// The error for two features that the table refuses.
pub(crate) fn refusal(refused: (Feature, Found), beside: (Feature, Found)) -> Diagnostic {
    let is_pair = |(_, one, other): &Combination| (*one, *other) == (refused.0, beside.0);
    match combinations().find(is_pair) {
        Some((row, ..)) => row.diagnostic(refused, beside),
        // by construction: a stage refuses combinations that are in the table
        None => error!(refused.1.place, "{} does not go with {}", refused.0.words(), beside.0.words()),
    }
}

/// A row with one of its pairs: the refused feature, and the other one.
type Combination = (&'static Row, Feature, Feature);

/// Every row for each of its pairs.
fn combinations() -> impl Iterator<Item = Combination> {
    let of_row = |row: &'static Row| {
        row.beside.iter().flat_map(move |beside| row.refused.iter().map(move |refused| (row, *refused, *beside)))
    };
    ROWS.iter().flat_map(of_row)
}

/// The features with which one is refused, in the order of the table.
pub(crate) fn refused_beside(feature: Feature) -> impl Iterator<Item = Feature> {
    ROWS.iter().filter(move |row| row.refused.contains(&feature)).flat_map(|row| row.beside.iter().copied())
}

impl Row {
    fn diagnostic(&self, refused: (Feature, Found), beside: (Feature, Found)) -> Diagnostic {
        let name = if refused.1.name.is_empty() { &beside.1.name } else { &refused.1.name };
        let fill = |text: &str| filled(text, refused.0.words(), beside.0.words(), name);
        let error = Diagnostic::new(refused.1.place, fill(self.message)).help(fill(self.help));
        if self.why.is_empty() { error } else { error.note(fill(self.why)) }
    }
}

fn filled(text: &str, refused: &str, beside: &str, name: &str) -> String {
    text.replace("{refused}", refused).replace("{beside}", beside).replace("{name}", name)
}

/// The conflicts of a key and of its values: a line for each of them, in the order of the table.
pub(crate) fn refused_with(key: &str) -> Vec<String> {
    let mut refused: Vec<(&str, Vec<&str>)> = Vec::new();
    for (_, one, other) in combinations() {
        for (own, beside) in [(one, other), (other, one)] {
            if !own.belongs_to(key) || beside.belongs_to(key) {
                continue;
            }
            let known = refused.iter().position(|(feature, _)| *feature == own.words()).unwrap_or(refused.len());
            if known == refused.len() {
                refused.push((own.words(), Vec::new()));
            }
            let others = &mut refused[known].1;
            if !others.contains(&beside.words()) {
                others.push(beside.words());
            }
        }
    }
    refused.into_each(|(own, others)| conflicts(own, &others))
}

/// Keys and values in one line, and below it a list of the features that have no name.
fn conflicts(own: &str, others: &[&str]) -> String {
    let (named, described): (Vec<&str>, Vec<&str>) = others.iter().partition(|feature| feature.starts_with('`'));
    let gap = if named.is_empty() { "" } else { " " };
    let below = described.iter().map(|feature| format!("\n  * {feature}"));
    format!("{own}: not with{gap}{}{}", named.join(", "), below.collect::<String>())
}

/// The table of combinations that are refused, in Markdown.
pub(crate) fn features_as_markdown() -> String {
    let head = "| feature | not with | reason | cure |\n|---|---|---|---|\n";
    ROWS.iter().map(markdown_row).fold(head.to_string(), |table, row| table + &row)
}

fn markdown_row(row: &Row) -> String {
    let refused = words(row.refused, ", ");
    let beside = words(row.beside, ", ");
    let fill = |text: &str, name: &str| {
        filled(text, &either(row.refused, "the former"), &either(row.beside, "the latter"), name)
    };
    let why = without_tags(&fill(if row.why.is_empty() { row.message } else { row.why }, "…"));
    // help gives the name of a velocity; a bar would end a cell
    let help = fill(row.help, "omega").replace('|', "\\|");
    format!("| {refused} | {beside} | {why} | {help} |\n")
}

/// Angles outside of code begin a tag of HTML in Markdown.
fn without_tags(text: &str) -> String {
    let part = |(position, part): (usize, &str)| if position % 2 == 0 { part.replace('<', "\\<") } else { part.into() };
    text.split('`').enumerate().map(part).into_list().join("`")
}

/// Few features by their words, else words for all of them.
fn either(features: &[Feature], stand_in: &str) -> String {
    if features.len() > 2 { stand_in.to_string() } else { words(features, " or ") }
}

fn words(features: &[Feature], separator: &str) -> String {
    features.each(|feature| feature.words()).join(separator)
}
