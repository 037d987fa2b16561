use super::{OfOrderEight, OfOrderFour, OfOrderSix, Sizes, Stages};
use crate::runner::proptest;
use nalgebra::SMatrix;
use proptest::prelude::*;
use std::vec;
use std::vec::Vec;

fn all<const K: usize>(sizes: &[f64; K]) -> Vec<f64> {
    let composed = Stages::new(1.0, sizes, |h: f64| Ok(h)).expect("constants");
    let steps: Vec<_> = (0..).map_while(|number| composed.at(number)).collect();
    assert_eq!(steps.len(), 2 * K - 1);
    assert!(steps.iter().all(|(constants, size)| **constants == *size));
    steps.into_iter().map(|(_, size)| size).collect()
}

#[test]
fn stages_start_where_the_one_before_ends() {
    let composed = Stages::new(0.3, &OfOrderEight::SIZES, |h: f64| Ok(h)).expect("constants");
    let mut time = 0.0_f64;
    for number in 0..17 {
        let stage = composed.stage(number);
        assert!((stage.start - time).abs() < 1e-15 && *stage.constants == stage.size);
        assert_eq!(composed.at(number).map(|(_, size)| size), Some(stage.size));
        time += stage.size;
    }
    assert!((time - 0.3).abs() < 1e-15);
}

/// All words of the letters X1, X3, X5, … up to a weight, the sum of the numbers of their letters.
fn words(weight: usize) -> Vec<Vec<usize>> {
    let mut words = vec![vec![]];
    let mut number = 0;
    while let Some(word) = words.get(number).cloned() {
        let longer = (1..=weight - word.iter().sum::<usize>()).step_by(2);
        words.extend(longer.map(|letter| [word.as_slice(), &[letter]].concat()));
        number += 1;
    }
    words
}

/// The coefficient of a word in exp(Σ γⁿ Xn): γ^weight/k! for k letters.
fn of_step(size: f64, word: &[usize]) -> f64 {
    (1..=word.len()).fold(size.powi(word.iter().sum::<usize>() as i32), |product, k| product / k as f64)
}

/// The coefficient of a word in the product of the steps.
fn of_steps(sizes: &[f64], word: &[usize]) -> f64 {
    // of the beginnings of the word, in the steps so far
    let mut beginnings = vec![0.0; word.len() + 1];
    beginnings[0] = 1.0;
    for &size in sizes {
        for end in (0..=word.len()).rev() {
            beginnings[end] = (0..=end).map(|at| beginnings[at] * of_step(size, &word[at..end])).sum();
        }
    }
    beginnings[word.len()]
}

/// The largest coefficient of Ψ − exp(X1) in words of weight ≤ p. It is zero for a composition of order p.
fn defect(sizes: &[f64], order: usize) -> f64 {
    let of_word = |word: &Vec<usize>| {
        let exact = if word.iter().all(|&letter| letter == 1) { of_step(1.0, word) } else { 0.0 };
        (of_steps(sizes, word) - exact).abs()
    };
    words(order).iter().map(of_word).fold(0.0, f64::max)
}

/// All conditions of each order. An error of 1e-13 in any of the constants breaks them.
#[test]
fn compositions_meet_all_conditions_of_their_order() {
    fn check<const K: usize>(sizes: [f64; K], order: usize) {
        let steps = all(&sizes);
        assert!(steps.iter().eq(steps.iter().rev()), "the same forwards and backwards");
        assert!(defect(&steps, order) < 1e-15, "order {order}: {:.1e}", defect(&steps, order));
        assert!(defect(&steps, order + 2) > 1e-8, "the order is no higher than {order}");
        for number in 0..K {
            for error in [-1e-13, 1e-13] {
                let mut wrong = sizes;
                wrong[number] += error;
                assert!(defect(&all(&wrong), order) > 5e-14, "order {order}, γ_{number}");
            }
        }
    }
    check(OfOrderFour::SIZES, 4);
    check(OfOrderSix::SIZES, 6);
    check(OfOrderEight::SIZES, 8);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 32, failure_persistence: None, ..ProptestConfig::default() })]

    /// By the chain rule: f = a s + b τ of the size s and the time τ of a stage. At the start of the step these are h
    /// and t.
    #[test]
    fn slopes_are_those_along_the_whole_step(a in -1.0_f64..1.0, b in -1.0_f64..1.0, h in 0.1_f64..1.0, number in 0_usize..11) {
        let at = |h: f64, t: f64| {
            let composed = Stages::new(h, &OfOrderSix::SIZES, |h: f64| Ok(h)).expect("constants");
            let stage = composed.stage(number);
            a * *stage.constants + b * (t + stage.start)
        };
        let composed = Stages::new(h, &OfOrderSix::SIZES, |h: f64| Ok(h)).expect("constants");
        // columns: h, something else, t
        let found = composed.stage(number).slopes(SMatrix::<f64, 1, 3>::new(a, 7.0, b), Some(0), Some(2));
        // f is linear in h, so that any difference is a derivative
        prop_assert!((found[0] - (at(h + 1.0, 0.0) - at(h, 0.0))).abs() < 1e-14);
        prop_assert_eq!((found[1], found[2]), (7.0, b));
    }
}
