//! Other declarations of the same motion: forces, other discretizations, other groups and sides, methods and lanes.

use clebsch::{Clebsch, Error, F64x4, Method, Scalar};
use nalgebra::{Matrix3, Quaternion, SVector, Vector1, Vector2, Vector3};

/// Suslov's body by one discretization.
macro_rules! suslov {
    ($($name:ident: $discretization:ident;)*) => { $(
        mod $name {
            use clebsch::{Clebsch, Scalar};
            use nalgebra::Matrix3;

            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action     = |F: SO<3>, R: SO<3>| R * F,
                lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
                constraint = |omega| [omega.z == 0],
                discretization = $discretization,
            )]
            pub struct Body<T: Scalar> {
                #[clebsch(symmetric)]
                pub inertia: Matrix3<T>,
            }
        }
    )* };
}

suslov! {
    cayley: cayley;
    exponential: exponential;
    projection: projection;
    moser_veselov: moser_veselov;
}

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

/// The momentum after a second.
macro_rules! momentum {
    ($system:expr, $place:expr, $steps:expr) => {{
        let stepper = $system.into_stepper(1.0 / $steps as f64)?;
        let start = stepper.state_moving($place, Vector3::new(0.9, -0.7, 0.0))?;
        stepper.advance(&start, $steps)?.momentum()
    }};
}

#[test]
fn discretizations_and_groups_agree() -> Result<(), Error> {
    let (inertia, place) = (inertia(), Matrix3::identity());
    let exact = momentum!(moser_veselov::Body { inertia }, place, 20_000);
    let near = |name: &str, coarse: Vector3<f64>, fine: Vector3<f64>| {
        let order = ((coarse - exact).norm() / (fine - exact).norm()).log2();
        assert!((order - 2.0).abs() < 0.05, "{name}: order {order}");
    };
    near("cayley", momentum!(cayley::Body { inertia }, place, 50), momentum!(cayley::Body { inertia }, place, 100));
    near(
        "exponential",
        momentum!(exponential::Body { inertia }, place, 50),
        momentum!(exponential::Body { inertia }, place, 100),
    );
    near(
        "projection",
        momentum!(projection::Body { inertia }, place, 50),
        momentum!(projection::Body { inertia }, place, 100),
    );
    let identity = Quaternion::new(1.0, 0.0, 0.0, 0.0);
    near("quaternions", momentum!(Turned { inertia }, identity, 50), momentum!(Turned { inertia }, identity, 100));
    // a method of sixth order
    let stepper = Turned { inertia }.into_stepper_by::<Fine>(0.05)?;
    let start = stepper.state_moving(identity, Vector3::new(0.9, -0.7, 0.0))?;
    let end = stepper.advance(&start, 20)?;
    assert!((end.momentum() - exact).norm() < 1e-8, "{}", (end.momentum() - exact).norm());
    assert_eq!(<Fine as Method<Turned>>::ORDER, 6);
    Ok(())
}

#[test]
fn lanes_are_bodies_alone() -> Result<(), Error> {
    let wide = moser_veselov::Body { inertia: inertia().map(F64x4::splat) }.into_stepper(F64x4::splat(0.1))?;
    let velocities = [0.9, 0.5, -0.3, 0.0].map(|x| Vector3::new(x, -0.7, 0.0));
    let velocity = Vector3::from_fn(|i, _| F64x4::from_lanes(|lane| velocities[lane][i]));
    let start = wide.state_moving(Matrix3::identity().map(F64x4::splat), velocity)?;
    let end = wide.advance(&start, 50)?;
    for (lane, velocity) in velocities.into_iter().enumerate() {
        let one = moser_veselov::Body { inertia: inertia() }.into_stepper(0.1)?;
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
