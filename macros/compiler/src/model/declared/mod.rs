//! Groups of the user's own: the Lie algebra of an equation in literals, or the group of a basis, with everything checked that can be.

mod basis;
mod equation;
mod follow;
mod numbers;
#[cfg(test)]
mod tests;

use clebsch_symbolic::{Graph, IntoList, Rational, Shape, Sparse, integer};
use proc_macro2::{Ident, Span, TokenStream, TokenTree};
use syn::Generics;
use syn::ext::IdentExt;

use super::Constant;
use super::elaborate::{Context, Elaborator};
use super::fields::Fields;
use super::groups::{DeclaredGroups, is_built_in};
use super::scope::Scope;
use super::shapes::named_shape;
use crate::diagnostic::{Diagnostic, Diagnostics, Location, bail, error};
use crate::parse::{DeclaredGroup, Definition, joined, spell_tokens};

/// The largest matrices of a declared group, whose Lie algebra is found at compile time.
const LARGEST: usize = 10;

/// The groups of a declaration.
pub(super) fn read_all(graph: &Graph, groups: &[DeclaredGroup], diagnostics: &Diagnostics) -> DeclaredGroups {
    let mut known = DeclaredGroups::default();
    for declared in groups {
        let name = declared.name.unraw().to_string();
        let group = check_name(&declared.name).and_then(|()| match &declared.definition {
            Definition::Equation(closure) => equation::read(graph, &name, closure),
            Definition::Basis(elements, place) => basis::read(graph, &name, elements, *place),
        });
        if let Some(group) = diagnostics.take(group) {
            known.add(declared.name.clone(), group);
        }
    }
    known
}

/// Refuses a name that means something already.
fn check_name(name: &Ident) -> Result<(), Diagnostics> {
    let text = name.unraw().to_string();
    let is_group = is_built_in(&text);
    if is_group || named_shape(&text).is_some() || ["SVector", "SMatrix", "Unit", "Quaternion"].contains(&&*text) {
        let what = if is_group { "group" } else { "space" };
        bail!(name, "`{text}` is a {what} that is built in"; help "choose another name, `My{text}`");
    }
    Ok(())
}

/// Elaborates literals: with the names that are given, and no others.
fn elaborate<'g, R>(
    graph: &'g Graph,
    key: &str,
    scope: Scope<'g>,
    work: impl FnOnce(&mut Elaborator<'_, '_, 'g>) -> Option<R>,
) -> Result<R, Diagnostics> {
    let (fields, diagnostics) = (Fields::none(), Diagnostics::new());
    let generics = Generics::default();
    let mut context = Context::new(graph, &fields, &generics, None, &diagnostics);
    let value = work(&mut Elaborator::new(&mut context, key, scope));
    for Constant { path, .. } in &context.constants {
        diagnostics.push(not_literal(path.into(), key, &format!("the constant `{}`", spell_tokens(path))));
    }
    diagnostics.propagate(())?;
    // by construction: a closure without a value has an error
    value.ok_or_else(Diagnostics::new)
}

/// Refuses fields of the struct, which no literal reads: where `self` stands.
fn check_literal(key: &str, stream: TokenStream) -> Result<(), Diagnostics> {
    let tokens: Vec<TokenTree> = stream.into_iter().into_list();
    for (position, token) in tokens.iter().enumerate() {
        match token {
            TokenTree::Group(group) => check_literal(key, group.stream())?,
            TokenTree::Ident(this) if this == "self" => {
                let field = tokens.get(position + 2);
                let text = field.map_or_else(|| "`self`".into(), |field| format!("`self.{field}`"));
                let place = Location { start: this.span(), end: field.unwrap_or(token).span() };
                return Err(not_literal(place, key, &text).into());
            }
            _ => {}
        }
    }
    Ok(())
}

/// The error for values that are known only at run time.
fn not_literal(place: Location, key: &str, what: &str) -> Diagnostic {
    error!(place, "the {key} cannot depend on {what}";
        help "write the numbers themselves";
        note "its Lie algebra is derived at compile time, where the values of fields and constants are not known")
}

/// A scope with nothing in it, in which names of other closures have a reason to be missing.
fn empty_scope<'g>() -> Scope<'g> {
    let mut scope = Scope::default();
    let help = "a group is declared by numbers alone";
    scope.missing = ["h", "t"].map(|name| (name.to_string(), help.to_string())).into();
    scope
}

/// The entries of a matrix that are not zero.
fn sparse(shape: Shape, entries: &[Rational]) -> Sparse {
    let placed = shape.positions().zip(entries).filter(|(_, value)| !value.is_zero());
    placed.map(|((i, j), value)| (i, j, value.clone())).into_list()
}

/// All entries of a sum of multiples of sparse matrices, row by row.
fn dense(shape: Shape, sum: &[(i64, &Sparse)]) -> Vec<Rational> {
    let mut entries = vec![Rational::zero(); shape.len()];
    for (scale, element) in sum {
        let scaled = element.iter().map(|(i, j, value)| (i * shape.columns + j, value * &integer(*scale)));
        scaled.for_each(|(entry, value)| entries[entry] += value);
    }
    entries
}

/// A matrix of numbers, `[0, 1; 0, 0]`.
fn spell_matrix(shape: Shape, entries: &[Rational]) -> String {
    let rows: Vec<String> = entries.chunks(shape.columns).map(joined).into_list();
    format!("[{}]", rows.join("; "))
}

/// The first bracket of two elements of a basis that lies outside of their span: the elements and the bracket.
fn open_bracket(graph: &Graph, shape: Shape, basis: &[Sparse]) -> Option<(usize, usize, Vec<Rational>)> {
    let algebra = graph.algebra(shape, basis.to_vec());
    let span = graph.span(algebra);
    let pairs = (0..basis.len()).flat_map(|j| (0..j).map(move |i| (i, j)));
    let mut brackets = pairs.map(|(i, j)| (i, j, graph.bracket(algebra, i, j)));
    brackets.find(|(_, _, bracket)| !span.holds(bracket))
}

/// The size of a declared group's matrices is within the limit.
fn check_size(name: &str, n: usize, span: Span) -> Result<(), Diagnostics> {
    if n <= LARGEST {
        return Ok(());
    }
    bail!(span, "the matrices of `{name}` are {n}x{n}, more than {LARGEST}x{LARGEST}";
        note "the Lie algebra of a declared group is found at compile time")
}
