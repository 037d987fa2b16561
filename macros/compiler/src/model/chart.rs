//! The dial `chart`.

use clebsch_symbolic::Graph;

use super::{ChartChoice, Factor};
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::parse::Dials;

/// The chart that is chosen has to stay in the group.
pub(super) fn check(graph: &Graph, dials: &Dials, factors: &[Factor], diagnostics: &mut Diagnostics) {
    let Some(chosen) = dials.chart.as_ref().filter(|chosen| chosen.value == ChartChoice::Cayley) else { return };
    let leaves = |factor: &&Factor| !factor.group.is_translation() && !factor.group.has_cayley_chart(graph);
    if let Some(factor) = factors.iter().find(leaves) {
        let message = format!("the Cayley map leaves {}", factor.group.name(graph));
        diagnostics.push(
            Diagnostic::new(chosen.span, message)
                .help("write `chart = exponential`, or leave the key out")
                .note("(I - Z)^-1 (I + Z) stays in groups of a quadratic equation, like SO<n>, Sp<2n> and U<n>"),
        );
    }
}
