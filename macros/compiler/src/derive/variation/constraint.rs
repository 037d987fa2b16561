//! The derivatives of a constraint at both ends of an edge.

use clebsch_symbolic::{Elements, Expr, both};

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

impl<'g> Source<'_, 'g> {
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
