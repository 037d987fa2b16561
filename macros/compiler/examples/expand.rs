//! Prints every stage of the structs in a file: `cargo run -p clebsch-compiler --example expand -- FILE [STAGE]`.

use clebsch_compiler::diagnostic::Diagnostics;
use clebsch_compiler::model::{ByNumber, Model};
use clebsch_compiler::{Graph, compile, derive, emit, model, parse};
use proc_macro2::TokenStream;
use quote::ToTokens;

fn main() {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().expect("a file with annotated structs");
    let stage = arguments.next().unwrap_or_else(|| "formulas".into());
    let source = std::fs::read_to_string(path).expect("a readable file");
    let file = syn::parse_file(&source).expect("Rust source");
    if stage == "latex" {
        println!("% an appendix: \\usepackage{{amsmath, amssymb}}\n");
    }
    for item in file.items {
        let syn::Item::Struct(item) = item else { continue };
        if !item.attrs.iter().any(|attribute| attribute.path().is_ident("clebsch")) {
            continue;
        }
        if let Err(errors) = show(&stage, item.to_token_stream()) {
            println!("{errors}");
        }
    }
}

/// The model, by sites where that is possible.
fn model(graph: &Graph, item: TokenStream) -> Result<Model<'_>, Diagnostics> {
    let declaration = parse::parse(item)?;
    let by = |by_number| model::model(graph, &declaration, by_number);
    let by_sites = model::may_be_sites(&declaration).then(|| by(ByNumber::Sites));
    by_sites.and_then(Result::ok).map_or_else(|| by(ByNumber::Unrolled), Ok)
}

/// Prints one stage, and runs none behind it.
fn show(stage: &str, item: TokenStream) -> Result<(), Diagnostics> {
    let graph = Graph::new();
    match stage {
        "declaration" => println!("{}", parse::parse(item)?),
        "model" => println!("{}", model(&graph, item)?),
        "formulas" => println!("{}", derive::derive(model(&graph, item)?)?),
        "latex" => println!("{}", emit::appendix(&compile(&graph, item)?)),
        "program" => println!("{}", compile(&graph, item)?),
        "derivation" => println!("{}", emit::derivations(&compile(&graph, item)?)),
        _ => println!("{}", emit::generated(&compile(&graph, item)?)),
    }
    Ok(())
}
