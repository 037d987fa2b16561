//! Symbols with numbers in them: formulas are evaluated and kernels are run.

use std::cmp::Ordering;
use std::collections::HashMap;

use clebsch_compiler::derive::Id;
use clebsch_compiler::lower::{Callee, Code, Kernel, MatrixOperation, MechanicsProgram, Output, Whole};
use clebsch_symbolic::{Analytic, Expr, Matrix, Number, Operation, Rational, Shape};
use nalgebra::SMatrix;

/// The numbers of all symbols of a program, by name.
#[derive(Clone, Default)]
pub struct Values(pub HashMap<String, Matrix<f64>>);

#[allow(dead_code, reason = "two tests share this file, and each uses a part of it")]
impl Values {
    /// Gives a symbol its numbers, or others.
    pub fn set(&mut self, symbol: Expr<'_>, entries: &[f64]) {
        let data = symbol.as_symbol().expect("a symbol");
        self.0.insert(data.name, Matrix::new(data.shape, entries.to_vec()));
    }

    /// The numbers of a symbol, row by row.
    pub fn get(&self, symbol: Expr<'_>) -> &[f64] {
        &self.0[&symbol.as_symbol().expect("a symbol").name].entries
    }

    /// A formula with these numbers.
    pub fn evaluate(&self, formula: Expr<'_>) -> Matrix<f64> {
        formula.evaluate(&mut |symbol| self.0[&symbol.as_symbol().expect("a symbol").name].clone())
    }

    /// Σ; of κI the kernel gives κ.
    pub fn inertia(&self, program: &MechanicsProgram<'_>) -> Matrix<f64> {
        let shape = program.formulas.inertia.shape();
        let entries = self.run(program.kernel(Id::Inertia), &[], &[]).remove(0);
        match entries[..] {
            [kappa] => Matrix::from_fn(shape, |(i, j)| if i == j { kappa } else { 0.0 }),
            _ => Matrix::new(shape, entries),
        }
    }

    /// The outputs of a kernel, one list of entries each.
    pub fn run(&self, kernel: &Kernel, constants: &[f64], terms: &[f64]) -> Vec<Vec<f64>> {
        let mut run = Run { values: self, constants, terms, locals: Vec::new() };
        for local in &kernel.locals {
            let value = run.local(local);
            run.locals.push(value);
        }
        let output = |(_, entries): &(Shape, Vec<Code>)| match &entries[..] {
            [whole] => run.matrix(whole).entries,
            entries => entries.iter().map(|entry| run.code(entry)).collect(),
        };
        kernel.outputs.iter().map(output).collect()
    }
}

struct Run<'a> {
    values: &'a Values,
    constants: &'a [f64],
    terms: &'a [f64],
    locals: Vec<Matrix<f64>>,
}

impl Run<'_> {
    /// A shared term: a number, or the result of a call.
    fn local(&self, code: &Code) -> Matrix<f64> {
        let Code::Call(callee, arguments) = code else { return self.matrix(code) };
        let argument =
            |(shape, entries): &(Shape, Vec<Code>)| Matrix::new(*shape, entries.iter().map(|x| self.code(x)).collect());
        let arguments: Vec<Matrix<f64>> = arguments.iter().map(argument).collect();
        match callee {
            Callee::Analytic(Analytic::Logarithm) => logarithm(&arguments[0]),
            Callee::Analytic(function) => <f64 as Number>::analytic(*function, &arguments[0]),
            Callee::PhiTimes => {
                let matrix = <f64 as Number>::analytic(Analytic::Phi, &arguments[0]);
                let row = |i: usize| (0..matrix.shape.columns).map(|j| matrix.at(i, j) * arguments[1].at(j, 0)).sum();
                Matrix::from_fn(arguments[1].shape, |(i, _)| row(i))
            }
            Callee::Inverse => arguments[0].inverse().0,
            Callee::SineAndCosine => {
                let (sine, cosine) = arguments[0].at(0, 0).sin_cos();
                Matrix::new(Shape::new(2, 1), vec![sine, cosine])
            }
            Callee::Value(name) | Callee::Gradient(name) => panic!("no numbers are known of the method `{name}`"),
        }
    }

    fn output(&self, local: usize, output: Output) -> f64 {
        self.locals[local].at(output.row, output.column)
    }

    fn code(&self, code: &Code) -> f64 {
        let rational = |value: &Rational| <f64 as Number>::from_rational(value);
        match code {
            Code::Read(input) => self.values.0[&input.name].at(input.row, input.column),
            Code::Pi => std::f64::consts::PI,
            Code::Number(value) => rational(value),
            Code::Constant(index) => self.constants[*index],
            Code::Term(index) => self.terms[*index],
            Code::Local(index) => self.locals[*index].entries[0],
            Code::Sum(constant, terms) => {
                terms.iter().fold(rational(constant), |sum, (factor, term)| sum + rational(factor) * self.code(term))
            }
            Code::Product(factors) => factors.iter().map(|factor| self.code(factor)).product(),
            Code::Reciprocal(x) => 1.0 / self.code(x),
            Code::Root(x, (numerator, denominator)) => self.code(x).powf(*numerator as f64 / *denominator as f64),
            Code::PerOnePlusCosine(t) => 1.0 / (1.0 + (1.0 - self.code(t)).sqrt()),
            Code::Function(function, x) => Number::function(self.code(x), *function),
            Code::Call(callee, _) => panic!("{callee:?} returns a matrix"),
            Code::Output(local, _, output) => self.output(*local, *output),
            Code::Whole(whole) => self.whole(whole).entries[0],
        }
    }

    /// A number, or a matrix.
    fn matrix(&self, code: &Code) -> Matrix<f64> {
        match code {
            Code::Whole(whole) => self.whole(whole),
            Code::Local(index) => self.locals[*index].clone(),
            number => Matrix::new(Shape::scalar(), vec![self.code(number)]),
        }
    }

    fn whole(&self, whole: &Whole) -> Matrix<f64> {
        let of: Vec<Matrix<f64>> = whole.operands.iter().map(|operand| self.matrix(operand)).collect();
        let one = |(i, j): (usize, usize)| if i == j { 1.0 } else { 0.0 };
        let number = |value: f64| Matrix::new(Shape::scalar(), vec![value]);
        let from = |entry: &dyn Fn((usize, usize)) -> f64| Matrix::from_fn(whole.shape, entry);
        match &whole.operation {
            MatrixOperation::Argument(input) => self.values.0[&input.name].clone(),
            MatrixOperation::Zero => from(&|_| 0.0),
            MatrixOperation::Entries => Matrix::new(whole.shape, of.iter().map(|entry| entry.entries[0]).collect()),
            MatrixOperation::Sum(weights) => from(&|(i, j)| {
                weights.iter().zip(&of).map(|(weight, a)| <f64 as Number>::from_rational(weight) * a.at(i, j)).sum()
            }),
            MatrixOperation::Scaled => from(&|(i, j)| of[0].at(i, j) * of[1].entries[0]),
            MatrixOperation::Shifted => from(&|(i, j)| of[0].at(i, j) + of[1].entries[0] * one((i, j))),
            MatrixOperation::Product => {
                from(&|(i, j)| (0..of[0].shape.columns).map(|k| of[0].at(i, k) * of[1].at(k, j)).sum())
            }
            MatrixOperation::Of(Operation::Transpose) => from(&|(i, j)| of[0].at(j, i)),
            MatrixOperation::Of(Operation::Inverse) => of[0].inverse().0,
            MatrixOperation::Of(Operation::Analytic(Analytic::Logarithm)) => logarithm(&of[0]),
            MatrixOperation::Of(Operation::Analytic(function)) => <f64 as Number>::analytic(*function, &of[0]),
            MatrixOperation::Of(Operation::Block(row, column)) => from(&|(i, j)| of[0].at(row + i, column + j)),
            MatrixOperation::Hadamard => from(&|(i, j)| of[0].at(i, j) * of[1].at(i, j)),
            MatrixOperation::Of(Operation::DiagonalMatrix) => from(&|(i, j)| of[0].at(i, 0) * one((i, j))),
            MatrixOperation::Of(Operation::Diagonal) => from(&|(i, _)| of[0].at(i, i)),
            MatrixOperation::Hat => from(&|(i, j)| match (3 + j - i) % 3 {
                0 => 0.0,
                1 => -of[0].at(3 - i - j, 0),
                _ => of[0].at(3 - i - j, 0),
            }),
            MatrixOperation::Axial => from(&|(i, _)| {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                of[0].at(k, j) - of[0].at(j, k)
            }),
            MatrixOperation::Skew => {
                let n = whole.shape.rows;
                from(&|(i, j)| match i.cmp(&j) {
                    Ordering::Equal => 0.0,
                    Ordering::Less => -of[0].at(pair(n, (i, j)), 0),
                    Ordering::Greater => of[0].at(pair(n, (j, i)), 0),
                })
            }
            MatrixOperation::SkewComponents => {
                let pairs = pairs(of[0].shape.rows);
                from(&|(k, _)| of[0].at(pairs[k].1, pairs[k].0) - of[0].at(pairs[k].0, pairs[k].1))
            }
            MatrixOperation::SkewOuter => {
                let pairs = pairs(of[0].shape.rows);
                let product = |i: usize, j: usize| of[0].at(i, 0) * of[1].at(j, 0);
                from(&|(k, _)| product(pairs[k].1, pairs[k].0) - product(pairs[k].0, pairs[k].1))
            }
            MatrixOperation::Pairing => number(of[0].entries.iter().zip(&of[1].entries).map(|(a, b)| a * b).sum()),
            MatrixOperation::Trace => number((0..of[0].shape.rows).map(|i| of[0].at(i, i)).sum()),
            MatrixOperation::Entry(i, j) => number(of[0].at(*i, *j)),
            other => panic!("{other:?} is not among what is called once in a while"),
        }
    }
}

/// The pairs of axes of so(n) in the order of its basis.
fn pairs(n: usize) -> Vec<(usize, usize)> {
    (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j))).collect()
}

/// The place of one of them.
fn pair(n: usize, wanted: (usize, usize)) -> usize {
    pairs(n).iter().position(|&pair| pair == wanted).expect("a pair of axes")
}

/// The function of the runtime, for emitted code has no other.
fn logarithm(a: &Matrix<f64>) -> Matrix<f64> {
    macro_rules! of_size {
        ($($n:literal)*) => {
            match a.shape.rows {
                $($n => {
                    let y = clebsch::__private::logarithm(&SMatrix::<f64, $n, $n>::from_row_slice(&a.entries));
                    Matrix::from_fn(a.shape, |position| y[position])
                })*
                n => panic!("a logarithm of {n}x{n}"),
            }
        };
    }
    of_size!(1 2 3 4 5 6)
}
