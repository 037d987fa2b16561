//! Bases of vector spaces of matrices, Lie algebras above all: vectors as matrices Σ v_i E_i, and the components ⟨A, E_i⟩ of matrices.

use std::rc::Rc;

use crate::memory::Map;
use crate::node::{ExprNode, Operation, Term};
use crate::{Elements, Expr, Graph, Group, IntoElements, IntoList, Rational, Shape, indexed, integer};

/// The entries (row, column, value) of a matrix that are not zero.
pub type Sparse = Vec<(usize, usize, Rational)>;

/// A basis E_1 … E_m of a space of matrices, known to a graph.
#[derive(Copy, Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct Algebra {
    index: u32,
    /// The dimension m.
    pub dimension: usize,
    /// The shape of the matrices.
    pub shape: Shape,
    /// Whether every element is a skew matrix.
    pub is_skew: bool,
    /// Whether elements are their own coordinates: vectors in the unit basis.
    pub is_identification: bool,
}

/// The data that a graph stores for a basis.
#[derive(PartialEq, Eq, Hash, Debug)]
pub struct Basis {
    /// The shape of the matrices.
    pub shape: Shape,
    /// E_1 … E_m.
    pub elements: Vec<Sparse>,
}

impl Graph {
    /// The handle of a basis; the same basis has the same handle.
    pub fn algebra(&self, shape: Shape, elements: Vec<Sparse>) -> Algebra {
        let basis = Basis { shape, elements };
        let dimension = basis.elements.len();
        let (is_skew, is_identification) = (basis.is_skew(), basis.is_identification());
        let index = self.bases.borrow_mut().intern(Rc::new(basis)).0 as u32;
        Algebra { index, dimension, shape, is_skew, is_identification }
    }

    /// For each basis element its entries that are not zero.
    pub fn basis(&self, algebra: Algebra) -> Rc<Basis> {
        self.bases.borrow().value(algebra.index as usize).clone()
    }

    /// The basis as literal matrices.
    pub fn basis_matrices(&self, algebra: Algebra) -> Vec<Expr<'_>> {
        let matrix = |element: &Sparse| self.sparse_literal(algebra.shape, element.iter().cloned());
        self.basis(algebra).elements.each(matrix)
    }
}

/// All entries of a matrix, row by row.
pub(crate) fn dense(shape: Shape, filled: impl IntoIterator<Item = (usize, usize, Rational)>) -> Vec<Rational> {
    let mut entries = vec![Rational::zero(); shape.len()];
    filled.into_iter().for_each(|(i, j, value)| entries[i * shape.columns + j] += value);
    entries
}

/// The inverse of the Gram matrix of a basis.
pub(crate) enum InverseGram {
    /// A multiple of the identity.
    Uniform(Rational),
    /// Any other, row by row.
    Rows(Vec<Vec<Rational>>),
}

impl InverseGram {
    fn of(basis: &Basis) -> InverseGram {
        if let Some(square) = basis.uniform_gram() {
            return InverseGram::Uniform(square.recip());
        }
        let gram = basis.gram();
        let count = gram.len();
        let unit = |i: usize, j: usize| if i == j { Rational::one() } else { Rational::zero() };
        let both = |(i, row): (usize, Vec<Rational>)| row.into_iter().chain((0..count).map(|j| unit(i, j))).into_list();
        let mut rows: Vec<Vec<Rational>> = gram.into_iter().enumerate().map(both).into_list();
        // the elements of a basis are independent, so the first half becomes the identity
        crate::reduce(&mut rows);
        InverseGram::Rows(rows.into_each(|row| row.into_iter().skip(count).into_list()))
    }
}

impl Basis {
    /// G_ij = ⟨E_i, E_j⟩ = tr(E_iᵀE_j).
    pub fn gram(&self) -> Vec<Vec<Rational>> {
        let pairing = |a: &Sparse, b: &Sparse| -> Rational {
            let product = |(i, j, value): &(usize, usize, Rational)| {
                let others = b.iter().filter(|(k, l, _)| (k, l) == (i, j));
                others.map(|(_, _, other)| value * other).sum::<Rational>()
            };
            a.iter().map(product).sum()
        };
        self.elements.each(|a| self.elements.each(|b| pairing(a, b)))
    }

    /// The square ⟨E_i, E_i⟩ of the elements, if they are orthogonal to each other and equally long.
    pub fn uniform_gram(&self) -> Option<Rational> {
        let square_of = |element: &Sparse| element.iter().map(|(_, _, value)| value * value).sum::<Rational>();
        let square = square_of(self.elements.first()?);
        // those of large bases have no entry in common
        let mut places: Vec<(usize, usize)> = self.elements.iter().flatten().map(|(i, j, _)| (*i, *j)).into_list();
        places.sort_unstable();
        let is_apart = places.windows(2).all(|pair| pair[0] != pair[1]);
        let are_orthogonal = || {
            let gram = self.gram();
            let positions = Shape::square(gram.len()).positions();
            positions.filter(|(i, j)| i != j).all(|(i, j)| gram[i][j].is_zero())
        };
        let fits = self.elements.iter().all(|element| square_of(element) == square) && (is_apart || are_orthogonal());
        fits.then_some(square)
    }

    fn is_skew(&self) -> bool {
        let mirrored = |element: &Sparse| {
            element.iter().all(|(i, j, value)| {
                i != j && element.iter().any(|(k, l, other)| (k, l) == (j, i) && *other == -value.clone())
            })
        };
        self.shape.is_square() && !self.shape.is_scalar() && self.elements.iter().all(mirrored)
    }

    fn is_identification(&self) -> bool {
        let unit = |(k, element): (usize, &Sparse)| *element == vec![(k, 0, Rational::one())];
        self.shape == Shape::vector(self.elements.len()) && self.elements.iter().enumerate().all(unit)
    }
}

pub(crate) fn unit_vectors(n: usize) -> Vec<Sparse> {
    indexed(n, |i| vec![(i, 0, integer(1))])
}

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

    /// v E_1 of a one-dimensional algebra, stored as one letter so that its products are known as those of v^.
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
                let components = plain.graph.basis(algebra).elements.each(component);
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
            _ => self.is_identity().then(|| self.shape().positions().map(one_at).into_list()),
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

    /// The same of numbers.
    pub(crate) fn raised_numbers(&self, algebra: Algebra, components: &[Rational]) -> Vec<Rational> {
        match &*self.inverse_gram(algebra) {
            InverseGram::Uniform(factor) => components.each(|component| component * factor),
            InverseGram::Rows(rows) => rows.each(|row| {
                let terms = components.iter().zip(row).filter(|(component, _)| !component.is_zero());
                terms.map(|(component, factor)| component * factor).sum()
            }),
        }
    }

    fn inverse_gram(&self, algebra: Algebra) -> Rc<InverseGram> {
        let known = self.inverse_grams.borrow().get(&algebra).cloned();
        known.unwrap_or_else(|| {
            let inverse = Rc::new(InverseGram::of(&self.basis(algebra)));
            self.inverse_grams.borrow_mut().insert(algebra, inverse.clone());
            inverse
        })
    }

    fn gram_matrix(&self, basis: &Basis) -> Expr<'_> {
        self.literal(Shape::square(basis.elements.len()), basis.gram().into_iter().flatten().into_list())
    }
}
