//! Products that share pairs of factors: which pair most of them share, as pairs are taken out one after the other.

use std::cmp::Reverse;

use clebsch_symbolic::{IntoList, Table, work};

use super::kernel::Id;

/// Two factors, the lesser first.
type Pair = (Id, Id);

/// Products and the pairs of their factors.
#[derive(Clone, Default)]
pub struct Pairs {
    products: Table<Id, Vec<Id>>,
    uses: Table<Pair, Uses>,
    /// Which factors divide. Products of two of them are made last: 1/d² overflows where a/d · b/d does not.
    divisors: Vec<bool>,
    /// The pairs that may be shared, each with at least the number of its uses, those of two divisors last.
    queue: Queue,
}

/// Whether a pair has a factor that does not divide, the number of its uses, and the pair.
type Shared = (bool, usize, Reverse<Pair>);

/// A priority queue: a binary heap of numbers. That of the standard library takes a third of the time of long sums without
/// optimisation.
#[derive(Clone, Default)]
struct Queue(Vec<u128>);

impl Queue {
    fn push(&mut self, (is_plain, uses, Reverse((a, b))): Shared) {
        let first = (is_plain as u128) << 127 | (uses as u128) << 64;
        self.0.push(first | !((a as u64) << 32 | b as u64) as u128);
        let heap = self.0.as_mut_slice();
        let mut place = heap.len() - 1;
        while place > 0 && heap[(place - 1) / 2] < heap[place] {
            heap.swap(place, (place - 1) / 2);
            place = (place - 1) / 2;
        }
    }

    fn pop(&mut self) -> Option<Shared> {
        let last = self.0.pop()?;
        let heap = self.0.as_mut_slice();
        let mut greatest = last;
        if !heap.is_empty() {
            (greatest, heap[0]) = (heap[0], last);
        }
        let mut place = 0;
        while 2 * place + 1 < heap.len() {
            let mut child = 2 * place + 1;
            if child + 1 < heap.len() && heap[child] < heap[child + 1] {
                child += 1;
            }
            if heap[child] <= heap[place] {
                break;
            }
            heap.swap(place, child);
            place = child;
        }
        let pair = !(greatest as u64);
        let uses = (greatest >> 64) as u64 & (u64::MAX >> 1);
        Some((greatest >> 127 != 0, uses as usize, Reverse(((pair >> 32) as Id, pair as u32 as Id))))
    }
}

/// Where a pair stands.
#[derive(Clone, Default)]
struct Uses {
    /// The number of products with it.
    all: usize,
    /// The number of those with further factors.
    long: usize,
    /// The products, also some that had it once.
    products: Vec<Id>,
}

impl Uses {
    fn are_shared(&self) -> bool {
        self.all > 1 && self.long > 0
    }
}

impl Pairs {
    /// The factors of a product; `None` of one that is not among these.
    pub fn get(&self, product: Id) -> Option<&[Id]> {
        self.products.get(&product).map(Vec::as_slice)
    }

    /// Products with their factors, sorted, and which factors divide.
    pub fn new(products: impl Iterator<Item = (Id, Vec<Id>)>, divisors: Vec<bool>) -> Pairs {
        let mut pairs = Pairs { divisors, ..Pairs::default() };
        for (product, factors) in products {
            distinct(&factors).into_iter().for_each(|pair| pairs.count(product, factors.len(), pair));
            pairs.products.insert(product, factors);
        }
        let shared = pairs.uses.iter().filter(|(_, uses)| uses.are_shared());
        let shared = shared.map(|(pair, uses)| pairs.waiting(*pair, uses.all)).into_list();
        shared.into_iter().for_each(|pair| pairs.queue.push(pair));
        pairs
    }

    fn divides(&self, factor: Id) -> bool {
        // products that have been taken out since do not
        let divisors = self.divisors.as_slice();
        factor < divisors.len() && divisors[factor]
    }

    fn waiting(&self, (a, b): Pair, uses: usize) -> Shared {
        (!self.divides(a) || !self.divides(b), uses, Reverse((a, b)))
    }

    /// Sets the factors of a product, sorted.
    pub fn insert(&mut self, product: Id, factors: Vec<Id>) {
        for pair in distinct(&factors) {
            self.count(product, factors.len(), pair);
            let uses = &self.uses[&pair];
            if uses.are_shared() {
                let waiting = self.waiting(pair, uses.all);
                self.queue.push(waiting);
            }
        }
        self.products.insert(product, factors);
    }

    fn count(&mut self, product: Id, length: usize, pair: Pair) {
        work::spend(5);
        let uses = self.uses.entry(pair);
        uses.all += 1;
        uses.long += usize::from(length > 2);
        uses.products.push(product);
    }

    /// The pair that most products share, the first of several; `None` if no product of more than two factors shares one.
    pub fn most_common(&mut self) -> Option<Pair> {
        while let Some((_, count, Reverse(pair))) = self.queue.pop() {
            // a step for each level of the heap
            work::spend(3 + self.queue.0.len().max(1).ilog2() as usize / 2);
            let uses = &self.uses[&pair];
            if uses.are_shared() && uses.all == count {
                return Some(pair);
            }
            // some of its uses are gone
            let waiting = uses.are_shared().then(|| self.waiting(pair, uses.all));
            waiting.into_iter().for_each(|pair| self.queue.push(pair));
        }
        None
    }

    /// Puts the product of a pair in its place wherever there are further factors.
    pub fn replace(&mut self, pair: Pair, by: Id) {
        for product in std::mem::take(&mut self.uses.entry(pair).products) {
            let mut factors = self.products[&product].clone();
            while factors.len() > 2 && take(&mut factors, pair) {
                factors.push(by);
                factors.sort_unstable();
            }
            if factors != self.products[&product] {
                self.forget(product);
                self.insert(product, factors);
            }
        }
    }

    fn forget(&mut self, product: Id) {
        let factors = &self.products[&product];
        for pair in distinct(factors) {
            let uses = self.uses.entry(pair);
            uses.all -= 1;
            uses.long -= usize::from(factors.len() > 2);
        }
    }
}

/// The distinct pairs of sorted factors.
fn distinct(factors: &[Id]) -> Vec<Pair> {
    let mut pairs = Vec::with_capacity(factors.len() * factors.len() / 2);
    for (i, &a) in factors.iter().enumerate() {
        if i > 0 && factors[i - 1] == a {
            continue;
        }
        for (j, &b) in factors.iter().enumerate().skip(i + 1) {
            if j == i + 1 || factors[j - 1] != b {
                pairs.push((a, b));
            }
        }
    }
    pairs
}

/// Removes both factors of a pair, if they are there.
fn take(factors: &mut Vec<Id>, (a, b): Pair) -> bool {
    let first = factors.iter().position(|&factor| factor == a);
    let second = factors.iter().rposition(|&factor| factor == b);
    match (first, second) {
        (Some(first), Some(second)) if first < second => {
            factors.remove(second);
            factors.remove(first);
            true
        }
        _ => false,
    }
}

#[cfg(test)]
mod tests;
