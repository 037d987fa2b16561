//! Conserved momenta of groups that are too large for a null space: those of single basis elements.
//!
//! The variation of the discrete Lagrangian along ξ is linear in ξ. Its slope is one vector, and where a component of it vanishes at
//! random points the momentum of that basis element is conserved. Combinations of basis elements are not looked for. Systems with forces
//! or offered symmetries do not come here: `model` and `lower` refuse them.

use clebsch_symbolic::identity::{Point, Residue};
use clebsch_symbolic::{Expr, IntoList, Number, Shape, integer};

use super::{ConservedMomentum, Symmetries};
use crate::derive::{DiscreteLagrangian, SystemFormulas, naming};
use crate::model::Side;

/// The momenta of the basis elements of the group along which the discrete Lagrangian is invariant.
pub(super) fn find<'g>(system: &SystemFormulas<'g>, lagrangian: &DiscreteLagrangian<'g>) -> Symmetries<'g> {
    let mut conserved = Vec::new();
    for (k, factor) in system.model.factors.iter().enumerate() {
        // one point decides whether a component vanishes, but for a chance of about 10⁻¹⁴
        let slopes = slopes(system, lagrangian, k).into_iter();
        let values: Vec<_> = slopes.map(|slope| Point::new(0).evaluate(slope)).into_list();
        let zero = Residue::from_rational(&integer(0));
        let of = if system.model.factors.len() > 1 { format!(" of {}", factor.name) } else { String::new() };
        let holds = |i: &usize| values.iter().all(|value| value.at(*i, 0) == zero);
        conserved.extend((0..factor.group.dimension()).filter(holds).map(|i| {
            let element = naming::basis_element(&system.model, factor.group, i);
            let name = format!("{element}{of}, {}", factor.side.frame());
            ConservedMomentum { name, value: system.symbols.momenta[k].entry(i, 0) }
        }));
    }
    Symmetries { conserved, ..Symmetries::default() }
}

/// The variations of K, U₀ and U₁ along ξ in factor k, as their slopes in ξ. The direction is q ↦ Φ_g q with F ↦ gFg⁻¹
/// (left) or g⁻¹Fg (right).
fn slopes<'g>(system: &SystemFormulas<'g>, lagrangian: &DiscreteLagrangian<'g>, k: usize) -> Vec<Expr<'g>> {
    let (factor, xi) = (&system.model.factors[k], system.symbols.algebra[k]);
    let turned = system.conjugation(k, xi);
    let turned = if factor.side == Side::Left { turned } else { -turned };
    let moved = system.motion_by(&system.in_factor(k, xi));
    let leaves = system.model.configurations.iter().zip(moved).map(|(leaf, motion)| (leaf.symbol, motion));
    let motions: Vec<_> = leaves.chain([(factor.symbol, turned)]).into_list();
    let parts = [lagrangian.kinetic, lagrangian.start, lagrangian.end];
    let pairings = parts.iter().map(|part| {
        let terms = motions.iter().map(|(symbol, motion)| part.gradient(*symbol).pairing(*motion));
        system.model.graph.total(Shape::scalar(), terms)
    });
    pairings.filter(|pairing| !pairing.is_zero()).map(|pairing| pairing.gradient(xi)).into_list()
}
