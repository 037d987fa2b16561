//! A group by a basis of its Lie algebra: matrices of numbers, independent, with brackets in their span.

use clebsch_symbolic::{Elements, Graph, Group, IntoList, Rational, Shape, Sparse, indexed, reduce};
use quote::ToTokens;
use syn::Expr as Syntax;

use super::super::value::Value;
use super::follow::at_identity;
use super::{check_literal, check_size, elaborate, empty_scope, open_bracket, sparse, spell_matrix};
use crate::diagnostic::{Diagnostics, Location, bail, error};
use crate::parse::{joined, shortened};

/// Reads `basis([E1, E2])`.
pub(super) fn read(graph: &Graph, name: &str, elements: &[Syntax], place: Location) -> Result<Group, Diagnostics> {
    if elements.is_empty() {
        bail!(place, "the basis of `{name}` is empty"; help "write its matrices, `basis([Matrix2::new(0, -1, 1, 0)])`");
    }
    let errors = Diagnostics::new();
    let literals = elements.iter().enumerate().map(|(k, element)| literal(graph, name, k, element));
    let matrices: Vec<Matrix> = literals.filter_map(|literal| errors.take(literal)).into_list();
    errors.propagate(())?;
    let shape = common_shape(name, &matrices, elements)?;
    check_size(name, shape.rows, place.start)?;
    independent(name, &matrices, elements)?;
    let basis: Vec<Sparse> = matrices.each(|(_, entries)| sparse(shape, entries));
    closed(graph, name, shape, &basis, place)?;
    Ok(Group::declare(graph, name, shape, basis, None))
}

/// The shape of a matrix of numbers, and its entries row by row.
type Matrix = (Shape, Vec<Rational>);

fn literal(graph: &Graph, name: &str, k: usize, element: &Syntax) -> Result<Matrix, Diagnostics> {
    let key = format!("basis of `{name}`");
    check_literal(&key, element.to_token_stream())?;
    let value = elaborate(graph, &key, empty_scope(), |elaborator| elaborator.elaborate(element))?;
    let Value::Matrix(expr) = value else {
        let is_identity = matches!(value, Value::Identity(_));
        let example = if is_identity { "Matrix3::identity()" } else { "Matrix3::new(0, 1, 0, 0, 0, 0, 0, 0, 0)" };
        bail!(element, "`E{}` of `{name}` is {}, not a matrix", k + 1, value.describe(); help "write `{example}`");
    };
    // without symbols none is asked for: any will do
    let values = if expr.symbols().is_empty() { at_identity(expr, graph.identity(1)) } else { None };
    let entries = values.ok_or_else(|| {
        error!(element, "the entries of `{}` are not rational", shortened(element);
            note "whether brackets stay in the span is decided exactly, over the rational numbers")
    })?;
    Ok((expr.shape(), entries))
}

fn common_shape(name: &str, matrices: &[Matrix], elements: &[Syntax]) -> Result<Shape, Diagnostics> {
    let first = matrices[0].0;
    if !first.is_square() {
        bail!(&elements[0], "`E1` of `{name}` is {first}, but a Lie algebra is made of square matrices";
            note "its elements are multiplied, E1*E2 - E2*E1");
    }
    if let Some(k) = matrices.iter().position(|(shape, _)| *shape != first) {
        bail!(&elements[k], "`E1` of `{name}` is {first} and `E{}` is {}", k + 1, matrices[k].0;
            note "the matrices of a basis have one shape");
    }
    Ok(first)
}

fn independent(name: &str, matrices: &[Matrix], elements: &[Syntax]) -> Result<(), Diagnostics> {
    // the columns are the matrices; one without a pivot is a combination of those before, with the entries above as coefficients
    let length = matrices[0].1.len();
    let mut rows: Vec<Vec<Rational>> = indexed(length, |entry| matrices.each(|(_, entries)| entries[entry].clone()));
    let pivots = reduce(&mut rows);
    let Some(k) = (0..matrices.len()).find(|k| !pivots.contains(k)) else { return Ok(()) };
    let terms = pivots.iter().zip(&rows).filter(|(pivot, _)| **pivot < k).map(|(pivot, row)| (*pivot, row[k].clone()));
    bail!(&elements[k], "the basis of `{name}` is not independent";
        help "leave E{} out", k + 1; note "E{} = {}", k + 1, combination(terms))
}

/// `2*E1 - E2`.
fn combination(terms: impl Iterator<Item = (usize, Rational)>) -> String {
    let mut text = String::new();
    for (k, coefficient) in terms.filter(|(_, coefficient)| !coefficient.is_zero()) {
        let [first, next] = if coefficient.is_negative() { ["-", " - "] } else { ["", " + "] };
        text.push_str(if text.is_empty() { first } else { next });
        let size = coefficient.abs();
        let factor = if size.is_one() { String::new() } else { format!("{size}*") };
        text.push_str(&format!("{factor}E{}", k + 1));
    }
    if text.is_empty() { "0".into() } else { text }
}

fn closed(graph: &Graph, name: &str, shape: Shape, basis: &[Sparse], place: Location) -> Result<(), Diagnostics> {
    let Some((i, j, bracket)) = open_bracket(graph, shape, basis) else { return Ok(()) };
    let (i, j, n) = (i + 1, j + 1, shape.rows);
    let name_of_type = if n <= 6 { format!("Matrix{n}::new") } else { format!("SMatrix::<f64, {n}, {n}>::new") };
    bail!(place, "the basis of `{name}` is not closed: [E{i}, E{j}] is outside of its span";
        help "add `{name_of_type}({})`, and whatever its brackets need", joined(&bracket);
        note "[E{i}, E{j}] = E{i}*E{j} - E{j}*E{i} = {}", spell_matrix(shape, &bracket))
}
