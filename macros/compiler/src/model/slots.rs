//! The meaning of each argument. It is found by the name that the action gives, and arguments keep their order.

use clebsch_symbolic::{Elements, IntoList};
use syn::ext::IdentExt;

use super::arguments::TypedArguments;
use super::elaborate::reserved;
use super::references;
use super::scope::check_reserved;
use crate::diagnostic::{Diagnostic, error, report};
use crate::parse::{Argument, Closure, Pattern, joined, spell_type};

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
    /// A reference, data of a plan, which has a type.
    Reference,
}

// the arguments of each closure, in order; the price is of a step
pub(super) const COST: &[Slot] = &[Slot::Time, Slot::Step, Slot::Configuration, Slot::Element];
pub(super) const LAGRANGIAN: &[Slot] = &[Slot::Time, Slot::Configuration, Slot::Velocity];
pub(super) const POTENTIAL: &[Slot] = &[Slot::Time, Slot::Configuration];
pub(super) const MONITOR: &[Slot] = &[Slot::Configuration];
pub(super) const FORCE: &[Slot] = &[Slot::Time, Slot::Configuration, Slot::Velocity, Slot::Input];
pub(super) const CHOSEN_FORCE: &[Slot] =
    &[Slot::Time, Slot::Configuration, Slot::Velocity, Slot::Input, Slot::Reference];
pub(super) const CONSTRAINT: &[Slot] = &[Slot::Time, Slot::Configuration, Slot::Velocity];
pub(super) const CONTROLS: &[Slot] = &[Slot::Time, Slot::Configuration, Slot::Input, Slot::Reference];
pub(super) const DYNAMICS: &[Slot] = &[Slot::Time, Slot::Step, Slot::Configuration, Slot::Input, Slot::Reference];
pub(super) const RIGHT_HAND_SIDE: &[Slot] = &[Slot::Time, Slot::Configuration, Slot::Input, Slot::Reference];
pub(super) const PRICE: &[Slot] = &[Slot::Time, Slot::Step, Slot::Configuration, Slot::Chosen, Slot::Reference];
pub(super) const EFFORT: &[Slot] =
    &[Slot::Time, Slot::Step, Slot::Configuration, Slot::Velocity, Slot::Chosen, Slot::Reference];
pub(super) const BOUNDS: &[Slot] = &[Slot::Time, Slot::Configuration, Slot::Chosen, Slot::Reference];
pub(super) const BOUNDS_OF_FORCES: &[Slot] =
    &[Slot::Time, Slot::Configuration, Slot::Velocity, Slot::Chosen, Slot::Reference];
pub(super) const END: &[Slot] = &[Slot::Time, Slot::Configuration, Slot::Reference];
pub(super) const END_OF_STATES: &[Slot] = &[Slot::Time, Slot::Configuration, Slot::Velocity, Slot::Reference];
pub(super) const SYMMETRY: &[Slot] = &[Slot::Offered, Slot::Configuration, Slot::Element];

/// The arguments of the closure of each key.
const ARGUMENTS: [(&str, &[Slot]); 14] = [
    ("cost", COST),
    ("lagrangian", LAGRANGIAN),
    ("potential", POTENTIAL),
    ("step", MONITOR),
    ("symmetry", SYMMETRY),
    ("force", FORCE),
    ("force_on", FORCE),
    ("constraint", CONSTRAINT),
    ("controls", CONTROLS),
    ("dynamics", DYNAMICS),
    ("effort", EFFORT),
    ("bounds", BOUNDS_OF_FORCES),
    ("endpoint", END_OF_STATES),
    ("target", END_OF_STATES),
];

/// The arguments that the closure of a key may take, in their order, as the docs say it; `None` for a key without.
pub(crate) fn arguments_of(key: &str) -> Option<String> {
    if key == "space" {
        return Some("a new name (spacing), the configuration, a new name (that of the neighbour). In place of the last two, a name (group element)".to_string());
    }
    if key == "action" {
        return Some("a new name with its group (group element), a new name with its type (configuration)".to_string());
    }
    let (_, slots) = ARGUMENTS.iter().find(|(name, _)| *name == key)?;
    let name = |slot: &Slot| match slot {
        Slot::Time => "`t` (time)",
        Slot::Step => "`h` (step)",
        Slot::Configuration => "the configuration",
        Slot::Element => "the group element",
        Slot::Velocity => "a new name (velocity)",
        Slot::Offered => "a new name with its group (symmetry)",
        Slot::Input => "a new name with its type (input)",
        Slot::Chosen => "the input",
        Slot::Reference => "new names with their types (references)",
    };
    let also = match key {
        "cost" => "; with `controls` and `dynamics` the input and references in place of the group element",
        "dynamics" => ". A right-hand side takes no step",
        "constraint" => "; without a velocity it is on the configuration",
        "force" | "force_on" => ". With `effort` new names with their types stand behind it (references)",
        "bounds" | "endpoint" | "target" => "; with `controls` and `dynamics` no velocity",
        _ => "",
    };
    Some(format!("{}{also}", joined(slots.iter().map(name))))
}

impl<'d> TypedArguments<'d> {
    /// The pattern and the meaning of a slot; a velocity and the element of a symmetry are introduced by their closures.
    fn names(&self, slot: Slot) -> (String, &'static str) {
        match slot {
            Slot::Time => ("t".into(), "the time"),
            Slot::Step => ("h".into(), "the step"),
            Slot::Configuration => (self.configuration.spell(), "the configuration"),
            Slot::Element => (self.element.spell(), "the group element"),
            Slot::Velocity => {
                (self.declared_velocity().map_or("omega".into(), Pattern::spell), "the velocity a new name")
            }
            Slot::Input => ("u: Vector3".into(), "the input, a new name and its type"),
            Slot::Chosen => (self.input.map_or("u".into(), Pattern::spell), "the input"),
            Slot::Reference => ("r: Vector3".into(), "a reference, a new name and its type"),
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

    fn find(&self, pattern: &Pattern, slots: &[Slot]) -> Option<Slot> {
        slots.iter().copied().find(|&slot| match (slot, pattern) {
            (Slot::Time, Pattern::Name(ident)) => ident == "t",
            (Slot::Step, Pattern::Name(ident)) => ident == "h",
            (Slot::Reference, _) => references::find(self.references(slots), pattern).is_some(),
            _ => self.pattern(slot).is_some_and(|known| known.holds(pattern)),
        })
    }

    /// The references that a closure with these slots may read.
    fn references(&self, slots: &[Slot]) -> &[&'d Argument] {
        if is_of_step(slots) { &self.references.of_steps } else { &self.references.of_end }
    }

    /// Whether an argument of a step has a meaning without being a reference.
    pub(super) fn is_other(&self, pattern: &Pattern) -> bool {
        let others = [Slot::Time, Slot::Step, Slot::Configuration, Slot::Chosen];
        self.find(pattern, &others).is_some() || self.declared_velocity().is_some_and(|known| known.holds(pattern))
    }

    /// The velocity as the Lagrangian or a force calls it.
    pub(super) fn declared_velocity(&self) -> Option<&'d Pattern> {
        self.velocity.filter(|pattern| !self.is_known(pattern))
    }

    /// Whether a pattern has a meaning in some closure.
    fn is_known(&self, pattern: &Pattern) -> bool {
        [COST, BOUNDS, END].into_iter().any(|slots| self.find(pattern, slots).is_some())
    }
}

/// The time or the step among these slots, where a pattern is its name in other programs.
fn other_name(pattern: &Pattern, slots: &[Slot]) -> Option<Slot> {
    let slot = match reserved(&pattern.spell())? {
        "t" => Slot::Time,
        _ => Slot::Step,
    };
    slots.contains(&slot).then_some(slot)
}

/// Whether slots are those of a step: of its motion, its price or its bounds.
fn is_of_step(slots: &[Slot]) -> bool {
    slots.contains(&Slot::Chosen) || slots.contains(&Slot::Input)
}

/// The arguments of a closure, with the slot that each takes.
pub(super) struct Matched<'d> {
    pub closure: &'d Closure,
    names: TypedArguments<'d>,
    slots: &'static [Slot],
    /// `None` for an argument with an error, which was reported.
    taken: Vec<Option<Slot>>,
}

impl<'d> Matched<'d> {
    /// Finds the slot that each argument takes, and reports mistakes in them.
    pub fn new(names: TypedArguments<'d>, closure: &'d Closure, slots: &'static [Slot]) -> Matched<'d> {
        let arguments = &closure.arguments;
        let mut taken: Vec<Option<Slot>> = arguments.each(|argument| names.find(&argument.pattern, slots));
        let mut untyped = arguments.len();
        if slots.contains(&Slot::Input) && slots.contains(&Slot::Reference) {
            // the first argument with a type; those behind it are references
            let input = arguments.iter().position(|argument| argument.ty.is_some());
            // given twice, an error of its own
            let names_it = |argument: &Argument| {
                input.is_some() && names.input.is_some_and(|known| known.matches(&argument.pattern))
            };
            for (position, argument) in arguments.iter().enumerate() {
                if Some(position) == input || taken[position].is_none() && names_it(argument) {
                    taken[position] = Some(Slot::Input);
                }
            }
            untyped = input.unwrap_or(untyped);
            while untyped > 0 && taken[untyped - 1] == Some(Slot::Reference) {
                untyped -= 1;
            }
        } else if slots.contains(&Slot::Input) && arguments.last().is_some_and(|argument| argument.ty.is_some()) {
            untyped -= 1;
            taken[untyped] = Some(Slot::Input);
            // a second input before it, an error of its own
            let is_typed = |position: usize| arguments[position].ty.is_some() && taken[position].is_none();
            untyped = (0..untyped).rev().find(|&position| !is_typed(position)).map_or(0, |position| position + 1);
        }
        if let Some(last) = untyped.checked_sub(1).filter(|_| slots.contains(&Slot::Velocity))
            && taken[last].is_none()
            && !names.is_known(&arguments[last].pattern)
            && other_name(&arguments[last].pattern, slots).is_none()
        {
            taken[last] = Some(Slot::Velocity);
        }
        // a velocity before the other arguments is in another order
        let is_new = |position: &usize| {
            let pattern = &arguments[*position].pattern;
            taken[*position].is_none() && !names.is_known(pattern) && other_name(pattern, slots).is_none()
        };
        let new: Vec<usize> = (0..untyped).filter(is_new).into_list();
        if let &[only] = new.as_slice()
            && slots.contains(&Slot::Velocity)
            && !taken.contains(&Some(Slot::Velocity))
        {
            taken[only] = Some(Slot::Velocity);
        }
        let introduces = |argument: &Argument| argument.ty.is_some() || arguments.len() == slots.len();
        if slots.contains(&Slot::Offered) && arguments.first().is_some_and(introduces) {
            taken[0] = Some(Slot::Offered);
        }
        let mut matched = Matched { closure, names, slots, taken };
        matched.check_velocity_of_price();
        (0..arguments.len()).for_each(|position| matched.check_argument(position));
        matched.check_order();
        if closure.key == "lagrangian" && !matched.has(Slot::Velocity) && !matched.has_error() {
            report!(matched.names.diagnostics, closure.head, "the lagrangian has no velocity";
                help "write `{} …`", matched.head(Some(Slot::Velocity)));
        }
        matched
    }

    /// Whether this is a price or a bound of inputs of forces, or the price of the end.
    fn is_price(&self) -> bool {
        self.slots.contains(&Slot::Velocity) && (self.slots.contains(&Slot::Chosen) || self.is_of_end())
    }

    /// Whether it is of the end of a plan.
    fn is_of_end(&self) -> bool {
        self.closure.key == "endpoint" || self.closure.key == "target"
    }

    /// In a price a new name may be a slip of the pen for another argument. It is the velocity where the Lagrangian or
    /// a force calls it so, and where all others are there.
    fn check_velocity_of_price(&mut self) {
        let Some(position) = self.taken.iter().position(|slot| *slot == Some(Slot::Velocity)) else { return };
        let pattern = &self.closure.arguments[position].pattern;
        let is_declared = self.names.declared_velocity().is_some_and(|velocity| velocity.holds(pattern));
        let is_free = |slot: &Slot| matches!(slot, Slot::Configuration | Slot::Chosen) && !self.has(*slot);
        let is_late = self.taken[..position].contains(&Some(Slot::Chosen));
        if self.is_price() && !is_declared && (is_late || self.slots.iter().any(is_free)) {
            self.taken[position] = None;
        }
    }

    /// The advice for a new name in a price that may be the velocity.
    fn of_velocity_of_price(&self, position: usize) -> Option<String> {
        let pattern = &self.closure.arguments[position].pattern;
        let is_declared = self.names.declared_velocity().is_some();
        if !self.is_price() || is_declared || self.has(Slot::Velocity) || self.names.is_known(pattern) {
            return None;
        }
        let all = |slot: &&Slot| !matches!(slot, Slot::Time | Slot::Step | Slot::Reference) || self.has(**slot);
        let name = |slot: &Slot| match slot {
            Slot::Velocity => pattern.spell(),
            slot => self.names.names(*slot).0,
        };
        let all = self.slots.iter().filter(all).map(name);
        Some(format!("a new name is the velocity where all other arguments are there: `|{}|`", joined(all)))
    }

    /// Whether an argument has an error, which was reported.
    pub fn has_error(&self) -> bool {
        self.taken.contains(&None)
    }

    fn has(&self, slot: Slot) -> bool {
        self.taken.contains(&Some(slot))
    }

    /// The first slot that no argument takes.
    pub fn first_free(&self) -> Option<Slot> {
        self.slots.iter().copied().find(|slot| !self.has(*slot))
    }

    /// Whether it is of a step: of its motion, its price or its bounds.
    pub fn is_of_step(&self) -> bool {
        is_of_step(self.slots)
    }

    pub fn argument(&self, slot: Slot) -> Option<&'d Argument> {
        let position = self.taken.iter().position(|taken| *taken == Some(slot))?;
        Some(&self.closure.arguments[position])
    }

    pub fn arguments(&self) -> impl Iterator<Item = (&'d Argument, Option<Slot>)> {
        self.closure.arguments.iter().zip(self.taken.iter().copied())
    }

    fn check_argument(&self, position: usize) {
        let diagnostics = self.names.diagnostics;
        let argument = &self.closure.arguments[position];
        let slot = self.taken[position];
        let (name, place) = (argument.pattern.spell(), argument.pattern.place());
        if let (Some(ty), None, Some(Some(Slot::Input))) = (&argument.ty, slot, self.taken.get(position + 1)) {
            let next = &self.closure.arguments[position + 1];
            let (other, other_ty) = (next.pattern.spell(), next.ty.as_ref().map(spell_type).unwrap_or_default());
            report!(diagnostics, place, "the {} has two inputs, `{name}` and `{other}`", self.closure.key;
                help "write one, a tuple: `({name}, {other}): ({}, {other_ty})`", spell_type(ty);
                note "where `effort` chooses the input, names with types behind it are references");
            return;
        }
        let is_new = slot.is_none() && !self.names.is_known(&argument.pattern);
        let is_introduced = is_new || matches!(slot, Some(Slot::Offered | Slot::Input)) || self.introduces(argument);
        if let Some(ty) = argument.ty.as_ref().filter(|_| !is_introduced) {
            let introduces = match slot {
                Some(Slot::Reference) => "the type of a reference stands where it is first read",
                _ => "types stand in the action, which introduces the spaces",
            };
            report!(diagnostics, ty, "`{name}` has a type again";
                help "write `{name}` without `: {}`", spell_type(ty); note "{introduces}");
        }
        match slot {
            Some(slot) if self.is_taken_before(position, slot) => {
                report!(diagnostics, place, "`{name}` is given twice"; help "remove one of the two");
            }
            Some(Slot::Velocity) => self.check_new(argument, "the velocity"),
            Some(Slot::Offered) => self.check_new(argument, "the symmetry"),
            Some(Slot::Input) => self.check_new(argument, "the input"),
            Some(Slot::Reference) if self.introduces(argument) => self.check_new(argument, "a reference"),
            Some(_) => {}
            None => diagnostics.push(self.unknown(position)),
        }
    }

    /// Whether an argument introduces a reference.
    fn introduces(&self, argument: &Argument) -> bool {
        let references = self.names.references(self.slots);
        self.slots.contains(&Slot::Reference) && references.iter().any(|known| std::ptr::eq(*known, argument))
    }

    /// Whether an argument before this one has the same slot. Parts of a tuple are given one by one.
    fn is_taken_before(&self, position: usize, slot: Slot) -> bool {
        let pattern = &self.closure.arguments[position].pattern;
        let mut before = self.arguments().take(position).filter(|(_, taken)| *taken == Some(slot));
        if slot == Slot::Reference {
            return before.any(|(other, _)| other.pattern.holds(pattern) || pattern.holds(&other.pattern));
        }
        let is_part = |other: &Pattern| self.names.pattern(slot).is_some_and(|whole| !whole.matches(other));
        let is_other =
            |other: &Pattern| is_part(other) && is_part(pattern) && !other.holds(pattern) && !pattern.holds(other);
        before.any(|(argument, _)| !is_other(&argument.pattern))
    }

    /// A name that a closure introduces is no name of the action.
    fn check_new(&self, argument: &Argument, what: &str) {
        let of_action = [self.names.element.names(), self.names.configuration.names()].concat();
        for ident in argument.pattern.names() {
            let free = check_reserved(ident, what, self.names.diagnostics);
            if free && of_action.iter().any(|known| known.unraw() == ident.unraw()) {
                report!(self.names.diagnostics, ident, "`{ident}` is an argument of the action and cannot be the name of {what}";
                    help "choose another name");
            }
        }
    }

    /// The advice if the potential reads the velocity and this is its pattern in the Lagrangian.
    fn of_velocity(&self) -> Option<(&'d Pattern, String)> {
        let velocity = self.names.declared_velocity().filter(|_| self.slots == POTENTIAL)?;
        let name = velocity.spell();
        let q = self.names.configuration.spell();
        Some((
            velocity,
            format!(
                "write `force = |{name}| …`; a term linear in the velocity, as of a magnetic field, belongs to `lagrangian = |{q}, {name}| …`"
            ),
        ))
    }

    /// The error for an argument that the action does not know.
    fn unknown(&self, position: usize) -> Diagnostic {
        let Argument { pattern, .. } = &self.closure.arguments[position];
        let (name, key) = (pattern.spell(), &self.closure.key);
        if let Some(error) = self
            .in_other_order(position)
            .or_else(|| self.without_type(position))
            .or_else(|| self.reference_without_type(position))
        {
            return error;
        }
        if let Some((_, help)) = self.of_velocity().filter(|(velocity, _)| velocity.matches(pattern)) {
            return error!(pattern.place(), "the {key} cannot depend on the velocity `{name}`"; help "{help}");
        }
        let is_input = self.names.input.is_some_and(|input| input.holds(pattern));
        if key == "lagrangian" && is_input && !self.has(Slot::Velocity) {
            return error!(pattern.place(), "`{name}` is the velocity in the {key}, and the input of a force or of the price";
                help "give one of them another name"; note "a force takes the velocity, and the input behind it with its type");
        }
        let error = if self.names.is_known(pattern) {
            error!(pattern.place(), "the {key} cannot depend on `{name}`")
        } else {
            error!(pattern.place(), "cannot find `{name}` in the {key}")
        };
        let meant = self.called_otherwise(pattern).or_else(|| self.meant(position));
        let head = self.head(meant);
        let error = error.help(match meant.map(|slot| (slot, self.names.names(slot))) {
            Some((Slot::Velocity, (name, _))) if self.is_price() && self.names.declared_velocity().is_some() => {
                format!("the velocity is called `{name}`: write `{head}`")
            }
            Some((Slot::Velocity, (_, meaning))) => format!("give {meaning}: write `{head}`"),
            Some((Slot::Time | Slot::Step, (known, meaning))) => {
                format!("{meaning} is called `{known}`: write `{head}`")
            }
            Some((_, (known, meaning))) => format!("the action calls {meaning} `{known}`: write `{head}`"),
            None => format!("write `{head}`"),
        });
        let describe = |slot: &Slot| match (slot, self.names.names(*slot)) {
            (Slot::Time | Slot::Step, (name, _)) => format!("`{name}`"),
            (Slot::Velocity, _) => "a new name (velocity)".to_string(),
            (Slot::Input, _) => "a new name with its type (input)".to_string(),
            (Slot::Offered, _) => "a new name with its group (symmetry)".to_string(),
            (Slot::Reference, _) => "new names with their types (references)".to_string(),
            (_, (name, meaning)) => format!("`{name}` ({})", meaning.trim_start_matches("the ")),
        };
        let error = match self.of_velocity_of_price(position) {
            Some(advice) => error.note(advice),
            None => error,
        };
        let order = if self.slots.len() > 1 { ", in this order" } else { "" };
        error.note(format!("arguments go by name: {}{order}", joined(self.slots.iter().map(describe))))
    }

    /// The error for an input before the velocity, where all other arguments are known.
    fn in_other_order(&self, position: usize) -> Option<Diagnostic> {
        let arguments = &self.closure.arguments;
        let has_input = self.slots.contains(&Slot::Velocity) && self.slots.contains(&Slot::Input);
        let input = arguments.iter().position(|argument| argument.ty.is_some()).filter(|_| has_input)?;
        let is_new = |&at: &usize| arguments[at].ty.is_none() && !self.names.is_known(&arguments[at].pattern);
        let new: Vec<usize> = (0..arguments.len()).filter(is_new).into_list();
        let &[velocity] = new.as_slice() else { return None };
        let is_declared =
            self.names.declared_velocity().is_some_and(|known| known.matches(&arguments[velocity].pattern));
        // with references behind the input, another new name may be one of these.
        let is_other = self.slots.contains(&Slot::Reference) && !is_declared;
        let is_slip = other_name(&arguments[velocity].pattern, self.slots).is_some();
        let is_one = |at: usize| at == input || at == velocity;
        let are_known =
            (0..arguments.len()).all(|at| is_one(at) || self.taken[at].is_some() && arguments[at].ty.is_none());
        if is_other || is_slip || velocity < input || !is_one(position) || !are_known {
            return None;
        }
        let of_slot = |slot: &Slot| match slot {
            Slot::Velocity => vec![arguments[velocity].spell()],
            Slot::Input => vec![arguments[input].spell()],
            slot => {
                let takes = |at: &usize| !is_one(*at) && self.taken[*at] == Some(*slot);
                (0..arguments.len()).filter(takes).map(|at| arguments[at].spell()).into_list()
            }
        };
        let head = joined(self.slots.iter().flat_map(of_slot));
        let (key, place) = (&self.closure.key, arguments[position].pattern.place());
        let (input, velocity) = (arguments[input].pattern.spell(), arguments[velocity].pattern.spell());
        Some(error!(place, "the input `{input}` of the {key} stands before the velocity `{velocity}`";
            help "write `|{head}|`"; note "the velocity has no type, and the input has one"))
    }

    /// The error for two new names at the end: the velocity, and an input without a type.
    fn without_type(&self, position: usize) -> Option<Diagnostic> {
        let arguments = &self.closure.arguments;
        let is_new = |position: usize| !self.names.is_known(&arguments[position].pattern);
        let last = arguments.len() - 1;
        let is_input =
            self.slots.contains(&Slot::Velocity) && self.slots.contains(&Slot::Input) && !self.has(Slot::Input);
        if !is_input || position + 1 != last || !is_new(position) || !is_new(last) || arguments[last].ty.is_some() {
            return None;
        }
        let (key, input) = (&self.closure.key, arguments[last].pattern.spell());
        let head = arguments.iter().map(|argument| argument.pattern.spell());
        Some(error!(arguments[last].pattern.place(), "`{input}` is new in the {key} and has no type";
            help "write `|{}: Vector3|`, with the type of the input", joined(head);
            note "an input stands behind the velocity, with its type; the velocity has none"))
    }

    /// The error for a new name behind all others, in a closure that may read references.
    fn reference_without_type(&self, position: usize) -> Option<Diagnostic> {
        let arguments = &self.closure.arguments;
        let pattern = &arguments[position].pattern;
        let is_last = |slot: &Slot| match slot {
            Slot::Chosen | Slot::Input => true,
            slot => *slot == Slot::Configuration && !is_of_step(self.slots),
        };
        let is_late = self.taken[..position].iter().flatten().any(is_last);
        if !self.slots.contains(&Slot::Reference) || self.names.is_known(pattern) || !is_late {
            return None;
        }
        let spelled = |(k, argument): (usize, &Argument)| {
            if k == position { format!("{}: Vector3", pattern.spell()) } else { argument.spell() }
        };
        let head = joined(arguments.iter().enumerate().map(spelled));
        let note = match is_of_step(self.slots) {
            true => "a new name behind the input is a reference, which `Control::refer` gives to each step",
            false => "a new name with a type is a reference, which `Control::with_end_reference` gives",
        };
        let (key, name) = (&self.closure.key, pattern.spell());
        Some(error!(pattern.place(), "`{name}` is new in the {key} and has no type";
            help "write `|{head}|`, with the type of the reference"; note "{note}"))
    }

    /// The time or the step where an unknown argument has another name for it.
    fn called_otherwise(&self, pattern: &Pattern) -> Option<Slot> {
        other_name(pattern, self.slots).filter(|slot| !self.has(*slot))
    }

    /// The slot that an unknown argument most likely stands for: the last one that is free before those behind it.
    fn meant(&self, position: usize) -> Option<Slot> {
        let behind = &self.taken[position + 1..];
        let unknown_behind = behind.iter().filter(|slot| slot.is_none()).count();
        let limit = behind.iter().flatten().filter_map(|slot| self.index(*slot)).min().unwrap_or(self.slots.len());
        let free =
            |slot: &Slot| !matches!(slot, Slot::Time | Slot::Step | Slot::Input | Slot::Reference) && !self.has(*slot);
        self.slots[..limit].iter().rev().copied().filter(free).nth(unknown_behind)
    }

    fn index(&self, slot: Slot) -> Option<usize> {
        self.slots.iter().position(|other| *other == slot)
    }

    /// The arguments as they should be.
    pub fn head(&self, meant: Option<Slot>) -> String {
        // also those that are there by other names
        let is_called = |slot: Slot| {
            let is = |pattern| self.called_otherwise(pattern) == Some(slot);
            self.arguments().any(|(argument, taken)| taken.is_none() && is(&argument.pattern))
        };
        let is_wanted = |slot: &Slot| self.has(*slot) || Some(*slot) == meant || is_called(*slot);
        let wanted = self.slots.iter().copied().filter(is_wanted);
        let given = |slot: Slot| -> Vec<String> {
            let arguments = self.arguments().filter(|(_, taken)| *taken == Some(slot));
            arguments.map(|(argument, _)| argument.spell()).into_list()
        };
        let names = |slot: Slot| if self.has(slot) { given(slot) } else { vec![self.names.names(slot).0] };
        format!("|{}|", joined(wanted.flat_map(names)))
    }

    fn check_order(&self) {
        let order: Vec<usize> = self.taken.iter().flatten().filter_map(|slot| self.index(*slot)).into_list();
        if !self.has_error() && !order.is_sorted() {
            let key = &self.closure.key;
            report!(self.names.diagnostics, self.closure.head, "the arguments of the {key} are in another order";
                help "write `{}`", self.head(None));
        }
    }

    /// The names of the declaration that are no arguments here, and the advice for each.
    pub fn missing(&self) -> Vec<(String, String)> {
        let named = [Slot::Time, Slot::Step, Slot::Configuration, Slot::Element, Slot::Chosen];
        let named = named.into_iter().filter(|slot| *slot != Slot::Chosen || !self.slots.contains(&Slot::Input));
        let missing = named.filter(|slot| !self.has(*slot)).flat_map(|slot| {
            let help = if self.slots.contains(&slot) {
                format!("take it as an argument: write `{}`", self.head(Some(slot)))
            } else {
                self.dependence()
            };
            let names = match (self.names.pattern(slot), slot) {
                (Some(pattern), _) => pattern.names().each(|ident| ident.unraw().to_string()),
                (None, Slot::Chosen) => Vec::new(),
                (None, _) => vec![self.names.names(slot).0],
            };
            names.into_iter().map(move |name| (name, help.clone()))
        });
        let of_velocity = self.of_velocity().into_iter().flat_map(|(velocity, help)| {
            velocity.names().into_iter().map(move |ident| (ident.unraw().to_string(), help.clone()))
        });
        let velocity = self.names.declared_velocity().filter(|_| self.is_price() && !self.has(Slot::Velocity));
        let of_price = velocity.into_iter().flat_map(|velocity| {
            let help = format!("take it as an argument: write `{}`", self.head(Some(Slot::Velocity)));
            velocity.names().into_iter().map(move |ident| (ident.unraw().to_string(), help.clone()))
        });
        let references = self.names.references.of_steps.iter().filter(|_| self.slots.contains(&Slot::Reference));
        let is_read =
            |argument: &&&Argument| self.closure.arguments.iter().any(|own| argument.pattern.holds(&own.pattern));
        let of_references = references.filter(|argument| !is_read(argument)).flat_map(|argument| {
            let all = self.closure.arguments.iter().map(Argument::spell).chain([argument.pattern.spell()]);
            let help = format!("take it as an argument: write `|{}|`", joined(all));
            argument.pattern.names().into_iter().map(move |ident| (ident.unraw().to_string(), help.clone()))
        });
        missing.chain(of_velocity).chain(of_price).chain(of_references).into_list()
    }

    /// The arguments on which the closure may depend.
    fn dependence(&self) -> String {
        let (key, q) = (&self.closure.key, self.names.configuration.spell());
        let has = |slot| self.slots.contains(&slot);
        if has(Slot::Chosen) || (has(Slot::Input) && !has(Slot::Velocity)) {
            let step = if has(Slot::Step) { "the step `h`, " } else { "" };
            let velocity = if has(Slot::Velocity) { ", the velocity" } else { "" };
            return format!(
                "the {key} may depend on the time `t`, {step}the configuration `{q}`{velocity} and the input alone"
            );
        }
        if has(Slot::Offered) {
            let f = self.names.element.spell();
            return format!("the {key} depends on its own element, on `{q}` and on `{f}` alone");
        }
        let [before, after] = match (has(Slot::Input), has(Slot::Velocity)) {
            (true, _) => [",", ", the velocity and an input"],
            (false, true) => [",", " and the velocity"],
            (false, false) => [" and", ""],
        };
        format!("the {key} depends on the time `t`{before} the configuration `{q}`{after} alone")
    }
}
