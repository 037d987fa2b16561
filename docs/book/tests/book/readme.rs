//! The README shows the derivation that its first struct got, and stays short.

use clebsch_compiler::{Graph, compile, derive, emit, model, parse};
use proc_macro2::TokenStream;
use quote::ToTokens;

const README: &str = include_str!("../../../../README.md");

/// The struct of the first example.
fn declaration() -> TokenStream {
    let file = syn::parse_file(include_str!("../../../../examples/rigid_body/main.rs")).expect("Rust source");
    let item = file.items.into_iter().find(|item| matches!(item, syn::Item::Struct(_)));
    item.expect("a struct").into_token_stream()
}

/// The lines of the first block of code in a language behind a heading.
fn block<'a>(heading: &str, language: &str) -> Vec<&'a str> {
    let section = README.split(heading).nth(1).expect("the heading");
    let fence = format!("```{language}\n");
    let block = section.split(&fence).nth(1).and_then(|text| text.split("```").next()).expect("the block");
    block.lines().collect()
}

#[test]
fn the_readme_shows_words_of_the_derivation() {
    let derivation = emit::derivations(&compile(&Graph::new(), declaration()).expect("a declaration"));
    for line in block("## The derivation", "text") {
        assert!(derivation.lines().any(|said| said == line), "the derivation does not say: {line}\n{derivation}");
    }
}

/// GitHub does not take `\operatorname`.
#[test]
fn the_readme_shows_five_formulas_of_the_derivation() {
    let graph = Graph::new();
    let model = model::model(&graph, &parse::parse(declaration()).expect("a declaration"), model::ByNumber::Unrolled)
        .expect("a system");
    let latex = derive::derive(model).expect("formulas").latex().replace(r"\operatorname", r"\mathrm");
    let bare = |line: &str| line.trim_end_matches(r"\\").trim().to_owned();
    let formulas: Vec<String> = latex.lines().map(bare).collect();
    let block = block("## The derivation", "math");
    let shown: Vec<String> = block.iter().filter(|line| line.contains("&=")).map(|line| bare(line)).collect();
    assert_eq!(shown.len(), 5);
    for formula in shown {
        assert!(formulas.contains(&formula), "no formula of the derivation: {formula}\n{latex}");
    }
}

#[test]
fn the_readme_is_short() {
    assert!(README.lines().count() <= 200, "{} lines: move some to a page of the book", README.lines().count());
    assert!(README.len() <= 12_000, "{} bytes: move some to a page of the book", README.len());
}
