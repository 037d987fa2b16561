//! Values that are computed less often than the kernels that use them: of a value and its negative, one.

use clebsch_symbolic::{Elements, IntoList, integer, work};

use super::{Hoisting, kernel};
use crate::lower::entries::Grid;
use crate::lower::{Code, Kernel, Scalar, ScalarNode, Scalars, signs};

/// Values that are computed less often than the kernels that use them.
#[derive(Clone, Default, Debug)]
pub struct Hoisted {
    /// In the order in which they were met.
    met: Vec<Met>,
    /// The number of values that are stored.
    kept: usize,
}

#[derive(Clone, Debug)]
struct Met {
    scalar: Scalar,
    /// Whether its negative is stored.
    is_negative: bool,
    /// Its index among the stored values.
    place: usize,
    /// Whether it is the first of its place.
    is_first: bool,
}

impl Hoisted {
    /// Whether the negative of a value is stored, and its index.
    pub(super) fn index(&mut self, scalars: &Scalars, scalar: Scalar) -> (bool, usize) {
        work::spend(1 + self.met.len() / 32);
        let known = |wanted: Scalar| self.met.iter().find(|met| met.scalar == wanted);
        if let Some(met) = known(scalar) {
            return (met.is_negative, met.place);
        }
        let (is_negative, place) = match scalars.negated(scalar).and_then(known) {
            Some(opposite) => (!opposite.is_negative, opposite.place),
            None => (scalars.is_negative(scalar), self.kept),
        };
        let is_first = place == self.kept;
        self.kept = self.kept.max(place + 1);
        self.met.push(Met { scalar, is_negative, place, is_first });
        (is_negative, place)
    }

    /// The stored values: each as it was first met, and whether its negative is stored.
    pub fn kept(&self) -> impl Iterator<Item = (Scalar, bool)> {
        self.first().map(|(_, met)| (met.scalar, met.is_negative))
    }

    /// The first of each place, with its number among those that were met.
    fn first(&self) -> impl Iterator<Item = (usize, &Met)> {
        self.met.iter().enumerate().filter(|(_, met)| met.is_first)
    }

    /// Computes the stored values, one output each.
    pub(in crate::lower) fn kernel(&self, scalars: &mut Scalars, hoisting: Hoisting<'_>) -> Kernel {
        // with those that are not stored: terms that they share with others decide how these are rounded
        let outputs: Vec<Grid> = self.met.each(|met| Grid::scalar(met.scalar));
        let Kernel { locals, outputs } = kernel(scalars, &outputs, hoisting);
        let signed = |(number, met): (usize, &Met)| {
            let (shape, entries) = &outputs[number];
            let signed = |code: &Code| if met.is_negative { signs::negative(code.clone()) } else { code.clone() };
            (*shape, entries.each(signed))
        };
        let outputs = self.first().map(signed).into_list();
        Kernel { locals, outputs }.without_unused()
    }
}

impl Scalars {
    /// −x, if it is known. Only a sum is negated anew; for another expression −x has to exist.
    fn negated(&self, scalar: Scalar) -> Option<Scalar> {
        let minus = integer(-1);
        match self.node(scalar) {
            ScalarNode::Sum(constant, terms) if constant.is_zero() && terms.len() == 1 && terms[0].1 == minus => {
                Some(terms[0].0)
            }
            ScalarNode::Sum(constant, terms) => {
                let terms = terms.each(|(term, weight)| (*term, weight * &minus));
                self.known(&ScalarNode::Sum(constant * &minus, terms))
            }
            _ => self.known(&ScalarNode::Sum(integer(0), vec![(scalar, minus)])),
        }
    }

    /// Whether all of its terms are subtracted.
    fn is_negative(&self, scalar: Scalar) -> bool {
        match self.node(scalar) {
            ScalarNode::Sum(constant, terms) => {
                (constant.is_zero() || constant.is_negative()) && terms.iter().all(|(_, weight)| weight.is_negative())
            }
            _ => false,
        }
    }
}
