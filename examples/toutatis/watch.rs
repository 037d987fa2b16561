//! The record of the motion while it runs.

use crate::periods::{Periods, Turns, frame_of};
use clebsch_examples::claims::Claims;
use clebsch_examples::flags::Run;
use clebsch_examples::table::Table;
use nalgebra::{Matrix3, Vector3};

/// Points of the figure.
const POINTS: u64 = 5000;
/// How much of the path of the short axis is recorded, days: it soon covers the sphere.
pub const SHORT_PATH: f64 = 30.0;
/// Intervals of the table.
const ROWS: u64 = 8;

/// The path of the long axis and the largest defects.
pub struct Watch {
    /// The motion at a few times.
    pub table: Table<5>,
    /// Time, days, and the end of the long axis that starts nearer to the momentum, in a frame with the momentum upwards.
    pub path: Vec<(f64, [f64; 3])>,
    /// The axis of the largest moment, in the same frame, over the last [`SHORT_PATH`] days.
    pub short_path: Vec<[f64; 3]>,
    /// A bound of the angle by which a step turns the body, h|π| over the smallest moment, radians.
    pub turn_of_a_step: f64,
    run: Run,
    turns: Turns,
    to_frame: Matrix3<f64>,
    /// The body's long axis.
    long_axis: Vector3<f64>,
    /// The body's axis of the largest moment.
    short_axis: Vector3<f64>,
    momentum: Vector3<f64>,
    energy: Option<f64>,
    /// Upper bound of |ω||π|, by which an error of the momentum moves the energy.
    energy_scale: f64,
    momentum_defect: f64,
    energy_defect: f64,
    orbit_defect: f64,
}

impl Watch {
    /// For a body that starts with this body momentum and the identity as attitude.
    pub fn new(run: &Run, moments: &Vector3<f64>, momentum: &Vector3<f64>) -> Self {
        let long = moments.imin();
        let sign = if momentum[long] < 0.0 { -1.0 } else { 1.0 };
        let fastest = momentum.norm() / moments[long];
        Self {
            table: Table::new([
                "day",
                "long axis to momentum / °",
                "rotations",
                "precessions",
                "energy, relative error",
            ]),
            path: Vec::new(),
            short_path: Vec::new(),
            turn_of_a_step: run.step_size * fastest,
            run: run.clone(),
            turns: Turns::new(moments, momentum),
            to_frame: frame_of(momentum),
            long_axis: Vector3::ith(long, sign),
            short_axis: Vector3::ith(moments.imax(), 1.0),
            momentum: *momentum,
            energy: None,
            energy_scale: fastest * momentum.norm(),
            momentum_defect: 0.0,
            energy_defect: 0.0,
            orbit_defect: 0.0,
        }
    }

    /// Takes the next state.
    pub fn observe(
        &mut self,
        step: u64,
        time: f64,
        attitude: &Matrix3<f64>,
        momentum: &Vector3<f64>,
        energy: f64,
        orbit_defect: f64,
    ) {
        let long_axis = self.to_frame * attitude * self.long_axis;
        self.turns.observe(time, momentum, &long_axis);
        let start = *self.energy.get_or_insert(energy);
        self.momentum_defect = self.momentum_defect.max((attitude * momentum - self.momentum).amax());
        self.energy_defect = self.energy_defect.max((energy - start).abs());
        self.orbit_defect = self.orbit_defect.max(orbit_defect);
        if self.run.samples(step, POINTS) {
            self.path.push((time, long_axis.into()));
            if time >= self.run.duration() - SHORT_PATH {
                self.short_path.push((self.to_frame * attitude * self.short_axis).into());
            }
        }
        if self.run.samples(step, ROWS) {
            let turns = self.turns.since_start();
            let relative = if start > 0.0 { (energy - start) / start } else { 0.0 };
            self.table.row([
                format!("{time:.2}"),
                format!("{:.3}", angle_to_third(&long_axis.into())),
                format!("{:.3}", turns.rotation),
                format!("{:.3}", turns.precession),
                format!("{relative:.1e}"),
            ]);
        }
    }

    /// The periods that the motion showed.
    pub fn periods(&self) -> Option<Periods<f64>> {
        self.turns.periods()
    }

    /// Claims the exactly conserved quantities of a free body.
    pub fn claim(&self, run: &Run, claims: &mut Claims) {
        let momentum = self.momentum.norm();
        claims.round_off("the spatial momentum R π is constant", self.momentum_defect, run.steps, momentum);
        claims.round_off("the energy is constant", self.energy_defect, run.steps, self.energy_scale);
        claims.round_off("the attitude stays a rotation", self.orbit_defect, run.steps, 1.0);
    }
}

/// The angle between a unit vector and the third axis, degrees.
pub fn angle_to_third([x, y, z]: &[f64; 3]) -> f64 {
    x.hypot(*y).atan2(*z).to_degrees()
}
