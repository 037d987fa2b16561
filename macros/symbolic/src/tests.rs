//! Tests of items that are private to the crate: numbers, tables, the count of work.

mod rational {
    use crate::{Rational, integer, rational};

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

mod natural {
    use crate::natural::Natural;

    /// Numbers of up to seven digits; some digits are 0 or the greatest, where carries go far.
    fn numbers() -> Vec<Natural> {
        let mut state = 1_u64;
        let mut digit = || {
            state = state.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(0x1405_7b7e_f767_814f);
            [0, u64::MAX, 1 << 63, state, state >> 40][(state >> 33) as usize % 5]
        };
        let number = |length: usize, digit: &mut dyn FnMut() -> u64| {
            (0..length).fold(Natural::from(0), |sum, _| sum.shifted(64).plus(&u128::from(digit()).into()))
        };
        (0..40).map(|k| number(k % 8, &mut digit)).collect()
    }

    #[test]
    fn operations_on_any_size_are_those_of_numbers() {
        let numbers = numbers();
        for (a, b) in numbers.iter().flat_map(|a| numbers.iter().map(move |b| (a, b))) {
            let (sum, product) = (a.plus(b), a.times(b));
            assert_eq!((sum.minus(b), sum.clone()), (a.clone(), b.plus(a)));
            assert_eq!(
                (product.clone(), sum.times(&sum)),
                (b.times(a), a.power(2).plus(&product.shifted(1)).plus(&b.power(2)))
            );
            if b.bits() > 0 {
                let (quotient, remainder) = a.divided(b);
                assert!(remainder < *b && quotient.times(b).plus(&remainder) == *a, "{a}/{b}");
                assert_eq!(product.plus(&remainder).divided(b), (a.clone(), remainder));
                let common = a.common_divisor(b);
                let [a, b] = [a, b].map(|part| part.divided(&common));
                assert!([a.1, b.1].iter().all(|remainder| remainder.bits() == 0));
                assert_eq!(a.0.common_divisor(&b.0), Natural::from(1));
            }
        }
    }

    #[test]
    fn quotients_are_the_nearest_floating_point_numbers() {
        let power = |exponent: u32| Natural::from(10).power(exponent);
        let quotients = [
            (1, 0, 0),
            (17, 0, 1),
            (123_456_789_123_456_789, 0, 5),
            (1, 300, 0),
            (1, 0, 300),
            (49, 0, 325),
            (1, 0, 330),
        ];
        for (k, (factor, above, below)) in quotients.into_iter().enumerate() {
            let expected: f64 = format!("{factor}e{}", i64::from(above) - i64::from(below)).parse().unwrap();
            assert_eq!(Natural::from(factor).times(&power(above)).ratio(&power(below)), expected, "{k}");
        }
        let least = f64::from_bits(1);
        // halves go to even, and numbers above a half go up
        let halves = [(1, 1075, 0.0), (3, 1075, 2.0 * least), (5, 1075, 2.0 * least), (11, 1076, 3.0 * least)];
        for (factor, exponent, expected) in halves {
            assert_eq!(Natural::from(factor).ratio(&Natural::from(1).shifted(exponent)), expected);
        }
        let odd = (1_u128 << 53) + 1;
        assert_eq!(Natural::from(odd).ratio(&Natural::from(1)), (1_u64 << 53) as f64);
        assert_eq!(power(400).ratio(&Natural::from(3)), f64::INFINITY);
    }

    #[test]
    fn texts_have_all_digits() {
        let number = Natural::from(10).power(57).plus(&7.into());
        assert_eq!(number.to_string(), format!("1{}7", "0".repeat(56)));
        assert_eq!(Natural::from(0).to_string(), "0");
    }
}

mod fraction {
    use crate::{Rational, integer, rational};

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
    use crate::work::{Exhausted, apart, spend, spent, within};

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
    fn work_apart_has_its_own_limit() {
        let before = spent();
        assert_eq!(within(10, || apart(100, || spend(100))), Ok(Ok(())));
        assert_eq!(within(10, || apart(100, || spend(101))), Ok(Err(Exhausted)));
        assert_eq!(apart(5, || (within(10, || spend(6)), apart(10, || spend(6)))), Ok((Err(Exhausted), Ok(()))));
        assert_eq!(spent(), before);
    }

    #[test]
    fn a_panic_stays_one() {
        let caught = std::panic::catch_unwind(|| within(10, || std::panic::resume_unwind(Box::new("ours"))));
        assert_eq!(caught.unwrap_err().downcast_ref::<&str>(), Some(&"ours"));
        // and the limit is gone
        spend(1000);
    }
}

mod print {
    use crate::{Expr, Function, Graph, Notation, Property, Role, Shape};

    fn symbol<'g>(graph: &'g Graph, name: &str) -> Expr<'g> {
        graph.symbol(name, Shape::scalar(), Role::Parameter(0), Property::General)
    }

    /// The value of a text with one-letter names, by the rules that a reader has: powers, then products and bars, then sums.
    struct Reader<'t> {
        text: std::iter::Peekable<std::str::Chars<'t>>,
        values: [f64; 4],
    }

    impl Reader<'_> {
        fn next_if(&mut self, sign: char) -> bool {
            while self.text.next_if_eq(&' ').is_some() {}
            self.text.next_if_eq(&sign).is_some()
        }

        fn sum(&mut self) -> f64 {
            let mut sum = if self.next_if('−') { -self.product() } else { self.product() };
            loop {
                match (self.next_if('+'), self.next_if('−')) {
                    (true, _) => sum += self.product(),
                    (_, true) => sum -= self.product(),
                    _ => return sum,
                }
            }
        }

        fn product(&mut self) -> f64 {
            let mut product = self.power();
            loop {
                match (self.next_if('·'), self.next_if('/')) {
                    (true, _) => product *= self.power(),
                    (_, true) => product /= self.power(),
                    _ => return product,
                }
            }
        }

        fn power(&mut self) -> f64 {
            while self.text.next_if_eq(&' ').is_some() {}
            let base = match self.text.next() {
                Some('(') => {
                    let sum = self.sum();
                    assert!(self.next_if(')'));
                    sum
                }
                Some('√') => return self.power().sqrt(),
                Some(letter @ 'a'..='d') => self.values[letter as usize - 'a' as usize],
                Some(digit) => {
                    let mut number = f64::from(digit.to_digit(10).expect("a number"));
                    while let Some(digit) = self.text.peek().and_then(|digit| digit.to_digit(10)) {
                        number = 10.0 * number + f64::from(digit);
                        self.text.next();
                    }
                    number
                }
                None => panic!("a factor"),
            };
            let mut exponent = 0;
            while let Some(digit) = self.text.peek().and_then(|sign| "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().position(|c| c == *sign))
            {
                exponent = 10 * exponent + digit as i32;
                self.text.next();
            }
            if self.next_if('^') {
                return base.powf(self.power());
            }
            if exponent == 0 { base } else { base.powi(exponent) }
        }
    }

    /// Common factors move in front of sums, and the value stays.
    #[test]
    fn a_text_has_the_value_of_its_expression() {
        let mut state = 1_u64;
        let mut random = |count: u64| {
            state = state.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(0x1405_7b7e_f767_814f);
            (state >> 33) % count
        };
        for case in 0..2000 {
            let graph = Graph::new();
            let values = [0.7, 1.3, 2.9, 0.4];
            let mut all: Vec<(Expr<'_>, f64)> =
                ["a", "b", "c", "d"].iter().zip(values).map(|(name, value)| (symbol(&graph, name), value)).collect();
            for _ in 0..2 + random(9) {
                let [(x, a), (y, b)] = [(); 2].map(|()| all[random(all.len() as u64) as usize]);
                all.push(match random(7) {
                    0 | 1 => (x + y, a + b),
                    2 => (x - y, a - b),
                    3 => (x * y, a * b),
                    4 if b.abs() > 1e-3 => (x / y, a / b),
                    5 if a > 0.0 => (x.sqrt(), a.sqrt()),
                    _ => (3 * x / 4 - y / 2, 0.75 * a - b / 2.0),
                });
            }
            let (formula, expected) = all[all.len() - 1];
            let text = formula.to_string();
            let mut reader = Reader { text: text.chars().peekable(), values };
            let found = reader.sum();
            assert_eq!(reader.text.next(), None, "{text}");
            let scale = 1.0 + all.iter().fold(0.0_f64, |largest, (_, value)| largest.max(value.abs()));
            assert!((found - expected).abs() < 1e-9 * scale, "case {case}: {text} is {found}, not {expected}");
        }
    }

    #[test]
    fn a_text_has_at_most_so_many_characters() {
        let graph = Graph::new();
        let sum = symbol(&graph, "a") + symbol(&graph, "b");
        let square = sum.sqrt() * sum.sqrt().function(Function::Sin);
        let text = square.to_string();
        let length = text.chars().count();
        assert_eq!(square.written_within(Notation::Unicode, length), Some(text));
        assert_eq!(square.written_within(Notation::Unicode, length - 1), None);
    }

    /// Each part has its name in the parts behind it and in the formulas, and short ones have none.
    #[test]
    fn parts_that_occur_again_have_names() {
        let graph = Graph::new();
        let (a, b) = (symbol(&graph, "amplitude"), symbol(&graph, "b"));
        let sine = (a + b).function(Function::Sin);
        let root = (sine * sine.function(Function::Cos) + b.function(Function::Sin)).sqrt();
        let formulas = [root * root.function(Function::Exp), b.function(Function::Sin) * sine];
        let (texts, parts) = graph.written_in_parts(&formulas, Notation::Unicode, 1000).expect("a short text");
        assert_eq!(parts, ["P₁ = sin(amplitude + b)", "P₂ = P₁·cos(P₁) + sin(b)"]);
        assert_eq!(texts, ["√(P₂)·exp(√(P₂))", "P₁·sin(b)"]);
        assert_eq!(graph.written_in_parts(&formulas, Notation::Unicode, 40), None);
    }

    /// A text that doubles with each level has two parts for each.
    #[test]
    fn a_text_that_doubles_is_as_long_as_its_parts() {
        let graph = Graph::new();
        let mut nested = symbol(&graph, "q");
        for _ in 0..60 {
            nested = nested.function(Function::Sin) * (nested + symbol(&graph, "b")).function(Function::Cos);
        }
        assert_eq!(nested.written_within(Notation::Unicode, 10_000), None);
        let (texts, parts) = graph.written_in_parts(&[nested], Notation::Latex, 10_000).expect("a short text");
        assert!(texts[0].contains("P_{118}") && parts.len() == 118, "{texts:?} {parts:?}");
    }

    #[test]
    fn a_long_expression_is_not_expanded() {
        let graph = Graph::new();
        let (a, b) = (symbol(&graph, "a"), symbol(&graph, "b"));
        let product = (a + b) * (a - b);
        assert_eq!(product.expand_within(1000), product.expand());
        assert_eq!((product + a).expand_within(0), product + a);
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
            assert_eq!(Residue::dot(row, column, 1), one_by_one);
        }
    }
}
