//! What follows from the action alone: generator, momentum map, Ad*, cotangent lift.

use clebsch_symbolic::{Expr, Shape, identity};

use super::Symbols;
use super::symbols::logarithm;
use crate::model::{Factor, Side, System};

/// ξ_Q(q) = d/dε Φ_{exp εξ}(q) at ε = 0.
pub(super) fn generator<'g>(model: &System<'g>, symbols: &Symbols<'g>) -> Vec<Expr<'g>> {
    let factors = || model.factors.iter().zip(&symbols.algebra);
    let directions: Vec<_> = factors().map(|(factor, xi)| (factor.symbol, factor.group.wedge(*xi))).collect();
    let at_identity = identities(model);
    model.action.iter().map(|image| image.differential(&directions).substitute(&at_identity).expand()).collect()
}

/// The replacement of every group element by the identity, and of its logarithm by zero.
pub(super) fn identities<'g>(model: &System<'g>) -> Vec<(Expr<'g>, Expr<'g>)> {
    let elements = model.factors.iter().map(|factor| (factor.symbol, factor.group.identity(model.graph)));
    let logarithms = (0..model.factors.len()).map(|k| logarithm(model, k));
    elements.chain(logarithms.map(|y| (y, model.graph.zero(y.shape())))).collect()
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

/// Ad*_F μ.
pub(super) fn coadjoint<'g>(model: &System<'g>, symbols: &Symbols<'g>) -> Vec<Expr<'g>> {
    model.factors.iter().zip(&symbols.momenta).map(|(factor, mu)| factor.group.coadjoint(factor.symbol, *mu)).collect()
}

/// (TΦ_F)^{-*} p at q⁺: the gradient of ⟨p, Φ_{F⁻¹}(q⁺)⟩ with respect to q⁺.
pub(super) fn cotangent_lift<'g>(model: &System<'g>, symbols: &Symbols<'g>) -> Vec<Expr<'g>> {
    let inverses: Vec<_> =
        model.factors.iter().map(|factor| (factor.symbol, factor.group.inverse(factor.symbol))).collect();
    let images = model.action.iter().map(|image| image.substitute(&inverses));
    let pairing = images.zip(&symbols.covectors).map(|(image, p)| p.dot(image)).reduce(|a, b| a + b);
    let gradient = |pairing: Expr<'g>| -> Vec<Expr<'g>> {
        model.configurations.iter().map(|leaf| pairing.gradient(leaf.symbol).expand()).collect()
    };
    pairing.map_or(Vec::new(), gradient)
}

/// The motion of q⁺ = Φ_F(q) that a motion ξ of q carries along: Ad_F ξ for a left action, Ad_{F⁻¹} ξ for a right one.
pub(super) fn adjoint_of<'g>(factor: &Factor<'g>, xi: Expr<'g>) -> Expr<'g> {
    let element = match factor.side {
        Side::Left => factor.symbol,
        Side::Right => factor.group.inverse(factor.symbol),
    };
    factor.group.adjoint(element, xi)
}

/// The components of −J(q, ∂_q K) for each factor.
pub(super) fn coupling<'g>(
    model: &System<'g>,
    symbols: &Symbols<'g>,
    momentum_map: &[Expr<'g>],
    kinetic: Expr<'g>,
) -> Vec<Expr<'g>> {
    let leaves = model.configurations.iter().zip(&symbols.covectors);
    let gradients: Vec<_> = leaves.map(|(leaf, p)| (*p, kinetic.gradient(leaf.symbol))).collect();
    momentum_map.iter().map(|momentum| -momentum.substitute(&gradients)).collect()
}

/// J(q, ∂U(q)), the impulse of a function of q; `None` if it moves nothing.
pub(super) fn impulse<'g>(
    model: &System<'g>,
    symbols: &Symbols<'g>,
    momentum_map: &[Expr<'g>],
    potential: Expr<'g>,
) -> Option<Vec<Expr<'g>>> {
    let leaves = model.configurations.iter().zip(&symbols.covectors);
    let gradients: Vec<_> = leaves.map(|(leaf, p)| (*p, potential.gradient(leaf.symbol))).collect();
    let impulse: Vec<_> = momentum_map.iter().map(|momentum| momentum.substitute(&gradients)).collect();
    impulse.iter().any(|component| !identity::vanishes(*component)).then_some(impulse)
}

/// J(q, μ_Q(q))/c for each factor, where it leaves the momenta J(q, p) of motions as they are: then it is the orthogonal projection to them,
/// for ξ ↦ ξ_Q(q) and p ↦ J(q, p) are transposes of each other. c is 1 on spheres, and |E_i|² where matrices are multiplied.
pub(super) fn projection<'g>(
    model: &System<'g>,
    symbols: &Symbols<'g>,
    generator: &[Expr<'g>],
    momentum_map: &[Expr<'g>],
) -> Option<Vec<Expr<'g>>> {
    let alike: Vec<_> = symbols.algebra.iter().zip(&symbols.momenta).map(|(xi, mu)| (*xi, *mu)).collect();
    let velocities = generator.iter().map(|velocity| velocity.substitute(&alike));
    let velocities: Vec<_> = symbols.covectors.iter().copied().zip(velocities).collect();
    let projection: Vec<_> = momentum_map.iter().map(|momentum| momentum.substitute(&velocities)).collect();
    let motions: Vec<_> = symbols.momenta.iter().zip(momentum_map).map(|(mu, momentum)| (*mu, *momentum)).collect();
    let kept = |(k, momentum): (usize, &Expr<'g>)| {
        let twice = projection[k].substitute(&motions);
        let others = symbols.momenta.iter().enumerate().filter(|(j, _)| *j != k);
        let is_alone = others.into_iter().all(|(_, mu)| !projection[k].depends_on(*mu));
        let scale = [1, 2].into_iter().find(|&scale| identity::equal(&[twice], &[scale * *momentum]))?;
        (is_alone || model.factors.len() == 1).then(|| projection[k] / scale)
    };
    momentum_map.iter().enumerate().map(kept).collect()
}

/// Whether ξ ↦ ξ_Q(q) is injective for a general q, for the factors that move anything.
pub(super) fn is_free<'g>(model: &System<'g>, symbols: &Symbols<'g>, generator: &[Expr<'g>]) -> bool {
    if generator.is_empty() {
        return false;
    }
    let moving = model.factors.iter().filter(|factor| factor.moves);
    let moving: usize = moving.map(|factor| factor.group.dimension()).sum();
    let rows: usize = generator.iter().map(|velocity| velocity.shape().len()).sum();
    if rows < moving {
        return false;
    }
    let columns = generator_columns(symbols, generator);
    let dimension = columns.len();
    let entries = (0..rows).flat_map(|i| columns.iter().map(move |column| column[i])).collect();
    identity::rank(model.graph.stack(Shape::new(rows, dimension), entries)) == moving
}

/// For each basis element of the algebra, the entries of (E_i)_Q(q), leaf after leaf.
pub(super) fn generator_columns<'g>(symbols: &Symbols<'g>, generator: &[Expr<'g>]) -> Vec<Vec<Expr<'g>>> {
    let column = |element: Vec<(Expr<'g>, Expr<'g>)>| {
        let images = generator.iter().map(|velocity| velocity.substitute(&element));
        images.flat_map(|image| image.shape().positions().map(move |(i, j)| image.entry(i, j))).collect()
    };
    symbols.basis().into_iter().map(column).collect()
}
