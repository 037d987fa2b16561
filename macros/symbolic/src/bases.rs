//! Vectors as matrices of an algebra, Σ v_i E_i, and the components ⟨A, E_i⟩ of matrices.

use num_traits::{One, Zero};

use crate::memory::Map;
use crate::node::{ExprNode, Term};
use crate::{Algebra, Expr, Graph, Group, Rational, Shape, integer};

impl<'g> Expr<'g> {
    /// The matrix of x ↦ a × x.
    pub fn hat(self) -> Expr<'g> {
        self.wedge(self.graph.algebra_of(Group::SpecialOrthogonal(3)))
    }

    /// a × b.
    pub fn cross(self, other: Expr<'g>) -> Expr<'g> {
        self.hat() * other
    }

    /// Σ v_i E_i in the basis of the algebra.
    pub fn wedge(self, algebra: Algebra) -> Expr<'g> {
        let shape = algebra.matrix_shape();
        if algebra.is_identification() {
            return self;
        }
        if algebra.dimension() == 1 {
            return self.wedge_of_scalar(algebra);
        }
        if let ExprNode::Literal(entries) = &*self.node() {
            let basis = self.graph.basis_matrices(algebra);
            let terms = entries.iter().zip(basis).map(|(entry, element)| element.times(entry));
            return terms.fold(self.graph.zero(shape), |sum, term| sum + term);
        }
        self.linear(shape, |plain| match &*plain.node() {
            ExprNode::Literal(_) if plain != self => plain.wedge(algebra),
            _ => plain.atom_of(ExprNode::Wedge(algebra, plain.id), shape),
        })
    }

    /// v E_1 of a one-dimensional algebra, kept as one letter so that its products are known as those of v^.
    fn wedge_of_scalar(self, algebra: Algebra) -> Expr<'g> {
        let graph = self.graph;
        let shape = algebra.matrix_shape();
        self.terms().into_iter().fold(graph.zero(shape), |sum, Term { coefficient, scalars, word }| {
            let plain = graph.collect(Shape::scalar(), [Term { coefficient: Rational::one(), scalars, word }]);
            let element = match plain.as_number() {
                Some(number) => graph.basis_matrices(algebra)[0].times(&number),
                None => self.atom_of(ExprNode::Wedge(algebra, plain.id), shape),
            };
            sum + element.times(&coefficient)
        })
    }

    /// The components ⟨A, E_i⟩ = tr(AᵀE_i) in the basis of the algebra.
    pub fn components(self, algebra: Algebra) -> Expr<'g> {
        let shape = Shape::vector(algebra.dimension());
        if algebra.is_identification() {
            return self;
        }
        self.remembered(&self.graph.images(Map::Components(algebra)), || self.components_by_terms(algebra, shape))
    }

    fn components_by_terms(self, algebra: Algebra, shape: Shape) -> Expr<'g> {
        self.linear(shape, |plain| {
            if let ExprNode::Wedge(other, inner) = &*plain.node()
                && *other == algebra
            {
                let (inner, basis) = (plain.graph.expr(*inner), plain.graph.basis(algebra));
                return match basis.uniform_gram() {
                    Some(square) => inner.times(&square),
                    None => {
                        let square = Shape::square(basis.elements.len());
                        plain.graph.literal(square, basis.gram().into_iter().flatten().collect()) * inner
                    }
                };
            }
            if let Some(entries) = plain.constant_entries() {
                return plain.graph.pairings(algebra, &entries);
            }
            if !algebra.is_skew() {
                return plain.atom_of(ExprNode::Components(algebra, plain.id), shape);
            }
            // the components of a skew group see only the skew part: one of A and −Aᵀ stands for both
            let Term { coefficient, scalars, word } = plain.transpose().factor();
            let sign = coefficient.clone();
            let word = plain.graph.collect(plain.shape(), [Term { coefficient: Rational::one(), scalars, word }]);
            match sign == integer(1) || sign == integer(-1) {
                true if word == plain && sign == integer(1) => plain.graph.zero(shape),
                true if word.id < plain.id => {
                    plain.atom_of(ExprNode::Components(algebra, word.id), shape).times(&-sign)
                }
                _ => plain.atom_of(ExprNode::Components(algebra, plain.id), shape),
            }
        })
    }

    /// The entries of a literal or of the identity, row by row.
    fn constant_entries(self) -> Option<Vec<Rational>> {
        let one_at = |(i, j)| if i == j { Rational::one() } else { Rational::zero() };
        match &*self.node() {
            ExprNode::Literal(entries) => Some(entries.clone()),
            _ if self.is_identity() => Some(self.shape().positions().map(one_at).collect()),
            _ => None,
        }
    }
}

impl Graph {
    /// ⟨A, E_i⟩ of a matrix of numbers.
    fn pairings(&self, algebra: Algebra, entries: &[Rational]) -> Expr<'_> {
        let columns = algebra.matrix_shape().columns;
        let component = |element: &crate::Sparse| -> Rational {
            element.iter().map(|(i, j, value)| &entries[i * columns + j] * value).sum()
        };
        let components = self.basis(algebra).elements.iter().map(component).collect();
        self.literal(Shape::vector(algebra.dimension()), components)
    }
}
