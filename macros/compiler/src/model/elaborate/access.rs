//! Parts of values: `self.field`, `q.0`, `q[1]`, `x[(i, j)]`, `.x .y .z .w`.

use clebsch_symbolic::{Expr, Shape};
use quote::ToTokens;
use syn::{Expr as Syntax, ExprField, ExprIndex, Member};

use super::super::value::Value;
use super::operators::parenthesized;
use super::{Elaborator, Growth};
use crate::diagnostic::{Diagnostic, Location, nearest};
use crate::parse::spell;

/// Components by name.
const COMPONENTS: [(&str, usize); 4] = [("x", 0), ("y", 1), ("z", 2), ("w", 3)];

impl<'g> Elaborator<'_, '_, 'g> {
    /// `base.member`.
    pub(super) fn field(&mut self, field: &ExprField) -> Option<Value<'g>> {
        if is_self(&field.base) {
            return self.parameter(&field.member);
        }
        let base = self.elaborate(&field.base)?;
        match (&field.member, base) {
            (Member::Unnamed(index), Value::Tuple(parts)) => match parts.get(index.index as usize) {
                Some(part) => Some(part.clone()),
                None => {
                    let message =
                        format!("`{}` has {} parts and no `.{}`", spell(&field.base), parts.len(), index.index);
                    self.error(Diagnostic::new(index.span, message).note("parts are counted from 0"))
                }
            },
            (Member::Unnamed(index), other) => {
                let message =
                    format!("`{}` is {} and has no part `.{}`", spell(&field.base), other.describe(), index.index);
                let error = Diagnostic::new(index.span, message);
                let help = matches!(other, Value::Array(_))
                    .then(|| format!("write `{}[{}]`", parenthesized(&field.base), index.index));
                self.error(error.maybe_help(help))
            }
            (Member::Named(name), Value::Quaternion(q)) => self.coordinate(field, q, name),
            (Member::Named(name), base) => {
                let vector = self.as_matrix(&field.base, base)?;
                self.component(field, vector, name)
            }
        }
    }

    fn parameter(&mut self, member: &Member) -> Option<Value<'g>> {
        let (name, span) = match member {
            Member::Named(ident) => (syn::ext::IdentExt::unraw(ident).to_string(), ident.span()),
            Member::Unnamed(index) => (index.index.to_string(), index.span),
        };
        if let Some(value) = self.context.fields.value(&name) {
            return value.clone();
        }
        let names: Vec<&str> = self.context.fields.names().collect();
        let similar = nearest(&name, names.iter().copied())
            .map(|similar| format!("a field with a similar name exists: `{similar}`"));
        let error = Diagnostic::new(span, format!("cannot find `{name}` in the {}", self.key));
        let listed: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
        let error = match (similar, listed.is_empty()) {
            (Some(help), _) => error.help(help),
            (None, true) => error.note("the struct has no fields"),
            (None, false) => error.note(format!("the fields are {}", listed.join(", "))),
        };
        self.error(error)
    }

    fn component(&mut self, field: &ExprField, vector: Expr<'g>, name: &syn::Ident) -> Option<Value<'g>> {
        let base = spell(&field.base);
        let shape = vector.shape();
        let Some(&(_, index)) = COMPONENTS.iter().find(|(component, _)| name == component) else {
            let error = Diagnostic::new(name.span(), format!("`{base}` has no component `{name}`"));
            return self.error(
                error.note("components are `.x`, `.y`, `.z`, `.w`, `[i]` of a vector and `[(i, j)]` of a matrix"),
            );
        };
        if !shape.is_column() && shape.rows != 1 {
            let error =
                Diagnostic::new(name.span(), format!("`{base}` is {shape}: `.{name}` is a component of a vector"));
            return self
                .error(error.help(format!("write `{}[({index}, {index})]` for an entry", parenthesized(&field.base))));
        }
        if index >= shape.len() {
            let error = Diagnostic::new(name.span(), format!("`{base}` is {shape} and has no component `{name}`"));
            return self.error(error.note("components are `.x`, `.y`, `.z`, `.w` in this order"));
        }
        self.entry(field, vector, index)
    }

    /// The component of a row or a column.
    fn entry(&mut self, at: &dyn ToTokens, vector: Expr<'g>, index: usize) -> Option<Value<'g>> {
        let make = || if vector.shape().is_column() { vector.entry(index, 0) } else { vector.entry(0, index) };
        self.build(at, &[vector], Growth::Sum, make).map(Value::Matrix)
    }

    /// `base[index]`.
    pub(super) fn index(&mut self, index: &ExprIndex) -> Option<Value<'g>> {
        let base = self.elaborate(&index.expr)?;
        let at = index;
        match base {
            Value::PerSite(per_site) => self.site(index, per_site),
            Value::Array(parts) => {
                let position =
                    self.position(&index.index, parts.len(), &format!("the entries of `{}`", spell(&index.expr)))?;
                parts.get(position).cloned()
            }
            Value::Tuple(_) => {
                let error = Diagnostic::new(Location::of(&index.index), format!("`{}` is a tuple", spell(&index.expr)));
                self.error(error.help(format!("write `{}.0`", parenthesized(&index.expr))))
            }
            base => {
                let matrix = self.as_matrix(&index.expr, base)?;
                let Shape { rows, columns } = matrix.shape();
                let base = spell(&index.expr);
                match strip(&index.index) {
                    Syntax::Tuple(pair) if pair.elems.len() == 2 => {
                        let row = self.position(&pair.elems[0], rows, &format!("the rows of `{base}`"));
                        let column = self.position(&pair.elems[1], columns, &format!("the columns of `{base}`"));
                        let (row, column) = row.zip(column)?;
                        self.build(at, &[matrix], Growth::Sum, || matrix.entry(row, column)).map(Value::Matrix)
                    }
                    single if rows == 1 || columns == 1 => {
                        let position = self.position(single, rows * columns, &format!("the components of `{base}`"))?;
                        self.entry(at, matrix, position)
                    }
                    single => {
                        let error = Diagnostic::new(
                            Location::of(single),
                            format!("`{base}` is {rows}x{columns}: an entry has two indices"),
                        );
                        self.error(
                            error.help(format!("write `{}[(i, j)]`, counted from 0", parenthesized(&index.expr))),
                        )
                    }
                }
            }
        }
    }

    /// An index: a whole number below `length`, known here.
    pub(super) fn position(&mut self, syntax: &Syntax, length: usize, of: &str) -> Option<usize> {
        let value = self.matrix(syntax)?;
        let Some(number) = value.as_number().filter(|number| number.is_integer()) else {
            let error = Diagnostic::new(
                Location::of(syntax),
                format!("`{}` is no index: an index is a whole number known here", spell(syntax)),
            );
            return self.error(error.help("write a number, as in `[0]`"));
        };
        match number.parts().and_then(|(position, _)| usize::try_from(position).ok()) {
            Some(position) if position < length => Some(position),
            _ => {
                let error = Diagnostic::new(Location::of(syntax), format!("the index {number} is out of range"));
                self.error(error.note(format!("{of} are counted from 0 to {}", length - 1)))
            }
        }
    }
}

/// Whether an expression is `self`.
pub(super) fn is_self(syntax: &Syntax) -> bool {
    match syntax {
        Syntax::Path(path) => path.path.is_ident("self"),
        Syntax::Paren(inner) => is_self(&inner.expr),
        Syntax::Reference(inner) => is_self(&inner.expr),
        _ => false,
    }
}

/// An expression without parentheses and references around it.
pub(super) fn strip(syntax: &Syntax) -> &Syntax {
    match syntax {
        Syntax::Paren(inner) => strip(&inner.expr),
        Syntax::Group(inner) => strip(&inner.expr),
        Syntax::Reference(inner) => strip(&inner.expr),
        other => other,
    }
}
