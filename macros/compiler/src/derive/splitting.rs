//! Splittings with force gradients, of steps whose drifts are exact: the free motion of rigid bodies and of translations, and geodesics
//! of bi-invariant metrics.

use clebsch_symbolic::{Chart, Expr, Property, Role, Shape};

use super::equation::{MomentumEquation, Solution, Sources, is_diagonal};
use super::exact::inertia_inverse;
use super::symbols::entries;
use super::{DiscreteLagrangian, Substep, Symbols};
use crate::model::{Mechanics, Order};

/// A step of drifts and kicks, with a force gradient where the potential is a formula.
pub struct Splitting<'g> {
    /// A kick of the weights b and g adds U to the discrete Lagrangian. U = −h b V + h³ g G·Σ⁻¹G with G = J(q, ∂V).
    pub potential: Expr<'g>,
    /// J(q, ∂U) for each factor.
    pub kick: Vec<Expr<'g>>,
    /// Whether there is a force gradient.
    pub has_gradient: bool,
}

/// Whether a step without its kicks is the exact flow of the kinetic energy.
pub(super) fn drifts_exactly(model: &Mechanics<'_>, symbols: &Symbols<'_>, substeps: &[Substep<'_>]) -> bool {
    let [substep] = substeps else { return false };
    let is_known = |equation: &MomentumEquation<'_>| {
        let follows_velocity = matches!(symbols.charts[equation.factors[0]], Chart::Exponential | Chart::Identity);
        equation.solution == Solution::FreeRotation
            || equation.solution == Solution::Explicit && equation.formula.is_none() && follows_velocity
    };
    let rests = substep.rest.is_none() && substep.coupling.is_none() && substep.force.is_none();
    rests && model.force.is_none() && !substep.lagrangian.couples && substep.equations.iter().all(is_known)
}

/// The splitting that makes a step of order 4 or 6, where the drift is exact and there is a potential.
pub(super) fn splitting<'g>(
    sources: &Sources<'_, 'g>,
    lagrangian: &DiscreteLagrangian<'g>,
    substeps: &[Substep<'g>],
) -> Option<Splitting<'g>> {
    let (model, h) = (sources.model, sources.model.step_size);
    let energy = model.potential.filter(|_| matches!(model.order, Order::Fourth | Order::Sixth))?;
    let half = -(h * energy / 2);
    let plain = lagrangian.start == half && lagrangian.end == half && !model.has_variations();
    if !plain || !drifts_exactly(model, &sources.symbols, substeps) {
        return None;
    }
    let force = sources.impulse(energy)?;
    let weight = |name: &str, role: Role| model.graph.symbol(name, Shape::scalar(), role, Property::General);
    let kick = -(h * weight("b", Role::Kick) * energy);
    let has_gradient = model.opaque.is_none();
    let potential = if has_gradient {
        kick + h * h * h * weight("g", Role::KickGradient) * gradient_energy(sources, &force)
    } else {
        kick
    };
    Some(Splitting { potential, kick: sources.impulse(potential)?, has_gradient })
}

/// {V, {V, T}} = G·Σ⁻¹G.
fn gradient_energy<'g>(sources: &Sources<'_, 'g>, force: &[Expr<'g>]) -> Expr<'g> {
    let (graph, inertia) = (sources.model.graph, sources.inertia);
    let entries = entries(force);
    if is_diagonal(inertia) {
        let squares = entries.iter().enumerate();
        return graph.total(Shape::scalar(), squares.map(|(i, entry)| *entry * *entry / inertia.entry(i, i).expand()));
    }
    let force = graph.stack(Shape::vector(entries.len()), entries);
    force.dot(inertia_inverse(graph, inertia.shape()) * force)
}
