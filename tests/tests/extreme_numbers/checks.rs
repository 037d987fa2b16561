//! Every entry point of a system, with numbers replaced. The result is an error that names the mistake, or it is finite
//! and on the space of configurations.
//!
//! The walk over places and numbers knows systems as a `dyn Trial` and is compiled once.

use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::slots::Part;
use crate::trial::{FORMULAS, Size, Trial};
use clebsch::Error;
use clebsch_tests::oracle::random::Random;

/// Numbers that no computation can go on with.
pub const BROKEN: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

/// Numbers that are too large or too small for squares, products or sums. Single precision takes its own largest and
/// smallest.
pub const EXTREME: [f64; 14] = [
    1e19,
    1e150,
    -1e150,
    1e200,
    1e300,
    f64::MAX,
    f64::MIN,
    1e-20,
    1e-150,
    1e-200,
    f64::MIN_POSITIVE,
    -5e-324,
    0.0,
    -0.0,
];

/// Powers of ten by which ordinary numbers are multiplied where many are replaced at once, at most: ratios are up to 10¹⁵ within one part.
const RATIOS: f64 = 7.5;
/// How often many numbers are replaced at once.
const TOGETHER: usize = if cfg!(feature = "heavy") { 1000 } else { 40 };

const GRADIENT: &str = "the gradient of the potential at the configuration";

/// The failures.
pub struct Report {
    scene: &'static str,
    pub failures: Vec<String>,
    /// How often a call gave a result, and an error.
    pub counts: [usize; 2],
}

impl Report {
    fn new(scene: &'static str) -> Report {
        Report { scene, failures: Vec::new(), counts: [0; 2] }
    }

    fn fail(&mut self, place: &str, what: &str) {
        let failure = format!("{}, {place}: {what}", self.scene);
        if !self.failures.contains(&failure) {
            self.failures.push(failure);
        }
    }

    /// A call whose result has to be finite and on its space; whether it gave one to go on with.
    fn call(&mut self, (place, entry): (&str, &str), call: &mut dyn FnMut() -> Result<bool, Error>) -> bool {
        match outcome(call) {
            Outcome::Panicked => self.fail(place, &format!("`{entry}` panicked")),
            Outcome::Refused(error) => {
                self.counts[1] += 1;
                let text = error.to_string().replace("look for NaN, infinity", "");
                if ["NaN", "inf"].iter().any(|number| text.contains(number)) && !text.contains("singular") {
                    self.fail(place, &format!("`{entry}` says {text}"));
                }
            }
            Outcome::Returned { is_sound: true } => {
                self.counts[0] += 1;
                return true;
            }
            Outcome::Returned { is_sound: false } => {
                self.fail(place, &format!("`{entry}` gave a result that is not finite, or off its space"));
            }
        }
        false
    }

    /// An entry point that takes the numbers of the trial.
    fn entry(&mut self, place: &str, entry: &str, trial: &mut dyn Trial) -> bool {
        self.call((place, entry), &mut || trial.call(entry))
    }

    /// A formula that has no error to give: it may pass on its input.
    fn formula(&mut self, place: &str, entry: &str, trial: &mut dyn Trial) {
        if matches!(outcome(&mut || trial.call(entry)), Outcome::Panicked) {
            self.fail(place, &format!("`{entry}` panicked"));
        }
    }

    /// A call that has to refuse, naming this.
    fn refused(&mut self, (place, entry): (&str, &str), call: &mut dyn FnMut() -> Result<bool, Error>, named: &str) {
        let names = |error: Error| match error {
            Error::NotFinite { name } => name == named,
            Error::StepSize { .. } => named == "the step size",
            _ => false,
        };
        match outcome(call) {
            Outcome::Refused(error) if names(error) => self.counts[1] += 1,
            Outcome::Refused(error) => {
                self.fail(place, &format!("`{entry}` says {error:?} and not that {named} is broken"));
            }
            Outcome::Returned { .. } => self.fail(place, &format!("`{entry}` takes it")),
            Outcome::Panicked => self.fail(place, &format!("`{entry}` panicked")),
        }
    }

    /// Entry points that have to refuse the numbers of the trial.
    fn all_refused(&mut self, place: &str, entries: &[&str], trial: &mut dyn Trial, named: &str) {
        for entry in entries {
            self.refused((place, entry), &mut || trial.call(entry), named);
        }
    }
}

/// How a call ended.
#[derive(Clone, Copy)]
enum Outcome {
    Panicked,
    Refused(Error),
    Returned { is_sound: bool },
}

fn outcome(call: &mut dyn FnMut() -> Result<bool, Error>) -> Outcome {
    match catch_unwind(AssertUnwindSafe(call)) {
        Err(_) => Outcome::Panicked,
        Ok(Err(error)) => Outcome::Refused(error),
        Ok(Ok(is_sound)) => Outcome::Returned { is_sound },
    }
}

/// All entry points that take a state, from (q, N).
fn steps(report: &mut Report, place: &str, trial: &mut dyn Trial) {
    FORMULAS.iter().for_each(|formula| report.formula(place, formula, trial));
    report.entry(place, "project", trial);
    report.entry(place, "inverse_legendre", trial);
    if report.entry(place, "cotangent_state", trial) {
        report.entry(place, "step_symmetric", trial);
    }
    report.entry(place, "staggered_state", trial);
    if !report.entry(place, "state", trial) {
        return;
    }
    for entry in ["step", "step_with", "advance", "trajectory", "another step size"] {
        report.entry(place, entry, trial);
    }
    ["energy", "synchronized", "failure"].iter().for_each(|formula| report.formula(place, formula, trial));
    report.entry(place, "step_each", trial);
    ensemble(report, place, trial);
}

/// Bodies of an ensemble stay where they were when their step fails, and the others do not notice.
fn ensemble(report: &mut Report, place: &str, trial: &mut dyn Trial) {
    if !report.entry(place, "Ensemble", trial) {
        return;
    }
    report.formula(place, "Ensemble::advance", trial);
    let [are_finite, have_stayed] = trial.bodies();
    if !are_finite {
        report.fail(place, "a body of the ensemble is not finite");
    }
    if !have_stayed {
        report.fail(place, "a body whose step failed did not stay where it was");
    }
}

/// One number of the scene after the other is replaced.
pub fn check(trial: &mut dyn Trial) -> Report {
    let mut report = Report::new(trial.name());
    let before = report.counts[1];
    steps(&mut report, "nothing replaced", trial);
    // a system with forces, or of momenta alone, has no covectors to step
    assert!(report.counts[1] - before <= 1, "{}: an ordinary step fails", trial.name());

    parameters(&mut report, trial);
    for value in BROKEN.into_iter().chain(EXTREME) {
        trial.restore();
        configurations(&mut report, trial, value);
        momenta(&mut report, trial, value);
        inputs(&mut report, trial, value);
        step_sizes(&mut report, trial, value);
    }
    together(&mut report, trial);
    report
}

fn parameters(report: &mut Report, trial: &mut dyn Trial) {
    for (field, count) in trial.fields() {
        for (entry, value) in (0..count).flat_map(|entry| BROKEN.map(|value| (entry, value))) {
            let place = format!("{field}[{entry}] = {value:e}");
            // fields of tuples are called as they are read
            let named = match field {
                "0" => "self.0",
                "1" => "self.1",
                other => other,
            };
            // the fields that methods read are not known
            let is_opaque = report.scene == "Harmonics" && field == "coefficients";
            // an infinite limit of a bound is none
            if report.scene == "SteeredBody" && field == "top" && value.is_infinite() {
                continue;
            }
            let mut call = || {
                trial.stepper(&[(field, entry, value)], Size::Ordinary)?;
                if is_opaque { trial.call("state") } else { Ok(true) }
            };
            match is_opaque {
                true => report.refused((&place, "state"), &mut call, GRADIENT),
                false => report.refused((&place, "stepper"), &mut call, named),
            }
        }
        for (entry, value) in (0..count).flat_map(|entry| EXTREME.map(|value| (entry, value))) {
            let place = format!("{field}[{entry}] = {value:e}");
            let mut stepper = || trial.stepper(&[(field, entry, value)], Size::Ordinary);
            if report.call((&place, "stepper"), &mut stepper) {
                steps(report, &place, trial);
            }
        }
    }
}

fn configurations(report: &mut Report, trial: &mut dyn Trial, value: f64) {
    for entry in 0..trial.slots(Part::Configuration).len() {
        let place = format!("q[{entry}] = {value:e}");
        trial.replace(Part::Configuration, entry, value);
        if value.is_finite() {
            steps(report, &place, trial);
            report.entry(&place, "step_symmetric of a covector", trial);
            continue;
        }
        let entries = ["state", "staggered_state", "project", "cotangent_state", "inverse_legendre"];
        report.all_refused(&place, &entries, trial, "the configuration");
        report.all_refused(&place, &["covector"], trial, "the covector");
        FORMULAS.iter().for_each(|formula| report.formula(&place, formula, trial));
    }
    trial.restore();
}

fn momenta(report: &mut Report, trial: &mut dyn Trial, value: f64) {
    let count = trial.slots(Part::Momentum).len();
    for entry in 0..=count {
        let place = match entry == count {
            true => format!("N = {value:e}"),
            false => format!("N[{entry}] = {value:e}"),
        };
        trial.restore();
        match entry == count {
            true => trial.slots(Part::Momentum).into_iter().for_each(|slot| slot.put(value)),
            false => trial.replace(Part::Momentum, entry, value),
        }
        if value.is_finite() {
            steps(report, &place, trial);
            // the nearest that is a momentum of a motion
            if trial.call("projected").is_ok() {
                steps(report, &place, trial);
            }
            continue;
        }
        let entries = ["state", "staggered_state", "project", "inverse_legendre"];
        report.all_refused(&place, &entries, trial, "the momentum");
        FORMULAS.iter().for_each(|formula| report.formula(&place, formula, trial));
    }
    trial.restore();
}

fn inputs(report: &mut Report, trial: &mut dyn Trial, value: f64) {
    if trial.call("state").is_err() {
        return;
    }
    for entry in 0..trial.slots(Part::Input).len() {
        let place = format!("u[{entry}] = {value:e}");
        trial.slots(Part::Input).into_iter().for_each(|slot| slot.put(0.0));
        trial.slots(Part::Input).into_iter().nth(entry).expect("a place").put(value);
        match value.is_finite() {
            true => drop(report.entry(&place, "step_with", trial)),
            false => report.all_refused(&place, &["step_with"], trial, "the input"),
        }
    }
    trial.restore();
}

fn step_sizes(report: &mut Report, trial: &mut dyn Trial, value: f64) {
    let place = format!("h = {value:e}");
    let mut stepper = || trial.stepper(&[], Size::Of(value));
    if !value.is_finite() || value == 0.0 {
        report.refused((&place, "stepper"), &mut stepper, "the step size");
    } else if report.call((&place, "stepper"), &mut stepper) {
        steps(report, &place, trial);
    }
}

/// Many numbers of the scene at once: parameters, configuration, momentum, input and step size of sizes that have
/// nothing to do with each other. Nothing is refused for being so; each refusal is an error that is checked as all
/// others are.
fn together(report: &mut Report, trial: &mut dyn Trial) {
    let random = &mut Random::new(9_001);
    let fields = trial.fields();
    for case in 0..TOGETHER {
        trial.restore();
        // one number in four, or all of them
        let share = [0.25, 1.0][case % 2];
        let mut replaced = Vec::new();
        for &(field, count) in &fields {
            for entry in 0..count {
                if random.between(0.0, 1.0) < share {
                    replaced.push((field, entry, hostile(random)));
                }
            }
        }
        // rotations and unit vectors are where they are: another number is no configuration
        for part in [Part::Configuration, Part::Momentum, Part::Input] {
            let share = if matches!(part, Part::Configuration) { share / 8.0 } else { share };
            for slot in trial.slots(part) {
                if random.between(0.0, 1.0) < share {
                    slot.put(hostile(random));
                }
            }
        }
        let h = if case % 3 == 0 { Size::Ordinary } else { Size::Of(hostile(random)) };
        let place = format!("case {case}");
        if report.call((&place, "stepper"), &mut || trial.stepper(&replaced, h)) {
            if trial.call("projected").is_err() {
                continue;
            }
            steps(report, &place, trial);
        }
    }
    trial.restore();
}

/// A number of any size and sign, and now and then one that few expect.
fn hostile(random: &mut Random) -> f64 {
    let choice = random.between(0.0, 24.0) as usize;
    let size = 10.0_f64.powf(random.between(-RATIOS, RATIOS));
    match EXTREME.get(choice) {
        Some(&extreme) if choice.is_multiple_of(3) => extreme,
        _ if choice.is_multiple_of(2) => size,
        _ => -size,
    }
}
