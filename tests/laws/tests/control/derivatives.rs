//! The derived formulas of the choice of inputs against differences of steps and prices, in exponential coordinates of
//! the places.

use clebsch::{Controlled, Space};
use clebsch_tests::fixtures::regulator::Regulator;
use clebsch_tests::fixtures::steered_body::SteeredBody;
use clebsch_tests::fixtures::unicycle::Unicycle;
use clebsch_tests::oracle::random::Random;
use nalgebra::{Matrix3, SMatrix, SVector, Vector1, Vector2, Vector3};

pub(super) const H: f64 = 0.1;
pub(super) const T: f64 = 0.3;

/// How places move in exponential coordinates, and back.
pub(super) struct Chart<X, const D: usize> {
    pub moved: fn(&X, &SVector<f64, D>) -> X,
    pub coordinates: fn(&X, &X) -> SVector<f64, D>,
}

/// exp A: the series of A/2⁸, squared eight times.
pub(super) fn exponential(a: &Matrix3<f64>) -> Matrix3<f64> {
    let scaled = a / 256.0;
    let (mut term, mut sum) = (Matrix3::identity(), Matrix3::identity());
    for k in 1..12 {
        term = term * scaled / f64::from(k);
        sum += term;
    }
    for _ in 0..8 {
        sum *= sum;
    }
    sum
}

/// log(I + E) of a small E.
pub(super) fn logarithm(e: &Matrix3<f64>) -> Matrix3<f64> {
    let mut power = *e;
    let mut sum = *e;
    for k in 2..=12 {
        power *= *e;
        sum += power * (if k % 2 == 0 { -1.0 } else { 1.0 } / f64::from(k));
    }
    sum
}

pub(super) fn check<S, const D: usize, const U: usize, const C: usize>(
    system: &S,
    chart: &Chart<S::Place, D>,
    x: &S::Place,
    random: &mut Random,
) where
    S: Controlled<D, U, C, Scalar = f64>,
    S::Place: Space<f64>,
{
    check_with(system, &|h| system.prepare(h).expect("regular parameters"), chart, x, random);
}

/// The same with the constants of a step size, and with their references.
pub(super) fn check_with<S, const D: usize, const U: usize, const C: usize>(
    system: &S,
    prepare: &dyn Fn(f64) -> S::Constants,
    chart: &Chart<S::Place, D>,
    x: &S::Place,
    random: &mut Random,
) where
    S: Controlled<D, U, C, Scalar = f64>,
    S::Place: Space<f64>,
{
    let constants = prepare(H);
    system.check_place(x).expect("a place");
    let (u, costate, z) = (random.vector::<U>(), random.vector::<D>(), random.vector::<C>());
    let expansion = system.expand(&constants, T, x, &u, &costate).expect("a step");
    assert!((chart.coordinates)(&system.follow(&constants, T, x, &u).expect("a step"), &expansion.next).amax() < 1e-14);
    assert!((expansion.price - system.price(&constants, T, x, &u).expect("a step")).abs() < 1e-14);

    // along w = (δ, δu)
    let moved = |delta: &SVector<f64, D>, du: &SVector<f64, U>| ((chart.moved)(x, delta), u + du);
    let next = |delta: &SVector<f64, D>, du: &SVector<f64, U>| {
        let (x, u) = moved(delta, du);
        (chart.coordinates)(&expansion.next, &system.follow(&constants, T, &x, &u).expect("a step"))
    };
    let price = |delta: &SVector<f64, D>, du: &SVector<f64, U>| {
        let (x, u) = moved(delta, du);
        SVector::<f64, 1>::new(system.price(&constants, T, &x, &u).expect("a step"))
    };
    let whole = |delta: &SVector<f64, D>, du: &SVector<f64, U>| {
        price(delta, du) + SVector::<f64, 1>::new(costate.dot(&next(delta, du)))
    };
    let bounds = |delta: &SVector<f64, D>, du: &SVector<f64, U>| {
        let (x, u) = moved(delta, du);
        system.bounds(&constants, T, &x, &u).expect("a step")
    };
    let name = S::NAME;
    for k in 0..D + U {
        let slope = first::<D, U, D>(&next, k);
        let (of_price, of_bounds) = (first::<D, U, 1>(&price, k)[0], first::<D, U, C>(&bounds, k));
        let expanded = system.bounds_expanded(&constants, T, x, &u, &z).expect("a step");
        let (column, price_slope, bound_slope) = match k.checked_sub(D) {
            None => (expansion.by_place.column(k), expansion.price_by_place[k], expanded.by_place.column(k)),
            Some(k) => (expansion.by_input.column(k), expansion.price_by_input[k], expanded.by_input.column(k)),
        };
        assert!((slope - column).amax() < 1e-8, "{name}: column {k}");
        assert!((of_price - price_slope).abs() < 1e-8, "{name}: slope {k} of the price");
        assert!(C == 0 || (of_bounds - bound_slope).amax() < 1e-8, "{name}: slope {k} of the bounds");
        for l in 0..D + U {
            let entry = |places: &SMatrix<f64, D, D>, mixed: &SMatrix<f64, U, D>, inputs: &SMatrix<f64, U, U>| match (
                k.checked_sub(D),
                l.checked_sub(D),
            ) {
                (None, None) => places[(k, l)],
                (Some(k), None) => mixed[(k, l)],
                (None, Some(l)) => mixed[(l, k)],
                (Some(k), Some(l)) => inputs[(k, l)],
            };
            let found = entry(&expansion.place_curvature, &expansion.mixed_curvature, &expansion.input_curvature);
            let expected = second::<D, U, 1>(&whole, k, l)[0];
            assert!((found - expected).abs() < 2e-5, "{name}: second derivative {k}, {l}: {found} is not {expected}");
            let found = entry(&expanded.place_curvature, &expanded.mixed_curvature, &expanded.input_curvature);
            let expected = second::<D, U, C>(&bounds, k, l).dot(&z);
            assert!((found - expected).abs() < 2e-5, "{name}: {k}, {l} of the bounds: {found} is not {expected}");
        }
    }
    of_time(system, prepare, x, &u, &costate, chart);
    of_end(system, &constants, x, chart);
    of_targets(system, x, chart);
    of_conditions(system, &constants, chart, x, &random.vector::<D>());
}

fn unit<const N: usize>(k: usize, step: f64) -> SVector<f64, N> {
    SVector::from_fn(|i, _| if i == k { step } else { 0.0 })
}

fn parts<const D: usize, const U: usize>(k: usize, step: f64) -> (SVector<f64, D>, SVector<f64, U>) {
    (unit(k, step), k.checked_sub(D).map_or(SVector::zeros(), |k| unit(k, step)))
}

type Function<'a, const D: usize, const U: usize, const R: usize> =
    dyn Fn(&SVector<f64, D>, &SVector<f64, U>) -> SVector<f64, R> + 'a;

fn first<const D: usize, const U: usize, const R: usize>(f: &Function<'_, D, U, R>, k: usize) -> SVector<f64, R> {
    let at = |step: f64| {
        let (delta, du) = parts(k, step);
        f(&delta, &du)
    };
    let h = 1e-3;
    (at(-2.0 * h) - at(2.0 * h) + (at(h) - at(-h)) * 8.0) / (12.0 * h)
}

fn second<const D: usize, const U: usize, const R: usize>(
    f: &Function<'_, D, U, R>,
    k: usize,
    l: usize,
) -> SVector<f64, R> {
    let h = 1e-3;
    let at = |a: f64, b: f64| {
        let ((d1, u1), (d2, u2)) = (parts::<D, U>(k, a), parts::<D, U>(l, b));
        f(&(d1 + d2), &(u1 + u2))
    };
    (at(h, h) - at(h, -h) - at(-h, h) + at(-h, -h)) / (4.0 * h * h)
}

/// d/dh (ℓ + λ·f) with t = t₀ + kh.
fn of_time<S, const D: usize, const U: usize, const C: usize>(
    system: &S,
    prepare: &dyn Fn(f64) -> S::Constants,
    x: &S::Place,
    u: &SVector<f64, U>,
    costate: &SVector<f64, D>,
    chart: &Chart<S::Place, D>,
) where
    S: Controlled<D, U, C, Scalar = f64>,
{
    let k = 3.0;
    let reference = system.follow(&prepare(H), T, x, u).expect("a step");
    let at = |step: f64| {
        let constants = prepare(H + step);
        let t = T + k * step;
        let next = system.follow(&constants, t, x, u).expect("a step");
        system.price(&constants, t, x, u).expect("a step") + costate.dot(&(chart.coordinates)(&reference, &next))
    };
    let expected = (at(1e-5) - at(-1e-5)) / 2e-5;
    let found = system.price_of_time(&prepare(H), T, k, x, u, costate).expect("a step");
    assert!((found - expected).abs() < 1e-7, "{}: {found} is not {expected}", S::NAME);
}

fn of_end<S, const D: usize, const U: usize, const C: usize>(
    system: &S,
    constants: &S::Constants,
    x: &S::Place,
    chart: &Chart<S::Place, D>,
) where
    S: Controlled<D, U, C, Scalar = f64>,
{
    let end = system.endpoint_expanded(constants, T, x);
    assert!((end.price - system.endpoint(constants, T, x)).abs() < 1e-14);
    let by_time = (system.endpoint(constants, T + 1e-5, x) - system.endpoint(constants, T - 1e-5, x)) / 2e-5;
    assert!((end.by_time - by_time).abs() < 1e-8);
    let price = |delta: &SVector<f64, D>, _: &SVector<f64, 0>| {
        SVector::<f64, 1>::new(system.endpoint(constants, T, &(chart.moved)(x, delta)))
    };
    for k in 0..D {
        assert!((first::<D, 0, 1>(&price, k)[0] - end.slope[k]).abs() < 1e-8);
        for l in 0..D {
            assert!((second::<D, 0, 1>(&price, k, l)[0] - end.curvature[(k, l)]).abs() < 1e-5);
        }
    }
}

/// slope·δ = residual and δ = displacement lead to targets, to first order.
fn of_targets<S, const D: usize, const U: usize, const C: usize>(system: &S, x: &S::Place, chart: &Chart<S::Place, D>)
where
    S: Controlled<D, U, C, Scalar = f64>,
{
    let delta = SVector::<f64, D>::from_fn(|i, _| 1e-6 * (1.0 + i as f64));
    let target = (chart.moved)(x, &delta);
    let arrival = system.arrival(x, &target);
    assert!((arrival.slope * delta - arrival.residual).amax() < 1e-10, "{}", S::NAME);
    assert!((system.displacement(x, &target) - delta).amax() < 1e-10, "{}", S::NAME);
}

/// The conditions of the end, with these multipliers.
fn of_conditions<S, const D: usize, const U: usize, const C: usize>(
    system: &S,
    constants: &S::Constants,
    chart: &Chart<S::Place, D>,
    x: &S::Place,
    multipliers: &SVector<f64, D>,
) where
    S: Controlled<D, U, C, Scalar = f64>,
{
    let (name, count) = (S::NAME, S::TARGET.len());
    let at = |t: f64, x: &S::Place| system.target_expanded(constants, t, x, multipliers);
    let expanded = at(T, x);
    assert!(expanded.slope.rows(count, D - count).iter().all(|slope| *slope == 0.0));
    assert!(expanded.values.iter().zip(&expanded.sizes).all(|(value, size)| value.abs() <= *size));
    let values = |t: f64, delta: &SVector<f64, D>| at(t, &(chart.moved)(x, delta)).values;
    let zero = SVector::zeros();
    let by_time = (values(T + 1e-5, &zero) - values(T - 1e-5, &zero)) / 2e-5;
    assert!((by_time - expanded.by_time).amax() < 1e-8, "{name}");
    let function = |delta: &SVector<f64, D>, _: &SVector<f64, 0>| values(T, delta);
    for j in 0..D {
        assert!((first::<D, 0, D>(&function, j) - expanded.slope.column(j)).amax() < 1e-8, "{name}: slope {j}");
    }
    let weighted =
        |delta: &SVector<f64, D>, _: &SVector<f64, 0>| SVector::<f64, 1>::new(multipliers.dot(&values(T, delta)));
    for (i, j) in (0..D).flat_map(|i| (0..D).map(move |j| (i, j))) {
        let (found, expected) = (expanded.curvature[(i, j)], second::<D, 0, 1>(&weighted, i, j)[0]);
        assert!((found - expected).abs() < 2e-5, "{name}: curvature {i}, {j}: {found} is not {expected}");
    }
}

/// An element of the Lie algebra of SE(2).
fn algebra(v: &Vector3<f64>) -> Matrix3<f64> {
    Matrix3::new(0.0, -v.x, v.y, v.x, 0.0, v.z, 0.0, 0.0, 0.0)
}

/// Places in a plane that are moved from the right.
pub(super) fn chart_of_plane() -> Chart<Matrix3<f64>, 3> {
    Chart {
        moved: |q: &Matrix3<f64>, delta| q * exponential(&algebra(delta)),
        coordinates: |q, p| {
            let log = logarithm(&(q.try_inverse().expect("a motion") * p - Matrix3::identity()));
            Vector3::new(log[(1, 0)], log[(0, 2)], log[(1, 2)])
        },
    }
}

#[test]
fn a_group_from_the_right() {
    let random = &mut Random::new(501);
    let chart = chart_of_plane();
    for _ in 0..5 {
        let system = Unicycle {
            turn_price: 0.7,
            top_turn: 1.2,
            time_price: 0.3,
            miss_price: 2.0,
            goal: Vector2::new(1.0, -0.5),
        };
        let x = exponential(&algebra(&(random.vector::<3>() * 2.0)));
        check::<_, 3, 2, 3>(&system, &chart, &x, random);
    }
}

/// Places that are vectors.
pub(super) fn check_vectors<S, const D: usize>(system: &S, x: &SVector<f64, D>, random: &mut Random)
where
    S: Controlled<D, 1, 0, Scalar = f64, Place = SVector<f64, D>>,
{
    let chart = Chart { moved: |x: &SVector<f64, D>, delta| x + delta, coordinates: |x, y| y - x };
    check(system, &chart, x, random);
}

#[test]
fn a_map_of_a_vector_space() {
    let random = &mut Random::new(502);
    for _ in 0..5 {
        let system = Regulator { mass: 1.3, stiffness: 2.0, price: 0.4 };
        let x = random.vector::<2>();
        check_vectors(&system, &x, random);
    }
    let system = Regulator { mass: 2.0, stiffness: 3.0, price: 0.4 };
    let x = system.follow(&0.5, 0.0, &Vector2::new(1.0, 4.0), &Vector1::new(5.0)).expect("a step");
    assert_eq!(x, Vector2::new(3.0, 4.5));
}

/// Attitudes that are turned from the right, with momenta.
pub(super) fn chart_of_bodies() -> Chart<(Matrix3<f64>, Vector3<f64>), 6> {
    Chart {
        moved: |(q, n), delta| {
            (q * exponential(&delta.fixed_rows::<3>(0).into_owned().cross_matrix()), n + delta.fixed_rows::<3>(3))
        },
        coordinates: |(q, n), (p, m)| {
            let log = logarithm(&(q.transpose() * p - Matrix3::identity()));
            let (eta, nu) = (Vector3::new(log[(2, 1)], log[(0, 2)], log[(1, 0)]), m - n);
            SVector::<f64, 6>::from_iterator(eta.iter().chain(nu.iter()).copied())
        },
    }
}

#[test]
fn a_forced_body() {
    let random = &mut Random::new(503);
    let chart = chart_of_bodies();
    for _ in 0..5 {
        let system = SteeredBody { inertia: random.inertia::<3>(), damping: 0.4, top: 1.0 };
        let x = (random.attitude::<3>(), random.vector::<3>());
        check::<_, 6, 3, 2>(&system, &chart, &x, random);
    }
}
