//! What a step maps: (q, N), or (q, p) on the cotangent bundle.

use crate::Clebsch;
use core::fmt::{self, Debug, Formatter};

/// A configuration q with its momentum N, checked by [`Stepper::state`](crate::Stepper::state).
///
/// N is the momentum *before* the kick of the step that follows: with order 2 the physical momentum at q.
/// The impulse at q, which two steps share, travels along unseen.
pub struct State<S: Clebsch> {
    pub(crate) configuration: S::Configuration,
    pub(crate) momentum: S::Momentum,
    pub(crate) impulse: S::Impulse,
}

impl<S: Clebsch> State<S> {
    /// The configuration q.
    #[inline]
    pub fn configuration(&self) -> &S::Configuration {
        &self.configuration
    }

    /// The momentum N in the basis that [`group`](crate::group) documents.
    #[inline]
    pub fn momentum(&self) -> &S::Momentum {
        &self.momentum
    }

    /// (q, N)
    #[inline]
    pub fn into_parts(self) -> (S::Configuration, S::Momentum) {
        (self.configuration, self.momentum)
    }
}

impl<S: Clebsch> Copy for State<S> {}

impl<S: Clebsch> Clone for State<S> {
    #[inline]
    fn clone(&self) -> Self {
        *self
    }
}

impl<S: Clebsch> PartialEq for State<S> {
    fn eq(&self, other: &Self) -> bool {
        self.configuration == other.configuration && self.momentum == other.momentum
    }
}

impl<S: Clebsch> Debug for State<S> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct("State").field("configuration", &self.configuration).field("momentum", &self.momentum).finish()
    }
}

/// A configuration q with a covector p at it, checked by [`Stepper::cotangent_state`](crate::Stepper::cotangent_state).
///
/// p has the shape of q and pairs with velocities of q entry by entry: ⟨p, v⟩ = tr(pᵀv).
pub struct CotangentState<S: Clebsch> {
    pub(crate) configuration: S::Configuration,
    pub(crate) covector: S::Configuration,
}

impl<S: Clebsch> CotangentState<S> {
    /// The configuration q.
    #[inline]
    pub fn configuration(&self) -> &S::Configuration {
        &self.configuration
    }

    /// The covector p.
    #[inline]
    pub fn covector(&self) -> &S::Configuration {
        &self.covector
    }

    /// (q, p)
    #[inline]
    pub fn into_parts(self) -> (S::Configuration, S::Configuration) {
        (self.configuration, self.covector)
    }
}

impl<S: Clebsch> Copy for CotangentState<S> {}

impl<S: Clebsch> Clone for CotangentState<S> {
    #[inline]
    fn clone(&self) -> Self {
        *self
    }
}

impl<S: Clebsch> PartialEq for CotangentState<S> {
    fn eq(&self, other: &Self) -> bool {
        self.configuration == other.configuration && self.covector == other.covector
    }
}

impl<S: Clebsch> Debug for CotangentState<S> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct("CotangentState")
            .field("configuration", &self.configuration)
            .field("covector", &self.covector)
            .finish()
    }
}
