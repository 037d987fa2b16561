//! How a generated function is written: its documentation, its signature and its body.

use clebsch_symbolic::{Elements, IntoList, both};
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::SystemEmitter;
use super::block::{Block, matrix};
use super::names::put_in;
use super::scope::{Scope, size};
use crate::derive::{Formula, Id};
use crate::lower::Kernel;

/// A generated function.
pub struct Function {
    /// Its name.
    pub name: &'static str,
    /// The beginning of its documentation; empty if it has none.
    pub title: &'static str,
    /// The kernel that it computes, by its id in the first substep.
    pub kernel: Id,
    /// The formulas that its documentation shows.
    pub shown: &'static [Id],
    pub arguments: &'static str,
    pub result: &'static str,
    pub is_inline: bool,
    /// Its statements, where they are not just those of the kernel.
    pub code: &'static str,
}

/// The body of a generated function, and its attributes.
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
    /// The value of one kernel, in some code.
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

    /// The body that the table says, where there is the kernel that it names.
    pub(super) fn written<'k>(
        &self,
        scope: &Scope<'_, '_>,
        kernel: Option<&'k Kernel>,
        words: &Words<'_>,
    ) -> Option<Body<'k>> {
        if self.code.is_empty() {
            return Some(self.computes(scope, kernel?));
        }
        let cost = if self.code.contains("Locals") { Some(kernel?) } else { None };
        let of_kernel = |word: &str| match (number(word, "Value"), number(word, "Number")) {
            (Some(index), _) => Some(scope.output(kernel?, index)),
            (_, Some(index)) => Some(scope.scalar(kernel?, index)),
            _ if word == "Locals" => Some(scope.locals(kernel?)),
            _ => None,
        };
        let code = scope.parsed(self.code, &|word| words(word).or_else(|| of_kernel(word)));
        Some(Body { cost, ..Body::from(code) })
    }

    /// The body that computes a kernel and returns its value.
    pub(super) fn computes<'k>(&self, scope: &Scope<'_, '_>, kernel: &'k Kernel) -> Body<'k> {
        let locals = scope.locals(kernel);
        let value = match self.result {
            "T" => scope.scalar(kernel, 0),
            "Q" | "Option<Q>" | "Self::Configuration" => scope.configuration(kernel),
            "F" | "Self::Element" => scope.element(kernel, 0),
            _ => scope.output(kernel, 0),
        };
        let value = if self.result.starts_with("Option") { quote!(runtime::Some(#value)) } else { value };
        Body::new(kernel, quote!(#locals #value))
    }
}

/// The tokens for the words of a table.
pub(super) type Words<'w> = dyn Fn(&str) -> Option<TokenStream> + 'w;

impl<'g> SystemEmitter<'_, 'g> {
    /// The functions of a table as it says them.
    pub(super) fn written(&self, table: &[Function], scope: &Scope<'_, '_>, words: &Words<'_>) -> TokenStream {
        self.functions(table, (0, 0), words, |function, kernel| function.written(scope, kernel, words))
    }

    /// The functions of a table that have a body, made from their kernels. Those of a substep, or of an equation in it,
    /// have a place.
    pub(super) fn functions<'k>(
        &'k self,
        table: &[Function],
        place: (usize, usize),
        words: &Words<'_>,
        body: impl Fn(&Function, Option<&'k Kernel>) -> Option<Body<'k>>,
    ) -> TokenStream {
        let mut written = TokenStream::new();
        for function in table {
            if let Some(body) = body(function, self.kernels.find(function.kernel.at(place))) {
                written.extend(self.documented(function, place, words, body));
            }
        }
        written
    }

    fn documented(&self, function: &Function, place: (usize, usize), words: &Words<'_>, body: Body<'_>) -> TokenStream {
        let title = body.title.unwrap_or(function.title);
        let is_shown = |id: Id| function.shown.iter().any(|shown| shown.is_like(id) && id.at(place) == id);
        let documentation = || self::documentation(title, self.rows.titled_all(is_shown), body.cost);
        let documentation = (!title.is_empty()).then(documentation);
        let function = self.function(function, words, body);
        quote!(#documentation #function)
    }
}

/// No words but those of every table.
pub(super) fn no_words(_: &str) -> Option<TokenStream> {
    None
}

/// The number behind a word of this kind.
pub(super) fn number(word: &str, kind: &str) -> Option<usize> {
    word.strip_prefix(kind)?.parse().ok()
}

impl Block<'_> {
    /// A function of a table.
    pub(super) fn function(
        &self,
        function: &Function,
        words: &Words<'_>,
        Body { inline, code, .. }: Body<'_>,
    ) -> TokenStream {
        let inline = inline.or_else(|| function.is_inline.then(|| quote!(#[inline])));
        let name = format_ident!("{}", function.name);
        let [arguments, result] = both([function.arguments, function.result], |text| self.parsed(text, words));
        quote!(#inline fn #name #arguments -> #result { #code })
    }

    /// The tokens of a text, with its words replaced.
    fn parsed(&self, text: &str, words: &Words<'_>) -> TokenStream {
        // by construction: the texts in the table of functions were tokens
        put_in(text.parse().unwrap_or_default(), &|name, _| words(name).or_else(|| self.word(name)))
    }

    /// The tokens for a word of a table, unless it stands for itself.
    fn word(&self, word: &str) -> Option<TokenStream> {
        let (name, dimension) = (format_ident!("{word}"), size(self.dimension));
        Some(match word {
            "Receiver" if self.method.is_none() => quote!(&self),
            "Receiver" => {
                let system = self.target.of_type();
                quote!(system: &#system)
            }
            "U" => self.input.clone(),
            "Bool" => quote!(::core::primitive::bool),
            "Option" | "Solved" | "Result" | "Error" | "Orientation" => quote!(runtime::#name),
            "Momenta" | "Edge" | "Carried" | "EndpointExpansion" => quote!(runtime::#name<T, #dimension>),
            "Ends" => quote!(runtime::Ends<'_, Self>),
            "PassedEdge" => quote!(runtime::PassedEdge<T, #dimension>),
            "Square" => matrix(self.dimension, self.dimension),
            _ => return None,
        })
    }
}

/// Doc attributes, one for each line; the space before each line keeps it off the slashes.
pub(super) fn lines(text: &str) -> TokenStream {
    let lines = text.split('\n').map(|line| if line.is_empty() { String::new() } else { format!(" {line}") });
    quote!(#(#[doc = #lines])*)
}

/// A title with the shape, the cost of the kernel and the source of its formulas, and below these the formulas.
pub(super) fn documentation(title: &str, formulas: &[Formula<'_>], kernel: Option<&Kernel>) -> TokenStream {
    let (mut line, first) = (vec![title.to_string()], formulas.first());
    line.extend(first.map(|formula| {
        let shapes: Vec<String> = formula.shapes().each(|shape| shape.to_string());
        format!("Shape: {}.", shapes.join(", "))
    }));
    line.extend(kernel.map(|kernel| format!("Cost: {}.", kernel.cost())));
    line.extend(first.and_then(|formula| formula.source).map(|source| format!("Source: {source}.")));
    let equations = formulas.iter().map(|formula| format!("`{}`", formula.equation()));
    let text: Vec<String> = [line.join(" ")].into_iter().chain(equations).into_list();
    lines(&text.join("\n"))
}
