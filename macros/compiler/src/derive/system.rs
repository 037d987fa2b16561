//! The formulas of the action: the symbols of the derivation, the generator, the momentum map, Ad*, the cotangent lift;
//! elements in their charts.

use std::cell::OnceCell;
use std::rc::Rc;

use clebsch_symbolic::{Chart, Elements, Expr, IntoElements, IntoList, identity, indexed};

use super::choice::{EndTarget, Endpoint, Steering};
use super::symbols::{identities, of_columns};
use super::{ChartBlock, FormulaTable, Symbols, cayley};
use crate::model::{Discretization, Factor, Side, System};

/// The formulas of the action, and of the prices of inputs and of the end.
pub struct SystemFormulas<'g> {
    /// The model from which it is derived.
    pub model: Rc<System<'g>>,
    /// The symbols that the derivation adds to those of the model.
    pub symbols: Symbols<'g>,
    /// The infinitesimal generator ξ_Q(q), for each leaf of the configuration.
    pub generator: Vec<Expr<'g>>,
    /// J(q, p), for each factor.
    pub momentum_map: Vec<Expr<'g>>,
    /// The formulas for the choice of inputs; `None` if there is no choice.
    pub steering: Option<Steering<'g>>,
    /// The price of the end; `None` if there is none.
    pub endpoint: Option<Endpoint<'g>>,
    /// The conditions of the end.
    pub target: Option<EndTarget<'g>>,
    /// All formulas as a table, made when it is first asked for.
    pub(super) table: OnceCell<FormulaTable<'g>>,
}

impl<'g> SystemFormulas<'g> {
    /// The formulas of the action of a model; prices are still to come.
    pub(super) fn new(model: Rc<System<'g>>, discretization: Option<Discretization>) -> SystemFormulas<'g> {
        let symbols = Symbols::new(&model, discretization);
        let generator = generator(&model, &symbols);
        let momentum_map = momentum_map(&symbols, &generator);
        let (steering, endpoint, target, table) = (None, None, None, OnceCell::new());
        SystemFormulas { model, symbols, generator, momentum_map, steering, endpoint, target, table }
    }

    pub(super) fn chart_element(&self, factor: usize) -> Expr<'g> {
        self.symbols.charts[factor].element(self.model.factors[factor].group, &self.symbols.coordinates(factor))
    }

    /// The increment F − I of a factor in its chart, without cancellation.
    pub(super) fn chart_increment(&self, factor: usize) -> Expr<'g> {
        self.symbols.charts[factor].increment(self.model.factors[factor].group, &self.symbols.coordinates(factor))
    }

    /// The value of the letters for Cayley coordinates of a factor: x in Cayley's chart, else a function of D.
    pub(super) fn cayley_coordinates(&self, k: usize, by_increment: bool) -> Option<(Expr<'g>, Expr<'g>)> {
        let increment = if by_increment { self.symbols.increments[k] } else { self.chart_increment(k) };
        let (letter, value) = cayley::of_increment(&self.model, k, increment)?;
        let is_own = self.symbols.charts[k] == Chart::Cayley;
        Some((letter, if is_own { self.symbols.stacked_coordinates(k) } else { value }))
    }

    /// s·h/c with s = dx/dξ at the identity in a block. To first order, x is this factor times a velocity in one of c
    /// parts of a step.
    pub(super) fn chart_step(&self, block: usize, divisor: i64) -> Expr<'g> {
        let (numerator, denominator) = self.chart_slope(block);
        numerator * self.model.step_size / (denominator * divisor)
    }

    /// s = dx/dξ at the identity in a block, a ratio.
    pub fn chart_slope(&self, block: usize) -> (i64, i64) {
        let ChartBlock { factor, block, .. } = self.symbols.blocks[block];
        let blocks = self.model.graph.blocks(self.model.factors[factor].group);
        self.symbols.charts[factor].slope_at_identity(&blocks[block])
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
        let others = mu.graph().stack(mu.shape(), indexed(mu.shape().rows, entry));
        expression.substitute(&[(mu, others)])
    }

    /// Whether an expression depends on the configuration, on the time or on the input.
    pub(super) fn is_moving(&self, expression: Expr<'g>) -> bool {
        expression.depends_on(self.model.time)
            || self.model.inputs.iter().any(|leaf| expression.depends_on(leaf.symbol))
            || self.model.reads_configuration(expression)
    }

    /// A vector of the components of all factors, factor by factor.
    pub(super) fn parted(&self, vector: Expr<'g>) -> Vec<Expr<'g>> {
        let part = |k: usize| vector.block(self.model.offset(k), 0, self.symbols.algebra[k].shape());
        indexed(self.model.factors.len(), part)
    }

    /// J(q, p) of these covectors p.
    pub(super) fn momenta_of(&self, covectors: impl IntoIterator<Item = Expr<'g>>) -> Vec<Expr<'g>> {
        let covectors: Vec<_> = self.symbols.covectors.iter().copied().zip(covectors).into_list();
        self.momentum_map.each(|momentum| momentum.substitute(&covectors))
    }

    /// ξ_Q(q) for a velocity of all factors.
    pub(super) fn motion_by(&self, velocity: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let replaced: Vec<_> = self.symbols.algebra.iter().copied().zip(velocity.iter().copied()).into_list();
        self.generator.each(|motion| motion.substitute(&replaced))
    }

    /// A function of the time, of a time that is later.
    pub(super) fn later(&self, part: Expr<'g>, by: Expr<'g>) -> Expr<'g> {
        part.substitute(&[(self.model.time, self.model.time + by)])
    }

    /// How q moves with ξ.
    pub(super) fn leaves_by_generator(&self) -> Vec<(Expr<'g>, Expr<'g>)> {
        self.model.configurations.iter().map(|leaf| leaf.symbol).zip(self.generator.iter().copied()).into_list()
    }

    /// The replacement of q by q⁺.
    pub(super) fn images_of_leaves(&self) -> Vec<(Expr<'g>, Expr<'g>)> {
        self.model.configurations.iter().map(|leaf| leaf.symbol).zip(self.symbols.images.iter().copied()).into_list()
    }

    /// The gradients with respect to the leaves of the configuration.
    pub(super) fn gradients(&self, part: Expr<'g>) -> Vec<Expr<'g>> {
        self.model.configurations.each(|leaf| part.gradient(leaf.symbol))
    }

    /// Ad*_F μ.
    pub(super) fn coadjoint(&self) -> Vec<Expr<'g>> {
        let factors = self.model.factors.iter().zip(&self.symbols.momenta);
        factors.map(|(factor, mu)| factor.group.coadjoint(factor.symbol, *mu)).into_list()
    }

    /// Ad*_{F⁻¹} μ for a left action, Ad*_F μ for a right one: M⁺ of a factor whose momentum the drift carries along, of M = μ.
    pub(super) fn carried(&self, k: usize, mu: Expr<'g>) -> Expr<'g> {
        let factor = &self.model.factors[k];
        match factor.side {
            Side::Left => factor.group.coadjoint(factor.group.inverse(factor.symbol), mu),
            Side::Right => factor.group.coadjoint(factor.symbol, mu),
        }
    }

    /// The motion of q⁺ = Φ_F(q) that a motion ξ of q carries along.
    pub(super) fn adjoint(&self, k: usize) -> Expr<'g> {
        adjoint(&self.model.factors[k], self.symbols.algebra[k])
    }

    /// (TΦ_F)^{-*} p at q⁺: the gradient of ⟨p, Φ_{F⁻¹}(q⁺)⟩ with respect to q⁺.
    pub(super) fn cotangent_lift(&self) -> Vec<Expr<'g>> {
        let factors = self.model.factors.iter();
        let inverses: Vec<_> = factors.map(|factor| (factor.symbol, factor.group.inverse(factor.symbol))).into_list();
        let images = self.model.action.iter().map(|image| image.substitute(&inverses));
        let pairing = images.zip(&self.symbols.covectors).map(|(image, p)| p.dot(image)).reduce(|a, b| a + b);
        let leaves =
            pairing.into_iter().flat_map(|pairing| self.model.configurations.iter().map(move |leaf| (pairing, leaf)));
        leaves.map(|(pairing, leaf)| pairing.gradient(leaf.symbol).expand()).into_list()
    }

    /// The components of −J(q, ∂_q K) for each factor.
    pub(super) fn coupling(&self, kinetic: Expr<'g>) -> Vec<Expr<'g>> {
        self.momenta_of(self.gradients(kinetic)).into_each(|momentum| -momentum)
    }

    /// J(q⁺, ∂_q⁺ K) for each factor, of a function of both ends.
    pub(super) fn arrival(&self, by_ends: Expr<'g>) -> Vec<Expr<'g>> {
        let gradients = self.symbols.images.each(|image| by_ends.gradient(*image));
        let place: Vec<_> = self
            .images_of_leaves()
            .into_iter()
            .chain(self.symbols.covectors.iter().copied().zip(gradients))
            .into_list();
        self.momentum_map.each(|momentum| momentum.substitute(&place))
    }

    /// J(q, ∂U(q)), the impulse of a function of q; `None` if it moves nothing.
    pub(super) fn impulse(&self, potential: Expr<'g>) -> Option<Vec<Expr<'g>>> {
        let impulse = self.momenta_of(self.gradients(potential));
        if let Some(direction) = self.direction(potential, &impulse) {
            return Some(vec![direction.inserted(direction.impulse(direction.potential))]);
        }
        impulse.iter().any(|component| !identity::vanishes(*component)).then_some(impulse)
    }

    /// J(q, μ_Q(q))/c for each factor, where it leaves the momenta J(q, p) of motions as they are. It is the orthogonal projection to
    /// them then, as ξ ↦ ξ_Q(q) and p ↦ J(q, p) are transposes. c is 1 on spheres, and |E_i|² where matrices are multiplied.
    pub(super) fn projection(&self) -> Option<Vec<Expr<'g>>> {
        let (momenta, momentum_map) = (&self.symbols.momenta, &self.momentum_map);
        let projection = self.momenta_of(self.motion_by(momenta));
        let motions: Vec<_> = momenta.iter().zip(momentum_map).map(|(mu, momentum)| (*mu, *momentum)).into_list();
        let kept = |(k, momentum): (usize, &Expr<'g>)| {
            let twice = projection[k].substitute(&motions);
            let mut others = momenta.iter().enumerate().filter(|(j, _)| *j != k);
            let is_alone = others.all(|(_, mu)| !projection[k].depends_on(*mu));
            let scale = [1, 2].into_iter().find(|&scale| identity::equal(&[twice], &[scale * *momentum]))?;
            is_alone.then(|| projection[k] / scale)
        };
        momentum_map.iter().enumerate().map(kept).collect()
    }

    /// Whether ξ ↦ ξ_Q(q) is injective for a general q, for the factors that move anything.
    pub(super) fn is_free(&self) -> bool {
        let moving = self.model.factors.iter().filter(|factor| factor.moves);
        let moving: usize = moving.map(|factor| factor.group.dimension()).sum();
        let rows: usize = self.generator.iter().map(|velocity| velocity.shape().len()).sum();
        !self.generator.is_empty() && rows >= moving && identity::rank(self.matrix_of_generator()) == moving
    }

    /// The matrix of ξ ↦ ξ_Q(q), a row for each entry of the configuration.
    pub(super) fn matrix_of_generator(&self) -> Expr<'g> {
        of_columns(self.model.graph, &self.generator_columns())
    }

    /// For each basis element of the algebra, the entries of (E_i)_Q(q), leaf after leaf.
    pub(super) fn generator_columns(&self) -> Vec<Vec<Expr<'g>>> {
        let column =
            |motion: Vec<(Expr<'g>, Expr<'g>)>| motion.into_iter().flat_map(|(_, leaf)| leaf.entries()).into_list();
        self.symbols.along_basis(&self.leaves_by_generator()).into_each(column)
    }
}

/// ξ_Q(q) = d/dε Φ_{exp εξ}(q) at ε = 0.
pub(super) fn generator<'g>(model: &System<'g>, symbols: &Symbols<'g>) -> Vec<Expr<'g>> {
    let factors = || model.factors.iter().zip(&symbols.algebra);
    let directions: Vec<_> = factors().map(|(factor, xi)| (factor.symbol, factor.group.wedge(*xi))).into_list();
    let at_identity = identities(model);
    model.action.each(|image| image.differential(&directions).substitute(&at_identity).expand())
}

/// J(q, p): the gradient of ⟨p, ξ_Q(q)⟩ with respect to ξ.
pub(super) fn momentum_map<'g>(symbols: &Symbols<'g>, generator: &[Expr<'g>]) -> Vec<Expr<'g>> {
    let pairing = generator.iter().zip(&symbols.covectors).map(|(velocity, p)| p.dot(*velocity)).reduce(|a, b| a + b);
    let gradient = |xi: &Expr<'g>| match pairing {
        Some(pairing) => pairing.gradient(*xi),
        None => xi.graph().zero(xi.shape()),
    };
    symbols.algebra.each(gradient)
}

/// Ad_F ξ for a left action, Ad_{F⁻¹} ξ for a right one.
pub(super) fn adjoint<'g>(factor: &Factor<'g>, xi: Expr<'g>) -> Expr<'g> {
    let element = match factor.side {
        Side::Left => factor.symbol,
        Side::Right => factor.group.inverse(factor.symbol),
    };
    factor.group.adjoint(element, xi)
}

/// Whether the group leaves a function of q and ξ invariant: f(Φ_F(q), Ad_F ξ) = f(q, ξ).
pub(super) fn is_invariant<'g>(model: &System<'g>, function: Expr<'g>, velocities: &[Expr<'g>]) -> bool {
    let leaves = model.configurations.iter().map(|leaf| leaf.symbol).zip(model.action.iter().copied());
    let carried = model.factors.iter().zip(velocities).map(|(factor, xi)| (*xi, adjoint(factor, *xi)));
    let moved = leaves.chain(carried).into_list();
    identity::equal(&[function.substitute(&moved)], &[function])
}
