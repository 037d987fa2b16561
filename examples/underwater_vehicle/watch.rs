//! The record of the rise while it runs, and the claims about it.

use crate::kirchhoff::Kirchhoff;
use crate::vehicle::halves;
use clebsch::Conserved;
use clebsch_examples::claims::Claims;
use clebsch_examples::energy_band::EnergyBand;
use clebsch_examples::flags::Run;
use clebsch_examples::table::Table;
use nalgebra::{Matrix4, Vector3, Vector6};

/// Points of the figure.
const POINTS: u64 = 5000;
/// Intervals of the table.
const ROWS: u64 = 10;

/// One state.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Seconds.
    pub time: f64,
    /// The third body axis in space.
    pub axis: Vector3<f64>,
    /// J, less that of the start.
    pub energy: f64,
}

impl Sample {
    /// The angle between the third body axis and the vertical, degrees.
    pub fn tilt(&self) -> f64 {
        self.axis.x.hypot(self.axis.y).atan2(self.axis.z).to_degrees()
    }
}

/// Points of the path, and the largest defects of all states.
pub struct Watch {
    /// The motion at a few times.
    pub table: Table<6>,
    /// Points of the figure, the first state first.
    pub samples: Vec<Sample>,
    run: Run,
    kirchhoff: Kirchhoff,
    band: EnergyBand,
    start: Option<(Conserved<f64, 4>, f64)>,
    rate: f64,
    largest_linear: f64,
    largest_angular: f64,
    defects: [f64; 4],
    orbit_defect: f64,
}

impl Watch {
    /// Nothing observed yet.
    pub fn new(run: &Run, kirchhoff: Kirchhoff) -> Self {
        Self {
            table: Table::new(["time / s", "x / m", "y / m", "height / m", "tilt / °", "energy, change / J"]),
            samples: Vec::new(),
            run: run.clone(),
            kirchhoff,
            band: EnergyBand::new(run),
            start: None,
            rate: 0.0,
            largest_linear: 0.0,
            largest_angular: 0.0,
            defects: [0.0; 4],
            orbit_defect: 0.0,
        }
    }

    /// Takes the next state, its energy and the potential part of that.
    pub fn observe(
        &mut self,
        step: u64,
        time: f64,
        pose: &Matrix4<f64>,
        momentum: &Vector6<f64>,
        (energy, potential): (f64, f64),
        conserved: &Conserved<f64, 4>,
    ) {
        let (first, first_energy) = *self.start.get_or_insert((*conserved, energy));
        let terms = self.kirchhoff.terms(pose, momentum);
        self.band.observe(energy, potential, terms);
        self.rate = self.rate.max(terms.rate);
        for (defect, (now, then)) in self.defects.iter_mut().zip(conserved.values().iter().zip(first.values())) {
            *defect = defect.max((now - then).abs());
        }
        let ((angular, linear), position) = (halves(momentum), pose.fixed_view::<3, 1>(0, 3));
        self.largest_linear = self.largest_linear.max(linear.norm());
        self.largest_angular = self.largest_angular.max(angular.norm() + position.norm() * linear.norm());
        let sample = Sample { time, axis: pose.fixed_view::<3, 1>(0, 2).into(), energy: energy - first_energy };
        if self.run.samples(step, POINTS) {
            self.samples.push(sample);
        }
        if self.run.samples(step, ROWS) {
            let [x, y, z] = [0, 1, 2].map(|i| format!("{:.3}", position[i]));
            self.table.row([
                format!("{time:.2}"),
                x,
                y,
                z,
                format!("{:.3}", sample.tilt()),
                format!("{:.1e}", sample.energy),
            ]);
        }
    }

    /// Takes how far a pose is from a rigid motion.
    pub fn observe_orbit(&mut self, defect: f64) {
        self.orbit_defect = self.orbit_defect.max(defect);
    }

    /// The fastest rate of the motion, 1/s.
    pub fn rate(&self) -> f64 {
        self.rate
    }

    /// Claims the momenta that the macro found, and the band of the energy.
    pub fn claim(&self, claims: &mut Claims) {
        let steps = self.run.steps;
        let names = self.start.as_ref().map_or(&[""; 4], |start| start.0.names());
        for (name, defect) in names.iter().zip(self.defects) {
            let scale = if name.starts_with("along") { self.largest_linear } else { self.largest_angular };
            claims.round_off(&format!("the momentum {name}, is constant"), defect, steps, scale);
        }
        claims.round_off("the pose stays a rigid motion", self.orbit_defect, steps, 1.0);
        self.band.claim(claims);
    }
}
