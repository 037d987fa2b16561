//! Exact drifts and conserved quantities: a rigid body, with weight or without, against a method that knows no groups.

use crate::Pictures;
use clebsch::{Clebsch, Declared, Method, State};
use clebsch_examples::claims::Claims;
use clebsch_examples::figure::{BLUE, Curve, Decades, GREEN, ORANGE, PURPLE, RED, TEAL};
use clebsch_examples::scene::Failure;
use nalgebra::{Matrix3, Rotation3, Vector3};

/// The free motion without an error in h.
pub struct Exact;

/// The velocity of a step by Cayley's map.
pub struct Cayley;

/// A rigid body turning about a fixed pivot; free where it has no weight.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<3>, R: SO<3>| R * F,
    lagrangian     = |omega| omega.dot(&self.moments.component_mul(&omega)) / 2,
    potential      = |R| self.weight * R[(2, 2)],
    discretization = moser_veselov,
    method Exact   = (discretization = exact),
    method Cayley  = (discretization = cayley),
)]
pub struct Top {
    /// Principal moments of inertia, kg·m².
    pub moments: Vector3<f64>,
    /// Weight times the distance from the pivot to the centre of mass, N·m.
    pub weight: f64,
}

impl Top {
    /// The time derivative of (R, π), for a method that knows no groups.
    fn rate(&self, (attitude, momentum): &Place) -> Place {
        let omega = momentum.component_div(&self.moments);
        let up = attitude.row(2).transpose();
        (attitude * omega.cross_matrix(), momentum.cross(&omega) + self.weight * up.cross(&Vector3::z()))
    }

    /// The classical Runge–Kutta step of order 4.
    fn runge_kutta(&self, at: &Place, h: f64) -> Place {
        let ahead = |rate: &Place, h: f64| (at.0 + rate.0 * h, at.1 + rate.1 * h);
        let first = self.rate(at);
        let second = self.rate(&ahead(&first, h / 2.0));
        let third = self.rate(&ahead(&second, h / 2.0));
        let fourth = self.rate(&ahead(&third, h));
        let mean = (first.0 + (second.0 + third.0) * 2.0 + fourth.0, first.1 + (second.1 + third.1) * 2.0 + fourth.1);
        ahead(&mean, h / 6.0)
    }

    pub fn energy(&self, (attitude, momentum): &Place) -> f64 {
        momentum.dot(&momentum.component_div(&self.moments)) / 2.0 + self.weight * attitude[(2, 2)]
    }
}

/// Attitude and body momentum.
pub type Place = (Matrix3<f64>, Vector3<f64>);

/// A free body with three moments.
pub const BOOK: Top = Top { moments: Vector3::new(1.0, 2.0, 3.0), weight: 0.0 };
/// The error of a free body after ten seconds, against the step size.
pub fn exact_drift(pictures: &Pictures, claims: &mut Claims) -> Result<(), Failure> {
    let start = (Matrix3::identity(), Vector3::new(0.3, 1.9, 0.4));
    let mut curves = Vec::new();
    let mut curve = |label, colour, errors: Vec<(f64, f64)>| {
        let ringed = vec![false; errors.len()];
        curves.push(Curve { label, colour, width: 1.6, points: errors, ringed });
    };
    let end = end::<Exact>(&start, 3000)?;
    let counts = || (3..=12).map(|power| 1 << power);
    let error = |other: Place| (other.0 - end.0).norm().max((other.1 - end.1).norm());
    // a gap where steps are too long
    let errors = |ends: &dyn Fn(usize) -> Result<Place, clebsch::Error>| -> Vec<(f64, f64)> {
        counts().map(|steps| (DURATION / steps as f64, ends(steps).map_or(f64::NAN, error))).collect()
    };
    let exact = errors(&|steps| self::end::<Exact>(&start, steps));
    claims.at_most(
        "error of exact steps",
        exact.iter().fold(0.0, |worst, point| point.1.max(worst)),
        1e-12,
        "rounding",
    );
    curve("cayley", ORANGE, errors(&|steps| self::end::<Cayley>(&start, steps)));
    curve("moser_veselov", PURPLE, errors(&|steps| self::end::<Declared>(&start, steps)));
    curve("Runge–Kutta 4", TEAL, errors(&|steps| Ok(runge_kutta(&start, steps))));
    curve("exact", BLUE, exact);
    let title = "A free body after 10 s";
    let chart = Decades { title, x_label: "step size (s)", y_label: "error", curves: &curves };
    pictures.draw("exact-drift", |area| chart.draw(area))
}

const DURATION: f64 = 10.0;

/// Where the free body is in the end, by the method M.
///
/// # Errors
/// [`clebsch::Error::Unsolvable`] where steps are too long.
fn end<M: Method<Top>>(start: &Place, steps: usize) -> Result<Place, clebsch::Error> {
    let stepper = BOOK.stepper_by::<M>(DURATION / steps as f64)?;
    let start = stepper.state(start.0, start.1)?;
    stepper.advance(&start, steps).map(State::into_parts)
}

fn runge_kutta(start: &Place, steps: usize) -> Place {
    (0..steps).fold(*start, |at, _| BOOK.runge_kutta(&at, DURATION / steps as f64))
}

/// Energy and vertical momentum of a heavy top: how far they have been from their start, by the step and by Runge–Kutta.
pub fn conserved(pictures: &Pictures, claims: &mut Claims) -> Result<(), Failure> {
    const STEP: f64 = 0.1;
    const STEPS: usize = 1_000_000;
    let top = Top { moments: Vector3::new(1.0, 1.2, 0.6), weight: 1.0 };
    let stepper = top.stepper(STEP)?;
    let attitude = Rotation3::from_euler_angles(1.0, 0.0, 0.0).into_inner();
    let start = stepper.state(attitude, Vector3::new(0.0, 0.1, 1.5))?;
    let vertical = |(attitude, momentum): &Place| (attitude * momentum).z;
    let begin = start.into_parts();
    let (energy, momentum) = (top.energy(&begin), vertical(&begin));

    let mut worst = [0.0_f64; 4];
    let mut points = [const { Vec::new() }; 4];
    let (mut state, mut classical, mut next_mark) = (start, begin, 1.0);
    for step in 1..=STEPS {
        state = stepper.step(&state).map_err(|error| Failure::Step { step: step as u64, error })?;
        classical = top.runge_kutta(&classical, STEP);
        let places = [state.into_parts(), classical];
        let defects = places.map(|place| [(top.energy(&place) - energy).abs(), (vertical(&place) - momentum).abs()]);
        for (worst, defect) in worst.iter_mut().zip(defects.as_flattened()) {
            *worst = worst.max(*defect);
        }
        if step as f64 >= next_mark {
            next_mark *= 1.5;
            for (points, worst) in points.iter_mut().zip(worst) {
                points.push((step as f64 * STEP, worst));
            }
        }
    }
    claims.at_most("energy of the step: the band", worst[0], 0.02, "order 2 at h|ω| = 0.2");
    claims.round_off("vertical momentum of the step", worst[1], STEPS as u64, 2.0);
    claims.holds("energy by Runge–Kutta leaves that band", worst[2] > 10.0 * worst[0], "it drifts");
    let names = ["energy, step", "momentum, step", "energy, Runge–Kutta", "momentum, Runge–Kutta"];
    let colours = [BLUE, GREEN, ORANGE, RED];
    let curve = |(index, points): (usize, Vec<(f64, f64)>)| {
        let ringed = vec![false; points.len()];
        Curve { label: names[index], colour: colours[index], width: 1.6, points, ringed }
    };
    let curves: Vec<_> = points.into_iter().enumerate().map(curve).collect();
    let title = "A heavy top, steps of 0.1 s";
    let chart = Decades { title, x_label: "time (s)", y_label: "largest change so far", curves: &curves };
    pictures.draw("conserved-quantities", |area| chart.draw(area))
}
