//! The names that an expression may use, and what is known about those that it may not.

use clebsch_symbolic::{Expr, Group};
use proc_macro2::Ident;
use syn::ext::IdentExt;

use super::value::Value;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::parse::Pattern;

/// GroupNames with a meaning of their own in all closures.
const RESERVED: [&str; 4] = ["h", "t", "I", "self"];

/// A name and its value; a value with an error, which was reported, is `None`.
pub(super) struct Binding<'g> {
    ident: Ident,
    value: Option<Value<'g>>,
}

/// Why a name of the declaration is not known in a closure.
#[derive(Clone)]
pub(super) enum Missing {
    /// The closure may have it as an argument, with this head.
    Argument {
        /// `|h, q, F|`.
        head: String,
    },
    /// The closure cannot depend on it.
    Foreign {
        /// What it may depend on.
        help: String,
    },
}

/// The names of one closure.
#[derive(Default)]
pub(super) struct Scope<'g> {
    names: Vec<(String, Option<Value<'g>>)>,
    arguments: usize,
    missing: Vec<(String, Missing)>,
    velocities: Vec<(Expr<'g>, Group)>,
    elements: Vec<(Expr<'g>, Group)>,
}

impl<'g> Binding<'g> {
    /// The names of a pattern with the parts of a value.
    pub fn of(pattern: &Pattern, value: Option<Value<'g>>, diagnostics: &mut Diagnostics) -> Option<Vec<Binding<'g>>> {
        match (pattern, value?) {
            (Pattern::Name(ident), value) => Some(vec![Binding { ident: ident.clone(), value: Some(value) }]),
            (Pattern::Tuple(patterns, _), Value::Tuple(parts)) if patterns.len() == parts.len() => {
                let bindings: Option<Vec<Vec<Binding<'g>>>> = patterns
                    .iter()
                    .zip(parts)
                    .map(|(pattern, part)| Binding::of(pattern, Some(part), diagnostics))
                    .collect();
                bindings.map(|bindings| bindings.into_iter().flatten().collect())
            }
            (pattern, other) => {
                let message = format!("`{}` does not fit {}", pattern.spell(), other.describe());
                diagnostics.push(
                    Diagnostic::new(pattern.place(), message)
                        .help("write as many names as the tuple has parts, or one for all"),
                );
                None
            }
        }
    }

    /// The names of a pattern without values.
    pub fn unknown(pattern: &Pattern) -> Vec<Binding<'g>> {
        pattern.names().into_iter().map(|ident| Binding { ident: ident.clone(), value: None }).collect()
    }
}

/// Reports a name that may not be introduced, and returns whether it may.
pub(super) fn check_reserved(ident: &Ident, what: &str, diagnostics: &mut Diagnostics) -> bool {
    let name = ident.unraw().to_string();
    let reserved = RESERVED.contains(&name.as_str());
    if reserved {
        diagnostics.push(
            Diagnostic::new(ident.span(), format!("`{name}` is reserved and cannot be the name of {what}"))
                .help("choose another name")
                .note("in all closures `h` is the step, `t` the time, `I` the identity and `self` the struct"),
        );
    }
    !reserved
}

impl<'g> Scope<'g> {
    /// Introduces an argument.
    pub fn add_argument(&mut self, pattern: &Pattern, value: Option<Value<'g>>, diagnostics: &mut Diagnostics) {
        let bindings = Binding::of(pattern, value, diagnostics).unwrap_or_else(|| Binding::unknown(pattern));
        self.names.extend(bindings.into_iter().map(|binding| (binding.ident.unraw().to_string(), binding.value)));
        self.arguments = self.names.len();
    }

    /// Introduces a name of a `let` or of a closure inside; arguments stay what they are.
    pub fn add(&mut self, binding: Binding<'g>, what: &str, diagnostics: &mut Diagnostics) {
        let name = binding.ident.unraw().to_string();
        if !check_reserved(&binding.ident, what, diagnostics) {
            return;
        }
        if self.names[..self.arguments].iter().any(|(argument, _)| *argument == name) {
            let error =
                Diagnostic::new(binding.ident.span(), format!("`{name}` is an argument and cannot be redefined"));
            diagnostics.push(error.help("choose another name").note("a `let` may replace a `let`, and nothing else"));
            return;
        }
        self.names.push((name, binding.value));
    }

    /// Notes that a name of the declaration is not an argument here.
    pub fn add_missing(&mut self, name: String, missing: Missing) {
        self.missing.push((name, missing));
    }

    /// Notes which symbols are velocities, each of one factor.
    pub fn set_velocities(&mut self, velocities: Vec<(Expr<'g>, Group)>) {
        self.velocities = velocities;
    }

    /// The group whose velocity an expression is.
    pub fn group_of_velocity(&self, expr: Expr<'g>) -> Option<Group> {
        self.velocities.iter().find(|(velocity, _)| *velocity == expr).map(|(_, group)| *group)
    }

    /// Notes which symbols lie on a group.
    pub fn set_elements(&mut self, elements: &[(Expr<'g>, Group)]) {
        self.elements.extend_from_slice(elements);
    }

    /// The symbols that lie on a group.
    pub fn elements(&self) -> impl Iterator<Item = (Expr<'g>, Group)> {
        self.elements.iter().copied()
    }

    /// The value of a name, the latest first.
    pub fn value(&self, name: &str) -> Option<&Option<Value<'g>>> {
        self.names.iter().rev().find(|(known, _)| known == name).map(|(_, value)| value)
    }

    /// Why a name is not known.
    pub fn missing(&self, name: &str) -> Option<Missing> {
        self.missing.iter().find(|(known, _)| known == name).map(|(_, missing)| missing.clone())
    }

    /// All names.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.names.iter().map(|(name, _)| name.as_str())
    }

    /// All names, for messages.
    pub fn list(&self) -> String {
        let mut names: Vec<String> = self.names().map(|name| format!("`{name}`")).collect();
        names.extend(["`I`".to_string(), "`self`".to_string()]);
        names.join(", ")
    }

    /// A point to come back to.
    pub fn mark(&self) -> usize {
        self.names.len()
    }

    /// Forgets the names since a mark.
    pub fn release(&mut self, mark: usize) {
        self.names.truncate(mark);
    }
}
