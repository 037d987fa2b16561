//! Systems of momenta alone: the action has said from which side the group acts, and nothing is left of what it acts on.

use clebsch_symbolic::Expr;

use super::features::{self, Feature, Found};
use super::{Force, Layout, System, Written};
use crate::diagnostic::Diagnostics;

/// The system without its configuration, where the momentum is stepped alone.
///
/// # Errors
/// A kinetic energy or a force that depends on the configuration.
pub(super) fn alone<'g>(
    system: System<'g>,
    energy: Expr<'g>,
    force: Option<&Force<'g>>,
) -> Result<System<'g>, Diagnostics> {
    let diagnostics = Diagnostics::new();
    check(&system, &[energy], &system.spans.kinetic, &diagnostics);
    if let Some(force) = force {
        let parts = force.of_group.as_deref().unwrap_or_default();
        force.written.iter().for_each(|written| check(&system, parts, written, &diagnostics));
    }
    diagnostics.propagate(System {
        configurations: Vec::new(),
        configuration: Layout::Tuple(Vec::new()),
        action: Vec::new(),
        ..system
    })
}

fn check<'g>(system: &System<'g>, parts: &[Expr<'g>], written: &Written, diagnostics: &Diagnostics) {
    let read = |part: &Expr<'g>| system.configurations.iter().find(|leaf| part.depends_on(leaf.symbol));
    let Some(leaf) = parts.iter().find_map(read) else { return };
    let dependent = Found::at(written.place).named(&leaf.name);
    diagnostics
        .push(features::refusal((Feature::DependsOnConfiguration, dependent), (Feature::Momentum, Found::somewhere())));
}
