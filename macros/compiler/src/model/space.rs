//! Products of spaces: their leaves, the expressions of a value for each leaf, and the names that a pattern gives them.

use clebsch_symbolic::{Elements, Expr, Graph, Group, IntoList, Role, Shape};
use syn::ext::IdentExt;
use syn::{Expr as Syntax, Ident};

use super::spaces::{Product, SpaceType};
use super::value::Value;
use super::{Configuration, Layout, LeafSpace, quaternion};
use crate::diagnostic::{Diagnostics, error, refuse};
use crate::parse::{Pattern, joined, shortened, spell, tail};

/// A configuration or an input: its leaves, and how they nest.
#[derive(Clone)]
pub(super) struct Space<'g> {
    pub layout: Layout,
    pub leaves: Vec<Configuration<'g>>,
}

impl<'g> Space<'g> {
    /// The leaves that a pattern names, by their role; `None` where it does not fit the type, which was reported.
    pub fn new(
        graph: &'g Graph,
        pattern: &Pattern,
        product: Product<SpaceType>,
        role: impl Fn(usize) -> Role,
        diagnostics: &Diagnostics,
    ) -> Option<Space<'g>> {
        let layout = product.layout;
        let names = leaf_names(pattern, &layout, diagnostics)?.into_iter().zip(layout.accessors());
        let leaves = names.zip(&product.leaves).enumerate().map(|(i, ((name, accessor), (leaf, _)))| {
            let symbol = graph.symbol(&name, leaf.shape, role(i), leaf.property());
            let SpaceType { space, shape, is_quaternion, .. } = *leaf;
            Configuration { symbol, name, space, shape, is_quaternion, accessor }
        });
        Some(Space { leaves: leaves.into_list(), layout })
    }

    /// The space of a single point.
    pub fn point() -> Space<'g> {
        Space { layout: Layout::Tuple(Vec::new()), leaves: Vec::new() }
    }

    /// Its value in a closure.
    pub fn value(&self) -> Value<'g> {
        let values: Vec<_> = self.leaves.each(|leaf| Value::leaf(leaf.symbol, leaf.is_quaternion));
        Value::nested(&self.layout, &values)
    }

    /// The symbols of leaves that lie on a group.
    pub fn members(&self) -> impl Iterator<Item = (Expr<'g>, Group)> {
        self.leaves.iter().filter_map(|leaf| match leaf.space {
            LeafSpace::Group(group) => Some((leaf.symbol, group)),
            _ => None,
        })
    }

    /// The value of a closure, or of a part of its body, leaf by leaf. An error names the part that does not fit. `is`
    /// names the value.
    pub fn leaves_of(
        &self,
        (key, body): (&Ident, &Syntax),
        value: &Value<'g>,
        is: &str,
        diagnostics: &Diagnostics,
    ) -> Option<Vec<Expr<'g>>> {
        let leaf = |value: &Value<'g>, k: usize| {
            let Configuration { name, shape, is_quaternion, .. } = &self.leaves[k];
            match value {
                Value::Matrix(expr) if expr.shape() == *shape && !is_quaternion => Ok(*expr),
                Value::Quaternion(expr) if *is_quaternion => Ok(*expr),
                Value::Identity(scale) if *is_quaternion => Ok(quaternion::real(scale.graph(), *scale)),
                Value::Identity(scale) if shape.is_square() => Ok(*scale * scale.graph().identity(shape.rows)),
                _ if *is_quaternion => Err(format!("a quaternion for `{name}`")),
                _ => Err(format!("{shape} for `{name}`")),
            }
        };
        match value.leaves(&self.layout, &leaf) {
            Ok(leaves) => Some(leaves),
            Err((found, needed)) => {
                let error = error!(tail(body), "the {key} gives {found}, but it has to give {needed}";
                    note "`{}` is {is}", shortened(body));
                diagnostics
                    .refuse(error.maybe_help(self.in_another_order(value).or_else(|| self.column((key, body), value))))
            }
        }
    }

    /// The advice for a space of one column.
    fn column(&self, (key, body): (&Ident, &Syntax), value: &Value<'g>) -> Option<String> {
        let [leaf] = self.leaves.as_slice() else { return None };
        let is_meant = !leaf.is_quaternion && (key == "force_on" || matches!(value, Value::Array(_)));
        column(leaf.shape, body, value).filter(|_| is_meant)
    }

    /// The advice for a tuple that has all parts in another order.
    fn in_another_order(&self, value: &Value<'g>) -> Option<String> {
        let Value::Tuple(parts) = value else { return None };
        let mut given: Vec<String> = parts.each(Value::describe);
        let mut needed: Vec<String> = self.leaves.each(|leaf| Value::leaf(leaf.symbol, leaf.is_quaternion).describe());
        given.sort();
        needed.sort();
        let names = self.leaves.iter().map(|leaf| leaf.name.as_str());
        (given == needed).then(|| format!("write its parts in the order `({})`", joined(names)))
    }
}

/// The advice for an array or a scalar in place of a column.
pub(super) fn column(shape: Shape, body: &Syntax, value: &Value) -> Option<String> {
    if !shape.is_column() || shape.is_scalar() {
        return None;
    }
    match (value, tail(body)) {
        (Value::Array(parts), array @ Syntax::Array(_)) if parts.len() == shape.rows => {
            Some(format!("write `vector!{}`", spell(array)))
        }
        (Value::Matrix(expr), _) if expr.shape().is_scalar() => {
            Some(format!("multiply it by a direction, a vector of {} components", shape.rows))
        }
        _ => None,
    }
}

/// The words for an image under an action.
pub(super) fn new_value_of(old: &Pattern) -> String {
    format!("the new value of `{}`, which has the shape of the old one", old.spell())
}

/// The name of each leaf: the pattern's names, with accessors where one name stands for several leaves.
pub(super) fn leaf_names(pattern: &Pattern, layout: &Layout, diagnostics: &Diagnostics) -> Option<Vec<String>> {
    match (pattern, layout) {
        (Pattern::Name(ident), _) => {
            let name = ident.unraw();
            Some(layout.accessors().each(|accessor| format!("{name}{accessor}")))
        }
        (Pattern::Tuple(patterns, _), Layout::Tuple(parts)) if patterns.len() == parts.len() => {
            let names = patterns.iter().zip(parts).map(|(pattern, part)| leaf_names(pattern, part, diagnostics));
            Some(names.collect::<Option<Vec<_>>>()?.concat())
        }
        (Pattern::Tuple(patterns, place), layout) => {
            let (text, count, is) = (pattern.spell(), patterns.len(), layout.describe());
            refuse!(diagnostics, *place, "`{text}` has {count} names, but its type is {is}";
                help "write one name, or as many as the tuple has parts")
        }
    }
}
