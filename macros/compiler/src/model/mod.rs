//! The second stage: the declaration as mathematics, with names resolved, shapes checked and the action's laws verified.

mod action_errors;
mod action_laws;
mod arguments;
mod closures;
mod elaborate;
mod fields;
mod groups;
mod outline;
mod print;
mod scalar;
mod scope;
mod sizes;
mod slots;
mod spaces;
mod structure;
mod types;
mod value;
mod vectors;

pub use crate::parse::{Discretization, Emit, Order, Promise};
pub use outline::{Outline, outline};
pub use structure::Structure;
pub use types::*;

use clebsch_symbolic::{Expr, Graph, Group, Property, Role, Shape};

use self::action_laws::Action;
use self::arguments::{Arguments, TypedArguments};
use self::elaborate::Context;
use self::spaces::{Product, SpaceType};
use self::value::Value;
use crate::diagnostic::Diagnostics;
use crate::parse::{Declaration, Pattern};

/// The model of a declaration.
pub fn model<'g>(graph: &'g Graph, declaration: &Declaration) -> Result<Model<'g>, Diagnostics> {
    let mut diagnostics = Diagnostics::new();
    let types = arguments::of_action(&declaration.action, &mut diagnostics);
    let generics = &declaration.generics;
    let groups = types.and_then(|types| spaces::read_groups(types.group, generics, &mut diagnostics));
    let spaces = types.and_then(|types| spaces::read_spaces(types.space, generics, &mut diagnostics));
    let scalars: Vec<Option<&syn::Type>> =
        spaces.iter().flat_map(|spaces| spaces.leaves.iter().map(|(leaf, _)| leaf.scalar)).collect();
    let fields = fields::read(graph, declaration, &scalars, &mut diagnostics);
    let (Some(TypedArguments { element, configuration, .. }), Some(groups), Some(spaces)) = (types, groups, spaces)
    else {
        return diagnostics.propagate(()).and(Err(Diagnostics::new()));
    };

    let factors = factors(graph, element, &groups, &mut diagnostics);
    let configurations = configurations(graph, configuration, &spaces, &mut diagnostics);
    let nested = |structure: &Structure, symbols: Option<Vec<Expr<'g>>>| {
        symbols.map(|symbols| Value::nested(structure, &symbols))
    };
    let step_size = graph.symbol("h", Shape::scalar(), Role::StepSize, Property::General);
    let arguments = Arguments {
        element,
        configuration,
        element_value: nested(
            &groups.structure,
            factors.as_ref().map(|factors| factors.iter().map(|factor| factor.symbol).collect()),
        ),
        configuration_value: nested(
            &spaces.structure,
            configurations.as_ref().map(|leaves| leaves.iter().map(|leaf| leaf.symbol).collect()),
        ),
        step_size,
    };

    let mut context = Context { graph, fields: &fields, constants: Vec::new(), diagnostics };
    let action = closures::action(&mut context, declaration, &arguments, &spaces.structure, configurations.as_deref());
    let kinetic = closures::kinetic(&mut context, declaration, &arguments, factors.as_deref());
    let potential = closures::potential(&mut context, declaration, &arguments);
    let Context { constants, mut diagnostics, .. } = context;

    let sides = match (&action, &factors, &configurations) {
        (Some(value), Some(factors), Some(configurations)) => {
            let action = Action { graph, closure: &declaration.action, factors, configurations, value };
            action_laws::check(&action, &mut diagnostics)
        }
        _ => None,
    };
    diagnostics.propagate(())?;
    let (Some(mut factors), Some(configurations), Some(action), Some(sides), Some(kinetic)) =
        (factors, configurations, action, sides, kinetic)
    else {
        // by construction: what is missing has an error, and there were none
        return Err(Diagnostics::new());
    };
    factors.iter_mut().zip(sides).for_each(|(factor, side)| factor.side = side);
    let dials = &declaration.dials;
    Ok(Model {
        graph,
        item: Item {
            ident: declaration.ident.clone(),
            vis: declaration.vis.clone(),
            generics: declaration.generics.clone(),
            scalar: fields.scalar,
            krate: dials.krate.clone().unwrap_or_else(|| syn::parse_quote!(::clebsch)),
        },
        parameters: fields.parameters,
        constants,
        step_size,
        factors,
        element: groups.structure,
        configurations,
        configuration: spaces.structure,
        action,
        kinetic,
        potential,
        order: dials.order.as_ref().map_or(Order::Second, |order| order.value),
        emit: dials.emit,
        spans: closures::spans(declaration),
    })
}

/// The factors of the group, the side of each still open.
fn factors<'g>(
    graph: &'g Graph,
    pattern: &Pattern,
    groups: &Product<Group>,
    diagnostics: &mut Diagnostics,
) -> Option<Vec<Factor<'g>>> {
    let names = closures::leaf_names(pattern, &groups.structure, diagnostics)?;
    let mut factors = Vec::new();
    for (&(group, ty), (name, accessor)) in
        groups.leaves.iter().zip(names.into_iter().zip(groups.structure.accessors()))
    {
        let role = Role::Element(factors.len());
        let symbol = graph.symbol(&name, group.element_shape(), role, group.element_property());
        factors.push(Factor { group, symbol, name, side: Side::Left, accessor, span: spaces::span_of(ty) });
    }
    Some(factors)
}

fn configurations<'g>(
    graph: &'g Graph,
    pattern: &Pattern,
    spaces: &Product<SpaceType>,
    diagnostics: &mut Diagnostics,
) -> Option<Vec<Configuration<'g>>> {
    let names = closures::leaf_names(pattern, &spaces.structure, diagnostics)?;
    let mut configurations = Vec::new();
    for ((leaf, _), (name, accessor)) in spaces.leaves.iter().zip(names.into_iter().zip(spaces.structure.accessors())) {
        let role = Role::Configuration(configurations.len());
        let symbol = graph.symbol(&name, leaf.shape, role, leaf.property());
        configurations.push(Configuration { symbol, name, space: leaf.space, shape: leaf.shape, accessor });
    }
    Some(configurations)
}
