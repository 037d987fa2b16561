//! The documentation of generated code shows the formulas that are computed: each formula as the table has it, by its
//! id. One fixture in three is read, and all of them where `CLEBSCH_FUZZ` is set.

use std::path::Path;

use clebsch_compiler::derive::{Formula, FormulaTable, Id};
use clebsch_compiler::lower::{MechanicsProgram, Program};
use clebsch_compiler::{Graph, compile, emit};
use quote::ToTokens;
use syn::{Attribute, Expr, ImplItem, Item, ItemImpl, Lit, Meta, PathArguments, Stmt, Type};

/// A method or type of generated code with its documentation.
struct Documented {
    /// Its name.
    name: String,
    /// The substep and the equation that it belongs to; `None` for those of the system.
    place: Option<(usize, Option<usize>)>,
    lines: Vec<String>,
}

impl Documented {
    /// The equations that it shows.
    fn equations(&self) -> Vec<&str> {
        self.lines.iter().filter_map(|line| line.strip_prefix('`')?.strip_suffix('`')).collect()
    }

    /// The source that it names.
    fn source(&self) -> Option<&str> {
        self.lines.iter().find_map(|line| line.find("Source: ").map(|start| &line[start..]))
    }

    fn shows(&self, row: &Formula<'_>) -> bool {
        let substep = row.id.substep();
        // these are told apart by more than the names of their functions
        let is_named = match row.id {
            Id::Displacement => self.name == "displace",
            Id::ScaledAdvance => self.name == "scaled_advance",
            Id::Lagrangian => self.name == "velocity",
            Id::Equation(..) if self.name == "Equation" => true,
            id => emit::shown_by(id).contains(&self.name.as_str()),
        };
        is_named
            && (substep.is_none() || substep == self.place.map(|(index, _)| index))
            && row.id.equation() == self.place.and_then(|(_, number)| number)
    }
}

/// The substep that a suffix stands for.
fn substep(program: Option<&MechanicsProgram<'_>>, suffix: &str) -> usize {
    match suffix {
        "_whole" | "Whole" => program.map_or(0, |program| program.formulas.stepped),
        "_adjoint" | "Adjoint" => 1,
        _ => 0,
    }
}

/// The substep of an implementation of `Substep<K>`.
fn of_trait(item: &ItemImpl) -> Option<(usize, Option<usize>)> {
    let last = item.trait_.as_ref()?.0.segments.last()?;
    let PathArguments::AngleBracketed(arguments) = &last.arguments else { return None };
    let first = arguments.args.first().filter(|_| last.ident == "Substep")?;
    Some((first.to_token_stream().to_string().parse().ok()?, None))
}

/// The name of the move of a step that takes the coordinates, or an increment up to a factor, and not the increment.
fn name_of_move(program: Option<&MechanicsProgram<'_>>, item: &ItemImpl, method: &str) -> Option<&'static str> {
    let of = item.trait_.as_ref().and_then(|(path, _)| path.segments.last());
    let program = program.filter(|_| method == "advance" && of.is_some_and(|of| of.ident == "Parts"))?;
    let moves = [(Id::Displacement, "displace"), (Id::ScaledAdvance, "scaled_advance")];
    moves.into_iter().find(|(id, _)| program.find(*id).is_some()).map(|(_, name)| name)
}

/// The place of the type of a momentum equation, `EquationFirst1`.
fn of_equation(program: Option<&MechanicsProgram<'_>>, name: &str) -> Option<(usize, Option<usize>)> {
    let suffix = name.strip_prefix("Equation")?.trim_end_matches(|c: char| c.is_ascii_digit());
    let number: usize = name.trim_start_matches(|c: char| !c.is_ascii_digit()).parse().ok()?;
    Some((substep(program, suffix), Some(number - 1)))
}

fn documentation(attributes: &[Attribute]) -> Vec<String> {
    let line = |attribute: &Attribute| match &attribute.meta {
        Meta::NameValue(pair) if pair.path.is_ident("doc") => match &pair.value {
            Expr::Lit(literal) => match &literal.lit {
                Lit::Str(text) => Some(text.value().trim().to_string()),
                _ => None,
            },
            _ => None,
        },
        _ => None,
    };
    attributes.iter().filter_map(line).collect()
}

/// The items of the generated code of a program.
fn items(program: &Program<'_>) -> Vec<Item> {
    syn::parse_file(&emit::generated(program)).expect("generated Rust").items
}

/// The items of the block of each method.
fn items_of_methods(items: &[Item]) -> Vec<Vec<Item>> {
    let block = |item: &Item| match item {
        Item::Const(block) => match &*block.expr {
            Expr::Block(block) => {
                Some(&block.block.stmts).map(|statements| statements.iter().filter_map(item_of).collect())
            }
            _ => None,
        },
        _ => None,
    };
    items.iter().filter_map(block).collect()
}

fn item_of(statement: &Stmt) -> Option<Item> {
    if let Stmt::Item(item) = statement { Some(item.clone()) } else { None }
}

/// All methods and types among the items of a program.
fn documented(program: Option<&MechanicsProgram<'_>>, items: Vec<Item>) -> Vec<Documented> {
    let power = program.and_then(|program| program.formulas.model.power.as_ref());
    let is_power = |owner: &str| power.is_some_and(|power| power.item.ident == owner);
    let mut all = Vec::new();
    for item in items {
        match item {
            Item::Struct(item) => {
                let place = of_equation(program, &item.ident.to_string());
                let name = if place.is_some() { "Equation".to_string() } else { item.ident.to_string() };
                all.push(Documented { name, place, lines: documentation(&item.attrs) });
            }
            Item::Impl(item) => {
                let Type::Path(path) = &*item.self_ty else { continue };
                let owner = path.path.segments.last().expect("a path").ident.to_string();
                for method in &item.items {
                    let ImplItem::Fn(method) = method else { continue };
                    let mut name = method.sig.ident.to_string();
                    let place = of_equation(program, &owner).or_else(|| of_trait(&item));
                    if let Some(of_move) = name_of_move(program, &item, &name) {
                        name = of_move.to_string();
                    }
                    if owner == "Velocity" {
                        name = "velocity".to_string();
                    }
                    let shown = Documented { name, place, lines: documentation(&method.attrs) };
                    // a power passes questions on to its sites
                    if !is_power(&owner) || !shown.equations().is_empty() {
                        all.push(shown);
                    }
                }
            }
            _ => {}
        }
    }
    all
}

/// Formulas that the documentation of a program shows and the table does not have, or the other way round.
fn differences(table: &FormulaTable<'_>, program: Option<&MechanicsProgram<'_>>, items: Vec<Item>) -> Vec<String> {
    let mut found = Vec::new();
    for item in documented(program, items) {
        let rows: Vec<_> = table.rows().iter().filter(|row| item.shows(row)).collect();
        let expected: Vec<String> = rows.iter().map(|row| row.equation()).collect();
        let source = rows.first().and_then(|row| row.source).map(|source| format!("Source: {source}."));
        if item.equations() != expected || item.source() != source.as_deref() {
            let (name, place, shown) = (&item.name, item.place, item.equations());
            found.push(format!("`{name}` {place:?} shows {shown:?} and not {expected:?}"));
        }
    }
    found
}

/// Half of the fixtures.
#[test]
fn methods_show_the_formulas_that_they_compute() {
    check(0);
}

/// The other half.
#[test]
fn methods_show_the_formulas_that_they_compute_too() {
    check(1);
}

fn check(remainder: usize) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/fixtures/accept");
    let (mut count, mut different) = (0, Vec::new());
    let files = std::fs::read_dir(folder).expect("a folder of fixtures");
    let mut files: Vec<_> = files.map(|entry| entry.expect("a file").path()).collect();
    files.sort();
    let step = if std::env::var_os("CLEBSCH_FUZZ").is_some() { 1 } else { 3 };
    for path in files.into_iter().step_by(step).skip(remainder).step_by(2) {
        let source = std::fs::read_to_string(&path).expect("a readable fixture");
        let file = syn::parse_file(&source).expect("Rust source");
        for item in file.items {
            let Item::Struct(item) = item else { continue };
            if !item.attrs.iter().any(|attribute| attribute.path().is_ident("clebsch")) {
                continue;
            }
            let graph = Graph::new();
            let program = compile(&graph, item.to_token_stream()).unwrap_or_else(|errors| panic!("{errors}"));
            let items = items(&program);
            let blocks = items_of_methods(&items);
            let found = match &program {
                Program::Mechanics(program) => {
                    assert_eq!(blocks.len(), program.methods.len(), "{}", path.display());
                    let of = |program: &MechanicsProgram<'_>, items| {
                        differences(program.formulas.table(), Some(program), items)
                    };
                    let methods = program.methods.iter().zip(blocks);
                    let of_methods = methods.flat_map(|(method, items)| of(&method.program, items));
                    of_methods.chain(of(program, items)).collect::<Vec<String>>()
                }
                Program::Steered(program) => differences(program.formulas.table(), None, items),
            };
            different.extend(found.into_iter().map(|difference| format!("{}: {difference}", path.display())));
            count += 1;
        }
    }
    assert!(different.is_empty(), "{}", different.join("\n"));
    assert!(count >= 10, "only {count} fixtures");
}
