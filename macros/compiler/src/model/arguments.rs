//! Arguments go by name: the action fixes the names, the other closures use those that they need, in a fixed order.

use clebsch_symbolic::{Expr, Group};
use syn::ext::IdentExt;

use super::scope::{Missing, Scope, check_reserved};
use super::slots::{COST, FORCE, LAGRANGIAN, POTENTIAL, SYMMETRY, SharedNames, Slot};
use super::value::{Each, PerSite, Value};
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::parse::{Argument, Closure, Pattern};

/// The names that the action fixes, with their values.
pub(super) struct Arguments<'d, 'g> {
    pub names: SharedNames<'d>,
    pub element_value: Option<Value<'g>>,
    pub configuration_value: Option<Value<'g>>,
    /// The symbols that lie on a group.
    pub members: Vec<(Expr<'g>, Group)>,
    pub step_size: Expr<'g>,
    pub time: Expr<'g>,
}

/// The slots that the arguments of a closure take; `None` for one with an error, which was reported.
pub(super) type Taken = Vec<Option<Slot>>;

/// The two arguments of the action: the group element and the configuration, with their types.
#[derive(Copy, Clone)]
pub(super) struct TypedArguments<'d> {
    pub element: &'d Pattern,
    pub group: &'d syn::Type,
    pub configuration: &'d Pattern,
    pub space: &'d syn::Type,
}

/// The patterns and types of the two arguments of the action.
pub(super) fn of_action<'d>(action: &'d Closure, diagnostics: &mut Diagnostics) -> Option<TypedArguments<'d>> {
    let [element, configuration] = action.arguments.as_slice() else {
        let count = action.arguments.len();
        let message = format!("the action has {count} argument{}, not two", if count == 1 { "" } else { "s" });
        diagnostics.push(
            Diagnostic::new(action.head, message)
                .help("write `|F: SO<3>, q: Unit<Vector3>| …`")
                .note("the group element comes first, then the configuration that it moves"),
        );
        return None;
    };
    let mut seen: Vec<String> = Vec::new();
    for ident in element.pattern.names().into_iter().chain(configuration.pattern.names()) {
        check_reserved(ident, "an argument", diagnostics);
        let name = ident.unraw().to_string();
        if seen.contains(&name) {
            let error = Diagnostic::new(ident.span(), format!("`{name}` is the name of two arguments"));
            diagnostics.push(error.help("choose another name for one of them"));
        }
        seen.push(name);
    }
    let group = typed(element, "SO<3>", "the group", diagnostics);
    let space = typed(configuration, "Unit<Vector3>", "the space of configurations", diagnostics);
    Some(TypedArguments {
        element: &element.pattern,
        group: group?,
        configuration: &configuration.pattern,
        space: space?,
    })
}

fn typed<'d>(
    argument: &'d Argument,
    example: &str,
    what: &str,
    diagnostics: &mut Diagnostics,
) -> Option<&'d syn::Type> {
    if argument.ty.is_none() {
        let name = argument.pattern.spell();
        let error = Diagnostic::new(argument.pattern.place(), format!("`{name}` has no type in the action"));
        diagnostics.push(error.help(format!("write `{name}: {example}`")).note(format!("its type declares {what}")));
    }
    argument.ty.as_ref()
}

impl<'d, 'g> Arguments<'d, 'g> {
    /// The arguments of a power, where these are those of a site.
    pub fn of_each_site(&mut self) {
        let each = |value: &mut Option<Value<'g>>, of: Each| {
            *value = value.take().map(|own| Value::PerSite(PerSite { of, own: Box::new(own) }));
        };
        each(&mut self.element_value, Each::Motion);
        each(&mut self.configuration_value, Each::Configuration);
    }

    /// The names in the action itself.
    pub fn action_scope(&self, diagnostics: &mut Diagnostics) -> Scope<'g> {
        let mut scope = Scope::default();
        scope.set_elements(&self.members);
        scope.add_argument(self.names.element, self.element_value.clone(), diagnostics);
        scope.add_argument(self.names.configuration, self.configuration_value.clone(), diagnostics);
        let help = format!(
            "the action depends on `{}` and `{}` alone",
            self.names.element.spell(),
            self.names.configuration.spell()
        );
        scope.add_missing("h".into(), Missing::Foreign { help: help.clone() });
        scope.add_missing("t".into(), Missing::Foreign { help });
        scope
    }

    /// The names in a cost.
    pub fn cost_scope(&self, closure: &Closure, diagnostics: &mut Diagnostics) -> Scope<'g> {
        let taken = self.names.match_slots(closure, COST, diagnostics);
        self.scope(closure, COST, &taken, &[], diagnostics)
    }

    /// The names in a potential.
    pub fn potential_scope(&self, closure: &Closure, diagnostics: &mut Diagnostics) -> Scope<'g> {
        let taken = self.names.match_slots(closure, POTENTIAL, diagnostics);
        self.scope(closure, POTENTIAL, &taken, &[], diagnostics)
    }

    /// The pattern of a Lagrangian's velocity, with the meaning of all its arguments.
    pub fn velocity<'c>(&self, closure: &'c Closure, diagnostics: &mut Diagnostics) -> (Taken, Option<&'c Pattern>) {
        let taken = self.names.match_slots(closure, LAGRANGIAN, diagnostics);
        let position = taken.iter().position(|slot| *slot == Some(Slot::Velocity));
        (taken, position.map(|position| &closure.arguments[position].pattern))
    }

    /// The names in a Lagrangian, whose last argument is new.
    pub fn lagrangian_scope(
        &self,
        closure: &Closure,
        taken: &Taken,
        velocity: Option<Value<'g>>,
        diagnostics: &mut Diagnostics,
    ) -> Scope<'g> {
        self.scope(closure, LAGRANGIAN, taken, &[(Slot::Velocity, velocity)], diagnostics)
    }

    /// The patterns of a force's velocity and of its input, with the meaning of all its arguments.
    pub fn force<'c>(
        &self,
        closure: &'c Closure,
        diagnostics: &mut Diagnostics,
    ) -> (Taken, Option<&'c Pattern>, Option<&'c Argument>) {
        let taken = self.names.match_slots(closure, FORCE, diagnostics);
        let of = |slot: Slot| taken.iter().position(|other| *other == Some(slot)).map(|i| &closure.arguments[i]);
        let (velocity, input) = (of(Slot::Velocity).map(|argument| &argument.pattern), of(Slot::Input));
        (taken, velocity, input)
    }

    /// The names in a force, whose last two arguments are new.
    pub fn force_scope(
        &self,
        closure: &Closure,
        taken: &Taken,
        velocity: Option<Value<'g>>,
        input: Option<Value<'g>>,
        diagnostics: &mut Diagnostics,
    ) -> Scope<'g> {
        self.scope(closure, FORCE, taken, &[(Slot::Velocity, velocity), (Slot::Input, input)], diagnostics)
    }

    /// The arguments of an offered symmetry, all of which it needs.
    pub fn symmetry<'c>(&self, closure: &'c Closure, diagnostics: &mut Diagnostics) -> Option<(Taken, &'c Argument)> {
        let taken = self.names.match_slots(closure, SYMMETRY, diagnostics);
        if taken.contains(&None) {
            return None;
        }
        if let Some(slot) = SYMMETRY.iter().find(|slot| !taken.contains(&Some(**slot))) {
            let name =
                self.names.pattern(*slot).map_or("element of its group".into(), |name| format!("`{}`", name.spell()));
            let offered = taken.iter().position(|slot| *slot == Some(Slot::Offered));
            let offered = offered.map_or("S: SO<3>".into(), |position| closure.arguments[position].spell());
            let known = [offered, self.names.configuration.spell(), self.names.element.spell()].join(", ");
            diagnostics.push(
                Diagnostic::new(closure.head, format!("the symmetry has no {name}"))
                    .help(format!("write `|{known}| …`"))
                    .note("it moves configurations and group elements together, so it takes both"),
            );
            return None;
        }
        taken.iter().position(|slot| *slot == Some(Slot::Offered)).map(|position| (taken, &closure.arguments[position]))
    }

    /// The names in an offered symmetry, whose first argument is new.
    pub fn symmetry_scope(
        &self,
        closure: &Closure,
        taken: &Taken,
        element: Option<Value<'g>>,
        diagnostics: &mut Diagnostics,
    ) -> Scope<'g> {
        self.scope(closure, SYMMETRY, taken, &[(Slot::Offered, element)], diagnostics)
    }

    /// The scope in which arguments have the values of their slots, and what is left out has a reason.
    pub fn scope(
        &self,
        closure: &Closure,
        slots: &[Slot],
        taken: &[Option<Slot>],
        introduced: &[(Slot, Option<Value<'g>>)],
        diagnostics: &mut Diagnostics,
    ) -> Scope<'g> {
        let mut scope = Scope::default();
        scope.set_elements(&self.members);
        for (argument, slot) in closure.arguments.iter().zip(taken) {
            let value = match slot {
                Some(Slot::Time) => Some(Value::Matrix(self.time)),
                Some(Slot::Step) => Some(Value::Matrix(self.step_size)),
                Some(Slot::Configuration) => self.configuration_value.clone(),
                Some(Slot::Element) => self.element_value.clone(),
                Some(new) => introduced.iter().find(|(slot, _)| slot == new).and_then(|(_, value)| value.clone()),
                None => None,
            };
            scope.add_argument(&argument.pattern, value, diagnostics);
        }
        let named = [Slot::Time, Slot::Step, Slot::Configuration, Slot::Element, Slot::Chosen];
        let named = named.into_iter().filter(|slot| *slot != Slot::Chosen || !slots.contains(&Slot::Input));
        for slot in named.filter(|slot| !taken.contains(&Some(*slot))) {
            let missing = match slots.contains(&slot) {
                true => Missing::Argument { head: self.names.head(taken, slots, Some(slot), closure) },
                false => Missing::Foreign { help: self.dependence(closure, slots) },
            };
            let names: Vec<String> = match (self.names.pattern(slot), slot) {
                (Some(pattern), _) => pattern.names().iter().map(|ident| ident.unraw().to_string()).collect(),
                (None, Slot::Time) => vec!["t".into()],
                (None, Slot::Chosen) => Vec::new(),
                (None, _) => vec!["h".into()],
            };
            names.into_iter().for_each(|name| scope.add_missing(name, missing.clone()));
        }
        scope
    }

    /// What a closure may depend on.
    fn dependence(&self, closure: &Closure, slots: &[Slot]) -> String {
        let (key, q) = (&closure.key, self.names.configuration.spell());
        if slots.contains(&Slot::Chosen) || (slots.contains(&Slot::Input) && !slots.contains(&Slot::Velocity)) {
            let step = if slots.contains(&Slot::Step) { "the step `h`, " } else { "" };
            return format!("the {key} may depend on the time `t`, {step}the configuration `{q}` and the input alone");
        }
        match slots.contains(&Slot::Velocity) {
            _ if slots.contains(&Slot::Offered) => {
                format!("the {key} depends on its own element, on `{q}` and on `{}` alone", self.names.element.spell())
            }
            true if slots.contains(&Slot::Input) => {
                format!("the {key} depends on the time `t`, the configuration `{q}`, the velocity and an input alone")
            }
            true => format!("the {key} depends on the time `t`, the configuration `{q}` and the velocity alone"),
            false => format!("the {key} depends on the time `t` and the configuration `{q}` alone"),
        }
    }
}
