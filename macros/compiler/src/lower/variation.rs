//! The kernels of variations: motions of configurations, and edges with their second derivatives.

use super::made::{Maker, of_matrices};
use super::{Hoisting, Kernel, matrices};
use crate::derive::{EdgeDerivatives, EdgeMatrices, Id, MatrixForm, MechanicsFormulas};

impl<'g> Maker<'_, 'g> {
    /// The kernels of variations, where they are asked for.
    pub(super) fn variations(&mut self, formulas: &MechanicsFormulas<'g>) {
        if !formulas.model.has_variations() {
            return;
        }
        self.rows([Id::Retraction, Id::Composition, Id::Generator]);
        self.orbit_metric();
        let edges = formulas.substeps.iter().take(formulas.stepped).filter_map(|substep| substep.variation.as_ref());
        edges.enumerate().for_each(|(index, variation)| self.edge(formulas, index, variation));
    }

    /// J(q, (E_j)_Q(q)), column by column; with whole matrices J(q, ξ_Q(q)).
    pub(super) fn orbit_metric(&mut self) {
        match self.rows.value(Id::OrbitMetric).filter(|_| self.scalars.keeps_matrices) {
            Some(momenta) => self.add(Id::OrbitMetric, matrices::kernel(&matrices::below(momenta))),
            None => self.matrices(Id::OrbitMetric, &[self.system.orbit_metric()]),
        }
    }

    fn edge(&mut self, formulas: &MechanicsFormulas<'g>, index: usize, variation: &EdgeDerivatives<'g>) {
        let EdgeMatrices { momenta, derivatives, carried, slopes } =
            formulas.edge_matrices(variation, self.scalars.keeps_matrices);
        let mut made = |id: Id, matrices: &[MatrixForm<'_>]| -> (Id, Kernel) {
            (id, of_matrices(&mut self.scalars, matrices, Hoisting::Constants(&mut self.hoisted)))
        };
        let mut kernels = vec![
            made(Id::EdgeMomenta(index), &momenta),
            made(Id::Edge(index), &[momenta, derivatives].concat()),
            made(Id::Carried(index), &carried),
        ];
        kernels.extend(slopes.map(|slopes| made(Id::EdgeSlopes(index), &slopes)));
        self.table.extend(kernels);
    }
}
