//! States of implicit steps and of connections, which are written as those of fields.

use super::SavedField;
use crate::field::midpoint::{MidpointState, MidpointStepper};
use crate::field::{CellComplex, ConnectedField, ConnectionState, ConnectionStepper, Field, FieldState};
use crate::field::{MidpointSite, Population};
use crate::parameters::check_finite;
use crate::parts::{Mu, Q, T};
use crate::saved::resumed_time;
use crate::{Clebsch, Real, SiteError, Time};
use alloc::vec::Vec;
use nalgebra::SVector;
use serde::{Serialize, Serializer};

impl<S, Points, Momenta, const M: usize> Serialize for MidpointState<S, Points, Momenta, M>
where
    S: Clebsch<Time: Serialize>,
    Points: Serialize,
    Momenta: Serialize,
{
    /// Its [`FieldState`].
    fn serialize<W: Serializer>(&self, writer: W) -> Result<W::Ok, W::Error> {
        (**self).serialize(writer)
    }
}

impl<S, P: Population, const M: usize> MidpointStepper<S, P>
where
    S: Field<1> + MidpointSite<M> + Clebsch<Momentum = SVector<T<S>, M>> + Clone,
    T<S>: Real,
{
    /// The state that was written, as that of a [`FieldStepper`](crate::FieldStepper). The next steps have the bits that they would have had.
    ///
    /// # Errors
    /// As those of [`FieldStepper::resume`](crate::FieldStepper::resume).
    pub fn resume<Points, Momenta>(
        &self,
        saved: SavedField<Points, Momenta, S::Time>,
    ) -> Result<MidpointState<S, Points, Momenta, M>, SiteError>
    where
        Points: AsRef<[Q<S>]> + AsMut<[Q<S>]>,
        Momenta: AsRef<[Mu<S>]> + AsMut<[Mu<S>]>,
    {
        Ok(self.with_work(self.field.resume(saved)?))
    }
}

impl<S: Clebsch<Configuration: Serialize, Momentum: Serialize, Time: Serialize>> Serialize for ConnectionState<S> {
    /// Elements, momenta and time, as a field has them. A state whose step failed is not written.
    fn serialize<W: Serializer>(&self, writer: W) -> Result<W::Ok, W::Error> {
        let Self { elements, sites: FieldState { momentum, time, steps, failed, .. } } = self;
        let (configuration, momentum) = (elements.as_slice(), momentum.as_slice());
        FieldState { configuration, momentum, time: *time, steps: *steps, failed: *failed }.serialize(writer)
    }
}

impl<S, G, P: Population> ConnectionStepper<S, G, P>
where
    S: ConnectedField + Clone,
    G: CellComplex<S>,
{
    /// The state that was written, after the checks of [`state`](Self::state). The next steps have the bits that they would have had.
    ///
    /// ```
    /// # use clebsch::{Clebsch, Field, SavedField};
    /// # use nalgebra::{Matrix2, Vector1};
    /// # #[derive(Clebsch, Clone, Debug)]
    /// # #[clebsch(
    /// #     action = |F: SO<2>, R: SO<2>| R * F,
    /// #     cost   = |h, F| (F - I).norm_squared() / (4 * h),
    /// #     space  = |dx, W| (W - I).norm_squared() / (4 * dx.powi(2)),
    /// #     emit   = [connection],
    /// # )]
    /// # struct Angles;
    /// let stepper = Angles.grid([4]).periodic().connection(0.1)?;
    /// let mut state = stepper.state(vec![Matrix2::identity(); 4], vec![Vector1::new(0.1); 4])?;
    /// stepper.advance(&mut state, 7)?;
    /// let text = serde_json::to_string(&state)?;
    /// let saved: SavedField<Vec<Matrix2<f64>>, Vec<Vector1<f64>>> = serde_json::from_str(&text)?;
    /// assert_eq!(stepper.resume(saved)?, state);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`state`](Self::state), and [`Error::NotFinite`](crate::Error::NotFinite) for the time.
    pub fn resume(
        &self,
        SavedField(saved): SavedField<Vec<Q<S>>, Vec<Mu<S>>, S::Time>,
    ) -> Result<ConnectionState<S>, SiteError> {
        let FieldState { configuration: elements, momentum, time, steps, .. } = saved;
        check_finite("the time", &time.now())?;
        let mut state = self.state(elements, momentum)?;
        (state.sites.time, state.sites.steps) = (resumed_time(&time), steps);
        Ok(state)
    }
}
