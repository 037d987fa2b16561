//! A cost from a Lagrangian: h ℓ(ξ) or h/2 (ℓ(q, ξ) + ℓ(Φ_F q, ξ)), with the velocity ξ made from F and h.

use clebsch_symbolic::Expr;

use super::symbols::moved_on;
use super::{exact, velocity};
use crate::diagnostic::Diagnostics;
use crate::model::{Discretization, Kinetic, Mechanics};

/// The cost K(t, h, q, F), as declared or made from the Lagrangian.
pub(super) fn kinetic_cost<'g>(model: &Mechanics<'g>) -> Result<Expr<'g>, Diagnostics> {
    let (energy, velocities, discretization) = match &model.kinetic {
        Kinetic::Cost(cost) => return Ok(*cost),
        Kinetic::Lagrangian { energy, velocities, discretization, .. } => (*energy, velocities, *discretization),
    };
    let h = model.step_size;
    let velocity = |k: usize| velocity::of_element(model, k, h, discretization);
    let discrete: Vec<(Expr<'g>, Expr<'g>)> =
        velocities.iter().enumerate().map(|(k, symbol)| (*symbol, velocity(k))).collect();
    let at = |energy: Expr<'g>| match discretization {
        Discretization::MoserVeselov => velocity::moser_veselov(model, energy, velocities),
        Discretization::Exact => exact::stand_in(model, energy, velocities),
        _ => Ok(h * energy.substitute(&discrete)),
    };
    if !model.reads_configuration(energy) && !energy.depends_on(model.time) {
        return at(energy);
    }
    Ok((at(energy)? + at(energy.substitute(&moved_on(model)))?) / 2)
}
