//! Every entry point of a system, with numbers replaced: an error that names what is wrong, or results that are finite.

use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::slots::Slots;
use clebsch::{Clebsch, Error, Real, Scalar, Space, State, Stepper};

/// What no computation can go on with.
pub const BROKEN: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

/// What is a number, and too large or too small for squares, products or sums. Single precision takes its own largest and smallest.
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

const GRADIENT: &str = "the gradient of the potential at the configuration";

/// A system with its parameters by field, a step size and a place to start from.
pub trait Scene: Clebsch<Scalar: Real, Configuration: Slots, Momentum: Slots, Input: Slots> + Clone {
    /// The system with ordinary parameters.
    fn ordinary() -> Self;
    /// A step size of it.
    fn step_size() -> Self::Scalar;
    /// A configuration on its orbit.
    fn configuration() -> Self::Configuration;
    /// The fields that formulas read, and how many numbers are in each.
    fn fields(&mut self) -> Vec<(&'static str, usize)>;
    /// The system with the number `value` at a place of a field.
    fn with_field(self, field: &str, place: usize, value: f64) -> Self;
}

/// What has failed.
pub struct Report {
    scene: &'static str,
    pub failures: Vec<String>,
    /// How often a call gave a result, and an error.
    pub counts: [usize; 2],
}

impl Report {
    pub fn new(scene: &'static str) -> Report {
        Report { scene, failures: Vec::new(), counts: [0; 2] }
    }

    fn fail(&mut self, place: &str, what: &str) {
        let failure = format!("{}, {place}: {what}", self.scene);
        if !self.failures.contains(&failure) {
            self.failures.push(failure);
        }
    }

    /// A call whose result has to be finite; what it returns, unless it fails or panics.
    fn call<R>(
        &mut self,
        at: (&str, &str),
        call: impl FnOnce() -> Result<R, Error>,
        is_finite: impl FnOnce(&R) -> bool,
    ) -> Option<R> {
        let result = catch_unwind(AssertUnwindSafe(call));
        let outcome = match &result {
            Err(_) => Outcome::Panicked,
            Ok(Err(error)) => Outcome::Refused(*error),
            Ok(Ok(value)) => Outcome::Returned { is_finite: is_finite(value) },
        };
        let is_good = self.judge(at, outcome);
        result.ok().and_then(Result::ok).filter(|_| is_good)
    }

    /// Whether a call gave something to go on with. Compiled once, while calls are compiled for each system.
    fn judge(&mut self, (place, entry): (&str, &str), outcome: Outcome) -> bool {
        match outcome {
            Outcome::Panicked => self.fail(place, &format!("`{entry}` panicked")),
            Outcome::Refused(error) => {
                self.counts[1] += 1;
                let text = error.to_string().replace("look for NaN, infinity", "");
                if ["NaN", "inf"].iter().any(|number| text.contains(number)) && !text.contains("singular") {
                    self.fail(place, &format!("`{entry}` says {text}"));
                }
            }
            Outcome::Returned { is_finite: true } => self.counts[0] += 1,
            Outcome::Returned { is_finite: false } => {
                self.fail(place, &format!("`{entry}` gave a result that is not finite"));
            }
        }
        matches!(outcome, Outcome::Returned { is_finite: true })
    }

    /// A formula that has no error to give: it may pass on what it is given.
    fn formula<R>(&mut self, (place, entry): (&str, &str), formula: impl FnOnce() -> R) {
        if catch_unwind(AssertUnwindSafe(formula)).is_err() {
            self.fail(place, &format!("`{entry}` panicked"));
        }
    }

    /// A call that has to refuse, naming this.
    fn refused<R>(&mut self, at: (&str, &str), call: impl FnOnce() -> Result<R, Error>, named: &str) {
        let outcome = match catch_unwind(AssertUnwindSafe(call)) {
            Err(_) => Outcome::Panicked,
            Ok(Err(error)) => Outcome::Refused(error),
            Ok(Ok(_)) => Outcome::Returned { is_finite: true },
        };
        self.judge_refusal(at, outcome, named);
    }

    /// Whether it did; compiled once too.
    fn judge_refusal(&mut self, (place, entry): (&str, &str), outcome: Outcome, named: &str) {
        let names = |error: Error| match error {
            Error::NotFinite { name } => name == named,
            Error::StepSize { .. } => named == "the step size",
            _ => false,
        };
        match outcome {
            Outcome::Refused(error) if names(error) => self.counts[1] += 1,
            Outcome::Refused(error) => {
                self.fail(place, &format!("`{entry}` says {error:?} and not that {named} is broken"));
            }
            Outcome::Returned { .. } => self.fail(place, &format!("`{entry}` takes it")),
            Outcome::Panicked => self.fail(place, &format!("`{entry}` panicked")),
        }
    }
}

/// How a call ended.
#[derive(Clone, Copy)]
enum Outcome {
    Panicked,
    Refused(Error),
    Returned { is_finite: bool },
}

fn is_finite<S: Clebsch>(state: &State<S>) -> bool {
    state.configuration().is_finite() && state.momentum().is_finite()
}

/// A momentum that motions of the configuration can have.
pub fn momentum<S: Scene>(stepper: &Stepper<S>) -> S::Momentum {
    let momentum = S::Momentum::filled(Scalar::from_ratio(3, 10));
    stepper.project(&S::configuration(), &momentum).expect("a projection")
}

/// A step that is compiled once for all calls.
#[inline(never)]
pub fn step<S: Clebsch>(stepper: &Stepper<S>, state: &State<S>) -> Result<State<S>, Error> {
    stepper.step(state)
}

/// The same with an input.
#[inline(never)]
fn step_with<S: Clebsch>(stepper: &Stepper<S>, state: &State<S>, input: &S::Input) -> Result<State<S>, Error> {
    stepper.step_with(state, input)
}

/// All entry points that take a state, from (q, N).
pub fn steps<S: Scene>(report: &mut Report, place: &str, stepper: &Stepper<S>, q: S::Configuration, mu: S::Momentum) {
    let at = |entry| (place, entry);
    let (zero, small) = (S::Scalar::from_f64(0.0), S::Scalar::from_f64(0.1));
    formulas(report, place, stepper, q, mu);
    report.call(at("project"), || stepper.project(&q, &mu), |mu| mu.is_finite());
    report.call(at("inverse_legendre"), || stepper.inverse_legendre_at(zero, &q, &mu), |f| f.is_finite());
    let cotangent = report.call(at("cotangent_state"), || stepper.cotangent_state(q, q), |_| true);
    if let Some(start) = cotangent {
        report.call(
            at("step_symmetric"),
            || stepper.step_symmetric(&start),
            |next| next.configuration().is_finite() && next.covector().is_finite(),
        );
    }
    report.call(at("staggered_state"), || stepper.staggered_state(q, mu), is_finite);
    let Some(start) = report.call(at("state"), || stepper.state(q, mu), is_finite) else { return };
    report.call(at("step"), || step(stepper, &start), is_finite);
    report.call(at("step_with"), || step_with(stepper, &start, &S::Input::filled(small)), is_finite);
    report.call(at("advance"), || stepper.advance(&start, 3), is_finite);
    report.call(at("trajectory"), || stepper.trajectory(start).take(4).last().unwrap_or(Ok(start)), is_finite);
    report.call(at("another step size"), || step(&stepper.system().stepper(small)?, &start), is_finite);
    report.formula(at("energy"), || (stepper.energy(&start), stepper.synchronized_energy(&start)));
    report.formula(at("synchronized"), || stepper.synchronized(&start));
    report.formula(at("failure"), || stepper.failure(&start, 0));
    report.call(at("step_each"), || Ok(stepper.step_each(&start).0), is_finite);
    ensemble(report, place, stepper, &start);
}

/// What is evaluated as it stands.
fn formulas<S: Scene>(report: &mut Report, place: &str, stepper: &Stepper<S>, q: S::Configuration, mu: S::Momentum) {
    let (at, zero) = (|entry| (place, entry), S::Scalar::from_f64(0.0));
    report.formula(at("momentum_map"), || stepper.momentum_map(&q, &q));
    report.formula(at("momentum_matrix"), || stepper.momentum_components(&stepper.momentum_matrix(&mu)));
    report.formula(at("potential"), || stepper.potential_at(zero, &q));
    let broken = S::Element::filled(S::Scalar::from_f64(f64::NAN));
    report.formula(at("legendre"), || stepper.legendre_at(zero, &q, &broken));
    report.formula(at("legendre_next"), || stepper.legendre_next_at(zero, &q, &broken));
    report.formula(at("act"), || (stepper.act(&broken, &q), stepper.coadjoint(&broken, &mu)));
}

/// Bodies of an ensemble stay where they were when their step fails, and the others do not notice.
fn ensemble<S: Scene>(report: &mut Report, place: &str, stepper: &Stepper<S>, start: &State<S>) {
    let bodies = || stepper.clone().ensemble([start.lane(0), start.lane(0)]).map_err(|failure| failure.error);
    let Some(mut bodies) = report.call((place, "Ensemble"), bodies, |_| true) else { return };
    report.formula((place, "Ensemble::advance"), || bodies.advance(2));
    let last: Vec<_> = bodies.bodies().collect();
    if !last.iter().all(|(q, mu)| q.is_finite() && mu.is_finite()) {
        report.fail(place, "a body of the ensemble is not finite");
    }
    let stays = bodies.failures().filter(|failure| failure.step == 0).all(|failure| {
        let (q, mu) = &last[failure.body];
        format!("{q:?} {mu:?}") == format!("{:?} {:?}", start.lane(0).0, start.lane(0).1)
    });
    if !stays {
        report.fail(place, "a body whose step failed did not stay where it was");
    }
}

/// One number of the scene after the other is replaced.
pub fn check<S: Scene>() -> Report {
    let mut report = Report::new(S::NAME);
    let (q, h) = (S::configuration(), S::step_size());
    let stepper = S::ordinary().stepper(h).expect("an ordinary system");
    let mu = momentum(&stepper);
    let before = report.counts[1];
    steps(&mut report, "nothing replaced", &stepper, q, mu);
    // a system with forces, or of momenta alone, has no covectors to step
    assert!(report.counts[1] - before <= 1, "{}: an ordinary step fails", S::NAME);

    parameters::<S>(&mut report, mu);
    for value in BROKEN.into_iter().chain(EXTREME) {
        configurations(&mut report, &stepper, value, mu);
        momenta(&mut report, &stepper, value, mu);
        inputs(&mut report, &stepper, value, mu);
        step_sizes::<S>(&mut report, value, mu);
    }
    report
}

fn parameters<S: Scene>(report: &mut Report, mu: S::Momentum) {
    let (q, h) = (S::configuration(), S::step_size());
    for (field, count) in S::ordinary().fields() {
        for (entry, value) in (0..count).flat_map(|entry| BROKEN.map(|value| (entry, value))) {
            let system = S::ordinary().with_field(field, entry, value);
            let place = format!("{field}[{entry}] = {value:e}");
            // fields of tuples are called as they are read
            let named = match field {
                "0" => "self.0",
                "1" => "self.1",
                other => other,
            };
            match S::NAME == "Harmonics" && field == "coefficients" {
                // what methods read is not known
                true => report.refused((&place, "state"), || system.stepper(h)?.state(q, mu), GRADIENT),
                false => report.refused((&place, "stepper"), || system.stepper(h), named),
            }
        }
        for (entry, value) in (0..count).flat_map(|entry| EXTREME.map(|value| (entry, value))) {
            let system = S::ordinary().with_field(field, entry, value);
            let place = format!("{field}[{entry}] = {value:e}");
            if let Some(stepper) = report.call((&place, "stepper"), || system.stepper(h), |_| true) {
                steps(report, &place, &stepper, q, mu);
            }
        }
    }
}

fn configurations<S: Scene>(report: &mut Report, stepper: &Stepper<S>, value: f64, mu: S::Momentum) {
    let mut configuration = S::configuration();
    for entry in 0..configuration.slots().len() {
        let (q, place) = (S::configuration().with(entry, value), format!("q[{entry}] = {value:e}"));
        if value.is_finite() {
            steps(report, &place, stepper, q, mu);
            covectors(report, &place, stepper, q);
            continue;
        }
        report.refused((&place, "state"), || stepper.state(q, mu), "the configuration");
        report.refused((&place, "staggered_state"), || stepper.staggered_state(q, mu), "the configuration");
        report.refused((&place, "project"), || stepper.project(&q, &mu), "the configuration");
        report.refused((&place, "cotangent_state"), || stepper.cotangent_state(q, q), "the configuration");
        report.refused((&place, "covector"), || stepper.cotangent_state(configuration, q), "the covector");
        let zero = S::Scalar::from_f64(0.0);
        let named = "the configuration";
        report.refused((&place, "inverse_legendre"), || stepper.inverse_legendre_at(zero, &q, &mu), named);
        formulas(report, &place, stepper, q, mu);
    }
}

fn covectors<S: Scene>(report: &mut Report, place: &str, stepper: &Stepper<S>, p: S::Configuration) {
    let start = || stepper.cotangent_state(S::configuration(), p);
    let is_finite = |state: &clebsch::CotangentState<S>| state.covector().is_finite();
    report.call((place, "step_symmetric of a covector"), || stepper.step_symmetric(&start()?), is_finite);
}

fn momenta<S: Scene>(report: &mut Report, stepper: &Stepper<S>, value: f64, mu: S::Momentum) {
    let (q, mut entries) = (S::configuration(), mu);
    let count = entries.slots().len();
    let replaced = (0..count).map(|entry| (mu.with(entry, value), format!("N[{entry}] = {value:e}")));
    for (mu, place) in replaced.chain([(mu.with_all(value), format!("N = {value:e}"))]) {
        if value.is_finite() {
            steps(report, &place, stepper, q, mu);
            // the nearest that is a momentum of a motion
            if let Ok(mu) = stepper.project(&q, &mu) {
                steps(report, &place, stepper, q, mu);
            }
            continue;
        }
        let zero = S::Scalar::from_f64(0.0);
        report.refused((&place, "state"), || stepper.state(q, mu), "the momentum");
        report.refused((&place, "staggered_state"), || stepper.staggered_state(q, mu), "the momentum");
        report.refused((&place, "project"), || stepper.project(&q, &mu), "the momentum");
        report.refused((&place, "inverse_legendre"), || stepper.inverse_legendre_at(zero, &q, &mu), "the momentum");
        formulas(report, &place, stepper, q, mu);
    }
}

fn inputs<S: Scene>(report: &mut Report, stepper: &Stepper<S>, value: f64, mu: S::Momentum) {
    let Ok(start) = stepper.state(S::configuration(), mu) else { return };
    let mut input = S::Input::origin();
    for entry in 0..input.slots().len() {
        let (u, place) = (S::Input::origin().with(entry, value), format!("u[{entry}] = {value:e}"));
        match value.is_finite() {
            true => drop(report.call((&place, "step_with"), || step_with(stepper, &start, &u), is_finite)),
            false => report.refused((&place, "step_with"), || step_with(stepper, &start, &u), "the input"),
        }
    }
}

fn step_sizes<S: Scene>(report: &mut Report, value: f64, mu: S::Momentum) {
    let mut h = S::Scalar::from_f64(value);
    // the extremes of single precision
    if value.is_finite() && !h.is_finite() {
        h = S::Scalar::from_f64(f64::from(f32::MAX.copysign(value as f32)));
    }
    let place = format!("h = {value:e}");
    if !value.is_finite() || value == 0.0 {
        return report.refused((&place, "stepper"), || S::ordinary().stepper(h), "the step size");
    }
    if let Some(stepper) = report.call((&place, "stepper"), || S::ordinary().stepper(h), |_| true) {
        steps(report, &place, &stepper, S::configuration(), mu);
    }
}
