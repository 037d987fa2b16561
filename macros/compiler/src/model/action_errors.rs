//! What is wrong with an action, with the formulas that show it.

use clebsch_symbolic::{Expr, Group, Shape, identity};

use super::action_laws::Action;
use super::elaborate::shortened;
use super::membership::Verdict;
use super::{Configuration, Factor, LeafSpace};
use crate::diagnostic::{Diagnostic, Location};
use crate::parse::spell;

impl<'g> Action<'_, 'g> {
    /// The identity moves something.
    pub(super) fn identity_moves(&self) -> Diagnostic {
        let images = self.of_identity();
        let moved = self.configurations.iter().zip(&images).find(|(leaf, image)| leaf.symbol != **image);
        let names: Vec<String> =
            self.factors.iter().map(|factor| format!("{} = {}", factor.name, identity_name(factor.group))).collect();
        let error = self.no_action(None);
        match moved {
            Some((leaf, &image)) => {
                let formula = Some(ascii(image)).filter(|formula| self.is_readable(formula));
                let place = formula.map_or("elsewhere".to_string(), |formula| format!("to {formula}"));
                let names = names.join(", ");
                error.note(format!("the identity has to move nothing, but with {names} it moves {} {place}", leaf.name))
            }
            None => error.note("the identity has to move nothing"),
        }
        .help(self.example(0))
    }

    fn name_of(&self, factor: &Factor) -> String {
        factor.group.name(self.graph)
    }

    /// A configuration does not stay where it is promised to be.
    pub(super) fn leaves_space(&self, leaf: &Configuration, moved: Expr<'g>, verdict: Verdict) -> Diagnostic {
        let promise = match leaf.space {
            LeafSpace::Group(group) => format!("in {}", group.name(self.graph)),
            _ => "a unit vector".to_string(),
        };
        let (key, name) = (&self.closure.key, &leaf.name);
        let plain = plain_name(leaf);
        let which = if verdict == Verdict::Open { "cannot be shown to be always" } else { "is not always" };
        let formula = Some(ascii(moved)).filter(|formula| self.is_readable(formula));
        let moved = formula.unwrap_or_else(|| shortened(&spell(&self.closure.body)));
        let message = format!("the {key} moves `{name}` to `{moved}`, which {which} {promise}");
        Diagnostic::new(Location::of(&self.closure.body), message)
            .help(format!("write `{name}: {plain}` if any value is a configuration"))
    }

    pub(super) fn no_action(&self, factor: Option<usize>) -> Diagnostic {
        let names: Vec<String> = self.closure.arguments.iter().map(|argument| argument.pattern.spell()).collect();
        let text = format!("|{}| {}", names.join(", "), spell(&self.closure.body));
        let group = match factor {
            Some(index) if self.factors.len() > 1 => {
                format!("{} by its factor `{}`", self.name_of(&self.factors[index]), self.factors[index].name)
            }
            _ if self.factors.len() > 1 => "the group".to_string(),
            _ => self.name_of(&self.factors[0]),
        };
        Diagnostic::new(Location::of(&self.closure.body), format!("`{text}` is not an action of {group}"))
    }

    pub(super) fn composition(&self, index: usize, composed: &[Expr<'g>]) -> String {
        let name = &self.factors[index].name;
        let element = self.element(index, 1);
        // the first leaf that the factor moves shows the formula
        let shown = composed.iter().find(|image| image.depends_on(element)).unwrap_or(&composed[0]);
        let order = format!("acting by {name}1 and then by {name}2");
        let text = ascii(*shown);
        let formula = match self.is_readable(&text) {
            true => format!("gives {text}, which"),
            false => String::new(),
        };
        match self.factors[index].group.is_translation() {
            true => format!("{order} {formula} is not the action of {name}1 + {name}2"),
            false => format!("{order} {formula} is neither the action of {name}2*{name}1 nor of {name}1*{name}2"),
        }
        .replace("  ", " ")
    }

    /// Whether a formula says more than the closure itself: it is short, and no products of quaternions are written out in it.
    fn is_readable(&self, formula: &str) -> bool {
        const LONGEST: usize = 160;
        let quaternions = self.factors.iter().any(|factor| factor.group == Group::UnitQuaternions)
            || self.configurations.iter().any(|leaf| leaf.is_quaternion);
        !quaternions && formula.chars().count() <= LONGEST
    }

    /// Actions that a factor could have.
    pub(super) fn example(&self, index: usize) -> String {
        let Factor { group, name: f, symbol, .. } = &self.factors[index];
        let moved = self.configurations.iter().zip(self.value).find(|(_, image)| image.depends_on(*symbol));
        let leaf = moved.map_or(&self.configurations[0], |(leaf, _)| leaf);
        let (q, rows) = (&leaf.name, group.element_shape().rows);
        let inverse = if group.is_orthogonal() { "transpose" } else { "inverse" };
        match (group, group.linear_part()) {
            (Group::Translation(_), _) => format!("`{q} + {f}` is an action"),
            (Group::UnitQuaternions, _) if !leaf.is_quaternion => {
                format!("`{f} * {q}` (left) and `{f}.inverse() * {q}` (right) are actions")
            }
            (Group::UnitQuaternions, _) => {
                format!("`{f} * {q}` (left), `{q} * {f}` (right) and `{f} * {q} * {f}.inverse()` (left) are actions")
            }
            (_, Some(n)) if leaf.shape == Shape::vector(n) => {
                format!("`{f}.rotation() * {q} + {f}.translation()` (left) is an action")
            }
            _ if leaf.shape.rows != rows && leaf.shape.columns == rows => format!("`{q} * {f}` (right) is an action"),
            _ if leaf.shape.columns != rows => {
                format!("`{f} * {q}` (left) and `{f}.{inverse}() * {q}` (right) are actions")
            }
            _ => {
                format!("`{f} * {q}` (left), `{q} * {f}` (right) and `{f} * {q} * {f}.{inverse}()` (left) are actions")
            }
        }
    }

    pub(super) fn do_not_commute(
        &self,
        first: usize,
        second: usize,
        then_second: &[Expr<'g>],
        then_first: &[Expr<'g>],
    ) -> Diagnostic {
        let differs = |(&a, &b): (&Expr<'g>, &Expr<'g>)| !identity::equal(&[a], &[b]);
        let leaf = then_second.iter().zip(then_first).position(differs).unwrap_or(0);
        let (one, other) = (&self.factors[first], &self.factors[second]);
        let declared = |factor: &Factor| format!("`{}: {}`", factor.name, self.name_of(factor));
        Diagnostic::new(
            Location::of(&self.closure.body),
            format!("the factors {} and {} do not commute", declared(one), declared(other)),
        )
        .note(self.both_orders(one, other, leaf, [then_second[leaf], then_first[leaf]]))
        .help(self.one_group(one, other, &self.configurations[leaf]))
    }

    fn both_orders(&self, one: &Factor, other: &Factor, leaf: usize, images: [Expr<'g>; 2]) -> String {
        let (first, second, name) = (verb(one), verb(other), &self.configurations[leaf].name);
        let [then_second, then_first] = images.map(ascii);
        match self.is_readable(&format!("{then_second}{then_first}")) {
            true => {
                format!("{first} and then {second} moves {name} to {then_second}, in the other order to {then_first}")
            }
            false => format!("{first} and then {second} moves {name} elsewhere than in the other order"),
        }
    }

    /// The one group to write instead of two factors that do not commute.
    fn one_group(&self, one: &Factor, other: &Factor, leaf: &Configuration) -> String {
        let f = if one.group.is_translation() { &other.name } else { &one.name };
        let (q, space) = (&leaf.name, self.space_name(leaf));
        match smallest_group(one.group, other.group) {
            Some(group) if group.linear_part().is_some() && !leaf.shape.is_square() => {
                let name = group.name(self.graph);
                format!("write one group: `|{f}: {name}, {q}: {space}| {f}.rotation() * {q} + {f}.translation()`")
            }
            Some(group) => {
                format!("write one group: `|{f}: {}, {q}: {space}| {f} * {q}`", group.name(self.graph))
            }
            None => "write one group that holds both, by its equation: `group Both = |F: Matrix4| …`".to_string(),
        }
    }

    /// The type of a leaf of the configuration.
    fn space_name(&self, leaf: &Configuration) -> String {
        let plain = plain_name(leaf);
        match leaf.space {
            LeafSpace::Vectors => plain,
            LeafSpace::Unit => format!("Unit<{plain}>"),
            LeafSpace::Group(group) => group.name(self.graph),
        }
    }
}

/// The type of any value of the shape of a leaf.
fn plain_name(leaf: &Configuration) -> String {
    match (leaf.is_quaternion, leaf.shape.columns, leaf.shape.rows) {
        (true, ..) => "Quaternion".to_string(),
        (_, 1, n @ 1..=6) => format!("Vector{n}"),
        (_, 1, n) => format!("SVector<{n}>"),
        (_, m, n @ 1..=6) if m == n => format!("Matrix{n}"),
        (_, m, n) => format!("SMatrix<{n}, {m}>"),
    }
}

/// The smallest group that is built in and holds two groups that act on the same space.
fn smallest_group(one: Group, other: Group) -> Option<Group> {
    let translations = [one, other].into_iter().find(|group| group.is_translation());
    let linear = [one, other].into_iter().find(|group| !group.is_translation());
    match (translations, linear?) {
        (None, _) if one == other => Some(one),
        // both turn R³
        (None, _) if [one, other].contains(&Group::UnitQuaternions) => {
            [one, other].contains(&Group::SpecialOrthogonal(3)).then_some(Group::SpecialOrthogonal(3))
        }
        (None, _) => {
            let (a, b) = (one.element_shape(), other.element_shape());
            match (a.is_scalar(), b.is_scalar()) {
                (true, false) => Some(Group::GeneralLinear(b.rows)),
                (false, true) => Some(Group::GeneralLinear(a.rows)),
                _ if a == b => Some(Group::GeneralLinear(a.rows)),
                _ => None,
            }
        }
        (Some(shift), linear) => {
            let n = shift.dimension();
            match linear {
                Group::SpecialOrthogonal(m) if m == n => Some(Group::SpecialEuclidean(n)),
                Group::UnitQuaternions if n == 3 => Some(Group::SpecialEuclidean(n)),
                Group::GeneralLinear(1) if n > 1 => Some(Group::Similarity(n)),
                Group::SpecialEuclidean(m) | Group::Affine(m) | Group::Similarity(m) if m == n => Some(linear),
                _ if linear.element_shape().rows == n => Some(Group::Affine(n)),
                _ => None,
            }
        }
    }
}

fn verb(factor: &Factor) -> String {
    let verb = match factor.group {
        Group::Translation(_) => "shifting",
        Group::SpecialOrthogonal(_) | Group::UnitQuaternions => "turning",
        _ => "acting",
    };
    format!("{verb} by {}", factor.name)
}

fn identity_name(group: Group) -> &'static str {
    match group {
        Group::Translation(_) => "0",
        _ => "I",
    }
}

/// A formula with the operators of the declaration.
pub(super) fn ascii(expr: Expr) -> String {
    expr.to_string().replace('·', "*").replace('−', "-")
}
