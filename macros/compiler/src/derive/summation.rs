//! Compensated summation: the increments that a step adds to q and N, so that sums can store their rounding errors.
//!
//! ```text
//! q⁺ = q + (Φ_{I+D}(q) − q),    M⁺ = M + (Ad*_{I+D} M − M)
//! ```
//! The increments are of the size of a step. They are right to rounding of their own only if q and M cancel in them as
//! formulas. If F⁻¹ occurs, I − D F⁻¹ stands for it.
//!
//! Source: Hairer, Lubich and Wanner, *Geometric Numerical Integration*, §VIII.5 (compensated summation, Kahan 1965, Møller 1965).

use clebsch_symbolic::{Expr, IntoElements, IntoList, Property, Role, WordTerm, identity, integer};

use super::moves::inverse_by;
use super::symbols::at_zero;
use super::{MechanicsFormulas, Substep, cayley};
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
        if let Some(change) = self.small_change(substep) {
            return Some(self.at_both_ends(change));
        }
        let inverses = self.inverses();
        let coupling = substep.coupling.as_ref();
        let kick = coupling.map(|coupling| self.at_both_ends(&coupling.kick));
        let arrival = coupling.map(|coupling| self.at_both_ends(&coupling.arrival));
        let added = |(k, m): (usize, &Expr<'g>)| {
            let change = || self.beside(self.carried(k, *m), *m).substitute(&inverses);
            let change = if substep.unchanged[k] { self.model.graph.zero(m.shape()) } else { change() };
            let Some((kick, arrival)) = kick.as_ref().zip(arrival.as_ref()) else { return change };
            change.substitute(&[(*m, *m + kick[k])]) + kick[k] + arrival[k]
        };
        let changes = coupling.is_some() || substep.unchanged.contains(&false);
        changes.then(|| self.symbols.momenta.iter().enumerate().map(added).into_list())
    }

    /// Whether the move leaves the momentum as it is.
    pub(super) fn keeps_momentum(&self, substep: &Substep<'g>) -> bool {
        let adds = substep.coupling.is_some() || (substep.rest.is_some() && !self.is_compensated());
        !adds && !substep.unchanged.contains(&false)
    }

    /// M⁺ = Ad*_{F⁻¹} M for a left action, Ad*_F M for a right one, of the momenta M of ∂_F K; `None` where it is μ.
    pub(super) fn carried_on(&self, substep: &Substep<'g>) -> Option<Vec<Expr<'g>>> {
        if let Some(change) = self.small_change(substep) {
            let momenta = self.symbols.momenta.iter().zip(change).map(|(mu, change)| *mu + *change);
            let momenta = momenta.enumerate().map(|(k, m)| substep.rest.as_ref().map_or(m, |rest| m - rest[k]));
            return Some(momenta.into_list());
        }
        let momenta: Vec<_> = self.symbols.momenta.iter().copied().zip(self.momenta_of_move(substep)?).into_list();
        let carried = self.carried_by_move(substep).into_each(|carried| carried.substitute(&momenta));
        Some(with_arrival(carried, substep.coupling.as_ref().map(|coupling| coupling.arrival.as_slice())))
    }

    /// r⁺(F) − r(F) of a cost that couples, where each of its terms is of second order in D = F − I or has a factor h.
    ///
    /// Then it is added to μ. The tolerance of the solve changes no conserved momentum. Elsewhere terms of first order cancel each other,
    /// but their rounding does not.
    pub(super) fn small_change<'a>(&self, substep: &'a Substep<'g>) -> Option<&'a [Expr<'g>]> {
        let change = substep.coupling.as_ref()?.change.as_slice();
        change.iter().all(|change| self.is_small(*change)).then_some(change)
    }

    /// Whether each term of a function of both ends is of second order in D, or has a factor h.
    fn is_small(&self, change: Expr<'g>) -> bool {
        let (model, symbols) = (&self.model, &self.symbols);
        let along = |(k, factor): (usize, &Factor<'g>)| (symbols.increments[k], factor.group.wedge(symbols.algebra[k]));
        let mut directions: Vec<_> = model.factors.iter().enumerate().map(along).into_list();
        let mut near = at_zero(symbols.increments.iter().copied());
        // z is half of D at first
        for (k, algebra) in symbols.algebra.iter().enumerate() {
            let z = cayley::symbol(model, k);
            directions.push((z, *algebra / 2));
            near.push((z, z.graph().zero(z.shape())));
        }
        for ((leaf, image), motion) in model.configurations.iter().zip(&symbols.images).zip(&self.generator) {
            directions.push((*image, *motion));
            near.push((*image, leaf.symbol));
        }
        let is_small = |term: WordTerm<'g>| {
            let term = term.product(change.graph());
            let vanishes = |part: Expr<'g>| identity::vanishes(part.substitute(&near));
            term.least_exponent(model.step_size).is_some_and(|least| least >= integer(1))
                || vanishes(term) && vanishes(term.differential(&directions))
        };
        self.near_elements(change).word_terms().into_iter().all(is_small)
    }

    /// M⁺ of M = μ, which is μ itself where both trivialisations of ∂_F K agree.
    pub(super) fn carried_by_move(&self, substep: &Substep<'g>) -> Vec<Expr<'g>> {
        let momenta = self.symbols.momenta.iter().enumerate();
        momenta.map(|(k, mu)| if substep.unchanged[k] { *mu } else { self.carried(k, *mu) }).into_list()
    }

    /// M = μ + r(I) + J(q, ∂_q K), the components of ∂_F K where r(F) = μ + r(I); `None` where the move leaves μ as it is.
    pub(super) fn momenta_of_move(&self, substep: &Substep<'g>) -> Option<Vec<Expr<'g>>> {
        let changes = substep.unchanged.contains(&false) || substep.rest.is_some() || substep.coupling.is_some();
        let momentum = |(k, mu): (usize, &Expr<'g>)| {
            let all = substep.rest.as_ref().map_or(*mu, |rest| *mu - rest[k]);
            substep.coupling.as_ref().map_or(all, |coupling| all + coupling.kick[k])
        };
        changes.then(|| self.symbols.momenta.iter().enumerate().map(momentum).into_list())
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

/// Momenta M⁺ with the impulse at q⁺ of a coupled cost.
pub(super) fn with_arrival<'g>(carried: Vec<Expr<'g>>, arrival: Option<&[Expr<'g>]>) -> Vec<Expr<'g>> {
    let Some(arrival) = arrival else { return carried };
    carried.iter().zip(arrival).map(|(carried, arrival)| *carried + *arrival).into_list()
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
    let terms = added.word_terms().into_iter().map(|term| term.product(graph));
    let left = terms.filter(|term| !increments.iter().any(|d| term.depends_on(*d)));
    let left = graph.total(added.shape(), left);
    identity::equal(&[left], &[left.substitute(&[(from, graph.zero(from.shape()))])])
}
