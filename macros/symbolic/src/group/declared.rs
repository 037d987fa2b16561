//! Groups that a user declares, by an equation or by a basis of the Lie algebra.

use num_traits::Zero;

use super::chart::Chart;
use super::{Declared, Group, sample};
use crate::algebra::Sparse;
use crate::node::Id;
use crate::{Algebra, Expr, Graph, Property, Rational, Role, Shape};

/// What a graph keeps of a declared group.
#[derive(Debug)]
pub struct Definition {
    pub(crate) name: String,
    pub(crate) algebra: Algebra,
    pub(crate) chart: Chart,
    /// An expression that vanishes on the group, and the symbol that stands for the element in it.
    equation: Option<(Id, Id)>,
}

impl Definition {
    /// The equation for an element; `None` for a group that is given by a basis.
    pub(crate) fn equation<'g>(&self, f: Expr<'g>) -> Vec<Expr<'g>> {
        let graph = f.graph();
        let at = |(equation, symbol)| graph.expr(equation).substitute(&[(graph.expr(symbol), f)]);
        self.equation.map(at).into_iter().collect()
    }
}

impl Group {
    /// The group of the matrices on which an expression in `symbol` vanishes, near the identity, with a basis of its Lie algebra.
    pub fn by_equation<'g>(
        graph: &'g Graph,
        name: &str,
        equation: Expr<'g>,
        symbol: Expr<'g>,
        basis: Vec<Sparse>,
    ) -> Group {
        declare(graph, name, symbol.shape(), basis, Some((equation.id, symbol.id)))
    }

    /// The group that a basis of a Lie algebra of matrices generates.
    pub fn by_basis(graph: &Graph, name: &str, shape: Shape, basis: Vec<Sparse>) -> Group {
        declare(graph, name, shape, basis, None)
    }
}

fn declare(graph: &Graph, name: &str, shape: Shape, basis: Vec<Sparse>, equation: Option<(Id, Id)>) -> Group {
    let algebra = graph.algebra(shape, basis);
    let definition = Definition { name: name.to_string(), algebra, chart: Chart::Exponential, equation };
    let declared = |definition: Definition| {
        let index = graph.keep_definition(definition);
        Group::Declared(Declared { index, size: shape.rows, dimension: algebra.dimension() })
    };
    // the chart is found for the group with the general one, and then kept with it
    let group = declared(definition);
    let chart = match () {
        () if graph.is_closed_under_products(algebra) => Chart::Affine,
        () if sample::is_cayley_tangent(graph, group) => Chart::Cayley,
        () => Chart::Exponential,
    };
    declared(Definition { name: name.to_string(), algebra, chart, equation })
}

impl Graph {
    /// The coordinates of a matrix in a basis; `None` if it is outside of the span.
    pub fn coordinates(&self, algebra: Algebra, matrix: &[Rational]) -> Option<Vec<Rational>> {
        let basis = self.basis(algebra);
        let (m, columns) = (algebra.dimension(), algebra.matrix_shape().columns);
        // one row for each entry of the matrices: the coefficients of the basis and the given value
        let mut rows = vec![vec![Rational::zero(); m + 1]; matrix.len()];
        for (k, element) in basis.elements.iter().enumerate() {
            element.iter().for_each(|(i, j, value)| rows[i * columns + j][k] += value);
        }
        rows.iter_mut().zip(matrix).for_each(|(row, value)| row[m] = value.clone());
        let pivots = reduce(&mut rows);
        let solvable = pivots.last().is_none_or(|&last| last < m);
        let mut coordinates = vec![Rational::zero(); m];
        pivots
            .iter()
            .zip(&rows)
            .filter(|(pivot, _)| **pivot < m)
            .for_each(|(&pivot, row)| coordinates[pivot] = row[m].clone());
        solvable.then_some(coordinates)
    }

    /// The bracket E_i E_j − E_j E_i of two basis elements, row by row.
    pub fn bracket(&self, algebra: Algebra, i: usize, j: usize) -> Vec<Rational> {
        let (forward, back) = (self.basis_product(algebra, i, j), self.basis_product(algebra, j, i));
        forward.into_iter().zip(back).map(|(a, b)| a - b).collect()
    }

    fn basis_product(&self, algebra: Algebra, i: usize, j: usize) -> Vec<Rational> {
        let basis = self.basis(algebra);
        let n = algebra.matrix_shape().columns;
        let mut product = vec![Rational::zero(); algebra.matrix_shape().len()];
        for (row, inner, left) in &basis.elements[i] {
            for (_, column, right) in basis.elements[j].iter().filter(|(other, ..)| other == inner) {
                product[row * n + column] += left * right;
            }
        }
        product
    }

    /// Whether products of basis elements lie in their span, so that I + Z stays in the group.
    pub fn is_closed_under_products(&self, algebra: Algebra) -> bool {
        let (m, span) = (algebra.dimension(), self.span(algebra));
        (0..m).all(|i| (0..m).all(|j| span.holds(&self.basis_product(algebra, i, j))))
    }

    /// The span of a basis.
    pub fn span(&self, algebra: Algebra) -> Span {
        let shape = algebra.matrix_shape();
        let dense = |element: &Sparse| {
            let mut row = vec![Rational::zero(); shape.len()];
            element.iter().for_each(|(i, j, value)| row[i * shape.columns + j] += value);
            row
        };
        Span::of(self.basis(algebra).elements.iter().map(dense).collect())
    }

    /// A new symbol for an element of a declared group's matrices.
    pub fn element_symbol(&self, name: &str, n: usize) -> Expr<'_> {
        self.symbol(name, Shape::square(n), Role::DeclaredElement, Property::General)
    }
}

/// A space of vectors, ready to be asked what lies in it.
pub struct Span {
    /// Rows in reduced echelon form, each with the column of its pivot.
    rows: Vec<(usize, Vec<Rational>)>,
}

impl Span {
    /// The span of some vectors.
    pub fn of(mut vectors: Vec<Vec<Rational>>) -> Span {
        let pivots = reduce(&mut vectors);
        Span { rows: pivots.into_iter().zip(vectors).collect() }
    }

    /// Whether a vector lies in the span.
    pub fn holds(&self, vector: &[Rational]) -> bool {
        let mut rest = vector.to_vec();
        for (pivot, row) in &self.rows {
            let factor = rest[*pivot].clone();
            if !factor.is_zero() {
                let others = rest.iter_mut().zip(row).filter(|(_, other)| !other.is_zero());
                others.for_each(|(entry, other)| *entry -= &factor * other);
            }
        }
        rest.iter().all(Rational::is_zero)
    }
}

/// The reduced row echelon form of a matrix; gives the columns of the pivots.
pub fn reduce(rows: &mut [Vec<Rational>]) -> Vec<usize> {
    let columns = rows.first().map_or(0, Vec::len);
    let mut pivots = Vec::new();
    for column in 0..columns {
        let rank = pivots.len();
        let Some(found) = (rank..rows.len()).find(|&row| !rows[row][column].is_zero()) else { continue };
        rows.swap(rank, found);
        let scale = rows[rank][column].recip();
        rows[rank].iter_mut().for_each(|entry| *entry *= &scale);
        let pivot = rows[rank].clone();
        for (_, row) in rows.iter_mut().enumerate().filter(|(index, _)| *index != rank) {
            let factor = row[column].clone();
            if !factor.is_zero() {
                let others = row.iter_mut().zip(&pivot).filter(|(_, other)| !other.is_zero());
                others.for_each(|(entry, other)| *entry -= &factor * other);
            }
        }
        pivots.push(column);
    }
    pivots
}
