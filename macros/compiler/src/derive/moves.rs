//! What a move runs: elements as increments D = F − I and in the chart, so that what is near the identity is written without cancellation.

use clebsch_symbolic::{Chart, Expr, Property, Role, Shape, identity};

use super::{MechanicsFormulas, Substep};

impl<'g> MechanicsFormulas<'g> {
    /// Functions of the time at which a step starts, of functions of a time that is `later`.
    pub(super) fn as_of_start(&self, later: Expr<'g>, parts: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let moved = [(self.model.time, self.model.time + later)];
        parts.iter().map(|part| part.substitute(&moved)).collect()
    }

    /// The gradients of a part of the discrete Lagrangian with respect to the configuration; none where they vanish.
    ///
    /// Forces in 𝔤* have no covectors, so that a forced system has no kicks of covectors.
    pub(super) fn covector_kick(&self, part: Expr<'g>, later: Expr<'g>) -> Vec<Expr<'g>> {
        let part = self.as_of_start(later, &[part])[0];
        let gradients = self.gradients(part);
        let acts = self.model.force.is_none() && gradients.iter().any(|gradient| !identity::vanishes(*gradient));
        if acts { gradients } else { Vec::new() }
    }

    /// ∂_q K of a cost that couples, at F = I + D; none of another.
    pub(super) fn coupled_kick(&self, substep: &Substep<'g>) -> Vec<Expr<'g>> {
        let acts = substep.lagrangian.couples && self.model.force.is_none();
        let moved = self.increments();
        let kick = || self.gradients(substep.lagrangian.kinetic).iter().map(|part| part.substitute(&moved)).collect();
        if acts { kick() } else { Vec::new() }
    }

    /// A force that depends on the velocity, in the chart.
    pub(super) fn in_chart(&self, parts: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let elements = self.chart_elements();
        parts.iter().map(|part| part.substitute(&elements).expand()).collect()
    }

    /// The replacement of each group element by that of the chart, and of its logarithm.
    fn chart_elements(&self) -> Vec<(Expr<'g>, Expr<'g>)> {
        let symbols = &self.symbols;
        let mut elements = Vec::new();
        for (k, factor) in self.model.factors.iter().enumerate() {
            let element = self.chart_element(k);
            let logarithm = match symbols.charts[k] {
                Chart::Exponential => symbols.stacked_coordinates(k),
                _ => factor.group.logarithm(element),
            };
            elements.extend([(factor.symbol, element), (symbols.logarithms[k], logarithm)]);
        }
        elements
    }

    /// F − I of each factor, from the chart coordinates.
    pub(super) fn chart_increments(&self) -> Vec<Expr<'g>> {
        let weighted = self.weighted();
        let increment = |k: usize| match weighted.iter().position(|&other| other == k) {
            Some(number) => self.weighted_increment(k, number),
            None => self.chart_increment(k),
        };
        (0..self.model.factors.len()).map(increment).collect()
    }

    /// F − I = 2 (w x^ + (x^)²)/(w² + |x|²) of the rotation whose Gibbs vector is x/w.
    fn weighted_increment(&self, k: usize, number: usize) -> Expr<'g> {
        let x = self.symbols.stacked_coordinates(k);
        let w = self.model.graph.symbol("w", Shape::scalar(), Role::ChartWeight(number), Property::General);
        let hat = self.model.factors[k].group.wedge(x);
        2 * (w * hat + hat * hat) / (w * w + x.dot(x))
    }

    /// q⁺ = Φ_F(q) with F = I + D: for linear actions q + D q, without cancellation. Where sums keep their rests, what is added to q.
    pub(super) fn advance(&self) -> Vec<Expr<'g>> {
        if self.is_compensated() { self.displacements() } else { self.at_increments(&self.model.action) }
    }

    /// M⁺ = Ad*_{F⁻¹} M for a left action, Ad*_F M for a right one, with F = I + D; the other trivialisation of ∂_F K where the cost couples.
    /// Where sums keep their rests, what is added to what was solved for. `None` where M does not change.
    pub(super) fn momentum_after(&self, substep: &Substep<'g>) -> Option<Vec<Expr<'g>>> {
        if let Some(other) = &substep.other {
            return Some(self.at_increments(other));
        }
        if self.is_compensated() {
            return self.momentum_increments(substep);
        }
        self.carried_on(substep).map(|carried| self.at_increments(&carried))
    }
}
