//! What is wrong with an action, with the formulas that show it.

use clebsch_symbolic::{Expr, Group, identity};

use super::Factor;
use super::action_laws::Action;
use crate::diagnostic::{Diagnostic, Place};
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

    pub(super) fn no_action(&self, factor: Option<usize>) -> Diagnostic {
        let names: Vec<String> = self.closure.arguments.iter().map(|argument| argument.pattern.spell()).collect();
        let text = format!("|{}| {}", names.join(", "), spell(&self.closure.body));
        let group = match factor {
            Some(index) if self.factors.len() > 1 => {
                format!("{} by its factor `{}`", self.factors[index].group.name(), self.factors[index].name)
            }
            _ if self.factors.len() > 1 => "the group".to_string(),
            _ => self.factors[0].group.name(),
        };
        Diagnostic::new(Place::of(&self.closure.body), format!("`{text}` is not an action of {group}"))
    }

    pub(super) fn composition(&self, index: usize, composed: &[Expr<'g>]) -> String {
        let name = &self.factors[index].name;
        let element = self.element(index, 1);
        // the first leaf that the factor moves shows the formula
        let shown = composed.iter().find(|image| image.depends_on(element)).unwrap_or(&composed[0]);
        let [left, right] = match self.factors[index].group {
            Group::Translation(_) => [format!("{name}1 + {name}2"), format!("{name}2 + {name}1")],
            _ => [format!("{name}2*{name}1"), format!("{name}1*{name}2")],
        };
        match left.contains('+') {
            true => format!(
                "acting by {name}1 and then by {name}2 gives {}, which is not the action of {left}",
                ascii(*shown)
            ),
            false => format!(
                "acting by {name}1 and then by {name}2 gives {}, which is neither the action of {left} nor of {right}",
                ascii(*shown)
            ),
        }
    }

    /// Actions that a factor could have.
    pub(super) fn example(&self, index: usize) -> String {
        let Factor { group, name: f, symbol, .. } = &self.factors[index];
        let moved = self.configurations.iter().zip(self.value).find(|(_, image)| image.depends_on(*symbol));
        let leaf = moved.map_or(&self.configurations[0], |(leaf, _)| leaf);
        let q = &leaf.name;
        match group {
            Group::Translation(_) => format!("`{q} + {f}` is an action"),
            _ if leaf.shape.is_column() => {
                format!("`{f} * {q}` (left) and `{f}.transpose() * {q}` (right) are actions")
            }
            _ => {
                format!("`{f} * {q}` (left), `{q} * {f}` (right) and `{f} * {q} * {f}.transpose()` (left) are actions")
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
        let declared = |factor: &Factor| format!("`{}: {}`", factor.name, factor.group.name());
        Diagnostic::new(
            Place::of(&self.closure.body),
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
pub(super) fn ascii(expr: Expr) -> String {
    expr.to_string().replace('·', "*").replace('−', "-")
}
