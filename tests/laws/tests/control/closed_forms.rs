//! Plans with a closed form, on a group without Cayley's map in it and on a homogeneous space.

use clebsch::{Clebsch, Controlled, Error, Target};
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::PI;

/// Dido's problem: the shortest curve that encloses an area.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: Heisenberg<1>, q: Heisenberg<1>| q * F,
    controls       = |u: Vector2| vector![u.x, u.y, 0],
    cost           = |h, u| h * u.norm_squared() / 2,
    discretization = exponential,
)]
pub struct Dido;

/// A pointer that two motors turn about horizontal axes, not about the vertical.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<3>, q: Unit<Vector3>| F * q,
    controls       = |u: Vector2| vector![u.x, u.y, 0],
    cost           = |h, u| h * u.norm_squared() / 2,
    discretization = exponential,
)]
pub struct Pointer;

/// Curves of N straight pieces: the regular polygon of area A has the perimeter 2√(N A tan(π/N)). The least price is
/// its square over 2T.
#[test]
fn polygons_enclose_most() -> Result<(), Error> {
    for steps in [3, 4, 10, 40] {
        let control = Dido.control(1.0 / steps as f64)?;
        let start = Matrix3::identity();
        let area = 0.7;
        let mut target = start;
        target[(0, 2)] = area;
        let mut plan = vec![control.stage(&start); steps];
        let optimum = control.solve(&start, Target::Place(target), &mut plan)?;
        let n = steps as f64;
        let expected = 2.0 * n * area * (PI / n).tan();
        assert!((optimum.price() - expected).abs() < 1e-9 * expected, "{steps}: {} is not {expected}", optimum.price());
        // all sides are equal, and so are all angles
        let inputs: Vec<_> = optimum.stages().iter().map(|stage| *stage.input()).collect();
        let cosine = (2.0 * PI / n).cos();
        for pair in inputs.windows(2) {
            assert!((pair[0].norm() - pair[1].norm()).abs() < 1e-6 * pair[0].norm());
            assert!((pair[0].dot(&pair[1]) / pair[0].norm_squared() - cosine).abs() < 1e-6);
        }
    }
    Ok(())
}

/// From the pole along a meridian: a turn about a horizontal axis, at no more than the price of its angle. It is exact
/// for any number of steps.
#[test]
fn a_pointer_leaves_the_pole_along_a_meridian() -> Result<(), Error> {
    for steps in [1, 2, 30] {
        let control = Pointer.control(1.0 / steps as f64)?;
        let start = Vector3::z();
        let (angle, azimuth) = (1.2_f64, 0.7_f64);
        let target = Vector3::new(angle.sin() * azimuth.cos(), angle.sin() * azimuth.sin(), angle.cos());
        let mut plan = vec![control.stage(&start); steps];
        let optimum = control.solve(&start, Target::Place(target), &mut plan)?;
        assert!((optimum.price() - angle * angle / 2.0).abs() < 1e-10, "{steps}: {}", optimum.price());
        for stage in optimum.stages() {
            assert!((stage.input().x + angle * azimuth.sin()).abs() < 1e-7);
            assert!((stage.input().y - angle * azimuth.cos()).abs() < 1e-7);
        }
        assert!(optimum.gap() < 1e-12);
        // no motion leads off the sphere
        let error = control.solve(&start, Target::Place(target * 1.5), &mut plan).map(|_| ());
        assert!(matches!(error, Err(Error::OffOrbit { .. })), "{error:?}");
    }
    Ok(())
}

/// A body with two wheels: it turns about its first two axes, never about the third.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<3>, R: SO<3>| R * F,
    controls       = |u: Vector2| vector![u.x, u.y, 0],
    cost           = |h, u| h * u.norm_squared() / 2,
    discretization = exponential,
)]
pub struct TwoWheels;

/// To a turn by φ about the third axis, in a time of one: R = exp(t(p + c e₃)) exp(−t c e₃). Here |p + c e₃| = 2π and
/// c = 2π − φ. So the least price is (4πφ − φ²)/2. Steps with constant inputs come near it to second order.
#[test]
fn two_wheels_turn_about_the_third_axis() -> Result<(), Error> {
    let angle = 0.9_f64;
    let expected = (4.0 * PI * angle - angle * angle) / 2.0;
    let start = Matrix3::identity();
    let target = *nalgebra::Rotation3::from_scaled_axis(Vector3::z() * angle).matrix();
    let mut errors = Vec::new();
    for steps in [20, 40, 80] {
        let control = TwoWheels.control(1.0 / steps as f64)?;
        let mut plan = vec![control.stage(&start); steps];
        let optimum = control.solve(&start, Target::Place(target), &mut plan)?;
        assert!(optimum.gap() < 1e-11);
        errors.push(optimum.price() - expected);
    }
    assert!(errors[2].abs() < 2e-2, "{errors:?}");
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 2.0).abs() < 0.05, "order {order}: {errors:?}");
    }
    Ok(())
}
