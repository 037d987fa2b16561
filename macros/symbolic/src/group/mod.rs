//! Matrix Lie groups as data: all that the derivation needs to know of a group.
//!
//! The Lie algebra of a group is a sum of *blocks*. Each is a basis of matrices with a place in the matrices of the
//! group. For example, se(3) is so(3) in the upper left and R³ in the last column. Blocks are the units in which charts
//! are made and equations uncouple.

mod bases;
mod chart;
mod declared;
mod motion;
pub(crate) mod sample;
mod structure;

use std::rc::Rc;

use crate::algebra::Sparse;
use crate::{Algebra, Elements, Expr, Graph, IntoElements, IntoList, Property, Shape, integer};

pub use chart::Chart;
pub(crate) use declared::Definition;
pub use declared::{Span, reduce};
pub use motion::{conjugate, quaternion_product};

/// A Lie group, its elements matrices, vectors or unit quaternions.
#[derive(Copy, Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub enum Group {
    /// SO(n): RᵀR = I, det R = 1.
    SpecialOrthogonal(usize),
    /// SO(p, q): FᵀηF = η with η = diag(1 …, −1 …), the component of the identity.
    PseudoOrthogonal(usize, usize),
    /// SE(n): rotations and translations, (W b; 0 1).
    SpecialEuclidean(usize),
    /// Rⁿ with addition; elements are vectors.
    Translation(usize),
    /// GL(n): invertible matrices.
    GeneralLinear(usize),
    /// SL(n): det F = 1.
    SpecialLinear(usize),
    /// Sp(2n), by its matrix size 2n: FᵀΩF = Ω, Ω = (0 I; −I 0).
    Symplectic(usize),
    /// U(n) as real 2n×2n matrices (A −B; B A).
    Unitary(usize),
    /// SU(n), n > 2, as real 2n×2n matrices.
    SpecialUnitary(usize),
    /// SU(2): quaternions of length one, as the vector (i, j, k, w).
    UnitQuaternions,
    /// The Heisenberg group of dimension 2n + 1, upper unitriangular of size n + 2.
    Heisenberg(usize),
    /// Aff(n): (A b; 0 1) with A invertible.
    Affine(usize),
    /// Sim(n): (sR b; 0 1) with a positive s.
    Similarity(usize),
    /// A group that a user has declared.
    Declared(Declared),
}

/// A declared group: its place in the graph and its sizes.
#[derive(Copy, Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct Declared {
    index: u32,
    size: usize,
    dimension: usize,
}

/// A part of a Lie algebra: a basis and where its matrices stand in those of the group.
#[derive(Copy, Clone, PartialEq, Eq, Debug)]
pub struct Block {
    /// The basis.
    pub algebra: Algebra,
    /// The first row of its matrices.
    pub row: usize,
    /// Their first column.
    pub column: usize,
    /// The index of its first component among those of the group.
    pub offset: usize,
}

impl Group {
    /// The name that a declaration uses, `SO<3>`.
    pub fn name(self, graph: &Graph) -> String {
        match self {
            Group::Declared(declared) => graph.definition(declared).name.clone(),
            _ => {
                let (name, sizes) = self.symbol();
                let sizes: Vec<String> = sizes.each(usize::to_string);
                format!("{name}<{}>", sizes.join(", "))
            }
        }
    }

    /// The letters and the sizes of a built-in group.
    pub fn symbol(self) -> (&'static str, Vec<usize>) {
        let row = self.row();
        (row.name, row.sizes.into_iter().flatten().into_list())
    }

    /// Whether a user has declared it.
    pub fn is_declared(self) -> bool {
        matches!(self, Group::Declared(_))
    }

    /// The shape of the arrays that represent elements.
    pub fn element_shape(self) -> Shape {
        self.row().shape
    }

    /// The dimension m.
    pub fn dimension(self) -> usize {
        self.row().dimension
    }

    /// The property of every element.
    pub fn element_property(self) -> Property {
        match self {
            Group::SpecialOrthogonal(_) => Property::Orthogonal,
            Group::Translation(_) => Property::General,
            Group::UnitQuaternions => Property::Unit,
            _ => Property::Element(self),
        }
    }

    /// Whether elements are vectors under addition.
    pub fn is_translation(self) -> bool {
        matches!(self, Group::Translation(_))
    }

    /// Whether elements are orthogonal matrices.
    pub fn is_orthogonal(self) -> bool {
        matches!(self, Group::SpecialOrthogonal(_) | Group::Unitary(_) | Group::SpecialUnitary(_))
    }

    /// Whether elements are matrices of determinant one.
    pub(crate) fn is_special(self) -> bool {
        use Group::*;
        let by_determinant = matches!(self, SpecialLinear(_) | Symplectic(_) | SpecialUnitary(_) | Unitary(_));
        by_determinant || matches!(self, SpecialEuclidean(_) | Heisenberg(_))
    }

    /// Whether all elements have the entry of the identity here.
    pub fn has_entry_of_identity(self, i: usize, j: usize) -> bool {
        match self {
            // (1 xᵀ z; 0 I y; 0 0 1)
            Group::Heisenberg(n) => i >= j || i > 0 && j <= n,
            _ => self.linear_part() == Some(i),
        }
    }

    /// The size of the linear part of a group of matrices (A b; 0 1).
    pub fn linear_part(self) -> Option<usize> {
        match self {
            Group::SpecialEuclidean(n) | Group::Affine(n) | Group::Similarity(n) => Some(n),
            _ => None,
        }
    }
}

/// The data of a group that its sizes alone give.
struct Row {
    /// The letters.
    name: &'static str,
    /// The sizes that a declaration writes behind them.
    sizes: [Option<usize>; 2],
    /// The shape of the arrays that represent elements.
    shape: Shape,
    /// The dimension m.
    dimension: usize,
    /// The chart in which the implicit equation is solved, unless a declaration chooses another.
    chart: Chart,
}

impl Group {
    /// The row of a group. The row of a declared group has its sizes, and its graph has the other data.
    #[rustfmt::skip]
    fn row(self) -> Row {
        let turns = |n: usize| n * (n - 1) / 2;
        let (square, vector) = (Shape::square, Shape::vector);
        match self {
            Group::SpecialOrthogonal(n)   => row("SO", n,          square(n),     turns(n),         Chart::Cayley),
            Group::PseudoOrthogonal(p, q) => Row { sizes: [Some(p), Some(q)], ..row("SO", p, square(p + q), turns(p + q), Chart::Cayley) },
            Group::SpecialEuclidean(n)    => row("SE", n,          square(n + 1), turns(n) + n,     Chart::Product),
            Group::Translation(n)         => row("Translation", n, vector(n),     n,                Chart::Identity),
            Group::GeneralLinear(n)       => row("GL", n,          square(n),     n * n,            Chart::Affine),
            Group::SpecialLinear(2)       => row("SL", 2,          square(2),     3,                Chart::Cayley),
            Group::SpecialLinear(n)       => row("SL", n,          square(n),     n * n - 1,        Chart::Root),
            Group::Symplectic(n)          => row("Sp", n,          square(n),     n * (n + 1) / 2,  Chart::Cayley),
            Group::Unitary(n)             => row("U", n,           square(2 * n), n * n,            Chart::Cayley),
            Group::SpecialUnitary(n)      => row("SU", n,          square(2 * n), n * n - 1,        Chart::Exponential),
            Group::UnitQuaternions        => row("SU", 2,          vector(4),     3,                Chart::Cayley),
            Group::Heisenberg(n)          => row("Heisenberg", n,  square(n + 2), 2 * n + 1,        Chart::Affine),
            Group::Affine(n)              => row("Aff", n,         square(n + 1), n * n + n,        Chart::Affine),
            Group::Similarity(n)          => row("Sim", n,         square(n + 1), turns(n) + 1 + n, Chart::Product),
            Group::Declared(declared) => {
                let (shape, dimension) = (square(declared.size), declared.dimension);
                Row { name: "", sizes: [None, None], shape, dimension, chart: Chart::Exponential }
            }
        }
    }
}

fn row(name: &'static str, size: usize, shape: Shape, dimension: usize, chart: Chart) -> Row {
    Row { name, sizes: [Some(size), None], shape, dimension, chart }
}

impl Graph {
    /// The blocks of a group's Lie algebra, in the order of its components.
    pub fn blocks(&self, group: Group) -> Rc<[Block]> {
        if let Some(known) = self.blocks.borrow().get(&group) {
            return known.clone();
        }
        let made: Rc<[Block]> = bases::blocks(self, group).into();
        self.blocks.borrow_mut().insert(group, made.clone());
        made
    }

    /// The only basis of a group whose algebra is one block; by its first block otherwise.
    pub fn algebra_of(&self, group: Group) -> Algebra {
        self.blocks(group)[0].algebra
    }

    /// The basis of a group's Lie algebra, as matrices of the shape of its elements.
    pub fn elements(&self, group: Group) -> Vec<Sparse> {
        let placed = |block: &Block| -> Vec<Sparse> {
            let moved = |(i, j, value): &(usize, usize, _)| (i + block.row, j + block.column, Clone::clone(value));
            let basis = self.basis(block.algebra);
            basis.elements.each(|element| element.each(moved))
        };
        self.blocks(group).iter().flat_map(placed).into_list()
    }

    /// The basis of a group's Lie algebra as literal matrices.
    pub fn matrices(&self, group: Group) -> Vec<Expr<'_>> {
        let shape = group.element_shape();
        self.elements(group).into_each(|element| self.sparse_literal(shape, element))
    }

    /// (0 I; −I 0) of size 2n.
    pub(crate) fn symplectic_form(&self, size: usize) -> Expr<'_> {
        let n = size / 2;
        let entries = (0..n).flat_map(|i| [(i, n + i, integer(1)), (n + i, i, integer(-1))]);
        self.sparse_literal(Shape::square(size), entries)
    }

    /// diag(1 …, −1 …) with p ones.
    pub(crate) fn metric(&self, p: usize, q: usize) -> Expr<'_> {
        let entries = (0..p + q).map(|i| (i, i, integer(if i < p { 1 } else { -1 })));
        self.sparse_literal(Shape::square(p + q), entries)
    }
}
