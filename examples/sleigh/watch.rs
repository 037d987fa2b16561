//! The record of both motions while they run, and the claims about them.

use crate::closed_form::{Crossing, Place};
use clebsch_examples::claims::Claims;
use clebsch_examples::conserved::Conserved;
use clebsch_examples::flags::Run;
use clebsch_examples::table::Table;

/// Points of each curve in the figure.
const POINTS: u64 = 500;
/// Intervals of the table.
const ROWS: u64 = 10;
/// c t + δ where the table and the curves end: 1 − tanh is 10⁻³ there.
const END: f64 = 3.8;

/// One of the two motions.
pub struct Motion {
    name: &'static str,
    /// The closed form.
    pub exact: Crossing,
    /// Time and place until the crossing has ended.
    pub places: Vec<(f64, Place)>,
    /// Time and relative error of the energy, as long.
    pub energies: Vec<(f64, f64)>,
    energy: Conserved,
    violation: f64,
    last: Place,
}

/// Both of them at one time.
pub struct Moment {
    /// Seconds.
    pub time: f64,
    /// Of the sleigh and of Suslov's body.
    pub places: [Place; 2],
    /// Their energies, J.
    pub energies: [f64; 2],
    /// Their velocities against the constraint, in parts of C.
    pub violations: [f64; 2],
}

/// Both motions.
pub struct Watch {
    /// The motions at a few times.
    pub table: Table<7>,
    /// The sleigh and Suslov's body.
    pub motions: [Motion; 2],
    /// The steps until both crossings have ended, or all.
    pub window: u64,
    run: Run,
}

impl Watch {
    /// Nothing observed yet. `scales` are those of the energies.
    pub fn new(run: &Run, crossings: [Crossing; 2], scales: [f64; 2]) -> Self {
        let motion = |name, energy, i: usize| Motion {
            name,
            exact: crossings[i],
            places: Vec::new(),
            energies: Vec::new(),
            energy: Conserved::new(energy, scales[i]),
            violation: 0.0,
            last: crossings[i].at(0.0),
        };
        let end = crossings.map(|crossing| (END - crossing.delay) / crossing.rate / run.step_size);
        let window = (end[0].max(end[1]).clamp(20.0, 1e9) as u64).min(run.steps);
        Self {
            table: Table::new(["time / s", "v", "β ω", "sleigh off by", "along", "across", "body off by"]),
            motions: [
                motion("the sleigh", "energy of the sleigh", 0),
                motion("Suslov's body", "energy of Suslov's body", 1),
            ],
            window,
            run: run.clone(),
        }
    }

    /// Takes the next states.
    pub fn observe(&mut self, step: u64, moment: &Moment) {
        let window = Run { steps: self.window, ..self.run.clone() };
        let (is_row, is_point) = (window.samples(step, ROWS), window.samples(step, POINTS));
        let mut row = vec![format!("{:.2}", moment.time)];
        for (i, motion) in self.motions.iter_mut().enumerate() {
            let place = moment.places[i];
            let error = motion.energy.observe(moment.energies[i]);
            motion.violation = motion.violation.max(moment.violations[i].abs());
            motion.last = place;
            if step <= self.window && is_point {
                motion.places.push((moment.time, place));
                motion.energies.push((moment.time, error));
            }
            let off = place.distance(&motion.exact.at(moment.time));
            row.extend([format!("{:.5}", place.along), format!("{:.5}", place.across), format!("{off:.1e}")]);
        }
        if let (true, Ok(row)) = (step <= self.window && is_row, row.try_into()) {
            self.table.row(row);
        }
    }

    /// Claims the constraints, the energies and the ends.
    pub fn claim(&self, claims: &mut Claims) {
        let steps = self.run.steps;
        for motion in &self.motions {
            let name = motion.name;
            claims.round_off(&format!("{name} obeys its constraint"), motion.violation, steps, 1.0);
            motion.energy.claim(steps, claims);
            let ended = motion.exact.rate * self.run.duration() + motion.exact.delay;
            let name = format!("{name} ends at the stable end");
            // 1 − tanh and sech of the phase
            if ended > 37.0 {
                let end = Place { along: motion.exact.size, across: 0.0 };
                claims.round_off(&name, motion.last.distance(&end), steps, 1.0);
            } else {
                claims.skip(&name, "the run ends before: sech(ct + δ) is above ε");
            }
        }
    }
}
