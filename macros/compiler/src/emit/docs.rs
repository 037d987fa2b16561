//! Doc comments of generated functions: title, formula, cost.

use proc_macro2::TokenStream;
use quote::quote;

use crate::derive::Formula;
use crate::lower::Kernel;

/// Doc attributes, one for each line; the space before each line keeps it off the slashes.
pub fn lines(text: &str) -> TokenStream {
    let lines = text.split('\n').map(|line| if line.is_empty() { String::new() } else { format!(" {line}") });
    quote!(#(#[doc = #lines])*)
}

/// A title with the shape, the cost of the kernel and the source of its formulas, and below these the formulas.
pub fn formulas(title: &str, formulas: &[Formula<'_>], kernel: Option<&Kernel>) -> TokenStream {
    let (mut line, first) = (vec![title.to_string()], formulas.first());
    line.extend(first.map(|formula| {
        let shapes: Vec<String> = formula.shapes().iter().map(|shape| shape.to_string()).collect();
        format!("Shape: {}.", shapes.join(", "))
    }));
    line.extend(kernel.map(|kernel| format!("Cost: {}.", kernel.cost())));
    line.extend(first.and_then(|formula| formula.source).map(|source| format!("Source: {source}.")));
    let equations = formulas.iter().map(|formula| format!("`{}`", formula.equation()));
    let text: Vec<String> = [line.join(" ")].into_iter().chain(equations).collect();
    lines(&text.join("\n"))
}
