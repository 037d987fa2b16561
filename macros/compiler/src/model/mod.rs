//! The second stage: the declaration as mathematics, with names resolved, shapes checked and the action's laws verified.

mod action_errors;
mod action_laws;
mod arguments;
mod closures;
mod comparisons;
mod constraint;
mod control;
mod declared;
mod elaborate;
pub(crate) mod features;
mod field;
mod fields;
mod forces;
mod groups;
mod joints;
mod layout;
mod momentum;
mod outline;
mod power;
mod print;
mod quaternion;
mod references;
mod scalar;
mod scope;
mod shapes;
mod sites;
mod slots;
mod space;
mod space_names;
mod spaces;
mod symmetries;
mod target;
#[cfg(test)]
mod tests;
mod typed;
mod types;
mod value;

pub use crate::parse::dials::*;
pub use crate::parse::{Located, Opaque};
pub use arguments::ByNumber;
pub(crate) use elaborate::functions_as_markdown;
pub(crate) use features::{features_as_markdown, refused_with};
pub(crate) use groups::groups_as_markdown;
pub use groups::is_large;
pub use layout::{Access, Layout, Part};
pub use outline::{Nested, Outline, outline};
pub use power::{Joint, Joints, Length, Linear, Range, SiteIndex, Term};
pub(crate) use shapes::{IN_LOOPS, spelled};
pub(crate) use slots::arguments_of;
pub use types::*;

use std::rc::Rc;

use clebsch_symbolic::{Expr, Graph, IntoList, Role};

use self::action_laws::Action;
use self::closures::{Closures, optional};
use self::elaborate::Context;
use self::features::{Feature, Found};
use self::groups::GroupNames;
use self::references::{Introduced, References};
use self::sites::Sites;
use self::space::Space;
use self::typed::{ActedSystem, Arguments, Typed};
use crate::diagnostic::Diagnostics;
use crate::parse::{self, Declaration, Potential};

/// Whether a declaration may be one of sites by a number. Joints are faster site by site; the potential alone is not.
pub fn may_be_sites(declaration: &Declaration) -> bool {
    let Declaration { action, constraints, dials, generics, .. } = declaration;
    let is_unrolled = dials.code.as_ref().is_some_and(|code| code.value == CodeForm::Unrolled);
    let by_number = |argument: &parse::Argument| {
        let sites = argument.ty.as_ref().and_then(|ty| arguments::sites_of(ty, generics));
        matches!(sites, Some((Length::Number(_), _)))
    };
    !constraints.is_empty() && !is_unrolled && action.arguments.iter().all(by_number)
}

/// The model of a declaration.
///
/// # Errors
/// Everything that is wrong with it. Read by sites, also closures that are no formulas of one site.
pub fn model<'g>(graph: &'g Graph, declaration: &Declaration, by_number: ByNumber) -> Result<Model<'g>, Diagnostics> {
    let diagnostics = Diagnostics::new();
    let declared = declared::read_all(graph, &declaration.groups, &diagnostics);
    // a type cannot name a group that has an error
    diagnostics.propagate(())?;
    let diagnostics = Diagnostics::new();
    let names = GroupNames { generics: &declaration.generics, declared: &declared, diagnostics: &diagnostics };
    let types = arguments::of_action(declaration, by_number, &diagnostics);
    let sites = types.as_ref().and_then(|types| types.sites.as_ref());
    if sites.is_some() {
        sites::check(declaration, &diagnostics);
    }
    field::check(declaration, &diagnostics);
    if let Some(types) = &types {
        // the types mean nothing in another order
        arguments::check_order(types, names)?;
    }
    let groups = types.as_ref().and_then(|types| spaces::read_groups(types.group, names));
    if let (Some(Length::Number(count)), Some(groups)) = (sites, &groups)
        && !sites::are_many(*count, groups)
    {
        return Err(Diagnostics::new());
    }
    let spaces = types.as_ref().and_then(|types| spaces::read_spaces(types.space, names));
    let scalars: Vec<&syn::Type> =
        spaces.iter().flat_map(|spaces| &spaces.leaves).filter_map(|(leaf, _)| leaf.scalar).into_list();
    let fields = fields::read(graph, declaration, &scalars, sites, &diagnostics);
    let (Some(types), Some(groups), Some(spaces)) = (&types, groups, spaces) else { return Err(diagnostics) };
    let typed = Typed::new(graph, types, groups, spaces);
    // before the laws of the action are looked at in all directions
    if let (Some(factors), Some(space)) = (&typed.factors, &typed.space)
        && let Some(error) = groups::large(declaration, factors, &space.leaves)
    {
        diagnostics.push(error);
        return Err(diagnostics);
    }
    let Introduced { of_steps, of_end, of_forces } = &types.references;
    // a choice has one vector of inputs, and references of forces are read behind it
    let of_step = |number, leaf| if number < *of_forces { Role::Input(1 + leaf) } else { Role::Reference(leaf) };
    let references = [
        References::read(graph, of_steps, of_step, names),
        References::read(graph, of_end, |_, leaf| Role::EndReference(leaf), names),
    ];
    if let Some(argument) = of_end.first() {
        let reference = (Feature::ReferenceOfEnd, Found::at(argument.pattern.place()).named(argument.pattern.spell()));
        diagnostics.extend(features::refusals_of(reference, |feature| features::declared(declaration, feature)));
    }
    let arguments = typed.arguments(graph, types.clone(), references);
    let configuration_names = types.configuration.clone();
    let power = sites.zip(typed.space.clone()).map(|(length, space)| {
        Sites::new(graph, length.clone(), space, types.configuration.spell(), fields.leaf_count())
    });
    let mut context = Context::new(graph, &fields, &declaration.generics, power, &diagnostics);
    let formulas = ClosureValues::read(&mut context, declaration, &arguments, &typed, names);
    let Context { constants, power, .. } = context;
    let Arguments { step_size, time, references, .. } = arguments;
    let given = references[0].as_ref().map_or_else(Vec::new, |references| references.first(*of_forces));
    let formulas = formulas.zip(references[0].as_ref()).map(|(formulas, references)| ClosureValues {
        input: references.behind(formulas.input, *of_forces),
        ..formulas
    });
    let references = references.map(|references| references.map(References::joined));
    declared.check_used(&diagnostics);
    groups::check_chart(graph, &declaration.dials, typed.factors.as_deref().unwrap_or_default(), &diagnostics);
    diagnostics.propagate(())?;
    // by construction: a missing value has an error, and there were none
    let (Some(formulas), Some(mut factors), Some(space)) = (formulas, typed.factors, typed.space) else {
        return Err(Diagnostics::new());
    };
    let [Some(reference), Some(end_reference)] = references else { return Err(Diagnostics::new()) };
    for (factor, law) in factors.iter_mut().zip(formulas.laws) {
        (factor.side, factor.moves) = law;
    }
    let dials = &declaration.dials;
    let mut system = System {
        graph,
        item: Item {
            ident: declaration.ident.clone(),
            generics: declaration.generics.clone(),
            scalar: fields.scalar,
            krate: dials.krate.clone().unwrap_or_else(|| syn::parse_quote!(::clebsch)),
        },
        parameters: fields.parameters,
        constants,
        step_size,
        time,
        factors,
        element: typed.element,
        configurations: space.leaves,
        configuration: space.layout,
        configuration_names,
        action: formulas.action,
        inputs: formulas.input.leaves,
        input: formulas.input.layout,
        given,
        reference: (reference.layout, reference.leaves),
        end_reference: (end_reference.layout, end_reference.leaves),
        control: formulas.control,
        endpoint: formulas.endpoint,
        target: formulas.target,
        emit: dials.emit,
        dials: dials.of_steps(),
        spans: Spans {
            action: closures::written(&declaration.action),
            kinetic: closures::written(declaration.kinetic.closure()),
            order: dials.order.as_ref().map(|order| order.span),
            mass: parse::declared_mass(&declaration.fields, None),
        },
    };
    let kinetic = match formulas.mover {
        Mover::Momenta(kinetic) => kinetic,
        Mover::Inputs(motion) => return Ok(Model::Steered(Box::new(Steered { system: Rc::new(system), motion }))),
    };
    let (kinetic, declared) = match declaration.potential.as_ref().and_then(Potential::opaque) {
        None if power.is_none() && formulas.edges.is_empty() && !dials.emit.momentum => {
            kinetic.without_potential(&system, formulas.potential)
        }
        _ => (kinetic, formulas.potential),
    };
    let force = formulas.force;
    if dials.emit.connection {
        field::check_connection(&system, kinetic.energy())?;
    }
    if dials.emit.momentum {
        system = momentum::alone(system, kinetic.energy(), force.as_ref())?;
    }
    let declared_order = dials.order.as_ref().map_or(Order::Second, |order| order.value);
    // a composed step is one of all sites, made of steps of second order
    let order = if power.is_some() && declared_order.stages().is_some() { Order::Second } else { declared_order };
    let is_field = !formulas.edges.is_empty();
    let order = if is_field && declared_order.stages().is_some() { Order::Second } else { order };
    let mut potential = declared;
    // the sites of a field are kicked by their potential and by their edges at once
    let field = is_field.then(|| FieldEnergies {
        edges: formulas.edges,
        potential: potential.take(),
        order: declared_order,
        is_static: declaration.is_static,
    });
    let power = power.map(|power| {
        let forces = force.iter().flat_map(|force| force.of_group.iter().chain(&force.on_configuration).flatten());
        let read = [kinetic.energy()].into_iter().chain(forces.copied()).into_list();
        sites::power_of(&mut system, &read, (power, declared_order), (formulas.terms, formulas.joints))
    });
    let isotropy = dials.isotropy.as_ref().map_or(Isotropy::Fixed, |isotropy| isotropy.value);
    Ok(Model::Mechanics(Box::new(Mechanics {
        system: Rc::new(system),
        kinetic,
        potential,
        opaque: declaration.potential.as_ref().and_then(Potential::opaque).cloned(),
        monitor: formulas.monitor,
        force,
        constraint: formulas.constraint,
        power,
        field,
        symmetries: formulas.symmetries,
        isotropy: if dials.emit.momentum { Isotropy::Free } else { isotropy },
        signature: dials.signature.as_ref().map_or(Signature::Definite, |signature| signature.value),
        order,
    })))
}

/// The key that moves the configuration.
enum Mover<'g> {
    Momenta(Kinetic<'g>),
    Inputs(Motion<'g>),
}

/// The values of the closures.
struct ClosureValues<'g> {
    action: Vec<Expr<'g>>,
    laws: Vec<(Side, bool)>,
    mover: Mover<'g>,
    potential: Option<Expr<'g>>,
    monitor: Option<Monitor<'g>>,
    /// The potential of a power.
    terms: Vec<Term<'g>>,
    symmetries: Vec<OfferedSymmetry<'g>>,
    force: Option<Force<'g>>,
    constraint: Option<Constraint<'g>>,
    /// The constraint of a power.
    joints: Option<Joints<'g>>,
    /// The energies of the edges of a field.
    edges: Vec<EdgeEnergy<'g>>,
    input: Space<'g>,
    control: Option<InputChoice<'g>>,
    endpoint: Option<EndPrice<'g>>,
    target: Option<EndConditions<'g>>,
}

impl<'g> ClosureValues<'g> {
    /// Elaborates all closures, so that each reports its errors; `None` if one has an error.
    fn read(
        context: &mut Context<'_, 'g>,
        declaration: &Declaration,
        arguments: &Arguments<'_, 'g>,
        typed: &Typed<'g>,
        names: GroupNames,
    ) -> Option<ClosureValues<'g>> {
        let mut closures = Closures { context, declaration, arguments, typed };
        let action = closures.action();
        let kinetic = closures.kinetic();
        let (potential, terms) = closures.potential();
        let monitor = closures.monitor();
        let (action, factors, space) = (action?, typed.factors.as_deref()?, typed.space.as_ref()?);
        let (graph, diagnostics, closure) = (context.graph, context.diagnostics, &declaration.action);
        let acting = Action { graph, closure, factors, configurations: &space.leaves, value: &action };
        let laws = action_laws::check(&acting, diagnostics);
        let element = &typed.element;
        let mut system = ActedSystem { context, arguments, names, element, factors, space, action: &action };
        let offered = declaration.symmetries.iter().enumerate();
        let symmetries = offered.filter_map(|symmetry| system.symmetry(symmetry)).into_list();
        forces::check_dials(declaration, diagnostics);
        let is_steered = declaration.kinetic.is_steered();
        let endpoint = optional(declaration.endpoint.as_ref(), |closure| system.endpoint(closure, is_steered));
        let target = optional(declaration.target.as_ref(), |closure| system.target(closure, is_steered));
        let forces = system.forces(declaration);
        let is_power = system.context.power.is_some();
        let edges = if is_power { Some(Vec::new()) } else { system.edges(declaration) };
        let first = declaration.constraints.first();
        let joints = optional(first.filter(|_| is_power), |_| system.joints(declaration));
        let constraint = optional(first.filter(|_| !is_power), |_| system.constraint(declaration));
        let (mover, (force, input)) = match system.motion(declaration) {
            Some((motion, input)) => (Some(Mover::Inputs(motion)), (None, input)),
            // the moving closure has an error, and without it nothing is known of the input
            None if is_steered => return None,
            None => (kinetic.map(Mover::Momenta), forces?),
        };
        let edges = edges?;
        let control = optional(declaration.control.as_ref(), |control| system.choice(control, &input, is_steered))?;
        Some(ClosureValues {
            action,
            laws: laws?,
            mover: mover?,
            potential,
            monitor: monitor?,
            terms,
            symmetries,
            force,
            constraint: constraint?,
            joints: joints?,
            edges,
            input,
            control,
            endpoint: endpoint?,
            target: target?,
        })
    }
}
