//! Derivatives of steps and of their discrete Lagrangians: against central differences, and by the rules of linear maps.
//!
//! Differences are taken over 2·10⁻⁵. The third derivatives of numbers of order one are of order 1/h there, which
//! leaves some 10⁻⁹, and rounding divided by h 10⁻¹⁰.

use crate::arbitrary::{attitude, cases, matrix, rotation, vector};
use crate::bodies::{H, particles, tops};
use crate::runner::proptest;
use clebsch::__private as private;
use clebsch::{Carried, Clebsch, Momenta, Sensitive, Sensitivity, Space, State, Tangent, Variation, Variational};
use clebsch_tests::fixtures::watched_top::WatchedTop;
use clebsch_tests::oracle::near::assert_near;
use clebsch_tests::oracle::rotation::{hat, vee};
use clebsch_tests::stepping::Stepping;
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use private::{Link, Price};
use proptest::prelude::*;

const STEP: f64 = 1e-5;
/// The error of differences.
const DIFFERENCE: f64 = 1e-7;
/// Rounding of a few dozen products of numbers of order one, divided by h.
const NEAR: f64 = 1e-12;

fn exponential(eta: &Vector3<f64>) -> Matrix3<f64> {
    private::exponential(&hat(eta))
}

/// The derivative by s at s = 0.
fn slope<const R: usize, const C: usize>(f: impl Fn(f64) -> SMatrix<f64, R, C>) -> SMatrix<f64, R, C> {
    (f(STEP) - f(-STEP)) / (2.0 * STEP)
}

/// η of a rotation that moves to another in s, seen from where it is.
fn motion(r: impl Fn(f64) -> Matrix3<f64>) -> Vector3<f64> {
    vee(&(r(0.0).transpose() * slope(r)))
}

fn zero_tangent() -> Tangent<f64, 3> {
    let zero = Matrix3::zeros();
    Tangent { motion_by_motion: zero, motion_by_momentum: zero, momentum_by_motion: zero, momentum_by_momentum: zero }
}

/// A linear map from four blocks, and the same as one matrix.
fn tangents() -> BoxedStrategy<(Tangent<f64, 3>, SMatrix<f64, 6, 6>)> {
    let of = |a: SMatrix<f64, 6, 6>| {
        let block = |i: usize, j: usize| a.fixed_view::<3, 3>(3 * i, 3 * j).into_owned();
        let tangent = Tangent {
            motion_by_motion: block(0, 0),
            motion_by_momentum: block(0, 1),
            momentum_by_motion: block(1, 0),
            momentum_by_momentum: block(1, 1),
        };
        (tangent, a)
    };
    matrix::<6, 6>(1.0).prop_map(of).boxed()
}

fn whole(variation: &Variation<f64, 3>) -> SVector<f64, 6> {
    private::pair(&variation.motion, &variation.momentum)
}

fn parts(v: &SVector<f64, 6>) -> Variation<f64, 3> {
    Variation { motion: v.fixed_rows::<3>(0).into_owned(), momentum: v.fixed_rows::<3>(3).into_owned() }
}

/// The top with one of its quantities changed: three masses, the weight, and the step size.
fn changed(top: &WatchedTop, quantity: usize, by: f64) -> (WatchedTop, f64) {
    let mut top = top.clone();
    match quantity {
        3 => top.weight += by,
        4 => return (top, H + by),
        _ => top.mass[quantity] += by,
    }
    (top, H)
}

/// So many steps of a top that is changed.
fn stepped(
    top: &WatchedTop,
    quantity: usize,
    by: f64,
    start: &(Matrix3<f64>, Vector3<f64>),
    steps: usize,
) -> State<WatchedTop> {
    let (top, h) = changed(top, quantity, by);
    let stepper = top.into_stepper(h).expect("regular");
    stepper.advance(&stepper.state(start.0, start.1).expect("a state"), steps).expect("steps")
}

proptest! {
    #![proptest_config(cases(32))]

    /// Tangent maps are matrices: apply, the transposed, composition and the identity.
    #[test]
    fn tangent_maps_are_linear((one, a) in tangents(), (other, b) in tangents(), v in vector::<6>(1.0), w in vector::<6>(1.0)) {
        let near = 1e-14;
        assert_near(&whole(&one.apply(&parts(&v))), &(a * v), near, "apply");
        let pulled = one.apply_transposed(&parts(&w));
        prop_assert!((whole(&pulled).dot(&v) - w.dot(&whole(&one.apply(&parts(&v))))).abs() < near, "the adjoint");
        assert_near(&whole(&one.then(&other).apply(&parts(&v))), &(b * (a * v)), 4.0 * near, "composition");
        prop_assert_eq!(Tangent::identity().apply(&parts(&v)), parts(&v));
        prop_assert_eq!(Tangent::identity().then(&one), one);
        prop_assert_eq!(zero_tangent().apply(&parts(&v)), parts(&SVector::zeros()));
        let (zero, of_step) = (Sensitivity::<f64, 3, 6>::zero(), Sensitivity { motion: a.fixed_view::<3, 6>(0, 0).into_owned(), momentum: a.fixed_view::<3, 6>(3, 0).into_owned() });
        prop_assert_eq!(zero.after(&one, &of_step), of_step);
        let after = of_step.after(&other, &zero);
        assert_near(&whole(&Variation { motion: after.motion * v, momentum: after.momentum * v }), &(b * (a * v)), 4.0 * near, "the chain rule");
    }

    /// The tangent map of a step against differences of the step, and that of two steps as a composition.
    #[test]
    fn tangent_maps_are_differences(top in tops(), r in attitude(), mu in vector::<3>(1.0), eta in vector::<3>(1.0), nu in vector::<3>(1.0)) {
        let stepper = top.stepper(H)?;
        let moved = |s: f64, steps: usize| {
            let state = stepper.state(r * exponential(&(eta * s)), mu + nu * s).expect("a state");
            stepper.advance(&state, steps).expect("steps")
        };
        let (next, tangent) = stepper.step_tangent(&stepper.state(r, mu)?)?;
        prop_assert_eq!(stepper.step_tangent_with(&stepper.state(r, mu)?, &())?, (next, tangent));
        let (last, second) = stepper.step_tangent(&next)?;
        prop_assert!(Space::<f64>::distance_squared(&last.momentum(), &moved(0.0, 2).momentum()) < NEAR * NEAR);
        for (steps, map) in [(1, tangent), (2, tangent.then(&second))] {
            let found = map.apply(&Variation { motion: eta, momentum: nu });
            assert_near(&found.motion, &motion(|s| *moved(s, steps).configuration()), DIFFERENCE, "η′");
            assert_near(&found.momentum, &slope(|s| moved(s, steps).momentum()), DIFFERENCE, "ν′");
        }
        assert_near(&stepper.infinitesimal_motion(&r, &eta), &(r * hat(&eta)), NEAR, "η_Q(q)");
    }

    /// Sensitivities to parameters and to the step size against differences, over two steps.
    #[test]
    fn sensitivities_are_differences(top in tops(), r in attitude(), mu in vector::<3>(1.0), quantity in 0_usize..5) {
        let stepper = top.stepper(H)?;
        let start = stepper.state(r, mu)?;
        let (next, _, first) = stepper.step_sensitivity::<5>(&start)?;
        let (again, _, same) = stepper.step_sensitivity_with::<5>(&start, &())?;
        prop_assert_eq!((again, same), (next, first));
        let (_, tangent, second) = stepper.step_sensitivity::<5>(&next)?;
        for (steps, found) in [(1, first), (2, first.after(&tangent, &second))] {
            let at = |s: f64| stepped(&top, quantity, s, &(r, mu), steps);
            assert_near(&found.motion.column(quantity).into_owned(), &motion(|s| *at(s).configuration()), DIFFERENCE, "∂η");
            assert_near(&found.momentum.column(quantity).into_owned(), &slope(|s| at(s).momentum()), DIFFERENCE, "∂N");
        }
        prop_assert_eq!(<WatchedTop as Sensitive<3, 5>>::QUANTITIES[4], "h");
    }

    /// Increments: τ(η) and τ(−η) undo each other, two after the other are composed, and the drift is the inverse of F⁻ℓd.
    #[test]
    fn increments_are_those_of_the_group(top in tops(), r in attitude(), mu in vector::<3>(1.0), eta in vector::<3>(1.0), zeta in vector::<3>(1.0)) {
        let constants = top.step_constants(H)?;
        let [ahead, back] = top.retractions(&eta);
        let of = |d: &Matrix3<f64>| private::from_increment(d);
        prop_assert_eq!(top.retraction(&eta), ahead);
        assert_near(&(of(&ahead) * of(&back)), &Matrix3::identity(), NEAR, "τ(η)τ(−η)");
        assert_near(&slope(|s| top.retraction(&(eta * s))), &hat(&eta), DIFFERENCE, "dτ = id");
        let second = top.retraction(&zeta);
        assert_near(&of(&top.compose(&ahead, &second)), &(of(&ahead) * of(&second)), NEAR, "one after the other");
        let twice = top.advance(&top.advance(&r, &ahead), &second);
        assert_near(&twice, &top.act(&of(&top.compose(&ahead, &second)), &r), NEAR, "Φ");
        let d = top.drift(&constants, 0, 0.0, &r, &mu, &())?;
        assert_near(&of(&d), &top.inverse_legendre(&constants, 0.0, &r, &mu)?, NEAR, "the drift");
        // the metric of R ↦ Rη^, and the motion to a target
        let metric = top.orbit_metric(&r);
        let paired = (top.infinitesimal_motion(&r, &eta).transpose() * top.infinitesimal_motion(&r, &zeta)).trace();
        prop_assert!((eta.dot(&(metric * zeta)) - paired).abs() < NEAR);
        assert_near(&top.approach(&r, &twice), &top.momentum_map(&r, &(twice - r)), NEAR, "Gᵀ(q* − q)");
    }

    /// An edge: dℓd = F⁺ℓd·η′ − F⁻ℓd·η. The derivatives of both momenta are along motions of the start, of the end, and
    /// of both with F as it is.
    #[test]
    fn edges_are_differentiated_twice(top in tops(), r in attitude(), f in rotation(0.3), eta in vector::<3>(1.0)) {
        let constants = top.step_constants(H)?;
        let d = f - Matrix3::identity();
        let at = |start: f64, end: f64| -> Momenta<f64, 3> {
            let q = r * exponential(&(eta * start));
            let next = r * f * exponential(&(eta * end));
            top.momenta(&constants, 0, 0.0, (&q, &(q.transpose() * next - Matrix3::identity()), &next, &()))
        };
        let carried_along = |s: f64| {
            let q = r * exponential(&(eta * s));
            top.momenta(&constants, 0, 0.0, (&q, &d, &(q * f), &()))
        };
        let edge = top.edge(&constants, 0, 0.0, (&r, &d, &(r * f), &()));
        let momenta = at(0.0, 0.0);
        assert_near(&edge.before, &momenta.before, NEAR / H, "F⁻ℓd");
        assert_near(&edge.after, &momenta.after, NEAR / H, "F⁺ℓd");
        assert_near(&edge.before, &top.legendre(H, 0.0, &r, &f), NEAR / H, "F⁻ℓd");
        assert_near(&edge.after, &top.legendre_next(H, 0.0, &r, &f), NEAR / H, "F⁺ℓd");
        let lagrangian = |m: Momenta<f64, 3>| SMatrix::<f64, 1, 1>::new(m.lagrangian);
        prop_assert!((lagrangian(momenta)[0] - edge.lagrangian).abs() < NEAR / H);
        // momenta are of the size of inertia/h, and so are the errors of differences
        let near = DIFFERENCE / H;
        prop_assert!((slope(|s| lagrangian(at(s, 0.0)))[0] + edge.before.dot(&eta)).abs() < near);
        prop_assert!((slope(|s| lagrangian(at(0.0, s)))[0] - edge.after.dot(&eta)).abs() < near);
        assert_near(&(edge.before_by_start * eta), &slope(|s| at(s, 0.0).before), near, "∂F⁻ℓd/∂η");
        assert_near(&(edge.before_by_end * eta), &slope(|s| at(0.0, s).before), near, "∂F⁻ℓd/∂η′");
        assert_near(&(edge.after_by_start * eta), &slope(|s| at(s, 0.0).after), near, "∂F⁺ℓd/∂η");
        assert_near(&(edge.after_by_end * eta), &slope(|s| at(0.0, s).after), near, "∂F⁺ℓd/∂η′");
        let carried: Carried<f64, 3> = top.carried(&constants, 0, 0.0, (&r, &d, &(r * f), &()));
        assert_near(&carried.momentum, &edge.after, NEAR / H, "F⁺ℓd");
        assert_near(&carried.adjoint, &f.transpose(), NEAR, "Ad");
        assert_near(&(carried.before * eta), &slope(|s| carried_along(s).before), near, "∂F⁻ℓd/∂η at fixed F");
        assert_near(&(carried.after * eta), &slope(|s| carried_along(s).after), near, "∂F⁺ℓd/∂η at fixed F");
        assert_near(&carried.before_by_end, &edge.before_by_end, NEAR / H, "∂F⁻ℓd/∂η′");
        assert_near(&carried.after_by_end, &edge.after_by_end, NEAR / H, "∂F⁺ℓd/∂η′");
        let (before, after): (SMatrix<f64, 3, 5>, _) = top.edge_slopes(&constants, 0, 0.0, (&r, &d, &(r * f), &()));
        for quantity in 0..5 {
            let of = |s: f64| {
                let (top, h) = changed(&top, quantity, s);
                top.momenta(&top.step_constants(h).expect("regular"), 0, 0.0, (&r, &d, &(r * f), &()))
            };
            // along h they are of the size of inertia/h²
            let near = if quantity == 4 { near / H } else { near };
            assert_near(&before.column(quantity).into_owned(), &slope(|s| of(s).before), near, "slopes of F⁻ℓd");
            assert_near(&after.column(quantity).into_owned(), &slope(|s| of(s).after), near, "slopes of F⁺ℓd");
        }
    }

    /// c t + κ/2 |x − g|² with its derivatives.
    #[test]
    fn ends_have_a_price(particle in particles(), x in vector::<2>(1.0), t in 0.0_f64..3.0) {
        let end = particle.endpoint(t, &x);
        let miss = x - particle.goal;
        prop_assert!((end.price - particle.price * t - particle.pull * miss.norm_squared() / 2.0).abs() < 1e-14);
        prop_assert!((end.by_time - particle.price).abs() < 1e-15);
        assert_near(&end.slope, &(miss * particle.pull), 1e-14, "slope");
        assert_near(&end.curvature, &(SMatrix::identity() * particle.pull), 1e-14, "curvature");
    }

    /// A forced step by the implicit function theorem. Places move by the tangent map, and inputs as F⁻ℓd = N asks for.
    /// Second derivatives are those of the edge along them.
    #[test]
    fn links_are_implicit_functions(
        top in tops(), (r, f) in (attitude(), rotation(0.3)), (before, after) in (matrix::<3, 2>(1.0), matrix::<3, 2>(1.0)), costate in vector::<6>(1.0),
        (w, delta, u) in (matrix::<8, 8>(1.0), vector::<6>(1.0), vector::<2>(1.0)), (by_motion, by_input) in (vector::<3>(1.0), vector::<2>(1.0)),
    ) {
        let constants = top.step_constants(H)?;
        let edge = top.carried(&constants, 0, 0.0, (&r, &(f - Matrix3::identity()), &(r * f), &()));
        let link = Link::new(&edge, &before, &after, &costate).expect("regular");
        // κ makes α·η′ + β·F⁺ℓd + κ·F⁻ℓd stationary
        let stationary = edge.before_by_end.transpose() * link.multiplier + link.driving + edge.after_by_end.transpose() * link.costate;
        assert_near(&stationary, &Vector3::zeros(), NEAR / H, "stationary");
        prop_assert_eq!(private::pair::<f64, 3, 6>(&link.driving, &link.costate), costate);
        let curvature = w + w.transpose();
        let price = Price { price: 0.5, by_motion, by_input, motions: Matrix3::identity() * 2.0, mixed: SMatrix::zeros(), inputs: SMatrix::identity() * 3.0 };
        let found = link.expansion::<_, 8, 6>(r * f, &curvature, &Matrix3::zeros(), &price);
        prop_assert_eq!((found.next, found.price, found.price_by_input), (r * f, 0.5, by_input));
        assert_near(&found.price_by_place, &private::pair(&by_motion, &Vector3::zeros()), 0.0, "∂ℓ/∂x");
        // η′ = Ad η + ζ with ∂F⁻ℓd/∂η η + ∂F⁻ℓd/∂η′ ζ + ∂F⁻ℓd/∂u u = ν
        let (eta, nu) = (delta.fixed_rows::<3>(0).into_owned(), delta.fixed_rows::<3>(3).into_owned());
        let change: SVector<f64, 6> = found.by_place * delta + found.by_input * u;
        let zeta = change.fixed_rows::<3>(0) - edge.adjoint * eta;
        assert_near(&(edge.before * eta + edge.before_by_end * zeta + before * u), &nu, NEAR / H, "F⁻ℓd = N");
        let momentum = edge.after * eta + edge.after_by_end * zeta + after * u;
        assert_near(&change.fixed_rows::<3>(3).into_owned(), &momentum, NEAR / H, "N⁺ = F⁺ℓd");
        let all = SVector::<f64, 8>::from_iterator(eta.iter().chain(zeta.iter()).chain(u.iter()).copied());
        let expected = all.dot(&(curvature * all)) + 2.0 * eta.norm_squared() + 3.0 * u.norm_squared();
        let second = delta.dot(&(found.place_curvature * delta)) + 2.0 * u.dot(&(found.mixed_curvature * delta)) + u.dot(&(found.input_curvature * u));
        prop_assert!((second - expected).abs() < NEAR / H * (1.0 + expected.abs()), "{second} for {expected}");
        // a step of a place is a step of its state
        let stepper = top.stepper(H)?;
        let mu = by_motion;
        prop_assert_eq!(private::check_state(&top, &r, &mu), Ok(()));
        prop_assert!(private::check_state(&top, &(r * 2.0), &mu).is_err());
        let place = private::forced_step(&top, &constants, 0.0, &(r, mu), &())?;
        prop_assert_eq!(place, stepper.step(&stepper.state(r, mu)?)?.into_parts());
    }

    /// Prices and bounds of an edge are expanded along places and inputs as the motions of both ends and the inputs are.
    /// κ makes a price stationary in the end too, whose slope is the middle part of that along all directions.
    #[test]
    fn links_take_functions_of_the_edge(
        top in tops(), (r, f) in (attitude(), rotation(0.3)), (before, after) in (matrix::<3, 2>(1.0), matrix::<3, 2>(1.0)), costate in vector::<6>(1.0),
        (w, bend) in (matrix::<8, 8>(1.0), matrix::<8, 8>(1.0)), (along, slopes, z) in (vector::<8>(1.0), matrix::<2, 8>(1.0), vector::<2>(1.0)),
        (delta, u, values) in (vector::<6>(1.0), vector::<2>(1.0), vector::<2>(1.0)),
    ) {
        let constants = top.step_constants(H)?;
        let edge = top.carried(&constants, 0, 0.0, (&r, &(f - Matrix3::identity()), &(r * f), &()));
        let of_end: Vector3<f64> = private::along_end(&along);
        prop_assert_eq!(of_end, along.fixed_rows::<3>(3).into_owned());
        let pushed: Vector3<f64> = private::pushed_along_end(&slopes, &z);
        assert_near(&pushed, &(slopes.transpose() * z).fixed_rows::<3>(3).into_owned(), 1e-14, "z·a");
        let link = Link::priced(&edge, &before, &after, &costate, &of_end).expect("regular");
        let stationary = of_end + edge.before_by_end.transpose() * link.multiplier + link.driving + edge.after_by_end.transpose() * link.costate;
        assert_near(&stationary, &Vector3::zeros(), NEAR / H, "stationary");
        let (w, bend, none) = (w + w.transpose(), bend + bend.transpose(), Matrix3::zeros());
        let found = link.expansion_of_edge::<_, 8, 6>(r * f, &w, &none, (0.5, &along, &bend));
        prop_assert_eq!((found.next, found.price), (r * f, 0.5));
        // η and u as they are, and the motion ζ of the end alone
        let (eta, change) = (delta.fixed_rows::<3>(0).into_owned(), found.by_place * delta + found.by_input * u);
        let zeta = change.fixed_rows::<3>(0) - edge.adjoint * eta;
        let all = SVector::<f64, 8>::from_iterator(eta.iter().chain(zeta.iter()).chain(u.iter()).copied());
        let size = NEAR / H * (1.0 + all.norm_squared());
        let first = found.price_by_place.dot(&delta) + found.price_by_input.dot(&u);
        prop_assert!((first - along.dot(&all)).abs() < size, "{first} for {}", along.dot(&all));
        let second = |place: &SMatrix<f64, 6, 6>, mixed: &SMatrix<f64, 2, 6>, input: &SMatrix<f64, 2, 2>| {
            delta.dot(&(place * delta)) + 2.0 * u.dot(&(mixed * delta)) + u.dot(&(input * u))
        };
        let (bent, expected) = (second(&found.place_curvature, &found.mixed_curvature, &found.input_curvature), all.dot(&((w + bend) * all)));
        prop_assert!((bent - expected).abs() < 8.0 * size, "{bent} for {expected}");
        let bounds = link.bounds::<8, 6, 2>(values, &slopes, &bend);
        prop_assert_eq!(bounds.values, values);
        assert_near(&(bounds.by_place * delta + bounds.by_input * u), &(slopes * all), size, "∂a");
        let (bent, expected) = (second(&bounds.place_curvature, &bounds.mixed_curvature, &bounds.input_curvature), all.dot(&(bend * all)));
        prop_assert!((bent - expected).abs() < 8.0 * size, "{bent} for {expected}");
    }
}
