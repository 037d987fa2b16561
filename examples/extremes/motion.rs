//! A scene that moves: the part that differs between methods and number types.
//!
//! All else of a probe is compiled once, and takes a motion as an object.

use crate::setup::Setup;
use clebsch::{Clebsch, Error, Method, Real, Scalar, Space, State, Stepper};

/// A declaration that can be set up.
pub trait Scene: Clebsch<Scalar: Real, Time = (), Input = ()> + Clone {
    /// The system.
    fn of(setup: &Setup) -> Self;

    /// Where it starts.
    ///
    /// # Errors
    /// Those of [`Stepper::state`].
    fn start<M: Method<Self>>(setup: &Setup, stepper: &Stepper<Self, M>) -> Result<State<Self, M>, Error>;

    /// Configuration and momentum.
    fn numbers<M: Method<Self>>(state: &State<Self, M>) -> Vec<f64>;

    /// The momenta that no step changes, zeros for those that it has not.
    fn conserved<M: Method<Self>>(stepper: &Stepper<Self, M>, state: &State<Self, M>) -> [f64; 3];
}

/// Steps from a start.
pub trait Motion {
    /// One step; where it is refused, the state stays.
    ///
    /// # Errors
    /// Those of [`Stepper::step`].
    fn step(&mut self) -> Result<(), Error>;

    /// Configuration and momentum.
    fn numbers(&self) -> Vec<f64>;
}

/// Steps that are watched.
pub trait Watched: Motion {
    /// Starts once more, with the parameters and the step size of before.
    ///
    /// # Errors
    /// Those of [`Stepper::state`].
    fn restart(&mut self, setup: &Setup) -> Result<(), Error>;

    /// The observation of a state.
    fn observe(&self) -> Observation;

    /// Whether a step is that of one equation F⁻ℓd(q, F) = N.
    fn has_equation(&self) -> bool;

    /// |F⁻ℓd(q, F) − N| for the F that the next step finds, over the larger one of |N| and |F⁺ℓd(q, F)|; `None` where it finds none.
    fn residual(&self) -> Option<f64>;

    /// Whether configuration and momentum are finite.
    fn is_finite(&self) -> bool;
}

/// Steps of a long run.
pub trait Advancing: Watched {
    /// So many steps.
    ///
    /// # Errors
    /// That of the step which is refused.
    fn advance(&mut self, steps: usize) -> Result<(), Error>;
}

/// The quantities of a state that are followed.
#[derive(Clone, Copy, Debug)]
pub struct Observation {
    /// The energy.
    pub energy: f64,
    /// The largest component of the momentum.
    pub size: f64,
    /// [`Scene::conserved`].
    pub conserved: [f64; 3],
    /// The defect of the configuration.
    pub constraint: f64,
}

/// A scene and where it is.
pub struct Moving<S: Scene, M: Method<S>> {
    stepper: Stepper<S, M>,
    state: State<S, M>,
}

impl<S: Scene, M: Method<S>> Moving<S, M> {
    /// At the start.
    ///
    /// # Errors
    /// Those of [`Clebsch::into_stepper_by`] and [`Stepper::state`].
    pub fn new(setup: &Setup) -> Result<Self, Error> {
        let stepper = S::of(setup).into_stepper_by(S::Scalar::from_f64(setup.h))?;
        let state = S::start(setup, &stepper)?;
        Ok(Self { stepper, state })
    }
}

impl<S: Scene, M: Method<S>> Motion for Moving<S, M> {
    fn step(&mut self) -> Result<(), Error> {
        self.state = self.stepper.step(&self.state)?;
        Ok(())
    }

    fn numbers(&self) -> Vec<f64> {
        S::numbers(&self.state)
    }
}

impl<S: Scene, M: Method<S>> Watched for Moving<S, M> {
    fn restart(&mut self, setup: &Setup) -> Result<(), Error> {
        self.state = S::start(setup, &self.stepper)?;
        Ok(())
    }

    fn observe(&self) -> Observation {
        let Self { stepper, state } = self;
        Observation {
            energy: stepper.energy(state).to_f64(),
            size: state.momentum().max_abs().to_f64(),
            conserved: S::conserved(stepper, state),
            constraint: stepper.system().orbit_defect(state.configuration()).to_f64(),
        }
    }

    fn has_equation(&self) -> bool {
        M::ORDER == 2
    }

    fn residual(&self) -> Option<f64> {
        // known to the compiler, which makes no solver for those without
        if M::ORDER != 2 {
            return None;
        }
        let (q, n) = (self.state.configuration(), self.state.momentum());
        let f = self.stepper.inverse_legendre(q, &n).ok()?;
        let found = self.stepper.legendre(q, &f);
        let size = n.max_abs().to_f64().max(self.stepper.legendre_next(q, &f).max_abs().to_f64());
        Some(if size == 0.0 { 0.0 } else { found.zip_map(&n, |found, n| found - n).max_abs().to_f64() / size })
    }

    fn is_finite(&self) -> bool {
        self.state.configuration().all_finite() && self.state.momentum().all_finite()
    }
}

impl<S: Scene, M: Method<S>> Advancing for Moving<S, M> {
    fn advance(&mut self, steps: usize) -> Result<(), Error> {
        self.state = self.stepper.advance(&self.state, steps)?;
        Ok(())
    }
}
