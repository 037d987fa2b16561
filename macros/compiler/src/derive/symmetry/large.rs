//! Conserved momenta of groups that are too large for a null space: those of single basis elements.
//!
//! The variation of the discrete Lagrangian along ξ is linear in ξ. Its slope is one vector, and where a component of it vanishes at
//! random points the momentum of that basis element is conserved. Combinations of basis elements are not looked for. Systems with forces
//! or offered symmetries do not come here: `model` and `lower` refuse them.

use clebsch_symbolic::identity::{Point, Residue};
use clebsch_symbolic::{Expr, Number, integer};

use super::directions::{generated, in_factor};
use super::{ConservedMomentum, Symmetries};
use crate::derive::{DiscreteLagrangian, Symbols, naming};
use crate::model::{Mechanics, Side};

/// As many points decide whether a component vanishes: one does but for a chance of about 10⁻¹⁴.
const POINTS: u64 = 1;

/// The momenta of the basis elements of the group along which the discrete Lagrangian is invariant.
pub(super) fn find<'g>(
    model: &Mechanics<'g>,
    symbols: &Symbols<'g>,
    generator: &[Expr<'g>],
    lagrangian: &DiscreteLagrangian<'g>,
) -> Symmetries<'g> {
    let mut conserved = Vec::new();
    for (k, factor) in model.factors.iter().enumerate() {
        let slopes = slopes(model, symbols, generator, lagrangian, k);
        let zero = Residue::from_rational(&integer(0));
        let values: Vec<_> = (0..POINTS)
            .flat_map(|seed| slopes.iter().map(move |slope| Point::new(seed).evaluate(*slope)).collect::<Vec<_>>())
            .collect();
        let frame = if factor.side == Side::Left { "spatial" } else { "body" };
        let of = if model.factors.len() > 1 { format!(" of {}", factor.name) } else { String::new() };
        let holds = |i: &usize| values.iter().all(|value| value.at(*i, 0) == zero);
        conserved.extend((0..factor.group.dimension()).filter(holds).map(|i| ConservedMomentum {
            name: format!("{}{of}, {frame}", naming::basis_element(model, factor.group, i)),
            value: symbols.momenta[k].entry(i, 0),
        }));
    }
    Symmetries { conserved, ..Symmetries::default() }
}

/// The variations of K, U₀ and U₁ along ξ in factor k, q ↦ Φ_g q with F ↦ gFg⁻¹ (left) or g⁻¹Fg (right), as their slopes in ξ.
fn slopes<'g>(
    model: &Mechanics<'g>,
    symbols: &Symbols<'g>,
    generator: &[Expr<'g>],
    lagrangian: &DiscreteLagrangian<'g>,
    k: usize,
) -> Vec<Expr<'g>> {
    let (factor, xi) = (&model.factors[k], symbols.algebra[k]);
    let element = factor.group.wedge(xi);
    let turned =
        factor.group.translate_right(factor.symbol, element) - factor.group.translate_left(factor.symbol, element);
    let turned = if factor.side == Side::Left { turned } else { -turned };
    let moved = generated(symbols, generator, &in_factor(symbols, k, xi));
    let leaves = model.configurations.iter().zip(moved).map(|(leaf, motion)| (leaf.symbol, motion));
    let motions: Vec<_> = leaves.chain([(factor.symbol, turned)]).collect();
    let parts = [lagrangian.kinetic, lagrangian.start, lagrangian.end];
    let pairings = parts.iter().map(|part| {
        let terms = motions.iter().map(|(symbol, motion)| part.gradient(*symbol).pairing(*motion));
        terms.fold(model.graph.integer(0), |sum, term| sum + term)
    });
    pairings.filter(|pairing| !pairing.is_zero()).map(|pairing| pairing.gradient(xi)).collect()
}
