//! The names that an expression may use, and the facts about those that it may not.

use clebsch_symbolic::{Expr, Group, IntoList};
use proc_macro2::Ident;
use syn::ext::IdentExt;

use super::Factor;
use super::value::Value;
use crate::diagnostic::{Diagnostics, report};
use crate::parse::Pattern;

/// Names with a meaning of their own in all closures.
const RESERVED: [&str; 4] = ["h", "t", "I", "self"];

/// The names of one closure.
#[derive(Default)]
pub(super) struct Scope<'g> {
    /// Every name with its value, the latest last.
    pub names: Vec<(String, Option<Value<'g>>)>,
    arguments: usize,
    /// Names of the declaration that are not arguments here, and the advice for each.
    pub missing: Vec<(String, String)>,
    /// The symbols of velocities, each with the group of its factor.
    pub velocities: Vec<(Expr<'g>, Group)>,
    /// The symbols that lie on a group.
    pub elements: Vec<(Expr<'g>, Group)>,
}

/// The names of a pattern with the parts of a value; a value with an error, which was reported, is `None`.
pub(super) fn bindings<'g>(
    pattern: &Pattern,
    value: Option<Value<'g>>,
    diagnostics: &Diagnostics,
) -> Vec<(Ident, Option<Value<'g>>)> {
    match (pattern, value) {
        (Pattern::Name(ident), value) => vec![(ident.clone(), value)],
        (Pattern::Tuple(patterns, _), Some(Value::Tuple(parts))) if patterns.len() == parts.len() => {
            let parts = patterns.iter().zip(parts);
            parts.flat_map(|(pattern, part)| bindings(pattern, Some(part), diagnostics)).into_list()
        }
        (Pattern::Tuple(patterns, place), value) => {
            if let Some(value) = value {
                report!(diagnostics, *place, "`{}` does not fit {}", pattern.spell(), value.describe();
                    help "write as many names as the tuple has parts, or one for all");
            }
            patterns.iter().flat_map(|pattern| bindings(pattern, None, diagnostics)).into_list()
        }
    }
}

/// Reports a name that may not be introduced, and returns whether it may.
pub(super) fn check_reserved(ident: &Ident, what: &str, diagnostics: &Diagnostics) -> bool {
    let name = ident.unraw().to_string();
    let reserved = RESERVED.contains(&name.as_str());
    if reserved {
        report!(diagnostics, ident.span(), "`{name}` is reserved and cannot be the name of {what}";
            help "choose another name";
            note "in all closures `h` is the step, `t` the time, `I` the identity and `self` the struct");
    }
    !reserved
}

impl<'g> Scope<'g> {
    /// No names, and the symbols that lie on a group.
    pub fn new(elements: &[(Expr<'g>, Group)]) -> Scope<'g> {
        Scope { elements: elements.to_vec(), ..Scope::default() }
    }

    pub fn add_argument(&mut self, pattern: &Pattern, value: Option<Value<'g>>, diagnostics: &Diagnostics) {
        let bindings = bindings(pattern, value, diagnostics);
        self.names.extend(bindings.into_iter().map(|(ident, value)| (ident.unraw().to_string(), value)));
        self.arguments = self.names.len();
    }

    /// The names of the arguments.
    pub fn arguments(&self) -> impl Iterator<Item = &String> {
        self.names[..self.arguments].iter().map(|(name, _)| name)
    }

    /// Introduces a name of a `let` or of a closure inside. Arguments keep their meaning.
    pub fn add(&mut self, ident: &Ident, value: Option<Value<'g>>, what: &str, diagnostics: &Diagnostics) {
        if !check_reserved(ident, what, diagnostics) {
            return;
        }
        let name = ident.unraw().to_string();
        if self.arguments().any(|argument| *argument == name) {
            // the lines that follow mean the new value
            report!(diagnostics, ident, "`{name}` is an argument and cannot be redefined";
                help "choose another name"; note "a `let` may replace a `let`, and nothing else");
        }
        self.names.push((name, value));
    }

    /// Notes which symbols are velocities, each of one factor.
    pub fn set_velocities(&mut self, velocities: &[Expr<'g>], factors: &[Factor<'g>]) {
        self.velocities = velocities.iter().copied().zip(factors.iter().map(|factor| factor.group)).into_list();
    }

    /// The value of a name, the latest first.
    pub fn value(&self, name: &str) -> Option<&Option<Value<'g>>> {
        self.names.iter().rev().find(|(known, _)| known == name).map(|(_, value)| value)
    }
}
