//! A contestant: how it is timed and how far its invariants drift.

use crate::hand::Kernel;
use crate::timing::Run;
use clebsch::{Clebsch, Method, State, Stepper};
use nalgebra::SMatrix;
use std::hint::black_box;

/// The largest deviations seen at full units of time.
#[derive(Copy, Clone, Default, Debug)]
pub struct Drift {
    /// From the energy at the start.
    pub energy: f64,
    /// From the constraint of the configuration.
    pub constraint: f64,
}

/// Given the steps in a unit of time and the number of units: the drift, and the configuration at the end by rows.
pub type Invariants<'a> = Box<dyn Fn(u64, u64) -> (Drift, Vec<f64>) + 'a>;

/// A contestant at a problem.
pub struct Trial<'a> {
    /// Its name.
    pub name: &'static str,
    /// The run that is timed.
    pub run: Run<'a>,
    /// The quantities that are checked.
    pub drift: Invariants<'a>,
}

/// The derived step, the state handed from step to step as a user does. Energies are multiplied by `scale`.
pub fn derived<'a, S, M, const R: usize, const C: usize>(
    stepper: &'a Stepper<S, M>,
    start: State<S, M>,
    scale: f64,
) -> Trial<'a>
where
    S: Clebsch<Scalar = f64, Configuration = SMatrix<f64, R, C>>,
    M: Method<S>,
{
    let run = move |steps| {
        let (stepper, mut state) = (black_box(stepper), black_box(start));
        for _ in 0..steps {
            state = stepper.step(&state).expect("a step of moderate size");
        }
        black_box(state);
    };
    let drift = move |steps: u64, units| {
        let mut state = start;
        let drift = observe(scale * stepper.energy(&start), units, || {
            for _ in 0..steps {
                state = stepper.step(&state).expect("a step of moderate size");
            }
            (scale * stepper.energy(&state), stepper.system().orbit_defect(state.configuration()))
        });
        (drift, state.configuration().transpose().as_slice().to_vec())
    };
    Trial { name: "clebsch", run: Box::new(run), drift: Box::new(drift) }
}

impl Trial<'_> {
    /// The same under another name.
    pub fn named(self, name: &'static str) -> Self {
        Self { name, ..self }
    }
}

/// Anything else.
pub fn by_hand<'a, K: Kernel + 'a>(name: &'static str, start: K) -> Trial<'a> {
    let run = move |steps| {
        let mut state = black_box(start);
        for _ in 0..steps {
            state.step();
        }
        black_box(state);
    };
    let drift = move |steps: u64, units| {
        let mut state = start;
        let drift = observe(start.energy(), units, || {
            (0..steps).for_each(|_| state.step());
            (state.energy(), state.defect())
        });
        (drift, state.configuration())
    };
    Trial { name, run: Box::new(run), drift: Box::new(drift) }
}

/// The drift from the energy at the start over some units of time; after each, `advance` returns energy and defect.
fn observe(start: f64, units: u64, mut advance: impl FnMut() -> (f64, f64)) -> Drift {
    (0..units).fold(Drift::default(), |drift, _| {
        let (energy, defect) = advance();
        Drift { energy: drift.energy.max((energy - start).abs()), constraint: drift.constraint.max(defect) }
    })
}
