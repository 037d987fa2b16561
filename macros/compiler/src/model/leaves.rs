//! The leaves of products: what a value gives for each, and the names that a pattern gives them.

use clebsch_symbolic::Expr;
use syn::{Expr as Syntax, Ident};

use super::closures::tail;
use super::elaborate::shortened;
use super::value::Value;
use super::{Configuration, Layout, quaternion};
use crate::diagnostic::{Diagnostics, refuse};
use crate::parse::{Pattern, spell};

/// The value of a closure, or of a part of its body, leaf by leaf; or an error that says what does not fit. `is` says what the value is.
pub(super) fn leaves<'g>(
    (key, body): (&Ident, &Syntax),
    value: &Value<'g>,
    structure: &Layout,
    expected: &[Configuration<'g>],
    is: &str,
    diagnostics: &Diagnostics,
) -> Option<Vec<Expr<'g>>> {
    let leaf = |value: &Value<'g>, k: usize| {
        let Configuration { name, shape, is_quaternion, .. } = &expected[k];
        match value {
            Value::Matrix(expr) if expr.shape() == *shape && !is_quaternion => Ok(*expr),
            Value::Quaternion(expr) if *is_quaternion => Ok(*expr),
            Value::Identity(scale) if *is_quaternion => Ok(quaternion::real(scale.graph(), *scale)),
            Value::Identity(scale) if shape.is_square() => Ok(*scale * scale.graph().identity(shape.rows)),
            _ if *is_quaternion => Err(format!("a quaternion for `{name}`")),
            _ => Err(format!("{shape} for `{name}`")),
        }
    };
    match value.leaves(structure, &leaf) {
        Ok(leaves) => Some(leaves),
        Err((found, needed)) => {
            refuse!(diagnostics, tail(body).0, "the {key} gives {found}, but it has to give {needed}";
            note "`{}` is {is}", shortened(&spell(body)))
        }
    }
}

/// What an image under an action is.
pub(super) fn new_value_of(old: &Pattern) -> String {
    format!("the new value of `{}`, which has the shape of the old one", old.spell())
}

/// The name of each leaf: the pattern's names, with accessors where one name stands for several leaves.
pub(super) fn leaf_names(pattern: &Pattern, structure: &Layout, diagnostics: &Diagnostics) -> Option<Vec<String>> {
    match (pattern, structure) {
        (Pattern::Name(ident), _) => {
            let name = syn::ext::IdentExt::unraw(ident).to_string();
            Some(structure.accessors().into_iter().map(|accessor| format!("{name}{accessor}")).collect())
        }
        (Pattern::Tuple(patterns, _), Layout::Tuple(parts)) if patterns.len() == parts.len() => {
            let parts = patterns.iter().zip(parts);
            let names = parts.map(|(pattern, part)| leaf_names(pattern, part, diagnostics));
            Some(names.collect::<Option<Vec<_>>>()?.concat())
        }
        (Pattern::Tuple(patterns, place), structure) => {
            let (text, count, is) = (pattern.spell(), patterns.len(), structure.describe());
            refuse!(diagnostics, *place, "`{text}` has {count} names, but its type is {is}";
                help "write one name, or as many as the tuple has parts")
        }
    }
}
