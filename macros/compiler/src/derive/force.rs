//! Forces by the discrete Lagrange–d'Alembert principle: half of the impulse h·f at each end of a step.
//!
//! r(F) = N + h/2 f(t, q, ξ) and N⁺ = r⁺(F) + h/2 f(t + h, q⁺, ξ), with the velocity ξ = ξ(F)/h of the step at both
//! ends. The part of f at ξ = 0 is a kick. The other part joins the momentum equation as the coupling of a cost does.

use clebsch_symbolic::{Elements, Expr, IntoList, identity, indexed};

use super::symbols::at_zero;
use super::{SystemFormulas, velocity};
use crate::model::{Discretization, Mechanics, Order};

/// The forces on an edge, in the components of each factor.
#[derive(Clone)]
pub struct EdgeForce<'g> {
    /// The impulse at the start that does not depend on the velocity, a function of t, q and u; `None` if there is none.
    pub start: Option<Vec<Expr<'g>>>,
    /// The part of the impulse at the start that vanishes at F = I; `None` if there is none. It is a function of t, q, F
    /// and u.
    pub start_moving: Option<Vec<Expr<'g>>>,
    /// The impulse at the end, a function of F and u and of t and q there.
    pub end: Vec<Expr<'g>>,
}

/// f in 𝔤*, that on configurations by J(q, f); `None` if nothing acts.
pub(super) fn covector<'g>(model: &Mechanics<'g>, system: &SystemFormulas<'g>) -> Option<Vec<Expr<'g>>> {
    let force = model.force.as_ref()?;
    let on_leaves = force.on_configuration.as_ref().map(|leaves| system.momenta_of(leaves.iter().copied()));
    total(force.of_group.clone(), on_leaves)
}

/// The sum of two impulses.
pub(super) fn total<'g>(one: Option<Vec<Expr<'g>>>, other: Option<Vec<Expr<'g>>>) -> Option<Vec<Expr<'g>>> {
    match (one, other) {
        (Some(one), Some(other)) => Some(one.into_iter().zip(other).map(|(a, b)| a + b).into_list()),
        (one, other) => one.or(other),
    }
}

/// The impulses of a force f on an edge that is one of `parts` in a step.
pub(super) fn on_edge<'g>(model: &Mechanics<'g>, covector: &[Expr<'g>], divisor: i64) -> EdgeForce<'g> {
    let part = model.step_size / divisor;
    let (first, last) = match model.order {
        Order::First => (model.graph.integer(0), part),
        _ => (part / 2, part / 2),
    };
    let velocities = velocities(model);
    let rest = at_zero(velocities.iter().copied());
    let at_rest = |f: &Expr<'g>| f.substitute(&rest);
    let moving = moving(model, part);
    let moved = |f: &Expr<'g>| f.substitute(&moving);
    let acts = |impulse: Vec<Expr<'g>>| impulse.iter().any(|part| !identity::vanishes(*part)).then_some(impulse);
    let depends = velocities.iter().any(|xi| covector.iter().any(|component| component.depends_on(*xi)));
    let beyond_rest = |f: &Expr<'g>| first * (moved(f) - moved(&at_rest(f))).expand();
    let start_moving: Vec<_> = covector.each(beyond_rest);
    EdgeForce {
        start: acts(covector.each(|f| first * at_rest(f))),
        start_moving: if depends { acts(start_moving) } else { None },
        end: covector.each(|f| last * moved(f)),
    }
}

fn velocities<'a, 'g>(model: &'a Mechanics<'g>) -> &'a [Expr<'g>] {
    model.force.as_ref().map_or(&[], |force| &force.velocities)
}

/// The replacement of ξ by ξ(F)/h. It is the logarithm if the Lagrangian is discretised so or if Cayley's map leaves a
/// factor. It is the projection if the declaration asks for it, and else Cayley's map. Both ends see the same velocity,
/// so it has to be odd: ξ(F⁻¹) = −ξ(F).
fn moving<'g>(model: &Mechanics<'g>, part: Expr<'g>) -> Vec<(Expr<'g>, Expr<'g>)> {
    let velocities = velocities(model).iter().copied();
    velocities.zip(velocities_of_step(model, part)).into_list()
}

/// ξ(F)/h of a step or of a part of it, for each factor.
pub(super) fn velocities_of_step<'g>(model: &Mechanics<'g>, part: Expr<'g>) -> Vec<Expr<'g>> {
    let discretization = discretization_of_velocity(model);
    indexed(model.factors.len(), |k| velocity::of_element(model, k, part, discretization))
}

/// The map F ↦ ξ(F) of the velocity of a step, which forces and constraints take.
pub(super) fn discretization_of_velocity(model: &Mechanics<'_>) -> Discretization {
    let of_constraint = || model.constraint.as_ref()?.discretization;
    let chosen = model.kinetic.discretization().or_else(of_constraint).unwrap_or(Discretization::Cayley);
    let has_cayley =
        model.factors.iter().all(|factor| factor.group.is_translation() || factor.group.has_cayley_chart(model.graph));
    match chosen {
        Discretization::Exponential | Discretization::Projection => chosen,
        _ if has_cayley => Discretization::Cayley,
        _ => Discretization::Exponential,
    }
}
