//! The compiler of `clebsch`: an ordinary library on proc-macro2 that turns a declaration into an integrator.
//!
//! ```text
//! tokens ─▶ Declaration ─▶ Model ─▶ Formulas ─▶ Program ─▶ Expansion
//!         parse          model    derive      lower      emit
//! ```
//!
//! Each stage is a function from one value to the next, each value prints, and each print is a snapshot test.

mod budget;
pub mod derive;
pub mod diagnostic;
pub mod emit;
mod hints;
pub mod lower;
mod methods;
pub mod model;
pub mod parse;
mod reference;

use proc_macro2::TokenStream;

pub use budget::WORK;
pub use clebsch_symbolic::Graph;
use clebsch_symbolic::work::{self, Exhausted};

use crate::budget::{CompilerStage, Stage};
use crate::diagnostic::Diagnostics;
use crate::lower::Program;
pub use crate::methods::MethodProgram;
use crate::model::ByNumber;
use crate::parse::Declaration;
pub use crate::reference::{keys_for_editors, reference};

/// The integrator of the item that carries `#[derive(Clebsch)]`, or the errors of its declaration.
///
/// With the errors comes an implementation with the declared types, as far as they can be read, so that nothing else is
/// reported. There are no panics: one of ours is an error that asks for a report.
pub fn expand(item: TokenStream) -> TokenStream {
    let integrator = budget::without_panic(&item, || integrator(item.clone())).flatten().unwrap_or_else(|errors| {
        let errors = errors.to_compile_errors();
        let stub = budget::without_panic(&item, || stub(item.clone())).ok().flatten();
        quote::quote!(#errors #stub)
    });
    let hints = hints::hints(&item);
    quote::quote!(#integrator #hints)
}

/// All five stages.
fn integrator(item: TokenStream) -> Result<TokenStream, Diagnostics> {
    let (graph, declaration) = (Graph::new(), parse::parse(item)?);
    budget::within(&declaration, |stage| {
        let program = program(&graph, &declaration, stage)?;
        stage.set(CompilerStage::Emit);
        Ok(emit::emit(&program))
    })
}

/// The implementation that accompanies errors; `None` if the types cannot be read.
fn stub(item: TokenStream) -> Option<TokenStream> {
    let (graph, declaration) = (Graph::new(), parse::parse_with_errors(item)?);
    let outline = work::within(WORK, || model::outline(&graph, &declaration));
    Some(emit::stub(&declaration, &outline.ok()??))
}

/// The first four stages, which may panic where the compiler has a bug.
///
/// # Errors
/// Everything that is wrong with the declaration, each error at its place.
pub fn compile(graph: &Graph, item: TokenStream) -> Result<Program<'_>, Diagnostics> {
    let declaration = parse::parse(item)?;
    budget::within(&declaration, |stage| program(graph, &declaration, stage))
}

/// The program of a declaration with those of its methods, which have the same system and other dials.
fn program<'g>(graph: &'g Graph, declaration: &Declaration, stage: &Stage) -> Result<Program<'g>, Diagnostics> {
    let may_be_sites = declaration.methods.is_empty() && model::may_be_sites(declaration);
    let mut program = match program_of_steps(graph, declaration, may_be_sites, stage)? {
        Program::Mechanics(program) => program,
        // a configuration that inputs move has no methods
        steered => return Ok(steered),
    };
    let diagnostics = Diagnostics::new();
    let mut graph = graph;
    for method in &declaration.methods {
        // formulas are ordered by when they were made: each method has a graph of its own, and the code that it has alone
        let mut steps = |declaration: &Declaration| {
            graph = graph.another();
            program_of_steps(graph, declaration, false, stage)
        };
        let by_method = declaration.by(method);
        let found = match steps(&by_method) {
            Ok(found) if program.has_the_same_quantities(&found) => Ok(found),
            // not all steps have derivatives: a method may do without those that the declaration asks for
            _ if declaration.dials.emit.variations() => steps(&by_method.without_variations()),
            found => found,
        };
        match found.and_then(|steps| MethodProgram::new(&method.name, steps, &program)) {
            Ok(found) => program.methods.push(found),
            Err(errors) => diagnostics.extend(errors),
        }
    }
    diagnostics.propagate(Program::Mechanics(program))
}

/// The program of a declaration as its own dials step it. Where sites by a number have formulas of one site each, they are
/// those.
fn program_of_steps<'g>(
    graph: &'g Graph,
    declaration: &Declaration,
    may_be_sites: bool,
    stage: &Stage,
) -> Result<Program<'g>, Diagnostics> {
    let stages = |graph: &'g Graph, by_number: ByNumber| {
        stage.set(CompilerStage::Model);
        let model = model::model(graph, declaration, by_number)?;
        stage.set(CompilerStage::Derive);
        let formulas = derive::derive(model)?;
        stage.set(CompilerStage::Lower);
        lower::lower(formulas)
    };
    let both = || {
        if !may_be_sites {
            return stages(graph, ByNumber::Unrolled);
        }
        let by_sites = stages(graph, ByNumber::Sites);
        // the types of too many sites mean nothing unrolled
        if by_sites.is_ok() || model::outline(&Graph::new(), declaration).is_none() {
            return by_sites;
        }
        stages(graph.another(), ByNumber::Unrolled)
    };
    work::within(WORK, both).unwrap_or_else(|Exhausted| work::give_up())
}
