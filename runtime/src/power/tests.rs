use super::wrapped;

#[test]
fn indices_go_round_a_ring() {
    let expected: [usize; 13] = [4, 0, 1, 2, 3, 4, 0, 1, 2, 3, 4, 0, 1];
    for (index, expected) in (-6..7).zip(expected) {
        assert_eq!(wrapped::<5>(index), expected, "{index}");
    }
    assert_eq!(wrapped::<1>(1), 0);
    assert_eq!(wrapped::<0>(3), 0, "there is no site, and nothing is read");
}
