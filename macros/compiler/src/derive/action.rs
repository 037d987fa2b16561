//! What follows from the action alone: generator, momentum map, Ad*, cotangent lift.

use clebsch_symbolic::{Expr, identity};

use super::SystemFormulas;
use super::symbols::of_columns;
use crate::model::Side;

impl<'g> SystemFormulas<'g> {
    /// J(q, p) of these covectors p.
    pub(super) fn momenta_of(&self, covectors: impl IntoIterator<Item = Expr<'g>>) -> Vec<Expr<'g>> {
        let covectors: Vec<_> = self.symbols.covectors.iter().copied().zip(covectors).collect();
        self.momentum_map.iter().map(|momentum| momentum.substitute(&covectors)).collect()
    }

    /// ξ_Q(q) for a velocity of all factors.
    pub(super) fn motion_by(&self, velocity: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let replaced: Vec<_> = self.symbols.algebra.iter().copied().zip(velocity.iter().copied()).collect();
        self.generator.iter().map(|motion| motion.substitute(&replaced)).collect()
    }

    /// A function of the time, of a time that is later.
    pub(super) fn later(&self, part: Expr<'g>, by: Expr<'g>) -> Expr<'g> {
        part.substitute(&[(self.model.time, self.model.time + by)])
    }

    /// How q moves with ξ.
    pub(super) fn leaves_by_generator(&self) -> Vec<(Expr<'g>, Expr<'g>)> {
        self.model.configurations.iter().map(|leaf| leaf.symbol).zip(self.generator.iter().copied()).collect()
    }

    /// The replacement of q by q⁺.
    pub(super) fn images_of_leaves(&self) -> Vec<(Expr<'g>, Expr<'g>)> {
        self.model.configurations.iter().map(|leaf| leaf.symbol).zip(self.symbols.images.iter().copied()).collect()
    }

    /// The gradients with respect to the leaves of the configuration.
    pub(super) fn gradients(&self, part: Expr<'g>) -> Vec<Expr<'g>> {
        self.model.configurations.iter().map(|leaf| part.gradient(leaf.symbol)).collect()
    }

    /// Ad*_F μ.
    pub(super) fn coadjoint(&self) -> Vec<Expr<'g>> {
        let factors = self.model.factors.iter().zip(&self.symbols.momenta);
        factors.map(|(factor, mu)| factor.group.coadjoint(factor.symbol, *mu)).collect()
    }

    /// Ad*_{F⁻¹} μ for a left action, Ad*_F μ for a right one: M⁺ of a factor whose momentum the drift carries along, of M = μ.
    pub(super) fn carried(&self, k: usize, mu: Expr<'g>) -> Expr<'g> {
        let factor = &self.model.factors[k];
        match factor.side {
            Side::Left => factor.group.coadjoint(factor.group.inverse(factor.symbol), mu),
            Side::Right => factor.group.coadjoint(factor.symbol, mu),
        }
    }

    /// The motion of q⁺ = Φ_F(q) that a motion ξ of q carries along: Ad_F ξ for a left action, Ad_{F⁻¹} ξ for a right one.
    pub(super) fn adjoint(&self, k: usize) -> Expr<'g> {
        let factor = &self.model.factors[k];
        let element = match factor.side {
            Side::Left => factor.symbol,
            Side::Right => factor.group.inverse(factor.symbol),
        };
        factor.group.adjoint(element, self.symbols.algebra[k])
    }

    /// (TΦ_F)^{-*} p at q⁺: the gradient of ⟨p, Φ_{F⁻¹}(q⁺)⟩ with respect to q⁺.
    pub(super) fn cotangent_lift(&self) -> Vec<Expr<'g>> {
        let factors = self.model.factors.iter();
        let inverses: Vec<_> = factors.map(|factor| (factor.symbol, factor.group.inverse(factor.symbol))).collect();
        let images = self.model.action.iter().map(|image| image.substitute(&inverses));
        let pairing = images.zip(&self.symbols.covectors).map(|(image, p)| p.dot(image)).reduce(|a, b| a + b);
        let leaves =
            pairing.into_iter().flat_map(|pairing| self.model.configurations.iter().map(move |leaf| (pairing, leaf)));
        leaves.map(|(pairing, leaf)| pairing.gradient(leaf.symbol).expand()).collect()
    }

    /// The components of −J(q, ∂_q K) for each factor.
    pub(super) fn coupling(&self, kinetic: Expr<'g>) -> Vec<Expr<'g>> {
        self.momenta_of(self.gradients(kinetic)).into_iter().map(|momentum| -momentum).collect()
    }

    /// J(q, ∂U(q)), the impulse of a function of q; `None` if it moves nothing.
    pub(super) fn impulse(&self, potential: Expr<'g>) -> Option<Vec<Expr<'g>>> {
        let impulse = self.momenta_of(self.gradients(potential));
        impulse.iter().any(|component| !identity::vanishes(*component)).then_some(impulse)
    }

    /// J(q, μ_Q(q))/c for each factor, where it leaves the momenta J(q, p) of motions as they are: then it is the orthogonal projection to
    /// them, for ξ ↦ ξ_Q(q) and p ↦ J(q, p) are transposes of each other. c is 1 on spheres, and |E_i|² where matrices are multiplied.
    pub(super) fn projection(&self) -> Option<Vec<Expr<'g>>> {
        let (momenta, momentum_map) = (&self.symbols.momenta, &self.momentum_map);
        let projection = self.momenta_of(self.motion_by(momenta));
        let motions: Vec<_> = momenta.iter().zip(momentum_map).map(|(mu, momentum)| (*mu, *momentum)).collect();
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
            |motion: Vec<(Expr<'g>, Expr<'g>)>| motion.into_iter().flat_map(|(_, leaf)| leaf.entries()).collect();
        self.symbols.along_basis(&self.leaves_by_generator()).into_iter().map(column).collect()
    }
}
