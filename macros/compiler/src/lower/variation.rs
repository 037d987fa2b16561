//! The kernels of plans: motions of configurations and edges with their second derivatives, and the choice of inputs
//! with price and bounds.

use super::made::{Maker, of_matrices, stack};
use super::{Hoisting, TooLong, matrices};
use crate::derive::{Choice, Id, MechanicsFormulas, StepOfChoice};

impl<'g> Maker<'_, 'g> {
    /// The kernels of motions, and of the derivatives of edges.
    ///
    /// # Errors
    /// Unrolled code that is too long.
    pub(super) fn variations(&mut self, formulas: &MechanicsFormulas<'g>) -> Result<(), TooLong> {
        if !formulas.model.has_variations() {
            return Ok(());
        }
        self.rows([Id::Retraction, Id::Composition, Id::Generator]);
        self.orbit_metric();
        let edges = formulas.substeps.iter().take(formulas.stepped).filter_map(|substep| substep.variation.as_ref());
        for (index, variation) in edges.enumerate() {
            for (id, matrices) in formulas.edge_kernels(index, variation, self.scalars.keeps_matrices) {
                self.add(id, |scalars, hoisted| of_matrices(scalars, &matrices, Hoisting::Constants(hoisted)));
                self.check_length()?;
            }
        }
        Ok(())
    }

    /// J(q, (E_j)_Q(q)), column by column; in matrix code J(q, ξ_Q(q)).
    pub(super) fn orbit_metric(&mut self) {
        match self.rows.value(Id::OrbitMetric).filter(|_| self.scalars.keeps_matrices) {
            Some(momenta) => self.add(Id::OrbitMetric, |_, _| matrices::kernel(&matrices::below(momenta))),
            None => self.matrices(Id::OrbitMetric, &[self.system.orbit_metric()]),
        }
    }

    /// The kernels of a choice. They have the step that inputs make by themselves, or the effect of inputs on an edge
    /// as that of forces.
    pub(super) fn choice(&mut self, choice: &Choice<'_, 'g>) {
        let is_steered = matches!(choice.step, StepOfChoice::Steered(_));
        let made = |maker: &mut Self, id: Id| maker.matrices(id, &choice.matrices(id));
        if is_steered {
            made(self, Id::StepExpanded);
            self.rows([Id::Increment, Id::Advance, Id::Retraction, Id::Generator]);
            self.orbit_metric();
        } else {
            [Id::ByInput, Id::Bend, Id::Bracket].into_iter().for_each(|id| made(self, id));
            if !choice.matrices(Id::Crossed).is_empty() {
                made(self, Id::Crossed);
            }
        }
        self.add(Id::Approach, |scalars, _| stack(scalars, &choice.steering.approach, Hoisting::Nothing));
        self.rows([Id::Price]);
        if !is_steered {
            made(self, Id::PriceExpanded);
        }
        made(self, Id::PriceOfTime);
        self.rows([Id::Bounds]);
        self.known_rows([Id::BoundPrices]);
        made(self, Id::BoundsExpanded);
    }

    /// The kernels of the price and of the conditions of the end.
    pub(super) fn end(&mut self) {
        if let Some(endpoint) = &self.system.endpoint {
            self.matrices(Id::PriceOfEndExpanded, &self.system.endpoint_expanded(endpoint));
            self.rows([Id::PriceOfEnd]);
        }
        if let Some(target) = &self.system.target {
            self.matrices(Id::TargetExpanded, &self.system.target_expanded(target));
        }
    }
}
