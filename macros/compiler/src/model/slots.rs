//! Which argument stands for what: each is found by its name, and they keep their order.

use syn::ext::IdentExt;

use super::scope::check_reserved;
use crate::diagnostic::{Diagnostic, Diagnostics, Location};
use crate::parse::{Argument, Closure, Pattern, spell_type};

/// What an argument stands for.
#[derive(Copy, Clone, PartialEq, Eq)]
pub(super) enum Slot {
    Time,
    Step,
    Configuration,
    Element,
    Velocity,
    /// The element of an offered symmetry, which has a type.
    Offered,
    /// The input of a force or of controls, which has a type.
    Input,
    /// The same input where it is priced and bounded.
    Chosen,
}

/// The arguments of a cost, in order.
pub(super) const COST: &[Slot] = &[Slot::Time, Slot::Step, Slot::Configuration, Slot::Element];
/// The arguments of a Lagrangian, in order.
pub(super) const LAGRANGIAN: &[Slot] = &[Slot::Time, Slot::Configuration, Slot::Velocity];
/// The arguments of a potential, in order.
pub(super) const POTENTIAL: &[Slot] = &[Slot::Time, Slot::Configuration];
/// The arguments of a force, in order.
pub(super) const FORCE: &[Slot] = &[Slot::Time, Slot::Configuration, Slot::Velocity, Slot::Input];
/// The arguments of controls, in order.
pub(super) const CONTROLS: &[Slot] = &[Slot::Time, Slot::Configuration, Slot::Input];
/// The arguments of dynamics, in order.
pub(super) const DYNAMICS: &[Slot] = &[Slot::Time, Slot::Step, Slot::Configuration, Slot::Input];
/// The arguments of the price of a step, in order.
pub(super) const PRICE: &[Slot] = &[Slot::Time, Slot::Step, Slot::Configuration, Slot::Chosen];
/// The arguments of bounds, in order.
pub(super) const BOUNDS: &[Slot] = &[Slot::Time, Slot::Configuration, Slot::Chosen];
/// The arguments of an offered symmetry, in order.
pub(super) const SYMMETRY: &[Slot] = &[Slot::Offered, Slot::Configuration, Slot::Element];

/// The names that the closures of a declaration share.
#[derive(Copy, Clone)]
pub(super) struct SharedNames<'d> {
    /// The group element, as the action calls it.
    pub element: &'d Pattern,
    /// The configuration, as the action calls it.
    pub configuration: &'d Pattern,
    /// The input, as the closure that introduces it calls it.
    pub input: Option<&'d Pattern>,
}

impl<'d> SharedNames<'d> {
    /// The pattern and the meaning of a slot; a velocity and the element of a symmetry are introduced by their closures.
    fn names(&self, slot: Slot) -> (String, &'static str) {
        match slot {
            Slot::Time => ("t".into(), "the time"),
            Slot::Step => ("h".into(), "the step"),
            Slot::Configuration => (self.configuration.spell(), "the configuration"),
            Slot::Element => (self.element.spell(), "the group element"),
            Slot::Velocity => ("omega".into(), "the velocity a new name"),
            Slot::Input => ("u: Vector3".into(), "the input, a new name and its type"),
            Slot::Chosen => (self.input.map_or("u".into(), Pattern::spell), "the input"),
            Slot::Offered => ("S: SO<3>".into(), "an element of the symmetry, a new name and its group"),
        }
    }

    /// The pattern that the action gives a slot.
    pub(super) fn pattern(&self, slot: Slot) -> Option<&'d Pattern> {
        match slot {
            Slot::Configuration => Some(self.configuration),
            Slot::Element => Some(self.element),
            Slot::Chosen => self.input,
            _ => None,
        }
    }

    /// The slot that each argument takes; `None` if there is an error, which is reported.
    pub(super) fn match_slots(
        &self,
        closure: &Closure,
        slots: &[Slot],
        diagnostics: &mut Diagnostics,
    ) -> Vec<Option<Slot>> {
        let mut taken: Vec<Option<Slot>> =
            closure.arguments.iter().map(|argument| self.find(&argument.pattern, slots)).collect();
        let mut untyped = closure.arguments.len();
        if slots.contains(&Slot::Input) && closure.arguments.last().is_some_and(|argument| argument.ty.is_some()) {
            untyped -= 1;
            taken[untyped] = Some(Slot::Input);
        }
        if let Some(last) = untyped.checked_sub(1).filter(|_| slots.contains(&Slot::Velocity))
            && taken[last].is_none()
            && !self.is_foreign(&closure.arguments[last].pattern)
        {
            taken[last] = Some(Slot::Velocity);
        }
        let introduces = |argument: &Argument| argument.ty.is_some() || closure.arguments.len() == slots.len();
        if slots.contains(&Slot::Offered) && closure.arguments.first().is_some_and(introduces) {
            taken[0] = Some(Slot::Offered);
        }
        for (position, argument) in closure.arguments.iter().enumerate() {
            self.check_argument(closure, argument, position, &taken, slots, diagnostics);
        }
        self.check_order(closure, &taken, slots, diagnostics);
        if slots == LAGRANGIAN && !taken.contains(&Some(Slot::Velocity)) && !taken.contains(&None) {
            let error = Diagnostic::new(closure.head, "the lagrangian has no velocity");
            diagnostics
                .push(error.help(format!("write `{} …`", self.head(&taken, slots, Some(Slot::Velocity), closure))));
        }
        taken
    }

    fn find(&self, pattern: &Pattern, slots: &[Slot]) -> Option<Slot> {
        slots.iter().copied().find(|&slot| match (slot, pattern) {
            (Slot::Time, Pattern::Name(ident)) => ident == "t",
            (Slot::Step, Pattern::Name(ident)) => ident == "h",
            _ => self.pattern(slot).is_some_and(|known| known.matches(pattern)),
        })
    }

    /// Whether a pattern has a meaning that this closure has no slot for.
    fn is_foreign(&self, pattern: &Pattern) -> bool {
        self.find(pattern, COST).or_else(|| self.find(pattern, BOUNDS)).is_some()
    }

    fn check_argument(
        &self,
        closure: &Closure,
        argument: &Argument,
        position: usize,
        taken: &[Option<Slot>],
        slots: &[Slot],
        diagnostics: &mut Diagnostics,
    ) {
        let (name, place) = (argument.pattern.spell(), argument.pattern.place());
        if let Some(ty) = argument.ty.as_ref().filter(|_| !matches!(taken[position], Some(Slot::Offered | Slot::Input)))
        {
            diagnostics.push(
                Diagnostic::new(Location::of(ty), format!("`{name}` has a type again"))
                    .help(format!("write `{name}` without `: {}`", spell_type(ty)))
                    .note("types stand in the action, which introduces the spaces"),
            );
        }
        match taken[position] {
            Some(slot) if taken[..position].contains(&Some(slot)) => {
                diagnostics
                    .push(Diagnostic::new(place, format!("`{name}` is given twice")).help("remove one of the two"));
            }
            Some(Slot::Velocity) => self.check_new(argument, "the velocity", diagnostics),
            Some(Slot::Offered) => self.check_new(argument, "the symmetry", diagnostics),
            Some(Slot::Input) => self.check_new(argument, "the input", diagnostics),
            Some(_) => {}
            None => diagnostics.push(self.unknown(closure, argument, position, taken, slots)),
        }
    }

    /// A name that a closure introduces is no name of the action.
    fn check_new(&self, argument: &Argument, what: &str, diagnostics: &mut Diagnostics) {
        let of_action = || self.element.names().into_iter().chain(self.configuration.names());
        for ident in argument.pattern.names() {
            let free = check_reserved(ident, what, diagnostics);
            if free && of_action().any(|known| known.unraw() == ident.unraw()) {
                let message = format!("`{ident}` is an argument of the action and cannot be the name of {what}");
                diagnostics.push(Diagnostic::new(ident.span(), message).help("choose another name"));
            }
        }
    }

    /// The error for an argument that the action does not know.
    fn unknown(
        &self,
        closure: &Closure,
        argument: &Argument,
        position: usize,
        taken: &[Option<Slot>],
        slots: &[Slot],
    ) -> Diagnostic {
        let (name, place, key) = (argument.pattern.spell(), argument.pattern.place(), &closure.key);
        let error = if self.is_foreign(&argument.pattern) {
            Diagnostic::new(place, format!("the {key} cannot depend on `{name}`"))
        } else {
            Diagnostic::new(place, format!("cannot find `{name}` in the {key}"))
        };
        let meant = self.meant(position, taken, slots);
        let head = self.head(taken, slots, meant, closure);
        let error = match meant.map(|slot| self.names(slot)) {
            Some((_, meaning)) if meant == Some(Slot::Velocity) => {
                error.help(format!("give {meaning}: write `{head}`"))
            }
            Some((known, meaning)) => error.help(format!("the action calls {meaning} `{known}`: write `{head}`")),
            None => error.help(format!("write `{head}`")),
        };
        let describe = |slot: &Slot| match (slot, self.names(*slot)) {
            (Slot::Time | Slot::Step, (name, _)) => format!("`{name}`"),
            (Slot::Velocity, _) => "a new name (velocity)".to_string(),
            (Slot::Input, _) => "a new name with its type (input)".to_string(),
            (Slot::Offered, _) => "a new name with its group (symmetry)".to_string(),
            (_, (name, meaning)) => format!("`{name}` ({})", meaning.trim_start_matches("the ")),
        };
        let listed: Vec<String> = slots.iter().map(describe).collect();
        let order = if listed.len() > 1 { ", in this order" } else { "" };
        error.note(format!("arguments go by name: {}{order}", listed.join(", ")))
    }

    /// The slot that an unknown argument most likely stands for: the last one that is free before those behind it.
    fn meant(&self, position: usize, taken: &[Option<Slot>], slots: &[Slot]) -> Option<Slot> {
        let index = |slot: Slot| slots.iter().position(|&other| other == slot);
        let unknown_behind = taken[position + 1..].iter().filter(|slot| slot.is_none()).count();
        let limit = taken[position + 1..].iter().flatten().filter_map(|&slot| index(slot)).min().unwrap_or(slots.len());
        let free =
            |slot: &&Slot| !matches!(slot, Slot::Time | Slot::Step | Slot::Input) && !taken.contains(&Some(**slot));
        slots[..limit].iter().rev().filter(free).nth(unknown_behind).copied()
    }

    /// The arguments as they should be.
    pub(super) fn head(
        &self,
        taken: &[Option<Slot>],
        slots: &[Slot],
        meant: Option<Slot>,
        closure: &Closure,
    ) -> String {
        let wanted = slots.iter().filter(|slot| taken.contains(&Some(**slot)) || Some(**slot) == meant);
        let names: Vec<String> = wanted
            .map(|&slot| match taken.iter().position(|other| *other == Some(slot)) {
                Some(position) => match slot {
                    Slot::Offered | Slot::Input => closure.arguments[position].spell(),
                    _ => closure.arguments[position].pattern.spell(),
                },
                None => self.names(slot).0,
            })
            .collect();
        format!("|{}|", names.join(", "))
    }

    fn check_order(&self, closure: &Closure, taken: &[Option<Slot>], slots: &[Slot], diagnostics: &mut Diagnostics) {
        let index = |slot: &Slot| slots.iter().position(|other| other == slot);
        let order: Vec<usize> = taken.iter().flatten().filter_map(index).collect();
        if !taken.contains(&None) && order.windows(2).any(|pair| pair[0] > pair[1]) {
            let error =
                Diagnostic::new(closure.head, format!("the arguments of the {} are in another order", closure.key));
            diagnostics.push(error.help(format!("write `{}`", self.head(taken, slots, None, closure))));
        }
    }
}
