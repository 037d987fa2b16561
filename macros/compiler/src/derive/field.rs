//! The energies of a field: the forces of an edge on both of its sites, and of all edges of a site together.
//!
//! U(q, q⁺) of an edge pushes its site by −J(q, ∂₁U) and its neighbour by −J(q⁺, ∂₂U). J is linear in the covector, so
//! the gradients of all edges of a site may be added first, and J taken once.

use clebsch_symbolic::{Elements, Expr, Group, IntoElements, IntoList, Role, Shape, indexed, work};

use super::formula::shorter;
use super::power::{SiteTerm, of_terms};
use super::{SystemFormulas, cayley, trivialisation};
use crate::model::{EdgeEnergy, Factor, FieldEnergies, Mechanics, Term};

/// The work to expand a force for code that may be shorter, at most.
const EXPANSION: u64 = 50_000;

/// The formulas of a field.
pub struct FieldFormulas<'g> {
    /// Those of the edges, one for each direction.
    pub edges: Vec<EdgeFormulas<'g>>,
    /// −J(q, ∂V) for each factor, a function of the configuration; none without a potential.
    pub force_of_site: Vec<Expr<'g>>,
    /// The force on a site that has a neighbour on both sides in each direction: from its potential and from all edges.
    /// The neighbour in direction d stands at the place 1 + 2d, and the site whose neighbour it is at 2 + 2d. `None` where an
    /// edge is of a group element.
    pub force_inside: Option<Vec<Expr<'g>>>,
}

/// The formulas of an edge.
pub struct EdgeFormulas<'g> {
    /// U.
    pub energy: Expr<'g>,
    /// −J(q, ∂₁U) for each factor.
    pub on_site: Vec<Expr<'g>>,
    /// −J(q⁺, ∂₂U) for each factor, with q⁺ of the neighbour.
    pub on_neighbour: Vec<Expr<'g>>,
    /// The group element that moves the site to the neighbour, for each factor. All three are functions of it then.
    pub element: Vec<Expr<'g>>,
    /// Its Cayley coordinates for each factor, a function of it; empty where none is read.
    pub coordinates: Vec<Expr<'g>>,
}

/// The formulas of the field of a model; `None` if it is none.
pub(super) fn of<'g>(model: &Mechanics<'g>, system: &SystemFormulas<'g>) -> Option<FieldFormulas<'g>> {
    let field = model.field.as_ref()?;
    let force_of_site = field.potential.and_then(|potential| system.impulse(potential)).unwrap_or_default();
    let there = |edge: &EdgeEnergy<'g>, end: usize| -> Vec<Expr<'g>> {
        indexed(model.configurations.len(), |leaf| leaf_of_edge(model, edge, end, leaf))
    };
    let edges = field.edges.each(|edge| {
        if !edge.element.is_empty() {
            return of_element(model, edge);
        }
        let [on_site, on_neighbour] = [0, 1].map(|end| push(system, &there(edge, end), gradient(model, edge, end)));
        EdgeFormulas { energy: edge.value, on_site, on_neighbour, element: Vec::new(), coordinates: Vec::new() }
    });
    Some(FieldFormulas {
        edges,
        force_of_site: force_of_site.into_each(|force| -force),
        force_inside: field
            .edges
            .iter()
            .all(|edge| edge.element.is_empty())
            .then(|| force_inside(model, system, field)),
    })
}

/// The formulas of an edge whose energy is a function κ(F) of a group element. Its forces are the two trivialisations of ∂κ. For a
/// right action they are T*_id R_F ∂κ and −T*_id L_F ∂κ.
fn of_element<'g>(model: &Mechanics<'g>, edge: &EdgeEnergy<'g>) -> EdgeFormulas<'g> {
    let (before, after) = trivialisation::of_all(model, edge.value);
    let on_site = trivialisation::components(model, &before);
    let on_neighbour = trivialisation::components(model, &after).into_each(|force| -force);
    let reads = |k: usize| edge.value.depends_on(cayley::symbol(model, k));
    let coordinates = if (0..model.factors.len()).any(reads) { coordinates(model) } else { Vec::new() };
    EdgeFormulas { energy: edge.value, on_site, on_neighbour, element: edge.element.clone(), coordinates }
}

/// (F − I)(F + I)⁻¹ of each factor, in coordinates.
fn coordinates<'g>(model: &Mechanics<'g>) -> Vec<Expr<'g>> {
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
            let known = (0..model.factors.len()).map(|k| cayley::symbol(model, k)).zip(coordinates(model));
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

/// Vectors of several parts, expanded: their code may be shorter. `None` where that takes too much work.
pub fn expanded<'g>(vectors: &[&Vec<Expr<'g>>]) -> Option<Vec<Vec<Expr<'g>>>> {
    work::apart(EXPANSION, || vectors.each(|parts| parts.each(|part| part.expand()))).ok()
}
