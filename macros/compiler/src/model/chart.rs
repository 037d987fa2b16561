//! The dial `chart`.

use clebsch_symbolic::Graph;

use super::features::{self, Feature, Found};
use super::{ChartChoice, Factor};
use crate::diagnostic::Diagnostics;
use crate::parse::Dials;

/// The chart that is chosen has to stay in the group.
pub(super) fn check(graph: &Graph, dials: &Dials, factors: &[Factor], diagnostics: &Diagnostics) {
    let Some(chosen) = dials.chart.as_ref().filter(|chosen| chosen.value == ChartChoice::Cayley) else { return };
    if let Some(factor) = without_cayley_map(graph, factors) {
        let beside = Found::somewhere().named(factor.group.name(graph));
        let chosen = Found::at(chosen.span);
        diagnostics.push(features::refusal((Feature::CayleyChart, chosen), (Feature::NoCayleyMap, beside)));
    }
}

/// The first factor whose group Cayley's map leaves.
pub(super) fn without_cayley_map<'f, 'g>(graph: &Graph, factors: &'f [Factor<'g>]) -> Option<&'f Factor<'g>> {
    factors.iter().find(|factor| !factor.group.is_translation() && !factor.group.has_cayley_chart(graph))
}
