//! Sums that are multiples of other sums: for constants a, b and k, k a x + k b y is k (a x + b y).
//!
//! Constants are multiplied with each other first. So k a and k b are constants of their own, and their sum costs as much
//! as a x + b y. Where that is there anyway, one multiplication is left of it.

use clebsch_symbolic::{Elements, Rational, Table, integer, work};

use super::{Builder, Id, Operation, Rate};
use crate::lower::scalar::{Factors, add, is_unit};

/// In kernels of more operations the number of these determines the time.
const LONGEST_CHAIN: usize = 1000;

/// A sum, the constants of its terms, and how many factors and numbers these have in all.
type Member = (Id, Vec<(Rational, Factors)>, (u32, usize));

impl Builder<'_, '_> {
    /// Writes sums as multiples of others, unless outputs would have to wait longer for them.
    pub(super) fn share_multiples(&mut self) {
        let multiples = self.multiples();
        if multiples.is_empty() {
            return;
        }
        let is_short = self.operations.len() <= LONGEST_CHAIN;
        let before = is_short.then(|| self.longest_wait()).flatten();
        let plain = self.sums.clone();
        for (sum, (ratio, factors), base) in multiples {
            let sign = if ratio.is_negative() { -integer(1) } else { integer(1) };
            let factor = self.scalars.product(super::repeated(&factors));
            let factor = self.scalars.scale(factor, ratio.abs());
            let term = if self.scalars.as_number(factor).is_some() {
                (ratio, base)
            } else {
                let mut factors = vec![self.convert(factor), base];
                factors.sort_unstable();
                (sign, self.intern(Operation::Product(factors)))
            };
            self.sums.insert(sum, vec![term]);
        }
        if before.is_some_and(|before| self.longest_wait().is_some_and(|after| after > before)) {
            self.sums = plain;
        }
    }

    /// The time at which the last output is there, where the longest chain of operations determines it.
    fn longest_wait(&self) -> Option<u32> {
        let delays = self.delays_in(&self.uses().1);
        self.waits(&delays).then(|| self.outputs.iter().map(|&entry| delays[entry]).max().unwrap_or(0))
    }

    /// Factors, and in place of a sum that is written as a product the factors of that.
    pub(super) fn flat(&self, factors: &[Id]) -> Vec<Id> {
        let mut flat = Vec::with_capacity(factors.len());
        for &factor in factors {
            match self.multiple(factor).map(|multiple| self.operations.value(multiple)) {
                Some(Operation::Product(factors)) => flat.extend(factors),
                _ => flat.push(factor),
            }
        }
        flat.sort_unstable();
        flat
    }

    /// The product, or the sum, that a sum is written as.
    fn multiple(&self, sum: Id) -> Option<Id> {
        let Operation::Sum(constant, _) = self.operations.value(sum) else { return None };
        match self.sums.get(&sum)?.as_slice() {
            [(one, multiple)] if constant.is_zero() && *one == integer(1) => Some(*multiple),
            _ => None,
        }
    }

    /// Sums with a ratio and the sum that is to be multiplied by it. That one has fewer factors, or fewer numbers.
    fn multiples(&self) -> Vec<(Id, (Rational, Factors), Id)> {
        let mut alike: Table<Vec<Vec<Id>>, Vec<Member>> = Table::default();
        for id in self.used() {
            if let Operation::Sum(constant, terms) = self.operations.value(id)
                && constant.is_zero()
                && terms.len() > 1
            {
                work::spend(4 * terms.len());
                let mut terms = terms.each(|(coefficient, term)| self.parted(coefficient, *term));
                terms.sort_unstable_by(|a, b| a.1.cmp(&b.1));
                let (constants, changing): (Vec<_>, Vec<_>) = terms.into_iter().unzip();
                let size = constants.iter().flat_map(|(_, factors)| factors).map(|(_, power)| power).sum();
                let numbers = constants.iter().filter(|(number, _)| !is_unit(number)).count();
                alike.entry(changing).push((id, constants, (size, numbers)));
            }
        }
        let mut found = Vec::new();
        for (_, members) in alike.iter().filter(|(_, members)| members.len() > 1) {
            let mut members = members.iter().collect::<Vec<_>>();
            members.sort_by_key(|(id, _, size)| (*size, *id));
            let (mut bases, mut others): (Vec<&Member>, Vec<&Member>) = (Vec::new(), Vec::new());
            for member in members {
                let multiple_of = |base: &&Member| Some((ratio(&member.1, &base.1)?, base.0));
                let is_by_number = |((_, factors), _): &((Rational, Factors), Id)| factors.is_empty();
                // of other bases a number could be taken out later: they could become multiples of this sum
                let plain = bases.iter().chain(&others).filter(|base| base.2.1 == 0);
                let by_number = plain.filter_map(multiple_of).find(is_by_number);
                let by_factors = || bases.iter().filter_map(multiple_of).find(|multiple| !is_by_number(multiple));
                match by_number.or_else(by_factors) {
                    Some((ratio, base)) => {
                        found.push((member.0, ratio, base));
                        others.push(member);
                    }
                    None => bases.push(member),
                }
            }
        }
        found
    }

    /// A term as a constant and the factors that change. A constant is a number with factors.
    fn parted(&self, coefficient: &Rational, term: Id) -> ((Rational, Factors), Vec<Id>) {
        let factors = match self.operations.value(term) {
            Operation::Product(factors) => factors.as_slice(),
            _ => &[term],
        };
        let (mut number, mut constant, mut changing) = (coefficient.clone(), Factors::new(), Vec::new());
        for &factor in factors {
            match self.operations.value(factor) {
                Operation::Leaf(scalar) if self.scalars.rate(*scalar) == Rate::Once => {
                    let (part, rest) = self.scalars.factor(*scalar);
                    number *= &part;
                    for (base, power) in rest.into_iter().flat_map(|rest| self.scalars.factors(rest)) {
                        add(&mut constant, base, power);
                    }
                }
                _ => changing.push(factor),
            }
        }
        ((number, constant), changing)
    }
}

/// The factors that the constants of one sum have more than those of another. `None` where they are not the same for all.
fn ratio(of: &[(Rational, Factors)], base: &[(Rational, Factors)]) -> Option<(Rational, Factors)> {
    let mut common: Option<(Rational, Factors)> = None;
    for ((number, factors), (other, divisors)) in of.iter().zip(base) {
        // the number may be 0 where constants cancel
        if other.is_zero() || number.is_zero() {
            return None;
        }
        let mut left = factors.clone();
        for (divisor, power) in divisors {
            let (_, own) = left.iter_mut().find(|(factor, _)| factor == divisor)?;
            *own = own.checked_sub(*power)?;
        }
        left.retain(|(_, power)| *power > 0);
        let ratio = (number / other, left);
        if *common.get_or_insert_with(|| ratio.clone()) != ratio {
            return None;
        }
    }
    common.filter(|(number, factors)| !factors.is_empty() || !is_unit(number))
}

#[cfg(test)]
mod tests;
