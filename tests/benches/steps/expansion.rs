//! The cost of the expansion of each fixture: time of the compiler, size of its output, operations of a step.

use clebsch_compiler::lower::Cost;
use clebsch_compiler::{Graph, compile, emit, expand};
use proc_macro2::{TokenStream, TokenTree};
use quote::ToTokens;
use std::time::Instant;
use std::{fs, path::Path};

/// How often an expansion is timed.
const REPETITIONS: usize = 7;

/// The expansion of one struct.
pub struct Expansion {
    /// The struct.
    pub name: String,
    /// Median time from tokens to tokens, ms.
    pub milliseconds: f64,
    /// Tokens of the output, delimiters as two.
    pub tokens: usize,
    /// Lines of the output as text.
    pub lines: usize,
    /// Operations of one residual with its Jacobian, all equations.
    pub linearization: Cost,
    /// Operations of a step outside of linearisations.
    pub rest: Cost,
}

/// The expansions of all structs that are accepted.
pub fn all() -> Vec<Expansion> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/accept");
    let mut files: Vec<_> =
        fs::read_dir(folder).expect("the fixtures").map(|file| file.expect("a file").path()).collect();
    files.sort();
    files.iter().flat_map(|file| structs(&fs::read_to_string(file).expect("a readable file"))).map(expansion).collect()
}

fn structs(source: &str) -> Vec<syn::ItemStruct> {
    let items = syn::parse_file(source).expect("Rust source").items;
    let structs =
        items.into_iter().filter_map(|item| if let syn::Item::Struct(item) = item { Some(item) } else { None });
    let is_declared = |attribute: &syn::Attribute| attribute.path().is_ident("clebsch");
    structs.filter(|item| item.attrs.iter().any(is_declared)).collect()
}

fn expansion(item: syn::ItemStruct) -> Expansion {
    let (name, item) = (item.ident.to_string(), item.into_token_stream());
    let mut times: Vec<f64> = (0..REPETITIONS)
        .map(|_| {
            let (item, start) = (item.clone(), Instant::now());
            std::hint::black_box(expand(item));
            start.elapsed().as_secs_f64() * 1e3
        })
        .collect();
    times.sort_by(f64::total_cmp);
    let graph = Graph::new();
    let program = match compile(&graph, item.clone()) {
        Ok(program) => program,
        Err(errors) => panic!("{name} is refused: {errors}"),
    };
    let mut costs = (Cost::default(), Cost::default());
    // where a step moves by the chart coordinates alone, increments are made for others
    let steps =
        program.mechanics().is_none_or(|program| (0..program.steps.len()).all(|index| program.makes_increments(index)));
    for (kernel, cost) in program.kernels().into_iter().map(|(name, kernel)| (name, kernel.cost())) {
        let stem = kernel.trim_end_matches(|c: char| c.is_ascii_digit() || c == '_');
        // names that end in `_whole` serve the inverse Legendre transform of a composed step alone
        let stem = stem.trim_end_matches("_first").trim_end_matches("_adjoint");
        let stem = stem.trim_end_matches("_first").trim_end_matches("_adjoint");
        match stem {
            "linearize" => costs.0 = costs.0.plus(cost),
            "increment" if !steps => {}
            "start_kick" | "end_kick" | "prepare" | "predict" | "closed_form" | "increment" | "advance"
            | "displace" | "update" => {
                costs.1 = costs.1.plus(cost);
            }
            _ => {}
        }
    }
    Expansion {
        name,
        milliseconds: times[REPETITIONS / 2],
        tokens: count(expand(item)),
        lines: emit::generated(&program).lines().count(),
        linearization: costs.0,
        rest: costs.1,
    }
}

fn count(tokens: TokenStream) -> usize {
    let size = |token| match token {
        TokenTree::Group(group) => 2 + count(group.stream()),
        _ => 1,
    };
    tokens.into_iter().map(size).sum()
}

/// The table for a person.
pub fn print(expansions: &[Expansion]) {
    let profile = profile();
    println!("Expansion ({profile} build of the compiler) and operations: of a linearisation, of the rest of a step\n");
    println!("{:20} {:>8} {:>8} {:>7}   {:22} rest of a step", "struct", "ms", "tokens", "lines", "linearisation");
    for Expansion { name, milliseconds, tokens, lines, linearization, rest } in expansions {
        let linearization = linearization.to_string();
        println!("{name:20} {milliseconds:8.2} {tokens:8} {lines:7}   {linearization:22} {rest}");
    }
}

/// One JSON line for each struct.
pub fn print_json(expansions: &[Expansion]) {
    for Expansion { name, milliseconds, tokens, lines, linearization, rest } in expansions {
        let (profile, linearization, rest) = (profile(), linearization.total(), rest.total());
        println!(
            "{{\"expansion\":\"{name}\",\"profile\":\"{profile}\",\"ms\":{milliseconds:.4},\"tokens\":{tokens},\"lines\":{lines},\
             \"ops_linearize\":{linearization},\"ops_rest\":{rest}}}"
        );
    }
}

fn profile() -> &'static str {
    if cfg!(debug_assertions) { "debug" } else { "release" }
}
