//! Three bars in the plane and four pins that close a loop with the ground: nine coordinates, eight equations, one freedom.

use crate::linkages::FourBar;
use crate::watch::Law;
use clebsch::State;
use nalgebra::{Matrix3, SMatrix, SVector, Vector2, Vector3};

/// The angles of the bars against the horizontal, and their rates.
pub type Angles = SVector<f64, 6>;

fn along(angle: f64) -> Vector2<f64> {
    Vector2::new(angle.cos(), angle.sin())
}

fn across(angle: f64) -> Vector2<f64> {
    Vector2::new(-angle.sin(), angle.cos())
}

impl FourBar {
    /// Uniform bars of so many metres, 1 kg for a metre.
    pub fn new(lengths: [f64; 3], ground: f64, gravity: f64) -> Self {
        Self {
            mass: lengths,
            inertia: lengths.map(|length| length.powi(3) / 12.0),
            half: lengths.map(|length| Vector2::x() * (length / 2.0)),
            ground: Vector2::x() * ground,
            gravity,
        }
    }

    fn length(&self, i: usize) -> f64 {
        2.0 * self.half[i].x
    }

    /// The angles and rates of an open loop, from those of the crank; `None` where the loop cannot be closed.
    pub fn closed(&self, crank: f64, rate: f64) -> Option<Angles> {
        // the coupler and the rocker meet above the line between their other ends
        let from_end = self.ground - along(crank) * self.length(0);
        let (coupler, rocker, distance) = (self.length(1), self.length(2), from_end.norm());
        let cosine = (coupler * coupler + distance * distance - rocker * rocker) / (2.0 * coupler * distance);
        if cosine.abs() >= 1.0 {
            return None;
        }
        let angle = from_end.y.atan2(from_end.x) + cosine.acos();
        let tip = along(angle) * coupler - from_end;
        let angles = [crank, angle, tip.y.atan2(tip.x)];
        let [first, second, third] = [0, 1, 2].map(|i| across(angles[i]) * self.length(i));
        // first ω₁ + second ω₂ = third ω₃
        let determinant = second.perp(&third);
        let rates = [rate, -rate * first.perp(&third) / determinant, rate * second.perp(&first) / determinant];
        Some(Angles::from_iterator(angles.into_iter().chain(rates)))
    }

    /// Places and velocities of the bars.
    pub fn start(&self, y: &Angles) -> ([Matrix3<f64>; 3], SVector<f64, 9>) {
        let reach = |i: usize| along(y[i]) * (self.length(i) / 2.0);
        let speed = |i: usize| across(y[i]) * (self.length(i) / 2.0 * y[3 + i]);
        let centres = [reach(0), reach(0) * 2.0 + reach(1), self.ground + reach(2)];
        let velocities = [speed(0), speed(0) * 2.0 + speed(1), speed(2)];
        let placed = |i: usize| {
            let (sin, cos) = y[i].sin_cos();
            Matrix3::new(cos, -sin, centres[i].x, sin, cos, centres[i].y, 0.0, 0.0, 1.0)
        };
        let in_bar =
            |i: usize| Vector3::new(y[3 + i], along(y[i]).dot(&velocities[i]), across(y[i]).dot(&velocities[i]));
        let parts = [in_bar(0), in_bar(1), in_bar(2)];
        ([placed(0), placed(1), placed(2)], SVector::from_iterator(parts.iter().flat_map(|part| part.iter().copied())))
    }

    /// The ends of the bars, from the pin of the crank on.
    pub fn corners(&self, y: &Angles) -> [Vector2<f64>; 4] {
        let (first, last) = (along(y[0]) * self.length(0), self.ground + along(y[2]) * self.length(2));
        [Vector2::zeros(), first, last, self.ground]
    }

    /// Angles and rates of a state, by hand.
    pub fn angles(&self, state: &State<Self>) -> Angles {
        let (q, n) = (state.configuration(), state.momentum());
        let angle = |i: usize| q[i][(1, 0)].atan2(q[i][(0, 0)]);
        let rate = |i: usize| n[3 * i] / self.inertia[i];
        Angles::from([angle(0), angle(1), angle(2), rate(0), rate(1), rate(2)])
    }

    /// By how much the pins are open (metres), and how fast they open (m/s).
    pub fn gaps(&self, state: &State<Self>) -> (f64, f64) {
        let (q, n) = (state.configuration(), state.momentum());
        let end = |i: usize, side: f64| {
            let (turn, lever) = (q[i].fixed_view::<2, 2>(0, 0), self.half[i] * side);
            let velocity =
                n.fixed_rows::<2>(3 * i + 1) / self.mass[i] + Vector2::y() * (lever.x * n[3 * i] / self.inertia[i]);
            (q[i].fixed_view::<2, 1>(0, 2) + turn * lever, turn * velocity)
        };
        let pin = |at: Vector2<f64>| (at, Vector2::zeros());
        let pairs = [
            (end(0, -1.0), pin(Vector2::zeros())),
            (end(0, 1.0), end(1, -1.0)),
            (end(1, 1.0), end(2, 1.0)),
            (end(2, -1.0), pin(self.ground)),
        ];
        let gaps = pairs.map(|((at, moving), (other, turning))| ((at - other).norm(), (moving - turning).norm()));
        gaps.into_iter().fold((0.0, 0.0), |(gap, opening), (at, moving)| (at.max(gap), moving.max(opening)))
    }
}

impl Law<6> for FourBar {
    /// α′ and α″: the bars by their angles, and the loop by two multipliers.
    fn law(&self, y: &Angles) -> Angles {
        let [a, b, c] = [0, 1, 2].map(|i| self.length(i));
        let [m, n, o] = self.mass;
        let (g, crossing) = (self.gravity, (y[1] - y[0]).cos());
        let mut matrix = SMatrix::<f64, 5, 5>::zeros();
        matrix[(0, 0)] = self.inertia[0] + m * a * a / 4.0 + n * a * a;
        matrix[(1, 1)] = self.inertia[1] + n * b * b / 4.0;
        matrix[(2, 2)] = self.inertia[2] + o * c * c / 4.0;
        matrix[(0, 1)] = n * a * b / 2.0 * crossing;
        matrix[(1, 0)] = matrix[(0, 1)];
        let turned = n * a * b / 2.0 * (y[1] - y[0]).sin();
        let mut right = SVector::<f64, 5>::zeros();
        right[0] = turned * y[4] * y[4] - g * a * (m / 2.0 + n) * y[0].cos();
        right[1] = -turned * y[3] * y[3] - g * b * n / 2.0 * y[1].cos();
        right[2] = -g * c * o / 2.0 * y[2].cos();
        // a u₁ + b u₂ − c u₃ stays
        for (i, length) in [a, b, -c].into_iter().enumerate() {
            let (row, pull) = (across(y[i]) * length, along(y[i]) * (length * y[3 + i] * y[3 + i]));
            for k in 0..2 {
                matrix[(3 + k, i)] = row[k];
                matrix[(i, 3 + k)] = row[k];
                right[3 + k] += pull[k];
            }
        }
        let change = matrix.lu().solve(&right).unwrap_or(SVector::repeat(f64::NAN));
        Angles::from([y[3], y[4], y[5], change[0], change[1], change[2]])
    }

    /// Of the angles, which may differ by full turns.
    fn distance(&self, one: &Angles, other: &Angles) -> f64 {
        (0..3).map(|i| 2.0 * ((one[i] - other[i]) / 2.0).sin().abs()).fold(0.0, f64::max)
    }
}
