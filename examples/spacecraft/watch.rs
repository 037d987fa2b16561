//! The record of the motion while it runs, and the claims about it.

use crate::body::{Body, Orientation};
use crate::equations::Equations;
use crate::libration::Tilt;
use crate::orbit::Circle;
use crate::{Momentum, Pose, halves};
use clebsch::Conserved;
use clebsch_examples::claims::Claims;
use clebsch_examples::energy_band::EnergyBand;
use clebsch_examples::flags::{Order, Run};
use clebsch_examples::round_off::worst_case;
use clebsch_examples::table::Table;
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// Points of the figure.
const POINTS: u64 = 5000;
/// Intervals of the table.
const ROWS: u64 = 10;

/// One state.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Orbits.
    pub orbits: f64,
    /// Yaw, roll and pitch, radians.
    pub angles: Vector3<f64>,
    /// The longest axis in the orbiting frame: outwards, along, normal.
    pub axis: Vector3<f64>,
    /// Jacobi's integral, less that of the start, J.
    pub jacobi: f64,
}

/// Points of the path, and the largest defects of all states.
pub struct Watch {
    /// The motion at a few times.
    pub table: Table<6>,
    /// Points of the figure, the first state first.
    pub samples: Vec<Sample>,
    run: Run,
    equations: Equations,
    orientation: Orientation,
    circle: Circle,
    band: EnergyBand,
    start: Option<(Conserved<f64, 3>, f64)>,
    jacobi_defect: f64,
    /// The largest of all angles squared.
    excursion: f64,
    largest_moment: f64,
    largest_momentum: f64,
    defects: [f64; 3],
    radius_defect: f64,
    orbit_defect: f64,
}

impl Watch {
    /// Nothing observed yet.
    pub fn new(run: &Run, body: &Body, orientation: &Orientation, circle: &Circle) -> Self {
        Self {
            table: Table::new(["time / s", "orbits", "yaw / °", "roll / °", "pitch / °", "radius, change / m"]),
            samples: Vec::new(),
            run: run.clone(),
            equations: Equations::new(body),
            orientation: *orientation,
            circle: *circle,
            band: EnergyBand::new(run),
            start: None,
            jacobi_defect: 0.0,
            excursion: 0.0,
            largest_moment: body.moments.z,
            largest_momentum: 0.0,
            defects: [0.0; 3],
            radius_defect: 0.0,
            orbit_defect: 0.0,
        }
    }

    /// Takes the next state, its energy and the potential part of that.
    pub fn observe(
        &mut self,
        step: u64,
        time: f64,
        pose: &Pose,
        momentum: &Momentum,
        (energy, potential): (f64, f64),
        conserved: &Conserved<f64, 3>,
    ) {
        let jacobi = self.equations.jacobi(&self.circle, pose, momentum);
        let (first, first_jacobi) = *self.start.get_or_insert((*conserved, jacobi));
        self.jacobi_defect = self.jacobi_defect.max((jacobi - first_jacobi).abs());
        self.band.observe(energy, potential, self.equations.terms(pose, momentum));
        for (defect, (now, then)) in self.defects.iter_mut().zip(conserved.values().iter().zip(first.values())) {
            *defect = defect.max((now - then).abs());
        }
        let (linear, angular) = halves(momentum);
        let size = pose.0.norm() * linear.norm() + angular.norm();
        self.largest_momentum = self.largest_momentum.max(size);
        let radius = pose.0.norm() - self.circle.radius;
        self.radius_defect = self.radius_defect.max(radius.abs());
        let tilt = Tilt::new(&self.equations, &self.orientation, &self.circle, pose, momentum);
        self.excursion = self.excursion.max(tilt.angles.norm_squared());
        let orbits = time * self.circle.mean_motion / TAU;
        if self.run.samples(step, POINTS) {
            let axis = crate::orbit::frame(&pose.0, &linear).transpose() * pose.1 * self.orientation.axes.column(0);
            self.samples.push(Sample { orbits, angles: tilt.angles, axis, jacobi: jacobi - first_jacobi });
        }
        if self.run.samples(step, ROWS) {
            let [yaw, roll, pitch] = <[f64; 3]>::from(tilt.angles).map(|angle| format!("{:.3}", angle.to_degrees()));
            self.table.row([format!("{time}"), format!("{orbits:.3}"), yaw, roll, pitch, format!("{radius:.1e}")]);
        }
    }

    /// Takes how far an attitude is from a rotation.
    pub fn observe_orbit(&mut self, defect: f64) {
        self.orbit_defect = self.orbit_defect.max(defect);
    }

    /// Claims the angular momentum that the offered symmetry gives, the circle, and the band of the energy.
    pub fn claim(&self, claims: &mut Claims) {
        let steps = self.run.steps;
        let names = self.start.as_ref().map_or(&[""; 3], |start| start.0.names());
        for (name, defect) in names.iter().zip(self.defects) {
            claims.round_off(
                &format!("the angular momentum {name}, is constant"),
                defect,
                steps,
                self.largest_momentum,
            );
        }
        claims.round_off("the attitude stays a rotation", self.orbit_defect, steps, 1.0);
        self.band.claim(claims);
        self.claim_jacobi(claims);
        let turns = 1.0 + self.run.duration() * self.circle.mean_motion;
        let reason = "relative; J/(m r²) and rounding, along the whole arc";
        let coupling = self.equations.coupling(self.circle.radius);
        let rounding = worst_case(steps, 1.0);
        let bound = turns * (10.0 * coupling + rounding);
        claims.at_most("the circle of the steps stays one", self.radius_defect / self.circle.radius, bound, reason);
    }

    /// The energy of orbit and body says nothing of the libration, which is less than its rounding; Jacobi's integral does.
    ///
    /// It is conserved by the continuous libration on a circle. Steps conserve a modified one. It differs by hΩ
    /// (order 1) or (hΩ)² (order 2) of the integral of a libration by these angles. Ω = 2n is the fastest rate of the
    /// libration.
    fn claim_jacobi(&self, claims: &mut Claims) {
        let n = self.circle.mean_motion;
        let angle = 2.0 * n * self.run.step_size;
        let libration = self.largest_moment * (2.0 * n).powi(2) * self.excursion / 2.0;
        let (share, name) = match self.run.order {
            Order::First => (angle, "hΩ"),
            Order::Second => (angle * angle, "(hΩ)²"),
        };
        let rounding = worst_case(self.run.steps, self.largest_moment * n * n);
        let reason = format!("J; {name} of the energy of the libration");
        claims.at_most(
            "Jacobi's integral stays in its band",
            self.jacobi_defect,
            share * libration + rounding,
            &reason,
        );
    }
}
