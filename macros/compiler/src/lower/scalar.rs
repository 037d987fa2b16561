//! Scalar expressions: sums of multiples, products of powers, functions; each distinct one exists once.

use std::ops::AddAssign;
use std::rc::Rc;

use clebsch_symbolic::{Analytic, Function, Interner, Rational, Role, Shape, Symbol, Table, integer, product, work};

use super::entries::{Grid, Scalar};

/// Factors with their exponents.
pub(super) type Factors = Vec<(Scalar, u32)>;

/// How often a value changes, from never to in each iteration of a solve.
#[derive(Copy, Clone, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Rate {
    /// Fixed by the parameters and the step size.
    Once,
    /// Fixed at a time.
    Time,
    /// Fixed during a step.
    Step,
    /// Different in each iteration.
    Iteration,
}

impl Rate {
    /// How often an input changes.
    pub fn of(role: Role) -> Rate {
        match role {
            Role::StepSize | Role::Parameter(_) | Role::Constant(_) | Role::InertiaInverse => Rate::Once,
            Role::Time => Rate::Time,
            Role::Chart(_) => Rate::Iteration,
            _ => Rate::Step,
        }
    }
}

/// An entry of an input.
#[derive(Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct Input {
    /// The role of the input.
    pub role: Role,
    /// Its name, for the names of shared terms.
    pub name: String,
    /// The row of the entry.
    pub row: usize,
    /// Its column.
    pub column: usize,
    /// The shape of the input.
    pub shape: Shape,
}

impl Input {
    pub(super) fn of(symbol: &Symbol, row: usize, column: usize) -> Input {
        let Symbol { role, name, shape, .. } = symbol;
        Input { role: *role, name: name.clone(), row, column, shape: *shape }
    }
}

/// A function of matrices that generated code calls.
#[derive(Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub enum Callee {
    /// A power series of a matrix.
    Analytic(Analytic),
    /// φ(A)v, without the matrix φ(A).
    PhiTimes,
    /// The inverse of a matrix, with pivoting.
    Inverse,
    /// (sin x, cos x), which share the reduction of the angle.
    SineAndCosine,
    /// A method of the user's.
    Value(String),
    /// The gradient method of the same potential, with one matrix for each argument of the configuration.
    Gradient(String),
}

/// The identity of a call in its arena.
#[derive(Copy, Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct CallId(u32);

/// An entry of the result of a call.
#[derive(Copy, Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct Output {
    /// The leaf of a gradient.
    pub leaf: usize,
    /// The row of the entry.
    pub row: usize,
    /// Its column.
    pub column: usize,
    /// The shape of the returned matrix.
    pub shape: Shape,
}

/// A scalar expression.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub enum ScalarNode {
    /// An entry of an input.
    Input(Input),
    /// π.
    Pi,
    /// constant + Σ coefficient · scalar.
    Sum(Rational, Vec<(Scalar, Rational)>),
    /// Π scalar^exponent, exponents positive.
    Product(Factors),
    /// 1/x.
    Reciprocal(Scalar),
    /// x^(numerator/denominator) with an exponent between zero and one.
    Root(Scalar, (i64, i64)),
    /// An elementary function.
    Function(Function, Scalar),
    /// An entry of the result of a call.
    Output(CallId, Output),
}

impl ScalarNode {
    /// About the work that it takes to make it once its parts are there.
    fn size(&self) -> usize {
        2 + match self {
            ScalarNode::Sum(_, terms) => terms.len(),
            ScalarNode::Product(factors) => factors.len() / 2,
            _ => 0,
        }
    }
}

/// Owns scalars.
#[derive(Default)]
pub struct Scalars {
    /// Whether kernels leave sums as they are written, sums within them too.
    pub keeps_sums: bool,
    /// The work that is left for searches for fewer operations.
    pub(super) searches: u64,
    /// Whether there was too little of it, so that some code is left as it is.
    pub(super) is_plain: bool,
    /// Whether kernels are matrix code, and not unrolled.
    pub keeps_matrices: bool,
    /// The names of sums that have one in formulas.
    pub(super) names: Vec<(Scalar, String)>,
    /// Angles whose sine and cosine have both been met.
    pub(super) angles: Vec<Scalar>,
    nodes: Interner<ScalarNode>,
    rates: Vec<Rate>,
    calls: Interner<(Callee, Vec<Rc<Grid>>)>,
    /// The grids of expressions of one graph, by their positions: kernels have many expressions in common.
    pub(super) grids: Table<usize, Rc<Grid>>,
    /// Which expressions are fixed once per stepper.
    pub(super) constant: Table<usize, bool>,
}

impl Scalars {
    /// The expression behind an identity.
    pub fn node(&self, scalar: Scalar) -> &ScalarNode {
        self.nodes.value(scalar.0 as usize)
    }

    /// The identity of an expression that is there.
    pub(super) fn known(&self, node: &ScalarNode) -> Option<Scalar> {
        self.nodes.position(node).map(|position| Scalar(position as u32))
    }

    /// Hands on the scalars that an expression is made of.
    pub(super) fn each_part(&self, scalar: Scalar, mut visit: impl FnMut(Scalar)) {
        match self.node(scalar) {
            ScalarNode::Input(_) | ScalarNode::Pi => {}
            ScalarNode::Sum(_, terms) => terms.iter().for_each(|(term, _)| visit(*term)),
            ScalarNode::Product(factors) => factors.iter().for_each(|(factor, _)| visit(*factor)),
            ScalarNode::Reciprocal(x) | ScalarNode::Root(x, _) | ScalarNode::Function(_, x) => visit(*x),
            ScalarNode::Output(call, _) => {
                let (_, arguments) = self.call_of(*call);
                arguments.iter().flat_map(|grid| &grid.entries).for_each(|entry| visit(*entry));
            }
        }
    }

    /// How often its value changes.
    pub fn rate(&self, scalar: Scalar) -> Rate {
        self.rates[scalar.0 as usize]
    }

    fn intern(&mut self, node: ScalarNode, rate: Rate) -> Scalar {
        work::spend(node.size());
        let (position, is_new) = self.nodes.intern(node);
        if is_new {
            self.rates.push(rate);
        }
        Scalar(position as u32)
    }

    fn rate_of(&self, parts: impl Iterator<Item = Scalar>) -> Rate {
        parts.map(|part| self.rate(part)).max().unwrap_or(Rate::Once)
    }

    /// An entry of an input.
    pub fn input(&mut self, input: Input) -> Scalar {
        let rate = Rate::of(input.role);
        self.intern(ScalarNode::Input(input), rate)
    }

    /// Whether another entry of the same input occurs.
    pub fn has_other_entries(&self, input: &Input) -> bool {
        self.nodes.values().iter().any(|node| {
            matches!(node, ScalarNode::Input(other) if other.role == input.role && (other.row, other.column) != (input.row, input.column))
        })
    }

    /// π.
    pub fn pi(&mut self) -> Scalar {
        self.intern(ScalarNode::Pi, Rate::Once)
    }

    /// A number.
    pub fn number(&mut self, value: Rational) -> Scalar {
        self.intern(ScalarNode::Sum(value, Vec::new()), Rate::Once)
    }

    /// The number zero.
    pub fn zero(&mut self) -> Scalar {
        self.number(integer(0))
    }

    /// The value, if it is a number.
    pub fn as_number(&self, scalar: Scalar) -> Option<&Rational> {
        match self.node(scalar) {
            ScalarNode::Sum(constant, terms) if terms.is_empty() => Some(constant),
            _ => None,
        }
    }

    /// Whether it is the number zero.
    pub fn is_zero(&self, scalar: Scalar) -> bool {
        self.as_number(scalar).is_some_and(Rational::is_zero)
    }

    /// constant + Σ coefficient · scalar; sums inside are merged where the coefficient is ±1.
    pub fn sum(&mut self, constant: Rational, terms: impl IntoIterator<Item = (Scalar, Rational)>) -> Scalar {
        let mut total = constant;
        let mut collected: Vec<(Scalar, Rational)> = Vec::new();
        for (scalar, coefficient) in terms {
            self.add_term(&mut total, &mut collected, scalar, coefficient);
        }
        self.sum_of(total, collected)
    }

    /// Adds a term, or the terms inside, to a constant and terms.
    fn add_term(
        &self,
        total: &mut Rational,
        terms: &mut Vec<(Scalar, Rational)>,
        scalar: Scalar,
        coefficient: Rational,
    ) {
        match self.node(scalar) {
            ScalarNode::Sum(inner, parts) if parts.len() < 2 || is_unit(&coefficient) => {
                if !inner.is_zero() {
                    *total += product(inner, &coefficient);
                }
                for (part, factor) in parts {
                    add(terms, *part, product(factor, &coefficient));
                }
            }
            _ => add(terms, scalar, coefficient),
        }
    }

    fn sum_of(&mut self, total: Rational, mut terms: Vec<(Scalar, Rational)>) -> Scalar {
        terms.retain(|(_, coefficient)| !coefficient.is_zero());
        match terms.as_slice() {
            [(only, coefficient)] if total.is_zero() && coefficient.is_one() => *only,
            _ => {
                let rate = self.rate_of(terms.iter().map(|(scalar, _)| *scalar));
                self.intern(ScalarNode::Sum(total, terms), rate)
            }
        }
    }

    /// The sum of scalars.
    pub fn total(&mut self, terms: impl IntoIterator<Item = Scalar>) -> Scalar {
        self.sum(integer(0), terms.into_iter().map(|term| (term, integer(1))))
    }

    /// coefficient · a.
    pub fn scale(&mut self, a: Scalar, coefficient: Rational) -> Scalar {
        if coefficient.is_one() { a } else { self.sum(integer(0), [(a, coefficient)]) }
    }

    /// A scalar as a number times another scalar.
    pub fn factor(&self, scalar: Scalar) -> (Rational, Option<Scalar>) {
        match self.node(scalar) {
            ScalarNode::Sum(constant, terms) if terms.is_empty() => (constant.clone(), None),
            ScalarNode::Sum(constant, terms) if terms.len() == 1 && constant.is_zero() => {
                (terms[0].1.clone(), Some(terms[0].0))
            }
            _ => (integer(1), Some(scalar)),
        }
    }

    /// Its factors; itself where it is no product.
    pub fn factors(&self, scalar: Scalar) -> Factors {
        match self.node(scalar) {
            ScalarNode::Product(factors) => factors.clone(),
            _ => vec![(scalar, 1)],
        }
    }

    /// The product of scalars.
    pub fn product(&mut self, factors: impl IntoIterator<Item = Scalar>) -> Scalar {
        let mut coefficient = integer(1);
        let mut powers = Factors::new();
        for factor in factors {
            let (number, rest) = self.factor(factor);
            coefficient = product(&coefficient, &number);
            match rest.map(|rest| (rest, self.node(rest))) {
                Some((_, ScalarNode::Product(inner))) => {
                    inner.iter().for_each(|&(base, exponent)| add(&mut powers, base, exponent));
                }
                Some((rest, _)) => add(&mut powers, rest, 1),
                None => {}
            }
        }
        if coefficient.is_zero() {
            return self.zero();
        }
        self.cancel_reciprocals(&mut powers);
        let product = match powers.as_slice() {
            [] => return self.number(coefficient),
            [(only, 1)] => *only,
            _ => {
                let rate = self.rate_of(powers.iter().map(|&(base, _)| base));
                self.intern(ScalarNode::Product(powers), rate)
            }
        };
        self.scale(product, coefficient)
    }

    fn cancel_reciprocals(&self, powers: &mut Factors) {
        for position in 0..powers.len() {
            if let ScalarNode::Reciprocal(inner) = self.node(powers[position].0)
                && let Ok(other) = powers.binary_search_by_key(inner, |(base, _)| *base)
            {
                let common = powers[other].1.min(powers[position].1);
                powers[other].1 -= common;
                powers[position].1 -= common;
            }
        }
        powers.retain(|(_, exponent)| *exponent > 0);
    }

    /// 1/x.
    pub fn reciprocal(&mut self, x: Scalar) -> Scalar {
        let (number, rest) = self.factor(x);
        // a reciprocal of the number zero stays symbolic: at run time it is an infinity that the finiteness checks report
        let number = if number.is_zero() { integer(1) } else { number.recip() };
        let Some(rest) = rest else {
            return self.number(number);
        };
        let inverse = match self.node(rest).clone() {
            ScalarNode::Reciprocal(inner) => inner,
            _ => {
                let rate = self.rate(rest);
                self.intern(ScalarNode::Reciprocal(rest), rate)
            }
        };
        self.scale(inverse, number)
    }

    /// x^exponent: the integer part by products and a reciprocal, the fraction as a root.
    pub fn power(&mut self, x: Scalar, numerator: i64, denominator: i64) -> Scalar {
        let whole = numerator.div_euclid(denominator);
        let fraction = numerator.rem_euclid(denominator);
        // x^(-1/2) is the reciprocal of a root rather than a root times a reciprocal
        if whole < 0 && fraction != 0 {
            let positive = self.power(x, -numerator, denominator);
            return self.reciprocal(positive);
        }
        let base = if whole < 0 { self.reciprocal(x) } else { x };
        let mut factors = vec![base; whole.unsigned_abs() as usize];
        if fraction != 0 {
            let rate = self.rate(x);
            factors.push(self.intern(ScalarNode::Root(x, (fraction, denominator)), rate));
        }
        self.product(factors)
    }

    /// An elementary function.
    pub fn function(&mut self, function: Function, x: Scalar) -> Scalar {
        let rate = self.rate(x);
        let other = match function {
            Function::Sin => Some(Function::Cos),
            Function::Cos => Some(Function::Sin),
            _ => None,
        };
        let is_both = other.is_some_and(|other| self.known(&ScalarNode::Function(other, x)).is_some());
        if is_both && !self.angles.contains(&x) {
            self.angles.push(x);
        }
        self.intern(ScalarNode::Function(function, x), rate)
    }

    /// The entries of the result of a call.
    pub fn call(&mut self, callee: Callee, arguments: Vec<Rc<Grid>>, leaf: usize, shape: Shape) -> Grid {
        let rate = self.rate_of(arguments.iter().flat_map(|argument| argument.entries.iter().copied()));
        let (index, _) = self.calls.intern((callee, arguments));
        let entry = |(row, column)| ScalarNode::Output(CallId(index as u32), Output { leaf, row, column, shape });
        Grid::from_fn(shape, |place| self.intern(entry(place), rate))
    }

    /// The function that is called, with its arguments entry by entry.
    pub fn call_of(&self, id: CallId) -> &(Callee, Vec<Rc<Grid>>) {
        self.calls.value(id.0 as usize)
    }
}

/// Whether a number is 1 or −1, so that nothing is multiplied.
pub(super) fn is_unit(coefficient: &Rational) -> bool {
    coefficient.is_one() || *coefficient == integer(-1)
}

/// Adds to the value of a scalar among sorted ones: the coefficient of a term, the exponent of a factor.
pub(super) fn add<V: AddAssign>(parts: &mut Vec<(Scalar, V)>, scalar: Scalar, value: V) {
    match parts.binary_search_by_key(&scalar, |(other, _)| *other) {
        Ok(position) => parts[position].1 += value,
        Err(position) => parts.insert(position, (scalar, value)),
    }
}
