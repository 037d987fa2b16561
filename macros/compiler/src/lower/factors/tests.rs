use crate::lower::entries::Grid;
use crate::lower::kernel::kernel;
use crate::lower::{Hoisting, Input, Scalar, Scalars};
use clebsch_symbolic::{Role, Shape, integer};

/// Entries of an input.
fn inputs<const N: usize>(scalars: &mut Scalars) -> [Scalar; N] {
    let entry = |row| Input { role: Role::Momentum(0), name: "x".to_string(), row, column: 0, shape: Shape::vector(N) };
    std::array::from_fn(|row| scalars.input(entry(row)))
}

/// Σ ± the products of some factors.
fn sum(scalars: &mut Scalars, terms: &[(i64, &[Scalar])]) -> Scalar {
    let terms: Vec<_> =
        terms.iter().map(|(sign, factors)| (scalars.product(factors.iter().copied()), integer(*sign))).collect();
    scalars.sum(integer(0), terms)
}

/// Additions and multiplications of outputs.
fn operations(scalars: &mut Scalars, outputs: Vec<Scalar>) -> (usize, usize) {
    let cost = kernel(scalars, &[Grid::vector(outputs)], Hoisting::Nothing).cost();
    (cost.additions, cost.multiplications)
}

/// An arena with work for searches.
fn scalars() -> Scalars {
    let mut scalars = Scalars::default();
    scalars.searches = 1_000_000;
    scalars
}

#[test]
fn a_common_factor_is_taken_out() {
    let mut scalars = scalars();
    let [a, b, c] = inputs(&mut scalars);
    let whole = sum(&mut scalars, &[(1, &[a, b]), (-1, &[a, c])]);
    assert_eq!(operations(&mut scalars, vec![whole]), (1, 1));
}

#[test]
fn what_is_at_hand_is_not_made_again() {
    let mut scalars = scalars();
    let [a, b, c] = inputs(&mut scalars);
    let [left, right] = [[a, b], [a, c]].map(|factors| scalars.product(factors));
    let whole = sum(&mut scalars, &[(1, &[a, b]), (1, &[a, c])]);
    assert_eq!(operations(&mut scalars, vec![left, right, whole]), (1, 2));
}

/// k (a b − c d) + k (a e + c f) = k (a (b + e) + c (f − d)).
#[test]
fn sums_that_stand_alone_are_opened() {
    let mut scalars = scalars();
    let [k, a, b, c, d, e, f] = inputs(&mut scalars);
    let first = sum(&mut scalars, &[(1, &[a, b]), (-1, &[c, d])]);
    let second = sum(&mut scalars, &[(1, &[a, e]), (1, &[c, f])]);
    let whole = sum(&mut scalars, &[(1, &[k, first]), (1, &[k, second])]);
    assert_eq!(operations(&mut scalars, vec![whole]), (3, 3));
}

/// (a b + a c)/2 − (a d − b c)/2 = (a (b + c − d) + b c)/2.
#[test]
fn numbers_are_factors() {
    let mut scalars = scalars();
    let [a, b, c, d] = inputs(&mut scalars);
    let first = sum(&mut scalars, &[(1, &[a, b]), (1, &[a, c])]);
    let second = sum(&mut scalars, &[(1, &[a, d]), (-1, &[b, c])]);
    let half = clebsch_symbolic::rational(1, 2);
    let whole = scalars.sum(integer(0), [(first, half.clone()), (second, -half)]);
    assert_eq!(operations(&mut scalars, vec![whole]), (3, 3));
}

/// k (a b − a b) + k c: terms that cancel once the factor is out leave nothing.
#[test]
fn what_cancels_leaves_nothing() {
    let mut scalars = scalars();
    let [k, a, b, c] = inputs(&mut scalars);
    let [first, second] = [(1, c), (-1, a)].map(|(sign, other)| sum(&mut scalars, &[(1, &[a, b]), (sign, &[other])]));
    let whole = sum(&mut scalars, &[(1, &[k, first]), (-1, &[k, second])]);
    assert_eq!(operations(&mut scalars, vec![whole]), (1, 1));
}

/// c (1 + k a + k b) = c (1 + k (a + b)). The sum of a constant and one product is not taken apart.
#[test]
fn a_constant_beside_a_common_factor_stays() {
    let mut scalars = scalars();
    let [a, b, c, k] = inputs(&mut scalars);
    let terms = [[k, a], [k, b]].map(|factors| (scalars.product(factors), integer(1)));
    let inner = scalars.sum(integer(1), terms);
    let whole = scalars.product([c, inner]);
    assert_eq!(operations(&mut scalars, vec![whole]), (2, 2));
}
