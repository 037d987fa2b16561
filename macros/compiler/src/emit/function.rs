//! How a generated function is written: its documentation, its signature and its body.

use proc_macro2::{Group, TokenStream, TokenTree};
use quote::{format_ident, quote};

use super::scope::{Scope, size};
use super::{SystemEmitter, docs};
use crate::derive::{Formula, Id};
use crate::lower::Kernel;

/// A generated function.
pub struct Function {
    /// Its name.
    pub name: &'static str,
    /// What its documentation begins with; empty where it has none.
    pub title: &'static str,
    /// What it computes, by the id that this has in the first substep.
    pub kernel: Id,
    /// The formulas that its documentation shows.
    pub shown: &'static [Id],
    pub arguments: &'static str,
    pub result: &'static str,
    pub is_inline: bool,
}

/// What a generated function does.
pub(super) struct Body<'k> {
    /// The title of its documentation, where it is not that of the table.
    pub title: Option<&'static str>,
    /// The kernel whose cost its documentation tells.
    pub cost: Option<&'k Kernel>,
    /// How it is inlined, where that is not said by the table.
    pub inline: Option<TokenStream>,
    /// Its statements.
    pub code: TokenStream,
}

impl<'k> Body<'k> {
    /// What one kernel computes, in some code.
    pub fn new(kernel: &'k Kernel, code: TokenStream) -> Body<'k> {
        Body { cost: Some(kernel), ..Body::from(code) }
    }

    /// The same with another title.
    pub fn titled(self, title: &'static str) -> Body<'k> {
        Body { title: Some(title), ..self }
    }

    /// The same behind other statements.
    pub fn after(self, before: Option<TokenStream>) -> Body<'k> {
        let code = self.code;
        Body { code: quote!(#before #code), ..self }
    }

    /// The same with other attributes, `#[inline]` or none.
    pub fn inlined(self, inline: TokenStream) -> Body<'k> {
        Body { inline: Some(inline), ..self }
    }
}

impl From<TokenStream> for Body<'_> {
    fn from(code: TokenStream) -> Self {
        Body { title: None, cost: None, inline: None, code }
    }
}

impl Function {
    /// Whether the system is one of its arguments, so that each method has its own.
    pub(super) fn is_of_method(&self) -> bool {
        self.arguments.contains("Receiver")
    }

    /// Whether its documentation shows a formula.
    pub(super) fn shows(&self, id: Id) -> bool {
        self.shown.iter().any(|shown| shown.is_like(id))
    }

    /// The body that computes a kernel and returns what it gives.
    pub(super) fn computes<'k>(&self, scope: &Scope<'_, '_>, kernel: &'k Kernel) -> Body<'k> {
        let (private, locals) = (&scope.paths.private, scope.locals(kernel));
        let value = match self.result {
            "T" => scope.scalar(kernel, 0),
            "Q" | "Option<Q>" | "Self::Configuration" => scope.configuration(kernel),
            "F" | "Self::Element" => scope.element(kernel, 0),
            _ => scope.output(kernel, 0),
        };
        let value = if self.result.starts_with("Option") { quote!(#private::Some(#value)) } else { value };
        Body::new(kernel, quote!(#locals #value))
    }
}

/// Names in signatures, with what they stand for.
pub(super) type Words = [(&'static str, TokenStream)];

impl<'g> SystemEmitter<'_, 'g> {
    /// The functions of a table that have a body, made from their kernels; those of a substep, or of an equation in it, have a place.
    pub(super) fn functions<'k>(
        &'k self,
        table: &[Function],
        place: (usize, usize),
        words: &Words,
        body: impl Fn(&Function, Option<&'k Kernel>) -> Option<Body<'k>>,
    ) -> TokenStream {
        let written = table.iter().filter_map(|function| {
            let Body { title, cost, inline, code } = body(function, self.kernels.find(function.kernel.at(place)))?;
            let title = title.unwrap_or(function.title);
            let documentation = (!title.is_empty()).then(|| docs::formulas(title, self.shown(function, place), cost));
            let inline = inline.or_else(|| function.is_inline.then(|| quote!(#[inline])));
            let name = format_ident!("{}", function.name);
            // by construction: what the table of functions holds was tokens
            let [arguments, result] =
                [function.arguments, function.result].map(|text| self.put_in(text.parse().unwrap_or_default(), words));
            Some(quote!(#documentation #inline fn #name #arguments -> #result { #code }))
        });
        written.collect()
    }

    /// The formulas that the documentation of a function shows.
    fn shown(&self, function: &Function, place: (usize, usize)) -> &[Formula<'g>] {
        self.rows.titled_all(|id| function.shown.iter().any(|shown| shown.is_like(id) && id.at(place) == id))
    }

    /// Some tokens, with what their words stand for.
    fn put_in(&self, tokens: TokenStream, words: &Words) -> TokenStream {
        let put_in = |token: TokenTree| match token {
            TokenTree::Ident(name) => {
                let word = words.iter().find(|(word, _)| name == word).map(|(_, tokens)| tokens.clone());
                word.or_else(|| self.word(&name.to_string())).unwrap_or_else(|| TokenTree::from(name).into())
            }
            TokenTree::Group(group) => {
                TokenTree::from(Group::new(group.delimiter(), self.put_in(group.stream(), words))).into()
            }
            other => other.into(),
        };
        tokens.into_iter().map(put_in).collect()
    }

    /// What a word stands for, unless it is itself.
    fn word(&self, word: &str) -> Option<TokenStream> {
        let (private, krate, scalar) = (&self.paths.private, &self.paths.krate, &self.paths.scalar);
        let name = format_ident!("{word}");
        Some(match word {
            "Receiver" => self.receiver_parameter(),
            "T" => quote!(#scalar),
            "Q" | "F" | "Mu" | "C" => self.alias(word),
            "U" => self.input_type(),
            "Bool" => quote!(::core::primitive::bool),
            "Option" | "Solved" | "Result" | "Error" | "Orientation" => quote!(#private::#name),
            "Momenta" | "Edge" | "Carried" | "EndpointExpansion" => {
                let dimension = size(self.model.dimension());
                quote!(#krate::#name<#scalar, #dimension>)
            }
            "Square" => self.paths.matrix_of_any_shape(self.model.dimension(), self.model.dimension()),
            _ => return None,
        })
    }
}
