//! A group by a basis of its Lie algebra: matrices of numbers, independent, with brackets in their span.

use clebsch_symbolic::{Expr, Graph, Group, Rational, Shape, Sparse, reduce};
use syn::Expr as Syntax;

use super::super::elaborate::shortened;
use super::super::value::Value;
use super::exact::Exact;
use super::{bracket_with, check_size, elaborate, empty_scope, fields_in, not_literal, sparse, spell_matrix};
use crate::diagnostic::{Diagnostic, Location};
use crate::parse::spell;

/// Reads `basis([E1, E2])`.
pub(super) fn read(graph: &Graph, name: &str, elements: &[Syntax], place: Location) -> Result<Group, Vec<Diagnostic>> {
    if elements.is_empty() {
        let error = Diagnostic::new(place, format!("the basis of `{name}` is empty"));
        return Err(vec![error.help("write its matrices, `basis([Matrix2::new(0, -1, 1, 0)])`")]);
    }
    let found: Vec<Result<Matrix, Vec<Diagnostic>>> =
        elements.iter().enumerate().map(|(k, element)| literal(graph, name, k, element)).collect();
    let (found, errors): (Vec<_>, Vec<_>) = found.into_iter().partition(Result::is_ok);
    let errors: Vec<Diagnostic> = errors.into_iter().filter_map(Result::err).flatten().collect();
    if !errors.is_empty() {
        return Err(errors);
    }
    let matrices: Vec<Matrix> = found.into_iter().flatten().collect();
    let shape = common_shape(name, &matrices, elements)?;
    check_size(name, shape.rows, place.start())?;
    independent(name, &matrices, elements)?;
    let basis: Vec<Sparse> = matrices.iter().map(|matrix| sparse(shape, &matrix.entries)).collect();
    closed(graph, name, shape, &basis, place)?;
    Ok(Group::by_basis(graph, name, shape, basis))
}

/// A matrix of numbers, row by row.
struct Matrix {
    shape: Shape,
    entries: Vec<Rational>,
}

fn literal(graph: &Graph, name: &str, k: usize, element: &Syntax) -> Result<Matrix, Vec<Diagnostic>> {
    let key = format!("basis of `{name}`");
    if let Some((place, field)) = fields_in(element) {
        return Err(vec![not_literal(place, &key, &format!("`{field}`"))]);
    }
    let value = elaborate(graph, &key, empty_scope(), |elaborator| elaborator.elaborate(element))?;
    let Value::Matrix(expr) = value else {
        let message = format!("`E{}` of `{name}` is {}, not a matrix", k + 1, value.describe());
        let example = match value {
            Value::Identity(_) => "Matrix3::identity()",
            _ => "Matrix3::new(0, 1, 0, 0, 0, 0, 0, 0, 0)",
        };
        return Err(vec![Diagnostic::new(Location::of(element), message).help(format!("write `{example}`"))]);
    };
    let entries = exact(expr).ok_or_else(|| {
        let text = shortened(&spell(element));
        let error = Diagnostic::new(Location::of(element), format!("the entries of `{text}` are not rational"));
        vec![error.note("whether brackets stay in the span is decided exactly, over the rational numbers")]
    })?;
    Ok(Matrix { shape: expr.shape(), entries })
}

/// The values of an expression without symbols.
fn exact(expr: Expr<'_>) -> Option<Vec<Rational>> {
    if !expr.symbols().is_empty() {
        return None;
    }
    // by construction: there is no symbol to be asked for
    let unknown = |symbol: Expr<'_>| clebsch_symbolic::Matrix::from_fn(symbol.shape(), |_| Exact::UNKNOWN);
    let value = expr.evaluate(&mut |symbol| unknown(symbol));
    value.entries.into_iter().map(Exact::rational).collect()
}

fn common_shape(name: &str, matrices: &[Matrix], elements: &[Syntax]) -> Result<Shape, Vec<Diagnostic>> {
    let first = matrices[0].shape;
    if !first.is_square() {
        let message = format!("`E1` of `{name}` is {first}, but a Lie algebra is made of square matrices");
        let error = Diagnostic::new(Location::of(&elements[0]), message);
        return Err(vec![error.note("its elements are multiplied, E1*E2 - E2*E1")]);
    }
    match matrices.iter().position(|matrix| matrix.shape != first) {
        Some(k) => {
            let message = format!("`E1` of `{name}` is {first} and `E{}` is {}", k + 1, matrices[k].shape);
            let error = Diagnostic::new(Location::of(&elements[k]), message);
            Err(vec![error.note("the matrices of a basis have one shape")])
        }
        None => Ok(first),
    }
}

fn independent(name: &str, matrices: &[Matrix], elements: &[Syntax]) -> Result<(), Vec<Diagnostic>> {
    // the columns are the matrices; one without a pivot is a combination of those before, with the entries above as coefficients
    let length = matrices[0].entries.len();
    let mut rows: Vec<Vec<Rational>> =
        (0..length).map(|entry| matrices.iter().map(|matrix| matrix.entries[entry].clone()).collect()).collect();
    let pivots = reduce(&mut rows);
    let Some(k) = (0..matrices.len()).find(|k| !pivots.contains(k)) else { return Ok(()) };
    let error = Diagnostic::new(Location::of(&elements[k]), format!("the basis of `{name}` is not independent"));
    let terms = pivots.iter().zip(&rows).filter(|(pivot, _)| **pivot < k).map(|(pivot, row)| (*pivot, row[k].clone()));
    Err(vec![error.help(format!("leave E{} out", k + 1)).note(format!("E{} = {}", k + 1, combination(terms)))])
}

/// `2*E1 - E2`.
fn combination(terms: impl Iterator<Item = (usize, Rational)>) -> String {
    use clebsch_symbolic::{One, Zero};
    let mut text = String::new();
    for (k, coefficient) in terms.filter(|(_, coefficient)| !coefficient.is_zero()) {
        let sign = match (coefficient.is_negative(), text.is_empty()) {
            (true, true) => "-",
            (true, false) => " - ",
            (false, true) => "",
            (false, false) => " + ",
        };
        let size = coefficient.abs();
        let factor = if size.is_one() { String::new() } else { format!("{size}*") };
        text.push_str(&format!("{sign}{factor}E{}", k + 1));
    }
    if text.is_empty() { "0".into() } else { text }
}

fn closed(graph: &Graph, name: &str, shape: Shape, basis: &[Sparse], place: Location) -> Result<(), Vec<Diagnostic>> {
    let span = graph.span(graph.algebra(shape, basis.to_vec()));
    let outside = |bracket: &[Rational]| !span.holds(bracket);
    let Some((i, j, bracket)) = bracket_with(graph, shape, basis, outside) else { return Ok(()) };
    let (i, j) = (i + 1, j + 1);
    let message = format!("the basis of `{name}` is not closed: [E{i}, E{j}] is outside of its span");
    let error = Diagnostic::new(place, message)
        .help(format!("add `{}`, and whatever its brackets need", constructor(shape, &bracket)))
        .note(format!("[E{i}, E{j}] = E{i}*E{j} - E{j}*E{i} = {}", spell_matrix(shape, &bracket)));
    Err(vec![error])
}

/// The text of a matrix in a declaration.
fn constructor(shape: Shape, entries: &[Rational]) -> String {
    let n = shape.rows;
    let name = if n <= 6 { format!("Matrix{n}::new") } else { format!("SMatrix::<f64, {n}, {n}>::new") };
    format!("{name}({})", entries.iter().map(Rational::to_string).collect::<Vec<_>>().join(", "))
}
