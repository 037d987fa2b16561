//! A fast top with three moments of inertia.

use super::rotation::{
    Compact, compact, compact_rates, defect, last_row, pack, pack_quaternion, rates, split, split_compact, tilted,
    tilted_quaternion, unpack_compact,
};
use crate::classical::{Equation, VectorField};
use crate::motion::Scene;
use crate::setting::{Setting, declared};
use clebsch::Clebsch;
use nalgebra::{Matrix3, Vector3, Vector6};
use std::hint::black_box;

const MOMENTS: Vector3<f64> = Vector3::new(1.0, 1.5, 2.0);
const CENTER: Vector3<f64> = Vector3::new(0.0, 0.0, 1.0);
const VELOCITY: Vector3<f64> = Vector3::new(0.1, 0.2, 5.0);
const TILT: f64 = 0.5;

struct ExactFirst;
struct ExactSecond;
struct ExactFourth;
struct ExactSixth;
struct Compensated;
struct MoserVeselovFirst;
struct MoserVeselovSecond;
struct MoserVeselovFourth;
struct MoserVeselovSixth;
struct MoserVeselovEighth;
struct CayleyFirst;
struct CayleySecond;
struct CayleyFourth;
struct CayleySixth;
struct CayleyEighth;
struct ExponentialFirst;
struct ExponentialSecond;
struct ExponentialFourth;
struct ExponentialSixth;
struct ExponentialEighth;
struct ProjectionFirst;
struct ProjectionSecond;
struct ProjectionFourth;
struct ProjectionSixth;
struct ProjectionEighth;
struct Collocation;
struct ToleratedRough;
struct ToleratedFourth;
struct ToleratedSixth;
struct ToleratedMedium;
struct QuaternionExactFirst;
struct QuaternionExactSecond;
struct QuaternionExactFourth;
struct QuaternionExactSixth;
struct QuaternionCollocation;
struct QuaternionCollocationLoose;
struct QuaternionCayleyFirst;
struct QuaternionCayleySecond;
struct QuaternionCayleyFourth;
struct QuaternionCayleySixth;
struct QuaternionCayleyEighth;
struct ChordFirst;
struct ChordSecond;
struct ChordFourth;
struct ChordSixth;
struct ChordEighth;

/// A body about a pivot, in one form after another, in every order.
#[derive(Clebsch, Clone, Copy, Debug)]
#[clebsch(
    action     = |F: SO<3>, R: SO<3>| R * F,
    lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
    potential  = |R| self.weight * (R * self.center).z,
    method ExactFirst         = (order = 1, discretization = exact),
    method ExactSecond        = (order = 2, discretization = exact),
    method ExactFourth        = (order = 4, discretization = exact),
    method ExactSixth         = (order = 6, discretization = exact),
    method Compensated        = (order = 6, discretization = exact, summation = compensated),
    method MoserVeselovFirst  = (order = 1, discretization = moser_veselov),
    method MoserVeselovSecond = (order = 2, discretization = moser_veselov),
    method MoserVeselovFourth = (order = 4, discretization = moser_veselov),
    method MoserVeselovSixth  = (order = 6, discretization = moser_veselov),
    method MoserVeselovEighth = (order = 8, discretization = moser_veselov),
    method CayleyFirst        = (order = 1, discretization = cayley),
    method CayleySecond       = (order = 2, discretization = cayley),
    method CayleyFourth       = (order = 4, discretization = cayley),
    method CayleySixth        = (order = 6, discretization = cayley),
    method CayleyEighth       = (order = 8, discretization = cayley),
    method ExponentialFirst   = (order = 1, discretization = exponential),
    method ExponentialSecond  = (order = 2, discretization = exponential),
    method ExponentialFourth  = (order = 4, discretization = exponential),
    method ExponentialSixth   = (order = 6, discretization = exponential),
    method ExponentialEighth  = (order = 8, discretization = exponential),
    method ProjectionFirst    = (order = 1, discretization = projection),
    method ProjectionSecond   = (order = 2, discretization = projection),
    method ProjectionFourth   = (order = 4, discretization = projection),
    method ProjectionSixth    = (order = 6, discretization = projection),
    method ProjectionEighth   = (order = 8, discretization = projection),
    method Collocation        = (order = 16),
    method ToleratedRough     = (order = 4, discretization = exact, tolerance = 1e-4),
    method ToleratedFourth    = (order = 4, discretization = exact, tolerance = 1e-7),
    method ToleratedSixth     = (order = 6, discretization = exact, tolerance = 1e-10),
    method ToleratedMedium    = (order = 6, discretization = exact, tolerance = 1e-7),
)]
struct Top {
    /// Inertia tensor about the pivot, kg·m².
    #[clebsch(symmetric)]
    inertia: Matrix3<f64>,
    /// m·g, N.
    weight: f64,
    /// Centre of mass in the body frame, m.
    center: Vector3<f64>,
}

/// The same body by unit quaternions.
#[derive(Clebsch, Clone, Copy, Debug)]
#[clebsch(
    action     = |F: SU<2>, Q: SU<2>| Q * F,
    lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
    potential  = |Q| self.weight * (Q * self.center).z,
    method QuaternionExactFirst       = (order = 1, discretization = exact),
    method QuaternionExactSecond      = (order = 2, discretization = exact),
    method QuaternionExactFourth      = (order = 4, discretization = exact),
    method QuaternionExactSixth       = (order = 6, discretization = exact),
    method QuaternionCollocation      = (order = 16),
    method QuaternionCollocationLoose = (order = 16, tolerance = 1e-10),
    method QuaternionCayleyFirst      = (order = 1, discretization = cayley),
    method QuaternionCayleySecond     = (order = 2, discretization = cayley),
    method QuaternionCayleyFourth     = (order = 4, discretization = cayley),
    method QuaternionCayleySixth      = (order = 6, discretization = cayley),
    method QuaternionCayleyEighth     = (order = 8, discretization = cayley),
)]
struct Turn {
    /// Inertia tensor about the pivot, kg·m².
    #[clebsch(symmetric)]
    inertia: Matrix3<f64>,
    /// m·g, N.
    weight: f64,
    /// Centre of mass in the body frame, m.
    center: Vector3<f64>,
}

/// The same by unit quaternions and the chord of the rotation of a step.
#[derive(Clebsch, Clone, Copy, Debug)]
#[clebsch(
    action    = |F: SU<2>, Q: SU<2>| Q * F,
    cost      = |h, F| 2 * F.imag().dot(&(self.inertia * F.imag())) / h,
    potential = |Q| self.weight * (Q * self.center).z,
    method ChordFirst  = (order = 1),
    method ChordSecond = (order = 2),
    method ChordFourth = (order = 4),
    method ChordSixth  = (order = 6),
    method ChordEighth = (order = 8),
)]
struct Chord {
    /// Inertia tensor about the pivot, kg·m².
    #[clebsch(symmetric)]
    inertia: Matrix3<f64>,
    /// m·g, N.
    weight: f64,
    /// Centre of mass in the body frame, m.
    center: Vector3<f64>,
}

fn declarations(inertia: Matrix3<f64>, weight: f64, center: Vector3<f64>) -> Vec<Box<dyn Setting<12>>> {
    let top = Top { inertia, weight, center };
    let turn = Turn { inertia, weight, center };
    let chord = Chord { inertia, weight, center };
    let start = (tilted(TILT), inertia * VELOCITY);
    let turned = (tilted_quaternion(TILT), inertia * VELOCITY);
    vec![
        declared(ExactFirst, "exact", top, start, pack),
        declared(ExactSecond, "exact", top, start, pack),
        declared(ExactFourth, "exact", top, start, pack),
        declared(ExactSixth, "exact", top, start, pack),
        declared(Compensated, "exact compensated", top, start, pack),
        declared(QuaternionExactFirst, "quaternion exact", turn, turned, pack_quaternion),
        declared(QuaternionExactSecond, "quaternion exact", turn, turned, pack_quaternion),
        declared(QuaternionExactFourth, "quaternion exact", turn, turned, pack_quaternion),
        declared(QuaternionExactSixth, "quaternion exact", turn, turned, pack_quaternion),
        declared(MoserVeselovFirst, "moser_veselov", top, start, pack),
        declared(MoserVeselovSecond, "moser_veselov", top, start, pack),
        declared(MoserVeselovFourth, "moser_veselov", top, start, pack),
        declared(MoserVeselovSixth, "moser_veselov", top, start, pack),
        declared(MoserVeselovEighth, "moser_veselov", top, start, pack),
        declared(CayleyFirst, "cayley", top, start, pack),
        declared(CayleySecond, "cayley", top, start, pack),
        declared(CayleyFourth, "cayley", top, start, pack),
        declared(CayleySixth, "cayley", top, start, pack),
        declared(CayleyEighth, "cayley", top, start, pack),
        declared(ExponentialFirst, "exponential", top, start, pack),
        declared(ExponentialSecond, "exponential", top, start, pack),
        declared(ExponentialFourth, "exponential", top, start, pack),
        declared(ExponentialSixth, "exponential", top, start, pack),
        declared(ExponentialEighth, "exponential", top, start, pack),
        declared(ProjectionFirst, "projection", top, start, pack),
        declared(ProjectionSecond, "projection", top, start, pack),
        declared(ProjectionFourth, "projection", top, start, pack),
        declared(ProjectionSixth, "projection", top, start, pack),
        declared(ProjectionEighth, "projection", top, start, pack),
        declared(ChordFirst, "quaternion chord", chord, turned, pack_quaternion),
        declared(ChordSecond, "quaternion chord", chord, turned, pack_quaternion),
        declared(ChordFourth, "quaternion chord", chord, turned, pack_quaternion),
        declared(ChordSixth, "quaternion chord", chord, turned, pack_quaternion),
        declared(ChordEighth, "quaternion chord", chord, turned, pack_quaternion),
        declared(Collocation, "collocation", top, start, pack),
        declared(QuaternionCollocation, "quaternion collocation", turn, turned, pack_quaternion),
        declared(QuaternionCayleyFirst, "quaternion cayley", turn, turned, pack_quaternion),
        declared(QuaternionCayleySecond, "quaternion cayley", turn, turned, pack_quaternion),
        declared(QuaternionCayleyFourth, "quaternion cayley", turn, turned, pack_quaternion),
        declared(QuaternionCayleySixth, "quaternion cayley", turn, turned, pack_quaternion),
        declared(QuaternionCayleyEighth, "quaternion cayley", turn, turned, pack_quaternion),
        // series of drifts that end early
        declared(ToleratedRough, "exact", top, start, pack).to(1e-4),
        declared(ToleratedFourth, "exact", top, start, pack).to(1e-7),
        declared(ToleratedSixth, "exact", top, start, pack).to(1e-10),
        declared(ToleratedMedium, "exact", top, start, pack).to(1e-7),
        // sweeps that end early
        declared(QuaternionCollocationLoose, "quaternion collocation", turn, turned, pack_quaternion).to(1e-10),
        declared(ExactFirst, "exact synchronized", top, start, pack).synchronized(),
    ]
}

/// Euler's equations with the torque of the weight.
#[derive(Clone)]
struct Swinging {
    inverse: Vector3<f64>,
    /// Of the weight, about the pivot.
    moment: Vector3<f64>,
}

impl VectorField<7> for Swinging {
    #[inline(always)]
    fn rates(&self, y: &Compact) -> Compact {
        let (attitude, momentum) = split_compact(y);
        let omega = self.inverse.component_mul(&momentum);
        let torque = last_row(&attitude).cross(&self.moment);
        compact_rates(&attitude, &omega, &(momentum.cross(&omega) + torque))
    }
}

/// m·g = 1, the centre of mass one metre up the third axis.
pub fn scene() -> Scene<12> {
    let (inertia, weight, center) = (Matrix3::from_diagonal(&black_box(MOMENTS)), black_box(1.0), black_box(CENTER));
    let inverse = inertia.map(|entry| if entry == 0.0 { 0.0 } else { 1.0 / entry });
    let momentum = inertia * VELOCITY;
    let torque = move |up: &Vector3<f64>| -weight * center.cross(up);
    let field = move |y: &_| {
        let (attitude, momentum) = split(y);
        let omega = inverse * momentum;
        rates(&attitude, &omega, &(momentum.cross(&omega) + torque(&attitude.row(2).transpose())))
    };
    let energy = move |y: &_| {
        let (attitude, momentum) = split(y);
        momentum.dot(&(inverse * momentum)) / 2.0 + weight * (attitude * center).z
    };
    let mut settings = declarations(inertia, weight, center);
    let start = compact(&tilted_quaternion(TILT), &momentum);
    let equation = Swinging { inverse: inverse.diagonal(), moment: center * weight };
    settings.extend(Equation { field: equation, start, flat: unpack_compact }.settings());
    Scene {
        name: "heavy_top",
        title: "heavy top",
        duration: 50.0,
        start: pack(&tilted(TILT), &momentum),
        field: Box::new(field),
        energy: Box::new(energy),
        momenta,
        constraint: defect,
        split: 9,
        momentum_size: momentum.norm(),
        closed_form: None,
        known: None,
        reference_steps: 200_000,
        longer: 10,
        least_error: 0.0,
        shows_sixteen: true,
        settings,
    }
}

/// The spatial momentum about the vertical.
fn momenta(y: &super::rotation::Body) -> Vector6<f64> {
    let (attitude, momentum) = split(y);
    Vector6::new((attitude * momentum).z, 0.0, 0.0, 0.0, 0.0, 0.0)
}
