//! Equations that are solved to a tolerance, or in so many iterations: whether there are any, and what is conserved all the same.

use clebsch_symbolic::{Expr, identity};

use super::symbols::moved;
use super::{ConservedMomentum, MechanicsFormulas, Solution, Substep};
use crate::diagnostic::Diagnostics;
use crate::model::Mechanics;
use crate::model::features::{self, Feature, Found};

/// A tolerance ends an iteration, or the series of the free rotations between kicks; a number of iterations limits one.
pub(super) fn check(model: &Mechanics<'_>, substeps: &[Substep<'_>], collocates: bool) -> Result<(), Diagnostics> {
    let solutions: Vec<Solution> =
        substeps.iter().flat_map(|s| &s.equations).map(|equation| equation.solution).collect();
    let is_iterated = collocates || solutions.contains(&Solution::Newton);
    if let Some(iterations) = &model.dials.iterations {
        let asked = (Feature::Iterations, Found::at(iterations.span));
        features::check(asked, |feature| Found::when(feature == Feature::ExplicitEquation && !is_iterated))?;
    }
    let Some(tolerance) = &model.dials.tolerance else { return Ok(()) };
    let turns_freely = solutions.contains(&Solution::FreeRotation);
    // without kicks d is found once, to round-off
    let is_series = turns_freely && model.potential.is_some();
    features::check((Feature::Tolerance, Found::at(tolerance.span)), |feature| match feature {
        _ if is_iterated || is_series => None,
        Feature::FreeMotion => Found::when(turns_freely),
        Feature::ExplicitEquation => Found::when(!turns_freely),
        _ => None,
    })
}

impl<'g> MechanicsFormulas<'g> {
    /// The conserved momenta that every F conserves, whether or not it solves the momentum equation: those with the same value at
    /// (Φ_F q, M⁺) as at (q, M) where M⁺ is made of M. Kicks leave them as they are.
    pub fn conserved_by_any_element(&self) -> Vec<&ConservedMomentum<'g>> {
        let substeps = || self.substeps.iter().take(self.stepped);
        if substeps().any(|substep| substep.other.is_some()) {
            return Vec::new();
        }
        let move_of = |substep: &Substep<'g>| -> Vec<(Expr<'g>, Expr<'g>)> {
            let momenta = self.symbols.momenta.iter().enumerate().filter(|(k, _)| !substep.unchanged[*k]);
            moved(&self.model).into_iter().chain(momenta.map(|(k, mu)| (*mu, self.carried(k, *mu)))).collect()
        };
        let moves: Vec<_> = substeps().map(move_of).collect();
        let stays = |momentum: &&ConservedMomentum<'g>| {
            moves.iter().all(|moved| identity::equal(&[momentum.value.substitute(moved)], &[momentum.value]))
        };
        self.symmetries.conserved.iter().filter(stays).collect()
    }
}
