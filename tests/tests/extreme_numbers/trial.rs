//! The code that is compiled for each system: its entry points, each called in one place.

use crate::slots::{Part, Slot, Slots};
use clebsch::__private::Scheme;
use clebsch::{Body, Clebsch, CotangentState, Ensemble, Error, Real, Scalar, Space, State, Stepper};

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

/// The formulas that are evaluated as they stand.
pub const FORMULAS: [&str; 6] = ["momentum_map", "momentum_matrix", "potential", "legendre", "legendre_next", "act"];

/// Round-off of a configuration after some steps, in units of ε.
const ROUNDING: f64 = 1024.0;

/// A step size.
#[derive(Clone, Copy)]
pub enum Size {
    /// The one of the scene.
    Ordinary,
    /// So many times that.
    Times(i64),
    /// This one; where single precision has no such number, its largest one.
    Of(f64),
}

/// A scene whose numbers are replaced, whatever its types.
pub trait Trial {
    /// The name of the system.
    fn name(&self) -> &'static str;
    /// [`Scene::fields`].
    fn fields(&self) -> Vec<(&'static str, usize)>;
    /// The ordinary numbers everywhere, and the ordinary stepper.
    fn restore(&mut self);
    /// Another stepper, with numbers replaced at places of fields.
    fn stepper(&mut self, replaced: &[(&str, usize, f64)], h: Size) -> Result<bool, Error>;
    /// The numbers of a part.
    fn slots(&mut self, part: Part) -> Vec<Slot<'_>>;
    /// One number of a part, the others being ordinary.
    fn replace(&mut self, part: Part, place: usize, value: f64) {
        self.restore();
        self.slots(part).into_iter().nth(place).expect("a place").put(value);
    }
    /// Calls an entry point with the numbers as they are; whether its result is finite and on the space of configurations.
    fn call(&mut self, entry: &str) -> Result<bool, Error>;
    /// Whether all bodies of the ensemble are finite, and whether those whose first step failed are where they were.
    fn bodies(&self) -> [bool; 2];
    /// Whether a step that is too long names the longest one. None is tried where each would take constants of
    /// kilobytes, but for free motions, where it is known.
    fn knows_the_longest(&self) -> bool;
}

/// The trial of a system.
pub struct Of<S: Scene> {
    /// The ordinary stepper and a momentum that motions of the configuration can have.
    ordinary: (Stepper<S>, S::Momentum),
    stepper: Stepper<S>,
    q: S::Configuration,
    mu: S::Momentum,
    input: S::Input,
    start: Option<State<S>>,
    cotangent: Option<CotangentState<S>>,
    ensemble: Option<Ensemble<S>>,
}

impl<S: Scene> Of<S> {
    pub fn new() -> Self {
        let stepper = S::ordinary().stepper(S::step_size()).expect("an ordinary system");
        let (q, mu) = (S::configuration(), S::Momentum::filled(Scalar::from_ratio(3, 10)));
        let mu = stepper.project(q, mu).expect("a projection").momentum();
        let input = S::Input::filled(S::Scalar::from_f64(0.1));
        let ordinary = (stepper.clone(), mu);
        Of { ordinary, stepper, q, mu, input, start: None, cotangent: None, ensemble: None }
    }

    fn start(&self) -> State<S> {
        self.start.expect("a state")
    }

    /// The step, compiled once.
    #[inline(never)]
    fn step(&self, stepper: &Stepper<S>) -> Result<bool, Error> {
        stepper.step(&self.start()).map(|next| self.is_sound(&next))
    }

    /// Whether a state is finite, and a configuration on its space.
    fn is_sound(&self, state: &State<S>) -> bool {
        state.momentum().all_finite() && self.is_on_space(state.configuration())
    }

    /// Whether a configuration is finite and where configurations lie, up to the round-off of its entries and to the defect of the start.
    /// On groups that are not compact, steps pass through larger elements, and configurations are those that `state` accepts.
    fn is_on_space(&self, q: &S::Configuration) -> bool {
        self.is_on_space_from(&self.q, q)
    }

    fn is_on_space_from(&self, start: &S::Configuration, q: &S::Configuration) -> bool {
        let defect = |q: &S::Configuration| self.stepper.system().orbit_defect(q).to_f64();
        let size = q.max_abs().to_f64().max(1.0);
        let rounding = ROUNDING * S::Scalar::EPSILON.to_f64();
        let most = match S::MAY_LEAVE_ORBIT {
            true => S::Scalar::EPSILON.to_f64().sqrt(),
            false => (rounding + 4.0 * defect(start)) * size * size,
        };
        q.all_finite() && defect(q) <= most
    }
}

impl<S: Scene> Trial for Of<S> {
    fn name(&self) -> &'static str {
        S::NAME
    }

    fn fields(&self) -> Vec<(&'static str, usize)> {
        S::ordinary().fields()
    }

    fn restore(&mut self) {
        (self.stepper, self.mu) = self.ordinary.clone();
        (self.q, self.input) = (S::configuration(), S::Input::filled(S::Scalar::from_f64(0.1)));
    }

    fn stepper(&mut self, replaced: &[(&str, usize, f64)], h: Size) -> Result<bool, Error> {
        let h = match h {
            Size::Ordinary => S::step_size(),
            Size::Times(times) => S::step_size() * S::Scalar::from_ratio(times, 1),
            Size::Of(value) => match S::Scalar::from_f64(value) {
                h if value.is_finite() && !h.is_finite() => {
                    S::Scalar::from_f64(f64::from(f32::MAX.copysign(value as f32)))
                }
                h => h,
            },
        };
        let mut system = S::ordinary();
        for &(field, place, value) in replaced {
            system = system.with_field(field, place, value);
        }
        self.stepper = system.stepper(h)?;
        Ok(true)
    }

    fn slots(&mut self, part: Part) -> Vec<Slot<'_>> {
        match part {
            Part::Configuration => self.q.slots(),
            Part::Momentum => self.mu.slots(),
            Part::Input => self.input.slots(),
        }
    }

    fn call(&mut self, entry: &str) -> Result<bool, Error> {
        let Of { stepper, q, mu, .. } = &*self;
        let (q, mu, zero) = (*q, *mu, S::Scalar::from_f64(0.0));
        let broken = || S::Element::filled(S::Scalar::from_f64(f64::NAN));
        match entry {
            "momentum_map" => drop(stepper.momentum_map(&q, &q)),
            "momentum_matrix" => drop(stepper.momentum_components(&stepper.momentum_matrix(&mu))),
            "potential" => drop(stepper.potential_at(zero, &q)),
            "legendre" => drop(stepper.legendre_at(zero, &q, &broken())),
            "legendre_next" => drop(stepper.legendre_next_at(zero, &q, &broken())),
            "act" => drop((stepper.act(&broken(), &q), stepper.coadjoint(&broken(), &mu))),
            "project" => return Ok(stepper.project(q, mu)?.momentum().all_finite()),
            "projected" => self.mu = stepper.project(q, mu)?.momentum(),
            "inverse_legendre" => {
                let f = stepper.inverse_legendre_at(zero, &q, &mu)?;
                let moved = stepper.act(&f, &q);
                // an entry near the largest number overflows when a finite F moves it: the step is refused for it
                let overflows = || stepper.state(q, mu).and_then(|start| stepper.step(&start)).is_err();
                return Ok(f.all_finite() && (self.is_on_space(&moved) || !moved.all_finite() && overflows()));
            }
            "cotangent_state" => self.cotangent = Some(stepper.cotangent_state(q, q)?),
            "covector" => self.cotangent = Some(stepper.cotangent_state(S::configuration(), q)?),
            "step_symmetric" | "step_symmetric of a covector" => {
                let start = match entry {
                    "step_symmetric" => self.cotangent.expect("a state"),
                    _ => stepper.cotangent_state(S::configuration(), q)?,
                };
                let next = stepper.step_symmetric(&start)?;
                return Ok(next.covector().all_finite()
                    && (entry != "step_symmetric" || self.is_on_space(next.configuration())));
            }
            "staggered_state" => return Ok(self.is_sound(&stepper.staggered_state(q, mu)?)),
            "state" => {
                let start = stepper.state(q, mu)?;
                self.start = Some(start);
                return Ok(self.is_sound(&start));
            }
            "step" => return self.step(stepper),
            "another step size" => {
                // a fixed one would be too long for the fastest scenes
                let other = stepper.system().stepper(S::step_size() * S::Scalar::from_ratio(1, 2))?;
                return self.step(&other);
            }
            "step_with" => return Ok(self.is_sound(&stepper.step_with(&self.start(), &self.input)?)),
            "advance" => return Ok(self.is_sound(&stepper.advance(&self.start(), 3)?)),
            "trajectory" => {
                let start = self.start();
                return Ok(self.is_sound(&stepper.trajectory(start).take(4).last().unwrap_or(Ok(start))?));
            }
            "energy" => drop((stepper.energy(&self.start()), stepper.synchronized_energy(&self.start()))),
            "synchronized" => drop(stepper.synchronized(&self.start())),
            "failure" => drop(stepper.failure(&self.start(), 0)),
            "step_each" => return Ok(self.is_sound(&stepper.step_each(&self.start()).0)),
            "Ensemble" => {
                let body = self.start().lane(0);
                self.ensemble = Some(stepper.clone().ensemble([body, body]).map_err(|failure| failure.error)?);
            }
            "Ensemble::advance" => self.ensemble.as_mut().expect("an ensemble").advance(2),
            other => unreachable!("no entry point `{other}`"),
        }
        Ok(true)
    }

    fn bodies(&self) -> [bool; 2] {
        let (ensemble, start) = (self.ensemble.as_ref().expect("an ensemble"), self.start().lane(0));
        let last: Vec<Body<S>> = ensemble.bodies().collect();
        let shown = |(q, mu): &Body<S>| format!("{q:?} {mu:?}");
        let mut failed = ensemble.failures().filter(|failure| failure.step == 0);
        let are_finite = last.iter().all(|(q, mu)| q.all_finite() && mu.all_finite());
        [are_finite, failed.all(|failure| shown(&last[failure.body]) == shown(&start))]
    }

    fn knows_the_longest(&self) -> bool {
        size_of::<<S::Scheme as Scheme<S>>::Constants>() <= 2048 || S::IS_FREE_MOTION
    }
}
