//! The free motion of rigid bodies and of translations, which needs no equation to be solved by iteration.

use clebsch_symbolic::{Expr, Graph, Group, IntoList, Property, Role, Shape, indexed};

use super::equation::{Form, MomentumEquation, Solution, Sources, is_diagonal};
use super::velocity;
use crate::diagnostic::Diagnostics;
use crate::model::features::{self, Feature, Found};
use crate::model::{Discretization, Factor, Mechanics};

/// Whether a step without a potential is to be the exact free motion.
pub(super) fn is_exact(model: &Mechanics<'_>) -> bool {
    model.kinetic.discretization() == Some(Discretization::Exact)
}

/// Whether the motion of a factor is found from the constants of free rotation.
pub(super) fn is_free_rotation(model: &Mechanics<'_>, k: usize) -> bool {
    is_exact(model) && !model.factors[k].group.is_translation()
}

/// The discretisation of velocities that stands in for the action of the free motion, which is no formula of F. Its
/// cost has the same kinetic energy and the same symmetries. All formulas that do not depend on the discretisation are
/// derived from it.
pub(super) fn stand_in(model: &Mechanics<'_>, k: usize, discretization: Discretization) -> Discretization {
    match (discretization, model.factors[k].group) {
        (Discretization::Exact, Group::UnitQuaternions) => Discretization::Cayley,
        (Discretization::Exact, _) => Discretization::Projection,
        _ => discretization,
    }
}

/// An exact step needs a group and an energy whose free motion is known.
pub(super) fn check<'g>(model: &Mechanics<'g>, energy: Expr<'g>, velocities: &[Expr<'g>]) -> Result<(), Diagnostics> {
    use Group::{SpecialOrthogonal, Translation, UnitQuaternions};
    let is_known = |group: Group| matches!(group, Translation(_) | SpecialOrthogonal(3 | 4) | UnitQuaternions);
    let velocity = || Found::somewhere().named(velocities[0]);
    features::check((Feature::ExactDiscretization, Found::at(model.spans.kinetic.place)), |feature| match feature {
        Feature::UnknownFreeMotion => {
            let factor = model.factors.iter().find(|factor| !is_known(factor.group))?;
            Some(Found::somewhere().named(factor.group.name(model.graph)))
        }
        Feature::RotationsOfFourSpace => {
            let turns = model.factors.iter().any(|factor| factor.group == SpecialOrthogonal(4));
            let is_alone = model.factors.len() == 1 && model.potential.is_none() && model.opaque.is_none();
            Found::when(turns && !is_alone)
        }
        Feature::Forces => Found::when(model.force.is_some()),
        Feature::Tangent => Found::when(model.has_variations()),
        // a constant quadratic form of each velocity alone
        Feature::VaryingEnergy => {
            let is_form = |velocity: &Expr<'g>| velocity::inertia(energy, velocities, *velocity).is_some();
            let varies = model.reads_configuration(energy) || energy.depends_on(model.time);
            (varies || !velocities.iter().all(is_form)).then(velocity)
        }
        // whether a distribution of mass has the energy, on the factors where this matters
        Feature::NoDistributionOfMass => {
            let mut factors = model.factors.iter().zip(velocities);
            let is_massless = |(factor, velocity): (&Factor<'g>, &Expr<'g>)| {
                let inertia = || energy.gradient(*velocity).matrix_of_linear(*velocity);
                factor.group == SpecialOrthogonal(4) && velocity::mass_matrix(factor.group, inertia()).is_none()
            };
            factors.any(is_massless).then(velocity)
        }
        _ => None,
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
    let letter = |name: &str, shape: Shape, property: Property| graph.symbol(name, shape, Role::Letter, property);
    let m = letter("m", Shape::vector(n), Property::General);
    let residual = if turns_whole(sources.model) {
        let mass = letter("J̃", Shape::square(4), Property::Symmetric);
        let turned = letter("F̃", Shape::square(4), Property::Orthogonal);
        let skew = turned * mass - mass * turned.transpose();
        sources.model.factors[block.factor].group.projected_coordinates(skew) - m
    } else {
        let d = letter("d", Shape::square(3), Property::Symmetric);
        d * block.coordinates - Group::SpecialOrthogonal(3).wedge(m) * block.coordinates - m
    };
    let equation = MomentumEquation::new(
        sources,
        block.components().into_list(),
        residual,
        Form { cleared: true, is_near: false },
    );
    MomentumEquation { solution: Solution::FreeRotation, ..equation }
}

/// Σ⁻¹μ, by divisions where Σ is diagonal, else by `inverse`, its inverse.
pub(super) fn by_inertia<'g>(inertia: Expr<'g>, inverse: impl FnOnce() -> Expr<'g>, mu: &[Expr<'g>]) -> Vec<Expr<'g>> {
    if is_diagonal(inertia) {
        return mu.iter().enumerate().map(|(i, mu)| *mu / inertia.entry(i, i).expand()).into_list();
    }
    let inverse = inverse();
    let row = |i: usize| {
        inertia.graph().total(Shape::scalar(), mu.iter().enumerate().map(|(j, mu)| inverse.entry(i, j) * *mu))
    };
    indexed(mu.len(), row)
}

/// Σ⁻¹ as a symbol, which the stepper computes from Σ.
pub(super) fn inertia_inverse<'g>(graph: &'g Graph, shape: Shape) -> Expr<'g> {
    graph.symbol("inertia_inverse", shape, Role::InertiaInverse, Property::Symmetric)
}
