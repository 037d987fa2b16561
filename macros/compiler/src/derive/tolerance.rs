//! Equations that are solved to a tolerance, or in so many iterations: whether there are any, and what is conserved all the same.

use clebsch_symbolic::{Expr, identity};

use super::{ConservedMomentum, Formulas, Solution, Substep};
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::{Model, Side};

/// A tolerance ends an iteration, or the series of the free rotations between kicks; a number of iterations limits one.
pub(super) fn check(model: &Model<'_>, substeps: &[Substep<'_>], collocates: bool) -> Result<(), Diagnostics> {
    let solutions: Vec<Solution> =
        substeps.iter().flat_map(|s| &s.equations).map(|equation| equation.solution).collect();
    if let Some(iterations) =
        model.iterations.as_ref().filter(|_| !collocates && !solutions.contains(&Solution::Newton))
    {
        let error = Diagnostic::new(iterations.span, "the momentum equation of this step is solved without iteration");
        return Err(error.help("leave out `iterations`: every step takes the same number of operations").into());
    }
    let Some(tolerance) = model.tolerance.as_ref() else { return Ok(()) };
    let turns_freely = solutions.contains(&Solution::FreeRotation);
    // without kicks d is found once, to round-off
    if collocates || solutions.contains(&Solution::Newton) || turns_freely && model.potential.is_some() {
        return Ok(());
    }
    let (text, note) = match turns_freely {
        true => (
            "the free motion is found once for all steps, to round-off",
            "the series of a free rotation are evaluated again after each kick",
        ),
        false => (
            "the momentum equation of this step is solved without iteration",
            "a tolerance says where an iteration ends",
        ),
    };
    Err(Diagnostic::new(tolerance.span, text).help("leave out `tolerance`").note(note).into())
}

impl<'g> Formulas<'g> {
    /// Ad*_{F⁻¹} μ for a left action, Ad*_F μ for a right one: M⁺ of a factor whose momentum the drift carries along, of M = μ.
    pub(super) fn carried(&self, k: usize, mu: Expr<'g>) -> Expr<'g> {
        let factor = &self.model.factors[k];
        match factor.side {
            Side::Left => factor.group.coadjoint(factor.group.inverse(factor.symbol), mu),
            Side::Right => factor.group.coadjoint(factor.symbol, mu),
        }
    }

    /// The conserved momenta that every F conserves, whether or not it solves the momentum equation: those with the same value at
    /// (Φ_F q, M⁺) as at (q, M) where M⁺ is made of M. Kicks leave them as they are.
    pub fn conserved_by_any_element(&self) -> Vec<&ConservedMomentum<'g>> {
        let substeps = || self.substeps.iter().take(self.parts);
        if substeps().any(|substep| substep.other.is_some()) {
            return Vec::new();
        }
        let moves: Vec<Vec<(Expr<'g>, Expr<'g>)>> = substeps()
            .map(|substep| {
                let leaves = self.model.configurations.iter().zip(&self.model.action);
                let momenta = self.symbols.momenta.iter().enumerate();
                let momenta =
                    momenta.filter(|(k, _)| !substep.unchanged[*k]).map(|(k, mu)| (*mu, self.carried(k, *mu)));
                leaves.map(|(leaf, image)| (leaf.symbol, *image)).chain(momenta).collect()
            })
            .collect();
        let stays = |momentum: &&ConservedMomentum<'g>| {
            moves.iter().all(|moved| identity::equal(&[momentum.value.substitute(moved)], &[momentum.value]))
        };
        self.symmetries.conserved.iter().filter(stays).collect()
    }
}
