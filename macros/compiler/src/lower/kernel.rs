//! Kernels: straight-line code for some outputs. Terms that change less often are hoisted, and common terms are shared.

mod angles;
mod hoisted;
mod proportional;
mod shorten;

use clebsch_symbolic::{
    Elements, Function, Interner, IntoElements, IntoList, Rational, Role, Shape, Table, integer, work,
};

use super::balance;
use super::code::DEEPEST_EXPRESSION;
use super::entries::Grid;
use super::pairs::Pairs;
use super::scalar::{Callee, Factors, Output};
use super::signs;
use super::{Code, Kernel, Rate, Scalar, ScalarNode, Scalars};
pub use hoisted::Hoisted;
use shorten::delay_of_term;

/// Where a kernel finds the terms that change less often than itself.
pub enum Hoisting<'a> {
    /// It computes everything itself.
    Nothing,
    /// In the stepper's constants.
    Constants(&'a mut Hoisted),
    /// In the stepper's constants and in the terms of the solve.
    Terms(&'a mut Hoisted, &'a mut Hoisted),
    /// In the stepper's constants and in the terms of a time.
    Times(&'a mut Hoisted, &'a mut Hoisted),
}

/// Makes a kernel of grids of outputs.
pub fn kernel(scalars: &mut Scalars, outputs: &[Grid], hoisting: Hoisting<'_>) -> Kernel {
    let is_iterated = matches!(hoisting, Hoisting::Terms(..));
    let (operations, products) = (Interner::default(), Pairs::default());
    let (sums, known, delays) = (Table::default(), Table::default(), Vec::new());
    let (angles, entries) = (Vec::new(), Vec::new());
    let mut builder =
        Builder { scalars, hoisting, angles, outputs: entries, operations, products, sums, known, delays };
    builder.angles = builder.angles_of(outputs);
    for entry in outputs.iter().flat_map(|grid| &grid.entries) {
        let entry = builder.convert(*entry);
        builder.outputs.push(entry);
    }
    if !builder.is_beyond_limits() {
        builder.shorten();
    }
    let (locals, entries) = builder.code();
    let mut entries = entries.into_iter();
    let output = |grid: &Grid| (grid.shape, entries.by_ref().take(grid.entries.len()).into_list());
    signs::moved(Kernel { locals, outputs: outputs.each(output) }, is_iterated)
}

/// Factors as often as they stand in a product.
fn repeated(factors: &[(Scalar, u32)]) -> impl Iterator<Item = Scalar> {
    factors.iter().flat_map(|&(factor, power)| std::iter::repeat_n(factor, power as usize))
}

/// An expression of more operations is cut into terms of its own: compilers recurse into expressions.
const LONGEST_EXPRESSION: usize = 256;
/// A sum of more terms is cut into sums, for the same reason.
const LONGEST_SUM: usize = 96;
/// The index of an operation of a kernel.
pub(super) type Id = usize;

/// The operations of a kernel, each of them once.
pub(super) type Operations = Interner<Operation>;

/// An operation of a kernel on its own operations.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub(super) enum Operation {
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

impl Operation {
    pub(super) fn operands(&self) -> Vec<Id> {
        match self {
            Operation::Leaf(_) => Vec::new(),
            Operation::Sum(_, terms) => terms.each(|(_, term)| *term),
            Operation::Product(factors) => factors.clone(),
            Operation::Reciprocal(x) | Operation::Root(x, _) | Operation::Function(_, x) => vec![*x],
            Operation::Call(_, arguments) => {
                arguments.iter().flat_map(|(_, entries)| entries.iter().copied()).into_list()
            }
            Operation::Output(call, ..) => vec![*call],
        }
    }
}

struct Builder<'a, 'b> {
    scalars: &'a mut Scalars,
    hoisting: Hoisting<'b>,
    /// Angles whose sine and cosine come from one call.
    angles: Vec<Scalar>,
    /// The entries of all outputs.
    outputs: Vec<Id>,
    operations: Operations,
    /// The factors of products once pairs are shared.
    products: Pairs,
    /// The terms of sums once sums within them are shared, where there are such.
    sums: Table<Id, Vec<(Rational, Id)>>,
    known: Table<Scalar, Id>,
    /// The time at which each operation is done, if the longest chain of operations determines the time of the code.
    delays: Vec<u32>,
}

impl Builder<'_, '_> {
    /// Rates below which values are taken out of this kernel, slowest first.
    fn slow_rates(&self) -> &'static [Rate] {
        match self.hoisting {
            Hoisting::Nothing => &[],
            Hoisting::Constants(_) => &[Rate::Once],
            Hoisting::Terms(..) => &[Rate::Once, Rate::Step],
            Hoisting::Times(..) => &[Rate::Once, Rate::Time],
        }
    }

    /// How often a value changes. A value of a time is fixed during a step where times are not told apart.
    fn rate(&self, scalar: Scalar) -> Rate {
        match (self.scalars.rate(scalar), &self.hoisting) {
            (Rate::Time, Hoisting::Nothing | Hoisting::Constants(_) | Hoisting::Terms(..)) => Rate::Step,
            (rate, _) => rate,
        }
    }

    /// Whether a value is simply read: an argument, a number.
    fn is_entry(&self, scalar: Scalar) -> bool {
        match self.scalars.node(scalar) {
            ScalarNode::Input(input) => input.role != Role::StepSize,
            ScalarNode::Pi => true,
            _ => self.scalars.as_number(scalar).is_some(),
        }
    }

    fn is_hoisted(&self, scalar: Scalar) -> bool {
        !self.is_entry(scalar) && self.slow_rates().contains(&self.rate(scalar))
    }

    fn intern(&mut self, operation: Operation) -> Id {
        work::spend(20 + 4 * operation.operands().len());
        self.operations.intern(operation).0
    }

    /// The operation that computes a scalar, slow parts of sums and products taken out.
    fn convert(&mut self, scalar: Scalar) -> Id {
        if let Some(&known) = self.known.get(&scalar) {
            return known;
        }
        let node = self.scalars.node(scalar).clone();
        let id = match node {
            _ if self.is_hoisted(scalar) || self.is_entry(scalar) => self.intern(Operation::Leaf(scalar)),
            ScalarNode::Sum(constant, terms) => self.convert_sum(constant, terms),
            ScalarNode::Product(factors) => match self.convert_product(integer(1), &factors) {
                (coefficient, product) if coefficient == integer(1) => product,
                scaled => self.intern(Operation::Sum(integer(0), vec![scaled])),
            },
            node => {
                let operation = match node {
                    ScalarNode::Reciprocal(x) => Operation::Reciprocal(self.convert(x)),
                    ScalarNode::Root(x, exponent) => Operation::Root(self.convert(x), exponent),
                    ScalarNode::Function(function @ (Function::Sin | Function::Cos), x) if self.angles.contains(&x) => {
                        self.sine_or_cosine(function, x)
                    }
                    ScalarNode::Function(function, x) => Operation::Function(function, self.convert(x)),
                    ScalarNode::Output(call, output) => {
                        let (callee, arguments) = self.scalars.call_of(call).clone();
                        let mut entries = |grid: &Grid| grid.entries.each(|entry| self.convert(*entry));
                        let arguments = arguments.each(|grid| (grid.shape, entries(grid)));
                        let id = self.intern(Operation::Call(callee.clone(), arguments));
                        Operation::Output(id, callee, output)
                    }
                    _ => Operation::Leaf(scalar),
                };
                self.intern(operation)
            }
        };
        self.known.insert(scalar, id);
        id
    }

    fn convert_sum(&mut self, mut constant: Rational, mut terms: Vec<(Scalar, Rational)>) -> Id {
        let mut parts = Vec::new();
        for &rate in self.slow_rates() {
            let (slow, fast): (Vec<_>, Vec<_>) = terms.into_iter().partition(|(term, _)| self.rate(*term) == rate);
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
                ScalarNode::Product(factors) => self.convert_product(coefficient, &factors),
                _ => (coefficient, self.convert(term)),
            });
        }
        while parts.len() > LONGEST_SUM {
            let tail = parts.split_off(parts.len() - LONGEST_SUM);
            let tail = self.intern(Operation::Sum(integer(0), tail));
            parts.push((integer(1), tail));
        }
        match parts.as_slice() {
            [(coefficient, only)] if constant == integer(0) && *coefficient == integer(1) => *only,
            _ => self.intern(Operation::Sum(constant, parts)),
        }
    }

    /// Terms with their coefficients, those together whose factors differ in constants alone: a x + b x is (a + b) x, with one constant.
    fn collected(&mut self, terms: Vec<(Scalar, Rational)>) -> Vec<(Scalar, Rational)> {
        if !self.slow_rates().contains(&Rate::Once) {
            return terms;
        }
        let mut groups: Table<Factors, Vec<(usize, Factors)>> = Table::default();
        for (position, (term, _)) in terms.iter().enumerate() {
            let is_slow = |(factor, _): &(Scalar, u32)| self.scalars.rate(*factor) == Rate::Once;
            let (slow, fast) = self.scalars.factors(*term).into_iter().partition(is_slow);
            groups.entry(fast).push((position, slow));
        }
        let collect = |(fast, members): (&Factors, &Vec<(usize, Factors)>)| {
            if let [(only, _)] = members[..] {
                return terms[only].clone();
            }
            let slow = |(position, slow): &(usize, Factors)| {
                (self.scalars.product(repeated(slow)), terms[*position].1.clone())
            };
            let slow: Vec<_> = members.each(slow);
            let slow = self.scalars.sum(integer(0), slow);
            (self.scalars.product([slow].into_iter().chain(repeated(fast))), integer(1))
        };
        groups.iter().map(collect).into_list()
    }

    /// Slow factors together and with the magnitude of the coefficient, so that one multiplication is left of them.
    fn convert_product(&mut self, mut coefficient: Rational, factors: &[(Scalar, u32)]) -> (Rational, Id) {
        let mut factors: Vec<Scalar> = repeated(factors).into_list();
        let mut parts = Vec::new();
        for &rate in self.slow_rates() {
            let (slow, fast): (Vec<_>, Vec<_>) = factors.into_iter().partition(|factor| self.rate(*factor) == rate);
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
        parts.extend(factors.into_iter().map(|factor| self.convert(factor)));
        parts.sort_unstable();
        match parts.as_slice() {
            [only] => (coefficient, *only),
            _ => (coefficient, self.intern(Operation::Product(parts))),
        }
    }

    /// Replaces the pair of factors that most products share by a product of its own, as long as there is one.
    fn share_pairs(&mut self) {
        self.share_pairs_of(Self::flat);
    }

    /// The same of the factors that `flat` makes of those of a product.
    fn share_pairs_of(&mut self, flat: fn(&Self, &[Id]) -> Vec<Id>) {
        let used = self.used();
        let divides = |id: &Id| matches!(self.operations.value(*id), Operation::Reciprocal(_));
        let mut divisors = vec![false; self.operations.len()];
        used.iter().filter(|id| divides(id)).for_each(|id| divisors[*id] = true);
        let products = used.into_iter().filter_map(|id| match self.operations.value(id) {
            Operation::Product(factors) => Some((id, flat(self, factors))),
            _ => None,
        });
        self.products = Pairs::new(products, divisors);
        while let Some((a, b)) = self.products.most_common() {
            let (product, _) = self.operations.intern(Operation::Product(vec![a, b]));
            if self.products.get(product).is_none() {
                self.products.insert(product, vec![a, b]);
            }
            self.products.replace((a, b), product);
        }
    }

    /// The operations of the outputs, in the order in which they were met.
    fn used(&self) -> Vec<Id> {
        work::spend(1 + self.operations.len() / 2);
        let mut is_used = vec![false; self.operations.len()];
        let mut waiting = self.outputs.clone();
        while let Some(id) = waiting.pop() {
            if !std::mem::replace(&mut is_used[id], true) {
                self.each_operand(id, |operand| waiting.push(operand));
            }
        }
        (0..is_used.len()).filter(|&id| is_used[id]).into_list()
    }

    fn terms<'t>(&'t self, id: Id, terms: &'t [(Rational, Id)]) -> &'t [(Rational, Id)] {
        self.sums.get(&id).map_or(terms, Vec::as_slice)
    }

    fn operands(&self, id: Id) -> Vec<Id> {
        match self.operations.value(id) {
            Operation::Sum(_, terms) => self.terms(id, terms).each(|(_, term)| *term),
            Operation::Product(factors) => self.products.get(id).unwrap_or(factors).to_vec(),
            operation => operation.operands(),
        }
    }

    /// Hands the operands on, one after the other, without a list of them.
    fn each_operand(&self, id: Id, mut visit: impl FnMut(Id)) {
        match self.operations.value(id) {
            Operation::Sum(_, terms) => self.terms(id, terms).iter().for_each(|(_, term)| visit(*term)),
            Operation::Product(factors) => {
                self.products.get(id).unwrap_or(factors).iter().for_each(|factor| visit(*factor));
            }
            operation => operation.operands().into_iter().for_each(visit),
        }
    }

    /// The codes of shared terms and of the outputs.
    fn code(mut self) -> (Vec<Code>, Vec<Code>) {
        let (uses, order) = self.uses();
        let mut locals = Vec::new();
        let mut names: Table<Id, usize> = Table::default();
        let (mut sizes, mut depths) = (vec![0; self.operations.len()], vec![0; self.operations.len()]);
        let delays = self.delays_in(&order);
        // where it is not, sums by pairs would only take registers
        if !self.scalars.keeps_sums && self.waits(&delays) {
            self.delays = delays;
        }
        for id in order {
            let operands = self.operands(id);
            let inner = || operands.iter().filter(|&operand| !names.contains(operand));
            sizes[id] = 1 + inner().map(|&operand| sizes[operand]).sum::<usize>();
            depths[id] = 1 + inner().map(|&operand| depths[operand]).max().unwrap_or(0);
            let long = sizes[id] > LONGEST_EXPRESSION || depths[id] > DEEPEST_EXPRESSION;
            if matches!(self.operations.value(id), Operation::Call(..)) || (uses[id] > 1 || long) && self.is_shared(id)
            {
                let code = self.operation(id, &names);
                locals.push(code);
                names.insert(id, locals.len() - 1);
            }
        }
        let outputs = self.outputs.clone();
        (locals, outputs.into_each(|entry| self.reference(entry, &names)))
    }

    /// How often each operation stands in the code, and the operations behind their operands.
    fn uses(&self) -> (Vec<usize>, Vec<Id>) {
        let (mut uses, mut order) = (vec![0; self.operations.len()], Vec::new());
        self.outputs.iter().for_each(|&entry| self.count(entry, &mut uses, &mut order));
        (uses, order)
    }

    fn count(&self, id: Id, uses: &mut [usize], order: &mut Vec<Id>) {
        work::spend(6);
        uses[id] += 1;
        let is_first = uses[id] == 1;
        // an operation without a name of its own is repeated at each use
        if is_first || !self.is_shared(id) {
            for operand in self.operands(id) {
                self.count(operand, uses, order);
            }
        }
        if is_first {
            order.push(id);
        }
    }

    /// Whether a value deserves a name of its own when it is used more than once. A read or a change of sign does not.
    fn is_shared(&self, id: Id) -> bool {
        match self.operations.value(id) {
            Operation::Leaf(_) | Operation::Output(..) => false,
            Operation::Sum(constant, terms) => {
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
            Operation::Leaf(scalar) => self.leaf(scalar),
            Operation::Sum(constant, terms) => {
                let terms = self.terms(id, &terms).to_vec();
                if terms.is_empty() {
                    return Code::Number(constant);
                }
                let code = |(weight, term): &(Rational, Id)| (weight.clone(), self.reference(*term, names));
                let codes: Vec<_> = terms.each(code);
                if self.delays.is_empty() {
                    return Code::Sum(constant, codes);
                }
                let delays = terms.iter().map(|term| delay_of_term(&self.delays, term));
                balance::balanced(constant, codes.into_iter().zip(delays))
            }
            Operation::Product(_) => {
                let factors = self.operands(id);
                Code::Product(factors.into_each(|factor| self.reference(factor, names)))
            }
            Operation::Reciprocal(x) => Code::reciprocal(self.reference(x, names)),
            Operation::Root(x, exponent) => Code::Root(Box::new(self.reference(x, names)), exponent),
            Operation::Function(function, x) => Code::Function(function, Box::new(self.reference(x, names))),
            Operation::Call(callee, arguments) => {
                let argument = |(shape, entries): (Shape, Vec<Id>)| {
                    (shape, entries.into_each(|entry| self.reference(entry, names)))
                };
                Code::Call(callee, arguments.into_each(argument))
            }
            // by construction: calls are always shared terms, and come before their entries
            Operation::Output(call, callee, output) => {
                Code::Output(names.get(&call).copied().unwrap_or(0), callee, output)
            }
        }
    }

    fn leaf(&mut self, scalar: Scalar) -> Code {
        let hoisted = self.is_hoisted(scalar);
        let rate = self.rate(scalar);
        let (known, kind): (_, fn(usize) -> Code) = match &mut self.hoisting {
            Hoisting::Terms(_, terms) if rate == Rate::Step => (terms, Code::Term),
            Hoisting::Times(_, terms) if hoisted && rate == Rate::Time => (terms, Code::Term),
            Hoisting::Terms(constants, _) | Hoisting::Times(constants, _) | Hoisting::Constants(constants)
                if hoisted =>
            {
                (constants, Code::Constant)
            }
            _ => match self.scalars.node(scalar) {
                ScalarNode::Input(input) => return Code::Read(input.clone()),
                ScalarNode::Pi => return Code::Pi,
                ScalarNode::Sum(value, _) => return Code::Number(value.clone()),
                // by construction: leaves are entries or have been taken out
                node => unreachable!("a leaf that is neither read nor taken out: {node:?}"),
            },
        };
        let (is_negative, place) = known.index(self.scalars, scalar);
        if is_negative { Code::Sum(integer(0), vec![(integer(-1), kind(place))]) } else { kind(place) }
    }
}
