//! Signs: each stands between the terms of a sum or at the head of a value, never before a factor and never twice.
//!
//! (−a) b = −(a b), a − (−b) = a + b, −a − b = −(a + b) and a + b = b + a hold to the last bit. The reason is that
//! numbers are rounded alike on both sides of zero. Terms are otherwise added as before, so that nothing else than the
//! sign of a zero changes.
//!
//! In the loop of a solve, a shared term −a − b is computed as it is where a does not change: −a is made once. Elsewhere a + b is computed and
//! then subtracted.

use clebsch_symbolic::{Interner, IntoElements, IntoList, Rational, Shape, integer, work};

use super::{Code, Cost, Kernel, MatrixOperation, Whole};

/// A code that begins with no sign, and whether its negative is meant.
type Signed = (bool, Code);

/// A kernel with its signs moved and with terms that are then the same as one. Its sums may be in any order that has
/// additions before subtractions. Sums of the result are in the order in which they are added. `is_iterated` where the
/// kernel runs in the loop of a solve.
pub(super) fn moved(kernel: Kernel, is_iterated: bool) -> Kernel {
    let mut signs = Signs::default();
    for local in kernel.locals {
        let (is_negative, code) = signs.split(local, true);
        if let Code::Local(place) = code {
            signs.places.push((is_negative, place));
            continue;
        }
        let is_computed = is_iterated && is_negative && has_terms(&code) && begins_slowly(&code);
        let (place, is_new) = signs.locals.intern(code);
        signs.are_negative.extend(is_new.then_some(is_computed));
        signs.places.push((is_negative ^ signs.are_negative[place], place));
    }
    let mut whole = |entries: Vec<Code>| entries.into_each(|entry| signs.whole(entry));
    let outputs = kernel.outputs.into_each(|(shape, entries)| (shape, whole(entries)));
    let locals = signs.locals.into_values().into_iter().zip(signs.are_negative);
    let locals = locals.map(|(code, is_negative)| if is_negative { negative(code) } else { code });
    Kernel { locals: locals.into_list(), outputs }
}

/// The negative of a code whose signs have been moved.
pub(super) fn negative(code: Code) -> Code {
    match code {
        Code::Number(value) => Code::Number(-value),
        Code::Sum(constant, mut terms) if constant.is_zero() && terms.len() == 1 => {
            terms.iter_mut().for_each(flip);
            match terms.pop() {
                Some((weight, only)) if weight.is_one() => only,
                term => Code::Sum(constant, term.into_iter().into_list()),
            }
        }
        Code::Sum(constant, terms) => negative_sum(constant, terms),
        code => Code::Sum(integer(0), vec![(integer(-1), code)]),
    }
}

/// −(a − b) is b − a, and −a − k (b − c) is k (c − b) − a; a number at the head takes the sign.
fn negative_sum(constant: Rational, mut terms: Vec<(Rational, Code)>) -> Code {
    let turns_at = |place: usize| terms[place].0.is_one() && turns(&terms[place].1);
    if constant.is_zero() && (turns_at(0) || turns_at(1)) {
        if turns_at(1) {
            terms.swap(0, 1);
        }
        terms.iter_mut().for_each(flip);
        let (_, first) = terms.remove(0);
        terms.insert(0, (integer(1), turned(first)));
        return Code::Sum(constant, terms);
    }
    let takes_sign = |(weight, code): &(Rational, Code)| !weight.is_one() || matches!(code, Code::Number(_));
    let is_second = constant.is_zero() && (terms[1].0.is_negative() || !takes_sign(&terms[0]) && takes_sign(&terms[1]));
    if constant.is_zero() && !is_second && !takes_sign(&terms[0]) && !begins_slowly(&terms[0].1) {
        return Code::Sum(integer(0), vec![(integer(-1), Code::Sum(constant, terms))]);
    }
    if is_second {
        terms.swap(0, 1);
    }
    // a constant and the terms that are subtracted from it
    if !constant.is_zero() && terms[0].0.is_negative() {
        terms.iter_mut().for_each(flip);
        terms.insert(1, (integer(-1), Code::Number(constant)));
        return Code::Sum(integer(0), terms);
    }
    terms.iter_mut().for_each(flip);
    Code::Sum(-constant, terms)
}

/// Whether its negative takes no sign: −(a − b) is b − a, also as a factor.
fn turns(code: &Code) -> bool {
    match code {
        Code::Sum(constant, terms) => {
            let second = terms.get(usize::from(constant.is_zero()));
            second.is_some_and(|(weight, _)| weight.is_negative())
        }
        Code::Product(factors) => factors.iter().any(turns),
        _ => false,
    }
}

/// The negative of such a code.
fn turned(code: Code) -> Code {
    match code {
        Code::Product(mut factors) => {
            if let Some(factor) = factors.iter_mut().find(|factor| turns(factor)) {
                *factor = turned(factor.clone());
            }
            Code::Product(factors)
        }
        code => negative(code),
    }
}

#[derive(Default)]
struct Signs {
    /// The terms so far, each of them once: those that differed in sign are one.
    locals: Interner<Code>,
    /// For each term of the kernel, whether its negative is among these, and where.
    places: Vec<(bool, usize)>,
    /// Whether the negative of a term is computed: that of a sum whose first number takes the sign outside of the loop.
    are_negative: Vec<bool>,
}

impl Signs {
    /// A code with its sign in it.
    fn whole(&mut self, code: Code) -> Code {
        let (is_negative, code) = self.split(code, true);
        match self.shape(&code).filter(|_| is_negative) {
            Some(shape) => Code::whole(MatrixOperation::Sum(vec![integer(-1)]), vec![code], shape, Cost::default()),
            None if is_negative => negative(code),
            None => code,
        }
    }

    /// A code apart from its sign; `is_head` where no factor is written before it that would be multiplied first.
    fn split(&mut self, code: Code, is_head: bool) -> Signed {
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
                let (is_negative, x) = self.split(*x, true);
                (is_negative, Code::Reciprocal(Box::new(x)))
            }
            Code::Whole(whole) => self.matrix(*whole),
            code => (false, code.of(&mut |part| self.whole(part))),
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
        let (is_negative, term) = self.split(term, is_head);
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
            let (other, part) = self.split(factor, is_head);
            is_negative ^= other;
            // a (−(b c)) is not −((a b) c), and a (−(1/b)) no quotient: they stay in their brackets
            let is_bound = is_product(&part) && !is_head || matches!(part, Code::Reciprocal(_));
            parts.push(if is_bracketed && is_bound { bracketed(part) } else { part });
        }
        (is_negative, Code::Product(parts))
    }

    /// An operation on matrices. It passes on the signs of operands in which it is linear.
    fn matrix(&mut self, whole: Whole) -> Signed {
        let Whole { operation, operands, shape, cost } = whole;
        match operation {
            MatrixOperation::Sum(weights) => {
                let mut parts: Vec<_> = weights.into_iter().zip(operands).into_list();
                parts.sort_by_key(|(weight, _)| weight.is_negative());
                let mut parts: Vec<_> = parts.into_each(|(weight, part)| self.weighted(weight, part, true));
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
                (is_negative, Code::whole(MatrixOperation::Sum(weights), operands, shape, cost))
            }
            operation => {
                let (is_linear, mut is_negative) = (operation.is_linear(), false);
                let code = Code::whole(operation, operands, shape, cost).of(&mut |operand| {
                    if !is_linear {
                        return self.whole(operand);
                    }
                    let (other, operand) = self.split(operand, true);
                    is_negative ^= other;
                    operand
                });
                (is_negative, code)
            }
        }
    }

    /// The shape of a matrix; `None` of a number.
    fn shape(&self, code: &Code) -> Option<Shape> {
        match code {
            Code::Local(index) => self.shape(self.locals.value(*index)),
            Code::Whole(whole) => Some(whole.shape).filter(|shape| !shape.is_scalar()),
            _ => None,
        }
    }
}

/// Whether it is a sum of several terms.
fn has_terms(code: &Code) -> bool {
    matches!(code, Code::Sum(constant, terms) if !constant.is_zero() || terms.len() > 1)
}

/// Whether its first number changes less often than the others. The negative of that number is then computed outside of
/// the loop of a solve.
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

/// A code in brackets: a sum of one term.
fn bracketed(code: Code) -> Code {
    Code::Sum(integer(0), vec![(integer(1), code)])
}

/// Whether it is a sum in brackets next to a multiplication. One term that is added stands without before signs are
/// moved.
fn is_bracketed(code: &Code) -> bool {
    has_terms(code) || matches!(code, Code::Sum(_, terms) if terms.iter().any(|(weight, _)| weight.is_negative()))
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
mod tests;
