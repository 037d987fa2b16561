//! The solver on Moser–Veselov equations 2Jc = a − c×a + (a·c)c, a = hπ, and on equations made to mislead it.

use super::path::LINEARIZATIONS;
use super::{Equation, Orientation, solve, solve_fixed_point};
use crate::runner::proptest;
use crate::{Error, Scalar};
use core::cell::Cell;
use nalgebra::{Matrix3, SMatrix, SVector, Vector1, Vector3};
use proptest::prelude::*;

/// h π^ = F𝒥 − 𝒥Fᵀ in the Cayley chart; the target is a = hπ.
struct Body<T: Scalar> {
    inertia: Matrix3<T>,
    /// The factor of the predictor (h/2)J⁻¹π; NaN forces the path to be followed.
    guess: T,
    linearizations: Cell<u32>,
}

impl<T: Scalar> Body<T> {
    fn new(inertia: Matrix3<T>) -> Self {
        Self { inertia, guess: T::one(), linearizations: Cell::new(0) }
    }
}

fn principal(moments: [f64; 3]) -> Body<f64> {
    Body::new(Matrix3::from_diagonal(&Vector3::from(moments)))
}

impl<T: Scalar> Equation<T, 3> for Body<T> {
    type Terms = Vector3<T>;
    type Jacobian = Matrix3<T>;

    fn prepare(&self, target: &Vector3<T>) -> Vector3<T> {
        *target
    }

    fn predict(&self, target: &Vector3<T>) -> Vector3<T> {
        let inverse = crate::parameters::invert(&self.inertia).unwrap_or(Matrix3::identity());
        inverse * target * (self.guess * T::from_ratio(1, 2))
    }

    fn linearize(&self, a: &Vector3<T>, c: &Vector3<T>) -> (Vector3<T>, Matrix3<T>) {
        self.linearizations.set(self.linearizations.get() + 1);
        let (along, twice) = (a.dot(c), self.inertia * T::from_f64(2.0));
        let residual = twice * c - a + c.cross(a) - c * along;
        let hat = Matrix3::new(T::zero(), -a.z, a.y, a.z, T::zero(), -a.x, -a.y, a.x, T::zero());
        (residual, twice - hat - c * a.transpose() - Matrix3::identity() * along)
    }
}

/// The same equation without a predictor of its own.
struct Unpredicted(Body<f64>);

impl Equation<f64, 3> for Unpredicted {
    type Terms = Vector3<f64>;
    type Jacobian = Matrix3<f64>;

    fn prepare(&self, target: &Vector3<f64>) -> Vector3<f64> {
        *target
    }

    fn linearize(&self, a: &Vector3<f64>, c: &Vector3<f64>) -> (Vector3<f64>, Matrix3<f64>) {
        self.0.linearize(a, c)
    }
}

/// A scalar equation from its residual and slope, with 0 as the predictor.
struct Curve<'a>(&'a dyn Fn(f64, f64) -> (f64, f64), Cell<u32>);

impl Equation<f64, 1> for Curve<'_> {
    type Terms = f64;
    type Jacobian = SMatrix<f64, 1, 1>;

    fn prepare(&self, target: &Vector1<f64>) -> f64 {
        target.x
    }

    fn linearize(&self, target: &f64, xi: &Vector1<f64>) -> (Vector1<f64>, SMatrix<f64, 1, 1>) {
        self.1.set(self.1.get() + 1);
        let (residual, slope) = (self.0)(*target, xi.x);
        (SVector::from([residual]), SMatrix::<f64, 1, 1>::new(slope))
    }
}

fn curve(target: f64, residual: impl Fn(f64, f64) -> (f64, f64)) -> (Result<f64, Error>, u32) {
    let curve = Curve(&residual, Cell::new(0));
    let solution = solve(&curve, &Vector1::new(target)).map(|xi| xi.x);
    (solution, curve.1.get())
}

fn fraction(result: Result<Vector3<f64>, Error>) -> f64 {
    match result {
        Err(Error::Unsolvable { solvable_fraction, .. }) => solvable_fraction,
        other => panic!("{other:?} is not unsolvable"),
    }
}

/// c of the permanent rotation sin θ = a/I: tan(θ/2) = sin θ/(1 + cos θ).
fn permanent(sine: f64) -> f64 {
    sine / (1.0 + ((1.0 - sine) * (1.0 + sine)).sqrt())
}

/// Each axis, and for each the sines that have a solution and those that have none.
#[test]
fn permanent_rotations_exist_up_to_a_right_angle() {
    let moments = [2.0, 3.0, 4.0];
    for (axis, moment) in moments.into_iter().enumerate().take(if cfg!(miri) { 1 } else { 3 }) {
        let axis_solve = |sine: f64| {
            let mut target = Vector3::zeros();
            target[axis] = moment * sine;
            solve(&principal(moments), &target)
        };
        for sine in [1e-300, 1e-8, 0.01, -0.3, 0.7, 0.95, -0.999, 1.0 - 1e-6, 1.0 - 1e-9] {
            let c = axis_solve(sine).unwrap_or_else(|error| panic!("sin θ = {sine}: {error}"));
            let expected = permanent(sine);
            // Close to a right angle the data determine c to ε / cos θ only.
            let tolerance = 8.0 * f64::EPSILON / ((1.0 - sine.abs()) * 2.0).sqrt().min(1.0);
            assert!((c[axis] / expected - 1.0).abs() <= tolerance, "sin θ = {sine}: {} is not {expected}", c[axis]);
        }
        for sine in [1.0 + 1e-12, 1.0 + 1e-6, -1.01, 1.4, 30.0, -1e6, 1e40] {
            let fraction = fraction(axis_solve(sine));
            assert!((fraction * sine.abs() - 1.0).abs() < 1e-3, "sin θ = {sine} solvable up to {fraction}");
        }
    }
}

#[test]
fn spherical_bodies_turn_about_their_momentum() {
    let direction = Vector3::new(2.0, -1.0, 2.0) / 3.0;
    for sine in [0.1, 0.5, 0.9, 0.99] {
        let c = solve(&principal([1.5; 3]), &(direction * 1.5 * sine)).expect("below a right angle");
        assert!((c - direction * permanent(sine)).amax() < 1e-15 / (1.0 - sine));
    }
    assert!((fraction(solve(&principal([1.5; 3]), &(direction * 3.0))) - 0.5).abs() < 1e-3);
}

/// FJ_d = (h²M² + J_d² − t hM + e₂I)⁻¹(tJ_d² + dI − hM J_d²), t the largest root of (t² − p₁)² = 4p₂ + 8dt.
#[test]
fn the_closed_form_in_three_dimensions_agrees() {
    for (j, a) in [
        (Vector3::new(0.65, 0.25, 0.75), Vector3::new(0.3, -0.4, 0.2)),
        (Vector3::new(0.05, 0.5, 0.9), Vector3::new(-0.2, 0.1, 0.35)),
        (Vector3::new(0.4, 0.41, 0.42), Vector3::new(0.5, 0.4, -0.3)),
    ] {
        let (squares, d) = (j.component_mul(&j), j.product());
        let p1 = squares.sum() - a.norm_squared();
        let p2 =
            squares.x * squares.y + squares.y * squares.z + squares.z * squares.x - a.component_mul(&a).dot(&squares);
        let mut t: f64 = j.sum();
        for _ in 0..60 {
            t -= (f64::powi(t * t - p1, 2) - 4.0 * p2 - 8.0 * d * t) / (4.0 * t * (t * t - p1) - 8.0 * d);
        }
        let (diagonal, m, e2) = (Matrix3::from_diagonal(&squares), a.cross_matrix(), (t * t - p1) / 2.0);
        let left = m * m + diagonal - m * t + Matrix3::identity() * e2;
        let right = diagonal * t + Matrix3::identity() * d - m * diagonal;
        let rotation = left.lu().solve(&right).expect("regular") * Matrix3::from_diagonal(&j.map(f64::recip));
        // 𝒥 = 2J_d and π = 2a.
        let inertia = (Matrix3::identity() * j.sum() - Matrix3::from_diagonal(&j)) * 2.0;
        let c = solve(&Body::new(inertia), &(a * 2.0)).expect("solvable");
        let z = c.cross_matrix();
        let cayley = Matrix3::identity() + (z + z * z) * (2.0 / (1.0 + c.norm_squared()));
        assert!((rotation - cayley).amax() < 1e-13, "{rotation}{cayley}");
    }
}

/// Linearisations with the one that the orientation costs here.
#[test]
fn small_steps_need_few_linearizations() {
    for (angle, most) in [(0.0, 2), (1e-9, 2), (1e-6, 2), (1e-2, 3), (0.1, 4), (0.5, 5), (0.9, 7)] {
        let body = principal([1.0, 1.4, 0.9]);
        let target = body.inertia * Vector3::new(0.6, 0.64, 0.48) * angle;
        solve(&body, &target).expect("solvable");
        assert!(body.linearizations.get() <= most, "{angle}: {}", body.linearizations.get());
    }
}

/// One linearisation more than with a predictor, up to steps that are too long for most; never the path.
#[test]
fn without_a_predictor_the_first_correction_is_one() {
    for (angle, most) in [(0.0, 2), (1e-9, 3), (1e-6, 3), (1e-2, 4), (0.1, 5), (0.5, 6), (0.9, 8)] {
        let body = Unpredicted(principal([1.0, 1.4, 0.9]));
        let target = body.0.inertia * Vector3::new(0.6, 0.64, 0.48) * angle;
        let c = solve(&body, &target).expect("solvable");
        assert!(body.0.linearizations.get() <= most, "{angle}: {}", body.0.linearizations.get());
        assert!((c - solve(&body.0, &target).expect("solvable")).amax() <= 1e-15 * c.amax());
    }
}

/// An error without its numbers.
fn kind(error: Error) -> core::mem::Discriminant<Error> {
    core::mem::discriminant(&error)
}

/// Where the iteration contracts and beyond, to the end of the branch and past it.
#[test]
fn fixed_points_are_the_solutions_of_newtons_method() {
    let body = principal([1.0, 1.4, 0.9]);
    let direction = Vector3::new(0.6, 0.64, 0.48);
    for angle in [0.0, 1e-300, 1e-9, 1e-3, 0.01, 0.05, 0.2, 0.5, 0.9, 0.99, 1.4, 30.0, 1e40, f64::NAN, f64::INFINITY] {
        let target = body.inertia * direction * angle;
        match (solve_fixed_point(&body, &target), solve(&body, &target)) {
            (Ok(c), Ok(expected)) => assert!((c - expected).amax() <= 1e-15 * expected.amax(), "{angle}: {c}"),
            (fixed, newton) => assert_eq!(fixed.map_err(kind), newton.map_err(kind), "{angle}"),
        }
    }
}

/// An iteration contracts like h|ω|; where it does not by a factor of four, it is given up at once.
#[test]
fn iterations_of_fixed_points() {
    for (angle, most) in [(0.0, 1), (1e-9, 2), (1e-6, 3), (1e-3, 6), (1e-2, 8), (0.1, 16)] {
        let body = principal([1.0, 1.4, 0.9]);
        solve_fixed_point(&body, &(body.inertia * Vector3::new(0.6, 0.64, 0.48) * angle)).expect("solvable");
        assert!(body.linearizations.get() <= most, "{angle}: {}", body.linearizations.get());
    }
}

#[test]
fn magnitudes_do_not_matter() {
    let (inertia, target) = (principal([1.0, 1.4, 0.9]).inertia, Vector3::new(0.3, 0.4, -0.2));
    let expected = solve(&Body::new(inertia), &target).expect("solvable");
    for power in [-1000, -500, 500, 1000].into_iter().step_by(if cfg!(miri) { 3 } else { 1 }) {
        let scale = 2.0_f64.powi(power);
        assert_eq!(solve(&Body::new(inertia * scale), &(target * scale)), Ok(expected));
    }
    for tiny in [1e-160, 1e-300, 1e-310, 5e-324] {
        let c = solve(&Body::new(inertia), &Vector3::new(tiny, 0.0, 0.0)).expect("solvable");
        assert!((c.x - tiny / 2.0).abs() <= 1e-15 * tiny + 5e-324);
    }
    assert_eq!(solve(&Body::new(inertia), &Vector3::zeros()), Ok(Vector3::zeros()));
    assert!(fraction(solve(&Body::new(inertia), &Vector3::new(1e300, 0.0, 0.0))) <= 1e-299);
}

#[test]
fn single_precision_is_solved_to_single_precision() {
    let inertia = Matrix3::from_diagonal(&Vector3::new(2.0_f32, 3.0, 4.0));
    let c = solve(&Body::new(inertia), &Vector3::new(0.0, 1.8, 0.0)).expect("sin θ = 0.6");
    assert!((c.y - 1.0 / 3.0).abs() < 1e-7);
    assert!(matches!(solve(&Body::new(inertia), &Vector3::new(0.0, 3.1, 0.0)), Err(Error::Unsolvable { .. })));
}

#[test]
fn what_is_not_finite_is_said() {
    let body = principal([1.0, 1.4, 0.9]);
    for broken in [f64::NAN, f64::INFINITY] {
        assert_eq!(solve(&body, &Vector3::new(0.0, broken, 0.0)), Err(Error::NotFinite { name: "the momentum" }));
        let inertia = Matrix3::from_diagonal(&Vector3::new(broken, 1.0, 1.0));
        let result = solve(&Body::new(inertia), &Vector3::new(0.1, 0.0, 0.0));
        assert_eq!(result, Err(Error::NotFinite { name: "the implicit equation of the step" }));
    }
}

#[test]
fn singular_equations_have_no_solvable_fraction() {
    assert_eq!(fraction(solve(&principal([1.0, 0.0, 1.0]), &Vector3::new(0.1, 0.2, 0.3))), 0.0);
    assert!(matches!(super::orientation(&principal([0.0; 3])), Err(Error::SingularKineticEnergy { .. })));
}

#[test]
fn indefinite_inertia_has_a_branch_too() {
    let body = principal([1.0, -2.0, 3.0]);
    assert_eq!(super::orientation(&body), Ok(Orientation::NEGATIVE));
    let c = solve(&body, &Vector3::new(0.0, 1.2, 0.0)).expect("sin θ = −0.6");
    assert!((c.y + 1.0 / 3.0).abs() < 1e-15);
}

/// The other solution of sin θ = a/I has c replaced by 1/c.
#[test]
fn predictors_on_another_branch_are_not_believed() {
    for guess in [-1.0, 0.0, 3.0, 20.0, f64::NAN, f64::INFINITY] {
        let mut body = principal([2.0, 3.0, 4.0]);
        body.guess = guess;
        let c = solve(&body, &Vector3::new(0.0, 0.0, 3.2)).expect("sin θ = 0.8");
        assert!((c.z - 0.5).abs() < 1e-15, "from {guess} times the predictor: {c}");
    }
}

/// ξ − ξ³/3 = m: the branch ends at ξ = 1, m = 2/3; Newton's method from outside would find ξ < −2.
#[test]
fn folds_are_found() {
    let cubic = |m: f64, x: f64| (x - x * x * x / 3.0 - m, 1.0 - x * x);
    for m in [0.1, 0.5, 0.66, 0.666_666, 0.666_666_666_6] {
        let x = curve(m, cubic).0.expect("below the fold");
        assert!(x < 1.0 && (x - x * x * x / 3.0 - m).abs() < 1e-15);
    }
    for m in [0.666_667, 0.67, 0.8, 5.0, 1e9] {
        let result = curve(m, cubic).0;
        let Err(Error::Unsolvable { solvable_fraction, .. }) = result else { panic!("{m}: {result:?}") };
        assert!((solvable_fraction * m - 2.0 / 3.0).abs() < 1e-3);
    }
}

/// ξ³ + εξ = m is steep near 0 and has all solutions.
#[test]
fn stiff_monotone_equations_are_solved() {
    for softness in [1.0, 1e-3, 1e-6] {
        for m in [1e-12, 1e-6, 1.0, 1e6] {
            let x = curve(m, |m, x| (x * x * x + softness * x - m, 3.0 * x * x + softness)).0.expect("monotone");
            assert!((x * x * x + softness * x - m).abs() <= 1e-14 * m, "{softness} {m}: {x}");
        }
    }
}

/// 12 by Newton's method, those along the path with 4 for its last point, and one for the error. Each of both also
/// takes one for the sign at the identity.
const MOST: u32 = 12 + LINEARIZATIONS + 4 + 1 + 2;

/// tanh ξ = m has ξ going to infinity as m goes to 1.
#[test]
fn paths_that_leave_the_chart_end() {
    let tanh = |m: f64, x: f64| (Scalar::tanh(x) - m, 1.0 / Scalar::cosh(x) / Scalar::cosh(x));
    assert!((curve(0.999, tanh).0.expect("below 1") - 3.800_201_167_250_2).abs() < 1e-9);
    let (result, linearizations) = curve(1.5, tanh);
    assert!(result.is_err() && linearizations <= MOST, "{result:?} {linearizations}");
}

#[test]
fn work_is_bounded_whatever_the_equation() {
    type Wild = fn(f64, f64) -> (f64, f64);
    let wild: [Wild; 4] = [
        |m, x| ((1e3 * x).sin() + 1e-3 * x - m, 1e-9 + (7e5 * x).cos()),
        |m, x| (if x > 0.3 { f64::NAN } else { x - m }, 1.0),
        |m, x| (x.signum() - m, 1.0),
        |m, x| (x - m, 1.0 - 1e9 * (1e5 * x).sin()),
    ];
    for equation in wild {
        for m in [1e-3, 1.0, 1e3] {
            let (result, linearizations) = curve(m, equation);
            assert!(linearizations <= MOST, "{result:?} after {linearizations}");
        }
    }
}

/// Principal moments of a mass distribution, from second moments.
fn moments() -> impl Strategy<Value = [f64; 3]> {
    prop::array::uniform3(0.05_f64..1.0).prop_map(|[x, y, z]| [y + z, x + z, x + y])
}

proptest! {
    #[test]
    fn newton_and_the_path_agree(moments in moments(), omega in prop::array::uniform3(-0.9_f64..0.9)) {
        let body = principal(moments);
        let target = body.inertia * Vector3::from(omega);
        let mut slow = principal(moments);
        slow.guess = f64::NAN;
        match (solve(&body, &target), solve(&slow, &target)) {
            (Ok(quick), Ok(path)) => {
                prop_assert!((quick - path).amax() <= 1e-7 * quick.amax());
                let (residual, jacobian) = body.linearize(&target, &quick);
                prop_assert!(residual.amax() <= 32.0 * f64::EPSILON * target.amax());
                prop_assert!(jacobian.determinant() > 0.0);
            }
            (Err(Error::Unsolvable { solvable_fraction: quick, .. }), Err(Error::Unsolvable { solvable_fraction: path, .. })) => {
                prop_assert_eq!(quick, path);
                prop_assert!(solve(&body, &(target * (quick * 0.998))).is_ok());
                prop_assert!(solve(&body, &(target * (quick * 1.002))).is_err());
            }
            (quick, path) => prop_assert!(false, "{:?} {:?}", quick, path),
        }
    }

    /// Found numerically for bodies: always solvable for h|J⁻¹π| ≤ 1, never beyond 1.31.
    #[test]
    fn the_rule_for_solvability_holds(moments in moments(), direction in prop::array::uniform3(-1.0_f64..1.0), speed in 0.0_f64..2.0) {
        let direction = Vector3::from(direction);
        prop_assume!(direction.norm() > 0.1);
        let body = principal(moments);
        let result = solve(&body, &(body.inertia * direction * (speed / direction.norm())));
        prop_assert!(speed > 1.0 || result.is_ok(), "{:?}", result);
        prop_assert!(speed < 1.31 || result.is_err(), "{:?}", result);
    }
}

/// ξ/(1 − ξ²) = μ, with a pole at 1 and a predictor of its own.
struct Pole {
    start: f64,
}

impl Equation<f64, 1> for Pole {
    type Terms = f64;
    type Jacobian = SMatrix<f64, 1, 1>;

    fn prepare(&self, target: &Vector1<f64>) -> f64 {
        target.x
    }

    fn predict(&self, _: &Vector1<f64>) -> Vector1<f64> {
        Vector1::new(self.start)
    }

    fn linearize(&self, target: &f64, xi: &Vector1<f64>) -> (Vector1<f64>, SMatrix<f64, 1, 1>) {
        let (x, rest) = (xi.x, (1.0 - xi.x) * (1.0 + xi.x));
        (Vector1::new(x / rest - target), SMatrix::<f64, 1, 1>::new((1.0 + x * x) / (rest * rest)))
    }

    fn has_poles() -> bool {
        true
    }
}

/// From some starts, Newton's step ends in the last place next to the pole, where the next one is not seen. There is no
/// solution all the same.
#[test]
fn a_pole_is_no_solution() {
    let target = Vector1::new(-3.0);
    let next = |x: f64| {
        let (residual, slope) = Pole { start: x }.linearize(&target.x, &Vector1::new(x));
        x - residual.x / slope[(0, 0)]
    };
    // where Newton's step to the left goes over 1, for ξ beyond it
    let (mut low, mut high) = (1.0 + 1e-6, 3.0);
    assert!(next(low) > 1.0 && next(high) < 1.0, "{} {}", next(low), next(high));
    for _ in 0..200 {
        let middle = low + (high - low) / 2.0;
        if next(middle) > 1.0 { low = middle } else { high = middle }
    }
    let expected = (1.0 - 37.0_f64.sqrt()) / 6.0;
    for start in [low, high, low - 1e-15, high + 1e-15, 0.0] {
        assert!(start == 0.0 || (next(start) - 1.0).abs() < 1e-14, "{}", next(start));
        let found = solve(&Pole { start }, &target).expect("the branch goes on for ever");
        assert!((found.x - expected).abs() < 1e-15, "{start}: {} for {expected}", found.x);
    }
}
