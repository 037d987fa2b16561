//! The documented bases of the built-in groups.

use super::{Block, Group};
use crate::algebra::{Sparse, unit_vectors};
use crate::{Elements, Graph, IntoList, Rational, Shape, indexed, integer, rational};

pub(super) fn blocks(graph: &Graph, group: Group) -> Vec<Block> {
    let whole = |elements: Vec<Sparse>| vec![(group.element_shape(), elements, 0, 0)];
    let square = |n: usize, elements: Vec<Sparse>| (Shape::square(n), elements, 0, 0);
    let column = |n: usize| (Shape::vector(n), unit_vectors(n), 0, n);
    let parts = match group {
        Group::SpecialOrthogonal(n) => whole(rotations(n)),
        Group::PseudoOrthogonal(p, q) => whole(pseudo_rotations(p, q)),
        Group::SpecialEuclidean(n) => vec![square(n, rotations(n)), column(n)],
        Group::Similarity(n) => {
            let dilation = vec![indexed(n, |i| one(i, i))];
            vec![square(n, rotations(n)), square(n, dilation), column(n)]
        }
        Group::Affine(n) => vec![square(n, entries(n)), column(n)],
        Group::Translation(n) => whole(unit_vectors(n)),
        Group::GeneralLinear(n) => whole(entries(n)),
        Group::SpecialLinear(n) => whole(differences(n).chain(off_diagonal(n)).into_list()),
        Group::Symplectic(n) => whole(hamiltonian(n / 2)),
        Group::Unitary(n) => whole(anti_hermitian(n, (0..n).map(|i| vec![one(i, i)]))),
        Group::SpecialUnitary(n) => whole(anti_hermitian(n, differences(n))),
        Group::UnitQuaternions => whole(indexed(3, |i| vec![(i, 0, rational(1, 2))])),
        Group::Heisenberg(n) => whole(heisenberg(n)),
        Group::Declared(declared) => {
            let algebra = graph.definition(declared).algebra;
            return vec![Block { algebra, row: 0, column: 0, offset: 0 }];
        }
    };
    let mut offset = 0;
    let block = |(shape, elements, row, column): (Shape, Vec<Sparse>, usize, usize)| {
        let block = Block { algebra: graph.algebra(shape, elements), row, column, offset };
        offset += block.algebra.dimension;
        block
    };
    parts.into_iter().filter(|(_, elements, ..)| !elements.is_empty()).map(block).into_list()
}

/// Eij.
fn one(i: usize, j: usize) -> (usize, usize, Rational) {
    (i, j, integer(1))
}

/// −Eij.
fn minus(i: usize, j: usize) -> (usize, usize, Rational) {
    (i, j, integer(-1))
}

fn pairs(n: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..n).flat_map(move |i| (i + 1..n).map(move |j| (i, j)))
}

/// Eji − Eij.
fn turn((i, j): (usize, usize)) -> Sparse {
    vec![one(j, i), minus(i, j)]
}

/// e1^, e2^, e3^ for n = 3, else Eji − Eij for i < j in the order (12) (13) … (n−1 n).
fn rotations(n: usize) -> Vec<Sparse> {
    if n == 3 { [(1, 2), (2, 0), (0, 1)].map(turn).to_vec() } else { pairs(n).map(turn).into_list() }
}

/// Eji − η_i η_j Eij for i < j.
fn pseudo_rotations(p: usize, q: usize) -> Vec<Sparse> {
    let mirrored = |i: usize, j: usize| if (i < p) == (j < p) { minus(i, j) } else { one(i, j) };
    pairs(p + q).map(|(i, j)| vec![one(j, i), mirrored(i, j)]).into_list()
}

/// Eij by rows.
fn entries(n: usize) -> Vec<Sparse> {
    Shape::square(n).positions().map(|(i, j)| vec![one(i, j)]).into_list()
}

/// Eij by rows, i ≠ j.
fn off_diagonal(n: usize) -> impl Iterator<Item = Sparse> {
    Shape::square(n).positions().filter(|(i, j)| i != j).map(|(i, j)| vec![one(i, j)])
}

/// Eii − E(i+1)(i+1).
fn differences(n: usize) -> impl Iterator<Item = Sparse> {
    (1..n).map(|i| vec![one(i - 1, i - 1), minus(i, i)])
}

/// Eij − E(n+j)(n+i) by rows; Ei(n+j) + Ej(n+i), once if i = j, for j ≤ i; their transposes.
fn hamiltonian(n: usize) -> Vec<Sparse> {
    let linear = Shape::square(n).positions().map(|(i, j)| vec![one(i, j), minus(n + j, n + i)]);
    let pairs = (0..n).flat_map(|i| (0..=i).map(move |j| (i, j)));
    let element = |(i, j)| if i == j { vec![one(i, n + j)] } else { vec![one(i, n + j), one(j, n + i)] };
    let symmetric: Vec<Sparse> = pairs.map(element).into_list();
    let transpose = |element: &Sparse| element.each(|(i, j, value)| (*j, *i, value.clone()));
    let transposed: Vec<Sparse> = symmetric.each(transpose);
    linear.chain(symmetric).chain(transposed).into_list()
}

/// (A −B; B A) with A = Eji − Eij, then with B = Eji + Eij, i < j, then with the diagonal matrices B that are given.
fn anti_hermitian(n: usize, diagonal: impl Iterator<Item = Sparse>) -> Vec<Sparse> {
    let real = |matrix: Sparse| -> Sparse {
        let lower: Sparse = matrix.each(|(i, j, value)| (n + i, n + j, value.clone()));
        matrix.into_iter().chain(lower).into_list()
    };
    let imaginary = |matrix: Sparse| -> Sparse {
        let upper: Sparse = matrix.each(|(i, j, value)| (*i, n + j, -value.clone()));
        let lower = matrix.into_iter().map(|(i, j, value)| (n + i, j, value));
        lower.chain(upper).into_list()
    };
    let turns = pairs(n).map(turn).map(real);
    let mixed = pairs(n).map(|(i, j)| imaginary(vec![one(j, i), one(i, j)]));
    turns.chain(mixed).chain(diagonal.map(imaginary)).into_list()
}

/// X_i = E1(1+i); Y_i = E(1+i)(n+2); Z = E1(n+2).
fn heisenberg(n: usize) -> Vec<Sparse> {
    let row = (1..=n).map(|i| vec![one(0, i)]);
    let column = (1..=n).map(|i| vec![one(i, n + 1)]);
    row.chain(column).chain([vec![one(0, n + 1)]]).into_list()
}
