//! Jacobians of bodies on SO(n): Sylvester's linear map of skew matrices.

use clebsch_symbolic::{Expr, Group, Operation, Shape, View};

use crate::derive::equation::MomentumEquation;
use crate::derive::{ChartBlock, Solution, SystemFormulas};

/// The fewest unknowns (21, those of SO(7)) for which Newton's method solves Sylvester's equation. The alternative is a
/// linear system in all unknowns. It takes as long for SO(7), twice as long for SO(10), and more memory in all.
const FEWEST_OF_SYLVESTER: usize = 21;

impl<'g> MomentumEquation<'g> {
    /// The factor of the Jacobian if Newton's method solves Sylvester's equation in matrix code.
    pub(in crate::derive) fn large_jacobian_factor(&self, system: &SystemFormulas<'g>) -> Option<Expr<'g>> {
        let is_large = self.solution == Solution::Newton && self.components.len() >= FEWEST_OF_SYLVESTER;
        if is_large { self.sylvester_factor(system) } else { None }
    }

    /// B with Dρ(x)·δ = ⟨δ^·B, E⟩ for all δ in so(n), which is ΔB + BᵀΔ for Δ = δ^.
    ///
    /// ⟨A, E⟩ is the skew part of A, so that a term uΔ counts as Δuᵀ. `None` where Δ stands between two matrices, and for other groups.
    pub fn sylvester_factor(&self, system: &SystemFormulas<'g>) -> Option<Expr<'g>> {
        let graph = system.model.graph;
        // the unknowns are all those of one SO(n)
        let [block] = system.symbols.blocks_of(&self.components)[..] else { return None };
        let ChartBlock { factor, direction, .. } = system.symbols.blocks[block];
        let Group::SpecialOrthogonal(n) = system.model.factors[factor].group else { return None };
        if !self.components.iter().copied().eq(system.symbols.blocks[block].components()) {
            return None;
        }
        let mut factor = graph.zero(Shape::square(n));
        for outer in self.directional.word_terms() {
            let [components] = outer.word[..] else { return None };
            let View::Of(Operation::Components(_), inner) = components.view() else { return None };
            for term in outer.over(inner) {
                let turns =
                    |letter: &Expr<'g>| matches!(letter.view(), View::Of(Operation::Wedge(_), x) if x == direction);
                let at = term.word.iter().position(turns)?;
                let (before, after) = (&term.word[..at], &term.word[at + 1..]);
                let scale = term.scale(graph);
                if before.iter().chain(after).chain([&scale]).any(|other| other.depends_on(direction)) {
                    return None;
                }
                let product =
                    |letters: &[Expr<'g>]| letters.iter().fold(graph.identity(n), |product, letter| product * *letter);
                factor = factor
                    + match (before.is_empty(), after.is_empty()) {
                        (true, _) => scale * product(after),
                        (_, true) => scale * product(before).transpose(),
                        _ => return None,
                    };
            }
        }
        Some(factor)
    }
}
