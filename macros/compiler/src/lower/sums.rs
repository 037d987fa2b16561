//! Sums within sums.

use clebsch_symbolic::{IntoList, Rational, Table, integer};

use super::kernel::Id;
use super::scalar::is_unit;

/// A sum: its index, whether it has no constant, and its terms.
type Sum = (Id, bool, Vec<(Rational, Id)>);

/// Some sums contain all terms of another sum. If that is less work, they are written with that sum, or its negative, in
/// place of these terms. With d = −a − b − c, for example, 1 − 2a − b − c is 1 + d − a. The named sum may then occur,
/// among other terms, in a further sum. `serves` decides whether some terms may replace others.
pub(super) fn shared(
    mut sums: Vec<Sum>,
    serves: impl Fn(&[(Rational, Id)], &[(Rational, Id)]) -> bool,
) -> Table<Id, Vec<(Rational, Id)>> {
    let mut shared = Table::default();
    loop {
        let found = shortest(&sums, &serves);
        if found.is_empty() {
            return shared;
        }
        for (position, terms) in found.iter() {
            sums[*position].2.clone_from(terms);
            shared.insert(sums[*position].0, terms.clone());
        }
    }
}

/// Of those sums, by position, in which another one can stand: the terms that are the least work.
fn shortest(
    sums: &[Sum],
    serves: &impl Fn(&[(Rational, Id)], &[(Rational, Id)]) -> bool,
) -> Table<usize, Vec<(Rational, Id)>> {
    let mut holders: Table<Id, Vec<usize>> = Table::default();
    for (position, (_, _, terms)) in sums.iter().enumerate() {
        for (_, term) in terms {
            holders.entry(*term).push(position);
        }
    }
    // of equals the shortest, which is a part of others too
    let is_part = |position: &usize| sums[*position].1 && sums[*position].2.len() > 1;
    let mut parts: Vec<usize> = (0..sums.len()).filter(is_part).into_list();
    parts.sort_by_key(|&position| sums[position].2.len());
    let mut found: Table<usize, Vec<(Rational, Id)>> = Table::default();
    for part in parts {
        let (name, _, terms) = &sums[part];
        // a sum with all terms has the rarest one
        let held = terms.iter().filter_map(|(_, term)| holders.get(term)).min_by_key(|held| held.len());
        for &position in held.into_iter().flatten() {
            let (id, has_no_constant, whole) = &sums[position];
            // a longer sum has a shorter one in it. Of two with the same terms, the one with less work, or the first,
            // gives the other: no two have each other
            let comes_after = whole.len() > terms.len()
                || whole.len() == terms.len() && (!has_no_constant || (work(whole), id) > (work(terms), name));
            if comes_after
                && let Some(replaced) = replaced(whole, terms, *name)
                && found.get(&position).is_none_or(|best| work(&replaced) < work(best))
                && serves(&replaced, whole)
            {
                found.insert(position, replaced);
            }
        }
    }
    found
}

/// A sum with ±1 times a part of it by name. `None` if the sum does not contain the terms of the part, or if nothing is
/// saved.
fn replaced(whole: &[(Rational, Id)], part: &[(Rational, Id)], name: Id) -> Option<Vec<(Rational, Id)>> {
    if whole.iter().any(|(_, term)| *term == name) {
        return None;
    }
    let weight_in = |terms: &[(Rational, Id)], wanted: Id| {
        clebsch_symbolic::work::spend(6 + terms.len() / 4);
        // a term that stands in it twice is left alone
        let mut found = terms.iter().filter(|(_, term)| *term == wanted).map(|(weight, _)| weight.clone());
        found.next().filter(|_| found.next().is_none())
    };
    let sign = integer(if weight_in(whole, part[0].1)?.is_negative() == part[0].0.is_negative() { 1 } else { -1 });
    // the part is a part of each term: a + b + c + d as (a + b + c − d) + 2 d would cancel digits
    let is_within = |(taken, term): &(Rational, Id)| {
        let taken = taken.clone() * &sign;
        weight_in(whole, *term).is_some_and(|weight| {
            let left = weight.clone() - &taken;
            weight.is_negative() == taken.is_negative()
                && (left.is_zero() || left.is_negative() == weight.is_negative())
        })
    };
    if !part.iter().all(is_within) {
        return None;
    }
    let left = whole.iter().map(|(weight, term)| match weight_in(part, *term) {
        Some(taken) => (weight.clone() - taken * &sign, *term),
        None => (weight.clone(), *term),
    });
    let left: Vec<_> = left.filter(|(weight, _)| !weight.is_zero()).chain([(sign.clone(), name)]).into_list();
    (work(&left) < work(whole)).then_some(left)
}

/// The additions and multiplications of a sum without a constant.
fn work(terms: &[(Rational, Id)]) -> usize {
    terms.len() - 1 + terms.iter().filter(|(weight, _)| !is_unit(weight)).count()
}

#[cfg(test)]
mod tests;
