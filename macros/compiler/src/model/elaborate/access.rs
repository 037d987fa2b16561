//! Parts of values: `self.field`, `q.0`, `q[1]`, `x[(i, j)]`, `.x .y .z .w`.

use clebsch_symbolic::{Expr, Group, IntoList, Rational, Shape};
use quote::ToTokens;
use syn::{Expr as Syntax, ExprField, ExprIndex, Index, Member};

use super::{Elaborator, Growth, Value};
use crate::diagnostic::{error, nearest, refuse};
use crate::parse::{listed, member_name, parenthesized, spell};

const COMPONENTS: [&str; 4] = ["x", "y", "z", "w"];

impl<'g> Elaborator<'_, '_, 'g> {
    /// `base.member`.
    pub(super) fn field(&mut self, field: &ExprField) -> Option<Value<'g>> {
        if is_self(&field.base) {
            return self.parameter(&field.member);
        }
        match (&field.member, self.elaborate(&field.base)?) {
            (Member::Unnamed(Index { index, span }), Value::Tuple(parts)) => match parts.get(*index as usize) {
                Some(part) => Some(part.clone()),
                None => refuse!(self, *span, "`{}` has {} parts and no `.{index}`", spell(&field.base), parts.len();
                    note "parts are counted from 0"),
            },
            (Member::Unnamed(Index { index, span }), other) => {
                let (base, is) = (spell(&field.base), other.describe());
                let error = error!(*span, "`{base}` is {is} and has no part `.{index}`");
                self.refuse(error.help(instead_of_part(&parenthesized(&field.base), *index as usize, &other)))
            }
            (Member::Named(name), Value::Quaternion(q)) => self.coordinate(field, q, name),
            (Member::Named(name), base) => {
                let vector = self.as_matrix(&field.base, base)?;
                self.component(field, vector, name)
            }
        }
    }

    fn parameter(&mut self, member: &Member) -> Option<Value<'g>> {
        let name = member_name(member);
        if let Some(value) = self.context.fields.value(&name) {
            return value.clone();
        }
        let names: Vec<&str> = self.context.fields.names().into_list();
        let error = error!(member, "cannot find `{name}` in the {}", self.key);
        self.refuse(match nearest(&name, names.iter().copied()) {
            Some(similar) => error.help(format!("a field with a similar name exists: `{similar}`")),
            None if names.is_empty() => error.note("the struct has no fields"),
            None => error.note(format!("the fields are {}", listed(names))),
        })
    }

    fn component(&mut self, field: &ExprField, vector: Expr<'g>, name: &syn::Ident) -> Option<Value<'g>> {
        let base = spell(&field.base);
        let shape = vector.shape();
        let Some(index) = COMPONENTS.iter().position(|component| name == component) else {
            let error = error!(name, "`{base}` has no component `{name}`");
            let help = entry_named(field, shape, &name.to_string()).or_else(|| self.parts_of_velocity(&base, vector));
            return self.refuse(
                error
                    .maybe_help(help)
                    .note("components are `.x`, `.y`, `.z`, `.w`, `[i]` of a vector and `[(i, j)]` of a matrix"),
            );
        };
        if !shape.is_column() && shape.rows != 1 {
            refuse!(self, name, "`{base}` is {shape}: `.{name}` is a component of a vector";
                help "write `{}[({index}, {index})]` for an entry", parenthesized(&field.base));
        }
        if index >= shape.len() {
            refuse!(self, name, "`{base}` is {shape} and has no component `{name}`";
                note "components are `.x`, `.y`, `.z`, `.w` in this order");
        }
        self.entry(field, vector, index)
    }

    /// The advice for a part of a velocity of SE(n) that has a name elsewhere, `xi.omega`.
    fn parts_of_velocity(&self, base: &str, vector: Expr<'g>) -> Option<String> {
        let (_, group) = self.scope.velocities.iter().find(|(velocity, _)| *velocity == vector)?;
        let &Group::SpecialEuclidean(n) = group else { return None };
        let turns = n * (n - 1) / 2;
        Some(format!(
            "write `{base}.fixed_rows::<{turns}>(0)` for the rotation, `{base}.fixed_rows::<{n}>({turns})` for the translation"
        ))
    }

    /// The component of a row or a column.
    fn entry(&mut self, at: &dyn ToTokens, vector: Expr<'g>, index: usize) -> Option<Value<'g>> {
        let make = || if vector.shape().is_column() { vector.entry(index, 0) } else { vector.entry(0, index) };
        self.build(at, &[vector], Growth::Sum, make)
    }

    /// `base[index]`.
    pub(super) fn index(&mut self, index: &ExprIndex) -> Option<Value<'g>> {
        let base = self.elaborate(&index.expr)?;
        let text = spell(&index.expr);
        match base {
            Value::PerSite(of, own) => self.site(index, of, *own),
            Value::Array(parts) => {
                let position = self.position(&index.index, parts.len(), &format!("the entries of `{text}`"))?;
                parts.get(position).cloned()
            }
            Value::Tuple(_) => refuse!(self, &index.index, "`{text}` is a tuple";
                help "write `{}.0`", parenthesized(&index.expr)),
            base => {
                let matrix = self.as_matrix(&index.expr, base)?;
                let Shape { rows, columns } = matrix.shape();
                match strip(&index.index) {
                    Syntax::Tuple(pair) if pair.elems.len() == 2 => {
                        let row = self.position(&pair.elems[0], rows, &format!("the rows of `{text}`"));
                        let column = self.position(&pair.elems[1], columns, &format!("the columns of `{text}`"));
                        let (row, column) = row.zip(column)?;
                        self.build(index, &[matrix], Growth::Sum, || matrix.entry(row, column))
                    }
                    single if rows == 1 || columns == 1 => {
                        let position = self.position(single, rows * columns, &format!("the components of `{text}`"))?;
                        self.entry(index, matrix, position)
                    }
                    single => refuse!(self, single, "`{text}` is {rows}x{columns}: an entry has two indices";
                        help "write `{}[(i, j)]`, counted from 0", parenthesized(&index.expr)),
                }
            }
        }
    }

    /// An index: a whole number below `length`, known here.
    pub(super) fn position(&mut self, syntax: &Syntax, length: usize, of: &str) -> Option<usize> {
        let Some(number) = self.matrix(syntax)?.as_number().filter(Rational::is_integer) else {
            refuse!(self, syntax, "`{}` is no index: an index is a whole number known here", spell(syntax);
                help "write a number, as in `[0]`");
        };
        match number.parts().and_then(|(position, _)| usize::try_from(position).ok()) {
            Some(position) if position < length => Some(position),
            _ => refuse!(self, syntax, "the index {number} is out of range";
                note "{of} are counted from 0 to {}", length - 1),
        }
    }
}

/// The entry that nalgebra names `m33`, counted from 0.
fn entry_named(field: &ExprField, shape: Shape, name: &str) -> Option<String> {
    let digits: Vec<usize> = name
        .strip_prefix('m')?
        .chars()
        .map(|digit| digit.to_digit(10).map(|digit| digit as usize))
        .collect::<Option<_>>()?;
    let &[row, column] = digits.as_slice() else { return None };
    let is_entry = (1..=shape.rows).contains(&row) && (1..=shape.columns).contains(&column);
    is_entry.then(|| format!("write `{}[({}, {})]`, counted from 0", parenthesized(&field.base), row - 1, column - 1))
}

/// The replacement of `base.index`, if the base has that entry.
fn instead_of_part(base: &str, index: usize, value: &Value) -> String {
    match value {
        Value::Array(_) => format!("write `{base}[{index}]`"),
        Value::Matrix(expr) if expr.shape().is_column() && !expr.shape().is_scalar() => {
            let component = COMPONENTS.get(index).map(|name| format!("`{base}.{name}` or "));
            let component = component.unwrap_or_default();
            let rows = expr.shape().rows;
            if index < rows {
                format!("write {component}`{base}[{index}]`")
            } else {
                format!("write `{base}[0]` to `{base}[{}]`", rows - 1)
            }
        }
        Value::Matrix(expr) if !expr.shape().is_scalar() => {
            format!("write `{base}[(i, j)]` for an entry, counted from 0")
        }
        _ => format!("leave out `.{index}`"),
    }
}

pub(super) fn is_self(syntax: &Syntax) -> bool {
    matches!(strip(syntax), Syntax::Path(path) if path.path.is_ident("self"))
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
