//! The velocity ξ, made from F and h.

use clebsch_symbolic::{Elements, Expr, Group, IntoElements, IntoList, Shape, identity, indexed, integer, reduce};

use super::symbols::{at_zero, logarithm, of_columns};
use crate::diagnostic::Diagnostics;
use crate::model::features::{self, Feature, Found};
use crate::model::{Discretization, Factor, System};

/// The velocity ξ(F)/h of a factor. It is the coordinates of log F/h, of 2(F − I)(F + I)⁻¹/h, projected if that leaves
/// the algebra, or of P(F − I)/h.
pub(super) fn of_element<'g>(model: &System<'g>, k: usize, h: Expr<'g>, discretization: Discretization) -> Expr<'g> {
    let Factor { group, symbol: f, .. } = model.factors[k];
    let identity = group.identity(model.graph);
    match discretization {
        _ if group.is_translation() => f / h,
        Discretization::Exponential => logarithm(model, k) / h,
        // tan(θ/2) is the vector part over the scalar part
        Discretization::Cayley if group == Group::UnitQuaternions => {
            2 * (f.block(0, 0, Shape::vector(3)) / (f.entry(3, 0) * h))
        }
        Discretization::Cayley => 2 * group.projected_coordinates((f - identity) * (f + identity).inverse()) / h,
        _ => group.projected_coordinates(f - identity) / h,
    }
}

/// h times ½ tr((F − I)/h 𝕄 (F − I)ᵀ/h), with the symmetric 𝕄 for which ½ tr(ξ 𝕄 ξᵀ) = ℓ(ξ) − ℓ(0), and ℓ(0).
pub(super) fn moser_veselov<'g>(
    model: &System<'g>,
    energy: Expr<'g>,
    velocities: &[Expr<'g>],
) -> Result<Expr<'g>, Diagnostics> {
    let (h, graph) = (model.step_size, model.graph);
    let mut cost = h * energy.substitute(&at_zero(velocities.iter().copied()));
    for (factor, velocity) in model.factors.iter().zip(velocities) {
        let inertia = inertia(energy, velocities, *velocity)
            .ok_or_else(|| refused(model, Feature::CoupledVelocities, velocity))?;
        let mass = mass_matrix(factor.group, inertia)
            .ok_or_else(|| refused(model, Feature::NoMassMatrix, factor.group.name(graph)))?;
        let identity = factor.group.identity(graph);
        let f = factor.symbol;
        cost = cost
            + match factor.group {
                Group::SpecialOrthogonal(_) => (mass * (f - identity) * (f - identity).transpose()).trace() / (2 * h),
                Group::Translation(_) => f.dot(mass * f) / (2 * h),
                _ => ((f - identity) * mass * (f - identity).transpose()).trace() / (2 * h),
            };
    }
    Ok(cost)
}

/// Σ of a velocity, if the energy is a quadratic form of it alone. A term that couples two velocities belongs to the
/// form of neither.
pub(super) fn inertia<'g>(energy: Expr<'g>, velocities: &[Expr<'g>], velocity: Expr<'g>) -> Option<Expr<'g>> {
    let gradient = energy.gradient(velocity);
    let inertia = gradient.matrix_of_linear(velocity);
    let is_constant = !velocities.iter().any(|v| inertia.depends_on(*v));
    (is_constant && identity::equal(&[gradient], &[inertia * velocity])).then_some(inertia)
}

/// The symmetric 𝕄 with ½ tr(ξ 𝕄 ξᵀ) = ½ ξ·Σξ for all ξ, if there is one: ½tr(J)I − J on SO(3).
pub(super) fn mass_matrix<'g>(group: Group, inertia: Expr<'g>) -> Option<Expr<'g>> {
    let graph = inertia.graph();
    match group {
        Group::SpecialOrthogonal(3) => {
            return Some((inertia.trace() / 2 * graph.identity(3) - inertia).expand());
        }
        Group::Translation(_) => return Some(inertia),
        Group::UnitQuaternions => return None,
        _ => {}
    }
    let n = group.element_shape().rows;
    let basis = graph.matrices(group);
    // Σ_ij = tr(E_i 𝕄 E_jᵀ): linear in the entries of 𝕄, solved by least squares over the rationals
    let square = Shape::square(n);
    let unit = |(i, j): (usize, usize)| {
        if i == j { graph.unit(square, i, i) } else { graph.unit(square, i, j) + graph.unit(square, j, i) }
    };
    let units: Vec<Expr<'g>> = square.positions().filter(|(i, j)| i <= j).map(unit).into_list();
    let image = |unit: &Expr<'g>| -> Vec<Expr<'g>> {
        basis.iter().flat_map(|a| basis.iter().map(|b| (*a * *unit).dot(*b).expand())).into_list()
    };
    let (units, images) = independent(units.into_each(|unit| (unit, image(&unit))));
    let map = of_columns(graph, &images);
    let normal = map.transpose() * map;
    let given = graph.stack(Shape::vector(map.shape().rows), inertia.entries());
    let solution = normal.inverse() * (map.transpose() * given);
    let fits = !normal.has_inverse() && !solution.has_inverse();
    if !fits || !identity::equal(&[map * solution], &[given]) {
        return None;
    }
    let terms = units.iter().enumerate().map(|(k, unit)| solution.entry(k, 0).expand() * *unit);
    Some(graph.total(square, terms))
}

/// The matrices whose images are independent: on SE(2) and SO(2) several 𝕄 have the same Σ, and one of them will do.
fn independent<'g>(units: Vec<(Expr<'g>, Vec<Expr<'g>>)>) -> (Vec<Expr<'g>>, Vec<Vec<Expr<'g>>>) {
    let value = |entry: &Expr<'g>| entry.as_number().unwrap_or_else(|| integer(0));
    let length = units.first().map_or(0, |(_, image)| image.len());
    let mut rows: Vec<Vec<_>> = indexed(length, |row| units.each(|(_, image)| value(&image[row])));
    let pivots = reduce(&mut rows);
    units.into_iter().enumerate().filter(|(index, _)| pivots.contains(index)).map(|(_, unit)| unit).unzip()
}

/// The error for a Lagrangian that Moser and Veselov's discretisation cannot have.
fn refused(model: &System<'_>, feature: Feature, name: impl ToString) -> Diagnostics {
    let beside = Found::somewhere().named(name);
    features::refusal((Feature::MoserVeselov, Found::at(model.spans.kinetic.place)), (feature, beside)).into()
}
