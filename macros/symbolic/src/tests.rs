//! Tests of what is not seen from outside: numbers, tables, the count of work.

mod rational {
    use crate::{One, Rational, Zero, integer, rational};

    #[test]
    fn numbers_of_any_size_are_exact() {
        let large = integer(i64::MAX);
        let square = &large * &large;
        assert_eq!(square.to_string(), "85070591730234615847396907784232501249");
        assert_eq!(&square / &large, large);
        assert_eq!(&square - &square, Rational::zero());
        assert_eq!((&large + &Rational::one()) - Rational::one(), large);
        assert_eq!(integer(i64::MIN) + Rational::one(), -large.clone());
        assert_eq!(-integer(i64::MIN), &large + &Rational::one());
        assert!(square > large && -&square < -&large);
        assert_eq!(square.recip() * square.clone(), Rational::one());
        assert_eq!(square.power(-2) * square.power(3), square);
        assert_eq!((square / integer(2)).floor() * integer(2) + Rational::one(), &large * &large);
    }

    #[test]
    fn what_fits_is_held_as_it_fits() {
        let large = integer(i64::MAX);
        assert_eq!((&(&large * &large) / &large).parts(), Some((i64::MAX, 1)));
        assert_eq!((&large * &large).parts(), None);
        assert_eq!(rational(6, -4).to_string(), "-3/2");
        assert_eq!((rational(-3, 2).abs(), rational(-3, 2).floor()), (rational(3, 2), integer(-2)));
        assert_eq!(rational(1, 3).to_f64(), 1.0 / 3.0);
    }
}

mod fraction {
    use crate::{One, Rational, integer, rational};

    #[test]
    fn lowest_terms_and_order() {
        assert_eq!(rational(6, -4).parts(), Some((-3, 2)));
        assert_eq!(rational(-1, 2).floor(), integer(-1));
        assert_eq!(rational(-i64::MAX, 4).floor(), integer(i64::MIN / 4));
        assert!(rational(1, 3) < rational(1, 2) && rational(-1, 2) < rational(-1, 3));
        assert_eq!(rational(1, 3) + rational(1, 6), rational(1, 2));
        assert_eq!(rational(2, 3) * rational(-3, 4), rational(-1, 2));
        assert_eq!(rational(-2, 3).recip(), rational(-3, 2));
    }

    #[test]
    fn what_does_not_fit_is_no_fraction() {
        let most = integer(i64::MAX);
        assert_eq!((&most + &Rational::one()).parts(), None);
        assert_eq!((-&most + -Rational::one()).parts(), None);
        assert_eq!((&most * &most).parts(), None);
        let least = rational(1, i64::MAX);
        assert_eq!((&least * &least).parts(), None);
        assert_eq!(&least * &most, Rational::one());
        assert_eq!(integer(i64::MIN).parts(), None);
        assert_eq!(rational(i64::MIN, 2).parts(), Some((i64::MIN / 2, 1)));
        assert_eq!(rational(1, i64::MIN).parts(), None);
    }
}

mod table {
    use crate::{Interner, Table};

    #[test]
    fn values_keep_their_positions() {
        let mut interner = Interner::default();
        let positions: Vec<(usize, bool)> = (0..2000_u64).map(|k| interner.intern(k * 7 % 1000)).collect();
        assert!(positions.iter().enumerate().all(|(k, found)| *found == (k % 1000, k < 1000)));
        assert_eq!((interner.len(), interner.value(2), interner.position(&1000)), (1000, &14, None));
    }

    #[test]
    fn a_key_has_its_last_value() {
        let mut table: Table<String, usize> = Table::default();
        ["b", "a", "b"].iter().zip(0..).for_each(|(k, v)| table.insert(k.to_string(), v));
        *table.entry("c".into()) += 5;
        let entries: Vec<(&str, usize)> = table.iter().map(|(key, value)| (key.as_str(), *value)).collect();
        assert_eq!(entries, [("b", 2), ("a", 1), ("c", 5)]);
        assert!(table.contains(&"a".into()) && !table.contains(&"d".into()) && table[&"c".into()] == 5);
    }
}

mod work {
    use crate::work::{Exhausted, spend, spent, within};

    #[test]
    fn what_stays_within_its_limit_is_done() {
        let before = spent();
        assert_eq!(within(10, || (0..10).for_each(|_| spend(1))), Ok(()));
        assert_eq!(spent() - before, 10);
        assert_eq!(within(10, || spend(11)), Err(Exhausted));
        spend(1000);
    }

    #[test]
    fn a_limit_within_another_cannot_raise_it() {
        let inner = || within(100, || spend(11));
        assert_eq!(within(10, inner), Ok(Err(Exhausted)));
        assert_eq!(within(10, || (within(5, || spend(6)), within(5, || spend(3)))), Ok((Err(Exhausted), Ok(()))));
    }

    #[test]
    fn a_panic_stays_one() {
        let caught = std::panic::catch_unwind(|| within(10, || std::panic::resume_unwind(Box::new("ours"))));
        assert_eq!(caught.unwrap_err().downcast_ref::<&str>(), Some(&"ours"));
        // and the limit is gone
        spend(1000);
    }
}

mod identity {
    use crate::evaluate::{Number, zero};
    use crate::identity::{PRIME, Residue};

    /// Products of the largest residues: their sums must not leave the words that hold them.
    #[test]
    fn sums_of_products_are_those_of_reduced_products() {
        let numbers: Vec<Residue> = (0..20).map(|k| Residue::new(u128::from(PRIME - 1 - k * k))).collect();
        for count in 0..numbers.len() {
            let (row, column) = (&numbers[..count], &numbers[numbers.len() - count..]);
            let one_by_one = row.iter().zip(column).fold(zero(), |sum: Residue, (a, b)| sum.add(a.multiply(*b)));
            assert_eq!(Residue::dot(row, column.iter()), one_by_one);
        }
    }
}
