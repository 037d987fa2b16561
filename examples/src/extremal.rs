//! Extremals of continuous problems whose inputs are bounded. They are smooth pieces, joined where an input reaches a
//! bound or leaves it. Newton's method aims them at a target.

use crate::reference::solve;
use nalgebra::{SMatrix, SVector};

/// Pieces are cut so that no bound is reached and left within one.
const STRIDES: f64 = 200.0;
/// Steps of the search for the time at which a bound is reached.
const SEARCH: usize = 60;
/// Newton corrections at most.
const CORRECTIONS: usize = 60;
/// The largest correction, relative.
const LARGEST: f64 = 0.3;
/// Differences of costates, relative: the error of derivatives is the square of it and rounding over it.
const DIFFERENCE: f64 = 1e-6;

/// Pontryagin's conditions: N numbers, places and costates among them, and U inputs. The duration is 1.
pub trait Pontryagin<const N: usize, const U: usize> {
    /// ẏ with each input at its lower bound (−1), at its upper bound (1) or between them (0).
    fn field(&self, y: &SVector<f64, N>, held: [i8; U]) -> SVector<f64, N>;

    /// Where the costates in y want the inputs.
    fn wanted(&self, y: &SVector<f64, N>) -> [i8; U];

    /// The extremal before it has begun.
    fn begin(&self, y: SVector<f64, N>) -> Motion<N, U> {
        Motion { held: self.wanted(&y), y, switches: 0, error: 0.0 }
    }

    /// The extremal later by a part of the duration.
    fn after(&self, motion: &Motion<N, U>, part: f64) -> Motion<N, U> {
        let strides = (part * STRIDES).ceil().max(1.0);
        (0..strides as u64).fold(*motion, |motion, _| self.stride(motion, part / strides))
    }

    /// The extremal at so many equal parts of a time, the start and the end among them.
    fn path(&self, start: Motion<N, U>, parts: u64, time: f64) -> Vec<Motion<N, U>> {
        let later = |motion: &Motion<N, U>| Some(self.after(motion, time / parts as f64));
        std::iter::successors(Some(start), later).take(parts as usize + 1).collect()
    }

    /// Over `length`, piece by piece.
    #[doc(hidden)]
    fn stride(&self, mut motion: Motion<N, U>, mut length: f64) -> Motion<N, U> {
        loop {
            let whole = self.piece(&motion, length);
            let passed = (0..U).filter(|&input| self.wanted(&whole.y)[input] != whole.held[input]);
            let times = passed.map(|input| (self.reach(&motion, length, input), input));
            let Some((time, input)) = times.min_by(|a, b| a.0.total_cmp(&b.0)) else { return whole };
            motion = self.piece(&motion, time);
            motion.held[input] = self.wanted(&motion.y)[input];
            motion.switches += 1;
            length -= time;
            if length <= 0.0 {
                return motion;
            }
        }
    }

    /// With inputs at a bound, or not, as at its start.
    #[doc(hidden)]
    fn piece(&self, motion: &Motion<N, U>, length: f64) -> Motion<N, U> {
        let solution = solve(|y| self.field(y, motion.held), motion.y, length, 1.0);
        Motion { y: solution.end, error: motion.error + solution.error, ..*motion }
    }

    /// The time at which an input is first not as it is wanted, by bisection.
    #[doc(hidden)]
    fn reach(&self, motion: &Motion<N, U>, length: f64, input: usize) -> f64 {
        let (mut before, mut after) = (0.0, length);
        for _ in 0..SEARCH {
            let middle = (before + after) / 2.0;
            if middle <= before || middle >= after {
                break;
            }
            let is_past = self.wanted(&self.piece(motion, middle).y)[input] != motion.held[input];
            if is_past { after = middle } else { before = middle }
        }
        after
    }
}

/// Where an extremal is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion<const N: usize, const U: usize> {
    /// Places, costates and the other integrated quantities.
    pub y: SVector<f64, N>,
    /// For each input −1 or 1 at its lower or upper bound, 0 between them.
    pub held: [i8; U],
    /// How many times a bound was reached or left.
    pub switches: usize,
    /// The error of integration.
    pub error: f64,
}

/// Costates at the start whose extremal ends at the target.
#[derive(Clone, Copy, Debug)]
pub struct Shot<const K: usize> {
    /// At the start.
    pub costates: SVector<f64, K>,
    /// How far the end may be off: the error of corrections and integration.
    pub error: f64,
}

impl<const K: usize> Shot<K> {
    /// The costates near `guess` for which `miss` vanishes, and the error of integration; `None` where corrections do
    /// not end. Derivatives by differences of `units` times the relative size.
    pub fn aim(
        guess: &SVector<f64, K>,
        units: &SVector<f64, K>,
        miss: impl Fn(&SVector<f64, K>) -> (SVector<f64, K>, f64),
    ) -> Option<Self> {
        let mut scaled = guess.component_div(units);
        let at = |scaled: &SVector<f64, K>| miss(&scaled.component_mul(units));
        let mut last = f64::INFINITY;
        for _ in 0..CORRECTIONS {
            let (missed, integration) = at(&scaled);
            let difference = DIFFERENCE * scaled.norm();
            let moved = |axis: usize, by: f64| {
                let mut moved = scaled;
                moved[axis] += by;
                at(&moved).0
            };
            let column = |axis| (moved(axis, difference) - moved(axis, -difference)) / (2.0 * difference);
            let columns: [SVector<f64, K>; K] = std::array::from_fn(column);
            let jacobian = SMatrix::<f64, K, K>::from_columns(&columns);
            let correction = jacobian.try_inverse()? * missed;
            let size = correction.norm() / scaled.norm();
            if size >= last && last < 1e-9 {
                let error = integration + jacobian.norm() * last * scaled.norm();
                return Some(Self { costates: scaled.component_mul(units), error });
            }
            last = size;
            scaled -= correction * (LARGEST / size).min(1.0);
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Vector2, Vector5};

    /// ẍ = u with |u| ≤ 5 at least ½ ∫ u² dt: x, v, their costates, the effort.
    struct Cart;

    const TOP: f64 = 5.0;

    impl Pontryagin<5, 1> for Cart {
        fn field(&self, y: &Vector5<f64>, [held]: [i8; 1]) -> Vector5<f64> {
            let u = if held == 0 { -y[3] } else { TOP * f64::from(held) };
            Vector5::new(y[1], u, 0.0, -y[2], u * u / 2.0)
        }

        fn wanted(&self, y: &Vector5<f64>) -> [i8; 1] {
            [i8::from(-y[3] > TOP) - i8::from(-y[3] < -TOP)]
        }
    }

    /// From rest to rest a unit further, by hand. The input is ±5 down to the share s of half the time, s² = 3 − 12/5,
    /// and linear between.
    #[test]
    fn a_cart_is_held_back_at_both_ends() {
        let end =
            |costates: &Vector2<f64>| Cart.after(&Cart.begin(Vector5::new(0.0, 0.0, costates.x, costates.y, 0.0)), 1.0);
        let miss = |costates: &Vector2<f64>| {
            let end = end(costates);
            (Vector2::new(end.y[0] - 1.0, end.y[1]), end.error)
        };
        let shot = Shot::aim(&Vector2::new(-12.0, -6.0), &Vector2::repeat(1.0), miss).expect("a way");
        let (end, s) = (end(&shot.costates), 0.6_f64.sqrt());
        let slope = -2.0 * TOP / s;
        assert!((shot.costates.x - slope).abs() < 1e-9 && (shot.costates.y - slope / 2.0).abs() < 1e-9, "{shot:?}");
        assert!((end.y[4] - TOP * TOP / 2.0 * (1.0 - 2.0 * s / 3.0)).abs() < 1e-10 && end.switches == 2, "{end:?}");
    }
}
