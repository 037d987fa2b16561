//! The target: the closure `target`, with the equations and inequalities that hold at the end of a plan.

use clebsch_symbolic::IntoList;
use syn::Expr as Syntax;

use super::EndConditions;
use super::closures::written;
use super::comparisons::{Among, comparisons, conjuncts, equations_first};
use super::elaborate::Elaborator;
use super::slots::{END, END_OF_STATES};
use super::typed::ActedSystem;
use crate::diagnostic::{refuse, report};
use crate::parse::{Argument, Closure, joined, tail};

impl<'g> ActedSystem<'_, '_, 'g> {
    /// The conditions of the end, equations first; `None` if one has an error.
    pub fn target(&mut self, closure: &Closure, is_steered: bool) -> Option<EndConditions<'g>> {
        let diagnostics = self.context.diagnostics;
        let matched = self.arguments.matched(closure, if is_steered { END } else { END_OF_STATES });
        let (scope, velocities) = self.with_velocity(&matched, None)?;
        let body = tail(&closure.body);
        let list = match body {
            Syntax::Array(list) if !list.elems.is_empty() => list,
            Syntax::Array(list) => refuse!(diagnostics, list, "the target has no condition";
                help "write one, as in `[{} == …]`, or leave out the key", self.arguments.names.configuration.spell()),
            body => refuse!(diagnostics, body, "a target is a list of conditions";
                help "write `target = |{}| [{}]`", joined(closure.arguments.iter().map(Argument::spell)), conjuncts(body)),
        };
        let mut elaborator = Elaborator::new(self.context, "target", scope);
        let moving = self.space.leaves.iter().map(|leaf| leaf.symbol).chain(velocities.iter().copied()).into_list();
        let conditions = elaborator
            .in_block(&closure.body, |elaborator| comparisons(elaborator, list, (Among::Conditions, &moving)))?;
        let motions: usize = self.factors.iter().map(|factor| factor.group.dimension()).sum();
        let room = if is_steered { motions } else { 2 * motions };
        if let Some(beyond) = conditions.get(room) {
            let count = conditions.len();
            report!(diagnostics, beyond.place, "the target has {count} conditions, and places have {room} dimensions";
                help "leave out conditions that follow from others, or write one for both sides of an interval, as in `(q.x - 1).powi(2) <= 0.01`");
        }
        let equations = conditions.iter().filter(|condition| condition.is_equation).count();
        Some(EndConditions {
            conditions: equations_first(conditions),
            equations,
            velocities,
            written: written(closure),
        })
    }
}
