//! The structure constants of a Lie algebra: [E_i, E_j] = Σ c_ij^k E_k.

use std::collections::BTreeMap;

use super::Group;
use crate::algebra::Sparse;
use crate::{Algebra, Elements, Graph, IntoList, Rational, Shape, indexed, work};

/// A matrix, by its entries that may differ from zero.
type Entries = BTreeMap<(usize, usize), Rational>;

/// The entries of all elements of a basis, by their rows, by their columns and by both. Each has the number of its element.
/// Those by rows have their column, and those by columns have their row.
struct Places {
    by_row: Vec<Vec<(usize, usize, Rational)>>,
    by_column: Vec<Vec<(usize, usize, Rational)>>,
    by_place: BTreeMap<(usize, usize), Vec<(usize, Rational)>>,
}

impl Places {
    fn of(shape: Shape, elements: &[Sparse]) -> Places {
        let (by_row, by_column) = (vec![Vec::new(); shape.rows], vec![Vec::new(); shape.columns]);
        let mut places = Places { by_row, by_column, by_place: BTreeMap::new() };
        for (k, element) in elements.iter().enumerate() {
            for (i, j, value) in element {
                places.by_row[*i].push((k, *j, value.clone()));
                places.by_column[*j].push((k, *i, value.clone()));
                places.by_place.entry((*i, *j)).or_default().push((k, value.clone()));
            }
        }
        places
    }

    /// [E, E_j] for all j.
    fn brackets(&self, element: &Sparse, count: usize) -> Vec<Entries> {
        let mut brackets = vec![Entries::new(); count];
        for (row, column, value) in element {
            for (j, other, factor) in &self.by_row[*column] {
                *brackets[*j].entry((*row, *other)).or_insert_with(Rational::zero) += value * factor;
            }
            for (j, other, factor) in &self.by_column[*row] {
                *brackets[*j].entry((*other, *column)).or_insert_with(Rational::zero) -= value * factor;
            }
        }
        work::spend(brackets.iter().map(Entries::len).sum());
        brackets
    }

    /// ⟨A, E_k⟩ for all k.
    fn components(&self, matrix: &Entries, count: usize) -> Vec<Rational> {
        let mut components = vec![Rational::zero(); count];
        for (place, value) in matrix.iter().filter(|(_, value)| !value.is_zero()) {
            for (k, factor) in self.by_place.get(place).into_iter().flatten() {
                components[*k] += value * factor;
            }
        }
        work::spend(1 + count / 16);
        components
    }
}

impl Group {
    /// The algebra of the matrices of ad_{E_i}, for a group of matrices.
    pub(super) fn adjoint_algebra(self, graph: &Graph) -> Algebra {
        let (elements, m) = (graph.elements(self), self.dimension());
        let places = Places::of(self.element_shape(), &elements);
        let structure = |i: usize| -> Sparse {
            let brackets = places.brackets(&elements[i], m);
            let columns: Vec<Vec<Rational>> =
                brackets.each(|bracket| self.raised_numbers(graph, places.components(bracket, m)));
            let entries = Shape::square(m).positions().map(|(row, column)| (row, column, columns[column][row].clone()));
            entries.filter(|(_, _, value)| !value.is_zero()).into_list()
        };
        graph.algebra(Shape::square(m), indexed(m, structure))
    }

    /// G⁻¹m, block by block, of numbers.
    fn raised_numbers(self, graph: &Graph, components: Vec<Rational>) -> Vec<Rational> {
        let raised = |block: &super::Block| {
            let own = &components[block.offset..block.offset + block.algebra.dimension];
            graph.raised_numbers(block.algebra, own)
        };
        graph.blocks(self).iter().flat_map(raised).into_list()
    }
}
