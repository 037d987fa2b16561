//! The value of the stage `parse`, and its printed form: one line for each key and field.

use std::fmt;

use clebsch_symbolic::IntoList;
use proc_macro2::Ident;
use syn::ext::IdentExt;
use syn::{DeriveInput, Expr, Generics, parse_quote_spanned};

use super::dials::{Dials, RungeKutta};
use super::keys::Keys;
use super::spelling::{joined, spell, spell_type, tokens};
use super::{
    Argument, Choice, Closure, DeclaredGroup, DeclaredMethod, Definition, Field, Opaque, Pattern, combinations,
    control, methods,
};
use crate::diagnostic::{Diagnostic, error};

/// The user's declaration as written: the struct, the closures and the dials.
#[derive(Clone)]
pub struct Declaration {
    pub(crate) ident: Ident,
    pub(crate) generics: Generics,
    pub(crate) fields: Vec<Field>,
    /// The groups of the user's own, in the order in which they were declared.
    pub groups: Vec<DeclaredGroup>,
    /// The action of the group on the configurations.
    pub action: Closure,
    /// Where the kinetic energy comes from.
    pub kinetic: Kinetic,
    /// The potential energy; a free body has none.
    pub potential: Option<Potential>,
    /// The monitor, which sets the times of steps.
    pub step: Option<Closure>,
    /// The force as a covector of the group, in 𝔤*.
    pub force: Option<Closure>,
    /// The force as a covector of the configuration.
    pub force_on: Option<Closure>,
    /// The equations that the velocity obeys.
    pub constraints: Vec<Closure>,
    /// The energies of the edges between sites of a field, one for each direction.
    pub spaces: Vec<Closure>,
    /// The price and the bounds of a choice of inputs; `None` if there is no choice.
    pub control: Option<Choice>,
    /// In the declaration of a method, the choice of its system. Nothing is derived from it, but it introduces references of forces.
    pub choice_of_system: Option<Choice>,
    /// The price of the end.
    pub endpoint: Option<Closure>,
    /// The conditions of the end.
    pub target: Option<Closure>,
    /// The symmetries that the user offers.
    pub symmetries: Vec<Closure>,
    /// Everything else.
    pub dials: Dials,
    /// Further ways to step the system, each with dials of its own.
    pub methods: Vec<DeclaredMethod>,
    /// Whether it is a field without a kinetic energy, which rests. ½|ξ|² then measures its motions.
    pub is_static: bool,
}

/// The key `potential`.
#[derive(Clone)]
pub enum Potential {
    /// A formula.
    Closure(Closure),
    /// Two methods of the struct.
    Opaque(Opaque),
}

impl Potential {
    pub(crate) fn closure(&self) -> Option<&Closure> {
        if let Potential::Closure(closure) = self { Some(closure) } else { None }
    }

    pub(crate) fn opaque(&self) -> Option<&Opaque> {
        if let Potential::Opaque(opaque) = self { Some(opaque) } else { None }
    }
}

/// The key that moves the configuration: a kinetic energy, or inputs.
#[derive(Clone)]
pub enum Kinetic {
    /// `controls = …`, the velocity that inputs give.
    Controls(Closure),
    /// `dynamics = …`, the next configuration, or a right-hand side and how it is integrated.
    Dynamics(Closure, Option<RungeKutta>),
    /// `cost = …`, the kinetic part of the discrete Lagrangian.
    Cost(Closure),
    /// `lagrangian = …`, to be discretised.
    Lagrangian(Closure),
}

impl Declaration {
    /// The argument that introduces the input, with its type.
    pub fn input(&self) -> Option<&Argument> {
        let steered = Some(self.kinetic.closure()).filter(|_| self.kinetic.is_steered());
        let mut closures = steered.into_iter().chain(&self.force).chain(&self.force_on);
        // typed arguments behind an input that is chosen are references
        let refers = steered.is_some() || self.choice().is_some();
        closures.find_map(|closure| {
            let is_typed = |argument: &&Argument| argument.ty.is_some();
            if refers { closure.arguments.iter().find(is_typed) } else { closure.arguments.last().filter(is_typed) }
        })
    }

    /// The choice of inputs of the system, which its methods do not make.
    pub fn choice(&self) -> Option<&Choice> {
        self.control.as_ref().or(self.choice_of_system.as_ref())
    }

    /// All closures over the arguments of the action, the action first.
    pub fn closures(&self) -> impl Iterator<Item = &Closure> {
        let potential = self.potential.as_ref().and_then(Potential::closure);
        let forces = self.force.iter().chain(&self.force_on).chain(&self.constraints).chain(&self.spaces);
        let energies = [Some(&self.action), Some(self.kinetic.closure()), potential, self.step.as_ref()];
        let control = self.control.iter().flat_map(|control| [Some(&control.price), control.bounds.as_ref()]);
        energies.into_iter().chain(control).flatten().chain(forces).chain(self.of_end()).chain(&self.symmetries)
    }

    /// The closures of the end of plans.
    pub fn of_end(&self) -> impl Iterator<Item = &Closure> {
        self.endpoint.iter().chain(&self.target)
    }
}

impl Kinetic {
    /// Whether inputs move the configuration.
    pub fn is_steered(&self) -> bool {
        matches!(self, Kinetic::Controls(_) | Kinetic::Dynamics(..))
    }

    pub(crate) fn closure(&self) -> &Closure {
        match self {
            Kinetic::Cost(closure)
            | Kinetic::Lagrangian(closure)
            | Kinetic::Controls(closure)
            | Kinetic::Dynamics(closure, _) => closure,
        }
    }
}

/// Puts the declaration together, and reports keys that are missing or too many; `None` without a readable action. A
/// kinetic energy that is missing is the action's closure, which nothing reads: the declaration has an error.
pub(super) fn assemble(input: &DeriveInput, mut keys: Keys, fields: Vec<Field>) -> Option<Declaration> {
    let diagnostics = keys.diagnostics;
    combinations::check(&keys);
    let (kinetic, control) = control::read(&mut keys);
    // a closure that was given and could not be read has its own error
    let nothing_readable = keys.is_empty() && !diagnostics.is_empty();
    // one of the keys that are missing may have been meant
    let nothing_readable = nothing_readable || keys.has_unknown;
    let moved_by_inputs = keys.was_given("controls") || keys.was_given("dynamics");
    if !keys.was_given("action") && !keys.was_given("dynamics") && !nothing_readable {
        diagnostics.push(missing_action(&input.ident, keys.is_empty()));
    } else if !nothing_readable
        && !moved_by_inputs
        && !["cost", "lagrangian", "space"].iter().any(|key| keys.was_given(key))
    {
        diagnostics.push(missing_kinetic(&input.ident, &fields));
    }
    control::check_end(&keys, control.as_ref());
    let [action, step, force, force_on, endpoint, target] =
        ["action", "step", "force", "force_on", "endpoint", "target"].map(|name| keys.closures.remove(name));
    let [constraints, spaces, symmetries] =
        ["constraint", "space", "symmetry"].map(|name| keys.lists.remove(name).unwrap_or_default());
    let Keys { potential, groups, dials, methods, .. } = keys;
    let methods = methods::checked(&input.ident, methods, diagnostics);
    let action = action?;
    let is_static = kinetic.is_none() && !spaces.is_empty();
    let kinetic =
        kinetic.unwrap_or_else(|| Kinetic::Lagrangian(if is_static { metric(&action) } else { action.clone() }));
    Some(Declaration {
        ident: input.ident.clone(),
        generics: input.generics.clone(),
        fields,
        groups,
        action,
        kinetic,
        potential,
        step,
        force,
        force_on,
        constraints,
        spaces,
        control,
        choice_of_system: None,
        endpoint,
        target,
        symmetries,
        dials,
        methods,
        is_static,
    })
}

/// ½|ξ|², which measures motions where there is no kinetic energy: `|(x0, x1)| (x0.norm_squared() + x1.norm_squared()) / 2`.
fn metric(action: &Closure) -> Closure {
    let span = action.key.span();
    let count = action.arguments.first().map_or(1, |argument| match &argument.pattern {
        Pattern::Name(_) => 1,
        Pattern::Tuple(parts, _) => parts.len(),
    });
    let taken: Vec<&Ident> = action.arguments.iter().flat_map(|argument| argument.pattern.names()).into_list();
    let mut stem = String::from("xi");
    while taken.iter().any(|name| name.unraw().to_string().starts_with(&stem)) {
        stem.push('_');
    }
    let names: Vec<Ident> = (0..count).map(|k| Ident::new(&format!("{stem}{k}"), span)).into_list();
    let squares = names.iter().map(|name| -> Expr { parse_quote_spanned!(span=> #name.norm_squared()) });
    let squares = squares.reduce(|sum, square| parse_quote_spanned!(span=> #sum + #square));
    let sum = squares.unwrap_or_else(|| parse_quote_spanned!(span=> 0));
    let pattern = match names.as_slice() {
        [only] => Pattern::Name(only.clone()),
        _ => Pattern::Tuple(names.iter().cloned().map(Pattern::Name).into_list(), action.head),
    };
    let arguments = vec![Argument { pattern, ty: None, written: None }];
    Closure {
        key: Ident::new("lagrangian", span),
        arguments,
        head: action.head,
        body: parse_quote_spanned!(span=> (#sum) / 2),
    }
}

fn missing_action(ident: &Ident, nothing_given: bool) -> Diagnostic {
    let (what, example) = if nothing_given {
        let example = "#[clebsch(action = |F: SO<3>, R: SO<3>| R * F, lagrangian = |omega| …)]";
        ("no `#[clebsch(…)]` that declares its motion", example)
    } else {
        ("no action", "action = |F: SO<3>, R: SO<3>| R * F")
    };
    error!(ident, "`{ident}` has {what}";
        help "write `{example}` for a rigid body";
        note "the action declares the group and the configurations by its two typed arguments")
}

fn missing_kinetic(ident: &Ident, fields: &[Field]) -> Diagnostic {
    let inertia = super::mass(fields, Some(3));
    error!(ident, "`{ident}` has neither a cost nor a lagrangian";
        help "write `lagrangian = |omega| omega.dot(&({inertia} * omega)) / 2`, or a `cost = |h, F| …`";
        note "without kinetic energy nothing says how a momentum moves the configuration")
}

impl fmt::Display for Declaration {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "declaration {}{}", self.ident, tokens(&self.generics))?;
        for DeclaredGroup { name, definition } in &self.groups {
            match definition {
                Definition::Equation(closure) => writeln!(f, "  group {name} = {}", closure.spell())?,
                Definition::Basis(elements, _) => {
                    writeln!(f, "  group {name} = basis([{}])", joined(elements.iter().map(spell)))?;
                }
            }
        }
        let entry = |f: &mut fmt::Formatter<'_>, closure: &Closure| {
            writeln!(f, "  {:<10} = {}", closure.key.to_string(), closure.spell())
        };
        entry(f, &self.action)?;
        if !self.is_static {
            match &self.kinetic {
                Kinetic::Dynamics(closure, Some(method)) => {
                    writeln!(f, "  {:<10} = {method}({})", closure.key.to_string(), closure.spell())?;
                }
                kinetic => entry(f, kinetic.closure())?,
            }
        }
        match &self.potential {
            Some(Potential::Closure(closure)) => entry(f, closure)?,
            Some(Potential::Opaque(opaque)) => writeln!(f, "  potential  = {}", opaque.spell())?,
            None => {}
        }
        self.step.iter().try_for_each(|closure| entry(f, closure))?;
        let control = self.control.iter().flat_map(|control| [Some(&control.price), control.bounds.as_ref()]).flatten();
        let others =
            self.force.iter().chain(&self.force_on).chain(&self.constraints).chain(&self.spaces).chain(control);
        others.chain(self.of_end()).chain(&self.symmetries).try_for_each(|closure| entry(f, closure))?;
        for (name, value) in self.dials.given() {
            writeln!(f, "  {name:<10} = {}", value.value)?;
        }
        for method in &self.methods {
            let dials = joined(method.dials.given().map(|(name, value)| format!("{name} = {}", value.value)));
            writeln!(f, "  method {} = ({dials})", method.name)?;
        }
        for field in &self.fields {
            let promise = field.promise.map(|(promise, _)| format!(", {promise}")).unwrap_or_default();
            writeln!(f, "  field {}: {}{promise}", field.name(), spell_type(&field.ty))?;
        }
        Ok(())
    }
}
