//! Lowering to matrix code: a statement for each operation on matrices, for systems that are too large to be unrolled.
//!
//! The expressions are those of unrolled code. This module makes the decisions of a writer of matrix code. It orders
//! the factors of products and finds letters that sums of products have in common. Some products never need their
//! matrix, such as Zv, or ⟨abᵀ, E⟩ for rotations.

mod blocks;
mod hoisting;
mod words;

use clebsch_symbolic::{
    Algebra, Elements, Expr, Fraction, Function, Graph, Group, Interner, IntoElements, IntoList, Operation, Rational,
    Role, Shape, Symbol, Table, View, WordTerm, indexed, integer, work,
};

use super::grid::by_components;
use super::signs;
use super::{Code, Cost, Input, Kernel, MatrixOperation};
use blocks::{times, total};
pub(super) use hoisting::hoisted;
use words::{Weighted, cheapest_cut, common_letter};

/// One output for each expression.
pub(super) fn kernel(expressions: &[Expr<'_>]) -> Kernel {
    Matrices::default().kernel(|lowering| lowering.each(expressions))
}

/// The same for a person to read: as few statements as there are shared terms, and matrices of blocks entry by entry.
pub(super) fn short_kernel(expressions: &[Expr<'_>]) -> Kernel {
    short(|lowering| lowering.each(expressions))
}

/// Vectors as one.
pub(super) fn below<'g>(vectors: &[Expr<'g>]) -> Vec<Expr<'g>> {
    vectors.first().map(|first| first.graph().below(vectors)).into_iter().into_list()
}

/// Numbers, one after the other in one output, for a person to read.
pub(super) fn short_list(expressions: &[Expr<'_>]) -> Kernel {
    short(|lowering| vec![column(expressions.each(|&expr| lowering.value(expr)))])
}

fn short(outputs: impl FnOnce(&mut Matrices) -> Vec<(Shape, Vec<Code>)>) -> Kernel {
    let lowering = Matrices { joins_blocks: true, ..Matrices::default() };
    lowering.kernel(outputs).without_unused().nested()
}

/// The largest entry of each expression, in one output.
pub(super) fn largest(expressions: &[Expr<'_>]) -> Kernel {
    Matrices::default().kernel(|lowering| {
        let largest = expressions.iter().map(|&expr| {
            if expr.shape().is_scalar() {
                lowering.value(expr)
            } else {
                lowering.of_matrix(MatrixOperation::Largest, expr, Shape::scalar())
            }
        });
        vec![column(largest.into_list())]
    })
}

fn column(entries: Vec<Code>) -> (Shape, Vec<Code>) {
    (Shape::vector(entries.len()), entries)
}

/// The state of lowering one kernel.
#[derive(Default)]
struct Matrices {
    /// Shared terms, each of them once.
    locals: Interner<Code>,
    known: Table<usize, Code>,
    /// Whether matrices that are made of blocks are written entry by entry.
    joins_blocks: bool,
}

impl Matrices {
    fn kernel(mut self, outputs: impl FnOnce(&mut Matrices) -> Vec<(Shape, Vec<Code>)>) -> Kernel {
        let outputs = outputs(&mut self);
        signs::moved(Kernel { locals: self.locals.into_values(), outputs }, true)
    }

    fn each(&mut self, expressions: &[Expr<'_>]) -> Vec<(Shape, Vec<Code>)> {
        expressions.each(|&expr| (expr.shape(), vec![self.value(expr)]))
    }

    /// The code of an expression: a scalar if it is 1×1, else a matrix.
    fn value(&mut self, expr: Expr<'_>) -> Code {
        if let Some(known) = self.known.get(&expr.position()) {
            return known.clone();
        }
        let code = self.made(expr);
        let code = self.shared(code);
        self.known.insert(expr.position(), code.clone());
        code
    }

    /// The code as a shared term, unless it is simply read; the same code is one term.
    fn shared(&mut self, code: Code) -> Code {
        work::spend(40);
        let is_read = match &code {
            Code::Read(_) | Code::Number(_) | Code::Pi | Code::Local(_) => true,
            Code::Whole(whole) => matches!(whole.operation, MatrixOperation::Argument(_)),
            _ => false,
        };
        if is_read {
            return code;
        }
        Code::Local(self.locals.intern(code).0)
    }

    fn operation(&mut self, operation: MatrixOperation, operands: Vec<Code>, shape: Shape) -> Code {
        let first = operands.first().map_or(Shape::scalar(), |operand| self.shape(operand));
        let cost = operation.cost(shape, first);
        self.shared(Code::whole(operation, operands, shape, cost))
    }

    fn shape(&self, code: &Code) -> Shape {
        self.operation_of(code).map_or(Shape::scalar(), |whole| whole.shape)
    }

    /// Expressions are deep: each kind has a function of its own, so that this one has little on the stack.
    fn made(&mut self, expr: Expr<'_>) -> Code {
        let (shape, graph) = (expr.shape(), expr.graph());
        match expr.view() {
            View::Symbol(symbol) => argument(&symbol),
            View::Pi => Code::Pi,
            View::Sum(terms) if shape.is_scalar() => self.scalar_sum(terms),
            View::Sum(terms) => self.sum(graph, shape, terms),
            View::Literal(entries) => self.entries(shape, entries.into_each(Code::Number)),
            View::Stack(entries) => self.stack(&entries, shape),
            View::Word(word) => self.scalar_word(&word),
            View::Trace(word) => self.trace(&word),
            View::Opaque(_, output, arguments) => self.opaque(output, &arguments, shape),
            View::Hadamard(a, b) => self.hadamard(a, b, shape),
            View::Of(operation, a) => self.made_of(operation, a, shape),
        }
    }

    fn made_of(&mut self, operation: Operation, a: Expr<'_>, shape: Shape) -> Code {
        let graph = a.graph();
        match operation {
            Operation::Function(function) => self.function(function, a),
            Operation::Block(row, column) => self.block(a, row, column, shape),
            Operation::Embed(row, column) if self.joins_blocks => self.embedded(a, (row, column), shape),
            Operation::Wedge(algebra) => self.wedge(graph, algebra, a, shape),
            Operation::Components(algebra) => {
                let outer = self.outer(graph, algebra, a);
                outer.unwrap_or_else(|| self.components_of(graph, algebra, a))
            }
            operation => self.of_matrix(MatrixOperation::Of(operation), a, shape),
        }
    }

    fn of_matrix(&mut self, operation: MatrixOperation, a: Expr<'_>, shape: Shape) -> Code {
        let a = self.value(a);
        self.operation(operation, vec![a], shape)
    }

    fn stack(&mut self, entries: &[Expr<'_>], shape: Shape) -> Code {
        let entries = entries.each(|&entry| self.value(entry));
        self.entries(shape, entries)
    }

    fn function(&mut self, function: Function, a: Expr<'_>) -> Code {
        Code::Function(function, Box::new(self.value(a)))
    }

    fn opaque(&mut self, output: usize, arguments: &[Expr<'_>], shape: Shape) -> Code {
        let arguments: Vec<Code> = arguments.each(|&argument| self.value(argument));
        let operation = if output == 0 { MatrixOperation::Value } else { MatrixOperation::Gradient(output - 1) };
        self.operation(operation, arguments, shape)
    }

    fn hadamard(&mut self, a: Expr<'_>, b: Expr<'_>, shape: Shape) -> Code {
        let operands = vec![self.value(a), self.value(b)];
        if shape.is_scalar() {
            return Code::Product(operands);
        }
        self.operation(MatrixOperation::Hadamard, operands, shape)
    }

    fn components_of(&mut self, graph: &Graph, algebra: Algebra, a: Expr<'_>) -> Code {
        let a = self.value(a);
        self.components(graph, algebra, a)
    }

    fn entries(&mut self, shape: Shape, entries: Vec<Code>) -> Code {
        self.operation(MatrixOperation::Entries, entries, shape)
    }

    fn block(&mut self, a: Expr<'_>, row: usize, column: usize, shape: Shape) -> Code {
        // an entry of an argument is read
        if shape.is_scalar()
            && let Some(symbol) = a.as_symbol()
        {
            return Code::Read(Input::of(&symbol, row, column));
        }
        let value = self.value(a);
        if shape.is_scalar() {
            return self.entry(&value, row, column);
        }
        self.operation(MatrixOperation::Of(Operation::Block(row, column)), vec![value], shape)
    }

    /// Σ x_k E_k, entry by entry where the basis has no function of its own.
    fn wedge(&mut self, graph: &Graph, algebra: Algebra, x: Expr<'_>, shape: Shape) -> Code {
        if is_rotations(graph, algebra) {
            return self.of_matrix(MatrixOperation::Skew, x, shape);
        }
        if is_hat(graph, algebra) {
            return self.of_matrix(MatrixOperation::Hat, x, shape);
        }
        let (x, basis) = (self.value(x), graph.basis(algebra));
        let mut entries = vec![Vec::new(); shape.len()];
        for (k, element) in basis.elements.iter().enumerate() {
            for (i, j, value) in element {
                let x = if algebra.dimension == 1 { x.clone() } else { self.entry(&x, k, 0) };
                entries[i * shape.columns + j].push((value.clone(), x));
            }
        }
        let entries = entries.into_each(|terms| linear(integer(0), terms));
        self.entries(shape, entries)
    }

    fn components(&mut self, graph: &Graph, algebra: Algebra, a: Code) -> Code {
        let shape = Shape::vector(algebra.dimension);
        if is_rotations(graph, algebra) {
            return self.operation(MatrixOperation::SkewComponents, vec![a], shape);
        }
        if is_hat(graph, algebra) && !(self.joins_blocks && self.is_read(&a)) {
            return self.operation(MatrixOperation::Axial, vec![a], shape);
        }
        let basis = graph.basis(algebra);
        let component = |element: &clebsch_symbolic::Sparse| {
            let terms = element.each(|(i, j, value)| (value.clone(), self.entry(&a, *i, *j)));
            total(terms)
        };
        let components: Vec<Code> = basis.elements.each(component);
        match components.len() {
            1 => components.into_iter().next().unwrap_or(Code::Number(integer(0))),
            _ => self.entries(shape, components),
        }
    }

    /// ⟨abᵀ, E⟩ of rotations, without the matrix.
    fn outer(&mut self, graph: &Graph, algebra: Algebra, a: Expr<'_>) -> Option<Code> {
        let (word, cut) = outer_product(graph, algebra, a)?;
        let row: Vec<Expr<'_>> = word[cut..].iter().rev().map(|letter| letter.transpose()).into_list();
        let operands = vec![self.product(&word[..cut]), self.product(&row)];
        Some(self.operation(MatrixOperation::SkewOuter, operands, Shape::vector(algebra.dimension)))
    }

    fn scalar_sum(&mut self, terms: Vec<WordTerm<'_>>) -> Code {
        let mut constant = integer(0);
        let mut parts = Vec::new();
        for term in terms {
            let mut factors = self.powers(&term.scalars);
            factors.extend((!term.word.is_empty()).then(|| self.scalar_word(&term.word)));
            match factors.len() {
                0 => constant += term.coefficient,
                1 => parts.extend(factors.pop().map(|factor| (term.coefficient, factor))),
                _ => parts.push((term.coefficient, Code::Product(factors))),
            }
        }
        linear(constant, parts)
    }

    fn powers(&mut self, scalars: &[(Expr<'_>, Fraction)]) -> Vec<Code> {
        let power = |(base, exponent): &(Expr<'_>, Fraction)| {
            let (numerator, denominator) = exponent.parts();
            let base = self.value(*base);
            let power = match (numerator.unsigned_abs() as usize, denominator) {
                (1, 1) => base,
                (count, 1) => Code::Product(vec![base; count]),
                _ => Code::Root(Box::new(base), (numerator.abs(), denominator)),
            };
            self.shared(if numerator < 0 { Code::reciprocal(power) } else { power })
        };
        scalars.each(power)
    }

    /// A product of letters that is 1×1.
    fn scalar_word(&mut self, word: &[Expr<'_>]) -> Code {
        match word {
            [only] => self.value(*only),
            [first, rest @ ..] if first.shape().columns == 1 => {
                Code::Product(vec![self.value(first.transpose()), self.product(rest)])
            }
            [first, rest @ ..] => self.pairing(*first, rest),
            [] => Code::Number(integer(1)),
        }
    }

    /// tr(AB) = ⟨Aᵀ, B⟩, A the first letter.
    fn trace(&mut self, word: &[Expr<'_>]) -> Code {
        match word {
            [only] => {
                let (n, only) = (only.shape().rows, self.value(*only));
                if self.joins_blocks && self.is_read(&only) {
                    return total(indexed(n, |i| (integer(1), self.entry(&only, i, i))));
                }
                self.operation(MatrixOperation::Trace, vec![only], Shape::scalar())
            }
            [first, rest @ ..] => self.pairing(*first, rest),
            [] => Code::Number(integer(0)),
        }
    }

    /// ⟨Aᵀ, B⟩, B the product of the other letters.
    fn pairing(&mut self, first: Expr<'_>, others: &[Expr<'_>]) -> Code {
        let operands = vec![self.value(first.transpose()), self.product(others)];
        self.operation(MatrixOperation::Pairing, operands, Shape::scalar())
    }

    /// The product of some letters, in the order that takes the fewest multiplications.
    fn product(&mut self, word: &[Expr<'_>]) -> Code {
        if let [only] = word {
            return self.value(*only);
        }
        let cut = cheapest_cut(word);
        let (left, right) = word.split_at(cut);
        let shape = Shape::new(left[0].shape().rows, right[right.len() - 1].shape().columns);
        if let ([letter], 1) = (left, shape.columns) {
            if let Some((sign, x)) = skew_letter(*letter) {
                let operands = vec![self.value(x), self.product(right)];
                let turned = self.operation(MatrixOperation::SkewTimes, operands, shape);
                return self.total(shape, vec![(sign, turned)]);
            }
            if letter.role() == Some(Role::InertiaInverse) {
                let vector = self.product(right);
                return self.operation(MatrixOperation::InertiaTimes, vec![vector], shape);
            }
            if let View::Literal(numbers) = letter.view() {
                let vector = self.product(right);
                return self.combinations(&numbers, &vector, shape);
            }
        }
        let operands = vec![self.product(left), self.product(right)];
        self.operation(MatrixOperation::Product, operands, shape)
    }

    /// A matrix of numbers times a vector, without its zeros.
    fn combinations(&mut self, numbers: &[Rational], vector: &Code, shape: Shape) -> Code {
        let columns = numbers.len() / shape.rows;
        let row = |row: &[Rational]| {
            let terms = row.iter().enumerate().filter(|(_, number)| **number != integer(0));
            let terms: Vec<_> = terms.map(|(j, number)| (number.clone(), self.entry(vector, j, 0))).into_list();
            linear(integer(0), terms)
        };
        let entries: Vec<Code> = numbers.chunks(columns).map(row).into_list();
        self.entries(shape, entries)
    }

    /// A sum of terms: components in one basis are taken of the sum.
    fn sum(&mut self, graph: &Graph, shape: Shape, terms: Vec<WordTerm<'_>>) -> Code {
        let (under, rest) = by_components(terms, |algebra, inner| outer_product(graph, algebra, inner).is_none());
        let mut parts = Vec::new();
        for (algebra, inner) in under {
            let matrix = algebra.shape;
            let inner = inner.each(|term| self.weighted(term));
            let sum = self.gathered(matrix, inner);
            parts.push((integer(1), self.components(graph, algebra, sum)));
        }
        if !rest.is_empty() {
            let rest = rest.each(|term| self.weighted(term));
            parts.extend(self.summands(shape, rest));
        }
        self.total(shape, parts)
    }

    fn weighted<'g>(&mut self, term: &WordTerm<'g>) -> Weighted<'g> {
        let mut factors = self.powers(&term.scalars);
        let scale = match factors.len() {
            0 => None,
            1 => factors.pop(),
            _ => Some(self.shared(Code::Product(factors))),
        };
        Weighted { coefficient: term.coefficient.clone(), scale, word: term.word.clone() }
    }

    /// Σ of words with their weights.
    fn gathered(&mut self, shape: Shape, terms: Vec<Weighted<'_>>) -> Code {
        let summands = self.summands(shape, terms);
        self.total(shape, summands)
    }

    /// The same as summands. A letter that several words begin or end with is multiplied once, by the sum of their
    /// other factors.
    fn summands(&mut self, shape: Shape, terms: Vec<Weighted<'_>>) -> Vec<(Rational, Code)> {
        let mut parts = Vec::new();
        let mut terms = terms;
        while let Some((letter, first)) = common_letter(shape, &terms) {
            let is_shared = |term: &Weighted<'_>| term.outermost(first) == Some(letter);
            let (shared, rest): (Vec<_>, Vec<_>) = terms.into_iter().partition(is_shared);
            terms = rest;
            let left = shared.into_each(|term| term.without(first));
            let parts_of = if first {
                Shape::new(letter.shape().columns, shape.columns)
            } else {
                Shape::new(shape.rows, letter.shape().rows)
            };
            let sum = self.gathered(parts_of, left);
            let value = self.value(letter);
            let operands = if first { vec![value, sum] } else { vec![sum, value] };
            parts.push((integer(1), self.operation(MatrixOperation::Product, operands, shape)));
        }
        let (mut identity, mut scales) = (integer(0), Vec::new());
        for term in terms {
            let Weighted { coefficient, scale, word } = term;
            match (word.is_empty(), scale) {
                (true, None) => identity += coefficient,
                (true, Some(scale)) => scales.push((coefficient, scale)),
                (false, None) => parts.push((coefficient, self.product(&word))),
                (false, Some(scale)) => {
                    let product = self.product(&word);
                    let weight = linear(integer(0), vec![(coefficient, scale)]);
                    if self.joins_blocks && self.is_listed(&product) {
                        let entries = shape.positions().map(|(i, j)| times(&weight, self.entry(&product, i, j)));
                        let entries = entries.into_list();
                        parts.push((integer(1), self.entries(shape, entries)));
                        continue;
                    }
                    let weight = self.shared(weight);
                    parts.push((integer(1), self.operation(MatrixOperation::Scaled, vec![product, weight], shape)));
                }
            }
        }
        if identity != integer(0) || !scales.is_empty() {
            let multiple = self.shared(linear(identity, scales));
            let sum = self.total(shape, parts);
            parts = vec![(integer(1), self.operation(MatrixOperation::Shifted, vec![sum, multiple], shape))];
        }
        parts
    }

    fn total(&mut self, shape: Shape, parts: Vec<(Rational, Code)>) -> Code {
        match parts.as_slice() {
            [(weight, only)] if weight.is_one() => return only.clone(),
            [] => return self.operation(MatrixOperation::Zero, Vec::new(), shape),
            _ => {}
        }
        if let Some(entries) = self.joined(shape, &parts) {
            return self.entries(shape, entries);
        }
        let (weights, operands) = parts.into_iter().unzip();
        self.operation(MatrixOperation::Sum(weights), operands, shape)
    }
}

/// ±1 and x of a letter ±x^ of rotations.
fn skew_letter(letter: Expr<'_>) -> Option<(Rational, Expr<'_>)> {
    match letter.view() {
        View::Of(Operation::Wedge(algebra), x) => is_rotations(letter.graph(), algebra).then(|| (integer(1), x)),
        View::Of(Operation::Transpose, inner) => skew_letter(inner).map(|(sign, x)| (-sign, x)),
        View::Sum(terms) => match terms.as_slice() {
            [WordTerm { coefficient, scalars, word }] if scalars.is_empty() && coefficient.abs().is_one() => {
                let [only] = word[..] else { return None };
                skew_letter(only).map(|(sign, x)| (sign * coefficient, x))
            }
            _ => None,
        },
        _ => None,
    }
}

/// Whether a basis is that of so(n) that the runtime has functions for.
fn is_rotations(graph: &Graph, algebra: Algebra) -> bool {
    let shape = algebra.shape;
    algebra.is_skew && shape.rows > 3 && algebra == graph.algebra_of(Group::SpecialOrthogonal(shape.rows))
}

/// Whether a basis is that of so(3), x^ v = x × v.
fn is_hat(graph: &Graph, algebra: Algebra) -> bool {
    algebra == graph.algebra_of(Group::SpecialOrthogonal(3))
}

/// The word of a column times a row, and where the row begins, where ⟨·, E⟩ of it is taken for rotations.
fn outer_product<'g>(graph: &Graph, algebra: Algebra, a: Expr<'g>) -> Option<(Vec<Expr<'g>>, usize)> {
    let mut terms = a.word_terms();
    let term = terms.pop().filter(|term| terms.is_empty() && term.coefficient.is_one() && term.scalars.is_empty())?;
    let cut = term.word.iter().position(|letter| letter.shape().rows == 1)?;
    (cut > 0 && is_rotations(graph, algebra)).then_some((term.word, cut))
}

fn entry(a: &Code, i: usize, j: usize) -> Code {
    Code::whole(MatrixOperation::Entry(i, j), vec![a.clone()], Shape::scalar(), Cost::default())
}

/// constant + Σ coefficient · code.
fn linear(constant: Rational, mut terms: Vec<(Rational, Code)>) -> Code {
    match terms.len() {
        0 => Code::Number(constant),
        1 if constant == integer(0) && terms[0].0.is_one() => terms.remove(0).1,
        _ => Code::Sum(constant, terms),
    }
}

fn argument(symbol: &Symbol) -> Code {
    let input = Input::of(symbol, 0, 0);
    if symbol.shape.is_scalar() {
        return Code::Read(input);
    }
    Code::whole(MatrixOperation::Argument(input), Vec::new(), symbol.shape, Cost::default())
}
