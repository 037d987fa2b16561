//! Lie algebras of matrix groups: bases, in the documented order.

use crate::{Expr, Graph, Shape, integer};

/// The Lie algebra of a group, with its basis E_1 … E_m.
#[derive(Copy, Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub enum Algebra {
    /// so(n). For n = 3 the hat basis e1^, e2^, e3^; else Eji − Eij for i < j in the order (12) (13) … (n−1 n).
    SpecialOrthogonal(usize),
    /// Rⁿ with the unit vectors: elements and their coordinates are the same thing.
    Translation(usize),
}

impl Algebra {
    /// The dimension m.
    pub fn dimension(self) -> usize {
        match self {
            Algebra::SpecialOrthogonal(n) => n * (n - 1) / 2,
            Algebra::Translation(n) => n,
        }
    }

    /// The shape of the matrices that represent elements.
    pub fn matrix_shape(self) -> Shape {
        match self {
            Algebra::SpecialOrthogonal(n) => Shape::square(n),
            Algebra::Translation(n) => Shape::vector(n),
        }
    }

    /// Whether every element is a skew matrix.
    pub fn is_skew(self) -> bool {
        matches!(self, Algebra::SpecialOrthogonal(_))
    }

    /// Whether elements are their own coordinates.
    pub fn is_identification(self) -> bool {
        matches!(self, Algebra::Translation(_))
    }

    /// For each basis element its entries (row, column, value) that are not zero.
    pub fn sparse_basis(self) -> Vec<Vec<(usize, usize, i64)>> {
        match self {
            Algebra::SpecialOrthogonal(3) => {
                [(1, 2), (2, 0), (0, 1)].iter().map(|&(i, j)| vec![(j, i, 1), (i, j, -1)]).collect()
            }
            Algebra::SpecialOrthogonal(n) => {
                let pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
                pairs.map(|(i, j)| vec![(j, i, 1), (i, j, -1)]).collect()
            }
            Algebra::Translation(n) => (0..n).map(|i| vec![(i, 0, 1)]).collect(),
        }
    }

    /// The basis as literal matrices.
    pub fn basis(self, graph: &Graph) -> Vec<Expr<'_>> {
        let shape = self.matrix_shape();
        let dense = |entries: &Vec<(usize, usize, i64)>| {
            let value = |(i, j)| entries.iter().find(|&&(r, c, _)| (r, c) == (i, j)).map_or(0, |&(_, _, value)| value);
            graph.literal(shape, shape.positions().map(|position| integer(value(position))).collect())
        };
        self.sparse_basis().iter().map(dense).collect()
    }

    /// The square ⟨E_i, E_i⟩ of the basis elements, if they are orthogonal to each other and equally long.
    pub fn uniform_gram(self) -> Option<i64> {
        match self {
            Algebra::SpecialOrthogonal(_) => Some(2),
            Algebra::Translation(_) => Some(1),
        }
    }
}
