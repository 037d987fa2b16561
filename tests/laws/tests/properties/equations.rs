//! Implicit equations, transforms and flows: each against the equation that it solves.

use crate::arbitrary::{cases, definite, vector};
use crate::runner::proptest;
use clebsch::__private as private;
use clebsch::Error;
use clebsch::implicit::{self, Equation, LinearEquation};
use clebsch_tests::oracle::near::assert_near;
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use private::{
    GradientFour, GradientSix, Kicks, OfOrderEight, OfOrderFour, OfOrderSix, Orientation, PlainFour, PlainSix, Sizes,
    Stages, VelocityEquation,
};
use proptest::prelude::*;

/// Σ ξ + c |ξ|² ξ = μ: monotone, so that each μ has one solution, which is connected to 0. At most `MOST` iterations.
struct Cubic<const MOST: u32> {
    inertia: Matrix3<f64>,
    inverse: Matrix3<f64>,
    stiffness: f64,
}

impl<const MOST: u32> Cubic<MOST> {
    fn new(inertia: Matrix3<f64>, stiffness: f64) -> Self {
        Self { inertia, inverse: inertia.try_inverse().expect("definite"), stiffness }
    }
}

impl<const MOST: u32> Equation<f64, 3> for Cubic<MOST> {
    type Terms = Vector3<f64>;
    type Jacobian = Matrix3<f64>;

    fn prepare(&self, target: &Vector3<f64>) -> Vector3<f64> {
        *target
    }

    fn predict(&self, target: &Vector3<f64>) -> Vector3<f64> {
        self.inverse * target
    }

    fn linearize(&self, target: &Vector3<f64>, xi: &Vector3<f64>) -> (Vector3<f64>, Matrix3<f64>) {
        let square = xi.norm_squared();
        let residual = self.inertia * xi + xi * (self.stiffness * square) - target;
        let jacobian = self.inertia
            + Matrix3::identity() * (self.stiffness * square)
            + xi * xi.transpose() * (2.0 * self.stiffness);
        (residual, jacobian)
    }

    fn limit() -> Option<u32> {
        (MOST > 0).then_some(MOST)
    }
}

/// (q + ξ) − q = μ with a place q, whose rounding is that of the residual. `TELLS` whether the equation tells its extent.
struct Placed<const TELLS: bool>(f64);

impl<const TELLS: bool> Equation<f64, 1> for Placed<TELLS> {
    type Terms = f64;
    type Jacobian = SMatrix<f64, 1, 1>;

    fn prepare(&self, target: &SVector<f64, 1>) -> f64 {
        target.x
    }

    fn predict(&self, target: &SVector<f64, 1>) -> SVector<f64, 1> {
        *target
    }

    fn linearize(&self, target: &f64, xi: &SVector<f64, 1>) -> (SVector<f64, 1>, SMatrix<f64, 1, 1>) {
        (SVector::from([((self.0 + xi.x) - self.0) - target]), SMatrix::identity())
    }

    fn extent(&self) -> f64 {
        if TELLS { private::extent(&Vector3::new(0.0, self.0, 1.0)) } else { 0.0 }
    }
}

/// ξ/(1 − ξ²) = μ, whose branch from 0 ends at the poles ±1 for μ = ±∞; predicted anywhere.
struct Pole(f64);

impl Equation<f64, 1> for Pole {
    type Terms = f64;
    type Jacobian = SMatrix<f64, 1, 1>;

    fn prepare(&self, target: &SVector<f64, 1>) -> f64 {
        target.x
    }

    fn predict(&self, _: &SVector<f64, 1>) -> SVector<f64, 1> {
        SVector::from([self.0])
    }

    fn linearize(&self, target: &f64, xi: &SVector<f64, 1>) -> (SVector<f64, 1>, SMatrix<f64, 1, 1>) {
        let (x, rest) = (xi.x, (1.0 - xi.x) * (1.0 + xi.x));
        (SVector::from([x / rest - target]), SMatrix::from([[(1.0 + x * x) / (rest * rest)]]))
    }

    fn has_poles() -> bool {
        true
    }
}

/// The same with the provided methods: no prediction, and a computed orientation.
struct Provided(Cubic<0>);

impl Equation<f64, 3> for Provided {
    type Terms = Vector3<f64>;
    type Jacobian = Matrix3<f64>;

    fn prepare(&self, target: &Vector3<f64>) -> Vector3<f64> {
        self.0.prepare(target)
    }

    fn linearize(&self, target: &Vector3<f64>, xi: &Vector3<f64>) -> (Vector3<f64>, Matrix3<f64>) {
        self.0.linearize(target, xi)
    }
}

/// (A + μ_1 B) ξ = μ, with B skew: regular for every μ.
struct Affine {
    a: Matrix3<f64>,
    b: Matrix3<f64>,
}

impl LinearEquation<f64, 3> for Affine {
    fn system(&self, target: &Vector3<f64>) -> (Matrix3<f64>, Vector3<f64>) {
        (self.a + self.b * target.x, *target)
    }
}

/// ℓ(ξ) = ½ ξ·Σξ + ¼ c |ξ|⁴, convex.
struct Quartic(Cubic<0>);

impl Quartic {
    fn value(&self, xi: &Vector3<f64>) -> f64 {
        xi.dot(&(self.0.inertia * xi)) / 2.0 + self.0.stiffness * xi.norm_squared().powi(2) / 4.0
    }
}

impl VelocityEquation<f64, 3> for Quartic {
    fn linearize(&self, xi: &Vector3<f64>) -> (f64, Vector3<f64>, Matrix3<f64>) {
        let (gradient, hessian) = self.0.linearize(&Vector3::zeros(), xi);
        (self.value(xi), gradient, hessian)
    }
}

/// Rounding of the terms of the equation; there are about ten.
fn rounding(mu: &Vector3<f64>) -> f64 {
    32.0 * f64::EPSILON * mu.amax()
}

/// q″ = −ω²q as (q, p): its flow over a time.
fn oscillation(omega: f64, time: f64, (q, p): (f64, f64)) -> (f64, f64) {
    let (sine, cosine) = (omega * time).sin_cos();
    (q * cosine + p * sine / omega, p * cosine - q * sine * omega)
}

/// Half kick, drift, half kick.
fn leapfrog(omega: f64, h: f64, (q, p): (f64, f64)) -> (f64, f64) {
    let p = p - h / 2.0 * omega * omega * q;
    let q = q + h * p;
    (q, p - h / 2.0 * omega * omega * q)
}

fn apart(a: (f64, f64), b: (f64, f64)) -> f64 {
    (a.0 - b.0).abs().max((a.1 - b.1).abs())
}

/// A map of (q, p) for a step size.
type Flow<'a> = dyn Fn(f64, (f64, f64)) -> (f64, f64) + 'a;

/// The errors of steps of h and of h/2 as maps, in units of the amplitude. The next term of the error is of h² relative
/// to the first.
fn assert_order(flow: &Flow, omega: f64, h: f64, order: i32) {
    let from = |h: f64, start| {
        let ((q, p), exact) = (flow(h, start), oscillation(omega, h, start));
        apart((omega * q, p), (omega * exact.0, exact.1))
    };
    let error = |h: f64| from(h, (1.0 / omega, 0.0)).max(from(h, (0.0, 1.0)));
    let slope = (error(h) / error(h / 2.0)).log2();
    assert!((slope - f64::from(order + 1)).abs() < 0.4, "{slope} for {order} + 1");
}

/// A composed step of leapfrogs. The impulse for the next step is scaled by the ratio of their sizes: the last is as
/// long as the first.
fn composed<const K: usize>(sizes: &[f64; K], omega: f64, h: f64, start: (f64, f64)) -> (f64, f64) {
    let all = Stages::new(h, sizes, |h: f64| Ok(h)).expect("constants");
    // each stage rounds a ratio and a product
    let rounding = K as f64 * f64::EPSILON;
    let step = |h: &f64, _, (q, p, length): (f64, f64, f64)| {
        assert!((length - h).abs() <= rounding * h.abs(), "{length} is not {h}");
        let (q, p) = leapfrog(omega, *h, (q, p));
        Ok::<_, Error>((q, p, length))
    };
    let first = h * sizes[0];
    let scaled = |(q, p, length): (f64, f64, f64), ratio| (q, p, length * ratio);
    let (q, p, length) = private::compose(&all, 0.0, (start.0, start.1, first), step, scaled).expect("steps");
    assert!((length - first).abs() < 1e-14 * first.abs());
    (q, p)
}

/// So many steps of this size at once.
type Steps<'a> = dyn Fn(f64, usize, (f64, f64)) -> (f64, f64) + 'a;

/// Steps with these kicks, of V = ½ω²q² with {V, {V, T}} = ω⁴q².
macro_rules! splitting {
    ($kicks:ident, $omega:ident) => {
        |h: f64, steps: usize, start: (f64, f64)| {
            let square = $omega * $omega;
            let drift = |part: f64, (q, p): (f64, f64)| Ok((q + part * h * p, p));
            let kick = |_: f64, b: f64, g: f64, (q, p): (f64, f64)| {
                (q, p - b * h * square * q + 2.0 * g * h.powi(3) * square * square * q)
            };
            private::split(&$kicks::KICKS, (0.0, h, steps), start, drift, kick, |state| state, |_| Ok(()))
                .expect("drifts do not fail")
        }
    };
}

proptest! {
    #![proptest_config(cases(128))]

    /// Newton's method and fixed points both end at the rounding of the equation, and so does Newton's method without a prediction.
    #[test]
    fn equations_are_solved_to_rounding(inertia in definite::<3>(), stiffness in 0.0_f64..0.5, mu in vector::<3>(3.0)) {
        let equation = Cubic::<0>::new(inertia, stiffness);
        let provided = Provided(Cubic::new(inertia, stiffness));
        prop_assert_eq!(Equation::<f64, 3>::predict(&provided, &mu), Vector3::zeros());
        let solutions = [implicit::solve(&equation, &mu)?, implicit::solve_fixed_point(&equation, &mu)?, implicit::solve(&provided, &mu)?];
        for xi in solutions {
            let terms = equation.prepare(&mu);
            prop_assert!(equation.residual(&terms, &xi).amax() <= rounding(&mu), "{:e}", equation.residual(&terms, &xi).amax());
            prop_assert_eq!(equation.residual(&terms, &xi), equation.linearize(&terms, &xi).0);
        }
        // a definite Jacobian; a correction solves it
        let (_, jacobian) = equation.linearize(&mu, &solutions[0]);
        let (correction, sign) = <Cubic<0> as Equation<f64, 3>>::correct(&jacobian, &mu).expect("definite");
        prop_assert!((jacobian * correction - mu).amax() <= rounding(&mu));
        prop_assert_eq!((sign, equation.orientation(), implicit::orientation(&equation)), (Orientation::POSITIVE, Some(Orientation::POSITIVE), Ok(Orientation::POSITIVE)));
        prop_assert_eq!(<Cubic<0> as Equation<f64, 3>>::tolerance(), f64::EPSILON / 4.0);
    }

    /// Wherever the predictor is, except at a pole itself, the result solves the equation.
    #[test]
    fn poles_are_no_solutions(mu in -50.0_f64..50.0, start in prop_oneof![-0.99_f64..0.99, 1.01_f64..1.5, -1.5_f64..-1.01]) {
        prop_assert!(<Pole as Equation<f64, 1>>::has_poles());
        let xi = implicit::solve(&Pole(start), &SVector::from([mu]))?.x;
        let missed = (xi / ((1.0 - xi) * (1.0 + xi)) - mu).abs();
        prop_assert!(missed <= 1e-11 * (1.0 + mu * mu), "{} at {}", missed, xi);
    }

    /// With two iterations at most a step is solved, or is said not to be.
    #[test]
    fn iterations_have_a_limit(inertia in definite::<3>(), stiffness in 0.0_f64..0.5, mu in vector::<3>(3.0)) {
        let exact = implicit::solve(&Cubic::<0>::new(inertia, stiffness), &mu)?;
        let bounded = Cubic::<2>::new(inertia, stiffness);
        prop_assert_eq!(<Cubic<2> as Equation<f64, 3>>::limit(), Some(2));
        match implicit::solve(&bounded, &mu) {
            Ok(xi) => assert_near(&xi, &exact, 1e-14, "in two iterations"),
            Err(error) => {
                let is_said = matches!(error, Error::NotConverged { iterations, .. } if iterations <= 2);
                prop_assert!(is_said, "{error}");
            }
        }
    }

    /// A solution below the rounding of places is found where the equation tells their size, 1 + |q|.
    #[test]
    fn places_have_a_rounding(q in 1e3_f64..1e6, part in 0.3_f64..0.7) {
        prop_assert_eq!(private::extent(&Vector3::new(0.0, -q, 1.0)), 1.0 + q);
        prop_assert_eq!(Cubic::<0>::new(Matrix3::identity(), 0.1).extent(), 0.0);
        let rounding = f64::EPSILON * (1.0 + q);
        let mu = SVector::from([part * f64::EPSILON * q / 2.0]);
        let found = implicit::solve(&Placed::<true>(q), &mu)?;
        prop_assert!((found - mu).amax() <= 8.0 * rounding);
        prop_assert!(implicit::solve(&Placed::<false>(q), &mu).is_err());
    }

    #[test]
    fn tolerances_end_at_rounding(part in -20.0_f64..-1.0) {
        let part = 10.0_f64.powf(part);
        prop_assert_eq!(private::tolerance::<f64>(part), part.max(f64::EPSILON / 4.0));
        prop_assert_eq!(private::tolerance::<f32>(part), (part as f32).max(f32::EPSILON / 4.0));
    }

    #[test]
    fn affine_equations_take_one_elimination(a in definite::<3>(), axis in vector::<3>(1.0), mu in vector::<3>(3.0)) {
        let equation = Affine { a, b: axis.cross_matrix() };
        let xi = private::solve_linear_equation(&equation, &mu)?;
        let (matrix, target) = LinearEquation::system(&equation, &mu);
        // |A| grows like |μ||b|, and |ξ| is at most 2|μ|
        prop_assert!((matrix * xi - target).amax() <= rounding(&mu) * (1.0 + matrix.amax() * 2.0));
        let (again, sign) = <Affine as LinearEquation<f64, 3>>::correct(&matrix, &target).expect("regular");
        prop_assert_eq!((again, Some(sign)), (xi, LinearEquation::orientation(&equation)));
    }

    /// Fenchel and Young: ℓ*(μ) + ℓ(ξ) ≥ μ·ξ for every ξ, with equality where ∂ℓ/∂ξ = μ.
    #[test]
    fn transforms_obey_fenchel_and_young(
        inertia in definite::<3>(), stiffness in 0.0_f64..2.0, xi in vector::<3>(2.0), other in vector::<3>(2.0),
    ) {
        let lagrangian = Quartic(Cubic::new(inertia, stiffness));
        let (value, mu, _) = VelocityEquation::linearize(&lagrangian, &xi);
        let transform = private::legendre_fenchel(&lagrangian, &mu);
        let size = 1.0 + mu.dot(&xi).abs();
        prop_assert!((transform + value - mu.dot(&xi)).abs() <= 32.0 * f64::EPSILON * size);
        prop_assert!(transform + lagrangian.value(&other) - mu.dot(&other) >= -32.0 * f64::EPSILON * size);
        if stiffness == 0.0 {
            prop_assert!((transform - private::kinetic_energy_at(&inertia, &mu)).abs() <= 32.0 * f64::EPSILON * size);
        }
    }

    /// An oscillator with two degrees of freedom, whose flow is known in closed form; 16 orders leave rounding over a radian.
    #[test]
    fn collocation_follows_linear_equations(omega in 0.1_f64..2.0, nu in 0.1_f64..2.0, h in -0.5_f64..0.5, start in vector::<4>(1.0)) {
        prop_assume!(h.abs() > 1e-3);
        let [q, r, p, s]: [f64; 4] = start.into();
        let slope = |_: f64, &[]: &[f64; 0], y: &[f64; 4]| [y[2], y[3], -omega * omega * y[0], -nu * nu * y[1]];
        let change = private::collocate::<_, 4, 0, 8, 4>(&private::GAUSS_16, (0.0, h), &[q, r, p, s], (0.0, private::SWEEPS), |_| [q, r, p, s], |_| [], slope)?;
        let (first, second) = (oscillation(omega, h, (q, p)), oscillation(nu, h, (r, s)));
        let found = (SVector::from(change) + start).into();
        let [q, r, p, s]: [f64; 4] = found;
        prop_assert!(apart((q, p), first) < 1e-14 && apart((r, s), second) < 1e-14, "{found:?}");
    }

    /// Halving the step divides the error by 2ᵖ⁺¹; backwards undoes it.
    #[test]
    fn compositions_have_their_orders(omega in 0.5_f64..1.5, part in 0.6_f64..1.0, start in vector::<2>(1.0)) {
        let start = (start.x, start.y);
        let check = |composed: &Flow, h: f64, order: i32| {
            assert_order(composed, omega, h, order);
            assert!(apart(composed(-h, composed(h, start)), start) < 1e-13);
        };
        check(&|h, state| composed(&OfOrderFour::SIZES, omega, h, state), 0.4 * part / omega, 4);
        check(&|h, state| composed(&OfOrderSix::SIZES, omega, h, state), 0.6 * part / omega, 6);
        check(&|h, state| composed(&OfOrderEight::SIZES, omega, h, state), 0.8 * part / omega, 8);
    }

    /// A composed step is its stages one after the other, each from where and when the last ended.
    #[test]
    fn compositions_are_their_stages(omega in 0.5_f64..1.5, h in 0.01_f64..0.5, t in -1.0_f64..1.0) {
        let all = Stages::new(h, &OfOrderSix::SIZES, |h: f64| Ok(h))?;
        prop_assert_eq!(all.whole, h);
        let times = std::cell::RefCell::new(vec![]);
        let step = |h: &f64, t: f64, state| {
            times.borrow_mut().push(t);
            Ok::<_, Error>(leapfrog(omega, *h, state))
        };
        let whole = private::compose(&all, t, (1.0, 0.5), step, |state, _| state)?;
        let mut state = (1.0, 0.5);
        for number in 0..11 {
            let stage = all.stage(number);
            prop_assert!((times.borrow()[number] - t - stage.start).abs() < 1e-15);
            state = leapfrog(omega, *stage.constants, state);
        }
        prop_assert_eq!(state, whole);
        prop_assert_eq!(times.borrow().len(), 11);
    }

    /// Splittings of an oscillator, with and without force gradients: steps at once are steps one by one; and errors of h⁵ and h⁷.
    #[test]
    fn splittings_have_their_orders(omega in 0.5_f64..1.5, part in 0.6_f64..1.0, start in vector::<2>(1.0), steps in 1_usize..5) {
        let start = (start.x, start.y);
        let check = |stepped: &Steps, h: f64, order: i32| {
            assert_order(&|h, state| stepped(h, 1, state), omega, h, order);
            let one_by_one = (0..steps).fold(start, |state, _| stepped(h, 1, state));
            assert!(apart(stepped(h, steps, start), one_by_one) < 1e-13);
            assert!(apart(stepped(-h, 1, stepped(h, 1, start)), start) < 1e-13);
        };
        check(&splitting!(GradientFour, omega), 0.8 * part / omega, 4);
        check(&splitting!(PlainFour, omega), 0.6 * part / omega, 4);
        // in longer steps the terms of order 8 are as large
        check(&splitting!(GradientSix, omega), 0.5 * part / omega, 6);
        check(&splitting!(PlainSix, omega), 0.8 * part / omega, 6);
    }
}
