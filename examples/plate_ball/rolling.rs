//! The continuous extremals, which know nothing of steps or groups, by shooting.
//!
//! The costates in space are λ of the position and m of the attitude. Pontryagin's principle gives these equations, with
//! u = λ + (m₂, −m₁)/r.
//! ```text
//! ẋ = u,   Ṙ = ω × R,   ṁ = ω × m   with   ω = (−u₂, u₁, 0)/r,   λ constant
//! ```
//! So u̇ = m₃/r² (u₂, −u₁) and ṁ₃ = λ × u. The speed is constant, and the curvature is an affine function of the position:
//! an elastica.
//! Source: Jurdjevic, *The geometry of the plate-ball problem*, Archive for Rational Mechanics and Analysis 124 (1993), 305–328.

use crate::Problem;
use crate::attitude::turned;
use clebsch_examples::reference::{Solution, solve};
use nalgebra::{Matrix3, SMatrix, SVector, Vector2, Vector3};

/// λ in units of r/T and m in units of r²/T.
pub type Costate = SVector<f64, 5>;

/// Newton corrections at most.
const CORRECTIONS: usize = 30;
/// The largest correction.
const LARGEST: f64 = 1.0;
/// Of differences to one side.
const STEP: f64 = 1e-7;
/// Singular values below this are those of symmetries: turned solutions are as good.
const SINGULAR: f64 = 1e-6;

/// An extremal from the start to the goal.
#[derive(Clone, Copy, Debug)]
pub struct Shot {
    /// At the start.
    pub costate: Costate,
    /// ½|u|²T, m²/s.
    pub price: f64,
    /// How far the way may be off, in radii and rad.
    pub error: f64,
    /// Whether no others are arbitrarily near. Those of a goal above the start that is turned about the vertical can be
    /// turned. Those of a goal that is not turned can be shifted along their tracks, which are periodic.
    pub is_isolated: bool,
}

/// Where the ball is, in units of r and T.
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    /// x
    pub position: Vector2<f64>,
    /// R
    pub attitude: Matrix3<f64>,
    /// m
    pub momentum: Vector3<f64>,
}

impl Shot {
    /// The extremal near this costate that ends at the goal; `None` where corrections do not end.
    pub fn aim(problem: &Problem, guess: &Costate) -> Option<Self> {
        let (mut costate, mut last) = (*guess, f64::INFINITY);
        for _ in 0..CORRECTIONS {
            let (lack, integrated) = left(problem, &costate);
            let decomposed = slope(problem, &costate, &lack).svd(true, true);
            let (least, largest) = (decomposed.singular_values.min(), decomposed.singular_values.max());
            let correction = -decomposed.solve(&lack, SINGULAR).ok()?;
            let size = correction.norm();
            if size >= last && last < 1e-9 {
                // where nothing leads closer, that is not the goal
                let error = integrated + 8.0 * last;
                let price = input(&costate, &start(problem, &costate).momentum).norm_squared() / 2.0;
                let unit = problem.radius * problem.radius / problem.duration;
                let is_isolated = least > SINGULAR * largest;
                return (lack.norm() < 1e-8).then_some(Self { costate, price: price * unit, error, is_isolated });
            }
            last = size;
            costate += correction * (LARGEST / size).min(1.0);
        }
        None
    }

    /// The motion at so many equal parts of the time, the start and the end among them.
    pub fn path(&self, problem: &Problem, parts: u64) -> Vec<Motion> {
        let later = |motion: &Motion| Some(after(&self.costate, motion, 1.0 / parts as f64).0);
        std::iter::successors(Some(start(problem, &self.costate)), later).take(parts as usize + 1).collect()
    }
}

fn start(problem: &Problem, costate: &Costate) -> Motion {
    let position = problem.start.0 / problem.radius;
    Motion { position, attitude: problem.start.1, momentum: costate.fixed_rows::<3>(2).into() }
}

fn input(costate: &Costate, momentum: &Vector3<f64>) -> Vector2<f64> {
    Vector2::new(costate[0] + momentum.y, costate[1] - momentum.x)
}

/// The motion later by a part of the time, and the error of integration.
fn after(costate: &Costate, motion: &Motion, part: f64) -> (Motion, f64) {
    let field = |y: &SVector<f64, 14>| {
        let motion = unpack(y);
        let u = input(costate, &motion.momentum);
        let omega = Vector3::new(-u.y, u.x, 0.0);
        let attitude = omega.cross_matrix() * motion.attitude;
        pack(&Motion { position: u, attitude, momentum: omega.cross(&motion.momentum) })
    };
    let rate = input(costate, &motion.momentum).norm().max(motion.momentum.z.abs()).max(1.0);
    let Solution { end, error } = solve(field, pack(motion), part, rate);
    (unpack(&end), error)
}

/// The distance to the goal, in radii and rad.
fn left(problem: &Problem, costate: &Costate) -> (SVector<f64, 5>, f64) {
    let (end, error) = after(costate, &start(problem, costate), 1.0);
    let way = end.position - problem.goal.0 / problem.radius;
    let turn = turned(&(problem.goal.1.transpose() * end.attitude));
    (SVector::from([way.x, way.y, turn.x, turn.y, turn.z]), error)
}

fn slope(problem: &Problem, costate: &Costate, here: &SVector<f64, 5>) -> SMatrix<f64, 5, 5> {
    let mut slope = SMatrix::<f64, 5, 5>::zeros();
    for column in 0..5 {
        let mut moved = *costate;
        moved[column] += STEP;
        slope.set_column(column, &((left(problem, &moved).0 - here) / STEP));
    }
    slope
}

fn pack(motion: &Motion) -> SVector<f64, 14> {
    let parts = [motion.position.as_slice(), motion.attitude.as_slice(), motion.momentum.as_slice()];
    SVector::from_iterator(parts.into_iter().flatten().copied())
}

fn unpack(y: &SVector<f64, 14>) -> Motion {
    let attitude = Matrix3::from_column_slice(&y.as_slice()[2..11]);
    Motion { position: y.fixed_rows::<2>(0).into(), attitude, momentum: y.fixed_rows::<3>(11).into() }
}
