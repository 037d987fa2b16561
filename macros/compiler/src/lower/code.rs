//! Code: the operations of kernels, and the terms and arguments that they read.

use clebsch_symbolic::{Elements, Function, IntoElements, IntoList, Operation, Rational, Role, Shape, integer};

use super::scalar::{Callee, Output, is_unit};
use super::{Cost, Input};

/// An expression that nests deeper is cut into terms of its own. A parser takes more of its stack for a level than for
/// an operation.
pub(super) const DEEPEST_EXPRESSION: usize = 24;

/// Straight-line code of one output entry or shared term.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
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
    /// A matrix operation: a shared term, or an entry of one.
    Whole(Box<Whole>),
}

/// An operation on matrices, in matrix code.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub struct Whole {
    /// The operation.
    pub operation: MatrixOperation,
    /// Its operands.
    pub operands: Vec<Code>,
    /// The shape of the result.
    pub shape: Shape,
    /// Its scalar operations.
    pub cost: Cost,
}

/// Operations on matrices.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub enum MatrixOperation {
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
    /// An operation of expressions on one matrix; bases have operations of their own.
    Of(Operation),
    /// The value of an opaque potential.
    Value,
    /// A leaf of its gradient, by the number of the argument.
    Gradient(usize),
    /// The product entry by entry.
    Hadamard,
    /// x^ in the basis of so(3).
    Hat,
    /// ⟨A, E_k⟩ in that basis.
    Axial,
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
    /// The largest |A_ij|.
    Largest,
    /// The entry (i, j).
    Entry(usize, usize),
}

impl MatrixOperation {
    /// Whether the sign of an operand is that of the result; of sums each term has its own.
    pub(super) fn is_linear(&self) -> bool {
        use MatrixOperation::*;
        use Operation::{Analytic, Determinant, Inverse};
        !matches!(self, Entries | Shifted | Value | Gradient(_) | Largest | Of(Inverse | Analytic(_) | Determinant))
    }
}

/// Straight-line code.
#[derive(Clone, Default, Debug)]
pub struct Kernel {
    /// Shared terms, each in terms of those before it.
    pub locals: Vec<Code>,
    /// The outputs, one grid for each value returned.
    pub outputs: Vec<(Shape, Vec<Code>)>,
}

/// Where a shared term stands when terms are put into each other.
enum Place {
    /// It is left out: nothing is made of it.
    Nowhere,
    /// It is written where it is used.
    Inside,
    /// It is a shared term.
    Named,
}

impl Kernel {
    pub(super) fn entries(&self) -> impl Iterator<Item = &Code> {
        self.outputs.iter().flat_map(|(_, entries)| entries)
    }

    /// Whether all of its entries are zero.
    pub fn vanishes(&self) -> bool {
        self.entries().all(|entry| matches!(entry, Code::Number(value) if value.is_zero()))
    }

    /// Looks at the code of its terms and outputs, and at all parts of it.
    pub(super) fn visit<'a>(&'a self, see: &mut dyn FnMut(&'a Code)) {
        self.locals.iter().chain(self.entries()).for_each(|code| code.visit(see));
    }

    /// The arguments that it reads, as matrices or by entries, with their shapes. An argument is listed as often as it
    /// occurs.
    pub fn inputs(&self) -> Vec<(&Input, Shape)> {
        let mut inputs = Vec::new();
        self.visit(&mut |code| inputs.extend(code.input()));
        inputs
    }

    /// Which of its terms depend on an argument of a role that is wanted.
    pub fn depends_on(&self, wanted: impl Fn(Role) -> bool) -> Vec<bool> {
        let mut depends: Vec<bool> = Vec::new();
        for code in &self.locals {
            let mut found = code.locals().into_iter().any(|index| depends[index]);
            code.visit(&mut |part| found |= part.input().is_some_and(|(input, _)| wanted(input.role)));
            depends.push(found);
        }
        depends
    }

    /// How often each of its terms occurs in the code of some outputs.
    fn uses(&self, outputs: &[(Shape, Vec<Code>)]) -> Vec<usize> {
        let mut uses = vec![0_usize; self.locals.len()];
        outputs.iter().flat_map(|(_, entries)| entries).flat_map(Code::locals).for_each(|index| uses[index] += 1);
        for index in (0..self.locals.len()).rev() {
            if uses[index] > 0 {
                self.locals[index].locals().into_iter().for_each(|other| uses[other] += 1);
            }
        }
        uses
    }

    /// The same without terms that no output is made of; a term that is an output and stands nowhere else is written there.
    pub(super) fn without_unused(self) -> Kernel {
        let uses = self.uses(&self.outputs);
        let outputs: Vec<usize> = self.entries().filter_map(Code::as_local).into_list();
        self.placed(|index| match uses[index] {
            0 => Place::Nowhere,
            1 if outputs.contains(&index) => Place::Inside,
            _ => Place::Named,
        })
    }

    /// The same with each shared term that is used once in its place, where its type is known without a name.
    pub(super) fn nested(self) -> Kernel {
        let uses = self.uses(&self.outputs);
        // the type of a returned value is known
        let outputs = self.outputs.iter().filter(|(_, entries)| entries.len() == 1);
        let returned: Vec<usize> = outputs.flat_map(|(_, entries)| entries[0].as_local()).into_list();
        let mut depths: Vec<usize> = Vec::new();
        self.placed(|index| {
            let code = &self.locals[index];
            let depth = 1 + code.locals().into_iter().map(|other| depths[other]).max().unwrap_or(0);
            let has_place = !code.needs_name() || returned.contains(&index);
            let is_inside = uses[index] == 1 && has_place && depth <= DEEPEST_EXPRESSION;
            depths.push(if is_inside { depth } else { 0 });
            if is_inside { Place::Inside } else { Place::Named }
        })
    }

    /// The same with each shared term at the place that it is given.
    fn placed(&self, mut place: impl FnMut(usize) -> Place) -> Kernel {
        let (mut places, mut locals): (Vec<Code>, Vec<Code>) = (Vec::new(), Vec::new());
        for (index, code) in self.locals.iter().enumerate() {
            let put_in = || code.with_locals(&|other: usize| places[other].clone());
            let placed = match place(index) {
                Place::Nowhere => Code::Local(index),
                Place::Inside => put_in(),
                Place::Named => {
                    locals.push(put_in());
                    Code::Local(locals.len() - 1)
                }
            };
            places.push(placed);
        }
        Kernel { locals, outputs: self.outputs_by(|entry| entry.with_locals(&|index| places[index].clone())) }
    }

    /// Its outputs with other entries.
    pub(super) fn outputs_by(&self, other: impl Fn(&Code) -> Code) -> Vec<(Shape, Vec<Code>)> {
        self.outputs.each(|(shape, entries)| (*shape, entries.each(&other)))
    }

    /// Its outputs, where each is an entry of an argument.
    pub(super) fn reads(&self) -> Option<Vec<Code>> {
        let outputs = self.outputs.iter().map(|(_, entries)| match &entries[..] {
            [read @ Code::Read(_)] => Some(read.clone()),
            _ => None,
        });
        outputs.collect()
    }

    /// The same with other codes for terms that are computed once per solve.
    pub(super) fn with_terms(&self, terms: &[Code]) -> Kernel {
        let put_in = |code: &Code| match code {
            Code::Term(index) => Some(terms[*index].clone()),
            _ => None,
        };
        let mapped = |code: &Code| code.clone().mapped(&put_in);
        Kernel { locals: self.locals.each(mapped), outputs: self.outputs_by(mapped) }
    }

    /// Which of its terms an output is made of.
    pub fn needed_by(&self, output: usize) -> Vec<bool> {
        self.uses(&self.outputs[output..=output]).into_each(|uses| uses > 0)
    }
}

/// Whether a sum is written in brackets next to a multiplication. A number needs none, nor does one term with a
/// positive number before it. One term alone has brackets that decide how it is rounded.
pub fn is_in_brackets(constant: &Rational, terms: &[(Rational, Code)]) -> bool {
    match terms {
        [] => constant.is_negative(),
        [(weight, _)] => *constant != integer(0) || weight.is_negative() || *weight == integer(1),
        _ => true,
    }
}

impl Code {
    /// A product as a quotient: the factors above and those below, where one of them is a reciprocal that is used here alone.
    pub(crate) fn quotient(factors: &[Code]) -> Option<(Vec<&Code>, Vec<&Code>)> {
        let (mut above, mut below): (Vec<&Code>, Vec<&Code>) = (Vec::new(), Vec::new());
        for factor in factors {
            match factor {
                Code::Reciprocal(x) => below.push(x),
                factor => above.push(factor),
            }
        }
        (!below.is_empty()).then_some((above, below))
    }

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
                Code::Sum(constant, terms) if is_unit(coefficient) => {
                    let (constant, terms) = Code::summands(constant, terms);
                    total += constant * coefficient;
                    all.extend(terms.into_iter().map(|(weight, term)| (weight * coefficient, term)));
                }
                _ => all.push((coefficient.clone(), term.clone())),
            }
        }
        (total, all)
    }

    fn as_local(&self) -> Option<usize> {
        if let Code::Local(index) = self { Some(*index) } else { None }
    }

    /// Whether it is a matrix whose size only the type of a name says.
    pub(crate) fn needs_name(&self) -> bool {
        let Code::Whole(whole) = self else { return false };
        use MatrixOperation::*;
        matches!(whole.operation, Of(Operation::Embed(..)) | Skew | SkewComponents | SkewOuter)
    }

    /// The argument that it reads, as a matrix or by an entry, with the shape of the argument.
    fn input(&self) -> Option<(&Input, Shape)> {
        match self {
            Code::Read(input) => Some((input, Shape::scalar())),
            Code::Whole(whole) => match &whole.operation {
                MatrixOperation::Argument(input) => Some((input, whole.shape)),
                _ => None,
            },
            _ => None,
        }
    }

    /// Looks at it and at all its parts, each before those that it is made of.
    pub(super) fn visit<'a>(&'a self, see: &mut dyn FnMut(&'a Code)) {
        see(self);
        match self {
            Code::Sum(_, terms) => terms.iter().for_each(|(_, term)| term.visit(see)),
            Code::Product(factors) => factors.iter().for_each(|factor| factor.visit(see)),
            Code::Reciprocal(x) | Code::Root(x, _) | Code::PerOnePlusCosine(x) | Code::Function(_, x) => x.visit(see),
            Code::Call(_, arguments) => arguments.iter().flat_map(|(_, all)| all).for_each(|entry| entry.visit(see)),
            Code::Whole(whole) => whole.operands.iter().for_each(|operand| operand.visit(see)),
            Code::Read(_) | Code::Pi | Code::Number(_) => {}
            Code::Constant(_) | Code::Term(_) | Code::Local(_) | Code::Output(..) => {}
        }
    }

    /// The shared terms that it stands on, by their indices.
    pub(super) fn locals(&self) -> Vec<usize> {
        let mut locals = Vec::new();
        self.visit(&mut |part| {
            if let Code::Local(index) | Code::Output(index, ..) = part {
                locals.push(*index);
            }
        });
        locals
    }

    /// An operation on matrices.
    pub(super) fn whole(operation: MatrixOperation, operands: Vec<Code>, shape: Shape, cost: Cost) -> Code {
        Code::Whole(Box::new(Whole { operation, operands, shape, cost }))
    }

    /// The same with other codes for its shared terms.
    pub(super) fn with_locals(&self, other: &impl Fn(usize) -> Code) -> Code {
        self.clone().mapped(&|part| match part {
            Code::Local(index) => Some(other(*index)),
            Code::Output(index, callee, output) => match other(*index) {
                Code::Local(index) => Some(Code::Output(index, callee.clone(), *output)),
                // by construction: calls are terms wherever they are put in
                _ => None,
            },
            _ => None,
        })
    }

    /// The same with other codes for some of its parts.
    fn mapped(self, other: &impl Fn(&Code) -> Option<Code>) -> Code {
        other(&self).unwrap_or_else(|| self.of(&mut |part| part.mapped(other)))
    }

    /// The same operation of other codes.
    pub(super) fn of(self, other: &mut dyn FnMut(Code) -> Code) -> Code {
        match self {
            Code::Sum(constant, terms) => Code::Sum(constant, terms.into_each(|(weight, term)| (weight, other(term)))),
            Code::Product(factors) => Code::Product(factors.into_each(other)),
            Code::Reciprocal(x) => Code::Reciprocal(Box::new(other(*x))),
            Code::Root(x, exponent) => Code::Root(Box::new(other(*x)), exponent),
            Code::PerOnePlusCosine(x) => Code::PerOnePlusCosine(Box::new(other(*x))),
            Code::Function(function, x) => Code::Function(function, Box::new(other(*x))),
            Code::Call(callee, arguments) => {
                let mut each = |entries: Vec<Code>| entries.into_each(&mut *other);
                Code::Call(callee, arguments.into_each(|(shape, entries)| (shape, each(entries))))
            }
            Code::Whole(mut whole) => {
                whole.operands = whole.operands.into_each(other);
                Code::Whole(whole)
            }
            read => read,
        }
    }
}
