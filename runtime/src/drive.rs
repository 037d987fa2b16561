//! Drivers step a state of their own in place: a [`Stepper`](crate::Stepper) with its state.

use core::ops::ControlFlow;

#[cfg(feature = "alloc")]
mod ensemble;
mod integrator;
mod sites;

#[cfg(feature = "alloc")]
pub use ensemble::{Bodies, Ensemble, Failure};
pub use integrator::Integrator;
pub use sites::{NoJoints, SiteError, SiteStorage, Sites};

/// A stepper with a state that it steps in place: the words that [`Integrator`], [`Sites`] and `Ensemble` share.
///
/// Each is made by a [`Stepper`](crate::Stepper): [`integrator`](crate::Stepper::integrator), [`sites`](crate::Stepper::sites) and `ensemble`.
///
/// ```
/// use clebsch::{Clebsch, Drive};
/// use nalgebra::Vector3;
///
/// /// A body on a spring.
/// #[derive(Clebsch, Clone, Debug)]
/// #[clebsch(
///     action    = |a: Translation<3>, x: Vector3| x + a,
///     cost      = |h, a| a.norm_squared() / (2 * h),
///     potential = |x| x.norm_squared() / 2,
/// )]
/// struct Spring;
///
/// /// Works for whatever is stepped in place.
/// fn hundred_steps<D: Drive>(drive: &mut D) -> Result<u64, D::Error> {
///     drive.advance(100)?;
///     Ok(drive.steps())
/// }
///
/// let stepper = Spring.into_stepper(0.1)?;
/// let start = stepper.state(Vector3::x(), Vector3::y())?;
/// assert_eq!(hundred_steps(&mut stepper.integrator(start))?, 100);
/// # Ok::<(), clebsch::Error>(())
/// ```
pub trait Drive {
    /// The view of it that [`state`](Self::state) returns.
    type State<'a>
    where
        Self: 'a;
    /// Why a step fails.
    type Error;

    /// One step.
    ///
    /// # Errors
    /// Those of a step. After an error the state is unchanged.
    fn step(&mut self) -> Result<(), Self::Error>;

    /// So many steps.
    ///
    /// # Errors
    /// Those of a step. The state is then the one before the step that failed.
    fn advance(&mut self, steps: u64) -> Result<(), Self::Error>;

    /// So many steps, with a look at the driver after every `each` of them and after the last one.
    ///
    /// `progress` sees the driver, and so its [`state`](Self::state) and its [`steps`](Self::steps). It ends the run by
    /// `ControlFlow::Break`, with a value of yours. The run is then where it was ended, and can go on. Steps are those of
    /// [`advance`](Self::advance) but for rounding, with the same cost. An `each` of 0 counts as 1.
    ///
    /// ```
    /// # use clebsch::{Clebsch, Drive};
    /// # use nalgebra::Vector1;
    /// # #[derive(Clebsch, Clone, Debug)]
    /// # #[clebsch(action = |a: Translation<1>, x: Vector1| x + a, cost = |h, a| self.mass * a.norm_squared() / (2 * h))]
    /// # struct Particle { mass: f64 }
    /// use core::ops::ControlFlow;
    ///
    /// let stepper = Particle { mass: 2.0 }.into_stepper(0.5)?;
    /// let start = stepper.state(Vector1::zeros(), Vector1::new(6.0))?;
    /// let mut particle = stepper.integrator(start);
    /// let ended = particle.advance_watched(1_000_000, 1000, |particle| {
    ///     // a bar, a button, or a limit
    ///     let x = particle.state().configuration().x;
    ///     if x > 10_000.0 { ControlFlow::Break("too far") } else { ControlFlow::Continue(()) }
    /// })?;
    /// assert_eq!((ended, particle.steps()), (ControlFlow::Break("too far"), 7000));
    /// # Ok::<(), clebsch::Error>(())
    /// ```
    ///
    /// # Errors
    /// Those of a step. The state is then the one before the step that failed.
    fn advance_watched<B>(
        &mut self,
        steps: u64,
        each: u64,
        mut progress: impl FnMut(&Self) -> ControlFlow<B>,
    ) -> Result<ControlFlow<B>, Self::Error>
    where
        Self: Sized,
    {
        let mut left = steps;
        while left > 0 {
            let part = left.min(each.max(1));
            self.advance(part)?;
            left -= part;
            if let ControlFlow::Break(value) = progress(self) {
                return Ok(ControlFlow::Break(value));
            }
        }
        Ok(ControlFlow::Continue(()))
    }

    /// The state that it has reached.
    fn state(&self) -> Self::State<'_>;

    /// The number of steps that it has made, at most 2⁶⁴ − 1.
    fn steps(&self) -> u64;
}
