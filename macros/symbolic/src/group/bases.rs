//! The documented bases of the built-in groups.

use super::{Block, Group};
use crate::algebra::{Sparse, unit_vectors};
use crate::{Graph, Rational, Shape, integer, rational};

/// The blocks of a built-in group.
pub(super) fn blocks(graph: &Graph, group: Group) -> Vec<Block> {
    let whole = |elements: Vec<Sparse>| vec![(group.element_shape(), elements, 0, 0)];
    let column = |n: usize| (Shape::vector(n), unit_vectors(n), 0, n);
    let parts = match group {
        Group::SpecialOrthogonal(n) => whole(rotations(n)),
        Group::PseudoOrthogonal(p, q) => whole(pseudo_rotations(p, q)),
        Group::SpecialEuclidean(n) => vec![(Shape::square(n), rotations(n), 0, 0), column(n)],
        Group::Similarity(n) => {
            let dilation = vec![(0..n).map(|i| (i, i, integer(1))).collect()];
            vec![(Shape::square(n), rotations(n), 0, 0), (Shape::square(n), dilation, 0, 0), column(n)]
        }
        Group::Affine(n) => vec![(Shape::square(n), entries(n), 0, 0), column(n)],
        Group::Translation(n) => whole(unit_vectors(n)),
        Group::GeneralLinear(n) => whole(entries(n)),
        Group::SpecialLinear(n) => whole(traceless(n)),
        Group::Symplectic(n) => whole(hamiltonian(n / 2)),
        Group::Unitary(n) => whole(anti_hermitian(n, (0..n).map(|i| vec![(i, i, integer(1))]).collect())),
        Group::SpecialUnitary(n) => {
            let differences = (1..n).map(|i| vec![(i - 1, i - 1, integer(1)), (i, i, integer(-1))]).collect();
            whole(anti_hermitian(n, differences))
        }
        Group::UnitQuaternions => whole((0..3).map(|i| vec![(i, 0, rational(1, 2))]).collect()),
        Group::Heisenberg(n) => whole(heisenberg(n)),
        Group::Declared(declared) => {
            return vec![Block { algebra: graph.definition(declared).algebra, row: 0, column: 0, offset: 0 }];
        }
    };
    let mut offset = 0;
    let block = |(shape, elements, row, column): (Shape, Vec<Sparse>, usize, usize)| {
        let block = Block { algebra: graph.algebra(shape, elements), row, column, offset };
        offset += block.algebra.dimension();
        block
    };
    parts.into_iter().filter(|(_, elements, ..)| !elements.is_empty()).map(block).collect()
}

fn pairs(n: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..n).flat_map(move |i| (i + 1..n).map(move |j| (i, j)))
}

/// e1^, e2^, e3^ for n = 3, else Eji − Eij for i < j in the order (12) (13) … (n−1 n).
fn rotations(n: usize) -> Vec<Sparse> {
    let turn = |(i, j)| vec![(j, i, integer(1)), (i, j, integer(-1))];
    match n {
        3 => [(1, 2), (2, 0), (0, 1)].into_iter().map(turn).collect(),
        _ => pairs(n).map(turn).collect(),
    }
}

/// Eji − η_i η_j Eij for i < j.
fn pseudo_rotations(p: usize, q: usize) -> Vec<Sparse> {
    let sign = |i: usize, j: usize| integer(if (i < p) == (j < p) { -1 } else { 1 });
    pairs(p + q).map(|(i, j)| vec![(j, i, integer(1)), (i, j, sign(i, j))]).collect()
}

/// Eij by rows.
fn entries(n: usize) -> Vec<Sparse> {
    Shape::square(n).positions().map(|(i, j)| vec![(i, j, integer(1))]).collect()
}

/// Eii − E(i+1)(i+1), then Eij for i ≠ j by rows.
fn traceless(n: usize) -> Vec<Sparse> {
    let diagonal = (1..n).map(|i| vec![(i - 1, i - 1, integer(1)), (i, i, integer(-1))]);
    let others = Shape::square(n).positions().filter(|(i, j)| i != j).map(|(i, j)| vec![(i, j, integer(1))]);
    diagonal.chain(others).collect()
}

/// Eij − E(n+j)(n+i) by rows; Ei(n+j) + Ej(n+i), once if i = j, for j ≤ i; their transposes.
fn hamiltonian(n: usize) -> Vec<Sparse> {
    let linear = Shape::square(n).positions().map(|(i, j)| vec![(i, j, integer(1)), (n + j, n + i, integer(-1))]);
    let symmetric: Vec<Sparse> = (0..n)
        .flat_map(|i| (0..=i).map(move |j| (i, j)))
        .map(|(i, j)| match i == j {
            true => vec![(i, n + j, integer(1))],
            false => vec![(i, n + j, integer(1)), (j, n + i, integer(1))],
        })
        .collect();
    let transpose = |element: &Sparse| element.iter().map(|(i, j, value)| (*j, *i, value.clone())).collect();
    let transposed: Vec<Sparse> = symmetric.iter().map(transpose).collect();
    linear.chain(symmetric).chain(transposed).collect()
}

/// (A −B; B A) with A = Eji − Eij, then with B = Eji + Eij, i < j, then with the diagonal matrices B that are given.
fn anti_hermitian(n: usize, diagonal: Vec<Sparse>) -> Vec<Sparse> {
    let real = |matrix: Sparse| -> Sparse {
        let lower: Sparse = matrix.iter().map(|(i, j, value)| (n + i, n + j, value.clone())).collect();
        matrix.into_iter().chain(lower).collect()
    };
    let imaginary = |matrix: Sparse| -> Sparse {
        let negated = |value: &Rational| -value.clone();
        let upper: Sparse = matrix.iter().map(|(i, j, value)| (*i, n + j, negated(value))).collect();
        let lower = matrix.iter().map(|(i, j, value)| (n + i, *j, value.clone()));
        lower.chain(upper).collect()
    };
    let turns = rotations_by_pairs(n).into_iter().map(real);
    let mixed = pairs(n).map(|(i, j)| imaginary(vec![(j, i, integer(1)), (i, j, integer(1))]));
    turns.chain(mixed).chain(diagonal.into_iter().map(imaginary)).collect()
}

fn rotations_by_pairs(n: usize) -> Vec<Sparse> {
    pairs(n).map(|(i, j)| vec![(j, i, integer(1)), (i, j, integer(-1))]).collect()
}

/// X_i = E1(1+i); Y_i = E(1+i)(n+2); Z = E1(n+2).
fn heisenberg(n: usize) -> Vec<Sparse> {
    let (x, y) = ((1..=n).map(|i| vec![(0, i, integer(1))]), (1..=n).map(move |i| vec![(i, n + 1, integer(1))]));
    x.chain(y).chain([vec![(0, n + 1, integer(1))]]).collect()
}
