//! The closed form: geodesics of the sub-Riemannian plane of motions in Jacobi's elliptic functions.
//!
//! The turning rate is ω, the speed v and the price ½∫(a²ω² + v²)dt. Pontryagin's principle gives a²ω = λ_θ and v = λ_x
//! for a costate λ = (λ_θ, λ_x, λ_y) in the frame of the unicycle. Its part (λ_x, λ_y) is a vector of length P that is
//! constant in space. The angle φ that it makes with the heading obeys φ̈ = (P/a)² sin φ cos φ. So 2φ − π swings like a
//! pendulum with the frequency Ω = P/a.
//!
//! Source: Moiseev and Sachkov, *Maxwell strata in sub-Riemannian problem on the group of motions of a plane*, ESAIM
//! COCV 16 (2010), 380–399. There a = 1 and the speed is 1. The formulas are integrated anew for the coordinates of this
//! scene.

use crate::place::at;
use clebsch_examples::jacobi::Jacobi;
use nalgebra::{Matrix3, Vector2, Vector3};
use std::f64::consts::FRAC_PI_2;

/// A geodesic from the origin.
#[derive(Clone, Copy, Debug)]
pub struct Geodesic {
    /// a, m.
    length: f64,
    /// λ at the start.
    pub costate: Vector3<f64>,
    motion: Motion,
}

/// Where a unicycle is, with its costate λ and its inputs (ω, v).
#[derive(Clone, Copy, Debug)]
pub struct Moment {
    /// q
    pub place: Matrix3<f64>,
    /// λ_θ, λ_x, λ_y: the decrease of the price by more of a small motion.
    pub costate: Vector3<f64>,
    /// ω in rad/s, v in m/s.
    pub input: Vector2<f64>,
}

#[derive(Clone, Copy, Debug)]
enum Motion {
    /// P = 0: turning in place, or rest.
    Still,
    /// P² > 2E: the pendulum swings, about the side −`side` of φ.
    Swings { functions: Jacobi, modulus: f64, frequency: f64, start: f64, side: f64 },
    /// P² ≤ 2E: the pendulum turns over, from that side on.
    TurnsOver { functions: Jacobi, modulus: f64, frequency: f64, start: f64, side: f64, sense: f64 },
}

impl Geodesic {
    /// With the price a² of turning, m², and this costate at the start.
    pub fn new(turn_price: f64, costate: &Vector3<f64>) -> Option<Self> {
        let (length, [turn, ahead, left]) = (turn_price.sqrt(), <[f64; 3]>::from(*costate));
        let (p, speed) = (ahead.hypot(left), (turn / length).hypot(ahead));
        let frequency = p / length;
        // P² − 2E, without the common part of both
        let excess = left * left - (turn / length).powi(2);
        let side = 1_f64.copysign(left);
        let motion = if p == 0.0 {
            Motion::Still
        } else if excess > 0.0 {
            let functions = Jacobi::new((speed / p).powi(2).min(1.0), excess / (p * p))?;
            let start = functions.argument((-side * ahead).atan2(-turn / length));
            Motion::Swings { functions, modulus: speed / p, frequency, start, side }
        } else {
            let functions = Jacobi::new((p / speed).powi(2), -excess / (speed * speed))?;
            let sense = -turn.signum();
            let start = functions.argument(sense * (left.atan2(ahead) - side * FRAC_PI_2));
            Motion::TurnsOver { functions, modulus: p / speed, frequency: speed / length, start, side, sense }
        };
        Some(Self { length, costate: *costate, motion })
    }

    /// 2E = a²ω² + v², the square of the speed in the metric, which is constant: the price of the time T is ET.
    pub fn speed_squared(&self) -> f64 {
        (self.costate.x / self.length).powi(2) + self.costate.y.powi(2)
    }

    /// After the time `t`.
    pub fn at(&self, t: f64) -> Moment {
        let (a, p) = (self.length, self.costate.y.hypot(self.costate.z));
        if let Motion::Still = self.motion {
            let rate = self.costate.x / (a * a);
            return Moment { place: at(0.0, 0.0, rate * t), costate: self.costate, input: Vector2::new(rate, 0.0) };
        }
        let (from, to) = (self.swing(0.0), self.swing(t));
        // along and to the left of the vector that stays in space
        let (ahead, left) = (to.along - from.along, a * a / p * (to.rate - from.rate));
        let (sin, cos) = from.angle.sin_cos();
        let place = at(ahead * cos - left * sin, ahead * sin + left * cos, from.angle - to.angle);
        let costate = Vector3::new(a * a * to.rate, p * to.cos, p * to.sin);
        Moment { place, costate, input: Vector2::new(to.rate, costate.y) }
    }

    fn swing(&self, t: f64) -> Swing {
        match self.motion {
            Motion::Still => Swing::default(),
            Motion::Swings { functions, modulus, frequency, start, side } => {
                let u = start + frequency * t;
                let (phi, epsilon) = functions.amplitude(u);
                let (sin, delta) = (modulus * phi.sin(), functions.delta(phi));
                Swing {
                    angle: side * FRAC_PI_2 + sin.atan2(delta),
                    cos: -side * sin,
                    sin: side * delta,
                    rate: -modulus * frequency * phi.cos(),
                    along: self.length * (frequency * t - epsilon),
                }
            }
            Motion::TurnsOver { functions, modulus, frequency, start, side, sense } => {
                let u = start + frequency * t;
                let (phi, epsilon) = functions.amplitude(u);
                Swing {
                    angle: side * FRAC_PI_2 + sense * phi,
                    cos: -side * sense * phi.sin(),
                    sin: side * phi.cos(),
                    rate: -sense * frequency * functions.delta(phi),
                    along: self.length / modulus * (frequency * t - epsilon),
                }
            }
        }
    }
}

/// The pendulum.
#[derive(Clone, Copy, Debug, Default)]
struct Swing {
    /// φ, with its cosine and sine.
    angle: f64,
    cos: f64,
    sin: f64,
    /// ω = −φ̇
    rate: f64,
    /// ∫ P cos²φ dt
    along: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::place::coordinates;
    use clebsch_examples::reference::solve;
    use nalgebra::SVector;

    /// All kinds of pendulum, against the equations ẋ = v cos θ, ẏ = v sin θ, θ̇ = ω, λ̇ = (−vλ_y, ωλ_y, −ωλ_x).
    #[test]
    fn geodesics_solve_their_equations() {
        let (price, time) = (0.5, 1.5);
        let cases = [
            [0.3, 1.0, 2.0],
            [-0.3, 1.0, -2.0],
            [0.4, -2.0, 1.0],
            [2.0, 1.0, 0.5],
            [-2.0, 1.0, -0.5],
            [-2.0, -1.0, 0.5],
            [3.0, 0.0, 0.0],
            [0.0, 1.3, 0.0],
            [0.0, -1.3, 0.0],
            [0.0, 0.0, 1.0],
            [0.5_f64.sqrt(), 0.6, 1.0],
            [1.0, 0.0, 0.2],
        ];
        for case in cases {
            let start = Vector3::from(case);
            let field = |y: &SVector<f64, 6>| {
                let (rate, speed) = (y[3] / price, y[4]);
                let (sin, cos) = y[2].sin_cos();
                [speed * cos, speed * sin, rate, -speed * y[5], rate * y[5], -rate * y[4]].into()
            };
            let y = solve(field, [0.0, 0.0, 0.0, start.x, start.y, start.z].into(), time, 10.0).end;
            let moment = Geodesic::new(price, &start).expect("a geodesic").at(time);
            let heading = (coordinates(&moment.place).z - y[2]) / std::f64::consts::TAU;
            assert!((moment.place.fixed_view::<2, 1>(0, 2) - y.fixed_rows::<2>(0)).amax() < 1e-12, "{case:?}");
            assert!((heading - heading.round()).abs() < 1e-12, "{case:?}");
            assert!((moment.costate - y.fixed_rows::<3>(3)).amax() < 1e-12, "{case:?}");
        }
    }
}
