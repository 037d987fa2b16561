//! Signs: each stands between the terms of a sum or at the head of a value, never before a factor and never twice.
//!
//! (−a) b = −(a b), a − (−b) = a + b, −a − b = −(a + b) and a + b = b + a hold to the last bit: numbers are rounded alike on both sides of
//! zero. Terms are otherwise added as before, so that nothing else than the sign of a zero changes.
//!
//! A shared term −a − b is computed as it is where a does not change in the loop of a solve: −a is made once. Where a changes, a + b is computed and
//! then subtracted.

use clebsch_symbolic::{Interner, One, Rational, Shape, Zero, integer, work};

use super::{Code, Cost, Kernel, MatrixOperation, Whole};

/// A code that begins with no sign, and whether its negative is meant.
type Signed = (bool, Code);

/// A kernel with its signs moved and with terms that are then the same as one. Its sums may be in any order, in which terms that are added come before those that are subtracted; sums of
/// the result are in the order in which they are added up.
pub(super) fn moved(kernel: Kernel) -> Kernel {
    let mut signs = Signs::default();
    for local in kernel.locals {
        let (is_negative, code) = signs.split(local);
        if let Code::Local(place) = code {
            signs.places.push((is_negative, place));
            continue;
        }
        let shape = shape(&code);
        let is_computed = is_negative && has_terms(&code) && begins_slowly(&code);
        let (place, is_new) = signs.locals.intern(code);
        if is_new {
            signs.shapes.push(shape);
            signs.are_negative.push(is_computed);
        }
        signs.places.push((is_negative ^ signs.are_negative[place], place));
    }
    let mut outputs = Vec::with_capacity(kernel.outputs.len());
    for (shape, entries) in kernel.outputs {
        outputs.push((shape, entries.into_iter().map(|entry| signs.whole(entry)).collect()));
    }
    let locals = signs.locals.into_values().into_iter().zip(signs.are_negative);
    let locals = locals.map(|(code, is_negative)| if is_negative { negative(code) } else { code });
    Kernel { locals: locals.collect(), outputs }
}

/// The negative of a code whose signs have been moved.
pub(super) fn negative(code: Code) -> Code {
    match code {
        Code::Number(value) => Code::Number(-value),
        Code::Sum(constant, mut terms) if constant.is_zero() && terms.len() == 1 => {
            terms.iter_mut().for_each(flip);
            match terms.pop() {
                Some((weight, only)) if weight.is_one() => only,
                term => Code::Sum(constant, term.into_iter().collect()),
            }
        }
        Code::Sum(constant, terms) => negative_sum(constant, terms),
        code => Code::Sum(integer(0), vec![(integer(-1), code)]),
    }
}

/// −(a − b) is b − a; a number at the head takes the sign.
fn negative_sum(constant: Rational, mut terms: Vec<(Rational, Code)>) -> Code {
    let takes_sign = |(weight, code): &(Rational, Code)| !weight.is_one() || matches!(code, Code::Number(_));
    let is_second = constant.is_zero() && (terms[1].0.is_negative() || !takes_sign(&terms[0]) && takes_sign(&terms[1]));
    if constant.is_zero() && !is_second && !takes_sign(&terms[0]) && !begins_slowly(&terms[0].1) {
        return Code::Sum(integer(0), vec![(integer(-1), Code::Sum(constant, terms))]);
    }
    if is_second {
        terms.swap(0, 1);
    }
    // a constant and what is subtracted from it
    if !constant.is_zero() && terms[0].0.is_negative() {
        terms.iter_mut().for_each(flip);
        terms.insert(1, (integer(-1), Code::Number(constant)));
        return Code::Sum(integer(0), terms);
    }
    terms.iter_mut().for_each(flip);
    Code::Sum(-constant, terms)
}

#[derive(Default)]
struct Signs {
    /// The terms so far, each of them once: those that differed in sign are one.
    locals: Interner<Code>,
    /// For each term of the kernel, whether its negative is among these, and where.
    places: Vec<(bool, usize)>,
    /// The shapes of those that are matrices.
    shapes: Vec<Option<Shape>>,
    /// Whether the negative of a term is computed: that of a sum whose first number takes the sign outside of loops.
    are_negative: Vec<bool>,
}

impl Signs {
    /// A code with its sign in it.
    fn whole(&mut self, code: Code) -> Code {
        let (is_negative, code) = self.split(code);
        match self.shape(&code).filter(|_| is_negative) {
            Some(shape) => {
                let operation = MatrixOperation::Sum(vec![integer(-1)]);
                Code::Whole(Box::new(Whole { operation, operands: vec![code], shape, cost: Cost::default() }))
            }
            None if is_negative => negative(code),
            None => code,
        }
    }

    fn boxed(&mut self, code: Code) -> Box<Code> {
        Box::new(self.whole(code))
    }

    /// A code apart from its sign, written by itself.
    fn split(&mut self, code: Code) -> Signed {
        self.split_at(code, true)
    }

    /// The same; `is_head` where no factor is written before it that would be multiplied first.
    fn split_at(&mut self, code: Code, is_head: bool) -> Signed {
        work::spend(1);
        match code {
            Code::Number(value) if value.is_negative() => (true, Code::Number(-value)),
            Code::Local(index) => {
                let (is_negative, place) = self.places[index];
                (is_negative, Code::Local(place))
            }
            Code::Output(index, callee, output) => (false, Code::Output(self.places[index].1, callee, output)),
            Code::Sum(constant, terms) => self.sum(constant, terms, is_head),
            Code::Product(factors) => self.product(factors, is_head),
            Code::Reciprocal(x) => {
                let (is_negative, x) = self.split(*x);
                (is_negative, Code::Reciprocal(Box::new(x)))
            }
            Code::Root(x, exponent) => (false, Code::Root(self.boxed(*x), exponent)),
            Code::PerOnePlusCosine(x) => (false, Code::PerOnePlusCosine(self.boxed(*x))),
            Code::Function(function, x) => (false, Code::Function(function, self.boxed(*x))),
            Code::Call(callee, arguments) => {
                let mut whole = |entries: Vec<Code>| entries.into_iter().map(|entry| self.whole(entry)).collect();
                let arguments = arguments.into_iter().map(|(shape, entries)| (shape, whole(entries))).collect();
                (false, Code::Call(callee, arguments))
            }
            Code::Whole(whole) => self.matrix(*whole),
            code => (false, code),
        }
    }

    fn sum(&mut self, constant: Rational, terms: Vec<(Rational, Code)>, is_head: bool) -> Signed {
        // several terms stand in brackets
        let is_head = is_head || terms.len() > 1 || !constant.is_zero();
        let mut parts = Vec::with_capacity(terms.len() + 1);
        if !constant.is_zero() {
            let sign = integer(if constant.is_negative() { -1 } else { 1 });
            parts.push((sign, Code::Number(constant.abs())));
        }
        let (subtracted, added): (Vec<_>, Vec<_>) = terms.into_iter().partition(|(weight, _)| weight.is_negative());
        for (weight, term) in added.into_iter().chain(subtracted) {
            parts.push(self.weighted(weight, term, is_head));
        }
        in_order(parts)
    }

    /// A term with its sign in the weight.
    fn weighted(&mut self, weight: Rational, term: Code, is_head: bool) -> (Rational, Code) {
        let is_head = is_head && is_exact(&weight);
        let is_bracketed = is_bracketed(&term);
        let (is_negative, term) = self.split_at(term, is_head);
        // a number times −(b c) is not the number times b, times c
        let term = if is_bracketed && is_product(&term) && !is_head { bracketed(term) } else { term };
        (if is_negative { -weight } else { weight }, term)
    }

    fn product(&mut self, factors: Vec<Code>, is_head: bool) -> Signed {
        let mut is_negative = false;
        let mut parts = Vec::with_capacity(factors.len());
        for factor in factors {
            let is_bracketed = is_bracketed(&factor);
            let is_head = is_head && parts.is_empty();
            let (other, part) = self.split_at(factor, is_head);
            is_negative ^= other;
            // a (−(b c)) is not −((a b) c), and a (−(1/b)) no quotient: they stay in their brackets
            let is_bound = is_product(&part) && !is_head || matches!(part, Code::Reciprocal(_));
            parts.push(if is_bracketed && is_bound { bracketed(part) } else { part });
        }
        (is_negative, Code::Product(parts))
    }

    /// An operation on whole matrices: signs of what it is linear in go through.
    fn matrix(&mut self, whole: Whole) -> Signed {
        let Whole { operation, operands, shape, cost } = whole;
        match operation {
            MatrixOperation::Sum(weights) => {
                let mut parts: Vec<_> = weights.into_iter().zip(operands).collect();
                parts.sort_by_key(|(weight, _)| weight.is_negative());
                let mut parts: Vec<_> =
                    parts.into_iter().map(|(weight, part)| self.weighted(weight, part, true)).collect();
                let is_negative = parts.iter().all(|(weight, _)| weight.is_negative());
                if is_negative {
                    parts.iter_mut().for_each(flip);
                }
                if parts.len() > 1 && parts[0].0.is_negative() && !parts[1].0.is_negative() {
                    parts.swap(0, 1);
                }
                if parts.len() == 1 && parts[0].0.is_one() {
                    return (is_negative, parts.remove(0).1);
                }
                let (weights, operands) = parts.into_iter().unzip();
                let operation = MatrixOperation::Sum(weights);
                (is_negative, Code::Whole(Box::new(Whole { operation, operands, shape, cost })))
            }
            operation => {
                let is_linear = is_linear(&operation);
                let mut is_negative = false;
                let mut part = |operand: Code| {
                    if !is_linear {
                        return self.whole(operand);
                    }
                    let (other, operand) = self.split(operand);
                    is_negative ^= other;
                    operand
                };
                let operands = operands.into_iter().map(&mut part).collect();
                (is_negative, Code::Whole(Box::new(Whole { operation, operands, shape, cost })))
            }
        }
    }

    fn shape(&self, code: &Code) -> Option<Shape> {
        match code {
            Code::Local(index) => self.shapes[*index],
            code => shape(code),
        }
    }
}

/// The shape of a matrix; `None` of a number.
fn shape(code: &Code) -> Option<Shape> {
    match code {
        Code::Whole(whole) => Some(whole.shape).filter(|shape| !shape.is_scalar()),
        _ => None,
    }
}

/// Whether it is a sum of several terms.
fn has_terms(code: &Code) -> bool {
    matches!(code, Code::Sum(constant, terms) if !constant.is_zero() || terms.len() > 1)
}

/// Whether its first number changes less often than the rest: the negative of that number is made outside of the loop of a solve.
fn begins_slowly(code: &Code) -> bool {
    match code {
        Code::Number(_) | Code::Constant(_) | Code::Term(_) => true,
        Code::Sum(constant, terms) => {
            !constant.is_zero() || terms.first().is_some_and(|(weight, term)| !weight.is_one() || begins_slowly(term))
        }
        Code::Product(factors) => factors.first().is_some_and(begins_slowly),
        _ => false,
    }
}

/// Whether the sign of an operand is that of the result.
fn is_linear(operation: &MatrixOperation) -> bool {
    use MatrixOperation::*;
    matches!(
        operation,
        Scaled
            | InertiaTimes
            | Product
            | Transpose
            | Block(..)
            | Embedded(..)
            | Hadamard
            | DiagonalMatrix
            | Diagonal
            | Hat
            | Axial
            | Skew
            | SkewComponents
            | SkewTimes
            | SkewOuter
            | Pairing
            | Trace
            | Entry(..)
    )
}

/// A code in brackets: a sum of one term.
fn bracketed(code: Code) -> Code {
    Code::Sum(integer(0), vec![(integer(1), code)])
}

/// Whether it is a sum that stands in brackets beside a multiplication. One term that is added stands without before signs are moved.
fn is_bracketed(code: &Code) -> bool {
    match code {
        Code::Sum(constant, terms) => {
            !constant.is_zero() || terms.len() > 1 || terms.iter().any(|(weight, _)| weight.is_negative())
        }
        _ => false,
    }
}

/// Whether it is written as a product, with roundings of its own.
fn is_product(code: &Code) -> bool {
    match code {
        Code::Product(_) => true,
        Code::Sum(constant, terms) if constant.is_zero() && terms.len() == 1 => {
            !is_exact(&terms[0].0) || is_product(&terms[0].1)
        }
        _ => false,
    }
}

/// Whether multiplications by a number are exact.
fn is_exact(number: &Rational) -> bool {
    let is_power = |part: i64| part.unsigned_abs().is_power_of_two();
    number.parts().is_some_and(|(numerator, denominator)| is_power(numerator) && is_power(denominator))
}

fn flip((weight, _): &mut (Rational, Code)) {
    *weight = -weight.clone();
}

/// The sum of parts that are added up from the first to the last, apart from its sign.
fn in_order(mut parts: Vec<(Rational, Code)>) -> Signed {
    let leading = parts.iter().take_while(|(weight, _)| weight.is_negative()).count();
    let is_negative = leading > 0 && leading == parts.len();
    match leading {
        0 => {}
        _ if is_negative => parts.iter_mut().for_each(flip),
        1 => parts.swap(0, 1),
        _ => {
            let mut rest = parts.split_off(leading);
            parts.iter_mut().for_each(flip);
            rest.insert(1, (integer(-1), made(parts)));
            parts = rest;
        }
    }
    (is_negative, made(parts))
}

fn made(mut parts: Vec<(Rational, Code)>) -> Code {
    match parts.as_slice() {
        [] => Code::Number(integer(0)),
        [(weight, _)] if weight.is_one() => parts.remove(0).1,
        [(weight, Code::Number(_)), ..] if weight.is_one() => match parts.remove(0).1 {
            Code::Number(constant) => Code::Sum(constant, parts),
            // by construction: the first part is a number
            other => other,
        },
        _ => Code::Sum(integer(0), parts),
    }
}

#[cfg(test)]
mod tests {
    use super::{Code, Kernel, moved};
    use crate::lower::code::is_in_brackets;
    use clebsch_symbolic::{Rational, Shape, Zero, integer, rational};

    /// x/2 + 1 for the first term, and so on.
    fn local(index: usize) -> Code {
        Code::Local(index)
    }

    fn sum(constant: i64, terms: &[(i64, Code)]) -> Code {
        Code::Sum(integer(constant), terms.iter().map(|(weight, term)| (integer(*weight), term.clone())).collect())
    }

    fn with_terms(terms: Vec<Code>, value: Code) -> Kernel {
        Kernel { locals: terms, outputs: vec![(Shape::scalar(), vec![value])] }
    }

    fn output(kernel: &Kernel) -> &Code {
        &kernel.outputs[0].1[0]
    }

    #[test]
    fn a_negative_term_is_subtracted_where_it_was_added() {
        let [a, b, c] = [0, 1, 2].map(Code::Constant);
        let negative = sum(0, &[(-1, Code::Product(vec![a.clone(), b.clone()]))]);
        let kernel = moved(with_terms(vec![negative], sum(0, &[(1, c.clone()), (1, local(0)), (-1, b.clone())])));
        assert_eq!(kernel.locals, [Code::Product(vec![a, b.clone()])]);
        assert_eq!(*output(&kernel), sum(0, &[(1, c), (-1, local(0)), (-1, b)]));
    }

    #[test]
    fn factors_have_no_signs() {
        let [a, b] = [0, 1].map(Code::Constant);
        let both = sum(0, &[(-1, a.clone()), (-1, b.clone())]);
        let minus_b = sum(0, &[(-1, b.clone())]);
        let kernel = moved(with_terms(Vec::new(), Code::Product(vec![both.clone(), minus_b])));
        assert_eq!(*output(&kernel), Code::Product(vec![sum(0, &[(1, a.clone()), (1, b.clone())]), b.clone()]));
        let kernel = moved(with_terms(Vec::new(), both.clone()));
        assert_eq!(*output(&kernel), both);
        let terms = || vec![Code::Reciprocal(Box::new(a.clone())), Code::Reciprocal(Box::new(b.clone()))];
        let kernel = moved(with_terms(terms(), sum(0, &[(-1, local(0)), (-1, local(1))])));
        assert_eq!(*output(&kernel), sum(0, &[(-1, sum(0, &[(1, local(0)), (1, local(1))]))]));
    }

    #[test]
    fn a_term_that_is_all_negative_stays_so_where_a_constant_takes_the_sign() {
        let [a, b] = [0, 1].map(Code::Constant);
        let both = sum(0, &[(-1, a.clone()), (-1, b.clone())]);
        let opposite = sum(0, &[(1, a), (1, b.clone())]);
        let kernel =
            moved(with_terms(vec![both.clone(), opposite], sum(0, &[(1, b.clone()), (1, local(0)), (1, local(1))])));
        assert_eq!(kernel.locals, [both]);
        assert_eq!(*output(&kernel), sum(0, &[(1, b), (1, local(0)), (-1, local(0))]));
    }

    #[test]
    fn what_is_subtracted_first_is_subtracted_together() {
        let [a, b, c] = [0, 1, 2].map(Code::Constant);
        let minus = |code: &Code| sum(0, &[(-1, code.clone())]);
        let kernel = moved(with_terms(Vec::new(), sum(0, &[(1, minus(&a)), (1, minus(&b)), (1, c.clone())])));
        assert_eq!(*output(&kernel), sum(0, &[(1, c), (-1, sum(0, &[(1, a), (1, b)]))]));
    }

    /// Numbers that seem random.
    struct Random(u64);

    impl Random {
        fn below(&mut self, bound: u64) -> u64 {
            self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (self.0 >> 33) % bound
        }

        fn weight(&mut self) -> Rational {
            let sign = 1 - 2 * self.below(2) as i64;
            match self.below(4) {
                0 => rational(sign, 3),
                1 => rational(sign, 2),
                _ => integer(sign),
            }
        }

        fn code(&mut self, depth: u64, locals: u64) -> Code {
            match self.below(if depth == 0 { 2 } else { 8 }) {
                0 if locals > 0 => local(self.below(locals) as usize),
                0 | 1 => Code::Constant(self.below(6) as usize),
                2..=4 => {
                    let constant = if self.below(3) == 0 { self.weight() } else { integer(0) };
                    // one term alone would be no sum
                    let count = 2 + self.below(3);
                    let terms = (0..count).map(|_| (self.weight(), self.code(depth - 1, locals))).collect();
                    Code::Sum(constant, terms)
                }
                5 => match self.code(depth - 1, locals) {
                    // a quotient is no sum of one term
                    Code::Reciprocal(x) => Code::Reciprocal(x),
                    term => Code::Sum(integer(0), vec![(self.weight(), term)]),
                },
                6 => Code::Product((0..2 + self.below(2)).map(|_| self.code(depth - 1, locals)).collect()),
                _ => Code::Reciprocal(Box::new(self.code(depth - 1, locals))),
            }
        }
    }

    /// What generated code computes, with the brackets that it is written with.
    struct Values<'a> {
        locals: Vec<f64>,
        constants: &'a [f64],
        /// Whether sums are added up from the first term to the last, and not those first that are added.
        in_order: bool,
    }

    impl Values<'_> {
        fn of(kernel: &Kernel, constants: &[f64], in_order: bool) -> f64 {
            let mut values = Values { locals: Vec::new(), constants, in_order };
            for code in &kernel.locals {
                let value = values.value(code);
                values.locals.push(value);
            }
            values.value(output(kernel))
        }

        fn value(&self, code: &Code) -> f64 {
            match code {
                Code::Number(value) => number(value),
                Code::Constant(index) => self.constants[*index],
                Code::Local(index) => self.locals[*index],
                Code::Reciprocal(x) => 1.0 / self.value(x),
                Code::Product(_) => self.times(None, code),
                Code::Sum(constant, terms) => self.sum(constant, terms),
                _ => unreachable!("no random code has it"),
            }
        }

        fn sum(&self, constant: &Rational, terms: &[(Rational, Code)]) -> f64 {
            let mut terms: Vec<_> = terms.iter().collect();
            if !self.in_order {
                terms.sort_by_key(|(weight, _)| weight.is_negative());
            }
            let mut total = (!constant.is_zero()).then(|| number(constant));
            for (weight, term) in terms {
                let size = weight.abs();
                let term = match size == integer(1) {
                    true => self.value(term),
                    false => self.times(Some(number(&size)), term),
                };
                let signed = if weight.is_negative() { -term } else { term };
                total = Some(total.map_or(signed, |total| total + signed));
            }
            total.unwrap_or(0.0)
        }

        fn is_in_brackets(&self, constant: &Rational, terms: &[(Rational, Code)]) -> bool {
            let is_plain = constant.is_zero() && terms.len() == 1 && terms[0].0 == integer(1);
            is_in_brackets(constant, terms) && (self.in_order || !is_plain)
        }

        /// What stands before a factor times the factor, which is written without brackets where it is a product.
        fn times(&self, before: Option<f64>, factor: &Code) -> f64 {
            match factor {
                Code::Product(factors) => {
                    let quotient = Code::quotient(factors);
                    let (above, below) = quotient.unwrap_or_else(|| (factors.iter().collect(), Vec::new()));
                    let above = above.into_iter().fold(before, |product, factor| Some(self.times(product, factor)));
                    below.into_iter().fold(above.unwrap_or(1.0), |quotient, divisor| quotient / self.value(divisor))
                }
                Code::Sum(constant, terms) if !self.is_in_brackets(constant, terms) => {
                    let weight = number(&terms[0].0);
                    self.times(Some(before.map_or(weight, |before| before * weight)), &terms[0].1)
                }
                _ => before.map_or(self.value(factor), |before| before * self.value(factor)),
            }
        }
    }

    fn number(value: &Rational) -> f64 {
        let (numerator, denominator) = value.parts().expect("a short number");
        numerator as f64 / denominator as f64
    }

    #[test]
    fn no_bit_changes() {
        let mut random = Random(7);
        let constants = [0.3, -1.7, 2.9, 1e-3, -0.11, 13.7];
        let mut compared = 0;
        for _ in 0..20_000 {
            let locals: Vec<Code> = (0..3).map(|index| random.code(2, index)).collect();
            let kernel = with_terms(locals, random.code(3, 3));
            let before = Values::of(&kernel, &constants, false);
            let after = Values::of(&moved(kernel.clone()), &constants, true);
            compared += usize::from(before.is_finite());
            // of zeros that are divided by, the sign may change
            assert!(before == after || !before.is_finite(), "{before} {after} {kernel:?}");
        }
        assert!(compared > 15_000);
    }
}
