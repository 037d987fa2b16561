//! Bases of vector spaces of matrices, Lie algebras above all: what v ↦ Σ v_i E_i and A ↦ ⟨A, E_i⟩ refer to.

use num_traits::{One, Zero};

use crate::{Expr, Graph, Rational, Shape, integer};

/// The entries (row, column, value) of a matrix that are not zero.
pub type Sparse = Vec<(usize, usize, Rational)>;

/// A basis E_1 … E_m of a space of matrices, known to a graph.
#[derive(Copy, Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct Algebra {
    index: u32,
    dimension: usize,
    shape: Shape,
    skew: bool,
    identification: bool,
}

/// What a graph keeps of a basis.
#[derive(PartialEq, Eq, Debug)]
pub struct Basis {
    /// The shape of the matrices.
    pub shape: Shape,
    /// E_1 … E_m.
    pub elements: Vec<Sparse>,
}

impl Algebra {
    /// The dimension m.
    pub fn dimension(self) -> usize {
        self.dimension
    }

    /// The shape of the matrices.
    pub fn matrix_shape(self) -> Shape {
        self.shape
    }

    /// Whether every element is a skew matrix.
    pub fn is_skew(self) -> bool {
        self.skew
    }

    /// Whether elements are their own coordinates: vectors in the unit basis.
    pub fn is_identification(self) -> bool {
        self.identification
    }
}

impl Graph {
    /// The handle of a basis; the same basis has the same handle.
    pub fn algebra(&self, shape: Shape, elements: Vec<Sparse>) -> Algebra {
        let basis = Basis { shape, elements };
        let (dimension, skew, identification) = (basis.elements.len(), basis.is_skew(), basis.is_identification());
        let index = self.basis_index(basis);
        Algebra { index, dimension, shape, skew, identification }
    }

    /// For each basis element its entries that are not zero.
    pub fn basis(&self, algebra: Algebra) -> std::rc::Rc<Basis> {
        self.basis_at(algebra.index)
    }

    /// The basis as literal matrices.
    pub fn basis_matrices(&self, algebra: Algebra) -> Vec<Expr<'_>> {
        self.basis(algebra).elements.iter().map(|element| self.sparse_literal(algebra.shape, element)).collect()
    }

    /// A literal matrix from its entries that are not zero.
    pub fn sparse_literal(&self, shape: Shape, entries: &Sparse) -> Expr<'_> {
        let mut dense = vec![Rational::zero(); shape.len()];
        for (i, j, value) in entries {
            dense[i * shape.columns + j] += value;
        }
        self.literal(shape, dense)
    }
}

impl Basis {
    /// G_ij = ⟨E_i, E_j⟩ = tr(E_iᵀE_j).
    pub fn gram(&self) -> Vec<Vec<Rational>> {
        let pairing = |a: &Sparse, b: &Sparse| {
            let mut sum = Rational::zero();
            for (i, j, value) in a {
                for (_, _, other) in b.iter().filter(|(k, l, _)| (k, l) == (i, j)) {
                    sum += value * other;
                }
            }
            sum
        };
        self.elements.iter().map(|a| self.elements.iter().map(|b| pairing(a, b)).collect()).collect()
    }

    /// The square ⟨E_i, E_i⟩ of the elements, if they are orthogonal to each other and equally long.
    pub fn uniform_gram(&self) -> Option<Rational> {
        let square_of =
            |element: &Sparse| element.iter().fold(Rational::zero(), |sum, (_, _, value)| sum + value * value);
        let square = square_of(self.elements.first()?);
        // those of large bases have no entry in common
        let mut places: Vec<(usize, usize)> = self.elements.iter().flatten().map(|(i, j, _)| (*i, *j)).collect();
        places.sort_unstable();
        let is_apart = places.windows(2).all(|pair| pair[0] != pair[1]);
        let fits = match is_apart {
            true => self.elements.iter().all(|element| square_of(element) == square),
            false => {
                let expected = |i: usize, j: usize| if i == j { square.clone() } else { Rational::zero() };
                let gram = self.gram();
                gram.iter().enumerate().all(|(i, row)| row.iter().enumerate().all(|(j, g)| *g == expected(i, j)))
            }
        };
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
