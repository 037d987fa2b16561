//! Inertias that change with the configuration: against Lagrange's equations with multipliers, by a method of Runge and
//! Kutta. Their mass matrices and slopes are written by hand.

use clebsch::{Clebsch, Error, Reacting, Space, State};
use nalgebra::*;

use crate::order::integrated;

/// A mechanism in its coordinates, with a mass matrix that changes, a weight, and a constraint that couples them.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |a: Translation<2>, x: Vector2| x + a,
    lagrangian = |x, v| (1 + x.x.powi(2)) * v.x.powi(2) / 2 + (2 + x.y.sin()) * v.y.powi(2) / 2 + self.coupling * v.x * v.y,
    potential  = |x| self.weight * x.x.sin(),
    constraint = |x, v| [v.x == x.y * v.y],
    method Fourth = (order = 4),
)]
pub struct Mechanism {
    pub coupling: f64,
    pub weight: f64,
}

/// Compositions of five steps.
pub struct Fourth;

/// A double pendulum in its two angles. Its tip slides on a straight wire.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |a: Translation<2>, x: Vector2| x + a,
    lagrangian = |x, v| self.mass * (v.x.powi(2) + v.y.powi(2) / 2 + v.x * v.y * (x.x - x.y).cos()),
    potential  = |x| -self.mass * self.gravity * (2 * x.x.cos() + x.y.cos()),
    constraint = |t, x| [x.x.sin() + x.y.sin() == self.wire + self.rate * t],
)]
pub struct Tied {
    pub mass: f64,
    pub gravity: f64,
    pub wire: f64,
    /// The wire moves, metres a second.
    pub rate: f64,
}

/// A body that cannot turn about its third axis, with a mass that slides along the first on a spring.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |(F, a): (SO<3>, Translation<1>), (R, x): (SO<3>, Vector1)| (R * F, x + a),
    lagrangian = |x, (omega, v)| (omega.dot(&(self.inertia * omega)) + self.mass * (x.x.powi(2) * (omega.y.powi(2) + omega.z.powi(2)) + v.norm_squared())) / 2,
    potential  = |x| self.stiffness * x.norm_squared() / 2,
    constraint = |(omega, v)| [omega.z == 0],
)]
pub struct Slider {
    #[clebsch(symmetric)]
    pub inertia: Matrix3<f64>,
    pub mass: f64,
    pub stiffness: f64,
}

/// M, ∂M/∂x₁, ∂M/∂x₂, ∂V, the row A, and A x″.
type Lagrange = (Matrix2<f64>, [Matrix2<f64>; 2], Vector2<f64>, Vector2<f64>, f64);

/// x″ and λ of M x″ + Ṁ v − ½ ∂(vᵀM v) + ∂V = Aᵀλ with A x″ = bend.
fn accelerated((mass, slopes, slope, row, bend): Lagrange, v: Vector2<f64>) -> (Vector2<f64>, f64) {
    let changed = (slopes[0] * v.x + slopes[1] * v.y) * v;
    let centrifugal = Vector2::from(slopes.map(|slope| v.dot(&(slope * v)) / 2.0));
    let force = centrifugal - changed - slope;
    let free = mass.try_inverse().expect("a mass matrix") * force;
    let moved = mass.try_inverse().expect("a mass matrix") * row;
    let multiplier = (bend - row.dot(&free)) / row.dot(&moved);
    (free + moved * multiplier, multiplier)
}

fn of_mechanism(system: &Mechanism, x: Vector2<f64>, v: Vector2<f64>) -> Lagrange {
    let mass = Matrix2::new(1.0 + x.x * x.x, system.coupling, system.coupling, 2.0 + x.y.sin());
    let slopes = [Matrix2::new(2.0 * x.x, 0.0, 0.0, 0.0), Matrix2::new(0.0, 0.0, 0.0, x.y.cos())];
    // v₁ = x₂ v₂, so x₁″ − x₂ x₂″ = v₂²
    (mass, slopes, Vector2::new(system.weight * x.x.cos(), 0.0), Vector2::new(1.0, -x.y), v.y * v.y)
}

fn of_tied(system: &Tied, x: Vector2<f64>, v: Vector2<f64>) -> Lagrange {
    let (m, difference) = (system.mass, x.x - x.y);
    let mass = m * Matrix2::new(2.0, difference.cos(), difference.cos(), 1.0);
    let turned = -m * difference.sin() * Matrix2::new(0.0, 1.0, 1.0, 0.0);
    let weight = m * system.gravity * Vector2::new(2.0 * x.x.sin(), x.y.sin());
    let bend = x.x.sin() * v.x * v.x + x.y.sin() * v.y * v.y;
    (mass, [turned, -turned], weight, Vector2::new(x.x.cos(), x.y.cos()), bend)
}

/// (x, v) a second later, and the multiplier there.
fn exact(lagrange: impl Fn(Vector2<f64>, Vector2<f64>) -> Lagrange, start: Vector4<f64>) -> (Vector4<f64>, f64) {
    let at = |y: &Vector4<f64>| (Vector2::new(y[0], y[1]), Vector2::new(y[2], y[3]));
    let slope = |y: &Vector4<f64>| {
        let (x, v) = at(y);
        let (a, _) = accelerated(lagrange(x, v), v);
        Vector4::new(v.x, v.y, a.x, a.y)
    };
    let end = integrated(slope, start, 1.0);
    let (x, v) = at(&end);
    (end, accelerated(lagrange(x, v), v).1)
}

/// The orders of the configuration, of the momentum and of the reactions after a second. They are from so many steps and
/// from twice as many.
fn orders<S>(
    steps: usize,
    run: impl Fn(usize) -> Result<(State<S>, S::Reactions), Error>,
    (place, momentum, reactions): (S::Configuration, S::Momentum, S::Reactions),
) -> Result<[f64; 3], Error>
where
    S: Reacting<Scalar = f64>,
{
    let error = |steps| -> Result<[f64; 3], Error> {
        let (state, found) = run(steps)?;
        Ok([
            state.configuration().distance_squared(&place).sqrt(),
            state.momentum().distance_squared(&momentum).sqrt(),
            found.distance_squared(&reactions).sqrt(),
        ])
    };
    let (coarse, fine) = (error(steps)?, error(2 * steps)?);
    Ok([(coarse[0] / fine[0]).log2(), (coarse[1] / fine[1]).log2(), (coarse[2] / fine[2]).log2()])
}

/// The end of a second in so many steps, with the reactions there.
fn after_a_second<S: Reacting<Scalar = f64> + Clone>(
    system: &S,
    place: S::Configuration,
    velocity: S::Momentum,
    steps: usize,
) -> Result<(State<S>, S::Reactions), Error> {
    let stepper = system.clone().into_stepper(1.0 / steps as f64)?;
    let state = stepper.advance(&stepper.state_moving(place, velocity)?, steps)?;
    let reactions = stepper.reactions(&state)?;
    Ok((state, reactions))
}

#[test]
fn velocities_of_a_mechanism_are_constrained() -> Result<(), Error> {
    let system = Mechanism { coupling: 0.4, weight: 1.3 };
    let (x, v) = (Vector2::new(0.3, 0.8), Vector2::new(0.64, 0.8));
    let (end, multiplier) = exact(|x, v| of_mechanism(&system, x, v), Vector4::new(x.x, x.y, v.x, v.y));
    let (place, velocity) = (Vector2::new(end[0], end[1]), Vector2::new(end[2], end[3]));
    let momentum = of_mechanism(&system, place, velocity).0 * velocity;
    let found = orders(40, |n| after_a_second(&system, x, v, n), (place, momentum, Vector1::new(multiplier)))?;
    assert!(found.iter().all(|order| (order - 2.0).abs() < 0.1), "{found:?}");

    // composed steps
    let error = |steps: usize| -> Result<f64, Error> {
        let stepper = system.stepper_by::<Fourth>(1.0 / steps as f64)?;
        let state = stepper.advance(&stepper.state_moving(x, v)?, steps)?;
        Ok((state.configuration() - place).norm() + (state.momentum() - momentum).norm())
    };
    let order = (error(10)? / error(20)?).log2();
    assert!((order - 4.0).abs() < 0.3, "{order}");
    Ok(())
}

#[test]
fn places_of_a_mechanism_are_constrained() -> Result<(), Error> {
    let system = Tied { mass: 0.7, gravity: 9.81, wire: 1.1, rate: 0.2 };
    // sin θ₁ + sin θ₂ = 1.1, cos θ₁ ω₁ + cos θ₂ ω₂ = 0.2
    let x = Vector2::new(0.5f64.asin(), 0.6f64.asin());
    let v = Vector2::new(0.9, (0.2 - 0.9 * x.x.cos()) / x.y.cos());
    let (end, multiplier) = exact(|x, v| of_tied(&system, x, v), Vector4::new(x.x, x.y, v.x, v.y));
    let (place, velocity) = (Vector2::new(end[0], end[1]), Vector2::new(end[2], end[3]));
    let momentum = of_tied(&system, place, velocity).0 * velocity;
    let found = orders(100, |n| after_a_second(&system, x, v, n), (place, momentum, Vector1::new(multiplier)))?;
    assert!(found.iter().all(|order| (order - 2.0).abs() < 0.1), "{found:?}");
    Ok(())
}

#[test]
fn a_body_with_a_sliding_mass_is_constrained() -> Result<(), Error> {
    let inertia = Matrix3::new(1.0, 0.1, 0.3, 0.1, 1.4, -0.2, 0.3, -0.2, 0.9);
    let system = Slider { inertia, mass: 0.6, stiffness: 2.5 };
    let total = |x: f64| inertia + system.mass * x * x * Matrix3::from_diagonal(&Vector3::new(0.0, 1.0, 1.0));
    // (ω, x, v): Σω′ = Σω × ω − Σ̇ω + λe₃ with ω₃ = 0, and m x″ = m x (ω₂² + ω₃²) − k x
    let slope = |y: &SVector<f64, 5>| {
        let (omega, x, v) = (Vector3::new(y[0], y[1], y[2]), y[3], y[4]);
        let change = 2.0 * system.mass * x * v * Vector3::new(0.0, omega.y, omega.z);
        let inverse = total(x).try_inverse().expect("an inertia");
        let free = inverse * ((total(x) * omega).cross(&omega) - change);
        let turned = free - inverse.column(2) * (free.z / inverse[(2, 2)]);
        let slid = x * omega.y.powi(2) - system.stiffness * x / system.mass;
        SVector::from([turned.x, turned.y, turned.z, v, slid])
    };
    let start = SVector::from([0.9, -0.7, 0.0, 0.5, 0.4]);
    let end = integrated(slope, start, 1.0);
    let omega = Vector3::new(end[0], end[1], end[2]);
    let free = (total(end[3]) * omega).cross(&omega)
        - 2.0 * system.mass * end[3] * end[4] * Vector3::new(0.0, omega.y, omega.z);
    let multiplier = {
        let inverse = total(end[3]).try_inverse().expect("an inertia");
        -(inverse * free).z / inverse[(2, 2)]
    };
    let turned = total(end[3]) * omega;
    let momentum = Vector4::new(turned.x, turned.y, turned.z, system.mass * end[4]);
    let place = (Matrix3::identity(), Vector1::new(0.5));
    let error = |steps: usize| -> Result<[f64; 3], Error> {
        let velocity = Vector4::new(0.9, -0.7, 0.0, 0.4);
        let (state, reactions) = after_a_second(&system, place, velocity, steps)?;
        let slid = (state.configuration().1.x - end[3]).abs();
        Ok([slid, (state.momentum() - momentum).norm(), (reactions.x - multiplier).abs()])
    };
    let (coarse, fine) = (error(50)?, error(100)?);
    for i in 0..3 {
        let order = (coarse[i] / fine[i]).log2();
        assert!((order - 2.0).abs() < 0.1, "{i}: {coarse:?} {fine:?}");
    }
    Ok(())
}

#[test]
fn steps_with_a_moving_inertia_go_back() -> Result<(), Error> {
    let system = Mechanism { coupling: 0.4, weight: 1.3 };
    let (there, back) = (system.stepper(0.05)?, system.stepper(-0.05)?);
    let start = there.state_moving(Vector2::new(0.3, 0.8), Vector2::new(0.64, 0.8))?;
    let late = there.advance(&start, 100)?;
    let velocity =
        of_mechanism(&system, *late.configuration(), Vector2::zeros()).0.try_inverse().expect("a mass matrix")
            * late.momentum();
    assert!((velocity.x - late.configuration().y * velocity.y).abs() < 1e-13);
    let returned = back.advance(&back.state(*late.configuration(), late.momentum())?, 100)?;
    assert!((returned.configuration() - start.configuration()).amax() < 1e-12);
    assert!((returned.momentum() - start.momentum()).amax() < 1e-12);
    Ok(())
}
