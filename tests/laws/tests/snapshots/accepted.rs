//! Every stage of every accepted fixture.

use std::fmt::Write;

use clebsch_compiler::lower::{MechanicsProgram, Program};
use clebsch_compiler::parse::Declaration;
use clebsch_compiler::{emit, parse};
use insta::assert_snapshot;

use crate::fixture::{Fixture, root, with_snapshots};

/// A longer snapshot helps nobody; a longer text is shown by its operation counts.
const MOST_LINES: usize = 150;

/// Whose formulas are shown in LaTeX too.
const IN_LATEX: [&str; 2] = ["heavy_top", "two_pendulums"];

/// The fixtures whose generated code is shown in full, for people to review: the shortest expansions, and one of each
/// kind that is written most.
const GENERATED: [&str; 6] =
    ["free_particle", "planar_pendulum", "heavy_top", "spherical_pendulum", "rigid_body4", "spin_chain"];

#[test]
fn every_stage_of_every_accepted_fixture() {
    Fixture::check_all("accept", |fixture| {
        let declaration = parse::parse(fixture.item()).unwrap_or_else(|errors| panic!("{}:\n{errors}", fixture.name));
        fixture.with_program(|program| fixture.snapshots("accept", || stages(&fixture.name, &declaration, program)));
    });
}

fn stages(name: &str, declaration: &Declaration, program: &Program<'_>) {
    let (model, formulas, latex) = match program {
        Program::Mechanics(program) => {
            let model = with_methods(program, |program| program.formulas.model.to_string());
            let table = program.formulas.table();
            (model, with_methods(program, |program| program.formulas.table().to_string()), table.latex())
        }
        Program::Steered(program) => {
            let table = program.formulas.table();
            (program.formulas.model.to_string(), table.to_string(), table.latex())
        }
    };
    assert_snapshot!(format!("{name}.1_declaration"), declaration);
    assert_snapshot!(format!("{name}.2_model"), model);
    assert_snapshot!(format!("{name}.3_formulas"), formulas);
    if IN_LATEX.contains(&name) {
        assert_snapshot!(format!("{name}.3_formulas_latex"), latex);
    }
    check_appendix(&emit::appendix(program));
    assert_snapshot!(format!("{name}.4_program"), code_or_counts(program));
    assert_snapshot!(format!("{name}.5_derivation"), emit::derivations(program));
    if GENERATED.contains(&name) {
        assert_snapshot!(format!("{name}.6_generated"), emit::generated(program));
    }
}

/// An appendix is ASCII, and each bracket and environment ends. `.ci/latex` compiles them.
fn check_appendix(appendix: &str) {
    let other = appendix.lines().find(|line| !line.is_ascii());
    assert_eq!(other, None, "a character that pdflatex does not read");
    let plain = appendix.replace("\\{", "").replace("\\}", "");
    let count = |part: &str| plain.matches(part).count();
    let pairs = [("{", "}"), ("\\left", "\\right"), ("\\begin{", "\\end{")];
    for (open, close) in pairs {
        let others = if open == "\\left" { count("\\leftarrow") } else { 0 };
        assert_eq!(count(open) - others, count(close), "{open} and {close}");
    }
    assert_eq!(plain.replace("\\$", "").matches('$').count() % 2, 0, "$");
}

/// A stage with the same of each method behind it.
fn with_methods(program: &MechanicsProgram<'_>, print: impl Fn(&MechanicsProgram<'_>) -> String) -> String {
    let methods = program.methods.iter();
    let methods = methods.map(|method| format!("\nmethod {}\n{}", method.name, print(&method.program)));
    methods.fold(print(program), |text, method| text + &method)
}

/// The code of all kernels, or their operation counts where that is long.
fn code_or_counts(program: &Program<'_>) -> String {
    let code = program.to_string();
    let lines = code.lines().count();
    if lines <= MOST_LINES {
        return code;
    }
    let mut text = format!("{lines} lines\n");
    for (name, kernel) in program.kernels() {
        // by construction: writing to a string does not fail
        let _ = writeln!(text, "{name}: {}", kernel.cost());
    }
    text
}

#[test]
fn no_snapshot_is_left_over() {
    for folder in ["accept", "reject"] {
        let names: Vec<String> = Fixture::all(folder).into_iter().map(|fixture| fixture.name).collect();
        let left_over: Vec<_> = with_snapshots(folder).into_iter().filter(|name| !names.contains(name)).collect();
        assert!(left_over.is_empty(), "delete the snapshots of {folder} whose fixtures are gone: {left_over:?}");
    }
}

#[test]
fn every_accepted_fixture_is_compiled() {
    let library = std::fs::read_to_string(root().join("src/lib.rs")).expect("the library of the fixtures");
    let words: Vec<&str> = library.split_whitespace().collect();
    let missing: Vec<_> = Fixture::all("accept").into_iter().map(|fixture| fixture.name).collect();
    let missing: Vec<_> = missing.iter().filter(|name| !words.contains(&name.as_str())).collect();
    assert!(missing.is_empty(), "add {missing:?} to the list of fixtures in tests/src/lib.rs");
}
