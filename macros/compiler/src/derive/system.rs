//! What follows from the action: the symbols of the derivation, the generator, the momentum map; elements in their charts.

use std::cell::OnceCell;
use std::rc::Rc;

use clebsch_symbolic::Expr;

use super::choice::{Endpoint, Steering};
use super::symbols::identities;
use super::{ChartBlock, FormulaTable, Symbols};
use crate::model::{Discretization, System};

/// What follows from the action, and from the prices of inputs and of the end.
pub struct SystemFormulas<'g> {
    /// What it is derived from.
    pub model: Rc<System<'g>>,
    /// The symbols that the derivation adds to those of the model.
    pub symbols: Symbols<'g>,
    /// The infinitesimal generator ξ_Q(q), for each leaf of the configuration.
    pub generator: Vec<Expr<'g>>,
    /// J(q, p), for each factor.
    pub momentum_map: Vec<Expr<'g>>,
    /// What the choice of inputs needs; `None` where nothing is chosen.
    pub steering: Option<Steering<'g>>,
    /// The price of the end; `None` if there is none.
    pub endpoint: Option<Endpoint<'g>>,
    /// All formulas as a table, made when it is first asked for.
    pub(super) table: OnceCell<FormulaTable<'g>>,
}

impl<'g> SystemFormulas<'g> {
    /// What follows from the action of a model, the prices still to come.
    pub(super) fn new(model: Rc<System<'g>>, discretization: Option<Discretization>) -> SystemFormulas<'g> {
        let symbols = Symbols::new(&model, discretization);
        let generator = generator(&model, &symbols);
        let momentum_map = momentum_map(&symbols, &generator);
        let (steering, endpoint, table) = (None, None, OnceCell::new());
        SystemFormulas { model, symbols, generator, momentum_map, steering, endpoint, table }
    }

    /// The element of a factor in its chart.
    pub(super) fn chart_element(&self, factor: usize) -> Expr<'g> {
        self.symbols.charts[factor].element(self.model.factors[factor].group, &self.symbols.coordinates(factor))
    }

    /// The increment F − I of a factor in its chart, without cancellation.
    pub(super) fn chart_increment(&self, factor: usize) -> Expr<'g> {
        self.symbols.charts[factor].increment(self.model.factors[factor].group, &self.symbols.coordinates(factor))
    }

    /// s·h/c with s = dx/dξ at the identity in a block: x is that times a velocity, to first order in one of c parts of a step.
    pub(super) fn chart_step(&self, block: usize, divisor: i64) -> Expr<'g> {
        let ChartBlock { factor, block, .. } = self.symbols.blocks[block];
        let blocks = self.model.graph.blocks(self.model.factors[factor].group);
        let (numerator, denominator) = self.symbols.charts[factor].slope_at_identity(&blocks[block]);
        numerator * self.model.step_size / (denominator * divisor)
    }

    /// The part of the momentum symbol that belongs to a block.
    pub(super) fn momentum_of_block(&self, i: usize) -> Expr<'g> {
        let block = self.symbols.blocks[i];
        let start = block.offset - self.model.offset(block.factor);
        self.symbols.momenta[block.factor].block(start, 0, block.coordinates.shape())
    }

    /// An expression with the momentum of a block set to zero.
    pub(super) fn without_momentum_of_block(&self, expression: Expr<'g>, i: usize) -> Expr<'g> {
        let block = self.symbols.blocks[i];
        let mu = self.symbols.momenta[block.factor];
        let start = block.offset - self.model.offset(block.factor);
        let is_own = |a: &usize| (start..start + block.dimension()).contains(a);
        let entry = |a: usize| if is_own(&a) { mu.graph().integer(0) } else { mu.entry(a, 0) };
        let others = mu.graph().stack(mu.shape(), (0..mu.shape().rows).map(entry).collect());
        expression.substitute(&[(mu, others)])
    }

    /// Whether an expression depends on the configuration, on the time or on the input.
    pub(super) fn is_moving(&self, expression: Expr<'g>) -> bool {
        expression.depends_on(self.model.time)
            || self.model.inputs.iter().any(|leaf| expression.depends_on(leaf.symbol))
            || self.model.reads_configuration(expression)
    }
}

/// ξ_Q(q) = d/dε Φ_{exp εξ}(q) at ε = 0.
pub(super) fn generator<'g>(model: &System<'g>, symbols: &Symbols<'g>) -> Vec<Expr<'g>> {
    let factors = || model.factors.iter().zip(&symbols.algebra);
    let directions: Vec<_> = factors().map(|(factor, xi)| (factor.symbol, factor.group.wedge(*xi))).collect();
    let at_identity = identities(model);
    model.action.iter().map(|image| image.differential(&directions).substitute(&at_identity).expand()).collect()
}

/// J(q, p): the gradient of ⟨p, ξ_Q(q)⟩ with respect to ξ.
pub(super) fn momentum_map<'g>(symbols: &Symbols<'g>, generator: &[Expr<'g>]) -> Vec<Expr<'g>> {
    let pairing = generator.iter().zip(&symbols.covectors).map(|(velocity, p)| p.dot(*velocity)).reduce(|a, b| a + b);
    let gradient = |xi: &Expr<'g>| match pairing {
        Some(pairing) => pairing.gradient(*xi),
        None => xi.graph().zero(xi.shape()),
    };
    symbols.algebra.iter().map(gradient).collect()
}
