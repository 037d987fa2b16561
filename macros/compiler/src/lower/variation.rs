//! The kernels of variations: motions of configurations, and edges with their second derivatives.

use super::made::{Maker, of_matrices};
use super::{Hoisting, matrices};
use crate::derive::{Id, MechanicsFormulas};

impl<'g> Maker<'_, 'g> {
    /// The kernels of variations, where they are asked for.
    pub(super) fn variations(&mut self, formulas: &MechanicsFormulas<'g>) {
        if !formulas.model.has_variations() {
            return;
        }
        self.rows([Id::Retraction, Id::Composition, Id::Generator]);
        self.orbit_metric();
        let edges = formulas.substeps.iter().take(formulas.stepped).filter_map(|substep| substep.variation.as_ref());
        for (index, variation) in edges.enumerate() {
            for (id, matrices) in formulas.edge_kernels(index, variation, self.scalars.keeps_matrices) {
                let kernel = of_matrices(&mut self.scalars, &matrices, Hoisting::Constants(&mut self.hoisted));
                self.add(id, kernel);
            }
        }
    }

    /// J(q, (E_j)_Q(q)), column by column; with whole matrices J(q, ξ_Q(q)).
    pub(super) fn orbit_metric(&mut self) {
        match self.rows.value(Id::OrbitMetric).filter(|_| self.scalars.keeps_matrices) {
            Some(momenta) => self.add(Id::OrbitMetric, matrices::kernel(&matrices::below(momenta))),
            None => self.matrices(Id::OrbitMetric, &[self.system.orbit_metric()]),
        }
    }
}
