//! The search for the sizes of symmetric compositions, `runtime/src/scheme/composed.rs`.
//!
//! ```text
//! Ψ_h = Φ_{γ_1 h} ∘ … ∘ Φ_{γ_m h},    γ_i = γ_{m+1−i},    Φ_h = exp(h X1 + h³ X3 + h⁵ X5 + …)
//! ```
//! Both are series in words of the letters X1, X3, …. The weight of a word is the sum of its numbers.
//! Ψ is of order p if it is exp(h X1) in all words of weight ≤ p.
//!
//! `cargo run --release -p clebsch-tests --example compositions` prints the sizes of each order and number of steps.
//! `-- 4` multiplies the number of starts by four.
//!
//! Sources: Hairer, Lubich and Wanner, *Geometric Numerical Integration*, section V.3.2; Sofroniou and Spaletta,
//! *Derivation of symmetric composition constants for symmetric integrators*, Optim. Methods Softw. 20 (2005) 597–613.

use clebsch::__private::{OfOrderEight, OfOrderFour, OfOrderSix, Sizes};
use clebsch::{DoubleDouble, Scalar};
use clebsch_tests::oracle::random::Random;
use nalgebra::{DMatrix, DVector};

/// ‖X1‖, ‖X3‖, ‖X5‖, … of the model: h³/24 is the first error of an oscillator, 2 arcsin(h/2) = h + h³/24 + ….
///
/// The next ones halve. Larger ones count Σ γᵖ⁺¹ for more: the error of free bodies, whose X1, X3, … commute.
/// Smaller ones count commutators for more, the error of particles in potentials.
/// A rank here is a guess: sizes are taken after their steps are counted on random problems that are not in the model.
const NORMS: [f64; 6] = [1.0, 1.0 / 24.0, 1.0 / 48.0, 1.0 / 96.0, 1.0 / 192.0, 1.0 / 384.0];
/// Errors after a unit of time at which the numbers of steps are compared.
const ERRORS: [f64; 4] = [1e-4, 1e-6, 1e-8, 1e-10];

/// A word: the numbers of its letters.
type Word = Vec<usize>;
/// The coefficients of all words up to a weight, by number of the word.
type Series<T> = Vec<T>;
/// The words up to a weight, the empty one first.
struct Words {
    words: Vec<Word>,
    /// Of each word the pairs (beginning, end) that make it.
    splits: Vec<Vec<(usize, usize)>>,
    /// Of each word the number of the same backwards.
    mirror: Vec<usize>,
}

impl Words {
    fn up_to(weight: usize) -> Words {
        let mut words: Vec<Word> = vec![vec![]];
        let mut number = 0;
        while number < words.len() {
            let room = weight - words[number].iter().sum::<usize>();
            for letter in (1..=room).step_by(2) {
                words.push([words[number].as_slice(), &[letter]].concat());
            }
            number += 1;
        }
        let place = |word: &[usize]| words.iter().position(|other| other == word).unwrap_or(0);
        let splits = |word: &Word| (0..=word.len()).map(|at| (place(&word[..at]), place(&word[at..]))).collect();
        let splits = words.iter().map(splits).collect();
        let mirror = words.iter().map(|word| place(&word.iter().rev().copied().collect::<Word>())).collect();
        Words { words, splits, mirror }
    }

    /// (a b)(w) = Σ a(u) b(v) over u v = w
    fn product<T: Scalar>(&self, a: &[T], b: &[T]) -> Series<T> {
        let sum = |splits: &Vec<(usize, usize)>| splits.iter().fold(T::zero(), |sum, &(u, v)| sum + a[u] * b[v]);
        self.splits.iter().map(sum).collect()
    }

    /// exp(Σ γⁿ Xn): a word of k letters has γ^weight/k!
    fn exponential<T: Scalar>(&self, size: T) -> Series<T> {
        let of_letter = |product: T, (k, &n): (usize, &usize)| {
            (0..n).fold(product, |product, _| product * size) / T::from_f64(k as f64 + 1.0)
        };
        self.words.iter().map(|word| word.iter().enumerate().fold(T::one(), of_letter)).collect()
    }

    /// d/dγ of it
    fn slope(&self, size: f64) -> Series<f64> {
        let weight = |word: &Word| word.iter().sum::<usize>() as f64;
        let series = self.exponential(size);
        series.iter().zip(&self.words).map(|(value, word)| value * weight(word) / size).collect()
    }

    /// The same of every word backwards: the inverse order of steps that are their own.
    fn backwards<T: Scalar>(&self, series: &[T]) -> Series<T> {
        self.mirror.iter().map(|&number| series[number]).collect()
    }

    /// exp(Σ γ_1ⁿ Xn) … exp(Σ γ_mⁿ Xn)
    fn composition<T: Scalar>(&self, half: &[T]) -> Series<T> {
        let Some((&middle, before)) = half.split_last() else { return vec![] };
        let steps = before.iter().map(|&size| self.exponential(size));
        let before = steps.reduce(|before, step| self.product(&before, &step)).unwrap_or_default();
        self.product(&self.product(&before, &self.exponential(middle)), &self.backwards(&before))
    }

    /// d/dγ_number of it
    fn composition_slope(&self, half: &[f64], number: usize) -> Series<f64> {
        let steps: Vec<_> = half.iter().map(|&size| self.exponential(size)).collect();
        let turned = |place: usize| if place == number { self.slope(half[place]) } else { steps[place].clone() };
        let last = half.len() - 1;
        let before = (1..last).fold(steps[0].clone(), |before, place| self.product(&before, &steps[place]));
        if number == last {
            return self.product(&self.product(&before, &turned(last)), &self.backwards(&before));
        }
        let slope = (1..last).fold(turned(0), |before, place| self.product(&before, &turned(place)));
        let slope = self.product(&self.product(&slope, &steps[last]), &self.backwards(&before));
        slope.iter().zip(self.backwards(&slope)).map(|(one, other)| one + other).collect()
    }
}

/// Whether a word comes before all of its ends, by letters. Series that are exponentials agree if they agree in these.
fn is_lyndon(word: &[usize]) -> bool {
    !word.is_empty() && (1..word.len()).all(|at| word < &word[at..])
}

/// An order p, and its conditions.
struct Conditions {
    order: usize,
    /// The words of weight < p.
    short: Words,
    /// Lyndon words of odd weight < p: those of even weight follow from the symmetry.
    independent: Vec<usize>,
    /// The words of weight ≤ p + 3.
    long: Words,
}

impl Conditions {
    fn new(order: usize) -> Conditions {
        let short = Words::up_to(order - 1);
        let is_independent = |word: &Word| word.iter().sum::<usize>() % 2 == 1 && is_lyndon(word);
        let independent = (0..short.words.len()).filter(|&number| is_independent(&short.words[number])).collect();
        Conditions { order, short, independent, long: Words::up_to(order + 3) }
    }

    /// The coefficients that vanish: of X1 that of exp(X1) is subtracted.
    fn defects<T: Scalar>(&self, half: &[T]) -> Vec<T> {
        let series = self.short.composition(half);
        let wished = |number| if self.short.words[number] == [1] { T::one() } else { T::zero() };
        self.independent.iter().map(|&number| series[number] - wished(number)).collect()
    }

    fn jacobian(&self, half: &[f64]) -> DMatrix<f64> {
        let columns: Vec<_> = (0..half.len()).map(|number| self.short.composition_slope(half, number)).collect();
        DMatrix::from_fn(self.independent.len(), half.len(), |i, j| columns[j][self.independent[i]])
    }

    /// Newton's method with the shortest steps: δ = −Jᵀ (J Jᵀ)⁻¹ f
    fn solve(&self, start: &[f64], iterations: usize) -> Option<Vec<f64>> {
        let mut half = start.to_vec();
        for _ in 0..iterations {
            let defects = DVector::from_vec(self.defects(&half));
            if defects.amax() < 1e-14 {
                return Some(half);
            }
            let jacobian = self.jacobian(&half);
            let gram = &jacobian * jacobian.transpose();
            let step = jacobian.transpose() * gram.lu().solve(&defects)?;
            let shortened = 1.0_f64.min(0.3 / step.amax());
            half.iter_mut().zip(step.iter()).for_each(|(size, step)| *size -= step * shortened);
        }
        let is_solved = self.defects(&half).iter().all(|defect| defect.abs() < 1e-11);
        is_solved.then_some(half)
    }

    /// The sizes with the first ones rounded to so many digits, and the others from the conditions, to 28 digits.
    fn polished(&self, half: &[f64], unit: i64) -> Option<Vec<DoubleDouble>> {
        let free = half.len() - self.independent.len();
        let rounded = |&size: &f64| DoubleDouble::from_ratio((size * unit as f64).round() as i64, unit);
        let kept = half[free..].iter().map(|&size| DoubleDouble::from_f64(size));
        let mut sizes: Vec<DoubleDouble> = half[..free].iter().map(rounded).chain(kept).collect();
        for _ in 0..30 {
            let jacobian = self.jacobian(&rough(&sizes)).columns_range(free..).into_owned();
            let step = jacobian.lu().solve(&DVector::from_vec(rough(&self.defects(&sizes))))?;
            sizes[free..].iter_mut().zip(&step).for_each(|(size, &step)| *size -= DoubleDouble::from_f64(step));
        }
        rough(&self.defects(&sizes)).iter().all(|defect| defect.abs() < 1e-28).then_some(sizes)
    }

    /// The parts of weight p + 1 and p + 3 of log Ψ, in the norm of the model.
    ///
    /// ```text
    /// Ψ = exp(X1 + A + B),    A = Ψ_{p+1},    B = Ψ_{p+3} − (X1 X1 A + X1 A X1 + A X1 X1)/6
    /// ```
    /// Letters stand for large independent matrices, in which words are orthogonal.
    fn errors(&self, half: &[f64]) -> [f64; 2] {
        let words = &self.long;
        let (series, one) = (words.composition(half), words.exponential(1.0));
        let is_one = |word: &Word| word.iter().all(|&letter| letter == 1);
        let part = |weight| {
            let of = |(number, word): (usize, &Word)| {
                let exact = if is_one(word) { one[number] } else { 0.0 };
                if word.iter().sum::<usize>() == weight { series[number] - exact } else { 0.0 }
            };
            words.words.iter().enumerate().map(of).collect::<Series<f64>>()
        };
        let x: Series<f64> = words.words.iter().map(|word| f64::from(word == &[1])).collect();
        let (first, mut second) = (part(self.order + 1), part(self.order + 3));
        let (left, right) = (words.product(&x, &first), words.product(&first, &x));
        for thrice in [words.product(&x, &left), words.product(&left, &x), words.product(&right, &x)] {
            second.iter_mut().zip(thrice).for_each(|(second, thrice)| *second -= thrice / 6.0);
        }
        [self.norm(&first), self.norm(&second)]
    }

    fn norm(&self, series: &[f64]) -> f64 {
        let norm = |word: &Word| word.iter().map(|letter| NORMS[letter / 2]).product::<f64>();
        series.iter().zip(&self.long.words).map(|(value, word)| (value * norm(word)).powi(2)).sum::<f64>().sqrt()
    }

    /// m/h, the steps of a unit of time, where h^p ‖A‖ + h^{p+2} ‖B‖ is the error; their geometric mean over `ERRORS`.
    fn cost(&self, half: &[f64]) -> f64 {
        let (power, [first, second]) = (1.0 / self.order as f64, self.errors(half));
        let h = |error: f64| {
            (0..60)
                .fold((error / first).powf(power), |h, _| (h * (error / (first + h * h * second)).powf(power)).sqrt())
        };
        let logarithms: f64 = ERRORS.iter().map(|&error| h(error).ln()).sum();
        (2 * half.len() - 1) as f64 / (logarithms / ERRORS.len() as f64).exp()
    }

    /// Walks downhill among solutions by random steps, whose length follows their success.
    fn descend(&self, start: Vec<f64>, worth: f64, random: &mut Random) -> Option<(f64, Vec<f64>)> {
        let (mut best, mut half, mut length) = (self.cost(&start), start, 0.03);
        for tried in 0..400 {
            if length < 1e-6 || (tried == 50 && best > worth) {
                break;
            }
            let moved: Vec<f64> = half.iter().map(|size| size + length * random.number()).collect();
            let moved = self.solve(&moved, 8).map(|moved| (self.cost(&moved), moved));
            match moved.filter(|(cost, _)| *cost < best) {
                Some(moved) => ((best, half), length) = (moved, length * 1.6),
                None => length *= 0.87,
            }
        }
        Some((best, half)).filter(|(_, half)| largest(half) < 1.0)
    }

    /// The best of the solutions for 2K − 1 steps, from so many starts.
    fn search(&self, distinct: usize, starts: usize, width: f64) -> Option<(f64, Vec<f64>)> {
        let (mut random, mut best) = (Random::new(1), None::<(f64, Vec<f64>)>);
        for _ in 0..starts {
            // about 1/m
            let start: Vec<f64> = (0..distinct).map(|_| 0.5 / distinct as f64 + width * random.number()).collect();
            let worth = best.as_ref().map_or(f64::MAX, |(cost, _)| 1.4 * cost);
            let start = self.solve(&start, 40).filter(|start| largest(start) < 1.2);
            let found = start.and_then(|start| self.descend(start, worth, &mut random));
            best = best.into_iter().chain(found).min_by(|(one, _), (other, _)| one.total_cmp(other));
        }
        best
    }

    fn report(&self, name: &str, half: &[f64]) {
        let [first, second] = self.errors(half);
        let (cost, largest, steps) = (self.cost(half), largest(half), 2 * half.len() - 1);
        let order = self.order;
        println!("{order:5} {steps:5}  {name:8} {cost:9.2} {largest:11.3} {first:12.2e} {second:10.2e}");
    }
}

fn largest(half: &[f64]) -> f64 {
    half.iter().fold(0.0, |largest, size| size.abs().max(largest))
}

fn rough(numbers: &[DoubleDouble]) -> Vec<f64> {
    numbers.iter().map(|number| number.parts()[0]).collect()
}

/// Sizes of others and of the runtime: Suzuki (1990), Kahan and Li (1997), Sofroniou and Spaletta (2005).
const KNOWN: [(usize, &str, &[f64]); 7] = [
    (4, "Suzuki", &<OfOrderFour as Sizes<3>>::SIZES),
    (6, "in use", &<OfOrderSix as Sizes<6>>::SIZES),
    (6, "K and L", &KL6),
    (6, "S and S", &SS11),
    (6, "S and S", &SS13),
    (8, "K and L", &<OfOrderEight as Sizes<9>>::SIZES),
    (8, "S and S", &SS21),
];

const KL6: [f64; 5] = [
    0.392_161_444_007_314_1,
    0.332_599_136_789_359_43,
    -0.706_246_172_557_639_3,
    0.082_213_596_293_550_8,
    0.798_543_990_934_83,
];
const SS11: [f64; 6] = [
    0.213_755_839_458_782_54,
    0.183_293_814_074_257_14,
    0.176_928_194_730_989_44,
    -0.443_290_826_811_702_2,
    0.117_285_604_328_659_35,
    0.504_054_748_438_027_4,
];
const SS13: [f64; 7] = [
    0.138_619_308_540_516_96,
    0.133_465_628_510_747_6,
    0.130_705_310_114_492_25,
    0.129_618_937_569_070_36,
    -0.350_003_248_939_209,
    0.118_055_306_530_023_87,
    0.399_077_515_348_714_55,
];
const SS21: [f64; 11] = [
    0.106_477_289_845_500_32,
    0.108_374_086_458_357_26,
    0.353_378_210_526_543_4,
    -0.233_414_140_231_650_82,
    -0.244_452_667_915_288_4,
    0.113_178_484_357_556_33,
    0.118_929_056_250_003_5,
    0.126_039_123_218_259_88,
    0.125_817_187_361_760_42,
    0.116_991_350_192_176_42,
    -0.382_635_960_126_436_65,
];

/// Numbers of steps and of starts, and the width of starts.
type Search = (usize, usize, f64);
/// Those of each order.
const SEARCHES: [(usize, &[Search]); 3] = [
    (4, &[(5, 50, 0.5), (7, 50, 0.4)]),
    (6, &[(9, 200, 0.3), (11, 200, 0.25), (13, 300, 0.2)]),
    (8, &[(17, 1000, 0.25), (19, 2000, 0.25), (21, 3000, 0.14)]),
];

fn main() {
    let times = std::env::args().nth(1).map_or(1, |times| times.parse().expect("a number of starts"));
    println!("order steps  sizes     steps a s  largest |γ|    ‖log_p+1‖ ‖log_p+3‖");
    for (order, searches) in SEARCHES {
        let conditions = Conditions::new(order);
        for (_, name, half) in KNOWN.iter().filter(|(of, _, _)| *of == order) {
            conditions.report(name, half);
        }
        for &(steps, starts, width) in searches {
            let found = conditions.search(steps.div_ceil(2), starts * times, width);
            let Some((_, half)) = found else { continue };
            let polished = [10_000, 1_000_000, 100_000_000].iter().find_map(|&unit| conditions.polished(&half, unit));
            let Some(sizes) = polished else { continue };
            conditions.report("found", &rough(&sizes));
            println!("             {:?}", rough(&sizes));
        }
    }
}
