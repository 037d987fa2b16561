//! The kernels of a choice of inputs: the step that inputs make, price, bounds and the price of the end, each with its derivatives.

use super::Hoisting;
use super::made::{Maker, stack};
use crate::derive::Id;

impl Maker<'_, '_> {
    /// The kernels of a choice, where there is one: with the step that inputs make by themselves, or what they do to an edge as those of forces.
    pub(super) fn choice(&mut self) {
        let Some(choice) = self.formulas.choice() else { return };
        let steering = choice.steering;
        if let Some(step) = &steering.step {
            self.matrices(Id::StepExpanded, &choice.step_expanded(step));
            self.rows([Id::Increment, Id::Advance]);
        }
        if let Some(bend) = choice.bend {
            self.matrices(Id::ByInput, &choice.by_input(bend));
            self.matrices(Id::Bend, &[choice.bend_curvature(bend)]);
            self.matrices(Id::Bracket, &[choice.bracket(bend)]);
        } else {
            self.orbit_metric();
        }
        let approach = stack(&mut self.scalars, &steering.approach, Hoisting::Nothing);
        self.add(Id::Approach, approach);
        self.rows([Id::Price]);
        if choice.bend.is_some() {
            self.matrices(Id::PriceExpanded, &choice.price_expanded());
        }
        self.matrices(Id::PriceOfTime, &[choice.price_of_time()]);
        self.rows([Id::Bounds]);
        self.matrices(Id::BoundsExpanded, &choice.bounds_expanded());
    }

    /// The kernels of the price of the end, where there is one.
    pub(super) fn price_of_end(&mut self) {
        let formulas = self.formulas;
        if let Some(endpoint) = &formulas.endpoint {
            self.matrices(Id::PriceOfEndExpanded, &formulas.endpoint_expanded(endpoint));
            self.rows([Id::PriceOfEnd]);
        }
    }
}
