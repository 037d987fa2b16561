//! Doc comments of generated functions: title, formula, cost.

use proc_macro2::TokenStream;
use quote::quote;

use crate::derive::Formula;
use crate::lower::Kernel;

/// Doc attributes, one for each line; the space before each line keeps it off the slashes.
pub fn lines(lines: &[String]) -> TokenStream {
    let lines = lines.iter().map(|line| if line.is_empty() { String::new() } else { format!(" {line}") });
    quote!(#(#[doc = #lines])*)
}

/// A title with the shape, the cost of the kernel and the source of its formulas, and below these the formulas.
pub fn formulas(title: &str, formulas: &[Formula<'_>], kernel: Option<&Kernel>) -> TokenStream {
    let cost = kernel.map(|kernel| format!("Cost: {}.", kernel.cost()));
    let Some(first) = formulas.first() else {
        let line: Vec<String> = [Some(title.to_string()), cost].into_iter().flatten().collect();
        return lines(&[line.join(" ")]);
    };
    let shapes: Vec<String> = first.shapes().iter().map(|shape| shape.to_string()).collect();
    let shape = Some(format!("Shape: {}.", shapes.join(", ")));
    let source = first.source.map(|source| format!("Source: {source}."));
    let line: Vec<String> = [Some(title.to_string()), shape, cost, source].into_iter().flatten().collect();
    let equations = formulas.iter().map(|formula| format!("`{}`", formula.equation()));
    let text: Vec<String> = [line.join(" ")].into_iter().chain(equations).collect();
    lines(&text)
}
