//! Lowering of matrix expressions: a grid of scalars for each.

mod products;

use std::rc::Rc;

use clebsch_symbolic::{
    Algebra, Basis, Elements, Expr, Graph, IntoElements, IntoList, Operation, Property, Rational, Shape, Sparse,
    Symbol, View, WordTerm, integer,
};

use super::entries::{Grid, Scalar};
use super::scalar::{Callee, Input, Rate, Scalars};

impl<'g> Scalars {
    /// The scalars of an expression.
    pub fn grid(&mut self, expr: Expr<'g>) -> Rc<Grid> {
        if let Some(grid) = self.grids.get(&expr.position()) {
            return grid.clone();
        }
        let grid = Rc::new(self.transposed(expr).unwrap_or_else(|| self.lower(expr)));
        self.grids.insert(expr.position(), grid.clone());
        grid
    }

    /// The entries of a sum whose transpose is known. Its products of three and more letters would associate in another way, and be other
    /// scalars.
    fn transposed(&self, expr: Expr<'g>) -> Option<Grid> {
        let View::Sum(terms) = expr.view() else { return None };
        if !terms.iter().any(|term| term.word.len() > 2) {
            return None;
        }
        let known = self.grids.get(&expr.transpose().position())?;
        Some(Grid::from_fn(expr.shape(), |(i, j)| known.at(j, i)))
    }

    fn lower(&mut self, expr: Expr<'g>) -> Grid {
        let shape = expr.shape();
        match expr.view() {
            View::Symbol(symbol) => self.symbol(&symbol),
            View::Pi => Grid::scalar(self.pi()),
            View::Sum(terms) => self.terms(expr.graph(), shape, terms),
            View::Literal(entries) => Grid { shape, entries: entries.into_each(|entry| self.number(entry)) },
            View::Stack(entries) => Grid { shape, entries: entries.into_each(|entry| self.grid(entry).entries[0]) },
            View::Word(word) => self.word(&word),
            View::Trace(word) => {
                let product = self.word(&word);
                Grid::scalar(self.total((0..product.shape.rows).map(|i| product.at(i, i))))
            }
            View::Opaque(name, output, arguments) => {
                let arguments = arguments.into_each(|argument| self.grid(argument));
                let of = if output == 0 { Callee::Value } else { Callee::Gradient };
                self.call(of(name.to_string()), arguments, output.saturating_sub(1), shape)
            }
            View::Hadamard(a, b) => {
                let (a, b) = (self.grid(a), self.grid(b));
                Grid::from_fn(shape, |(i, j)| self.product([a.at(i, j), b.at(i, j)]))
            }
            View::Of(operation, a) => self.operation(operation, a, shape),
        }
    }

    fn operation(&mut self, operation: Operation, argument: Expr<'g>, shape: Shape) -> Grid {
        let a = self.grid(argument);
        match operation {
            Operation::Transpose => Grid::from_fn(shape, |(i, j)| a.at(j, i)),
            Operation::Inverse => {
                // I + Z with Z skew has no small pivots
                let z = argument - argument.graph().identity(a.shape.rows);
                let stable = (z + z.transpose()).is_zero();
                if a.shape.rows <= 3 || stable {
                    self.inverse(&a)
                } else {
                    self.call(Callee::Inverse, vec![a], 0, shape)
                }
            }
            Operation::Analytic(function) => self.call(Callee::Analytic(function), vec![a], 0, shape),
            Operation::Determinant => {
                let all: Vec<usize> = (0..a.shape.rows).into_list();
                Grid::scalar(self.determinant(&a, &all, &all))
            }
            Operation::Function(function) => Grid::scalar(self.function(function, a.entries[0])),
            Operation::Block(row, column) => Grid::from_fn(shape, |(i, j)| a.at(row + i, column + j)),
            Operation::Embed(row, column) => {
                let zero = self.zero();
                let inside = |i: usize, j: usize| {
                    i >= row && j >= column && i < row + a.shape.rows && j < column + a.shape.columns
                };
                Grid::from_fn(shape, |(i, j)| if inside(i, j) { a.at(i - row, j - column) } else { zero })
            }
            Operation::DiagonalMatrix => {
                let zero = self.zero();
                Grid::from_fn(shape, |(i, j)| if i == j { a.at(i, 0) } else { zero })
            }
            Operation::Diagonal => Grid::from_fn(shape, |(i, _)| a.at(i, i)),
            Operation::Wedge(algebra) => self.wedge(&argument.graph().basis(algebra), &a),
            Operation::Components(algebra) => self.components(&argument.graph().basis(algebra), &a),
        }
    }

    fn symbol(&mut self, symbol: &Symbol) -> Grid {
        let zero = self.zero();
        Grid::from_fn(symbol.shape, |(i, j)| match symbol.property {
            Property::Diagonal if i != j => zero,
            Property::Increment(group) if group.has_entry_of_identity(i, j) => zero,
            property if property.is_symmetric() => self.input(Input::of(symbol, i.min(j), i.max(j))),
            _ => self.input(Input::of(symbol, i, j)),
        })
    }

    fn wedge(&mut self, basis: &Basis, a: &Grid) -> Grid {
        let shape = basis.shape;
        let zero = self.zero();
        let mut matrix = Grid::from_fn(shape, |_| zero);
        for (k, entries) in basis.elements.iter().enumerate() {
            for (i, j, value) in entries {
                let entry = self.scale(a.at(k, 0), value.clone());
                matrix.entries[i * shape.columns + j] = self.total([matrix.at(*i, *j), entry]);
            }
        }
        matrix
    }

    fn components(&mut self, basis: &Basis, a: &Grid) -> Grid {
        let component =
            |entries: &Sparse| self.sum(integer(0), entries.iter().map(|(i, j, value)| (a.at(*i, *j), value.clone())));
        Grid::vector(basis.elements.each(component))
    }

    fn multiply(&mut self, a: &Grid, b: &Grid) -> Grid {
        Grid::from_fn(Shape::new(a.shape.rows, b.shape.columns), |(i, j)| {
            let factors = (0..a.shape.columns).map(|k| [a.at(i, k), b.at(k, j)]);
            let factors: Vec<_> = factors.filter(|pair| !pair.iter().any(|x| self.is_zero(*x))).into_list();
            let terms: Vec<Scalar> = factors.into_each(|pair| self.product(pair));
            self.total(terms)
        })
    }

    /// A sum of terms: components of one algebra are taken of the sum, constant letters are summed before they are multiplied.
    fn terms(&mut self, graph: &'g Graph, shape: Shape, terms: Vec<WordTerm<'g>>) -> Grid {
        let (mut under, rest) = by_components(terms, |_, _| true);
        under.sort_by_key(|(algebra, _)| *algebra);
        let mut grids = Vec::new();
        for (algebra, inner) in under {
            let matrix = self.gathered(algebra.shape, inner);
            grids.push(self.components(&graph.basis(algebra), &matrix));
        }
        grids.push(self.gathered(shape, rest));
        self.total_of(shape, &grids)
    }

    fn total_of(&mut self, shape: Shape, grids: &[Grid]) -> Grid {
        if let [only] = grids {
            return only.clone();
        }
        Grid::from_fn(shape, |(i, j)| self.total(grids.iter().map(|grid| grid.at(i, j))))
    }

    /// Whether an expression is fixed once per stepper.
    fn is_constant(&mut self, expr: Expr<'g>) -> bool {
        if let Some(known) = self.constant.get(&expr.position()) {
            return *known;
        }
        let is_constant = |symbol: Expr<'g>| symbol.role().is_some_and(|role| Rate::of(role) == Rate::Once);
        let found = expr.symbols().into_iter().all(is_constant);
        self.constant.insert(expr.position(), found);
        found
    }

    fn monomial(&mut self, coefficient: &Rational, scalars: &[(Expr<'g>, (i64, i64))]) -> Scalar {
        let mut factors = vec![self.number(coefficient.clone())];
        for (base, exponent) in scalars {
            let base = self.grid(*base).entries[0];
            factors.push(self.power(base, exponent.0, exponent.1));
        }
        self.product(factors)
    }

    fn scaled(&mut self, grid: &Grid, scale: Scalar) -> Grid {
        if self.as_number(scale).is_some_and(Rational::is_one) {
            return grid.clone();
        }
        Grid::from_fn(grid.shape, |(i, j)| self.product([scale, grid.at(i, j)]))
    }

    fn scaled_identity(&mut self, n: usize, scale: Scalar) -> Grid {
        let zero = self.zero();
        Grid::from_fn(Shape::square(n), |(i, j)| if i == j { scale } else { zero })
    }

    /// The inverse: by cofactors up to 3×3, by elimination without pivoting beyond. Elimination is stable for the
    /// matrices I ± Z with Z skew that arise in the Cayley chart.
    fn inverse(&mut self, a: &Grid) -> Grid {
        let n = a.shape.rows;
        if n <= 3 {
            let all: Vec<usize> = (0..n).into_list();
            let determinant = self.determinant(a, &all, &all);
            let reciprocal = self.reciprocal(determinant);
            return Grid::from_fn(a.shape, |(i, j)| {
                let cofactor = self.determinant(a, &without(&all, j), &without(&all, i));
                let sign = integer(if (i + j) % 2 == 0 { 1 } else { -1 });
                let signed = self.scale(cofactor, sign);
                self.product([signed, reciprocal])
            });
        }
        let one = self.number(integer(1));
        let (mut left, mut right) = (a.clone(), self.scaled_identity(n, one));
        for k in 0..n {
            let reciprocal = self.reciprocal(left.at(k, k));
            for j in 0..n {
                left.entries[k * n + j] = self.product([reciprocal, left.at(k, j)]);
                right.entries[k * n + j] = self.product([reciprocal, right.at(k, j)]);
            }
            for i in (0..n).filter(|&i| i != k) {
                let factor = left.at(i, k);
                for j in 0..n {
                    left.entries[i * n + j] = self.reduced(left.at(i, j), factor, left.at(k, j));
                    right.entries[i * n + j] = self.reduced(right.at(i, j), factor, right.at(k, j));
                }
            }
        }
        right
    }

    fn reduced(&mut self, entry: Scalar, factor: Scalar, pivot: Scalar) -> Scalar {
        let product = self.product([factor, pivot]);
        self.sum(integer(0), [(entry, integer(1)), (product, integer(-1))])
    }

    fn determinant(&mut self, a: &Grid, rows: &[usize], columns: &[usize]) -> Scalar {
        let [column, columns @ ..] = columns else { return self.number(integer(1)) };
        let mut terms = Vec::new();
        for (position, &row) in rows.iter().enumerate() {
            let minor = self.determinant(a, &without(rows, row), columns);
            let sign = integer(if position % 2 == 0 { 1 } else { -1 });
            terms.push((self.product([a.at(row, *column), minor]), sign));
        }
        self.sum(integer(0), terms)
    }
}

fn without(indices: &[usize], index: usize) -> Vec<usize> {
    indices.iter().copied().filter(|&other| other != index).into_list()
}

/// Terms by the bases whose components they are, in the order in which these come, and the other terms; for components that are meant.
#[allow(clippy::type_complexity)]
pub(super) fn by_components<'g>(
    terms: Vec<WordTerm<'g>>,
    is_meant: impl Fn(Algebra, Expr<'g>) -> bool,
) -> (Vec<(Algebra, Vec<WordTerm<'g>>)>, Vec<WordTerm<'g>>) {
    let mut under: Vec<(Algebra, Vec<WordTerm<'g>>)> = Vec::new();
    let mut rest = Vec::new();
    for term in terms {
        let letter = if let [letter] = term.word[..] { Some(letter.view()) } else { None };
        match letter {
            Some(View::Of(Operation::Components(algebra), inner)) if is_meant(algebra, inner) => {
                let inner = term.over(inner);
                match under.iter_mut().find(|(other, _)| *other == algebra) {
                    Some((_, terms)) => terms.extend(inner),
                    None => under.push((algebra, inner)),
                }
            }
            _ => rest.push(term),
        }
    }
    (under, rest)
}
