//! Vectors and matrices from their entries: `Vector3::new(…)`, `Matrix3::from_diagonal(…)`, `vector![…]`, `matrix![…; …]`.

use clebsch_symbolic::{Expr, IntoList, Shape};
use quote::ToTokens;
use syn::parse::ParseStream;
use syn::{Expr as Syntax, ExprCall, ExprPath, GenericArgument, Generics, Ident, Macro, PathSegment, Token};

use super::super::shapes::{LARGEST, arguments, named_shape, size_argument};
use super::access::strip;
use super::methods::wrong_count;
use super::tables::METHODS;
use super::{Elaborator, Growth, Value};
use crate::diagnostic::{Diagnostic, error, meant, refuse};
use crate::parse::{listed, parenthesized, spell};

/// A constructor: its number of arguments, the shapes that have it, and its value.
type Constructor =
    (usize, fn(Shape) -> bool, for<'g> fn(&mut Elaborator<'_, '_, 'g>, &ExprCall, Shape) -> Option<Value<'g>>);

/// Constructors by name, each with its value. `new` is none of them: it has one argument for each entry.
#[rustfmt::skip]
pub(super) const CONSTRUCTORS: [(&str, Constructor, &str); 8] = [
    ("zeros",         (0, |_| true, |this, _, shape| Some(Value::Matrix(this.graph().zero(shape)))), "all entries 0"),
    ("identity",      (0, |shape| shape.is_square(), |this, _, shape| Some(Value::Matrix(this.graph().identity(shape.rows)))), "ones on the diagonal, of a square matrix"),
    ("from_diagonal", (1, |shape| shape.is_square(), |this, call, shape| this.diagonal(call, shape)), "the square matrix with a vector on its diagonal"),
    ("from_columns",  (1, |_| true, |this, call, shape| this.joined(call, shape, Shape::new(shape.rows, 1), shape.columns)), "from an array of columns"),
    ("from_rows",     (1, |_| true, |this, call, shape| this.joined(call, shape, Shape::new(1, shape.columns), shape.rows)), "from an array of rows"),
    ("x",             (0, |shape| shape.is_column(), |this, _, shape| Some(Value::Matrix(this.graph().unit(shape, 0, 0)))), "the first unit vector"),
    ("y",             (0, |shape| shape.is_column() && shape.rows > 1, |this, _, shape| Some(Value::Matrix(this.graph().unit(shape, 1, 0)))), "the second unit vector"),
    ("z",             (0, |shape| shape.is_column() && shape.rows > 2, |this, _, shape| Some(Value::Matrix(this.graph().unit(shape, 2, 0)))), "the third unit vector"),
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
            refuse!(self, &call.func, "`{}` is no function", spell(&call.func); help "write `*` to multiply");
        };
        let Some([owner, method]) = path.path.segments.iter().into_list().last_chunk().copied() else {
            return self.unknown_function(call, path);
        };
        if owner.ident == "Quaternion" || owner.ident == "UnitQuaternion" {
            return self.quaternion_constructor(call, &method.ident);
        }
        match self.constructed_shape(owner) {
            Some(shape) => self.construct(call, &method.ident, shape?),
            None => self.unknown_function(call, path),
        }
    }

    /// The shape of `Matrix3` in `Matrix3::new`; `None` if that is no such type.
    fn constructed_shape(&mut self, segment: &PathSegment) -> Option<Option<Shape>> {
        let name = segment.ident.to_string();
        let sizes = match name.as_str() {
            "SVector" => 1,
            "SMatrix" => 2,
            _ => return named_shape(&name).map(Some),
        };
        let given = arguments(segment);
        let Some(known) = self.sizes(&given[given.len().saturating_sub(sizes)..]) else { return Some(None) };
        Some(match known.as_slice() {
            [n] if sizes == 1 => Some(Shape::vector(*n)),
            [rows, columns] => Some(Shape::new(*rows, *columns)),
            _ => {
                let example = if sizes == 1 { "SVector::<f64, 8>" } else { "SMatrix::<f64, 2, 3>" };
                let error = error!(&segment.ident, "the size of `{name}` is not known here"; help "write `{example}`");
                self.refuse(error)
            }
        })
    }

    /// The sizes that generic arguments stand for.
    pub(super) fn sizes(&mut self, arguments: &[&GenericArgument]) -> Option<Vec<usize>> {
        let sizes = arguments.iter().map(|argument| size_argument(argument, &Generics::default()));
        self.context.diagnostics.take(sizes.collect::<Result<_, _>>())
    }

    fn construct(&mut self, call: &ExprCall, method: &Ident, shape: Shape) -> Option<Value<'g>> {
        if method == "new" {
            return self.entries(call, method, shape);
        }
        let Some(&(_, (arity, exists, make), _)) = CONSTRUCTORS.iter().find(|(name, ..)| method == name) else {
            return self.unknown_constructor(method);
        };
        let function = spell(&call.func);
        if call.args.len() != arity {
            return self.refuse(wrong_count(method, "", &function, arity, call.args.len()));
        }
        if !exists(shape) {
            refuse!(self, method, "`{function}` does not exist: the type is {shape}";
                note "`identity` and `from_diagonal` are of square matrices, `x`, `y` and `z` of vectors");
        }
        make(self, call, shape)
    }

    fn diagonal(&mut self, call: &ExprCall, shape: Shape) -> Option<Value<'g>> {
        let (argument, n) = (&call.args[0], shape.rows);
        let diagonal = self.matrix(argument)?;
        if diagonal.shape() != Shape::vector(n) {
            let (text, is) = (spell(strip(argument)), diagonal.shape());
            refuse!(self, argument, "`{text}` is {is}, but the diagonal is {n}x1";
                help "write `{}(&vector![…])` with {n} entries", spell(&call.func));
        }
        self.build(call, &[diagonal], Growth::Sum, || diagonal.diagonal_matrix())
    }

    /// A matrix from its columns or rows.
    fn joined(&mut self, call: &ExprCall, shape: Shape, part: Shape, count: usize) -> Option<Value<'g>> {
        let Value::Array(parts) = self.elaborate(&call.args[0])? else {
            let function = spell(&call.func);
            refuse!(self, &call.args[0], "`{function}` takes an array"; help "write `{function}(&[a, b])`");
        };
        let fits = |value: &Value<'g>| value.matrix().filter(|matrix| matrix.shape() == part);
        match parts.iter().map(fits).collect::<Option<Vec<Expr<'g>>>>() {
            Some(matrices) if matrices.len() == count => {
                let entry = |(i, j): (usize, usize)| {
                    if part.columns == shape.columns { matrices[i].entry(0, j) } else { matrices[j].entry(i, 0) }
                };
                let entries = shape.positions().map(entry).into_list();
                self.stack(call, shape, entries)
            }
            _ => {
                let function = spell(&call.func);
                refuse!(self, &call.args[0], "`{function}` takes {count} parts, each {part}";
                    help "write `{function}(&[…])` with {count} of them")
            }
        }
    }

    /// A matrix from its entries, row by row.
    fn entries(&mut self, call: &ExprCall, method: &Ident, shape: Shape) -> Option<Value<'g>> {
        if call.args.len() != shape.len() {
            let function = spell(&call.func);
            refuse!(self, method, "`{function}` has {} entries, not {}", shape.len(), call.args.len();
                note "entries are given row by row");
        }
        let entries = self.scalars(&call.args)?;
        self.stack(call, shape, entries)
    }

    /// All values as scalars, or all of their errors.
    pub(super) fn scalars<'s>(&mut self, parts: impl IntoIterator<Item = &'s Syntax>) -> Option<Vec<Expr<'g>>> {
        let found: Vec<Option<Expr<'g>>> = parts.into_iter().map(|part| self.scalar(part)).into_list();
        found.into_iter().collect()
    }

    pub(super) fn stack(&mut self, at: &dyn ToTokens, shape: Shape, entries: Vec<Expr<'g>>) -> Option<Value<'g>> {
        let graph = self.graph();
        self.build(at, &entries.clone(), Growth::Product, || graph.stack(shape, entries))
    }

    fn unknown_constructor(&mut self, method: &Ident) -> Option<Value<'g>> {
        let name = method.to_string();
        let names = ["new"].into_iter().chain(CONSTRUCTORS.iter().map(|&(name, ..)| name));
        let error = error!(method, "unknown constructor `{name}`");
        self.refuse(match meant(&name, &SYNONYMS, names.clone()) {
            Some(meant) => error.help(format!("write `{meant}`")),
            None => error.note(format!("the constructors are {}", listed(names))),
        })
    }

    fn unknown_function(&mut self, call: &ExprCall, path: &ExprPath) -> Option<Value<'g>> {
        let name = path.path.segments.last().map(|segment| segment.ident.to_string()).unwrap_or_default();
        let error = error!(&call.func, "the function `{}` is not known in the {}", spell(&call.func), self.key);
        let is_method = METHODS.iter().any(|(method, ..)| *method == name);
        self.refuse(match call.args.first().filter(|_| is_method) {
            Some(first) => {
                let is_of_number = name == "log" && self.key != "space" && call.args.len() == 1;
                let method = if is_of_number { "ln" } else { &name };
                error.help(format!("write `{}.{method}()`", parenthesized(strip(first))))
            }
            None => {
                let error = error.help("write its formula here").maybe_help(self.opaque());
                error.note("a macro cannot look into functions")
            }
        })
    }

    /// `vector![…]` and `matrix![…]`.
    pub(super) fn macro_call(&mut self, written: &Macro) -> Option<Value<'g>> {
        let name = written.path.segments.last().map(|segment| segment.ident.to_string()).unwrap_or_default();
        let is_vector = name == "vector";
        if name == "vec" {
            refuse!(self, &written.path, "`vec!` makes a vector on the heap, which no {} has", self.key;
                help "write `[a, b]` for an array, `vector![a, b, c]` for a column of numbers");
        }
        if !is_vector && name != "matrix" {
            refuse!(self, &written.path, "unknown macro `{name}!` in the {}", self.key;
                help "the macros are `vector![a, b, c]` and `matrix![a, b; c, d]`");
        }
        let rows = self.context.diagnostics.take(read_rows(written, is_vector).map_err(Diagnostic::from))?;
        let columns = rows.first().map_or(0, Vec::len);
        if columns == 0 || rows.iter().any(|row| row.len() != columns) || rows.len().max(columns) > LARGEST {
            refuse!(self, written, "the rows have no common length between 1 and 64";
                help "write `vector![a, b, c]` or `matrix![a, b; c, d]`");
        }
        let shape = if is_vector { Shape::vector(columns) } else { Shape::new(rows.len(), columns) };
        let entries = self.scalars(rows.iter().flatten())?;
        self.stack(written, shape, entries)
    }
}

/// Rows separated by semicolons, entries by commas.
fn read_rows(written: &Macro, single: bool) -> syn::Result<Vec<Vec<Syntax>>> {
    let parser = |stream: ParseStream| {
        let mut rows = vec![Vec::new()];
        while !stream.is_empty() {
            let row: &mut Vec<Syntax> = rows.last_mut().ok_or_else(|| stream.error("a row"))?;
            row.push(stream.parse()?);
            if !single && stream.peek(Token![;]) {
                stream.parse::<Token![;]>()?;
                rows.push(Vec::new());
            } else if !stream.is_empty() {
                stream.parse::<Token![,]>()?;
            }
        }
        rows.retain(|row| !row.is_empty());
        Ok(rows)
    };
    written.parse_body_with(parser)
}
