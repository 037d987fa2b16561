//! The properties in a file, and the subject of each. The subject is the words of its body and, in turn, of the
//! functions and macros of the same file that it names.

use proc_macro2::{Delimiter, TokenStream, TokenTree};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// The functions and macros of a file with the words in their bodies, and which of them are properties.
#[derive(Default)]
pub struct File {
    bodies: BTreeMap<String, BTreeSet<String>>,
    properties: BTreeSet<String>,
}

impl File {
    /// Reads a file.
    pub fn read(path: &Path) -> File {
        let text = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let mut file = File::default();
        file.collect(text.parse().unwrap_or_else(|error| panic!("{}: {error}", path.display())), false);
        file
    }

    fn collect(&mut self, tokens: TokenStream, in_properties: bool) {
        let tokens: Vec<TokenTree> = tokens.into_iter().collect();
        for (i, token) in tokens.iter().enumerate() {
            let TokenTree::Group(group) = token else {
                self.declare(&tokens[i..], in_properties);
                continue;
            };
            let is_block = i >= 2 && is_word(&tokens[i - 2], "proptest") && group.delimiter() == Delimiter::Brace;
            self.collect(group.stream(), in_properties || is_block);
        }
    }

    /// `fn name … { body }` or `macro_rules! name { body }`
    fn declare(&mut self, tokens: &[TokenTree], in_properties: bool) {
        let place = match tokens {
            [first, ..] if is_word(first, "fn") => 1,
            [first, ..] if is_word(first, "macro_rules") => 2,
            _ => return,
        };
        let Some(TokenTree::Ident(name)) = tokens.get(place) else { return };
        let body = tokens.iter().skip(place + 1).find_map(|token| match token {
            TokenTree::Group(group) if group.delimiter() == Delimiter::Brace => Some(group.stream()),
            _ => None,
        });
        self.bodies.entry(name.to_string()).or_default().extend(body.into_iter().flat_map(words));
        if in_properties {
            self.properties.insert(name.to_string());
        }
    }

    /// Whether there is a property of this name.
    pub fn has_property(&self, name: &str) -> bool {
        self.properties.contains(name)
    }

    /// Whether the property, or a function that it calls in its file, names the function.
    pub fn is_about(&self, property: &str, function: &str) -> bool {
        let (mut seen, mut open) = (BTreeSet::new(), vec![property]);
        while let Some(name) = open.pop() {
            let Some(body) = self.bodies.get(name).filter(|_| seen.insert(name)) else { continue };
            if body.contains(function) {
                return true;
            }
            open.extend(body.iter().map(String::as_str));
        }
        false
    }
}

fn is_word(token: &TokenTree, word: &str) -> bool {
    matches!(token, TokenTree::Ident(ident) if ident == word)
}

/// All identifiers, in their order.
pub fn words(tokens: TokenStream) -> Vec<String> {
    let words = tokens.into_iter().flat_map(|token| match token {
        TokenTree::Ident(ident) => vec![ident.to_string()],
        TokenTree::Group(group) => words(group.stream()),
        _ => vec![],
    });
    words.collect()
}
