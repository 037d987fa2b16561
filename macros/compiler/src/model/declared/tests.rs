//! Declared groups against the documented bases of those that are built in, and against dimensions that are known otherwise.

use clebsch_symbolic::{Expr, Graph, Group, integer, rational};
use proc_macro2::Span;

use super::equation::kernel;
use super::read_all;
use crate::diagnostic::Diagnostics;
use crate::parse::parse;

/// The group `Own` of a definition.
fn declare(graph: &Graph, definition: &str) -> Result<Group, Diagnostics> {
    let source =
        format!("#[clebsch(group Own = {definition}, action = |F: Own, q: Own| F * q, cost = |h, F| h)] struct S;");
    let declaration = parse(source.parse().expect("the table holds Rust"))?;
    let diagnostics = Diagnostics::new();
    let groups = read_all(graph, &declaration.groups, &diagnostics);
    diagnostics.propagate(())?;
    Ok(groups.find(&syn::Ident::new("Own", Span::call_site())).expect("a group, since there are no errors"))
}

/// The basis of a definition, as text.
#[track_caller]
fn basis(graph: &Graph, definition: &str) -> Vec<String> {
    let group = declare(graph, definition).unwrap_or_else(|errors| panic!("{definition}\n{errors}"));
    spell(&graph.matrices(group))
}

fn spell(basis: &[Expr<'_>]) -> Vec<String> {
    basis.iter().map(Expr::to_string).collect()
}

/// Table of bases: "for RᵀR = I: the SO<n> row", and likewise for other forms.
#[test]
fn an_equation_gives_the_documented_basis() {
    let graph = Graph::new();
    let so = |n: usize| spell(&graph.matrices(Group::SpecialOrthogonal(n)));
    for n in [2, 4, 5, 6] {
        assert_eq!(basis(&graph, &format!("|F: Matrix{n}| F.transpose() * F == I")), so(n));
    }
    assert_eq!(basis(&graph, "|F: SMatrix<7, 7>| F.transpose() == F.inverse()"), so(7));
    let lorentz =
        "|F: Matrix4| { let eta = Matrix4::from_diagonal(&vector![1, -1, -1, -1]); F.transpose() * eta * F == eta }";
    assert_eq!(basis(&graph, lorentz), spell(&graph.matrices(Group::PseudoOrthogonal(1, 3))));
    let anti = "|F: Matrix3| { let eta = matrix![1, 0, 0; 0, 1, 0; 0, 0, -1]; F * eta * F.transpose() - eta == Matrix3::zeros() }";
    assert_eq!(basis(&graph, anti), spell(&graph.matrices(Group::PseudoOrthogonal(2, 1))));
}

#[test]
fn coordinates_are_the_entries_column_by_column() {
    let graph = Graph::new();
    assert_eq!(basis(&graph, "|F: Matrix2| F.determinant() == 1"), ["[1, 0; 0, −1]", "[0, 0; 1, 0]", "[0, 1; 0, 0]"]);
    let motions = "|F: Matrix3| (F.fixed_view::<2, 2>(0, 0).transpose() * F.fixed_view::<2, 2>(0, 0), F.row(2)) == (I, matrix![0, 0, 1])";
    assert_eq!(
        basis(&graph, motions),
        ["[0, −1, 0; 1, 0, 0; 0, 0, 0]", "[0, 0, 1; 0, 0, 0; 0, 0, 0]", "[0, 0, 0; 0, 0, 1; 0, 0, 0]"]
    );
    // a form with denominators: the second entry is minus half of the first
    let skewed = "|F: Matrix2| { let a = matrix![1, 0; 0, 2]; F.transpose() * a * F == a }";
    assert_eq!(basis(&graph, skewed), ["[0, −2; 1, 0]"]);
}

/// Dimensions that are known from the theory of Lie groups.
#[test]
#[rustfmt::skip]
fn dimensions_of_declared_groups() {
    let table = [
        ("|F: Matrix3| F.determinant() == 1", 8),
        ("|F: Matrix4| { let j = matrix![0, 0, 1, 0; 0, 0, 0, 1; -1, 0, 0, 0; 0, -1, 0, 0]; F.transpose() * j * F == j }", 10),
        // U(2) in its real form, SU(2) with the determinant of the upper left made of its complex entries
        ("|F: Matrix4| { let j = matrix![0, 0, 1, 0; 0, 0, 0, 1; -1, 0, 0, 0; 0, -1, 0, 0]; (F.transpose() * F, F * j) == (I, j * F) }", 4),
        ("|F: Matrix2| F * matrix![0, -1; 1, 0] == matrix![0, -1; 1, 0] * F", 2),
        // Heisenberg, upper triangular, diagonal, affine
        ("|F: Matrix3| [F[(0, 0)], F[(1, 1)], F[(2, 2)], F[(1, 0)], F[(2, 0)], F[(2, 1)]] == [1, 1, 1, 0, 0, 0]", 3),
        ("|F: Matrix3| [F[(1, 0)], F[(2, 0)], F[(2, 1)]] == [0, 0, 0]", 6),
        ("|F: Matrix3| F.component_mul(&I) == F", 3),
        ("|F: Matrix3| F.row(2) == matrix![0, 0, 1]", 6),
        // conformal: FᵀF a multiple of the identity
        ("|F: Matrix3| F.transpose() * F == (F.transpose() * F).trace() / 3 * I", 4),
        // the stabiliser of a vector in SO(4), of a line in GL(2)
        ("|F: Matrix4| (F.transpose() * F, F * vector![1, 1, 0, 0]) == (I, vector![1, 1, 0, 0])", 3),
        ("|F: Matrix2| (F * vector![1, 2])[0] * 2 == (F * vector![1, 2])[1]", 3),
        ("basis([Matrix3::new(0, 1, 0, 0, 0, 0, 0, 0, 0), Matrix3::new(0, 0, 0, 0, 0, 1, 0, 0, 0), Matrix3::new(0, 0, 1, 0, 0, 0, 0, 0, 0)])", 3),
        ("basis([Vector3::x().cross_matrix(), Vector3::y().cross_matrix(), Vector3::z().cross_matrix()])", 3),
        ("basis([Matrix2::new(1 / 2, 0, 0, -1 / 2), Matrix2::new(0, 1, 0, 0)])", 2),
    ];
    let graph = Graph::new();
    for (definition, dimension) in table {
        assert_eq!(basis(&graph, definition).len(), dimension, "{definition}");
    }
}

/// Equations that define no group, with the first line of the message.
#[test]
#[rustfmt::skip]
fn solutions_that_are_no_group_are_refused() {
    let table = [
        ("|F: Matrix3| F.transpose() == F", "the matrices with `F.transpose() == F` are no group"),
        ("|F: Matrix3| F.trace() == 3", "the matrices with `F.trace() == 3` are no group"),
        ("|F: Matrix2| F[(0, 0)].powi(2) + F[(1, 0)].powi(2) == 1", "the matrices with `F[(0, 0)].powi(2) + F[(1, 0)].powi(2) == 1` are no group"),
        ("|F: Matrix3| (F - I) * (F - I) == Matrix3::zeros()", "the equation of `Own` is not regular at the identity"),
        ("|F: Matrix3| (F.transpose() * F - I).norm_squared() == 0", "the equation of `Own` is not regular at the identity"),
        ("|F: Matrix2| (F.determinant() - 1).powi(3) == 0", "the equation of `Own` is not regular at the identity"),
        ("|F: Matrix2| 1 / F.trace() == 2", "the identity is not in `Own`"),
        ("|F: Matrix2| (F - I).inverse() == F", "the equation of `Own` has no value at the identity"),
        ("|F: Matrix2| F.norm() == 2.sqrt()", "the equation of `Own` is not rational"),
    ];
    let graph = Graph::new();
    let first_line = |definition: &str| match declare(&graph, definition) {
        Ok(_) => "a group".to_string(),
        Err(errors) => errors.to_string().lines().next().unwrap_or_default().trim_start_matches("error: ").to_string(),
    };
    for (definition, expected) in table {
        assert_eq!(first_line(definition), expected, "{definition}");
    }
}

#[test]
fn an_entry_that_those_before_do_not_determine_is_a_coordinate() {
    // x1 + x2 = 0 and x0 + 2 x3 = 0: x0 and x1 are free, x2 and x3 follow
    let row = |entries: [i64; 4]| entries.map(integer).to_vec();
    let found = kernel(&[row([0, 1, 1, 0]), row([1, 0, 0, 2]), row([1, 1, 1, 2])], 4);
    let first = vec![integer(1), integer(0), integer(0), rational(-1, 2)];
    assert_eq!(found, [first, row([0, 1, -1, 0])]);
}
