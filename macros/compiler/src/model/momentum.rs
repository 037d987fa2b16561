//! Systems of momenta alone: the action has said from which side the group acts, and nothing is left of what it acts on.

use clebsch_symbolic::Expr;

use super::features::{self, Feature, Found};
use super::{Isotropy, Kinetic, Layout, Model, Written};
use crate::diagnostic::Diagnostics;

/// The model without its configuration, where the momentum is stepped alone.
///
/// # Errors
/// A kinetic energy or a force that depends on the configuration.
pub(super) fn alone(model: Model<'_>) -> Result<Model<'_>, Diagnostics> {
    if !model.emit.momentum {
        return Ok(model);
    }
    let mut diagnostics = Diagnostics::new();
    let kinetic = match &model.kinetic {
        Kinetic::Cost(cost) => vec![*cost],
        Kinetic::Lagrangian { energy, .. } => vec![*energy],
        Kinetic::Controls { .. } | Kinetic::Dynamics(_) => Vec::new(),
    };
    check(&model, &kinetic, &model.spans.kinetic, &mut diagnostics);
    if let Some(force) = &model.force {
        let parts = force.of_group.as_deref().unwrap_or_default();
        force.written.iter().for_each(|written| check(&model, parts, written, &mut diagnostics));
    }
    diagnostics.propagate(Model {
        configurations: Vec::new(),
        configuration: Layout::Tuple(Vec::new()),
        action: Vec::new(),
        isotropy: Isotropy::Free,
        ..model
    })
}

fn check<'g>(model: &Model<'g>, parts: &[Expr<'g>], written: &Written, diagnostics: &mut Diagnostics) {
    let read = |part: &Expr<'g>| model.configurations.iter().find(|leaf| part.depends_on(leaf.symbol));
    let Some(leaf) = parts.iter().find_map(read) else { return };
    let dependent = Found::at(written.place).named(&leaf.name);
    diagnostics
        .push(features::refusal((Feature::DependsOnConfiguration, dependent), (Feature::Momentum, Found::somewhere())));
}
