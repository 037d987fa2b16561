//! Drivers step a state of their own in place: a [`Stepper`](crate::Stepper) with its state.

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

    /// The state that it has reached.
    fn state(&self) -> Self::State<'_>;

    /// The number of steps that it has made, at most 2⁶⁴ − 1.
    fn steps(&self) -> u64;
}
