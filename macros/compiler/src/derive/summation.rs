//! Compensated summation: the increments that a step adds to q and N, so that sums can store their rounding errors.
//!
//! ```text
//! q⁺ = q + (Φ_{I+D}(q) − q),    M⁺ = M + (Ad*_{I+D} M − M)
//! ```
//! The increments are of the size of a step. They are right to rounding of their own only if q and M cancel in them as
//! formulas. If F⁻¹ occurs, I − D F⁻¹ stands for it.
//!
//! Source: Hairer, Lubich and Wanner, *Geometric Numerical Integration*, §VIII.5 (compensated summation, Kahan 1965, Møller 1965).

use clebsch_symbolic::{Expr, IntoList, Property, Role, WordTerm, identity};

use super::moves::inverse_by;
use super::{MechanicsFormulas, Substep};
use crate::diagnostic::Diagnostics;
use crate::model::Factor;
use crate::model::features::{self, Feature, Found};

impl<'g> MechanicsFormulas<'g> {
    /// Whether the sums of a step keep the rests of their rounding.
    pub fn is_compensated(&self) -> bool {
        self.model.is_compensated()
    }

    /// The increment of the momentum M by the move, for each factor; `None` if it is zero.
    pub(super) fn momentum_increments(&self, substep: &Substep<'g>) -> Option<Vec<Expr<'g>>> {
        let inverses = self.inverses();
        let added = |(k, m): (usize, &Expr<'g>)| {
            let change = || self.beside(self.carried(k, *m), *m).substitute(&inverses);
            if substep.unchanged[k] { self.model.graph.zero(m.shape()) } else { change() }
        };
        substep.unchanged.contains(&false).then(|| self.symbols.momenta.iter().enumerate().map(added).into_list())
    }

    /// Whether the move leaves the momentum as it is.
    pub(super) fn keeps_momentum(&self, substep: &Substep<'g>) -> bool {
        let carries = substep.unchanged.contains(&false) || (substep.rest.is_some() && !self.is_compensated());
        substep.other.is_none() && !carries
    }

    /// M⁺ = Ad*_{F⁻¹} M for a left action, Ad*_F M for a right one, of M = μ + r(I) for each factor; `None` where it is μ.
    pub(super) fn carried_on(&self, substep: &Substep<'g>) -> Option<Vec<Expr<'g>>> {
        let carried = |(k, mu): (usize, &Expr<'g>)| {
            // the equation is solved for M − r(I)
            let m = substep.rest.as_ref().map_or(*mu, |rest| *mu - rest[k]);
            if substep.unchanged[k] { m } else { self.carried(k, m) }
        };
        let changes = substep.unchanged.contains(&false) || substep.rest.is_some();
        changes.then(|| self.symbols.momenta.iter().enumerate().map(carried).into_list())
    }

    /// Φ_{I+D}(q) − q for each leaf of the configuration, where letters stand for F⁻¹.
    pub(super) fn displacements(&self) -> Vec<Expr<'g>> {
        let leaves = self.model.configurations.iter().zip(&self.model.action);
        leaves.map(|(leaf, image)| self.beside(*image, leaf.symbol)).into_list()
    }

    /// `moved` − `from` with F = I + D and I − D S for F⁻¹.
    fn beside(&self, moved: Expr<'g>, from: Expr<'g>) -> Expr<'g> {
        let mut near = self.increments();
        let has_letter = |factor: &Factor<'_>| !inverse_by(factor.group, factor.symbol, factor.symbol).is_empty();
        for (k, factor) in self.model.factors.iter().enumerate().filter(|(_, factor)| has_letter(factor)) {
            let written = factor.group.identity(self.model.graph) - self.symbols.increments[k] * self.inverse_letter(k);
            let (inverse, transposed) = (factor.symbol.inverse(), factor.symbol.transpose().inverse());
            near.retain(|(letter, _)| *letter != inverse && *letter != transposed);
            near.extend([(inverse, written), (transposed, written.transpose())]);
        }
        (moved.substitute(&near).expand() - from).expand()
    }

    /// A letter for F⁻¹ until all products are distributed: then F⁻¹ itself would take D F⁻¹ to I − F⁻¹ again.
    fn inverse_letter(&self, k: usize) -> Expr<'g> {
        let shape = self.model.factors[k].group.element_shape();
        self.model.graph.symbol("S", shape, Role::Following(k), Property::General)
    }

    /// The replacements of the letters.
    pub(super) fn inverses(&self) -> Vec<(Expr<'g>, Expr<'g>)> {
        let near = self.increments();
        let mut inverses = Vec::new();
        for (k, factor) in self.model.factors.iter().enumerate() {
            let inverse = factor.symbol.inverse();
            let found = near.iter().find(|(letter, _)| *letter == inverse);
            inverses.extend(found.map(|(_, explicit)| (self.inverse_letter(k), *explicit)));
        }
        inverses
    }
}

/// Compensated sums need increments.
///
/// # Errors
/// A step in which q or N is no sum.
pub(super) fn check(formulas: &MechanicsFormulas<'_>) -> Result<(), Diagnostics> {
    // collocation adds changes to q and N whatever they are
    let Some(summation) = formulas.model.compensated().filter(|_| formulas.collocation.is_none()) else {
        return Ok(());
    };
    features::check((Feature::Summation, Found::at(summation.span)), |feature| match feature {
        Feature::FreeMotionOfFourSpace => Found::when(formulas.turns_whole()),
        Feature::CoupledCost => {
            Found::when(formulas.substeps.iter().take(formulas.stepped).any(|substep| substep.other.is_some()))
        }
        Feature::OtherSum => {
            // Ad*_F M = Fᵀ M F⁻ᵀ always does: M cancels with F = I + D and F⁻¹ = I − D S
            let near = formulas.symbols.increments.as_slice();
            let mut leaves = formulas.model.configurations.iter().zip(formulas.displacements());
            let (leaf, _) = leaves.find(|(leaf, added)| !cancels(*added, leaf.symbol, near))?;
            Some(Found::somewhere().named(&leaf.name))
        }
        _ => None,
    })
}

/// Whether `from` is in no term without D, or cancels in their sum.
fn cancels<'g>(added: Expr<'g>, from: Expr<'g>, increments: &[Expr<'g>]) -> bool {
    let graph = added.graph();
    let term = |term: WordTerm<'g>| term.word.iter().fold(term.scale(graph), |product, letter| product * *letter);
    let terms = added.word_terms().into_iter().map(term);
    let left = terms.filter(|term| !increments.iter().any(|d| term.depends_on(*d)));
    let left = graph.total(added.shape(), left);
    identity::equal(&[left], &[left.substitute(&[(from, graph.zero(from.shape()))])])
}
