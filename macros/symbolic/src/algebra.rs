//! Bases of vector spaces of matrices, Lie algebras above all: what v ↦ Σ v_i E_i and A ↦ ⟨A, E_i⟩ refer to.

use std::rc::Rc;

use num_traits::{One, Zero};

use crate::{Expr, Graph, Rational, Shape, integer};

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

/// What a graph keeps of a basis.
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
        let matrix = |element: &Sparse| self.literal(algebra.shape, dense(algebra.shape, element));
        self.basis(algebra).elements.iter().map(matrix).collect()
    }
}

/// All entries of a matrix, row by row.
pub(crate) fn dense(shape: Shape, element: &Sparse) -> Vec<Rational> {
    let mut entries = vec![Rational::zero(); shape.len()];
    element.iter().for_each(|(i, j, value)| entries[i * shape.columns + j] += value);
    entries
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
        self.elements.iter().map(|a| self.elements.iter().map(|b| pairing(a, b)).collect()).collect()
    }

    /// The square ⟨E_i, E_i⟩ of the elements, if they are orthogonal to each other and equally long.
    pub fn uniform_gram(&self) -> Option<Rational> {
        let square_of = |element: &Sparse| element.iter().map(|(_, _, value)| value * value).sum::<Rational>();
        let square = square_of(self.elements.first()?);
        // those of large bases have no entry in common
        let mut places: Vec<(usize, usize)> = self.elements.iter().flatten().map(|(i, j, _)| (*i, *j)).collect();
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

/// The unit vectors of Rⁿ.
pub(crate) fn unit_vectors(n: usize) -> Vec<Sparse> {
    (0..n).map(|i| vec![(i, 0, integer(1))]).collect()
}
