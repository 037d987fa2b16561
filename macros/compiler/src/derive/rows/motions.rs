//! The rows of small motions: how they retract, follow each other, and move a configuration.

use clebsch_symbolic::{Chart, Expr, IntoElements, IntoList, indexed};

use super::Names;
use crate::derive::moves::from_increment;
use crate::derive::symbols::of_columns;
use crate::derive::{Formula, Id, MatrixForm, MechanicsFormulas, SystemFormulas};
use crate::model::{Factor, Side};

impl<'g> SystemFormulas<'g> {
    /// J(q, ξ_Q(q)).
    pub(super) fn row_of_orbit_metric(&self, Names { q, xi, .. }: &Names) -> Formula<'g> {
        let metric = self.momenta_of(self.generator.iter().copied());
        Formula::new(Id::OrbitMetric, format!("J({q}, {xi}_Q({q}))"), metric)
    }

    /// GᵀG, column by column: J(q, (E_j)_Q(q)).
    pub fn orbit_metric(&self) -> MatrixForm<'g> {
        let column = |motion: Vec<(Expr<'g>, Expr<'g>)>| {
            let momenta = self.momenta_of(motion.into_iter().map(|(_, velocity)| velocity));
            momenta.into_each(Expr::expand)
        };
        let motions = self.symbols.along_basis(&self.leaves_by_generator());
        MatrixForm::Columns(motions.into_each(column))
    }

    /// The chart of small motions of a factor. It is Cayley's if that stays in the group, for it has no end, else that
    /// of the solve.
    fn retraction(&self, k: usize) -> Chart {
        let has_cayley_chart = self.model.factors[k].group.has_cayley_chart(self.model.graph);
        if has_cayley_chart { Chart::Cayley } else { self.symbols.charts[k] }
    }

    /// τ(±x) − I of each factor.
    fn retractions(&self, sign: i64) -> Vec<Expr<'g>> {
        let increment = |(k, factor): (usize, &Factor<'g>)| {
            let coordinates: Vec<_> = self.symbols.coordinates(k).into_each(|x| sign * x);
            self.retraction(k).increment(factor.group, &coordinates)
        };
        self.model.factors.iter().enumerate().map(increment).into_list()
    }

    /// τ(x) − I, for the choice of inputs that move the configuration by themselves.
    pub(super) fn row_of_retraction(&self, Names { x, .. }: &Names) -> Formula<'g> {
        Formula::new(Id::Retraction, format!("τ({x}) − I"), self.retractions(1))
    }

    /// For each component of ξ, the chart coordinate of exp ξ to first order, as numerator and denominator.
    pub fn slopes_of_retraction(&self) -> Vec<(i64, i64)> {
        let mut slopes = Vec::new();
        for (k, factor) in self.model.factors.iter().enumerate() {
            for block in self.model.graph.blocks(factor.group).iter() {
                let slope = self.retraction(k).slope_at_identity(block);
                slopes.extend(std::iter::repeat_n(slope, block.algebra.dimension));
            }
        }
        slopes
    }
}

impl<'g> MechanicsFormulas<'g> {
    /// The formulas of motions for variations and for the choice of inputs.
    pub(super) fn rows_of_motions(&self, names: &Names) -> Vec<Formula<'g>> {
        if !self.model.has_variations() {
            return Vec::new();
        }
        vec![
            self.row_of_orbit_metric(names),
            Formula::new(Id::Retraction, "(τ(x) − I, τ(−x) − I)", [self.retractions(1), self.retractions(-1)].concat()),
            Formula::new(Id::Composition, format!("{d}, then {d}⁺", d = names.d), self.compositions()),
        ]
    }

    /// F₂ F₁ − I for a left action, F₁ F₂ − I for a right one, with F = I + D.
    fn compositions(&self) -> Vec<Expr<'g>> {
        let product = |k: usize| {
            let factor = &self.model.factors[k];
            let elements = [self.symbols.increments[k], self.symbols.following[k]];
            let [first, second] = elements.map(|d| from_increment(factor.group, d));
            let (left, right) = if factor.side == Side::Left { (second, first) } else { (first, second) };
            let product = factor.group.compose(left, right);
            (product - factor.group.identity(self.model.graph)).expand()
        };
        indexed(self.model.factors.len(), product)
    }

    /// The matrix of ξ ↦ ξ_Q(q), a row for each entry of the configuration. Any momentum of a factor that moves nothing is one of a motion: behind
    /// them stands a row for each component of such a factor.
    pub fn generator_matrix(&self) -> Expr<'g> {
        let (graph, factors) = (self.model.graph, &self.model.factors);
        let mut columns = self.generator_columns();
        for k in (0..factors.len()).filter(|&k| !factors[k].moves) {
            for component in self.model.offset(k)..self.model.offset(k + 1) {
                let extra = columns.iter_mut().enumerate();
                extra.for_each(|(j, column)| column.push(graph.integer((j == component) as i64)));
            }
        }
        of_columns(graph, &columns)
    }
}
