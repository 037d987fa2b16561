//! Prints every stage of the structs in a file: `cargo run -p clebsch-compiler --example expand -- FILE [STAGE]`.

use clebsch_compiler::{Graph, compile, emit};
use quote::ToTokens;

fn main() {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().expect("a file with annotated structs");
    let stage = arguments.next().unwrap_or_else(|| "formulas".into());
    let source = std::fs::read_to_string(path).expect("a readable file");
    let file = syn::parse_file(&source).expect("Rust source");
    for item in file.items {
        let syn::Item::Struct(item) = item else { continue };
        let graph = Graph::new();
        match compile(&graph, item.to_token_stream()) {
            Err(errors) => println!("{errors}"),
            Ok(program) => match stage.as_str() {
                "formulas" => println!("{}", program.formulas),
                "model" => println!("{}", program.formulas.model),
                "program" => println!("{program}"),
                "derivation" => println!("{}", emit::derivation(&program)),
                _ => println!("{}", emit::generated(&program)),
            },
        }
    }
}
