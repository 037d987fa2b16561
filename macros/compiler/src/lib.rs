//! The compiler of `clebsch`: an ordinary library on proc-macro2 that turns a declaration into an integrator.
//!
//! ```text
//! tokens ─▶ Declaration ─▶ Model ─▶ Formulas ─▶ Program ─▶ Expansion
//!         parse          model    derive      lower      emit
//! ```
//!
//! Each stage is a function from one value to the next, each value prints, and each print is a snapshot test.

pub mod derive;
pub mod diagnostic;
pub mod emit;
pub mod lower;
pub mod model;
pub mod parse;

use proc_macro2::TokenStream;

pub use clebsch_symbolic::Graph;

use crate::diagnostic::Diagnostics;
use crate::lower::Program;

/// The integrator of the item that carries `#[derive(Clebsch)]`, or the errors of its declaration.
///
/// Beside errors stands an implementation with the declared types, as far as they can be read, so that nothing else is reported.
pub fn expand(item: TokenStream) -> TokenStream {
    let graph = Graph::new();
    match compile(&graph, item.clone()) {
        Ok(program) => emit::emit(&program),
        Err(errors) => {
            let declaration = parse::parse(item).ok();
            let outline = declaration.as_ref().and_then(|declaration| model::outline(&graph, declaration));
            let stub = declaration.zip(outline).map(|(declaration, outline)| emit::stub(&declaration, &outline));
            let errors = errors.to_compile_errors();
            quote::quote!(#errors #stub)
        }
    }
}

/// The first four stages.
///
/// # Errors
/// Everything that is wrong with the declaration, each error at its place.
pub fn compile(graph: &Graph, item: TokenStream) -> Result<Program<'_>, Diagnostics> {
    let declaration = parse::parse(item)?;
    let model = model::model(graph, &declaration)?;
    let formulas = derive::derive(model)?;
    lower::lower(formulas)
}
