//! The record of the motion while it runs, and the claims about it.

use crate::Discretization;
use crate::great_circle::GreatCircle;
use clebsch_examples::claims::Claims;
use clebsch_examples::flags::Run;
use clebsch_examples::round_off;
use clebsch_examples::table::Table;
use nalgebra::SVector;
use std::f64::consts::TAU;

/// Turns in the figure, and points of them.
const TURNS: f64 = 1.5;
const POINTS: f64 = 400.0;
/// Ratio of the numbers of steps at which the growth of round-off is recorded.
const SPACING: f64 = 1.05;

/// Largest distances from the closed form after some number of steps.
#[derive(Clone, Copy, Debug)]
pub struct Growth {
    /// The number of steps.
    pub step: u64,
    /// From the point of the great circle.
    pub distance: f64,
    /// From the plane of the great circle.
    pub outside: f64,
    /// ||q|² − 1|.
    pub off_sphere: f64,
}

/// The largest defects of all states so far, and how they grew.
pub struct Watch<const D: usize> {
    /// The closed form.
    pub circle: GreatCircle<D>,
    /// The largest defects after 1, 10, 100, … steps.
    pub table: Table<6>,
    /// The largest defects at steps that are evenly spaced on a logarithmic scale.
    pub growth: Vec<Growth>,
    /// Seconds and coordinates of the first turns.
    pub path: Vec<(f64, SVector<f64, D>)>,
    run: Run,
    largest: Growth,
    /// Largest ratio of the distance to the rounding error of so many steps.
    worst: f64,
    momentum_defect: f64,
}

impl<const D: usize> Watch<D> {
    /// Nothing observed yet.
    pub fn new(run: &Run, circle: GreatCircle<D>) -> Self {
        Self {
            circle,
            table: Table::new(["step", "turns", "from the circle", "in units of ε k", "from its plane", "||q|² − 1|"]),
            growth: Vec::new(),
            path: Vec::new(),
            run: run.clone(),
            largest: Growth { step: 0, distance: 0.0, outside: 0.0, off_sphere: 0.0 },
            worst: 0.0,
            momentum_defect: 0.0,
        }
    }

    /// Takes the next point; `momentum_moved` is by how much the momentum has changed since the start.
    pub fn observe(&mut self, step: u64, time: f64, q: &SVector<f64, D>, momentum_moved: f64, orbit_defect: f64) {
        let largest = &mut self.largest;
        largest.step = step;
        largest.distance = largest.distance.max((q - self.circle.point(step)).norm());
        largest.outside = largest.outside.max(self.circle.outside(q));
        largest.off_sphere = largest.off_sphere.max(orbit_defect);
        self.worst = self.worst.max(largest.distance / round_off::worst_case(step, self.scale()));
        self.momentum_defect = self.momentum_defect.max(momentum_moved);
        self.keep(step, time, q);
    }

    /// The unit of a rounding of one step: the point, of length one, or the angle that it is turned by, if that is
    /// larger.
    fn scale(&self) -> f64 {
        self.circle.angle.abs().max(1.0)
    }

    /// Records the data of the table and the figure.
    fn keep(&mut self, step: u64, time: f64, q: &SVector<f64, D>) {
        let shown = (TURNS * TAU / self.circle.angle).min(self.run.steps as f64);
        if step as f64 <= shown && step.is_multiple_of((shown / POINTS).ceil().max(1.0) as u64) {
            self.path.push((time, *q));
        }
        let last = self.growth.last().map_or(0.0, |growth| growth.step as f64);
        if step >= 1 && (step == self.run.steps || step as f64 >= last * SPACING) {
            self.growth.push(self.largest);
        }
        if step >= 1 && (step == self.run.steps || step == 10_u64.pow(step.ilog10())) {
            self.row();
        }
    }

    fn row(&mut self) {
        let Growth { step, distance, outside, off_sphere } = self.largest;
        self.table.row([
            step.to_string(),
            format!("{:.2}", step as f64 * self.circle.angle / TAU),
            format!("{distance:.1e}"),
            format!("{:.2}", distance / (f64::EPSILON * step as f64)),
            format!("{outside:.1e}"),
            format!("{off_sphere:.1e}"),
        ]);
    }

    /// The exponent p with which the distance from the circle grew like step^p over the last factor of 100.
    pub fn exponent(&self) -> Option<f64> {
        let last = self.growth.last()?;
        let earlier = self.growth.iter().find(|growth| growth.step * 100 >= last.step)?;
        let exponent = (last.distance / earlier.distance).ln() / (last.step as f64 / earlier.step as f64).ln();
        (earlier.step >= 100 && exponent.is_finite()).then_some(exponent)
    }

    /// Claims the closed form; `momentum` is the size of the conserved momenta.
    pub fn claim(&self, claims: &mut Claims, discretization: Discretization, derivation: &str, momentum: f64) {
        let steps = self.run.steps;
        let on_circle = "the points lie on the great circle, kθ from the start";
        claims.round_off(on_circle, self.largest.distance, steps, self.scale());
        claims.round_off("they stay in its plane", self.largest.outside, steps, 1.0);
        claims.round_off("they stay on the sphere", self.largest.off_sphere, steps, 1.0);
        let name = "round-off grows like the steps, or slower";
        claims.at_most(name, self.worst, 1.0, "largest ratio to the worst case of so many steps, at any step");
        let (constant, explicit) = ("all momenta are constant", "the step is explicit");
        match discretization {
            Discretization::Chord => {
                claims.at_most(constant, self.momentum_defect, 0.0, "to the last bit: they are copied");
                let closed = derivation.contains("closed form") && !derivation.contains("Newton");
                claims.holds(explicit, closed, "its derivation: closed form, no Newton iteration");
            }
            Discretization::Exponential => {
                claims.round_off(constant, self.momentum_defect, steps, momentum);
                let solved = derivation.contains("no iteration") && !derivation.contains("Newton");
                claims.holds(explicit, solved, "its derivation: the velocity itself, no Newton iteration");
            }
        }
    }
}
