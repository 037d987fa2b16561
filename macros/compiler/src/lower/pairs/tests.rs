use super::{Pairs, distinct};

#[test]
fn pairs_are_distinct() {
    assert_eq!(distinct(&[1, 1, 2, 3, 3]), [(1, 1), (1, 2), (1, 3), (2, 3), (3, 3)]);
    assert_eq!(distinct(&[4, 4]), [(4, 4)]);
}

#[test]
fn the_most_common_pair_is_taken_first() {
    let products = [vec![1, 2, 3], vec![1, 2], vec![2, 3, 4], vec![2, 2, 3, 3]];
    let mut pairs = Pairs::new((10..).zip(products), Default::default());
    assert_eq!(pairs.most_common(), Some((2, 3)));
    pairs.insert(20, vec![2, 3]);
    pairs.replace((2, 3), 20);
    assert_eq!(pairs.get(10).unwrap(), [1, 20]);
    assert_eq!(pairs.get(12).unwrap(), [4, 20]);
    assert_eq!(pairs.get(13).unwrap(), [20, 20]);
    assert_eq!(pairs.most_common(), None);
}
