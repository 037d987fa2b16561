//! The table refuses no pair twice.

use super::combinations;

#[test]
fn no_pair_is_refused_twice() {
    let pairs: Vec<_> = combinations().map(|(_, refused, beside)| (refused, beside)).collect();
    for (position, (one, other)) in pairs.iter().enumerate() {
        let again = pairs[..position].iter().any(|pair| *pair == (*one, *other) || *pair == (*other, *one));
        assert!(!again, "{one:?} and {other:?}");
    }
}
