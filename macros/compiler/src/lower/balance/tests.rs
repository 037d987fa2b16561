use super::{balanced, delay};
use crate::lower::Code;
use clebsch_symbolic::integer;

fn sum(constant: i64, terms: &[(i64, Code)]) -> Code {
    Code::Sum(integer(constant), terms.iter().map(|(weight, term)| (integer(*weight), term.clone())).collect())
}

#[test]
fn terms_that_are_there_at_once_make_a_balanced_tree() {
    let [a, b, c, d] = [0, 1, 2, 3].map(Code::Local);
    let terms = [(1, &a), (-1, &b), (-1, &c), (-1, &d)].map(|(weight, term)| ((integer(weight), term.clone()), 0));
    let pairs = [(1, sum(0, &[(1, a), (-1, b)])), (-1, sum(0, &[(1, c), (1, d)]))];
    assert_eq!(balanced(integer(0), terms.into_iter()), sum(0, &pairs));
    assert_eq!(delay([0; 4].into_iter()), 8);
    assert_eq!((delay([].into_iter()), delay([12].into_iter())), (0, 12));
}

#[test]
fn what_comes_last_is_added_last() {
    let [a, b, c] = [0, 1, 2].map(Code::Local);
    let terms = [(&a, 20), (&b, 0), (&c, 4)].map(|(term, delay)| ((integer(-1), term.clone()), delay));
    let rest = sum(0, &[(1, sum(2, &[(-1, b)])), (-1, c)]);
    assert_eq!(balanced(integer(2), terms.into_iter()), sum(0, &[(-1, a), (1, rest)]));
    assert_eq!(delay([20, 0, 4, 0].into_iter()), 24);
}

#[test]
fn sums_of_two_stay_as_they_are() {
    let [a, b] = [0, 1].map(Code::Local);
    let terms = [((integer(-2), a.clone()), 9), ((integer(-1), b.clone()), 0)];
    assert_eq!(balanced(integer(0), terms.into_iter()), sum(0, &[(-2, a), (-1, b)]));
}
