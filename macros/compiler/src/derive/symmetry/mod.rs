//! Conserved momenta: the directions along which cost and potential are invariant for every value of the parameters.
//!
//! A direction moves the configuration by δq and the group element by δF so that q⁺ moves with them. Directions of the
//! group itself are q ↦ Φ_g q with F ↦ gFg⁻¹. Those that commute with the action are q ↦ gq or qg with F as it is. The
//! user may offer others. Invariance is linear in the direction, so all invariant directions together, diagonals of
//! equal factors among them, are one null space. The momentum of a direction w is ⟨p, δq⟩ = ⟨N, ξ⟩ with ξ_Q(q) = δq.

mod directions;
mod large;
mod special;

use clebsch_symbolic::{Elements, Expr, Group, IntoElements, IntoList, Rational, Shape, identity, indexed};

use super::equation::Sources;
use super::power::{self, SiteTerm};
use super::symbols::{moved, of_columns};
use super::{ConstraintFormulas, DiscreteLagrangian, MechanicsFormulas, Substep, naming};
use crate::model::{Isotropy, Mechanics, is_large};
use directions::Directions;

/// A conserved momentum.
#[derive(Clone)]
pub struct ConservedMomentum<'g> {
    /// Its name, such as `about e3, spatial`.
    pub name: String,
    /// Its value, a function of q and μ.
    pub value: Expr<'g>,
}

/// The known symmetries of a system.
#[derive(Default)]
pub struct Symmetries<'g> {
    /// The momenta that are conserved for every value of the parameters.
    pub conserved: Vec<ConservedMomentum<'g>>,
    /// The momenta that are also conserved for special parameters, as sentences.
    pub special: Vec<String>,
    /// Offered symmetries that are none, by the index of the offer.
    pub refused: Vec<usize>,
    /// Whether functions that are not rational may hide further conserved momenta.
    pub undecided: bool,
}

/// A direction in which a system may be moved.
struct Direction<'g> {
    /// Where it comes from, for its name.
    family: usize,
    /// The index among the directions of its family.
    index: usize,
    /// The motion of each leaf of the configuration.
    leaves: Vec<Expr<'g>>,
    /// The motion of each factor's element.
    factors: Vec<Expr<'g>>,
    /// The motion of the coordinates of each log F; `None` where it is not known.
    logarithms: Option<Vec<Expr<'g>>>,
    /// ⟨N, ξ⟩, the momentum of the direction.
    momentum: Expr<'g>,
}

/// Directions of one kind: those of a factor, of a commuting side of a leaf, or of an offered group.
struct Family {
    group: Group,
    /// `of F`, where there are several.
    of: String,
    frame: &'static str,
    /// The offered symmetry that it comes from.
    offered: Option<usize>,
}

pub(super) fn find<'g>(
    sources: &Sources<'_, 'g>,
    lagrangian: &DiscreteLagrangian<'g>,
    (force, constraint): (Option<&[Expr<'g>]>, Option<&ConstraintFormulas<'g>>),
    links: &[SiteTerm<'g>],
) -> Symmetries<'g> {
    let model = sources.model;
    if model.factors.iter().any(|factor| is_large(factor.group, &model.configurations)) {
        return large::find(sources, lagrangian);
    }
    let Directions { families, all: directions, .. } = Directions::of(model, sources.system);
    if directions.is_empty() {
        return Symmetries::default();
    }
    let places = constraint.map_or_else(|| places_of_joints(model), |constraint| places(model, constraint));
    let matrix = variations(sources, lagrangian, (&directions, &places), (force, constraint), links);
    // the weights of places come first, so that each vector of the basis has a direction of its own
    let found = identity::null_space(matrix).into_each(|vector| vector[places.len()..].to_vec());
    let finder = Finder { sources, families, directions, matrix, places };
    let mut symmetries = Symmetries {
        conserved: finder.momenta(&found),
        special: finder.special(&found),
        refused: finder.refused(&found),
        undecided: found.len() < finder.directions.len() && matrix.has_functions(),
    };
    symmetries.conserved.extend(finder.along_parameters(&found));
    if model.isotropy == Isotropy::Free {
        symmetries.conserved.extend(finder.isotropy());
    }
    symmetries
}

/// A column of a constraint on places: φ_j times any number may be added to the row of an equation.
#[derive(Copy, Clone)]
struct Place<'g> {
    /// The number of the row.
    row: usize,
    /// φ_j.
    value: Expr<'g>,
}

/// The most equations of places that may mix where they move. In a longer constraint those of one vector mix alone.
const MIXED: usize = 12;

/// The places that the change of each equation may be a combination of. Joints of vectors turn with the bodies that they join.
fn places<'g>(model: &Mechanics<'g>, constraint: &ConstraintFormulas<'g>) -> Vec<Place<'g>> {
    let (Some(places), Some(declared)) = (&constraint.places, &model.constraint) else { return Vec::new() };
    let count = places.value.shape().rows;
    let (mut all, mut first) = (Vec::new(), 0);
    for equation in declared.equations.iter().filter(|equation| !equation.is_of_velocities) {
        let own = first..first + equation.count;
        let others = if count <= MIXED { 0..count } else { own.clone() };
        for row in own {
            all.extend(others.clone().map(|j| Place { row, value: places.value.entry(j, 0) }));
        }
        first += equation.count;
    }
    all
}

/// The same of the joints of a power, whose entries are the first of the terms: those of one joint mix.
fn places_of_joints<'g>(model: &Mechanics<'g>) -> Vec<Place<'g>> {
    let joints = model.power.iter().flat_map(|power| &power.joints).flat_map(|joints| &joints.all);
    let (mut all, mut first) = (Vec::new(), 0);
    for joint in joints {
        for row in first..first + joint.count() {
            all.extend((0..joint.count()).map(|j| Place { row, value: joint.term.value.entry(j, 0) }));
        }
        first += joint.count();
    }
    all
}

/// One column for each direction, with four kinds of rows. The variations of K, U₀ and U₁ all vanish along a symmetry.
/// ⟨f, ξ⟩ is the change of its momentum by the force. A ξ = 0 says that a constraint does not change it. The last rows are the
/// variations of each term of a power where all sites move alike.
///
/// The first columns are those of places. On a constraint φ = 0 it is enough that A ξ = C φ with constant numbers C. A
/// step changes the momentum by λᵀA ξ at its ends, where φ = 0.
fn variations<'g>(
    sources: &Sources<'_, 'g>,
    lagrangian: &DiscreteLagrangian<'g>,
    (directions, places): (&[Direction<'g>], &[Place<'g>]),
    (force, constraint): (Option<&[Expr<'g>]>, Option<&ConstraintFormulas<'g>>),
    links: &[SiteTerm<'g>],
) -> Expr<'g> {
    let (model, graph) = (sources.model, sources.model.graph);
    let parts = [lagrangian.kinetic, lagrangian.start, lagrangian.end];
    let logarithms: Vec<Expr<'g>> = sources.symbols.logarithms.each(|y| lagrangian.kinetic.gradient(*y));
    let gradients = parts.map(|part| -> (Vec<Expr<'g>>, Vec<Expr<'g>>) {
        let factors = model.factors.iter().map(|factor| part.gradient(factor.symbol));
        (sources.gradients(part), factors.into_list())
    });
    let pairing = |gradients: &[Expr<'g>], motions: &[Expr<'g>]| {
        graph.total(Shape::scalar(), gradients.iter().zip(motions).map(|(gradient, motion)| gradient.pairing(*motion)))
    };
    let momenta = sources.symbols.momenta.iter().copied();
    let impulse: Vec<_> = momenta.zip(force.unwrap_or_default().iter().copied()).into_list();
    let rows = constraint.map_or_else(Vec::new, |constraint| along_rows(sources, constraint));
    let column = |direction: &Direction<'g>| -> Vec<Expr<'g>> {
        let mut column = Vec::new();
        for (part, (leaves, factors)) in gradients.iter().enumerate() {
            let moved = pairing(leaves, &direction.leaves) + pairing(factors, &direction.factors);
            column.push(match &direction.logarithms {
                _ if part > 0 || logarithms.iter().all(|gradient| gradient.is_zero()) => moved,
                Some(motions) => moved + pairing(&logarithms, motions),
                // a motion of log F that is not known is taken for a change
                None => graph.integer(1),
            });
        }
        column.extend(force.map(|_| direction.momentum.substitute(&impulse)));
        column.extend(rows.iter().map(|row| direction.momentum.substitute(row)));
        column.extend(power::moved(model, links, &direction.leaves));
        column
    };
    let before = gradients.len() + usize::from(force.is_some());
    let height = before + rows.len() + links.len();
    let of_place = |place: &Place<'g>| -> Vec<Expr<'g>> {
        indexed(height, |row| if row == before + place.row { place.value } else { graph.integer(0) })
    };
    of_columns(graph, &places.iter().map(of_place).chain(directions.iter().map(column)).into_list())
}

/// For each row of a constraint its components in place of the momentum, so that ⟨N, ξ⟩ becomes the entry of A ξ.
fn along_rows<'g>(sources: &Sources<'_, 'g>, constraint: &ConstraintFormulas<'g>) -> Vec<Vec<(Expr<'g>, Expr<'g>)>> {
    let Shape { rows, columns } = constraint.rows.shape();
    let momenta = &sources.symbols.momenta;
    indexed(rows, |i| {
        let row = constraint.rows.block(i, 0, Shape::new(1, columns)).transpose();
        momenta.iter().copied().zip(sources.system.parted(row)).into_list()
    })
}

/// Everything that names and checks directions.
struct Finder<'a, 'g> {
    sources: &'a Sources<'a, 'g>,
    families: Vec<Family>,
    directions: Vec<Direction<'g>>,
    /// A column for each place, and then for each direction.
    matrix: Expr<'g>,
    places: Vec<Place<'g>>,
}

impl<'g> Finder<'_, 'g> {
    fn momenta(&self, found: &[Vec<Rational>]) -> Vec<ConservedMomentum<'g>> {
        let mut momenta: Vec<ConservedMomentum<'g>> = Vec::new();
        for combination in found {
            let value = self.combined(combination, Shape::scalar(), |direction| direction.momentum);
            // a motion that fixes every q has no momentum, and two ways to move q alike have the same
            let known = |value: Expr<'g>| momenta.iter().any(|other| identity::equal(&[other.value], &[value]));
            if !identity::vanishes(value) && !known(value) && !self.is_isotropy(combination) {
                momenta.push(ConservedMomentum { name: self.name(combination), value });
            }
        }
        momenta
    }

    /// Σ w_i v_i of values of the directions.
    fn combined(&self, combination: &[Rational], shape: Shape, value: impl Fn(&Direction<'g>) -> Expr<'g>) -> Expr<'g> {
        let graph = self.sources.model.graph;
        let terms = self.directions.iter().zip(combination).filter(|(_, weight)| !weight.is_zero());
        graph.total(shape, terms.map(|(direction, weight)| graph.number(weight.clone()) * value(direction)))
    }

    /// Whether the combination moves no configuration, so that its momentum is zero for every state that is one of q.
    fn is_isotropy(&self, combination: &[Rational]) -> bool {
        let model = self.sources.model;
        let leaf = |j: usize| self.combined(combination, model.configurations[j].shape, |of| of.leaves[j]);
        model.isotropy == Isotropy::Fixed
            && model.factors.iter().all(|factor| factor.moves)
            && (0..model.configurations.len()).all(|j| identity::vanishes(leaf(j)))
    }

    /// `about e3, spatial`.
    fn name(&self, combination: &[Rational]) -> String {
        let mut parts: Vec<(String, String)> = Vec::new();
        let mut frames: Vec<&str> = Vec::new();
        for (index, family) in self.families.iter().enumerate() {
            let mut weights = vec![Rational::zero(); family.group.dimension()];
            let members = self.directions.iter().zip(combination);
            for (direction, weight) in members.filter(|(direction, _)| direction.family == index) {
                weights[direction.index] = weight.clone();
            }
            if !weights.iter().all(Rational::is_zero) {
                parts.push((naming::combination(self.sources.model, family.group, &weights), family.of.clone()));
                frames.push(family.frame);
            }
        }
        frames.dedup();
        let frames = frames.join(" and ");
        // a diagonal of all factors has one name
        let is_diagonal = parts.len() > 1 && parts.iter().all(|(words, _)| *words == parts[0].0);
        if is_diagonal && parts.len() == self.sources.model.factors.len() {
            return format!("{} of all factors, {frames}", parts[0].0);
        }
        let parts: Vec<String> = parts.into_each(|(words, of)| words + &of);
        format!("{}, {frames}", parts.join(" + "))
    }

    /// The offered symmetries that have a direction that is no symmetry.
    fn refused(&self, found: &[Vec<Rational>]) -> Vec<usize> {
        let is_whole = |offer: usize| {
            let is_of_offer = |i: usize| self.families[self.directions[i].family].offered == Some(offer);
            let held = (0..self.directions.len()).filter(|&i| is_of_offer(i) && holds(found, i));
            held.count() == self.sources.model.symmetries[offer].group.dimension()
        };
        (0..self.sources.model.symmetries.len()).filter(|&offer| !is_whole(offer)).into_list()
    }
}

impl<'g> MechanicsFormulas<'g> {
    /// The conserved momenta that every F conserves, whether or not it solves the momentum equation. They have the same
    /// value at (Φ_F q, M⁺) as at (q, M) if M⁺ is computed from M. Kicks leave them as they are.
    pub(in crate::derive) fn conserved_by_any_element(&self) -> Vec<&ConservedMomentum<'g>> {
        let substeps = || self.substeps.iter().take(self.stepped);
        if substeps().any(|substep| substep.coupling.is_some()) {
            return Vec::new();
        }
        let move_of = |substep: &Substep<'g>| -> Vec<(Expr<'g>, Expr<'g>)> {
            let momenta = self.symbols.momenta.iter().enumerate().filter(|(k, _)| !substep.unchanged[*k]);
            moved(&self.model).into_iter().chain(momenta.map(|(k, mu)| (*mu, self.carried(k, *mu)))).into_list()
        };
        let moves: Vec<_> = substeps().map(move_of).into_list();
        let stays = |momentum: &&ConservedMomentum<'g>| {
            moves.iter().all(|moved| identity::equal(&[momentum.value.substitute(moved)], &[momentum.value]))
        };
        self.symmetries.conserved.iter().filter(stays).into_list()
    }
}

/// Whether the direction of a position is among the symmetries by itself.
fn holds(found: &[Vec<Rational>], position: usize) -> bool {
    found.iter().any(|w| w.iter().enumerate().all(|(i, weight)| weight.is_zero() != (i == position)))
}
