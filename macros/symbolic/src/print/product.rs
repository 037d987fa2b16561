//! Products as people write them, and sums with their common factors in front: `length²·(m₀ + m₁)/2`.

use super::{Binding, Notation, in_digits, joined};
use crate::{Elements, Fraction, IntoList, Rational, integer};

/// Terms of longer sums are not grouped.
const MOST_GROUPED: usize = 64;

/// A factor as text.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Factor {
    pub(super) text: String,
    pub(super) binding: Binding,
    /// Whether it is a symbol or an entry of one.
    pub(super) is_name: bool,
}

/// number · Π scalarᵉˣᵖᵒⁿᵉⁿᵗ · letters, where factors are told apart by their texts.
#[derive(Clone, Debug)]
pub struct Product {
    number: Rational,
    scalars: Vec<(Factor, Fraction)>,
    /// Matrix factors.
    letters: Vec<Factor>,
}

impl Factor {
    pub(super) fn atom(text: String) -> Factor {
        Factor { text, binding: Binding::Atom, is_name: false }
    }

    pub(super) fn at(&self, place: Binding, notation: Notation) -> String {
        if self.binding < place { notation.parenthesized(&self.text) } else { self.text.clone() }
    }

    /// A power; the exponent is positive.
    fn raised(&self, exponent: Fraction, place: Binding, notation: Notation) -> String {
        match exponent.parts() {
            (1, 1) => self.at(place, notation),
            (1, 2) => notation.enclosed(&self.text, ["√(", ")"], ["\\sqrt{", "}"]),
            (whole, 1) => {
                notation.raised(&self.at(Binding::Atom, notation), &in_digits(whole, "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"), &whole.to_string())
            }
            _ => notation.raised(&self.at(Binding::Atom, notation), &format!("^({exponent})"), &exponent.to_string()),
        }
    }
}

impl Product {
    /// A number.
    pub fn number(number: Rational) -> Product {
        Product { number, scalars: Vec::new(), letters: Vec::new() }
    }

    /// A scalar that is called so.
    pub fn name(text: String) -> Product {
        Product::factor(Factor { text, binding: Binding::Atom, is_name: true }, true)
    }

    /// A scalar with this text, which is one factor but no name.
    pub fn scalar(text: String) -> Product {
        Product::factor(Factor::atom(text), true)
    }

    pub(super) fn factor(factor: Factor, is_scalar: bool) -> Product {
        let one = Product::number(Rational::one());
        match is_scalar {
            true => Product { scalars: vec![(factor, Fraction::ONE)], ..one },
            false => Product { letters: vec![factor], ..one },
        }
    }

    /// Whether it is 0.
    pub fn is_zero(&self) -> bool {
        self.number.is_zero()
    }

    /// Times another product; its matrix factors come last.
    pub fn multiply(&mut self, other: &Product) {
        self.number *= &other.number;
        other.scalars.iter().for_each(|(factor, exponent)| self.multiply_power(factor, *exponent));
        self.letters.extend(other.letters.iter().cloned());
    }

    /// Over a scalar, which is not zero.
    pub fn divide(&mut self, other: &Product) {
        self.number *= &other.number.recip();
        other.scalars.iter().for_each(|(factor, exponent)| self.multiply_power(factor, -*exponent));
    }

    /// Times a power of a scalar, which is not zero; the exponent is an integer.
    pub(super) fn multiply_by_power(&mut self, scalar: &Product, exponent: Fraction) {
        for _ in 0..exponent.parts().0.abs() {
            if exponent.is_negative() { self.divide(scalar) } else { self.multiply(scalar) }
        }
    }

    pub(super) fn multiply_power(&mut self, factor: &Factor, exponent: Fraction) {
        match self.scalars.iter_mut().find(|(own, _)| own.text == factor.text) {
            Some((_, own)) => *own = *own + exponent,
            None => self.scalars.push((factor.clone(), exponent)),
        }
        self.scalars.retain(|(_, exponent)| !exponent.is_zero());
    }

    /// The scalars, and the matrix factors.
    pub(super) fn split(self) -> (Product, Product) {
        let Product { number, scalars, letters } = self;
        (Product { number, scalars, letters: Vec::new() }, Product { letters, ..Product::number(Rational::one()) })
    }

    /// The length of its text, about.
    pub(super) fn length(&self) -> usize {
        let scalars = self.scalars.iter().map(|(factor, _)| factor.text.len()).sum::<usize>();
        scalars + self.letters.iter().map(|letter| letter.text.len()).sum::<usize>()
    }

    /// The number with the scalars that are names, and all else.
    fn names_and_others(&self) -> (Product, Product) {
        let (names, others) = self.scalars.iter().cloned().partition(|(factor, _)| factor.is_name);
        let names = Product { number: self.number.clone(), scalars: names, letters: Vec::new() };
        (names, Product { number: Rational::one(), scalars: others, letters: self.letters.clone() })
    }

    /// The number with all but the scalars that are names, and these.
    fn others_and_names(&self) -> (Product, Product) {
        let (names, others) = self.names_and_others();
        (Product { number: names.number, ..others }, Product { number: Rational::one(), ..names })
    }

    fn exponent(&self, name: &str) -> Fraction {
        self.scalars.iter().find(|(own, _)| own.text == name).map_or(Fraction::ZERO, |(_, exponent)| *exponent)
    }

    /// Whether it is the same but for its number.
    fn is_like(&self, other: &Product) -> bool {
        self.scalars.len() == other.scalars.len()
            && self.letters == other.letters
            && self.scalars.iter().all(|(factor, exponent)| other.exponent(&factor.text) == *exponent)
    }

    /// Whether people write these terms in a bracket with these common factors: fractions in fractions they do not.
    fn is_worth_a_bracket(&self, terms: &[Product]) -> bool {
        let has_numerator =
            !self.letters.is_empty() || self.scalars.iter().any(|(_, exponent)| !exponent.is_negative());
        has_numerator || (!self.scalars.is_empty() && have_one_denominator(terms))
    }

    fn is_number(&self) -> bool {
        self.scalars.is_empty() && self.letters.is_empty()
    }

    /// A sum as a number, common scalars and a bracket. Where it `is_open`, it has no brackets around it, and a common
    /// number stays in the terms unless there is a common scalar.
    pub fn sum(terms: Vec<Product>, notation: Notation, is_open: bool) -> Product {
        let mut terms = terms.into_iter().fold(Vec::new(), with_term);
        terms.retain(|term| !term.is_zero());
        if terms.len() < 2 {
            return terms.pop().unwrap_or_else(|| Product::number(Rational::zero()));
        }
        let mut common = Product { scalars: common_scalars(&terms), ..Product::number(content(&terms)) };
        if is_open && !common.is_worth_a_bracket(&terms) {
            common = Product::number(Rational::one());
        }
        terms.iter_mut().for_each(|term| term.divide(&common));
        if terms.len() <= MOST_GROUPED {
            terms = grouped(terms, notation, Product::names_and_others);
            terms = grouped(terms, notation, Product::others_and_names);
        }
        let bracket = match terms.as_slice() {
            [term] => term.clone(),
            _ => Product::bracket(terms, notation),
        };
        common.multiply(&bracket);
        common
    }

    /// A sum as one factor: positive terms first, plain numbers and identities last.
    fn bracket(mut terms: Vec<Product>, notation: Notation) -> Product {
        let is_identity = |letter: &Factor| letter.text == "I";
        let is_constant = |term: &Product| term.scalars.is_empty() && term.letters.iter().all(is_identity);
        terms.sort_by_key(|term| (term.number.is_negative(), is_constant(term)));
        let is_scalar = terms.iter().all(|term| term.letters.is_empty());
        let signed = terms.iter().map(|term| (term.number.is_negative(), term.size(notation)));
        // names may hold signs too
        let text = joined(signed, '−').replace('−', notation.either("−", "-"));
        Product::factor(Factor { binding: Binding::Sum, ..Factor::atom(text) }, is_scalar)
    }

    /// The text in a notation.
    pub fn written(&self, notation: Notation) -> String {
        self.as_factor(notation).text
    }

    /// The text, and how tightly it binds.
    pub(super) fn as_factor(&self, notation: Notation) -> Factor {
        match (self.scalars.as_slice(), self.letters.as_slice()) {
            ([], [letter]) if self.number.is_one() => return letter.clone(),
            ([(factor, exponent)], []) if self.number.is_one() && exponent.is_one() => return factor.clone(),
            _ => {}
        }
        let size = self.size(notation);
        match self.number.is_negative() {
            true => {
                Factor { text: notation.either("−", "-").to_string() + &size, binding: Binding::Sum, is_name: false }
            }
            false if self.is_number() && self.number.is_integer() => {
                Factor { text: size, binding: Binding::Atom, is_name: false }
            }
            false => Factor { text: size, binding: Binding::Product, is_name: false },
        }
    }

    /// The absolute value: numerator over denominator, names before sums before other scalars.
    fn size(&self, notation: Notation) -> String {
        let (mut above, mut below) = (Vec::new(), Vec::new());
        let size = self.number.abs();
        if !size.denom().is_one() {
            below.push(size.denom().to_string());
        }
        let is_below = |(_, exponent): &&(Factor, Fraction)| exponent.is_negative();
        let below_bar = below.len() + self.scalars.iter().filter(is_below).count();
        let above_bar = usize::from(!size.numer().is_one()) + self.letters.len() + self.scalars.len()
            - self.scalars.iter().filter(is_below).count();
        // a lone factor on its side of a bar needs no brackets; in one line a sum or a product below does
        let place_above = match (above_bar, below_bar) {
            (1, 1..) => notation.either(Binding::Product, Binding::Sum),
            _ => Binding::Product,
        };
        let place_below = match below_bar {
            1 => notation.either(Binding::Atom, Binding::Sum),
            _ => Binding::Product,
        };
        let mut scalars: Vec<&(Factor, Fraction)> = self.scalars.iter().into_list();
        scalars.sort_by_key(|(factor, _)| (!factor.is_name, factor.binding != Binding::Sum));
        for (factor, exponent) in scalars {
            if exponent.is_negative() {
                below.push(factor.raised(-*exponent, place_below, notation));
            } else {
                above.push(factor.raised(*exponent, place_above, notation));
            }
        }
        above.extend(self.letters.each(|letter| letter.at(place_above, notation)));
        if !size.numer().is_one() || above.is_empty() {
            above.insert(0, size.numer().to_string());
        }
        let (above, factors, below) = (notation.joined(&above), below.len(), notation.joined(&below));
        match factors {
            0 => above,
            _ if notation == Notation::Latex => format!("\\frac{{{above}}}{{{below}}}"),
            1 => format!("{above}/{below}"),
            _ => format!("{above}/({below})"),
        }
    }
}

/// A sum with one more term, which is added to a like one.
fn with_term(mut sum: Vec<Product>, term: Product) -> Vec<Product> {
    match sum.iter_mut().find(|other| other.is_like(&term)) {
        Some(like) => like.number += &term.number,
        None => sum.push(term),
    }
    sum
}

/// Terms with one factor in common, as the sum of their other factors times it. `parts` splits a term into these.
fn grouped(terms: Vec<Product>, notation: Notation, parts: fn(&Product) -> (Product, Product)) -> Vec<Product> {
    let mut groups: Vec<(Product, Vec<(Product, Product)>)> = Vec::new();
    for term in terms {
        let (inner, outer) = parts(&term);
        match groups.iter_mut().find(|(common, _)| !outer.is_number() && common.is_like(&outer)) {
            Some((_, group)) => group.push((inner, term)),
            None => groups.push((outer, vec![(inner, term)])),
        }
    }
    let of_group = |(outer, group): (Product, Vec<(Product, Product)>)| {
        let (inner, members): (Vec<Product>, Vec<Product>) = group.into_iter().unzip();
        if inner.len() < 2 || !outer.is_worth_a_bracket(&inner) {
            return members;
        }
        let mut sum = Product::sum(inner, notation, false);
        sum.multiply(&outer);
        vec![sum]
    };
    groups.into_iter().flat_map(of_group).into_list()
}

/// The scalars of the first term that all terms have, to the power that all of them have.
fn common_scalars(terms: &[Product]) -> Vec<(Factor, Fraction)> {
    let mut common = Vec::new();
    for (factor, exponent) in &terms[0].scalars {
        let exponents = terms.each(|term| term.exponent(&factor.text));
        let shared = if exponent.is_negative() { exponents.iter().max() } else { exponents.iter().min() };
        let shared =
            shared.copied().filter(|shared| !shared.is_zero() && shared.is_negative() == exponent.is_negative());
        common.extend(shared.map(|shared| (factor.clone(), shared)));
    }
    common
}

/// The number before a sum: the greatest one that divides all terms by integers if they have one denominator, else 1.
/// It is negative where all terms are.
fn content(terms: &[Product]) -> Rational {
    let sign = if terms.iter().all(|term| term.number.is_negative()) { -1 } else { 1 };
    let divisor = |above, term: &Product| Some(greatest_divisor(above, term.number.numer().parts()?.0.checked_abs()?));
    let above = if have_one_denominator(terms) { terms.iter().try_fold(0_i64, divisor) } else { None };
    above.map_or(integer(sign), |above| integer(sign) * integer(above) / terms[0].number.denom())
}

fn have_one_denominator(terms: &[Product]) -> bool {
    terms.iter().all(|term| term.number.denom() == terms[0].number.denom())
}

/// The greatest common divisor of numbers that are not negative.
fn greatest_divisor(a: i64, b: i64) -> i64 {
    if b == 0 { a } else { greatest_divisor(b, a % b) }
}
