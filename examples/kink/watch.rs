//! The record of one motion for the picture.

use crate::line::{Line, Mesh, Pendulums};
use crate::study::Case;
use clebsch_examples::claims::largest;
use clebsch_examples::flags::Run;
use clebsch_examples::integrate::integrate_field;
use clebsch_examples::scene::Failure;

/// Times of the picture.
const PICTURES: u64 = 120;
/// Points of curves.
const POINTS: u64 = 240;

/// One motion.
pub struct Watch {
    /// Time, and u of all sites.
    pub pictures: Vec<(f64, Vec<f64>)>,
    /// Time and u of the middle: of the steps, and of the closed solution.
    pub middle: Vec<(f64, [f64; 2])>,
    /// The largest change of the energy, over the energy.
    pub energy: f64,
}

impl Watch {
    /// Steps a line to the end of the run. `record` gets u of the middle, exact and by steps, and the energy.
    ///
    /// # Errors
    /// Those of steps, and of `record`.
    pub fn of<S: Pendulums>(
        system: &S,
        run: &Run,
        mesh: &Mesh,
        case: &Case,
        mut record: impl FnMut(u64, f64, [f64; 3]) -> Result<(), Failure>,
    ) -> Result<Self, Failure> {
        let Line { stepper, mut state } = Line::start(system, mesh, &case.soliton, case.from)?;
        let mut watch = Self { pictures: Vec::new(), middle: Vec::new(), energy: 0.0 };
        let mut first = None;
        let is_seen = |step: u64| run.writes(step) || run.samples(step, PICTURES) || run.samples(step, POINTS);
        integrate_field(run, &stepper, &mut state, is_seen, |step, after, state| {
            let line = Line { stepper: stepper.clone(), state: state.clone() };
            let (energy, angles, time) = (line.energy()?, line.angles(), case.from + after);
            let place = angles.len() / 2;
            let x = mesh.places().nth(place).unwrap_or(0.0);
            let both = [angles.get(place).copied().unwrap_or(0.0), case.soliton.at(x, time)[0]];
            record(step, time, [both[0], both[1], energy])?;
            watch.energy = largest([watch.energy, (energy / *first.get_or_insert(energy) - 1.0).abs()]);
            watch.middle.push((time, both));
            if run.samples(step, PICTURES) {
                watch.pictures.push((time, angles));
            }
            Ok(())
        })?;
        Ok(watch)
    }
}
