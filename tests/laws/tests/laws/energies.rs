//! Energies of Lagrangians in other words, and a momentum that the time alone pushes.

use clebsch::{Clebsch, Error, Method};
use nalgebra::Vector1;

/// Declares systems on a line.
macro_rules! lines {
    ($($name:ident { $($declaration:tt)* })*) => {$(
        #[derive(Clebsch, Clone, Debug)]
        #[clebsch(action = |a: Translation<1>, x: Vector1| x + a, $($declaration)*)]
        struct $name {
            level: f64,
            speed: f64,
        }
    )*};
}

lines! {
    InLagrangian { lagrangian = |v| v.norm_squared() / 2 - self.level * self.speed }
    InPotential { lagrangian = |v| v.norm_squared() / 2, potential = |x| self.level * self.speed + 0 * x.x }
    OfOrderFour { lagrangian = |v| v.norm_squared() / 2 - self.level * self.speed, order = 4 }
    WithPlace { lagrangian = |x, v| v.norm_squared() / 2 - self.level * self.speed - x.x.powi(2) }
    OfTime { lagrangian = |t, v| v.norm_squared() / 2 - self.level * self.speed * t }
    InCost { cost = |h, a| a.norm_squared() / (2 * h) - h * self.level * self.speed }
    Relativistic { lagrangian = |v| -self.level * self.speed.powi(2) * (1 - v.norm_squared() / self.speed.powi(2)).sqrt() }
}

const LEVEL: f64 = 2.0;
const SPEED: f64 = 3.0;

macro_rules! energy {
    ($name:ident, $t:expr, $x:expr, $momentum:expr) => {{
        let stepper = $name { level: LEVEL, speed: SPEED }.into_stepper(0.1)?;
        stepper.energy(&stepper.state_at($t, Vector1::new($x), Vector1::new($momentum))?)
    }};
    ($name:ident, $x:expr, $momentum:expr) => {{
        let stepper = $name { level: LEVEL, speed: SPEED }.into_stepper(0.1)?;
        stepper.energy(&stepper.state(Vector1::new($x), Vector1::new($momentum))?)
    }};
}

/// E = ξ·∂ℓ/∂ξ − ℓ, constants of ℓ and functions of the time included: a term has one meaning wherever it stands.
#[test]
fn energies_have_the_constants_of_their_lagrangians() -> Result<(), Error> {
    let (kinetic, level) = (0.5, LEVEL * SPEED);
    assert_eq!(energy!(InLagrangian, 0.5, 1.0), kinetic + level);
    assert_eq!(energy!(InPotential, 0.5, 1.0), kinetic + level);
    assert_eq!(energy!(WithPlace, 0.5, 1.0), kinetic + level + 0.25);
    assert_eq!(energy!(OfTime, 3.0, 0.5, 1.0), kinetic + 3.0 * level);
    assert_eq!(energy!(InCost, 0.5, 1.0), kinetic + level);
    // √(m²c⁴ + p²c²)
    let relativistic = ((LEVEL * SPEED * SPEED).powi(2) + SPEED * SPEED).sqrt();
    assert!((energy!(Relativistic, 0.5, 1.0) - relativistic).abs() < 1e-13);
    Ok(())
}

/// A constant pushes nothing: a step is the exact motion, of any order.
#[test]
fn constants_leave_free_motions_exact() {
    for derivation in [InLagrangian::DERIVATION, OfOrderFour::DERIVATION, InCost::DERIVATION] {
        assert!(derivation.contains("a step is the exact motion"), "{derivation}");
    }
    assert_eq!(
        std::any::type_name::<<OfOrderFour as Clebsch>::Scheme>(),
        std::any::type_name::<<InLagrangian as Clebsch>::Scheme>()
    );
}

struct Fourth;
struct Sixth;

/// A charge in an electric field that changes with the time, by its vector potential A(t).
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action        = |a: Translation<1>, x: Vector1| x + a,
    lagrangian    = |t, v| self.mass * v.norm_squared() / 2 + (self.rate * t).cos() * v.x,
    emit          = [tangent],
    method Fourth = (order = 4),
    method Sixth  = (order = 6),
)]
struct Charge {
    mass: f64,
    rate: f64,
}

/// The distance from x(t) = (N t − sin(ω t)/ω)/m.
fn error<M: Method<Charge>>(h: f64, steps: usize) -> Result<f64, Error> {
    let (mass, rate, momentum) = (1.5, 2.0, 0.7);
    let stepper = Charge { mass, rate }.into_stepper_by::<M>(h)?;
    let end = stepper.advance(&stepper.state(Vector1::zeros(), Vector1::new(momentum))?, steps)?;
    let t = h * steps as f64;
    assert!((end.momentum().x - momentum).abs() < 1e-14, "N is conserved");
    Ok((end.configuration().x - (momentum * t - (rate * t).sin() / rate) / mass).abs())
}

#[test]
fn a_charge_follows_the_vector_potential_of_the_time() -> Result<(), Error> {
    let orders = [
        (error::<clebsch::Declared>(0.1, 10)? / error::<clebsch::Declared>(0.05, 20)?).log2(),
        (error::<Fourth>(0.2, 5)? / error::<Fourth>(0.1, 10)?).log2(),
        (error::<Sixth>(0.4, 3)? / error::<Sixth>(0.2, 6)?).log2(),
    ];
    for (measured, order) in orders.into_iter().zip([2.0, 4.0, 6.0]) {
        assert!((measured / order - 1.0).abs() < 0.05, "{measured} for {order}");
    }
    Ok(())
}
