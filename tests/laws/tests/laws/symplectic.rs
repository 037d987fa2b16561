//! Steps are symplectic: DᵀΩD = Ω with the exact Jacobian D of the step, from dual numbers put through the generated code.
//!
//! So these tests also run generic declarations on a scalar that the runtime does not know. D is exact up to round-off; entries
//! of D and of the momenta are of order one and DᵀΩD sums products: 1e-13 allowed, 1e-15 measured.

use clebsch::{Clebsch, Scalar};
use clebsch_tests::fixtures::generic_body::GenericBody;
use clebsch_tests::oracle::dual::Dual;
use clebsch_tests::oracle::near::{assert_near, distance};
use clebsch_tests::oracle::random::Random;
use clebsch_tests::oracle::rotation::{hat, vee};
use clebsch_tests::stepping::Stepping;
use nalgebra::{Matrix3, Matrix4, SMatrix, SVector, Vector3};

const H: f64 = 0.1;
const NEAR: f64 = 1e-13;

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost      = |h, F| self.inertia * (F - I).norm_squared() / (4 * h),
    potential = |q| self.gravity * q.z + q.x.powi(3) / 3,
)]
pub struct Pendulum<T: Scalar> {
    pub inertia: T,
    pub gravity: T,
}

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<4>, q: Unit<Vector4>| F * q,
    cost      = |h, F| (F - I).norm_squared() / (4 * h),
    potential = |q| q.dot(&(self.stiffness * q)) / 2,
)]
pub struct Neumann<T: Scalar> {
    #[clebsch(symmetric)]
    pub stiffness: Matrix4<T>,
}

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |a: Translation<3>, x: Vector3| x + a,
    cost      = |h, a| self.mass * a.norm_squared() / (2 * h),
    potential = |x| -self.mass / x.norm(),
)]
pub struct Planet<T: Scalar> {
    pub mass: T,
}

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, R: SO<3>| R * F,
    cost      = |h, F| (self.mass_matrix * (F - I) * (F - I).transpose()).trace() / (2 * h),
    potential = |R| self.weight * (R * self.center).z,
    order     = 1,
)]
pub struct FirstOrderBody<T: Scalar> {
    pub mass_matrix: Matrix3<T>,
    pub weight: T,
    pub center: Vector3<T>,
}

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, R: SO<3>| R * F,
    cost      = |h, F| {
        let kinetic = (self.mass_matrix * (F - I) * (F - I).transpose()).trace() / (2 * h);
        kinetic + self.skew * (F[(1, 0)] - F[(0, 1)]).powi(3) / h
    },
    potential = |R| self.weight * (R * self.center).z,
)]
pub struct ComposedBody<T: Scalar> {
    #[clebsch(symmetric)]
    pub mass_matrix: Matrix3<T>,
    pub weight: T,
    pub center: Vector3<T>,
    pub skew: T,
}

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<3>, R: SO<3>| R * F,
    lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
    potential  = |R| self.weight * (R * self.center).z,
    order      = 16,
)]
pub struct CollocatedBody<T: Scalar> {
    #[clebsch(symmetric)]
    pub inertia: Matrix3<T>,
    pub weight: T,
    pub center: Vector3<T>,
}

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost      = |h, F| self.inertia * (F - I).norm_squared() / (4 * h),
    potential = |q| self.gravity * q.z + q.x.powi(3) / 3,
    order     = 16,
)]
pub struct CollocatedPendulum<T: Scalar> {
    pub inertia: T,
    pub gravity: T,
}

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |a: Translation<3>, x: Vector3| x + a,
    lagrangian = |x, v| v.norm_squared() / 2 + self.field * (x.x * v.y - x.y * v.x) / 2,
    potential  = |x| 1 / x.norm(),
    order      = 16,
)]
pub struct CollocatedCharge<T: Scalar> {
    pub field: T,
}

fn constant<const K: usize, const R: usize, const C: usize>(a: &SMatrix<f64, R, C>) -> SMatrix<Dual<K>, R, C> {
    a.map(Dual::constant)
}

/// The numbers of `a` as variables, from direction `first` on.
fn variables<const K: usize, const R: usize, const C: usize>(
    a: &SMatrix<f64, R, C>,
    first: usize,
) -> SMatrix<Dual<K>, R, C> {
    let entries = a.iter().enumerate().map(|(k, value)| Dual::variable(*value, first + k));
    SMatrix::from_iterator(entries)
}

/// Row after row the derivatives of the entries.
fn jacobian<'a, const K: usize>(entries: impl Iterator<Item = &'a Dual<K>>) -> SMatrix<f64, K, K> {
    SMatrix::from_row_iterator(entries.flat_map(|entry| entry.derivatives))
}

/// Theorem 1 on T*Rⁿ, K = 2n: D of (q, p) ↦ (q⁺, p⁺) in all directions, those off the orbit too.
fn assert_symplectic<S, const R: usize, const C: usize, const K: usize>(
    system: &S,
    q: &SMatrix<f64, R, C>,
    p: &SMatrix<f64, R, C>,
) where
    S: Clebsch<Scalar = Dual<K>, Configuration = SMatrix<Dual<K>, R, C>>,
{
    let constants = system.step_constants(Dual::constant(H)).expect("a regular system");
    let step = system.step_symmetric(&constants, Dual::constant(0.0), &variables(q, 0), &variables(p, K / 2));
    let (q, p) = step.expect("a solvable step");
    let d = jacobian(q.iter().chain(p.iter()));
    let omega = SMatrix::<f64, K, K>::from_fn(|i, j| match (i + K / 2 == j, j + K / 2 == i) {
        (true, _) => 1.0,
        (_, true) => -1.0,
        _ => 0.0,
    });
    let pulled_back = d.transpose() * omega * d;
    println!("{}: DᵀΩD − Ω {:.1e}, |D| {:.1}", S::NAME, distance(&pulled_back, &omega), d.amax());
    assert_near(&pulled_back, &omega, NEAR, S::NAME);
    assert!(distance(&d, &SMatrix::identity()) > 1e-3, "{}: the step moves something", S::NAME);
}

fn body<const K: usize>(random: &mut Random) -> GenericBody<Dual<K>> {
    GenericBody {
        mass_matrix: constant(&random.inertia()),
        weight: Dual::constant(1.3),
        center: constant(&random.vector()),
    }
}

#[test]
fn steps_on_the_cotangent_bundle_are_symplectic() {
    let random = &mut Random::new(51);
    for _ in 0..5 {
        let pendulum = Pendulum::<Dual<6>> { inertia: Dual::constant(1.2), gravity: Dual::constant(3.0) };
        assert_symplectic(&pendulum, &random.unit::<3>(), &random.vector());
        let planet = Planet::<Dual<6>> { mass: Dual::constant(1.5) };
        assert_symplectic(&planet, &(random.vector::<3>() + Vector3::x() * 2.0), &random.vector());
        let neumann = Neumann::<Dual<8>> { stiffness: constant(&random.inertia()) };
        assert_symplectic(&neumann, &random.unit::<4>(), &random.vector());
        assert_symplectic(&body::<18>(random), &random.attitude(), &random.matrix());
        // other steps of bodies have the form of their momentum, below
        #[cfg(feature = "heavy")]
        {
            let GenericBody { mass_matrix, weight, center } = body::<18>(random);
            let first = FirstOrderBody { mass_matrix, weight, center };
            assert_symplectic(&first, &random.attitude(), &random.matrix());
            let composed = ComposedBody { mass_matrix, weight, center, skew: Dual::constant(0.1) };
            assert_symplectic(&composed, &random.attitude(), &random.matrix());
            let collocated = CollocatedBody { inertia: mass_matrix, weight, center };
            assert_symplectic(&collocated, &random.attitude(), &random.matrix());
        }
        let pendulum = CollocatedPendulum::<Dual<6>> { inertia: Dual::constant(1.2), gravity: Dual::constant(3.0) };
        assert_symplectic(&pendulum, &random.unit::<3>(), &random.vector());
        let charge = CollocatedCharge::<Dual<6>> { field: Dual::constant(1.5) };
        assert_symplectic(&charge, &(random.vector::<3>() + Vector3::x() * 2.0), &random.vector());
    }
}

/// D of (R, π) ↦ (R⁺, π⁺) where δR = R x^ and δπ = m are the directions at both ends, by a stepper and its states.
fn trivialised<S>(system: S, r: &Matrix3<f64>, pi: &Vector3<f64>) -> (SMatrix<f64, 6, 6>, Vector3<f64>)
where
    S: Clebsch<Scalar = Dual<6>, Configuration = SMatrix<Dual<6>, 3, 3>, Momentum = SVector<Dual<6>, 3>>,
{
    let direction = |k: usize| if k < 3 { r * hat(&Vector3::ith(k, 1.0)) } else { Matrix3::zeros() };
    let turned: SMatrix<Dual<6>, 3, 3> =
        SMatrix::from_fn(|i, j| Dual { value: r[(i, j)], derivatives: std::array::from_fn(|k| direction(k)[(i, j)]) });
    let stepper = system.into_stepper(Dual::constant(H)).expect("a regular body");
    let state = stepper.state(turned, variables(pi, 3)).expect("directions along the orbit");
    let next = stepper.step(&state).expect("a solvable step");
    let value = next.configuration().map(|entry| entry.value);
    let mut d = SMatrix::<f64, 6, 6>::zeros();
    for k in 0..6 {
        let derivative = next.configuration().map(|entry| entry.derivatives[k]);
        d.fixed_view_mut::<3, 1>(0, k).copy_from(&vee(&(value.transpose() * derivative)));
        d.fixed_view_mut::<3, 1>(3, k).copy_from(&next.momentum().map(|entry| entry.derivatives[k]));
    }
    (d, next.momentum().map(|entry| entry.value))
}

/// W(π) = (−π^, I; −I, 0).
fn form(pi: &Vector3<f64>) -> SMatrix<f64, 6, 6> {
    let mut w = SMatrix::<f64, 6, 6>::zeros();
    w.fixed_view_mut::<3, 3>(0, 0).copy_from(&-hat(pi));
    w.fixed_view_mut::<3, 3>(0, 3).fill_with_identity();
    w.fixed_view_mut::<3, 3>(3, 0).copy_from(&-Matrix3::identity());
    w
}

#[test]
fn steps_of_a_body_keep_the_symplectic_form_of_its_momentum() {
    let random = &mut Random::new(52);
    for _ in 0..20 {
        let (r, pi) = (random.attitude::<3>(), random.vector::<3>());
        let GenericBody { mass_matrix, weight, center } = body::<6>(random);
        let composed = ComposedBody { mass_matrix, weight, center, skew: Dual::constant(0.1) };
        let collocated = CollocatedBody { inertia: mass_matrix, weight, center };
        let steps = [
            trivialised(collocated, &r, &pi),
            trivialised(GenericBody { mass_matrix, weight, center }, &r, &pi),
            trivialised(FirstOrderBody { mass_matrix, weight, center }, &r, &pi),
            trivialised(composed, &r, &pi),
        ];
        for (d, next) in steps {
            assert_near(&(d.transpose() * form(&next) * d), &form(&pi), NEAR, "DᵀW(π⁺)D = W(π)");
            // the form with the opposite sign of the magnetic term is not conserved: the test can tell
            let opposite = distance(&(d.transpose() * form(&-next) * d), &form(&-pi));
            assert!(opposite > 1e-4, "{opposite:.1e}");
        }
    }
}

/// Without a potential the momentum alone steps, and Dπ^Dᵀ = π⁺^.
#[test]
fn steps_of_a_free_body_are_lie_poisson() {
    let random = &mut Random::new(53);
    for _ in 0..20 {
        let free = GenericBody { weight: Dual::constant(0.0), ..body::<3>(random) };
        let pi = random.vector::<3>();
        let stepper = free.into_stepper(Dual::constant(H)).expect("a regular body");
        let state = stepper.state(SMatrix::identity(), variables(&pi, 0)).expect("a state");
        let next = stepper.step(&state).expect("a solvable step");
        let d = jacobian::<3>(next.momentum().iter());
        let pi_next = next.momentum().map(|entry| entry.value);
        assert_near(&(d * hat(&pi) * d.transpose()), &hat(&pi_next), NEAR, "Dπ^Dᵀ = π⁺^");
    }
}

/// On the sphere (q, N) carry the Lie–Poisson structure of rigid motions, B = (0, q^; q^, N^): D B Dᵀ = B⁺.
#[test]
fn steps_on_the_sphere_are_poisson_in_configuration_and_momentum() {
    let random = &mut Random::new(54);
    for _ in 0..20 {
        let pendulum = Pendulum::<Dual<6>> { inertia: Dual::constant(0.8), gravity: Dual::constant(3.0) };
        let q = random.unit::<3>();
        let n = q.cross(&random.vector());
        let constants = pendulum.step_constants(Dual::constant(H)).expect("a regular pendulum");
        let (at, momentum) = (variables::<6, 3, 1>(&q, 0), variables(&n, 3));
        let impulse = pendulum.impulse(&constants, Dual::constant(0.0), &at, &momentum);
        let (next, next_momentum, _) =
            pendulum.step(&constants, Dual::constant(0.0), &at, &momentum, &impulse, &()).expect("a solvable step");
        let d = jacobian(next.iter().chain(next_momentum.iter()));
        let bracket = |q: Vector3<f64>, n: Vector3<f64>| {
            let mut b = SMatrix::<f64, 6, 6>::zeros();
            b.fixed_view_mut::<3, 3>(0, 3).copy_from(&hat(&q));
            b.fixed_view_mut::<3, 3>(3, 0).copy_from(&hat(&q));
            b.fixed_view_mut::<3, 3>(3, 3).copy_from(&hat(&n));
            b
        };
        let after = bracket(next.map(|entry| entry.value), next_momentum.map(|entry| entry.value));
        assert_near(&(d * bracket(q, n) * d.transpose()), &after, NEAR, "D B Dᵀ = B⁺");
    }
}

/// The derivatives of the generated step are those of its values: central differences, to their own accuracy of 1e-9.
#[test]
fn dual_numbers_give_the_derivatives_of_the_step() {
    let random = &mut Random::new(55);
    let (r, pi) = (random.attitude::<3>(), random.vector::<3>());
    let dual = body::<6>(random);
    let plain = GenericBody::<f64> {
        mass_matrix: dual.mass_matrix.map(|entry| entry.value),
        weight: dual.weight.value,
        center: dual.center.map(|entry| entry.value),
    };
    let (d, _) = trivialised(dual, &r, &pi);
    let stepper = plain.into_stepper(H).expect("a regular body");
    let end = |pi: Vector3<f64>| stepper.step(&stepper.state(r, pi).expect("a state")).expect("a step");
    let epsilon = 1e-5;
    for k in 0..3 {
        let (plus, minus) = (end(pi + Vector3::ith(k, epsilon)), end(pi - Vector3::ith(k, epsilon)));
        let slope = (plus.momentum() - minus.momentum()) / (2.0 * epsilon);
        assert_near(&slope, &d.fixed_view::<3, 1>(3, 3 + k).into(), 1e-9, "∂π⁺/∂π");
    }
}
