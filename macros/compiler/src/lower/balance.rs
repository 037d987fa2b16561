//! Sums in the order in which their terms become available. Early terms are added first, so that the last one waits for
//! one addition alone.

use clebsch_symbolic::{IntoList, Rational, integer};

use super::Code;

/// The cycles of an addition or a multiplication.
pub(super) const STEP: u32 = 4;

/// A summand still to be added: the time at which it is available, its place among the terms, and its coefficient with
/// the factor. A number has no factor.
type Part = (u32, usize, (Rational, Option<Code>));

/// The sum of a constant and of terms, each with the cycle in which it is there.
///
/// The tree of additions always adds the two parts that are available earliest. Of all trees its result is available
/// first, as Huffman's code is the shortest.
pub(super) fn balanced(constant: Rational, terms: impl Iterator<Item = ((Rational, Code), u32)>) -> Code {
    let numbered = terms.enumerate();
    let mut parts: Vec<Part> =
        numbered.map(|(place, ((coefficient, term), delay))| (delay, place, (coefficient, Some(term)))).into_list();
    if parts.len() + usize::from(!constant.is_zero()) < 3 {
        return Code::Sum(constant, parts.into_iter().filter_map(|(_, _, (c, term))| Some((c, term?))).into_list());
    }
    if !constant.is_zero() {
        parts.push((0, parts.len(), (constant, None)));
    }
    while parts.len() > 2 {
        let (one, other) = (earliest(&mut parts), earliest(&mut parts));
        let (delay, place) = (one.0.max(other.0) + STEP, one.1.min(other.1));
        let (sign, sum) = pair(one, other);
        parts.push((delay, place, (sign, Some(sum))));
    }
    let (one, other) = (earliest(&mut parts), earliest(&mut parts));
    let (sign, sum) = pair(one, other);
    if sign == integer(1) { sum } else { Code::Sum(integer(0), vec![(sign, sum)]) }
}

/// When a sum of terms is done that are there in these cycles.
pub(super) fn delay(terms: impl Iterator<Item = u32>) -> u32 {
    let mut delays: Vec<u32> = terms.into_list();
    delays.sort_unstable_by_key(|delay| std::cmp::Reverse(*delay));
    while let [.., later, _] = delays[..] {
        delays.truncate(delays.len() - 2);
        let done = later + STEP;
        delays.insert(delays.partition_point(|delay| *delay >= done), done);
    }
    delays.first().copied().unwrap_or(0)
}

/// Takes out the part that is there first, of several the first.
fn earliest(parts: &mut Vec<Part>) -> Part {
    let first = parts.iter().enumerate().min_by_key(|(_, part)| (part.0, part.1)).map_or(0, |(position, _)| position);
    parts.remove(first)
}

/// The sum of two parts as a sign and a sum in which one of them is positive.
fn pair(one: Part, other: Part) -> (Rational, Code) {
    // the one that stood first is written first
    let (one, other) = if one.1 < other.1 { (one.2, other.2) } else { (other.2, one.2) };
    let sign = integer(if one.0.is_negative() && other.0.is_negative() { -1 } else { 1 });
    let (mut constant, mut terms) = (integer(0), Vec::with_capacity(2));
    for (coefficient, term) in [one, other] {
        match term {
            Some(term) => terms.push((coefficient * &sign, term)),
            None => constant = coefficient * &sign,
        }
    }
    (sign, Code::Sum(constant, terms))
}

#[cfg(test)]
mod tests;
