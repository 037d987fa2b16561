//! Other declarations of the same motion: forces, other discretizations, other groups and sides, methods and lanes.

use clebsch::{Clebsch, Constrained, Declared, Error, F64x4, Method, Scalar};
use nalgebra::{Matrix3, Quaternion, SVector, Vector1, Vector2, Vector3};

/// Suslov's body, with steps of several methods.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<3>, R: SO<3>| R * F,
    lagrangian     = |omega| omega.dot(&(self.inertia * omega)) / 2,
    constraint     = |omega| [omega.z == 0],
    discretization = moser_veselov,
    method Cayley      = (discretization = cayley),
    method Exponential = (discretization = exponential),
    method Projection  = (discretization = projection),
    method Fourth      = (discretization = moser_veselov, order = 4),
    method Compensated = (discretization = moser_veselov, summation = compensated),
)]
pub struct Suslov<T: Scalar> {
    #[clebsch(symmetric)]
    pub inertia: Matrix3<T>,
}

pub struct Cayley;
pub struct Exponential;
pub struct Projection;
/// Compositions of five steps, each with its projection.
pub struct Fourth;
pub struct Compensated;

/// The same in quaternions.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SU<2>, q: Quaternion| q * F,
    lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
    constraint = |omega| [omega.z == 0],
    method Fine = (order = 6),
)]
pub struct Turned {
    #[clebsch(symmetric)]
    pub inertia: Matrix3<f64>,
}

/// Steps of sixth order.
pub struct Fine;

fn inertia() -> Matrix3<f64> {
    Matrix3::new(1.0, 0.1, 0.3, 0.1, 1.4, -0.2, 0.3, -0.2, 0.9)
}

/// The momentum a second after (ω₁, ω₂) = (0.9, −0.7).
fn after_a_second<S, M>(system: &S, place: S::Configuration, steps: usize) -> Result<Vector3<f64>, Error>
where
    S: Constrained<Scalar = f64, Momentum = Vector3<f64>> + Clone,
    M: Method<S>,
{
    let stepper = system.stepper_by::<M>(1.0 / steps as f64)?;
    let start = stepper.state_moving(place, Vector3::new(0.9, -0.7, 0.0))?;
    Ok(stepper.advance(&start, steps)?.momentum())
}

/// The order of a method, from so many steps a second and from twice as many.
fn order<S, M>(system: &S, place: S::Configuration, exact: Vector3<f64>, steps: usize) -> Result<f64, Error>
where
    S: Constrained<Scalar = f64, Momentum = Vector3<f64>> + Clone,
    M: Method<S>,
{
    let [coarse, fine] = [steps, 2 * steps].map(|steps| after_a_second::<S, M>(system, place, steps));
    Ok(((coarse? - exact).norm() / (fine? - exact).norm()).log2())
}

#[test]
fn discretizations_groups_and_compositions_have_their_orders() -> Result<(), Error> {
    let (inertia, place) = (inertia(), Matrix3::identity());
    let (body, identity) = (Suslov { inertia }, Quaternion::new(1.0, 0.0, 0.0, 0.0));
    let exact = crate::order::momentum_of_suslov(inertia, Vector2::new(0.9, -0.7), 1.0);
    for (name, measured) in [
        ("Cayley", order::<_, Cayley>(&body, place, exact, 50)?),
        ("exponential", order::<_, Exponential>(&body, place, exact, 50)?),
        ("projection", order::<_, Projection>(&body, place, exact, 50)?),
        ("quaternions", order::<_, Declared>(&Turned { inertia }, identity, exact, 50)?),
    ] {
        assert!((measured - 2.0).abs() < 0.05, "{name}: order {measured}");
    }
    let measured = order::<_, Fourth>(&body, place, exact, 5)?;
    assert!((measured - 4.0).abs() < 0.2, "a composition: order {measured}");
    // a method of sixth order
    let stepper = Turned { inertia }.into_stepper_by::<Fine>(0.05)?;
    let start = stepper.state_moving(identity, Vector3::new(0.9, -0.7, 0.0))?;
    let end = stepper.advance(&start, 20)?;
    assert!((end.momentum() - exact).norm() < 1e-8, "{}", (end.momentum() - exact).norm());
    assert_eq!(<Fine as Method<Turned>>::ORDER, 6);
    Ok(())
}

#[test]
fn compensated_sums_are_the_same_steps() -> Result<(), Error> {
    let body = Suslov { inertia: inertia() };
    let (plain, compensated) = (body.stepper(0.1)?, body.stepper_by::<Compensated>(0.1)?);
    let (place, omega) = (Matrix3::identity(), Vector3::new(0.9, -0.7, 0.0));
    let one = plain.advance(&plain.state_moving(place, omega)?, 100)?;
    let other = compensated.advance(&compensated.state_moving(place, omega)?, 100)?;
    let far = (one.momentum() - other.momentum()).norm();
    assert!(far < 1e-13, "{far:e}");
    assert!((one.configuration() - other.configuration()).norm() < 1e-13);
    Ok(())
}

#[test]
fn lanes_are_bodies_alone() -> Result<(), Error> {
    let wide = Suslov { inertia: inertia().map(F64x4::splat) }.into_stepper(F64x4::splat(0.1))?;
    let velocities = [0.9, 0.5, -0.3, 0.0].map(|x| Vector3::new(x, -0.7, 0.0));
    let velocity = Vector3::from_fn(|i, _| F64x4::from_lanes(|lane| velocities[lane][i]));
    let start = wide.state_moving(Matrix3::identity().map(F64x4::splat), velocity)?;
    let end = wide.advance(&start, 50)?;
    for (lane, velocity) in velocities.into_iter().enumerate() {
        let one = Suslov { inertia: inertia() }.into_stepper(0.1)?;
        let alone = one.advance(&one.state_moving(Matrix3::identity(), velocity)?, 50)?;
        let found = end.momentum().map(|entry| Scalar::lane(entry, lane));
        assert!((found - alone.momentum()).norm() < 1e-15, "lane {lane}");
    }
    Ok(())
}

/// A sleigh that is pushed along its blade, with friction.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SE<2>, q: SE<2>| q * F,
    lagrangian     = |xi| (self.inertia * xi.x.powi(2) + self.mass * (xi.y.powi(2) + (xi.z + self.offset * xi.x).powi(2))) / 2,
    discretization = moser_veselov,
    potential      = |q| self.weight * q.translation().y,
    force          = |xi, push: Vector1| vector![-self.friction * xi.x, push.x - self.friction * xi.y, 0],
    constraint     = |xi| [xi.z == 0],
)]
pub struct Pushed {
    pub mass: f64,
    pub inertia: f64,
    pub offset: f64,
    pub friction: f64,
    pub weight: f64,
}

#[test]
fn forces_and_constraints_act_together() -> Result<(), Error> {
    let sleigh = Pushed { mass: 1.5, inertia: 0.4, offset: 0.6, friction: 0.2, weight: 0.7 };
    let (m, a, c, w) = (sleigh.mass, sleigh.offset, sleigh.friction, sleigh.weight);
    let (whole, push) = (sleigh.inertia + m * a * a, 0.8);
    // m v′ = m a ω² + push − c v − w sin θ, (I + m a²) ω′ = −m a v ω − c ω
    let slope = |y: &SVector<f64, 5>| {
        let [_, _, turned, omega, v] = *y.as_ref();
        let along = a * omega * omega + (push - c * v - w * turned.sin()) / m;
        SVector::from([v * turned.cos(), v * turned.sin(), omega, -(m * a * v + c) * omega / whole, along])
    };
    let expected = crate::order::integrated(slope, SVector::from([0.0, 0.0, 0.0, 1.1, -0.8]), 2.0);
    let error = |steps: usize| -> Result<f64, Error> {
        let stepper = sleigh.stepper(2.0 / steps as f64)?;
        let mut state = stepper.state_moving(Matrix3::identity(), Vector3::new(1.1, -0.8, 0.0))?;
        for _ in 0..steps {
            state = stepper.step_with(&state, &Vector1::new(push))?;
        }
        let q = state.configuration();
        Ok(Vector2::new(q[(0, 2)] - expected[0], q[(1, 2)] - expected[1]).norm())
    };
    let order = (error(80)? / error(160)?).log2();
    assert!((order - 2.0).abs() < 0.1, "order {order}");
    Ok(())
}
