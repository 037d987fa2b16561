//! The error for a degenerate kinetic energy, whose Σ is singular.

use clebsch_symbolic::{Elements, Expr, Group, IntoList, Shape, identity};

use super::symbols::of_columns;
use super::{SystemFormulas, isotropy, naming};
use crate::diagnostic::{Diagnostic, error};
use crate::model::{Configuration, Isotropy, Kinetic, LeafSpace, Mechanics, spelled};

/// The error for a singular Σ. It names the motions without kinetic energy by their directions, by the points that they
/// leave unchanged, or by their factors.
pub(super) fn error<'g>(model: &Mechanics<'g>, system: &SystemFormulas<'g>, inertia: Expr<'g>) -> Diagnostic {
    Degenerate { model, system, inertia, rank: identity::rank(inertia) }.error()
}

struct Degenerate<'a, 'g> {
    model: &'a Mechanics<'g>,
    system: &'a SystemFormulas<'g>,
    inertia: Expr<'g>,
    rank: usize,
}

impl<'g> Degenerate<'_, 'g> {
    fn error(&self) -> Diagnostic {
        if let Some(points) = self.points() {
            return self.of_isotropy(&points);
        }
        let (place, key) = (self.model.spans.kinetic.place, self.key());
        let directions = self.directions();
        let factors = self.factors();
        let names: Vec<_> = factors.each(|&k| self.model.factors[k].name.clone());
        let listed = names.each(|name| format!("`{name}`")).join(" and ");
        let alone = self.alone(&factors);
        let (rank, dimension) = (self.rank, self.inertia.shape().rows);
        let (message, note) = if !directions.is_empty() {
            (
                format!("does not depend on {}", directions.join(" and ")),
                format!("its Hessian at the identity has rank {rank} of {dimension}"),
            )
        } else if let Some(&k) = alone.first() {
            let (name, count) = (&self.model.factors[k].name, self.model.factors[k].group.dimension());
            let rank = identity::rank(self.columns(|j| self.is_of(k, j)));
            (
                format!("does not fix `{name}`"),
                format!("its Hessian in `{name}` has rank {rank} of {count} at the identity"),
            )
        } else {
            (
                format!("gives some motions of {listed} together no kinetic energy"),
                format!("its Hessian at the identity has rank {rank} of {dimension}"),
            )
        };
        let lacking = if alone.is_empty() { &factors } else { &alone };
        let term = lacking.last().map_or_else(String::new, |&k| self.term(k));
        error!(place, "the {key} {message}";
            help "write the kinetic energy of each motion, as in `… + {term}` with the inertia that the system has";
            note "{note}, so the momentum does not determine the velocity of {listed}")
    }

    /// The error where motions without kinetic energy leave the configuration unchanged.
    fn of_isotropy(&self, points: &[String]) -> Diagnostic {
        let (place, key) = (self.model.spans.kinetic.place, self.key());
        let listed = points.each(|name| format!("`{name}`")).join(", ");
        let (rank, dimension) = (self.rank, self.inertia.shape().rows);
        let of = if dimension == rank + 1 { "a motion that leaves" } else { "motions that leave" };
        let error = error!(place, "the {key} gives no kinetic energy to {of} {listed} unchanged");
        let error = if self.model.isotropy == Isotropy::Free {
            let term = self.factors().last().map_or_else(String::new, |&k| self.term(k));
            error
                .help("leave out `isotropy = free`, if such motions are no motions of the body")
                .help(format_args!("or write their kinetic energy, as in `… + {term}`"))
        } else if isotropy::is_left_open(self.model, self.system) {
            error
                .maybe_help(self.symmetric_matrix())
                .help("let a smaller group act, which has no such motions and moves the configuration in as many directions")
                .note("their velocity is arbitrary here, and no vertical term is known for this action that sets it to 0")
        } else {
            error
                .help(format_args!("write the {key} in terms of {} alone", self.displacement()))
                .note(format_args!("the {key} depends on such motions, but not to second order"))
        };
        error.note(format_args!("its Hessian at the identity has rank {rank} of {dimension}"))
    }

    /// The advice for a square matrix that moves as symmetric ones do.
    fn symmetric_matrix(&self) -> Option<String> {
        let model = self.model;
        let is_moved = |leaf: &Configuration<'g>, image: Expr<'g>| {
            let (q, is_plain) = (leaf.symbol, leaf.space == LeafSpace::Vectors && leaf.shape.is_square());
            let moved = |f: Expr<'g>| f.shape() == leaf.shape && identity::equal(&[image], &[f * q * f.transpose()]);
            let by = |f: Expr<'g>| moved(f) || moved(f.transpose());
            is_plain && !leaf.shape.is_scalar() && model.factors.iter().any(|factor| by(factor.symbol))
        };
        let leaves = || model.configurations.iter().zip(&model.action);
        let (leaf, _) = leaves().find(|(leaf, image)| is_moved(leaf, **image))?;
        let (name, shape) = (&leaf.name, spelled(leaf.shape));
        Some(format!("write `{name}: Symmetric<{shape}>` if `{name}` is symmetric, as covariances are"))
    }

    /// The displacement, or the velocity, of the configuration as the user writes it.
    fn displacement(&self) -> String {
        match &self.model.kinetic {
            Kinetic::Cost(_) => format!("`{}` and its old value", self.model.spans.action.text),
            Kinetic::Lagrangian { name, .. } => format!("the velocity that `{name}` gives the configuration"),
        }
    }

    fn key(&self) -> &'static str {
        if self.model.kinetic.discretization().is_some() { "lagrangian" } else { "cost" }
    }

    /// The leaves that every motion without kinetic energy leaves unchanged; `None` if one of these motions moves something.
    fn points(&self) -> Option<Vec<String>> {
        let (model, system) = (self.model, self.system);
        if model.configurations.is_empty() || system.is_free() {
            return None;
        }
        let map = system.matrix_of_generator();
        let both = model.graph.below(&[self.inertia, map]);
        let factors = self.factors();
        let moved = |leaf: &Expr<'g>| factors.iter().any(|&k| leaf.depends_on(system.symbols.algebra[k]));
        let leaves = model.configurations.iter().zip(&system.generator).filter(|(_, leaf)| moved(leaf));
        let names: Vec<String> = leaves.map(|(leaf, _)| leaf.name.clone()).into_list();
        (identity::rank(both) == self.rank && !names.is_empty()).then_some(names)
    }

    /// The constant directions without kinetic energy, in words.
    fn directions(&self) -> Vec<String> {
        let dimension = self.inertia.shape().rows;
        let is_lost =
            |j: &usize| self.rank > 0 && identity::vanishes(self.inertia.block(0, *j, Shape::vector(dimension)));
        (0..dimension).filter(is_lost).map(|j| naming::basis_direction(self.model, j)).into_list()
    }

    /// The factors that some motion without kinetic energy moves.
    fn factors(&self) -> Vec<usize> {
        let (dimension, rank) = (self.inertia.shape().rows, self.rank);
        // without the columns of such a factor fewer motions of the others are left in the kernel
        let takes_part = |k: &usize| {
            let others = dimension - self.model.factors[*k].group.dimension();
            let of_others = if others == 0 { 0 } else { identity::rank(self.columns(|j| !self.is_of(*k, j))) };
            others - of_others < dimension - rank
        };
        (0..self.model.factors.len()).filter(takes_part).into_list()
    }

    /// The factors that have motions of their own without kinetic energy.
    fn alone(&self, factors: &[usize]) -> Vec<usize> {
        let is_alone = |k: &&usize| {
            identity::rank(self.columns(|j| self.is_of(**k, j))) < self.model.factors[**k].group.dimension()
        };
        factors.iter().filter(is_alone).copied().into_list()
    }

    fn is_of(&self, k: usize, j: usize) -> bool {
        (self.model.offset(k)..self.model.offset(k + 1)).contains(&j)
    }

    /// Some columns of Σ.
    fn columns(&self, takes: impl Fn(usize) -> bool) -> Expr<'g> {
        let shape = Shape::vector(self.inertia.shape().rows);
        let columns = (0..shape.rows).filter(|j| takes(*j)).map(|j| self.inertia.block(0, j, shape).entries());
        of_columns(self.model.graph, &columns.into_list())
    }

    /// A kinetic energy of a factor, in the user's key and names.
    fn term(&self, k: usize) -> String {
        let mass = self.model.spans.mass.as_ref().map_or_else(String::new, |mass| format!("{mass} * "));
        let factor = &self.model.factors[k];
        match (&self.model.kinetic, factor.group) {
            (Kinetic::Lagrangian { velocities, .. }, _) => format!("{mass}{}.norm_squared() / 2", velocities[k]),
            (_, Group::Translation(_)) => format!("{mass}{}.norm_squared() / (2 * h)", factor.name),
            (_, Group::SpecialOrthogonal(_)) => format!("{mass}({} - I).norm_squared() / (4 * h)", factor.name),
            _ => format!("{mass}({} - I).norm_squared() / (2 * h)", factor.name),
        }
    }
}
