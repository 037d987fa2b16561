//! Splittings with force gradients, of steps whose drifts are exact: the free motion of rigid bodies and of translations, and geodesics
//! of bi-invariant metrics.

use clebsch_symbolic::{Chart, Elements, Expr, IntoList, Property, Role, Shape, identity};

use super::equation::{MomentumEquation, Solution, Sources, is_diagonal};
use super::exact::{by_inertia, inertia_inverse};
use super::symbols::entries;
use super::{DiscreteLagrangian, Substep, Symbols};
use crate::model::{Mechanics, Order};

/// A step of drifts and kicks, with a force gradient where the potential is a formula.
pub struct Splitting<'g> {
    /// A kick of the weights b and g adds U to the discrete Lagrangian, but for a constant. U = −h b V + h³ g G·Σ⁻¹G with G = J(q, ∂V).
    pub potential: Expr<'g>,
    /// J(q, ∂U) for each factor.
    pub kick: Vec<Expr<'g>>,
    /// Whether there is a force gradient.
    pub has_gradient: bool,
    /// The entries of B where h² G·Σ⁻¹G = yᵀBy for entries y of q, with their names.
    pub form: Vec<(String, Expr<'g>)>,
}

/// Whether a step without its kicks is the exact flow of the kinetic energy.
pub(super) fn drifts_exactly(model: &Mechanics<'_>, symbols: &Symbols<'_>, substeps: &[Substep<'_>]) -> bool {
    let [substep] = substeps else { return false };
    let is_known = |equation: &MomentumEquation<'_>| {
        let follows_velocity = matches!(symbols.charts[equation.factors[0]], Chart::Exponential | Chart::Identity);
        equation.solution == Solution::FreeRotation
            || equation.solution == Solution::Explicit && equation.formula.is_none() && follows_velocity
    };
    let rests = substep.rest.is_none() && substep.coupling.is_none() && substep.force.is_none();
    rests && model.force.is_none() && !substep.lagrangian.couples && substep.equations.iter().all(is_known)
}

/// The splitting that makes a step of order 4 or 6, where the drift is exact and there is a potential.
pub(super) fn splitting<'g>(
    sources: &Sources<'_, 'g>,
    lagrangian: &DiscreteLagrangian<'g>,
    substeps: &[Substep<'g>],
) -> Option<Splitting<'g>> {
    let (model, h) = (sources.model, sources.model.step_size);
    let energy = model.potential.filter(|_| matches!(model.order, Order::Fourth | Order::Sixth))?;
    let half = -(h * energy / 2);
    let plain =
        lagrangian.start == half && lagrangian.end == half && !model.has_variations() && model.monitor.is_none();
    if !plain || !drifts_exactly(model, &sources.symbols, substeps) {
        return None;
    }
    let direction = sources.direction(energy, &sources.momenta_of(sources.gradients(energy)));
    let (place, energy, force) = match (&direction, &model.configurations[..]) {
        (Some(direction), _) => {
            (Some(direction.symbol), direction.potential, vec![direction.impulse(direction.potential)])
        }
        // on spheres G is as short as a form
        (None, [leaf]) if leaf.symbol.shape().columns > 1 => (Some(leaf.symbol), energy, sources.impulse(energy)?),
        _ => (None, energy, sources.impulse(energy)?),
    };
    let weight = |name: &str, role: Role| model.graph.symbol(name, Shape::scalar(), role, Property::General);
    let kick = -(h * weight("b", Role::Kick) * energy);
    let has_gradient = model.opaque.is_none();
    let (mut potential, mut form) = (kick, Vec::new());
    if has_gradient {
        // from impulses rather than forces: squares of forces overflow in units of time that steps are made in
        let impulse = force.each(|part| h * *part);
        let energy = match place.and_then(|place| quadratic_form(sources, place, &entries(&impulse))) {
            Some(quadratic) => {
                form = quadratic.entries;
                quadratic.value
            }
            None => gradient_energy(sources, &impulse),
        };
        potential = potential + h * weight("g", Role::KickGradient) * energy;
    }
    let Some(direction) = direction else {
        return Some(Splitting { potential, kick: sources.impulse(potential)?, has_gradient, form });
    };
    let kick = vec![direction.inserted(direction.impulse(potential))];
    Some(Splitting { potential: direction.inserted(potential), kick, has_gradient, form })
}

/// I·Σ⁻¹I of an impulse, h² {V, {V, T}}.
fn gradient_energy<'g>(sources: &Sources<'_, 'g>, impulse: &[Expr<'g>]) -> Expr<'g> {
    let (graph, inertia) = (sources.model.graph, sources.inertia);
    let entries = entries(impulse);
    if is_diagonal(inertia) {
        let squares = entries.iter().enumerate();
        return graph.total(Shape::scalar(), squares.map(|(i, entry)| *entry * *entry / inertia.entry(i, i).expand()));
    }
    let impulse = graph.stack(Shape::vector(entries.len()), entries);
    impulse.dot(inertia_inverse(graph, inertia.shape()) * impulse)
}

/// The most entries of q in a form: it has a coefficient for each pair of them.
const LARGEST_FORM: usize = 6;

/// A form that is quadratic in entries of q, with the names of its coefficients.
struct QuadraticForm<'g> {
    value: Expr<'g>,
    entries: Vec<(String, Expr<'g>)>,
}

/// I·Σ⁻¹I as yᵀBy where I = Ly, `impulse`, is linear in as few entries y of q as it has components. B = LᵀΣ⁻¹L is constant then, as for weight.
fn quadratic_form<'g>(sources: &Sources<'_, 'g>, place: Expr<'g>, impulse: &[Expr<'g>]) -> Option<QuadraticForm<'g>> {
    let (model, graph) = (sources.model, sources.model.graph);
    let gradients = impulse.each(|component| component.expand().gradient(place));
    let moves = |gradient: &Expr<'g>| {
        gradient.depends_on(place) || model.reads_configuration(*gradient) || gradient.depends_on(model.time)
    };
    if gradients.iter().any(moves) {
        return None;
    }
    let column = |(i, j): (usize, usize)| gradients.each(|gradient| gradient.entry(i, j));
    let is_read = |position: &(usize, usize)| column(*position).iter().any(|entry| !identity::vanishes(*entry));
    let read: Vec<(usize, usize)> = place.shape().positions().filter(is_read).into_list();
    let linear = |gradient: &Expr<'g>| {
        let terms = read.iter().map(|&(i, j)| place.entry(i, j) * gradient.entry(i, j));
        graph.total(Shape::scalar(), terms)
    };
    if read.len() > impulse.len().min(LARGEST_FORM) || !identity::equal(impulse, &gradients.each(linear)) {
        return None;
    }
    let (mut terms, mut entries) = (Vec::new(), Vec::new());
    for (b, &second) in read.iter().enumerate() {
        let inverse = || inertia_inverse(graph, sources.inertia.shape());
        let velocity = by_inertia(sources.inertia, inverse, &column(second));
        for (a, &first) in read.iter().enumerate().take(b + 1) {
            let products = column(first).into_iter().zip(&velocity).map(|(impulse, velocity)| impulse * *velocity);
            let entry = graph.total(Shape::scalar(), products);
            let twice = if a == b { 1 } else { 2 };
            terms.push(twice * (entry * (place.entry(first.0, first.1) * place.entry(second.0, second.1))));
            entries.push((format!("force_gradient_{a}{b}"), entry));
        }
    }
    Some(QuadraticForm { value: graph.total(Shape::scalar(), terms), entries })
}
