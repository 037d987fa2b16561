//! The laws of the action, checked exactly and factor by factor: the identity moves nothing, products act as one after the
//! other, different factors do not meet, and every factor moves something. The side of each factor is found here.

use clebsch_symbolic::{Expr, Graph, Group, Role, identity};

use super::{Configuration, Factor, Side, Space};
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::parse::{Closure, spell};

/// The action with what it acts on.
pub(super) struct Action<'a, 'g> {
    pub graph: &'g Graph,
    pub closure: &'a Closure,
    pub factors: &'a [Factor<'g>],
    pub configurations: &'a [Configuration<'g>],
    /// Φ_F(q), leaf by leaf.
    pub value: &'a [Expr<'g>],
}

/// Checks all laws and returns the side of each factor.
pub(super) fn check(action: &Action, diagnostics: &mut Diagnostics) -> Option<Vec<Side>> {
    let before = diagnostics.len();
    action.stays_in_space(diagnostics);
    if !identity::equal(&action.of_identity(), &action.points()) {
        diagnostics.push(action.identity_moves());
        return None;
    }
    let sides: Vec<Option<Sides>> = (0..action.factors.len()).map(|factor| action.sides(factor, diagnostics)).collect();
    action.factors_commute(diagnostics);
    (diagnostics.len() == before).then(|| settle(&sides.into_iter().flatten().collect::<Vec<_>>()))
}

/// On which sides the composition law holds.
#[derive(Copy, Clone, PartialEq, Eq)]
enum Sides {
    Left,
    Right,
    Both,
}

/// A factor on which both laws hold takes the side of the others, else left.
fn settle(sides: &[Sides]) -> Vec<Side> {
    let any = |wanted: Sides| sides.contains(&wanted);
    let open = if any(Sides::Right) && !any(Sides::Left) { Side::Right } else { Side::Left };
    let side = |sides: &Sides| match sides {
        Sides::Left => Side::Left,
        Sides::Right => Side::Right,
        Sides::Both => open,
    };
    sides.iter().map(side).collect()
}

impl<'g> Action<'_, 'g> {
    fn points(&self) -> Vec<Expr<'g>> {
        self.configurations.iter().map(|leaf| leaf.symbol).collect()
    }

    /// Φ at elements for some factors (the identity for all others) and a point.
    fn at(&self, elements: &[(usize, Expr<'g>)], point: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let mut rules: Vec<(Expr<'g>, Expr<'g>)> = self
            .factors
            .iter()
            .enumerate()
            .map(|(index, factor)| {
                let given = elements.iter().find(|(other, _)| *other == index).map(|&(_, element)| element);
                (factor.symbol, given.unwrap_or_else(|| factor.group.identity(self.graph)))
            })
            .collect();
        rules.extend(self.points().into_iter().zip(point.iter().copied()));
        self.value.iter().map(|expr| expr.substitute(&rules)).collect()
    }

    fn of_identity(&self) -> Vec<Expr<'g>> {
        self.at(&[], &self.points())
    }

    /// A second element of a factor, printed as `F1` or `F2`.
    fn element(&self, factor: usize, number: usize) -> Expr<'g> {
        let Factor { group, name, .. } = &self.factors[factor];
        let role = Role::Auxiliary(2 * factor + number);
        self.graph.symbol(&format!("{name}{number}"), group.element_shape(), role, group.element_property())
    }

    /// A promise about the configuration has to survive the action.
    fn stays_in_space(&self, diagnostics: &mut Diagnostics) {
        for (leaf, &moved) in self.configurations.iter().zip(self.value) {
            let (norm, fixed, promise) = match leaf.space {
                Space::Vectors => continue,
                Space::Unit => (moved.norm_squared(), self.graph.integer(1), "a unit vector".to_string()),
                Space::Group(group) => {
                    (moved.transpose() * moved, self.graph.identity(leaf.shape.rows), format!("in {}", group.name()))
                }
            };
            if !identity::equal(&[norm], &[fixed]) {
                let message = format!("the action moves `{}` to `{}`, which is not always {promise}", leaf.name, ascii(moved));
                let plain = match leaf.shape.is_column() {
                    true => format!("Vector{}", leaf.shape.rows),
                    false => format!("Matrix{}", leaf.shape.rows),
                };
                let error = Diagnostic::new(crate::diagnostic::Place::of(&self.closure.body), message);
                diagnostics.push(error.help(format!("write `{}: {plain}` if any value is a configuration", leaf.name)));
            }
        }
    }

    fn identity_moves(&self) -> Diagnostic {
        let images = self.of_identity();
        let moved = self.configurations.iter().zip(&images).find(|(leaf, image)| leaf.symbol != **image);
        let names: Vec<String> = self.factors.iter().map(|factor| format!("{} = {}", factor.name, identity_name(factor.group))).collect();
        let error = self.no_action(None);
        match moved {
            Some((leaf, &image)) => error.note(format!(
                "the identity has to move nothing, but with {} it moves {} to {}",
                names.join(", "),
                leaf.name,
                ascii(image)
            )),
            None => error.note("the identity has to move nothing"),
        }
        .help(self.example(0))
    }

    /// The sides on which a factor's composition law holds.
    fn sides(&self, index: usize, diagnostics: &mut Diagnostics) -> Option<Sides> {
        let Factor { group, symbol, name, span, .. } = &self.factors[index];
        let points = self.points();
        if identity::equal(&self.at(&[(index, *symbol)], &points), &points) {
            diagnostics.push(
                Diagnostic::new(*span, format!("the factor `{name}: {}` moves nothing", group.name()))
                    .help(format!("leave `{name}` out of the action"))
                    .note("a factor that moves no configuration has no side from which it acts"),
            );
            return None;
        }
        let (first, second) = (self.element(index, 1), self.element(index, 2));
        let composed = self.at(&[(index, second)], &self.at(&[(index, first)], &points));
        let is_action_of = |product: Expr<'g>| identity::equal(&composed, &self.at(&[(index, product)], &points));
        let left = is_action_of(group.compose(second, first));
        let right = is_action_of(group.compose(first, second));
        match (left, right) {
            (true, true) => Some(Sides::Both),
            (true, false) => Some(Sides::Left),
            (false, true) => Some(Sides::Right),
            (false, false) => {
                let error = self.no_action(Some(index)).note(self.composition(index, &composed)).help(self.example(index));
                diagnostics.push(error);
                None
            }
        }
    }

    fn no_action(&self, factor: Option<usize>) -> Diagnostic {
        let names: Vec<String> = self.closure.arguments.iter().map(|argument| argument.pattern.spell()).collect();
        let text = format!("|{}| {}", names.join(", "), spell(&self.closure.body));
        let group = match factor {
            Some(index) if self.factors.len() > 1 => {
                format!("{} by its factor `{}`", self.factors[index].group.name(), self.factors[index].name)
            }
            _ if self.factors.len() > 1 => "the group".to_string(),
            _ => self.factors[0].group.name(),
        };
        Diagnostic::new(crate::diagnostic::Place::of(&self.closure.body), format!("`{text}` is not an action of {group}"))
    }

    fn composition(&self, index: usize, composed: &[Expr<'g>]) -> String {
        let name = &self.factors[index].name;
        let element = self.element(index, 1);
        // the first leaf that the factor moves shows the formula
        let shown = composed.iter().find(|image| image.depends_on(element)).unwrap_or(&composed[0]);
        let [left, right] = match self.factors[index].group {
            Group::Translation(_) => [format!("{name}1 + {name}2"), format!("{name}2 + {name}1")],
            _ => [format!("{name}2*{name}1"), format!("{name}1*{name}2")],
        };
        match left.contains('+') {
            true => format!("acting by {name}1 and then by {name}2 gives {}, which is not the action of {left}", ascii(*shown)),
            false => format!(
                "acting by {name}1 and then by {name}2 gives {}, which is neither the action of {left} nor of {right}",
                ascii(*shown)
            ),
        }
    }

    /// Actions that a factor could have.
    fn example(&self, index: usize) -> String {
        let Factor { group, name: f, symbol, .. } = &self.factors[index];
        let moved = self.configurations.iter().zip(self.value).find(|(_, image)| image.depends_on(*symbol));
        let leaf = moved.map_or(&self.configurations[0], |(leaf, _)| leaf);
        let q = &leaf.name;
        match group {
            Group::Translation(_) => format!("`{q} + {f}` is an action"),
            _ if leaf.shape.is_column() => format!("`{f} * {q}` (left) and `{f}.transpose() * {q}` (right) are actions"),
            _ => format!("`{f} * {q}` (left), `{q} * {f}` (right) and `{f} * {q} * {f}.transpose()` (left) are actions"),
        }
    }

    /// Any two factors commute, and all together act as one after the other.
    fn factors_commute(&self, diagnostics: &mut Diagnostics) {
        let count = self.factors.len();
        let symbol = |index: usize| self.factors[index].symbol;
        let points = self.points();
        let before = diagnostics.len();
        for second in 1..count {
            for first in 0..second {
                let (a, b) = (symbol(first), symbol(second));
                let then_second = self.at(&[(second, b)], &self.at(&[(first, a)], &points));
                let then_first = self.at(&[(first, a)], &self.at(&[(second, b)], &points));
                if !identity::equal(&then_second, &then_first) {
                    diagnostics.push(self.do_not_commute(first, second, &then_second, &then_first));
                }
            }
        }
        let one_by_one = (0..count).fold(points.clone(), |point, index| self.at(&[(index, symbol(index))], &point));
        if diagnostics.len() == before && !identity::equal(&one_by_one, self.value) {
            diagnostics.push(self.no_action(None).note("its factors together act otherwise than one after the other"));
        }
    }

    fn do_not_commute(&self, first: usize, second: usize, then_second: &[Expr<'g>], then_first: &[Expr<'g>]) -> Diagnostic {
        let differs = |(&a, &b): (&Expr<'g>, &Expr<'g>)| !identity::equal(&[a], &[b]);
        let leaf = then_second.iter().zip(then_first).position(differs).unwrap_or(0);
        let (one, other) = (&self.factors[first], &self.factors[second]);
        let declared = |factor: &Factor| format!("`{}: {}`", factor.name, factor.group.name());
        Diagnostic::new(
            crate::diagnostic::Place::of(&self.closure.body),
            format!("the factors {} and {} do not commute", declared(one), declared(other)),
        )
        .note(format!(
            "{} and then {} moves {} to {}, in the other order to {}",
            verb(one),
            verb(other),
            self.configurations[leaf].name,
            ascii(then_second[leaf]),
            ascii(then_first[leaf])
        ))
        .help("let each factor move a part of the configuration of its own")
    }
}

fn verb(factor: &Factor) -> String {
    match factor.group {
        Group::Translation(_) => format!("shifting by {}", factor.name),
        _ => format!("turning by {}", factor.name),
    }
}

fn identity_name(group: Group) -> &'static str {
    match group {
        Group::Translation(_) => "0",
        _ => "I",
    }
}

/// A formula with the operators of the declaration.
fn ascii(expr: Expr) -> String {
    expr.to_string().replace('·', "*").replace('−', "-")
}
