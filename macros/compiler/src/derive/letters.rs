//! The letters of a residual: F − I, ∂K/∂z and q⁺ stand for themselves until all terms that cancel at F = I have done so.

use clebsch_symbolic::{Chart, Expr, IntoList, Property, Role, WordTerm, identity, indexed};

use super::equation::{Momentum, Sources};
use super::moves::from_increment;
use super::symbols::at_zero;

/// The letters of the residuals of a substep, with the formulas in x that replace them.
pub(super) struct Letters<'a, 'g> {
    sources: &'a Sources<'a, 'g>,
    /// The replacement of group elements and of their coordinates.
    pub elements: Vec<(Expr<'g>, Expr<'g>)>,
    /// The increments D(x) that are substituted last, with their symbols. Terms that cancel in F − I do so before.
    pub increments: Vec<(Expr<'g>, Expr<'g>)>,
    /// The letters for ∂K/∂z, which depends on q⁺ and x.
    gradients: Vec<(Expr<'g>, Expr<'g>)>,
    /// q⁺ = q + Δ, with letters for Δ.
    images: Vec<(Expr<'g>, Expr<'g>)>,
    /// Δ = Φ_F(q) − q, without cancellation.
    pub displacements: Vec<(Expr<'g>, Expr<'g>)>,
}

impl<'a, 'g> Letters<'a, 'g> {
    pub(super) fn new(sources: &'a Sources<'a, 'g>, momentum: &Momentum<'_, 'g>) -> Letters<'a, 'g> {
        let (model, symbols) = (sources.model, &sources.symbols);
        let increments = late(sources, momentum);
        let is_late = |j: &usize| increments.iter().any(|(d, _)| *d == symbols.increments[*j]);
        let by_increment = |j: usize| model.factors[j].group.identity(model.graph) + symbols.increments[j];
        let element = |j: usize| if is_late(&j) { by_increment(j) } else { sources.chart_element(j) };
        let mut elements: Vec<_> = indexed(model.factors.len(), |j| (model.factors[j].symbol, element(j)));
        elements.extend((0..model.factors.len()).map(|j| (symbols.logarithms[j], symbols.stacked_coordinates(j))));
        elements.extend((0..model.factors.len()).filter_map(|j| sources.cayley_coordinates(j, is_late(&j))));
        let rational = momentum.before.iter().filter_map(|before| before.rational);
        let gradients =
            rational.map(|rational| (rational.letter, rational.gradient.expand().substitute(&elements))).into_list();
        let (mut images, mut displacements) = (Vec::new(), Vec::new());
        if momentum.couples {
            let near: Vec<_> = indexed(model.factors.len(), |j| {
                let is_long = sources.keeps(symbols.charts[j], true);
                let increment = if is_long { symbols.increments[j] } else { sources.chart_increment(j) };
                (symbols.increments[j], increment)
            });
            let moved: Vec<_> = indexed(model.factors.len(), |j| {
                (model.factors[j].symbol, from_increment(model.factors[j].group, symbols.increments[j]))
            });
            for (i, leaf) in model.configurations.iter().enumerate() {
                let letter = model.graph.symbol("Δ", leaf.shape, Role::Image(i), Property::General);
                let displacement = (model.action[i].substitute(&moved).expand() - leaf.symbol).expand();
                images.push((symbols.images[i], leaf.symbol + letter));
                displacements.push((letter, displacement.substitute(&near).expand()));
            }
        }
        Letters { sources, elements, increments, gradients, images, displacements }
    }

    /// Whether an expression has letters in it.
    pub(super) fn occur_in(&self, expression: Expr<'g>) -> bool {
        let mut letters = self.increments.iter().chain(&self.gradients).chain(&self.images).chain(&self.displacements);
        letters.any(|(letter, _)| expression.depends_on(*letter))
    }

    /// The expression in x, without letters.
    pub(super) fn replaced(&self, expression: Expr<'g>) -> Expr<'g> {
        let stages = [&self.gradients, &self.images, &self.displacements, &self.increments];
        stages.into_iter().fold(expression, |expression, letters| expression.substitute(letters))
    }

    /// The expression with the letters Δ and D alone. `None` if none of them is left.
    pub(super) fn by_increments(&self, expression: Expr<'g>) -> Option<Expr<'g>> {
        let expression =
            [&self.gradients, &self.images].into_iter().fold(expression, |sum, letters| sum.substitute(letters));
        let mut letters = self.increments.iter().chain(&self.displacements);
        letters.any(|(letter, _)| expression.depends_on(*letter)).then_some(expression)
    }

    /// A sum in which terms that do not vanish at F = I are written with Δ, until they cancel. The others keep their letters.
    pub(super) fn near(&self, sum: Expr<'g>) -> Expr<'g> {
        let blocks = self.sources.symbols.blocks.iter().map(|block| block.coordinates);
        let increments = self.sources.symbols.increments.iter().copied();
        let at_identity = at_zero(blocks.chain(increments).chain(self.displacements.iter().map(|(letter, _)| *letter)));
        let (graph, shape) = (sum.graph(), sum.shape());
        [&self.gradients, &self.images].into_iter().fold(sum, |sum, letters| {
            if !letters.iter().any(|(letter, _)| sum.depends_on(*letter)) {
                return sum;
            }
            let terms = sum.word_terms().into_iter().map(|term: WordTerm<'g>| term.product(graph));
            let (small, others): (Vec<_>, Vec<_>) =
                terms.partition(|term| identity::vanishes(term.substitute(&at_identity)));
            graph.total(shape, small) + graph.total(shape, others).substitute(letters).expand()
        })
    }
}

/// The increments D(x) that are substituted last, with their symbols. Terms that cancel in F − I do so before.
///
/// They belong to charts with roots and to exponentials. If the cost couples, they belong to Cayley's chart too, unless a denominator
/// depends on F.
fn late<'g>(sources: &Sources<'_, 'g>, momentum: &Momentum<'_, 'g>) -> Vec<(Expr<'g>, Expr<'g>)> {
    let (model, symbols) = (sources.model, &sources.symbols);
    let parts = || momentum.before.iter().map(|before| before.array).chain(momentum.coupling.iter().flatten().copied());
    let is_polynomial = |k: usize| !parts().any(|part| part.has_poles_in(&[model.factors[k].symbol]));
    let is_late = |k: &usize| match symbols.charts[*k] {
        Chart::Cayley | Chart::Product => momentum.couples && is_polynomial(*k),
        chart => sources.keeps(chart, momentum.coupling.is_some()),
    };
    (0..model.factors.len()).filter(is_late).map(|k| (symbols.increments[k], sources.chart_increment(k))).into_list()
}
