//! Arguments go by name: the action fixes the names, the other closures use those that they need, in a fixed order.

use clebsch_symbolic::{Expr, Group};
use proc_macro2::Ident;
use syn::ext::IdentExt;
use syn::{Generics, Type};

use super::scope::{Scope, check_reserved};
use super::shapes::const_generic;
use super::slots::{Matched, SharedNames, Slot};
use super::value::{Each, Value};
use crate::diagnostic::{Diagnostic, Diagnostics, error, refuse, report};
use crate::parse::{Argument, Closure, Declaration, Pattern, spell, spell_type};

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

/// The two arguments of the action: the group element and the configuration, with their types. Those of a power are those of one site.
#[derive(Copy, Clone)]
pub(super) struct TypedArguments<'d> {
    pub element: &'d Pattern,
    pub group: &'d Type,
    pub configuration: &'d Pattern,
    pub space: &'d Type,
    /// The const generic N of a power.
    pub sites: Option<&'d Ident>,
}

/// The patterns and types of the two arguments of the action.
pub(super) fn of_action<'d>(declaration: &'d Declaration, diagnostics: &Diagnostics) -> Option<TypedArguments<'d>> {
    let action = &declaration.action;
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
    let types = TypedArguments { element, group: group?, configuration, space: space?, sites: None };
    diagnostics.take(types.of_site(&declaration.generics))
}

impl<'d> TypedArguments<'d> {
    /// What stands inside `[…; N]` of both types, where these have a const generic N for their length.
    ///
    /// # Errors
    /// Where only one of them has, or another one.
    fn of_site(self, generics: &'d Generics) -> Result<TypedArguments<'d>, Diagnostic> {
        match (sites_of(self.group, generics), sites_of(self.space, generics)) {
            (None, None) => Ok(self),
            (Some((length, group)), Some((other, space))) if length == other => {
                Ok(TypedArguments { group, space, sites: Some(length), ..self })
            }
            (Some((length, inner)), _) => Err(unequal(self.space, inner, length)),
            (None, Some((length, inner))) => Err(unequal(self.group, inner, length)),
        }
    }
}

fn unequal(ty: &Type, inner: &Type, length: &Ident) -> Diagnostic {
    error!(ty, "`{}` is no power with {length} sites", spell_type(ty);
        help "write `[…; {length}]` for both, the group and the space that it moves";
        note "the other argument has {length} times `{}`, and each site is moved by its own element", spell_type(inner))
}

/// N and `T` of `[T; N]` with a const generic N.
pub(super) fn sites_of<'t, 'd>(ty: &'t Type, generics: &'d Generics) -> Option<(&'d Ident, &'t Type)> {
    match ty {
        Type::Group(group) => sites_of(&group.elem, generics),
        Type::Paren(paren) => sites_of(&paren.elem, generics),
        Type::Array(array) => Some((const_generic(&spell(&array.len), generics)?, &*array.elem)),
        _ => None,
    }
}

impl<'d, 'g> Arguments<'d, 'g> {
    /// The arguments of a power, where these are those of a site.
    pub fn of_each_site(&mut self) {
        self.element_value = self.element_value.take().map(|own| Value::PerSite(Each::Motion, Box::new(own)));
        self.configuration_value =
            self.configuration_value.take().map(|own| Value::PerSite(Each::Configuration, Box::new(own)));
    }

    /// The names in the action itself.
    pub fn action_scope(&self) -> Scope<'g> {
        let mut scope = Scope::new(&self.members);
        scope.add_argument(self.names.element, self.element_value.clone(), self.names.diagnostics);
        scope.add_argument(self.names.configuration, self.configuration_value.clone(), self.names.diagnostics);
        let (f, q) = (self.names.element.spell(), self.names.configuration.spell());
        let help = format!("the action depends on `{f}` and `{q}` alone");
        scope.missing = ["h", "t"].map(|name| (name.to_string(), help.clone())).into();
        scope
    }

    /// The arguments of a closure, with the slot that each takes.
    pub fn matched(&self, closure: &'d Closure, slots: &'static [Slot]) -> Matched<'d> {
        Matched::new(self.names, closure, slots)
    }

    /// The names in a closure that introduces none.
    pub fn scope_of(&self, closure: &'d Closure, slots: &'static [Slot]) -> Scope<'g> {
        self.scope(&self.matched(closure, slots), &[])
    }

    /// The scope in which arguments have the values of their slots, and what is left out has a reason.
    pub fn scope(&self, matched: &Matched, introduced: &[(Slot, Option<Value<'g>>)]) -> Scope<'g> {
        let mut scope = Scope::new(&self.members);
        for (argument, slot) in matched.arguments() {
            let value = slot.and_then(|slot| match slot {
                Slot::Time => Some(Value::Matrix(self.time)),
                Slot::Step => Some(Value::Matrix(self.step_size)),
                Slot::Configuration => self.configuration_value.clone(),
                Slot::Element => self.element_value.clone(),
                new => introduced.iter().find(|(slot, _)| *slot == new).and_then(|(_, value)| value.clone()),
            });
            scope.add_argument(&argument.pattern, value, self.names.diagnostics);
        }
        scope.missing = matched.missing();
        scope
    }
}
