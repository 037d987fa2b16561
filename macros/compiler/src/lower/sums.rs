//! Sums within sums.

use clebsch_symbolic::{Rational, Table};

/// The index of an operation of a kernel.
type Id = usize;

/// A sum: its index, whether it has no constant, and its terms.
type Sum = (Id, bool, Vec<(Rational, Id)>);

/// The terms of those sums that hold the whole of another one, or of its negative, with that one as a term.
pub(super) fn shared(sums: Vec<Sum>) -> Table<Id, Vec<(Rational, Id)>> {
    let mut holders: Table<Id, Vec<usize>> = Table::default();
    for (position, (_, _, terms)) in sums.iter().enumerate() {
        for (_, term) in terms {
            holders.entry(*term).push(position);
        }
    }
    // the longest first: what is left of a sum may hold a shorter one
    let mut parts: Vec<usize> = (0..sums.len()).filter(|&position| sums[position].1).collect();
    parts.sort_by_key(|&position| std::cmp::Reverse(sums[position].2.len()));
    let mut shared: Table<Id, Vec<(Rational, Id)>> = Table::default();
    for part in parts {
        let (name, _, terms) = &sums[part];
        // what holds all terms holds the rarest
        let held = terms.iter().filter_map(|(_, term)| holders.get(term)).min_by_key(|held| held.len());
        for &whole in held.into_iter().flatten() {
            let (id, has_no_constant, whole) = &sums[whole];
            // of a sum and its negative, the first gives the other
            if *has_no_constant && whole.len() == terms.len() && id <= name {
                continue;
            }
            let current = shared.get(id).unwrap_or(whole);
            if let Some(replaced) = replaced(current, terms, *name) {
                shared.insert(*id, replaced);
            }
        }
    }
    shared
}

/// A sum with ±1 times a part of it by name; `None` where it does not hold the part.
fn replaced(whole: &[(Rational, Id)], part: &[(Rational, Id)], name: Id) -> Option<Vec<(Rational, Id)>> {
    if whole.len() < part.len() {
        return None;
    }
    let coefficient = |wanted: Id| whole.iter().find(|(_, term)| *term == wanted).map(|(coefficient, _)| coefficient);
    let sign = clebsch_symbolic::integer(if *coefficient(part[0].1)? == part[0].0 { 1 } else { -1 });
    let holds =
        |(weight, term): &(Rational, Id)| coefficient(*term).is_some_and(|c| *c == weight.clone() * sign.clone());
    if !part.iter().all(holds) {
        return None;
    }
    let rest: Vec<_> = whole.iter().filter(|(_, term)| !part.iter().any(|(_, other)| other == term)).cloned().collect();
    // a term that stands in it twice is left alone
    let is_whole = rest.len() + part.len() == whole.len();
    is_whole.then(|| rest.into_iter().chain([(sign, name)]).collect())
}

#[cfg(test)]
mod tests {
    use super::{Id, shared};
    use clebsch_symbolic::{Rational, integer};

    fn terms(signed: &[i64]) -> Vec<(Rational, Id)> {
        signed.iter().map(|&term| (integer(term.signum()), term.unsigned_abs() as Id)).collect()
    }

    #[test]
    fn a_sum_within_another_is_put_in_by_name() {
        let sums = vec![(10, true, terms(&[1, 2])), (11, false, terms(&[-2, 3, -1])), (12, true, terms(&[1, -2, 3]))];
        let shared = shared(sums);
        assert_eq!(shared.get(&11), Some(&terms(&[3, -10])));
        assert_eq!((shared.get(&10), shared.get(&12)), (None, None));
    }

    #[test]
    fn of_a_sum_and_its_negative_one_gives_the_other() {
        let shared = shared(vec![(10, true, terms(&[1, 2])), (11, true, terms(&[-1, -2]))]);
        assert_eq!((shared.get(&10), shared.get(&11)), (None, Some(&terms(&[-10]))));
    }

    #[test]
    fn a_term_that_stands_twice_is_left_alone() {
        assert_eq!(shared(vec![(10, true, terms(&[1, 2])), (11, false, terms(&[1, 1, 2]))]).get(&11), None);
    }
}
