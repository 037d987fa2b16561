//! Symmetries that the user offers: `|S: SO<3>, q, F| (q′, F′)`, checked to be actions that agree with the action of the system.

use clebsch_symbolic::{Expr, Group, Role, identity};
use syn::Type;

use super::action_errors::ascii;
use super::action_laws::{self, Action};
use super::arguments::Arguments;
use super::closures;
use super::elaborate::{Context, Elaborator};
use super::groups::{GroupNames, group, unknown_group};
use super::leaves::{self, Expected};
use super::spaces::{space_of, span_of};
use super::value::Value;
use super::{Access, Configuration, Factor, Layout, OfferedSymmetry, Side};
use crate::diagnostic::{Diagnostic, Location};
use crate::parse::{Argument, Closure, Pattern, spell_type};

/// The system that symmetries are offered for.
pub(super) struct OfferedSystem<'a, 'g> {
    pub arguments: &'a Arguments<'a, 'g>,
    pub names: GroupNames<'a>,
    pub element: &'a Layout,
    pub factors: &'a [Factor<'g>],
    pub configuration: &'a Layout,
    pub configurations: &'a [Configuration<'g>],
    /// Φ_F(q), leaf by leaf.
    pub action: &'a [Expr<'g>],
}

impl<'g> OfferedSystem<'_, 'g> {
    /// Reads and checks one symmetry.
    pub fn symmetry(
        &self,
        context: &mut Context<'_, 'g>,
        closure: &Closure,
        index: usize,
    ) -> Option<OfferedSymmetry<'g>> {
        let (taken, argument) = self.arguments.symmetry(closure, &mut context.diagnostics)?;
        let offered = self.offered(context, argument, index);
        let value = offered.as_ref().map(|factor| Value::leaf(factor.symbol, factor.group == Group::UnitQuaternions));
        let scope = self.arguments.symmetry_scope(closure, &taken, value, &mut context.diagnostics);
        let value = Elaborator::new(context, "symmetry", scope).elaborate(&closure.body)?;
        let (configurations, elements) = self.images(context, closure, &value)?;
        let offered = offered?;
        let side = self.check(context, closure, &offered, &configurations, &elements)?;
        let Factor { group, symbol, name, .. } = offered;
        Some(OfferedSymmetry {
            group,
            symbol,
            name,
            side,
            configurations,
            elements,
            written: closures::written(closure),
        })
    }

    /// The element of the symmetry's group, as a factor.
    fn offered(&self, context: &mut Context<'_, 'g>, argument: &Argument, index: usize) -> Option<Factor<'g>> {
        let Pattern::Name(ident) = &argument.pattern else {
            let error = Diagnostic::new(argument.pattern.place(), "a symmetry has one group");
            return refuse(
                context,
                error.help("offer a product as several symmetries, `symmetry = [|S: SO<3>, …| …, …]`"),
            );
        };
        let name = syn::ext::IdentExt::unraw(ident).to_string();
        let Some(ty) = &argument.ty else {
            let error = Diagnostic::new(ident.span(), format!("`{name}` has no type in the symmetry"));
            let error =
                error.help(format!("write `{name}: SO<3>`")).note("its type declares the group of the symmetry");
            return refuse(context, error);
        };
        if matches!(ty, Type::Tuple(_) | Type::Array(_)) {
            let error = Diagnostic::new(
                Location::of(ty),
                format!("`{}` is a product, but a symmetry has one group", spell_type(ty)),
            );
            return refuse(context, error.help("offer several symmetries, `symmetry = [|S: SO<3>, …| …, …]`"));
        }
        match group(ty, self.names).unwrap_or_else(|| Err(unknown_group(ty, self.names))) {
            Ok(group) => {
                let role = Role::OfferedElement(index);
                let symbol = context.graph.symbol(&name, group.element_shape(), role, group.element_property());
                let accessor = Access::default();
                let span = span_of(ty);
                Some(Factor { group, symbol, name, side: Side::Left, moves: true, accessor, span })
            }
            Err(error) => refuse(context, error),
        }
    }

    /// q′ and F′ of the pair that the closure gives.
    fn images(
        &self,
        context: &mut Context<'_, 'g>,
        closure: &Closure,
        value: &Value<'g>,
    ) -> Option<(Vec<Expr<'g>>, Vec<Expr<'g>>)> {
        let (q, f) = (self.arguments.names.configuration.spell(), self.arguments.names.element.spell());
        let Value::Tuple(parts) = value else {
            let message = format!("the symmetry gives {}, but it has to give a pair", value.describe());
            return refuse(context, Diagnostic::new(closures::tail(&closure.body).0, message).help(pair(&q, &f)));
        };
        let [point, element] = parts.as_slice() else {
            let message = format!("the symmetry gives a tuple of {}, but it has to give a pair", parts.len());
            return refuse(context, Diagnostic::new(closures::tail(&closure.body).0, message).help(pair(&q, &f)));
        };
        let points: Vec<Expected> = self.configurations.iter().map(Expected::point).collect();
        let elements: Vec<Expected> = self.factors.iter().map(Expected::element).collect();
        let [first, second] = halves(&closure.body);
        let point =
            leaves::leaves(context, first, "symmetry", point, self.configuration, &points, &leaves::new_value_of(&q));
        let element =
            leaves::leaves(context, second, "symmetry", element, self.element, &elements, &leaves::new_value_of(&f));
        let (point, element) = point.zip(element)?;
        let foreign = |images: &[Expr<'g>], symbols: &[Expr<'g>]| {
            symbols.iter().find(|symbol| images.iter().any(|image| image.depends_on(**symbol))).copied()
        };
        let points: Vec<Expr<'g>> = self.configurations.iter().map(|leaf| leaf.symbol).collect();
        let elements: Vec<Expr<'g>> = self.factors.iter().map(|factor| factor.symbol).collect();
        if let Some(symbol) = foreign(&point, &elements) {
            let message = format!("the symmetry moves `{q}` by `{symbol}`");
            let error = Diagnostic::new(Location::of(first), message);
            return refuse(context, error.note("it moves a configuration to the same place whatever the step is"));
        }
        if let Some(symbol) = foreign(&element, &points) {
            let message = format!("the symmetry moves `{f}` by `{symbol}`");
            let error = Diagnostic::new(Location::of(second), message);
            return refuse(
                context,
                error.note("it moves a group element in the same way wherever the configuration is"),
            );
        }
        Some((point, element))
    }

    /// The symmetry is an action on configurations and elements together, and agrees with the action of the system.
    fn check(
        &self,
        context: &mut Context<'_, 'g>,
        closure: &Closure,
        offered: &Factor<'g>,
        points: &[Expr<'g>],
        elements: &[Expr<'g>],
    ) -> Option<Side> {
        let as_leaf = |factor: &Factor<'g>| Configuration {
            symbol: factor.symbol,
            name: factor.name.clone(),
            space: space_of(factor.group),
            shape: factor.group.element_shape(),
            is_quaternion: factor.group == Group::UnitQuaternions,
            accessor: Access::default(),
        };
        let leaves: Vec<Configuration<'g>> =
            self.configurations.iter().cloned().chain(self.factors.iter().map(as_leaf)).collect();
        let value: Vec<Expr<'g>> = points.iter().chain(elements).copied().collect();
        let factors = [offered.clone()];
        let graph = context.graph;
        let action = Action { graph, closure, factors: &factors, configurations: &leaves, value: &value };
        let law = *action_laws::check(&action, &mut context.diagnostics)?.first()?;
        if !law.moves {
            let message = format!("the symmetry by `{}` moves nothing", offered.name);
            return refuse(context, Diagnostic::new(Location::of(&closure.body), message).help("leave it out"));
        }
        let (stepped_then_moved, moved_then_stepped) = self.both_orders(points, elements);
        if !identity::equal(&stepped_then_moved, &moved_then_stepped) {
            let differs = |(a, b): (&Expr<'g>, &Expr<'g>)| !identity::equal(&[*a], &[*b]);
            let leaf = stepped_then_moved.iter().zip(&moved_then_stepped).position(differs).unwrap_or(0);
            let example = self.example(offered, leaf);
            let (q, s) = (&self.configurations[leaf].name, &offered.name);
            let step = self.arguments.names.element.spell();
            let error = Diagnostic::new(Location::of(&closure.body), "the symmetry does not agree with the action")
                .note(format!(
                    "a step by `{step}` and then `{s}` moves {q} to {}, `{s}` first and then the moved step to {}",
                    ascii(stepped_then_moved[leaf]),
                    ascii(moved_then_stepped[leaf])
                ))
                .help(example);
            return refuse(context, error);
        }
        Some(law.side)
    }

    /// Symmetries that agree with the usual actions, for the factor that moves a leaf.
    fn example(&self, offered: &Factor<'g>, leaf: usize) -> String {
        let moves = |factor: &&Factor<'g>| self.action[leaf].depends_on(factor.symbol);
        let factor = self.factors.iter().find(moves).unwrap_or(&self.factors[0]);
        let (q, s, f) = (&self.configurations[leaf].name, &offered.name, &factor.name);
        match (offered.group, factor.group) {
            (Group::Translation(_), _) => format!("for `{q} + {f}` write `({q} + {s}, {f})`"),
            (_, Group::Translation(_)) => format!("for `{q} + {f}` write `({s} * {q}, {s} * {f})`"),
            _ => format!(
                "for `{f} * {q}` write `({s} * {q}, {s} * {f} * {s}.inverse())`, for `{q} * {f}` write `({s} * {q}, {f})`"
            ),
        }
    }

    /// (Φ_F q)′ and Φ_{F′}(q′).
    fn both_orders(&self, points: &[Expr<'g>], elements: &[Expr<'g>]) -> (Vec<Expr<'g>>, Vec<Expr<'g>>) {
        let at = |values: &[Expr<'g>]| {
            self.configurations.iter().map(|leaf| leaf.symbol).zip(values.iter().copied()).collect()
        };
        let stepped: Vec<(Expr<'g>, Expr<'g>)> = at(self.action);
        let mut moved: Vec<(Expr<'g>, Expr<'g>)> = at(points);
        moved.extend(self.factors.iter().map(|factor| factor.symbol).zip(elements.iter().copied()));
        (
            points.iter().map(|image| image.substitute(&stepped)).collect(),
            self.action.iter().map(|image| image.substitute(&moved)).collect(),
        )
    }
}

fn pair(q: &str, f: &str) -> String {
    format!("give the moved `{q}` and the moved `{f}`, as in `(S * {q}, {f})`")
}

/// The two halves of the pair that gives a body its value, or twice the body.
fn halves(body: &syn::Expr) -> [&syn::Expr; 2] {
    match closures::tail(body).1 {
        syn::Expr::Tuple(tuple) if tuple.elems.len() == 2 => [&tuple.elems[0], &tuple.elems[1]],
        other => [other, other],
    }
}

fn refuse<T>(context: &mut Context<'_, '_>, error: Diagnostic) -> Option<T> {
    context.diagnostics.push(error);
    None
}

/// All symmetries of a declaration.
pub(super) fn read<'g>(
    context: &mut Context<'_, 'g>,
    system: &OfferedSystem<'_, 'g>,
    closures: &[Closure],
) -> Vec<OfferedSymmetry<'g>> {
    closures.iter().enumerate().filter_map(|(index, closure)| system.symmetry(context, closure, index)).collect()
}
