//! The second stage: the declaration as mathematics, with names resolved, shapes checked and the action's laws verified.

mod action_laws;
mod arguments;
mod closures;
mod elaborate;
mod fields;
mod groups;
mod print;
mod scope;
mod sizes;
mod spaces;
mod structure;
mod types;
mod value;
mod vectors;

pub use structure::Structure;
pub use types::*;

use clebsch_symbolic::{Expr, Graph, Group, Property, Role, Shape};

use self::action_laws::Action;
use self::arguments::Arguments;
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
    let groups = types.and_then(|((_, group), _)| spaces::read_groups(group, generics, &mut diagnostics));
    let spaces = types.and_then(|(_, (_, space))| spaces::read_spaces(space, generics, &mut diagnostics));
    let scalars: Vec<Option<&syn::Type>> = spaces.iter().flat_map(|spaces| spaces.leaves.iter().map(|(leaf, _)| leaf.scalar)).collect();
    let fields = fields::read(graph, declaration, &scalars, &mut diagnostics);
    let (Some(((element, _), (configuration, _))), Some(groups), Some(spaces)) = (types, groups, spaces) else {
        return diagnostics.propagate(()).and(Err(Diagnostics::new()));
    };

    let factors = factors(graph, element, &groups, &mut diagnostics);
    let configurations = configurations(graph, configuration, &spaces, &mut diagnostics);
    let nested = |structure: &Structure, symbols: Option<Vec<Expr<'g>>>| symbols.map(|symbols| Value::nested(structure, &symbols));
    let step_size = graph.symbol("h", Shape::scalar(), Role::StepSize, Property::General);
    let arguments = Arguments {
        element,
        configuration,
        element_value: nested(&groups.structure, factors.as_ref().map(|factors| factors.iter().map(|factor| factor.symbol).collect())),
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
    let leaves = groups.leaves.iter().zip(names).zip(groups.structure.accessors()).enumerate();
    let factor = |(index, ((&(group, ty), name), accessor)): (usize, ((&(Group, &syn::Type), String), String))| Factor {
        group,
        symbol: graph.symbol(&name, group.element_shape(), Role::Element(index), group.element_property()),
        name,
        side: Side::Left,
        accessor,
        span: spaces::span_of(ty),
    };
    Some(leaves.map(factor).collect())
}

fn configurations<'g>(
    graph: &'g Graph,
    pattern: &Pattern,
    spaces: &Product<SpaceType>,
    diagnostics: &mut Diagnostics,
) -> Option<Vec<Configuration<'g>>> {
    let names = closures::leaf_names(pattern, &spaces.structure, diagnostics)?;
    let leaves = spaces.leaves.iter().zip(names).zip(spaces.structure.accessors()).enumerate();
    let leaf = |(index, (((leaf, _), name), accessor)): (usize, ((&(SpaceType, _), String), String))| Configuration {
        symbol: graph.symbol(&name, leaf.shape, Role::Configuration(index), leaf.property()),
        name,
        space: leaf.space,
        shape: leaf.shape,
        accessor,
    };
    Some(leaves.map(leaf).collect())
}
