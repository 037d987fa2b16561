//! Signatures of small matrices.

use super::*;
use clebsch_symbolic::{Graph, Shape};

#[test]
fn signs_of_squares() {
    let graph = Graph::new();
    let matrix = |entries: [i64; 9]| {
        graph.literal(Shape::square(3), entries.into_iter().map(clebsch_symbolic::integer).collect())
    };
    assert_eq!(signature(matrix([2, 1, 0, 1, 2, 0, 0, 0, 5])), Some((3, 0)));
    assert_eq!(signature(matrix([1, 2, 0, 2, 1, 0, 0, 0, -5])), Some((1, 2)));
    assert_eq!(signature(matrix([1, 1, 0, 1, 1, 0, 0, 0, 1])), None);
}

/// x² + y² + a x y is positive definite for a near 1, and not for a = 3.
#[test]
fn signatures_of_typical_parameters_need_not_be_those_of_all() {
    let graph = Graph::new();
    let a = graph.symbol("a", Shape::scalar(), Role::Parameter(0), Property::General);
    let b = graph.symbol("b", Shape::scalar(), Role::Parameter(1), Property::General);
    let (one, zero) = (graph.integer(1), graph.integer(0));
    let half = a / 2;
    let mixed = graph.stack(Shape::square(2), vec![one, half, half, one]);
    assert_eq!((signature(mixed), holds_for_all(mixed, false)), (Some((2, 0)), false));
    let difference = 2 * a - b;
    assert_eq!((signature(difference), holds_for_all(difference, false)), (Some((1, 0)), false));
    let separate = graph.stack(Shape::square(2), vec![a, zero, zero, a * b + one]);
    assert_eq!((signature(separate), holds_for_all(separate, false)), (Some((2, 0)), true));
}
