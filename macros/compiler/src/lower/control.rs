//! The kernels of a choice of inputs: the step that inputs make, price, bounds and the price of the end, each with its derivatives.

use super::Hoisting;
use super::made::{Maker, stack};
use crate::derive::{Choice, Id, StepOfChoice};

impl<'g> Maker<'_, 'g> {
    /// The kernels of a choice: with the step that inputs make by themselves, or what they do to an edge as those of forces.
    pub(super) fn choice(&mut self, choice: &Choice<'_, 'g>) {
        match choice.step {
            StepOfChoice::Steered(step) => {
                self.matrices(Id::StepExpanded, &choice.step_expanded(step));
                self.rows([Id::Increment, Id::Advance]);
                self.orbit_metric();
            }
            StepOfChoice::Forced(bend) => {
                self.matrices(Id::ByInput, &choice.by_input(bend));
                self.matrices(Id::Bend, &[choice.bend_curvature(bend)]);
                self.matrices(Id::Bracket, &[choice.bracket(bend)]);
            }
        }
        let approach = stack(&mut self.scalars, &choice.steering.approach, Hoisting::Nothing);
        self.add(Id::Approach, approach);
        self.rows([Id::Price]);
        if let StepOfChoice::Forced(_) = choice.step {
            self.matrices(Id::PriceExpanded, &choice.price_expanded());
        }
        self.matrices(Id::PriceOfTime, &[choice.price_of_time()]);
        self.rows([Id::Bounds]);
        self.matrices(Id::BoundsExpanded, &choice.bounds_expanded());
    }

    /// The kernels of the price of the end, where there is one.
    pub(super) fn price_of_end(&mut self) {
        if let Some(endpoint) = &self.system.endpoint {
            self.matrices(Id::PriceOfEndExpanded, &self.system.endpoint_expanded(endpoint));
            self.rows([Id::PriceOfEnd]);
        }
    }
}
