//! The leaves of products: what a value gives for each, and the names that a pattern gives them.

use clebsch_symbolic::{Expr, Group, Shape};
use syn::Expr as Syntax;

use super::closures::tail;
use super::elaborate::{Context, shortened};
use super::value::Value;
use super::{Configuration, Factor, Layout, quaternion};
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::parse::{Pattern, spell};

/// What a leaf of a result has to be.
pub(super) struct Expected<'a> {
    pub name: &'a str,
    pub shape: Shape,
    pub is_quaternion: bool,
}

impl<'a> Expected<'a> {
    /// A leaf of the configuration.
    pub fn point(leaf: &'a Configuration) -> Expected<'a> {
        Expected { name: &leaf.name, shape: leaf.shape, is_quaternion: leaf.is_quaternion }
    }

    /// A factor of the group.
    pub fn element(factor: &'a Factor) -> Expected<'a> {
        let is_quaternion = factor.group == Group::UnitQuaternions;
        Expected { name: &factor.name, shape: factor.group.element_shape(), is_quaternion }
    }
}

/// The value of a closure, leaf by leaf, or an error that says what does not fit; `is` says what the value is.
pub(super) fn leaves<'g>(
    context: &mut Context<'_, 'g>,
    body: &Syntax,
    key: &str,
    value: &Value<'g>,
    structure: &Layout,
    expected: &[Expected],
    is: &str,
) -> Option<Vec<Expr<'g>>> {
    let mut leaves = Vec::new();
    let Err((found, needed)) = flatten(value, structure, expected, &mut leaves) else { return Some(leaves) };
    let message = format!("the {key} gives {found}, but it has to give {needed}");
    let text = shortened(&spell(body));
    let error = Diagnostic::new(tail(body).0, message).note(format!("`{text}` is {is}"));
    context.diagnostics.push(error);
    None
}

/// What an image under an action is.
pub(super) fn new_value_of(old: &str) -> String {
    format!("the new value of `{old}`, which has the shape of the old one")
}

/// Takes a value apart as a structure nests, or says what was found and what was expected.
fn flatten<'g>(
    value: &Value<'g>,
    structure: &Layout,
    expected: &[Expected],
    leaves: &mut Vec<Expr<'g>>,
) -> Result<(), (String, String)> {
    match (value, structure) {
        (Value::Matrix(expr), Layout::Leaf(leaf))
            if expr.shape() == expected[*leaf].shape && !expected[*leaf].is_quaternion =>
        {
            leaves.push(*expr);
            Ok(())
        }
        (Value::Quaternion(expr), Layout::Leaf(leaf)) if expected[*leaf].is_quaternion => {
            leaves.push(*expr);
            Ok(())
        }
        (Value::Identity(scale), Layout::Leaf(leaf)) if expected[*leaf].is_quaternion => {
            leaves.push(quaternion::real(scale.graph(), *scale));
            Ok(())
        }
        (Value::Identity(scale), Layout::Leaf(leaf)) if expected[*leaf].shape.is_square() => {
            leaves.push(*scale * scale.graph().identity(expected[*leaf].shape.rows));
            Ok(())
        }
        (Value::Tuple(values), Layout::Tuple(parts)) | (Value::Array(values), Layout::Array(parts))
            if values.len() == parts.len() =>
        {
            values.iter().zip(parts).try_for_each(|(value, part)| flatten(value, part, expected, leaves))
        }
        (value, Layout::Leaf(leaf)) => {
            let Expected { name, shape, is_quaternion } = &expected[*leaf];
            let wanted = if *is_quaternion { "a quaternion".to_string() } else { shape.to_string() };
            Err((value.describe(), format!("{wanted} for `{name}`")))
        }
        (value, Layout::Tuple(parts)) => Err((value.describe(), format!("a tuple of {}", parts.len()))),
        (value, Layout::Array(parts)) => Err((value.describe(), format!("an array of {}", parts.len()))),
    }
}

/// The name of each leaf: the pattern's names, with accessors where one name stands for several leaves.
pub(super) fn leaf_names(pattern: &Pattern, structure: &Layout, diagnostics: &mut Diagnostics) -> Option<Vec<String>> {
    match (pattern, structure) {
        (Pattern::Name(ident), _) => {
            let name = syn::ext::IdentExt::unraw(ident).to_string();
            Some(structure.accessors().into_iter().map(|accessor| format!("{name}{accessor}")).collect())
        }
        (Pattern::Tuple(patterns, _), Layout::Tuple(parts)) if patterns.len() == parts.len() => {
            let names: Option<Vec<Vec<String>>> =
                patterns.iter().zip(parts).map(|(pattern, part)| leaf_names(pattern, part, diagnostics)).collect();
            names.map(|names| names.into_iter().flatten().collect())
        }
        (Pattern::Tuple(patterns, place), structure) => {
            let is = match structure {
                Layout::Leaf(_) => "no tuple".to_string(),
                Layout::Tuple(parts) => format!("a tuple of {}", parts.len()),
                Layout::Array(parts) => format!("an array of {}", parts.len()),
            };
            let message = format!("`{}` has {} names, but its type is {is}", pattern.spell(), patterns.len());
            diagnostics
                .push(Diagnostic::new(*place, message).help("write one name, or as many as the tuple has parts"));
            None
        }
    }
}
