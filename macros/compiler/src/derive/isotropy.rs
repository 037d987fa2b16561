//! The vertical term: a kinetic energy for motions that leave the configuration unchanged, where the declared one gives them none.
//!
//! The isotropy algebra 𝔤_q = {ξ : ξ_Q(q) = 0} holds these motions. A cost that depends on F through Φ_F(q) alone is a
//! function of q and q⁺. Its Hessian vanishes on 𝔤_q, so its momentum equation determines q⁺ and leaves F open.
//!
//! The term W is quadratic in the component of the motion along 𝔤_q, its vertical part. Momenta lie in 𝔤_q^⊥, so the
//! equation with W has a solution without vertical part. W vanishes there with its derivative. Therefore q moves as by
//! the declared cost.

mod projection;
mod scale;
mod sections;

use clebsch_symbolic::{Elements, Expr, IntoList, Shape, identity};

use super::symbols::{at_zero, identities, of_columns};
use super::{Energy, SystemFormulas, energy, structure, trivialisation, velocity};
use crate::model::{Discretization, Isotropy, Kinetic, Mechanics};

/// The vertical term, and the kinetic part with it.
pub struct Vertical<'g> {
    /// W(h, q, F) of a cost, W(q, ξ) of a Lagrangian.
    pub term: Expr<'g>,
    /// The cost, or the Lagrangian, with it.
    pub filled: Expr<'g>,
    /// The factors whose isotropy it serves, by index.
    pub factors: Vec<usize>,
}

/// The vertical term. `None` where the declared kinetic energy is regular, and where it depends on motions along 𝔤_q.
pub(super) fn vertical<'g>(
    model: &Mechanics<'g>,
    system: &SystemFormulas<'g>,
    energy: &Energy<'g>,
) -> Option<Vertical<'g>> {
    let inertia = energy::inertia(&system.symbols, energy.kinetic);
    if model.isotropy != Isotropy::Fixed || energy::is_regular(inertia) || system.is_free() {
        return None;
    }
    let parts: Vec<Part<'_, 'g>> = parts(model, system, energy.kinetic, inertia);
    let parts: Vec<_> = parts.into_iter().filter(|part| is_left_open_along(model, &part.factors, part.map)).into_list();
    if parts.is_empty() {
        return None;
    }
    let (declared, terms): (Expr<'g>, Vec<Term<'g>>) = match &model.kinetic {
        Kinetic::Cost(cost) => (*cost, parts.iter().map(Part::of_cost).into_list()),
        Kinetic::Lagrangian { energy, velocities, .. } => {
            (*energy, parts.iter().map(|part| part.of_lagrangian(velocities)).into_list())
        }
    };
    let factors = parts.iter().flat_map(|part| part.factors.iter().copied()).into_list();
    let total = |of: fn(&Term<'g>) -> Expr<'g>| model.graph.total(Shape::scalar(), terms.iter().map(of));
    let (motion, displacement) = (total(|term| term.motion), total(|term| term.displacement));
    let is_quadratic = energy.general.is_none();
    let remainder = simplified(model, system, &factors, declared - displacement, is_quadratic);
    Some(Vertical { term: motion - displacement, filled: motion + remainder, factors })
}

impl<'g> Vertical<'g> {
    /// Gives the model the kinetic part with W.
    pub(super) fn fill(&self, model: &mut Mechanics<'g>) {
        match &mut model.kinetic {
            Kinetic::Cost(energy) | Kinetic::Lagrangian { energy, .. } => *energy = self.filled,
        }
    }
}

/// Whether the declared kinetic part depends on no motion along 𝔤_q.
pub(super) fn is_left_open<'g>(model: &Mechanics<'g>, system: &SystemFormulas<'g>) -> bool {
    let all = (0..model.factors.len()).into_list();
    is_left_open_along(model, &all, system.matrix_of_generator())
}

/// The same for some factors, with the matrix of their ξ ↦ ξ_Q(q). Its rows span 𝔤_q^⊥, in which T* ∂_F K of a cost and
/// ∂ℓ/∂ξ of a Lagrangian have to lie.
fn is_left_open_along<'g>(model: &Mechanics<'g>, factors: &[usize], map: Expr<'g>) -> bool {
    let momenta: Vec<Expr<'g>> = match &model.kinetic {
        Kinetic::Cost(cost) => trivialisation::components(model, &trivialisation::of_all(model, *cost).0),
        Kinetic::Lagrangian { energy, velocities, .. } => velocities.each(|xi| energy.gradient(*xi)),
    };
    let own: Vec<_> = factors.each(|&k| momenta[k]);
    let both = model.graph.below(&[map, model.graph.below(&own).transpose()]);
    identity::rank(both) == identity::rank(map)
}

/// W as a difference of two kinetic energies: of the motion of the group, and of the displacement of the configuration.
struct Term<'g> {
    motion: Expr<'g>,
    displacement: Expr<'g>,
}

/// Factors that move common leaves, and the vertical form of these.
struct Part<'a, 'g> {
    model: &'a Mechanics<'g>,
    system: &'a SystemFormulas<'g>,
    factors: Vec<usize>,
    /// The leaves that they move.
    leaves: Vec<usize>,
    /// The matrix of ξ ↦ ξ_Q(q).
    map: Expr<'g>,
    form: Form<'g>,
    /// κ, the scale of W: a mass of the declared kinetic energy.
    scale: Expr<'g>,
}

/// The quadratic form V of rank dim 𝔤_q that is positive on 𝔤_q, with W = ½ κ ξ·Vξ for ξ of first order.
enum Form<'g> {
    /// c − A + eA² of A: ξ ↦ J(q, ξ_Q(q)), c times the orthogonal projection to 𝔤_q. On a sphere the leaf is a vector that
    /// SO(n) turns.
    Difference { weight: Expr<'g>, square: Option<Expr<'g>>, sphere: Option<usize> },
    /// A diagonal matrix, in the components of the factors.
    Diagonal(Expr<'g>),
    /// ξ·Vξ = u·Cu of u = Aᵀξ, with sections A of 𝔤_q lowered by an inner product, and a weight C.
    Sections { along: Expr<'g>, weight: Expr<'g> },
}

/// The sets of factors that move common leaves, with a vertical form.
fn parts<'a, 'g>(
    model: &'a Mechanics<'g>,
    system: &'a SystemFormulas<'g>,
    kinetic: Expr<'g>,
    inertia: Expr<'g>,
) -> Vec<Part<'a, 'g>> {
    let moves = |k: usize, leaf: &Expr<'g>| leaf.depends_on(system.symbols.algebra[k]);
    let share = |i: usize, j: usize| system.generator.iter().any(|leaf| moves(i, leaf) && moves(j, leaf));
    let columns = system.generator_columns();
    let mut parts = Vec::new();
    for factors in structure::connected(model.factors.len(), share) {
        let leaves = (0..model.configurations.len())
            .filter(|&leaf| factors.iter().any(|&k| moves(k, &system.generator[leaf])))
            .into_list();
        let components: Vec<usize> = factors.iter().flat_map(|&k| model.offset(k)..model.offset(k + 1)).into_list();
        if leaves.is_empty() {
            continue;
        }
        let columns: Vec<Vec<Expr<'g>>> = components.each(|&j| columns[j].clone());
        let map = of_columns(model.graph, &columns);
        let own =
            Own { model, inertia, factors: &factors, leaves: &leaves, components: &components, columns: &columns, map };
        if let Some((form, scale)) = own.form(system, kinetic) {
            parts.push(Part { model, system, factors, leaves, map, form, scale });
        }
    }
    parts
}

/// A set of factors before its form is known.
struct Own<'a, 'g> {
    model: &'a Mechanics<'g>,
    inertia: Expr<'g>,
    factors: &'a [usize],
    leaves: &'a [usize],
    components: &'a [usize],
    columns: &'a [Vec<Expr<'g>>],
    map: Expr<'g>,
}

impl<'g> Own<'_, 'g> {
    /// V and κ. `None` where no motion leaves the leaves unchanged, and where no short form is known.
    fn form(&self, system: &SystemFormulas<'g>, kinetic: Expr<'g>) -> Option<(Form<'g>, Expr<'g>)> {
        if let Some((leaf, weight)) = self.sphere() {
            let rank = self.model.configurations[leaf].shape.rows as i64 - 1;
            let scale = self.scale_on_sphere(rank * weight, rank * (rank + 1));
            return Some((Form::Difference { weight, square: None, sphere: Some(leaf) }, scale));
        }
        let (count, rank) = (self.columns.len(), identity::rank(self.map));
        if rank == count {
            return None;
        }
        // motions that move all configurations alike, as translations do
        let is_constant = |j: usize| !self.columns[j].iter().any(|entry| self.model.reads_configuration(*entry));
        let of_factor = |k: usize| {
            let range = self.model.offset(k)..self.model.offset(k + 1);
            self.without(|j| range.contains(&self.components[j]), rank)
        };
        let constant = self.without(is_constant, rank).or_else(|| self.factors.iter().find_map(|&k| of_factor(k)));
        let by_sections = || Some((sections::form(self, system, kinetic)?, self.scale_at_points(rank)));
        constant.or_else(|| self.difference(rank)).or_else(by_sections)
    }

    /// The form |ξ_J|² of all components but some that move the leaves in all directions by themselves.
    fn without(&self, moving: impl Fn(usize) -> bool, rank: usize) -> Option<(Form<'g>, Expr<'g>)> {
        let (graph, columns) = (self.model.graph, self.columns);
        let own: Vec<_> = (0..columns.len()).filter(|j| moving(*j)).map(|j| columns[j].clone()).into_list();
        if own.len() != rank || rank == 0 || identity::rank(of_columns(graph, &own)) != rank {
            return None;
        }
        let entries = (0..columns.len()).map(|j| graph.integer(if moving(j) { 0 } else { 1 })).into_list();
        let form = graph.stack(Shape::vector(columns.len()), entries).diagonal_matrix();
        Some((Form::Diagonal(form), self.inertia_along(moving) / rank as i64))
    }

    /// The trace of Σ over some of the components.
    fn inertia_along(&self, takes: impl Fn(usize) -> bool) -> Expr<'g> {
        let entries = self.components.iter().enumerate().filter(|(j, _)| takes(*j));
        let trace = self.model.graph.total(Shape::scalar(), entries.map(|(_, &j)| self.inertia.entry(j, j)));
        trace.expand()
    }
}

impl<'g> Part<'_, 'g> {
    /// W(q, ξ) = ½ κ ξ·Vξ.
    fn of_lagrangian(&self, velocities: &[Expr<'g>]) -> Term<'g> {
        self.of_motion(velocities, self.scale / 2)
    }

    /// W(h, q, F) = κ/(2h) w·V(q)w of w = P(F − I). For points on spheres it is κ/(4h) (|F − I|² − 2|Φ_F(q) − q|²). The
    /// chord of the point adds up with that to the chord of the rotation. For projectors it is κ/(2h) (c|w|² − |Φ_F(q) − q|²), whose chord
    /// adds up with that of the cost to |w|² alone.
    fn of_cost(&self) -> Term<'g> {
        let (model, graph) = (self.model, self.model.graph);
        let scale = self.scale / (2 * model.step_size);
        if let Form::Difference { weight, sphere: Some(leaf), .. } = self.form {
            let (f, n) = (model.factors[self.factors[0]].symbol, model.configurations[leaf].shape.rows);
            return Term {
                motion: scale * weight * (f - graph.identity(n)).norm_squared() / 2,
                displacement: scale * self.chord(),
            };
        }
        let of_factor = |k: usize| velocity::of_element(model, k, graph.integer(1), Discretization::Projection);
        let motions = (0..model.factors.len()).map(of_factor).into_list();
        let term = self.of_motion(&motions, scale);
        let by_chord = Term { motion: term.motion, displacement: scale * self.chord() };
        if self.vanishes_on_reflections(&by_chord) { by_chord } else { term }
    }

    /// |Φ_F(q) − q|².
    fn chord(&self) -> Expr<'g> {
        let moved = |&leaf: &usize| self.model.action[leaf] - self.model.configurations[leaf].symbol;
        self.model.graph.total(Shape::scalar(), self.leaves.iter().map(|leaf| moved(leaf).norm_squared()))
    }

    /// The components of these factors, one below the other.
    fn own(&self, xi: &[Expr<'g>]) -> Expr<'g> {
        self.model.graph.below(&self.factors.each(|&k| xi[k]))
    }

    fn of_motion(&self, motions: &[Expr<'g>], scale: Expr<'g>) -> Term<'g> {
        let graph = self.model.graph;
        let own = |k: usize, motion: &Expr<'g>| {
            if self.factors.contains(&k) { *motion } else { graph.zero(motion.shape()) }
        };
        let motions: Vec<_> = motions.iter().enumerate().map(|(k, motion)| own(k, motion)).into_list();
        let sum = |terms: &[Expr<'g>]| graph.total(Shape::scalar(), terms.iter().copied());
        match self.form {
            Form::Difference { weight, square, .. } => {
                let norm = |parts: &[Expr<'g>]| sum(&parts.each(|part| part.norm_squared()));
                let displacement = self.system.motion_by(&motions);
                let images = square.map(|square| square * norm(&self.system.momenta_of(displacement.clone())));
                let motion = weight * norm(&motions) + images.unwrap_or(graph.integer(0));
                Term { motion: scale * motion, displacement: scale * norm(&displacement) }
            }
            Form::Diagonal(matrix) => {
                let own = self.own(&motions);
                Term { motion: scale * own.dot(matrix * own), displacement: graph.integer(0) }
            }
            Form::Sections { along, weight } => {
                let along = along.transpose() * self.own(&motions);
                Term { motion: scale * along.dot(weight * along), displacement: graph.integer(0) }
            }
        }
    }
}

/// A kinetic part without the displacements of some factors. It is free of factors that it does not depend on, and in
/// products of displacements where it couples them.
fn simplified<'g>(
    model: &Mechanics<'g>,
    system: &SystemFormulas<'g>,
    factors: &[usize],
    remainder: Expr<'g>,
    is_quadratic: bool,
) -> Expr<'g> {
    let rest: Vec<(Expr<'g>, Expr<'g>)> = match &model.kinetic {
        Kinetic::Cost(_) => identities(model),
        Kinetic::Lagrangian { velocities, .. } => at_zero(velocities.iter().copied()),
    };
    let mut remainder = remainder;
    for &k in factors {
        let still = remainder.substitute(&[rest[k]]);
        if identity::equal(&[still], &[remainder]) {
            remainder = still;
        }
    }
    if identity::vanishes(remainder) {
        return model.graph.integer(0);
    }
    let couples = factors.iter().any(|&k| remainder.depends_on(rest[k].0));
    if !couples || !is_quadratic {
        return remainder;
    }
    if !matches!(model.kinetic, Kinetic::Cost(_)) {
        return remainder.expand();
    }
    let elements = |k: usize| (model.factors[k].symbol, model.factors[k].group.identity(model.graph));
    let increments = &system.symbols.increments;
    let later: Vec<_> = factors.each(|&k| (elements(k).0, elements(k).1 + increments[k]));
    let back: Vec<_> = factors.each(|&k| (increments[k], elements(k).0 - elements(k).1));
    remainder.substitute(&later).expand().substitute(&back)
}
