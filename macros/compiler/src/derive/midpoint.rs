//! The implicit midpoint step of a field: F = G², with the forces of all sites at the midpoints of their steps.
//!
//! ```text
//! ℓd = K(F) − h U(Φ_G q),    F = G²,    s = T* ∂K(F) − N,    s + C s = h f(Φ_G q),    N⁺ = C (C N + h f)
//! ```
//! C carries a momentum along G: Ad*_{G⁻¹} for a left action, Ad*_G for a right one. As K depends on F alone, N⁺ is also T*⁺ ∂K(F) + C s.
//! In the form with forces, rounding of the solution changes no momentum. The symbol of F stands for G in all of
//! these formulas, as it stands for the element of an edge in those of edges.

use clebsch_symbolic::{Chart, Elements, Expr, Group, IntoList, Shape, indexed};

use super::field::{coordinates, logarithms, motion};
use super::moves::inverse_by;
use super::symbols::logarithm;
use super::{MatrixForm, SystemFormulas, cayley, trivialisation};
use crate::diagnostic::Diagnostics;
use crate::model::features::{self, Feature, Found};
use crate::model::{Discretization, Factor, Mechanics, Side, System};

/// The formulas of an implicit step.
pub struct MidpointFormulas<'g> {
    /// G of its Cayley coordinates, for each factor.
    pub element: Vec<Expr<'g>>,
    /// The Cayley coordinates of F = G², where the equation reads them.
    pub coordinates: Vec<Expr<'g>>,
    /// The logarithm of F, where the equation reads it.
    pub logarithm: Vec<Expr<'g>>,
    /// (1 + C)(T* ∂K(G²) − N) for each factor.
    pub residual: Vec<Expr<'g>>,
    /// Its derivatives by motions of the midpoint.
    pub slope: MatrixForm<'g>,
    /// C N for each factor.
    pub carried: Vec<Expr<'g>>,
    /// The change of the Cayley coordinates of G by a motion of the midpoint, for each factor.
    pub motion: Vec<Expr<'g>>,
    /// The declared force at the midpoint with its derivatives by motions of it; `None` if there is none. Its velocity is that of half of
    /// a step, 4z/h.
    pub force: Option<(Vec<Expr<'g>>, MatrixForm<'g>)>,
}

/// The formulas of the implicit steps of a field that asks for them.
///
/// # Errors
/// A cost that depends on the configuration, an action with motions that fix configurations, a group without a Cayley map.
pub(super) fn of<'g>(
    model: &Mechanics<'g>,
    system: &SystemFormulas<'g>,
    cost: Expr<'g>,
    force: Option<&[Expr<'g>]>,
) -> Result<Option<MidpointFormulas<'g>>, Diagnostics> {
    if !model.emit.midpoint {
        return Ok(None);
    }
    check(model, system, cost)?;
    let factors = &model.factors;
    let (before, _) = trivialisation::of_all(model, cost);
    let before = trivialisation::closed_components(model, &before);
    let squared = replacements(factors, |factor| factor.group.compose(factor.symbol, factor.symbol));
    let once = replacements(factors, |factor| factor.symbol);
    let impulse: Vec<Expr<'g>> =
        before.iter().zip(&system.symbols.momenta).map(|(before, mu)| before.substitute(&squared) - *mu).into_list();
    let along = |momenta: &[Expr<'g>]| {
        let carried = momenta.iter().enumerate().map(|(k, momentum)| system.carried(k, *momentum).substitute(&once));
        carried.into_list()
    };
    let residual: Vec<Expr<'g>> = impulse.iter().zip(along(&impulse)).map(|(own, carried)| *own + carried).into_list();
    let of_square = |symbol: fn(&System<'g>, usize) -> Expr<'g>, value: fn(&Mechanics<'g>) -> Vec<Expr<'g>>| {
        let is_read = (0..factors.len()).any(|k| before[k].depends_on(symbol(model, k)));
        if is_read { value(model).each(|value| value.substitute(&squared)) } else { Vec::new() }
    };
    let moves = (0..factors.len()).flat_map(|k| moves(model, k, &once)).into_list();
    let changes: Vec<Expr<'g>> = residual.each(|part| part.differential(&moves).substitute(&once));
    Ok(Some(MidpointFormulas {
        element: indexed(factors.len(), |k| element(model, k)),
        coordinates: of_square(cayley::symbol, coordinates),
        logarithm: of_square(logarithm, logarithms),
        slope: MatrixForm::Columns(columns(model, &changes)),
        residual,
        carried: along(&system.symbols.momenta),
        motion: indexed(factors.len(), |k| motion_of_coordinates(model, k)),
        force: force.map(|force| force_at(model, system, force)),
    }))
}

fn check<'g>(model: &Mechanics<'g>, system: &SystemFormulas<'g>, cost: Expr<'g>) -> Result<(), Diagnostics> {
    let refused = |feature, name: Option<String>| {
        let found = Found::at(model.spans.kinetic.place);
        let found = name.map_or(found.clone(), |name| found.named(name));
        Err(features::refusal((feature, found), (Feature::Midpoint, Found::somewhere())).into())
    };
    if let Some(leaf) = model.configurations.iter().find(|leaf| cost.depends_on(leaf.symbol)) {
        return refused(Feature::DependsOnConfiguration, Some(leaf.name.clone()));
    }
    if model.kinetic.discretization() == Some(Discretization::Exact) {
        return refused(Feature::ExactDiscretization, None);
    }
    for (k, factor) in model.factors.iter().enumerate() {
        let (group, y) = (factor.group, logarithm(model, k));
        if group == Group::UnitQuaternions {
            return refused(Feature::Quaternions, None);
        }
        let name = || Some(group.name(model.graph));
        if !group.is_translation() && !group.has_cayley_chart(model.graph) {
            return refused(Feature::NoCayleyMap, name());
        }
        if cost.depends_on(y) && group.logarithm_slope(y).is_none() {
            return refused(Feature::NoLogarithmSlope, name());
        }
    }
    if !system.is_free() {
        return refused(Feature::FixedConfigurations, None);
    }
    Ok(())
}

/// An element in place of each letter F, and the formulas of the groups in place of the inverses.
fn replacements<'g>(factors: &[Factor<'g>], element: impl Fn(&Factor<'g>) -> Expr<'g>) -> Vec<(Expr<'g>, Expr<'g>)> {
    let of_factor = |factor: &Factor<'g>| {
        let element = element(factor);
        inverse_by(factor.group, factor.symbol, element).into_iter().chain([(factor.symbol, element)]).into_list()
    };
    factors.iter().flat_map(of_factor).into_list()
}

/// G = (I − Z)⁻¹(I + Z) with Z = z^; 2z of a translation.
fn element<'g>(model: &Mechanics<'g>, k: usize) -> Expr<'g> {
    let (group, z) = (model.factors[k].group, cayley::symbol(model, k));
    if group.is_translation() {
        return 2 * z;
    }
    let blocks = model.graph.blocks(group);
    let blocks: Vec<Expr<'g>> =
        blocks.iter().map(|block| z.block(block.offset, 0, Shape::vector(block.algebra.dimension))).into_list();
    group.identity(model.graph) + Chart::Cayley.increment(group, &blocks)
}

/// The changes of G, and of the Cayley coordinates and the logarithm of G², by a motion η of the midpoint. G changes by ηG for a left action and
/// by Gη for a right one. So G² changes on the same side by the motion η + Ad η.
fn moves<'g>(model: &Mechanics<'g>, k: usize, once: &[(Expr<'g>, Expr<'g>)]) -> Vec<(Expr<'g>, Expr<'g>)> {
    let Factor { symbol: g, group, side, .. } = &model.factors[k];
    let (is_left, eta) = (*side == Side::Left, motion(model, 0, k));
    if group.is_translation() {
        return vec![(*g, eta), (cayley::symbol(model, k), eta), (logarithm(model, k), 2 * eta)];
    }
    let wedge = group.wedge(eta);
    let change = (*g, if is_left { wedge * *g } else { *g * wedge });
    let around = if is_left { *g } else { group.inverse(*g) };
    let twice = eta + group.adjoint(around, eta).substitute(once);
    let y = logarithm(model, k);
    let of_logarithm = group.logarithm_slope(if is_left { y } else { -y }).map(|slope| (y, slope * twice));
    [change].into_iter().chain(cayley::motion(model, k, twice, is_left)).chain(of_logarithm).into_list()
}

/// δz by a motion η of the midpoint.
fn motion_of_coordinates<'g>(model: &Mechanics<'g>, k: usize) -> Expr<'g> {
    let (eta, is_left) = (motion(model, 0, k), model.factors[k].side == Side::Left);
    cayley::motion(model, k, eta, is_left).map_or(eta / 2, |(_, moved)| moved)
}

/// A force at the midpoint, and its derivatives by motions of it.
fn force_at<'g>(
    model: &Mechanics<'g>,
    system: &SystemFormulas<'g>,
    force: &[Expr<'g>],
) -> (Vec<Expr<'g>>, MatrixForm<'g>) {
    let factors = 0..model.factors.len();
    let declared = model.force.as_ref().map_or(&[][..], |force| &force.velocities);
    let velocity = |(k, xi): (usize, &Expr<'g>)| (*xi, 4 * cayley::symbol(model, k) / model.step_size);
    let velocities = declared.iter().enumerate().map(velocity).into_list();
    let force: Vec<Expr<'g>> = force.each(|part| part.substitute(&velocities));
    let motions: Vec<Expr<'g>> = factors.clone().map(|k| motion(model, 0, k)).into_list();
    let places = model.configurations.iter().map(|leaf| leaf.symbol).zip(system.motion_by(&motions));
    let coordinates = factors.map(|k| (cayley::symbol(model, k), motion_of_coordinates(model, k)));
    let moves = places.chain(coordinates).into_list();
    let along: Vec<Expr<'g>> = force.each(|part| part.differential(&moves));
    (force, MatrixForm::Columns(columns(model, &along)))
}

/// The values of a linear function of all motions at each unit motion.
fn columns<'g>(model: &Mechanics<'g>, along: &[Expr<'g>]) -> Vec<Vec<Expr<'g>>> {
    let factors = 0..model.factors.len();
    let column = |component: usize| {
        let of_factor = |k: usize| {
            let (eta, first) = (motion(model, 0, k), model.offset(k));
            let is_own = (first..model.offset(k + 1)).contains(&component);
            let zero = model.graph.zero(eta.shape());
            (eta, if is_own { model.graph.unit(eta.shape(), component - first, 0) } else { zero })
        };
        let units = factors.clone().map(of_factor).into_list();
        along.each(|part| part.substitute(&units))
    };
    indexed(model.dimension(), column)
}
