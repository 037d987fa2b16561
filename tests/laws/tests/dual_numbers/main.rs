//! Simulations over dual numbers: their derivatives are those of the tangent maps and of differences.
//!
//! Newton's method stops when values no longer change, and derivatives are right one correction later: each test would see a derivative
//! that is left behind.

#[path = "../tangent/sixth.rs"]
mod sixth;
#[path = "../tangent/shared.rs"]
mod systems;

use clebsch::num_dual::{Dual2_64, Dual64, DualSVec64, HyperDual64};
use clebsch::{Clebsch, Scalar, State, Stepper};
use clebsch_tests::oracle::near::assert_near;
use clebsch_tests::oracle::random::Random;
use clebsch_tests::oracle::rotation::vee;
use nalgebra::{Matrix3, Matrix4, Vector3, Vector4, Vector6};
use sixth::Sixth;
use systems::{Composed, Satellite, Top};

const H: f64 = 0.1;

fn mass_matrix<T: Scalar>() -> Matrix3<T> {
    Matrix3::new(1.2, 0.1, -0.2, 0.1, 0.8, 0.05, -0.2, 0.05, 0.5).map(T::from_f64)
}

fn center<T: Scalar>() -> Vector3<T> {
    Vector3::new(0.1, -0.2, 0.7).map(T::from_f64)
}

fn top<T: Scalar>(weight: T) -> Stepper<Top<T>> {
    let top = Top { mass_matrix: mass_matrix(), weight, center: center() };
    top.into_stepper(T::from_f64(H)).expect("parameters")
}

/// The momentum whose entry i has the derivative 1 in direction i.
fn varied(mu: Vector3<f64>) -> Vector3<DualSVec64<3>> {
    Vector3::from_fn(|i, _| DualSVec64::<3>::from_re(mu[i]).derivative(i))
}

/// Columns: the derivatives of the entries of a vector.
fn gradients(vector: &Vector3<DualSVec64<3>>) -> Matrix3<f64> {
    Matrix3::from_fn(|i, j| vector[i].eps.0.map_or(0.0, |eps| eps[j]))
}

/// Asserts that one step differentiates like the tangent map of the same stepper over `f64`, by momenta.
macro_rules! assert_tangent {
    ($plain:expr, $dual:expr, $q:expr, $mu:expr) => {{
        let (plain, dual) = ($plain.expect("parameters"), $dual.expect("parameters"));
        let start = plain.state($q, $mu).expect("a state");
        let (next, tangent) = plain.step_tangent(&start).expect("a step");
        let start = dual.state($q.map(DualSVec64::<3>::from_f64), varied($mu)).expect("a state");
        let end = dual.step(&start).expect("a step");
        assert_near(&end.momentum().map(|x| x.re), &next.momentum(), 1e-14, "values");
        assert_near(&gradients(&end.momentum()), &tangent.momentum_by_momentum, 1e-12, "momenta");
        for j in 0..3 {
            let slope = end.configuration().map(|x| x.eps.0.map_or(0.0, |eps| eps[j]));
            let motion = vee(&(next.configuration().transpose() * slope));
            assert_near(&motion, &tangent.motion_by_momentum.column(j).into_owned(), 1e-12, "motions");
        }
    }};
}

#[test]
fn steps_differentiate_like_their_tangent_maps() {
    let mut random = Random::new(2);
    type D = DualSVec64<3>;
    let (h, dual_h) = (H, D::from_f64(H));
    for size in [1e-6, 0.01, 0.3, 2.0, 6.0] {
        let (q, mu) = (random.attitude::<3>(), random.unit::<3>() * size);
        let weight = 3.0;
        assert_tangent!(
            Top { mass_matrix: mass_matrix(), weight, center: center() }.into_stepper(h),
            Top { mass_matrix: mass_matrix(), weight: D::from_f64(weight), center: center() }.into_stepper(dual_h),
            q,
            mu
        );
        assert_tangent!(
            Composed { mass_matrix: mass_matrix(), weight, center: center(), skew: 0.05 }.into_stepper(h),
            Composed {
                mass_matrix: mass_matrix(),
                weight: D::from_f64(weight),
                center: center(),
                skew: D::from_f64(0.05)
            }
            .into_stepper(dual_h),
            q,
            mu
        );
        let inertia = Matrix3::new(1.0, 0.1, 0.0, 0.1, 1.4, -0.1, 0.0, -0.1, 0.9);
        let (dual_inertia, rate) = (inertia.map(D::from_f64), D::from_f64(0.6));
        assert_tangent!(
            Sixth { inertia, rate: 0.6 }.into_stepper(h),
            Sixth { inertia: dual_inertia, rate }.into_stepper(dual_h),
            q,
            mu
        );
        assert_tangent!(
            Satellite { inertia, orbital_rate: 0.6 }.into_stepper(h),
            Satellite { inertia: dual_inertia, orbital_rate: rate }.into_stepper(dual_h),
            q,
            mu
        );
    }
}

/// The path that is followed where Newton's method does not decide: just below the longest step that there is.
#[test]
fn derivatives_are_right_up_to_the_longest_step() {
    let stepper = top(0.0);
    let direction = Vector3::new(0.3, -0.5, 0.8);
    let momentum = |size: f64| {
        let state = stepper.state(Matrix3::identity(), direction * size).expect("a state");
        stepper.step(&state).map(|state| state.into_parts().1)
    };
    let longest =
        (0..2000).map(|i| f64::from(i) * 0.02).take_while(|&size| momentum(size).is_ok()).last().expect("some");
    let dual = top(Dual64::from_f64(0.0));
    for fraction in [0.0, 0.5, 0.9, 0.99, 0.999, 1.0] {
        let size = longest * fraction;
        let mu = direction.map(|x| Dual64::new(x * size, x));
        let start = dual.state(Matrix3::identity().map(Dual64::from_f64), mu).expect("a state");
        let slope = dual.step(&start).expect("a step").momentum().map(|x| x.eps);
        let delta = 1e-5 * (1.001 - fraction);
        let difference =
            (momentum(size + delta).expect("a step") - momentum(size - delta).expect("a step")) / (2.0 * delta);
        assert!((slope - difference).norm() < 1e-5 * (1.0 + difference.norm()), "{fraction}: {slope} {difference}");
    }
}

/// The height of a top after some steps, as a function of its weight and its spin.
fn height<T: Scalar>(weight: T, spin: T) -> T {
    let stepper = top(weight);
    let mut state: State<Top<T>> =
        stepper.state(Matrix3::identity(), Vector3::new(T::from_f64(0.1), spin, T::from_f64(2.0))).expect("a state");
    for _ in 0..50 {
        state = stepper.step(&state).expect("a step");
    }
    (state.configuration() * center::<T>()).z
}

/// First derivatives against differences of values, second ones against differences of first ones.
#[test]
fn simulations_differentiate_by_parameters_and_initial_data() {
    let (weight, spin, delta) = (3.0, -0.7, 1e-5);
    let by_weight = height(Dual64::new(weight, 1.0), Dual64::from_f64(spin));
    let by_spin = |spin: f64| height(Dual64::from_f64(weight), Dual64::new(spin, 1.0)).eps;
    assert!((by_weight.re - height(weight, spin)).abs() < 1e-13);
    let central = |f: &dyn Fn(f64) -> f64| (f(delta) - f(-delta)) / (2.0 * delta);
    let near = |found: f64, expected: f64| {
        assert!((found - expected).abs() < 1e-8 * (1.0 + expected.abs()), "{found} {expected}")
    };
    near(by_weight.eps, central(&|d| height(weight + d, spin)));
    near(by_spin(spin), central(&|d| height(weight, spin + d)));
    let second = height(Dual2_64::from_f64(weight), Dual2_64::new(spin, 1.0, 0.0));
    near(second.v1, by_spin(spin));
    near(second.v2, central(&|d| by_spin(spin + d)));
    let mixed = height(HyperDual64::new(weight, 1.0, 0.0, 0.0), HyperDual64::new(spin, 0.0, 1.0, 0.0));
    near(mixed.eps1, by_weight.eps);
    near(mixed.eps2, by_spin(spin));
    near(mixed.eps1eps2, central(&|d| height(Dual64::new(weight + d, 0.0), Dual64::new(spin, 1.0)).eps));
}

/// The step of a body at rest starts from a correction that is zero, but whose derivative is not. The series at angle
/// zero end at once.
#[test]
fn bodies_at_rest_have_derivatives() {
    type D = DualSVec64<3>;
    let inertia = Matrix3::new(1.0, 0.1, 0.0, 0.1, 1.4, -0.1, 0.0, -0.1, 0.9);
    let satellite = Satellite { inertia, orbital_rate: 0.0 }.into_stepper(H);
    let dual =
        Satellite { inertia: inertia.map(D::from_f64), orbital_rate: D::from_f64(0.0) }.into_stepper(D::from_f64(H));
    assert_tangent!(satellite, dual, Matrix3::<f64>::identity(), Vector3::<f64>::zeros());
    let (plain, dual) = (top(0.0), top(D::from_f64(0.0)));
    assert_tangent!(
        Ok::<_, clebsch::Error>(plain),
        Ok::<_, clebsch::Error>(dual),
        Matrix3::<f64>::identity(),
        Vector3::<f64>::zeros()
    );
}

/// A heavy top whose drift is the free motion: power series, whose coefficients are made of the inertia.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<3>, R: SO<3>| R * F,
    lagrangian     = |omega| omega.dot(&(self.inertia * omega)) / 2,
    potential      = |R| self.weight * (R * self.center).z,
    discretization = exact,
    order          = 4,
)]
struct SplitTop<T: Scalar> {
    #[clebsch(symmetric)]
    inertia: Matrix3<T>,
    weight: T,
    center: Vector3<T>,
}

/// By each entry of the inertia, also where it is diagonal or that of a ball, and by the momentum: against differences of values.
#[test]
fn exact_drifts_differentiate() {
    exact_drifts_of(0.1);
}

/// The same in long steps.
#[test]
fn long_exact_drifts_differentiate() {
    exact_drifts_of(2.0);
}

fn exact_drifts_of(h: f64) {
    let tensors = [
        Matrix3::new(1.0, 0.1, 0.0, 0.1, 1.4, -0.1, 0.0, -0.1, 0.9),
        Matrix3::from_diagonal(&Vector3::new(1.0, 1.5, 2.0)),
        Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 2.0)),
        Matrix3::identity(),
    ];
    let pi = Vector3::new(1.0, -1.5, 2.0);
    fn spatial<T: Scalar>(inertia: Matrix3<T>, pi: Vector3<T>, h: f64) -> Vector3<T> {
        let top = SplitTop { inertia, weight: T::from_f64(0.7), center: center() };
        let stepper = top.into_stepper(T::from_f64(h)).expect("parameters");
        let end = stepper.advance(&stepper.state(Matrix3::identity(), pi).expect("a state"), 5).expect("steps");
        end.configuration() * Vector3::new(T::one(), T::zero(), T::zero())
    }
    for inertia in tensors {
        let delta = 1e-5;
        // without the feature `heavy` one entry in two, on the diagonal and off it
        let entries = [(0, 0), (1, 1), (0, 1), (0, 2), (2, 2), (1, 2)];
        for (i, j) in entries.into_iter().step_by(if cfg!(feature = "heavy") { 1 } else { 2 }) {
            let mut direction = Matrix3::zeros();
            (direction[(i, j)], direction[(j, i)]) = (1.0, 1.0);
            let dual = inertia.zip_map(&direction, Dual64::new);
            let slope = spatial(dual, pi.map(Dual64::from_f64), h).map(|x| x.eps);
            let at = |size: f64| spatial(inertia + direction * size, pi, h);
            let difference = (at(delta) - at(-delta)) / (2.0 * delta);
            assert!(
                (slope - difference).norm() < 1e-6 * (1.0 + difference.norm()),
                "{inertia}({i}, {j}) {h}: {slope} {difference}"
            );
        }
        let slope = spatial(inertia.map(Dual64::from_f64), pi.map(|x| Dual64::new(x, x)), h).map(|x| x.eps);
        let at = |size: f64| spatial(inertia, pi * (1.0 + size), h);
        let difference = (at(delta) - at(-delta)) / (2.0 * delta);
        assert!((slope - difference).norm() < 1e-6 * (1.0 + difference.norm()), "{inertia}{h}: {slope} {difference}");
    }
}

/// A body in four dimensions, whose motion is a power series in the time where numbers have derivatives.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<4>, R: SO<4>| R * F,
    lagrangian     = |omega| (self.mass * omega.matrix() * omega.matrix().transpose()).trace() / 2,
    discretization = exact,
)]
struct Body4<T: Scalar> {
    #[clebsch(symmetric)]
    mass: Matrix4<T>,
}

#[test]
fn motions_in_four_dimensions_differentiate() {
    fn end<T: Scalar>(mass: Matrix4<T>, mu: Vector6<T>) -> (Matrix4<T>, Vector6<T>) {
        let stepper = Body4 { mass }.into_stepper(T::from_f64(1.5)).expect("parameters");
        let end = stepper.advance(&stepper.state(Matrix4::identity(), mu).expect("a state"), 3).expect("steps");
        end.into_parts()
    }
    let mu = Vector6::new(0.6, -1.0, 0.4, 1.2, -0.2, 1.0);
    let ball = Matrix4::identity();
    let mass = Matrix4::from_diagonal(&Vector4::new(1.0, 1.5, 2.0, 2.5));
    for mass in [mass, ball] {
        let value = end(mass.map(Dual64::from_f64), mu.map(Dual64::from_f64)).0.map(|x| x.re);
        assert!((value - end(mass, mu).0).norm() < 1e-13);
        let delta = 1e-5;
        for (i, j) in [(0, 0), (3, 3), (0, 1), (1, 3)] {
            let mut direction = Matrix4::zeros();
            (direction[(i, j)], direction[(j, i)]) = (1.0, 1.0);
            let (r, m) = end(mass.zip_map(&direction, Dual64::new), mu.map(|x| Dual64::new(x, x)));
            let at = |size: f64| end(mass + direction * size, mu * (1.0 + size));
            let (after, before) = (at(delta), at(-delta));
            let (turn, rate) = ((after.0 - before.0) / (2.0 * delta), (after.1 - before.1) / (2.0 * delta));
            assert!((r.map(|x| x.eps) - turn).norm() < 1e-7, "{mass}({i}, {j}): {} {turn}", r.map(|x| x.eps));
            assert!((m.map(|x| x.eps) - rate).norm() < 1e-7, "{mass}({i}, {j}): {} {rate}", m.map(|x| x.eps));
        }
    }
}
