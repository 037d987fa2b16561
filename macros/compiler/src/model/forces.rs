//! Forces: the closures `force` and `force_on`, with the velocity and the input that they introduce.

use clebsch_symbolic::{Expr, Group, Property, Role, Shape};

use super::arguments::{Arguments, Taken};
use super::closures::{tail, written};
use super::elaborate::{Context, Elaborator, shortened};
use super::features::{self, Feature, Found};
use super::groups::GroupNames;
use super::leaves::{Expected, leaf_names, leaves};
use super::spaces::read_spaces;
use super::value::Value;
use super::velocity::Velocity;
use super::{Access, Configuration, Factor, Force, Layout, LeafSpace};
use crate::diagnostic::{Diagnostic, Diagnostics, Location};
use crate::parse::{Argument, Closure, Declaration, Pattern, spell};

/// What forces are read for.
pub(super) struct ForcedSystem<'a, 'd, 'g> {
    pub arguments: &'a Arguments<'d, 'g>,
    pub names: GroupNames<'a>,
    pub element: &'a Layout,
    pub factors: &'a [Factor<'g>],
    pub configuration: &'a Layout,
    pub configurations: &'a [Configuration<'g>],
}

/// The forces of a declaration with their input.
pub(super) struct Forces<'g> {
    pub force: Option<Force<'g>>,
    pub inputs: Vec<Configuration<'g>>,
    pub input: Layout,
}

/// The leaves of an input, and how they nest.
pub(super) type Input<'g> = (Layout, Vec<Configuration<'g>>);

/// Reads both closures; `None` if one has an error, which was reported.
pub(super) fn read<'g>(
    context: &mut Context<'_, 'g>,
    system: &ForcedSystem<'_, '_, 'g>,
    declaration: &Declaration,
) -> Option<Forces<'g>> {
    let none = || (Layout::Tuple(Vec::new()), Vec::new());
    let of_group = declaration.force.as_ref().map(|closure| one(context, system, closure, ForceKind::OfGroup));
    let on_leaves =
        declaration.force_on.as_ref().map(|closure| one(context, system, closure, ForceKind::OnConfiguration));
    let second_input = on_leaves.iter().flatten().any(|read| read.input.is_some());
    if let Some(closure) = &declaration.force_on {
        let first_input = of_group.iter().flatten().any(|read| read.input.is_some());
        if first_input && second_input {
            context.diagnostics.push(two_inputs(closure));
            return None;
        }
    }
    let (of_group, on_leaves) =
        (of_group.map_or(Some(None), |read| read.map(Some))?, on_leaves.map_or(Some(None), |read| read.map(Some))?);
    let velocities = of_group.iter().chain(&on_leaves).next().map(|read| read.velocities.clone());
    let input = of_group.iter().chain(&on_leaves).find_map(|read| read.input.clone());
    let (input, inputs) = input.unwrap_or_else(none);
    // both closures speak of one velocity, each under its own name
    let renamed = |read: ReadForce<'g>| -> Vec<Expr<'g>> {
        let names: Vec<_> = read.velocities.iter().copied().zip(velocities.iter().flatten().copied()).collect();
        read.value.iter().map(|part| part.substitute(&names)).collect()
    };
    let closures = declaration.force.iter().chain(&declaration.force_on);
    let force = velocities.clone().map(|velocities| Force {
        of_group: of_group.map(renamed),
        on_configuration: on_leaves.map(renamed),
        velocities,
        written: closures.map(written).collect(),
    });
    Some(Forces { force, inputs, input })
}

/// What a closure gives.
#[derive(Copy, Clone, PartialEq, Eq)]
enum ForceKind {
    OfGroup,
    OnConfiguration,
}

/// A closure that has been read.
struct ReadForce<'g> {
    value: Vec<Expr<'g>>,
    velocities: Vec<Expr<'g>>,
    input: Option<Input<'g>>,
}

fn one<'g>(
    context: &mut Context<'_, 'g>,
    system: &ForcedSystem<'_, '_, 'g>,
    closure: &Closure,
    kind: ForceKind,
) -> Option<ReadForce<'g>> {
    let (taken, velocity, input) = system.arguments.force(closure, &mut context.diagnostics);
    let (value_of_velocity, velocities) = match velocity {
        Some(pattern) => named_velocity(context, system, pattern)?,
        None => (None, unnamed_velocity(context, system)),
    };
    let input = match input {
        Some(argument) => Some(read_input(context, system, argument)?),
        None => None,
    };
    let elaborated = Elaborated { taken, velocity: value_of_velocity, velocities: &velocities, input: input.as_ref() };
    let value = elaborate(context, system, closure, elaborated)?;
    let key = closure.key.to_string();
    let value = match kind {
        ForceKind::OfGroup => components(context, system, closure, &value)?,
        ForceKind::OnConfiguration => {
            let expected: Vec<Expected> = system.configurations.iter().map(Expected::point).collect();
            let is = format!("a covector at `{}`, which has its shape", system.arguments.names.configuration.spell());
            leaves(context, &closure.body, &key, &value, system.configuration, &expected, &is)?
        }
    };
    Some(ReadForce { value, velocities, input })
}

fn named_velocity<'g>(
    context: &mut Context<'_, 'g>,
    system: &ForcedSystem<'_, '_, 'g>,
    pattern: &Pattern,
) -> Option<(Option<Value<'g>>, Vec<Expr<'g>>)> {
    let velocity = Velocity { graph: context.graph, factors: system.factors };
    let (value, velocities) = velocity.of(pattern, system.element, &mut context.diagnostics)?;
    Some((Some(value), velocities))
}

/// The symbols of a velocity that the closure does not ask for.
fn unnamed_velocity<'g>(context: &Context<'_, 'g>, system: &ForcedSystem<'_, '_, 'g>) -> Vec<Expr<'g>> {
    let symbol = |(k, factor): (usize, &Factor<'g>)| {
        let shape = Shape::vector(factor.group.dimension());
        context.graph.symbol("velocity", shape, Role::Algebra(k), Property::General)
    };
    system.factors.iter().enumerate().map(symbol).collect()
}

/// The leaves of a typed argument: spaces of vectors.
pub(super) fn read_input<'g>(
    context: &mut Context<'_, 'g>,
    system: &ForcedSystem<'_, '_, 'g>,
    argument: &Argument,
) -> Option<Input<'g>> {
    let ty = argument.ty.as_ref()?;
    let product = read_spaces(ty, system.names, &mut context.diagnostics)?;
    if let Some((_, ty)) =
        product.leaves.iter().find(|(leaf, _)| leaf.space != LeafSpace::Vectors || leaf.is_quaternion)
    {
        context.diagnostics.push(no_input(Location::of(*ty)));
        return None;
    }
    let names = leaf_names(&argument.pattern, &product.structure, &mut context.diagnostics)?;
    let accessors = product.structure.accessors();
    let leaf = |(i, ((leaf, _), (name, accessor))): (usize, (&(super::spaces::SpaceType<'_>, _), (String, Access)))| {
        let symbol = context.graph.symbol(&name, leaf.shape, Role::Input(i), Property::General);
        Configuration { symbol, name, space: leaf.space, shape: leaf.shape, is_quaternion: false, accessor }
    };
    let leaves = product.leaves.iter().zip(names.into_iter().zip(accessors)).enumerate().map(leaf).collect();
    Some((product.structure, leaves))
}

/// What an input is in a closure.
pub(super) fn value_of<'g>((structure, leaves): &Input<'g>) -> Value<'g> {
    let values: Vec<_> = leaves.iter().map(|leaf| Value::Matrix(leaf.symbol)).collect();
    Value::nested(structure, &values)
}

struct Elaborated<'a, 'g> {
    taken: Taken,
    velocity: Option<Value<'g>>,
    velocities: &'a [Expr<'g>],
    input: Option<&'a Input<'g>>,
}

fn elaborate<'g>(
    context: &mut Context<'_, 'g>,
    system: &ForcedSystem<'_, '_, 'g>,
    closure: &Closure,
    given: Elaborated<'_, 'g>,
) -> Option<Value<'g>> {
    let input = given.input.map(value_of);
    let (taken, diagnostics) = (&given.taken, &mut context.diagnostics);
    let mut scope = system.arguments.force_scope(closure, taken, given.velocity, input, diagnostics);
    let groups: Vec<Group> = system.factors.iter().map(|factor| factor.group).collect();
    scope.set_velocities(given.velocities.iter().copied().zip(groups).collect());
    let key = closure.key.to_string();
    Elaborator::new(context, &key, scope).elaborate(&closure.body)
}

/// The components of each factor: a vector, or a tuple with a vector for each block of its algebra, `(torque, force)` on SE(3).
pub(super) fn components<'g>(
    context: &mut Context<'_, 'g>,
    system: &ForcedSystem<'_, '_, 'g>,
    closure: &Closure,
    value: &Value<'g>,
) -> Option<Vec<Expr<'g>>> {
    let mut parts = Vec::new();
    let Err((found, needed)) = flatten(context, system, value, system.element, &mut parts) else { return Some(parts) };
    let text = shortened(&spell(&closure.body));
    let (gives, has, is) = match closure.key == "controls" {
        true => ("the controls give", "they have", "a velocity in the group: it has the components of its Lie algebra"),
        false => ("the force gives", "it has", "a covector of the group: it has the components of the momentum"),
    };
    let error = Diagnostic::new(tail(&closure.body).0, format!("{gives} {found}, but {has} to give {needed}"))
        .note(format!("`{text}` is {is}"));
    context.diagnostics.push(error);
    None
}

fn flatten<'g>(
    context: &Context<'_, 'g>,
    system: &ForcedSystem<'_, '_, 'g>,
    value: &Value<'g>,
    structure: &Layout,
    parts: &mut Vec<Expr<'g>>,
) -> Result<(), (String, String)> {
    let factor = |k: usize| &system.factors[k];
    match (value, structure) {
        (Value::Matrix(expr), Layout::Leaf(k)) if expr.shape() == Shape::vector(factor(*k).group.dimension()) => {
            parts.push(*expr);
            Ok(())
        }
        (Value::Tuple(values), Layout::Leaf(k)) => match stacked(context, factor(*k), values) {
            Some(expr) => {
                parts.push(expr);
                Ok(())
            }
            None => Err((value.describe(), wanted(factor(*k)))),
        },
        (Value::Tuple(values), Layout::Tuple(inner)) | (Value::Array(values), Layout::Array(inner))
            if values.len() == inner.len() =>
        {
            values.iter().zip(inner).try_for_each(|(value, part)| flatten(context, system, value, part, parts))
        }
        (value, Layout::Leaf(k)) => Err((value.describe(), wanted(factor(*k)))),
        (value, Layout::Tuple(inner)) => Err((value.describe(), format!("a tuple of {}", inner.len()))),
        (value, Layout::Array(inner)) => Err((value.describe(), format!("an array of {}", inner.len()))),
    }
}

fn wanted(factor: &Factor<'_>) -> String {
    format!("{} for `{}`", Shape::vector(factor.group.dimension()), factor.name)
}

/// One vector from those of the blocks.
fn stacked<'g>(context: &Context<'_, 'g>, factor: &Factor<'g>, values: &[Value<'g>]) -> Option<Expr<'g>> {
    let (blocks, shape) = (context.graph.blocks(factor.group), Shape::vector(factor.group.dimension()));
    if blocks.len() != values.len() {
        return None;
    }
    let mut whole = context.graph.zero(shape);
    for (block, value) in blocks.iter().zip(values) {
        let part = value.matrix().filter(|part| part.shape() == Shape::vector(block.algebra.dimension()))?;
        whole = whole + part.embed(shape, block.offset, 0);
    }
    Some(whole)
}

fn no_input(place: Location) -> Diagnostic {
    Diagnostic::new(place, "an input is made of vectors and matrices")
        .help("write `u: Vector3`, or a tuple of such, `(torque, thrust): (Vector3, Vector1)`")
        .note("forces are linear spaces: sums and multiples of inputs are inputs")
}

fn two_inputs(closure: &Closure) -> Diagnostic {
    Diagnostic::new(closure.head, "both `force` and `force_on` take an input")
        .help("let one of the two take the whole input, as a tuple where it has parts")
        .note("a step has one input, `stepper.step_with(&state, &input)`")
}

/// What forces do not go with.
pub(super) fn check_dials(declaration: &Declaration, diagnostics: &mut Diagnostics) {
    let Some(force) = declaration.force.as_ref().or(declaration.force_on.as_ref()) else { return };
    let boundary = |feature| Found::when(feature == Feature::Boundary && declaration.dials.emit.boundary);
    let refused = features::refusals_of((Feature::Forces, Found::at(force.head)), boundary);
    refused.for_each(|error| diagnostics.push(error));
}
