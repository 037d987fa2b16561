//! Systems of momenta alone: the action has said from which side the group acts, and its configuration is dropped.

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
    let check = |parts: &[Expr<'g>], written: &Written| {
        let read = |part: &Expr<'g>| system.configurations.iter().find(|leaf| part.depends_on(leaf.symbol));
        if let Some(leaf) = parts.iter().find_map(read) {
            let dependent = (Feature::DependsOnConfiguration, Found::at(written.place).named(&leaf.name));
            diagnostics.push(features::refusal(dependent, (Feature::Momentum, Found::somewhere())));
        }
    };
    check(&[energy], &system.spans.kinetic);
    if let Some(force) = force {
        let parts = force.of_group.as_deref().unwrap_or_default();
        force.written.iter().for_each(|written| check(parts, written));
    }
    diagnostics.propagate(())?;
    let (configurations, configuration, action) = (Vec::new(), Layout::Tuple(Vec::new()), Vec::new());
    Ok(System { configurations, configuration, action, ..system })
}
