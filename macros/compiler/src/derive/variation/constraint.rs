//! The derivatives of a constraint at both ends of an edge.

use clebsch_symbolic::{Elements, Expr, IntoList, Property, Role, Shape, both};

use super::{Quantity, Source};
use crate::derive::choice::Direction;
use crate::derive::{ConstraintFormulas, cayley, exact};

/// The constraint at both ends of an edge, with its derivatives. κ stands for the multipliers, and μ for the momentum N⁺.
pub struct ConstraintDerivatives<'g> {
    /// A and A Σ⁻¹ at q, and at q⁺.
    pub rows: [[Expr<'g>; 2]; 2],
    /// ∂(Aᵀκ)η and ∂ψ η for the motions η of q that leave F as it is, and ∂ψ/∂η′ η′.
    pub at_start: [Expr<'g>; 3],
    /// ∂(Aᵀκ)/∂η′ η′ and ∂(A Σ⁻¹μ − b)/∂η′ η′ at q⁺.
    pub at_end: [Expr<'g>; 2],
    /// The derivatives with respect to each quantity: those of Aᵀκ and of ψ, and at q⁺ of Aᵀκ and of A Σ⁻¹μ − b.
    pub slopes: [[Vec<Expr<'g>>; 2]; 2],
}

/// The terms of a constraint in the function whose second derivatives a choice of inputs needs.
///
/// A step has the equations F⁻ℓd = N + Aᵀλ and ψ = 0, then N⁺ = F⁺ℓd + Aᵀν and A Σ⁻¹N⁺ = b at q⁺. With the multipliers κ, σ, β and ρ of these
/// the function is β·F⁺ℓd + κ·F⁻ℓd and
///
/// ```text
/// σ·ψ − κ·Aᵀλ + β·A⁺ᵀν + ρ·(A⁺Σ⁻¹N⁺ − b)
/// ```
pub struct ReactionTerms<'g> {
    /// This sum.
    pub terms: Expr<'g>,
    /// Its slopes with respect to λ, ν and N⁺, in which it is linear.
    pub slopes: Expr<'g>,
}

impl<'g> Source<'_, 'g> {
    /// The terms of a constraint on an edge.
    pub(super) fn reactions(&self, constraint: &ConstraintFormulas<'g>, ends: Expr<'g>) -> ReactionTerms<'g> {
        let (system, symbols) = (self.system, &self.system.symbols);
        let ConstraintFormulas { rows, values, velocity, .. } = *constraint;
        let (graph, [count, dimension]) = (rows.graph(), [rows.shape().rows, rows.shape().columns]);
        let reaction = |number, letter: &str, size| {
            graph.symbol(letter, Shape::vector(size), Role::Reaction(number), Property::General)
        };
        let [lambda, nu, landed] = [(0, "λ", count), (1, "ν", count), (2, "N⁺", dimension)]
            .map(|(number, letter, size)| reaction(number, letter, size));
        let [sigma, rho] = [reaction(3, "σ", count), reaction(4, "ρ", count)];
        let images = system.images_of_leaves();
        let between = constraint.between_by(self.model, &images).substitute(&cayley::replacements(self.model));
        let moving: Vec<_> = symbols.momenta.iter().copied().zip(system.parted(landed)).into_list();
        let at_end = |part: Expr<'g>| self.at_image(system.later(part, ends));
        let later_rows = at_end(rows);
        let later_velocity = at_end((rows * velocity - values).substitute(&moving));
        let costate = graph.below(&symbols.momenta);
        let terms = sigma.dot(between) - symbols.multiplier.dot(rows.transpose() * lambda)
            + costate.dot(later_rows.transpose() * nu)
            + rho.dot(later_velocity);
        let slopes = graph.below(&[lambda, nu, landed].map(|letter| terms.gradient(letter)));
        ReactionTerms { terms, slopes }
    }

    /// The derivatives of a constraint on an edge. `together` are the motions of q and q⁺ that leave F as it is.
    pub(super) fn constraint(
        &self,
        constraint: &ConstraintFormulas<'g>,
        together: &Direction<'g>,
        ends: Expr<'g>,
    ) -> ConstraintDerivatives<'g> {
        let (system, symbols) = (self.system, &self.system.symbols);
        let ConstraintFormulas { rows, by_inertia, values, velocity, .. } = *constraint;
        let kappa = symbols.multiplier_of(rows.shape().rows);
        let push = rows.transpose() * kappa;
        let images = system.images_of_leaves();
        let between = constraint.between_by(self.model, &images).substitute(&cayley::replacements(self.model));
        let at_end = |part: Expr<'g>| self.at_image(system.later(part, ends));
        let [later_push, later_velocity] = both([push, rows * velocity - values], at_end);
        let motion = self.at_end();
        ConstraintDerivatives {
            rows: [[rows, by_inertia], both([rows, by_inertia], at_end)],
            at_start: [push.differential(together), between.differential(together), between.differential(&motion)],
            at_end: both([later_push, later_velocity], |part| part.differential(&motion)),
            slopes: [[push, between], [later_push, later_velocity]]
                .map(|parts| both(parts, |part| self.quantities.each(|quantity| along(constraint, quantity, part)))),
        }
    }
}

/// The derivative by a quantity. Σ⁻¹ is a letter in formulas, and changes by −Σ⁻¹ δΣ Σ⁻¹.
fn along<'g>(constraint: &ConstraintFormulas<'g>, quantity: &Quantity<'g>, part: Expr<'g>) -> Expr<'g> {
    let [inertia, inverse] = constraint.inertia;
    let own = (quantity.symbol, quantity.direction);
    let letter = exact::inertia_inverse(inertia.graph(), inertia.shape());
    part.differential(&[own, (letter, -(inverse * inertia.differential(&[own]) * inverse))])
}
