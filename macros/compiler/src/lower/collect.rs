//! Coefficients as people write them: a number, powers, and sums in brackets, as in `1/2*length[0]²*(mass[0] + mass[1])`.

use clebsch_symbolic::{Elements, IntoList, Rational, integer, joined};

use super::Code;

/// A number times powers of factors, which are told apart by their texts.
#[derive(Clone)]
struct Monomial {
    number: Rational,
    factors: Vec<(String, i32)>,
}

/// The text of a code, with like terms and common factors collected. `atom` is the text of a factor.
pub(super) fn collected(code: &Code, atom: &dyn Fn(&Code) -> String) -> String {
    monomial(code, atom).to_string()
}

/// A code as one term; a sum is a factor of it.
fn monomial(code: &Code, atom: &dyn Fn(&Code) -> String) -> Monomial {
    match code {
        Code::Number(value) => Monomial { number: value.clone(), factors: Vec::new() },
        Code::Product(factors) => {
            let mut product = Monomial { number: integer(1), factors: Vec::new() };
            for factor in factors {
                product.multiply(&monomial(factor, atom), 1);
            }
            product
        }
        Code::Reciprocal(x) => {
            let x = monomial(x, atom);
            if x.number.is_zero() {
                return Monomial { number: integer(1), factors: vec![(atom(code), 1)] };
            }
            let mut inverse = Monomial { number: integer(1), factors: Vec::new() };
            inverse.multiply(&x, -1);
            inverse
        }
        Code::Sum(..) => {
            let mut terms = Vec::new();
            each_term(&integer(1), code, atom, &mut terms);
            sum(terms)
        }
        _ => Monomial { number: integer(1), factors: vec![(atom(code), 1)] },
    }
}

/// The terms of a sum, of sums within it too, with like ones added.
fn each_term(weight: &Rational, code: &Code, atom: &dyn Fn(&Code) -> String, all: &mut Vec<Monomial>) {
    if let Code::Sum(constant, terms) = code {
        add(all, Monomial { number: constant * weight, factors: Vec::new() });
        terms.iter().for_each(|(own, term)| each_term(&(own * weight), term, atom, all));
        return;
    }
    let mut term = monomial(code, atom);
    term.number *= weight;
    add(all, term);
}

fn add(all: &mut Vec<Monomial>, term: Monomial) {
    match all.iter_mut().find(|other| other.is_like(&term)) {
        Some(like) => like.number += &term.number,
        None => all.push(term),
    }
}

/// A sum of terms, with their common factors in front of it.
fn sum(mut terms: Vec<Monomial>) -> Monomial {
    terms.retain(|term| !term.number.is_zero());
    let Some(first) = terms.first().cloned() else { return Monomial { number: integer(0), factors: Vec::new() } };
    if terms.len() == 1 {
        return first;
    }
    let mut common = Monomial { number: content(&terms), factors: Vec::new() };
    for (name, exponent) in &first.factors {
        let exponents = terms.each(|term| term.exponent(name));
        let shared = if *exponent > 0 { exponents.iter().min() } else { exponents.iter().max() };
        let shared = shared.copied().filter(|shared| *shared != 0 && (*shared > 0) == (*exponent > 0));
        common.factors.extend(shared.map(|shared| (name.clone(), shared)));
    }
    for term in &mut terms {
        term.multiply(&common, -1);
    }
    // positive terms first
    terms.sort_by_key(|term| term.number.is_negative());
    let written = terms.iter().map(|term| {
        let size = Monomial { number: term.number.abs(), factors: term.factors.clone() };
        (term.number.is_negative(), size.to_string())
    });
    let text = joined(written, '-');
    common.factors.push((format!("({text})"), 1));
    common
}

/// The largest number that all terms are integer multiples of; negative where all terms are.
fn content(terms: &[Monomial]) -> Rational {
    let sign = if terms.iter().all(|term| term.number.is_negative()) { -1 } else { 1 };
    let content = terms.iter().try_fold((0_i64, 1_i64), |(above, below), term| {
        let (numerator, denominator) = term.number.parts()?;
        let multiple = (below / greatest_divisor(below, denominator)).checked_mul(denominator)?;
        Some((greatest_divisor(above, numerator.checked_abs()?), multiple))
    });
    content.map_or(integer(sign), |(above, below)| integer(sign) * Rational::new(above.into(), below.into()))
}

/// The greatest common divisor of numbers that are not negative.
fn greatest_divisor(a: i64, b: i64) -> i64 {
    if b == 0 { a } else { greatest_divisor(b, a % b) }
}

impl Monomial {
    fn exponent(&self, name: &str) -> i32 {
        self.factors.iter().find(|(own, _)| own == name).map_or(0, |(_, exponent)| *exponent)
    }

    /// Whether it is the same but for its number.
    fn is_like(&self, other: &Monomial) -> bool {
        self.factors.len() == other.factors.len()
            && self.factors.iter().all(|(name, exponent)| other.exponent(name) == *exponent)
    }

    /// Times a power of another one, whose number is not zero.
    fn multiply(&mut self, other: &Monomial, power: i32) {
        self.number *= &if power < 0 { other.number.recip() } else { other.number.clone() };
        for (name, exponent) in &other.factors {
            match self.factors.iter_mut().find(|(own, _)| own == name) {
                Some((_, own)) => *own += power * exponent,
                None => self.factors.push((name.clone(), power * exponent)),
            }
        }
        self.factors.retain(|(_, exponent)| *exponent != 0);
    }
}

/// Numbers and names before sums in brackets, and quotients last.
impl std::fmt::Display for Monomial {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let is_sum = |(name, _): &&(String, i32)| name.starts_with('(');
        let (sums, names): (Vec<_>, Vec<_>) = self.factors.iter().partition(is_sum);
        let raised = |(name, exponent): &(String, i32)| match exponent.unsigned_abs() {
            1 => name.clone(),
            exponent => format!("{name}{}", superscript(exponent)),
        };
        let above = names.iter().chain(&sums).filter(|(_, exponent)| *exponent > 0);
        let above = above.map(|factor| raised(factor)).into_list();
        if self.number.is_negative() {
            f.write_str("-")?;
        }
        let size = self.number.abs();
        if above.is_empty() || !size.is_one() {
            write!(f, "{size}")?;
        }
        let star = if above.is_empty() || size.is_one() { "" } else { "*" };
        write!(f, "{star}{}", above.join("*"))?;
        let mut below = names.iter().chain(&sums).filter(|(_, exponent)| *exponent < 0);
        below.try_for_each(|factor| write!(f, "/{}", raised(factor)))
    }
}

fn superscript(number: u32) -> String {
    let digit = |digit: char| digit.to_digit(10).and_then(|digit| "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().nth(digit as usize));
    number.to_string().chars().filter_map(digit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lower::code::Code;

    fn name(code: &Code) -> String {
        match code {
            Code::Local(0) => "a".into(),
            Code::Local(1) => "b".into(),
            Code::Local(_) => "c".into(),
            other => format!("{other:?}"),
        }
    }

    fn weighted(terms: &[(i64, i64, Code)]) -> Code {
        Code::Sum(
            integer(0),
            terms.iter().map(|(n, d, code)| (Rational::new((*n).into(), (*d).into()), code.clone())).collect(),
        )
    }

    #[test]
    fn coefficients_are_collected() {
        let [a, b, c] = [0, 1, 2].map(Code::Local);
        let quarter = weighted(&[(1, 4, a.clone()), (1, 4, b.clone())]);
        let nested = weighted(&[(2, 1, Code::Product(vec![c.clone(), quarter, c.clone()]))]);
        let below =
            Code::Product(vec![a.clone(), Code::Reciprocal(Box::new(Code::Product(vec![b.clone(), b.clone()])))]);
        let common = weighted(&[
            (-1, 1, Code::Product(vec![a.clone(), b.clone()])),
            (-3, 1, Code::Product(vec![a.clone(), c.clone()])),
        ]);
        let mixed = weighted(&[(-1, 1, a.clone()), (1, 2, b.clone())]);
        let gone = weighted(&[(1, 1, a.clone()), (-1, 1, a.clone())]);
        let whole = weighted(&[(1, 1, Code::Sum(integer(3), vec![(integer(1), a.clone())])), (1, 1, a.clone())]);
        let found = [nested, below, common, mixed, gone, whole].map(|code| collected(&code, &name));
        let expected = ["1/2*c²*(a + b)", "a/b²", "-a*(b + 3*c)", "1/2*(b - 2*a)", "0", "(3 + 2*a)"];
        assert_eq!(found, expected);
    }
}
