//! Symmetries that the user offers: `|S: SO<3>, q, F| (q′, F′)`, checked to be actions that agree with the action of the system.

use clebsch_symbolic::{Elements, Expr, Group, IntoList, Role, both, identity};
use syn::Type;

use super::action_errors::{ascii, first_difference};
use super::action_laws::{self, Action};
use super::closures;
use super::groups::known_group;
use super::slots::{Matched, SYMMETRY, Slot};
use super::space::{Space, new_value_of};
use super::spaces::space_of;
use super::typed::ActedSystem;
use super::value::Value;
use super::{Access, Configuration, Factor, OfferedSymmetry, Side};
use crate::diagnostic::refuse;
use crate::parse::{Argument, Closure, Pattern, joined, spell_type, tail};

impl<'g> ActedSystem<'_, '_, 'g> {
    /// Reads and checks a symmetry, by its number among those of the declaration.
    pub fn symmetry(&mut self, (index, closure): (usize, &Closure)) -> Option<OfferedSymmetry<'g>> {
        let matched = self.arguments.matched(closure, SYMMETRY);
        let argument = self.offered_argument(&matched)?;
        let offered = self.offered(argument, index);
        let value = offered.as_ref().map(|factor| Value::leaf(factor.symbol, factor.group == Group::UnitQuaternions));
        let scope = self.arguments.scope(&matched, &[(Slot::Offered, value)]);
        let value = self.context.value(closure, scope)?;
        let (configurations, elements) = self.images(closure, &value)?;
        let offered = offered?;
        let side = self.check(closure, &offered, &configurations, &elements)?;
        let Factor { group, symbol, name, .. } = offered;
        let written = closures::written(closure);
        Some(OfferedSymmetry { group, symbol, name, side, configurations, elements, written })
    }

    /// The argument for the element of the symmetry's group; a symmetry needs the others too.
    fn offered_argument<'c>(&self, matched: &Matched<'c>) -> Option<&'c Argument> {
        if matched.has_error() {
            return None;
        }
        if let Some(slot) = matched.first_free() {
            let names = &self.arguments.names;
            let name = names.pattern(slot).map_or("element of its group".into(), |name| format!("`{}`", name.spell()));
            let offered = matched.argument(Slot::Offered).map_or("S: SO<3>".into(), Argument::spell);
            let known = joined([offered, names.configuration.spell(), names.element.spell()]);
            refuse!(self.context.diagnostics, matched.closure.head, "the symmetry has no {name}";
                help "write `|{known}| …`";
                note "it moves configurations and group elements together, so it takes both");
        }
        matched.argument(Slot::Offered)
    }

    /// The element of the symmetry's group, as a factor.
    fn offered(&self, argument: &Argument, index: usize) -> Option<Factor<'g>> {
        let diagnostics = self.context.diagnostics;
        let Pattern::Name(ident) = &argument.pattern else {
            refuse!(diagnostics, argument.pattern.place(), "a symmetry has one group";
                help "offer a product as several symmetries, `symmetry = [|S: SO<3>, …| …, …]`");
        };
        let name = syn::ext::IdentExt::unraw(ident).to_string();
        let Some(ty) = &argument.ty else {
            refuse!(diagnostics, ident, "`{name}` has no type in the symmetry";
                help "write `{name}: SO<3>`"; note "its type declares the group of the symmetry");
        };
        if matches!(ty, Type::Tuple(_) | Type::Array(_)) {
            refuse!(diagnostics, ty, "`{}` is a product, but a symmetry has one group", spell_type(ty);
                help "offer several symmetries, `symmetry = [|S: SO<3>, …| …, …]`");
        }
        let group = diagnostics.take(known_group(ty, self.names))?;
        Some(Factor::new(self.context.graph, (group, ty), name, Role::OfferedElement(index)))
    }

    /// q′ and F′ of the pair that the closure gives.
    fn images(&self, closure: &Closure, value: &Value<'g>) -> Option<(Vec<Expr<'g>>, Vec<Expr<'g>>)> {
        let diagnostics = self.context.diagnostics;
        let (configuration, element) = (self.arguments.names.configuration, self.arguments.names.element);
        let (q, f) = (configuration.spell(), element.spell());
        let parts = if let Value::Tuple(parts) = value { parts.as_slice() } else { &[] };
        let body = tail(&closure.body);
        let [point, moved] = parts else {
            refuse!(diagnostics, body, "the symmetry gives {}, but it has to give a pair", value.describe();
                help "give the moved `{q}` and the moved `{f}`, as in `(S * {q}, {f})`");
        };
        // the two halves of the pair that gives a body its value, or twice the body
        let [first, second] = match body {
            syn::Expr::Tuple(tuple) if tuple.elems.len() == 2 => [&tuple.elems[0], &tuple.elems[1]],
            other => [other, other],
        };
        let elements = Space { layout: self.element.clone(), leaves: self.factors.each(as_leaf) };
        let key = &closure.key;
        let points = self.space.leaves_of((key, first), point, &new_value_of(configuration), diagnostics);
        let moved = elements.leaves_of((key, second), moved, &new_value_of(element), diagnostics);
        let (points, moved) = points.zip(moved)?;
        let foreign = |images: &[Expr<'g>], space: &Space<'g>| {
            let is_read = |symbol: &Expr<'g>| images.iter().any(|image| image.depends_on(*symbol));
            space.leaves.iter().map(|leaf| leaf.symbol).find(is_read)
        };
        if let Some(symbol) = foreign(&points, &elements) {
            refuse!(diagnostics, first, "the symmetry moves `{q}` by `{symbol}`";
                note "it moves a configuration to the same place whatever the step is");
        }
        if let Some(symbol) = foreign(&moved, self.space) {
            refuse!(diagnostics, second, "the symmetry moves `{f}` by `{symbol}`";
                note "it moves a group element in the same way wherever the configuration is");
        }
        Some((points, moved))
    }

    /// The symmetry is an action on configurations and elements together, and agrees with the action of the system.
    fn check(
        &self,
        closure: &Closure,
        offered: &Factor<'g>,
        points: &[Expr<'g>],
        elements: &[Expr<'g>],
    ) -> Option<Side> {
        let mut leaves = self.space.leaves.clone();
        leaves.extend(self.factors.iter().map(as_leaf));
        let value = [points, elements].concat();
        let factors = [offered.clone()];
        let (graph, diagnostics) = (self.context.graph, self.context.diagnostics);
        let action = Action { graph, closure, factors: &factors, configurations: &leaves, value: &value };
        let (side, moves) = *action_laws::check(&action, diagnostics)?.first()?;
        if !moves {
            refuse!(diagnostics, &closure.body, "the symmetry by `{}` moves nothing", offered.name; help "leave it out");
        }
        // (Φ_F q)′ and Φ_{F′}(q′)
        let substituted = |images: &[Expr<'g>], values: &[Expr<'g>]| -> Vec<Expr<'g>> {
            let rules: Vec<_> = leaves.iter().map(|leaf| leaf.symbol).zip(values.iter().copied()).into_list();
            images.each(|image| image.substitute(&rules))
        };
        let stepped_then_moved = substituted(points, self.action);
        let moved_then_stepped = substituted(self.action, &value);
        if !identity::equal(&stepped_then_moved, &moved_then_stepped) {
            let leaf = first_difference(&stepped_then_moved, &moved_then_stepped);
            let (q, s, f) = (&self.space.leaves[leaf].name, &offered.name, self.arguments.names.element.spell());
            let [one, other] = both([&stepped_then_moved, &moved_then_stepped], |images| ascii(images[leaf]));
            refuse!(diagnostics, &closure.body, "the symmetry does not agree with the action";
                note "a step by `{f}` and then `{s}` moves {q} to {one}, `{s}` first and then the moved step to {other}";
                help "{}", self.example(offered, leaf));
        }
        Some(side)
    }

    /// Symmetries that agree with the usual actions, for the factor that moves a leaf.
    fn example(&self, offered: &Factor<'g>, leaf: usize) -> String {
        let moves = |factor: &&Factor<'g>| self.action[leaf].depends_on(factor.symbol);
        let factor = self.factors.iter().find(moves).unwrap_or(&self.factors[0]);
        let (q, s, f) = (&self.space.leaves[leaf].name, &offered.name, &factor.name);
        match (offered.group, factor.group) {
            (Group::Translation(_), _) => format!("for `{q} + {f}` write `({q} + {s}, {f})`"),
            (_, Group::Translation(_)) => format!("for `{q} + {f}` write `({s} * {q}, {s} * {f})`"),
            _ => format!(
                "for `{f} * {q}` write `({s} * {q}, {s} * {f} * {s}.inverse())`, for `{q} * {f}` write `({s} * {q}, {f})`"
            ),
        }
    }
}

/// A factor as a configuration that a symmetry moves.
fn as_leaf<'g>(factor: &Factor<'g>) -> Configuration<'g> {
    Configuration {
        symbol: factor.symbol,
        name: factor.name.clone(),
        space: space_of(factor.group),
        shape: factor.group.element_shape(),
        is_quaternion: factor.group == Group::UnitQuaternions,
        accessor: Access::default(),
    }
}
