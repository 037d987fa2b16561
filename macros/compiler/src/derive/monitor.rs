//! The monitor of `step`: how long a step takes at a configuration.

use clebsch_symbolic::{Elements, Expr, IntoElements, Shape, identity};

use super::equation::Sources;
use super::exact::{by_inertia, inertia_inverse};
use super::symbols::entries;
use super::{Energy, Substep, splitting};
use crate::diagnostic::{Diagnostics, error};
use crate::model::features::{self, Feature, Found};

/// The formulas of steps of transformed time, dt = g(q) ds.
pub struct MonitorFormulas<'g> {
    /// g(q)
    pub value: Expr<'g>,
    /// −h g J(q, ∂V) for each factor, the kick of a step.
    pub kick: Vec<Expr<'g>>,
    /// h Σ⁻¹J(q, ∂g)/g for each factor: its product with μ is h ġ/g, where q moves by the velocity of μ.
    pub slope: Vec<Expr<'g>>,
    /// Whether a drift is the exact motion without the potential.
    pub drifts_exactly: bool,
    /// Whether drifts are exact and g (V₀ − V) is constant for some V₀: the step is symplectic in s then.
    pub is_logarithmic: bool,
}

impl<'g> MonitorFormulas<'g> {
    /// `None` where steps are of one size.
    ///
    /// # Errors
    /// Features that such a step does not support.
    pub(super) fn of(
        sources: &Sources<'_, 'g>,
        energy: &Energy<'g>,
        substeps: &[Substep<'g>],
        potential: Expr<'g>,
    ) -> Result<Option<Self>, Diagnostics> {
        let (model, graph) = (sources.model, sources.model.graph);
        let Some(monitor) = &model.monitor else { return Ok(None) };
        let drifts_exactly = splitting::drifts_exactly(model, &sources.symbols, substeps);
        let rests = substeps.iter().any(|substep| substep.rest.is_some() || substep.lagrangian.couples);
        // K(τ, F) = h/τ K(h, F): the drift of a part of the time is that of this part of the momentum
        let twice = |kinetic: Expr<'g>| kinetic.substitute(&[(model.step_size, 2 * model.step_size)]);
        let scales = |kinetic: Expr<'g>| identity::equal(&[2 * twice(kinetic)], &[kinetic]);
        let scales = drifts_exactly || substeps.iter().all(|substep| scales(substep.lagrangian.kinetic));
        let varies = !scales || rests || sources.is_moving(sources.inertia) || !identity::vanishes(energy.gyroscopic);
        features::check((Feature::Step, Found::at(monitor.written.place)), |feature| match feature {
            Feature::GeneralLagrangian => Found::when(energy.general.is_some()),
            Feature::VaryingEnergy => Found::when(varies),
            Feature::AdjointPair => Found::when(substeps.len() > 1),
            _ => None,
        })?;
        let (g, h) = (monitor.value, model.step_size);
        let Some(kick) = sources.impulse(potential).filter(|_| model.potential.is_some()) else {
            return Err(error!(monitor.written.place, "`step` shortens steps where the potential changes much, and none acts";
                help "leave out `step`: without a potential, steps of one size are as exact where the system is near as where it is far")
            .into());
        };
        // divided first: of powers of |q| little is left then
        let slopes = sources.momenta_of(sources.gradients(g).each(|slope| *slope / g));
        let inverse = || inertia_inverse(graph, sources.inertia.shape());
        let slopes = by_inertia(sources.inertia, inverse, &entries(&slopes)).into_each(|slope| h * slope);
        let slope = sources.parted(graph.stack(Shape::vector(slopes.len()), slopes));
        let kick = kick.into_each(|impulse| -(h * g * impulse));
        let is_logarithmic = drifts_exactly && is_logarithmic(sources, g, potential);
        Ok(Some(Self { value: g, kick, slope, drifts_exactly, is_logarithmic }))
    }
}

/// Whether g²∂V is a constant multiple of ∂g, and so V one of −1/g but for a constant.
fn is_logarithmic<'g>(sources: &Sources<'_, 'g>, monitor: Expr<'g>, potential: Expr<'g>) -> bool {
    let model = sources.model;
    if model.opaque.is_some() || potential.depends_on(model.time) {
        return false;
    }
    let slopes = |part: Expr<'g>| entries(&sources.momenta_of(sources.gradients(part)));
    let (of_potential, of_monitor) = (slopes(potential), slopes(monitor));
    let Some(first) = of_monitor.iter().position(|slope| !identity::vanishes(*slope)) else { return false };
    let ratio = monitor * monitor * of_potential[first] / of_monitor[first];
    let is_constant = sources.gradients(ratio).iter().all(|slope| identity::vanishes(*slope));
    let pairs = of_potential.iter().zip(&of_monitor);
    is_constant && pairs.into_iter().all(|(v, g)| identity::equal(&[monitor * monitor * *v], &[ratio * *g]))
}
