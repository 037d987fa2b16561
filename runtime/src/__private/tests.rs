use super::{matrix, vector};

#[test]
fn matrices_are_given_by_rows() {
    assert_eq!(matrix([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]])[(0, 2)], 3.0);
    assert_eq!(vector([1.0, 2.0])[1], 2.0);
}
