//! Groups that a user declares, by an equation or by a basis of the Lie algebra.

use std::rc::Rc;

use super::chart::Chart;
use super::{Declared, Group, sample};
use crate::algebra::{Sparse, dense};
use crate::node::Id;
use crate::{Algebra, Elements, Expr, Graph, IntoList, Rational, Shape};

/// The data that a graph stores for a declared group.
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
        self.equation.map(at).into_iter().into_list()
    }
}

impl Group {
    /// The group of matrices that a basis of its Lie algebra generates. Near the identity it may be given by an
    /// expression and a symbol: the matrices at which the expression vanishes.
    pub fn declare<'g>(
        graph: &'g Graph,
        name: &str,
        shape: Shape,
        basis: Vec<Sparse>,
        equation: Option<(Expr<'g>, Expr<'g>)>,
    ) -> Group {
        let algebra = graph.algebra(shape, basis);
        let equation = equation.map(|(equation, symbol)| (equation.id, symbol.id));
        let declared = |chart: Chart| {
            let definition = Definition { name: name.to_string(), algebra, chart, equation };
            let mut definitions = graph.definitions.borrow_mut();
            definitions.push(Rc::new(definition));
            let index = definitions.len() as u32 - 1;
            Group::Declared(Declared { index, size: shape.rows, dimension: algebra.dimension })
        };
        // the chart is found for the group with the general one, and then stored with it
        let general = declared(Chart::Exponential);
        let span = graph.span(algebra);
        let is_in_algebra = |(i, j): (usize, usize)| span.holds(&graph.basis_product(algebra, i, j));
        // then I + Z stays in the group
        if Shape::square(algebra.dimension).positions().all(is_in_algebra) {
            declared(Chart::Affine)
        } else if sample::is_cayley_tangent(graph, general) {
            declared(Chart::Cayley)
        } else {
            general
        }
    }
}

impl Graph {
    pub(crate) fn definition(&self, declared: Declared) -> Rc<Definition> {
        self.definitions.borrow()[declared.index as usize].clone()
    }

    /// The bracket E_i E_j − E_j E_i of two basis elements, row by row.
    pub fn bracket(&self, algebra: Algebra, i: usize, j: usize) -> Vec<Rational> {
        let (forward, back) = (self.basis_product(algebra, i, j), self.basis_product(algebra, j, i));
        forward.into_iter().zip(back).map(|(a, b)| a - b).into_list()
    }

    fn basis_product(&self, algebra: Algebra, i: usize, j: usize) -> Vec<Rational> {
        let basis = self.basis(algebra);
        let n = algebra.shape.columns;
        let mut product = vec![Rational::zero(); algebra.shape.len()];
        for (row, inner, left) in &basis.elements[i] {
            for (_, column, right) in basis.elements[j].iter().filter(|(other, ..)| other == inner) {
                product[row * n + column] += left * right;
            }
        }
        product
    }

    /// The span of a basis.
    pub fn span(&self, algebra: Algebra) -> Span {
        let shape = algebra.shape;
        Span::of(self.basis(algebra).elements.each(|element| dense(shape, element.iter().cloned())))
    }
}

/// A space of vectors, prepared for tests of membership.
pub struct Span {
    /// Rows in reduced echelon form, each with the column of its pivot.
    rows: Vec<(usize, Vec<Rational>)>,
}

impl Span {
    /// The span of some vectors.
    pub fn of(mut vectors: Vec<Vec<Rational>>) -> Span {
        let pivots = reduce(&mut vectors);
        Span { rows: pivots.into_iter().zip(vectors).into_list() }
    }

    /// Whether a vector lies in the span.
    pub fn holds(&self, vector: &[Rational]) -> bool {
        let mut rest = vector.to_vec();
        self.rows.iter().for_each(|(pivot, row)| eliminate(&mut rest, row, *pivot));
        rest.iter().all(Rational::is_zero)
    }
}

/// Subtracts the multiple of a row, one at its pivot, with which another row is zero there.
fn eliminate(row: &mut [Rational], pivot_row: &[Rational], pivot: usize) {
    let factor = row[pivot].clone();
    if !factor.is_zero() {
        let others = row.iter_mut().zip(pivot_row).filter(|(_, other)| !other.is_zero());
        others.for_each(|(entry, other)| *entry -= &factor * other);
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
        let others = rows.iter_mut().enumerate().filter(|(index, _)| *index != rank);
        others.for_each(|(_, row)| eliminate(row, &pivot, column));
        pivots.push(column);
    }
    pivots
}
