//! Groups of the user's own: the Lie algebra of an equation in literals, or the group of a basis, with everything checked that can be.

mod basis;
mod equation;
mod exact;
mod follow;
mod kernel;
mod series;
#[cfg(test)]
mod tests;

use std::cell::Cell;

use clebsch_symbolic::{Graph, Group, Rational, Shape, Sparse, Zero};
use proc_macro2::{Ident, Span, TokenStream, TokenTree};
use quote::ToTokens;
use syn::ext::IdentExt;

use super::elaborate::{Context, Elaborator};
use super::fields::Fields;
use super::groups::is_built_in;
use super::scope::{Missing, Scope};
use super::vectors::named_shape;
use crate::diagnostic::{Diagnostic, Diagnostics, Location};
use crate::parse::{DeclaredGroup, Definition};

/// The largest matrices of a declared group, whose Lie algebra is found at compile time.
const LARGEST: usize = 10;

/// A declared group.
struct Known {
    name: Ident,
    group: Group,
    used: Cell<bool>,
}

/// The declared groups by name.
#[derive(Default)]
pub(super) struct DeclaredGroups {
    known: Vec<Known>,
}

impl DeclaredGroups {
    /// Reads all groups.
    pub fn read(graph: &Graph, groups: &[DeclaredGroup], diagnostics: &mut Diagnostics) -> DeclaredGroups {
        let mut known = Vec::new();
        for declared in groups {
            if let Some(error) = taken_name(&declared.name) {
                diagnostics.push(error);
                continue;
            }
            if let Some(group) = read(graph, declared, diagnostics) {
                known.push(Known { name: declared.name.clone(), group, used: Cell::new(false) });
            }
        }
        DeclaredGroups { known }
    }

    /// The group of a name.
    pub fn find(&self, name: &Ident) -> Option<Group> {
        let found = self.known.iter().find(|known| known.name.unraw() == name.unraw())?;
        found.used.set(true);
        Some(found.group)
    }

    /// All names.
    pub fn names(&self) -> impl Iterator<Item = String> {
        self.known.iter().map(|known| known.name.unraw().to_string())
    }

    /// Reports groups that no type names.
    pub fn check_used(&self, diagnostics: &mut Diagnostics) {
        for Known { name, .. } in self.known.iter().filter(|known| !known.used.get()) {
            diagnostics.push(
                Diagnostic::new(name.span(), format!("the group `{name}` is declared and not used"))
                    .help(format!("write `F: {name}` in the action, or remove the group")),
            );
        }
    }
}

/// A name that means something already.
fn taken_name(name: &Ident) -> Option<Diagnostic> {
    let text = name.unraw().to_string();
    let is_space =
        named_shape(&text).is_some() || ["SVector", "SMatrix", "Unit", "Quaternion"].contains(&text.as_str());
    let what = match (is_built_in(&text), is_space) {
        (true, _) => "group",
        (_, true) => "space",
        _ => return None,
    };
    let error = Diagnostic::new(name.span(), format!("`{text}` is a {what} that is built in"));
    Some(error.help(format!("choose another name, `My{text}`")))
}

fn read(graph: &Graph, declared: &DeclaredGroup, diagnostics: &mut Diagnostics) -> Option<Group> {
    let name = declared.name.unraw().to_string();
    let found = match &declared.definition {
        Definition::Equation(closure) => equation::read(graph, &name, closure),
        Definition::Basis(elements, place) => basis::read(graph, &name, elements, *place),
    };
    found.map_err(|errors| errors.into_iter().for_each(|error| diagnostics.push(error))).ok()
}

/// Elaborates literals: with the names that are given, and no others.
fn elaborate<'g, R>(
    graph: &'g Graph,
    key: &str,
    scope: Scope<'g>,
    work: impl FnOnce(&mut Elaborator<'_, '_, 'g>) -> Option<R>,
) -> Result<R, Vec<Diagnostic>> {
    let fields = Fields::none();
    let mut context =
        Context { graph, fields: &fields, constants: Vec::new(), power: None, diagnostics: Diagnostics::new() };
    let value = work(&mut Elaborator::new(&mut context, key, scope));
    let Context { constants, diagnostics, .. } = context;
    let mut errors = diagnostics.into_vec();
    errors.extend(constants.iter().map(|constant| {
        let text = crate::parse::spell_tokens(&constant.path);
        not_literal(Location::of(&constant.path), key, &format!("the constant `{text}`"))
    }));
    value.filter(|_| errors.is_empty()).ok_or(errors)
}

/// Fields of the struct, which no literal reads: where `self` stands.
fn fields_in(tokens: &impl ToTokens) -> Option<(Location, String)> {
    fn search(stream: TokenStream) -> Option<(Location, String)> {
        let tokens: Vec<TokenTree> = stream.into_iter().collect();
        tokens.iter().enumerate().find_map(|(position, token)| match token {
            TokenTree::Group(group) => search(group.stream()),
            TokenTree::Ident(ident) if ident == "self" => {
                let end = tokens.get(position + 2).unwrap_or(token);
                let field = tokens.get(position + 2).map(|field| format!("self.{field}"));
                Some((Location::between(ident.span(), end.span()), field.unwrap_or_else(|| "self".into())))
            }
            _ => None,
        })
    }
    search(tokens.to_token_stream())
}

/// The error for what is known at run time alone.
fn not_literal(place: Location, key: &str, what: &str) -> Diagnostic {
    Diagnostic::new(place, format!("the {key} cannot depend on {what}"))
        .help("write the numbers themselves")
        .note("its Lie algebra is derived at compile time, where the values of fields and constants are not known")
}

/// A scope with nothing in it, in which names of other closures have a reason to be missing.
fn empty_scope<'g>() -> Scope<'g> {
    let mut scope = Scope::default();
    for name in ["h", "t"] {
        let help = "a group is declared by numbers alone".to_string();
        scope.add_missing(name.into(), Missing::Foreign { help });
    }
    scope
}

/// The entries of a matrix that are not zero.
fn sparse(shape: Shape, entries: &[Rational]) -> Sparse {
    let placed = shape.positions().zip(entries).filter(|(_, value)| !value.is_zero());
    placed.map(|((i, j), value)| (i, j, value.clone())).collect()
}

/// A matrix of numbers, `[0, 1; 0, 0]`.
fn spell_matrix(shape: Shape, entries: &[Rational]) -> String {
    let rows: Vec<String> = entries
        .chunks(shape.columns)
        .map(|row| row.iter().map(Rational::to_string).collect::<Vec<_>>().join(", "))
        .collect();
    format!("[{}]", rows.join("; "))
}

/// The first bracket of two basis elements that has a property: which, and what it is.
fn bracket_with(
    graph: &Graph,
    shape: Shape,
    basis: &[Sparse],
    property: impl Fn(&[Rational]) -> bool,
) -> Option<(usize, usize, Vec<Rational>)> {
    let algebra = graph.algebra(shape, basis.to_vec());
    let pairs = (0..basis.len()).flat_map(|j| (0..j).map(move |i| (i, j)));
    let brackets = pairs.map(|(i, j)| (i, j, graph.bracket(algebra, i, j)));
    brackets.into_iter().find(|(_, _, bracket)| property(bracket))
}

/// The size of a declared group's matrices is within the limit.
fn check_size(name: &str, n: usize, span: Span) -> Result<(), Vec<Diagnostic>> {
    if n <= LARGEST {
        return Ok(());
    }
    let message = format!("the matrices of `{name}` are {n}x{n}, more than {LARGEST}x{LARGEST}");
    Err(vec![Diagnostic::new(span, message).note("the Lie algebra of a declared group is found at compile time")])
}
