//! Common factors of the terms of a sum: a x + a y is a (x + y), where that saves multiplications.

use clebsch_symbolic::{Elements, IntoElements, Rational, Table, integer, work};

use super::kernel::{Id, Operation, Operations};
use super::scalar::is_unit;

struct Factored<'a> {
    operations: &'a mut Operations,
    /// The terms of each sum that has changed.
    sums: Table<Id, Vec<(Rational, Id)>>,
    /// How often each operation occurs in the code of the outputs.
    uses: Vec<usize>,
    /// Sums that are still to be looked at.
    waiting: Vec<Id>,
    /// Whether sums that stand nowhere else are joined with those around them.
    joins: bool,
}

/// Takes common factors out of all sums in the code of the outputs. Some of these sums have terms other than those of
/// their creation. With `joins`, terms of a sum and of the sums in it have factors in common too.
pub(super) fn factored(
    operations: &mut Operations,
    outputs: &[Id],
    sums: Table<Id, Vec<(Rational, Id)>>,
    joins: bool,
) -> Table<Id, Vec<(Rational, Id)>> {
    let mut factored = Factored { uses: vec![0; operations.len()], operations, sums, waiting: Vec::new(), joins };
    outputs.iter().for_each(|&output| factored.take(output));
    while let Some(sum) = factored.waiting.pop() {
        factored.sum(sum);
    }
    factored.sums
}

enum Factor {
    /// A factor of products.
    Of(Id),
    /// The magnitude of coefficients.
    Number(Rational),
}

/// A factor that is taken out of the terms at these positions.
struct Choice {
    factor: Factor,
    positions: Vec<usize>,
    /// The multiplications that this saves.
    saved: isize,
}

impl Factored<'_> {
    /// One use more.
    fn take(&mut self, id: Id) {
        work::spend(3);
        self.uses[id] += 1;
        if self.uses[id] > 1 {
            return;
        }
        if matches!(self.operations.value(id), Operation::Sum(_, terms) if terms.len() > 1) {
            self.waiting.push(id);
        }
        self.operands(id).into_iter().for_each(|operand| self.take(operand));
    }

    /// One use less.
    fn release(&mut self, id: Id) {
        self.uses[id] -= 1;
        if self.uses[id] == 0 {
            self.operands(id).into_iter().for_each(|operand| self.release(operand));
        }
    }

    fn operands(&self, id: Id) -> Vec<Id> {
        match self.sums.get(&id) {
            Some(terms) => terms.each(|(_, term)| *term),
            None => self.operations.value(id).operands(),
        }
    }

    /// Takes out one factor after the other, the one that saves most first.
    fn sum(&mut self, sum: Id) {
        if self.uses[sum] == 0 {
            return;
        }
        while let Some(terms) = self.terms(sum) {
            let terms = match self.choose(&terms) {
                Some(choice) => self.taken_out(terms, &choice),
                None if !self.joins => break,
                None => {
                    let (flat, inner) = self.flat(&terms);
                    if inner.is_empty() {
                        break;
                    }
                    let Some(choice) = self.choose(&flat).filter(|choice| !self.divides(choice)) else { break };
                    inner.into_iter().for_each(|sum| self.uses[sum] = 0);
                    self.taken_out(flat, &choice)
                }
            };
            self.sums.insert(sum, terms);
        }
    }

    /// Whether a factor is a quotient. Taken out of several sums it would leave products that overflow, where it had made each of them small.
    fn divides(&self, choice: &Choice) -> bool {
        matches!(choice.factor, Factor::Of(factor) if matches!(self.operations.value(factor), Operation::Reciprocal(_)))
    }

    /// The terms with those of sums that stand nowhere else, and these sums. There are none where a term would stand twice.
    fn flat(&self, terms: &[(Rational, Id)]) -> (Vec<(Rational, Id)>, Vec<Id>) {
        work::spend(terms.len());
        let (mut flat, mut inner) = (Vec::new(), Vec::new());
        for (coefficient, term) in terms {
            match self.operations.value(*term) {
                Operation::Sum(constant, _) if constant.is_zero() && is_unit(coefficient) && self.uses[*term] == 1 => {
                    inner.push(*term);
                    let terms = self.terms(*term).unwrap_or_default();
                    flat.extend(terms.into_iter().map(|(weight, term)| (weight * coefficient, term)));
                }
                _ => flat.push((coefficient.clone(), *term)),
            }
        }
        let mut ids = flat.each(|(_, term)| *term);
        ids.sort_unstable();
        let is_distinct = ids.windows(2).all(|pair| pair[0] != pair[1]);
        (flat, if is_distinct { inner } else { Vec::new() })
    }

    fn terms(&self, sum: Id) -> Option<Vec<(Rational, Id)>> {
        match self.operations.value(sum) {
            Operation::Sum(_, terms) => Some(self.sums.get(&sum).unwrap_or(terms).clone()),
            _ => None,
        }
    }

    fn choose(&self, terms: &[(Rational, Id)]) -> Option<Choice> {
        let mut positions: Table<Id, Vec<usize>> = Table::default();
        for (position, (_, term)) in terms.iter().enumerate() {
            let Operation::Product(factors) = self.operations.value(*term) else { continue };
            for (i, factor) in factors.iter().enumerate() {
                // the product without it is looked for
                work::spend(4 + factors.len() / 2);
                if i == 0 || factors[i - 1] != *factor {
                    positions.entry(*factor).push(position);
                }
            }
        }
        let candidates = positions.iter().filter(|(_, positions)| positions.len() > 1);
        let choices = candidates.map(|(&factor, positions)| {
            let saved: isize = positions.iter().map(|&position| self.saved(terms[position].1, factor)).sum();
            Choice { factor: Factor::Of(factor), positions: positions.clone(), saved: saved - 1 }
        });
        let choices = choices.chain(numbers(terms));
        // the first of equals
        choices.filter(|choice| choice.saved > 0).reduce(|best, next| if next.saved > best.saved { next } else { best })
    }

    /// The multiplications that a product saves if a factor is taken out.
    fn saved(&self, product: Id, factor: Id) -> isize {
        let Operation::Product(factors) = self.operations.value(product) else { return 0 };
        let rest = without(factors, factor);
        let is_at_hand = match rest.as_slice() {
            [_] => true,
            _ => self.operations.position(&Operation::Product(rest.clone())).is_some_and(|rest| self.uses[rest] > 0),
        };
        let before = if self.uses[product] > 1 { 0 } else { factors.len() as isize - 1 };
        let after = if is_at_hand { 0 } else { rest.len() as isize - 1 };
        before - after
    }

    /// The terms with those of a choice replaced by one product.
    fn taken_out(&mut self, terms: Vec<(Rational, Id)>, choice: &Choice) -> Vec<(Rational, Id)> {
        work::spend(terms.len() * (1 + choice.positions.len() / 16));
        let (taken, mut rest): (Vec<_>, Vec<_>) =
            terms.into_iter().enumerate().partition(|(position, _)| choice.positions.contains(position));
        let (first, sign) = (taken[0].0, integer(if taken[0].1.0.is_negative() { -1 } else { 1 }));
        taken.iter().for_each(|(_, (_, product))| self.release(*product));
        let mut inner = Vec::with_capacity(taken.len());
        for (_, (coefficient, term)) in taken {
            // sums that differ in sign are one
            let left = match &choice.factor {
                Factor::Of(factor) => (coefficient * &sign, self.divided(term, *factor)),
                Factor::Number(number) => (coefficient * &sign / number, term),
            };
            self.append(&mut inner, left);
        }
        inner.retain(|(coefficient, _)| !coefficient.is_zero());
        let sum = match inner.as_slice() {
            // the other terms cancel
            [] => return rest.into_each(|(_, term)| term),
            [(coefficient, only)] if *coefficient == integer(1) => *only,
            _ => self.made(Operation::Sum(integer(0), inner)),
        };
        let (weight, term) = match &choice.factor {
            Factor::Of(factor) => (sign, self.product(*factor, sum)),
            Factor::Number(number) => (sign * number, sum),
        };
        self.take(term);
        let place = rest.iter().position(|(position, _)| *position > first).unwrap_or(rest.len());
        rest.insert(place, (first, (weight, term)));
        rest.into_each(|(_, term)| term)
    }

    fn product(&mut self, factor: Id, other: Id) -> Id {
        let mut factors = match self.operations.value(other) {
            Operation::Product(factors) => factors.clone(),
            _ => vec![other],
        };
        factors.push(factor);
        factors.sort_unstable();
        self.made(Operation::Product(factors))
    }

    fn divided(&mut self, product: Id, factor: Id) -> Id {
        match without(&self.operations.value(product).operands(), factor).as_slice() {
            [only] => *only,
            rest => self.made(Operation::Product(rest.to_vec())),
        }
    }

    /// Adds a term to a sum; of a sum that stands nowhere else, its terms.
    fn append(&self, sum: &mut Vec<(Rational, Id)>, (coefficient, term): (Rational, Id)) {
        match self.operations.value(term) {
            Operation::Sum(constant, inner) if constant.is_zero() && is_unit(&coefficient) && self.uses[term] == 0 => {
                let inner = self.sums.get(&term).unwrap_or(inner);
                inner.iter().for_each(|(weight, term)| add(sum, weight * &coefficient, *term));
            }
            _ => add(sum, coefficient, term),
        }
    }

    fn made(&mut self, operation: Operation) -> Id {
        let (id, _) = self.operations.intern(operation);
        self.uses.resize(self.operations.len(), 0);
        id
    }
}

/// The magnitudes of coefficients that several terms have: one multiplication serves them all.
fn numbers(terms: &[(Rational, Id)]) -> Vec<Choice> {
    let mut choices: Vec<Choice> = Vec::new();
    for (position, (coefficient, _)) in terms.iter().enumerate() {
        let magnitude = coefficient.abs();
        if magnitude == integer(1) {
            continue;
        }
        let same = |choice: &&mut Choice| matches!(&choice.factor, Factor::Number(number) if *number == magnitude);
        match choices.iter_mut().find(same) {
            Some(choice) => {
                choice.positions.push(position);
                choice.saved += 1;
            }
            None => choices.push(Choice { factor: Factor::Number(magnitude), positions: vec![position], saved: 0 }),
        }
    }
    choices
}

fn add(terms: &mut Vec<(Rational, Id)>, coefficient: Rational, term: Id) {
    match terms.iter_mut().find(|(_, other)| *other == term) {
        Some((weight, _)) => *weight += coefficient,
        None => terms.push((coefficient, term)),
    }
}

/// Factors with one of them taken out once.
fn without(factors: &[Id], factor: Id) -> Vec<Id> {
    let mut rest = factors.to_vec();
    if let Some(position) = rest.iter().position(|other| *other == factor) {
        rest.remove(position);
    }
    rest
}

#[cfg(test)]
mod tests;
