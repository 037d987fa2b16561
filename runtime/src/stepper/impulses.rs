//! States that are changed from outside: impulses, and other configurations.

use super::{Stepper, check_violation};
use crate::parameters::check_finite;
use crate::scheme::Scheme;
use crate::space::{minus, plus};
use crate::{Clebsch, Error, Method, State, Time};

impl<S: Clebsch, M: Method<S>> Stepper<S, M> {
    /// The state after an impulse Δμ, as of a hit, a contact or a thruster: the same q and time, and N⁺ = N + Δμ.
    ///
    /// Δμ has the components, the basis and the units of [`State::momentum`]. A push p on the configuration has
    /// Δμ = J(q, p), by [`momentum_map`](Self::momentum_map). With `order = 1` the momentum that
    /// [`synchronized`](Self::synchronized) reads changes by Δμ too.
    ///
    /// The state is not checked again, only the impulse is. The time, the impulse of the potential at q and the rounding
    /// errors of compensated sums stay as they are. The constants of a free motion are made anew. An impulse costs no
    /// gradient.
    ///
    /// A constraint answers with an impulse of its own, N⁺ = N + Δμ + Aᵀκ. So the velocity after the kick obeys the
    /// constraint. It is the velocity nearest in the kinetic energy to that of N + Δμ.
    ///
    /// ```
    /// # use clebsch::Clebsch;
    /// # #[derive(Clebsch, Clone, Debug)]
    /// # #[clebsch(
    /// #     action     = |a: Translation<2>, x: Vector2| x + a,
    /// #     lagrangian = |v| self.mass * v.norm_squared() / 2,
    /// #     potential  = |x| self.mass * self.gravity * x.y,
    /// # )]
    /// # struct Ball { mass: f64, gravity: f64 }
    /// # use nalgebra::Vector2;
    /// let stepper = Ball { mass: 0.5, gravity: 9.81 }.into_stepper(0.01)?;
    /// let falling = stepper.state(Vector2::zeros(), Vector2::new(1.0, -2.0))?;
    /// // the floor returns 0.8 of the velocity along y
    /// let bounced = stepper.kick(&falling, Vector2::new(0.0, 1.8 * 2.0))?;
    /// assert_eq!(bounced.configuration(), falling.configuration());
    /// assert!((bounced.momentum() - Vector2::new(1.0, 1.6)).norm() < 1e-15);
    /// # Ok::<(), clebsch::Error>(())
    /// ```
    ///
    /// Source: the reaction of a constraint to an impulse is Gauss's principle of least constraint, as in
    /// [`project`](Self::project).
    ///
    /// # Errors
    /// [`Error::NotFinite`] for the impulse or for the momentum after it. [`Error::OutsideMomentumSpace`] if the impulse has
    /// a component along motions that leave q unchanged. [`Error::DependentConstraints`] as for [`state`](Self::state).
    pub fn kick(&self, state: &State<S, M>, impulse: S::Momentum) -> Result<State<S, M>, Error> {
        let State { time, configuration: q, held, .. } = state;
        let t = time.now();
        check_finite("the impulse", &impulse)?;
        check_violation(self.system.isotropy_defect(q, &impulse), &impulse)?;
        let pushed = plus(&state.momentum(), &impulse);
        check_finite("the momentum after the kick", &pushed)?;
        let constrained = M::constrained(&self.system, M::Scheme::whole(&self.constants), t, q, &pushed)?;
        // without a constraint the difference is 0, and the sum below is that of N and Δμ alone
        let impulse = plus(&impulse, &minus(&constrained, &pushed));
        let left = self.left_of(state);
        let (held, left) = M::Scheme::kicked(self.at(t), q, (held, &left), &impulse);
        check_finite("the momentum after the kick", &held)?;
        self.check_left(t, q, &left)?;
        Ok(State { held, left, h: self.h, ..*state })
    }

    /// The state at another configuration, as after the correction of a place or an attitude: the same time, and the
    /// same components of N.
    ///
    /// Components along motions that leave q unchanged go, and those that a constraint does not allow there, as by
    /// [`project`](Self::project). Of a right action, such as `R * F` of a body, N is the momentum in the body frame. Its
    /// spatial momentum turns along with the body. [`kick`](Self::kick) adds the difference where it has to stay.
    ///
    /// The configuration is checked as by [`state`](Self::state). The time and the rounding errors of compensated sums of N
    /// stay as they are. The impulse of the potential is computed at the new q.
    ///
    /// ```
    /// # use clebsch::Clebsch;
    /// # #[derive(Clebsch, Clone, Debug)]
    /// # #[clebsch(
    /// #     action    = |F: SO<3>, q: Unit<Vector3>| F * q,
    /// #     cost      = |h, F| (F - I).norm_squared() / (4 * h),
    /// #     potential = |q| q.z,
    /// # )]
    /// # struct Pendulum;
    /// # use nalgebra::{Rotation3, Vector3};
    /// let stepper = Pendulum.into_stepper(0.01)?;
    /// let state = stepper.state(Vector3::x(), Vector3::new(0.0, 0.6, 0.2))?;
    /// let turn = *Rotation3::from_axis_angle(&Vector3::y_axis(), 0.1).matrix();
    /// let corrected = stepper.with_configuration(&state, stepper.act(&turn, state.configuration()))?;
    /// assert!((corrected.configuration().z + 0.1_f64.sin()).abs() < 1e-15);
    /// assert!(corrected.momentum().dot(corrected.configuration()).abs() < 1e-15);
    /// # Ok::<(), clebsch::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::OffOrbit`], [`Error::OffConstraint`], [`Error::DependentConstraints`],
    /// [`Error::IndefiniteKineticEnergy`] or [`Error::Monitor`] as for [`state`](Self::state).
    pub fn with_configuration(&self, state: &State<S, M>, q: S::Configuration) -> Result<State<S, M>, Error> {
        let t = state.time.now();
        self.check_place(t, &q)?;
        self.system.check_place(t, &q)?;
        let mu = self.system.project_momentum(&q, &state.momentum());
        check_finite("the momentum", &mu)?;
        let mu = M::constrained(&self.system, M::Scheme::whole(&self.constants), t, &q, &mu)?;
        check_finite("the momentum", &mu)?;
        let left = M::Scheme::left_elsewhere(self.at(t), &q, &mu, &state.left);
        self.check_left(t, &q, &left)?;
        Ok(State { configuration: q, held: M::Scheme::held(&q, &mu), left, h: self.h, ..*state })
    }
}
