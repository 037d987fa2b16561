//! How many kicks splittings take for an error, on random potentials in the plane.

use super::{GradientSix, Kick, Kicks, PlainFour, PlainSix};
use core::f64::consts::TAU;
use nalgebra::Vector2;
use std::vec::Vec;

/// All kicks, from the drifts, weights of V and weights of the force gradient up to the middle of a step.
fn mirrored(first: &[(f64, f64, f64)], count: usize) -> Vec<Kick> {
    let middle = 1.0 - 2.0 * first.iter().map(|kick| kick.0).sum::<f64>();
    let drift = |index: usize| if 2 * index == count { middle } else { first[index.min(count - index)].0 };
    let kick = |index: usize| first[index.min(count - 1 - index)];
    (0..count).map(|index| Kick { drift: drift(index), weight: kick(index).1, gradient: kick(index).2 }).collect()
}

/// For any two flows: order 4, six kicks, and order 6, ten. They are S6 and S10 of S. Blanes and P. C. Moan, J. Comput.
/// Appl. Math. 142 (2002).
fn blanes_and_moan() -> [Vec<Kick>; 2] {
    let four = [
        (0.079_203_696_431_195_7, 0.209_515_106_613_362, 0.0),
        (0.353_172_906_049_774, -0.143_851_773_179_818, 0.0),
        (-0.042_065_080_357_719_5, 0.434_336_666_566_456, 0.0),
    ];
    let six = [
        (0.050_262_764_400_392_2, 0.148_816_447_901_042, 0.0),
        (0.413_514_300_428_344, -0.132_385_865_767_784, 0.0),
        (0.045_079_889_794_397_7, 0.067_307_604_692_185, 0.0),
        (-0.188_054_853_819_569, 0.432_666_402_578_175, 0.0),
        (0.541_960_678_450_78, -0.016_404_589_403_618, 0.0),
    ];
    [mirrored(&four, 6), mirrored(&six, 10)]
}

/// Five kicks of order (8, 6, 6): no number is free.
fn five() -> Vec<Kick> {
    let five = [
        (0.132_793_133_546_899_34, 0.293_280_560_323_112_45, 0.002_167_707_618_081_581),
        (-0.290_604_120_144_448_3, 0.004_900_351_437_300_99, -0.000_033_260_037_789_472_71),
        (0.657_810_986_597_549, 0.403_638_176_479_173_16, 0.001_637_619_689_152_927),
    ];
    mirrored(&five, 5)
}

/// V = Σ c cos(k·q + φ).
struct Potential([(Vector2<f64>, f64, f64); 4]);

impl Potential {
    /// Amplitudes up to 1, where T is ½ at the start. Multiples of a root, modulo one, are as good as random.
    fn random(seed: u32) -> Self {
        let roots =
            [2.0_f64, 3.0, 5.0, 7.0, 11.0, 13.0, 17.0, 19.0, 23.0, 29.0, 31.0, 37.0, 41.0, 43.0, 47.0, 53.0, 59.0];
        let draw = |index: usize| (f64::from(seed + 1) * roots[index].sqrt()) % 1.0;
        let scale = 0.02 * 100.0_f64.powf(draw(16));
        let wave = |i: usize| {
            let direction = Vector2::new(draw(4 * i), draw(4 * i + 1)) * 4.0 - Vector2::repeat(2.0);
            (direction, scale * (draw(4 * i + 2) - 0.5), TAU * draw(4 * i + 3))
        };
        Self([0, 1, 2, 3].map(wave))
    }

    fn gradient(&self, q: &Vector2<f64>) -> Vector2<f64> {
        self.0.iter().map(|(k, c, phase)| k * (-c * (k.dot(q) + phase).sin())).sum()
    }

    /// The second derivative along a vector.
    fn curvature(&self, q: &Vector2<f64>, v: &Vector2<f64>) -> Vector2<f64> {
        self.0.iter().map(|(k, c, phase)| k * (-c * (k.dot(q) + phase).cos() * k.dot(v))).sum()
    }

    /// After a time of 20, in about so many kicks.
    fn moved(&self, kicks: &[Kick], number: usize) -> (Vector2<f64>, Vector2<f64>) {
        let steps = number / kicks.len();
        let h = 20.0 / steps as f64;
        let (mut q, mut p) = (Vector2::new(0.3, -0.2), Vector2::new(0.6, 0.8));
        for (number, kick) in (0..steps).flat_map(|_| kicks.iter().enumerate()) {
            q += p * (kick.drift * h);
            let force = self.gradient(&q);
            p += self.curvature(&q, &force) * (2.0 * kick.gradient * h.powi(3)) - force * (kick.weight * h);
            if number + 1 == kicks.len() {
                q += p * (kicks[0].drift * h);
            }
        }
        (q, p)
    }
}

/// How many times as many kicks the old splitting takes for the error of the new one: of 100 potentials, in order.
fn savings(new: &[Kick], old: &[Kick], order: f64, number: usize) -> Vec<f64> {
    let mut savings: Vec<f64> = (0..100)
        .map(|seed| {
            let potential = Potential::random(seed);
            let exact = potential.moved(&GradientSix::KICKS, 8 * number);
            let error = |kicks: &[Kick]| {
                let (q, p) = potential.moved(kicks, number);
                (q - exact.0).norm().hypot((p - exact.1).norm())
            };
            (error(old) / error(new)).powf(1.0 / order)
        })
        .collect();
    savings.sort_by(f64::total_cmp);
    savings
}

#[test]
fn quadratic_energies_take_fewer_kicks_than_any_two_flows() {
    let [four, six] = blanes_and_moan();
    for (name, new, old, order, number) in [
        ("order 4", &PlainFour::KICKS[..], &four, 4.0, 420),
        ("order 6", &PlainSix::KICKS, &six, 6.0, 420),
        ("order 6 with gradients", &GradientSix::KICKS, &five(), 6.0, 280),
    ] {
        let savings = savings(new, old, order, number);
        let (low, median) = (savings[savings.len() / 4], savings[savings.len() / 2]);
        std::println!("{name}: {median:.2} times the kicks, {low:.2} or more for three in four potentials");
        assert!(median > 1.25 && low > 1.1, "{name}: {low} {median}");
    }
}
