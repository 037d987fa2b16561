//! Fewer operations for the same outputs, and when each of them is done.

use clebsch_symbolic::{Elements, IntoList, Rational, Table, integer, work};

use super::{Builder, Id, Operation};
use crate::lower::scalar::is_unit;
use crate::lower::{LARGEST_KERNEL, balance, factors, sums};

/// The additions and multiplications that a processor begins in a cycle, about.
const SIDE_BY_SIDE: usize = 3;
/// The cycles of a division,
const DIVISION: u32 = 13;
/// of a root,
const ROOT: u32 = 18;
/// and of an elementary function, about.
const CALL: u32 = 40;

/// When a term of a sum is there.
pub(super) fn delay_of_term(delays: &[u32], (coefficient, term): &(Rational, Id)) -> u32 {
    delays[*term] + if is_unit(coefficient) { 0 } else { balance::STEP }
}

/// A kernel that is so many times longer than the longest is refused without a search for fewer operations. The search never
/// left less than a quarter.
const BEYOND: usize = 8;

/// The work of a search through sums within sums.
const JOINED: u64 = 600_000;
/// Further searches leave next to nothing.
const JOINS: usize = 2;

impl Builder<'_, '_> {
    /// Whether unrolled code is refused for this kernel, however much shorter it can be made.
    pub(super) fn is_beyond_limits(&self) -> bool {
        self.operations.len() > LARGEST_KERNEL && self.count_operations() > BEYOND * LARGEST_KERNEL
    }

    /// Looks for fewer operations, within the allowance of the program for that. A search that does not end within it changes
    /// nothing. If it is one of the first, of pairs of factors and of terms, no other one is begun.
    pub(super) fn shorten(&mut self) {
        if !self.scalars.keeps_sums {
            self.search(Self::share_multiples, JOINED);
        }
        let is_complete = self.search(Self::share_pairs, u64::MAX)
            && (self.scalars.keeps_sums || self.search(Self::share_terms, u64::MAX));
        if !is_complete {
            (self.scalars.is_plain, self.scalars.searches) = (true, 0);
        } else if !self.scalars.keeps_sums {
            self.search(Self::join_sums, JOINED);
            self.search(Self::share_pairs_around_sums, JOINED);
        }
    }

    /// Pairs of factors once more, without those of the sums among them, where that leaves fewer operations.
    fn share_pairs_around_sums(&mut self) {
        let before = self.count_operations();
        let products = self.products.clone();
        self.share_pairs_of(|_, factors| factors.to_vec());
        if self.count_operations() >= before {
            self.products = products;
        }
    }

    /// Makes a search with this much work at most, and says whether it ended.
    fn search(&mut self, search: fn(&mut Self), most: u64) -> bool {
        let mut allowance = self.scalars.searches;
        let found = (self.sums.clone(), self.products.clone());
        let is_complete = work::on(&mut allowance, || work::within(most, || search(self))) == Ok(Ok(()));
        if !is_complete {
            (self.sums, self.products) = found;
        }
        self.scalars.searches = allowance;
        is_complete
    }

    /// Common factors and sums within sums; where numbers can be separated, with them and without.
    fn share_terms(&mut self) {
        let separated = self.separate_numbers().map(|separated| (separated, self.products.clone()));
        self.factor_sums(false);
        self.share_sums();
        if let Some((separated, products)) = separated {
            let before = self.count_operations();
            let plain = (std::mem::replace(&mut self.sums, separated), std::mem::replace(&mut self.products, products));
            self.factor_sums(false);
            self.share_sums();
            if self.count_operations() >= before {
                (self.sums, self.products) = plain;
            }
        }
    }

    /// Common factors of the terms of a sum and of sums in it, as long as they leave fewer operations, a few times at most.
    fn join_sums(&mut self) {
        for _ in 0..JOINS {
            let before = self.count_operations();
            self.factor_sums(true);
            self.share_sums();
            if self.count_operations() >= before {
                return;
            }
        }
    }

    /// A product a x with a = n b is written as n times b x. The condition is that a occurs nowhere else and b x is at
    /// hand. Then b x of other sums is found in this one. `None` where there is no such product.
    fn separate_numbers(&self) -> Option<Table<Id, Vec<(Rational, Id)>>> {
        let (mut sums, mut is_found) = (self.sums.clone(), false);
        let used = self.used();
        let mut uses = vec![0_usize; self.operations.len()];
        let operands = used.iter().flat_map(|&id| match self.operations.value(id) {
            Operation::Sum(_, terms) => self.terms(id, terms).each(|(_, term)| *term),
            operation => operation.operands(),
        });
        operands.chain(self.outputs.iter().copied()).for_each(|id| uses[id] += 1);
        let separate = |(coefficient, term): &(Rational, Id)| {
            let found = self.separated(*term).filter(|(_, product)| uses[*term] == 1 && uses[*product] > 0);
            found.map_or((coefficient.clone(), *term), |(number, product)| (coefficient * &number, product))
        };
        for &id in &used {
            let Operation::Sum(_, terms) = self.operations.value(id) else { continue };
            if self.sums.contains(&id) {
                continue;
            }
            let separated: Vec<_> = terms.each(separate);
            if separated != *terms {
                sums.insert(id, separated);
                is_found = true;
            }
        }
        is_found.then_some(sums)
    }

    /// A product of something that is taken out as a number times the product without the number, where that one is known.
    fn separated(&self, product: Id) -> Option<(Rational, Id)> {
        let Operation::Product(factors) = self.operations.value(product) else { return None };
        factors.iter().enumerate().find_map(|(position, &factor)| {
            let Operation::Leaf(scalar) = self.operations.value(factor) else { return None };
            let (number, Some(rest)) = self.scalars.factor(*scalar) else { return None };
            let plain = self.operations.position(&Operation::Leaf(rest)).filter(|_| number != integer(1))?;
            let mut factors = factors.clone();
            factors[position] = plain;
            factors.sort_unstable();
            Some((number, self.operations.position(&Operation::Product(factors))?))
        })
    }

    /// Takes common factors out of sums, where that leaves fewer operations once pairs are shared again.
    fn factor_sums(&mut self, joins: bool) {
        let before = self.count_operations();
        let sums = factors::factored(&mut self.operations, &self.outputs, self.sums.clone(), joins);
        if sums.iter().all(|(id, terms)| self.sums.get(id) == Some(terms)) {
            return;
        }
        let products = std::mem::take(&mut self.products);
        let plain = std::mem::replace(&mut self.sums, sums);
        self.share_pairs();
        if self.count_operations() >= before {
            (self.sums, self.products) = (plain, products);
        }
    }

    /// The additions and multiplications of the outputs, shared ones once.
    fn count_operations(&self) -> usize {
        let count = |id: Id| match self.operations.value(id) {
            Operation::Sum(constant, terms) => {
                let terms = self.terms(id, terms);
                let scaled = terms.iter().filter(|(weight, _)| !is_unit(weight)).count();
                (terms.len() + usize::from(!constant.is_zero())).saturating_sub(1) + scaled
            }
            Operation::Product(factors) => self.products.get(id).unwrap_or(factors).len() - 1,
            _ => 0,
        };
        self.used().into_iter().map(count).sum()
    }

    /// Puts a sum that stands within others, as a + b in 1 − a − b, into them by its name.
    fn share_sums(&mut self) {
        let used = self.used();
        let found = used.into_iter().filter_map(|id| match self.operations.value(id) {
            Operation::Sum(constant, terms) if terms.len() > 1 => {
                Some((id, constant.is_zero(), self.terms(id, terms).to_vec()))
            }
            _ => None,
        });
        // if the longest chain determines the time, no sum may wait longer than before
        let delays = self.delays_in(&self.uses().1);
        let waits = self.waits(&delays);
        let delay = |terms: &[(Rational, Id)]| balance::delay(terms.iter().map(|term| delay_of_term(&delays, term)));
        let shared = sums::shared(found.into_list(), |shorter, whole| !waits || delay(shorter) <= delay(whole));
        for (sum, terms) in shared.iter() {
            self.sums.insert(*sum, terms.clone());
        }
    }

    /// Whether the longest chain of operations takes longer than all of them side by side.
    pub(super) fn waits(&self, delays: &[u32]) -> bool {
        let longest = self.outputs.iter().map(|&entry| delays[entry]).max().unwrap_or(0);
        self.count_operations() < SIDE_BY_SIDE * longest as usize
    }

    /// When operations that stand behind their operands are done, in cycles after the arguments are there, as common processors take them.
    pub(super) fn delays_in(&self, order: &[Id]) -> Vec<u32> {
        let mut delays = vec![0; self.operations.len()];
        order.iter().for_each(|&id| delays[id] = self.delay(id, &delays));
        delays
    }

    fn delay(&self, id: Id, delays: &[u32]) -> u32 {
        let latest = || {
            let mut latest = 0;
            self.each_operand(id, |operand| latest = latest.max(delays[operand]));
            latest
        };
        match self.operations.value(id) {
            Operation::Leaf(_) => 0,
            Operation::Sum(constant, terms) => {
                let terms = self.terms(id, terms).iter().map(|term| delay_of_term(delays, term));
                balance::delay(terms.chain((!constant.is_zero()).then_some(0)))
            }
            Operation::Product(factors) => {
                let count = self.products.get(id).unwrap_or(factors).len() as u32;
                latest() + balance::STEP * (count - 1)
            }
            Operation::Reciprocal(_) => latest() + DIVISION,
            Operation::Root(..) => latest() + ROOT,
            Operation::Function(..) | Operation::Call(..) => latest() + CALL,
            Operation::Output(..) => latest(),
        }
    }
}
