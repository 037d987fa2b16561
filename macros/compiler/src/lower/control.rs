//! The kernels of a choice of inputs: the step that inputs make, price, bounds and the price of the end, each with its derivatives.

use super::Hoisting;
use super::made::{Maker, stack};
use crate::derive::{Choice, Id, StepOfChoice};

impl<'g> Maker<'_, 'g> {
    /// The kernels of a choice: with the step that inputs make by themselves, or what they do to an edge as those of forces.
    pub(super) fn choice(&mut self, choice: &Choice<'_, 'g>) {
        let is_steered = matches!(choice.step, StepOfChoice::Steered(_));
        let made = |maker: &mut Self, id: Id| maker.matrices(id, &choice.matrices(id));
        if is_steered {
            made(self, Id::StepExpanded);
            self.rows([Id::Increment, Id::Advance]);
            self.orbit_metric();
        } else {
            [Id::ByInput, Id::Bend, Id::Bracket].into_iter().for_each(|id| made(self, id));
        }
        let approach = stack(&mut self.scalars, &choice.steering.approach, Hoisting::Nothing);
        self.add(Id::Approach, approach);
        self.rows([Id::Price]);
        if !is_steered {
            made(self, Id::PriceExpanded);
        }
        made(self, Id::PriceOfTime);
        self.rows([Id::Bounds]);
        made(self, Id::BoundsExpanded);
    }

    /// The kernels of the price of the end, where there is one.
    pub(super) fn price_of_end(&mut self) {
        if let Some(endpoint) = &self.system.endpoint {
            self.matrices(Id::PriceOfEndExpanded, &self.system.endpoint_expanded(endpoint));
            self.rows([Id::PriceOfEnd]);
        }
    }
}
