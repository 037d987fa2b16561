//! Momenta alone, `emit = [momentum]`: they move as those of the bodies whose attitude is stepped with them.

use clebsch::{Clebsch, Error, F64x4, Scalar, Space, State, Stepper};
use clebsch_tests::fixtures::free_rigid_body::FreeRigidBody;
use clebsch_tests::fixtures::tumbling_momentum::TumblingMomentum;
use clebsch_tests::oracle::body;
use clebsch_tests::oracle::near::assert_near;
use clebsch_tests::oracle::random::Random;
use nalgebra::{Matrix3, Matrix4, SVector, Vector3, Vector6};

/// Declares a system twice: `whole` with its configuration, `alone` without it.
macro_rules! both {
    ($($module:ident { $($key:ident = $value:expr),* } $fields:tt)*) => { $(
        pub mod $module {
            pub mod whole { both! { @one [] $($key = $value),* ; $fields } }
            pub mod alone { both! { @one [emit = [momentum],] $($key = $value),* ; $fields } }
        }
    )* };
    (@one [$($emit:tt)*] $($key:ident = $value:expr),* ; { $($field:ident: $ty:ty),* }) => {
        use clebsch::{Clebsch, Scalar};
        use nalgebra::*;

        #[derive(Clebsch, Clone, Debug)]
        #[clebsch($($key = $value,)* $($emit)*)]
        pub struct System<T: Scalar> {
            $(pub $field: $ty,)*
        }
    };
}
both! {
    left {
        action = |F: SO<3>, R: SO<3>| F * R,
        lagrangian = |omega| omega.dot(&(Matrix3::from_diagonal(&self.moments) * omega)) / 2
    } { moments: Vector3<T> }
    wheeled {
        action = |F: SO<3>, R: SO<3>| R * F,
        lagrangian = |omega| omega.dot(&(Matrix3::from_diagonal(&self.moments) * omega)) / 2,
        force = |omega, torque: Vector3| torque - self.damping * omega
    } { moments: Vector3<T>, damping: T }
    sixth {
        action = |F: SO<3>, R: SO<3>| R * F,
        lagrangian = |omega| omega.dot(&(Matrix3::from_diagonal(&self.moments) * omega)) / 2,
        order = 6
    } { moments: Vector3<T> }
    exact {
        action = |F: SO<3>, R: SO<3>| R * F,
        lagrangian = |omega| omega.dot(&(Matrix3::from_diagonal(&self.moments) * omega)) / 2,
        discretization = exact
    } { moments: Vector3<T> }
    growing {
        action = |F: SU<2>, q: SU<2>| q * F,
        lagrangian = |t, omega| omega.dot(&(Matrix3::from_diagonal(&self.moments) * omega)) * (2 + t.sin()) / 2
    } { moments: Vector3<T> }
    fourfold {
        action = |F: SO<4>, R: SO<4>| R * F,
        cost = |h, F| (Matrix4::from_diagonal(&self.j_d) * (F - I) * (F - I).transpose()).trace() / h,
        solver = fixed_point
    } { j_d: Vector4<T> }
    fourfold_exact {
        action = |F: SO<4>, R: SO<4>| R * F,
        lagrangian = |xi| (Matrix4::from_diagonal(&self.mass) * xi.matrix() * xi.matrix().transpose()).trace() / 2,
        discretization = exact
    } { mass: Vector4<T> }
    moving {
        action = |F: SE<3>, q: SE<3>| q * F,
        lagrangian = |(omega, v)| (omega.dot(&(Matrix3::from_diagonal(&self.moments) * omega)) + v.dot(&(Matrix3::from_diagonal(&self.masses) * v))) / 2
    } { moments: Vector3<T>, masses: Vector3<T> }
    several {
        action = |(F, G): (SO<3>, SO<3>), (R, S): (SO<3>, SO<3>)| (F * R, S * G),
        lagrangian = |(xi, eta)| (xi.dot(&(Matrix3::from_diagonal(&self.moments) * xi)) + eta.dot(&(Matrix3::from_diagonal(&self.moments) * eta))) / 2 + self.coupling * xi.dot(&eta)
    } { moments: Vector3<T>, coupling: T }
}

fn moments() -> Vector3<f64> {
    Vector3::new(1.0, 2.0, 2.8)
}

/// The momenta of both, step by step, and their energies: but for rounding, as code that makes no attitude is optimised anew.
#[track_caller]
fn assert_same<S, P, const M: usize>(whole: &Stepper<S>, alone: &Stepper<P>, q: S::Configuration, mu: SVector<f64, M>)
where
    S: Clebsch<Scalar = f64, Momentum = SVector<f64, M>>,
    P: Clebsch<Scalar = f64, Momentum = SVector<f64, M>, Configuration = ()>,
{
    let (mut a, mut b): (State<S>, State<P>) =
        (whole.state(q, mu).expect("a state"), alone.state((), mu).expect("a state"));
    for _ in 0..100 {
        (a, b) = (whole.step(&a).expect("a step"), alone.step(&b).expect("a step"));
        assert_near(&a.momentum(), &b.momentum(), 1e-13, S::NAME);
        assert!((whole.energy(&a) - alone.energy(&b)).abs() < 1e-12);
    }
    assert!((a.momentum() - mu).norm() > 1e-2, "{}: a momentum that rests shows nothing", S::NAME);
    let late = alone.advance(&alone.state((), mu).expect("a state"), 100).expect("steps");
    assert_near(&late.momentum(), &b.momentum(), 1e-13, S::NAME);
}

#[test]
fn momenta_move_as_with_their_configuration() -> Result<(), Error> {
    let (random, h) = (&mut Random::new(91), 0.05);
    let (r, pi) = (random.attitude::<3>(), Vector3::new(1.1, 2.0, -0.7));
    macro_rules! compare {
        ($module:ident { $($field:ident: $value:expr),* }, $q:expr, $mu:expr) => {
            let whole = $module::whole::System { $($field: $value),* }.into_stepper(h)?;
            let alone = $module::alone::System { $($field: $value),* }.into_stepper(h)?;
            assert_same(&whole, &alone, $q, $mu);
        };
    }
    compare!(left { moments: moments() }, r, pi);
    compare!(wheeled { moments: moments(), damping: 0.3 }, r, pi);
    compare!(sixth { moments: moments() }, r, pi);
    compare!(exact { moments: moments() }, r, pi);
    compare!(growing { moments: moments() }, nalgebra::Quaternion::new(0.6, 0.0, 0.8, 0.0), pi);
    let six = Vector6::new(0.6, -1.0, 0.4, 1.2, -0.2, 1.0);
    compare!(fourfold { j_d: [1.0, 1.5, 2.0, 2.5].into() }, random.attitude::<4>(), six);
    compare!(fourfold_exact { mass: [1.0, 1.5, 2.0, 2.5].into() }, random.attitude::<4>(), six);
    compare!(moving { moments: moments(), masses: Vector3::new(1.0, 1.4, 2.0) }, Matrix4::identity(), six);
    compare!(several { moments: moments(), coupling: 0.3 }, (r, random.attitude::<3>()), six);
    Ok(())
}

/// Not only on our own bodies: π⁺ = Fᵀπ with F from another solver, and |π| and the energy, which free bodies conserve.
#[test]
fn free_momenta_obey_moser_and_veselov() -> Result<(), Error> {
    let (h, inertia) = (0.1, Matrix3::new(1.4, 0.1, 0.0, 0.1, 2.0, -0.2, 0.0, -0.2, 2.6));
    let stepper = TumblingMomentum { inertia }.into_stepper(h)?;
    let start = stepper.state((), Vector3::new(0.3, 2.0, 0.6))?;
    let (mut state, mut pi) = (start, start.momentum());
    for _ in 0..100 {
        (state, pi) = (stepper.step(&state)?, body::drift(&inertia, h, &pi).transpose() * pi);
        assert_near(&state.momentum(), &pi, 1e-13, "π");
    }
    for state in stepper.trajectory(start).take(100_000) {
        let state = state?;
        assert!((state.momentum().norm() / start.momentum().norm() - 1.0).abs() < 1e-12);
        assert!((stepper.energy(&state) / stepper.energy(&start) - 1.0).abs() < 1e-12);
    }
    assert!(size_of::<State<TumblingMomentum>>() + size_of::<Matrix3<f64>>() <= size_of::<State<FreeRigidBody>>());
    Ok(())
}

/// A body of revolution, whose momentum about its axis is conserved; the spatial ones need the attitude.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<3>, R: SO<3>| R * F,
    lagrangian = |omega| (self.across * (omega.x.powi(2) + omega.y.powi(2)) + self.along * omega.z.powi(2)) / 2,
    emit       = [momentum],
)]
pub struct Revolved {
    pub across: f64,
    pub along: f64,
}

#[test]
fn what_needs_no_configuration_is_conserved() -> Result<(), Error> {
    let stepper = Revolved { across: 1.0, along: 2.0 }.into_stepper(0.1)?;
    let start = stepper.state((), Vector3::new(0.4, 1.2, -0.7))?;
    assert_eq!(stepper.conserved(&start).values(), &[-0.7]);
    assert!(Revolved::DERIVATION.contains("Conserved: the momentum about e3, body.\n\n"));
    let late = stepper.advance(&start, 10_000)?;
    assert!((late.momentum().z + 0.7).abs() < 1e-13 && (late.momentum().x - 0.4).abs() > 1e-2);
    Ok(())
}

/// Inputs of forces reach the momentum, lanes are bodies, and there is nothing to step on the cotangent bundle.
#[test]
fn momenta_alone_are_systems_like_others() -> Result<(), Error> {
    let torque = Vector3::new(0.2, -0.1, 0.4);
    let (r, pi) = (Matrix3::identity(), Vector3::new(1.1, 2.0, -0.7));
    let whole = wheeled::whole::System { moments: moments(), damping: 0.3 }.into_stepper(0.05)?;
    let alone = wheeled::alone::System { moments: moments(), damping: 0.3 }.into_stepper(0.05)?;
    let (a, b) = (whole.step_with(&whole.state(r, pi)?, &torque)?, alone.step_with(&alone.state((), pi)?, &torque)?);
    assert_near(&a.momentum(), &b.momentum(), 1e-15, "π under a torque");
    assert!((alone.step(&alone.state((), pi)?)?.momentum() - b.momentum()).norm() > 1e-3);

    let lanes = sixth::alone::System { moments: moments().map(F64x4::from_f64) }.into_stepper(F64x4::from_f64(0.05))?;
    let one = sixth::alone::System { moments: moments() }.into_stepper(0.05)?;
    let momenta = [1.0, 0.5, -2.0, 0.0].map(|size| pi * size);
    let stepped = lanes.step(&lanes.state((), Vector3::side_by_side(|lane| momenta[lane]))?)?;
    for (lane, momentum) in momenta.into_iter().enumerate() {
        assert_eq!(stepped.lane(lane).1, one.step(&one.state((), momentum)?)?.momentum());
    }

    let upstairs = one.cotangent_state((), ())?;
    assert_eq!(one.step_symmetric(&upstairs), Err(Error::NoCovector));
    assert_eq!(one.momentum_map(&(), &()), Vector3::zeros());
    assert!(matches!(one.state((), pi * f64::NAN), Err(Error::NotFinite { .. })));
    Ok(())
}
