//! A body that nothing acts on, turning near its middle axis.

use super::rotation::{
    Compact, compact, compact_rates, defect, pack, pack_quaternion, rates, split, split_compact, unpack_compact,
};
use crate::classical::{Equation, VectorField};
use crate::motion::Scene;
use crate::setting::{Setting, declared};
use clebsch::Clebsch;
use clebsch_examples::jacobi::Jacobi;
use nalgebra::{Matrix3, Quaternion, Vector3, Vector6};
use std::hint::black_box;

const MOMENTS: Vector3<f64> = Vector3::new(1.0, 2.0, 3.0);
const MOMENTUM: Vector3<f64> = Vector3::new(0.3, 2.0, 0.6);

struct MoserVeselovSecond;
struct MoserVeselovFourth;
struct MoserVeselovSixth;
struct MoserVeselovEighth;
struct CayleySecond;
struct CayleyFourth;
struct CayleySixth;
struct CayleyEighth;
struct ExponentialSecond;
struct ExponentialFourth;
struct ExponentialSixth;
struct ExponentialEighth;
struct ProjectionSecond;
struct ProjectionFourth;
struct ProjectionSixth;
struct ProjectionEighth;
struct Exact;
struct ChordSecond;
struct ChordFourth;
struct ChordSixth;
struct ChordEighth;
struct QuaternionSecond;
struct QuaternionFourth;
struct QuaternionSixth;
struct QuaternionEighth;

/// A free body, in one form after another, in every order; without kicks order 1 is order 2. `Exact` is the motion itself, which no order makes better.
#[derive(Clebsch, Clone, Copy, Debug)]
#[clebsch(
    action     = |F: SO<3>, R: SO<3>| R * F,
    lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
    method Exact = (discretization = exact),
    method MoserVeselovSecond = (order = 2, discretization = moser_veselov),
    method MoserVeselovFourth = (order = 4, discretization = moser_veselov),
    method MoserVeselovSixth  = (order = 6, discretization = moser_veselov),
    method MoserVeselovEighth = (order = 8, discretization = moser_veselov),
    method CayleySecond       = (order = 2, discretization = cayley),
    method CayleyFourth       = (order = 4, discretization = cayley),
    method CayleySixth        = (order = 6, discretization = cayley),
    method CayleyEighth       = (order = 8, discretization = cayley),
    method ExponentialSecond  = (order = 2, discretization = exponential),
    method ExponentialFourth  = (order = 4, discretization = exponential),
    method ExponentialSixth   = (order = 6, discretization = exponential),
    method ExponentialEighth  = (order = 8, discretization = exponential),
    method ProjectionSecond   = (order = 2, discretization = projection),
    method ProjectionFourth   = (order = 4, discretization = projection),
    method ProjectionSixth    = (order = 6, discretization = projection),
    method ProjectionEighth   = (order = 8, discretization = projection),
)]
struct Body {
    /// Inertia tensor, kg·m².
    #[clebsch(symmetric)]
    inertia: Matrix3<f64>,
}

/// The same body by unit quaternions and the chord of the rotation of a step.
#[derive(Clebsch, Clone, Copy, Debug)]
#[clebsch(
    action = |F: SU<2>, Q: SU<2>| Q * F,
    cost   = |h, F| 2 * F.imag().dot(&(self.inertia * F.imag())) / h,
    method ChordSecond = (order = 2),
    method ChordFourth = (order = 4),
    method ChordSixth  = (order = 6),
    method ChordEighth = (order = 8),
)]
struct Chord {
    /// Inertia tensor, kg·m².
    #[clebsch(symmetric)]
    inertia: Matrix3<f64>,
}

/// The same by unit quaternions and its Lagrangian.
#[derive(Clebsch, Clone, Copy, Debug)]
#[clebsch(
    action     = |F: SU<2>, Q: SU<2>| Q * F,
    lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
    method QuaternionSecond = (order = 2, discretization = cayley),
    method QuaternionFourth = (order = 4, discretization = cayley),
    method QuaternionSixth  = (order = 6, discretization = cayley),
    method QuaternionEighth = (order = 8, discretization = cayley),
)]
struct Turn {
    /// Inertia tensor, kg·m².
    #[clebsch(symmetric)]
    inertia: Matrix3<f64>,
}

fn declarations(inertia: Matrix3<f64>) -> Vec<Box<dyn Setting<12>>> {
    let body = Body { inertia };
    let chord = Chord { inertia };
    let turn = Turn { inertia };
    let attitude = (unturned(), MOMENTUM);
    let quaternion = (unit(), MOMENTUM);
    vec![
        declared(MoserVeselovSecond, "moser_veselov", body, attitude, pack),
        declared(MoserVeselovFourth, "moser_veselov", body, attitude, pack),
        declared(MoserVeselovSixth, "moser_veselov", body, attitude, pack),
        declared(MoserVeselovEighth, "moser_veselov", body, attitude, pack),
        declared(CayleySecond, "cayley", body, attitude, pack),
        declared(CayleyFourth, "cayley", body, attitude, pack),
        declared(CayleySixth, "cayley", body, attitude, pack),
        declared(CayleyEighth, "cayley", body, attitude, pack),
        declared(ExponentialSecond, "exponential", body, attitude, pack),
        declared(ExponentialFourth, "exponential", body, attitude, pack),
        declared(ExponentialSixth, "exponential", body, attitude, pack),
        declared(ExponentialEighth, "exponential", body, attitude, pack),
        declared(ProjectionSecond, "projection", body, attitude, pack),
        declared(ProjectionFourth, "projection", body, attitude, pack),
        declared(ProjectionSixth, "projection", body, attitude, pack),
        declared(ProjectionEighth, "projection", body, attitude, pack),
        declared(ChordSecond, "quaternion chord", chord, quaternion, pack_quaternion),
        declared(ChordFourth, "quaternion chord", chord, quaternion, pack_quaternion),
        declared(ChordSixth, "quaternion chord", chord, quaternion, pack_quaternion),
        declared(ChordEighth, "quaternion chord", chord, quaternion, pack_quaternion),
        declared(QuaternionSecond, "quaternion cayley", turn, quaternion, pack_quaternion),
        declared(QuaternionFourth, "quaternion cayley", turn, quaternion, pack_quaternion),
        declared(QuaternionSixth, "quaternion cayley", turn, quaternion, pack_quaternion),
        declared(QuaternionEighth, "quaternion cayley", turn, quaternion, pack_quaternion),
        declared(Exact, "exact", body, attitude, pack),
    ]
}

fn unturned() -> Matrix3<f64> {
    Matrix3::identity()
}

fn unit() -> Quaternion<f64> {
    Quaternion::identity()
}

/// Euler's equations.
#[derive(Clone)]
struct Turning {
    inverse: Vector3<f64>,
}

impl VectorField<7> for Turning {
    #[inline(always)]
    fn rates(&self, y: &Compact) -> Compact {
        let (attitude, momentum) = split_compact(y);
        let omega = self.inverse.component_mul(&momentum);
        compact_rates(&attitude, &omega, &momentum.cross(&omega))
    }
}

/// Moments of inertia 1, 2 and 3.
pub fn scene() -> Scene<12> {
    let inertia = Matrix3::from_diagonal(&black_box(MOMENTS));
    let inverse = inertia.map(|entry| if entry == 0.0 { 0.0 } else { 1.0 / entry });
    let field = move |y: &_| {
        let (attitude, momentum) = split(y);
        let omega = inverse * momentum;
        rates(&attitude, &omega, &momentum.cross(&omega))
    };
    let mut settings = declarations(inertia);
    let equation = Turning { inverse: inverse.diagonal() };
    settings.extend(Equation { field: equation, start: compact(&unit(), &MOMENTUM), flat: unpack_compact }.settings());
    Scene {
        name: "free_body",
        title: "free rigid body",
        duration: 100.0,
        start: pack(&unturned(), &MOMENTUM),
        field: Box::new(field),
        energy: Box::new(move |y| split(y).1.dot(&(inverse * split(y).1)) / 2.0),
        momenta,
        constraint: defect,
        split: 9,
        momentum_size: MOMENTUM.norm(),
        closed_form: Some(closed_form),
        known: None,
        reference_steps: 80_000,
        longer: 10,
        least_error: 0.0,
        shows_sixteen: true,
        settings,
    }
}

/// The body momentum at a time, (a cn, b sn, c dn). The body turns about its third axis rather than its first, L² > 2E
/// J₂.
///
/// Source: Landau and Lifshitz, *Mechanics*, §37.
fn closed_form(time: f64) -> Option<Vector3<f64>> {
    let [j1, j2, j3] = [MOMENTS.x, MOMENTS.y, MOMENTS.z];
    let (square, double_energy) = (MOMENTUM.norm_squared(), MOMENTUM.dot(&MOMENTUM.component_div(&MOMENTS)));
    let (above, below) = (square - double_energy * j1, double_energy * j3 - square);
    let [a, b, c] =
        [j1 * below / (j3 - j1), j2 * below / (j3 - j2), j3 * above / (j3 - j1)].map(|square: f64| square.sqrt());
    let rate = ((j3 - j2) * above / (j1 * j2 * j3)).sqrt();
    let m = (j2 - j1) * below / ((j3 - j2) * above);
    let functions = Jacobi::new(m, 1.0 - m)?;
    let start = functions.argument((MOMENTUM.y / b).atan2(MOMENTUM.x / a));
    let (phi, _) = functions.amplitude(start + rate * time);
    Some(Vector3::new(a * phi.cos(), b * phi.sin(), c * functions.delta(phi)))
}

/// The spatial momentum Rπ.
fn momenta(y: &super::rotation::Body) -> Vector6<f64> {
    let (attitude, momentum) = split(y);
    (attitude * momentum).push(0.0).push(0.0).push(0.0)
}
