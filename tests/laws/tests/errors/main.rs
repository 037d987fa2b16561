//! Every error, provoked by a declared system in use: its text gives the names and numbers, and the advice.

#![allow(missing_docs)]

mod inputs;
mod scenes;

use std::collections::BTreeSet;

use clebsch::Error;
use proc_macro2::{Delimiter, TokenTree};
use scenes::scenes;

/// A scene that fails, and the facts that a person has to be told.
pub struct Scene {
    /// Where the error comes from.
    pub error: Error,
    /// The required parts of its text: names, numbers, and the advice.
    pub told: &'static [&'static str],
}

/// The name of the variant.
fn variant(error: &Error) -> String {
    format!("{error:?}").chars().take_while(|c| c.is_alphanumeric()).collect()
}

#[test]
fn every_error_says_what_to_change() {
    for Scene { error, told } in scenes() {
        let text = error.to_string();
        println!("{}: {text}", variant(&error));
        for part in told {
            assert!(text.contains(part), "{}: `{part}` is not in: {text}", variant(&error));
        }
        let is_sentence = text.starts_with(|c: char| c.is_lowercase() || c == '`') && !text.ends_with('.');
        assert!(is_sentence && !text.contains("  ") && !text.contains("NaN,NaN"), "{text}");
    }
}

/// The variants are those of the source, read as it is written: each follows its documentation.
#[test]
fn no_error_is_left_out() {
    let source = include_str!("../../../../runtime/src/error.rs");
    let file = syn::parse_file(source).expect("error.rs is Rust");
    let declared = file.items.iter().find_map(|item| match item {
        syn::Item::Macro(item) if item.mac.path.is_ident("errors") => item.mac.tokens.clone().into_iter().last(),
        _ => None,
    });
    let Some(TokenTree::Group(variants)) = declared else { panic!("an `enum Error` in `errors!`") };
    let tokens: Vec<TokenTree> = variants.stream().into_iter().collect();
    let declared = tokens.windows(2).filter_map(|pair| match pair {
        [TokenTree::Group(documentation), TokenTree::Ident(variant)] => {
            (documentation.delimiter() == Delimiter::Bracket).then(|| variant.to_string())
        }
        _ => None,
    });
    let declared: BTreeSet<String> = declared.collect();
    let provoked: BTreeSet<String> = scenes().iter().map(|scene| variant(&scene.error)).collect();
    assert_eq!(declared, provoked, "each variant needs a scene in tests/laws/tests/errors/scenes.rs");
}

/// The sources of errors chain, and errors can be handed on as any other.
#[test]
fn errors_are_errors() {
    fn check(error: impl std::error::Error + Send + Sync + 'static) -> Box<dyn std::error::Error + Send + Sync> {
        Box::new(error)
    }
    for scene in scenes() {
        assert_eq!(check(scene.error).to_string(), scene.error.to_string());
    }
}
