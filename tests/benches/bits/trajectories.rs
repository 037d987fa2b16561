//! The records of each system.

use crate::record::Record;
use crate::run::{Start, Task, stepped, uneven};
use clebsch::{Clebsch, CotangentState, Error, Method, Scalar, Space, State, Stepper};
use clebsch_tests::oracle::bits::Bits;
use std::cell::RefCell;

/// Steps of a trajectory.
const STEPS: usize = 1000;
/// Steps of other ways to step.
const FEW: usize = 200;
/// Steps from one point to the next at which formulas are evaluated.
const STRIDE: usize = 100;

/// Hashes of everything.
#[derive(Default)]
pub struct Recorder {
    lines: RefCell<Vec<String>>,
}

impl Recorder {
    /// The lines that have been recorded.
    pub fn lines(self) -> Vec<String> {
        self.lines.into_inner()
    }

    /// Records a quantity.
    pub fn quantity(&self, name: &str, quantity: &str, fill: impl FnOnce(&Record)) {
        let record = Record::new();
        fill(&record);
        self.lines.borrow_mut().push(record.line(name, quantity));
    }
}

impl Task for Recorder {
    fn fixture<S>(
        &self,
        name: &str,
        system: S,
        q: S::Configuration,
        h: S::Scalar,
        conserved: impl Fn(&Stepper<S>, &State<S>) -> String,
    ) where
        S: Clebsch<Scalar: Scalar<Lane: Bits>> + Clone,
    {
        let start = Start::new(system, q, h);
        trajectories(self, name, &start);
        ways_to_step(self, name, &start);
        formulas(self, name, &start, conserved);
    }

    fn combination_by<S, M>(&self, name: &str, system: S, q: S::Configuration, h: S::Scalar)
    where
        S: Clebsch<Scalar: Scalar<Lane: Bits>> + Clone,
        M: Method<S>,
    {
        trajectories(self, name, &Start::<S, M>::new(system, q, h));
    }
}

#[inline(never)]
fn step<S: Clebsch, M: Method<S>>(stepper: &Stepper<S, M>, state: &State<S, M>) -> Result<State<S, M>, Error> {
    stepper.step(state)
}

/// (q, N), or the error in its place; whether it is one.
fn put<S, M>(record: &Record, state: &Result<State<S, M>, Error>) -> bool
where
    S: Clebsch<Scalar: Scalar<Lane: Bits>>,
    M: Method<S>,
{
    match state {
        Ok(state) => {
            record.add(state.configuration());
            record.add(&state.momentum());
        }
        Err(error) => record.note(&format!("{error:?}")),
    }
    state.is_ok()
}

/// Steps one by one and at once.
fn trajectories<S, M>(task: &Recorder, name: &str, start: &Start<S, M>)
where
    S: Clebsch<Scalar: Scalar<Lane: Bits>> + Clone,
    M: Method<S>,
{
    let stepper = &start.stepper;
    task.quantity(name, "step", |record| {
        let mut state = start.state();
        for _ in 0..STEPS {
            let next = step(stepper, &state);
            if !put(record, &next) {
                break;
            }
            state = next.unwrap_or(state);
        }
    });
    task.quantity(name, "advance", |record| {
        put(record, &stepper.advance(&start.state(), 7));
        put(record, &stepper.advance(&start.state(), STEPS));
    });
    task.quantity(name, "step_symmetric", |record| {
        let mut state = stepper.cotangent_state(start.q, uneven(0.5)).expect("a state");
        for _ in 0..FEW {
            match stepper.step_symmetric(&state) {
                Ok(next) => state = next,
                Err(error) => return record.note(&format!("{error:?}")),
            }
            put_covector(record, &state);
        }
    });
}

fn put_covector<S: Clebsch<Scalar: Scalar<Lane: Bits>>>(record: &Record, state: &CotangentState<S>) {
    record.add(state.configuration());
    record.add(state.covector());
}

/// Steps in place, of another size, with an input, from a staggered state, too long ones.
fn ways_to_step<S: Clebsch<Scalar: Scalar<Lane: Bits>> + Clone>(task: &Recorder, name: &str, start: &Start<S>) {
    let stepper = &start.stepper;
    task.quantity(name, "integrator", |record| {
        let mut integrator = stepper.clone().integrator(start.state());
        let advanced = integrator.advance(FEW as u64);
        put(record, &advanced.map(|()| *integrator.state()));
    });
    task.quantity(name, "other_step_size", |record| {
        let h = stepper.step_size() * S::Scalar::from_f64(0.7);
        let other = stepper.system().stepper(h).expect("parameters");
        let mut state = start.state();
        for k in 0..FEW {
            let next = step(if k % 3 == 0 { &other } else { stepper }, &state);
            if !put(record, &next) {
                break;
            }
            state = next.unwrap_or(state);
        }
    });
    if size_of::<S::Input>() > 0 {
        task.quantity(name, "step_with", |record| {
            let mut state = start.state();
            for _ in 0..FEW {
                let next = stepper.step_with(&state, &uneven(0.1));
                if !put(record, &next) {
                    break;
                }
                state = next.unwrap_or(state);
            }
        });
    }
    task.quantity(name, "staggered", |record| {
        let state = stepper.staggered_state(start.q, start.mu);
        put(record, &state.and_then(|state| stepped(stepper, state, 7)));
    });
    task.quantity(name, "too_long", |record| {
        for size in [30.0, 1000.0, 1e5, 1e9] {
            let mu = start.mu.zip_map(&start.mu, |x, _| x * S::Scalar::from_f64(size));
            put(record, &stepper.state(start.q, mu).and_then(|state| step(stepper, &state)));
        }
    });
}

/// The formulas at points of the trajectory.
fn formulas<S: Clebsch<Scalar: Scalar<Lane: Bits>> + Clone>(
    task: &Recorder,
    name: &str,
    start: &Start<S>,
    conserved: impl Fn(&Stepper<S>, &State<S>) -> String,
) {
    let stepper = &start.stepper;
    let points = points(start);
    let each = |quantity: &str, put: &dyn Fn(&Record, &Point<S>)| {
        task.quantity(name, quantity, |record| points.iter().for_each(|point| put(record, point)));
    };
    let p: S::Configuration = uneven(0.5);
    each("inverse_legendre", &|record, point| {
        record.result(stepper.inverse_legendre_at(point.t, point.q(), &point.mu));
    });
    each("legendre", &|record, point| record.add(&stepper.legendre_at(point.t, point.q(), &point.f)));
    each("legendre_next", &|record, point| record.add(&stepper.legendre_next_at(point.t, point.q(), &point.f)));
    each("act", &|record, point| record.add(&stepper.act(&point.f, point.q())));
    each("coadjoint", &|record, point| record.add(&stepper.coadjoint(&point.f, &point.mu)));
    each("momentum_map", &|record, point| record.add(&stepper.momentum_map(point.q(), &p)));
    each("momentum_matrix", &|record, point| record.add(&stepper.momentum_matrix(&point.mu)));
    each("project", &|record, point| {
        record.result(stepper.project(*point.q(), uneven(1.0)).map(|state| state.momentum()))
    });
    each("potential", &|record, point| record.add(&stepper.potential_at(point.t, point.q())));
    each("kinetic_energy", &|record, point| record.add(&stepper.kinetic_energy(&point.state)));
    each("synchronized", &|record, point| {
        record.add(&stepper.synchronized(&point.state));
        record.add(&stepper.synchronized_energy(&point.state));
    });
    each("conserved", &|record, point| record.note(&conserved(stepper, &point.state)));
}

/// A state with the element that its step moves by.
struct Point<S: Clebsch> {
    t: S::Scalar,
    state: State<S>,
    mu: S::Momentum,
    f: S::Element,
}

impl<S: Clebsch> Point<S> {
    fn q(&self) -> &S::Configuration {
        self.state.configuration()
    }
}

fn points<S: Clebsch<Scalar: Scalar<Lane: Bits>> + Clone>(start: &Start<S>) -> Vec<Point<S>> {
    let stepper = &start.stepper;
    let mut points = Vec::new();
    let mut state = start.state();
    for k in (0..STEPS).step_by(STRIDE) {
        let t = stepper.step_size() * S::Scalar::from_f64(k as f64);
        let mu = state.momentum();
        let f = stepper.inverse_legendre_at(t, state.configuration(), &mu).unwrap_or(uneven(1.0));
        points.push(Point { t, state, mu, f });
        match stepped(stepper, state, STRIDE) {
            Ok(next) => state = next,
            Err(_) => break,
        }
    }
    points
}
