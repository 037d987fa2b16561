//! Kernels: straight-line code for some outputs, with what changes less often taken out and common terms shared.

mod shorten;

use clebsch_symbolic::{Analytic, Function, Interner, Rational, Role, Shape, Table, Zero, integer, work};

use super::balance;
use super::pairs::Pairs;
use super::scalar::{CallId, Callee, Output};
use super::{Cost, Input, Node, Rate, Scalar, Scalars};
use shorten::delay_of_term;

/// Straight-line code of one output entry or shared term.
#[derive(Clone, PartialEq, Debug)]
pub enum Code {
    /// An entry of an argument.
    Read(Input),
    /// π.
    Pi,
    /// A number.
    Number(Rational),
    /// A value that is computed once per stepper, by its index.
    Constant(usize),
    /// A value that is computed once per solve, by its index.
    Term(usize),
    /// A shared term of this kernel, by its index.
    Local(usize),
    /// constant + Σ coefficient · code.
    Sum(Rational, Vec<(Rational, Code)>),
    /// A product.
    Product(Vec<Code>),
    /// 1/x.
    Reciprocal(Box<Code>),
    /// x^(numerator/denominator).
    Root(Box<Code>, (i64, i64)),
    /// 1/(1 + √(1 − t)), which is 1/(1 + cos θ) with t = sin²θ.
    PerOnePlusCosine(Box<Code>),
    /// An elementary function.
    Function(Function, Box<Code>),
    /// A call of a function of matrices: always a shared term.
    Call(Callee, Vec<(Shape, Vec<Code>)>),
    /// An entry of a call, by the index of that term.
    Output(usize, Callee, Output),
    /// An operation on whole matrices: a shared term, or an entry of one.
    Whole(Box<Whole>),
}

/// An operation on whole matrices, for code that keeps them.
#[derive(Clone, PartialEq, Debug)]
pub struct Whole {
    /// What is done.
    pub operation: Operation,
    /// What it is done with.
    pub operands: Vec<Code>,
    /// The shape of the result.
    pub shape: Shape,
    /// Its scalar operations.
    pub cost: Cost,
}

/// What is done with whole matrices.
#[derive(Clone, PartialEq, Debug)]
pub enum Operation {
    /// An argument, by its first entry.
    Argument(Input),
    /// The zero matrix.
    Zero,
    /// The matrix with these entries, row by row.
    Entries,
    /// Σ c_i A_i, by the coefficients.
    Sum(Vec<Rational>),
    /// s A, of A and s.
    Scaled,
    /// A + s I, of A and s.
    Shifted,
    /// Σ⁻¹ v.
    InertiaTimes,
    /// A B.
    Product,
    /// Aᵀ.
    Transpose,
    /// A⁻¹.
    Inverse,
    /// A power series of A.
    Analytic(Analytic),
    /// The value of an opaque potential.
    Value,
    /// A leaf of its gradient, by the number of the argument.
    Gradient(usize),
    /// The block from (i, j) on.
    Block(usize, usize),
    /// A in a zero matrix from (i, j) on.
    Embedded(usize, usize),
    /// The product entry by entry.
    Hadamard,
    /// The diagonal matrix of a vector.
    DiagonalMatrix,
    /// The diagonal of a matrix.
    Diagonal,
    /// Σ x_k E_k in the basis of so(n).
    Skew,
    /// ⟨A, E_k⟩ in that basis.
    SkewComponents,
    /// Σ x_k E_k v.
    SkewTimes,
    /// ⟨abᵀ, E_k⟩.
    SkewOuter,
    /// ⟨A, B⟩ = Σ A_ij B_ij.
    Pairing,
    /// tr A.
    Trace,
    /// det A.
    Determinant,
    /// The largest |A_ij|.
    Largest,
    /// The entry (i, j).
    Entry(usize, usize),
}

/// Straight-line code.
#[derive(Clone, Debug)]
pub struct Kernel {
    /// Shared terms, each in terms of those before it.
    pub locals: Vec<Code>,
    /// The outputs, one grid for each value returned.
    pub outputs: Vec<(Shape, Vec<Code>)>,
}

impl Kernel {
    /// The entries of arguments that it reads, as often as they stand in it.
    pub fn inputs(&self) -> Vec<&Input> {
        let mut inputs = Vec::new();
        let outputs = self.outputs.iter().flat_map(|(_, entries)| entries);
        self.locals.iter().chain(outputs).for_each(|code| code.read(&mut inputs));
        inputs
    }

    /// Which of its terms depend on an argument of a role that is wanted.
    pub fn depends_on(&self, wanted: impl Fn(Role) -> bool) -> Vec<bool> {
        let mut depends: Vec<bool> = Vec::new();
        for code in &self.locals {
            let found = code.any(&mut |part| match part {
                Code::Local(index) => depends.get(*index).copied().unwrap_or(false),
                Code::Read(input) => wanted(input.role),
                Code::Whole(whole) => matches!(&whole.operation, Operation::Argument(input) if wanted(input.role)),
                _ => false,
            });
            depends.push(found);
        }
        depends
    }

    /// The arguments that it takes as a whole, with their shapes.
    pub(super) fn arguments(&self) -> Vec<(&Input, Shape)> {
        let mut arguments = Vec::new();
        let outputs = self.outputs.iter().flat_map(|(_, entries)| entries);
        self.locals.iter().chain(outputs).for_each(|code| code.take(&mut arguments));
        arguments
    }
}

impl Code {
    /// A product as a quotient: the factors above and those below, where one of them is a reciprocal that is used here alone.
    pub(crate) fn quotient(factors: &[Code]) -> Option<(Vec<&Code>, Vec<&Code>)> {
        let below: Vec<&Code> = factors.iter().filter_map(Code::divisor).collect();
        let above = factors.iter().filter(|factor| factor.divisor().is_none()).collect();
        (!below.is_empty()).then_some((above, below))
    }

    /// 1/x
    pub(super) fn reciprocal(x: Code) -> Code {
        match x.sine_squared() {
            Some(sine_squared) => Code::PerOnePlusCosine(Box::new(sine_squared)),
            None => Code::Reciprocal(Box::new(x)),
        }
    }

    /// The t of 1 + √(1 − t).
    fn sine_squared(&self) -> Option<Code> {
        let one = integer(1);
        let one_and = |code: &Code| {
            let Code::Sum(constant, terms) = code else { return None };
            let (constant, terms) = Code::summands(constant, terms);
            (constant == one).then_some(terms)
        };
        let [(coefficient, Code::Root(square, (1, 2)))] = &one_and(self)?[..] else { return None };
        let mut terms = one_and(square).filter(|_| *coefficient == one)?;
        terms.iter_mut().for_each(|(coefficient, _)| *coefficient = -coefficient.clone());
        match &terms[..] {
            [(coefficient, term)] if *coefficient == one => Some(term.clone()),
            _ => Some(Code::Sum(integer(0), terms)),
        }
    }

    /// The constant and the terms of a sum, of sums within it too.
    pub(super) fn summands(constant: &Rational, terms: &[(Rational, Code)]) -> (Rational, Vec<(Rational, Code)>) {
        let (mut total, mut all) = (constant.clone(), Vec::new());
        for (coefficient, term) in terms {
            match term {
                Code::Sum(constant, terms) if *coefficient == integer(1) || *coefficient == integer(-1) => {
                    let (constant, terms) = Code::summands(constant, terms);
                    total += constant * coefficient;
                    all.extend(terms.into_iter().map(|(weight, term)| (weight * coefficient, term)));
                }
                _ => all.push((coefficient.clone(), term.clone())),
            }
        }
        (total, all)
    }

    fn divisor(&self) -> Option<&Code> {
        match self {
            Code::Reciprocal(x) => Some(x),
            _ => None,
        }
    }

    fn read<'a>(&'a self, inputs: &mut Vec<&'a Input>) {
        match self {
            Code::Read(input) => inputs.push(input),
            Code::Sum(_, terms) => terms.iter().for_each(|(_, term)| term.read(inputs)),
            Code::Product(factors) => factors.iter().for_each(|factor| factor.read(inputs)),
            Code::Reciprocal(x) | Code::Root(x, _) | Code::PerOnePlusCosine(x) | Code::Function(_, x) => x.read(inputs),
            Code::Call(_, arguments) => {
                arguments.iter().flat_map(|(_, entries)| entries).for_each(|entry| entry.read(inputs));
            }
            Code::Whole(whole) => {
                if let Operation::Argument(input) = &whole.operation {
                    inputs.push(input);
                }
                whole.operands.iter().for_each(|operand| operand.read(inputs));
            }
            Code::Pi | Code::Number(_) | Code::Constant(_) | Code::Term(_) | Code::Local(_) | Code::Output(..) => {}
        }
    }

    fn take<'a>(&'a self, arguments: &mut Vec<(&'a Input, Shape)>) {
        if let Code::Whole(whole) = self
            && let Operation::Argument(input) = &whole.operation
        {
            arguments.push((input, whole.shape));
        }
        self.parts().into_iter().for_each(|part| part.take(arguments));
    }

    /// The codes that it is made of.
    pub(super) fn parts(&self) -> Vec<&Code> {
        match self {
            Code::Sum(_, terms) => terms.iter().map(|(_, term)| term).collect(),
            Code::Product(factors) => factors.iter().collect(),
            Code::Reciprocal(x) | Code::Root(x, _) | Code::PerOnePlusCosine(x) | Code::Function(_, x) => vec![x],
            Code::Call(_, arguments) => arguments.iter().flat_map(|(_, entries)| entries).collect(),
            Code::Whole(whole) => whole.operands.iter().collect(),
            Code::Read(_) | Code::Pi | Code::Number(_) => Vec::new(),
            Code::Constant(_) | Code::Term(_) | Code::Local(_) | Code::Output(..) => Vec::new(),
        }
    }

    /// The same with other codes for its shared terms.
    pub(super) fn with_locals(&self, other: &impl Fn(usize) -> Code) -> Code {
        let inner = |code: &Code| code.with_locals(other);
        match self {
            Code::Local(index) => other(*index),
            Code::Sum(constant, terms) => {
                Code::Sum(constant.clone(), terms.iter().map(|(weight, term)| (weight.clone(), inner(term))).collect())
            }
            Code::Product(factors) => Code::Product(factors.iter().map(inner).collect()),
            Code::Reciprocal(x) => Code::Reciprocal(Box::new(inner(x))),
            Code::Root(x, exponent) => Code::Root(Box::new(inner(x)), *exponent),
            Code::PerOnePlusCosine(x) => Code::PerOnePlusCosine(Box::new(inner(x))),
            Code::Function(function, x) => Code::Function(*function, Box::new(inner(x))),
            Code::Whole(whole) => {
                let operands = whole.operands.iter().map(inner).collect();
                Code::Whole(Box::new(Whole { operands, ..(**whole).clone() }))
            }
            other => other.clone(),
        }
    }

    /// Whether a test holds for it or for one of its parts.
    pub(super) fn any(&self, test: &mut impl FnMut(&Code) -> bool) -> bool {
        test(self) || self.parts().into_iter().any(|part| part.any(test))
    }
}

/// Values that are computed less often than the kernels that use them.
#[derive(Clone, Default, Debug)]
pub struct Hoisted {
    /// In the order in which they were met.
    pub scalars: Vec<Scalar>,
}

impl Hoisted {
    fn index(&mut self, scalar: Scalar) -> usize {
        work::spend(1 + self.scalars.len() / 32);
        self.scalars.iter().position(|&known| known == scalar).unwrap_or_else(|| {
            self.scalars.push(scalar);
            self.scalars.len() - 1
        })
    }
}

/// Where a kernel finds what changes less often than itself.
pub enum Hoisting<'a> {
    /// It computes everything itself.
    Nothing,
    /// In the stepper's constants.
    Constants(&'a mut Hoisted),
    /// In the stepper's constants and in the terms of the solve.
    Terms(&'a mut Hoisted, &'a mut Hoisted),
}

/// Makes a kernel of grids of outputs.
pub fn kernel(scalars: &mut Scalars, outputs: &[(Shape, Vec<Scalar>)], hoisting: Hoisting<'_>) -> Kernel {
    let (operations, products) = (Interner::default(), Pairs::default());
    let (sums, known, delays) = (Table::default(), Table::default(), Vec::new());
    let mut builder = Builder { scalars, hoisting, operations, products, sums, known, delays };
    let outputs: Vec<(Shape, Vec<Id>)> = outputs
        .iter()
        .map(|(shape, entries)| (*shape, entries.iter().map(|&entry| builder.convert(entry)).collect()))
        .collect();
    builder.share_pairs(&outputs);
    if !builder.scalars.keeps_sums {
        builder.shorten(&outputs);
    }
    builder.code(&outputs)
}

fn entries(outputs: &[(Shape, Vec<Id>)]) -> impl Iterator<Item = Id> {
    outputs.iter().flat_map(|(_, entries)| entries.iter().copied())
}

/// An expression of more operations is cut into terms of its own: compilers recurse into expressions.
const LONGEST_EXPRESSION: usize = 256;
/// An expression that nests deeper is cut too: a parser takes more of its stack for a level than for an operation.
const DEEPEST_EXPRESSION: usize = 24;
/// A sum of more terms is cut into sums, for the same reason.
const LONGEST_SUM: usize = 96;
/// The index of an operation of a kernel.
pub(super) type Id = usize;

/// The operations of a kernel, each of them once.
pub(super) type Operations = Interner<Step>;

/// A step of a kernel on its own steps.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub(super) enum Step {
    /// A scalar that is read or has been taken out.
    Leaf(Scalar),
    Sum(Rational, Vec<(Rational, Id)>),
    Product(Vec<Id>),
    Reciprocal(Id),
    Root(Id, (i64, i64)),
    Function(Function, Id),
    Call(Callee, Vec<(Shape, Vec<Id>)>),
    Output(Id, Callee, Output),
}

impl Step {
    /// The operations that it is made of.
    pub(super) fn operands(&self) -> Vec<Id> {
        match self {
            Step::Leaf(_) => Vec::new(),
            Step::Sum(_, terms) => terms.iter().map(|(_, term)| *term).collect(),
            Step::Product(factors) => factors.clone(),
            Step::Reciprocal(x) | Step::Root(x, _) | Step::Function(_, x) => vec![*x],
            Step::Call(_, arguments) => arguments.iter().flat_map(|(_, entries)| entries.iter().copied()).collect(),
            Step::Output(call, ..) => vec![*call],
        }
    }
}

struct Builder<'a, 'b> {
    scalars: &'a mut Scalars,
    hoisting: Hoisting<'b>,
    operations: Operations,
    /// The factors of products once pairs are shared.
    products: Pairs,
    /// The terms of sums once sums within them are shared, where there are such.
    sums: Table<Id, Vec<(Rational, Id)>>,
    known: Table<Scalar, Id>,
    /// When each operation is done, once code is made of which the longest chain is what takes the time.
    delays: Vec<u32>,
}

impl Builder<'_, '_> {
    /// Rates below which values are taken out of this kernel, slowest first.
    fn slow_rates(&self) -> &'static [Rate] {
        match self.hoisting {
            Hoisting::Nothing => &[],
            Hoisting::Constants(_) => &[Rate::Once],
            Hoisting::Terms(..) => &[Rate::Once, Rate::Step],
        }
    }

    /// Whether a value is simply read: an argument, a number.
    fn is_entry(&self, scalar: Scalar) -> bool {
        match self.scalars.node(scalar) {
            Node::Input(input) => input.role != Role::StepSize,
            Node::Pi => true,
            _ => self.scalars.as_number(scalar).is_some(),
        }
    }

    fn is_hoisted(&self, scalar: Scalar) -> bool {
        !self.is_entry(scalar) && self.slow_rates().contains(&self.scalars.rate(scalar))
    }

    fn intern(&mut self, operation: Step) -> Id {
        work::spend(2 + operation.operands().len());
        self.operations.intern(operation).0
    }

    /// The operation that computes a scalar, slow parts of sums and products taken out.
    fn convert(&mut self, scalar: Scalar) -> Id {
        if let Some(&known) = self.known.get(&scalar) {
            return known;
        }
        let node = self.scalars.node(scalar).clone();
        let id = match node {
            _ if self.is_hoisted(scalar) || self.is_entry(scalar) => self.intern(Step::Leaf(scalar)),
            Node::Sum(constant, terms) => self.convert_sum(constant, terms),
            Node::Product(factors) => {
                let (coefficient, product) = self.convert_product(integer(1), &factors);
                self.scaled(coefficient, product)
            }
            Node::Reciprocal(x) => {
                let x = self.convert(x);
                self.intern(Step::Reciprocal(x))
            }
            Node::Root(x, exponent) => {
                let x = self.convert(x);
                self.intern(Step::Root(x, exponent))
            }
            Node::Function(function, x) => {
                let x = self.convert(x);
                self.intern(Step::Function(function, x))
            }
            Node::Output(call, output) => {
                let (id, callee) = self.convert_call(call);
                self.intern(Step::Output(id, callee, output))
            }
            Node::Input(_) | Node::Pi => self.intern(Step::Leaf(scalar)),
        };
        self.known.insert(scalar, id);
        id
    }

    fn convert_call(&mut self, call: CallId) -> (Id, Callee) {
        let call = self.scalars.call_of(call).clone();
        let arguments = call
            .arguments
            .into_iter()
            .map(|(shape, entries)| (shape, entries.into_iter().map(|entry| self.convert(entry)).collect()));
        let arguments = arguments.collect();
        (self.intern(Step::Call(call.callee.clone(), arguments)), call.callee)
    }

    fn scaled(&mut self, coefficient: Rational, id: Id) -> Id {
        if coefficient == integer(1) { id } else { self.intern(Step::Sum(integer(0), vec![(coefficient, id)])) }
    }

    fn convert_sum(&mut self, mut constant: Rational, mut terms: Vec<(Scalar, Rational)>) -> Id {
        let mut parts = Vec::new();
        for &rate in self.slow_rates() {
            let (slow, fast): (Vec<_>, Vec<_>) =
                terms.into_iter().partition(|(term, _)| self.scalars.rate(*term) == rate);
            terms = fast;
            if slow.is_empty() {
                continue;
            }
            let taken = if rate == Rate::Once { std::mem::replace(&mut constant, integer(0)) } else { integer(0) };
            let group = self.scalars.sum(taken, slow);
            let (coefficient, rest) = self.scalars.factor(group);
            match rest {
                // −x is read as x and subtracted, anything else has its coefficient inside
                Some(rest) if coefficient == integer(-1) => parts.push((coefficient, self.convert(rest))),
                Some(_) => parts.push((integer(1), self.convert(group))),
                None => constant += coefficient,
            }
        }
        for (term, coefficient) in self.collected(terms) {
            parts.push(match self.scalars.node(term).clone() {
                Node::Product(factors) => self.convert_product(coefficient, &factors),
                _ => (coefficient, self.convert(term)),
            });
        }
        while parts.len() > LONGEST_SUM {
            let tail = parts.split_off(parts.len() - LONGEST_SUM);
            let tail = self.intern(Step::Sum(integer(0), tail));
            parts.push((integer(1), tail));
        }
        match parts.as_slice() {
            [(coefficient, only)] if constant == integer(0) && *coefficient == integer(1) => *only,
            _ => self.intern(Step::Sum(constant, parts)),
        }
    }

    /// Terms with their coefficients, those together whose factors differ in constants alone: a x + b x is (a + b) x, with one constant.
    fn collected(&mut self, terms: Vec<(Scalar, Rational)>) -> Vec<(Scalar, Rational)> {
        if !self.slow_rates().contains(&Rate::Once) {
            return terms;
        }
        let mut groups: Table<Vec<(Scalar, u32)>, Vec<usize>> = Table::default();
        for (position, (term, _)) in terms.iter().enumerate() {
            groups.entry(self.fast_factors(*term)).push(position);
        }
        let mut collected = Vec::new();
        for (fast, positions) in groups.iter() {
            match positions.as_slice() {
                [only] => collected.push((*only, terms[*only].clone())),
                [first, ..] => {
                    let slow = positions
                        .iter()
                        .map(|&position| (self.slow_part(terms[position].0), terms[position].1.clone()));
                    let slow: Vec<_> = slow.collect();
                    let factors = fast.iter().flat_map(|&(factor, power)| std::iter::repeat_n(factor, power as usize));
                    let factors: Vec<Scalar> =
                        [self.scalars.sum(integer(0), slow)].into_iter().chain(factors).collect();
                    collected.push((*first, (self.scalars.product(factors), integer(1))));
                }
                [] => {}
            }
        }
        collected.sort_by_key(|(position, _)| *position);
        collected.into_iter().map(|(_, term)| term).collect()
    }

    fn factors(&self, term: Scalar) -> Vec<(Scalar, u32)> {
        match self.scalars.node(term) {
            Node::Product(factors) => factors.clone(),
            _ => vec![(term, 1)],
        }
    }

    fn fast_factors(&self, term: Scalar) -> Vec<(Scalar, u32)> {
        self.factors(term).into_iter().filter(|(factor, _)| self.scalars.rate(*factor) != Rate::Once).collect()
    }

    fn slow_part(&mut self, term: Scalar) -> Scalar {
        let slow = self.factors(term).into_iter().filter(|(factor, _)| self.scalars.rate(*factor) == Rate::Once);
        let slow: Vec<Scalar> = slow.flat_map(|(factor, power)| std::iter::repeat_n(factor, power as usize)).collect();
        self.scalars.product(slow)
    }

    /// Slow factors together and with the magnitude of the coefficient, so that one multiplication is left of them.
    fn convert_product(&mut self, mut coefficient: Rational, factors: &[(Scalar, u32)]) -> (Rational, Id) {
        let repeated = |&(factor, exponent): &(Scalar, u32)| std::iter::repeat_n(factor, exponent as usize);
        let mut factors: Vec<Scalar> = factors.iter().flat_map(repeated).collect();
        let mut parts = Vec::new();
        for &rate in self.slow_rates() {
            let (slow, fast): (Vec<_>, Vec<_>) =
                factors.into_iter().partition(|factor| self.scalars.rate(*factor) == rate);
            factors = fast;
            if slow.is_empty() {
                continue;
            }
            let sign = if coefficient < integer(0) { integer(-1) } else { integer(1) };
            let magnitude = std::mem::replace(&mut coefficient, sign.clone()) * sign;
            let group = self.scalars.product(slow);
            let group = self.scalars.scale(group, magnitude);
            parts.push(self.convert(group));
        }
        for factor in factors {
            parts.push(self.convert(factor));
        }
        parts.sort_unstable();
        match parts.as_slice() {
            [only] => (coefficient, *only),
            _ => (coefficient, self.intern(Step::Product(parts))),
        }
    }

    /// Replaces the pair of factors that most products share by a product of its own, as long as there is one.
    fn share_pairs(&mut self, outputs: &[(Shape, Vec<Id>)]) {
        let used = self.used(outputs);
        let products = used.into_iter().filter_map(|id| match self.operations.value(id) {
            Step::Product(factors) => Some((id, factors.clone())),
            _ => None,
        });
        self.products = Pairs::new(products);
        while let Some((a, b)) = self.products.most_common() {
            let (product, _) = self.operations.intern(Step::Product(vec![a, b]));
            if self.products.get(product).is_none() {
                self.products.insert(product, vec![a, b]);
            }
            self.products.replace((a, b), product);
        }
    }

    /// What the outputs are made of, in the order in which it was met.
    fn used(&self, outputs: &[(Shape, Vec<Id>)]) -> Vec<Id> {
        work::spend(self.operations.len() / 4);
        let mut is_used = vec![false; self.operations.len()];
        let mut waiting: Vec<Id> = entries(outputs).collect();
        while let Some(id) = waiting.pop() {
            if !std::mem::replace(&mut is_used[id], true) {
                waiting.extend(self.operands(id));
            }
        }
        (0..is_used.len()).filter(|&id| is_used[id]).collect()
    }

    fn terms<'t>(&'t self, id: Id, terms: &'t [(Rational, Id)]) -> &'t [(Rational, Id)] {
        self.sums.get(&id).map_or(terms, Vec::as_slice)
    }

    fn operands(&self, id: Id) -> Vec<Id> {
        match self.operations.value(id) {
            Step::Sum(_, terms) => self.terms(id, terms).iter().map(|(_, term)| *term).collect(),
            Step::Product(factors) => self.products.get(id).unwrap_or(factors).to_vec(),
            operation => operation.operands(),
        }
    }

    fn code(mut self, outputs: &[(Shape, Vec<Id>)]) -> Kernel {
        let mut uses = vec![0; self.operations.len()];
        let mut order = Vec::new();
        for entry in entries(outputs) {
            self.count(entry, &mut uses, &mut order);
        }
        let mut locals = Vec::new();
        let mut names: Table<Id, usize> = Table::default();
        let (mut sizes, mut depths) = (vec![0; self.operations.len()], vec![0; self.operations.len()]);
        let delays = self.delays_in(&order);
        // where it is not, sums by pairs would only take registers
        if !self.scalars.keeps_sums && self.waits(outputs, &delays) {
            self.delays = delays;
        }
        for id in order {
            let operands = self.operands(id);
            let inner = || operands.iter().filter(|&operand| !names.contains(operand));
            sizes[id] = 1 + inner().map(|&operand| sizes[operand]).sum::<usize>();
            depths[id] = 1 + inner().map(|&operand| depths[operand]).max().unwrap_or(0);
            let long = sizes[id] > LONGEST_EXPRESSION || depths[id] > DEEPEST_EXPRESSION;
            if matches!(self.operations.value(id), Step::Call(..)) || (uses[id] > 1 || long) && self.is_shared(id) {
                let code = self.operation(id, &names);
                locals.push(code);
                names.insert(id, locals.len() - 1);
            }
        }
        let mut grids = Vec::new();
        for (shape, entries) in outputs {
            grids.push((*shape, entries.iter().map(|&entry| self.reference(entry, &names)).collect()));
        }
        Kernel { locals, outputs: grids }
    }

    fn count(&self, id: Id, uses: &mut [usize], order: &mut Vec<Id>) {
        work::spend(1);
        uses[id] += 1;
        let is_first = uses[id] == 1;
        // what has no name of its own is written out at each use
        if is_first || !self.is_shared(id) {
            for operand in self.operands(id) {
                self.count(operand, uses, order);
            }
        }
        if is_first {
            order.push(id);
        }
    }

    /// Whether a value is worth a name of its own when it is used more than once: a read or a change of sign is not.
    fn is_shared(&self, id: Id) -> bool {
        match self.operations.value(id) {
            Step::Leaf(_) | Step::Output(..) => false,
            Step::Sum(constant, terms) => {
                let terms = self.terms(id, terms);
                !(terms.is_empty()
                    || constant.is_zero() && terms.len() == 1 && [integer(1), integer(-1)].contains(&terms[0].0))
            }
            _ => true,
        }
    }

    fn reference(&mut self, id: Id, names: &Table<Id, usize>) -> Code {
        match names.get(&id) {
            Some(&local) => Code::Local(local),
            None => self.operation(id, names),
        }
    }

    fn operation(&mut self, id: Id, names: &Table<Id, usize>) -> Code {
        match self.operations.value(id).clone() {
            Step::Leaf(scalar) => self.leaf(scalar),
            Step::Sum(constant, terms) => {
                let terms = self.terms(id, &terms).to_vec();
                if terms.is_empty() {
                    return Code::Number(constant);
                }
                let delays: Vec<u32> = match self.delays.is_empty() {
                    true => Vec::new(),
                    false => terms.iter().map(|term| delay_of_term(&self.delays, term)).collect(),
                };
                let terms: Vec<_> =
                    terms.into_iter().map(|(coefficient, term)| (coefficient, self.reference(term, names))).collect();
                match delays.is_empty() {
                    true => Code::Sum(constant, terms),
                    false => balance::balanced(constant, terms.into_iter().zip(delays)),
                }
            }
            Step::Product(_) => {
                let factors = self.operands(id);
                Code::Product(factors.into_iter().map(|factor| self.reference(factor, names)).collect())
            }
            Step::Reciprocal(x) => Code::reciprocal(self.reference(x, names)),
            Step::Root(x, exponent) => Code::Root(Box::new(self.reference(x, names)), exponent),
            Step::Function(function, x) => Code::Function(function, Box::new(self.reference(x, names))),
            Step::Call(callee, arguments) => {
                let argument = |(shape, entries): (Shape, Vec<Id>)| {
                    (shape, entries.into_iter().map(|entry| self.reference(entry, names)).collect())
                };
                Code::Call(callee, arguments.into_iter().map(argument).collect())
            }
            // by construction: calls are always shared terms, and come before their entries
            Step::Output(call, callee, output) => Code::Output(names.get(&call).copied().unwrap_or(0), callee, output),
        }
    }

    fn leaf(&mut self, scalar: Scalar) -> Code {
        let hoisted = self.is_hoisted(scalar);
        let rate = self.scalars.rate(scalar);
        match (&mut self.hoisting, self.scalars.node(scalar)) {
            (Hoisting::Terms(_, terms), _) if rate == Rate::Step => Code::Term(terms.index(scalar)),
            (Hoisting::Terms(constants, _) | Hoisting::Constants(constants), _) if hoisted => {
                Code::Constant(constants.index(scalar))
            }
            (_, Node::Input(input)) => Code::Read(input.clone()),
            (_, Node::Pi) => Code::Pi,
            (_, Node::Sum(value, _)) => Code::Number(value.clone()),
            // by construction: leaves are entries or have been taken out
            (_, node) => unreachable!("a leaf that is neither read nor taken out: {node:?}"),
        }
    }
}
