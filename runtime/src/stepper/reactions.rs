//! The forces of constraints.

use super::stepping::check_input;
use super::{Stepper, first_without, whole_or_lane};
use crate::scheme::{Push, Scheme};
use crate::{Error, Method, Reacting, Scalar, Space, State, Time};

/// Where the declaration has a constraint.
impl<S: Reacting<M>, M: Method<S>> Stepper<S, M> {
    /// The multipliers λ of the constraint at a state, one for each scalar equation.
    ///
    /// Aᵀλ is the force of the constraint in 𝔤*, in the components of the momentum: N′ = N′_free + Aᵀλ with A ξ = b at all
    /// times. λ is that of the continuous motion through the state, exact up to rounding for every step size.
    ///
    /// Without a velocity in the equations, the rows are A = J(q, ∂φ), and λ is conjugate to φ. If φ is in metres, λ is in
    /// newtons. A positive λ pushes towards a larger φ.
    ///
    /// ```
    /// # use clebsch::Clebsch;
    /// # #[derive(Clebsch, Clone, Debug)]
    /// # #[clebsch(
    /// #     action     = |a: Translation<3>, x: Vector3| x + a,
    /// #     lagrangian = |v| self.mass * v.norm_squared() / 2,
    /// #     potential  = |x| self.mass * self.gravity * x.z,
    /// #     constraint = |x| [x.norm() == self.length],
    /// # )]
    /// # struct Bob { mass: f64, gravity: f64, length: f64 }
    /// # use nalgebra::Vector3;
    /// // 2 kg on a rod of 0.5 m, at the lowest point with 3 m/s: a pull of m (g + v²/l) towards the pivot
    /// let stepper = Bob { mass: 2.0, gravity: 10.0, length: 0.5 }.into_stepper(0.01)?;
    /// let start = stepper.state_moving(Vector3::new(0.0, 0.0, -0.5), Vector3::new(3.0, 0.0, 0.0))?;
    /// assert!((stepper.reactions(&start)?.x + 56.0).abs() < 1e-13);
    /// # Ok::<(), clebsch::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::DependentConstraints`] where the rows depend on each other, [`Error::NotFinite`] where numbers overflow.
    pub fn reactions(&self, state: &State<S, M>) -> Result<S::Reactions, Error> {
        self.reactions_under(state, &S::Input::origin())
    }

    /// The same while the input of the forces is `u`.
    ///
    /// # Errors
    /// As [`reactions`](Self::reactions), and [`Error::NotFinite`] where the input is not.
    pub fn reactions_under(&self, state: &State<S, M>, u: &S::Input) -> Result<S::Reactions, Error> {
        check_input::<S>(u)?;
        let constants = M::Scheme::whole(&self.constants);
        let (t, q) = (state.time.now(), state.configuration());
        checked(self.system.reactions_of_motion(constants, t, q, &state.momentum(), u)?)
    }

    /// One step, as [`step`](Self::step), with the reactions of that step: the impulses of the constraint, one for each scalar
    /// equation, divided by h.
    ///
    /// They are the mean of the multipliers λ of the continuous motion over the step, to the order of the method. With
    /// order 2 they are also those at the middle of the step, up to O(h²). An impulse is λ + μ, the multipliers at both ends of
    /// a step. A composed step adds those of its parts.
    ///
    /// ```
    /// # use clebsch::Clebsch;
    /// # #[derive(Clebsch, Clone, Debug)]
    /// # #[clebsch(
    /// #     action     = |a: Translation<2>, x: Vector2| x + a,
    /// #     lagrangian = |v| self.mass * v.norm_squared() / 2,
    /// #     potential  = |x| self.weight * x.y,
    /// #     constraint = |x| [x.y == 0],
    /// # )]
    /// # struct Resting { mass: f64, weight: f64 }
    /// # use nalgebra::Vector2;
    /// // the floor carries the weight
    /// let stepper = Resting { mass: 2.0, weight: 20.0 }.into_stepper(0.01)?;
    /// let start = stepper.state_moving(Vector2::zeros(), Vector2::new(3.0, 0.0))?;
    /// let (next, reactions) = stepper.step_with_reactions(&start)?;
    /// assert_eq!(next, stepper.step(&start)?);
    /// assert!((reactions.x - 20.0).abs() < 1e-13);
    /// # Ok::<(), clebsch::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`step`](Self::step).
    pub fn step_with_reactions(&self, state: &State<S, M>) -> Result<(State<S, M>, S::Reactions), Error> {
        self.step_with_reactions_under(state, &S::Input::origin())
    }

    /// The same while the input of the forces is `u`, as [`step_with`](Self::step_with).
    ///
    /// # Errors
    /// As [`step_with`](Self::step_with).
    pub fn step_with_reactions_under(
        &self,
        state: &State<S, M>,
        u: &S::Input,
    ) -> Result<(State<S, M>, S::Reactions), Error> {
        check_input::<S>(u)?;
        let State { time, configuration, held, .. } = state;
        let left = self.left_of(state);
        let mut impulses = S::Reactions::origin();
        let pushed = |push: Push<'_, S, M>| {
            let Push { at, place, momentum, .. } = push.at_its_time(self.h);
            let impulse = at.system.multipliers(at.constants, at.t, place, momentum);
            impulses = impulses.zip_map(&impulse, |sum, part| sum + part);
        };
        let stepped = M::Scheme::step_pushed(self.at(time.now()), (configuration, held, &left), u, pushed);
        let Ok((configuration, held, left)) = stepped else { return Err(self.refused(state, u)) };
        let next = State { time: time.after_step(self.h), configuration, held, left, h: self.h };
        if !self.is_sound(&next) {
            return Err(self.beyond(&next));
        }
        Ok((next, checked(impulses.zip_map(&impulses, |impulse, _| impulse / self.h))?))
    }
}

/// Reactions that are finite.
fn checked<T: Scalar, R: Space<T>>(reactions: R) -> Result<R, Error> {
    if reactions.all_finite() {
        return Ok(reactions);
    }
    let lane = first_without::<T>(reactions.finite());
    Err(whole_or_lane::<T>(lane, Error::NotFinite { name: "the reactions of the constraint" }))
}
