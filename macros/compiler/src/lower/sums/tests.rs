use super::Id;
use clebsch_symbolic::{Rational, integer};

fn shared(sums: Vec<super::Sum>) -> clebsch_symbolic::Table<Id, Vec<(Rational, Id)>> {
    super::shared(sums, |_, _| true)
}

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

/// 4 − 2 a − b − c − d − e with f = −a − b − c and g = −a − d − e is 4 + f + g.
#[test]
fn what_is_left_of_a_term_may_belong_to_another_sum() {
    let whole = [(-2, 1), (-1, 2), (-1, 3), (-1, 4), (-1, 5)];
    let whole: Vec<(Rational, Id)> = whole.map(|(weight, term)| (integer(weight), term)).to_vec();
    let shared = shared(vec![(10, true, terms(&[-1, -2, -3])), (11, true, terms(&[-1, -4, -5])), (12, false, whole)]);
    assert_eq!(shared.get(&12), Some(&terms(&[10, 11])));
    assert_eq!((shared.get(&10), shared.get(&11)), (None, None));
}

/// 1 + a + b + c + d is not 1 + (a + b + c − d) + 2 d.
#[test]
fn no_digits_are_cancelled() {
    let sums = vec![(10, true, terms(&[1, 2, 3, -4])), (11, false, terms(&[1, 2, 3, 4]))];
    assert!(shared(sums).is_empty());
}

#[test]
fn a_term_that_stands_twice_is_left_alone() {
    assert_eq!(shared(vec![(10, true, terms(&[1, 2])), (11, false, terms(&[1, 1, 2]))]).get(&11), None);
}
