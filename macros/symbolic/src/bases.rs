//! Vectors as matrices of an algebra, Σ v_i E_i, and the components ⟨A, E_i⟩ of matrices.

use num_traits::{One, Zero};

use crate::memory::Map;
use crate::node::{ExprNode, Operation, Term};
use crate::{Algebra, Basis, Expr, Graph, Group, Rational, Shape, Sparse};

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
        let shape = algebra.shape;
        if algebra.is_identification {
            return self;
        }
        if algebra.dimension == 1 {
            return self.wedge_of_scalar(algebra);
        }
        if let ExprNode::Literal(entries) = &*self.node() {
            let terms = self.graph.basis_matrices(algebra).into_iter().zip(entries);
            return terms.fold(self.graph.zero(shape), |sum, (element, entry)| sum + element.times(entry));
        }
        self.linear(shape, |plain| match &*plain.node() {
            ExprNode::Literal(_) if plain != self => plain.wedge(algebra),
            _ => plain.atom_of(Operation::Wedge(algebra), shape),
        })
    }

    /// v E_1 of a one-dimensional algebra, kept as one letter so that its products are known as those of v^.
    fn wedge_of_scalar(self, algebra: Algebra) -> Expr<'g> {
        let graph = self.graph;
        let shape = algebra.shape;
        self.terms().into_iter().fold(graph.zero(shape), |sum, Term { coefficient, scalars, word }| {
            let plain = graph.scalar(Term { coefficient: Rational::one(), scalars, word });
            let element = match plain.as_number() {
                Some(number) => graph.basis_matrices(algebra)[0].times(&number),
                None => plain.atom_of(Operation::Wedge(algebra), shape),
            };
            sum + element.times(&coefficient)
        })
    }

    /// The components ⟨A, E_i⟩ = tr(AᵀE_i) in the basis of the algebra.
    pub fn components(self, algebra: Algebra) -> Expr<'g> {
        let shape = Shape::vector(algebra.dimension);
        if algebra.is_identification {
            return self;
        }
        self.remembered(&self.graph.images(Map::Components(algebra)), || self.components_by_terms(algebra, shape))
    }

    fn components_by_terms(self, algebra: Algebra, shape: Shape) -> Expr<'g> {
        self.linear(shape, |plain| {
            if let ExprNode::Of(Operation::Wedge(other), inner) = &*plain.node()
                && *other == algebra
            {
                return plain.graph.lower(algebra, plain.graph.expr(*inner));
            }
            if let Some(entries) = plain.constant_entries() {
                let columns = algebra.shape.columns;
                let product = |(i, j, value): &(usize, usize, Rational)| &entries[i * columns + j] * value;
                let component = |element: &Sparse| element.iter().map(product).sum();
                let components = plain.graph.basis(algebra).elements.iter().map(component).collect();
                return plain.graph.literal(shape, components);
            }
            if !algebra.is_skew {
                return plain.atom_of(Operation::Components(algebra), shape);
            }
            // the components of a skew group see only the skew part: one of A and −Aᵀ stands for both
            let mut transposed = plain.transpose().factor();
            let sign = std::mem::replace(&mut transposed.coefficient, Rational::one());
            let transposed = plain.graph.collect(plain.shape(), [transposed]);
            if transposed == plain && sign.is_one() {
                plain.graph.zero(shape)
            } else if transposed.id < plain.id && sign.abs().is_one() {
                transposed.atom_of(Operation::Components(algebra), shape).times(&-sign)
            } else {
                plain.atom_of(Operation::Components(algebra), shape)
            }
        })
    }

    /// The entries of a literal or of the identity, row by row.
    fn constant_entries(self) -> Option<Vec<Rational>> {
        let one_at = |(i, j)| if i == j { Rational::one() } else { Rational::zero() };
        match &*self.node() {
            ExprNode::Literal(entries) => Some(entries.clone()),
            _ => self.is_identity().then(|| self.shape().positions().map(one_at).collect()),
        }
    }
}

impl Graph {
    /// Gξ for the coordinates ξ in a basis with Gram matrix G.
    fn lower<'g>(&'g self, algebra: Algebra, xi: Expr<'g>) -> Expr<'g> {
        let basis = self.basis(algebra);
        basis.uniform_gram().map_or_else(|| self.gram_matrix(&basis) * xi, |square| xi.times(&square))
    }

    /// G⁻¹m for the components m with respect to a basis with Gram matrix G.
    pub fn raise<'g>(&'g self, algebra: Algebra, mu: Expr<'g>) -> Expr<'g> {
        let basis = self.basis(algebra);
        basis.uniform_gram().map_or_else(|| self.gram_matrix(&basis).inverse() * mu, |square| mu.times(&square.recip()))
    }

    fn gram_matrix(&self, basis: &Basis) -> Expr<'_> {
        self.literal(Shape::square(basis.elements.len()), basis.gram().into_iter().flatten().collect())
    }
}
