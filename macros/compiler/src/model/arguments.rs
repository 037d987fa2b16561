//! Arguments go by name: the action fixes the names, the other closures use those that they need, in a fixed order.

use clebsch_symbolic::{Expr, Group};
use syn::ext::IdentExt;

use super::scope::{Scope, check_reserved};
use super::slots::{Matched, SharedNames, Slot};
use super::value::{Each, Value};
use crate::diagnostic::{Diagnostics, refuse, report};
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

/// The two arguments of the action: the group element and the configuration, with their types.
#[derive(Copy, Clone)]
pub(super) struct TypedArguments<'d> {
    pub element: &'d Pattern,
    pub group: &'d syn::Type,
    pub configuration: &'d Pattern,
    pub space: &'d syn::Type,
}

/// The patterns and types of the two arguments of the action.
pub(super) fn of_action<'d>(action: &'d Closure, diagnostics: &Diagnostics) -> Option<TypedArguments<'d>> {
    let [element, configuration] = action.arguments.as_slice() else {
        let count = action.arguments.len();
        let plural = if count == 1 { "" } else { "s" };
        refuse!(diagnostics, action.head, "the action has {count} argument{plural}, not two";
            help "write `|F: SO<3>, q: Unit<Vector3>| …`";
            note "the group element comes first, then the configuration that it moves");
    };
    let mut seen = Vec::new();
    for ident in element.pattern.names().into_iter().chain(configuration.pattern.names()) {
        check_reserved(ident, "an argument", diagnostics);
        let name = ident.unraw();
        if seen.contains(&name) {
            report!(diagnostics, ident, "`{name}` is the name of two arguments"; help "choose another name for one of them");
        }
        seen.push(name);
    }
    let typed = |argument: &'d Argument, example: &str, what: &str| {
        let name = argument.pattern.spell();
        if argument.ty.is_none() {
            report!(diagnostics, argument.pattern.place(), "`{name}` has no type in the action";
                help "write `{name}: {example}`"; note "its type declares {what}");
        }
        argument.ty.as_ref()
    };
    let group = typed(element, "SO<3>", "the group");
    let space = typed(configuration, "Unit<Vector3>", "the space of configurations");
    let (element, configuration) = (&element.pattern, &configuration.pattern);
    Some(TypedArguments { element, group: group?, configuration, space: space? })
}

impl<'d, 'g> Arguments<'d, 'g> {
    /// The arguments of a power, where these are those of a site.
    pub fn of_each_site(&mut self) {
        self.element_value = self.element_value.take().map(|own| Value::PerSite(Each::Motion, Box::new(own)));
        self.configuration_value =
            self.configuration_value.take().map(|own| Value::PerSite(Each::Configuration, Box::new(own)));
    }

    /// The names in the action itself.
    pub fn action_scope(&self, diagnostics: &Diagnostics) -> Scope<'g> {
        let mut scope = Scope::new(&self.members);
        scope.add_argument(self.names.element, self.element_value.clone(), diagnostics);
        scope.add_argument(self.names.configuration, self.configuration_value.clone(), diagnostics);
        let (f, q) = (self.names.element.spell(), self.names.configuration.spell());
        let help = format!("the action depends on `{f}` and `{q}` alone");
        scope.add_missing(["h", "t"].map(|name| (name.to_string(), help.clone())));
        scope
    }

    /// The arguments of a closure, with the slot that each takes.
    pub fn matched(&self, closure: &'d Closure, slots: &'static [Slot], diagnostics: &Diagnostics) -> Matched<'d> {
        Matched::new(self.names, closure, slots, diagnostics)
    }

    /// The names in a closure that introduces none.
    pub fn scope_of(&self, closure: &'d Closure, slots: &'static [Slot], diagnostics: &Diagnostics) -> Scope<'g> {
        self.scope(&self.matched(closure, slots, diagnostics), &[], diagnostics)
    }

    /// The scope in which arguments have the values of their slots, and what is left out has a reason.
    pub fn scope(
        &self,
        matched: &Matched,
        introduced: &[(Slot, Option<Value<'g>>)],
        diagnostics: &Diagnostics,
    ) -> Scope<'g> {
        let mut scope = Scope::new(&self.members);
        for (argument, slot) in matched.arguments() {
            let value = slot.and_then(|slot| match slot {
                Slot::Time => Some(Value::Matrix(self.time)),
                Slot::Step => Some(Value::Matrix(self.step_size)),
                Slot::Configuration => self.configuration_value.clone(),
                Slot::Element => self.element_value.clone(),
                new => introduced.iter().find(|(slot, _)| *slot == new).and_then(|(_, value)| value.clone()),
            });
            scope.add_argument(&argument.pattern, value, diagnostics);
        }
        scope.add_missing(matched.missing());
        scope
    }
}
