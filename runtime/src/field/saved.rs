//! States of fields that are written and read back, with the feature `serde`.

#[cfg(feature = "alloc")]
mod allocated;

use super::{FieldSite, FieldState, FieldStepper, Lattice, Population};
use crate::parameters::check_finite;
use crate::parts::{Mu, Q};
use crate::saved::resumed_time;
use crate::{SiteError, Time};
use serde::ser::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// The saved data of a state: its time, its number of steps, q and N of all sites.
#[derive(Serialize, Deserialize)]
#[serde(rename = "FieldState")]
struct Record<Points, Momenta, Time> {
    time: Time,
    steps: u64,
    configuration: Points,
    momentum: Momenta,
}

impl<Points: Serialize, Momenta: Serialize, C: Serialize> Serialize for FieldState<Points, Momenta, C> {
    /// A state whose step failed is not written: it is that of no time.
    fn serialize<W: Serializer>(&self, writer: W) -> Result<W::Ok, W::Error> {
        let Self { configuration, momentum, time, steps, failed } = self;
        if let Some(error) = failed {
            return Err(W::Error::custom(error));
        }
        Record { time, steps: *steps, configuration, momentum }.serialize(writer)
    }
}

/// A state of a field as it was read, which no stepper has seen yet: [`FieldStepper::resume`] makes it a [`FieldState`].
///
/// ```
/// # use clebsch::{Clebsch, Field, SavedField};
/// # use nalgebra::Vector1;
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(
/// #     action = |a: Translation<1>, x: Vector1| x + a,
/// #     cost   = |h, a| a.norm_squared() / (2 * h),
/// #     space  = |dx, x, next| (next - x).norm_squared() / (2 * dx.powi(2)),
/// # )]
/// # struct Strand;
/// let stepper = Strand.grid([3]).stepper(0.1)?;
/// let mut state = stepper.state(vec![Vector1::new(0.3); 3], vec![Vector1::new(1.0); 3])?;
/// stepper.advance(&mut state, 7)?;
/// let text = serde_json::to_string(&state)?;
/// let saved: SavedField<Vec<Vector1<f64>>, Vec<Vector1<f64>>> = serde_json::from_str(&text)?;
/// assert_eq!(stepper.resume(saved)?, state);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SavedField<Points, Momenta, Time = ()>(FieldState<Points, Momenta, Time>);

impl<'de, Points, Momenta, C> Deserialize<'de> for SavedField<Points, Momenta, C>
where
    Points: Deserialize<'de>,
    Momenta: Deserialize<'de>,
    C: Deserialize<'de>,
{
    fn deserialize<R: Deserializer<'de>>(reader: R) -> Result<Self, R::Error> {
        let Record { time, steps, configuration, momentum } = Record::deserialize(reader)?;
        Ok(Self(FieldState { configuration, momentum, time, steps, failed: None }))
    }
}

impl<S: FieldSite + Clone, G: Lattice<S>, P: Population> FieldStepper<S, G, P> {
    /// The state that was written, after the checks of [`state`](Self::state). The next steps have the bits that they would have had.
    ///
    /// Formats have to give back every bit of a number: `serde_json` does with its feature `float_roundtrip`, and binary ones do.
    /// Kicks of one call of [`advance`](Self::advance) are joined. So the bits are the same where the calls are.
    ///
    /// # Errors
    /// As [`state`](Self::state), and [`Error::NotFinite`](crate::Error::NotFinite) for the time.
    pub fn resume<Points, Momenta>(
        &self,
        SavedField(mut state): SavedField<Points, Momenta, S::Time>,
    ) -> Result<FieldState<Points, Momenta, S::Time>, SiteError>
    where
        Points: AsRef<[Q<S>]> + AsMut<[Q<S>]>,
        Momenta: AsRef<[Mu<S>]> + AsMut<[Mu<S>]>,
    {
        check_finite("the time", &state.time.now())?;
        state.time = resumed_time(&state.time);
        self.check_sites(&mut state)?;
        Ok(state)
    }
}
