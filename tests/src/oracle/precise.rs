//! The equations of discrete Clebsch optimal control (Nordkvist, Crouch and Bloch) as they stand, for any matrix group,
//! to 30 digits.
//!
//! A [`Problem`](problem::Problem) gives an action and a discrete Lagrangian as functions of any [`Real`](real::Real)
//! number. [`step`](step::step) solves F⁻ℓd(q, F) = N for F and returns (Φ_F q, F⁺ℓd(q, F)). Derivatives are those of
//! dual numbers, numbers are pairs of `f64`, and no formula is simplified. Derived steps are compared with this, and
//! nothing is shared with the macro.
//!
//! ```
//! use clebsch_tests::oracle::precise::problem::{Factor, Problem, right};
//! use clebsch_tests::oracle::precise::step::{State, deviation, trajectory};
//! use clebsch_tests::oracle::precise::{double_double::DoubleDouble, group::so, matrix::Matrix, real::Real};
//!
//! /// A free rigid body of the moment of inertia 2 about every axis.
//! struct Ball;
//! impl Problem for Ball {
//!     fn factors(&self) -> Vec<Factor> {
//!         vec![right(so(3))]
//!     }
//!     fn act<R: Real>(&self, f: &[Matrix<R>], q: &[Matrix<R>]) -> Vec<Matrix<R>> {
//!         vec![&q[0] * &f[0]]
//!     }
//!     fn cost<R: Real>(&self, _t: R, h: R, _q: &[Matrix<R>], f: &[Matrix<R>]) -> R {
//!         (&f[0] - Matrix::identity(3)).norm_squared() / (h * 2.0)
//!     }
//! }
//!
//! let h = 0.1;
//! let start = State { q: vec![Matrix::<f64>::identity(3)], n: vec![0.0, 0.0, 1.0] };
//! let oracle = trajectory(&Ball, DoubleDouble::of(h), &start.lift(), 5).unwrap();
//! // these states would come from the integrator under test; the ball turns by asin(hπ/2) about its axis
//! let turned = |k: f64| (&so(3).basis[2] * (k * (h / 2.0).asin())).exponential();
//! let states: Vec<_> = (0..=5).map(|k| State { q: vec![turned(f64::from(k))], n: start.n.clone() }).collect();
//! assert!(deviation(&oracle, &states) < 1e-15);
//! ```

pub mod constrained;
pub mod double_double;
pub mod dual;
pub mod energy;
pub mod equation;
pub mod group;
pub mod matrix;
pub mod on_itself;
pub mod problem;
pub mod real;
pub mod step;
