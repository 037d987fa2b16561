//! The exact motion against a Runge–Kutta method in small steps, and against its own laws.

use super::{FreeRotation4, KeptRotation4, PLANES, SERIES, flow, free_momentum_4d};
use crate::runner::{is_long, proptest};
use crate::{Error, Real};
use nalgebra::{Matrix4, SMatrix, SVector, Vector6};
use proptest::prelude::*;

type Tensor = SMatrix<f64, 6, 6>;

/// Σ of D: ½ tr(E_aᵀ(D E_b + E_b D)).
fn form(mass: &Matrix4<f64>) -> Tensor {
    Tensor::from_fn(|a, b| 0.5 * (basis(a).transpose() * (mass * basis(b) + basis(b) * mass)).trace())
}

/// E_ji − E_ij
fn basis(index: usize) -> Matrix4<f64> {
    let (i, j) = PLANES[index];
    let mut matrix = Matrix4::zeros();
    (matrix[(j, i)], matrix[(i, j)]) = (1.0, -1.0);
    matrix
}

fn wedge(xi: &Vector6<f64>) -> Matrix4<f64> {
    (0..6).fold(Matrix4::zeros(), |sum, index| sum + basis(index) * xi[index])
}

/// ½ Σ tr(Mᵀ E_i): entry by entry below the diagonal.
fn components(matrix: &Matrix4<f64>) -> Vector6<f64> {
    Vector6::from_fn(|index, _| matrix[(PLANES[index].1, PLANES[index].0)])
}

/// (R, μ) after a time, by the classical method of Runge and Kutta: R′ = RΩ, M′ = MΩ − ΩM.
fn followed(inertia: &Tensor, mu: &Vector6<f64>, time: f64, steps: u32) -> (Matrix4<f64>, Vector6<f64>) {
    let inverse = inertia.try_inverse().expect("regular");
    let rate = |(r, mu): &(Matrix4<f64>, Vector6<f64>)| {
        let (omega, m) = (wedge(&(inverse * mu)), wedge(mu));
        (r * omega, components(&(m * omega - omega * m)))
    };
    let h = time / f64::from(steps);
    let beside = |state: &(Matrix4<f64>, Vector6<f64>), rate: &(Matrix4<f64>, Vector6<f64>), part: f64| {
        (state.0 + rate.0 * part, state.1 + rate.1 * part)
    };
    let mut state = (Matrix4::identity(), *mu);
    for _ in 0..steps {
        let first = rate(&state);
        let second = rate(&beside(&state, &first, h / 2.0));
        let third = rate(&beside(&state, &second, h / 2.0));
        let fourth = rate(&beside(&state, &third, h));
        for (slope, weight) in [(first, 1.0), (second, 2.0), (third, 2.0), (fourth, 1.0)] {
            state = beside(&state, &slope, weight * h / 6.0);
        }
    }
    state
}

/// Where a number of steps of one motion lead.
fn stepped(inertia: &Tensor, mu: &Vector6<f64>, h: f64, steps: u32) -> (Matrix4<f64>, Vector6<f64>) {
    let free = FreeRotation4::new(inertia, h).expect("regular");
    let kept = free.motion(mu);
    let (mut r, mut mu) = (Matrix4::identity(), *mu);
    for _ in 0..steps {
        let (increment, next) = free.turn(&kept, &mu).expect("a step");
        (r, mu) = (r + r * increment, next);
    }
    (r, mu)
}

const START: [f64; 6] = [0.6, -1.0, 0.4, 1.2, -0.2, 1.0];

fn bodies() -> [(&'static str, Matrix4<f64>); 6] {
    let turn =
        SMatrix::<f64, 4, 4>::new(0.5, 0.5, 0.5, 0.5, 0.5, -0.5, 0.5, -0.5, 0.5, 0.5, -0.5, -0.5, 0.5, -0.5, -0.5, 0.5);
    let principal = |d: [f64; 4]| Matrix4::from_diagonal(&d.into());
    [
        ("four moments", principal([2.0, 3.0, 4.0, 5.0])),
        ("turned axes", turn * principal([2.0, 3.0, 4.0, 5.0]) * turn.transpose()),
        ("a pair of equal moments", principal([2.0, 2.0, 4.0, 5.0])),
        ("two pairs", principal([2.0, 2.0, 4.0, 4.0])),
        ("a ball", principal([3.0, 3.0, 3.0, 3.0])),
        ("flat", principal([0.0, 1.0, 2.0, 3.0])),
    ]
}

#[test]
fn motions_are_those_of_small_steps() {
    for (what, mass) in bodies() {
        let (inertia, mu) = (form(&mass), Vector6::from(START));
        let (time, followed_steps) = match (cfg!(miri), is_long()) {
            (true, _) => (0.01, 10),
            (_, true) => (4.0, 8000),
            (_, false) => (0.5, 1000),
        };
        let wanted = followed(&inertia, &mu, time, followed_steps);
        for steps in [2, 1, 4, 40].into_iter().take(if cfg!(miri) { 1 } else { 4 }) {
            let found = stepped(&inertia, &mu, time / f64::from(steps), steps);
            let error = ((found.0 - wanted.0).amax()).max((found.1 - wanted.1).amax());
            assert!(error < 3e-13, "{what}, {steps}: {error:e}");
        }
    }
}

/// Nine radians, or four under Miri, are too much for one series: they are made of halves, and of halves of those.
#[test]
fn long_motions_are_series_after_series() {
    let mass = Matrix4::from_diagonal(&[2.0, 3.0, 4.0, 5.0].into());
    let (inertia, mu) = (form(&mass), Vector6::from(START));
    let time = if is_long() { 30.0 } else { 12.0 };
    let free = FreeRotation4::new(&inertia, time).expect("regular");
    let m = free.in_principal_axes(&mu);
    assert!(flow(|m| free.velocity(m), &m).is_none());
    let (increment, end) = free.series(&m, &mut SERIES.clone()).expect("parts that end");
    let (increment, end) = free.in_coordinates(&increment, &end);
    // short runs are compared with short steps of their own; long ones with those of Runge and Kutta
    let (wanted, last) =
        if is_long() { followed(&inertia, &mu, time, 30_000) } else { stepped(&inertia, &mu, time / 12.0, 12) };
    let error = (increment + Matrix4::identity() - wanted).amax().max((end - last).amax());
    assert!(error < 1e-11, "{error:e}");
    // eleven series that do not end, each half as long as the one before, take Miri too long
    if !cfg!(miri) {
        assert!(free.series(&m.map(|entry| entry * 1e4), &mut SERIES.clone()).is_err());
    }
}

/// Constants are found: a step of a radian is one part, and no Taylor series.
#[test]
fn steps_are_of_one_part() {
    for (what, mass) in bodies() {
        let free = FreeRotation4::new(&form(&mass), 1.0).expect("regular");
        let kept: KeptRotation4<f64> = free.motion(&Vector6::from(START));
        assert_eq!((kept.0, kept.1), (1.0, 0.0), "{what}");
    }
}

/// Of rotations short of half a turn.
#[test]
fn the_momentum_is_that_of_the_rotation() {
    for (what, mass) in bodies().into_iter().take(if cfg!(miri) { 1 } else { 6 }) {
        let (inertia, mu) = (form(&mass), Vector6::from(START));
        for h in [-0.3, 1e-6, 0.1, 1.0, 2.0].into_iter().take(if cfg!(miri) { 2 } else { 5 }) {
            let (r, _) = stepped(&inertia, &mu, h, 1);
            let found = free_momentum_4d(&inertia, h, &r);
            assert!((found - mu).amax() < 1e-12, "{what}, {h}: {found} {mu}");
        }
    }
    let inertia = form(&bodies()[0].1);
    assert!(free_momentum_4d(&inertia, 0.1, &Matrix4::from_element(f64::NAN)).iter().all(|entry| entry.is_nan()));
}

#[test]
fn a_motion_of_many_steps_stays() {
    let mass = Matrix4::from_diagonal(&[2.0, 3.0, 4.0, 5.0].into());
    let (inertia, start) = (form(&mass), Vector6::from(START));
    let (r, mu) = stepped(
        &inertia,
        &start,
        1.0,
        if cfg!(miri) {
            10
        } else if is_long() {
            100_000
        } else {
            5000
        },
    );
    assert!((r.transpose() * r - Matrix4::identity()).amax() < 1e-12);
    let spatial = components(&(r * wedge(&mu) * r.transpose()));
    assert!((spatial - start).amax() < 1e-11, "{:e}", (spatial - start).amax());
    let inverse = inertia.try_inverse().expect("regular");
    let energy = |mu: &Vector6<f64>| mu.dot(&(inverse * mu));
    assert!((energy(&mu) / energy(&start) - 1.0).abs() < 1e-12);
}

#[test]
fn what_cannot_be_is_said() {
    let flat = Matrix4::from_diagonal(&[0.0, 0.0, 1.0, 2.0].into());
    assert!(matches!(FreeRotation4::new(&form(&flat), 0.1), Err(Error::SingularKineticEnergy { .. })));
    let mass = Matrix4::from_diagonal(&[2.0, 3.0, 4.0, 5.0].into());
    assert!(matches!(FreeRotation4::new(&(form(&mass) * f64::NAN), 0.1), Err(Error::NotFinite { .. })));
    let free = FreeRotation4::new(&form(&mass), 0.1).expect("regular");
    let turned = |mu: SVector<f64, 6>| free.turn(&free.motion(&mu), &mu);
    assert!(matches!(turned(Vector6::from_element(f64::NAN)), Err(Error::NotFinite { .. })));
    let far = Vector6::from(START) * 1e9;
    let Err(Error::Unsolvable { solvable_fraction, .. }) = turned(far) else { panic!("a billion radians were made") };
    assert!(turned(far * solvable_fraction).is_ok());
    assert_eq!(turned(Vector6::zeros()).expect("at rest"), (Matrix4::zeros(), Vector6::zeros()));
}

/// A step is a rotation up to round-off and agrees with its Taylor series, for all ratios of the moments.
#[test]
fn no_step_leaves_the_rotations() {
    fn check<T: Real>(d: [f64; 4], omega: &Vector6<f64>, h: f64) {
        let inertia = form(&Matrix4::from_diagonal(&d.into()));
        let number = T::from_f64;
        let (sigma, mu) = (inertia.map(number), (inertia * omega).map(number));
        let free = FreeRotation4::new(&sigma, number(h)).expect("regular");
        let kept = free.motion(&mu);
        let (increment, next) = free.turn(&kept, &mu).expect("a step");
        let (found, left) = (increment.map(T::to_f64), increment.transpose().map(T::to_f64));
        let defect = (found + left + left * found).amax();
        let accepted = 32.0 * T::EPSILON.to_f64();
        assert!(defect <= accepted, "{d:?}, {omega}, {h}: {defect:e}");
        let m = free.in_principal_axes(&mu);
        let (exact, end) = free.series(&m, &mut SERIES.clone()).expect("a series");
        let (exact, end) = free.in_coordinates(&exact, &end);
        let error = (increment - exact)
            .map(T::to_f64)
            .amax()
            .max((next - end).map(T::to_f64).amax() / mu.map(T::to_f64).amax());
        assert!(error <= 2e4 * T::EPSILON.to_f64(), "{d:?}, {omega}, {h}: {error:e}");
    }
    let ratios = if cfg!(miri) { 8..9 } else { 0..16 };
    for exponent in ratios {
        let m = 10.0_f64.powi(exponent);
        for d in [[1.0, 2.0, 3.0, m], [m, 1.0, 2.0, 1.0], [1.0, 1.0 / m, 1.5 / m, 2.0 / m], [1.0, m, m, 2.0 * m]] {
            let mut omega = Vector6::from(START);
            for time in if cfg!(miri) {
                0..1
            } else if is_long() {
                0..25
            } else {
                0..3
            } {
                omega = omega.map(|entry| (3.7 * entry + 0.3 * f64::from(time)).sin());
                let omega = if time == 0 { Vector6::zeros() } else { omega };
                for h in [0.3, 1e-5] {
                    check::<f64>(d, &omega, h);
                    // beyond a ratio of 1/ε a sum of moments of single precision is singular
                    if exponent <= 6 {
                        check::<f32>(d, &omega, h);
                    }
                }
            }
        }
    }
}

/// Constants may have been read from a damaged file. A step with them is an error or a rotation, after a bounded number of series.
#[test]
fn what_is_known_of_a_motion_may_be_wrong() {
    let mass = Matrix4::from_diagonal(&[2.0, 3.0, 4.0, 5.0].into());
    let free = FreeRotation4::new(&form(&mass), 0.5).expect("regular");
    let mu = Vector6::from(START);
    let hostile = [0.0, -1.0, 0.5, 2.0, 1024.0, 1025.0, 1e16, 1e300, -1e300, 5e-324, f64::NAN, f64::INFINITY];
    for (number, value) in hostile.into_iter().enumerate().take(if cfg!(miri) { 1 } else { 12 }) {
        for place in 0..25 {
            // a short run replaces each number once or twice
            if !cfg!(miri) && !is_long() && place % 12 != number {
                continue;
            }
            let mut kept: KeptRotation4<f64> = free.motion(&mu);
            replace(&mut kept, place, value);
            let sizes = [mu, mu * 1e3, mu * 1e16].into_iter().skip(if is_long() { 0 } else { place % 3 });
            for mu in sizes.take(if is_long() { 3 } else { 1 }) {
                let Ok((increment, next)) = free.turn(&kept, &mu) else { continue };
                let defect = (increment + increment.transpose() + increment.transpose() * increment).amax();
                assert!(
                    defect <= 1e-13 || !(increment.sum() + next.sum()).is_finite(),
                    "{place}, {value:e}: {defect:e}"
                );
            }
        }
    }
}

/// Puts a number in a place of the constants.
fn replace(
    (parts, by_series, step, moments, origin, slopes, casimirs, turn): &mut KeptRotation4<f64>,
    place: usize,
    value: f64,
) {
    let numbers = [parts, by_series, step].into_iter();
    let numbers = numbers.chain(moments).chain(origin).chain(slopes.iter_mut().flatten()).chain(casimirs).chain(turn);
    *numbers.into_iter().nth(place).expect("a place") = value;
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// The motion of h and then of k is that of h + k, each with its own constants; the integrals stay.
    #[test]
    fn motions_add_up(
        moments in prop::array::uniform4(0.1_f64..3.0),
        start in prop::array::uniform6(-1.0_f64..1.0),
        h in 0.01_f64..1.0,
        k in 0.01_f64..1.0,
    ) {
        let (inertia, mu) = (form(&Matrix4::from_diagonal(&moments.into())), Vector6::from(start));
        let (first, between) = stepped(&inertia, &mu, h, 1);
        let (second, end) = stepped(&inertia, &between, k, 1);
        let (whole, last) = stepped(&inertia, &mu, h + k, 1);
        let error = (first * second - whole).amax().max((end - last).amax());
        prop_assert!(error < 2e-13, "{error:e}");
        prop_assert!((whole.transpose() * whole - Matrix4::identity()).amax() < 2e-15);
    }
}
