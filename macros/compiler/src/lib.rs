//! The compiler of `clebsch`: an ordinary library on proc-macro2 that turns a declaration into an integrator.

pub mod diagnostic;
pub mod model;
pub mod parse;

use clebsch_symbolic::Graph;
use proc_macro2::TokenStream;

use crate::diagnostic::Diagnostics;

/// The integrator of the item that carries `#[derive(Clebsch)]`, or the errors of its declaration.
pub fn expand(item: TokenStream) -> TokenStream {
    compile(item).unwrap_or_else(|errors| errors.to_compile_errors())
}

fn compile(item: TokenStream) -> Result<TokenStream, Diagnostics> {
    let graph = Graph::new();
    let declaration = parse::parse(item)?;
    let _model = model::model(&graph, &declaration)?;
    Ok(TokenStream::new())
}
