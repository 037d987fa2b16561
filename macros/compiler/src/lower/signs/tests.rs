use super::{Code, Kernel, negative};
use crate::lower::code::is_in_brackets;
use clebsch_symbolic::{Rational, Shape, integer, rational};

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

/// In the loop of a solve.
fn moved(kernel: Kernel) -> Kernel {
    super::moved(kernel, true)
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
        with_terms(vec![both.clone(), opposite.clone()], sum(0, &[(1, b.clone()), (1, local(0)), (1, local(1))]));
    let in_a_loop = moved(kernel.clone());
    assert_eq!(in_a_loop.locals, [both]);
    assert_eq!(*output(&in_a_loop), sum(0, &[(1, b.clone()), (1, local(0)), (-1, local(0))]));
    let elsewhere = super::moved(kernel, false);
    assert_eq!(elsewhere.locals, [opposite]);
    assert_eq!(*output(&elsewhere), sum(0, &[(1, b), (-1, local(0)), (1, local(0))]));
}

#[test]
fn a_difference_takes_the_sign() {
    let [a, b, c, d] = [0, 1, 2, 3].map(Code::Constant);
    let times = |difference: Code| Code::Product(vec![b.clone(), difference]);
    let difference = sum(0, &[(1, c.clone()), (-1, d.clone())]);
    let kernel = moved(with_terms(Vec::new(), sum(0, &[(-1, a.clone()), (-1, times(difference.clone()))])));
    let opposite = sum(0, &[(1, d), (-1, c)]);
    assert_eq!(*output(&kernel), sum(0, &[(1, times(opposite)), (-1, a.clone())]));
    let kernel = moved(with_terms(Vec::new(), sum(0, &[(-1, times(difference.clone())), (-1, a.clone())])));
    assert_eq!(*output(&kernel), sum(0, &[(1, times(negative(difference))), (-1, a)]));
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

/// The values that generated code computes, with the brackets of its text.
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

    /// The product of the number before a factor and the factor. If the factor is a product, it is written without
    /// brackets.
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
        compared += usize::from(before.is_finite());
        for is_iterated in [false, true] {
            let after = Values::of(&super::moved(kernel.clone(), is_iterated), &constants, true);
            // of zeros that are divided by, the sign may change
            assert!(before == after || !before.is_finite(), "{before} {after} {kernel:?}");
        }
    }
    assert!(compared > 15_000);
}
