use super::{OfOrderEight, OfOrderFour, OfOrderSix, Sizes, Stages};
use crate::runner::proptest;
use nalgebra::SMatrix;
use proptest::prelude::*;
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

fn sum_of_powers(sizes: &[f64], power: i32) -> f64 {
    sizes.iter().map(|size| size.powi(power)).sum()
}

/// Σ γ = 1 and Σ γ³ = 0 for order 4, also Σ γ⁵ = 0 for 6 and Σ γ⁷ = 0 for 8. The conditions that mix them show in the
/// measured orders.
#[test]
fn the_odd_powers_of_the_sizes_cancel() {
    let [four, six, eight] = [all(&OfOrderFour::SIZES), all(&OfOrderSix::SIZES), all(&OfOrderEight::SIZES)];
    for (sizes, highest) in [(four, 3), (six, 5), (eight, 7)] {
        assert!((sum_of_powers(&sizes, 1) - 1.0).abs() < 1e-15);
        assert!(sizes.iter().eq(sizes.iter().rev()), "the same forwards and backwards");
        for power in (3..=highest).step_by(2) {
            assert!(sum_of_powers(&sizes, power).abs() < 1e-15, "{power}: {}", sum_of_powers(&sizes, power));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 32, failure_persistence: None, ..ProptestConfig::default() })]

    /// By the chain rule: f = a s + b τ of the size s and the time τ of a stage. At the start of the step these are h
    /// and t.
    #[test]
    fn slopes_are_those_along_the_whole_step(a in -1.0_f64..1.0, b in -1.0_f64..1.0, h in 0.1_f64..1.0, number in 0_usize..9) {
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
