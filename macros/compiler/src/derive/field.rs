//! The energies of a field: the forces of an edge on both of its sites, and of all edges of a site together.
//!
//! U(q, q⁺) of an edge pushes its site by −J(q, ∂₁U) and its neighbour by −J(q⁺, ∂₂U). J is linear in the covector, so
//! the gradients of all edges of a site may be added first, and J taken once.

use clebsch_symbolic::{Elements, Expr, Group, IntoElements, IntoList, Property, Role, Shape, indexed, work};

use super::formula::shorter;
use super::midpoint::{self, MidpointFormulas};
use super::power::{SiteTerm, of_terms};
use super::symbols::logarithm;
use super::{SystemFormulas, cayley, trivialisation};
use crate::diagnostic::Diagnostics;
use crate::model::{EdgeEnergy, Factor, FieldEnergies, Mechanics, Side, System, Term};

/// The work to expand a force for code that may be shorter, at most.
const EXPANSION: u64 = 50_000;

/// The formulas of a field.
pub struct FieldFormulas<'g> {
    /// Whether it rests, without a kinetic energy.
    pub is_static: bool,
    /// Those of the edges, one for each direction.
    pub edges: Vec<EdgeFormulas<'g>>,
    /// −J(q, ∂V) for each factor, a function of the configuration; none without a potential.
    pub force_of_site: Vec<Expr<'g>>,
    /// Its change by a small motion of the site.
    pub force_of_site_along: Vec<Expr<'g>>,
    /// The force on a site that has a neighbour on both sides in each direction: from its potential and from all edges.
    /// The neighbour in direction d stands at the place 1 + 2d, and the site whose neighbour it is at 2 + 2d. `None` where an
    /// edge is of a group element.
    pub force_inside: Option<Vec<Expr<'g>>>,
    /// Those of implicit steps, where they are asked for.
    pub midpoint: Option<MidpointFormulas<'g>>,
}

/// The formulas of an edge.
pub struct EdgeFormulas<'g> {
    /// U.
    pub energy: Expr<'g>,
    /// −J(q, ∂₁U) for each factor.
    pub on_site: Vec<Expr<'g>>,
    /// −J(q⁺, ∂₂U) for each factor, with q⁺ of the neighbour.
    pub on_neighbour: Vec<Expr<'g>>,
    /// The changes of both by small motions of the ends.
    pub along: [Vec<Expr<'g>>; 2],
    /// The group element that moves the site to the neighbour, for each factor. All three are functions of it then.
    pub element: Vec<Expr<'g>>,
    /// Its Cayley coordinates for each factor, a function of it; empty where none is read.
    pub coordinates: Vec<Expr<'g>>,
    /// The coordinates of its logarithm for each factor, in the same way.
    pub logarithm: Vec<Expr<'g>>,
}

/// The formulas of the field of a model; `None` if it is none.
///
/// # Errors
/// Those of implicit steps.
pub(super) fn of<'g>(
    model: &Mechanics<'g>,
    system: &SystemFormulas<'g>,
    cost: Expr<'g>,
    force: Option<&[Expr<'g>]>,
) -> Result<Option<FieldFormulas<'g>>, Diagnostics> {
    let Some(field) = model.field.as_ref() else { return Ok(None) };
    let force_of_site = field.potential.and_then(|potential| system.impulse(potential)).unwrap_or_default();
    let there = |edge: &EdgeEnergy<'g>, end: usize| -> Vec<Expr<'g>> {
        indexed(model.configurations.len(), |leaf| leaf_of_edge(model, edge, end, leaf))
    };
    let edges = field.edges.each(|edge| {
        if !edge.element.is_empty() {
            return of_element(model, edge);
        }
        let [on_site, on_neighbour] = [0, 1].map(|end| push(system, &there(edge, end), gradient(model, edge, end)));
        let moves = [0, 1].into_iter().flat_map(|end| moves(system, &there(edge, end), end)).into_list();
        let along = [&on_site, &on_neighbour].map(|force| force.each(|part| part.differential(&moves)));
        let (element, coordinates, logarithm) = (Vec::new(), Vec::new(), Vec::new());
        EdgeFormulas { energy: edge.value, on_site, on_neighbour, along, element, coordinates, logarithm }
    });
    let force_of_site = force_of_site.into_each(|force| -force);
    let moves = moves(system, &model.configurations.each(|leaf| leaf.symbol), 0);
    Ok(Some(FieldFormulas {
        midpoint: midpoint::of(model, system, cost, force)?,
        is_static: field.is_static,
        edges,
        force_of_site_along: force_of_site.each(|force| force.differential(&moves)),
        force_of_site,
        force_inside: field
            .edges
            .iter()
            .all(|edge| edge.element.is_empty())
            .then(|| force_inside(model, system, field)),
    }))
}

/// The formulas of an edge whose energy is a function κ(F) of a group element. Its forces are the two trivialisations of ∂κ. For a
/// right action they are T*_id R_F ∂κ and −T*_id L_F ∂κ.
fn of_element<'g>(model: &Mechanics<'g>, edge: &EdgeEnergy<'g>) -> EdgeFormulas<'g> {
    let (before, after) = trivialisation::of_all(model, edge.value);
    let on_site = trivialisation::closed_components(model, &before);
    let on_neighbour = trivialisation::closed_components(model, &after).into_each(|force| -force);
    let factors = 0..model.factors.len();
    let reads =
        |symbol: fn(&System<'g>, usize) -> Expr<'g>| factors.clone().any(|k| edge.value.depends_on(symbol(model, k)));
    let coordinates = if reads(cayley::symbol) { coordinates(model) } else { Vec::new() };
    let logarithm = if reads(logarithm) { logarithms(model) } else { Vec::new() };
    let moves = (0..model.factors.len()).flat_map(|k| moves_of_element(model, k)).into_list();
    let along = [&on_site, &on_neighbour].map(|force| force.each(|part| part.differential(&moves)));
    let element = edge.element.clone();
    EdgeFormulas { energy: edge.value, on_site, on_neighbour, along, element, coordinates, logarithm }
}

/// The coordinates of log F of each factor.
pub(super) fn logarithms<'g>(model: &Mechanics<'g>) -> Vec<Expr<'g>> {
    model.factors.each(|factor| factor.group.closed_logarithm(factor.symbol))
}

/// The coordinates of a small motion of an end of an edge, for a factor.
pub(super) fn motion<'g>(model: &System<'g>, end: usize, k: usize) -> Expr<'g> {
    let name = if end == 0 { "η" } else { "η⁺" };
    let shape = Shape::vector(model.factors[k].group.dimension());
    model.graph.symbol(name, shape, Role::Motion(end, k), Property::General)
}

/// The changes η_Q(q) of the leaves of a configuration by a small motion of an end.
fn moves<'g>(system: &SystemFormulas<'g>, q: &[Expr<'g>], end: usize) -> Vec<(Expr<'g>, Expr<'g>)> {
    let (model, leaves) = (&system.model, system.model.configurations.iter().map(|leaf| leaf.symbol));
    let places = leaves.zip(q.iter().copied()).into_list();
    let moved = system.motion_by(&indexed(model.factors.len(), |k| motion(model, end, k)));
    q.iter().copied().zip(moved.into_each(|moved| moved.substitute(&places))).into_list()
}

/// The changes of the element of an edge, of its Cayley coordinates and of its logarithm by small motions of both ends. For a right action
/// F = q⁻¹q⁺ changes by Fη⁺ − ηF, for a left one F = q⁺q⁻¹ by η⁺F − Fη.
fn moves_of_element<'g>(model: &Mechanics<'g>, k: usize) -> Vec<(Expr<'g>, Expr<'g>)> {
    let Factor { symbol: f, group, side, .. } = &model.factors[k];
    let is_left = *side == Side::Left;
    let [own, next] = [0, 1].map(|end| motion(model, end, k));
    if group.is_translation() {
        let change = next - own;
        return vec![(*f, change), (cayley::symbol(model, k), change / 2), (logarithm(model, k), change)];
    }
    let by = |motion: Expr<'g>, from_left: bool| {
        if from_left { group.wedge(motion) * *f } else { *f * group.wedge(motion) }
    };
    let change = (*f, by(next, is_left) - by(own, !is_left));
    let of_end = |motion: Expr<'g>, from_left: bool| cayley::motion(model, k, motion, from_left);
    let coordinates =
        of_end(next, is_left).zip(of_end(own, !is_left)).map(|((z, after), (_, before))| (z, after - before));
    // δF = ηF moves log F by dexp_y⁻¹ η, and δF = Fη by dexp_{−y}⁻¹ η
    let y = logarithm(model, k);
    let slope = |from_left: bool| group.logarithm_slope(if from_left { y } else { -y });
    let logarithm = slope(is_left).zip(slope(!is_left)).map(|(after, before)| (y, after * next - before * own));
    [change].into_iter().chain(coordinates).chain(logarithm).into_list()
}

/// (F − I)(F + I)⁻¹ of each factor, in coordinates.
pub(super) fn coordinates<'g>(model: &Mechanics<'g>) -> Vec<Expr<'g>> {
    let graph = model.graph;
    let of_factor = |(k, factor): (usize, &Factor<'g>)| {
        let f = factor.symbol;
        let turn = |n: usize, f: Expr<'g>| {
            let group = Group::SpecialOrthogonal(n);
            2 * group.projected_coordinates(f) / (f.trace() + graph.integer(4 - n as i64))
        };
        match factor.group {
            Group::Translation(_) => f / 2,
            Group::SpecialOrthogonal(n @ (2 | 3)) => turn(n, f),
            // the shift of (R d; 0 1) is ½ (I − Z)d
            Group::SpecialEuclidean(n @ (2 | 3)) => {
                let (r, d) = (f.block(0, 0, Shape::square(n)), f.block(0, n, Shape::vector(n)));
                let z = turn(n, r);
                let wedge = Group::SpecialOrthogonal(n).wedge(z);
                graph.below(&[z, (d - wedge * d) / 2])
            }
            _ => {
                let increment = f - factor.group.identity(graph);
                // by construction: the coordinates of a group without a Cayley map are not read
                let z = cayley::of_increment(model, k, increment);
                z.map_or_else(|| graph.zero(Shape::vector(factor.group.dimension())), |(_, z)| z)
            }
        }
    };
    model.factors.iter().enumerate().map(of_factor).into_list()
}

/// The symbol of a leaf of the configuration at a place.
fn leaf_at<'g>(model: &Mechanics<'g>, place: usize, leaf: usize) -> Expr<'g> {
    let own = model.configurations[leaf].symbol;
    let name = format!("{}{place}", model.configurations[leaf].name);
    model.graph.symbol(&name, own.shape(), Role::At(place, leaf), own.property())
}

/// The symbol of a leaf at an end of an edge, by the name that its closure gives.
fn leaf_of_edge<'g>(model: &Mechanics<'g>, edge: &EdgeEnergy<'g>, end: usize, leaf: usize) -> Expr<'g> {
    let own = model.configurations[leaf].symbol;
    model.graph.symbol(&edge.names[end][leaf], own.shape(), Role::At(end, leaf), own.property())
}

/// ∂U at an end of an edge.
fn gradient<'g>(model: &Mechanics<'g>, edge: &EdgeEnergy<'g>, end: usize) -> Vec<Expr<'g>> {
    // |next − q|² of points on a sphere is 2 − 2 q·next, whose gradient has fewer terms
    let value = shorter(edge.value);
    indexed(model.configurations.len(), |leaf| value.gradient(leaf_of_edge(model, edge, end, leaf)))
}

/// −J(q, p) at a configuration q, for each factor.
fn push<'g>(system: &SystemFormulas<'g>, q: &[Expr<'g>], covector: Vec<Expr<'g>>) -> Vec<Expr<'g>> {
    let leaves = system.model.configurations.iter().map(|leaf| leaf.symbol);
    let places = leaves.zip(q.iter().copied()).into_list();
    let covectors = system.symbols.covectors.iter().copied().zip(covector).into_list();
    let push = |momentum: &Expr<'g>| -(momentum.substitute(&places).substitute(&covectors));
    system.momentum_map.each(push)
}

fn force_inside<'g>(model: &Mechanics<'g>, system: &SystemFormulas<'g>, field: &FieldEnergies<'g>) -> Vec<Expr<'g>> {
    let leaves = 0..model.configurations.len();
    let own: Vec<_> =
        leaves.clone().map(|leaf| (model.configurations[leaf].symbol, leaf_at(model, 0, leaf))).into_list();
    let mut sum: Vec<Expr<'g>> = match field.potential {
        Some(potential) => system.gradients(potential).into_each(|slope| slope.substitute(&own)),
        None => model.configurations.each(|leaf| model.graph.zero(leaf.shape)),
    };
    for (direction, edge) in field.edges.iter().enumerate() {
        // the site as the start of an edge, and as its end
        for (end, places) in [(0, [0, 1 + 2 * direction]), (1, [2 + 2 * direction, 0])] {
            let moved = leaves.clone().flat_map(|leaf| {
                [0, 1].map(|end| (leaf_of_edge(model, edge, end, leaf), leaf_at(model, places[end], leaf)))
            });
            let moved: Vec<_> = moved.into_list();
            for (sum, slope) in sum.iter_mut().zip(gradient(model, edge, end)) {
                *sum = *sum + slope.substitute(&moved);
            }
        }
    }
    push(system, &own.into_each(|(_, there)| there), sum)
}

/// The energies of a field as terms with their gradients, for the symmetries that all of them have.
pub(super) fn terms<'g>(model: &Mechanics<'g>) -> Vec<SiteTerm<'g>> {
    let Some(field) = &model.field else { return Vec::new() };
    let leaves = 0..model.configurations.len();
    let at = |edge: &EdgeEnergy<'g>| {
        let names = leaves
            .clone()
            .flat_map(|leaf| [0, 1].map(|end| (leaf_of_edge(model, edge, end, leaf), leaf_at(model, end, leaf))));
        // with the element and its coordinates put in
        let elements: Vec<_> =
            model.factors.iter().map(|factor| factor.symbol).zip(edge.element.iter().copied()).into_list();
        let mut value = edge.value;
        if !elements.is_empty() {
            let known = coordinates(model).into_iter().enumerate().flat_map(|(k, z)| {
                let y = (logarithm(model, k), stand_in(&model.factors[k], z));
                [(cayley::symbol(model, k), z), y]
            });
            value = value.substitute(&known.into_list()).substitute(&elements);
        }
        value.substitute(&names.into_list())
    };
    let own: Vec<_> =
        leaves.clone().map(|leaf| (model.configurations[leaf].symbol, leaf_at(model, 0, leaf))).into_list();
    let site = field.potential.map(|potential| potential.substitute(&own));
    let values = site.into_iter().chain(field.edges.iter().map(at));
    let terms: Vec<Term<'g>> = values.map(|value| Term { ranges: Vec::new(), value }).into_list();
    of_terms(model, 2, &terms)
}

/// A vector in place of log F that turns with F as it does: Cayley coordinates z times a number of the class of F. It has
/// no other relation to z. So an energy of it has the symmetries of that of log F.
fn stand_in<'g>(Factor { symbol: f, group, .. }: &Factor<'g>, z: Expr<'g>) -> Expr<'g> {
    if group.is_translation() || group == &Group::UnitQuaternions {
        return 2 * z;
    }
    (f.trace() + f.graph().integer(7)) * z
}

/// Vectors of several parts, expanded: their code may be shorter. `None` where that takes too much work.
pub fn expanded<'g>(vectors: &[&Vec<Expr<'g>>]) -> Option<Vec<Vec<Expr<'g>>>> {
    work::apart(EXPANSION, || vectors.each(|parts| parts.each(|part| part.expand()))).ok()
}
