//! Steps on all cores.

use super::Ensemble;
use super::chunk;
use crate::{Clebsch, Method, State, Stepper};
use rayon::prelude::*;

/// The least number of groups of chunks that a thread takes at a time.
const SHARE: usize = 4;

impl<S: Clebsch, M: Method<S>> Ensemble<S, M>
where
    State<S, M>: Send,
    Stepper<S, M>: Sync,
{
    /// [`advance`](Self::advance) on all threads of the present pool, with the same bits.
    ///
    /// Needs the feature `rayon`.
    pub fn par_advance(&mut self, steps: u64) {
        let (first, steppers) = (self.steps, &self.steppers);
        self.chunks.par_chunks_mut(chunk::TOGETHER).enumerate().with_min_len(SHARE).for_each(|(group, chunks)| {
            chunk::advance(chunks, super::from(steppers, group * chunk::TOGETHER), first, steps);
        });
        self.steps = self.steps.saturating_add(steps);
    }
}
