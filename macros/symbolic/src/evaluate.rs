//! Evaluation of expressions over any field of numbers: the oracle of the tests, and the basis of identity testing.

use crate::node::{Analytic, Exponent, ExprNode, Function, Id, Operation};
use crate::{Elements, Expr, Graph, IntoList, Rational, Shape, Sparse, Table, work};

/// A field of numbers with elementary functions.
pub trait Number: Copy + PartialEq {
    /// The image of a rational number.
    fn from_rational(value: &Rational) -> Self;
    /// The image of an integer.
    fn from_integer(value: i64) -> Self {
        Self::from_rational(&crate::integer(value))
    }
    /// Whether nothing of it is left. Numbers with infinitesimal parts may be equal to zero and have such parts.
    fn vanishes(self) -> bool {
        self == zero()
    }
    /// The sum.
    fn add(self, other: Self) -> Self;
    /// The product.
    fn multiply(self, other: Self) -> Self;
    /// The sum of the products of the numbers in a row with those of a column, which stand so far apart.
    fn dot(row: &[Self], column: &[Self], apart: usize) -> Self {
        let (mut sum, mut k): (Self, usize) = (zero(), 0);
        while k < row.len() {
            sum = sum.add(row[k].multiply(column[k * apart]));
            k += 1;
        }
        sum
    }
    /// The reciprocal.
    fn reciprocal(self) -> Self;
    /// A power whose exponent lies between zero and one.
    fn fractional_power(self, exponent: (i64, i64)) -> Self;
    /// An elementary function.
    fn function(self, function: Function) -> Self;
    /// A power series of a matrix.
    fn analytic(function: Analytic, argument: &Matrix<Self>) -> Matrix<Self>;
    /// The value of a method that is not known here.
    fn opaque(name: &str, output: usize, arguments: &[&Matrix<Self>], shape: Shape) -> Matrix<Self>;
    /// π.
    fn pi() -> Self;
}

impl Number for f64 {
    fn from_rational(value: &Rational) -> f64 {
        value.to_f64()
    }
    fn add(self, other: f64) -> f64 {
        self + other
    }
    fn multiply(self, other: f64) -> f64 {
        self * other
    }
    fn reciprocal(self) -> f64 {
        1.0 / self
    }
    fn fractional_power(self, (numerator, denominator): (i64, i64)) -> f64 {
        if (numerator, denominator) == (1, 2) { self.sqrt() } else { self.powf(numerator as f64 / denominator as f64) }
    }
    fn function(self, function: Function) -> f64 {
        match function {
            Function::Sin => self.sin(),
            Function::Cos => self.cos(),
            Function::Tan => self.tan(),
            Function::Asin => self.asin(),
            Function::Acos => self.acos(),
            Function::Atan => self.atan(),
            Function::Sinh => self.sinh(),
            Function::Cosh => self.cosh(),
            Function::Tanh => self.tanh(),
            Function::Exp => self.exp(),
            Function::Ln => self.ln(),
            Function::Stumpff(k) => stumpff(k, self),
        }
    }
    fn analytic(function: Analytic, argument: &Matrix<f64>) -> Matrix<f64> {
        if matches!(function, Analytic::Logarithm | Analytic::MotionLogarithm) {
            return Matrix::from_fn(argument.shape, |_| f64::NAN);
        }
        // the series themselves: this is for matrices of moderate size in tests
        let shift = if function == Analytic::Phi { 1 } else { 0 };
        let mut power = Matrix::scaled_identity(argument.shape.rows, 1.0);
        let mut sum = power.clone();
        for k in 1..120 {
            power = power.multiply(argument).scale(1.0 / f64::from(k + shift));
            sum.add_scaled(&power, 1.0);
        }
        sum
    }
    fn opaque(_: &str, _: usize, _: &[&Matrix<f64>], shape: Shape) -> Matrix<f64> {
        Matrix::from_fn(shape, |_| f64::NAN)
    }
    fn pi() -> f64 {
        std::f64::consts::PI
    }
}

/// Σ (−s)ʲ/(k + 2j)!.
fn stumpff(k: u8, s: f64) -> f64 {
    let mut term = (1..=u32::from(k)).fold(1.0, |product, factor| product / f64::from(factor));
    let mut sum = term;
    for j in 1..100 {
        let last = f64::from(u32::from(k) + 2 * j);
        term *= -s / (last * (last - 1.0));
        sum += term;
    }
    sum
}

pub(crate) type Values<K> = Table<Id, Matrix<K>>;

/// A matrix of numbers, row by row.
#[derive(Clone, PartialEq, Debug)]
pub struct Matrix<K> {
    /// Rows and columns.
    pub shape: Shape,
    /// The entries, row by row.
    pub entries: Vec<K>,
}

impl<K: Number> Matrix<K> {
    /// The matrix with these entries, row by row.
    pub fn new(shape: Shape, entries: Vec<K>) -> Matrix<K> {
        assert_eq!(shape.len(), entries.len(), "one number for each entry");
        Matrix { shape, entries }
    }

    /// The matrix whose entries a function gives.
    pub fn from_fn(shape: Shape, entry: impl FnMut((usize, usize)) -> K) -> Matrix<K> {
        work::spend(6 + shape.len() / 4);
        Matrix::new(shape, shape.positions().map(entry).into_list())
    }

    /// `scale` times the identity.
    pub fn scaled_identity(n: usize, scale: K) -> Matrix<K> {
        Matrix::from_fn(Shape::square(n), |(i, j)| if i == j { scale } else { zero() })
    }

    /// The entry in row i and column j.
    pub fn at(&self, i: usize, j: usize) -> K {
        self.entries[i * self.shape.columns + j]
    }

    pub(crate) fn zeros(shape: Shape) -> Matrix<K> {
        work::spend(6 + shape.len() / 4);
        Matrix::new(shape, vec![zero(); shape.len()])
    }

    pub(crate) fn add_at(&mut self, (row, column): (usize, usize), value: K) {
        let entry = &mut self.entries[row * self.shape.columns + column];
        *entry = entry.add(value);
    }

    pub(crate) fn add_scaled(&mut self, other: &Matrix<K>, factor: K) {
        let (sum, other, mut k) = (self.entries.as_mut_slice(), other.entries.as_slice(), 0);
        while k < sum.len() {
            sum[k] = sum[k].add(other[k].multiply(factor));
            k += 1;
        }
    }

    pub(crate) fn add_sparse(&mut self, element: &Sparse, factor: K) {
        for (i, j, value) in element {
            self.add_at((*i, *j), factor.multiply(K::from_rational(value)));
        }
    }

    pub(crate) fn scale(&self, factor: K) -> Matrix<K> {
        Matrix::new(self.shape, self.entries.each(|entry| entry.multiply(factor)))
    }

    /// The matrix product; a 1×1 factor scales.
    pub fn multiply(&self, other: &Matrix<K>) -> Matrix<K> {
        if self.shape.is_scalar() {
            return other.scale(self.entries[0]);
        }
        if other.shape.is_scalar() {
            return self.scale(other.entries[0]);
        }
        let (columns, shape) = (other.shape.columns, Shape::new(self.shape.rows, other.shape.columns));
        work::spend(10 + self.shape.len() * columns / 16 + shape.len() / 4);
        let mut entries = Vec::with_capacity(shape.len());
        for row in self.entries.chunks(self.shape.columns) {
            for j in 0..columns {
                entries.push(K::dot(row, &other.entries[j..], columns));
            }
        }
        Matrix::new(shape, entries)
    }

    /// The transpose.
    pub fn transpose(&self) -> Matrix<K> {
        Matrix::from_fn(self.shape.transposed(), |(i, j)| self.at(j, i))
    }

    fn trace(&self) -> K {
        (0..self.shape.rows).fold(zero(), |sum: K, i| sum.add(self.at(i, i)))
    }

    /// The inverse and the determinant, by elimination; the inverse of a singular matrix is made of reciprocals of zero.
    pub fn inverse(&self) -> (Matrix<K>, K) {
        let n = self.shape.rows;
        work::spend(40 + n * n * n / 8);
        // (A I) becomes (I A⁻¹)
        let unit = |i: usize| (0..n).map(move |j| if i == j { one() } else { zero() });
        let rows = self.entries.chunks(n).enumerate().flat_map(|(i, row)| row.iter().copied().chain(unit(i)));
        let mut both = Matrix::new(Shape::new(n, 2 * n), rows.into_list());
        let (pivots, determinant) = both.reduce(n);
        if pivots.len() < n {
            return (Matrix::new(self.shape, vec![zero::<K>().reciprocal(); n * n]), zero());
        }
        let entries = both.entries.chunks(2 * n).flat_map(|row| &row[n..]).copied().into_list();
        (Matrix::new(self.shape, entries), determinant)
    }

    /// Brings the first columns into reduced row echelon form. Gives the columns of the pivots and their product, with the sign of
    /// the exchange of rows.
    pub(crate) fn reduce(&mut self, columns: usize) -> (Vec<usize>, K) {
        let Shape { rows, columns: width } = self.shape;
        let mut pivots = Vec::new();
        let mut product: K = one();
        for column in 0..columns {
            let rank = pivots.len();
            let Some(found) = (rank..rows).find(|&row| self.at(row, column) != zero()) else { continue };
            if found != rank {
                product = negative(product);
                (0..width).for_each(|k| self.entries.swap(rank * width + k, found * width + k));
            }
            product = product.multiply(self.at(rank, column));
            let reciprocal = self.at(rank, column).reciprocal();
            let pivot = &mut self.entries[rank * width..][..width];
            pivot.iter_mut().for_each(|entry| *entry = entry.multiply(reciprocal));
            let pivot = pivot.to_vec();
            let pivot = pivot.as_slice();
            for (_, row) in self.entries.chunks_mut(width).enumerate().filter(|(row, _)| *row != rank) {
                if row[column].vanishes() {
                    continue;
                }
                let (factor, mut k) = (negative(row[column]), column);
                while k < width {
                    row[k] = row[k].add(pivot[k].multiply(factor));
                    k += 1;
                }
            }
            pivots.push(column);
        }
        (pivots, product)
    }
}

pub(crate) fn zero<K: Number>() -> K {
    K::from_integer(0)
}

pub(crate) fn one<K: Number>() -> K {
    K::from_integer(1)
}

pub(crate) fn negative<K: Number>(value: K) -> K {
    value.multiply(K::from_integer(-1))
}

impl<'g> Expr<'g> {
    /// The value where each symbol has the value that `values` gives it.
    pub fn evaluate<K: Number>(self, values: &mut impl FnMut(Expr<'g>) -> Matrix<K>) -> Matrix<K> {
        self.evaluate_with(&mut Values::default(), values)
    }

    /// The value, and those of all parts that are not known yet.
    pub(crate) fn evaluate_with<K: Number>(
        self,
        known: &mut Values<K>,
        values: &mut impl FnMut(Expr<'g>) -> Matrix<K>,
    ) -> Matrix<K> {
        for id in self.reachable_where(|id| !known.contains(&id)) {
            let expr = self.graph.expr(id);
            let is_symbol = matches!(&*expr.node(), ExprNode::Symbol(_));
            let value = if is_symbol { values(expr) } else { expr.evaluate_node(known) };
            known.insert(id, value);
        }
        known[&self.id].clone()
    }

    fn evaluate_node<K: Number>(self, known: &Values<K>) -> Matrix<K> {
        let shape = self.shape();
        let scalar = |value: K| Matrix::new(Shape::scalar(), vec![value]);
        let product = |word: &[Id]| {
            let (first, rest) = word.split_first()?;
            Some(rest.iter().fold(known[first].clone(), |product, letter| product.multiply(&known[letter])))
        };
        match &*self.node() {
            ExprNode::Symbol(_) => Matrix::zeros(shape),
            ExprNode::Pi => scalar(K::pi()),
            ExprNode::Literal(entries) => Matrix::new(shape, entries.each(K::from_rational)),
            ExprNode::Sum(terms) => {
                let mut sum = Matrix::zeros(shape);
                for term in terms {
                    let powers = term.scalars.iter().map(|(base, exponent)| power(known[base].entries[0], *exponent));
                    let scale = powers.fold(K::from_rational(&term.coefficient), K::multiply);
                    match term.word.as_slice() {
                        [] => (0..shape.rows).for_each(|i| sum.add_at((i, i), scale)),
                        [letter] => sum.add_scaled(&known[letter], scale),
                        word => product(word).iter().for_each(|word| sum.add_scaled(word, scale)),
                    }
                }
                sum
            }
            ExprNode::Stack(parts) => Matrix::new(shape, parts.each(|part| known[part].entries[0])),
            ExprNode::Word(word) => product(word).unwrap_or_else(|| scalar(one())),
            ExprNode::Trace(word) => scalar(product(word).map_or_else(zero, |matrix| matrix.trace())),
            ExprNode::Opaque(name, output, arguments) => {
                let arguments: Vec<&Matrix<K>> = arguments.each(|argument| &known[argument]);
                K::opaque(name, *output, &arguments, shape)
            }
            ExprNode::Hadamard(a, b) => Matrix::from_fn(shape, |(i, j)| known[a].at(i, j).multiply(known[b].at(i, j))),
            ExprNode::Of(operation, a) => self.evaluate_operation(*operation, &known[a]),
        }
    }

    fn evaluate_operation<K: Number>(self, operation: Operation, a: &Matrix<K>) -> Matrix<K> {
        let shape = self.shape();
        let scalar = |value: K| Matrix::new(Shape::scalar(), vec![value]);
        match operation {
            Operation::Transpose => a.transpose(),
            Operation::Inverse => a.inverse().0,
            Operation::Determinant => scalar(a.inverse().1),
            Operation::Function(function) => scalar(a.entries[0].function(function)),
            Operation::Analytic(function) => K::analytic(function, a),
            Operation::Block(row, column) => Matrix::from_fn(shape, |(i, j)| a.at(row + i, column + j)),
            Operation::Embed(row, column) => {
                let mut matrix = Matrix::zeros(shape);
                a.shape.positions().for_each(|(i, j)| matrix.add_at((row + i, column + j), a.at(i, j)));
                matrix
            }
            Operation::DiagonalMatrix => Matrix::from_fn(shape, |(i, j)| if i == j { a.at(i, 0) } else { zero() }),
            Operation::Diagonal => Matrix::from_fn(shape, |(i, _)| a.at(i, i)),
            Operation::Wedge(algebra) => {
                let mut matrix = Matrix::zeros(shape);
                for (element, x) in self.graph.basis(algebra).elements.iter().zip(&a.entries) {
                    matrix.add_sparse(element, *x);
                }
                matrix
            }
            Operation::Components(algebra) => {
                let product = |(i, j, value): &(usize, usize, Rational)| a.at(*i, *j).multiply(K::from_rational(value));
                let component = |element: &Sparse| element.iter().map(product).fold(zero(), K::add);
                Matrix::new(shape, self.graph.basis(algebra).elements.each(component))
            }
        }
    }
}

/// base^exponent: the integer part by multiplication, the fraction by the field's own root.
pub(crate) fn power<K: Number>(base: K, exponent: Exponent) -> K {
    if exponent.is_one() {
        return base;
    }
    let whole = exponent.floor();
    let (numerator, denominator) = exponent.parts();
    let factor = if whole < 0 { base.reciprocal() } else { base };
    let mut result = (0..whole.unsigned_abs()).fold(one(), |product: K, _| product.multiply(factor));
    if !exponent.is_integer() {
        result = result.multiply(base.fractional_power((numerator - whole * denominator, denominator)));
    }
    result
}

impl Graph {
    /// A symbol-free expression as a floating-point matrix.
    pub fn constant_value(&self, expr: Expr<'_>) -> Matrix<f64> {
        expr.evaluate(&mut |symbol| Matrix::from_fn(symbol.shape(), |_| f64::NAN))
    }
}
