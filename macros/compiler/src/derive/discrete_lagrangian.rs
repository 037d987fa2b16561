//! The discrete Lagrangian ℓd(q, F) = K(F) + U₀(q) + U₁(Φ_F q): made from a Lagrangian where one is declared, separated,
//! tested for time symmetry, and composed with its adjoint where that fails.

use clebsch_symbolic::{Algebra, Expr, Group, identity};

use super::action::identities;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::{Discretization, Kinetic, Model, Order};

/// ℓd(q, F) = K(F) + U₀(q) + U₁(Φ_F q), with U₁ written as a function of q.
#[derive(Copy, Clone, PartialEq, Eq)]
pub struct DiscreteLagrangian<'g> {
    /// K(h, F).
    pub kinetic: Expr<'g>,
    /// U₀(h, q), at the start of the step.
    pub start: Expr<'g>,
    /// U₁(h, q), at its end.
    pub end: Expr<'g>,
}

/// The cost K(h, q, F), as declared or made from the Lagrangian.
pub(super) fn kinetic_cost<'g>(model: &Model<'g>) -> Result<Expr<'g>, Diagnostics> {
    let (energy, velocity, discretization) = match model.kinetic {
        Kinetic::Cost(cost) => return Ok(cost),
        Kinetic::Lagrangian { energy, velocity, discretization, .. } => (energy, velocity, discretization),
    };
    let gradient = energy.gradient(velocity);
    let at_rest = gradient.substitute(&[(velocity, velocity.graph().zero(velocity.shape()))]);
    let inertia = gradient.matrix_of_linear(velocity);
    if inertia.depends_on(velocity) || !identity::vanishes(at_rest) {
        let written = &model.spans.kinetic;
        let error = Diagnostic::new(written.place, "the Lagrangian is not a quadratic form of the velocity")
            .help(format!("write it as a kinetic energy, as in `{name}.dot(&(self.inertia * {name})) / 2`", name = velocity))
            .note("its Hessian depends on the velocity, or its gradient does not vanish at rest; such Lagrangians come with a later version of clebsch");
        return Err(error.into());
    }
    let factor = &model.factors[0];
    let (f, h) = (factor.symbol, model.step_size);
    let identity = factor.group.identity(model.graph);
    Ok(match discretization {
        Discretization::MoserVeselov => {
            let mass = (inertia.trace() / 2 * identity - inertia).expand();
            (mass * (f - identity) * (f - identity).transpose()).trace() / (2 * h)
        }
        Discretization::Cayley => {
            let xi = cayley_velocity(factor.group, f, h);
            h * energy.substitute(&[(velocity, xi)])
        }
    })
}

/// The components of 2(F − I)(F + I)⁻¹/h.
fn cayley_velocity<'g>(group: Group, f: Expr<'g>, h: Expr<'g>) -> Expr<'g> {
    let identity = group.identity(f.graph());
    let algebra = group.algebra();
    let components = ((f - identity) * (f + identity).inverse()).components(algebra);
    match algebra {
        Algebra::Translation(_) => f / h,
        _ => 2 * components / algebra.uniform_gram().unwrap_or(1) / h,
    }
}

/// Separates the cost into a part of F and a part of q, and places the potential.
pub(super) fn separate<'g>(model: &Model<'g>, cost: Expr<'g>) -> Result<DiscreteLagrangian<'g>, Diagnostics> {
    let static_part = cost.substitute(&identities(model));
    let couples = |kinetic: Expr<'g>| model.configurations.iter().any(|leaf| kinetic.depends_on(leaf.symbol));
    let difference = cost - static_part;
    let kinetic = if couples(difference) { difference.expand() } else { difference };
    if let Some(leaf) = model.configurations.iter().find(|leaf| kinetic.depends_on(leaf.symbol)) {
        let written = &model.spans.kinetic;
        let error = Diagnostic::new(
            written.place,
            format!("the cost couples `{}` and `{}`", leaf.name, model.factors[0].name),
        )
        .help("write a cost of the group element alone and put what depends on the configuration into the `potential`")
        .note("costs that depend on configuration and group element together come with a later version of clebsch");
        return Err(error.into());
    }
    let h = model.step_size;
    let zero = model.graph.integer(0);
    let (start, end) = match (model.potential, model.order) {
        (None, _) => (zero, zero),
        (Some(potential), Order::First) => (zero, -(h * potential)),
        (Some(potential), Order::Second) => (-(h * potential / 2), -(h * potential / 2)),
    };
    let constant = !model.configurations.iter().any(|leaf| static_part.depends_on(leaf.symbol));
    Ok(DiscreteLagrangian { kinetic, start: if constant { start } else { start + static_part }, end })
}

impl<'g> DiscreteLagrangian<'g> {
    /// −ℓd(Φ_F q, F⁻¹; −h), whose scheme is the adjoint.
    pub fn adjoint(&self, model: &Model<'g>) -> DiscreteLagrangian<'g> {
        let reversed = (model.step_size, -model.step_size);
        let inverse = |factor: &crate::model::Factor<'g>| (factor.symbol, factor.group.inverse(factor.symbol));
        let mut replacements: Vec<_> = model.factors.iter().map(inverse).collect();
        replacements.push(reversed);
        DiscreteLagrangian {
            kinetic: -self.kinetic.substitute(&replacements),
            start: -self.end.substitute(&[reversed]),
            end: -self.start.substitute(&[reversed]),
        }
    }

    /// Whether ℓd is its own adjoint: K(h, F) = −K(−h, F⁻¹) and likewise for the potentials, up to constants.
    pub fn is_time_symmetric(&self, model: &Model<'g>) -> bool {
        let adjoint = self.adjoint(model);
        let gradients = |lagrangian: &DiscreteLagrangian<'g>| -> Vec<Expr<'g>> {
            let leaves = model.configurations.iter().map(|leaf| leaf.symbol);
            leaves.flat_map(|q| [lagrangian.start.gradient(q), lagrangian.end.gradient(q)]).collect()
        };
        identity::equal(&[self.kinetic], &[adjoint.kinetic]) && identity::equal(&gradients(self), &gradients(&adjoint))
    }

    fn with_step(&self, h: Expr<'g>, step: Expr<'g>) -> DiscreteLagrangian<'g> {
        let scaled = |part: Expr<'g>| part.substitute(&[(h, step)]);
        DiscreteLagrangian { kinetic: scaled(self.kinetic), start: scaled(self.start), end: scaled(self.end) }
    }
}

/// The discrete Lagrangians whose steps make one step: ℓd itself where it has the order asked for, else half a step of ℓd and
/// half a step of its adjoint, and then ℓd itself again, whose Legendre transform is to be inverted.
pub(super) fn substeps<'g>(
    model: &Model<'g>,
    lagrangian: &DiscreteLagrangian<'g>,
) -> Vec<(i64, DiscreteLagrangian<'g>)> {
    if model.order == Order::First || lagrangian.is_time_symmetric(model) {
        return vec![(1, *lagrangian)];
    }
    let half = model.step_size / 2;
    let halves = [*lagrangian, lagrangian.adjoint(model)];
    let composed = halves.iter().map(|part| (2, part.with_step(model.step_size, half)));
    composed.chain([(1, *lagrangian)]).collect()
}
