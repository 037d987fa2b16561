//! Vectors and matrices from their entries: `Vector3::new(…)`, `Matrix3::from_diagonal(…)`, `vector![…]`, `matrix![…; …]`.

use clebsch_symbolic::{Expr, Shape};
use syn::{Expr as Syntax, ExprCall, ExprPath, GenericArgument, Generics, Ident};

use super::super::sizes::size_argument;
use super::super::value::Value;
use super::super::vectors::{arguments, named_shape};
use super::access::strip;
use super::{Elaborator, Growth};
use crate::diagnostic::{Diagnostic, Location, nearest};
use crate::parse::spell;

/// The constructors of vector and matrix types.
#[derive(Copy, Clone, PartialEq, Eq)]
enum Constructor {
    New,
    Zeros,
    Identity,
    FromDiagonal,
    FromColumns,
    FromRows,
    Axis(usize),
}

/// Constructors with their number of arguments; `new` has one for each entry.
#[rustfmt::skip]
const CONSTRUCTORS: [(&str, usize, Constructor); 9] = [
    ("new",           0, Constructor::New),
    ("zeros",         0, Constructor::Zeros),
    ("identity",      0, Constructor::Identity),
    ("from_diagonal", 1, Constructor::FromDiagonal),
    ("from_columns",  1, Constructor::FromColumns),
    ("from_rows",     1, Constructor::FromRows),
    ("x",             0, Constructor::Axis(0)),
    ("y",             0, Constructor::Axis(1)),
    ("z",             0, Constructor::Axis(2)),
];

/// Constructors by other names.
#[rustfmt::skip]
const SYNONYMS: [(&str, &str); 6] = [
    ("x_axis", "x"), ("y_axis", "y"), ("z_axis", "z"), ("from_row_slice", "new"), ("zero", "zeros"), ("from_vec", "new"),
];

impl<'g> Elaborator<'_, '_, 'g> {
    /// `Type::constructor(…)`; other functions cannot be looked into.
    pub(super) fn call(&mut self, call: &ExprCall) -> Option<Value<'g>> {
        let Syntax::Path(path) = strip(&call.func) else {
            let error = Diagnostic::new(Location::of(&call.func), format!("`{}` is no function", spell(&call.func)));
            return self.error(error.help("write `*` to multiply"));
        };
        if let [.., owner, method] = path.path.segments.iter().collect::<Vec<_>>().as_slice()
            && (owner.ident == "Quaternion" || owner.ident == "UnitQuaternion")
        {
            return self.quaternion_constructor(call, &method.ident);
        }
        match self.constructed_shape(path) {
            Some(shape) => self.construct(call, path, shape?),
            None => self.unknown_function(call, path),
        }
    }

    /// The shape of `Matrix3` in `Matrix3::new`; `None` if there is no such type in the path.
    fn constructed_shape(&mut self, path: &ExprPath) -> Option<Option<Shape>> {
        let segment = path.path.segments.iter().rev().nth(1)?;
        let name = segment.ident.to_string();
        let sizes = match name.as_str() {
            "SVector" => 1,
            "SMatrix" => 2,
            _ => return named_shape(&name).map(Some),
        };
        let given = arguments(segment);
        let written: Vec<&GenericArgument> = given.iter().copied().skip(given.len().saturating_sub(sizes)).collect();
        let mut known = Vec::new();
        for argument in &written {
            match size_argument(argument, &Generics::default()) {
                Ok(size) => known.push(size),
                Err(error) => {
                    self.context.diagnostics.push(error);
                    return Some(None);
                }
            }
        }
        match known.as_slice() {
            [n] if sizes == 1 => Some(Some(Shape::vector(*n))),
            [rows, columns] => Some(Some(Shape::new(*rows, *columns))),
            _ => {
                let example = if sizes == 1 { "SVector::<f64, 8>" } else { "SMatrix::<f64, 2, 3>" };
                let error = Diagnostic::new(segment.ident.span(), format!("the size of `{name}` is not known here"));
                self.context.diagnostics.push(error.help(format!("write `{example}`")));
                Some(None)
            }
        }
    }

    fn construct(&mut self, call: &ExprCall, path: &ExprPath, shape: Shape) -> Option<Value<'g>> {
        // by construction: a path with a type before its last segment has a last segment
        let method = &path.path.segments.last()?.ident;
        let Some(&(_, arity, constructor)) = CONSTRUCTORS.iter().find(|(name, ..)| method == name) else {
            return self.unknown_constructor(method);
        };
        if constructor == Constructor::New {
            return self.entries(call, method, shape, call.args.iter().collect());
        }
        if call.args.len() != arity {
            let plural = if arity == 1 { "" } else { "s" };
            let message = format!("`{}` has {arity} argument{plural}, not {}", spell(&call.func), call.args.len());
            let help = format!("write `{}({})`", spell(&call.func), if arity == 0 { "" } else { "…" });
            return self.error(Diagnostic::new(method.span(), message).help(help));
        }
        let graph = self.graph();
        match constructor {
            Constructor::Zeros => Some(Value::Matrix(graph.zero(shape))),
            Constructor::Identity if shape.is_square() => Some(Value::Matrix(graph.identity(shape.rows))),
            Constructor::Axis(index) if shape.is_column() && index < shape.rows => {
                Some(Value::Matrix(graph.unit(shape, index, 0)))
            }
            Constructor::FromDiagonal if shape.is_square() => self.diagonal(call, shape),
            Constructor::FromColumns => self.joined(call, shape, Shape::new(shape.rows, 1), shape.columns),
            Constructor::FromRows => self.joined(call, shape, Shape::new(1, shape.columns), shape.rows),
            _ => {
                let error = Diagnostic::new(
                    method.span(),
                    format!("`{}` does not exist: the type is {shape}", spell(&call.func)),
                );
                self.error(
                    error.note("`identity` and `from_diagonal` are of square matrices, `x`, `y` and `z` of vectors"),
                )
            }
        }
    }

    fn diagonal(&mut self, call: &ExprCall, shape: Shape) -> Option<Value<'g>> {
        let diagonal = self.matrix(&call.args[0])?;
        if diagonal.shape() != Shape::vector(shape.rows) {
            let message = format!(
                "`{}` is {}, but the diagonal is {}x1",
                spell(strip(&call.args[0])),
                diagonal.shape(),
                shape.rows
            );
            let help = format!("write `{}(&vector![…])` with {} entries", spell(&call.func), shape.rows);
            return self.error(Diagnostic::new(Location::of(&call.args[0]), message).help(help));
        }
        self.build(call, &[diagonal], Growth::Sum, || diagonal.diagonal_matrix()).map(Value::Matrix)
    }

    /// A matrix from its columns or rows.
    fn joined(&mut self, call: &ExprCall, shape: Shape, part: Shape, count: usize) -> Option<Value<'g>> {
        let Value::Array(parts) = self.elaborate(&call.args[0])? else {
            let error = Diagnostic::new(Location::of(&call.args[0]), format!("`{}` takes an array", spell(&call.func)));
            return self.error(error.help(format!("write `{}(&[a, b])`", spell(&call.func))));
        };
        let matrices: Option<Vec<Expr<'g>>> =
            parts.iter().map(|value| value.matrix().filter(|matrix| matrix.shape() == part)).collect();
        match matrices {
            Some(matrices) if matrices.len() == count => {
                let entry = |(i, j): (usize, usize)| {
                    if part.columns == shape.columns { matrices[i].entry(0, j) } else { matrices[j].entry(i, 0) }
                };
                let entries = shape.positions().map(entry).collect();
                self.stack(call, shape, entries)
            }
            _ => {
                let message = format!("`{}` takes {count} parts, each {part}", spell(&call.func));
                let help = format!("write `{}(&[…])` with {count} of them", spell(&call.func));
                self.error(Diagnostic::new(Location::of(&call.args[0]), message).help(help))
            }
        }
    }

    /// A matrix from its entries, row by row.
    fn entries(&mut self, at: &ExprCall, method: &Ident, shape: Shape, entries: Vec<&Syntax>) -> Option<Value<'g>> {
        if entries.len() != shape.len() {
            let message = format!("`{}` has {} entries, not {}", spell(&at.func), shape.len(), entries.len());
            return self.error(Diagnostic::new(method.span(), message).note("entries are given row by row"));
        }
        let found: Vec<Option<Expr<'g>>> = entries.into_iter().map(|entry| self.scalar(entry)).collect();
        let found: Vec<Expr<'g>> = found.into_iter().collect::<Option<_>>()?;
        self.stack(at, shape, found)
    }

    /// A matrix of these scalars.
    pub(super) fn stack(
        &mut self,
        at: &dyn quote::ToTokens,
        shape: Shape,
        entries: Vec<Expr<'g>>,
    ) -> Option<Value<'g>> {
        let graph = self.graph();
        self.build(at, &entries.clone(), Growth::Product, || graph.stack(shape, entries)).map(Value::Matrix)
    }

    fn unknown_constructor(&mut self, method: &Ident) -> Option<Value<'g>> {
        let name = method.to_string();
        let names = CONSTRUCTORS.iter().map(|&(name, ..)| name);
        let synonym = SYNONYMS.iter().find(|(other, _)| *other == name).map(|&(_, meant)| meant);
        let error = Diagnostic::new(method.span(), format!("unknown constructor `{name}`"));
        let list: Vec<String> = names.clone().map(|name| format!("`{name}`")).collect();
        self.error(match synonym.or_else(|| nearest(&name, names)) {
            Some(meant) => error.help(format!("write `{meant}`")),
            None => error.note(format!("the constructors are {}", list.join(", "))),
        })
    }

    fn unknown_function(&mut self, call: &ExprCall, path: &ExprPath) -> Option<Value<'g>> {
        let name = path.path.segments.last().map(|segment| segment.ident.to_string()).unwrap_or_default();
        let error = Diagnostic::new(
            Location::of(&call.func),
            format!("the function `{}` is not known in the {}", spell(&call.func), self.key),
        );
        let method = super::tables::METHODS.iter().any(|(method, ..)| *method == name);
        self.error(match call.args.first() {
            Some(first) if method => {
                error.help(format!("write `{}.{name}()`", super::operators::parenthesized(strip(first))))
            }
            _ => error.help("write its formula here").note("a macro cannot look into functions"),
        })
    }
}
