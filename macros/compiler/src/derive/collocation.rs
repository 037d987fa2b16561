//! Steps of order 16: Hamilton's equations on T*Q in the form of the Clebsch problem, to be collocated at the nodes of Gauss and Legendre.

use clebsch_symbolic::{Elements, Expr, IntoElements, IntoList, Property, Role, Shape, identity};

use super::Energy;
use super::equation::Sources;
use super::exact::{by_inertia, inertia_inverse};
use super::symbols::{at_zero, entries};
use crate::diagnostic::Diagnostics;
use crate::model::features::{self, Feature, Found};
use crate::model::{Isotropy, Order, System};

/// Hamilton's equations of H(t, q, p) = ½ (J − A)·Σ⁻¹(J − A) + V with J = J(q, p). H is a function on all of the linear
/// space of q and p.
///
/// With the velocity ξ = Σ⁻¹(J − A) they are q′ = ξ_Q(q) and p′ = −∂_q(⟨p, ξ_Q(q)⟩ − A·ξ + V), ξ fixed: the extremals of the continuous Clebsch
/// problem. Their flow keeps J where nothing acts, and the equations of the orbit of q.
pub struct Collocation<'g> {
    /// q′ for each leaf of the configuration.
    pub velocity: Vec<Expr<'g>>,
    /// p′ for each leaf.
    pub force: Vec<Expr<'g>>,
    /// ξ for each factor, as a function of t, q and μ.
    pub algebra: Vec<Expr<'g>>,
    /// A covector p for each leaf with J(q, p) = μ, as a function of q and μ.
    pub lift: Vec<Expr<'g>>,
    /// Whether J(0, p) is not zero: the action moves the origin.
    pub is_affine: bool,
}

/// The scales of covectors that are tried: λ of p = λ μ_Q(q). A scale is one over the square of the length of a basis
/// element that moves q.
const SCALES: [(i64, i64); 9] = [(1, 1), (1, 2), (1, 4), (2, 1), (4, 1), (1, 3), (1, 6), (1, 8), (8, 1)];

/// The equations that a step of order 16 collocates; `None` for another order.
///
/// # Errors
/// Features that such a step does not support, at the order that asks for it.
pub(super) fn collocation<'g>(
    sources: &Sources<'_, 'g>,
    energy: &Energy<'g>,
    potential: Expr<'g>,
    is_free: bool,
) -> Result<Option<Collocation<'g>>, Diagnostics> {
    let (model, symbols) = (sources.model, &sources.symbols);
    if model.order != Order::Sixteenth {
        return Ok(None);
    }
    check(sources, energy, is_free)?;
    // leaves of the configuration that need not lie on its orbit
    let mut general = Vec::new();
    for (i, leaf) in model.configurations.iter().enumerate() {
        let role = Role::Configuration(i);
        general.push((leaf.symbol, model.graph.symbol(&leaf.name, leaf.shape, role, Property::General)));
    }
    check_linear(sources, &general)?;
    let lift = lift(sources)?;
    // stages lie off the orbit of q, where simplifications on the orbit do not hold
    let everywhere = |expr: &Expr<'g>| expr.substitute(&general);
    let momentum: Vec<_> = sources.momentum_map.each(everywhere);
    let slope = symbols.slope(everywhere(&energy.gyroscopic));
    let velocities = velocities(sources, &momentum, slope);
    let pairing = model
        .graph
        .total(Shape::scalar(), symbols.algebra.iter().zip(&momentum).map(|(xi, momentum)| xi.dot(*momentum)));
    let hamiltonian = pairing - everywhere(&energy.gyroscopic) + everywhere(&potential);
    let moving = |expr: Expr<'g>| expr.substitute(&velocities);
    let at_start = self::velocities(sources, &symbols.momenta, symbols.slope(energy.gyroscopic));
    // J(0, p) is not zero
    let origin = at_zero(model.configurations.iter().map(|leaf| leaf.symbol));
    let is_moved = |momentum: &Expr<'g>| !identity::vanishes(momentum.substitute(&origin));
    Ok(Some(Collocation {
        algebra: at_start.into_each(|(_, velocity)| velocity),
        velocity: sources.generator.each(|velocity| moving(everywhere(velocity))),
        force: general.each(|(_, q)| moving(-hamiltonian.gradient(*q))),
        is_affine: sources.momentum_map.iter().any(is_moved),
        lift,
    }))
}

/// ξ = Σ⁻¹(J − A) for each factor.
fn velocities<'g>(sources: &Sources<'_, 'g>, momentum: &[Expr<'g>], slope: Expr<'g>) -> Vec<(Expr<'g>, Expr<'g>)> {
    let (graph, inertia) = (sources.model.graph, sources.inertia);
    let free = entries(momentum).into_iter().enumerate().map(|(i, entry)| entry - slope.entry(i, 0));
    let free: Vec<_> = free.into_list();
    let mut entries = by_inertia(inertia, || inertia_inverse(graph, inertia.shape()), &free).into_iter();
    let parts = sources.symbols.algebra.iter();
    parts.map(|xi| (*xi, graph.stack(xi.shape(), entries.by_ref().take(xi.shape().rows).into_list()))).into_list()
}

/// p = Σ λ_k (μ_k)_Q(q), the motion of q by the components of μ for a velocity. Then J(q, p) = μ if the columns of the
/// generator of each factor are orthogonal and of the same length.
fn lift<'g>(sources: &Sources<'_, 'g>) -> Result<Vec<Expr<'g>>, Diagnostics> {
    let (graph, momentum_map) = (sources.model.graph, &sources.momentum_map);
    let returned = |velocities: &[Expr<'g>]| sources.momenta_of(sources.motion_by(velocities));
    let scale = |k: usize| {
        let mut scales = SCALES.into_iter().map(|(n, d)| graph.rational(n, d));
        scales.find(|scale| {
            let alone = sources.in_factor(k, *scale * momentum_map[k]);
            identity::equal(&[returned(&alone)[k]], &[momentum_map[k]])
        })
    };
    let scales: Option<Vec<_>> = (0..momentum_map.len()).map(scale).collect();
    let lifted = scales.and_then(|scales| {
        let scaled = |parts: &[Expr<'g>]| -> Vec<Expr<'g>> {
            scales.iter().zip(parts).map(|(scale, part)| *scale * *part).into_list()
        };
        identity::equal(&returned(&scaled(momentum_map)), momentum_map)
            .then(|| sources.motion_by(&scaled(&sources.symbols.momenta)))
    });
    lifted.ok_or_else(|| {
        let groups: Vec<String> = sources.model.factors.each(|factor| factor.group.name(graph));
        let action = Found::somewhere().named(groups.join(" × "));
        features::refusal((Feature::Collocation, asked(sources.model)), (Feature::UnliftedMomentum, action)).into()
    })
}

fn check<'g>(sources: &Sources<'_, 'g>, energy: &Energy<'g>, is_free: bool) -> Result<(), Diagnostics> {
    let model = sources.model;
    features::check((Feature::Collocation, asked(model)), |feature| match feature {
        Feature::Momentum => Found::when(model.configurations.is_empty()),
        Feature::Forces => Found::when(model.force.is_some()),
        Feature::Tangent => Found::when(model.has_variations()),
        Feature::GeneralLagrangian => Found::when(energy.general.is_some()),
        Feature::MovingInertia => Found::when(sources.is_moving(sources.inertia)),
        Feature::UnmovedFactor => {
            let factor = model.factors.iter().find(|factor| !factor.moves)?;
            Some(Found::somewhere().named(&factor.name))
        }
        Feature::FreeIsotropy => Found::when(!is_free && model.isotropy == Isotropy::Free),
        _ => None,
    })
}

/// J is quadratic in (q, p), and conserved, if ξ_Q(q) is linear in q or affine.
fn check_linear<'g>(sources: &Sources<'_, 'g>, general: &[(Expr<'g>, Expr<'g>)]) -> Result<(), Diagnostics> {
    let leaves = general.iter().zip(&sources.symbols.covectors);
    let directions: Vec<_> = leaves.map(|((_, q), direction)| (*q, *direction)).into_list();
    let slope = |velocity: &Expr<'g>| velocity.substitute(general).differential(&directions).expand();
    let bends = |velocity: &Expr<'g>| general.iter().any(|(_, q)| slope(velocity).depends_on(*q));
    if !sources.generator.iter().any(bends) {
        return Ok(());
    }
    let action = (Feature::BentAction, Found::somewhere());
    Err(features::refusal((Feature::Collocation, asked(sources.model)), action).into())
}

/// Where order 16 is asked for.
fn asked(model: &System<'_>) -> Found {
    // by construction: no other order is there without being written
    Found::at(model.spans.order.unwrap_or_else(proc_macro2::Span::call_site))
}
