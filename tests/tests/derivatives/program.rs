//! Compiled declarations with numbers in them: formulas are evaluated and kernels are run.

use std::collections::HashMap;

use clebsch_compiler::lower::{Code, Kernel, Program};
use clebsch_compiler::{Graph, compile};
use clebsch_symbolic::{Expr, Matrix, Number, Property, Rational, Shape};
use clebsch_tests::oracle::random::Random;

/// The numbers of all symbols of a program, by name.
pub struct Values(HashMap<String, Matrix<f64>>);

/// The first four stages of the struct in a fixture's text.
pub fn program<'g>(graph: &'g Graph, text: &str) -> Program<'g> {
    let start = text.find("#[derive(").expect("a derived struct");
    let item = text[start..].parse().expect("Rust tokens");
    match compile(graph, item) {
        Ok(program) => program,
        Err(errors) => panic!("{errors}"),
    }
}

impl Values {
    /// Random numbers that keep what is promised of each symbol; the step is 0.1.
    pub fn random(program: &Program<'_>, random: &mut Random) -> Values {
        let formulas = &program.formulas;
        let (model, symbols) = (&formulas.model, &formulas.symbols);
        let mut all: Vec<Expr<'_>> = vec![model.step_size];
        all.extend(model.parameters.iter().flat_map(|parameter| parameter.leaves.iter().map(|leaf| leaf.symbol)));
        all.extend(model.constants.iter().map(|constant| constant.symbol));
        all.extend(model.factors.iter().map(|factor| factor.symbol));
        all.extend(model.configurations.iter().map(|leaf| leaf.symbol));
        for more in [&symbols.covectors, &symbols.momenta, &symbols.charts, &symbols.directions, &symbols.algebra] {
            all.extend(more.iter());
        }
        let mut values = Values(HashMap::new());
        for symbol in all {
            let data = symbol.as_symbol().expect("a symbol");
            values.0.insert(data.name.clone(), value(data.shape, data.property, random));
        }
        let step = program.formulas.model.step_size.as_symbol().expect("a symbol").name;
        values.0.insert(step, Matrix::new(Shape::scalar(), vec![0.1]));
        let inverse = values.evaluate(formulas.inertia).inverse().0;
        values.0.insert("inertia_inverse".into(), inverse);
        values
    }

    /// Replaces the numbers of a symbol.
    pub fn set(&mut self, symbol: Expr<'_>, entries: &[f64]) {
        let data = symbol.as_symbol().expect("a symbol");
        self.0.insert(data.name, Matrix::new(data.shape, entries.to_vec()));
    }

    /// Takes over all numbers of `other`.
    pub fn copy(&mut self, other: &Values) {
        self.0.clone_from(&other.0);
    }

    /// The numbers of the symbol with this name, row by row.
    pub fn named(&self, name: &str) -> &[f64] {
        &self.0[name].entries
    }

    /// The numbers of a symbol, row by row.
    pub fn get(&self, symbol: Expr<'_>) -> &[f64] {
        &self.0[&symbol.as_symbol().expect("a symbol").name].entries
    }

    /// A formula with these numbers.
    pub fn evaluate(&self, formula: Expr<'_>) -> Matrix<f64> {
        formula.evaluate(&mut |symbol| self.0[&symbol.as_symbol().expect("a symbol").name].clone())
    }

    /// The outputs of a kernel, one list of entries each.
    pub fn run(&self, kernel: &Kernel, constants: &[f64], terms: &[f64]) -> Vec<Vec<f64>> {
        let mut run = Run { values: self, constants, terms, locals: Vec::new() };
        for local in &kernel.locals {
            let value = run.code(local);
            run.locals.push(value);
        }
        kernel.outputs.iter().map(|(_, entries)| entries.iter().map(|entry| run.code(entry)).collect()).collect()
    }
}

fn value(shape: Shape, property: Property, random: &mut Random) -> Matrix<f64> {
    let plain = Matrix::from_fn(shape, |_| random.number());
    let n = shape.rows;
    match property {
        // regular masses and inertias
        _ if shape.is_scalar() => Matrix::new(shape, vec![random.between(0.5, 1.5)]),
        Property::Symmetric | Property::General if shape.is_square() => {
            Matrix::from_fn(shape, |(i, j)| f64::from(u8::from(i == j)) + (plain.at(i, j) + plain.at(j, i)) / 8.0)
        }
        Property::Diagonal => Matrix::from_fn(shape, |(i, j)| if i == j { 1.0 + plain.at(i, i) / 4.0 } else { 0.0 }),
        Property::Orthogonal => cayley(&Matrix::from_fn(shape, |(i, j)| plain.at(i, j) - plain.at(j, i)), n),
        Property::Unit => {
            let length = plain.entries.iter().map(|x| x * x).sum::<f64>().sqrt();
            Matrix::from_fn(shape, |(i, j)| plain.at(i, j) / length)
        }
        _ => plain,
    }
}

/// (I − Z)⁻¹(I + Z)
fn cayley(z: &Matrix<f64>, n: usize) -> Matrix<f64> {
    let shifted =
        |sign: f64| Matrix::from_fn(Shape::square(n), |(i, j)| f64::from(u8::from(i == j)) + sign * z.at(i, j));
    shifted(-1.0).inverse().0.multiply(&shifted(1.0))
}

struct Run<'a> {
    values: &'a Values,
    constants: &'a [f64],
    terms: &'a [f64],
    locals: Vec<f64>,
}

impl Run<'_> {
    fn code(&self, code: &Code) -> f64 {
        let rational = |value: &Rational| <f64 as Number>::from_rational(value);
        match code {
            Code::Read(input) => self.values.0[&input.name].at(input.row, input.column),
            Code::Pi => std::f64::consts::PI,
            Code::Number(value) => rational(value),
            Code::Constant(index) => self.constants[*index],
            Code::Term(index) => self.terms[*index],
            Code::Local(index) => self.locals[*index],
            Code::Sum(constant, terms) => {
                terms.iter().fold(rational(constant), |sum, (factor, term)| sum + rational(factor) * self.code(term))
            }
            Code::Product(factors) => factors.iter().map(|factor| self.code(factor)).product(),
            Code::Reciprocal(x) => 1.0 / self.code(x),
            Code::Root(x, (numerator, denominator)) => self.code(x).powf(*numerator as f64 / *denominator as f64),
            Code::Function(function, x) => Number::function(self.code(x), *function),
        }
    }
}
