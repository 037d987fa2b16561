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

/// A title, its formulas as a code block, their shape and source, and the cost of the kernel.
pub fn formulas(title: &str, formulas: &[Formula<'_>], kernel: Option<&Kernel>) -> TokenStream {
    let mut text = vec![title.to_string()];
    if !formulas.is_empty() {
        text.extend([String::new(), "```text".to_string()]);
        text.extend(formulas.iter().map(Formula::equation));
        text.push("```".to_string());
        let shapes: Vec<String> = formulas[0].shapes().iter().map(|shape| shape.to_string()).collect();
        text.extend([String::new(), format!("Shape: {}.", shapes.join(", "))]);
        if let Some(source) = formulas[0].source {
            text.extend([String::new(), format!("Source: {source}.")]);
        }
    }
    if let Some(kernel) = kernel {
        text.extend([String::new(), format!("Cost: {}.", kernel.cost())]);
    }
    lines(&text)
}
