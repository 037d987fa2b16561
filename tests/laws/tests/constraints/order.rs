//! The order of a step, against the equations of Lagrange and d'Alembert by a method of Runge and Kutta of high order.
//!
//! N′ = ad*_ξ N + τ(q) + Aᵀλ with A ξ = b, where λ comes from the derivative of the constraint. These equations are
//! written here by hand, from the declared Lagrangian and its rows alone.

use clebsch::{Clebsch, Error, Space};
use clebsch_tests::fixtures::{
    chaplygin_sleigh::ChaplyginSleigh, rattleback::Rattleback, rolling_ball::RollingBall, snakeboard::Snakeboard,
    suslov::Suslov,
};
use nalgebra::{Matrix3, Matrix4, SVector, Vector1, Vector2, Vector3, Vector5};

/// The classical method of order 4, with so many steps that its error is below those that are measured.
pub fn integrated<const N: usize>(
    slope: impl Fn(&SVector<f64, N>) -> SVector<f64, N>,
    start: SVector<f64, N>,
    time: f64,
) -> SVector<f64, N> {
    integrated_in(4_000, slope, start, time)
}

/// The same in so many steps.
pub fn integrated_in<const N: usize>(
    steps: u32,
    slope: impl Fn(&SVector<f64, N>) -> SVector<f64, N>,
    start: SVector<f64, N>,
    time: f64,
) -> SVector<f64, N> {
    let h = time / f64::from(steps);
    (0..steps).fold(start, |y, _| {
        let a = slope(&y);
        let b = slope(&(y + a * (h / 2.0)));
        let c = slope(&(y + b * (h / 2.0)));
        let d = slope(&(y + c * h));
        y + (a + (b + c) * 2.0 + d) * (h / 6.0)
    })
}

/// log₂ of the ratio of the errors of 80 and 160 steps.
fn order(error: impl Fn(usize) -> Result<f64, Error>) -> Result<f64, Error> {
    let (coarse, fine) = (error(80)?, error(160)?);
    assert!(fine > 1e-9, "{fine:e} is too near to rounding");
    Ok((coarse / fine).log2())
}

#[test]
fn the_sleigh_is_of_second_order() -> Result<(), Error> {
    let sleigh = ChaplyginSleigh { mass: 1.5, inertia: 0.4, offset: 0.6 };
    let (m, a) = (sleigh.mass, sleigh.offset);
    let whole = sleigh.inertia + m * a * a;
    // the closed form: v′ = a ω², (I + m a²) ω′ = −m a v ω
    let slope = |y: &SVector<f64, 5>| {
        let [_, _, turned, omega, v] = *y.as_ref();
        Vector5::new(v * turned.cos(), v * turned.sin(), omega, -m * a * v * omega / whole, a * omega * omega)
    };
    let (omega, v) = (1.1, -0.8);
    let expected = integrated(slope, Vector5::new(0.0, 0.0, 0.0, omega, v), 2.0);
    let measured = order(|steps| {
        let stepper = sleigh.stepper(2.0 / steps as f64)?;
        let start = stepper.state_moving(Matrix3::identity(), Vector3::new(omega, v, 0.0))?;
        let end = stepper.advance(&start, steps)?;
        let q = end.configuration();
        Ok(Vector2::new(q[(0, 2)] - expected[0], q[(1, 2)] - expected[1]).norm())
    })?;
    assert!((measured - 2.0).abs() < 0.05, "order {measured}");
    Ok(())
}

/// The change of (ω₁, ω₂) of Suslov's body and of the third row r of R.
///
/// ```text
/// J ω′ = J ω × ω + λ e₃ with ω₃ = 0,    r′ = r × ω
/// ```
pub fn suslov(inertia: Matrix3<f64>) -> impl Fn(&SVector<f64, 5>) -> SVector<f64, 5> {
    move |y| {
        let omega = Vector3::new(y[0], y[1], 0.0);
        let torque = (inertia * omega).cross(&omega);
        let plane = inertia.fixed_view::<2, 2>(0, 0).try_inverse().unwrap();
        let change = plane * Vector2::new(torque.x, torque.y);
        let row = Vector3::new(y[2], y[3], y[4]).cross(&omega);
        Vector5::new(change.x, change.y, row.x, row.y, row.z)
    }
}

/// The momentum of Suslov's body after some time, from (ω₁, ω₂).
pub fn momentum_of_suslov(inertia: Matrix3<f64>, omega: Vector2<f64>, time: f64) -> Vector3<f64> {
    let end = integrated(suslov(inertia), Vector5::new(omega.x, omega.y, 0.0, 0.0, 1.0), time);
    inertia * Vector3::new(end[0], end[1], 0.0)
}

#[test]
fn suslovs_body_is_of_second_order() -> Result<(), Error> {
    let inertia = Matrix3::new(1.0, 0.1, 0.3, 0.1, 1.4, -0.2, 0.3, -0.2, 0.9);
    let omega = Vector2::new(0.9, -0.7);
    let expected = integrated(suslov(inertia), Vector5::new(omega.x, omega.y, 0.0, 0.0, 1.0), 2.0);
    let measured = order(|steps| {
        let stepper = Suslov { inertia }.into_stepper(2.0 / steps as f64)?;
        let start = stepper.state_moving(Matrix3::identity(), Vector3::new(omega.x, omega.y, 0.0))?;
        let end = stepper.advance(&start, steps)?;
        let r = end.configuration();
        Ok(Vector3::new(r[(2, 0)] - expected[2], r[(2, 1)] - expected[3], r[(2, 2)] - expected[4]).norm())
    })?;
    assert!((measured - 2.0).abs() < 0.05, "order {measured}");
    Ok(())
}

/// x″ + κ y′ = 0 and y″ − κ x′ = 0: a circle, which the steps make with another angle.
#[test]
fn the_ball_goes_round_an_exact_circle() -> Result<(), Error> {
    let ball = RollingBall { mass: 1.3, inertia: 0.7, radius: 0.5, table_rate: 0.9 };
    let kappa = ball.inertia * ball.table_rate / (ball.inertia + ball.mass * ball.radius * ball.radius);
    let h = 0.1;
    assert!(!RollingBall::DERIVATION.contains("Newton"), "{}", RollingBall::DERIVATION);
    let stepper = ball.stepper(h)?;
    let (place, spin) = (Vector2::new(0.3, -0.2), 0.5);
    let v = Vector2::new(0.1863414637, 0.2795121951);
    let w =
        Vector2::new((ball.table_rate * place.x - v.y) / ball.radius, (v.x + ball.table_rate * place.y) / ball.radius);
    let start = stepper.state_moving(place, Vector5::new(v.x, v.y, w.x, w.y, spin))?;
    let places: Vec<Vector2<f64>> =
        stepper.trajectory(start).take(1001).map(|state| Ok(*state?.configuration())).collect::<Result<_, Error>>()?;
    // z₂ − z₁ = (1 + ia)/(1 − ia) (z₁ − z₀) with a = hκ/2
    let angle = 2.0 * (h * kappa / 2.0).atan();
    let turn = nalgebra::Rotation2::new(angle);
    let first = places[1] - places[0];
    for (k, pair) in places.windows(2).enumerate() {
        let expected = nalgebra::Rotation2::new(angle * k as f64) * first;
        assert!((pair[1] - pair[0] - expected).norm() < 1e-14 * (k + 1) as f64, "step {k}");
    }
    // z_k − c = turn^k (z₀ − c)
    let centre = places[0] - (turn.matrix() - nalgebra::Matrix2::identity()).try_inverse().unwrap() * first;
    let radius = (places[0] - centre).norm();
    let far = places.iter().map(|place| ((place - centre).norm() - radius).abs()).fold(0.0, f64::max);
    assert!(far < 1e-13, "{far:e}");
    // with the projection of the cost and of the velocity the momentum about e3 of the ball stays
    let end = stepper.advance(&start, 1000)?;
    assert!((end.momentum()[4] - ball.inertia * spin).abs() < 1e-15);
    assert!((stepper.conserved(&end)[0] - ball.inertia * spin).abs() < 1e-15);
    assert!(end.configuration().all_finite());
    Ok(())
}

/// The wheels turn evenly, the rotor keeps its momentum p = J(r + ω), and λ comes from the derivative of the second row.
#[test]
fn the_snakeboard_is_of_second_order() -> Result<(), Error> {
    let board = Snakeboard { mass: 1.2, length: 0.8, rotor: 0.3, wheel: 0.15 };
    let (m, l, j) = (board.mass, board.length, board.rotor);
    let (rate, omega) = (0.5, 0.4);
    // l cos φ ω + sin φ v = 0
    let (angle, spin) = (0.6_f64, 1.3);
    let v = -l * angle.cos() * omega / angle.sin();
    let whole = m * l * l - j;
    let slope = |y: &SVector<f64, 6>| {
        let [_, _, turned, angle, omega, v] = *y.as_ref();
        let (sin, cos) = angle.sin_cos();
        let lambda = rate * (l * sin * omega - cos * v) / (l * l * cos * cos / whole + sin * sin / m);
        let forces = [lambda * l * cos / whole, lambda * sin / m];
        SVector::from([v * turned.cos(), v * turned.sin(), omega, rate, forces[0], forces[1]])
    };
    let expected = integrated(slope, SVector::from([0.0, 0.0, 0.0, angle, omega, v]), 1.0);
    let measured = order(|steps| {
        let stepper = board.stepper(1.0 / steps as f64)?;
        let velocity = Vector5::new(omega, v, 0.0, spin, rate);
        let place = (Matrix3::identity(), Vector1::new(0.0), Vector1::new(angle));
        let start = stepper.state_moving(place, velocity)?;
        let end = stepper.advance(&start, steps)?;
        let [rotor, wheel] = [3, 4].map(|i| (end.momentum()[i] - start.momentum()[i]).abs());
        assert!(rotor < 1e-14 && wheel < 1e-14, "{rotor:e} {wheel:e}");
        let (q, ..) = end.configuration();
        Ok(Vector2::new(q[(0, 2)] - expected[0], q[(1, 2)] - expected[1]).norm())
    })?;
    assert!((measured - 2.0).abs() < 0.05, "order {measured}");
    Ok(())
}

/// A body that rolls, with the direction γ up and the place c of the contact, both in the body.
///
/// ```text
/// (J − m c^c^) ω′ = −ω × Jω + c × (m (c′ × ω + ω × (c × ω)) + m g γ),    γ′ = γ × ω
/// ```
fn rolling(body: &Rattleback, y: &SVector<f64, 6>) -> SVector<f64, 6> {
    let (omega, up): (Vector3<f64>, Vector3<f64>) = (y.fixed_rows::<3>(0).into(), y.fixed_rows::<3>(3).into());
    let squares = body.axes.component_mul(&body.axes);
    let (turning, scaled) = (up.cross(&omega), squares.component_mul(&up));
    let length = up.dot(&scaled).sqrt();
    let contact = Vector3::z() * body.height - scaled / length;
    let moved = scaled * (turning.dot(&scaled) / length.powi(3)) - squares.component_mul(&turning) / length;
    let push = (moved.cross(&omega) + omega.cross(&contact.cross(&omega)) + up * body.gravity) * body.mass;
    let hat = contact.cross_matrix();
    let inertia = body.inertia - hat * hat * body.mass;
    let torque = contact.cross(&push) - omega.cross(&(body.inertia * omega));
    let change = inertia.try_inverse().unwrap() * torque;
    SVector::from([change.x, change.y, change.z, turning.x, turning.y, turning.z])
}

#[test]
fn the_rattleback_is_of_second_order() -> Result<(), Error> {
    let inertia = Matrix3::new(1.6e-3, -2e-4, 0.0, -2e-4, 2e-3, 0.0, 0.0, 0.0, 2.2e-3);
    let body = Rattleback { inertia, mass: 1.0, gravity: 9.81, axes: Vector3::new(0.2, 0.03, 0.02), height: 0.0 };
    let omega = Vector3::new(0.1, 0.2, -5.0);
    let start = SVector::from([omega.x, omega.y, omega.z, 0.0, 0.0, 1.0]);
    let expected = integrated(|y| rolling(&body, y), start, 0.2);
    let contact = Vector3::z() * (body.height - body.axes.z);
    let v = contact.cross(&omega);
    let mut place = Matrix4::identity();
    place[(2, 3)] = -contact.z;
    let measured = order(|steps| {
        let stepper = body.stepper(0.2 / steps as f64)?;
        let velocity = SVector::from([omega.x, omega.y, omega.z, v.x, v.y, v.z]);
        let start = stepper.state_moving(place, velocity)?;
        let end = stepper.advance(&start, steps)?;
        let spin = inertia.try_inverse().unwrap() * end.momentum().fixed_rows::<3>(0);
        Ok((spin - expected.fixed_rows::<3>(0)).norm())
    })?;
    assert!((measured - 2.0).abs() < 0.1, "order {measured}");
    Ok(())
}

/// Spun one way it rocks and comes back the other way round. Spun the other way it goes on.
#[test]
fn the_rattleback_reverses() -> Result<(), Error> {
    let inertia = Matrix3::new(1.6e-3, -2e-4, 0.0, -2e-4, 2e-3, 0.0, 0.0, 0.0, 2.2e-3);
    let body = Rattleback { inertia, mass: 1.0, gravity: 9.81, axes: Vector3::new(0.2, 0.03, 0.02), height: 0.0 };
    let stepper = body.stepper(0.001)?;
    let mut place = Matrix4::identity();
    place[(2, 3)] = body.axes.z;
    for spin in [-5.0, 5.0] {
        let omega = Vector3::new(0.1, 0.2, spin);
        let v = Vector3::z().cross(&omega) * -body.axes.z;
        let velocity = SVector::from([omega.x, omega.y, omega.z, v.x, v.y, v.z]);
        let start = stepper.state_moving(place, velocity)?;
        let end = stepper.advance(&start, 5000)?;
        let found = (inertia.try_inverse().unwrap() * end.momentum().fixed_rows::<3>(0)).z;
        let start = SVector::from([omega.x, omega.y, omega.z, 0.0, 0.0, 1.0]);
        let expected = integrated(|y| rolling(&body, y), start, 5.0)[2];
        assert!(found > 4.9 && (found - expected).abs() < 1e-2, "{spin}: {found} and not {expected}");
    }
    Ok(())
}
