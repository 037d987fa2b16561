//! Rows that fix coordinates of a step at zero take out these unknowns. The same constraints are declared by rows that
//! are no coordinates, so that multipliers are found. Both have the same steps and the same reactions.

use clebsch::{Clebsch, Error, Reacting, Space, State};
use nalgebra::*;

/// A cart with a wheel: it does not slip sideways, and the wheel drives it.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |(F, a): (SE<2>, Translation<1>), (q, wheel): (SE<2>, Vector1)| (q * F, wheel + a),
    lagrangian = |(xi, w)| (self.inertia * xi.x.powi(2) + self.mass * (xi.y.powi(2) + (xi.z + self.offset * xi.x).powi(2)) + self.spin * w.x.powi(2)) / 2,
    potential  = |q| self.slope * q.translation().y,
    force      = |(xi, w)| (-self.drag * xi, -self.drag * w),
    constraint = |(xi, w)| [xi.z == 0, xi.y == self.radius * w.x],
)]
pub struct Cart {
    pub mass: f64,
    pub inertia: f64,
    pub offset: f64,
    pub spin: f64,
    pub slope: f64,
    pub drag: f64,
    pub radius: f64,
}

/// The same velocities, by two rows that mix them.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |(F, a): (SE<2>, Translation<1>), (q, wheel): (SE<2>, Vector1)| (q * F, wheel + a),
    lagrangian = |(xi, w)| (self.inertia * xi.x.powi(2) + self.mass * (xi.y.powi(2) + (xi.z + self.offset * xi.x).powi(2)) + self.spin * w.x.powi(2)) / 2,
    potential  = |q| self.slope * q.translation().y,
    force      = |(xi, w)| (-self.drag * xi, -self.drag * w),
    constraint = |(xi, w)| [xi.z + xi.y == self.radius * w.x, xi.z - xi.y == -self.radius * w.x],
)]
pub struct MixedCart {
    pub mass: f64,
    pub inertia: f64,
    pub offset: f64,
    pub spin: f64,
    pub slope: f64,
    pub drag: f64,
    pub radius: f64,
}

/// Two bodies that pull at each other. Each turns about two of its axes.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: [SO<3>; 2], R: [SO<3>; 2]| [R[0] * F[0], R[1] * F[1]],
    lagrangian = |omega| (0..2).map(|i| omega[i].dot(&(self.inertia[i] * omega[i])) / 2).sum(),
    potential  = |R| self.stiffness * (R[0].transpose() * R[1] * self.axis).z,
    constraint = |omega| [omega[0].z == 0, omega[1].x == 0],
    method Fourth = (order = 4),
)]
pub struct Pair {
    #[clebsch(symmetric)]
    pub inertia: [Matrix3<f64>; 2],
    pub stiffness: f64,
    pub axis: Vector3<f64>,
}

/// The same by axes that are parameters.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: [SO<3>; 2], R: [SO<3>; 2]| [R[0] * F[0], R[1] * F[1]],
    lagrangian = |omega| (0..2).map(|i| omega[i].dot(&(self.inertia[i] * omega[i])) / 2).sum(),
    potential  = |R| self.stiffness * (R[0].transpose() * R[1] * self.axis).z,
    constraint = |omega| [omega[0].dot(&self.fixed[0]) == 0, omega[1].dot(&self.fixed[1]) == 0],
    method Fourth = (order = 4),
)]
pub struct PairByAxes {
    #[clebsch(symmetric)]
    pub inertia: [Matrix3<f64>; 2],
    pub stiffness: f64,
    pub axis: Vector3<f64>,
    pub fixed: [Vector3<f64>; 2],
}

/// Compositions of five steps.
pub struct Fourth;

/// A bead on a sphere with a flag that cannot turn about its pole.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |(a, F): (Translation<3>, SO<3>), (x, R): (Vector3, SO<3>)| (x + a, R * F),
    lagrangian = |(v, w)| (self.mass * v.norm_squared() + w.dot(&(self.inertia * w))) / 2,
    potential  = |x, R| self.weight * x.dot(&(R * self.flag)),
    constraint = [|x| [x.norm_squared() == 1], |(v, w)| [w.z == 0]],
)]
pub struct Flag {
    pub mass: f64,
    #[clebsch(symmetric)]
    pub inertia: Matrix3<f64>,
    pub weight: f64,
    pub flag: Vector3<f64>,
}

/// The same with the pole as a parameter.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |(a, F): (Translation<3>, SO<3>), (x, R): (Vector3, SO<3>)| (x + a, R * F),
    lagrangian = |(v, w)| (self.mass * v.norm_squared() + w.dot(&(self.inertia * w))) / 2,
    potential  = |x, R| self.weight * x.dot(&(R * self.flag)),
    constraint = [|x| [x.norm_squared() == 1], |(v, w)| [w.dot(&self.pole) == 0]],
)]
pub struct FlagByPole {
    pub mass: f64,
    #[clebsch(symmetric)]
    pub inertia: Matrix3<f64>,
    pub weight: f64,
    pub flag: Vector3<f64>,
    pub pole: Vector3<f64>,
}

/// A body that cannot turn at all: no unknown is left.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<3>, R: SO<3>| R * F,
    lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
    potential  = |R| self.weight * (R * self.center).z,
    constraint = |omega| [omega.x == 0, omega.y == 0, omega.z == 0],
)]
pub struct Clamped {
    #[clebsch(symmetric)]
    pub inertia: Matrix3<f64>,
    pub weight: f64,
    pub center: Vector3<f64>,
}

fn inertia() -> Matrix3<f64> {
    Matrix3::new(1.0, 0.1, 0.3, 0.1, 1.4, -0.2, 0.3, -0.2, 0.9)
}

fn tilted() -> Matrix3<f64> {
    Rotation3::from_scaled_axis(Vector3::new(0.4, -0.9, 0.3)).into_inner()
}

/// Steps of both from the same start: the largest distance of their states, and of their reactions.
fn differences<A, B>(
    (a, mut at): (&clebsch::Stepper<A>, State<A>),
    (b, mut bt): (&clebsch::Stepper<B>, State<B>),
    mixed: impl Fn(B::Reactions) -> A::Reactions,
) -> Result<[f64; 2], Error>
where
    A: Reacting<Scalar = f64>,
    B: Reacting<Scalar = f64, Configuration = A::Configuration, Momentum = A::Momentum, Input = A::Input>,
{
    let mut largest = [0.0f64; 2];
    for _ in 0..200 {
        let (next, reactions) = a.step_with_reactions(&at)?;
        let (other, others) = b.step_with_reactions(&bt)?;
        let apart = next.configuration().distance_squared(other.configuration()).sqrt();
        largest[0] = largest[0].max(apart).max(next.momentum().distance_squared(&other.momentum()).sqrt());
        largest[1] = largest[1].max(reactions.distance_squared(&mixed(others)).sqrt());
        (at, bt) = (next, other);
    }
    Ok(largest)
}

#[test]
fn rows_that_are_coordinates_and_others_are_one_constraint() -> Result<(), Error> {
    let cart = Cart { mass: 2.0, inertia: 0.7, offset: 0.3, spin: 0.4, slope: 1.1, drag: 0.2, radius: 0.6 };
    let Cart { mass, inertia, offset, spin, slope, drag, radius } = cart;
    let mixed = MixedCart { mass, inertia, offset, spin, slope, drag, radius };
    let (a, b) = (cart.stepper(0.05)?, mixed.stepper(0.05)?);
    let place = (Matrix3::new(0.8, -0.6, 1.0, 0.6, 0.8, -2.0, 0.0, 0.0, 1.0), Vector1::new(0.3));
    let velocity = Vector4::new(0.9, 0.6, 0.0, 1.0);
    let starts = (a.state_moving(place, velocity)?, b.state_moving(place, velocity)?);
    // λ·A: (λ₁ + λ₂) along v_y, (λ₁ − λ₂) along v_x − r w
    let [state, reaction] =
        differences((&a, starts.0), (&b, starts.1), |mixed| Vector2::new(mixed.x + mixed.y, mixed.x - mixed.y))?;
    assert!(state < 1e-12 && reaction < 1e-11, "{state:e} {reaction:e}");
    Ok(())
}

#[test]
fn fixed_coordinates_of_two_bodies() -> Result<(), Error> {
    let (inertia, stiffness, axis) = ([inertia(), 1.7 * inertia()], 1.3, Vector3::new(0.3, 0.5, 0.8));
    let pair = Pair { inertia, stiffness, axis };
    let by_axes = PairByAxes { inertia, stiffness, axis, fixed: [Vector3::z(), Vector3::x()] };
    let places = [tilted(), tilted().transpose()];
    let velocity = Vector6::new(0.9, -0.7, 0.0, 0.0, 0.4, 1.1);
    let (a, b) = (pair.stepper(0.05)?, by_axes.stepper(0.05)?);
    let starts = (a.state_moving(places, velocity)?, b.state_moving(places, velocity)?);
    let [state, reaction] = differences((&a, starts.0), (&b, starts.1), |same| same)?;
    assert!(state < 1e-12 && reaction < 1e-11, "{state:e} {reaction:e}");
    let (a, b) = (pair.stepper_by::<Fourth>(0.1)?, by_axes.stepper_by::<Fourth>(0.1)?);
    let at = a.advance(&a.state_moving(places, velocity)?, 100)?;
    let bt = b.advance(&b.state_moving(places, velocity)?, 100)?;
    assert!((at.momentum() - bt.momentum()).amax() < 1e-12);
    Ok(())
}

#[test]
fn fixed_coordinates_next_to_places() -> Result<(), Error> {
    let (mass, weight, flag) = (0.8, 0.9, Vector3::new(0.2, -0.4, 1.0));
    let flagged = Flag { mass, inertia: inertia(), weight, flag };
    let by_pole = FlagByPole { mass, inertia: inertia(), weight, flag, pole: Vector3::z() };
    let (a, b) = (flagged.stepper(0.05)?, by_pole.stepper(0.05)?);
    let place = (Vector3::new(0.6, 0.0, 0.8), tilted());
    let velocity = Vector6::new(0.8, 0.3, -0.6, 0.5, -0.7, 0.0);
    let starts = (a.state_moving(place, velocity)?, b.state_moving(place, velocity)?);
    let [state, reaction] = differences((&a, starts.0), (&b, starts.1), |same| same)?;
    assert!(state < 1e-12 && reaction < 1e-11, "{state:e} {reaction:e}");
    Ok(())
}

#[test]
fn a_body_without_any_freedom_stays() -> Result<(), Error> {
    let clamped = Clamped { inertia: inertia(), weight: 2.0, center: Vector3::new(0.1, 0.3, -0.2) };
    let stepper = clamped.stepper(0.1)?;
    let start = stepper.state(tilted(), Vector3::zeros())?;
    let (next, reactions) = stepper.step_with_reactions(&start)?;
    assert_eq!(next.configuration(), start.configuration());
    assert!(next.momentum().amax() < 1e-16, "{}", next.momentum());
    // against the torque c × (−w Rᵀe₃) of the weight
    let torque = clamped.weight * (tilted().transpose() * Vector3::z()).cross(&clamped.center);
    assert!((reactions + torque).amax() < 1e-14, "{reactions} {torque}");
    Ok(())
}

#[test]
fn coordinates_that_are_fixed_have_no_equation() {
    for derivation in [Cart::DERIVATION, Pair::DERIVATION, Flag::DERIVATION, Clamped::DERIVATION] {
        assert!(derivation.contains("At zero by the constraint, without an equation: "), "{derivation}");
    }
    for derivation in [MixedCart::DERIVATION, PairByAxes::DERIVATION, FlagByPole::DERIVATION] {
        assert!(!derivation.contains("At zero by the constraint"), "{derivation}");
    }
}
