//! Hints for editors: the keys and values of a declaration, with their places, as paths of documented items of the runtime.
//!
//! An editor shows the documentation of such an item, and completes its name. The items exist for rust-analyzer alone. They are read from the
//! tokens, so that a declaration with errors has them too.

#[cfg(test)]
mod tests;

use proc_macro2::{Delimiter, Group, Ident, Spacing, TokenStream, TokenTree};
use quote::quote;
use syn::Path;
use syn::parse::Parser;

use crate::parse;

/// An import of the item of each key and of each word in the attributes of a struct and of its fields.
pub(crate) fn hints(item: &TokenStream) -> TokenStream {
    let mut found = Found { krate: quote!(::clebsch), paths: Vec::new() };
    let tokens: Vec<TokenTree> = item.clone().into_iter().collect();
    for list in lists(&tokens) {
        found.items(&list, false);
    }
    for fields in tokens.iter().filter_map(group) {
        let fields: Vec<TokenTree> = fields.stream().into_iter().collect();
        let words = lists(&fields).into_iter().flatten();
        found.paths.extend(words.filter_map(|word| ident(&word)).map(|word| quote!(field::#word)));
    }
    let Found { krate, paths } = found;
    // rustc does not know the condition, which rust-analyzer sets
    quote! {
        #[allow(unexpected_cfgs)]
        const _: () = {
            #[cfg(rust_analyzer)]
            const _: () = {
                #(use #krate::__private::keys::#paths as _;)*
            };
        };
    }
}

/// The contents of the attributes `#[clebsch(…)]` among some tokens.
fn lists(tokens: &[TokenTree]) -> Vec<Vec<TokenTree>> {
    let attributes = tokens.iter().filter_map(group).filter(|group| group.delimiter() == Delimiter::Bracket);
    let list = |attribute: &Group| match attribute.stream().into_iter().collect::<Vec<_>>().as_slice() {
        [TokenTree::Ident(name), TokenTree::Group(list)] if name == "clebsch" => {
            Some(list.stream().into_iter().collect())
        }
        _ => None,
    };
    attributes.filter_map(list).collect()
}

struct Found {
    /// The path of the runtime.
    krate: TokenStream,
    paths: Vec<TokenStream>,
}

impl Found {
    /// `key = value`, `method NAME = (…)`, whose dials are items too, and keys that are still being written.
    fn items(&mut self, tokens: &[TokenTree], are_of_method: bool) {
        for item in split(tokens) {
            if let [TokenTree::Ident(key), equals, path @ ..] = item
                && key == "crate"
                && is_equals(equals)
            {
                let path = Path::parse_mod_style.parse2(path.iter().cloned().collect());
                self.krate = path.map_or(quote!(::clebsch), |path| quote!(#path));
            }
            let Some(key) = item.first().and_then(ident) else { continue };
            match &item[1..] {
                [] => self.paths.push(quote!(#key)),
                [TokenTree::Ident(_), definition @ ..] if parse::is_named(&key) => {
                    self.paths.push(quote!(#key));
                    let dials = definition.get(1).and_then(group).filter(|_| key == "method" && !are_of_method);
                    if let Some(dials) = dials {
                        self.items(&dials.stream().into_iter().collect::<Vec<_>>(), true);
                    }
                }
                [equals, value @ ..] if is_equals(equals) => self.value(&key, value),
                _ => {}
            }
        }
    }

    fn value(&mut self, key: &Ident, value: &[TokenTree]) {
        let words: Vec<Ident> = match value {
            [word @ TokenTree::Ident(_)] | [word @ TokenTree::Ident(_), TokenTree::Group(_)] => {
                ident(word).into_iter().collect()
            }
            [TokenTree::Group(list)] => list.stream().into_iter().filter_map(|word| ident(&word)).collect(),
            _ => Vec::new(),
        };
        if words.is_empty() || !parse::has_words(key) {
            self.paths.push(quote!(#key));
        } else {
            self.paths.extend(words.iter().map(|word| quote!(#key::#word)));
        }
    }
}

/// The items between commas; those between the bars of a closure separate arguments.
fn split(tokens: &[TokenTree]) -> Vec<&[TokenTree]> {
    let mut is_head = false;
    let is_comma = |token: &TokenTree| {
        is_head ^= matches!(token, TokenTree::Punct(mark) if mark.as_char() == '|');
        !is_head && matches!(token, TokenTree::Punct(mark) if mark.as_char() == ',')
    };
    tokens.split(is_comma).collect()
}

/// A name that is no keyword: paths have to be such, also where they are not compiled.
fn ident(token: &TokenTree) -> Option<Ident> {
    syn::parse2(token.clone().into()).ok()
}

fn group(token: &TokenTree) -> Option<&Group> {
    if let TokenTree::Group(group) = token { Some(group) } else { None }
}

fn is_equals(token: &TokenTree) -> bool {
    matches!(token, TokenTree::Punct(mark) if mark.as_char() == '=' && mark.spacing() == Spacing::Alone)
}
