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
