//! Drifts that are exact: the free motion of rigid bodies and of translations, and geodesics of bi-invariant metrics. They need no equation to be
//! solved by iteration, and allow splittings with force gradients.

use clebsch_symbolic::{Chart, Expr, Graph, Group, Property, Role, Shape, identity};

use super::equation::{MomentumEquation, Solution, Sources, Structure, is_diagonal};
use super::{DiscreteLagrangian, Substep, Symbols, action, velocity};
use crate::diagnostic::Diagnostics;
use crate::model::features::{self, Feature, Found};
use crate::model::{Discretization, Mechanics, Order, Side};

/// A step of drifts and kicks, with a force gradient where the potential is a formula.
pub struct Splitting<'g> {
    /// U = −h b V + h³ g G·Σ⁻¹G with G = J(q, ∂V): what a kick of the weights b and g adds to the discrete Lagrangian.
    pub potential: Expr<'g>,
    /// J(q, ∂U) for each factor.
    pub kick: Vec<Expr<'g>>,
    /// Whether there is a force gradient.
    pub has_gradient: bool,
}

/// Whether a step without a potential is to be the exact free motion.
pub(super) fn is_exact(model: &Mechanics<'_>) -> bool {
    model.kinetic.discretization() == Some(Discretization::Exact)
}

/// Whether the motion of a factor is found from the constants of free rotation.
pub(super) fn is_free_rotation(model: &Mechanics<'_>, k: usize) -> bool {
    is_exact(model) && !model.factors[k].group.is_translation()
}

/// A cost with the same kinetic energy and the same symmetries as the action of the free motion, which is no formula of F: what does not
/// depend on the discretisation is derived from it.
///
/// # Errors
/// A group or an energy whose free motion is not known.
pub(super) fn stand_in<'g>(
    model: &Mechanics<'g>,
    energy: Expr<'g>,
    velocities: &[Expr<'g>],
) -> Result<Expr<'g>, Diagnostics> {
    check(model, energy, velocities)?;
    let h = model.step_size;
    let velocity = |k: usize| match model.factors[k].group {
        Group::UnitQuaternions => velocity::of_element(model, k, h, Discretization::Cayley),
        _ => velocity::of_element(model, k, h, Discretization::Projection),
    };
    let discrete: Vec<_> = velocities.iter().enumerate().map(|(k, symbol)| (*symbol, velocity(k))).collect();
    Ok(h * energy.substitute(&discrete))
}

fn check<'g>(model: &Mechanics<'g>, energy: Expr<'g>, velocities: &[Expr<'g>]) -> Result<(), Diagnostics> {
    let known = |group: Group| {
        group.is_translation() || matches!(group, Group::SpecialOrthogonal(3 | 4) | Group::UnitQuaternions)
    };
    let velocity = || Found::somewhere().named(velocities[0]);
    features::check((Feature::ExactDiscretization, Found::at(model.spans.kinetic.place)), |feature| match feature {
        Feature::UnknownFreeMotion => {
            let factor = model.factors.iter().find(|factor| !known(factor.group))?;
            Some(Found::somewhere().named(factor.group.name(model.graph)))
        }
        Feature::RotationsOfFourSpace => {
            let turns = model.factors.iter().any(|factor| factor.group == Group::SpecialOrthogonal(4));
            let is_alone = model.factors.len() == 1 && model.potential.is_none() && model.opaque.is_none();
            Found::when(turns && !is_alone)
        }
        Feature::Forces => Found::when(model.force.is_some()),
        Feature::Tangent => Found::when(model.has_variations()),
        Feature::VaryingEnergy => (!is_constant_form(model, energy, velocities)).then(velocity),
        Feature::NoDistributionOfMass => (!has_mass(model, energy, velocities)).then(velocity),
        _ => None,
    })
}

/// Whether an energy is a constant quadratic form of each velocity alone.
fn is_constant_form<'g>(model: &Mechanics<'g>, energy: Expr<'g>, velocities: &[Expr<'g>]) -> bool {
    let moves = energy.depends_on(model.time) || model.configurations.iter().any(|leaf| energy.depends_on(leaf.symbol));
    let quadratic = |velocity: &Expr<'g>| {
        let gradient = energy.gradient(*velocity);
        let inertia = gradient.matrix_of_linear(*velocity);
        !velocities.iter().any(|v| inertia.depends_on(*v)) && identity::equal(&[gradient], &[inertia * *velocity])
    };
    !moves && velocities.iter().all(quadratic)
}

/// Whether a distribution of mass has the energy, on the factors where this matters.
fn has_mass<'g>(model: &Mechanics<'g>, energy: Expr<'g>, velocities: &[Expr<'g>]) -> bool {
    model.factors.iter().zip(velocities).all(|(factor, velocity)| {
        factor.group != Group::SpecialOrthogonal(4)
            || velocity::mass_matrix(factor.group, energy.gradient(*velocity).matrix_of_linear(*velocity)).is_some()
    })
}

/// Whether a solution gives F − I and the next momentum themselves, not chart coordinates: the free motion of four dimensions, which is alone.
pub(super) fn turns_whole(model: &Mechanics<'_>) -> bool {
    is_exact(model) && model.factors.iter().any(|factor| factor.group == Group::SpecialOrthogonal(4))
}

/// The equation d x − m^ x = m of a free rotation with the Gibbs vector x and m = h μ/2, d of the modified inertia.
///
/// In four dimensions F̃J̃ − J̃F̃ᵀ = m, J̃ of the modified body and F̃ the motion but for a turn that the momentum gives.
pub(super) fn equation<'g>(sources: &Sources<'_, 'g>, i: usize) -> MomentumEquation<'g> {
    let (graph, block) = (sources.model.graph, sources.symbols.blocks[i]);
    let n = block.dimension();
    let m = graph.symbol("m", Shape::vector(n), Role::Letter, Property::General);
    let (residual, directional) = match turns_whole(sources.model) {
        true => {
            let group = sources.model.factors[block.factor].group;
            let mass = graph.symbol("J̃", Shape::square(4), Role::Letter, Property::Symmetric);
            let turned = graph.symbol("F̃", Shape::square(4), Role::Letter, Property::Orthogonal);
            let skew = turned * mass - mass * turned.transpose();
            (group.projected_coordinates(skew) - m, graph.zero(Shape::vector(n)))
        }
        false => {
            let d = graph.symbol("d", Shape::square(3), Role::Letter, Property::Symmetric);
            let hat = Group::SpecialOrthogonal(3).wedge(m);
            (d * block.coordinates - hat * block.coordinates - m, d * block.direction - hat * block.direction)
        }
    };
    MomentumEquation {
        components: block.components().collect(),
        factors: vec![block.factor],
        residual,
        directional,
        cleared: true,
        solution: Solution::FreeRotation,
        formula: None,
        sine_squared: None,
        sine: None,
        structure: Structure::Dense,
        coupled: Vec::new(),
        is_inertial: true,
        moves: false,
    }
}

/// F⁻ℓd and F⁺ℓd of a factor that moves freely, with the symbol μ for the momentum of the free motion that makes F.
pub(super) fn legendre<'g>(model: &Mechanics<'g>, symbols: &Symbols<'g>, k: usize) -> (Expr<'g>, Expr<'g>) {
    let (factor, mu) = (&model.factors[k], symbols.momenta[k]);
    let carried = match factor.side {
        Side::Left => factor.group.coadjoint(factor.group.inverse(factor.symbol), mu),
        Side::Right => factor.group.coadjoint(factor.symbol, mu),
    };
    (mu, carried)
}

/// Whether a step without its kicks is the exact flow of the kinetic energy.
pub(super) fn drifts_exactly(model: &Mechanics<'_>, symbols: &Symbols<'_>, substeps: &[Substep<'_>]) -> bool {
    let [substep] = substeps else { return false };
    let is_known = |equation: &MomentumEquation<'_>| match equation.solution {
        Solution::FreeRotation => true,
        Solution::Explicit => {
            let chart = symbols.charts[equation.factors[0]];
            equation.formula.is_none() && matches!(chart, Chart::Exponential | Chart::Identity)
        }
        _ => false,
    };
    let rests = substep.rest.is_none() && substep.other.is_none() && substep.force.is_none();
    rests && model.force.is_none() && !substep.lagrangian.couples && substep.equations.iter().all(is_known)
}

/// The splitting that makes a step of order 4 or 6, where the drift is exact and there is a potential.
pub(super) fn splitting<'g>(
    sources: &Sources<'_, 'g>,
    lagrangian: &DiscreteLagrangian<'g>,
    substeps: &[Substep<'g>],
) -> Option<Splitting<'g>> {
    let (model, symbols, h) = (sources.model, sources.symbols, sources.model.step_size);
    let energy = model.potential.filter(|_| matches!(model.order, Order::Fourth | Order::Sixth))?;
    let half = -(h * energy / 2);
    let plain = lagrangian.start == half && lagrangian.end == half && !model.has_variations();
    if !plain || !drifts_exactly(model, symbols, substeps) {
        return None;
    }
    let impulse = |potential: Expr<'g>| action::impulse(model, symbols, sources.momentum_map, potential);
    let force = impulse(energy)?;
    let weight = |name: &str, role: Role| model.graph.symbol(name, Shape::scalar(), role, Property::General);
    let kick = -(h * weight("b", Role::Kick) * energy);
    let has_gradient = model.opaque.is_none();
    let potential = match has_gradient {
        true => kick + h * h * h * weight("g", Role::KickGradient) * gradient_energy(sources, &force),
        false => kick,
    };
    Some(Splitting { potential, kick: impulse(potential)?, has_gradient })
}

/// {V, {V, T}} = G·Σ⁻¹G.
fn gradient_energy<'g>(sources: &Sources<'_, 'g>, force: &[Expr<'g>]) -> Expr<'g> {
    let (graph, inertia) = (sources.model.graph, sources.inertia);
    let entries: Vec<Expr<'g>> =
        force.iter().flat_map(|part| (0..part.shape().rows).map(|i| part.entry(i, 0))).collect();
    match is_diagonal(inertia) {
        true => entries
            .iter()
            .enumerate()
            .fold(graph.integer(0), |sum, (i, entry)| sum + *entry * *entry / inertia.entry(i, i).expand()),
        false => {
            let force = graph.stack(Shape::vector(entries.len()), entries);
            force.dot(inertia_inverse(graph, inertia.shape()) * force)
        }
    }
}

/// Σ⁻¹μ, by divisions where Σ is diagonal, else by `inverse`, its inverse.
pub(crate) fn by_inertia<'g>(inertia: Expr<'g>, inverse: impl FnOnce() -> Expr<'g>, mu: &[Expr<'g>]) -> Vec<Expr<'g>> {
    if is_diagonal(inertia) {
        return mu.iter().enumerate().map(|(i, mu)| *mu / inertia.entry(i, i).expand()).collect();
    }
    let (zero, inverse) = (inertia.graph().integer(0), inverse());
    let row = |i: usize| mu.iter().enumerate().fold(zero, |sum, (j, mu)| sum + inverse.entry(i, j) * *mu);
    (0..mu.len()).map(row).collect()
}

/// Σ⁻¹ as a symbol, which the stepper computes from Σ.
pub(crate) fn inertia_inverse<'g>(graph: &'g Graph, shape: Shape) -> Expr<'g> {
    graph.symbol("inertia_inverse", shape, Role::InertiaInverse, Property::Symmetric)
}
