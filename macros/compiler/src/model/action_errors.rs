//! The mistakes of an action, with the formulas that show them.

use clebsch_symbolic::{Expr, Group, Shape, identity};

use super::action_laws::{Action, Verdict};
use super::shapes::spelled;
use super::{Configuration, Factor, LeafSpace, Side};
use crate::diagnostic::{Diagnostic, error};
use crate::parse::{joined, shortened, spell};

impl<'g> Action<'_, 'g> {
    pub(super) fn identity_moves(&self) -> Diagnostic {
        let images = self.of_identity();
        let mut moved = self.configurations.iter().zip(&images);
        let found = moved.find(|(leaf, image)| leaf.symbol != **image).map(|(leaf, &image)| {
            let identity = |group: Group| if group.is_translation() { "0" } else { "I" };
            let names = self.factors.iter().map(|factor| format!("{} = {}", factor.name, identity(factor.group)));
            let place = self.formula(image).map_or("elsewhere".to_string(), |formula| format!("to {formula}"));
            format!(", but with {} it moves {} {place}", joined(names), leaf.name)
        });
        let found = found.unwrap_or_default();
        self.no_action(None).note(format!("the identity has to move nothing{found}")).help(self.example(0))
    }

    /// A configuration does not stay where it is promised to be.
    pub(super) fn leaves_space(&self, leaf: &Configuration, moved: Expr<'g>, verdict: Verdict) -> Diagnostic {
        let promise = match leaf.space {
            LeafSpace::Group(group) => format!("in {}", group.name(self.graph)),
            LeafSpace::Symmetric => "symmetric".to_string(),
            LeafSpace::Projector(rank) => format!("an orthogonal projector of rank {rank}"),
            LeafSpace::Orthonormal => "a matrix of orthonormal columns".to_string(),
            _ => "a unit vector".to_string(),
        };
        let which = if verdict == Verdict::Open { "cannot be shown to be always" } else { "is not always" };
        let moved = self.formula(moved).unwrap_or_else(|| shortened(&self.closure.body));
        let (key, name) = (&self.closure.key, &leaf.name);
        error!(&self.closure.body, "the {key} moves `{name}` to `{moved}`, which {which} {promise}";
            help "write `{name}: {}` if any value is a configuration", plain_name(leaf))
    }

    pub(super) fn no_action(&self, factor: Option<usize>) -> Diagnostic {
        let names = joined(self.closure.arguments.iter().map(|argument| argument.pattern.spell()));
        let group = match (self.factors, factor) {
            ([only], _) => only.group.name(self.graph),
            (factors, Some(k)) => format!("{} by its factor `{}`", factors[k].group.name(self.graph), factors[k].name),
            _ => "the group".to_string(),
        };
        let body = &self.closure.body;
        error!(body, "`|{names}| {}` is not an action of {group}", spell(body))
    }

    /// The error for a factor that moves nothing and a configuration of its own kind that nothing moves.
    pub(super) fn unmoved(&self, sides: &[(Option<Side>, bool)]) -> Option<Diagnostic> {
        let still = self.configurations.iter().zip(self.value).filter(|(leaf, image)| leaf.symbol == **image);
        let mut idle = self.factors.iter().zip(sides).filter(|(_, (_, moves))| !moves).map(|(factor, _)| factor);
        let (factor, (leaf, _)) = idle.find_map(|factor| {
            let mut still = still.clone();
            Some((factor, still.find(|(leaf, _)| acts_on(factor.group, leaf))?))
        })?;
        let (f, q) = (&factor.name, &leaf.name);
        let product = if factor.group.is_translation() { format!("{q} + {f}") } else { format!("{f} * {q}") };
        Some(error!(&self.closure.body, "`{f}` moves nothing, and nothing moves `{q}`";
            help "write `{product}` in place of `{q}`";
            note "the action is the moved configuration, and `{q}` would never change"))
    }

    pub(super) fn composition(&self, index: usize, composed: &[Expr<'g>]) -> String {
        let name = &self.factors[index].name;
        let element = self.element(index, 1);
        // the first leaf that the factor moves shows the formula
        let shown = composed.iter().find(|image| image.depends_on(element)).unwrap_or(&composed[0]);
        let formula = self.formula(*shown).map(|text| format!(" gives {text}, which")).unwrap_or_default();
        let products = if self.factors[index].group.is_translation() {
            format!("is not the action of {name}1 + {name}2")
        } else {
            format!("is neither the action of {name}2*{name}1 nor of {name}1*{name}2")
        };
        format!("acting by {name}1 and then by {name}2{formula} {products}")
    }

    /// A formula that says more than the closure itself: it is short, and products of quaternions are not expanded in
    /// it.
    fn formula(&self, expr: Expr<'g>) -> Option<String> {
        Some(ascii(expr)).filter(|formula| self.is_readable(formula))
    }

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
        let (q, rows, shape) = (&leaf.name, group.element_shape().rows, leaf.shape);
        let is_turn = group.is_orthogonal() && *group != Group::UnitQuaternions;
        let inverse = if is_turn { "transpose" } else { "inverse" };
        if group.is_translation() {
            format!("`{q} + {f}` is an action")
        } else if group.linear_part().is_some_and(|n| shape == Shape::vector(n)) {
            format!("`{f}.rotation() * {q} + {f}.translation()` (left) is an action")
        } else if shape.columns == rows && shape.rows != rows {
            format!("`{q} * {f}` (right) is an action")
        } else if shape.columns == rows || leaf.is_quaternion {
            format!("`{f} * {q}` (left), `{q} * {f}` (right) and `{f} * {q} * {f}.{inverse}()` (left) are actions")
        } else {
            format!("`{f} * {q}` (left) and `{f}.{inverse}() * {q}` (right) are actions")
        }
    }

    pub(super) fn do_not_commute(&self, [one, other]: [&Factor<'g>; 2], orders: [&[Expr<'g>]; 2]) -> Diagnostic {
        let leaf = first_difference(orders[0], orders[1]);
        let declared = |factor: &Factor| format!("`{}: {}`", factor.name, factor.group.name(self.graph));
        let [then_second, then_first] = orders.map(|images| ascii(images[leaf]));
        let (leaf, first, second) = (&self.configurations[leaf], verb(one), verb(other));
        let orders = if self.is_readable(&format!("{then_second}{then_first}")) {
            format!("to {then_second}, in the other order to {then_first}")
        } else {
            "elsewhere than in the other order".to_string()
        };
        error!(&self.closure.body, "the factors {} and {} do not commute", declared(one), declared(other);
            note "{first} and then {second} moves {} {orders}", leaf.name;
            help "{}", self.one_group(one, other, leaf))
    }

    /// The one group to write instead of two factors that do not commute.
    fn one_group(&self, one: &Factor, other: &Factor, leaf: &Configuration) -> String {
        let f = if one.group.is_translation() { &other.name } else { &one.name };
        let Some(group) = smallest_group(one.group, other.group) else {
            return "write one group that holds both, by its equation: `group Both = |F: Matrix4| …`".to_string();
        };
        let (q, plain) = (&leaf.name, plain_name(leaf));
        let space = match leaf.space {
            LeafSpace::Vectors => plain,
            LeafSpace::Unit => format!("Unit<{plain}>"),
            LeafSpace::Symmetric => format!("Symmetric<{plain}>"),
            LeafSpace::Projector(rank) => format!("Projector<{plain}, {rank}>"),
            LeafSpace::Orthonormal => format!("Orthonormal<{plain}>"),
            LeafSpace::Group(group) => group.name(self.graph),
        };
        let is_affine = group.linear_part().is_some() && !leaf.shape.is_square();
        let moved = if is_affine { format!("{f}.rotation() * {q} + {f}.translation()") } else { format!("{f} * {q}") };
        format!("write one group: `|{f}: {}, {q}: {space}| {moved}`", group.name(self.graph))
    }
}

/// Whether a group moves the points of a leaf in the usual way.
fn acts_on(group: Group, leaf: &Configuration) -> bool {
    match leaf.space {
        LeafSpace::Group(space) => space == group,
        LeafSpace::Unit | LeafSpace::Orthonormal => group == Group::SpecialOrthogonal(leaf.shape.rows),
        LeafSpace::Symmetric | LeafSpace::Projector(_) => false,
        LeafSpace::Vectors if leaf.is_quaternion => group == Group::UnitQuaternions,
        LeafSpace::Vectors => group.element_shape() == leaf.shape || group.element_shape().rows == leaf.shape.rows,
    }
}

/// The type of any value of the shape of a leaf.
fn plain_name(leaf: &Configuration) -> String {
    if leaf.is_quaternion { "Quaternion".to_string() } else { spelled(leaf.shape) }
}

/// The smallest group that is built in and holds two groups that act on the same space.
fn smallest_group(one: Group, other: Group) -> Option<Group> {
    let both = [one, other];
    let linear = both.into_iter().find(|group| !group.is_translation())?;
    let Some(shift) = both.into_iter().find(|group| group.is_translation()) else {
        let [a, b] = both.map(|group| group.element_shape());
        return if one == other {
            Some(one)
        } else if both.contains(&Group::UnitQuaternions) {
            // both turn R³
            both.into_iter().find(|group| *group == Group::SpecialOrthogonal(3))
        } else {
            (a == b || a.is_scalar() || b.is_scalar()).then_some(Group::GeneralLinear(a.rows.max(b.rows)))
        };
    };
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

/// The first leaf in which two images differ.
pub(super) fn first_difference<'g>(one: &[Expr<'g>], other: &[Expr<'g>]) -> usize {
    one.iter().zip(other).position(|(a, b)| !identity::equal(&[*a], &[*b])).unwrap_or(0)
}

fn verb(factor: &Factor) -> String {
    let verb = match factor.group {
        Group::Translation(_) => "shifting",
        Group::SpecialOrthogonal(_) | Group::UnitQuaternions => "turning",
        _ => "acting",
    };
    format!("{verb} by {}", factor.name)
}

/// A formula with the operators of the declaration.
pub(super) fn ascii(expr: Expr) -> String {
    expr.to_string().replace('·', "*").replace('−', "-")
}
